"""The solvent against molecular chaos and hydrodynamics: viscosity, diffusion, sound, waves against k, long-time tail."""
import collections
import math

import numpy
from scipy import optimize

from lib import dilute, figures, stats, theory
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "The solvent: viscosity, diffusion, sound, and the long-time tail"
PAPER = "Sec. IV A, Eqs. (30), (31)"

Point = collections.namedtuple("Point", "gamma dt_c alpha")
PAPERS = Point(5, 0.02, 90)  # the paper's
TAILS = Point(5, 0.1, 90)  # a longer tail, and sound that lives longer
STRONG = Point(10, 0.1, 130)
DILUTE = Point(5, 1.0, 90)  # a mean free path of a whole cell
GRID = [Point(5, dt_c, 90) for dt_c in (0.02, 0.05, 0.1, 0.2, 0.5, 1.0)] + \
       [Point(gamma, 0.02, 90) for gamma in (3, 10, 20)] + \
       [Point(5, 0.02, alpha) for alpha in (30, 60, 120, 150)] + [STRONG]
POINTS = {"quick": [PAPERS, TAILS, STRONG, DILUTE], "campaign": GRID}
PLENTY = {"quick": 1, "campaign": 8}  # times as many pairs of runs, or windows
SOUND_POINTS = {"quick": [TAILS], "campaign": [TAILS, PAPERS]}
TAIL_SEEDS = {TAILS: 40, PAPERS: 16}  # of the campaign; Student's t of few is wide

# Boxes of the shear waves: 8 x EDGE x 8. The finest are 8 cells long: shorter waves die before correlations build up.
EDGES, FINE_EDGES = (32, 16), (32, 24, 16, 12, 8)
DIFFUSION_BOX, WINDOWS = 16, 24
TAIL_BOX = 32
LATE = ("tail-late", "tail-late-2")
LATE_EVERY, LATE_LAGS, LATE_BLOCKS = 10, (35, 60), 99  # collisions between looks; lags, in looks; values that errors come from
SOUND_EDGE, SOUND_BLOCKS = 32, 24
SOUND_K = 2.0 * numpy.pi / SOUND_EDGE
HEAT_EDGE = 16
HEAVY = 2  # vertices of mass 5 per cell, as many as cL^3 = 1000 has
# Where molecular chaos is known to be off by a few per cent, nobody can say in advance by how many: a gate of 6 %.
CHAOS = 0.06


def label(point):
    return f"g{point.gamma}-dt{point.dt_c:g}-a{point.alpha}"


def amplitude(point):
    """Of the shear wave. Its energy becomes heat, and a kinetic viscosity grows with the temperature: small where the
    collisional part does not outweigh it."""
    kinetic, collisional = theory.viscosity(*point)
    return 0.6 if kinetic < 0.02 * collisional else 0.25 if kinetic < 0.3 * collisional else 0.12


def skip(point):
    """Collisions until what particles remember of each other has built up: 0.5 t0 at the paper's point."""
    return max(8, int(25 * min(1.0, 0.06 / point.dt_c)))


def shear_run(point, tier):
    edges = FINE_EDGES if point == PAPERS else EDGES
    pairs = PLENTY[tier] * (12 if point == PAPERS else 30 if point.dt_c < 0.2 else 60)
    arguments = [point.gamma, point.dt_c, point.alpha, amplitude(point), skip(point), pairs, 11, *edges]
    return Run("shear-" + label(point), program=["shear_decay", *arguments], hours=pairs * (1.6e-4 if point == PAPERS else 8e-5))


def heavy_run(tier):
    pairs = 10 * PLENTY[tier]
    return Run("shear-heavy", hours=pairs * 1e-4, program=[
        "shear_decay", f"{PAPERS.gamma}:{HEAVY}", *PAPERS[1:], 0.6, skip(PAPERS), pairs, 13, *EDGES])


