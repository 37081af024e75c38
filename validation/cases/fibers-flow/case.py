"""Fibers in shear: a Gaussian chain against Rouse, a stiff rod against the Fokker-Planck equation of a thin one, and noncrossing suspensions."""
import math

import numpy

from lib import fiber_flow as theory
from lib import figures, flow, stats
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "Fibers in shear: chains, rods, noncrossing suspensions"
PAPER = "not in the paper"

# --- runs -------------------------------------------------------------------------------------------------------------

CHAIN = {"box": 64, "per_cell": 5, "interval": 0.1, "chains": 200, "vertices": 6, "mass": 5, "spring": 0.2}
CHAIN_SCENE = """box: [{box}, {box}, {box}]
time_step: {interval}
solvent: {{per_cell: {per_cell}, collision_interval: {interval}, rule: srd, bath: phantoms, hydrodynamics: false}}
shear: {{rate: {rate}}}
fibers:
  - {{name: chain, count: {chains}, vertices: {vertices}, mass: {mass}, bond_length: 0, spring: {spring}, bending: 0}}
crossing: {{forbidden: false}}
observe: {{from: 10000, orientation: {{every: 20}}, stress: {{every: 20}}}}
"""
CHAIN_RATES = {"campaign": (0.003, 0.01, 0.03), "quick": (0.01,)}

ROD_SCENE = """box: [12, 12, 12]
time_step: 0.01
solvent: {{per_cell: 5, collision_interval: 0.02, rule: at-a}}
{shear}
fibers:
  - {{name: rod, count: 16, vertices: 8, mass: 5, bond_length: 0.5, spring: 400, bending: 100}}
crossing: {{forbidden: false}}
observe: {{from: 30000, {observers}}}
"""
ROD_RATES = {"1": 0.00124, "10": 0.0124, "50": 0.062}  # 1/t0, by the Peclet number that is aimed at

SUSPENSION_SCENE = """box: [16, 16, 16]
time_step: 0.01
solvent: {{per_cell: 5, collision_interval: 0.1, rule: at-a}}
shear: {{rate: {rate}}}
fibers:
  - {{name: fiber, count: {count}, vertices: 32, mass: 5, bond_length: 0.5, spring: 100, persistence_length: 32}}
crossing: {{forbidden: {forbidden}, rule: event-driven}}
observe: {{from: {start}, orientation: {{every: 50}}, stress: {{every: 10}}, collisions: {{every: 1000}}, temperature: {{every: 200}}}}
"""
SUSPENSIONS = {100: 110, 400: 440}  # fibers, by cL^3
SUSPENSION_RATES = (0.01, 0.03, 0.1, 0.3)  # 1/t0


def chain(rate, steps):
    text = CHAIN_SCENE.format(rate=rate, **CHAIN)
    return Run(f"chain-{rate:g}", scene=text, steps=steps, hours=steps * 1200 * 300e-9 / 3600.0)


def rod(peclet, steps):
    shear = f"shear: {{rate: {ROD_RATES[peclet]}}}" if peclet else ""
    observers = "orientation: {every: 20}" if peclet else "orientation: {every: 50}, dynamics: {every: 100, longest_lag: 100000}"
    return Run(f"rod-{peclet or 'rest'}", scene=ROD_SCENE.format(shear=shear, observers=observers), steps=steps, hours=steps * 150e-6 / 3600.0)


def suspension(density, rate, forbidden, strain):
    """Without the first part, in which fibers turn into the flow: a strain of 10, or 200 t0."""
    start, steps = round(max(10.0 / rate, 200.0) / 0.01), round(strain / rate / 0.01)
    start -= start % 1000
    text = SUSPENSION_SCENE.format(rate=rate, count=SUSPENSIONS[density], forbidden=str(forbidden).lower(), start=start)
    return Run(f"c{density}-{rate:g}-{'tight' if forbidden else 'free'}", scene=text, steps=start + steps,
               hours=(start + steps) * (20480 * 2e-9 + SUSPENSIONS[density] * 32 * (120e-9 if forbidden else 30e-9)) / 3600.0)


