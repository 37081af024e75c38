"""The same pure solvent in uncross and in LAMMPS: memory and diffusion of its particles, side by side."""
import math

import numpy
from scipy import stats as distributions

from lib import figures, stats, theory
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "The same solvent in LAMMPS"
PAPER = "Sec. III"
APART = True  # needs LAMMPS: `make peer`

CELLS, INTERVAL, LENGTH, SEEDS = 32, 0.02, 250, range(1, 9)
PROGRAMS = {  # name of the runs -> (program and arguments before the seed, CPU hours, label)
    "uncross": (["solvent_vacf", CELLS, 5, INTERVAL, 90, LENGTH, 16], 0.005, "uncross"),
    "box-axes": (["solvent_vacf_box_axes", CELLS, 5, INTERVAL, 90, LENGTH, 16], 0.005, "uncross, axes of LAMMPS"),
    "lammps": (["solvent_lammps", CELLS, LENGTH, 5], 0.015, "LAMMPS, fix srd"),
}
FALSE_ALARMS, VERDICTS = 1e-3, 11


def runs(tier):
    if tier == "quick":
        return []
    return [Run(f"{name}-{seed}", program=[*program, seed], hours=hours)
            for name, (program, hours, _) in PROGRAMS.items() for seed in SEEDS]


def collect(results, column):
    """name -> [seeds][LENGTH] of the programs with at least two seeds."""
    tables = {}
    for name in PROGRAMS:
        found = [results[f"{name}-{seed}"] for seed in SEEDS if f"{name}-{seed}" in results]
        if len(found) > 1:
            tables[name] = numpy.array([result.columns[column] for result in found])
    return tables


def mean(values):
    """(mean, standard error) over seeds."""
    values = numpy.asarray(values)
    return values.mean(0), values.std(0, ddof=1) / math.sqrt(len(values))


def freedom(a, b):
    """Welch's degrees of freedom of the difference of two means; b may be a number that is known."""
    parts = [(numpy.var(x, ddof=1) / len(x), len(x) - 1) for x in (a, b) if x is not None]
    return sum(v for v, _ in parts) ** 2 / sum(v * v / n for v, n in parts)


def compare(name, statement, ours, theirs, source, exact=None):
    """A verdict on means over seeds; theirs is None where the exact number is known."""
    if ours is None or (theirs is None and exact is None):
        return Verdict(f"peer.{name}", statement, exact, source, None)
    measured, error = map(float, mean(ours))
    expected, expected_error = (exact, 0.0) if theirs is None else map(float, mean(theirs))
    few = freedom(ours, theirs)
    z = distributions.t.isf(FALSE_ALARMS / VERDICTS / 2.0, few)
    both = math.hypot(error, expected_error)
    # A difference of the tolerance and 1.3 standard errors more is seen nine times out of ten.
    return Verdict(f"peer.{name}", statement, expected, source, stats.Tolerance(z * both, 0.0, few), measured, error, expected_error,
                   detects=(z + 1.3) * both)


def chaos_diffusion(n, c):
    """D after n flights of a velocity that keeps c per collision, kT = 1."""
    k = numpy.arange(1, n)
    return INTERVAL / (2 * n) * (n + 2.0 * ((n - k) * c**k).sum())


def long_time_tail(time):
    """C(t)/C(0) of hydrodynamics, late: (2/3 rho) [4 pi (nu + D) t]^(-3/2). Alder and Wainwright, Phys. Rev. A 1, 18
    (1970)."""
    spread = theory.kinematic_viscosity() + theory.self_diffusion()
    return 2.0 / (3.0 * 5.0) * (4.0 * math.pi * spread * time) ** -1.5


def verdicts(vacf, diffusion):
    def lag(tables, name, first, last=None):
        if name not in tables:
            return None
        return tables[name][:, first:(first if last is None else last) + 1].mean(1)

    source, kept = "LAMMPS, same system", theory.retention()
    found = [compare(f"first.{name}", f"{PROGRAMS[name][2]}: velocity kept in one collision", lag(vacf, name, 1), None,
                     "exact in equilibrium", kept) for name in ("uncross", "lammps")]
    for first, last in ((2, 2), (5, 5), (10, 24), (25, 49)):
        which = f"after {first} collisions" if first == last else f"mean after {first} to {last} collisions"
        found.append(compare(f"memory.{first}", f"C(t)/C(0) {which}", lag(vacf, "uncross", first, last),
                             lag(vacf, "lammps", first, last), source))
    for n in (10, 50, LENGTH - 1):
        found.append(compare(f"diffusion.{n}", f"<r^2>/6t kT at t = {n * INTERVAL:g} t0, a0^2/t0",
                             lag(diffusion, "uncross", n), lag(diffusion, "lammps", n), source))
    n = LENGTH - 1
    axes = f"<r^2>/6t kT at t = {n * INTERVAL:g} t0: axes of the box"
    found.append(compare("axes", axes, lag(diffusion, "box-axes", n), lag(diffusion, "uncross", n),
                         "uncross, axes from the sphere"))
    found.append(compare("axes.lammps", axes, lag(diffusion, "box-axes", n), lag(diffusion, "lammps", n), source))
    assert len(found) == VERDICTS
    return found


