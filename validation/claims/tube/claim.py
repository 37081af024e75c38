"""Fig. 4: what hydrodynamics and uncrossability do to d^2(t) in the densest suspension."""
from lib import semidilute as sd
from lib.claim import Outcome
from lib.runs import Run

TITLE = "The tube: hydrodynamics and uncrossability"
PAPER = "Fig. 4"

# name -> (solvent, crossings forbidden)
CASES = {"hi-entangled": (sd.SOLVENT, "true"), "hi-free": (sd.SOLVENT, "false"),
         "off-entangled": (sd.BATH, "true"), "off-free": (sd.BATH, "false")}
# The same at short lags with other choices: none of them may move d^2.
CHOICES = {"none": {"solvent": sd.FREE_SOLVENT},
           "maxwell-boltzmann": {"solvent": "thermostat: maxwell-boltzmann"},
           "bounce": {"refusal": "bounce"},
           "dt5": {"dt": 0.005}}


def campaign():
    # c L^3 = 1000. 7,200,000 steps are one tau_r with hydrodynamics; a third of it is 2,200,000.
    long = {"hi-entangled": (7200000, 19.0, ((300000, 0), (2200000, 1))),
            "hi-free": (7200000, 6.4, ((300000, 0), (2200000, 1))),
            "off-entangled": (4800000, 10.7, ((300000, 0), (1200000, 1))),
            "off-free": (4800000, 4.3, ((300000, 0), (1200000, 1)))}
    found = []
    for number, (name, (solvent, forbidden)) in enumerate(CASES.items()):
        steps, hours, goals = long[name]
        found.append(Run(name, scene=sd.scene(count=1000, solvent=solvent, forbidden=forbidden), steps=steps, hours=hours,
                         seed=400 + number, priority=2, goals=goals))
        found.append(Run(name + "-short", steps=4000, hours=0.012, seed=410 + number,
                         scene=sd.scene(count=1000, solvent=solvent, forbidden=forbidden, every=1, longest_lag=1024,
                                  series=100)))
    for number, (name, values) in enumerate(CHOICES.items()):
        scale = int(round(0.01 / values.get("dt", 0.01)))
        found.append(Run("choice-" + name, steps=4000 * scale, hours=0.012 * scale, seed=420 + number,
                         scene=sd.scene(count=1000, every=scale, longest_lag=1024 * scale, series=100, **values)))
    # Four fibers in one box: each is dilute, and four times the turning is seen for the same solvent. 40 without
    # hydrodynamics, where nobody feels anybody.
    found.append(Run("rotation-hi", steps=10000000, hours=2.6, seed=431, priority=2, goals=((2000000, 0), (4000000, 1)),
                     scene=sd.scene(count=4, forbidden="false", every=1000, longest_lag=1024000)))
    found.append(Run("rotation-off", steps=20000000, hours=1.2, seed=432, priority=1, goals=((4000000, 0),),
                     scene=sd.scene(count=40, solvent=sd.BATH, forbidden="false", every=1000, longest_lag=2048000)))
    return found


def quick():
    # c L^3 = 400 of fibers of 24 vertices, L = 12: a mesh of 1.04 a0, a tube that shows within 10 t0.
    small = {"box": 12, "vertices": 24, "count": 400, "every": 5, "longest_lag": 2560}
    found = [Run(name, scene=sd.scene(solvent=solvent, forbidden=forbidden, **small), steps=6000, seed=440 + number,
                 hours=0.003 if forbidden == "true" else 0.001)
             for number, (name, (solvent, forbidden)) in enumerate(CASES.items())]
    found += [Run("choice-" + name, scene=sd.scene(**{**small, **CHOICES[name]}), steps=3000, seed=450 + number, hours=0.002)
              for number, name in enumerate(("none", "bounce"))]
    return found


def runs(tier):
    return quick() if tier == "quick" else campaign()


def evaluate(results, tier):
    return Outcome([])
