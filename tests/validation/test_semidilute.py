"""validation/lib/semidilute.py, and goals of runs. Expected numbers by other ways, with the recipe beside each."""
import math
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TREE / "validation"))

import numpy
from scipy import integrate, stats
import yaml

from lib import runs
from lib import semidilute as sd


class Told:
    """A result with one table, or none."""

    def __init__(self, **columns):
        self.columns = {name: numpy.array(values, float) for name, values in columns.items()}

    def table(self, name):
        if not self.columns:
            raise KeyError(name)
        return self.columns


class Momentum(unittest.TestCase):
    def test_largest_change(self):
        """By hand: py goes from 1 to -3, kinetic energy 2 + 4 = 6 at the start: 4 / (2/3 x 6) = 1; px by 1: 1/4."""
        steady = Told(time=[0, 1], px=[5, 5], py=[1, 1], pz=[0, 0], vertex_kinetic=[2, 9], solvent_kinetic=[4, 9])
        moved = Told(time=[0, 1, 2], px=[0, 1, 0], py=[1, -3, 1], pz=[0, 0, 0], vertex_kinetic=[2, 9, 9],
                     solvent_kinetic=[4, 9, 9])
        self.assertEqual(sd.momentum_change([steady]), 0.0)
        self.assertEqual(sd.momentum_change([Told(), moved, steady]), 1.0)
        self.assertIsNone(sd.momentum_change([Told()]))


class Formulas(unittest.TestCase):
    def test_bonds(self):
        """<l>, <l^2> by quadrature of l^2 exp(-50 (l - 1/2)^2); l_p from <cos> of exp(64 cos)."""
        weight = [integrate.quad(lambda x: x**n * math.exp(-50 * (x - 0.5)**2), 0, 2)[0] for n in (2, 3, 4)]
        self.assertAlmostEqual(sd.BOND, weight[1] / weight[0], 5)
        self.assertAlmostEqual(sd.BOND2, weight[2] / weight[0], 5)
        cosine = [integrate.quad(lambda x: x**n * math.exp(64 * (x - 1)), -1, 1)[0] for n in (0, 1)]
        self.assertAlmostEqual(sd.PERSISTENCE, -sd.BOND / math.log(cosine[1] / cosine[0]), 4)

    def test_tube(self):
        """Eqs. (34), (35) at c L^3 = 1000: xi/L = sqrt(0.003) = 0.0547723, so 0.31 x 0.003^0.6 (0.0306389) + 0.56 x
        0.003."""
        self.assertAlmostEqual(sd.mesh_size(1000, 32, 32) / 32, 0.0547723, 7)
        self.assertAlmostEqual(sd.tube_width(sd.mesh_size(1000, 32, 32), 32, 32) / 32, 0.31 * 0.0306389 + 0.00168, 6)

    def test_bending(self):
        """Modes of a long straight chain that lies on a line, one direction after the other: per component
        int dq/pi kT/(kappa q^4) (1 - exp(-kappa q^4 t/zeta)), kappa = l_p kT; two components."""
        t, zeta = 20.0, 100.0
        one = integrate.quad(lambda q: -math.expm1(-sd.PERSISTENCE * q**4 * t / zeta) / (sd.PERSISTENCE * q**4), 0, 60,
                             limit=400)[0] * 2 / math.pi
        self.assertAlmostEqual(float(sd.bending_law(t, zeta)) / (2 * one), 1.0, 3)

    def test_free_fiber(self):
        """Others in its cells slow a fiber without hydrodynamics as its own friction falls: d^2 ~ D^(3/4)."""
        alone, among = (float(sd.free_fiber([20.0], 64, count, 32, False)[0]) for count in (1, 100))
        power = (sd.shared_diffusion(100) / sd.shared_diffusion())**0.75
        self.assertLess(power, 0.95)
        self.assertAlmostEqual(among / alone / power, 1.0, delta=0.01)

    def test_shared_diffusion(self):
        """Momentum that the vertices of a cell lose together, without their memory of each other: a cell with n of them
        loses the share (2/3) N/(N + 5 n). Within 2 %, D then is (0.02/5)(1/share - 1/2)."""
        draw = numpy.random.default_rng(1)
        along = draw.normal(size=(100000, 3))
        along *= sd.BOND / numpy.linalg.norm(along, axis=1)[:, None]
        place, together = draw.random((100000, 3)), numpy.ones(100000, int)
        for k in (-3, -2, -1, 1, 2, 3):
            together += ((place + k * along >= 0.0) & (place + k * along < 1.0)).all(axis=1)
        bath = numpy.arange(60)
        chance = stats.poisson.pmf(bath, 5.0)
        lost = [2.0 / 3.0 * float(chance @ (bath / (bath + 5.0 * n))) for n in range(1, 8)]
        share = numpy.mean([lost[n - 1] for n in together])
        self.assertAlmostEqual(sd.shared_diffusion() / (0.004 * (1.0 / share - 0.5)), 1.0, delta=0.02)

    def test_collision_rate(self):
        """THEORY 2.11: 0.180 per bond and t0 at c L^3 = 1000, each collision counted for both its bonds."""
        self.assertAlmostEqual(2.0 * sd.collision_rate(63000, 32**3) * 32**3 / 63000, 0.180, 3)
        u = numpy.linspace(0.0005, 0.9995, 1000)
        levers = numpy.sqrt(((1 - u)**2 + u**2)[:, None] + ((1 - u)**2 + u**2)[None, :]).mean()
        self.assertAlmostEqual(sd.LEVERS, levers, 4)

    def test_rod(self):
        """1/(2 D_r) of L = 32, b = 0.6: D_r = 3/(pi 11.184 32768) (3.97656 - 0.662 + 0.017194 - 0.000018) = 8.68e-6."""
        self.assertAlmostEqual(0.5 / sd.rod_rotation_time(32.0, 0.6, 11.184) / 8.68e-6, 1.0, 2)


