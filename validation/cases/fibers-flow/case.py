"""Fibers in shear: a Gaussian chain against Rouse, a stiff rod against the Fokker-Planck equation of a thin one, and noncrossing suspensions."""
import math

import numpy

from lib import fiber_flow as theory
from lib import figures, flow, stats
from lib.case import Figure, Outcome, Verdict, again
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
CHAIN_RATES = {"campaign": (0.003, 0.006, 0.01), "quick": (0.01,)}

ROD_SCENE = """box: [12, 12, 12]
time_step: 0.01
solvent: {{per_cell: 5, collision_interval: 0.02, rule: {rule}}}
{shear}
fibers:
  - {{name: rod, count: 16, vertices: 8, mass: 5, bond_length: 0.5, spring: 400, bending: 100}}
crossing: {{forbidden: false}}
observe: {{from: 30000, {observers}}}
"""
ROD_RATES = {"1": 0.00124, "10": 0.0124, "50": 0.062}  # 1/t0, by the Peclet number that is aimed at; at-a
ROD_RATES_PLUS = {"10": 0.028, "50": 0.14}  # the same for at+a

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
SUSPENSION_RATES = (0.003, 0.01, 0.03, 0.1, 0.3)  # 1/t0
REST_SCENE = """box: [16, 16, 16]
time_step: 0.01
solvent: {per_cell: 5, collision_interval: 0.1, rule: at-a}
fibers:
  - {name: fiber, count: 110, vertices: 32, mass: 5, bond_length: 0.5, spring: 100, persistence_length: 32}
crossing: {forbidden: false}
observe: {dynamics: {every: 100, longest_lag: 100000}}
"""


DOUBTED = ("rod-10", "rod-rest-plus", "rod-10-plus", "rod-50-plus")  # by ⟨u_y²⟩ at Pe 10, and by the spin of AT+a


def chain(rate, steps):
    text = CHAIN_SCENE.format(rate=rate, **CHAIN)
    return Run(f"chain-{rate:g}", scene=text, steps=steps, hours=steps * 1200 * 300e-9 / 3600.0)


def rod(peclet, steps, rule="at-a"):
    plus = rule == "at+a"
    shear = f"shear: {{rate: {(ROD_RATES_PLUS if plus else ROD_RATES)[peclet]}}}" if peclet else ""
    observers = "orientation: {every: 20}" if peclet else "orientation: {every: 50}, dynamics: {every: 100, longest_lag: 100000}"
    return Run(f"rod-{peclet or 'rest'}{'-plus' if plus else ''}", scene=ROD_SCENE.format(shear=shear, observers=observers, rule=rule), steps=steps,
               hours=steps * (350e-6 if plus else 150e-6) / 3600.0)


def suspension(density, rate, forbidden, strain):
    """Without the first part, in which fibers turn into the flow: a strain of 10, or 200 t0."""
    start, steps = round(max(10.0 / rate, 200.0) / 0.01), round(strain / rate / 0.01)
    start -= start % 1000
    text = SUSPENSION_SCENE.format(rate=rate, count=SUSPENSIONS[density], forbidden=str(forbidden).lower(), start=start)
    return Run(f"c{density}-{rate:g}-{'tight' if forbidden else 'free'}", scene=text, steps=start + steps,
               hours=(start + steps) * (20480 * 2e-9 + SUSPENSIONS[density] * 32 * (120e-9 if forbidden else 30e-9)) / 3600.0)


