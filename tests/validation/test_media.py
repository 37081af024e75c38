#!/usr/bin/python3
"""What the case `media` computes (validation/lib/media.py, validation/measure/apart.py), against numbers of their own."""
import importlib.util
import math
import pathlib
import sys
import unittest

import numpy

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TREE / "validation"))
from lib import dilute, media  # noqa: E402

spec = importlib.util.spec_from_file_location("apart", TREE / "validation/measure/apart.py")
apart = importlib.util.module_from_spec(spec)
spec.loader.exec_module(apart)


class Shapes(unittest.TestCase):
    def test_three_vertices(self):
        """On a line at 0, 1 and 3: (2/9)(1 + 1/2 + 1/3); with spheres of radius 1 the pairs at 1 and 2 overlap or touch."""
        places = numpy.array([[[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]]]])
        self.assertAlmostEqual(apart.inverse(places, 1e-3)[0], 2.0 / 9.0 * (1.0 + 0.5 + 1.0 / 3.0), 12)
        self.assertAlmostEqual(apart.inverse(places, 1.0)[0], 2.0 / 9.0 * (0.75 + 0.5 + 1.0 / 3.0), 12)

    def test_gaussian_chains_give_kirkwoods_number(self):
        """0.28559 of D0 for ten vertices with a = b/4 (an integral over the Gaussian distances)."""
        rng = numpy.random.default_rng(3)
        places = numpy.cumsum(rng.normal(0.0, math.sqrt(1.0 / 3.0), (200, 20, 10, 3)), axis=2)
        values = 0.1 + 0.25 * apart.inverse(places, 0.25)
        self.assertLess(abs(values.mean() - 0.28559), 4.0 * values.std(ddof=1) / math.sqrt(len(values)))


class Memory(unittest.TestCase):
    def test_its_integral_is_kirkwoods(self):
        """Of two different vertices: int_0^inf of their part is kT <1/r>/6 pi eta N^2, with <1/r> = sqrt(6/pi)/b of a bond. So
        for two vertices C less that of points, (2/3 rho N)(4 pi nu t)^(-3/2), has the integral sqrt(6/pi)/(6 pi eta 2)."""
        nu, rho = 2.0, 3.0
        x = numpy.linspace(-12.0, 14.0, 20001)  # ln t
        t = numpy.exp(x)
        points = 2.0 / (3.0 * rho * 2.0) * (4.0 * math.pi * nu * t) ** -1.5
        total = numpy.trapz((media.memory_form(t, 2, nu, rho) - points) * t, x) + 0.0
        self.assertAlmostEqual(total / (math.sqrt(6.0 / math.pi) / (12.0 * math.pi * nu * rho)), 1.0, 2)

    def test_late_it_is_that_of_one_point(self):
        late = media.memory_form([1e6], 10, 1.0, 1.0)[0] / (2.0 / 3.0 * (4.0 * math.pi * 1e6) ** -1.5)
        self.assertAlmostEqual(late, 1.0, 5)


class Known(unittest.TestCase):
    def test_kirkwood_of_a_fluid(self):
        """The part of the others depends on the viscosity alone: 1/6 pi eta <1/r>."""
        fluid = media.Known(2.0, 0.02, 0.1, 0.001)
        inverse = 0.7
        value, error = fluid.kirkwood((10, inverse * fluid.radius))
        others = inverse / (12.0 * math.pi)
        self.assertAlmostEqual(value, 0.01 + others, 12)
        self.assertAlmostEqual(error, math.hypot(0.0001, 0.01 * others), 12)

    def test_molecular_chaos(self):
        """Schmidt number 5/8 + (2 pi^2/675)(rho Gamma)^2."""
        eta, d = media.chaos(10.0, 0.0)
        self.assertAlmostEqual(eta / 3.0 / d, 0.625 + 2.0 * math.pi ** 2 / 675.0 * 900.0, 12)

    def test_a_chain_in_a_large_box_is_its_own(self):
        self.assertAlmostEqual(dilute.kirkwood_chain(10, 0.25) / dilute.stokes(0.25), 0.28559, 4)


if __name__ == "__main__":
    unittest.main()
