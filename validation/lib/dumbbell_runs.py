"""The scenes of case `dumbbells`: sheared boxes, steady and oscillating, and walls. evaluate() in case.py reads what they wrote."""
import math

from lib.runs import Run

N, DT = 10, 0.02
RULES = {"srd": "thermostat: rescale-layers", "at-a": "thermostat: none", "at+a": "thermostat: none"}
COST = {"srd": 60e-9, "at-a": 80e-9, "at+a": 130e-9}  # s per particle and collision
SIDE = 16  # of a sheared box, a0
RATES = {0.3: 0.015, 0.5: 0.025, 1: 0.05, 2: 0.1, 5: 0.2, 10: 0.2, 20: 0.2, 1000: 0.1}  # 1/t0 by spring: a Weissenberg number near 1 or below
PERIODS = {"fifth": 33500, "slow": 6280, "unit": 5720, "double": 2860, "fast": 1570, "fivefold": 1140}  # of an oscillation, in collision intervals
ROWS = {"fifth": 335, "slow": 157, "unit": 143, "double": 143, "fast": 157, "fivefold": 57}  # of the stress: a divisor of each
SPEED = {10: 0.25, 20: 0.4, 40: 0.4}  # a0/t0 of sliding walls, by their distance
POTENTIAL = (0.95, 1.2)  # depth in kT, range in sqrt(kT/K): the flattest density
FORCE = 0.02  # a0/t0^2
STILL_DT = 0.2  # densities do not depend on dt, and settle faster


def relaxation(spring, dt=DT):
    """1/omega_H in molecular chaos, AT-a, t0."""
    partners = N - 1.0 + math.exp(-N)
    return 1.0 / (4.0 * spring * dt * (N / partners - 0.5))


SCENE = """box: [{box}]
dimensions: 2
time_step: {dt}
solvent: {{per_cell: {n}, collision_interval: {dt}, rule: {rule}, {thermostat}{force}}}
dumbbells: {{spring: {spring}{potential}{fraction}}}
{boundary}
observe: {{from: {start}, profile: {{every: {sample}, slabs: {slabs}}}, stress: {{every: {rows}}}, dumbbells: {{every: {sample}}}}}
"""


