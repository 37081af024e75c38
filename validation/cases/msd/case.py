"""Fig. 5: d^2(t) against density."""
import math

import numpy

from lib import figures, stats
from lib import semidilute as sd
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "Fibers hindered by fibers: density"
PAPER = "Fig. 5"
USES = ("tube",)  # its hi-entangled is c L^3 = 1000
EVENTS = (100, 300)  # c L^3 at which the event-driven rule runs as well
EVENT_LAGS = (51.2, 409.6)  # t0
SMALL = (200,)  # quick tier: c L^3 of fibers with L = 12


def campaign():
    # 8,300,000 steps are one tau_r by the paper, 2,500,000 are 0.3 of it; c L^3 = 1000 is tube's.
    hours = {30: 2.1, 100: 2.9, 300: 5.2}
    found = []
    for number, (density, total) in enumerate(hours.items()):
        found.append(Run(f"c{density}", scene=sd.scene(count=density, every=10), steps=8300000, hours=total,
                         seed=500 + number, priority=2, goals=((600000, 0), (2500000, 1))))
        found.append(Run(f"c{density}-short", steps=20000, hours=0.002 * total, seed=510 + number,
                         scene=sd.scene(count=density, every=1, longest_lag=1024, series=1000)))
    # The same with each contact at its own time, without a thermostat; c L^3 = 1000 is tube's.
    found += [Run(f"c{density}-events", steps=100000, hours=hours[density] / 80.0, seed=550 + density, priority=1,
                  scene=sd.scene(count=density, every=10, rule="event-driven", solvent=sd.FREE_SOLVENT, series=1000,
                                 longest_lag=100000)) for density in EVENTS]
    found.append(Run("off-c100", steps=400000, hours=0.1, seed=520,
                     scene=sd.scene(count=100, solvent=sd.BATH, forbidden="false", every=10, longest_lag=131072)))
    return found


def quick():
    found = [Run("off-c100", steps=20000, seed=530, hours=0.001,
                 scene=sd.scene(count=100, solvent=sd.BATH, forbidden="false", every=4, longest_lag=4096, series=500)),
             Run("c100", steps=20000, seed=531, hours=0.002, scene=sd.scene(box=24, count=42, every=4,
                                                                            longest_lag=4096, series=500))]
    # Fibers of 24 vertices at two densities; c L^3 = 399 is tube's.
    found += [Run(f"small{count}", steps=24576, seed=540 + count, hours=0.003,
                  scene=sd.scene(box=12, vertices=24, count=count, every=10, longest_lag=12288,
                                 series=1000)) for count in SMALL]
    return found


def runs(tier):
    return quick() if tier == "quick" else campaign()



# --- what runs say ----------------------------------------------------------------------------------------------------

# c L^3 -> (name of the run, L, box, fibers); lags (t0) between which t^(3/4) is fitted, without and with hydrodynamics.
SYSTEMS = {"quick": {100: ("c100", 32.0, 24, 42), 200: ("small200", 12.0, 12, 200),
                     399: ("tube/hi-entangled", 12.0, 10, 231)},
           "campaign": {30: ("c30", 32.0, 32, 30), 100: ("c100", 32.0, 32, 100), 300: ("c300", 32.0, 32, 300),
                        1000: ("tube/hi-entangled", 32.0, 32, 1000)}}
LAW = {"quick": {"off": (2.5, 26.0), "hi": ((2.5, 26.0),), "dilute": "c100"},
       "campaign": {"off": (2.5, 300.0), "hi": ((2.5, 26.0), (26.0, 300.0)), "dilute": "c30"}}
FLOOR_LAG = {"quick": 5.0, "campaign": 100.0}
FLUID_LAG = 2.5


def curve(results, name):
    return sd.joined(sd.table(results.get(name + "-short"), least=4), sd.table(results.get(name)))


def tau(length):
    """Of the figure's time axis: a rigid rod of b = 0.6 a0 in a fluid as viscous as the solvent."""
    return sd.PAPER_ROTATION_TIME if length == 32.0 else sd.rod_rotation_time((2 * length - 1) * sd.BOND, 0.6, 11.184)


def width(length, box, count):
    return sd.tube_width(sd.mesh_size(count, length, box), length, length)


