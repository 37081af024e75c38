"""Mobility of a single vertex: D_M and a_h from boxes of several sizes, hydrodynamics on and off."""
import dataclasses
import functools
import math
import pathlib
import re
import string

import numpy

from lib import dilute, figures, lags
from lib.case import Figure, Outcome
from lib.runs import Run

TITLE = "A vertex: diffusion, hydrodynamic radius, and what the box does"
PAPER = "Sec. IV A, Table II"
SCENE = string.Template((pathlib.Path(__file__).parent / "vertices.yaml").read_text())


def vertices(name, box, count, time, bath="hydrodynamics", seed=1, priority=0):
    """A run of loose vertices; time in t0."""
    scene = SCENE.substitute(box=box, count=count, hydrodynamics=str(bath == "hydrodynamics").lower(),
                             bath="phantoms" if bath == "phantoms" else "particles")
    return Run(name, scene=scene, steps=round(time / 0.02), seed=seed, priority=priority,
               hours=dilute.hours(box, count, time, bath=bath))


# Boxes with hydrodynamics: vertices, one in 128 cells, and time in t0 of one run. Each has 1.9e5 vertex t0 or more.
BOXES = {8: (4, 60000), 10: (8, 30000), 12: (14, 18000), 16: (32, 8000), 24: (108, 2400), 32: (256, 1200)}
CROWDED = {8: 8000, 128: 8000, 512: 6000}  # vertices in 16^3 cells
SEEDS = ((0, 1), (1, 4), (2, 10))  # priority, seeds up to


def campaign():
    found = [vertices("phantoms-L64", 64, 256, 5000, bath="phantoms"),
             vertices("swap-L8", 8, 4, 30000, bath="swap"),
             vertices("swap-L16", 16, 32, 4000, bath="swap", priority=1)]
    before = 0
    for priority, seeds in SEEDS:
        for seed in range(before + 1, seeds + 1):
            found += [vertices(f"L{box}-s{seed}", box, count, time, seed=100 * box + seed, priority=priority)
                      for box, (count, time) in BOXES.items()]
        before = seeds
    return found + [vertices(f"crowd-{count}", 16, count, time, seed=count, priority=1)
                    for count, time in CROWDED.items()]


def quick():
    return [vertices("phantoms-L64", 64, 128, 1500, bath="phantoms"),
            vertices("swap-L8", 8, 4, 6000, bath="swap"),
            vertices("L8-s1", 8, 8, 25000, seed=801)]


def runs(tier):
    return quick() if tier == "quick" else campaign()


# --- what they say ----------------------------------------------------------------------------------------------------

LAST = 51.2  # longest lag, t0
LAG_BIAS = 0.008  # of D: by how much later first lags and shortest waves move it


def systems(results):
    """Merged tables of each box and number of vertices with hydrodynamics: {(box, vertices): (table, correction)}."""
    groups = {}
    for name, result in results.items():
        box = int(re.search(r"box: \[(\d+)", result.run.scene)[1])
        count = int(re.search(r"count: (\d+)", result.run.scene)[1])
        if "hydrodynamics: true" in result.run.scene:
            groups.setdefault((box, count), []).append(result)
    found = {}
    for (box, count), members in sorted(groups.items()):
        table = dilute.merged(members, "vertex")
        if table is not None:
            found[box, count] = table, functools.partial(dilute.memory, box=box)
    return found


def without(results, name, count, box):
    """(D, error) of vertices without hydrodynamics; None without the run."""
    table = dilute.merged([results[name]], "vertex") if name in results else None
    if table is None:
        return None
    limit = dilute.long_time([(table, numpy.zeros_like)], 0.4, [12.8])
    share = 1.0 if name.startswith("phantoms") else dilute.closed_box(count, dilute.MASS, box)
    return (limit.value[0] / share, limit.error[0] / share) if limit else None


