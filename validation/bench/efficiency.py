"""Statistics: CPU time that buys an error bar of 1 %, and of 0.3 %, with several estimators and boxes, side by side.

Every run takes some 20 s and gives a value, its error e (a fraction of it) and its CPU time t. Errors fall as the root
of the time, so 1 % takes t (e/0.01)^2, and 0.3 % eleven times as long.
"""
import math

import common

VISCOSITY = 10.74  # m/(a0 t0), measured: docs/accuracy.md; for the image correction only
CHAIN = "vertices=10,bond_length=0,spring=3,bending=0,crossing=0,dt=0.02"
CHAIN_SIZE = (10**2 - 1) / 60  # R_g^2 of ten vertices, a0^2

# name: program's arguments, edge of the box, R_g^2 of what diffuses
VISCOSITIES = {f"viscosity, {how}, {edge}^3": (mode, f"cells={edge},dt=0.02,every=1", time)
               for how, mode, sizes in (("decaying waves", "wave", ((8, 7000), (12, 2200), (16, 900))),
                                        ("thermal currents", "current", ((8, 5000), (16, 700))))
               for edge, time in sizes}
DIFFUSIONS = {
    "vertex, 8 in 8^3": ("cells=8,fibers=8,vertices=1,dt=0.02", 9000, 3, 9, 8, 0.0),
    "vertex, 32 in 8^3": ("cells=8,fibers=32,vertices=1,dt=0.02", 9000, 3, 9, 8, 0.0),
    "vertex, 64 in 16^3": ("cells=16,fibers=64,vertices=1,dt=0.02", 1100, 3, 9, 16, 0.0),
    "chain, 2 in 8^3": (f"cells=8,fibers=2,{CHAIN}", 9000, 10, 30, 8, CHAIN_SIZE),
    "chain, 8 in 8^3": (f"cells=8,fibers=8,{CHAIN}", 9000, 10, 30, 8, CHAIN_SIZE),
    "chain, 7 in 12^3": (f"cells=12,fibers=7,{CHAIN}", 2700, 10, 30, 12, CHAIN_SIZE),
    "chain, 62 in 25^3": (f"cells=25,fibers=62,{CHAIN}", 600, 10, 30, 25, CHAIN_SIZE),
}
ESTIMATORS = {"msd": "mean square displacement", "green-kubo": "velocity times displacement"}


def image_correction(edge, size):
    """What a periodic box takes from a diffusion coefficient at kT = 1: kT/(6 pi eta L) (2.837297 - ...), to L^-4."""
    return (2.837297 - 4.0 * math.pi / 3.0 * size / edge**2) / (6.0 * math.pi * VISCOSITY * edge)


def price(name, value, error, seconds):
    """Rows of the CPU time that buys 1 %, and 0.3 %, of this value."""
    if not math.isfinite(error):
        return []
    needed = seconds * (error / value) ** 2
    return [common.row(f"efficiency/{name}, CPU for {100 * goal:g} %", "s", value=needed / goal**2, error=None)
            for goal in (0.01, 0.003)]


def viscosity(store, effort):
    texts = store.run_all([("efficiency", mode, scene, round(time * effort))
                           for mode, scene, time in VISCOSITIES.values()])
    rows = []
    for name, text in zip(VISCOSITIES, texts):
        (value, error, seconds), = common.quantities(text).values()
        rows.append(common.row(f"efficiency/{name}", "a0^2/t0", value=value, error=error))
        rows += price(name, value, error, seconds)
    return rows


def diffusion(store, effort):
    texts = store.run_all([("efficiency", "diffusion", scene, max(300, round(time * effort)), short, long)
                           for scene, time, short, long, _, _ in DIFFUSIONS.values()])
    rows = []
    for (name, (_, _, _, _, edge, size)), text in zip(DIFFUSIONS.items(), texts):
        for estimator, (value, error, seconds) in common.quantities(text).items():
            full = f"{name}, {ESTIMATORS[estimator]}"
            rows.append(common.row(f"efficiency/{full}", "D, a0^2/t0", value=value, error=error))
            rows.append(common.row(f"efficiency/{full}, with images", "D, a0^2/t0",
                                   value=value + image_correction(edge, size), error=error))
            rows += price(full, value + image_correction(edge, size), error, seconds)
    return rows


ITEMS = {"viscosity": viscosity, "diffusion": diffusion}