def diffusion_run(point, tier):
    windows = WINDOWS * PLENTY[tier]
    return Run("diffusion-" + label(point), hours=windows * 4.5e-6 * point.gamma, program=[
        "solvent_vacf", DIFFUSION_BOX, point.gamma, point.dt_c, point.alpha, 250, windows, 21])


def tail_runs(point, length, windows):
    return [Run(f"tail-{label(point)}-{seed}", hours=(windows * length + 200) * 1.5e-6, program=[
        "solvent_vacf", TAIL_BOX, point.gamma, point.dt_c, point.alpha, length, windows, 30 + seed])
        for seed in range(1, TAIL_SEEDS[point] + 1)]


def runs(tier):
    found = [make(point, tier) for point in POINTS[tier] for make in (shear_run, diffusion_run)]
    for run in found:  # coarse: the points that verdicts are about; then the lines through them
        run.priority = 0 if any(run.name.endswith("-" + label(point)) for point in POINTS["quick"]) else 1
    if tier == "campaign":
        found += tail_runs(TAILS, 125, 30) + tail_runs(PAPERS, 250, 15)
        # When sound has died, C turns positive: 7 to 12 t0, from 20,000 origins each.
        found += [Run(name, hours=0.25, priority=1, program=[
            "solvent_tail", TAIL_BOX, PAPERS.dt_c, LATE_EVERY, *LATE_LAGS, 20000, 61 + number]) for number, name in enumerate(LATE)]
    return found + [heavy_run(tier)] + [sound_run(point, tier) for point in SOUND_POINTS[tier]] + [heat_run(tier)]


def sound_run(point, tier):
    pairs = PLENTY[tier] * (6 if point == TAILS else 2)
    return Run("sound-" + label(point), hours=pairs * 7e-4 * 0.1 / point.dt_c, program=[
        "sound_decay", SOUND_EDGE, *point, 0.03, round(0.2 / point.dt_c), pairs, 41])


def heat_run(tier):
    pairs = 2 if tier == "quick" else 32
    return Run("heat", hours=pairs * 1.6e-3, program=[
        "sound_decay", HEAT_EDGE, *PAPERS, 0.2, 5, pairs, 71, "heat"])


# --- what runs say ----------------------------------------------------------------------------------------------------

def viscosity(results, point):
    """(nu, error) for k -> 0: from both boxes, linear in k^2."""
    table = results["shear-" + label(point)].columns
    fit = stats.line(table["k"]**2, table["nu"], table["nu_error"])
    return fit.value[0], fit.error[0]


def diffusion(results, point):
    """(D, error) of a solvent particle at kT = 1, for long times and a large box: what shear waves still add after the
    last lag and sound takes back, and what periodic images take away, is made up for. The error has half of what the width of
    a particle would change: none or a cell's."""
    table = results["diffusion-" + label(point)].columns
    time, d, nu = table["time"][-1], table["D"][-1], viscosity(results, point)[0]
    points, wide = (theory.diffusion_still_to_come(time, DIFFUSION_BOX, point.gamma, nu, sound_damping(results, point), d, smear, heat(point))
                    for smear in (0.0, theory.CELL))
    images = theory.image_correction(point.gamma * (nu + d), DIFFUSION_BOX)
    return d + 0.5 * (points + wide) + images, math.hypot(table["D_error"][-1], 0.5 * (wide - points))


def heat(point):
    """Diffusivity of heat at constant density, molecular chaos: `heat_verdict` judges it."""
    return sum(theory.heat_diffusion(*point))


def sound_damping(results, point):
    """Gamma; where sound was not measured, half of what resists along a wave and of the share of heat. Collisions hand on momentum
    along a wave as they do across it; the kinetic part of nu counts 4/3 along it."""
    if "sound-" + label(point) in results:
        return sound(results, point)[0][2] / SOUND_K**2
    along = viscosity(results, point)[0] + theory.viscosity(*point)[0] / (3.0 * point.gamma)
    return 0.5 * (along + (1.0 - theory.SOUND_SPEED**-2) * heat(point))