def law(columns, window, name="d2_contour"):
    """(exponent, error, height, error, lag) of a power fitted to lags in a window, the height at the lag in its middle;
    None without enough of them. Errors are enlarged by as much as points scatter about the law more than they should."""
    if columns is None:
        return None
    keep = (columns["time"] >= window[0]) & (columns["time"] <= window[1])
    t, y, error = (columns[key][keep] for key in ("time", name, name + "_error"))
    if len(t) < 4:
        return None
    middle = math.exp(numpy.log(t).mean())  # there, slope and height are told apart
    fit = stats.power(t / middle, y, error)
    worse, height = math.sqrt(max(1.0, fit.chi2 / fit.freedom)), math.exp(fit.value[0])
    return fit.value[1], worse * fit.error[1], height, worse * height * fit.error[0], middle


# --- verdicts ---------------------------------------------------------------------------------------------------------

def law_verdicts(curves, tier):
    """Without hydrodynamics the law has no free number. With them no power holds for long."""
    off = law(curves["off"], LAW[tier]["off"])
    exponent = Verdict("msd.exponent.off", "exponent of d²(t) (contour), no hydrodynamics, crossing free", 0.75,
                       "wormlike chain", 0.05)
    height = Verdict("msd.prefactor.off", "d² over a straight chain's in the middle of the window, nothing fitted", 1.0,
                     "lib/bending.py: modes of 64 vertices, which share cells; 5 % for the nearest point, which is nearer "
                     "than where the vertex was", 0.05)
    friction = Verdict("msd.friction.off", "vertices × D of the centre of mass over D of a loose vertex, no "
                       "hydrodynamics", sd.shared_diffusion(100) / sd.VERTEX_DIFFUSION,
                       "momentum that a bath takes from the vertices of a cell together, straight fibers, others as "
                       "heavier solvent; 6 % for bends", 0.08)
    sd.measured(exponent, off, 0.04)
    with_hi = [sd.measured(Verdict(f"msd.exponent.hi.{name}", f"exponent of d²(t) (contour) of the most dilute fibers, "
                                   f"hydrodynamics on, {window[0]:g} to {window[1]:g} t0", 0.75, "paper, Fig. 5; 0.1 for the "
                                   "logarithm in the friction", 0.1, kind="paper",
                                   reason="At first the flow still builds up; later friction falls with the length that "
                                          "relaxes, by a logarithm."),
                           law(curves["dilute"], window), 0.1)
               for name, window in zip(("early", "late"), LAW[tier]["hi"])]
    if off:
        expected = sd.free_fiber([off[4]], 64, 100, 32, False)[0]
        sd.measured(height, (off[2] / expected, off[3] / expected), 0.05)
        k = int(numpy.argmin(abs(curves["off"]["time"] - 5.12)))
        unit = 64.0 / sd.VERTEX_DIFFUSION
        sd.measured(friction, (unit * curves["off"]["D"][k], unit * curves["off"]["D_error"][k]), 0.08)
    return [exponent, height, friction, *with_hi, *fluid_verdicts(curves, tier)]


def fluid_verdicts(curves, tier):
    """With hydrodynamics, once the flow has built up and before others' fibers resist."""
    found = []
    for density, (_, length, box, count) in SYSTEMS[tier].items():
        columns = curves[density]
        verdict = Verdict(f"msd.prefactor.c{density}", f"d² (contour) at {FLUID_LAG:g} t0 over a straight chain's, nothing "
                          f"fitted, c L³ = {density}, hydrodynamics on", 1.0,
                          "lib/bending.py: Oseen's field of the periodic box, smeared over cells, building up by ν, in a "
                          "fluid that vertices make heavier and more viscous: 8 % (bound and lag chosen with the first runs at "
                          "hand)", 0.08)
        if columns is not None:
            k = int(numpy.argmin(abs(numpy.log(columns["time"] / FLUID_LAG))))
            expected = sd.free_fiber([columns["time"][k]], round(2 * length), count, box, True)[0]
            sd.measured(verdict, sd.over((columns["d2_contour"][k], columns["d2_contour_error"][k]), expected), 0.08)
        found.append(verdict)
    return found


def event_verdicts(results, curves):
    """Does Fig. 5 depend on the paper's rule?"""
    found = []
    for density in EVENTS:
        events = sd.table(results.get(f"c{density}-events"))
        for lag in EVENT_LAGS:
            a, b = sd.at(events, "d2_contour", lag), sd.at(curves[density], "d2_contour", lag)
            ratio = a[0] / b[0] if a and b else None
            found.append(sd.measured(
                Verdict(f"msd.events.c{density}.{lag:g}", f"d² (contour) by the event-driven rule over that by the paper's, c L³ = "
                        f"{density}, {lag:g} t0", 1.0, "the rule does not move the result", 0.0),
                ratio and (ratio, ratio * math.hypot(a[1] / a[0], b[1] / b[0])), 0.01))
    return found


