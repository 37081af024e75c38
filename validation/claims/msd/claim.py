"""Fig. 5: d^2(t) against density."""
from lib import semidilute as sd
from lib.claim import Outcome
from lib.runs import Run

TITLE = "Fibers hindered by fibers: density"
PAPER = "Fig. 5"
USES = ("tube",)  # its hi-entangled is c L^3 = 1000
SMALL = (50, 200)  # quick tier: c L^3 of fibers with L = 12


def campaign():
    # 7,200,000 steps are one tau_r; c L^3 = 1000 is tube's.
    hours = {30: 2.1, 100: 2.9, 300: 5.2}
    found = []
    for number, (density, total) in enumerate(hours.items()):
        found.append(Run(f"c{density}", scene=sd.scene(count=density, every=10), steps=7200000, hours=total,
                         seed=500 + number, priority=2, goals=((600000, 0), (2200000, 1))))
        found.append(Run(f"c{density}-short", steps=20000, hours=0.002 * total, seed=510 + number,
                         scene=sd.scene(count=density, every=1, longest_lag=1024, series=1000)))
    found.append(Run("off-c100", steps=400000, hours=0.1, seed=520,
                     scene=sd.scene(count=100, solvent=sd.BATH, forbidden="false", every=10, longest_lag=131072)))
    return found


def quick():
    found = [Run("off-c100", steps=6000, seed=530, hours=0.001,
                 scene=sd.scene(count=100, solvent=sd.BATH, forbidden="false", every=2, longest_lag=2048)),
             Run("c100", steps=8000, seed=531, hours=0.002, scene=sd.scene(box=24, count=42, every=2, longest_lag=2048))]
    # Fibers of 24 vertices at three densities; c L^3 = 400 is tube's.
    found += [Run(f"small{count}", steps=8000, seed=540 + count, hours=0.002,
                  scene=sd.scene(box=12, vertices=24, count=count, every=5, longest_lag=2560)) for count in SMALL]
    return found


def runs(tier):
    return quick() if tier == "quick" else campaign()


def evaluate(results, tier):
    return Outcome([])