def has_point(results, point):
    return f"shear-{label(point)}" in results and f"diffusion-{label(point)}" in results


def tail_tables(results, point):
    names = [name for name in results if name.startswith(f"tail-{label(point)}-")]
    return [results[name].columns for name in sorted(names)]


def has_tail(results, point):
    return has_point(results, point) and "sound-" + label(point) in results and len(tail_tables(results, point)) > 1


def tail(results, point, first, last):
    """((amplitude, error), theory's, what theory leaves open) of C(t) between two times, in units of what shear waves alone
    would leave; the error from the scatter of seeds. Theory is of leading order in k: whether its point particle is as wide as a
    cell or not is of the next one."""
    tables = tail_tables(results, point)
    time = tables[0]["time"]
    inside = (time >= first) & (time <= last)
    shear = shear_tail(results, point, time[inside])

    def amplitude(vacf):
        return (vacf @ shear) / (shear @ shear)
    low, high = sorted(amplitude(tail_theory(results, point, time[inside], smear)) for smear in (0.0, theory.CELL))
    return stats.mean([amplitude(table["vacf"][inside]) for table in tables]), 0.5 * (low + high), 0.5 * (high - low)


def tail_theory(results, point, time, smear=0.0, conducted=1.0, more=0.0):
    """Of the measured nu, D and damping of sound (and so many of its standard errors more), and of the diffusivity of heat (or a share of
    it): nothing is fitted."""
    damping = sound_damping(results, point) + more * sound(results, point)[1][2] / SOUND_K**2
    return theory.long_time_tail(time, TAIL_BOX, point.gamma, viscosity(results, point)[0], damping,
                                 diffusion(results, point)[0], smear, conducted * heat(point))


def shear_tail(results, point, time):
    """The same without sound."""
    return theory.long_time_tail(time, TAIL_BOX, point.gamma, viscosity(results, point)[0], None, diffusion(results, point)[0])


def wave(parameters, time):
    cosine, sine, rate, frequency = parameters
    return numpy.exp(-rate * time) * (cosine * numpy.cos(frequency * time) + sine * numpy.sin(frequency * time))


def sound(results, point):
    """(fit, errors, time, amplitude of each block): fit is (cosine, sine, rate, frequency)."""
    table = dict(results["sound-" + label(point)].columns)
    time = table.pop("time")

    def estimate(mean):
        rate = 0.7 * theory.kinematic_viscosity(*point) * SOUND_K**2
        start = (1.0, 0.0, rate, theory.SOUND_SPEED * SOUND_K)
        return optimize.least_squares(lambda p: wave(p, time) - mean, start, x_scale=(1.0, 1.0, 0.01, 0.1)).x
    blocks = numpy.array(list(table.values()))
    return (*stats.jackknife(blocks, estimate), time, blocks)


def heat_measured(results):
    """(diffusivity of heat, error) for k -> 0, at the paper's point: of the part of a wave of temperature that sound leaves."""
    table = dict(results["heat"].columns)
    time = table.pop("time")
    k2 = (2.0 * numpy.pi / HEAT_EDGE)**2
    damping = sound_damping(results, PAPERS)

    def estimate(mean):
        return optimize.least_squares(lambda p: p[1] * theory.heat_mode(time, k2, damping, p[0]) - mean, (heat(PAPERS), 1.0)).x
    fit, error = stats.jackknife(numpy.array(list(table.values())), estimate)[:2]
    share = 1.0 - k2 / 30.0
    return fit[0] / share, error[0] / share


# --- verdicts ---------------------------------------------------------------------------------------------------------

NAMES = {PAPERS: "paper", TAILS: "dt0.1", STRONG: "strong", DILUTE: "dt1"}


def words(point):
    return f"γ {point.gamma}, dt_c {point.dt_c:g}, {point.alpha}°"


