"""validation/lib: statistics and formulas against numbers worked out by hand, with the recipe beside each."""
import math
import os
import pathlib
import re
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TREE / "validation"))

import numpy
from scipy import integrate, linalg

from lib import stats, theory

UNCROSS = os.environ.get("UNCROSS", "build/uncross")


def collided(v, random, angle):
    """Velocities (cells, members, 3) after a collision of each cell: relative ones turned by this angle about a random axis."""
    mean = v.mean(axis=1, keepdims=True)
    axis = random.normal(size=(len(v), 1, 3))
    axis /= numpy.linalg.norm(axis, axis=2, keepdims=True)
    w = v - mean
    along = (w * axis).sum(axis=2, keepdims=True) * axis
    return mean + along + math.cos(angle) * (w - along) + math.sin(angle) * numpy.cross(axis, w)


def heat_flux(v):
    """Sum of (v^2 - 5) v over the members of each cell, shape (cells, 3)."""
    return (((v**2).sum(axis=2, keepdims=True) - 5.0) * v).sum(axis=1)


class Means(unittest.TestCase):
    def test_mean(self):
        """1, 2, 3, 4: squares about 2.5 sum to 5; 5/3/4 = 0.41667, its root 0.645497."""
        value, error = stats.mean([1, 2, 3, 4])
        self.assertEqual(value, 2.5)
        self.assertAlmostEqual(error, 0.6454972243679028, 14)

    def test_one_value_has_no_error(self):
        self.assertTrue(math.isnan(stats.mean([3.0])[1]))

    def test_weighted_mean(self):
        """1 +- 1 and 4 +- 2: weights 1 and 1/4, mean 2/1.25 = 1.6, error 1/sqrt(1.25); chi^2 = 0.36 + 1.44 = 1.8, of one
        degree of freedom: p = erfc(sqrt(0.9))."""
        value, error, p = stats.weighted_mean([1, 4], [1, 2])
        self.assertAlmostEqual(value, 1.6, 13)
        self.assertAlmostEqual(error, math.sqrt(0.8), 13)
        self.assertAlmostEqual(p, math.erfc(math.sqrt(0.9)), 12)

    def test_blocked_mean(self):
        """16 zeros, then 16 ones. As they are: sqrt((8/31)/32) = 0.0898; in pairs, 16 blocks: sqrt((4/15)/16) = 0.129099;
        the next level has 8 blocks, too few."""
        value, error = stats.blocked_mean([0.0] * 16 + [1.0] * 16)
        self.assertEqual(value, 0.5)
        self.assertAlmostEqual(error, math.sqrt(4 / 15 / 16), 14)

    def test_steady_series_seldom_seem_to_move(self):
        """400 correlated series (each value 0.8 of the last, a correlation time of 4.5) of 512: of 800 normal values 2.2 exceed 3, and
        blocks of so few correlation times make errors some 10 % small, so that it is 2.7 and 6; 14 and more have a chance below 1 in 300."""
        random = numpy.random.default_rng(4)
        found = []
        for _ in range(400):
            series = [random.normal()]
            for kick in random.normal(size=511):
                series.append(0.8 * series[-1] + 0.6 * kick)
            found.append(stats.unsteady(series))
        self.assertLess(sum(z > 3.0 for z in found), 14)
        self.assertEqual(sum(z > stats.SIGMAS for z in found), 0)

    def test_what_moves_is_seen(self):
        """White noise of 1024 values: a half has an error of 1/sqrt(512) = 0.0442, their difference one of 0.0625. A step of 0.5 in the
        middle is 8 errors. A ramp of 1.2 parts the halves by 0.6; blocks see it, too: 0.6/sqrt(12)/sqrt(16) = 0.0433 makes a half's error 0.062,
        so these are 6.9 errors. A wave with a period of a tenth of the run moves nothing."""
        random = numpy.random.default_rng(5)
        noise, time = random.normal(size=1024), numpy.arange(1024) / 1024
        for drift, moves in ((0.0 * time, False), (0.5 * (time >= 0.5), True), (1.2 * time, True), (numpy.sin(20.0 * math.pi * time), False)):
            value, error = stats.average(3.0 + noise + drift)
            self.assertEqual(isinstance(value, stats.Moving), moves)
            self.assertEqual((value, error), stats.blocked_mean(3.0 + noise + drift))

    def test_what_is_constant_does_not_move(self):
        for value in (0.0, 0.1, 1.0 / 3.0, -1e9):
            self.assertEqual(stats.unsteady([value] * 63), 0.0)
        self.assertGreater(stats.unsteady([1.0] * 32 + [-1.0] * 32), stats.SIGMAS)
        self.assertEqual(stats.average([1.0] * 32 + [-1.0] * 32)[0].share, 1.0)

    def test_a_number_made_of_what_moves_moves(self):
        value = stats.Moving(4.0, "it still moves", 0.25)
        for made, plain in ((2.0 * value, 8.0), (value / 2, 2.0), (1.0 / value, 0.25), (value - 1, 3.0), (-value, -4.0), (value**2, 16.0),
                            (numpy.float64(2.0) / value, 0.5), (numpy.float64(2.0) - value, -2.0), (value * numpy.float64(2.0), 8.0)):
            self.assertEqual(made, plain)
            self.assertEqual(made.moves, "it still moves")
        with self.assertRaises(TypeError):
            numpy.ones(2) / value
        self.assertEqual(stats.error_that_covers(2.0 * value, 0.1), 2.0)
        self.assertEqual(stats.error_that_covers(8.0, 0.1), 0.1)

    def test_jackknife_of_a_mean_is_its_standard_error(self):
        value, error = stats.jackknife([[1, 10], [2, 10], [3, 10], [4, 10]], lambda mean: mean)
        self.assertEqual(list(value), [2.5, 10.0])
        self.assertAlmostEqual(error[0], 0.6454972243679028, 14)
        self.assertEqual(error[1], 0.0)

    def test_jackknife_of_a_ratio(self):
        """x = 1, 3 and y = 1, 1: without one, 3 and 1; sqrt((1/2)(1 + 1)) = 1; the ratio of means is 2."""
        value, error = stats.jackknife([[1, 1], [3, 1]], lambda mean: mean[0] / mean[1])
        self.assertEqual(float(value), 2.0)
        self.assertAlmostEqual(float(error), 1.0, 14)


