"""Fig. 2, flexible chains: diffusion against length, with hydrodynamics and without."""
import dataclasses
import functools
import math
import pathlib
import re
import string

import numpy

from lib import dilute, figures, lags, shape, stats, theory
from lib.case import Figure, Outcome
from lib.runs import Run

TITLE = "Chains: diffusion against length (Zimm), and Rouse without hydrodynamics"
PAPER = "Fig. 2"
SCENE = string.Template((pathlib.Path(__file__).parent / "chains.yaml").read_text())
SPRING = 3.0  # kT/a0^2: bonds of 1 a0
LOOSE = 0.1   # of chains whose vertices hardly ever share a cell


def chains(name, vertices, box, count, time, bath="hydrodynamics", seed=1, priority=0, spring=SPRING, every=0.4,
           lag=409.6, crossing="free"):
    """A run of Gaussian chains; times in t0."""
    scene = SCENE.substitute(box=box, count=count, vertices=vertices, spring=spring, every=round(every / 0.02),
                             longest_lag=round(lag / 0.02), crossing="true" if crossing == "forbidden" else "false",
                             hydrodynamics=str(bath == "hydrodynamics").lower(),
                             bath="phantoms" if bath == "phantoms" else "particles")
    return Run(name, scene=scene, steps=round(time / 0.02), seed=seed, priority=priority,
               hours=dilute.hours(box, count * vertices, time, bath=bath))


# With hydrodynamics. N, box: chains, time of one run in t0, and seeds up to which priorities 0, 1, 2 go.
PAPER_BOXES = {5: 18, 10: 25, 20: 35, 40: 50, 80: 71, 160: 100}  # 25 sqrt(N/10), rounded
SYSTEMS = {
    (5, 18): (10, 3000, 1, 4, 8), (10, 25): (16, 3500, 1, 4, 8), (20, 24): (6, 4000, 1, 2, 6),
    (20, 35): (20, 2000, 0, 3, 6), (40, 36): (9, 2500, 1, 3, 6), (40, 50): (24, 1200, 0, 2, 6),
    (80, 36): (6, 4000, 1, 4, 8), (80, 71): (32, 500, 0, 2, 8), (160, 50): (8, 800, 1, 6, 12),
    (10, 12): (2, 20000, 0, 2, 4), (10, 16): (4, 10000, 0, 2, 4), (10, 36): (48, 1500, 0, 2, 4),
    (40, 25): (3, 6000, 0, 2, 4), (160, 71): (16, 600, 0, 0, 3)}
# Pulled by a force on each chain, from equilibrium: name -> (N, box, chains, force, time). The answer gives D, for long chains at a
# fraction of the cost (validation/measure/pulled_fibers.c). N = 10 with three forces, to see how far the answer is linear.
PULLED = {"pulled-N10-F6": (10, 25, 16, 6, 1500), "pulled-N10-F12": (10, 25, 16, 12, 1000), "pulled-N10-F24": (10, 25, 16, 24, 500),
          "pulled-N160-F30-s1": (160, 100, 32, 30, 128), "pulled-N160-F30-s2": (160, 100, 32, 30, 128)}
PULLED_LEAST = 80  # vertices: a shorter chain changes its shape meanwhile, and is a test
# N and force of this test, and what heat does to it: forces do work, and kT grows by 3 % in this run, by 8 and 16 % with 12 and 24 kT/a0.
# The chain grows with it, and D falls by a sixth of that on average over the run.
LINEAR, HEAT = (10, 6), 0.005
CROWDED = {4: (10000, 3), 64: (2500, 1)}  # chains of 10 vertices in 25^3 cells, where 16 are: time, seeds
ROUSE = {5: (64, 3300), 10: (32, 6400), 20: (24, 12800), 40: (16, 8000), 80: (8, 10000), 160: (4, 12000)}  # phantoms
LOOSE_ROUSE = {5: (64, 40000, 6553.6, 0), 10: (32, 110000, 26214.4, 1), 20: (16, 420000, 104857.6, 2)}  # lag, priority