def retention_verdict(results, point):
    expected = theory.retention(point.gamma, point.alpha)
    verdict = Verdict(f"solvent.retention.{NAMES[point]}", f"velocity kept in one collision, {words(point)}", expected,
                      "exact: 1 − (2/3)(1 − cos α)(γ − 1 + exp(−γ))/γ", tolerance=0.004)
    if "diffusion-" + label(point) in results:
        table = results["diffusion-" + label(point)].columns
        verdict.measured, verdict.error = table["vacf"][1], table["vacf_error"][1]
        verdict.tolerance = stats.tolerance(verdict.error, values=WINDOWS)
    return verdict


def viscosity_verdict(results, point):
    expected = theory.kinematic_viscosity(*point)
    verdict = Verdict(f"solvent.viscosity.{NAMES[point]}", f"kinematic viscosity for k → 0, {words(point)}", expected,
                      "Eqs. (30), (31), molecular chaos, known to 6 %", tolerance=CHAOS * expected)
    if has_point(results, point):
        verdict.measured, verdict.error = viscosity(results, point)
        verdict.tolerance = stats.tolerance(verdict.error, systematic=CHAOS * expected)
    return verdict


def paper_verdicts(results):
    """What the paper computes with, to its letter: molecular chaos at a mean free path of 0.02 a0."""
    nu, d = theory.kinematic_viscosity(*PAPERS), theory.self_diffusion(*PAPERS)
    again = "At a mean free path of 0.02 a0 the same particles meet again, "
    schmidt = Verdict("solvent.schmidt", "Schmidt number ν/D at the paper's point", nu / d,
                      "Eqs. (30), (31) and D of molecular chaos", 0.0, kind="paper",
                      reason=again + "and backflow carries them on: D is a quarter higher, ν 4 % lower.")
    if has_point(results, PAPERS):
        (shear, shear_error), (measured, error) = viscosity(results, PAPERS), diffusion(results, PAPERS)
        schmidt.measured = shear / measured
        schmidt.error = schmidt.measured * numpy.hypot(error / measured, shear_error / shear)
    schmidt.tolerance = stats.tolerance(schmidt.error)
    return [schmidt]


def slope_verdict(results):
    share = theory.viscosity(*PAPERS)[1] / sum(theory.viscosity(*PAPERS))
    verdict = Verdict("solvent.viscosity.k", "d(ν(k)/ν)/dk², paper's point", -share / 30.0,
                      "collisional flux between neighboring cells: 1 − k²/30", 0.05)
    if has_point(results, PAPERS):
        table = results["shear-" + label(PAPERS)].columns
        fit = stats.line(table["k"]**2, table["nu"], table["nu_error"])
        verdict.measured = fit.value[1] / fit.value[0]
        verdict.error = fit.error[1] / fit.value[0]
        verdict.tolerance = stats.tolerance(verdict.error)
    return verdict


def heavy_verdict(results):
    """What the dense suspensions swim in: vertices that go with the flow are most of its mass."""
    eta, nu = dilute.heavy_fluid(HEAVY)
    verdict = Verdict("solvent.viscosity.heavy", f"ν of the solvent with {HEAVY} loose vertices of mass 5 per cell, the paper's "
                      "point", nu, f"Eq. (31) with the members' masses: η is {eta / dilute.ETA:.2f} times that of the measured "
                      "solvent; molecular chaos of the vertices, 4 %", 0.04 * nu)
    if "shear-heavy" in results:
        table = results["shear-heavy"].columns
        share = 1.0 - table["k"]**2 / 30.0
        verdict.measured, verdict.error, _ = stats.weighted_mean(table["nu"] / share, table["nu_error"] / share)
        verdict.tolerance = stats.tolerance(verdict.error, systematic=0.04 * nu)
    return verdict


def diffusion_verdict(results):
    expected = theory.self_diffusion(*DILUTE)
    verdict = Verdict("solvent.diffusion.dt1", f"self-diffusion, {words(DILUTE)}", expected,
                      "molecular chaos, which a mean free path of a cell makes right to 2 %", 0.02 * expected)
    if has_point(results, DILUTE):
        verdict.measured, verdict.error = diffusion(results, DILUTE)
        verdict.tolerance = stats.tolerance(verdict.error, systematic=0.02 * expected, values=WINDOWS)
    return verdict


