"""validation/lib/bending.py: each number by another way, with the recipe beside it."""
import math
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TREE / "validation"))

import numpy
from scipy import integrate, linalg

from lib import bending, dilute
from lib import semidilute as sd

FOREVER = 1e9  # t0: no wave is left that has not built up


def smeared_oseen(r, eta=dilute.ETA, spread=dilute.CELL_SPREAD):
    """Transverse component of Oseen's tensor folded with a Gaussian, by integrating it over the waves of infinite space:
    (1/2 pi^2 eta) int dk exp(-k^2 s^2/2) <(1 - k_x^2/k^2) cos(k_z r)>, x across and z along r; over directions of k,
    with c = k_z/k, (1 + c^2)/2 cos(k r c)."""
    def over_directions(k):
        return integrate.quad(lambda c: 0.5 * (1.0 + c * c) * math.cos(k * r * c), 0.0, 1.0)[0]
    value = integrate.quad(lambda k: math.exp(-0.5 * spread * k * k) * over_directions(k), 0.0, 15.0, limit=200)[0]
    return value / (2.0 * math.pi**2 * eta)


class Field(unittest.TestCase):
    def test_directions_are_even(self):
        d = bending.directions()
        self.assertTrue(numpy.allclose((d**2).sum(axis=1), 1.0))
        self.assertTrue(numpy.allclose(d.T @ d / len(d), numpy.eye(3) / 3.0, atol=0.02))

    def test_built_up_in_a_large_box(self):
        """Infinite space less what the images take, 2.837297/(6 pi eta L), where r is short; at r = 4 a0 the next term,
        of order r^2/L^3, is 1 % of it."""
        box = 40
        found = bending.field([FOREVER], box, 8, 0.5)[0]
        images = 2.837297 / (6.0 * math.pi * dilute.ETA * box)
        for n in (0, 1, 3, 7):
            self.assertAlmostEqual(found[n] / (smeared_oseen(0.5 * n) - images), 1.0, delta=0.015)

    def test_building_up(self):
        """A vertex's share of the flow around itself, before it has crossed the box: velocity autocorrelation
        (2/3 rho) [4 pi (nu t + s^2/2)]^(-3/2), and D(t) = (1/t) int (t - s) C(s) ds."""
        def memory(t):
            return 2.0 / (3.0 * dilute.PER_CELL) * (4.0 * math.pi * (dilute.NU * t + dilute.CELL_SPREAD / 2.0))**-1.5
        for lag in (0.1, 1.0, 5.0):
            expected = integrate.quad(lambda s, lag=lag: (1.0 - s / lag) * memory(s), 0.0, lag)[0]
            self.assertAlmostEqual(bending.field([lag], 32, 1, 0.5)[0, 0] / expected, 1.0, delta=0.01)


class Modes(unittest.TestCase):
    def test_against_matrix_exponentials(self):
        """x(t) - x(0) = (E - 1) x(0) + noise, E = exp(-H K t), x(0) with covariance K^+ and noise with
        2 int E(s) H E(s)^T ds: seven vertices, any mobilities."""
        draw = numpy.random.default_rng(5)
        a = draw.normal(size=(7, 7))
        mobility, kappa, bond2, t = 0.01 * (a @ a.T + numpy.eye(7)), 3.0, 0.7, 2.5
        second = numpy.diff(numpy.eye(7), 2, axis=0)
        stiffness = kappa / bond2 * second.T @ second

        def decay(s):
            return linalg.expm(-s * mobility @ stiffness)
        back = decay(t) - numpy.eye(7)
        start = (back @ linalg.pinv(stiffness) @ back.T)[3, 3]
        noise = integrate.quad(lambda s: 2.0 * (decay(s) @ mobility @ decay(s).T)[3, 3], 0.0, t)[0]
        self.assertAlmostEqual(bending.middle(t, mobility, kappa, bond2) / (2.0 * (start + noise)), 1.0, 6)

    def test_tends_to_the_line(self):
        """A long chain, vertices that rub alone: the wormlike chain's t^(3/4), and at first free diffusion, 4 D t."""
        diffusion, mobility = 0.01, 0.01 * numpy.eye(201)
        law = float(sd.bending_law(200.0, 1.0 / (diffusion * sd.BOND), 64.0 * sd.BOND**3 / sd.BOND2))
        self.assertAlmostEqual(bending.middle(200.0, mobility, 64.0, sd.BOND2) / law, 1.0, delta=0.01)
        self.assertAlmostEqual(bending.middle(1e-4, mobility, 64.0, sd.BOND2) / (4.0 * diffusion * 1e-4), 1.0, delta=0.01)

    def test_no_mobilities(self):
        with self.assertRaises(ValueError):
            bending.middle(1.0, numpy.diag([1.0, 1.0, -0.1]), 1.0, 1.0)


class Crowd(unittest.TestCase):
    def test_clumps(self):
        """Against clumps that are drawn: 0.9 vertices per cell, half of which come alone and half by threes, so Poisson
        numbers of 0.45 single ones and of 0.15 threes."""
        draw = numpy.random.default_rng(4)
        number = draw.poisson(0.45, 10**6) + 3 * draw.poisson(0.15, 10**6)
        found = dilute.crowded(0.9, numpy.array([0.0, 0.5, 0.0, 0.5]))
        self.assertAlmostEqual(found.sum(), 1.0, 12)
        self.assertAlmostEqual(found @ numpy.arange(60), 0.9, 12)
        for n in range(6):
            self.assertAlmostEqual(found[n], (number == n).mean(), delta=0.002)

    def test_lone_vertex_among_others(self):
        """It keeps 1 - (2/3) <1 - M/(M + M o + n)> per collision, o and n Poisson: drawn."""
        draw = numpy.random.default_rng(9)
        others, solvent = draw.poisson(1.5, 400000), draw.poisson(5.0, 400000)
        kept = 1.0 / 3.0 + 2.0 / 3.0 * float((5.0 / (5.0 + 5.0 * others + solvent)).mean())
        found = dilute.sharing_matrix(lambda random: numpy.zeros((1, 3)), shapes=2, shifts=2, crowd=1.5)[0, 0]
        self.assertAlmostEqual(found / (0.02 / 5.0 * (1.0 / (1.0 - kept) - 0.5)), 1.0, delta=0.003)

    def test_lone_fiber_rubs_at_its_vertices_alone_where_bonds_are_long(self):
        found = dilute.sharing_matrix(lambda random: dilute.rod_shape(5, 9.0, random), shapes=2, shifts=2)
        self.assertTrue(numpy.allclose(found, dilute.vertex_diffusion() * numpy.eye(5), rtol=1e-6, atol=1e-12))


if __name__ == "__main__":
    unittest.main()
