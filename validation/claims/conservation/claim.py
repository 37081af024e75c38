"""Claim 8: what is conserved, what not; how many moves are refused."""
from lib.claim import Outcome
from lib.runs import Run

TITLE = "Refused moves: conservation, heat, rates"
PAPER = "Sec. III C, V B 1"
USES = ("tube", "msd", "galilean")

# Fibers of 38 vertices in 16^3 cells, as many vertices per volume as c L^3 of the paper's have in 32^3.
COUNTS = {1000: 208, 300: 62, 100: 21}


def refused(density, time, seed, order="kick-split", dts=(0.02, 0.01, 0.005), rules=("stay", "bounce")):
    return ["refused_moves", 16, COUNTS[density], 38, 0, time, seed, order, *dts, "--", *rules]


def campaign():
    found = [Run(f"heat-c{density}", program=refused(density, 240, 800 + density, dts=(0.02, 0.01, 0.005, 0.0025)),
                 hours=hours) for density, hours in ((1000, 0.09), (300, 0.05), (100, 0.03))]
    found.append(Run("heat-paper-order", hours=0.005,
                     program=refused(1000, 8, 811, order="paper", dts=(0.01, 0.005, 0.0025), rules=("stay",))))
    found.append(Run("heat-drift-split", program=refused(1000, 240, 812, order="drift-split"), hours=0.08))
    found.append(Run("sweeps", program=["sweep_conservation", 16, 208, 38, 0.01, 2000, 820], hours=0.01))
    return found


def quick():
    return [Run("heat-c1000", program=refused(1000, 40, 831), hours=0.008),
            Run("heat-c300", program=refused(300, 40, 832, dts=(0.01,), rules=("stay",)), hours=0.001),
            Run("sweeps", program=["sweep_conservation", 16, 208, 38, 0.01, 100, 833], hours=0.001)]


def runs(tier):
    return quick() if tier == "quick" else campaign()


def evaluate(results, tier):
    return Outcome([])
