"""Fibers that cannot cross, beside LAMMPS' repulsive bonds and beads: crossings, thickness, d^2(t), and what an error costs."""
import importlib.util
import json
import math
import pathlib

import numpy

from lib import figures, semidilute as sd, stats
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

_spec = importlib.util.spec_from_file_location("rivals_measures", pathlib.Path(__file__).resolve().parent / "measures.py")
MEASURES = importlib.util.module_from_spec(_spec)  # what the runs measure with: copied beside the programs, too
_spec.loader.exec_module(MEASURES)

TITLE = "Noncrossing fibers beside their rivals"
PAPER = "Sec. I"
APART = True  # needs LAMMPS: `make bench-rivals`

OWN = ("events", "events:build=x86-64", "events:dt=0.02", "sequential")
FINE = "vertices=127,dt=0.004"  # bonds of half the length: a bead of half the size
# name -> (method, density, time of each seed (t0), seeds, seconds for each, priority)
MOTION = {
    "free-300": ("free", 300, 300, (1,), 40, 0),
    "ghosts-300": ("ghosts", 300, 150, (1,), 100, 0),
    "events-300": ("events", 300, 250, (1, 2), 75, 1),
    "sequential-300": ("sequential", 300, 100, (1,), 30, 3),
    "plain-300": ("plain", 300, 100, (1,), 30, 4),
    "srp-0.1-300": ("srp:range=0.1", 300, 75, (1,), 109, 3),
    "srp-0.2-300": ("srp:range=0.2", 300, 60, (2,), 100, 3),
    "srp-0.4-300": ("srp:range=0.4", 300, 55, (3,), 90, 3),
    "wca-0.5-300": ("wca:size=0.5", 300, 75, (1,), 60, 3),
    "wca-0.25-300": (f"wca:size=0.25,{FINE}", 300, 55, (1,), 250, 6),
    "events-dt0.02-300": ("events:dt=0.02", 300, 100, (5,), 15, 4),
    "events-dt0.04-300": ("events:dt=0.04", 300, 100, (5,), 8, 4),
    "srp-dt0.02-300": ("srp:range=0.2,dt=0.02", 300, 30, (5,), 27, 5),
    "srp-dt0.04-300": ("srp:range=0.2,dt=0.04", 300, 30, (5,), 14, 5),
    "wca-dt0.02-300": ("wca:size=0.5,dt=0.02", 300, 30, (5,), 15, 5),
    "events-1000": ("events", 1000, 100, (1,), 170, 6),
    "sequential-1000": ("sequential", 1000, 55, (1,), 120, 7),
    "srp-0.1-1000": ("srp:range=0.1", 1000, 52.5, (1,), 400, 7),
    "wca-0.5-1000": ("wca:size=0.5", 1000, 52.5, (1,), 250, 8),
    "wca-0.25-1000": (f"wca:size=0.25,{FINE}", 1000, 52.5, (1,), 900, 9),
    "events-3000": ("events", 3000, 52.5, (1,), 600, 8),
}
# name -> (method, density, time (t0), seconds, priority)
CROSSINGS = {
    "free-300": ("free", 300, 1.5, 40, 2),
    "events-300": ("events", 300, 1.5, 40, 2),
    "sequential-300": ("sequential", 300, 1.5, 40, 3),
    "plain-300": ("plain", 300, 1.5, 40, 4),
    "srp-0.1-10-300": ("srp:range=0.1", 300, 1.5, 45, 2),
    **{f"srp-{reach}-{barrier}-300": (f"srp:range={reach},barrier={barrier}", 300, 0.6, 25, 4) for reach, barrier in ((0.1, 4), (0.05, 10), (0.05, 4), (0.02, 10))},
    "srp-0.2-10-300": ("srp:range=0.2", 300, 0.6, 25, 6),
    "srp-0.2-dt0.02-300": ("srp:range=0.2,dt=0.02", 300, 1.2, 25, 5),
    "srp-0.2-dt0.04-300": ("srp:range=0.2,dt=0.04", 300, 2.4, 25, 5),
    "srp-0.1-dt0.02-300": ("srp:range=0.1,dt=0.02", 300, 1.2, 25, 5),
    "srp-0.1-skin0.3-300": ("srp:range=0.1,skin=0.3", 300, 1.5, 45, 6),
    **{f"wca-{size}-300": (f"wca:size={size}", 300, 0.6, 20, 4) for size in (0.3, 0.4, 0.5)},
    "wca-0.25-300": (f"wca:size=0.25,{FINE}", 300, 0.6, 90, 6),
    "free-1000": ("free", 1000, 0.2, 40, 6),
    "events-1000": ("events", 1000, 0.2, 40, 6),
    "sequential-1000": ("sequential", 1000, 0.2, 40, 6),
    "srp-0.1-1000": ("srp:range=0.1", 1000, 0.2, 80, 6),
    "events-3000": ("events", 3000, 0.05, 120, 7),
}
COST = {  # density -> (rounds, time (t0), methods, seconds, priority)
    300: (5, 0.5, (*OWN, "srp:range=0.1", "srp:range=0.2", "srp:range=0.2,dt=0.02", "srp:range=0.1,skin=0.3", "wca:size=0.5", f"wca:size=0.25,{FINE}"), 90, 2),
    1000: (5, 0.2, (*OWN, "srp:range=0.1", "wca:size=0.5"), 100, 5),
    3000: (5, 0.05, (*OWN, "srp:range=0.1"), 200, 6),
}
SAMPLE = 2.5  # t0
LAG = 50.0  # t0: the one of the comparison
GOAL = 0.02  # its error
LAGS = (2.5, 10.0, 50.0)  # of verdicts