def make(name, spring, boundary, steps, transient, box=(SIDE, SIDE), rule="at-a", dt=DT, potential=False, force=0.0, rows=None, slabs=None,
         sample=None, fraction=1.0):
    start = round(transient / dt)
    rows = rows or max(1, steps // 128)
    start += -start % rows
    text = SCENE.format(box=f"{box[0]}, {box[1]}, 1", dt=dt, n=N, rule=rule, thermostat=RULES[rule], force=f", acceleration: [{force}, 0, 0]" if force else "",
                        spring=spring, potential=f", depth: {POTENTIAL[0]}, range: {POTENTIAL[1]}" if potential else "",
                        fraction=f", fraction: {fraction}" if fraction < 1.0 else "", boundary=boundary,
                        start=start, sample=sample or round(0.5 / dt), slabs=slabs or box[1], rows=rows)
    return Run(name, scene=text, steps=steps, hours=steps * box[0] * box[1] * N * COST[rule] / 3600.0)


def key(rule):
    return rule.replace("+", "p")


def sheared(spring, steps, rule="at-a", dt=DT, rate=None, name=None):
    """Without the first five relaxation times."""
    rate = rate or RATES[spring]
    return make(name or f"shear-K{spring:g}-{key(rule)}" + (f"-dt{dt:g}" if dt != DT else ""), spring, f"shear: {{rate: {rate}}}", steps,
                5.0 * relaxation(spring, dt), rule=rule, dt=dt)


def mixed(fraction, steps):
    """K = 1; the other particles are points."""
    return make(f"mixed-K1-{fraction:g}", 1, f"shear: {{rate: {RATES[1]}}}", steps, 5.0 * relaxation(1), fraction=fraction)


def weissenberg(number, steps):
    """K = 1 at this Weissenberg number of molecular chaos."""
    rate = number / relaxation(1)
    return sheared(1, steps, rate=round(rate, 6), name=f"wi-{number:g}")


def oscillating(word, periods, spring=1):
    """Strain 1; without the first period, or five relaxation times."""
    length = PERIODS[word]
    first = max(1, math.ceil(5.0 * relaxation(spring) / (length * DT)))
    return make(f"oscillation-K{spring:g}-{word}", spring, f"shear: {{strain: 1, period: {round(length * DT, 6)}}}", (periods + first) * length,
                first * length * DT, rows=ROWS[word])


def walls(length, steps, potential=False, spring=1):
    transient = 5.0 * relaxation(spring) + length**2 / 20.0
    return make(f"walls-K{spring:g}-L{length}" + ("-flat" if potential else ""), spring,
                f"walls: {{kind: no-slip, shear_rate: {2.0 * SPEED[length] / length}}}", steps, transient, box=(SIDE, length), potential=potential,
                slabs=2 * length)


def oscillating_walls(word, length, periods, spring=1):
    first = max(1, math.ceil((5.0 * relaxation(spring) + length**2 / 20.0) / (PERIODS[word] * DT)))
    return make(f"wave-K{spring:g}-L{length}-{word}", spring, f"walls: {{kind: no-slip, shear_rate: {2.0 * SPEED[length] / length}, period: "
                f"{round(PERIODS[word] * DT, 6)}}}", (periods + first) * PERIODS[word], first * PERIODS[word] * DT, box=(SIDE, length), rows=ROWS[word],
                slabs=2 * length, sample=ROWS[word] // (3 if ROWS[word] % 3 == 0 else 11 if ROWS[word] % 11 == 0 else 1))


def still(steps, potential=False):
    return make("still-" + ("flat" if potential else "bare"), 1, "walls: {kind: no-slip}", steps, 60.0, box=(20, 10), dt=STILL_DT, potential=potential,
                slabs=40, sample=5)


def poiseuille(steps):
    return make("poiseuille-K1", 1, "walls: {kind: no-slip}", steps, 250.0, box=(SIDE, 20), potential=True, force=FORCE, slabs=40)


QUICK_PLACES = (1, 2, 3, 4, 5, 7, 8, 9, 10, 11)


def quick():
    return [sheared(1, 30000), sheared(5, 15000), sheared(1, 20000, rule="srd"), sheared(1, 15000, rule="at+a"),
            sheared(1, 15000, dt=0.04), oscillating("fast", 16), walls(20, 25000), walls(20, 25000, potential=True),
            still(20000), still(20000, potential=True)]


def campaign():
    found = [sheared(spring, {0.3: 400000, 0.5: 300000, 1: 400000}.get(spring, 150000)) for spring in RATES]
    found += [sheared(1, 200000, rule=rule) for rule in ("srd", "at+a")]
    found += [sheared(1, steps, dt=dt) for dt, steps in ((0.01, 300000), (0.04, 100000), (0.1, 50000))]
    found += [weissenberg(number, 150000) for number in (0.3, 2, 5, 10)]
    found += [oscillating(word, periods) for word, periods in
              (("fifth", 10), ("slow", 48), ("unit", 48), ("double", 64), ("fast", 96), ("fivefold", 96))]
    found += [oscillating(word, periods, spring=5) for word, periods in (("fast", 64), ("fivefold", 96))]
    found += [walls(length, 300000) for length in (10, 20, 40)] + [walls(20, 300000, potential=True)]
    found += [oscillating_walls(word, length, periods) for word, length, periods in (("slow", 10, 32), ("slow", 20, 32), ("fast", 20, 64))]
    found += [still(200000), still(200000, potential=True), poiseuille(300000), mixed(0.5, 100000)]
    for run in found:
        run.goals, run.priority = ((run.steps // 4, 0),), 1  # all coarse before one is fine
    return found


def runs(tier):
    """Seeds were chosen before the first run: those of the run's place in this list, as it was then."""
    found = {"quick": quick, "campaign": campaign}[tier]()
    for number, run in zip(QUICK_PLACES if tier == "quick" else range(len(found)), found, strict=True):
        run.seed = {"quick": 300, "campaign": 400}[tier] + number
    return found
