#!/usr/bin/python3
"""What a solute's own vertices add to the viscosity around it: first order, against what is known exactly."""
import math
import pathlib
import sys
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "validation"))
from lib import own_fluid  # noqa: E402

SPREAD = 1.0 / 6.0


class OwnFluid(unittest.TestCase):
    def test_one_vertex(self):
        """In a large box the mobility is that of a Gaussian of twice the variance, (1/6 pi eta) sqrt(2/pi)/sqrt(2 spread), less
        the images' 2.837297/L; and the loss does not know the box."""
        point, losses = numpy.zeros((1, 3)), []
        for cells in (48, 64):
            mobility, lost = own_fluid.loss(point, own_fluid.Grid(cells), SPREAD)
            expected = (math.sqrt(2.0 / math.pi / (2.0 * SPREAD)) - 2.837297 / (cells * own_fluid.SPACING)) / (6.0 * math.pi)
            self.assertAlmostEqual(mobility / expected, 1.0, 2)
            losses.append(lost)
        self.assertAlmostEqual(losses[0] / losses[1], 1.0, 2)

    def test_power_is_dissipation(self):
        """Others everywhere, one per cell, take all of the mobility: the force's power is what the fluid dissipates."""
        grid = own_fluid.Grid(32)
        points = numpy.random.Generator(numpy.random.PCG64(4)).normal(size=(7, 3))
        mobility, own = own_fluid.loss(points, grid, SPREAD)
        self.assertAlmostEqual((own_fluid.loss(points, grid, SPREAD, others=1.0)[1] - own) / mobility, 1.0, 4)

    def test_two_far_apart(self):
        """Each has half the force: half of what one alone loses, and little from the other."""
        grid = own_fluid.Grid(64)
        one = own_fluid.loss(numpy.zeros((1, 3)), grid, SPREAD)[1]
        two = own_fluid.loss(numpy.array([[0.0, 0.0, 0.0], [14.0, 0.0, 0.0]]), grid, SPREAD)[1]
        self.assertAlmostEqual(two / one, 0.5, 2)

    def test_does_not_know_the_grid(self):
        """A shift by a third of its spacing, and any turn by a quarter about the force, changes nothing, or (the spacing) half a per cent."""
        points = numpy.random.Generator(numpy.random.PCG64(5)).normal(size=(9, 3))
        grid = own_fluid.Grid(48)
        lost = [own_fluid.loss(p, grid, SPREAD)[1] for p in
                (points, points + 0.17, numpy.stack([-points[:, 1], points[:, 0], points[:, 2]], axis=1))]
        self.assertAlmostEqual(lost[1] / lost[0], 1.0, 2)
        self.assertAlmostEqual(lost[2] / lost[0], 1.0, 6)


if __name__ == "__main__":
    unittest.main()
