"""validation/lib/dilute.py: one solute in a box. Expected numbers by other ways, with the recipe beside each."""
import math
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TREE / "validation"))

import numpy

from lib import dilute


class Boxes(unittest.TestCase):
    def test_waves(self):
        """Box of 2 pi: wave vectors are whole numbers; 6 of length 1, 12 of sqrt 2, 8 of sqrt 3, 6 of 2."""
        k, count = dilute.waves(2.0 * math.pi)
        numpy.testing.assert_allclose(k, [1.0, math.sqrt(2.0), math.sqrt(3.0), 2.0], rtol=1e-14)
        self.assertEqual(list(count), [6, 12, 8, 6])

    def test_memory_is_what_the_velocity_correlation_says(self):
        """D(t) = int_0^t (1 - s/t) C(s) ds, by the trapezoidal rule, against D = int_0^inf C(s) ds, with
        C(s) = (1/3 rho V) sum_k {2 exp(-nu k^2 s) + exp(-G k^2 s) [cos ws - (G k^2/w) sin ws]}."""
        box, nu, damping, speed, t = 16.0, 2.0, 1.1, 1.3, 5.0
        k, count = dilute.waves(box)
        s = numpy.linspace(0.0, t, 20001)
        total = numpy.zeros_like(s)
        for wave, number in zip(k, count):
            decay = damping * wave ** 2
            w = numpy.sqrt(complex((speed * wave) ** 2 - decay ** 2))
            sound = numpy.exp(-decay * s) * (numpy.cos(w * s) - decay / w * numpy.sin(w * s)).real
            total += number * (2.0 * numpy.exp(-nu * wave ** 2 * s) + sound)
        total /= 3.0 * 5.0 * box ** 3
        limit = (count * 2.0 / (nu * k ** 2)).sum() / (3.0 * 5.0 * box ** 3)
        running = numpy.trapz((1.0 - s / t) * total, s)
        memory = dilute.memory(t, box, nu=nu, sound=speed, damping=damping)
        self.assertAlmostEqual(memory[0], limit - running, 8)

    def test_closed_box(self):
        """8 vertices of mass 5 in 8^3 cells: 1 - (1 - (2560/2600)^2)/8 = 0.99618; docs/accuracy.md has 0.9962."""
        self.assertAlmostEqual(dilute.closed_box(8, 5.0, 8), 1.0 - (1.0 - (2560 / 2600) ** 2) / 8, 14)

    def test_form_factors(self):
        """P -> 1 - k^2 R_g^2/3: R_g^2 = (N^2 - 1)/6N of the chain, (N^2 - 1) d^2/12 of the row."""
        k = 1e-3
        self.assertAlmostEqual((1.0 - dilute.gaussian_form(10)(k)[0]) * 3.0 / k ** 2, 99.0 / 60.0, 5)
        self.assertAlmostEqual((1.0 - dilute.rod_form(10, 0.5)(k)[0]) * 3.0 / k ** 2, 99.0 / 48.0, 5)


