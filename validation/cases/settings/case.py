"""Run time against error: CPU time to 1 % of six quantities, by time step, collision rule, thermostat and medium."""
import dataclasses
import functools
import math

import numpy

from lib import figures, flow, stats
from lib.case import Figure, Outcome, Verdict
from lib.flow_runs import Point
from lib.media import at, fill, mean_of
from lib.runs import Run

TITLE = "Run time against error, by time step, rule, thermostat and medium"
PAPER = "not in the paper"
APART = True  # times count only beside each other: `make bench-error`

GOAL = 0.01  # statistical error; and what is more off than this is never known to it
ALIKE = 1.25  # times of a shared machine are told apart from here on
CHAOS = 0.08  # molecular chaos is off by some per cent
PAIRS = {0.02: 160, 0.05: 320, 0.1: 400}  # of shear waves; at+a has a quarter
SKIP = {0.02: 25, 0.05: 20, 0.1: 20}  # collisions
NEW = (("srd", 0.05), ("at-a", 0.02), ("at-a", 0.05), ("at+a", 0.02), ("at+a", 0.05))  # points that no other case holds against theory
NAMES = {"srd": "SRD", "at-a": "AT-a", "at+a": "AT+a"}
TUBE_FIBERS, TUBE_LAG = 427, 50.0  # cL^3 = 300 in 36^3, as in case `rivals`


@dataclasses.dataclass(frozen=True)
class Setting:
    """A run, and what it is compared with. Settings of one `family` have one answer: that of the first of them, or `exact`."""
    quantity: str
    family: str
    series: str  # its line in the figure
    step: float  # t0: between collisions if the fluid has them, else dt
    words: str   # how it differs from the others of its family
    run: Run
    from_time: float = 0.0  # t0 left out

    @property
    def way(self):
        """How it is measured: what settings must share to have one variance."""
        return self.words.partition(",")[0] if self.quantity == "viscosity" else ""


# --- scenes -----------------------------------------------------------------------------------------------------------

def scene(box, step, observe, parts, order="kick-split"):
    return f"box: [{box}, {box}, {box}]\ntime_step: {step:g}\norder: {order}\n" + "\n".join(parts) + f"\nobserve: {{{observe}}}\n"


def solvent(interval, rule="srd", thermostat="none", more=""):
    return f"solvent: {{per_cell: 5, collision_interval: {interval:g}, rule: {rule}, thermostat: {thermostat}{more}}}"


def steps_of(time, step):
    return round(time / step)


def sampled(time, step):
    """`every` of an observable."""
    every = round(time / step)
    if abs(every * step - time) > 1e-9 * time:
        raise ValueError(f"{time} t0 is no number of steps of {step}")
    return every


def fibers(count, vertices, mass, spring):
    bonds = f"bond_length: 0, spring: {spring:g}" if vertices > 1 else "bond_length: 1, spring: 1"
    return f"crossing: {{forbidden: false}}\nfibers: [{{name: body, count: {count}, vertices: {vertices}, mass: {mass:g}, {bonds}}}]"


def named(quantity, series, step):
    return f"{quantity}-{series}-{step:g}".lower().replace(" ", "-").replace("+", "p").replace(",", "")


@dataclasses.dataclass(frozen=True)
class Body:
    """Loose vertices or chains whose D is measured: D_cumulative at `lag` t0."""
    quantity: str
    box: int
    count: int
    vertices: int
    mass: float
    spring: float
    lag: float
    order: str = "kick-split"

    def setting(self, family, series, words, medium, step, time, seconds, interval=None):
        sample = self.lag / 16.0
        observe = f"from: {steps_of(self.lag, step)}, dynamics: {{every: {sampled(sample, step)}, longest_lag: {sampled(self.lag, step)}}}"
        return Setting(self.quantity, family, series, interval or step, words, Run(
            named(self.quantity, series, step), scene=scene(self.box, step, observe, (medium, fibers(self.count, self.vertices, self.mass, self.spring)), self.order), steps=steps_of(time, step),
            seed=11, hours=seconds / 3600.0), from_time=self.lag)


VERTEX = Body("vertex", 8, 32, 1, 5.0, 1.0, 12.8)
CHAIN = Body("chain", 8, 8, 10, 5.0, 3.0, 25.6)
LOWE = dataclasses.replace(CHAIN, count=6, mass=1.0, spring=3.47, order="drift-split")
DPD = dataclasses.replace(CHAIN, count=6, mass=1.0, spring=6.0, lag=12.8)
BROWN = dataclasses.replace(CHAIN, box=64, count=50, mass=1.0, lag=6.4, order="drift-split")