def runs(tier):
    if tier == "quick":
        return []
    found = [Run(f"{name}-s{seed}", program=["rivals", "motion", method, density, seed, time, SAMPLE], hours=seconds / 3600, priority=priority)
             for name, (method, density, time, seeds, seconds, priority) in MOTION.items() for seed in seeds]
    found += [Run(f"crossings-{name}", program=["rivals", "crossings", method, density, 11, time], hours=seconds / 3600, priority=priority)
              for name, (method, density, time, seconds, priority) in CROSSINGS.items()]
    found += [Run(f"cost-{density}", program=["rivals", "cost", density, rounds, time, *methods], hours=seconds / 3600, priority=priority)
              for density, (rounds, time, methods, seconds, priority) in COST.items()]
    return found


# --- what runs say ----------------------------------------------------------------------------------------------------

def notes(result):
    """The single values that a run prints."""
    return {key: value for line in result.text.splitlines() if line.startswith("# ") for key, value in json.loads(line[2:]).items()}


def rows(result):
    """{first column: the others, as numbers} of the table that a run prints."""
    lines = [line.split(",") for line in result.text.splitlines() if not line.startswith("#")][1:]
    return {words[0]: [float(word) for word in words[1:]] for words in lines}


def seeds_of(name):
    """None of what is not planned."""
    return MOTION[name][3] if name in MOTION else ()


def pooled(results, name):
    """{lag: (d^2, error, of the center, error)} over the seeds that there are, weighted by intervals; None without one."""
    found = [rows(results[f"{name}-s{seed}"]) for seed in seeds_of(name) if f"{name}-s{seed}" in results]
    curve = {}
    for lag in found[0] if found else ():
        weights = numpy.array([one[lag][4] for one in found])
        weights /= weights.sum()
        values = numpy.array([one[lag][:4] for one in found])
        curve[float(lag)] = tuple(float(weights @ values[:, k]) if k % 2 == 0 else float(numpy.sqrt((weights**2) @ values[:, k]**2)) for k in range(4))
    return curve or None


def first_notes(results, name):
    """Values that the runs of a name agree on but for chance: means over seeds."""
    found = [notes(results[f"{name}-s{seed}"]) for seed in seeds_of(name) if f"{name}-s{seed}" in results]
    return found or None


def over(a, b, k=0):
    """(ratio, error) of two (value, error) that are independent; None if one is missing."""
    if a is None or b is None:
        return None
    ratio = a[k] / b[k]
    return ratio, ratio * math.hypot(a[k + 1] / a[k], b[k + 1] / b[k])


def thickness(results, name):
    """(effective width, its error): int (1 - g) de over distances up to 1.5 times the reach of the method. Lines without thickness: up to 0.1 a0."""
    found = first_notes(results, name)
    if not found:
        return None
    method = MOTION[name][0]
    settings = dict(word.split("=") for word in method.partition(":")[2].split(",") if word)
    reach = 1.5 * float(settings.get("range", settings.get("size", 0.0))) or 0.1
    k = int(numpy.searchsorted(found[0]["near"], min(reach, found[0]["near"][-1]) - 1e-9))
    near, pairs = found[0]["near"][k], sum(one["pairs"][k] for one in found)
    ideal = sum(one["pairs"][k] / one["share"][k] for one in found if one["share"][k])
    # Pairs that are close stay so for some t0: frames are 10 t0 apart, and count as independent.
    return near * (1.0 - pairs / ideal), near * math.sqrt(max(pairs, 1.0)) / ideal