def without_hydrodynamics():
    found = [chains(f"rouse-N{n}", n, 64, count, time, bath="phantoms", lag=819.2)
             for n, (count, time) in ROUSE.items()]
    found += [chains(f"loose-N{n}", n, 128, count, time, bath="phantoms", spring=LOOSE, every=6.4, lag=lag,
                     priority=priority) for n, (count, time, lag, priority) in LOOSE_ROUSE.items()]
    return found + [chains("swap-N5", 5, 18, 10, 3000, bath="swap", priority=1),
                    chains("swap-N10", 10, 25, 16, 3500, bath="swap", priority=1)]


def campaign():
    found = without_hydrodynamics()
    for (n, box), (count, time, *limits) in SYSTEMS.items():
        for seed in range(1, limits[-1] + 1):
            priority = next(p for p, limit in enumerate(limits) if seed <= limit)
            found.append(chains(f"N{n}-L{box}-s{seed}", n, box, count, time, seed=100000 * n + 100 * box + seed,
                                priority=priority))
    for number, (name, (n, box, count, force, time)) in enumerate(PULLED.items()):
        found.append(Run(name, program=["pulled_fibers", "chains", n, count, box, force, time, 1.6, dilute.FIRST_LAG, 1, 600 + number],
                         hours=dilute.hours(box, count * n, time), priority=1))
    for count, (time, seeds) in CROWDED.items():
        found += [chains(f"crowd-{count}" + (f"-s{k}" if k > 1 else ""), 10, 25, count, time, seed=count + 1000 * (k - 1),
                         priority=1) for k in range(1, seeds + 1)]
    return found + [chains("crossing-N20", 20, 35, 20, 6000, seed=77, priority=2, crossing="forbidden")]


def quick():
    return [chains("N5-L12-s1", 5, 12, 4, 4000, seed=5001), chains("N10-L16-s1", 10, 16, 4, 4000, seed=10001),
            chains("rouse-N5", 5, 64, 32, 500, bath="phantoms", lag=204.8),
            chains("rouse-N10", 10, 64, 32, 500, bath="phantoms", lag=204.8),
            chains("rouse-N20", 20, 64, 16, 500, bath="phantoms", lag=204.8)]


def runs(tier):
    return quick() if tier == "quick" else campaign()


# --- what they say ----------------------------------------------------------------------------------------------------

# Share of the hydrodynamic part that is lost because a chain's own vertices make the fluid in its coil heavier; errors:
# `validation/lib/own_fluid.py chain N SHAPES`, with 100, 80, 60, 40, 24 and 10 shapes.
OWN = {5: (0.0472, 0.0018), 10: (0.0533, 0.0023), 20: (0.0524, 0.0026), 40: (0.0565, 0.0039), 80: (0.0492, 0.0043),
       160: (0.0521, 0.0068)}
PAPER_ETA = sum(theory.viscosity())  # the paper scales with the analytic viscosity, 11.18; measured, it is 10.74
SIZES = numpy.array(sorted(PAPER_BOXES))


def gyration2(n):
    return (n * n - 1.0) / (6.0 * n)


def paper_box(n):
    """The paper's rule, 25 sqrt(N/10), not rounded."""
    return 25.0 * numpy.sqrt(numpy.asarray(n) / 10.0)


@dataclasses.dataclass
class Point:
    """A system's short-time D in its box, of one chain in a box at rest, and in an infinite box; both with the same error."""
    vertices: int
    box: int
    count: int
    value: float
    error: float
    infinite: float


@dataclasses.dataclass
class Measured:
    """All systems with hydrodynamics that have run, by name without the seed, the fit to all of them at once, and D in an
    infinite box: {N: (D, error, p)}, covariance of ln D, and the names of the systems that it comes from."""
    points: dict
    joint: object
    far: dict
    logs: numpy.ndarray
    covariance: numpy.ndarray  # of the points' D, in their order

    @property
    def estimator(self):
        return self.joint.estimator if self.joint else 0.0


def grouped(results):
    """{name without the seed: (vertices, box, count, dynamics)}"""
    groups = {}
    for name, result in results.items():
        found = re.fullmatch(r"(N\d+-L\d+|crowd-\d+|crossing-N\d+)(?:-s\d+)?", name)
        if found:
            groups.setdefault(found[1], []).append(result)
    found = {}
    for name, members in groups.items():
        scene, table = members[0].run.scene, dilute.merged(members, "chain")
        if table is not None:
            found[name] = (*(int(re.search(pattern, scene)[1])
                             for pattern in (r"vertices: (\d+)", r"box: \[(\d+)", r"count: (\d+)")), table)
    return found


