#!/usr/bin/python3
"""The fit of all systems at once (validation/lib/lags.py) and what changes of shape take (lib/shape.py). Expected numbers by other
ways, with the recipe beside each."""
import math
import pathlib
import sys
import unittest

import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "validation"))
from lib import bending, brownian, dilute, lags, semidilute, shape, stats  # noqa: E402


class Statistics(unittest.TestCase):
    def test_fisher(self):
        """-2 ln(0.1 x 0.2) = 7.824 of 4 degrees of freedom: exp(-x/2)(1 + x/2) = 0.02 (1 + 3.912)."""
        self.assertAlmostEqual(stats.fisher([0.1, 0.2]), 0.02 * (1.0 - math.log(0.02)), 12)

    def test_correlated(self):
        """Two values with errors of 1 and correlation r have the mean (x + y)/2 with the variance (1 + r)/2."""
        f = stats.fit_correlated([numpy.ones(2)], [1.0, 2.0], [[1.0, 0.6], [0.6, 1.0]])
        self.assertAlmostEqual(float(f.value[0]), 1.5, 14)
        self.assertAlmostEqual(float(f.error[0]), math.sqrt(0.8), 14)
        self.assertAlmostEqual(f.chi2, 1.0 / (2.0 * 0.4), 12)  # (y - x)^2 over its variance, 2 (1 - r)

    def test_fair_mean_is_that_of_independent_values(self):
        value, error, _ = stats.fair_mean([9.0, 11.0], numpy.diag([0.81, 1.21]))
        self.assertAlmostEqual(value, 10.0, 12)
        self.assertAlmostEqual(error, math.sqrt(0.5), 12)