@dataclasses.dataclass
class Boxes:
    """D of a vertex in closed boxes, by (box, vertices), and what is common to them."""
    keys: list
    value: numpy.ndarray  # without the closed box's share
    covariance: numpy.ndarray
    local: float
    p: float  # of the fit to all lags

    @property
    def error(self):
        return numpy.sqrt(self.covariance.diagonal())

    def dilute(self):
        """Indices of the boxes that are held against 1/L: those with at most one vertex in 60 cells."""
        return [i for i, (box, count) in enumerate(self.keys) if 60 * count <= box ** 3]

    def line(self):
        """D = D_inf - slope 2.837297/(6 pi eta L): (values, covariance)."""
        use = self.dilute()
        shift = numpy.array([dilute.image_shift(self.keys[i][0]) for i in use])
        weight = numpy.linalg.inv(self.covariance[numpy.ix_(use, use)])
        design = numpy.stack([numpy.ones(len(use)), -shift], axis=1)
        covariance = numpy.linalg.inv(design.T @ weight @ design)
        return covariance @ design.T @ weight @ self.value[use], covariance

    def limit(self):
        """D_inf with the slope that theory has: (value, error)."""
        use = self.dilute()
        corrected = self.value[use] + [dilute.image_shift(self.keys[i][0]) for i in use]
        weight = numpy.linalg.inv(self.covariance[numpy.ix_(use, use)])
        return (weight @ corrected).sum() / weight.sum(), 1.0 / math.sqrt(weight.sum())


def boxes(results):
    found = systems(results)
    limit = dilute.long_time(list(found.values()), dilute.FIRST_LAG, [LAST] * len(found)) if found else None
    if limit is None:
        return found, None
    share = numpy.array([dilute.closed_box(count, dilute.MASS, box) for box, count in found])
    return found, Boxes(list(found), limit.value / share, limit.covariance / numpy.outer(share, share), limit.local,
                        limit.p)


def verdicts(measured, off, swap):
    chaos = dilute.vertex_diffusion()
    limit = measured.limit() if measured else None
    slope = radius = None
    reason = ""
    if measured:
        radius = dilute.stokes(limit[0]), dilute.stokes(limit[0]) * limit[1] / limit[0]
        reason = f"Table II sets 2a_h to the bond length, 0.5; with the measured radius p is {32.0 / (2.0 * radius[0]):.0f}"
        if len({measured.keys[i][0] for i in measured.dilute()}) > 1:
            best, covariance = measured.line()
            slope = best[1], math.sqrt(covariance[1, 1])
    return [
        dilute.held("mobility.chaos", "Without hydrodynamics (phantoms): D of a lone vertex over molecular chaos's",
                    1.0,
                    "molecular chaos: D_0 = (kT dt_c/M) [1/(1 - c) - 1/2] = 0.010662",
                    dilute.over(off, (chaos, 0.0)) if off else None, 0.003),
        dilute.held("mobility.swap", "The same with the paper's swap of velocities: who is near is remembered", 1.02,
                    "docs/accuracy.md, hydrodynamics off", dilute.over(swap, (chaos, 0.0)) if swap else None, 0.01,
                    known=0.003),
        lags.images_verdict("mobility", slope),
        dilute.scatter("mobility.lags", "Scatter of D(t) over lags and boxes about one local memory, in standard errors",
                       measured.p if measured else None),
        dilute.held("mobility.D", "D of a vertex in an infinite box", 0.0179, "docs/accuracy.md, another estimator",
                    limit, LAG_BIAS * 0.0179 + 0.0002, known=0.0001),
        dilute.held("mobility.radius-table", "a_h = kT/(6πηD), measured η, against the 0.25 that the aspect ratio of Table II stands "
                    "for (Sec. IV A says “about 0.3”)", 0.25,
                    "Table II, p = L/2a_h = 64", radius, LAG_BIAS * 0.27, kind="paper",
                    reason=reason)]


def draw_boxes(measured, off, swap):
    figure, axes, below = figures.with_residuals()
    if measured:
        limit, _ = measured.limit()
        x = numpy.linspace(0.0, 0.13, 50)
        figures.theory(axes, x, limit - dilute.stokes(1.0) * 2.837297 * x, label="images, measured viscosity")
        named = set()
        for i, (box, count) in enumerate(measured.keys):
            plain = i in measured.dilute()
            label = "with hydrodynamics" if plain else "the same, crowded"
            expected = limit - dilute.image_shift(box)
            for panel, y, error in ((axes, measured.value[i], measured.error[i]),
                                    (below, measured.value[i] / expected - 1.0, measured.error[i] / expected)):
                figures.points(panel, 1.0 / box, y, error, 0 if plain else 3, label=None if label in named else label)
            named.add(label)
    chaos = dilute.vertex_diffusion()
    figures.theory(axes, [0.0, 0.13], [chaos, chaos], linestyle="--", label="molecular chaos")
    for number, (name, pair, box) in enumerate((("phantoms", off, 64), ("swap", swap, 8)), 1):
        if pair:
            figures.points(axes, 1.0 / box, *pair, number=number, label=f"without, {name}")
    axes.set(ylabel="$D$ of a vertex ($a_0^2/t_0$)", ylim=(0.009, 0.0195))
    figures.legend_above(axes)
    below.set(xlabel="$1/L_b$ ($1/a_0$)", ylabel="over line, $-1$", ylim=(-0.07, 0.03), xlim=(-0.002, 0.132))
    return figure


