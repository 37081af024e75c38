#!/usr/bin/python3
"""The validation case rivals: what it measures of made-up frames, and its verdicts on made-up tables: alike, one crossing too many, apart."""
import importlib.util
import json
import math
import pathlib
import sys
import unittest

import numpy

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TREE / "validation"))
from lib import case, semidilute as sd  # noqa: E402

RIVALS = case.load("rivals")
spec = importlib.util.spec_from_file_location("rivals_methods", TREE / "validation/cases/rivals/methods.py")
methods = importlib.util.module_from_spec(spec)
sys.modules[spec.name] = methods
spec.loader.exec_module(methods)
measures = RIVALS.MEASURES


def needles(count, edge, seed, bonds=1):
    """Isotropic straight fibers at random places, bonds of length 1."""
    draw = numpy.random.Generator(numpy.random.PCG64(seed))
    along = draw.normal(size=(count, 3))
    along /= numpy.linalg.norm(along, axis=1)[:, None]
    return edge * draw.random((count, 1, 3)) + along[:, None] * numpy.arange(bonds + 1)[:, None]


class Measures(unittest.TestCase):
    def test_tube(self):
        origin = needles(5, 10.0, 1, bonds=11)
        along = origin[:, 1:2] - origin[:, :1]
        across = numpy.cross(along, numpy.roll(along, 1, axis=2))
        across /= numpy.linalg.norm(across, axis=-1)[..., None]
        numpy.testing.assert_allclose(measures.tube(origin, origin + 0.3 * across + 0.9 * along), 0.09, rtol=1e-9)
        rows = measures.motion(numpy.array([origin + 0.1 * k * across for k in range(5)]), 0.5, (0.5, 1.0, 5.0))
        self.assertEqual([row[0] for row in rows], [0.5, 1.0])
        numpy.testing.assert_allclose([(row[1], row[3]) for row in rows], [(0.01, 0.01), (0.04, 0.04)], rtol=1e-9)
        self.assertEqual([row[5] for row in rows], [4, 3])

    def test_close_pairs(self):
        """Lines without thickness have the pairs of theory; where close ones are taken away, the width is what was taken."""
        found = [measures.close_pairs(needles(1500, 12.0, seed), 12.0) for seed in range(4)]
        counts, ideal = (sum(one[k] for one in found) for k in (0, 1))
        self.assertTrue((abs(counts / ideal - 1.0) < 4.0 / numpy.sqrt(ideal)).all(), counts / ideal)
        self.assertAlmostEqual(measures.width(ideal - ideal[5], ideal), measures.NEAR[5], 12)  # none nearer than 0.1 a0

    def test_order(self):
        self.assertAlmostEqual(measures.order(numpy.array([[[0, 0, 0], [0, 0, 1]]] * 3, float)), 1.0)
        self.assertLess(measures.order(needles(4000, 9.0, 2)), 0.05)

    def test_possible(self):
        frame = needles(1000, 10.0, 3)  # (pi/8) rho^2 V <|v_n|>, rho = 1
        self.assertAlmostEqual(measures.possible(frame, 10.0, 5.0), math.pi / 8.0 * 1000.0 * math.sqrt(2.0 / (math.pi * 5.0)) * 1.151155, 6)
        draw = numpy.random.Generator(numpy.random.PCG64(4)).random((1000000, 2))
        levers = numpy.sqrt((1.0 - draw)**2 + draw**2)
        self.assertAlmostEqual(numpy.sqrt((levers**2).sum(1)).mean(), measures.LEVERS, 3)

    def test_free_motion(self):
        tube, center = measures.free_motion([1e-3, 1e4], 64, 5.0, 1.0, 64.0, sd.BOND2)
        self.assertAlmostEqual(tube[0] / (2.0 * 1e-6 / 5.0), 1.0, 2)  # both directions, ballistic
        self.assertAlmostEqual(center[0] / (3.0 * 1e-6 / 320.0), 1.0, 2)
        self.assertAlmostEqual(center[1] / (6.0 * 1e4 / 320.0), 1.0, 3)

    def test_methods(self):
        method = methods.Method.read("srp:range=0.2,barrier=4,dt=0.02")
        self.assertEqual((method.kind, method.range, method.barrier, method.dt, method.is_own), ("srp", 0.2, 4.0, 0.02, False))
        self.assertIn("srp 40\n", methods.contacts_of(method)["contacts"] + "\n")  # U(0) = C R/2
        self.assertEqual([methods.fibers_of(density) for density in (300, 1000, 3000)], [427, 1424, 4271])
        fine = methods.chain(127)  # half the bond: equal contour, stretch, friction and stiffness
        self.assertAlmostEqual(126 * fine["rest"], 63 * 0.5)
        self.assertAlmostEqual(127 * fine["mass"], 64 * 5.0)
        self.assertAlmostEqual(fine["spring"] * fine["rest"]**2, 25.0)
        length = sd.BOND / 2.0
        self.assertAlmostEqual(-length / math.log(1.0 / math.tanh(fine["bending"]) - 1.0 / fine["bending"]) / sd.PERSISTENCE, 1.0, 4)