def heat_verdict(results):
    expected = heat(PAPERS)
    verdict = Verdict("solvent.heat", "diffusivity of heat at constant density for k → 0, the paper's point", expected,
                      "molecular chaos, known to 6 % as for viscosity", CHAOS * expected)
    if "heat" in results and has_point(results, PAPERS):
        verdict.measured, verdict.error = heat_measured(results)
        verdict.tolerance = stats.tolerance(verdict.error, systematic=CHAOS * expected, values=SOUND_BLOCKS)
    return verdict


def sound_verdict(results):
    """The frequency is c k up to a share (rate/frequency)^2 of it, viscosity's and heat's."""
    verdict = Verdict("solvent.sound", f"speed of sound, {words(TAILS)}", theory.SOUND_SPEED,
                      "√(5/3): energy is conserved", 0.02)
    if "sound-" + label(TAILS) in results:
        fit, error, *_ = sound(results, TAILS)
        verdict.measured, verdict.error = fit[3] / SOUND_K, error[3] / SOUND_K
        bound = (fit[2] / fit[3])**2 * theory.SOUND_SPEED
        verdict.tolerance = stats.tolerance(verdict.error, systematic=bound, values=SOUND_BLOCKS)
    return verdict


TAIL_TIMES = {TAILS: (2.0, 12.4), PAPERS: (2.5, 4.9)}


def tail_verdict(results, point):
    """It has to be told from the tail of shear alone. Not at the paper's point: there they cancel, what the width of a particle makes is as large as the rest, and no
    run however long would decide anything. (A theory without the sine of `sound_decays` is far off there; at dt_c 0.1 it is not.)"""
    first, last = TAIL_TIMES[point]
    verdict = Verdict(f"solvent.tail.{NAMES[point]}",
                      f"long-time tail of C(t), {first:g} to {last:g} t0, over that of shear waves alone, {words(point)}", 0.0,
                      "shear waves, sound and heat of the box with the measured ν, D, Γ: between particles of no "
                      "width and as wide as a cell; 0.05 for ν(k)", 0.0, rival=1.0)
    if has_tail(results, point):
        (verdict.measured, verdict.error), verdict.expected, open_ = tail(results, point, first, last)
        verdict.tolerance = stats.tolerance(verdict.error, systematic=open_ + 0.05, values=len(tail_tables(results, point)))
    return verdict


def late_tail(results):
    """(t, C, its error) of the paper's point at long lags, and (mean over lags, its error), over the runs that there are; None without
    one. Their errors are alike: plain means."""
    tables = [results[name].columns for name in LATE if name in results and results[name].text]
    if not tables:
        return None
    vacf = numpy.mean([table["vacf"] for table in tables], axis=0)
    error = numpy.sqrt(numpy.sum([table["vacf_error"]**2 for table in tables], axis=0)) / len(tables)
    return [tables[0]["time"][:-1], vacf[:-1], error[:-1]], (vacf[-1], error[-1])


