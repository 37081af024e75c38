"""Fig. 2, flexible chains: diffusion against length, with hydrodynamics and without."""
import pathlib
import string

from lib import dilute
from lib.claim import Outcome
from lib.runs import Run

TITLE = "Chains: diffusion against length (Zimm), and Rouse without hydrodynamics"
PAPER = "Fig. 2"
SCENE = string.Template((pathlib.Path(__file__).parent / "chains.yaml").read_text())
SPRING = 3.0  # kT/a0^2: bonds of 1 a0
LOOSE = 0.1   # of chains whose vertices hardly ever share a cell


def chains(name, vertices, box, count, time, bath="hydrodynamics", seed=1, priority=0, spring=SPRING, every=0.4,
           lag=409.6, crossing="free"):
    """A run of Gaussian chains; times in t0."""
    scene = SCENE.substitute(box=box, count=count, vertices=vertices, spring=spring, every=round(every / 0.02),
                             longest_lag=round(lag / 0.02), crossing="true" if crossing == "forbidden" else "false",
                             hydrodynamics=str(bath == "hydrodynamics").lower(),
                             bath="phantoms" if bath == "phantoms" else "particles")
    return Run(name, scene=scene, steps=round(time / 0.02), seed=seed, priority=priority,
               hours=dilute.hours(box, count * vertices, time, bath=bath))


# With hydrodynamics. N, box: chains, time of one run in t0, and seeds up to which priorities 0, 1, 2 go.
PAPER_BOXES = {5: 18, 10: 25, 20: 35, 40: 50, 80: 71, 160: 100}  # 25 sqrt(N/10), rounded
SYSTEMS = {
    (5, 18): (10, 3000, 1, 4, 8), (10, 25): (16, 3500, 1, 4, 8), (20, 24): (6, 4000, 1, 2, 6), (20, 35): (20, 2000, 0, 3, 6),
    (40, 36): (9, 2500, 1, 3, 6), (40, 50): (24, 1200, 0, 2, 6), (80, 36): (6, 4000, 1, 4, 8), (80, 71): (32, 500, 0, 2, 8),
    (160, 50): (8, 800, 1, 6, 12), (10, 12): (2, 20000, 0, 2, 4), (10, 16): (4, 10000, 0, 2, 4), (10, 36): (48, 1500, 0, 2, 4),
    (40, 25): (3, 6000, 0, 2, 4), (160, 71): (16, 600, 0, 0, 3)}
CROWDED = {4: 10000, 64: 2500}  # chains of 10 vertices in 25^3 cells, where 16 are
ROUSE = {5: (64, 2000), 10: (32, 6400), 20: (24, 12800), 40: (16, 8000), 80: (8, 10000), 160: (4, 12000)}  # phantoms
LOOSE_ROUSE = {5: (64, 40000, 0), 10: (32, 100000, 1), 20: (16, 200000, 2)}  # and priority


def without_hydrodynamics():
    found = [chains(f"rouse-N{n}", n, 64, count, time, bath="phantoms", lag=819.2)
             for n, (count, time) in ROUSE.items()]
    found += [chains(f"loose-N{n}", n, 128, count, time, bath="phantoms", spring=LOOSE, every=6.4, lag=26214.4,
                     priority=priority) for n, (count, time, priority) in LOOSE_ROUSE.items()]
    return found + [chains("swap-N5", 5, 18, 10, 3000, bath="swap", priority=1),
                    chains("swap-N10", 10, 25, 16, 3500, bath="swap", priority=1)]


def campaign():
    found = without_hydrodynamics()
    for (n, box), (count, time, *limits) in SYSTEMS.items():
        for seed in range(1, limits[-1] + 1):
            priority = next(p for p, limit in enumerate(limits) if seed <= limit)
            found.append(chains(f"N{n}-L{box}-s{seed}", n, box, count, time, seed=1000 * n + seed, priority=priority))
    found += [chains(f"crowd-{count}", 10, 25, count, time, seed=count, priority=1) for count, time in CROWDED.items()]
    return found + [chains("crossing-N20", 20, 35, 20, 6000, seed=77, priority=2, crossing="forbidden")]


def quick():
    return [chains("N5-L12-s1", 5, 12, 4, 4000, seed=5001), chains("N10-L16-s1", 10, 16, 4, 4000, seed=10001),
            chains("N20-L20-s1", 20, 20, 4, 3000, seed=20001), chains("N40-L25-s1", 40, 25, 4, 1700, seed=40001),
            chains("rouse-N5", 5, 64, 32, 500, bath="phantoms", lag=204.8),
            chains("rouse-N10", 10, 64, 32, 500, bath="phantoms", lag=204.8),
            chains("rouse-N20", 20, 64, 16, 500, bath="phantoms", lag=204.8),
            chains("loose-N5", 5, 128, 64, 5000, bath="phantoms", spring=LOOSE, every=6.4, lag=1638.4)]


def runs(tier):
    return quick() if tier == "quick" else campaign()


def evaluate(results, tier):
    """Verdicts and figures from what there is."""
    return Outcome([])