def leak(results, name):
    """(crossings over those that lines which feel nothing would make, error or bound at 95 %, crossings, possible); None without the run."""
    result = results.get(f"crossings-{name}")
    if result is None:
        return None
    possible, crossed = notes(result)["possible"], rows(result)["1"][0]
    return crossed / possible, (math.sqrt(crossed) if crossed else 3.0) / possible, int(crossed), possible


def price(results, density, method):
    """(median of user CPU seconds per t0, half the distance between the quartiles)"""
    result = results.get(f"cost-{density}")
    values = rows(result).get(method.replace(",", ";")) if result is not None else None
    if not values:
        return None
    low, middle, high = numpy.percentile(values, [25, 50, 75])
    return float(middle), float(0.5 * (high - low))


def scatter(results, density):
    """Standard deviation of d^2 at LAG over its mean, of one fiber and one interval of LAG, from event-driven runs: what one t0 of one fiber is worth."""
    name = f"events-{density}"
    curve = pooled(results, name)
    if curve is None or LAG not in curve:
        return None
    time = sum(one["time"] - 5.0 for one in first_notes(results, name))
    fibers = first_notes(results, name)[0]["fibers"]
    return curve[LAG][1] / curve[LAG][0] * math.sqrt(fibers * time / LAG)


def by_width(results, lag, density):
    """Of the ranges of SRP that have run: (widths, d^2 over event-driven, errors, error of the reference, which is off for all alike)."""
    reference, points = pooled(results, f"events-{density}"), []
    for reach in ("0.1", "0.2", "0.4"):
        name = f"srp-{reach}-{density}"
        curve = pooled(results, name)
        if curve and reference and lag in curve:
            points.append((thickness(results, name)[0], *over(curve[lag], (reference[lag][0], 0.0))))
    own = reference[lag][1] / reference[lag][0] if points else None
    return (*numpy.array(points).reshape(-1, 3).T, own)


def narrowing(results, density, lag=LAG):
    """(slope, error): d^2 of SRP over event-driven is 1 + slope times width, by least squares over its ranges; None without two."""
    x, y, error, reference = by_width(results, lag, density)
    if len(x) < 2:
        return None
    weight = 1.0 / error**2
    slope = float((weight * x * (y - 1.0)).sum() / (weight * x * x).sum())
    own = reference * float((weight * x).sum() / (weight * x * x).sum())
    return slope, math.hypot(1.0 / math.sqrt(float((weight * x * x).sum())), own)


def bias_of(results, row):
    """(distance of d^2 at LAG from lines without width, error), both over d^2: that of all ranges of SRP together, by width; else of the run itself. What differs by
    less than twice its error is not told from 0, and is 0 by construction for rules without width."""
    if row["key"] in ("events", "sequential", "plain"):
        return 0.0, row["ratio"][LAG][1]
    line = narrowing(results, row["density"]) if row["key"].startswith("srp") else None
    if line:
        return line[0] * row["width"][0], line[1] * row["width"][0]
    return row["ratio"][LAG][0] - 1.0, row["ratio"][LAG][1]


def seconds_to(error, bias, spread, fibers, cost):
    """CPU seconds until the root of bias^2 + variance is `error`; infinite if the bias alone is larger."""
    left = error**2 - bias**2
    return math.inf if left <= 0.0 else (spread**2 / left) * LAG / fibers * cost


# Rows of the table: name of the motion's run -> (label, its crossings, its method in cost-*)
LABELS = {"events": "event-driven", "sequential": "the paper's rule", "plain": "plain reversal (impulsive Verlet)", "srp-0.1": "SRP, range 0.1", "srp-0.2": "SRP, range 0.2",
          "srp-0.4": "SRP, range 0.4", "wca-0.5": "WCA, size 0.5", "wca-0.25": "WCA, size 0.25"}  # and bonds of half the length: 127 beads
CROSSED = {"srp-0.1": "srp-0.1-10", "srp-0.2": "srp-0.2-10"}