def draw(vacf, diffusion):
    figure, (left, right), (left_rest, right_rest) = figures.with_residuals(9.2, 5.2, columns=2)
    n = numpy.arange(LENGTH)
    time = n * INTERVAL
    shown = numpy.unique(numpy.round(numpy.geomspace(1, LENGTH - 1, 26)).astype(int))
    kept = theory.retention()
    early = n[1:13]
    figures.theory(left, time[early], kept ** early, label="molecular chaos, $c^n$")
    figures.theory(left, time[15:], long_time_tail(time[15:]), linestyle="--", label=r"shear waves, $t^{-3/2}$")
    figures.theory(right, time[1:], [chaos_diffusion(k, kept) for k in n[1:]], label="molecular chaos")
    for number, name in enumerate(vacf):
        label = PROGRAMS[name][2]
        for axes, table in ((left, vacf[name]), (right, diffusion[name])):
            value, error = mean(table[:, shown])
            figures.points(axes, time[shown], value, error, number, label=label, markerfacecolor="none")
        if "lammps" in vacf and name != "lammps":
            for axes, tables, scale in ((left_rest, vacf, 1e3), (right_rest, diffusion, None)):
                (a, da), (b, db) = mean(tables[name][:, shown]), mean(tables["lammps"][:, shown])
                by = scale if scale else 100.0 / b
                figures.points(axes, time[shown], (a - b) * by, numpy.hypot(da, db) * by, number)
    left.set(xscale="log", ylim=(-1e-3, 1.0), ylabel=r"$\langle v(0)\cdot v(t)\rangle/\langle v^2\rangle$")
    left.set_yscale("symlog", linthresh=1e-4)  # linear about 0, where there is noise of either sign
    right.set(xscale="log", ylabel=r"$\langle r^2(t)\rangle / 6\,t\,kT$   [$a_0^2/t_0$]")
    left_rest.set(xlabel=r"$t$ [$t_0$]", ylabel="less LAMMPS\n" + r"[$10^{-3}$]")
    right_rest.set(xlabel=r"$t$ [$t_0$]", ylabel="less LAMMPS\n[%]")
    figures.legend(left)
    figures.legend(right, loc="lower right")
    return figure


def prose(vacf, diffusion):
    if "uncross" not in diffusion or "lammps" not in diffusion:
        return "Not measured yet: `make peer`."
    chaos = chaos_diffusion(LENGTH - 1, theory.retention())
    excess = {name: 100.0 * (mean(table[:, -1])[0] / chaos - 1.0) for name, table in diffusion.items()}
    text = ("Both programs have the same velocity autocorrelation and the same diffusion within error bars. Both differ from molecular "
            f"chaos from the second collision on: at t = {(LENGTH - 1) * INTERVAL:g} t0 <r^2> of uncross is "
            f"{excess['uncross']:.1f} % larger than that, of LAMMPS {excess['lammps']:.1f} %. A particle flies 0.02 a0 "
            "between collisions, so it meets the same partners again, and a part of its momentum comes back.")
    if "box-axes" in diffusion:
        text += ("\n\nLAMMPS turns about the axes of the box, uncross about any axis. Molecular chaos gives the same "
                 "result for both, because the mean rotation is a third of the identity in both cases. The measured result is the same, "
                 f"too, within errors: with the axes of LAMMPS uncross has {excess['box-axes']:.1f} %.")
    return text


def evaluate(results, tier):
    if tier == "quick":
        return Outcome([], prose="Not in this tier: needs LAMMPS (`make peer`).")
    vacf, diffusion = collect(results, "vacf"), collect(results, "D")
    drawn = [Figure("peer", "Velocity autocorrelation (left) and mean square displacement over 6t (right) of solvent "
                    "particles in uncross and LAMMPS, 32³ cells. Errors from 8 seeds of each. Dashed: the tail of shear waves alone, without the negative "
                    "share of sound. Below: differences from LAMMPS.",
                    lambda: draw(vacf, diffusion))] if vacf else []
    return Outcome(verdicts(vacf, diffusion), drawn, prose(vacf, diffusion))