def system(n, box, table=None, kept=1.0):
    """The lags.System of chains in a box, whose momentum leaves them the share `kept` of their D."""
    return lags.System(table, functools.partial(dilute.memory, box=box, form=dilute.gaussian_form(n)),
                       (cells(n) - dilute.image_shift(box, gyration2(n))) * kept, functools.partial(shape.chain_share, n), box)


def systems(results):
    """{name: lags.System}"""
    return {name: system(n, box, table, dilute.closed_box(count, n * dilute.MASS, box))
            for name, (n, box, count, table) in grouped(results).items()}


def point(n, box, count, value, error):
    """The Point of chains whose D in their box is this."""
    pure = dilute.in_pure_solvent(value, sharing(n)[0], (count - 1) * n / box**3)
    return Point(n, box, count, value, error, pure + dilute.image_shift(box, gyration2(n)))


def forced(results):
    """{(N, box, force): Point} of chains that were pulled."""
    return {(n, box, force): point(n, box, count, value, error)
            for n, box, count, force, value, error in lags.answers(results, PULLED, system)}


def with_hydrodynamics(results):
    """Short-time D of chains with hydrodynamics."""
    groups, found = grouped(results), systems(results)
    joint, points = lags.joint(list(found.values())), {}
    if joint is None:
        return Measured({}, None, {}, None, None)
    shares = numpy.array([dilute.closed_box(count, n * dilute.MASS, box) for n, box, count, _ in groups.values()])
    covariance = joint.covariance / numpy.outer(shares, shares)
    for i, (name, (n, box, count, _)) in enumerate(groups.items()):
        points[name] = point(n, box, count, joint.value[i] / shares[i], math.sqrt(covariance[i, i]))
    for (n, box, force), answer in forced(results).items():
        if n >= PULLED_LEAST:
            points[f"N{n}-L{box}-F{force}"] = answer
            covariance = lags.beside(covariance, [answer.error])
    plain = [i for i, name in enumerate(points) if name.startswith("N")]
    chosen = [list(points.values())[i] for i in plain]
    far, logs = lags.per_length([p.vertices for p in chosen], numpy.array([p.infinite for p in chosen]),
                                covariance[numpy.ix_(plain, plain)], cells)
    return Measured(points, joint, far, logs, covariance)


def free(results, name, last=51.2):
    """(D, error) without hydrodynamics, of all lags from 0.8 t0 on; None without the run."""
    table = dilute.merged([results[name]], "chain") if name in results else None
    if table is None:
        return None
    limit = dilute.long_time([(table, numpy.zeros_like)], 0.8 if table["time"][0] < 0.5 else table["time"][0], [last])
    return (limit.value[0], limit.error[0]) if limit else None


def scene_of(result):
    """(vertices, spring, count) of a run."""
    return tuple(kind(re.search(pattern, result.run.scene)[1]) for kind, pattern in (
        (int, r"vertices: (\d+)"), (float, r"spring: ([\d.]+)"), (int, r"count: (\d+)")))


def size(result):
    """(<R^2> over its exact value, its error); None without the table. The error is theory's: R^2 of a Gaussian vector
    scatters by sqrt(2/3) of its mean; every chain starts with a shape of its own and has another after Rouse's time.
    (Short runs of few chains cannot know their error, and small values would come with small errors.)"""
    try:
        table = result.table("statics-chain")
    except KeyError:
        return None
    n, spring, count = scene_of(result)
    tau = dilute.rouse_time(n, spring, 1.0 / dilute.vertex_diffusion())
    return table["Ree2"][0] * spring / (3.0 * (n - 1.0)), math.sqrt(2.0 / 3.0 / count / (1.0 + result.time / tau))


def turning(result):
    """(lags, <|R(t) - R(0)|^2>/2<R^2>, errors), <R^2> being exact; a Gaussian vector has the relative error
    sqrt(2/3n), n intervals. None without tables."""
    table, sized = dilute.merged([result], "chain"), size(result)
    if table is None or sized is None:
        return None
    value = (1.0 - table["end_to_end"]) * sized[0]
    return table["time"], value, value * numpy.sqrt(2.0 / 3.0 / (table["intervals"] * scene_of(result)[2]))


