"""What the case `entangled` is compared with: exact sums against sampled chains and elementary limits."""
import math
import pathlib
import sys
import unittest

import numpy

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TREE / part) for part in ("validation", "validation/measure", "python")]

import sizes
import topology
from lib import case as cases
from lib import entangled


class Statics(unittest.TestCase):
    def test_bonds(self):
        r = numpy.linspace(1e-6, 1.5, 200001)
        weight = r**2 * numpy.exp(-50.0 * (r - 0.5)**2)
        for power, exact in enumerate(entangled.bond_moments(), 1):
            self.assertAlmostEqual((weight * r**power).sum() / weight.sum() / exact, 1.0, 5)

    def test_sampled_chains(self):
        for persistence in 0.5, 2.0:
            square = entangled.ideal_distances(24, persistence, 50000, 7)**2
            error = square.std() / len(square)**0.5
            self.assertLess(abs(square.mean() - entangled.end_to_end(24, persistence)), 4.0 * error)
        self.assertTrue(numpy.allclose(entangled.deciles(24, count=100000, seed=3), entangled.DECILES, atol=0.02))

    def test_gyration(self):
        """Of three vertices in a row: R_g^2 = (r01^2 + r12^2 + r02^2)/9."""
        square = entangled.bond_moments()[1]
        self.assertAlmostEqual(entangled.gyration(3), (2.0 * square + entangled.end_to_end(3)) / 9.0)

    def test_the_curve(self):
        """Row 3 of the table that the runs come from: L_e = 9.18 a0, 17 bonds."""
        self.assertAlmostEqual(entangled.entanglement() * entangled.bond_moments()[0], 9.18, 1)


class Motion(unittest.TestCase):
    def test_limits(self):
        early = entangled.displacement(1e-4, 24)[0]
        self.assertAlmostEqual(early / (3.0 / 5.0 * 1e-8), 1.0, 4)
        late = entangled.displacement([1e6, 2e6], 24)
        self.assertAlmostEqual((late[1] - late[0]) / 1e6 / (6.0 / 5.0 / 24.0), 1.0, 6)

    def test_interior(self):
        """Of a long chain, between bonds and ends: Rouse's line."""
        for t, near in (100.0, 0.06), (1600.0, 0.015):
            self.assertLess(abs(float(entangled.displacement(t, 600)[0] / entangled.rouse_line(t)) - 1.0), near)

    def test_lines_meet(self):
        bonds = 17.0
        meet = math.pi / 9.0 * entangled.rouse_time(bonds)
        self.assertAlmostEqual(float(entangled.rouse_line(meet) / entangled.tube_line(meet, bonds)), 1.0, 12)

    def test_what_a_contact_forgets(self):
        """Four vertices with thermal velocities meet with the weight of their speed of approach, and turn it round."""
        random = numpy.random.default_rng(5)
        s, other = random.random((2, 400000))
        levers = numpy.array([1.0 - s, s, other - 1.0, -other])
        v = random.normal(size=levers.shape) / math.sqrt(entangled.MASS)
        speed, inverse = (levers * v).sum(axis=0), (levers**2).sum(axis=0) / entangled.MASS
        weight = numpy.maximum(speed, 0.0)
        after = v - levers / entangled.MASS * 2.0 * speed / inverse
        lost = entangled.MASS * (v * (v - after)).sum(axis=0)
        self.assertAlmostEqual((weight * lost).sum() / weight.sum() / 4.0, 1.0, 2)

    def test_what_friction_leaves(self):
        kept = cases.load("entangled").kept
        t = 0.3  # 2 kT/M Gamma [t - (1 - exp -Gamma t)/Gamma] over kT t^2/M
        self.assertAlmostEqual(kept(2.0 * t), (t - (1.0 - math.exp(-2.0 * t)) / 2.0) / t**2, 12)


class Measured(unittest.TestCase):
    def test_sizes_of_rings(self):
        """Of a square: the diagonal, and half of it squared."""
        square = numpy.array([[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]] * 2, float)
        across, across_error, about, about_error = topology.ring_sizes(square)
        self.assertEqual((across, across_error, about, about_error), (2.0, 0.0, 0.5, 0.0))

    def test_distances(self):
        places = numpy.zeros((1, 4, 3))
        places[0, :, 0] = 0, 2, 0, 5
        file = {"particles/trajectory/position/value": places, "connectivity/bonds": [[0, 1], [2, 3]]}
        self.assertEqual(sizes.distances(file).tolist(), [[2.0, 5.0]])


if __name__ == "__main__":
    unittest.main()
