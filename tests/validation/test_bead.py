#!/usr/bin/python3
"""The analysis of a bead's motion (validation/measure/bead.py), of motions that are made here."""
import importlib.util
import pathlib
import unittest

import numpy

TREE = pathlib.Path(__file__).resolve().parent.parent.parent
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


if __name__ == "__main__":
    unittest.main()