def friction(result):
    """(zeta, error): friction of a vertex from the first turning of the end-to-end vector, up to 0.3 of Rouse's time;
    least squares. Neighboring lags share their noise, so the error is that of the best lag alone."""
    found = turning(result)
    if found is None:
        return None
    n, spring, _ = scene_of(result)
    zeta = 1.0 / dilute.vertex_diffusion()
    tau = dilute.rouse_time(n, spring, zeta)
    use = (found[0] > 0.03 * tau) & (found[0] < 0.3 * tau)
    if not use.any():
        return None
    t, y, error = (column[use] for column in found)
    for _ in range(20):
        model = 1.0 - dilute.rouse(t, n, spring, zeta)
        slope = (1.0 - dilute.rouse(t, n, spring, 1.001 * zeta) - model) / (0.001 * zeta)
        zeta += ((y - model) * slope / error ** 2).sum() / (slope ** 2 / error ** 2).sum()
    return zeta, float((error / abs(slope)).min())


@functools.lru_cache(maxsize=None)
def sharing(n):
    """D without hydrodynamics of a chain whose vertices share cells."""
    shapes = 80 if n <= 40 else 20
    return dilute.sharing_diffusion(lambda random: dilute.gaussian_shape(n, 1.0, random), shapes=shapes)


@functools.lru_cache(maxsize=None)
def kirkwood(n):
    """Short-time D of spheres in Oseen's field."""
    return dilute.kirkwood_chain(n, dilute.stokes(dilute.D_VERTEX))


def cells(n):
    """Short-time D of vertices that share cells, and feel each other through cells, in a fluid that they make heavier."""
    return dilute.cells_chain(n, sharing(n)[0], heavier=OWN[n][0])


MODELS = {"Kirkwood": kirkwood, "the smeared field": cells}


def exponent(sizes, values, logs):
    """(exponent, error) of values with this covariance of their logarithms."""
    f = stats.fit_correlated([numpy.ones(len(sizes)), numpy.log(sizes)], numpy.log(values), logs)
    return f.value[1], f.error[1]


def late(measured):
    """(lengths, D, error) at long times in the paper's boxes, from short-time D in an infinite one; errors of one length alone."""
    sizes = sorted(measured.far)
    lost = [shape.chain_share(n, shape.LATE)[0] for n in sizes]
    shift = [dilute.image_shift(paper_box(n), gyration2(n)) for n in sizes]
    values = numpy.array([measured.far[n][0] * (1.0 - share) for n, share in zip(sizes, lost)])
    errors = [value * math.hypot(measured.far[n][1] / measured.far[n][0], shape.chain_error(n), measured.estimator)
              for n, value in zip(sizes, values)]
    return numpy.array(sizes), values - shift, numpy.array(errors)


def fitted_exponents(sizes, values, logs, model):
    """((exponent, error), exponent of a model's values at the same N with the same weights); None, -0.5."""
    if len(sizes) < 2:
        return None, -0.5
    return exponent(sizes, values, logs), exponent(sizes, numpy.array([model(n) for n in sizes]), logs)[0]


def trend(measured, model):
    """(slope, error) of ln of D over a model against ln N, the errors of OWN in it; None with fewer than three lengths."""
    sizes = sorted(measured.far)
    if len(sizes) < 3:
        return None
    ratio = numpy.array([measured.far[n][0] / model(n) for n in sizes])
    f = stats.fit_correlated([numpy.ones(len(sizes)), numpy.log(sizes)], ratio,
                             measured.logs + numpy.diag([OWN[n][1]**2 for n in sizes]))
    return f.value[1], f.error[1]


def plain(n):
    """cells(n) of a chain that weighs nothing."""
    return dilute.cells_chain(n, sharing(n)[0])


