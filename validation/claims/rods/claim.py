"""Fig. 2, rods: diffusion against length, and what the periodic images do to it."""
import pathlib
import string

from lib import dilute
from lib.claim import Outcome
from lib.runs import Run

TITLE = "Rods: diffusion against length, diameter and prefactor, and the images' share"
PAPER = "Fig. 2"
SCENE = string.Template((pathlib.Path(__file__).parent / "rods.yaml").read_text())


def rods(name, vertices, box, count, time, bath="hydrodynamics", seed=1, priority=0):
    """A run of rods; time in t0."""
    scene = SCENE.substitute(box=box, count=count, vertices=vertices,
                             hydrodynamics=str(bath == "hydrodynamics").lower(),
                             bath="phantoms" if bath == "phantoms" else "particles")
    return Run(name, scene=scene, steps=round(time / 0.01), seed=seed, priority=priority,
               hours=dilute.hours(box, count * vertices, time, bath=bath, time_step=0.01))


# With hydrodynamics. N, box: rods, time of one run in t0, and seeds up to which priorities 0, 1, 2 go.
PAPER_BOXES = {10: 18, 15: 27, 30: 54, 45: 81, 60: 108}  # 1.8 N
SYSTEMS = {
    (10, 9): (1, 40000, 0, 1, 3), (10, 12): (2, 20000, 0, 2, 4), (10, 18): (6, 6000, 1, 4, 8), (10, 27): (20, 2500, 0, 3, 6),
    (10, 36): (48, 1600, 0, 3, 6), (15, 18): (3, 8000, 0, 1, 3), (15, 27): (10, 2500, 1, 3, 6), (30, 36): (7, 1500, 1, 4, 8),
    (30, 54): (24, 700, 0, 2, 6), (45, 45): (5, 1000, 1, 5, 9), (45, 81): (24, 500, 0, 0, 4), (60, 54): (5, 700, 1, 5, 10),
    (60, 72): (10, 1000, 0, 0, 3)}
FREE = {10: (32, 1500), 15: (24, 1500), 30: (16, 1500), 45: (12, 1500), 60: (8, 2000)}  # without hydrodynamics


def campaign():
    found = [rods(f"phantoms-N{n}", n, 128, count, time, bath="phantoms") for n, (count, time) in FREE.items()]
    for (n, box), (count, time, *limits) in SYSTEMS.items():
        for seed in range(1, limits[-1] + 1):
            priority = next(p for p, limit in enumerate(limits) if seed <= limit)
            found.append(rods(f"N{n}-L{box}-s{seed}", n, box, count, time, seed=1000 * n + seed, priority=priority))
    return found


def quick():
    return [rods("N10-L12-s1", 10, 12, 2, 5000, seed=10001), rods("N10-L18-s1", 10, 18, 6, 1600, seed=10002),
            rods("N20-L20-s1", 20, 20, 3, 1800, seed=20001), rods("phantoms-N10", 10, 64, 32, 200, bath="phantoms")]


def runs(tier):
    return quick() if tier == "quick" else campaign()


def evaluate(results, tier):
    """Verdicts and figures from what there is."""
    return Outcome([])
