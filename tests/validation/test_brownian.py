#!/usr/bin/python3
"""Brownian dynamics with hydrodynamic interactions: the tensor, the step, and what must not be lost."""
import math
import pathlib
import sys
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "validation"))
from lib import brownian, dilute  # noqa: E402

ETA, SPREAD = dilute.ETA, dilute.CELL_SPREAD


class Tensor(unittest.TestCase):
    def setUp(self):
        self.random = numpy.random.Generator(numpy.random.PCG64(3))

    def test_trace(self):
        """A third of it is the scalar field that Kirkwood's sum takes."""
        apart = self.random.normal(size=(50, 3))
        trace = numpy.trace(brownian.smeared_oseen(apart, ETA, SPREAD), axis1=1, axis2=2) / 3.0
        expected = dilute.smeared_pair(numpy.linalg.norm(apart, axis=1)) * dilute.stokes(1.0)
        self.assertLess(float(abs(trace / expected - 1.0).max()), 1e-12)

    def test_far_and_near(self):
        """Oseen's far away; at one place kT/(6 pi eta) sqrt(2/(pi spread)), in all directions."""
        far = brownian.smeared_oseen(numpy.array([30.0, 0.0, 0.0]), ETA, SPREAD) * 8.0 * math.pi * ETA * 30.0
        self.assertLess(float(abs(far - numpy.diag([2.0, 1.0, 1.0])).max()), 1e-3)
        near = brownian.smeared_oseen(numpy.zeros(3), ETA, SPREAD) / (dilute.stokes(1.0) * math.sqrt(2.0 / (math.pi * SPREAD)))
        self.assertLess(float(abs(near - numpy.eye(3)).max()), 1e-5)

    def test_no_divergence(self):
        """Why the step needs no drift."""
        h = 1e-4
        for at in self.random.normal(size=(20, 3)):
            slope = sum((brownian.smeared_oseen(at + h * unit, ETA, SPREAD) - brownian.smeared_oseen(at - h * unit, ETA, SPREAD))[k]
                        for k, unit in enumerate(numpy.eye(3))) / (2.0 * h)
            self.assertLess(float(abs(slope).max()), 1e-8)

    def test_positive(self):
        shapes = self.random.normal(size=(20, 12, 3)) * 0.3  # much in one place
        self.assertGreater(float(numpy.linalg.eigvalsh(brownian.mobility(shapes, 1e-4, ETA, SPREAD)).min()), 0.0)


class Slowing(unittest.TestCase):
    def test_dumbbell_loses_nothing(self):
        """Its two forces are opposite, and so is what either does to the other."""
        _, lost, _, _ = brownian.slowing(2, 8, 5.0, 0.01, ETA, SPREAD)
        self.assertLess(float(abs(lost).max()), 1e-15)

    def test_first_moment(self):
        """<A.A>/3 of a chain without a field: forces cancel, so nothing; with it, <A.A> at once is exact for three vertices:
        A = (1/3) sum_i (sum_j mu_ij) F_j, averaged here over shapes of their own, by another sum."""
        _, lost, _, _ = brownian.slowing(3, 64, 2.0, 0.01, 1e9, SPREAD)
        self.assertLess(float(abs(lost).max()), 1e-12)
        random = numpy.random.Generator(numpy.random.PCG64(9))
        bonds = random.normal(0.0, math.sqrt(1.0 / 3.0), (40000, 2, 3))
        x = numpy.concatenate([numpy.zeros((40000, 1, 3)), numpy.cumsum(bonds, axis=1)], axis=1)
        pair = [brownian.smeared_oseen(x[:, i] - x[:, j], ETA, SPREAD) for i, j in ((0, 1), (1, 2), (0, 2))]
        force = [3.0 * bonds[:, 0], 3.0 * (bonds[:, 1] - bonds[:, 0]), -3.0 * bonds[:, 1]]
        total = sum((m @ (force[i] + force[j])[:, :, None])[:, :, 0] for m, (i, j) in zip(pair, ((0, 1), (1, 2), (0, 2)))) / 3.0
        square = (total**2).sum(axis=1) / 3.0
        times, lost, error, _ = brownian.slowing(3, 2000, 2.0, 0.01, ETA, SPREAD)
        kirkwood = 0.01 / 3.0 + dilute.cells_chain(3, 0.0)
        slope = lost[1] / times[1] * kirkwood
        self.assertAlmostEqual(slope / square.mean(), 1.0, delta=5.0 * error[1] / lost[1] + 0.03)

    def test_memory_fades(self):
        """What is lost by 10 t0 is less than 0.7 of what would be if nothing were forgotten after 1 t0, and more than then."""
        times, lost, _, _ = brownian.slowing(8, 100, 20.0, 0.01, ETA, SPREAD)
        one, ten = (lost[round(t / times[1])] for t in (1.0, 9.75))
        self.assertTrue(1.1 * one < ten < 0.7 * 9.75 * one)

    def test_keeps_its_size(self):
        """Force and noise belong together: <R^2> stays, within five errors of 1000 Gaussian vectors."""
        size = brownian.slowing(4, 1000, 30.0, 0.01, ETA, SPREAD)[3]
        self.assertAlmostEqual(size, 1.0, delta=5.0 * math.sqrt(2.0 / 3.0 / 1000.0))


if __name__ == "__main__":
    unittest.main()