def compared(results, density):
    """Rows of the comparison at one density, as dictionaries."""
    reference = pooled(results, f"events-{density}")
    spread = scatter(results, density)
    found = []
    for key, label in LABELS.items():
        name = f"{key}-{density}"
        method = MOTION.get(name, MOTION[f"{key}-300"])[0]
        curve = pooled(results, name)
        row = {"density": density, "key": key, "label": label, "method": method, "leak": leak(results, f"{CROSSED.get(key, key)}-{density}") or leak(results, f"{key}-{density}"),
               "width": thickness(results, name), "price": price(results, density, "events" if key == "plain" and curve else method),
               "ratio": {lag: over(curve.get(lag), reference.get(lag)) for lag in (10.0, 25.0, LAG)} if curve and reference else {},
               "notes": first_notes(results, name)}
        if key == "events":
            row["ratio"] = {lag: (1.0, reference[lag][1] / reference[lag][0]) for lag in reference} if reference else {}
            row["x86-64"] = price(results, density, "events:build=x86-64")
        ratio = row["ratio"].get(LAG)
        if ratio and spread and row["price"] and row["notes"]:
            fibers, row["bias"] = row["notes"][0]["fibers"], bias_of(results, row)
            row["seconds"] = seconds_to(GOAL, row["bias"][0], spread, fibers, row["price"][0])
            row["unbiased"] = seconds_to(GOAL, 0.0, spread, fibers, row["price"][0])
        found.append(row)
    return found


# --- verdicts ---------------------------------------------------------------------------------------------------------

def bare_theory(time):
    """(d^2, square of the center's displacement) of fibers that feel nothing, Gamma = 1."""
    tube, center = MEASURES.free_motion([time], 64, sd.MASS, 1.0, 64.0, sd.BOND2)
    return float(tube[0]), float(center[0])


def bare_verdicts(results):
    """Without contacts: both codes against each other and theory. Nothing else may be compared before these pass."""
    own, other = (pooled(results, f"{name}-300") for name in ("free", "ghosts"))
    found = []
    for lag in LAGS:
        pair = over(own[lag], other[lag]) if own and other and lag in own and lag in other else None
        found.append(sd.measured(Verdict(f"rivals.bare.{lag:g}", f"no contacts, cL³ = 300: d² of uncross over LAMMPS at {lag:g} t0", 1.0, "the same fibers, bath and start",
                                         stats.tolerance(0.0), must_see=0.25), pair))
    for name, curve in (("uncross", own), ("lammps", other)):
        exact = bare_theory(10.0)
        pair = curve and (curve[10.0][0] / exact[0], curve[10.0][1] / exact[0])
        found.append(sd.measured(Verdict(f"rivals.bare.theory.{name}", f"no contacts: d² of {name} at 10 t0 over that of a straight fiber", 1.0,
                                         "modes of a straight fiber, each an oscillator with friction; nothing fitted", stats.tolerance(0.0), must_see=0.3), pair, 0.08))
        pair = curve and (curve[10.0][2] / exact[1], curve[10.0][3] / exact[1])
        found.append(sd.measured(Verdict(f"rivals.bare.center.{name}", f"no contacts: mean square displacement of the fibers' center in {name}, 10 t0, over theory", 1.0,
                                         "exact: a particle of the fiber's mass with friction", stats.tolerance(0.0), must_see=0.3), pair))
    return found


def crossing_verdicts(results):
    """Crossings over those that are possible. That of lines which feel nothing tests the count itself."""
    found = []
    for density in (300, 1000):
        row = leak(results, f"free-{density}")
        found.append(sd.measured(Verdict(f"rivals.crossings.free.{density}", f"no contacts, cL³ = {density}: crossings counted over (π/8) ρ² V ⟨|v_n|⟩ t", 1.0,
                                         "kinetic theory; exact for an ideal isotropic solution", stats.tolerance(0.0), must_see=0.5), row, 0.1))
    for name, label in (("events-300", "event-driven"), ("sequential-300", "the paper's rule"), ("plain-300", "plain reversal"), ("events-1000", "event-driven"),
                        ("sequential-1000", "the paper's rule"), ("events-3000", "event-driven")):
        row = leak(results, name)
        verdict = Verdict(f"rivals.crossings.{name.replace('-', '.')}", f"{label}, cL³ = {name.partition('-')[2]}: crossings over those that are possible", 0.0,
                          "none, by construction", 0.0, must_see=0.02)
        if row is not None:  # a single crossing is too many
            verdict.measured, verdict.error, verdict.tolerance, verdict.detects = row[0], row[1], 0.5 / row[3], 3.0 / row[3]
        found.append(verdict)
    return found