class Shape(unittest.TestCase):
    def test_a_rod_becomes_rigid(self):
        """At once Kirkwood's sum, 1 H 1/N^2; at last the D of a rigid row, 1/(1 H^-1 1), along it and across. Bends and stretches
        have no other part in it."""
        n, short, rigid = 12, 0.0, 0.0
        apart = numpy.zeros((n, n, 3))
        apart[..., 0] = shape.BOND * numpy.subtract.outer(numpy.arange(n), numpy.arange(n))
        field = brownian.smeared_oseen(apart, dilute.ETA, dilute.CELL_SPREAD)
        alone = dilute.sharing_matrix(lambda draw: dilute.rod_shape(n, shape.BOND, draw))
        for weight, k in ((1.0, 0), (2.0, 1)):
            h = alone + field[..., k, k]
            short += weight * h.mean() / 3.0
            # along: one force holds all; across: a force and a torque, which by symmetry has no part
            rigid += weight / numpy.linalg.inv(h).sum() / 3.0
        self.assertAlmostEqual(shape.rod_share(n, 1e-6)[0], 0.0, 5)
        self.assertAlmostEqual(shape.rod_share(n, 1e6)[0], 1.0 - rigid / short, 6)
        self.assertTrue(0.01 < shape.rod_share(n, 1e6)[0] < 0.04)

    def test_it_grows(self):
        t = numpy.geomspace(0.4, 400.0, 30)
        self.assertGreater(float(numpy.diff(shape.rod_share(20, t)).min()), 0.0)
        self.assertGreater(float(numpy.diff(shape.chain_share(20, numpy.array(brownian.LAGS))).min()), 0.0)

    def test_table(self):
        """The first lags again, of a few chains; their errors are what 64 chains have."""
        from lib import case
        alone = 10 * case.load("chains").sharing(10)[0]
        times, lost, error, _ = brownian.slowing(10, 64, 26.0, alone, dilute.ETA, dilute.CELL_SPREAD, seed=3)
        summed = numpy.concatenate([[0.0], numpy.cumsum(0.5 * (lost[1:] + lost[:-1]))]) * times[1]
        for t in (3.2, 12.8):
            share = float(numpy.interp(t, times, summed)) / t
            self.assertAlmostEqual(shape.chain_share(10, t)[0], share, delta=5.0 * float(numpy.interp(t, times, error)) + 1e-4)

    def test_rods_have_their_size(self):
        """<R^2> of N = 10: 20.3764, exact (docs/claims/rods.md); 3000 shapes tell it to half a per cent."""
        square = (shape.rod_shapes(10)[-1]**2).sum(axis=0)
        self.assertAlmostEqual(square.mean() / 20.3764, 1.0, delta=4.0 * square.std() / math.sqrt(3000) / 20.3764)

    def test_pairs(self):
        """Of a pair's distances the mean over i, j: a row of two bonds' <l> and <|r_2 - r_0|>, by its shapes."""
        places = shape.rod_shapes(3)[..., :400]
        ends = numpy.sqrt((places[2]**2).sum(axis=0)).mean()
        bonds = [numpy.sqrt(((places[i + 1] - places[i])**2).sum(axis=0)).mean() for i in (0, 1)]
        self.assertAlmostEqual(shape.pair_mean(3, lambda r: r), 2.0 * (ends + sum(bonds)) / 9.0, 12)

    def test_a_pair_turns(self):
        """Two vertices, d = 2 apart: D_r = 2 (D - G)/d^2, D what each has by itself, G the field across their bond; tau_r = 1/(2 D_r). Oseen's
        field of points: G = 1/(8 pi eta d)."""
        pair = numpy.array([[[0.0, 0.0, 0.0], [0.0, 2.0, 0.0]]])
        across = 1.0 / (16.0 * math.pi * 10.0)
        own = brownian.smeared_oseen(numpy.zeros((1, 3)), 10.0, 1e-4)[0, 0, 0]
        for rate in shape.turning_rates(pair, 0.05 * numpy.eye(2), 10.0, 1e-4):
            self.assertAlmostEqual(rate[0], 4.0 * (0.05 + own - across) / 4.0, 4)

    def test_fibers_turn(self):
        """Without the field, all points with the same friction: 2 D_r of a straight row is 2 D/sum of s^2, and a bent fiber's frozen shape turns
        as its moment of inertia says. With it, rods of 64 turn as the cylinders of
        Tirado and Garcia de la Torre do, to 10 %: 0.925, for vertices that are smeared over cells are no cylinder."""
        row = 0.5 * (numpy.arange(9.0) - 4.0)
        straight = numpy.stack([row, 0.0 * row, 0.0 * row], axis=1)[None]
        for rate in shape.turning_rates(straight, 0.02 * numpy.eye(9), 1e30, 0.1):
            self.assertAlmostEqual(rate[0], 2.0 * 0.02 / (row**2).sum(), 12)
        bent = numpy.array([[[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]])
        about = bent[0] - bent[0].mean(axis=0)  # axis x: D about y and z, from the moments of inertia x^2 + z^2 and x^2 + y^2
        x2, y2 = (about[:, 0]**2).sum(), (about[:, 1]**2).sum()
        self.assertAlmostEqual(shape.turning_rates(bent, 0.02 * numpy.eye(3), 1e30, 0.1)[1][0], 0.02 * (1.0 / x2 + 1.0 / (x2 + y2)), 12)
        tirado = semidilute.rod_rotation_time(63 * shape.BOND, 0.6, dilute.ETA)
        self.assertAlmostEqual(shape.turning_times(64, 1e5, 1000, 10)[1] / tirado, 1.0, delta=0.1)

    def test_images_of_a_turning_rod(self):
        """What the periodic box takes from D_r, by a sum over waves: the field of the box less that of a box twice as long, which loses an
        eighth of it. A straight row of 16, its field smeared, for 24 directions."""
        along, lost = numpy.arange(16) - 7.5, []
        for box in (16, 32):
            k = bending.half_waves(box)
            square = (k**2).sum(axis=1)
            weight = 4.0 * numpy.exp(-0.5 * dilute.CELL_SPREAD * square) / (square * dilute.ETA * box**3)  # half of all waves; two axes
            rates = []
            for d in bending.directions():
                rho = numpy.sin(numpy.outer(k @ d, shape.BOND * along)) @ along
                rates.append((weight * 0.5 * (1.0 + (k @ d)**2 / square) * rho**2).sum())
            lost.append(numpy.mean(rates) / (shape.BOND * (along**2).sum())**2)
        factor = (lost[1] - lost[0]) / (1.0 - 1.0 / 8.0) / 2.0 * dilute.ETA * 16**3
        self.assertAlmostEqual(factor / shape.IMAGES, 1.0, delta=0.1)


def walkers(random, count, local, step=0.4, steps=512, share=0.0):
    """dilute.merged's table of random walkers with D = 1/2, all lags without overlap, and D(t) = D (1 - share) - local D/t."""
    times = step * 2.0**numpy.arange(8)
    moves = random.normal(size=(count, 3, steps)) * math.sqrt(step)
    d, error = [], []
    for lag in 2**numpy.arange(8):
        size = (moves.reshape(count, 3, -1, lag).sum(axis=3)**2).sum(axis=1)
        d.append(size.mean() / 6.0 / (lag * step))
        error.append(0.5 * math.sqrt(2.0 / 3.0 / size.size))
    d = numpy.array(d) - 0.5 * (share + local / times)
    return {"time": times, "D": d, "D_error": numpy.array(error)}


def system(table, share=0.0):
    return lags.System(table, numpy.zeros_like, 0.5, lambda t: share * numpy.ones_like(t), 2)


class Together(unittest.TestCase):
    def test_one_tau_for_all(self):
        """Without noise: D of each, and tau, come back, with the share of the change of shape taken back."""
        t = 0.4 * 2.0**numpy.arange(8)
        made = [system({"time": t, "D": d * (1.0 - 0.3 / t) - 0.02 * 0.5, "D_error": 0.001 * numpy.sqrt(t)}, 0.02) for d in (0.5,)]
        found = lags.joint(made, 0.8)
        self.assertAlmostEqual(float(found.value[0]), 0.5, 12)
        self.assertAlmostEqual(found.tau, 0.3, 12)

    def test_errors(self):
        """200 sets of three systems of 20 walkers: D and tau have their errors, and so has the change of all D with the first
        lag doubled (sets tell a scatter of 1 to 0.05)."""
        random, pulls, changes = numpy.random.Generator(numpy.random.PCG64(8)), [], []
        for _ in range(200):
            found = lags.joint([system(walkers(random, 20, 0.2)) for _ in range(3)], 0.8)
            pulls.append((found.value[0] - 0.5) / math.sqrt(found.covariance[0, 0]))
            changes.append(found.doubled[0] / found.doubled[1])
        for values in (pulls, changes):
            self.assertLess(abs(numpy.mean(values)), 4.0 / math.sqrt(200))
            self.assertLess(abs(numpy.std(values) - 1.0), 0.2)

    def test_rule(self):
        """A memory that 1/t does not describe, 2 % of D until 2 t0: the rule waits until it is over."""
        random, made = numpy.random.Generator(numpy.random.PCG64(9)), []
        for _ in range(4):
            table = walkers(random, 400, 0.1, steps=2048)
            table["D"] = table["D"] + 0.01 * (table["time"] < 2.0)
            made.append(system(table))
        first, rows = lags.rule(made, (0.4, 0.8, 1.6, 3.2))
        self.assertEqual(first, 3.2)
        self.assertLess(rows[1][1], 0.05)
        self.assertLess(made and lags.joint(made, 3.2).estimator, 0.02)

    def test_pulled(self):
        """Fibers that drift with D F and a memory of waves, of their shape, and of what decayed at once: D comes back, and its error is the
        scatter of 300 sets (they tell it to 4 %), whatever the memory before the first lag."""
        t, share, d, fibers = 1.6 * numpy.arange(1.0, 101.0), 0.02, 0.5, 24
        made = lags.System(None, lambda x: 0.03 / numpy.sqrt(x), d, lambda x: share * numpy.ones_like(x), 2)
        mean = d * t * (1.0 - share) - t * made.waves(t) - 0.7 * d
        random, found = numpy.random.Generator(numpy.random.PCG64(10)), []
        for _ in range(300):
            steps = random.normal(0.0, math.sqrt(2.0 * d * 1.6 / 9.0), (fibers, 100))  # a force of 3: noise over force
            since = steps[:, 8:].sum(axis=1)  # from 12.8 t0 on
            columns = {"time": t, "way": mean + numpy.cumsum(steps.mean(axis=0)),
                       "since_error": numpy.where(numpy.arange(100) == 7, 0.0, since.std() / math.sqrt(fibers - 1.0))}
            found.append(lags.pulled(columns, made, 12.8))
        value, error = numpy.array(found).T
        self.assertLess(abs(value.mean() - d), 5.0 * value.std() / math.sqrt(300))
        self.assertAlmostEqual(value.std() / error.mean(), 1.0, delta=5.0 * 0.041)
        exact = lags.pulled({"time": t, "way": mean, "since_error": 1.0 * (numpy.arange(100) != 7)}, made, 12.8)
        self.assertAlmostEqual(exact[0], d, 12)
        with self.assertRaises(ValueError):
            lags.pulled({"time": t, "way": mean, "since_error": 1.0 * (numpy.arange(100) != 3)}, made, 12.8)

    def test_beside(self):
        self.assertEqual(lags.beside(numpy.array([[4.0, 1.0], [1.0, 9.0]]), [2.0]).tolist(), [[4, 1, 0], [1, 9, 0], [0, 0, 4]])

    def test_per_length(self):
        """Two boxes of one length with errors of 0.1 and 0.2, one of another, no correlation: the mean, weighted by 4 and 1."""
        far, logs = lags.per_length([5, 5, 7], numpy.array([1.0, 1.0, 2.0]), numpy.diag([0.01, 0.04, 0.01]), {5: 1.0, 7: 2.0}.get)
        self.assertAlmostEqual(far[5][0], 1.0, 12)
        self.assertAlmostEqual(far[5][1], 1.0 / math.sqrt(125.0), 12)
        self.assertAlmostEqual(float(logs[1, 1]), 0.0025, 12)

    def test_image_slope(self):
        """Boxes whose images take 0.8 of their share."""
        shifts = numpy.array([0.1, 0.2, 0.3, 0.1, 0.2])
        limit = numpy.array([1.0, 1.0, 1.0, 2.0, 2.0])
        slope, _ = lags.image_slope([5, 5, 5, 7, 7], limit - 0.8 * shifts + shifts, shifts, 0.01 * numpy.eye(5), float)
        self.assertAlmostEqual(slope, 0.8, 12)
        self.assertIsNone(lags.image_slope([5, 7], [1.0, 2.0], [0.1, 0.1], numpy.eye(2), float))

    def test_the_estimator_is_common(self):
        """Of the mean of two lengths with 1 % each and 2 % in common: sqrt(0.01^2/2 + 0.02^2)."""
        far = {5: (1.0, 0.01, 1.0), 7: (2.0, 0.02, 1.0)}
        mean, error = lags.mean_over(far, 1e-4 * numpy.eye(2), {5: 1.0, 7: 2.0}.get, 0.02)
        self.assertAlmostEqual(mean, 1.0, 12)
        self.assertAlmostEqual(error, math.sqrt(0.5e-4 + 4e-4), 12)


if __name__ == "__main__":
    unittest.main()