class Curves(unittest.TestCase):
    @staticmethod
    def table(t, **columns):
        made = {"time": t, "intervals": numpy.full(len(t), 9.0)}
        for name, values in columns.items():
            made[name], made[name + "_error"] = values, 0.01 * numpy.abs(values)
        return made

    def test_exponents(self):
        """Of a power law, at the lags of a run: two to an octave. The error: 1 % of either end."""
        t = numpy.sort(numpy.concatenate([2.0**numpy.arange(12), 1.5 * 2.0**numpy.arange(12)]))
        at, found, error = sd.exponents(self.table(t, d2_contour=3.0 * t**0.6))
        self.assertEqual(len(at), len(t) - 4)
        self.assertAlmostEqual(float(abs(found - 0.6).max()), 0.0, 12)
        self.assertAlmostEqual(float(error[0]), 0.01 * math.sqrt(2.0) / math.log(4.0), 12)
        self.assertAlmostEqual(at[0], 2.0, 12)

    def test_last_exponent(self):
        """0.2 where it counts, after 3/4 before; a last lag that was seen once does not count."""
        t = numpy.sort(numpy.concatenate([2.0**numpy.arange(12), 1.5 * 2.0**numpy.arange(12)]))
        made = self.table(t, d2_contour=numpy.where(t < 100.0, t**0.75, 100.0**0.55 * t**0.2))
        made["d2_contour"][-1] *= 3.0
        made["intervals"][-1] = 1
        value, error, lag = sd.last_exponent(made)
        self.assertAlmostEqual(value, 0.2, 9)
        self.assertTrue(0.0 < error < 0.01 and 256.0 < lag < 2048.0)
        self.assertIsNone(sd.last_exponent({key: column[:4] for key, column in made.items()}))

    def test_bend(self):
        """From 3/4 to 0 at a height of 2: a straight power has none; the height of the bend is in proportion."""
        t = 2.0**numpy.arange(20)
        curve = 2.0 / (1.0 + (100.0 / t)**0.75)
        height, error, lag = sd.bend(self.table(t, d2_contour=curve))
        self.assertAlmostEqual(height, 1.0, 1)  # d ln y/d ln t = 3/8 where both terms are alike
        self.assertAlmostEqual(math.log(lag / 100.0), 0.0, 1)
        self.assertTrue(0.0 < error < 0.2)
        self.assertAlmostEqual(sd.bend(self.table(t, d2_contour=7.0 * curve))[0] / height, 7.0, 9)
        self.assertIsNone(sd.bend(self.table(t, d2_contour=t**0.75)))

    def test_first_rate(self):
        """A rate that falls off steadily is 3 at the start, not 2; its error is that of many draws."""
        t = numpy.linspace(10.0, 20.0, 101)
        self.assertAlmostEqual(sd.first_rate(t, 3.0 * (t - 10.0) - 0.1 * (t - 10.0)**2)[0], 3.0, 9)
        random = numpy.random.Generator(numpy.random.PCG64(1))
        drawn = [sd.first_rate(t, numpy.concatenate([[0.0], numpy.cumsum(random.normal(0.3, 0.05, 100))])) for _ in range(400)]
        rates, errors = numpy.array(drawn).T
        self.assertAlmostEqual(rates.mean() / 3.0, 1.0, 1)
        self.assertAlmostEqual(rates.std() / errors.mean(), 1.0, delta=5.0 / math.sqrt(800.0))

    def test_rotation(self):
        t = numpy.array([100.0, 200.0, 400.0, 800.0, 1600.0, 3200.0])
        made = self.table(t, axis_unit=0.98 * numpy.exp(-t / 5e4), intervals=32000.0 / t)
        tau, _, height = sd.rotation_time([made, None], (150.0, 300.0), 4000.0, (4, 4))
        self.assertAlmostEqual(tau, 5e4, 3)
        self.assertAlmostEqual(height, 0.98, 9)
        self.assertIsNone(sd.rotation_time([made], (150.0, 300.0), 1000.0, (4,)))
        self.assertIsNone(sd.rotation_time([None], (150.0, 300.0), 4000.0, (4,)))
        # two runs are pooled by their intervals, and halve the error's square
        other = self.table(t, axis_unit=0.96 * numpy.exp(-t / 5e4), intervals=96000.0 / t)
        both = sd.rotation_time([made, other], (150.0, 300.0), 4000.0, (4, 4))
        self.assertAlmostEqual(both[2], 0.965, 9)
        # and by their fibers: weights 1 x 12 and 3 x 4
        self.assertAlmostEqual(sd.rotation_time([made, other], (150.0, 300.0), 4000.0, (12, 4))[2], 0.97, 9)
        one, four = (sd.rotation_time([made] * n, (150.0, 300.0), 4000.0, (4,) * n)[1] for n in (1, 4))
        self.assertAlmostEqual(one / four, 2.0, 6)
        # bends that relax slowly: tau_r changes with the first lag. The error holds the change as long as nobody can see it
        firsts, t = (150.0, 300.0, 600.0, 1200.0, 2400.0), 100.0 * 2.0**numpy.arange(9)
        cosine = numpy.exp(-t / 5e4) + 2e-3 * numpy.exp(-t / 300.0)
        few, many = (self.table(t, axis_unit=cosine, intervals=count / t) for count in (2e5, 1e9))
        tau, error, _ = sd.rotation_time([few], firsts, 3e4, (4,))
        early, later = (sd.rotation_fit(*sd.turning([few], (4,)), first, 3e4)[0] for first in firsts[:2])
        self.assertEqual(tau, early)
        self.assertGreater(abs(later - tau), 0.01 * tau)
        self.assertGreaterEqual(error, abs(later - tau))
        # and where it is seen, a later lag is taken, or none
        self.assertAlmostEqual(sd.rotation_time([many], firsts, 3e4, (4,))[0] / 5e4, 1.0, 3)
        self.assertIsNone(sd.rotation_time([many], firsts[:3], 3e4, (4,)))

    def test_error_of_rotation(self):
        """Rotors that turn by small angles about two axes, with bends that tilt them anew every time: the scatter of tau_r
        is its error. 300 sets: 4.1 % of the scatter; the 5 errors of the test are one false alarm in 10^6."""
        random = numpy.random.Generator(numpy.random.PCG64(7))
        lags, samples, fibers, sets = [10, 12, 16, 24, 32, 48, 64, 96], 1000, 16, 300
        step, tilt = math.sqrt(1.0 / 5000.0), 0.01  # of one angle per sample: tau_r = 5000 samples
        found = []
        for _ in range(sets):
            angles = numpy.cumsum(random.normal(0.0, step, (samples, fibers, 2)), axis=0)
            angles += random.normal(0.0, tilt, angles.shape)
            turned = [0.5 * numpy.mean(numpy.diff(angles[::lag], axis=0)**2) * 2.0 for lag in lags]
            made = {"time": numpy.array(lags, float), "axis_unit": 1.0 - numpy.array(turned),
                    "intervals": numpy.array([(samples - 1) // lag for lag in lags], float)}
            tau, error, _ = sd.rotation_fit(*sd.turning([made], (fibers,)), 10.0, 96.0)
            found.append((1.0 / tau, error / tau**2))
        rate, error = numpy.array(found).T
        self.assertLess(abs(rate.mean() * 5000.0 - 1.0), 5.0 * rate.std() * 5000.0 / math.sqrt(sets) + 0.01)
        self.assertAlmostEqual(rate.std() / error.mean(), 1.0, delta=5.0 * 0.041)

    def test_joined(self):
        short = self.table(numpy.array([1.0, 2.0, 4.0]), g=numpy.array([1.0, 2.0, 3.0]))
        long = self.table(numpy.array([4.0, 8.0]), g=numpy.array([9.0, 5.0]))
        self.assertEqual(list(sd.joined(short, None, long)["g"]), [1.0, 2.0, 3.0, 5.0])
        self.assertIsNone(sd.joined(None))


class Goals(unittest.TestCase):
    def test_scene_is_whole(self):
        scene = yaml.safe_load(sd.scene(count=7, vertices=24))
        self.assertEqual(scene["fibers"][0]["persistence_length"], 12.0)
        self.assertEqual(scene["fibers"][0]["count"], 7)

    def test_stages(self):
        run = runs.Run("a", scene="box: [6, 6, 6]\n", steps=1000, hours=5.0, priority=2, goals=((100, 0), (600, 1)),
                       case="c")
        stages = run.stages()
        self.assertEqual([stage.path for stage in stages], ["c/a@100", "c/a@600", "c/a"])
        self.assertEqual([stage.priority for stage in stages], [0, 1, 2])
        numpy.testing.assert_allclose([stage.hours for stage in stages], [0.5, 2.5, 2.0])
        self.assertEqual({stage.identity for stage in stages}, {run.identity})


if __name__ == "__main__":
    unittest.main()