def draw_lags(found, measured):
    figure, axes, below = figures.with_residuals()
    shown = [key for key in found if key[0] in (8, 16, 32) and 60 * key[1] <= key[0] ** 3]
    for number, key in enumerate(shown):
        table, correction = found[key]
        value = measured.value[measured.keys.index(key)] * dilute.closed_box(key[1], dilute.MASS, key[0])
        t = table["time"]
        model = value - correction(t) - measured.local / t
        late = t >= 0.8
        kept = (t >= 0.999 * dilute.FIRST_LAG) & (t <= 1.001 * LAST)
        figures.theory(axes, t[late], model[late], color=figures.COLORS[number])
        figures.points(axes, t, table["D"], table["D_error"], number, label=f"$L_b$ = {key[0]} $a_0$, {key[1]} vertices")
        for which, fill in ((late & ~kept, "none"), (kept, figures.COLORS[number])):
            figures.points(below, t[which], (table["D"] / model - 1.0)[which], (table["D_error"] / model)[which], number,
                           markerfacecolor=fill)
    axes.set(xscale="log", ylabel="$g(t)/6t$ ($a_0^2/t_0$)", ylim=(0.005, 0.019))
    figures.named(axes, "$D$ less its memory", linestyle="-", linewidth=1.1)
    figures.named(below, "lags left out of the fit", marker="o", markerfacecolor="none")
    figures.legend_above(axes, below, columns=3)
    below.set(xlabel="lag $t$ ($t_0$)", ylabel="over model, $-1$", ylim=(-0.21, 0.05))
    return figure


def words(measured):
    if not measured:
        return ""
    limit, error = measured.limit()
    text = f"""In an infinite box D = {limit:.5f} ± {error:.5f} (statistical), and up to {100 * LAG_BIAS:.1f} % for the
choice of lags: a hydrodynamic radius of {dilute.stokes(limit):.3f} a0, {limit / dilute.vertex_diffusion():.2f} times
the D of molecular chaos. The paper's 'about 0.3' is confirmed. Its aspect ratio of 64 uses 0.25, which is half a bond and
not the radius of a vertex.

D(t) = g/6t approaches its limit slowly, as 1/t, for two reasons. Transverse waves of the box go on carrying the vertex, so D(t)
is too small. Sound has carried it and will take it back, so D(t) is too large. In large boxes the two nearly cancel, and D(t)
looks constant long before it has reached its limit. The estimate subtracts both."""
    crowded = [i for i in range(len(measured.keys)) if i not in measured.dilute()]
    same = [i for i in measured.dilute() if measured.keys[i][0] == 16]
    if crowded and same:
        lone = measured.value[same[0]]
        parts = [f"{measured.keys[i][1]} vertices: {measured.value[i] / lone:.3f} ± {measured.error[i] / lone:.3f}"
                 for i in crowded]
        text += f"""\n\nCrowding (16³ cells, over the D of the most dilute): {'; '.join(parts)}. Vertices are heavy, and
what they add to the mass of the fluid adds to its viscosity."""
    return text


def evaluate(results, tier):
    off, swap = without(results, "phantoms-L64", 256, 64), without(results, "swap-L8", 4, 8)
    systems_found, measured = boxes(results)
    pictures = [
        Figure("boxes", "Diffusion of a vertex against the size of the box. The line has the slope of the images and "
               "the measured viscosity; only its height is fitted. Crowded: 128 and 512 vertices in 16³ cells; the latter is below the lower panel.", lambda: draw_boxes(measured, off, swap))]
    if measured:
        pictures.append(
            Figure("lags", "The running estimate g(t)/6t of a vertex in three boxes. Lines: the fitted limit, less the "
                   "memory of transverse waves and of sound, and less c/t with one c for all boxes. The fit uses the filled points of the lower panel.",
                   lambda: draw_lags(systems_found, measured)))
    found = verdicts(measured, off, swap)
    if tier == "quick":  # one box cannot tell this slope from none
        found = [v for v in found if v.id != "mobility.images"]
    return Outcome(found, pictures, words(measured))