def floor_verdict(curves, tier):
    """A point beside the contour is nearest to a vertex by at most half a bond: <l^3>/12<l> further, squared."""
    cubed = sd.BOND * (sd.BOND**2 + 3.0 * (sd.BOND2 - sd.BOND**2))
    expected = cubed / (12.0 * sd.BOND)
    verdict = Verdict("msd.floor", f"d² less d² (contour) at {FLOOR_LAG[tier]:g} t0, most dilute fibers", expected,
                      "⟨l³⟩/12⟨l⟩ once the vertex has left its own place along the contour", 0.2 * expected)
    columns = curves["dilute"]
    if columns is not None:
        k = int(numpy.argmin(abs(columns["time"] - FLOOR_LAG[tier])))
        error = columns["d2_contour_error"][k] / columns["d2_contour"][k] * expected
        sd.measured(verdict, (columns["d2"][k] - columns["d2_contour"][k], error), 0.2 * expected)
    return verdict


def bends(curves, tier):
    """c L^3 -> (height of the bend, error, L_perp of Eq. (35), xi), of those that have bent."""
    found = {}
    for density, (_, length, box, count) in SYSTEMS[tier].items():
        seen = sd.bend(curves[density])
        if seen:
            found[density] = (*seen[:2], width(length, box, count), sd.mesh_size(count, length, box))
    return found


def mesh_verdict(bent):
    """The width of a tube goes as the root of the height; factors that are the same at all densities drop out."""
    verdict = Verdict("msd.mesh", "exponent of √d² at the bend against ξ", 1.2,
                      "slope of Eq. (35) over the same densities; 6/5 is its limit for ξ → 0", 0.0, kind="paper", rival=1.2,
                      reason="Not known. Tubes at low density are hardly longer than they are wide.")
    if len(bent) >= 2:
        xi, height, error, theory = (numpy.array([row[k] for row in bent.values()]) for k in (3, 0, 1, 2))
        verdict.expected = float(stats.power(xi, theory, theory).value[1])
        fit = stats.power(xi, numpy.sqrt(height), 0.5 * error / numpy.sqrt(height))
        sd.measured(verdict, (fit.value[1], fit.error[1] * math.sqrt(max(1.0, fit.chi2 / max(fit.freedom, 1)))))
    return verdict


def order_verdict(curves, tier):
    """Denser is slower: number of neighboring pairs of equal fibers out of order at the longest common lag."""
    pairs, wrong = 0, 0
    rows = list(SYSTEMS[tier].items())
    for k, (density, one) in enumerate(rows):
        for denser, other in rows[k + 1:]:
            a, b = curves[density], curves[denser]
            if one[1] != other[1] or a is None or b is None:
                continue
            lags = [t for t in a["time"] if sd.at(b, "d2_contour", t)]
            x, y = sd.at(a, "d2_contour", lags[-1]), sd.at(b, "d2_contour", lags[-1])
            pairs += 1
            wrong += x[0] - y[0] < -2.0 * math.hypot(x[1], y[1])
    return Verdict("msd.order", "pairs of densities where the denser moves further, longest common lag", 0.0,
                   "paper, Fig. 5", 0.0, measured=float(wrong) if pairs else None, detects=1.0)


# --- figures ----------------------------------------------------------------------------------------------------------

def draw_curves(curves, tier, column):
    figure, above, below = figures.with_residuals(height=6.0)
    latest = None
    for number, (density, (_, length, box, count)) in enumerate(SYSTEMS[tier].items()):
        columns = curves[density]
        if columns is None:
            continue
        t, scale = columns["time"] / tau(length), length**2
        figures.points(above, t, columns[column] / scale, columns[column + "_error"] / scale, number, markersize=3.2,
                       linestyle="-", linewidth=0.8,
                       label=f"c L³ = {density}" + ("" if tier == "campaign" else f", L = {length:g}"))
        tube = 2.0 * width(length, box, count)**2 / scale
        above.plot([t[-1] / 30, t[-1]], [tube, tube], color=figures.COLORS[number], linestyle="-.", linewidth=1)
        latest = number
        x, slope, error = sd.exponents(columns, column)
        known = error < 0.1
        figures.points(below, x[known] / tau(length), slope[known], error[known], number, markersize=2.5, linestyle="-",
                       linewidth=0.7)
    length = max(row[1] for row in SYSTEMS[tier].values())
    most_dilute = min(key for key, row in SYSTEMS[tier].items() if row[1] == length)
    for density, (_, own, box, count) in SYSTEMS[tier].items():
        if own == length and column == "d2_contour":  # the other has the vertices' floor
            t = numpy.geomspace(0.5, 100.0, 16)
            figures.theory(above, t / tau(length), sd.free_fiber(t, round(2 * own), count, box, True) / own**2,
                           label="straight fibers that may cross, nothing fitted" if density == most_dilute else None)
    hi = law(curves["dilute"], LAW[tier]["hi"][0], column)
    if hi:
        t = numpy.geomspace(0.5, 6000.0, 30)
        figures.theory(above, t / tau(length), hi[2] * (t / hi[4])**0.75 / length**2, linestyle="--",
                       label="$t^{3/4}$ through the most dilute")
    above.set(xscale="log", yscale="log", ylabel="$\\langle d^2\\rangle/L^2$" + (", contour" if "contour" in column else ""))
    below.set(xscale="log", xlabel="$t/\\tau_r$", ylabel="local exponent", ylim=(0, 2))
    below.axhline(0.75, color=figures.INK, linestyle="--", linewidth=1)
    if latest is not None:
        figures.named(above, "$2L_\\perp^2$, Eq. (35), each in its colour", linestyle="-.", linewidth=1)
    figures.legend_above(above)
    return figure


