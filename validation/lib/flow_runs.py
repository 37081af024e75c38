"""The scenes of case `flow`: sheared boxes, walls, and forces with a profile. evaluate() in case.py reads what they wrote."""
import collections

from lib.runs import Run

Point = collections.namedtuple("Point", "d n dt")
POINTS = {"2d-n10": Point(2, 10, 0.02), "2d-n3": Point(2, 3, 0.02), "3d-n5": Point(3, 5, 0.1), "3d-n10": Point(3, 10, 0.02)}
THERMOSTATS = {"srd": "thermostat: rescale-layers", "at-a": "thermostat: none", "at+a": "thermostat: none"}
RULES = tuple(THERMOSTATS)
RATE = 0.08  # 1/t0, of sheared boxes
SIDE = {2: 20, 3: 10}  # of a sheared box, a0
SPEED = 0.5  # a0/t0, of walls: Mach number 0.5
PERIODS = {"slow": 60, "fast": 30}  # t0
HEAT_POINT = Point(2, 10, 0.1)
HEAT_RATE, HEAT_ACCELERATION = 0.06, 0.02

SCENE = """box: [{box}]
dimensions: {point.d}
time_step: {point.dt}
solvent: {{per_cell: {point.n}, collision_interval: {point.dt}, rule: {rule}, {thermostat}{force}}}
{boundary}observe: {{from: {start}, profile: {{every: {sample}, slabs: {slabs}}}, stress: {{every: {every}}}}}
"""
COST = {"srd": 50e-9, "at-a": 75e-9, "at+a": 125e-9}  # s per particle and collision