class Fits(unittest.TestCase):
    def test_line(self):
        """x = 0, 1, 2, errors 1: normal matrix [[3, 3], [3, 5]], inverse [[5, -3], [-3, 3]]/6. y = 0, 0, 1: -1/6 + x/2,
        residuals 1/6, -1/3, 1/6, chi^2 = 1/6."""
        fit = stats.line([0, 1, 2], [0, 0, 1], [1, 1, 1])
        numpy.testing.assert_allclose(fit.value, [-1 / 6, 1 / 2], atol=1e-14)
        numpy.testing.assert_allclose(fit.covariance, numpy.array([[5, -3], [-3, 3]]) / 6, atol=1e-14)
        numpy.testing.assert_allclose(fit.error, [math.sqrt(5 / 6), math.sqrt(1 / 2)], atol=1e-14)
        self.assertAlmostEqual(fit.chi2, 1 / 6, 13)
        self.assertEqual(fit.freedom, 1)
        self.assertAlmostEqual(fit.p, math.erfc(math.sqrt(1 / 12)), 12)

    def test_errors_weigh(self):
        """A point with a tiny error pulls the line through itself."""
        fit = stats.line([0, 1, 2], [0, 0, 1], [1, 1, 1e-6])
        self.assertAlmostEqual(fit.value[0] + 2 * fit.value[1], 1.0, 10)

    def test_power(self):
        """y = 2/sqrt(x) exactly; relative errors of 1 % at x = 1, e, e^2 are the line's 0.01 at 0, 1, 2."""
        x = numpy.exp([0.0, 1.0, 2.0])
        fit = stats.power(x, 2.0 / numpy.sqrt(x), 0.02 / numpy.sqrt(x))
        self.assertAlmostEqual(fit.value[1], -0.5, 13)
        self.assertAlmostEqual(math.exp(fit.value[0]), 2.0, 13)
        self.assertAlmostEqual(fit.error[1], 0.01 / math.sqrt(2), 13)

    def test_too_few_points(self):
        with self.assertRaises(ValueError):
            stats.line([1.0], [1.0], [1.0])


class Tolerances(unittest.TestCase):
    def test_one_test(self):
        self.assertAlmostEqual(stats.sigmas(0.05), 1.959963984540054, 12)

    def test_many_tests(self):
        """That none of 100 normal values exceeds z has the chance erf(z/sqrt 2)^100."""
        self.assertAlmostEqual(math.erf(stats.sigmas(1e-3, 100) / math.sqrt(2))**100, 0.999, 12)

    def test_few_values(self):
        """Student's t of 2 degrees of freedom has the tail P(|t| > x) = 1 - x/sqrt(2 + x^2)."""
        z = stats.sigmas(0.01, freedom=2)
        self.assertAlmostEqual(1.0 - z / math.sqrt(2.0 + z * z), 0.01, 12)
        self.assertGreater(stats.tolerance(1.0, values=8), 2.0 * stats.tolerance(1.0))

    def test_tolerance(self):
        self.assertAlmostEqual(stats.tolerance(0.3, 0.4, systematic=0.1, z=2.0), 1.1, 14)