def in_solvent(body, times):
    """SRD at 0.02 with three steps and three thermostats; other rules and intervals, each a fluid of its own. times: t0 at 0.02, and of the others."""
    own = f"SRD, dt_c {0.02:g}"
    found = [body.setting(own, "SRD", f"dt {step:g}", solvent(0.02), step, times[0], 15, 0.02) for step in (0.005, 0.01, 0.02)]
    found += [body.setting(own, f"SRD, {word}", "dt 0.02", solvent(0.02, thermostat=word), 0.02, times[0], 15) for word in ("rescale", "maxwell-boltzmann")]
    for rule in ("srd", "at-a", "at+a"):
        for interval in ((0.05, 0.1) if rule == "srd" else (0.02, 0.05, 0.1)):
            part = 4.0 if rule == "at+a" else 1.0
            found.append(body.setting(f"{NAMES[rule]}, dt_c {interval:g}", NAMES[rule], f"dt {interval:g}", solvent(interval, rule), interval, times[0] / part, 15))
    return found


def private(rate):
    return f"medium: {{kind: private, rate: {rate:g}, draw: relax}}"


def vertices():
    found = in_solvent(VERTEX, (2560.0, 2560.0))
    found += [VERTEX.setting("no hydrodynamics", word, "dt 0.02", solvent(0.02, more=f", hydrodynamics: false, bath: {bath}"), 0.02, 5120.0, seconds)
              for word, bath, seconds in (("swap", "particles", 20), ("phantoms", "phantoms", 2))]
    return found + [VERTEX.setting("private bath", "private", f"dt {step:g}", private(1), step, 20480.0, 2) for step in (0.05, 0.1, 0.2, 0.4)]


def pairs(draw, weight, repulsion, rate, density=3.0):
    return (f"medium: {{kind: pairs, density: {density:.10g}, rate: {rate:g}, draw: {draw}, weight: {weight}" + (f", repulsion: {repulsion:g}" if repulsion else "") + "}")


def chains():
    found = in_solvent(CHAIN, (2560.0, 2560.0))
    found += [CHAIN.setting("private bath", "private", f"dt {step:g}", private(1), step, 20480.0, 10) for step in (0.02, 0.05, 0.1, 0.2, 0.4)]
    found += [BROWN.setting("overdamped, rpy", "overdamped", f"dt {step:g}", "medium: {kind: overdamped, rate: 1, tensor: rpy, radius: 0.25}", step, 256.0, 8)
              for step in (0.005, 0.01, 0.02, 0.04)]
    density = 3.0 - 60 / 512.0
    found += [LOWE.setting("Lowe-Andersen", "Lowe-Andersen", f"dt {step:g}", pairs("replace", "hat", 0.0, 10.0, density), step, 512.0, 20) for step in (0.01, 0.02, 0.04)]
    return found + [DPD.setting("DPD", "DPD", f"dt {step:g}", pairs("relax", "quadratic", 25.0, 9.0, density), step, 410.0, 20) for step in (0.01, 0.02, 0.04, 0.05)]