def make(name, point, rule, box, steps, transient, boundary="", force="", seed=1, thermostat=None):
    """A run of `steps`, the first `transient` t0 of which are in no average. Its stress has some 128 rows."""
    start = round(transient / point.dt)
    rows = max(1, steps // 128)
    volume = box[0] * box[1] * box[2]
    text = SCENE.format(box=", ".join(map(str, box)), point=point, rule=rule, thermostat=thermostat or THERMOSTATS[rule], force=force,
                        boundary=boundary + "\n" if boundary else "", start=start, sample=round(0.5 / point.dt), slabs=2 * box[1] if
                        box[1] <= 10 else box[1], every=rows)
    return Run(name, scene=text, steps=steps, seed=seed, hours=steps * volume * point.n * COST[rule] / 3600.0)


def acceleration(g, profile=""):
    return f", acceleration: [{g}, 0, 0]" + (f", profile: {profile}" if profile else "")


def square(d, length, width=None):
    return (width or length, length, 1) if d == 2 else (width or length, length, width or length)


def sheared(name, rule, steps, rate=RATE, suffix=""):
    point = POINTS[name]
    return make(f"shear-{name}-{rule}{suffix}".replace("+", "p"), point, rule, square(point.d, SIDE[point.d]), steps, 20.0, f"shear: {{rate: {rate}}}")


def couette(name, rule, length, fill, steps, transient):
    return make(f"couette-{name}", POINTS["2d-n10"], rule, (20, length, 1), steps, transient,
                f"walls: {{kind: no-slip, fill: {fill}, shear_rate: {2.0 * SPEED / length}}}")


def poiseuille(name, g, box, steps, transient):
    return make(f"poiseuille-{name}", POINTS[name], "at-a", box, steps, transient, "walls: {kind: no-slip}", acceleration(g))


def profiled(name, rule, kind, g, length, steps, transient):
    point = POINTS[name]
    word = {"kolmogorov": "sine", "reverse": "reverse"}[kind]
    return make(f"{kind}-{name}-{rule}".replace("+", "p"), point, rule, square(point.d, length), steps, transient,
                force=acceleration(g, word))


def oscillating(name, periods):
    """The first three periods are left out."""
    point, period = POINTS["2d-n10"], PERIODS[name]
    return make(f"oscillation-{name}", point, "at-a", (20, 20, 1), round((periods + 3) * period / point.dt), 3.0 * period,
                f"walls: {{kind: no-slip, shear_rate: {2.0 * SPEED / 20}, period: {period}}}")


def heated(name, steps):
    boundary = "walls: {kind: no-slip" + (f", shear_rate: {HEAT_RATE}}}" if name == "couette" else "}")
    force = "" if name == "couette" else acceleration(HEAT_ACCELERATION)
    return make(f"heat-{name}", HEAT_POINT, "srd", (20, 10, 1), steps, 400.0, boundary, force, thermostat="thermostat: none")


# Of sheared boxes in two dimensions; MPC-AT+a is sheared in three, in a third of the time.
QUICK_RULES = ("srd", "at-a")
QUICK_PLACES = (0, 1, 3, 4, 5, 6, 7, 9, 10, 11, 12)


def quick():
    return [sheared("2d-n10", rule, 40000) for rule in QUICK_RULES] + [sheared("3d-n5", rule, 10000) for rule in RULES] + [
        sheared("2d-n3", "at-a", 40000),
        couette("planar-L10", "srd", 10, "planar", 150000, 15.0), couette("none-L20", "srd", 20, "none", 30000, 200.0),
        poiseuille("2d-n10", 0.03, (20, 20, 1), 60000, 60.0),
        profiled("2d-n10", "at-a", "kolmogorov", 0.15, 20, 40000, 15.0),
        oscillating("fast", 30)]


def campaign():
    found = [sheared(name, rule, {"2d-n10": 160000, "2d-n3": 240000, "3d-n5": 50000, "3d-n10": 30000}[name])
             for name in POINTS for rule in RULES]
    found += [sheared("2d-n10", "at-a", 240000, 0.04, "-slow"), sheared("2d-n10", "at-a", 60000, 0.16, "-fast")]
    found += [couette(f"{fill}-L10", "srd", 10, fill, 600000, 15.0) for fill in ("planar", "paper")]
    found += [couette(f"{fill}-L20", "srd", 20, fill, 600000, 60.0) for fill in ("planar", "paper")]
    found += [couette("none-L20", "srd", 20, "none", 200000, 200.0), couette("planar-L20-at-a", "at-a", 20, "planar", 320000, 60.0)]
    found += [poiseuille("2d-n10", 0.03, (20, 20, 1), 400000, 60.0), poiseuille("3d-n5", 0.01, (6, 16, 6), 200000, 200.0)]
    found += [profiled("2d-n10", rule, "kolmogorov", g, 20, 200000, 40.0) for rule, g in zip(RULES, (0.15, 0.15, 0.07))]
    found += [profiled("2d-n3", rule, "kolmogorov", g, 20, 200000, 50.0) for rule, g in zip(RULES, (0.1, 0.1, 0.025))]
    found += [profiled("3d-n5", "at+a", "kolmogorov", 0.02, 10, 60000, 50.0), profiled("3d-n10", "at+a", "kolmogorov", 0.25, 10, 30000, 10.0)]
    found += [profiled("2d-n10", "at-a", "reverse", 0.12, 20, 160000, 20.0)]
    found += [oscillating("slow", 48), oscillating("fast", 96), heated("couette", 400000), heated("poiseuille", 400000)]
    for run in found:
        run.goals, run.priority = ((run.steps // 4, 0),), 1  # all coarse before one is fine
    found.append(Run("stress-3d-n5-atpa", hours=0.035, priority=1, program=["green_kubo", 8, 5, 0.1, "at+a", 40, 400000, 23]))
    return found


def runs(tier):
    """Seeds were chosen before the first run: those of the run's place in this list, as it was then."""
    found = {"quick": quick, "campaign": campaign}[tier]()
    for number, run in zip(QUICK_PLACES if tier == "quick" else range(len(found)), found, strict=True):
        if run.scene:
            run.seed = {"quick": 100, "campaign": 200}[tier] + number
    return found