def late_verdict(results):
    """At the paper's point C is negative while sound dies, which heat prolongs. The theory without heat, which would take away 0.36, has
    to be told from it. The error of Gamma is one of what is expected."""
    first, last = (lag * LATE_EVERY * PAPERS.dt_c for lag in LATE_LAGS)
    verdict = Verdict("solvent.tail.late", "what sound and heat take away from C(t), over what shear waves alone make of it, "
                      f"{first:g} to {last:g} t0, {words(PAPERS)}", 0.0, "waves of shear, sound and heat of the box, nothing fitted: "
                      "between particles of no width and as wide as a cell; 0.05 for ν(k)", 0.0)
    found = late_tail(results)
    if found and has_tail(results, PAPERS):
        (time, _, _), (mean, error) = found
        shear = shear_tail(results, PAPERS, time).mean()

        def taken(**options):
            return 1.0 - tail_theory(results, PAPERS, time, **options).mean() / shear
        low, high = sorted(taken(smear=smear) for smear in (0.0, theory.CELL))
        verdict.rival = taken(conducted=0.0)
        verdict.expected = 0.5 * (low + high)
        verdict.expected_error = 0.5 * abs(taken(more=1.0) - taken(more=-1.0))
        verdict.measured, verdict.error = 1.0 - mean / shear, error / shear
        verdict.tolerance = stats.tolerance(math.hypot(verdict.error, verdict.expected_error), systematic=0.5 * (high - low) + 0.05,
                                            values=SOUND_BLOCKS)
    return verdict


# --- figures ----------------------------------------------------------------------------------------------------------

def lines_of(results, known):
    """Points along dt_c, gamma, alpha through the paper's point: (name of the axis, index, points)."""
    for index, name in ((1, "collision interval $\\Delta t_c$ ($t_0$)"), (0, "particles per cell $\\gamma$"),
                        (2, "rotation angle $\\alpha$ (degrees)")):
        others = [k for k in range(3) if k != index]
        yield name, index, sorted(point for point in known if all(point[k] == PAPERS[k] for k in others))


def draw_chaos(results, known):
    figure, tops, belows = figures.with_residuals(width=9.5, height=5.2, columns=3, share=0.75)
    quantities = (("viscosity $\\nu$", viscosity, theory.kinematic_viscosity),
                  ("self-diffusion $D$", diffusion, theory.self_diffusion))
    ends = {1: (0.015, 1.3), 0: (2.5, 25.0), 2: (20.0, 160.0)}
    for (name, index, points), top, below in zip(lines_of(results, known), tops, belows):
        for number, (what, measure, expected) in enumerate(quantities):
            x = numpy.geomspace(*ends[index], 100)
            figures.theory(top, x, [expected(*PAPERS._replace(**{Point._fields[index]: value})) for value in x],
                           color=figures.COLORS[number])
            values = numpy.array([measure(results, point) for point in points])
            chaos = numpy.array([expected(*point) for point in points])
            at = [point[index] for point in points]
            figures.points(top, at, values[:, 0], values[:, 1], number=number, label=what)
            figures.points(below, at, 100.0 * (values[:, 0] / chaos - 1.0), 100.0 * values[:, 1] / chaos, number=number)
        top.set_yscale("log")
        if index < 2:
            below.set_xscale("log")
            below.set_xticks([0.02, 0.1, 0.5] if index == 1 else [3, 5, 10, 20])
            below.xaxis.set_major_formatter("{x:g}")
            below.minorticks_off()
        below.set_xlabel(name)
    tops[0].set_ylabel("$a_0^2/t_0$")
    figures.named(tops[0], "molecular chaos", linestyle="-", linewidth=1.1)
    figures.legend_above(tops[0], columns=1)
    belows[0].set_ylabel("over molecular chaos (%)")
    return figure


def draw_waves(results):
    table = results["shear-" + label(PAPERS)].columns
    fit = stats.line(table["k"]**2, table["nu"], table["nu_error"])
    share = theory.viscosity(*PAPERS)[1] / sum(theory.viscosity(*PAPERS))
    figure, top, below = figures.with_residuals()
    k2 = numpy.linspace(0.0, 0.66, 50)
    figures.theory(top, k2, 1.0 - share * k2 / 30.0, label="$1 - k^2/30$")
    figures.points(top, table["k"]**2, table["nu"] / fit.value[0], table["nu_error"] / fit.value[0],
                   label="decay of shear waves")
    figures.points(below, table["k"]**2, table["nu"] / fit.value[0] - 1.0 + share * table["k"]**2 / 30.0,
                   table["nu_error"] / fit.value[0])
    top.set_ylabel("$\\nu(k)/\\nu(0)$")
    below.set_ylabel("difference")
    below.set_xlabel("$k^2$ ($a_0^{-2}$)")
    figures.legend(top)
    return figure


