"""What integrators of dissipative particle dynamics do to a fluid (validation/measure/dpd_integrators.c): those that err, and the
program's own step. Units a0 = kT = m = 1; density 3, a = 25, gamma = 4.5."""
import math

from lib import figures, stats
from lib.case import Verdict
from lib.runs import Run

STEPS = (0.01, 0.02, 0.03, 0.04, 0.06)
GAMMA = 4.5
# name: title, gamma. Lowe and Andersen's with the rate that has the same friction: 2 pi/9 of it is 2 pi/45 of 4.5.
SCHEMES = {"euler": ("explicit Euler", GAMMA), "groot-warren": ("Groot and Warren, λ = 1/2", GAMMA), "groot-warren-65": ("Groot and Warren, λ = 0.65", GAMMA),
           "dpd-vv": ("DPD-VV", GAMMA), "sc-vv": ("self-consistent, velocity Verlet", GAMMA), "leap-frog": ("self-consistent, leap-frog", GAMMA),
           "peters": ("this program, `relax` (Peters)", GAMMA), "shardlow": ("this program, `cayley` (Shardlow)", GAMMA),
           "lowe": ("this program, Lowe-Andersen", GAMMA / 10.0)}
TIME = {"peters": 400}  # t0; others 100. The errors of this one are compared between steps
IDEAL = ("groot-warren", "groot-warren-65", "dpd-vv", "sc-vv", "leap-frog", "peters")
STRONG = 40.0  # gamma of a second ideal gas, at a step of 0.02


def runs():
    found = []
    for name, (_, gamma) in SCHEMES.items():
        time = TIME.get(name, 100)
        found.append(Run(f"integrator-{name}", program=["dpd_integrators", name, 6, 25, gamma, time, 1, *STEPS], hours=0.007 * (time + 20) / 120))
    for name in IDEAL:
        found.append(Run(f"ideal-{name}", program=["dpd_integrators", name, 5, 0, GAMMA, 100, 1, 0.02, 0.05], hours=0.001))
        found.append(Run(f"ideal40-{name}", program=["dpd_integrators", name, 5, 0, STRONG, 100, 1, 0.02], hours=0.0006))
    return found


def quick_runs():
    """An ideal gas in the program's own step: its temperature and its structure are known exactly."""
    return [run for run in runs() if run.name == "ideal40-peters"]


def value(results, run, column, step):
    """(value, error) at this step; None without the run."""
    if run not in results:
        return None
    table = results[run].columns
    rows = [k for k, dt in enumerate(table["dt"]) if abs(dt - step) < 1e-9]
    return (table[column][rows[0]], table[column + "_error"][rows[0]]) if rows else None


def fill(verdict, pair, systematic, values=16):
    if pair is not None and math.isfinite(pair[1]):
        verdict.measured, verdict.error = pair
        verdict.tolerance = stats.tolerance(verdict.error, systematic=systematic, values=values)
    return verdict


def excess_ratio(results):
    """Of the configurational temperature less 1 at a step of 0.06 over that at 0.03."""
    large, small = (value(results, "integrator-peters", "configurational", dt) for dt in (0.06, 0.03))
    if large is None or small is None:
        return None
    a, b = large[0] - 1.0, small[0] - 1.0
    return a / b, abs(a / b) * math.hypot(large[1] / a, small[1] / b)


def verdicts(results):
    gap = 0.5 * 0.02 * 2.0 * math.pi / 45.0 * GAMMA * 3.0  # dt zeta/2
    found = [
        fill(Verdict("media.integrators.gap", "ideal gas, Groot and Warren's λ = 1/2, dt 0.02: temperature of the predicted velocity less that of the velocity", gap,
                     "dt ζ/2, to first order in γ dt: 15 %", 0.15 * gap), value(results, "ideal-groot-warren", "gap", 0.02), 0.15 * gap),
        fill(Verdict("media.integrators.hold65", "kinetic temperature with λ = 0.65 at dt 0.06", 1.0, "Groot and Warren (1997): no loss of control, 2 %", 0.02, kind="paper"),
             value(results, "integrator-groot-warren-65", "kinetic", 0.06), 0.02),
        fill(Verdict("media.integrators.order", "this program: T_conf − 1 at dt 0.06 over that at 0.03", 4.0, "dt²; the next order is 15 %", 0.6),
             excess_ratio(results), 0.6)]
    return found + [gas_verdict(results, *row) for row in (
        ("peters", "this program", "gate"), ("leap-frog", "the leap-frog with the mean velocity", "gate"), ("groot-warren", "Groot and Warren, λ = 1/2", "paper"))]


def quick_verdicts(results):
    heat = Verdict("media.integrators.gas.heat", f"ideal gas, γ = {STRONG:g}, dt 0.02, this program: kinetic temperature", 1.0,
                   "each exchange keeps Maxwell's distribution, whatever the step: exact", 0.0)
    return [fill(heat, value(results, "ideal40-peters", "kinetic", 0.02), 0.0), gas_verdict(results, "peters", "this program", "gate")]


def gas_verdict(results, name, title, kind):
    return fill(Verdict(f"media.integrators.gas.{name}", f"ideal gas, γ = {STRONG:g}, dt 0.02, {title}: pairs nearer than 0.1 a0 over chance", 1.0,
                        "an ideal gas has no structure: exact", 0.0, kind=kind, reason="" if kind == "gate" else "friction at the new place with the old velocity"),
                value(results, f"ideal40-{name}", "close", 0.02), 0.0)


def draw(results):
    """Errors of the two temperatures against the step."""
    figure, panels = figures.plain(width=9.2, height=4.2, columns=2)
    for panel, column, label in zip(panels, ("kinetic", "configurational"), ("kinetic temperature", "configurational temperature")):
        for number, (name, (title, _)) in enumerate(list(SCHEMES.items())[1:]):  # the first is off the scale
            if f"integrator-{name}" not in results:
                continue
            table = results[f"integrator-{name}"].columns
            figures.points(panel, table["dt"], table[column], table[column + "_error"], number, label=title.replace("`", ""), markersize=3.5)
            figures.line(panel, table["dt"], table[column], number)
        panel.axhline(1.0, color=figures.PALE, linewidth=0.8)
        panel.set(xlabel="time step ($t_0$)", ylabel=label, ylim=(0.95, 1.2))
    figures.legend(panels[0], loc="upper left", fontsize=7.5)
    return figure
