"""Fig. 3: a suspension in a uniform flow."""
from lib import semidilute as sd
from lib.claim import Outcome
from lib.runs import Run

TITLE = "Galilean invariance, and the lag behind a flow"
PAPER = "Fig. 3"
FLOWS = (0, 0.09, 0.18, 0.36, 0.54)
QUICK = {"flow00": {}, "flow54": {"flow": 0.54}, "comoving54": {"flow": 0.54, "refusal": "bounce", "frame": "flow"}}


def campaign():
    hours = {0: 0.28, 0.09: 0.29, 0.18: 0.31, 0.36: 0.36, 0.54: 0.42}
    common = {"count": 1000, "longest_lag": 100000, "series": 1000}
    found = [Run(f"flow{round(100 * v):02d}", scene=sd.scene(flow=v, **common), steps=100000, hours=hours[v], seed=300 + k)
             for k, v in enumerate(FLOWS)]
    found.append(Run("comoving54", steps=100000, hours=0.28, seed=310,
                     scene=sd.scene(flow=0.54, refusal="bounce", frame="flow", **common)))
    for k, v in enumerate((0, 0.54)):  # no thermostat: what becomes of the energy
        found.append(Run(f"isolated{round(100 * v):02d}", steps=10000, hours=0.04, seed=320 + k,
                         scene=sd.scene(flow=v, solvent=sd.FREE_SOLVENT, **{**common, "series": 100})))
    # How far the vertices fall behind, for each rule: as many per volume in 16^3 cells.
    found.append(Run("lag", hours=0.1,
                     program=["refused_moves", 16, 208, 38, 0.54, 144, 330, "kick-split", 0.02, 0.01, 0.005]))
    return found


def quick():
    # As many vertices per volume, in an eighth of the box.
    common = {"box": 16, "vertices": 38, "count": 208, "longest_lag": 2560, "every": 10}
    found = [Run(name, scene=sd.scene(**common, **values), steps=6000, hours=0.004, seed=340 + k)
             for k, (name, values) in enumerate(QUICK.items())]
    found.append(Run("isolated54", steps=1000, hours=0.001, seed=350,
                     scene=sd.scene(flow=0.54, solvent=sd.FREE_SOLVENT, series=20, **common)))
    found.append(Run("lag", hours=0.004, program=["refused_moves", 16, 208, 38, 0.54, 48, 351, "kick-split", 0.01, "--",
                                                  "stay", "bounce-flow"]))
    return found


def runs(tier):
    return quick() if tier == "quick" else campaign()


def evaluate(results, tier):
    return Outcome([])
