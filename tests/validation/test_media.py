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
from lib import dilute, filaments, integrators, interfaces, media  # noqa: E402

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


class Table:
    """As much of a Result as the parts of the case use."""

    def __init__(self, columns, name=None):
        self.columns = {key: numpy.array(value, dtype=float) for key, value in columns.items()}
        self.name = name

    def table(self, _name):
        return self.columns

    def tables(self):
        return [self.name]


def verdict(found, name):
    return next(v for v in found if v.id == name)


class Integrators(unittest.TestCase):
    def test_expected(self):
        """dt zeta/2 = 0.02 (4 pi/3) gamma rho/60 with int r^2 (1 - r)^2 = 1/30."""
        self.assertAlmostEqual(verdict(integrators.verdicts({}), "media.integrators.gap").expected, 0.02 * 4.0 * math.pi / 3.0 * 4.5 * 3.0 / 60.0, 12)

    def test_order_of_the_step(self):
        columns = {"dt": [0.03, 0.06], "configurational": [1.02, 1.08], "configurational_error": [0.0002, 0.0004]}
        found = verdict(integrators.verdicts({"integrator-peters": Table(columns)}), "media.integrators.order")
        self.assertAlmostEqual(found.measured, 4.0, 12)
        self.assertAlmostEqual(found.error, 4.0 * math.hypot(0.01, 0.005), 12)
        self.assertEqual(found.verdict, "pass")

    def test_a_gas_that_gathers_is_seen(self):
        columns = {"dt": [0.02], "close": [2.4], "close_error": [0.06]}
        found = integrators.verdicts({"ideal40-groot-warren": Table(columns), "ideal40-peters": Table(columns)})
        self.assertEqual(verdict(found, "media.integrators.gas.groot-warren").verdict, "not reproduced")
        self.assertEqual(verdict(found, "media.integrators.gas.peters").verdict, "fail")


class Interfaces(unittest.TestCase):
    def test_liquid_without_pressure(self):
        """rho - 4.04 rho^2 + 1.5978515625 (rho^3 - 4.16 rho^2 + 18) = 0: 6.0900 by hand (Newton)."""
        rho = interfaces.root(5.0, 7.0)
        self.assertAlmostEqual(rho - 4.04 * rho ** 2 + 1.59785156 * (rho ** 3 - 4.16 * rho ** 2 + 18.0), 0.0, 5)
        self.assertTrue(6.0 < rho < 6.2)

    def test_profile_is_centered(self):
        """A liquid of 6 over 8 of 16 a0, across the faces of the box."""
        y = (numpy.arange(64) + 0.5) / 4.0
        density = numpy.where((y < 3.0) | (y > 11.0), 6.0, 0.0)
        away, sorted_density = interfaces.profile({"many-slab": Table({"y": y, "density": density}, "profile")})
        self.assertTrue((sorted_density[abs(away) < 3.9] == 6.0).all())
        self.assertTrue((sorted_density[abs(away) > 4.1] == 0.0).all())

    def test_tension_of_two_surfaces(self):
        rows = 1600
        columns = {"p_yy": numpy.full(rows, 24.0), "p_xx": numpy.full(rows, 23.5), "p_zz": numpy.full(rows, 23.5)}
        value, error = interfaces.tension({"slab": Table(columns)}, "slab", 16, 0.1)
        self.assertAlmostEqual(value, 4.0, 12)
        self.assertAlmostEqual(error, 0.0, 12)


class Filaments(unittest.TestCase):
    def test_rows(self):
        found = filaments.verdicts({"filament-turn": Table({"rate": [0.0, 0.005], "decay": [0.02, 0.0098], "rises": [0.0, 3.0]})})
        self.assertAlmostEqual(verdict(found, "media.filament.slow").measured, 0.98, 12)
        self.assertEqual(verdict(found, "media.filament.slow").verdict, "pass")
        self.assertEqual(verdict(found, "media.filament.rises").verdict, "fail")


class Limit(unittest.TestCase):
    def test_ratio_of_viscosities(self):
        """At dt = 0.05: (9/12 pi - 0.025 + pi/25)/(45/48 pi - 0.025 + pi/25)."""
        eta = verdict(media.limit_verdicts({}), "media.limit.viscosity").expected
        self.assertAlmostEqual(eta, (0.75 / math.pi - 0.025 + math.pi / 25.0) / (0.9375 / math.pi - 0.025 + math.pi / 25.0), 12)


if __name__ == "__main__":
    unittest.main()