def draw_law(curves, tier):
    figure, above, below = figures.with_residuals()
    columns = curves["off"]
    if columns is not None:
        t = columns["time"]
        expected = sd.free_fiber(t, 64, 100, 32, False)
        figures.theory(above, t, expected, label="straight chain of vertices, nothing fitted")
        figures.theory(above, t, sd.bending_law(t, 1.0 / (sd.VERTEX_DIFFUSION * sd.BOND)), linestyle=":",
                       label="$t^{3/4}$, vertices that rub alone")
        for number, column in enumerate(("d2_contour", "d2")):
            figures.points(above, t, columns[column], columns[column + "_error"], number,
                           label="nearest point of the contour" if number == 0 else "nearest vertex (the paper's)")
            figures.points(below, t, columns[column] / expected - 1.0, columns[column + "_error"] / expected, number)
        window = LAW[tier]["off"]
        above.axvspan(*window, color=figures.PALE, alpha=0.15, linewidth=0, label="window of the fit")
        below.axvspan(*window, color=figures.PALE, alpha=0.15, linewidth=0)
    above.set(xscale="log", yscale="log", ylabel="$\\langle d^2\\rangle$ ($a_0^2$)")
    below.set(xscale="log", xlabel="$t$ ($t_0$)", ylabel="over law − 1", ylim=(-0.8, 0.8))
    figures.legend(above, loc="upper left")
    return figure


def draw_mesh(bent):
    figure, above, below = figures.with_residuals(height=4.4)
    xi = numpy.geomspace(1.0, 11.0, 50)
    wide = numpy.array([sd.tube_width(x, 32.0, 32.0) for x in xi])
    figures.theory(above, xi, math.sqrt(2.0) * wide, label="$\\sqrt{2}L_\\perp$, Eq. (35), $L = 32\\,a_0$")
    figures.theory(above, xi, 2.0 * wide, linestyle=":", label="$2L_\\perp$")
    for number, (density, (height, error, expected, mesh)) in enumerate(bent.items()):
        y, its = math.sqrt(height), 0.5 * error / math.sqrt(height)
        figures.points(above, [mesh], [y], [its], number, label=f"$cL^3$ = {density}")
        figures.points(below, [mesh], [y / expected], [its / expected], number)
    above.set(xscale="log", yscale="log", ylabel="$\\sqrt{d^2}$ at the bend ($a_0$)")
    below.set(xscale="log", xlabel="$\\xi$ ($a_0$)", ylabel="over $L_\\perp$", ylim=(0.0, 3.0))
    figures.legend(above, loc="upper left")
    return figure


def over_theory(columns, vertices, count, box, hydrodynamics):
    """(t, ratio, error) of d^2 over that of a straight fiber, nothing fitted, at lags where both are good for something."""
    keep = (columns["time"] > 0.3) & (columns["time"] < 200.0) & (columns["d2_contour_error"] < 0.1 * columns["d2_contour"])
    t, y, error = (columns[key][keep] for key in ("time", "d2_contour", "d2_contour_error"))
    expected = sd.free_fiber(t, vertices, count, box, hydrodynamics)
    return t, y / expected, error / expected


def against_theory(results, curves):
    """The campaign's curves with the theory that has nothing to fit: label -> (t, ratio, error)."""
    rows = {f"c L³ = {density}": (curves[density], count, True) for density, (_, _, _, count) in SYSTEMS["campaign"].items()}
    rows["c L³ = 1000, free"] = (curve(results, "tube/hi-free"), 1000, True)
    rows["four fibers, free"] = (sd.table(results.get("tube/axis-hi-1"), least=2), 4, True)
    rows["c L³ = 100, free, off"] = (curves["off"], 100, False)
    return {name: over_theory(columns, 64, count, 32, on) for name, (columns, count, on) in rows.items() if columns is not None}


