"""Sec. IV D: what a step costs, and how long one tau_r takes."""
from lib.claim import Outcome
from lib.runs import Run

TITLE = "Run time against volume and density"
PAPER = "Sec. IV D"

# Cells along an edge: fibers. c L^3 = 100 in growing boxes; growing density in the paper's box.
VOLUMES = ((16, 12), (20, 24), (24, 42), (32, 100), (40, 195), (48, 338))
DENSITIES = ((32, 0), (32, 30), (32, 55), (32, 100), (32, 175), (32, 300), (32, 550), (32, 1000))


def campaign():
    systems = [f"{cells}:{fibers}" for cells, fibers in dict.fromkeys(VOLUMES + DENSITIES)]
    # The paper's other figure: each fiber cut in two, the same mesh size, fewer and smaller fibers in a smaller box.
    return [Run("steps", program=["step_cost", 9, 200, *systems], hours=0.03)]


def quick():
    systems = ("16:0", "16:12", "16:38", "16:125", "24:42", "32:100")
    return [Run("steps", program=["step_cost", 5, 40, *systems], hours=0.002)]


def runs(tier):
    return quick() if tier == "quick" else campaign()


def evaluate(results, tier):
    return Outcome([])