def limit_of(results, lag, density=300):
    """(d^2 of SRP over that of event-driven fibers, both at no width: a line through the widths, error); None with fewer than three."""
    x, y, error, own = by_width(results, lag, density)
    if len(x) < 3:
        return None
    fit = stats.line(x, y, error)
    return float(fit.value[0]), math.hypot(float(fit.error[0]), own), float(fit.value[1]), float(fit.error[1])


def evaluate(results, tier):
    if tier == "quick":
        return Outcome([], prose="Not in this tier: needs LAMMPS (`make bench-rivals`).")
    verdicts = bare_verdicts(results) + crossing_verdicts(results)
    for name, label in (("sequential", "the paper's rule"), ("plain", "the plain reversal")):
        curve, reference = pooled(results, f"{name}-300"), pooled(results, "events-300")
        pair = over(curve[10.0], reference[10.0]) if curve and reference else None
        verdicts.append(sd.measured(Verdict(f"rivals.motion.{name}", f"cL³ = 300: d² at 10 t0 of {label} over event-driven", 1.0, "lines without thickness, all of them",
                                            stats.tolerance(0.0), must_see=0.15), pair))
    for lag in (10.0, LAG):
        pair = limit_of(results, lag)
        verdicts.append(sd.measured(Verdict(f"rivals.limit.{lag:g}", f"cL³ = 300: d² at {lag:g} t0 of LAMMPS' SRP, extrapolated to no width, over event-driven", 1.0,
                                            "another program and another kind of contact; zero width is one limit", stats.tolerance(0.0), must_see=0.3), pair))
    drawn = []
    if any(row.get("unbiased") for row in compared(results, 300)):
        drawn.append(Figure("cost", CAPTION, lambda: draw_cost(results)))
    if pooled(results, "events-300"):
        drawn.append(Figure("d2", "d² over that of event-driven fibers, cL³ = 300. Shaded: the error of the reference.", lambda: draw_ratio(results)))
    return Outcome(verdicts, drawn, PROSE)


# --- figures ----------------------------------------------------------------------------------------------------------

CAPTION = ("User CPU time of one core against the error of d² at 50 t0, cL³ = 300. The error is the root of bias squared and variance. The bias is the distance from event-driven "
           "fibers; of SRP it is taken as proportional to the width, by all its ranges. A method never gets below its bias (steep ends). Dotted: 2 %.")


def draw_cost(results):
    figure, axes = figures.plain(height=3.8)
    spread = scatter(results, 300)
    for row in (row for row in compared(results, 300) if row.get("unbiased")):
        bias = abs(row["bias"][0])
        goal = numpy.geomspace(max(0.003, 1.01 * bias), 0.3, 200)
        figures.line(axes, 100.0 * goal, [seconds_to(one, bias, spread, row["notes"][0]["fibers"], row["price"][0]) for one in goal], list(LABELS).index(row["key"]), label=row["label"])
    axes.axvline(100.0 * GOAL, color="#444444", linewidth=0.8, linestyle=":")
    axes.set(xscale="log", yscale="log", ylabel="user CPU time [s]", xlabel=r"error of $d^2$ at 50 $t_0$ [%]")
    figures.legend_above(axes, columns=3)
    return figure


def draw_ratio(results):
    figure, axes = figures.plain(height=3.8)
    reference = pooled(results, "events-300")
    lags = numpy.array(sorted(reference))
    own = numpy.array([reference[lag][1] / reference[lag][0] for lag in lags])
    axes.fill_between(lags, 1.0 - own, 1.0 + own, color="#dddddd")
    for number, row in enumerate(row for row in compared(results, 300) if row["key"] != "events" and row["ratio"]):
        curve = pooled(results, f"{row['key']}-300")
        pairs = [over(curve[lag], (reference[lag][0], 0.0, 0.0, 0.0)) for lag in lags if lag in curve]
        figures.points(axes, [lag * 1.02**number for lag in lags if lag in curve], [pair[0] for pair in pairs], [pair[1] for pair in pairs], list(LABELS).index(row["key"]), label=row["label"])
    axes.axhline(1.0, color="#444444", linewidth=0.8)
    axes.set(xscale="log", xlabel="$t$ [$t_0$]", ylabel="$d^2$ over event-driven")
    figures.legend_above(axes, columns=3)
    return figure


PROSE = "What each method costs at equal error; the table is in docs/claims/rivals.md, written by `validation/cases/rivals/table`."