def draw_theory(found):
    figure, axes = figures.plain(height=3.8)
    for number, (name, (t, ratio, error)) in enumerate(found.items()):
        figures.points(axes, t, ratio, error, number, label=name, markersize=3, linestyle="-", linewidth=0.7)
    axes.axhline(1.0, color="#444444", linewidth=0.8)
    axes.set(xscale="log", xlabel="$t$ ($t_0$)", ylabel="$d^2$ (contour) over theory", ylim=(0.3, 1.15))
    figures.legend_above(axes, columns=3)
    return figure


def theory_words(found):
    lags = (0.7, 1.3, 2.6, 5.0, 10.0, 20.0, 50.0, 100.0)
    rows = []
    for name, (t, ratio, _) in found.items():
        values = numpy.interp(numpy.log(lags), numpy.log(t), ratio, left=math.nan, right=math.nan)
        rows.append(f"**{name}** " + " · ".join("–" if math.isnan(value) else f"{value:.2f}" for value in values))
    return f"Measured over theory at {', '.join(f'{lag:g}' for lag in lags)} t0: " + "; ".join(rows) + "."


def evaluate(results, tier):
    curves = {density: curve(results, row[0]) for density, row in SYSTEMS[tier].items()}
    curves["off"], curves["dilute"] = curve(results, "off-c100"), curve(results, LAW[tier]["dilute"])
    bent = bends(curves, tier)
    verdicts = law_verdicts(curves, tier) + [floor_verdict(curves, tier), order_verdict(curves, tier)]
    lines = "Dash-dotted: 2 L⊥² of Eq. (35). Below: local exponent, over a factor of 4 in t. "
    axis = "Time in units of the paper's τ_r, 8.3·10⁴ t0" + (" (L = 12: a rigid rod's)." if tier == "quick" else ".")
    found = [Figure("fig5-d2", "The paper's d²(t), to the nearest vertex. " + lines + axis,
                    lambda: draw_curves(curves, tier, "d2")),
             Figure("fig5-d2_contour", "The same to the nearest point of the contour. " + lines + axis,
                    lambda: draw_curves(curves, tier, "d2_contour")),
             Figure("law", "Fibers without hydrodynamics that may cross, and the t^(3/4) law, which has no free number. Shaded: "
                           "the window of the fit of the exponent.",
                    lambda: draw_law(curves, tier))]
    words = PROSE
    if tier == "campaign":
        theory = against_theory(results, curves)
        verdicts.append(mesh_verdict(bent))
        verdicts += event_verdicts(results, curves)
        found.append(Figure("theory", "d² divided by d² of a straight fiber in the periodic box, nothing fitted. All curves but the last are with "
                            "hydrodynamics.", lambda: draw_theory(theory)))
        words += "\n\n" + theory_words(theory)
        if len(bent) >= 2:
            found.append(Figure("mesh", "Place of the bend: √d² at a local exponent of 3/8, against mesh size.", lambda: draw_mesh(bent)))
    return Outcome(verdicts, found, words)


PROSE = """The denser the suspension, the earlier d² leaves the t^(3/4) law of the bending of a lone fiber. The paper's d², to the nearest
**vertex**, has a floor of ⟨l³⟩/12⟨l⟩ = 0.026 a0²: if a fiber slides along its own contour, its vertices come to lie between its
old ones. The floor bends the curve where d² is a few times as large, below some 10 t0, and makes the local exponent
smaller than it is. d² to the nearest point of the **contour** has no floor.

Without hydrodynamics the law has no free number. With hydrodynamics the theory has none either: straight fibers in the periodic box, whose
flow builds up as momentum spreads, in a fluid that the vertices of the others make heavier and more viscous (2.9 times at c L³ = 1000). This
theory is good to 9 % between 1 and 5 t0, at all densities. Later it is too large. For four fibers that may cross, and are not
hindered, it is too large by 6 % at 20 t0 and 11 % at 100 t0; this part is an error of the theory. The rest, which grows with the density, is
the effect of the other fibers.

With hydrodynamics no single power holds: the local exponent is above 3/4 while the flow builds up, and below it later.

No curve has a plateau yet. The place of the bend can still be compared between densities. d² where the local
exponent falls to half of 3/4 is the square of a tube's width, up to a factor that is the same for all. The figure of the
tube (case `tube`) shows its relation to L⊥."""