def verdicts_with(measured):
    far, points = measured.far, measured.points
    sizes = sorted(far)
    slope, expected = fitted_exponents(sizes, [far[n][0] for n in sizes], measured.logs, cells)
    return [
        dilute.held("chains.exponent-paper", f"Exponent of D against N in an infinite box, against Zimm's N^-1/2 (theory's at these "
                    f"lengths: {expected:.3f})", -0.5, "Eq. (39), Fig. 2; 0.01 for a line through the paper's points", slope, 0.01,
                    kind="paper", reason="N^-1/2 is the limit of long chains; short ones still feel single vertices"),
        dilute.held("chains.cells", "Short-time D in an infinite box over vertices in Oseen's field smeared over the cells, nothing "
                    "fitted; mean over lengths", 1.0,
                    "lib/dilute.py: cells_chain, to 4 %, as good as it is for a lone vertex; lib/own_fluid.py for what the coil's "
                    "own mass does", over_model(measured, cells), dilute.CELLS, dilute.NU_ERROR / dilute.NU),
        dilute.held("chains.trend", "The same: slope against ln N", 0.0, "a theory that is off by a factor is off at all "
                    "lengths alike; without what the coil's mass takes, another", trend(measured, cells), 0.0,
                    rival=(trend(measured, plain) or (None,))[0]),
        lags.scatter_verdict("chains", measured.joint),
        dilute.kirkwood_held("chains", over_model(measured, kirkwood), 0.25),
        prefactor_verdict(measured), lags.images_verdict("chains", image_slope(measured)), crowding(points)]


def over_model(measured, model):
    """(value, error): D over a model, mean over lengths; the error has what the choice of lags leaves open."""
    return lags.mean_over(measured.far, measured.logs, model, measured.estimator)


def prefactor_verdict(measured):
    """All lengths have the shift of the images, and the estimator's error, in common."""
    pair = None
    if measured.far:
        sizes, values, errors = late(measured)
        unit = 1.0 / (PAPER_ETA * numpy.sqrt(sizes))
        logs = measured.logs + numpy.diag([shape.chain_error(n)**2 for n in sizes])
        mean, error, _ = stats.fair_mean(values / unit, logs * numpy.outer(values / unit, values / unit))
        pair = mean, math.hypot(error, measured.estimator * mean)
    return dilute.held("chains.prefactor", "D η √N/kT at long times in the paper's boxes, η = 11.18, most of them inferred from "
                       "smaller ones; mean over lengths", 0.17, "Fig. 2 (the paper's digits allow 0.005)", pair, 0.005,
                       kind="paper", reason="chains are slower than Zimm's: see chains.cells; the paper states no errors")


def image_slope(measured):
    """Of chains that ran in several boxes, at one concentration."""
    plain = [(i, p) for i, (name, p) in enumerate(measured.points.items()) if name.startswith("N")]
    chosen = [i for i, _ in plain]
    if not chosen:
        return None
    covariance = measured.covariance[numpy.ix_(chosen, chosen)]
    return lags.image_slope([p.vertices for _, p in plain], [p.infinite for _, p in plain],
                            [dilute.image_shift(p.box, gyration2(p.vertices)) for _, p in plain], covariance, cells)


def pulled_verdicts(results, points):
    """D from the answer to a force over D from Brownian motion, in the same box."""
    found = []
    for (n, box, force), answer in forced(results).items():
        free_one = points.get(f"N{n}-L{box}")
        if (n, force) == LINEAR and free_one:
            found.append(dilute.held(
                f"chains.pulled.F{force}", f"D of {n} vertices from the answer to a force of {force} kT/a0 over D from Brownian motion, "
                f"{box}³ cells", 1.0, "fluctuation and dissipation, while the answer is linear", dilute.over(
                    (answer.value, answer.error), (free_one.value, free_one.error)), HEAT, must_see=0.25))
    return found


def crowding(points):
    pair = None
    if "crowd-4" in points and "N10-L25" in points:
        pair = dilute.over(*((points[name].value, points[name].error) for name in ("N10-L25", "crowd-4")))
    return dilute.held("chains.dilute", "D with 16 chains of 10 vertices in 25³ cells over D with 4: are they dilute?",
                       1.0, "a dilute solution has no neighbors", pair, 0.02)