def runs(tier):
    if tier == "quick":
        found = [chain(rate, 40000) for rate in CHAIN_RATES["quick"]] + [rod(None, 120000), rod("50", 180000)]
    else:
        found = [chain(rate, 600000) for rate in CHAIN_RATES["campaign"]]
        found += [rod(None, 4000000)] + [rod(peclet, 3000000) for peclet in ROD_RATES]
        found += [suspension(density, rate, forbidden, 40.0) for density in SUSPENSIONS for rate in SUSPENSION_RATES[1:] for forbidden in (True, False)]
        found += [Run("rest-free", scene=REST_SCENE, steps=1000000, hours=1000000 * 150e-6 / 3600.0)]
        found += [suspension(density, SUSPENSION_RATES[0], forbidden, 40.0) for density in SUSPENSIONS for forbidden in (True, False)]
        found += [rod(None, 3000000, "at+a")] + [rod(peclet, 3000000, "at+a") for peclet in ROD_RATES_PLUS]
        for run in found:
            first = int(run.scene.split("{from: ")[1].split(",")[0]) if "{from: " in run.scene else 0
            run.goals, run.priority = ((first + (run.steps - first) // 4, 0),), 1  # all coarse before one is fine
    for number, run in enumerate(found):
        run.seed = {"quick": 500, "campaign": 600}[tier] + number
    return found + [again(run, 700 + number) for number, run in enumerate(found) if tier == "campaign" and run.name in DOUBTED]


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
    verdict.measured, verdict.error = value[0], float(value[1])
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


def rotation(results, run="rod-rest", kind="rod", first=50.0, last=100.0):
    """(D_r, error) of fibers at rest: -ln C/2t, C(t) of the direction of the end-to-end vector, at the best lag between two."""
    if run not in results or not f"dynamics-{kind}" in results[run].tables():
        return None
    table = results[run].table(f"dynamics-{kind}")
    inside = (table["time"] >= first) & (table["time"] <= last) & (table["end_to_end_unit"] > 0.0)
    if not inside.any():
        return None
    t, c, error = (table[name][inside] for name in ("time", "end_to_end_unit", "end_to_end_unit_error"))
    best = numpy.argmin(error / (c * t))
    return float(-math.log(c[best]) / (2.0 * t[best])), float(error[best] / (2.0 * c[best] * t[best]))


MOMENTS = (("uxux", "xx", "⟨u_x²⟩"), ("uyuy", "yy", "⟨u_y²⟩"), ("uxuy", "xy", "⟨u_x u_y⟩"), ("turning", "turning", "turns per rate"))
NAMES = {"at-a": "MPC-AT-a", "at+a": "MPC-AT+a"}
THICK = "A rod of 3.5 a0 is not thin in a fluid whose cells are 1 a0 wide: shape and spin say by how much."
NO_SPIN = "MPC-AT-a does not conserve angular momentum. Its stress has an antisymmetric part, which exerts a torque on a body that rotates with the fluid (Götze, Noguchi and Gompper 2007)."


def rod_rates(rule):
    return ROD_RATES_PLUS if rule == "at+a" else ROD_RATES


def rod_moments(results, peclet, rule):
    """{moment: (value, error)} of a run, or None."""
    row = orientation(results, f"rod-{peclet}{'-plus' if rule == 'at+a' else ''}", "rod")
    return row and {moment: pair(row, column, -1.0 / rod_rates(rule)[peclet] if column == "turning" else 1.0) for column, moment, _ in MOMENTS}


def rod_rotation(results, rule):
    return rotation(results, "rod-rest-plus" if rule == "at+a" else "rod-rest")


def rod_verdicts(results, peclet, rule, kind="paper", moments_of=MOMENTS, allowed=0.03):
    """The orientation of a thin rod at Pe = rate/D_r with the D_r of the run at rest. 3 % for a rod that bends, and has inertia."""
    rate, known, moments = rod_rates(rule)[peclet], rod_rotation(results, rule), rod_moments(results, peclet, rule)
    found = []
    for column, moment, label in moments_of:
        verdict = Verdict(f"fibers-flow.rod.{column}.{peclet}.{rule}", f"{label} of a stiff rod of 8 vertices, rate {rate:g}, Pe about {peclet}, {NAMES[rule]}",
                          theory.rod(float(peclet))[moment], f"Fokker-Planck equation of a thin rod, D_r of the run at rest; {100 * allowed:.0f} %", 0.0, kind=kind, reason=THICK if kind == "paper" else "")
        if known and moments:
            number = rate / known[0]
            value = theory.rod(number)[moment]
            verdict.expected = value
            verdict.expected_error = abs(theory.rod(number * (1.0 + known[1] / known[0]))[moment] - value)
            filled(verdict, moments[moment], systematic=allowed * value, error=verdict.expected_error)
        found.append(verdict)
    return found


def rod_fit(results, rule):
    known = rod_rotation(results, rule)
    measured = {rate: rod_moments(results, peclet, rule) for peclet, rate in rod_rates(rule).items()}
    measured = {rate: moments for rate, moments in measured.items() if moments and all(error > 0 for _, error in moments.values())}
    return theory.rod_fit(known, tuple((rate, tuple(moments.items())) for rate, moments in measured.items())) if known and measured else None


def jeffery_verdicts(results):
    """What all moments of a rule say together: u' = w W u + B (E u - (u E u) u)."""
    found = []
    for rule in NAMES:
        fit = rod_fit(results, rule)
        spin = Verdict(f"fibers-flow.rod.spin.{rule}", f"w, share of the flow's rotation that a rod follows, {NAMES[rule]}", 1.0, "no torque on a body that rotates with the fluid", 0.0,
                       kind="gate" if rule == "at+a" else "paper", reason="" if rule == "at+a" else NO_SPIN)
        shape = Verdict(f"fibers-flow.rod.shape.{rule}", f"B, share of the flow's strain that a rod follows, {NAMES[rule]}", 1.0, "thin rod", 0.0, kind="paper",
                        reason="The rod is as thick as the cells, for the flow: a spheroid of the same B has the aspect ratio √((1 + B)/(1 − B)).")
        found += [filled(spin, fit and fit[0]), filled(shape, fit and fit[1])]
    return found


# --- figures ----------------------------------------------------------------------------------------------------------

def relaxation(results):
    """tau, t0: in which free fibers of a suspension at rest forget their direction, 1/(2 D_r). The Weissenberg number is rate tau."""
    known = rotation(results, "rest-free", "fiber", 100.0, 1000.0)
    return known and 0.5 / known[0]


def of_stress(column, power):
    def read(result, rate):
        value, error = flow.stress(result, column)
        return value / rate**power, error / rate**power
    return read, "stress"


def of_orientation(column):
    def read(result, _):
        table = result.table("orientation-fiber")
        return float(table[column][0]), float(table[column + "_error"][0])
    return read, "orientation-fiber"


def contacts_over_theory(result, _):
    """Contacts over those of kinetic theory for bonds in all directions, after the first part; the error is that of a tenth of the run each."""
    table = result.table("collisions")
    rows = table["rate_over_theory"][1 + len(table["time"]) // 4:]
    parts = [part.mean() for part in numpy.array_split(rows, 10) if len(part)]
    return stats.judged(float(numpy.mean(parts)), rows), float(numpy.std(parts, ddof=1) / math.sqrt(len(parts)))


# What is drawn of suspensions: (what is read, its table), label, logarithmic, only where fibers cannot cross
SUSPENSION_PANELS = (
    (of_stress("sigma_xy_fibers", 1), "$\\eta_f=\\sigma_{xy}^{f}/\\dot\\gamma$ ($m/a_0 t_0$)", True, False),
    (of_stress("N1_fibers", 2), "$\\Psi_1^{f}=N_1^{f}/\\dot\\gamma^2$ ($m/a_0$)", True, False),
    (of_orientation("uxux"), "$\\langle u_x^2\\rangle$ of end-to-end vectors", False, False),
    ((contacts_over_theory, "collisions"), "contacts over kinetic theory at rest", False, True),
)


def suspension_points(results, density, forbidden, quantity):
    """[3][n] rates, means and errors of what is there; the error covers what an average changed between the halves of its run."""
    read, table = quantity
    found = []
    for rate in SUSPENSION_RATES:
        name = f"c{density}-{rate:g}-{'tight' if forbidden else 'free'}"
        if name in results and table in results[name].tables():
            value, error = read(results[name], rate)
            if math.isfinite(value) and math.isfinite(error):
                found.append((rate, value, stats.error_that_covers(value, error)))
    return numpy.array(found).reshape(-1, 3).T


def draw_suspension(results):
    tau = relaxation(results)
    figure, panels = figures.plain(9.5, 7.4, columns=2, rows=2)
    for panel, (quantity, label, logarithmic, only_tight) in zip(panels.flat, SUSPENSION_PANELS):
        number = 0
        for density in SUSPENSIONS:
            for forbidden in (True, False):
                rate, value, error = suspension_points(results, density, forbidden, quantity)
                if len(rate) and (forbidden or not only_tight):
                    figures.points(panel, rate * (tau or 1.0), value, error, number=number, label=f"cL³ = {density}, {'noncrossing' if forbidden else 'free'}")
                number += 1
        panel.set(xlabel="$\\mathrm{Wi}=\\dot\\gamma\\tau$" if tau else "$\\dot\\gamma$ ($1/t_0$)", ylabel=label, xscale="log", yscale="log" if logarithmic else "linear")
    figures.legend(panels[0][0])
    return figure


def draw_rods(results):
    figure, panels = figures.plain(9.5, 4.2, columns=2)
    grid = numpy.geomspace(0.5, 80.0, 14)
    thin = [theory.rod(float(x), 44 if x > 20 else 30) for x in grid]
    fits = {rule: rod_fit(results, rule) for rule in NAMES}
    number = 0
    for panel, moments, label in ((panels[0], MOMENTS[:3], "mean"), (panels[1], MOMENTS[3:], "rotation per $\\dot\\gamma$")):
        for _, moment, _ in moments:
            figures.theory(panel, grid, [m[moment] for m in thin], label="thin rod" if moment in ("xx", "turning") else None)
            for rule in NAMES:
                known = rod_rotation(results, rule)
                rows = [(rate / known[0], rod_moments(results, peclet, rule)) for peclet, rate in rod_rates(rule).items()] if known else []
                rows = [(x, *m[moment]) for x, m in rows if m]
                if rows:
                    name = {"xx": "$\\langle u_x^2\\rangle$", "yy": "$\\langle u_y^2\\rangle$", "xy": "$\\langle u_x u_y\\rangle$", "turning": "turning"}[moment]
                    figures.points(panel, *numpy.array(rows).T, number=number, label=f"{name}, {NAMES[rule]}")
                if fits[rule]:
                    (spin, _), (shape, _), _, _ = fits[rule]
                    panel.plot(grid, [theory.rod(float(x), 44 if x > 20 else 30, spin, shape)[moment] for x in grid], color=figures.COLORS[number % len(figures.COLORS)], linewidth=0.9, linestyle=":")
                number += 1
        panel.set(xlabel="$\\mathrm{Pe}=\\dot\\gamma/D_r$", ylabel=label, xscale="log")
        figures.legend(panel, fontsize=7.5)
    return figure


def figures_of(results):
    found = []
    if any(f"rod-{pe}{suffix}" in results for pe in ROD_RATES for suffix in ("", "-plus")):
        found.append(Figure("rods", "Orientation of a stiff rod in shear, and how fast it turns. Lines: the Fokker-Planck equation of a thin rod; dotted: with the spin w and the shape B that fit each rule.", lambda: draw_rods(results)))
    if any(suspension_points(results, density, forbidden, SUSPENSION_PANELS[0][0]).size for density in SUSPENSIONS for forbidden in (True, False)):
        found.append(Figure("suspension", "Suspensions of fibers of 32 vertices in steady shear, noncrossing and free: viscosity and first normal stress coefficient of the fibers, their orientation, and contacts of bonds. Bars of stresses and contacts: half of what an average changes between the halves of its run, where that is more than its error and no chance.",
                            lambda: draw_suspension(results)))
    return found


def prose(results):
    lines = []
    for rule in NAMES:
        known, fit = rod_rotation(results, rule), rod_fit(results, rule)
        if known:
            lines.append(f"D_r of the rod at rest, {NAMES[rule]}: {known[0]:.5f} ± {known[1]:.5f} per t0.")
        if fit:
            (spin, spin_error), (shape, shape_error), chi2, free = fit
            lines.append(f"Rods, {NAMES[rule]}: w {spin:.3f} ± {spin_error:.3f}, B {shape:.3f} ± {shape_error:.3f}, χ² {chi2:.1f} of {free}.")
    tau = relaxation(results)
    if tau:
        lines.append(f"Free fibers at rest forget their direction in τ = {tau:.0f} t0.")
    for density in SUSPENSIONS:
        for forbidden in (True, False):
            for rate, value, error in suspension_points(results, density, forbidden, SUSPENSION_PANELS[0][0]).T:
                lines.append(f"cL³ {density}, {'noncrossing' if forbidden else 'free'}, rate {rate:g}: η of the fibers {value:.2f} ± {error:.2f}.")
    return " ".join(lines) or "No run yet."


def evaluate(results, tier):
    verdicts = [verdict for rate in CHAIN_RATES[tier] for verdict in chain_verdicts(results, rate)]
    if tier == "quick":
        verdicts += rod_verdicts(results, "50", "at-a", kind="gate", moments_of=MOMENTS[3:], allowed=0.15)  # a rod that is as thick as a cell
    else:
        verdicts += [verdict for rule in NAMES for peclet in rod_rates(rule) for verdict in rod_verdicts(results, peclet, rule)] + jeffery_verdicts(results)
    return Outcome(verdicts, figures_of(results), prose(results))
