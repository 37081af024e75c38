"""Run time against error: three orders of drift, collision and kick, two crossing rules, and time steps from 0.0025 to 0.04.

Errors are measured in a small box (8^3 cells, 32 fibers of 16 vertices, 1 vertex per cell; the paper's k = 100,
l0 = 0.5, kappa = 64), costs at c L^3 = 100 and 1000. Collisions are 0.02 apart, with dt = 0.04 so far: that solvent is
another one, and what depends on it (g, diffusion) is not compared there.
"""
import numpy

import common
from speed import blocks

# Name -> settings of the scene. An order alone is with crossings refused one vertex at a time (crossing=1).
ORDERS = {"paper": "order=0", "kick-split": "order=1", "drift-split": "order=2",
          "kick-split, event-driven": "order=1,crossing=2", "drift-split, event-driven": "order=2,crossing=2"}
SPLIT = [order for order in ORDERS if order != "paper"]
SEQUENTIAL = [order for order in ORDERS if "event-driven" not in order]
STEPS = (0.0025, 0.005, 0.01, 0.02, 0.04)
FIBERS = "cells=8,fibers=32,vertices=16"
LOOSE = "cells=8,fibers=8,vertices=1"
WANTED = 0.01  # relative error that is to be bought


def every_case(largest=1.0, orders=ORDERS):
    return [(order, dt) for order in orders for dt in STEPS if dt <= largest]


def scene_of(base, order, dt):
    return f"{base},{ORDERS[order]},dt={dt}"


def measure(store, base, time, cases):
    """{(order, dt): quantities} of program precision."""
    texts = store.run_all([("precision", scene_of(base, order, dt), time) for order, dt in cases])
    return {case: common.quantities(text) for case, text in zip(cases, texts)}


def statics(store, effort):
    """Stiffest bending mode, bend energy and g(10 t0), at constant temperature, crossings refused."""
    found = measure(store, f"{FIBERS},thermostat=1", max(200, round(2000 * effort)), every_case())
    rows = []
    for (order, dt), q in found.items():
        if "fault" in q:
            rows.append(common.row(f"precision/fault, statics, {order}, dt {dt}", "t0", value=q["fault"][0]))
            continue
        for name in ("stiffest", "bend"):
            rows.append(common.row(f"precision/{name}, {order}, dt {dt}", "over exact", value=q[name][0],
                                   error=q[name][1]))
    best = [found[order, STEPS[0]]["msd"] for order in ("kick-split", "drift-split")]
    weights = [1.0 / error**2 for _, error in best]
    reference = sum(w * value for w, (value, _) in zip(weights, best)) / sum(weights)
    rows.append(common.row("precision/g(10 t0), reference", "a0^2", value=reference, error=sum(weights) ** -0.5))
    for (order, dt), q in found.items():
        if dt <= 0.02 and "fault" not in q:
            value, error = (x / reference for x in q["msd"])
            rows.append(common.row(f"precision/g(10 t0), {order}, dt {dt}", "over reference", value=value, error=error))
    return rows + prices(found, costs(store, effort))


def costs(store, effort):
    """{name: {(order, dt): CPU seconds per t0, a list}} at c L^3 = 100 in 32^3 cells, and 1000 in 16^3. The order
    `paper` does what kick-split does, but heats: it is not timed.
    """
    result = {}
    for name, base in (("cL^3 = 100", "cells=32,fibers=100"), ("cL^3 = 1000", "cells=16,fibers=125")):
        scenes = {case: scene_of(base, *case) for case in every_case() if case[0] != "paper"}
        times, _ = blocks(store, max(3, round(5 * effort)), 0.1, list(scenes.values()))
        result[name] = {case: [t / case[1] for t in times[scene]] for case, scene in scenes.items()}
    return result


def prices(found, cost):
    """Costs, and for either split order the time step that buys WANTED, and its cost."""
    rows = []
    for name, times in cost.items():
        for (order, dt), seconds in times.items():
            rows.append(common.row(f"precision/cost, {name}, {order}, dt {dt}", "CPU s per t0", seconds))
    for order in SPLIT:
        rows += cheapest(order, {dt: found[order, dt]["stiffest"] for dt in STEPS}, cost)
    return rows


def cheapest(order, stiffest, cost):
    """The largest time step measured up to which the stiffest mode is never off by more than WANTED, and its cost.
    Where the error can be told from none, also from a fit of the leap-frog's 1/(1 - c dt^2) over dt <= 0.02.
    """
    good = [abs(stiffest[dt][0] - 1.0) <= WANTED for dt in STEPS]
    rows, within = [], [dt for k, dt in enumerate(STEPS) if all(good[:k + 1])]
    if within:
        rows.append(common.row(f"precision/largest dt within 1 %, {order}", "t0", value=within[-1]))
        rows += [common.row(f"precision/its cost, {name}, {order}", "CPU s per t0", times[order, within[-1]])
                 for name, times in cost.items()]
    value, error = numpy.array([stiffest[dt] for dt in STEPS if dt <= 0.02]).T
    square = numpy.array([dt**2 for dt in STEPS if dt <= 0.02])
    weight = square * value**4 / error**2
    coefficient = float(sum(weight * (1.0 - 1.0 / value)) / sum(weight * square))
    uncertainty = float(sum(weight * square) ** -0.5)
    rows.append(common.row(f"precision/c of 1/(1 - c dt^2), {order}", "1/t0^2", value=coefficient, error=uncertainty))
    if coefficient < 3 * uncertainty:
        return rows
    dt = ((1.0 - 1.0 / (1.0 + WANTED)) / coefficient) ** 0.5
    rows.append(common.row(f"precision/dt for 1 %, {order}", "t0", value=dt,
                           error=0.5 * dt * uncertainty / coefficient))
    for name, times in cost.items():
        logs = [numpy.log(common.median(times[order, step])) for step in STEPS]
        rows.append(common.row(f"precision/cost of 1 %, {name}, {order}", "CPU s per t0",
                               value=float(numpy.exp(numpy.interp(numpy.log(dt), numpy.log(STEPS), logs)))))
    return rows


def energy(store, effort):
    """Growth of the energy of a closed box, crossings free and refused."""
    rows = []
    for name, on in (("free", 0), ("refused", 1)):
        orders = ORDERS if on else SEQUENTIAL
        found = measure(store, f"{FIBERS},crossing={on}", max(100, round(400 * effort)), every_case(orders=orders))
        for (order, dt), q in found.items():
            case = f"{name}, {order}, dt {dt}"
            if "fault" in q:
                rows.append(common.row(f"precision/fault, {case}", "t0", value=q["fault"][0]))
            else:
                rows.append(common.row(f"precision/drift, {case}", "kT per t0 and degree of freedom",
                                       value=q["drift"][0], error=q["drift"][1]))
    return rows


def diffusion(store, effort):
    """Loose vertices (M = 5) with hydrodynamics in 8^3 cells: no force, so dt should not matter, and `paper` is the
    same as kick-split.
    """
    cases = every_case(0.02, ("kick-split", "drift-split"))
    texts = store.run_all([("efficiency", "diffusion", scene_of(LOOSE, order, dt), max(500, round(3000 * effort)), 3, 9)
                           for order, dt in cases])
    found = [common.quantities(text)["msd"] for text in texts]
    return [common.row(f"precision/vertex diffusion, {order}, dt {dt}", "a0^2/t0", value=value, error=error)
            for (order, dt), (value, error, _) in zip(cases, found)]


ITEMS = {"statics and costs": statics, "energy": energy, "vertex diffusion": diffusion}