def verdicts_without(results, planned):
    """planned: names of all runs of the tier, there or not."""
    chaos = dilute.vertex_diffusion()
    measured = {n: free(results, f"rouse-N{n}") for n in SIZES}
    measured = {int(n): pair for n, pair in measured.items() if pair}
    sizes = sorted(measured)
    slope, shared = fitted_exponents(sizes, [measured[n][0] for n in sizes],
                                     numpy.diag([(measured[n][1] / measured[n][0])**2 for n in sizes]), lambda n: sharing(n)[0])
    ratio = dilute.mean_ratio(list(measured.values()), [sharing(n)[0] for n in measured])
    known = max((sharing(n)[1] / sharing(n)[0] for n in measured), default=0.0) / math.sqrt(max(len(measured), 1))
    found = [
        dilute.held("chains.free-exponent-paper", "Without hydrodynamics: exponent of D against N, against the paper's line N^-1 "
                    f"(chains that share cells: {shared:.3f})", -1.0, "Fig. 2", slope, 0.01, kind="paper",
                    reason="short chains share fewer cells than long ones"),
        dilute.held("chains.free-D", "Without hydrodynamics: D over molecular chaos of chains that share cells", 1.0,
                    "lib/dilute.py: sharing_diffusion", ratio, 0.03, known)]
    for n in LOOSE_ROUSE:
        if f"loose-N{n}" in planned:
            pair, zeta = free(results, f"loose-N{n}"), None
            if pair:
                zeta = friction(results[f"loose-N{n}"])
            found += [
                dilute.held(f"chains.rouse-times-N{n}", f"Loose chains (bonds of 5.5 a0) of {n}: Rouse times from the "
                            "turning of the end-to-end vector, over exact ones", 1.0,
                            "τ_p = ζ/(4k sin²(pπ/2N))",
                            dilute.over(zeta, (1.0 / chaos, 0.0)) if zeta else None, 0.01),
                dilute.held(f"chains.rouse-D-N{n}", "The same chains: D N/D_0", 1.0, "D = D_0/N",
                            dilute.over(pair, (chaos / n, 0.0)) if pair else None, 0.01)]
    return found + [swap_verdict(results, n) for n in (5, 10) if f"swap-N{n}" in planned]


def swap_verdict(results, n):
    swap, phantoms = free(results, f"swap-N{n}"), free(results, f"rouse-N{n}")
    share = dilute.closed_box(SYSTEMS[n, PAPER_BOXES[n]][0], n * dilute.MASS, PAPER_BOXES[n])
    pair = dilute.over((swap[0] / share, swap[1] / share), phantoms) if swap and phantoms else None
    return dilute.held(f"chains.swap-N{n}", f"No hydrodynamics, N = {n}: D with the paper's swap over D with phantoms",
                       1.0, "docs/accuracy.md: 0.996 ± 0.007, closed box taken out", pair, 0.03)


def size_verdict(results):
    sizes = [size(result) for name, result in results.items() if re.match(r"N\d+-L|rouse|loose", name)]
    sizes = [pair for pair in sizes if pair]
    return dilute.held("chains.size", "<R^2> over (N - 1) l^2, mean over all runs", 1.0, "exact: independent bonds",
                       stats.weighted_mean(*zip(*sizes))[:2] if sizes else None, 0.003)


# --- figures ----------------------------------------------------------------------------------------------------------