class Mobilities(unittest.TestCase):
    def test_row_of_three(self):
        """Spheres of 0.2 at 0, 0.6, 1.2: (3/0.2 + 4/0.6 + 2/1.2)/9 times kT/6 pi eta."""
        expected = (3 / 0.2 + 4 / 0.6 + 2 / 1.2) / 9 / (6.0 * math.pi * dilute.ETA)
        self.assertAlmostEqual(dilute.kirkwood_rod(3, 0.6, 0.2), expected, 14)

    def test_pair_of_a_chain(self):
        """<1/r> of a Gaussian bond of 1: sqrt(6/pi) = 1.381977; spheres of 1e-3 hardly ever overlap."""
        mobility = dilute.kirkwood_chain(2, 1e-3) * 6.0 * math.pi * dilute.ETA
        self.assertAlmostEqual((4.0 * mobility - 2e3) / 2.0, 1.381977, 4)

    def test_smeared_over_cells(self):
        """Far away Oseen's 1/r; in one place sqrt(2/pi)/sqrt(1/3) = 1.381977. A row of two and a chain of two by
        quadrature of 1/|r + s|, s Gaussian of variance 1/3 per axis: in shells of the whole width, or about the row."""
        self.assertAlmostEqual(float(dilute.smeared_pair(8.0)), 0.125, 12)
        self.assertAlmostEqual(float(dilute.smeared_pair(0.0)), 1.381977, 6)
        spread = 1.0 / 3.0
        z, rho = numpy.linspace(-6, 6, 2401), numpy.linspace(0, 6, 1201)[1:] - 0.0025
        weight = numpy.exp(-(z[:, None] ** 2 + rho ** 2) / 2 / spread) * rho
        mean = (weight / numpy.hypot(z[:, None] + 0.7, rho)).sum() / weight.sum()
        unit = 6.0 * math.pi * dilute.ETA
        self.assertAlmostEqual((dilute.cells_rod(2, 0.7, 0.003) - 0.003) * unit, (2 * 1.381977 + 2 * mean) / 4, 3)
        r = numpy.linspace(0, 9, 9001)[1:]
        shells = r ** 2 * numpy.exp(-r ** 2 / 2 / (2.0 / 3.0))
        mean = (shells / r).sum() / shells.sum()
        self.assertAlmostEqual((dilute.cells_chain(2, 0.003) - 0.003) * unit, (2 * 1.381977 + 2 * mean) / 4, 5)

    def test_cells_spread_so(self):
        """Places of two particles of one cell, the grid shifted at random, twice over: 2/6 per axis; and a lone vertex
        by chaos and its own smeared field is 2.3 % below the 0.0179 measured."""
        random = numpy.random.Generator(numpy.random.PCG64(1))
        away = random.uniform(size=(200000, 4))
        width = numpy.var(away[:, 0] - away[:, 1] + away[:, 2] - away[:, 3])
        self.assertAlmostEqual(width, dilute.CELL_SPREAD, 2)
        self.assertAlmostEqual(dilute.cells_rod(1, 0.5, dilute.vertex_diffusion()), 0.01749, 5)

    def test_overlapping_spheres(self):
        """Continuous where they touch; in one place, that of one sphere."""
        self.assertAlmostEqual(float(dilute.monomer_pair(0.6 - 1e-9, 0.3)), 1.0 / 0.6, 7)
        self.assertEqual(float(dilute.monomer_pair(0.0, 0.3)), 1.0 / 0.3)


class WithoutHydrodynamics(unittest.TestCase):
    def test_vertex(self):
        """`uncross check`: c = 0.684094, D_0 = 0.010662."""
        self.assertAlmostEqual(dilute.retention(), 0.684094, 6)
        self.assertAlmostEqual(dilute.vertex_diffusion(), 0.010662, 6)

    def test_far_apart(self):
        value, _ = dilute.sharing_diffusion(lambda random: numpy.arange(9.0).reshape(3, 3) * 5.0, shapes=2, shifts=3)
        self.assertAlmostEqual(value, dilute.vertex_diffusion() / 3.0, 12)

    def test_in_one_place(self):
        """Two vertices that are one of mass 10: D = (dt/10) [1/(1 - c) - 1/2], 1 - c = (2/3) <n/(10 + n)>."""
        value, _ = dilute.sharing_diffusion(lambda random: numpy.zeros((2, 3)), shapes=2, shifts=3)
        mean = sum(math.exp(-5.0) * 5.0 ** n / math.factorial(n) * n / (10.0 + n) for n in range(60))
        self.assertAlmostEqual(value, 0.02 / 10.0 * (1.5 / mean - 0.5), 12)

    def test_rouse(self):
        """5 vertices, by the eigenvectors of the chain's matrix:
        <R(t).R> = 3 sum_p (v_p(5) - v_p(1))^2 exp(-k a_p t/zeta)/(k a_p)."""
        k, zeta, t = 3.0, 94.0, numpy.array([0.0, 10.0, 50.0])
        matrix = numpy.diag([1.0, 2.0, 2.0, 2.0, 1.0]) - numpy.eye(5, k=1) - numpy.eye(5, k=-1)
        a, v = numpy.linalg.eigh(matrix)
        weight = (v[-1] - v[0])[1:] ** 2 / a[1:]
        expected = (weight * numpy.exp(-k * a[1:] * t[:, None] / zeta)).sum(axis=1) / weight.sum()
        numpy.testing.assert_allclose(dilute.rouse(t, 5, k, zeta), expected, rtol=1e-12)
        self.assertAlmostEqual(dilute.rouse_time(5, k, zeta), zeta / (k * a[1]), 10)


