#!/usr/bin/python3
"""What a solute's own vertices add to the viscosity around it: Stokes' equation with that viscosity, against what is known."""
import math
import pathlib
import sys
import unittest

import numpy
from scipy import integrate

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "validation"))
from lib import brownian, case, dilute, own_fluid  # noqa: E402

SPREAD = 1.0 / 6.0


def losses(points, gain, cells=48):
    return [without - own for without, own in own_fluid.mobilities(points, own_fluid.Grid(cells), SPREAD, gain)]


class OwnFluid(unittest.TestCase):
    def test_one_vertex(self):
        """In a large box the mobility is that of a Gaussian of twice the variance, (1/6 pi eta) sqrt(2/pi)/sqrt(2 spread), less
        the images' 2.837297/L."""
        for without, _ in own_fluid.mobilities(numpy.zeros((1, 3)), own_fluid.Grid(64), SPREAD, 0.0):
            expected = (math.sqrt(2.0 / math.pi / (2.0 * SPREAD)) - 2.837297 / 32.0) / (6.0 * math.pi)
            self.assertAlmostEqual(without / expected, 1.0, 3)

    def test_first_order(self):
        """2 int n e:e dr of one vertex in an infinite fluid, by quadrature in real space of another program's field, whose
        gradients are differences. The grid is good to 4 %."""
        h = 1e-3

        def power(r, cosine):
            at = r * numpy.array([math.sqrt(1.0 - cosine**2), 0.0, cosine])
            flow = numpy.array([[brownian.smeared_oseen(at + s * h * unit, 1.0, SPREAD)[:, 2] for unit in numpy.eye(3)]
                                for s in (1.0, -1.0)])
            slope = (flow[0] - flow[1]) / (2.0 * h)
            density = math.exp(-r * r / (2.0 * SPREAD)) / (2.0 * math.pi * SPREAD)**1.5
            return 4.0 * math.pi * r * r * density * 2.0 * float(((0.5 * (slope + slope.T))**2).sum())
        expected = 0.5 * integrate.dblquad(power, -1.0, 1.0, 0.0, 2.5, epsrel=1e-3)[0]
        self.assertAlmostEqual(expected, 0.003274, 5)
        for loss in losses(numpy.zeros((1, 3)), 0.02):
            self.assertAlmostEqual(loss / 0.02 / expected, 1.0, delta=0.04)

    def test_heavier_everywhere(self):
        """A flow in a fluid that is 1.7 times as viscous everywhere is 1.7 times slower."""
        grid = own_fluid.Grid(32)
        density = grid.points(numpy.random.Generator(numpy.random.PCG64(4)).normal(size=(7, 3)), SPREAD)
        force = [0.5 * density, numpy.zeros_like(density), density]
        slow = own_fluid.flow_of(force, 1.7, grid)
        self.assertAlmostEqual(grid.product(force, slow) * 1.7 / grid.product(force, grid.stokes(force)), 1.0, 6)

    def test_solves(self):
        """What is left of the force, less what keeps the flow going, is nothing, where the viscosity varies by a factor of 4."""
        grid = own_fluid.Grid(32)
        density = grid.points(numpy.random.Generator(numpy.random.PCG64(4)).normal(size=(20, 3)), SPREAD)
        viscosity, force = 1.0 + 1.5 * grid.real(density), [numpy.zeros_like(density), density, numpy.zeros_like(density)]
        self.assertGreater(float(viscosity.max()), 3.0)
        flow = own_fluid.flow_of(force, viscosity, grid)
        rest = [f - w for f, w in zip(grid.incompressible(force), grid.friction(flow, viscosity))]
        self.assertLess(grid.product(rest, grid.stokes(rest)) / grid.product(force, flow), 1e-7)

    def test_two_far_apart(self):
        """Each has half the force: half of what one alone loses, and little from the other."""
        one, two = (numpy.mean(losses(numpy.array(points), 0.7, 64)) for points in
                    ([[0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0], [14.0, 0.0, 0.0]]))
        self.assertAlmostEqual(two / one, 0.5, 2)

    def test_does_not_know_directions(self):
        """A rod along x loses in x, y, z what one along y does in y, z, x."""
        row = numpy.zeros((9, 3))
        row[:, 0] = 0.5 * numpy.arange(9)
        one, two = losses(row, 0.7), losses(row[:, [2, 0, 1]], 0.7)
        for axis in range(3):
            self.assertAlmostEqual(one[axis] / two[(axis + 1) % 3], 1.0, 5)

    def test_table(self):
        """A row of the case's table, made again from one rod: three axes of one shape are all."""
        rods = case.load("rods")
        value, _ = own_fluid.share(lambda random: dilute.rod_shape(10, rods.BOND, random), 1.55, 1, SPREAD)
        whole = dilute.cells_rod(10, rods.BOND, 0.0)
        self.assertAlmostEqual(value / dilute.ETA / whole, rods.OWN[10][0], delta=rods.OWN[10][1])

    def test_gain(self):
        """Vertices far apart: (<m - sum m^2/m> with one, less without) over <n - 1 + exp(-n)>, 2.8887/4.0067. All in one cell
        hand on more each: two, as much as 3.67 for 3 of a cell of 5."""
        random = numpy.random.Generator(numpy.random.PCG64(7))
        n, weight = dilute.poisson(5.0)
        alone = own_fluid.gain_of([numpy.arange(30.0).reshape(10, 3)], 20, random)
        self.assertAlmostEqual(alone, 2.8887 / 4.006738, 4)
        pair = own_fluid.gain_of([numpy.zeros((2, 3))], 20, random)
        two = float(weight @ (10.0 + n - (50.0 + n) / (10.0 + n))) - float(weight @ numpy.maximum(n - 1.0, 0.0))
        self.assertAlmostEqual(pair, 0.5 * two / 4.006738, 4)
        self.assertGreater(pair, 1.1 * alone)


if __name__ == "__main__":
    unittest.main()