class Theory(unittest.TestCase):
    def test_against_the_program(self):
        """The program's own formulas were written apart from these; it prints six digits at most."""
        said = subprocess.run([UNCROSS, "check", str(TREE / "scenes/solvent.yaml")], capture_output=True, text=True, check=True)
        kinetic, collisional = theory.viscosity()
        for symbol, value in (("eta", kinetic + collisional), ("nu", theory.kinematic_viscosity()),
                              ("D_s", theory.self_diffusion()), ("c_s", theory.SOUND_SPEED)):
            found = re.search(rf"\s{symbol}\s+([0-9.e+-]+)(?:\s|$)", said.stdout)
            self.assertIsNotNone(found, symbol)
            self.assertAlmostEqual(float(found[1]) / value, 1.0, 4, symbol)

    def test_angles(self):
        """Retention at 130 degrees, gamma 5: 1 - (2/3)(1.6427876)(4.0067379)/5 = 0.122371; viscosity at gamma 10, dt_c 0.1:
        kinetic 50/(9.0000454*(4 + 1.2855752 + 0.3472964)) - 0.5 = 0.4862692, collisional
        1.6427876*9.0000454/1.8 = 8.2139794; together 8.7002486."""
        self.assertAlmostEqual(theory.retention(5, 130), 0.122371, 6)
        self.assertAlmostEqual(sum(theory.viscosity(10, 0.1, 130)), 8.7002486, 6)

    def test_andersen(self):
        """gamma 5, dt_c 0.1: 0.5 (5/4.0067379 - 0.5) = 0.3739490 and 4.0067379/1.2 = 3.3389483; gamma 10, dt_c 0.02:
        0.2 (10/9.0000454 - 0.5) = 0.1222211 and 9.0000454/0.24 = 37.5001892."""
        for point, parts in (((5, 0.1), (0.3739490, 3.3389483)), ((10, 0.02), (0.1222211, 37.5001892))):
            for value, expected in zip(theory.andersen_viscosity(*point), parts):
                self.assertAlmostEqual(value, expected, 6)

    def test_tail_of_a_large_box_is_that_of_an_infinite_one(self):
        """In 160^3 cells at t = 40, spread 1: what is missing is the k = 0 wave, 2/(3 gamma 160^3) = 1.1 % of the tail."""
        t, gamma = numpy.array([40.0]), 5
        tail = theory.long_time_tail(t, 160, gamma, 1.0, None)[0] + 2.0 / (3.0 * gamma * 160**3)
        self.assertAlmostEqual(tail / theory.long_time_tail_unbounded(40.0, gamma, 1.0), 1.0, 6)

    def test_diffusion_still_to_come_is_an_integral_of_the_tail(self):
        """<r^2>/6t = (1/t) int_0^t (t - s) C(s) ds, so what is to come is (1/t) int min(s, t) C(s) ds: by the trapezoidal rule,
        without sound and with it."""
        s = numpy.geomspace(1e-5, 400.0, 4001)
        for waves in ((2.2, None), (2.1, 1.1, 0.03), (2.1, 1.1, 0.03, theory.CELL), (2.1, 1.1, 0.03, theory.CELL, 0.9)):
            c = theory.long_time_tail(s, 16, 5, *waves)
            expected = numpy.trapz(numpy.minimum(s, 3.0) * c, s) / 3.0
            self.assertAlmostEqual(theory.diffusion_still_to_come(3.0, 16, 5, *waves) / expected, 1.0, 4)

    def test_a_wave_of_sound_is_what_the_equations_make_of_it(self):
        """d rho/dt = -i k u, du/dt = -i k c^2 rho - 2 Gamma k^2 u, as the exponential of a matrix; under- and overdamped."""
        for k, damping in ((0.2, 1.1), (0.9, 1.1), (1.5, 1.1), (2.5, 0.36)):
            matrix = numpy.array([[0.0, -1j * k], [-1j * k * theory.SOUND_SPEED**2, -2.0 * damping * k**2]])
            for t in (0.3, 1.0, 4.0):
                self.assertAlmostEqual(theory.sound_mode(t, k**2, damping), linalg.expm(matrix * t)[1, 1].real, 12)

    def test_heat_takes_part_in_a_wave_of_sound(self):
        """d rho/dt = -i k u, du/dt = -i k (rho + T) - nu k^2 u, dT/dt = -(2/3) i k u - D k^2 T of an ideal gas with kT = 1, in plain units:
        the velocity of a wave of velocity, and the entropy of a wave of temperature."""
        for k, damping, heat in ((0.2, 1.1, 0.86), (0.9, 1.1, 0.86), (1.5, 1.1, 2.0), (2.5, 0.36, 0.3)):
            shear = 2.0 * damping - 0.4 * heat
            matrix = numpy.array([[0.0, -1j * k, 0.0], [-1j * k, -shear * k**2, -1j * k], [0.0, -2j / 3.0 * k, -heat * k**2]])
            for t in (0.3, 1.0, 4.0):
                moved = linalg.expm(matrix * t)
                self.assertAlmostEqual(theory.sound_mode(t, k**2, damping, heat), moved[1, 1].real, 12)
                self.assertAlmostEqual(theory.heat_mode(t, k**2, damping, heat), (moved[2, 2] - 2.0 / 3.0 * moved[0, 2]).real, 12)

    def test_long_waves_decay_by_what_was_measured(self):
        """With heat or without, a long wave of sound decays with the same Gamma; one of heat with 3/5 of its diffusivity."""
        k2 = 1e-4
        self.assertAlmostEqual(theory.sound_mode(1000.0, k2, 1.1, 0.86), theory.sound_mode(1000.0, k2, 1.1), 2)
        self.assertAlmostEqual(theory.heat_mode(4000.0, k2, 1.1, 0.86), math.exp(-0.6 * 0.86 * k2 * 4000.0), 2)

    def test_heat_goes_from_particle_to_particle_as_collisions_make_it(self):
        """One hot member (T = 1 + x) in cells of n: its energy above the mean of the others falls by (4/3)(1 - cos alpha)/n of it, drawn
        from 150,000 cells to 2 %. So the mean of (n - 1)/n is what counts. In closed form: 1 - exp(-gamma) [1 + int_0^gamma (exp(x) - 1)/x dx]."""
        random, cells, n, turn = numpy.random.default_rng(5), 150000, 4, 1.0 - math.cos(math.radians(130.0))
        v = random.normal(size=(cells, n, 3))
        v[:, 0] *= 2.0  # T = 4: 4.5 kT of energy above the others
        after = collided(v, random, math.radians(130.0))
        lost = 0.5 * (v[:, 0]**2 - after[:, 0]**2).sum(axis=1).mean()
        self.assertAlmostEqual(lost / (4.5 * (n - 1) / n) / (4.0 / 3.0 * turn / n), 1.0, delta=0.02)
        for gamma in (1.0, 5.0):
            partners = 1.0 - math.exp(-gamma) * (1.0 + integrate.quad(lambda x: math.expm1(x) / x, 0.0, gamma)[0])
            self.assertAlmostEqual(theory.heat_diffusion(gamma, 0.02, 130.0)[1], turn * partners / (9.0 * 0.02 * gamma), 12)

    def test_the_flux_of_heat_decays_as_collisions_make_it(self):
        """Of the flux (v^2 - 5) v of a cell's members a collision leaves the share q; the kinetic diffusivity at constant pressure is
        dt_c [1/(1 - q) - 1/2]. Drawn from 150,000 cells of gamma = 10: the published formula is of first order in 1/gamma."""
        random, gamma, angle = numpy.random.default_rng(6), 10.0, math.radians(90.0)
        kept = square = 0.0
        for n in range(1, 31):
            cells = int(1.5e5 * math.exp(n * math.log(gamma) - gamma - math.lgamma(n + 1.0)))
            v = random.normal(size=(cells, n, 3))
            before, after = heat_flux(v), heat_flux(collided(v, random, angle))
            kept, square = kept + (before * after).sum(), square + (before**2).sum()
        drawn = 1.0 / (1.0 - kept / square) - 0.5
        self.assertAlmostEqual(0.6 * theory.heat_diffusion(gamma, 1.0, 90.0)[0] / drawn, 1.0, delta=0.03)

    def test_sound_takes_as_much_as_it_brings(self):
        """In an infinite fluid the sound of a pulse leaves: int_0^inf of its share is 0 for each wave, so a particle's D is that
        of shear waves, two thirds of all."""
        t = numpy.linspace(0.0, 400.0, 400001)
        self.assertAlmostEqual(numpy.trapz(theory.sound_mode(t, 0.25, 0.8), t), 0.0, 6)


if __name__ == "__main__":
    unittest.main()