def viscosities():
    found = []
    for rule in NAMES:
        for interval, count in PAIRS.items():
            name = rule.replace("+", "p")
            found.append(Setting("viscosity", f"{NAMES[rule]}, dt_c {interval:g}", NAMES[rule], interval, "waves", Run(
                f"waves-{name}-{interval:g}", hours=0.003, program=["shear_decay", 5, interval, 90 if rule == "srd" else rule, 0.3, SKIP[interval],
                                                                   count // (4 if rule == "at+a" else 1), 51, 16])))
    for rule, word in (*(("srd", word) for word in ("none", "rescale", "rescale-layers", "maxwell-boltzmann")), ("at-a", "none"), ("at+a", "none")):
        step, time = 0.1, 400.0 if rule == "at+a" else 1600.0
        text = scene(8, step, f"from: {steps_of(20.0, step)}, stress: {{every: {round(time / step / 128)}}}", ("shear: {rate: 0.08}", solvent(step, rule, word)))
        found.append(Setting("viscosity", f"{NAMES[rule]}, dt_c {step:g}", f"{NAMES[rule]}, sheared", step, "sheared box" + (f", {word}" if rule == "srd" else ""), Run(
            f"sheared-{rule.replace('+', 'p')}-{word}", scene=text, steps=steps_of(time, step), seed=61, hours=0.003), from_time=20.0))
    return found


def tubes():
    """cL^3 = 300 in 36^3 as in case `rivals`: d^2 at 50 t0."""
    found = []

    def add(family, series, words, medium, step, rule, time, seconds):
        observe = f"from: {steps_of(5.0, step)}, dynamics: {{every: {sampled(25.0, step)}, longest_lag: {sampled(50.0, step)}}}"
        parts = (medium, f"crossing: {{rule: {rule}}}",
                 f"fibers: [{{name: body, count: {TUBE_FIBERS}, vertices: 64, mass: 5, bond_length: 0.5, spring: 100, bending: 64}}]")
        found.append(Setting("tube", family, series, step, words, Run(named("tube", series, step), scene=scene(36, step, observe, parts),
                                                                  steps=steps_of(time + 5.0, step), seed=71, hours=seconds / 3600.0, priority=1), from_time=5.0))
    for rule, steps in (("event-driven", (0.005, 0.01, 0.02, 0.04)), ("sequential", (0.01, 0.02, 0.04))):
        for step in steps:
            add("private bath", rule, f"dt {step:g}", private(1), step, rule, 200.0, 0.6 / step)
    add("phantoms", "phantoms", "dt 0.02", solvent(0.02, more=", hydrodynamics: false, bath: phantoms"), 0.02, "event-driven", 200.0, 40)
    add("SRD, dt_c 0.02", "SRD", "dt 0.02", solvent(0.02), 0.02, "event-driven", 200.0, 60)
    return found


def fluids():
    """DPD: the same equilibrium by any bath and order."""
    found = []
    for draw, weight, order, steps in (("relax", "quadratic", "kick-split", (0.005, 0.01, 0.02, 0.04, 0.05, 0.06)), ("relax", "quadratic", "drift-split", (0.02, 0.04, 0.06)),
                                       ("replace", "hat", "kick-split", (0.02, 0.04, 0.06))):
        for step in steps:
            text = scene(6, step, f"from: {steps_of(10.0, step)}, pressure: {{every: {sampled(0.6, step)}}}, temperature: {{every: {sampled(0.6, step)}}}", (pairs(draw, weight, 25.0, 9.0),), order)
            series = {"relax": "DPD", "replace": "Lowe-Andersen"}[draw] + (", drift-split" if order == "drift-split" else "")
            run = Run(f"dpd-{draw}-{order}-{step:g}", scene=text, steps=steps_of(300.0, step), seed=81, hours=0.4 / step / 3600.0)
            found += [Setting(quantity, "density 3, a 25", series, step, f"dt {step:g}", run, from_time=10.0) for quantity in ("kinetic", "configurational", "pressure")]
    return found


@functools.cache
def settings():
    return (*viscosities(), *vertices(), *chains(), *tubes(), *fluids())


SECOND_WAY = Run("stress-atpa-0.02", hours=0.008, program=["green_kubo", 8, 5, 0.02, "at+a", 60, 120000, 77])  # the point that is furthest from theory
MEMORY = 25  # collisions, as in case `andersen` at this interval


def runs(tier):
    """None in the quick tier: what is compared are times."""
    return [*{setting.run.name: setting.run for setting in settings()}.values(), SECOND_WAY] if tier == "campaign" else []


# --- what runs say ----------------------------------------------------------------------------------------------------

def viscosity(result, setting):
    if result.run.program:
        table = result.columns
        return 5.0 * table["nu"][0], 5.0 * table["nu_error"][0]
    value, error = flow.stress(result, "sigma_xy")
    return value / 0.08, error / 0.08


def diffusion(result, setting):
    return at(result.table("dynamics-body"), "D_cumulative", setting.from_time)  # of the lag, which is also what is left out


def configurational(result, setting):
    table = result.table("pressure")
    (square, error), (laplacian, _) = mean_of(table["force_square"]), mean_of(table["laplacian"])
    return square / laplacian, error / laplacian


# quantity: its words, how it is read
QUANTITIES = {
    "viscosity": ("viscosity of the solvent", viscosity),
    "vertex": ("D of a vertex", diffusion),
    "chain": ("D of a chain of ten", diffusion),
    "tube": ("d² at 50 t0", lambda result, setting: at(result.table("dynamics-body"), "d2_third", TUBE_LAG)),
    "kinetic": ("kinetic temperature of DPD", lambda result, setting: mean_of(result.table("temperature")["solvent"])),
    "configurational": ("configurational temperature of DPD", configurational),
    "pressure": ("pressure of DPD", lambda result, setting: mean_of(result.table("pressure")["pressure"])),
}
FLUID = ("kinetic", "configurational", "pressure")
# Families whose answer is known at any step; the other families' answer is that of their first setting.
EXACT = {("vertex", "private bath"): 1.0 / 5.0, ("chain", "private bath"): 1.0 / 50.0, ("kinetic", "density 3, a 25"): 1.0, ("configurational", "density 3, a 25"): 1.0}


def leap_frog(x):
    """How much too large D of a free particle is by leap-frog steps of x = Gamma dt, each followed by an exact bath: velocities are remembered by e^-x a step, so
    D = (kT/M) dt (1/(1 - e^-x) - 1/2), by the sum of the geometric series of correlations."""
    return x * (1.0 / -math.expm1(-x) - 0.5) - 1.0


OFF = {("vertex", "private bath"): leap_frog, ("chain", "private bath"): leap_frog}  # by theory, of a step; Gamma is 1


@dataclasses.dataclass
class Row:
    """What a setting gives. time: of the run, t0; 1 for a program, whose time is its own. off: (distance from its family's answer, error), both over that
    answer; None where nothing else is of the family. seconds: CPU time to a statistical error of GOAL."""
    setting: Setting
    value: float
    error: float
    spent: float
    time: float
    off: tuple = None
    seconds: float = math.nan

    @property
    def late(self):
        """Is it known to be off by more than GOAL, so that no time mends it? Three errors: two would be exceeded by chance in some of so many rows."""
        by_theory = OFF.get((self.setting.quantity, self.setting.family))
        if by_theory and abs(by_theory(self.setting.step)) > GOAL:
            return True
        return self.off is not None and abs(self.off[0]) > GOAL and abs(self.off[0]) > 3.0 * self.off[1]


def rows(results):
    """Rows of the settings whose runs are finished, in their order."""
    found = []
    for setting in settings():
        result = results.get(setting.run.name)
        if result is None or not result.finished:
            continue
        value, error = QUANTITIES[setting.quantity][1](result, setting)
        if math.isfinite(error) and error > 0.0:
            found.append(Row(setting, float(value), float(error), result.cpu_seconds, result.time - setting.from_time if result.run.scene else 1.0))
    families = {}
    for row in found:
        families.setdefault((row.setting.quantity, row.setting.family), []).append(row)
    for key, family in families.items():
        compare(family, EXACT.get(key))
    return found


def compare(family, exact):
    """Fills in off and seconds. The variance that one t0 leaves is a property of the physics and of the estimator, not of step or thermostat: it is the mean over the
    settings of a family that are measured alike. So times of a family differ by what a t0 costs, which is known well, and not by the errors of errors."""
    first = family[0]
    for row in family:
        if exact is not None:
            row.off = row.value / exact - 1.0, row.error / exact
        elif row is first:
            row.off = (0.0, row.error / row.value) if len(family) > 1 else None
        else:
            ratio = row.value / first.value
            row.off = ratio - 1.0, ratio * math.hypot(row.error / row.value, first.error / first.value)
    for way in {row.setting.way for row in family}:
        alike = [row for row in family if row.setting.way == way]
        variance = float(numpy.mean([(row.error / row.value) ** 2 * row.time for row in alike]))
        for row in alike:
            row.seconds = variance / GOAL ** 2 * row.spent / row.time


def cheapest(family):
    """The row of a family that reaches GOAL first; None if none does."""
    return min((row for row in family if not row.late), key=lambda row: row.seconds, default=None)


def alike(family):
    """Rows that reach GOAL in as little time, as far as times on a shared machine tell."""
    best = cheapest(family)
    return [row for row in family if best is not None and not row.late and row.seconds <= ALIKE * best.seconds]


# --- verdicts and figure ----------------------------------------------------------------------------------------------

def verdicts(results):
    found, waves = [], None
    for rule, interval in NEW:
        name = rule.replace("+", "p")
        expected = sum(flow.viscosity(Point(3, 5, interval), rule))
        verdict = Verdict(f"settings.viscosity.{name}.{interval:g}", f"η from shear waves, {NAMES[rule]}, γ 5, dt_c {interval:g}", expected, "molecular chaos, known to 8 %", CHAOS * expected,
                          kind="paper", reason="the shorter the interval, the more often particles meet again before they part")
        result = results.get(f"waves-{name}-{interval:g}")
        found.append(fill(verdict, viscosity(result, None), CHAOS * expected) if result is not None else verdict)
        waves = viscosity(result, None) if result is not None and (rule, interval) == ("at+a", 0.02) else waves
    ways = Verdict("settings.ways.atpa.0.02", "η from the stress over η from shear waves, AT+a, γ 5, dt_c 0.02", 1.0, "one fluid; the value of molecular chaos is told from it", 0.05)
    if waves and SECOND_WAY.name in results:
        table = results[SECOND_WAY.name].columns
        value, error = table["eta"][MEMORY], table["eta_error"][MEMORY]
        ways.rival = sum(flow.viscosity(Point(3, 5, 0.02), "at+a")) / waves[0]
        fill(ways, (value / waves[0], value / waves[0] * math.hypot(error / value, waves[1] / waves[0])))
    return [*found, ways]


PANELS = {"viscosity": "$\\eta$ of the solvent", "vertex": "$D$ of a vertex", "chain": "$D$ of a chain", "tube": "$d^2$ at 50 $t_0$", "configurational": "configurational $T$ of DPD",
          "pressure": "pressure of DPD"}
TICKS = (0.005, 0.02, 0.05, 0.1, 0.2, 0.4)


def draw(found):
    figure, axes = figures.plain(width=6.6, height=9.6, rows=3, columns=2)
    for panel, (quantity, title) in zip(axes.flat, PANELS.items()):
        own, label = [row for row in found if row.setting.quantity == quantity], "off by (%)" if quantity in FLUID else "CPU s to 1 %"
        for number, series in enumerate(dict.fromkeys(row.setting.series for row in own)):
            some = sorted((row for row in own if row.setting.series == series), key=lambda row: row.setting.step)
            (draw_off if quantity in FLUID else draw_seconds)(panel, some, number, series)
        panel.set(xscale="log", xlabel="step ($t_0$)", ylabel=f"{title}: {label}")
        steps = [row.setting.step for row in own]
        ticks = [tick for tick in TICKS if own and min(steps) <= tick <= max(steps)]
        panel.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        panel.minorticks_off()
        if quantity in FLUID:
            panel.axhspan(-1.0, 1.0, color=figures.PALE, alpha=0.25, linewidth=0)
        else:
            panel.set_yscale("log")
        figures.legend(panel, loc="lower left", bbox_to_anchor=(-0.1, 1.0), borderaxespad=0.2, ncols=2, fontsize=6.5, columnspacing=1.0)
    return figure


def draw_seconds(panel, some, number, series):
    look = {"color": figures.INK, "marker": "p"} if number >= len(figures.COLORS) else {}  # a ninth series
    figures.points(panel, [row.setting.step for row in some], [row.seconds for row in some], number=number, label=series, linewidth=0.8,
                   linestyle=figures.STROKES[number % len(figures.STROKES)], **look)
    late = [row for row in some if row.late]
    if late:  # crossed out
        panel.plot([row.setting.step for row in late], [row.seconds for row in late], "x", color=figures.INK, markersize=10, zorder=4)


def draw_off(panel, some, number, series):
    figures.points(panel, [row.setting.step for row in some], [100.0 * row.off[0] for row in some], [100.0 * row.off[1] for row in some], number, label=series)


CAPTION = ("CPU time of one core to a statistical error of 1 %, against the step: between collisions where the fluid has them, else dt. Crossed out: known to be more than 1 % off, so that no time "
           "mends it. Lowest panels: how far DPD's equilibrium is off, the error that counts there; shaded 1 %.")


def evaluate(results, tier):
    if tier == "quick":
        return Outcome([], prose="Not in this tier: times of one set of runs.")
    found = rows(results)
    return Outcome(verdicts(results), [Figure("time", CAPTION, lambda: draw(found))] if found else [], PROSE)


PROSE = "CPU time to 1 %; the tables are in docs/claims/settings.md, written by `validation/cases/settings/table`."
