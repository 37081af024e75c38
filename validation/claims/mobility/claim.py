"""Mobility of a single vertex: D_M and a_h from boxes of several sizes, hydrodynamics on and off."""
import pathlib
import string

from lib import dilute
from lib.claim import Outcome
from lib.runs import Run

TITLE = "A vertex: diffusion, hydrodynamic radius, and what the box does"
PAPER = "Sec. III D, Table II"
SCENE = string.Template((pathlib.Path(__file__).parent / "vertices.yaml").read_text())


def vertices(name, box, count, time, bath="hydrodynamics", seed=1, priority=0):
    """A run of loose vertices; time in t0."""
    scene = SCENE.substitute(box=box, count=count, hydrodynamics=str(bath == "hydrodynamics").lower(),
                             bath="phantoms" if bath == "phantoms" else "particles")
    return Run(name, scene=scene, steps=round(time / 0.02), seed=seed, priority=priority,
               hours=dilute.hours(box, count, time, bath=bath))


# Boxes with hydrodynamics: vertices, one in 128 cells, and time in t0 of one run. Each has 1.9e5 vertex t0 or more.
BOXES = {8: (4, 60000), 10: (8, 30000), 12: (14, 18000), 16: (32, 8000), 24: (108, 2400), 32: (256, 1200)}
CROWDED = {8: 8000, 128: 8000, 512: 6000}  # vertices in 16^3 cells
SEEDS = ((0, 1), (1, 4), (2, 10))  # priority, seeds up to


def campaign():
    found = [vertices("phantoms-L64", 64, 256, 5000, bath="phantoms"),
             vertices("swap-L8", 8, 4, 30000, bath="swap"),
             vertices("swap-L16", 16, 32, 4000, bath="swap", priority=1)]
    before = 0
    for priority, seeds in SEEDS:
        for seed in range(before + 1, seeds + 1):
            found += [vertices(f"L{box}-s{seed}", box, count, time, seed=100 * box + seed, priority=priority)
                      for box, (count, time) in BOXES.items()]
        before = seeds
    return found + [vertices(f"crowd-{count}", 16, count, time, seed=count, priority=1) for count, time in CROWDED.items()]


def quick():
    return [vertices("phantoms-L64", 64, 128, 1500, bath="phantoms"),
            vertices("swap-L8", 8, 4, 10000, bath="swap"),
            vertices("L8-s1", 8, 8, 25000, seed=801), vertices("L12-s1", 12, 27, 7500, seed=1201),
            vertices("L16-s1", 16, 64, 4000, seed=1601)]


def runs(tier):
    return quick() if tier == "quick" else campaign()


def evaluate(results, tier):
    """Verdicts and figures from what there is."""
    return Outcome([])