def draw_lengths(results, measured):
    figure, axes, below = figures.with_residuals(height=6.0)
    points, far = measured.points, measured.far
    n = numpy.geomspace(4.0, 200.0, 60)
    chaos = dilute.vertex_diffusion()
    figures.theory(axes, n, 0.17 / PAPER_ETA / numpy.sqrt(n), label="paper: 0.17 kT/($\\eta R_e$)")
    figures.theory(axes, n, 0.1955 / dilute.ETA / numpy.sqrt(n), linestyle="--", label="Zimm: 0.1955 kT/($\\eta R_e$)")
    figures.theory(axes, SIZES, [kirkwood(k) for k in SIZES], color=figures.COLORS[0], linewidth=0.9, label="Kirkwood")
    figures.theory(axes, SIZES, [cells(k) for k in SIZES], color=figures.COLORS[0], linewidth=0.9, linestyle=":",
                   label="smeared over cells")
    figures.theory(below, SIZES, [kirkwood(k) / cells(k) - 1.0 for k in SIZES], color=figures.COLORS[0], linewidth=0.9)
    figures.theory(axes, n, chaos / n, linestyle="-.", label="$D_0/N$")
    figures.theory(axes, SIZES, [sharing(k)[0] for k in SIZES], color=figures.COLORS[2], linewidth=0.9,
                   label="vertices that share cells")
    for k, value, error in zip(*late(measured)) if far else ():
        figures.points(axes, k, value, error, 1, label="at long times in the paper's box, from all boxes" if k == min(far) else None)
    for k, (value, error, _) in far.items():
        error = math.hypot(error, measured.estimator * value)
        figures.points(axes, k, value, error, 0, label="infinite box" if k == min(far) else None)
        figures.points(below, k, value / cells(k) - 1.0, error / cells(k), 0)
    direct = [p for name, p in points.items() if name.startswith("N") and p.box == PAPER_BOXES[p.vertices]]
    for i, p in enumerate(direct):
        figures.points(axes, p.vertices * 1.06, p.value, p.error, 5, markerfacecolor="none",
                       label="the paper's box itself" if i == 0 else None)
    for i, (k, pair) in enumerate((k, free(results, f"rouse-N{k}")) for k in SIZES):
        if pair:
            figures.points(axes, k, *pair, number=2, label="no hydrodynamics" if i == 0 else None)
            figures.points(below, k, pair[0] / sharing(k)[0] - 1.0, pair[1] / sharing(k)[0], 2)
    axes.set(xscale="log", yscale="log", ylabel="$D$ ($a_0^2/t_0$)", xlim=(4, 200))
    figures.legend_above(axes)
    below.set(xlabel="N", ylabel="over theory, $-1$", ylim=(-0.2, 0.12))
    return figure


def draw_boxes(points):
    figure, axes, below = figures.with_residuals()
    lengths = sorted({p.vertices for p in points.values()})
    x = numpy.linspace(0.0, 0.32, 60)  # R_e/L
    for number, n in enumerate(lengths):
        same = [p for name, p in points.items() if p.vertices == n and name.startswith("N")]
        if len(same) < 2:
            continue  # one point lies on any line
        mean = dilute.fair_mean([p.infinite for p in same], [p.error for p in same])[0]
        scale, end = dilute.ETA * math.sqrt(n), math.sqrt(n)
        line = mean - numpy.array([dilute.image_shift(end / v, gyration2(n)) if v else 0.0 for v in x])
        figures.theory(axes, x, line * scale, color=figures.COLORS[number], linewidth=0.8)
        share = numpy.array([end / p.box for p in same])
        value, error = (numpy.array([getattr(p, key) for p in same]) for key in ("value", "error"))
        figures.points(axes, share, value * scale, error * scale, number, label=f"N = {n}")
        figures.points(below, share, [p.infinite / mean - 1.0 for p in same], error / mean, number)
    axes.set(ylabel="D $\\eta R_e$/kT, measured $\\eta$", xlim=(0.0, 0.32))
    figures.named(axes, "one limit for each N, less the images' share", linestyle="-", linewidth=0.8)
    figures.legend_above(axes, columns=3)
    below.set(xlabel="$R_e/L_b$", ylabel="over line, $-1$", ylim=(-0.12, 0.12))
    return figure


def draw_rouse(results):
    figure, axes, below = figures.with_residuals()
    zeta = 1.0 / dilute.vertex_diffusion()
    names = [(f"loose-N{n}", n, LOOSE) for n in LOOSE_ROUSE] + [(f"rouse-N{n}", n, SPRING) for n in (5, 10, 20)]
    for number, (name, n, spring) in enumerate(names):
        found = turning(results[name]) if name in results else None
        if found is None:
            continue
        tau = dilute.rouse_time(n, spring, zeta)
        use = (found[0] > 0.002 * tau) & (found[0] < 2.0 * tau)
        t, value, error = (column[use] for column in found)
        expected = 1.0 - dilute.rouse(t, n, spring, zeta)
        figures.theory(axes, t / tau, expected, linewidth=0.8, color=figures.COLORS[number])
        options = {} if spring == LOOSE else {"markerfacecolor": "none"}
        label = f"N = {n}, " + ("loose" if spring == LOOSE else "k = 3")
        figures.points(axes, t / tau, value, error, number, label=label, **options)
        figures.points(below, t / tau, value / expected - 1.0, error / expected, number, **options)
    axes.set(xscale="log", yscale="log", ylabel="$\\langle|R(t)-R(0)|^2\\rangle/2\\langle R^2\\rangle$")
    figures.named(axes, "Rouse", linestyle="-", linewidth=0.8)
    figures.legend_above(axes, columns=3)
    below.set(xlabel="$t/\\tau_1$", ylabel="over Rouse, $-1$", ylim=(-0.25, 0.2))
    return figure