def runs(tier):
    if tier == "quick":
        found = [chain(rate, 40000) for rate in CHAIN_RATES["quick"]] + [rod(None, 120000), rod("10", 120000)]
    else:
        found = [chain(rate, 600000) for rate in CHAIN_RATES["campaign"]]
        found += [rod(None, 4000000)] + [rod(peclet, 3000000) for peclet in ROD_RATES]
        found += [suspension(density, rate, forbidden, 40.0) for density in SUSPENSIONS for rate in SUSPENSION_RATES for forbidden in (True, False)]
        for run in found:
            run.goals, run.priority = ((run.steps // 4, 0),), 1  # all coarse before one is fine
    for number, run in enumerate(found):
        run.seed = {"quick": 500, "campaign": 600}[tier] + number
    return found


# --- what they say ----------------------------------------------------------------------------------------------------

def orientation(results, run, kind):
    """The row of a run's table, or None."""
    if run not in results or not f"orientation-{kind}" in results[run].tables():
        return None
    table = results[run].table(f"orientation-{kind}")
    return {name: float(column[0]) for name, column in table.items()}


def pair(row, name, scale=1.0):
    return scale * row[name], abs(scale) * row[name + "_error"]


def filled(verdict, value, systematic=0.0, error=0.0):
    if value is None or not math.isfinite(value[0] + value[1] + error):
        return verdict
    verdict.measured, verdict.error = float(value[0]), float(value[1])
    verdict.tolerance = stats.tolerance(math.hypot(verdict.error, error), systematic=systematic)
    return verdict


def chain_verdicts(results, rate):
    """Nothing is fitted: the friction is that of a vertex alone among phantoms."""
    name = f"chain-{rate:g}"
    drag = theory.friction(CHAIN["per_cell"], CHAIN["mass"], CHAIN["interval"])
    expected = theory.chain(CHAIN["vertices"], CHAIN["spring"], CHAIN["mass"], drag, rate)
    row, found = orientation(results, name, "chain"), []
    words = f"Gaussian chain of {CHAIN['vertices']}, rate {rate:g}, no hydrodynamics"
    for part, label in (("RxRx", "⟨R_x²⟩"), ("RyRy", "⟨R_y²⟩"), ("RxRy", "⟨R_x R_y⟩")):
        verdict = Verdict(f"fibers-flow.chain.{part}.{rate:g}", f"{label}, {words}", expected[part], "Rouse, with inertia; friction of a vertex among phantoms, exact", 0.0)
        found.append(filled(verdict, row and pair(row, part), systematic=0.01 * expected[part]))
    volume = CHAIN["box"]**3 / CHAIN["chains"]
    for part, column, label in (("stress", "sigma_xy_fibers", "σ_xy"), ("N1", "N1_fibers", "N1")):
        verdict = Verdict(f"fibers-flow.chain.{part}.{rate:g}", f"{label} per chain and volume, {words}", expected[part], "Rouse, as above", 0.0)
        value = None
        if name in results and "stress" in results[name].tables():
            value = tuple(volume * x for x in flow.stress(results[name], column))
        found.append(filled(verdict, value, systematic=0.01 * expected[part]))
    return found


def rotation(results):
    """(D_r, error) of the rod at rest: -ln C/2t, C(t) of the direction of the end-to-end vector, at lags from 50 to 100 t0."""
    if "rod-rest" not in results or not "dynamics-rod" in results["rod-rest"].tables():
        return None
    table = results["rod-rest"].table("dynamics-rod")
    inside = (table["time"] >= 50.0) & (table["time"] <= 100.0) & (table["end_to_end_unit"] > 0.0)
    if not inside.any():
        return None
    t, c, error = (table[name][inside] for name in ("time", "end_to_end_unit", "end_to_end_unit_error"))
    best = numpy.argmin(error / (c * t))
    return float(-math.log(c[best]) / (2.0 * t[best])), float(error[best] / (2.0 * c[best] * t[best]))


def rod_verdicts(results, peclet):
    """The orientation of a thin rod at Pe = rate/D_r with the D_r of the run at rest. 3 % for a rod that bends, has a width for the flow, and inertia."""
    rate, known, row = ROD_RATES[peclet], rotation(results), orientation(results, f"rod-{peclet}", "rod")
    found = []
    for part, label in (("uxux", "⟨u_x²⟩"), ("uyuy", "⟨u_y²⟩"), ("uxuy", "⟨u_x u_y⟩"), ("turning", "turns per rate")):
        verdict = Verdict(f"fibers-flow.rod.{part}.{peclet}", f"{label} of a stiff rod of 8 vertices, rate {rate:g}, Pe about {peclet}", theory.rod(float(peclet))[PART[part]],
                          "Fokker-Planck equation of a thin rod, D_r of the run at rest; 3 %", 0.0)
        if known and row:
            number = rate / known[0]
            value = theory.rod(number)[PART[part]]
            verdict.expected = value
            verdict.expected_error = abs(theory.rod(number * (1.0 + known[1] / known[0]))[PART[part]] - value)
            filled(verdict, pair(row, part, -1.0 / rate if part == "turning" else 1.0), systematic=0.03 * value, error=verdict.expected_error)
        found.append(verdict)
    return found


PART = {"uxux": "xx", "uyuy": "yy", "uxuy": "xy", "turning": "turning"}

# --- figures ----------------------------------------------------------------------------------------------------------

def suspension_points(results, density, forbidden, column):
    """Rates, and (mean, error) of a column of the stress at each."""
    found = []
    for rate in SUSPENSION_RATES:
        name = f"c{density}-{rate:g}-{'tight' if forbidden else 'free'}"
        if name in results and "stress" in results[name].tables():
            found.append((rate, *flow.stress(results[name], column)))
    return numpy.array(found).T if found else None


def draw_suspension(results):
    figure, panels = figures.plain(width=9.5, height=4.4, columns=2)
    number = 0
    for density in SUSPENSIONS:
        for forbidden in (True, False):
            label = f"cL³ = {density}, {'noncrossing' if forbidden else 'free'}"
            for panel, column, power in ((panels[0], "sigma_xy_fibers", 1), (panels[1], "N1_fibers", 2)):
                known = suspension_points(results, density, forbidden, column)
                if known is not None:
                    rate, value, error = known
                    figures.points(panel, rate, value / rate**power, error / rate**power, number=number, label=label)
            number += 1
    panels[0].set(xlabel="$\\dot\\gamma$ ($1/t_0$)", ylabel="$\\sigma_{xy}^{fib}/\\dot\\gamma$ ($m/a_0 t_0$)", xscale="log", yscale="log")
    panels[1].set(xlabel="$\\dot\\gamma$ ($1/t_0$)", ylabel="$N_1^{fib}/\\dot\\gamma^2$ ($m/a_0$)", xscale="log", yscale="log")
    figures.legend(panels[0])
    return figure


def draw_rods(results):
    figure, panel = figures.plain()
    grid = numpy.geomspace(0.3, 80.0, 40)
    moments = [theory.rod(float(x), 44 if x > 20 else 30) for x in grid]
    known = rotation(results)
    for number, (part, label) in enumerate((("uxux", "$u_x^2$"), ("uyuy", "$u_y^2$"), ("uxuy", "$u_x u_y$"))):
        figures.theory(panel, grid, [m[PART[part]] for m in moments], label="thin rod" if number == 0 else None)
        rows = [(ROD_RATES[pe] / known[0], orientation(results, f"rod-{pe}", "rod")) for pe in ROD_RATES]
        rows = [(x, *pair(row, part)) for x, row in rows if row]
        if rows:
            figures.points(panel, *numpy.array(rows).T, number=number, label=label)
    panel.set(xlabel="$\\dot\\gamma/D_r$", ylabel="mean", xscale="log")
    figures.legend(panel)
    return figure


def figures_of(results):
    found = []
    if rotation(results) and any(orientation(results, f"rod-{pe}", "rod") for pe in ROD_RATES):
        found.append(Figure("rods", "Orientation of a stiff rod in shear. Lines: the Fokker-Planck equation of a thin rod.", lambda: draw_rods(results)))
    if any(suspension_points(results, density, forbidden, "sigma_xy_fibers") is not None for density in SUSPENSIONS for forbidden in (True, False)):
        found.append(Figure("suspension", "Viscosity and first normal stress difference of the fibers of a suspension, over rate and rate squared, noncrossing and free.",
                            lambda: draw_suspension(results)))
    return found


def prose(results):
    lines = []
    known = rotation(results)
    if known:
        lines.append(f"D_r of the rod at rest: {known[0]:.5f} ± {known[1]:.5f} per t0.")
    for density in SUSPENSIONS:
        for forbidden in (True, False):
            points = suspension_points(results, density, forbidden, "sigma_xy_fibers")
            for rate, value, error in points.T if points is not None else ():
                if math.isfinite(value + error):
                    lines.append(f"cL³ {density}, {'noncrossing' if forbidden else 'free'}, rate {rate:g}: η of the fibers {value / rate:.2f} ± {error / rate:.2f}.")
    return " ".join(lines) or "No run yet."


def evaluate(results, tier):
    verdicts = [verdict for rate in CHAIN_RATES[tier] for verdict in chain_verdicts(results, rate)]
    verdicts += [verdict for peclet in (("10",) if tier == "quick" else ROD_RATES) for verdict in rod_verdicts(results, peclet)]
    return Outcome(verdicts, figures_of(results), prose(results))