class Made:
    def __init__(self, notes, rows):
        self.text = "".join(f"# {json.dumps(notes)}\n" if notes else "") + "names\n" + "".join(",".join(map(str, row)) + "\n" for row in rows)


def moved(change=1.0, narrow=0.0, seed=1):
    draw = numpy.random.Generator(numpy.random.PCG64(seed))
    near = list(measures.NEAR)
    ideal = numpy.array(near) * 1e5
    share = [max(0.0, 1.0 - narrow / e) for e in near]
    rows = []
    for lag in (2.5, 5.0, 10.0, 25.0, 50.0):
        tube, center = RIVALS.bare_theory(lag)
        noise = 1.0 + 0.005 * draw.normal(size=2)
        rows.append((lag, tube * change * noise[0], tube * 0.005, center * noise[1], center * 0.005, 100))
    return Made({"time": 205.0, "fibers": 427, "near": near, "share": share, "pairs": [int(x) for x in share * ideal], "temperature": 1.0, "bond2": 0.3, "order": [0.0, 0.0]}, rows)


def made(crossed=0, bare=1.0, srp=1.0):
    found = {f"{name}-300-s{seed}": moved(bare if name == "ghosts" else 1.0, seed=number)
             for number, name in enumerate(("free", "ghosts", "events", "sequential", "plain")) for seed in RIVALS.MOTION[f"{name}-300"][3]}
    for reach in (0.1, 0.2, 0.4):
        (seed,) = RIVALS.MOTION[f"srp-{reach}-300"][3]
        found[f"srp-{reach}-300-s{seed}"] = moved(srp * (1.0 - reach), 0.66 * reach, seed=int(100 * reach))
    for name in RIVALS.CROSSINGS:
        count = 1000 if name.startswith("free") else crossed if name.partition("-")[0] in ("events", "sequential", "plain") else 0
        found[f"crossings-{name}"] = Made({"possible": 1000.0}, [(stride, count, 0, 0, 0) for stride in (1, 2, 5, 10)])
    return found


def words(results):
    return {verdict.id: verdict.verdict for verdict in RIVALS.evaluate(results, "campaign").verdicts}


class Verdicts(unittest.TestCase):
    def test_alike(self):
        self.assertEqual(set(words(made()).values()), {"pass"})

    def test_one_crossing_is_too_many(self):
        found = words(made(crossed=1))
        self.assertEqual({name for name, word in found.items() if word == "fail"}, {name for name in found if name.startswith("rivals.crossings") and ".free." not in name})

    def test_apart(self):
        self.assertEqual({name for name, word in words(made(bare=1.08)).items() if word == "fail"}, {f"rivals.bare.{lag}" for lag in ("2.5", "10", "50")})
        self.assertEqual({name for name, word in words(made(srp=1.15)).items() if word == "fail"}, {"rivals.limit.10", "rivals.limit.50"})

    def test_absent(self):
        self.assertEqual(set(words({}).values()), {"undecided"})

    def test_time_to_an_error(self):
        self.assertAlmostEqual(RIVALS.seconds_to(0.02, 0.0, 0.6, 427, 0.3), 900.0 * 50.0 / 427.0 * 0.3)
        self.assertEqual(RIVALS.seconds_to(0.02, 0.02, 0.6, 427, 0.3), math.inf)
        self.assertAlmostEqual(RIVALS.seconds_to(0.02, 0.016, 0.6, 427, 0.3) / RIVALS.seconds_to(0.02, 0.0, 0.6, 427, 0.3), 1.0 / 0.36)

    def test_width(self):
        found = made()
        self.assertAlmostEqual(RIVALS.thickness(found, "srp-0.2-300")[0], 0.66 * 0.2, 3)
        self.assertAlmostEqual(RIVALS.thickness(found, "events-300")[0], 0.0, 3)


if __name__ == "__main__":
    unittest.main()
