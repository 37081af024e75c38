#!/usr/bin/python3
"""The analysis of a bead's motion (validation/measure/bead.py), of motions that are made here."""
import importlib.util
import pathlib
import sys
import unittest

import numpy
from scipy import integrate

TREE = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TREE / "validation"))
from lib import slit  # noqa: E402

spec = importlib.util.spec_from_file_location("bead", TREE / "validation/measure/bead.py")
bead = importlib.util.module_from_spec(spec)
spec.loader.exec_module(bead)

FRICTION, STEP, TIMES = 50.0, 0.5, 200000


def walk(seed, drift=0.0):
    """Brownian motion of friction 50, with a drift along x."""
    rng = numpy.random.default_rng(seed)
    place = numpy.cumsum(rng.normal(size=(3, TIMES)) * numpy.sqrt(2.0 * STEP / FRICTION), axis=1)
    time = STEP * numpy.arange(TIMES)
    place[0] += drift * time
    return time, place


def trapped(seed, spring, amplitude=0.0, omega=1.0):
    """The same in a trap that swings along x: exact steps of an Ornstein-Uhlenbeck process about the steady swing."""
    rng = numpy.random.default_rng(seed)
    time, keep = STEP * numpy.arange(TIMES), numpy.exp(-spring / FRICTION * STEP)
    noise = rng.normal(size=(3, TIMES)) * numpy.sqrt((1.0 - keep ** 2) / spring)
    place = numpy.zeros((3, TIMES))
    for k in range(1, TIMES):
        place[:, k] = keep * place[:, k - 1] + noise[:, k]
    response = spring / (spring + 1j * omega * FRICTION)
    trap = amplitude * numpy.sin(omega * time)
    place[0] += amplitude * (response * numpy.exp(1j * omega * time)).imag
    force = -spring * place
    force[0] += spring * trap
    return time, place, force


class Bead(unittest.TestCase):
    def near(self, found, expected):
        value, error = found
        self.assertLess(abs(value - expected), 4.5 * error)
        self.assertLess(error, 0.05 * abs(expected))

    def test_friction_of_a_force(self):
        time, place = walk(1, drift=0.12)
        force = numpy.zeros_like(place)
        force[0] = 6.0
        self.near(bead.active_friction(time, place, force, rest=50.0), 50.0 * 1.02)

    def test_friction_of_a_trap_that_moves(self):
        time = numpy.linspace(0.0, 400.0, 8001)
        trap = numpy.outer([0.03, 0.0, -0.04], time)
        noise = numpy.random.default_rng(3).normal(0.0, 0.5, (3, len(time)))
        self.near(bead.drawn_friction(time, trap, 50.0 * numpy.array([[0.03], [0.0], [-0.04]]) + noise), 50.0)

    def test_friction_of_a_walk(self):
        self.near(bead.passive_friction(*walk(2)), FRICTION)

    def test_transform_of_a_line_is_that_of_a_line(self):
        time = numpy.linspace(0.0, 7.0, 50)
        self.assertAlmostEqual(bead.line_transform(time, 3.0 * time, 0.7), -3.0 / 0.49, places=12)

    def test_transform_of_a_relaxation(self):
        """1 - exp(-t/2): 1/(i w) - 1/(i w + 1/2)."""
        time = numpy.linspace(0.0, 60.0, 60001)
        for omega in 0.1, 1.0, 5.0:
            exact = 1.0 / (1j * omega) - 1.0 / (1j * omega + 0.5)
            self.assertLess(abs(bead.line_transform(time, 1.0 - numpy.exp(-0.5 * time), omega) - exact), 1e-5)

    def test_a_swinging_trap_measures_the_viscosity(self):
        omega = 0.3
        time, place, force = trapped(3, 20.0, amplitude=0.6, omega=omega)
        value, error = bead.active_modulus(time, place, force, 2.0, 0.0, omega)
        expected = FRICTION * omega / (12.0 * numpy.pi)
        self.near((value[1], error[1]), expected)
        self.assertLess(abs(value[0]), 4.5 * error[0])

    def test_a_walk_measures_the_viscosity(self):
        time, place = walk(4)
        value, error = bead.passive_moduli(time, place, 2.0, 0.0, 0.0, [0.2], longest=40.0)
        self.near((value[0][1], error[0][1]), FRICTION * 0.2 / (12.0 * numpy.pi))

    def test_inertia_is_taken_off(self):
        time, place, force = trapped(3, 20.0, amplitude=0.6, omega=0.3)
        light, heavy = (bead.active_modulus(time, place, force, 2.0, mass, 0.3)[0][0] for mass in (0.0, 100.0))
        self.assertAlmostEqual(heavy - light, 100.0 * 0.09 / (12.0 * numpy.pi), places=9)


class Slit(unittest.TestCase):
    def test_walls_slow_a_point_force_as_faxen_says(self):
        """First coefficients of his series (Happel and Brenner 1965, Chapter 7): of radius over height, for 1/(6 pi eta radius)."""
        for height, distance, expected in ((1.0, 2.0, 1.004), (1.0, 4.0, 0.6526), (1.0, 4000.0, 9.0 / 16.0)):
            def lost(k, y=height, d=distance):
                return 0.375 - k * 0.5 * (slit.transverse(k, y, d) + slit.longitudinal(k, y, d))
            found = sum(integrate.quad(lost, *part, epsabs=1e-5)[0] for part in ((1e-4, 1e-3), (1e-3, 0.01), (0.01, 0.1), (0.1, 30.0)))
            self.assertAlmostEqual(3.0 * found, expected, delta=0.0006)

    def test_images_near_one_wall(self):
        """Far from a point force at height h over a wall the flow is 3 h^2 x^2/(2 pi eta r^5) at that height (Blake 1971, the first term);
        the sum of 1/r^3 over a square lattice is 9.0336/L^3."""
        for length, known in ((40.0, 0.04), (120.0, 0.02)):
            expected = 1.5 * 2.0**2 / numpy.pi * 0.5 * 9.0336 / length**3
            self.assertAlmostEqual(slit.images(2.0, 4000.0, length) / expected, 1.0, delta=known)

    def test_narrow_slit_has_the_mean_flow_alone(self):
        """Images across H exp(-pi L/H) see one another by the flow through the slit only: of parabolic weight w, by half."""
        self.assertAlmostEqual(slit.images(1.0, 2.0, 20.0) / (2.0 * 1.5**2 / (24.0 * 400.0)), 1.0, delta=1e-4)


if __name__ == "__main__":
    unittest.main()