class Estimates(unittest.TestCase):
    def test_fair_mean(self):
        """9 and 11 with 10 % each: weights alike, mean 10, error 10 % of it over sqrt 2. As they are, 9.8."""
        value, error, _ = dilute.fair_mean([9.0, 11.0], [0.9, 1.1])
        self.assertAlmostEqual(value, 10.0, 13)
        self.assertAlmostEqual(error, math.sqrt(0.5), 13)

    def test_nested(self):
        times = numpy.array([1, 2, 3, 4, 6, 8, 12, 16, 24, 32]) * 0.4
        self.assertEqual(list(dilute.nested(times, 0.8, 6.4)), [1, 3, 5, 7])

    def test_errors_of_random_walks(self):
        """600 sets of 20 walkers, 256 steps with D = 1/2, lags of 1, 2, 4, 8, 16 without overlap. The estimate is
        unbiased, and its error is right: (value - 1/2)/error scatters by 1 (600 sets tell it to 0.03)."""
        random = numpy.random.Generator(numpy.random.PCG64(5))
        lags, pulls = numpy.array([1.0, 2.0, 4.0, 8.0, 16.0]), []
        for _ in range(600):
            steps = random.normal(size=(20, 3, 256))
            sizes = [(steps.reshape(20, 3, -1, int(lag)).sum(axis=3) ** 2).sum(axis=1) for lag in lags]
            table = {"time": lags, "D": numpy.array([x.mean() / 6.0 / lag for x, lag in zip(sizes, lags)]),
                     "D_error": numpy.array([0.5 * math.sqrt(2.0 / 3.0 / x.size) for x in sizes])}
            limit = dilute.long_time([(table, numpy.zeros_like)], 1.0, [16.0])
            pulls.append((limit.value[0] - 0.5) / limit.error[0])
        self.assertLess(abs(numpy.mean(pulls)), 4.0 / math.sqrt(600))
        self.assertLess(abs(numpy.std(pulls) - 1.0), 0.12)

    def test_lags(self):
        """Two octaves at least; in a box of 71 a0 twice the time of its longest wave, L^2/(4 pi^2 nu) = 59.4 t0."""
        self.assertAlmostEqual(dilute.last_lag(16), 51.2, 12)
        self.assertAlmostEqual(dilute.last_lag(16, 3.2), 12.8, 12)
        self.assertAlmostEqual(dilute.last_lag(71), 2.0 * 59.44, 1)

    def test_scatter(self):
        """A chi^2 with a chance of 2.28 % is two standard errors off; one with 84.13 % is one below."""
        for p, normal in ((0.022750132, 2.0), (0.841344746, -1.0)):
            self.assertAlmostEqual(dilute.scatter("a.b", "", p).measured, normal, 6)
        self.assertEqual(dilute.scatter("a.b", "", 1e-6).verdict, "fail")
        self.assertEqual(dilute.scatter("a.b", "", None).verdict, "undecided")

    def test_in_pure_solvent(self):
        """One vertex in 100 cells, to first order: a cell with n others passes on 5 + n - (25 + n)/(5 + n) instead of n - 1."""
        n, weight = dilute.poisson(5.0)
        gain = float(weight @ (5.0 + n - (25.0 + n) / (5.0 + n))) - float(weight @ numpy.maximum(n - 1.0, 0.0))
        expected = 0.002 + 0.008 * (1.0 + 0.01 * gain / (4.0 + math.exp(-5.0)))
        self.assertAlmostEqual(dilute.in_pure_solvent(0.010, 0.002, 0.01), expected, 6)
        self.assertAlmostEqual(dilute.in_pure_solvent(0.010, 0.002, 0.0), 0.010, 9)

    def test_common_local_memory(self):
        """D(t) = D_i - 0.1/t without noise gives back D_i and 0.1."""
        t = numpy.array([1.0, 2.0, 4.0, 8.0])
        tables = [({"time": t, "D": d - 0.1 / t, "D_error": 0.01 * numpy.sqrt(t)}, numpy.zeros_like) for d in (1.0,
                                                                                                               2.0)]
        limit = dilute.long_time(tables, 1.0, [8.0, 8.0])
        numpy.testing.assert_allclose(limit.value, [1.0, 2.0], rtol=1e-12)
        self.assertAlmostEqual(limit.local, 0.1, 12)


if __name__ == "__main__":
    unittest.main()