def draw_sound(results):
    fit, _, time, blocks = sound(results, TAILS)
    mean, error = blocks.mean(axis=0), blocks.std(axis=0, ddof=1) / numpy.sqrt(len(blocks))
    figure, top, below = figures.with_residuals()
    figures.theory(top, time, wave(fit, time), label="damped wave, fitted")
    step = slice(None, None, 3)
    figures.points(top, time[step], mean[step], error[step], label="$v_y(k,t)/v_y(k,0)$")
    figures.points(below, time[step], (mean - wave(fit, time))[step], error[step])
    top.set_ylabel("amplitude of the wave")
    below.set_ylabel("difference")
    below.set_xlabel("time ($t_0$)")
    figures.legend(top)
    return figure


def draw_late(axes, results, number):
    """Lags of tail-late, five to a point, over shear waves alone; and the theory there."""
    columns = late_tail(results)[0]
    time, vacf, error = (column[:len(column) // 5 * 5].reshape(-1, 5) for column in columns)
    t, over = time.mean(axis=1), shear_tail(results, PAPERS, time.mean(axis=1))
    figures.points(axes, t, vacf.mean(axis=1) / over, numpy.sqrt((error**2).sum(axis=1)) / 5.0 / over, number=number)
    lines = numpy.linspace(time[0, 0], time[-1, -1], 40)
    shear = shear_tail(results, PAPERS, lines)
    axes.fill_between(lines, *(tail_theory(results, PAPERS, lines, smear) / shear for smear in (0.0, theory.CELL)),
                      color=figures.COLORS[number], alpha=0.2, linewidth=0)


def draw_tail(results, points):
    figure, top, below = figures.with_residuals(share=0.45)
    for number, point in enumerate(points):
        tables = tail_tables(results, point)
        time, vacf = tables[0]["time"], numpy.array([table["vacf"] for table in tables])
        edges = numpy.unique(numpy.round(numpy.geomspace(1, len(time), 26)).astype(int))
        bins = [(time[a:b].mean(), *stats.mean(vacf[:, a:b].mean(axis=1)), a, b) for a, b in zip(edges, edges[1:])]
        t = numpy.array([entry[0] for entry in bins])
        mean, error = numpy.array([entry[1:3] for entry in bins]).T
        figures.points(top, t, mean, error, number=number, label=words(point))
        early = numpy.arange(1, 9) * point.dt_c
        figures.theory(top, early, theory.retention(point.gamma, point.alpha)**numpy.arange(1, 9), color=figures.COLORS[number],
                       linewidth=0.8)
        late, lines = t > 0.25 * TAIL_TIMES[point][0], time[time > 0.25 * TAIL_TIMES[point][0]]
        shear = shear_tail(results, point, lines)
        figures.theory(top, lines, shear, color=figures.COLORS[number], linestyle="--")
        bounds = [tail_theory(results, point, lines, smear) / shear for smear in (0.0, theory.CELL)]
        below.fill_between(lines, *bounds, color=figures.COLORS[number], alpha=0.2, linewidth=0)
        over = shear_tail(results, point, t[late])
        figures.points(below, t[late], mean[late] / over, error[late] / over, number=number)
        if point == PAPERS and late_tail(results):
            draw_late(below, results, number)
    top.set(xscale="log", ylim=(-1e-3, 1.0), ylabel="$C(t)/C(0)$")
    top.set_yscale("symlog", linthresh=1e-4)  # linear about 0, where there is noise of either sign
    below.set(ylabel="over the part\nof shear waves", ylim=(-3.0, 3.0), xlabel="time ($t_0$)")
    figures.named(top, "molecular chaos", linestyle="-", linewidth=0.8)
    figures.named(top, "shear waves of the box", linestyle="--", linewidth=1.1)
    figures.named(below, "shear, sound, heat; points to cells wide", marker="s", markersize=8, alpha=0.3)
    figures.legend_above(top, below)
    return figure


def evaluate(results, tier):
    verdicts = [retention_verdict(results, PAPERS), retention_verdict(results, STRONG)]
    verdicts += [viscosity_verdict(results, point) for point in POINTS["quick"]]
    verdicts += [slope_verdict(results)] if tier == "campaign" else []  # the quick runs cannot tell it from nothing
    verdicts += [heavy_verdict(results), diffusion_verdict(results), sound_verdict(results), heat_verdict(results)]
    if tier == "campaign":
        verdicts.append(tail_verdict(results, TAILS))
    verdicts += paper_verdicts(results) + ([late_verdict(results)] if tier == "campaign" else [])
    return Outcome(verdicts, figures_of(results, tier), prose(results))


def still_to_come(tier, known):
    count = len(POINTS[tier]) - len(known)
    return f" {count} other points are still to run." if count else ""


def figures_of(results, tier):
    known = [point for point in POINTS[tier] if has_point(results, point)]
    tails = [point for point in TAIL_TIMES if has_tail(results, point)]
    found = []
    if PAPERS in known:
        found.append(Figure(
            "chaos", "Viscosity and self-diffusion through the paper's point (γ 5, dt_c 0.02, 90°). Lines: molecular chaos, "
            "Eqs. (30), (31). Below: the measured values over these lines." + still_to_come(tier, known), lambda: draw_chaos(results, known)))
        found.append(Figure(
            "waves", "Decay of transverse modes against k at the paper's point. The line is the effect of the width of a "
            "cell on the collisional flux of momentum.", lambda: draw_waves(results)))
    if "sound-" + label(TAILS) in results:
        found.append(Figure("sound", f"A standing sound wave of k = 2π/32, {words(TAILS)}.", lambda: draw_sound(results)))
    if tails:
        found.append(Figure(
            "tail", "Velocity autocorrelation of solvent particles. Thin: molecular chaos, cⁿ after n collisions. Dashed: the tail "
            "due to shear waves, summed over the waves of the box. Below: divided by this tail. Shaded: waves of shear, sound and heat, for particles "
            "between points and the width of a cell. Nothing is fitted.",
            lambda: draw_tail(results, tails)))
    return found


def prose(results):
    if not has_point(results, PAPERS):
        return "No run at the paper's point yet."
    nu, d = viscosity(results, PAPERS)[0], diffusion(results, PAPERS)[0]
    chaos_nu, chaos_d = theory.kinematic_viscosity(*PAPERS), theory.self_diffusion(*PAPERS)
    return (
        f"At the paper's point ν is {nu:.3f} ({100.0 * (1.0 - nu / chaos_nu):.1f} % below Eqs. (30), (31)), and a solvent particle "
        f"diffuses with D = {d:.4f} ({100.0 * (d / chaos_d - 1.0):.0f} % above molecular chaos). **Both formulas fail for the same reason:** with a "
        "mean free path of 0.02 a0 the same particles share a cell for many collisions. A single collision agrees with molecular "
        f"chaos. The Schmidt number is {nu / d:.0f} instead of {chaos_nu / chaos_d:.0f}. With a mean free path of a cell molecular chaos "
        "holds.\n\nMolecular chaos leaves out hydrodynamics. The velocity autocorrelation follows ((ν + D)t)^(−3/2) with no number "
        "fitted, if the waves of the periodic box are summed one by one. Sound waves contribute, too, and heat makes them last longer. At "
        "dt_c 0.1 they take a third away at 2 t0 and have vanished at 10. At the paper's point the fluid is four times as viscous. There "
        "they take away more than the shear waves contribute, and C is negative from 1.5 to some 9 t0.\n\nVertices of mass 5 change the fluid. With two per cell, as at "
        "cL³ = 1000, collisions transfer almost three times as much momentum. The mass is three times as large as well, so ν hardly "
        "changes and η does.")