def words(results, measured):
    parts, points, far = [], measured.points, measured.far
    if far:
        parts.append(f"""**Short-time D in an infinite box**, 10⁻³ a0²/t0:
{dilute.listed(far, MODELS)}. Each is the mean over sizes of
box, with the images' share added and the recoil of the closed box taken out. Errors are statistical.""")
        parts.append(lags.words(list(systems(results).values()), measured.joint))
    sizes = sorted(far)
    slope, expected = fitted_exponents(sizes, [far[n][0] for n in sizes], measured.logs, cells)
    if slope:
        parts.append(f"""The exponent is {slope[0]:.3f} ± {slope[1]:.3f} (theory's at these lengths: {expected:.3f}).
**Effect of the images**: in boxes that grow with R_e they take the same share of D at every length, about 10 %. They
change the prefactor and not the exponent, as the paper says. Zimm's 0.1955 less the images would be 0.184 in the
paper's units, and the paper has 0.17. The rest of the difference has another origin: D is below Zimm's in an infinite box, too.""")
    pulled = [(force, dilute.over((p.value, p.error), (points[f"N{n}-L{box}"].value, points[f"N{n}-L{box}"].error)))
              for (n, box, force), p in forced(results).items() if f"N{n}-L{box}" in points]
    if pulled:
        parts.append(f"""**The answer to a force** over Brownian motion, N = 10: {"; ".join(
            f"{ratio:.3f} ± {error:.3f} at {force} kT/a0" for force, (ratio, error) in sorted(pulled))}. The larger the force, the
more these long runs heat up, by 3, 8 and 16 % of kT at their ends, and a chain that is hotter is larger and slower. Chains of 160 move by a third of R_e in their whole run, and it does not heat.""")
    if "rouse-N10" in results:
        parts.append("""**Without hydrodynamics** D falls nearly as 1/N, but it is larger than D_0/N. Vertices of a Gaussian chain
with bonds of 1 a0 share cells and keep their common momentum there, so the chain diffuses 19 to 47 % faster. Molecular
chaos with shared cells predicts this. Chains with bonds of 5.5 a0 share no cells, and Rouse's theory holds for them.""")
    for name, base in (("crossing-N20", "N20-L35"), ("crowd-64", "N10-L25")):
        if name in points and base in points:
            ratio = dilute.over(*((points[key].value, points[key].error) for key in (name, base)))
            parts.append(f"D of `{name}` over `{base}`: {ratio[0]:.3f} ± {ratio[1]:.3f}.")
    return "\n\n".join(parts)


def evaluate(results, tier):
    measured = with_hydrodynamics(results)
    points, far = measured.points, measured.far
    found = verdicts_with(measured) + pulled_verdicts(results, points) + verdicts_without(results, {run.name for run in runs(tier)}) + [size_verdict(results)]
    if tier == "quick":  # one box for each length, no other density, and errors that tell no trend
        found = [v for v in found if v.id not in ("chains.images", "chains.dilute", "chains.trend")]
    pictures = [
        Figure("lengths", "Fig. 2, chains: diffusion against length, with and without hydrodynamics. Below: divided by "
               "theory, with hydrodynamics by Oseen's field smeared over cells (line: Kirkwood's sum), without by molecular chaos of "
               "chains whose vertices share cells. Light crosses: runs in the paper's own box.",
               lambda: draw_lengths(results, measured)),
        Figure("rouse", "Rotation of the end-to-end vector without hydrodynamics. Line: Rouse's theory with the friction of "
               "a lone vertex, nothing fitted.", lambda: draw_rouse(results))]
    if len([name for name in points if name.startswith("N")]) > len(far):
        pictures.insert(1, Figure("boxes", "Effect of the box: the same chains in several boxes. Lines: one limit for each "
                                  "length, less the images' share.", lambda: draw_boxes(points)))
    return Outcome(found, pictures, words(results, measured))
