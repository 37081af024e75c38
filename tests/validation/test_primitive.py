#!/usr/bin/python3
"""Estimators of primitive paths (validation/lib/primitive.py), each against paths whose numbers are known, and the verdicts of the case on made-up
tables."""
import math
import pathlib
import sys
import types
import unittest

import numpy

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TREE / "validation"))
from lib import case, primitive  # noqa: E402

PRIMITIVE = case.load("primitive")
sys.path.insert(0, str(TREE / "tests"))
from support import load  # noqa: E402

MEASURE = load(TREE / "validation/measure/primitive.py")


def walks(draw, steps, step, bonds):
    """Paths of Z + 1 random straight steps, each cut into `bonds` bonds of equal length."""
    found = []
    for count in steps:
        along = draw.normal(size=(count, 3))
        along *= step / numpy.linalg.norm(along, axis=1)[:, None]
        corners = numpy.concatenate([[[0.0, 0.0, 0.0]], numpy.cumsum(along, axis=0)])
        at = numpy.linspace(0.0, count, count * bonds + 1)
        found.append(numpy.stack([numpy.interp(at, numpy.arange(count + 1), corners[:, k]) for k in range(3)], axis=1))
    return found


class Estimators(unittest.TestCase):
    def setUp(self):
        self.draw = numpy.random.Generator(numpy.random.PCG64(41))

    def test_steps_of_one_number(self):
        """Z + 1 = 9 steps of 3 a0, N = 180 bonds: <R^2> = 9 a^2, L = 9 a. The modified S-coil has N/Z, the classical one counts the ends."""
        paths = numpy.array(walks(self.draw, [9] * 4000, 3.0, 20))
        length, square = primitive.lengths(paths), primitive.spans(paths)
        numpy.testing.assert_allclose(length, 27.0, rtol=1e-12)
        error = square.std() / square.mean() / 4000**0.5
        self.assertLess(abs(square.mean() / 81.0 - 1.0), 4.0 * error)
        self.assertLess(abs(primitive.step(length, square) / 3.0 - 1.0), 4.0 * error)
        self.assertLess(abs(primitive.classical(length, square, 180) / 20.0 - 1.0), 4.0 * error)
        self.assertLess(abs(primitive.modified(length, square, 180) / 22.5 - 1.0), 4.0 * error * 9.0 / 8.0)

    def test_steps_of_many_numbers(self):
        """Z + 1 is 3 or 21, as often: <L^2>/<R^2> = (9 + 441)/24 = 18.75, <L>^2/<R^2> = 12. An estimator with the one for the other is off by half."""
        paths = walks(self.draw, [3, 21] * 3000, 2.0, 4)
        length, square = (numpy.array([of(path) for path in paths]) for of in (primitive.lengths, primitive.spans))
        error = square.std() / square.mean() / 6000**0.5
        self.assertLess(abs(primitive.modified(length, square, 100) / (100 / 17.75) - 1.0), 5.0 * error)
        self.assertLess(abs(primitive.classical(length, square, 100) / (100 / 12.0) - 1.0), 5.0 * error)

    def test_paths_longer_than_the_box(self):
        """Positions are unwrapped: a straight path of 40 a0 in a box of 16."""
        path = numpy.linspace([1.0, 2.0, 3.0], [41.0, 2.0, 3.0], 81)
        self.assertAlmostEqual(float(primitive.lengths(path)), 40.0, 12)
        self.assertAlmostEqual(float(primitive.spans(path)), 1600.0, 9)
        rows = numpy.concatenate([path, path + 5.0])
        self.assertEqual(primitive.unfolded(rows, 81).shape, (2, 81, 3))
        self.assertEqual(primitive.unfolded(numpy.stack([rows] * 4), 81).shape, (4, 2, 81, 3))
        numpy.testing.assert_allclose(primitive.lengths(primitive.unfolded(rows, 81)), 40.0)

    def test_known_square(self):
        """With the exact <R^2> the ratio is right, and its error smaller than that of both means: L^2 goes with R^2."""
        found = []
        for _ in range(300):
            square = self.draw.exponential(6.0, 40)
            length = numpy.sqrt(40.0 + 3.0 * square + self.draw.normal(size=40))
            found.append(primitive.known_square(length, square, 6.0))
        values, errors = numpy.array(found).T
        self.assertLess(abs(values.mean() - 58.0 / 6.0), 0.01)
        self.assertLess(abs(values.std() / errors.mean() - 1.0), 0.2)
        self.assertLess(errors.mean(), 0.2)

    def test_at_rest(self):
        k = numpy.array([100.0, 300.0, 900.0])
        value, error = primitive.at_rest(k, 7.0 * (1.0 + 4.0 / k + 9.0 / k**2), [0.01, 0.01, 0.01])
        self.assertAlmostEqual(value, 7.0, 9)
        self.assertAlmostEqual(error, 0.01 * math.hypot(0.0625, 0.75, 1.6875), 9)
        self.assertAlmostEqual(primitive.at_rest(k[1:], 7.0 * (1.0 + 4.0 / k[1:]), [0.01, 0.01])[0], 7.0, 9)

    def test_width(self):
        """sigma^2 per transverse component, one fluctuating position: 0.09 about a straight path and a circle."""
        count, sigma = 2000, 0.3
        path = numpy.linspace([0.0, 0.0, 0.0], [100.0, 0.0, 0.0], count)
        shaken = path + sigma * self.draw.normal(size=path.shape)
        self.assertAlmostEqual(primitive.inner(primitive.across(shaken[None], path[None]), 0.05)[0] / sigma**2, 1.0, delta=0.1)
        self.assertAlmostEqual(primitive.inner(primitive.beside(shaken[None], path[None]), 0.05)[0] / sigma**2, 1.0, delta=0.1)
        angle = numpy.linspace(0.0, 3.0, count)
        ring = 60.0 * numpy.stack([numpy.cos(angle), numpy.sin(angle), 0.0 * angle], axis=1)
        shaken = ring + sigma * self.draw.normal(size=ring.shape)
        self.assertAlmostEqual(primitive.inner(primitive.across(shaken[None], ring[None]), 0.05)[0] / sigma**2, 1.0, delta=0.1)

    def test_ends_are_left_out(self):
        values = numpy.array([[9.0, 1.0, 1.0, 1.0, 9.0]])
        self.assertEqual(primitive.inner(values, 0.2)[0], 1.0)
        self.assertEqual(primitive.inner(values, 0.0)[0], 4.2)


class Formulas(unittest.TestCase):
    def test_bonds_and_coils(self):
        """By quadrature, and the values of l_K that an independent program has for l_p = 0.5, 2, 8 and 32 a0."""
        r = numpy.linspace(1e-6, 2.0, 400001)
        weight = r**2 * numpy.exp(-50.0 * (r - 0.5)**2)
        for n, value in enumerate(primitive.moments(0.5, 100.0), 1):
            self.assertAlmostEqual(value, (weight * r**n).sum() / weight.sum(), 6)
        for persistence, kuhn in ((0.5, 1.046), (2.0, 3.798), (8.0, 16.71), (32.0, 68.40)):
            self.assertAlmostEqual(primitive.coil(10**7, 0.5, 100.0, persistence)[1], kuhn, delta=0.0006 * kuhn)
        self.assertAlmostEqual(primitive.coil(1, 0.5, 100.0, 2.0)[0], primitive.moments(0.5, 100.0)[1], 12)

    def test_curve(self):
        """Values of the curve at two points, and its slope by differences."""
        self.assertAlmostEqual(float(primitive.uchida(6.18)), 8.77, delta=0.02)
        self.assertAlmostEqual(float(primitive.uchida(962.0)), 0.198, delta=0.0005)
        for x in (2.0, 13.0, 500.0):
            slope = math.log(primitive.uchida(1.001 * x) / primitive.uchida(0.999 * x)) / math.log(1.001 / 0.999)
            self.assertAlmostEqual(float(primitive.uchida_slope(x)), slope, 5)


def known_text(short=1.0):
    rows = ["path,k,exact,L,error,contacts,softened,rigid"]
    for path in PRIMITIVE.KNOWN:
        rows += [f"{path},{k},8,{8 * short * (1 + 60 / k)},0.002,100000,3,0" for k in (1000, 3000, 9000)]
    return "\n".join(rows) + "\n"


def result(text):
    return types.SimpleNamespace(text=text, exists=True)


def coil_text(name, strand, draw, scatter=0.0, rigid=0):
    """Tables of a coil whose chains all have L_pp of strands of so many bonds, whatever their R^2; `scatter` is that of L_pp between chains."""
    _, chains, vertices, rest, spring, persistence, *_ = PRIMITIVE.ALL[name]
    exact = primitive.coil(vertices - 1, rest, spring, persistence)[0]
    length = math.sqrt(((vertices - 1) / strand + 1.0) * exact) * (1.0 + scatter * draw.normal(size=chains))
    springs = (90, 270, 810, 2430)
    lines = ["stages", "k,drift,contacts,softened,rigid", *(f"{k},0.0005,1000000,100,{rigid}" for k in springs), "chains", "R2,contour,sigma2," + ",".join(f"L{k}" for k in springs)]
    lines += [",".join(f"{x:.9g}" for x in (s, 1.0, 0.1, *(one * (1.0 + 5.0 / k) for k in springs))) for s, one in zip(exact * draw.chisquare(3, chains) / 3.0, length)]
    return "\n".join(lines)


class Case(unittest.TestCase):
    def setUp(self):
        self.draw = numpy.random.Generator(numpy.random.PCG64(43))

    def made_up(self, power, **more):
        """Verdicts of coils whose L_e goes with a power of x, 40 bonds at x = 2.09."""
        results = {}
        for name in ("coil-1", "coil-2", "coil-3", "coil-6", "coil-13", *more):
            x = PRIMITIVE.Point(name, "stages\nk\n90\nchains\nR2\n1\n").x
            results[name] = result(coil_text(name, more.get(name, 1.0) * 40.0 * (x / 2.09)**power, self.draw, 0.02))
        return {v.id.removeprefix("primitive."): v for v in PRIMITIVE.evaluate(results, "campaign").verdicts}

    def test_exponents(self):
        """L_e of known powers gives them back, between neighbors too, and each is told from the other."""
        for power, loosest in ((-2.0, "pass"), (-4.0 / 3.0, "not reproduced")):
            found = self.made_up(power)
            for name in ("exponent.loose", "exponent.loosest", "local.1", "local.2", "local.3", "local.6"):
                self.assertLess(abs(found[name].measured - power), 4.4 * found[name].error, name)
                self.assertLess(found[name].error, 0.2)
            self.assertEqual(found["exponent.loosest"].verdict, loosest)

    def test_forms(self):
        """A curve of both powers: the right second power fits, and the other does not."""
        x = numpy.array([1.0, 2.0, 3.0, 6.0, 13.0])
        for n in (4.0 / 3.0, 2.0):
            made = [types.SimpleNamespace(x=one, kuhn=1.0, strand=lambda one=one, n=n: ((one / 16.0)**-0.4 + (one / 16.0)**-n, 0.03 * (one / 16.0)**-n)) for one in x]
            found = PRIMITIVE.forms(made)
            self.assertLess(found[n].chi2, 1e-12)
            self.assertGreater(min(fit.chi2 for power, fit in found.items() if power != n), 20.0)

    def test_changes_are_seen(self):
        """Half bonds with L_e of 1.5, and cooled slowly with L_pp 5 % shorter: both are seen; equal ones pass."""
        same = self.made_up(-1.0, **{"coil-13-fine": 2.0, "coil-13-slow": 1.0})
        self.assertEqual((same["bonds.13"].verdict, same["rate.13"].verdict, same["step.13"].verdict), ("pass", "pass", "undecided"))
        other = self.made_up(-1.0, **{"coil-13-fine": 3.0, "coil-13-slow": 1.15})
        self.assertEqual((other["bonds.13"].verdict, other["rate.13"].verdict), ("not reproduced", "not reproduced"))

    def test_rigid_contacts_are_seen(self):
        text = coil_text("coil-13", 12.0, self.draw)
        for name, said in (("coil-13", "not reproduced"), ("coil-13-step0.1", "undecided")):
            with self.subTest(name):
                results = {name: result(coil_text(name, 12.0, self.draw, rigid=1)), **({} if name == "coil-13" else {"coil-6": result(coil_text("coil-6", 12.0, self.draw))})}
                words = {v.id: v.verdict for v in PRIMITIVE.evaluate(results, "campaign").verdicts}
                self.assertEqual(words["primitive.contacts.rigid"], said if name == "coil-13" else "pass")
        self.assertIn("L2430", text)

    def test_runs(self):
        self.assertEqual([run.name for run in PRIMITIVE.runs("quick")], ["known"])
        self.assertEqual([run.name for run in PRIMITIVE.runs("campaign")], ["known", *PRIMITIVE.POINTS, *PRIMITIVE.CHANGED])
        words = {run.name: run.program for run in PRIMITIVE.runs("campaign")}
        self.assertEqual(words["coil-13-slow"], [*words["coil-13"], "pace=3"])
        self.assertEqual(words["coil-13-step0.1"], words["coil-13"][:-1])

    def test_points(self):
        """More than three decades of rho l_K^2, and the table of the theory: 13.4, 6.18, 2.94, 2.09; 97, 125, 552, 962, 3906."""
        found = {name: PRIMITIVE.Point(name, "stages\nk\n90\nchains\nR2\n1\n").x for name in PRIMITIVE.ALL}
        for name, x in (("coil-1", 1.04), ("coil-13", 13.4), ("coil-6", 6.18), ("coil-3", 2.94), ("coil-2", 2.09), ("stiff-97", 96.9), ("stiff-125", 125), ("stiff-552", 552), ("stiff-962", 962),
                        ("stiff-3906", 3906)):
            self.assertLess(abs(found[name] / x - 1.0), 0.03, name)

    def test_changed_points_are_the_same_system(self):
        """x and l_K are those of the plain point, within 0.5 % where the seed is another: else unlike chains would be compared. l_K of half bonds by the
        sum over all pairs of bonds of a long chain."""
        made = {name: PRIMITIVE.Point(name, "stages\nk\n90\nchains\nR2\n1\n") for name in PRIMITIVE.ALL}
        for changed, plain, *_ in (*PRIMITIVE.SAME.values(), *PRIMITIVE.OTHER.values()):
            for of in ("x", "kuhn", "rho"):
                self.assertLess(abs(getattr(made[changed], of) / getattr(made[plain], of) - 1.0), 0.005, (changed, of))
        kappa = 0.5793 / 0.25
        cosine = numpy.linspace(-1.0, 1.0, 200001)
        weight = numpy.exp(kappa * cosine)
        c = (weight * cosine).sum() / weight.sum()
        mean, square = primitive.moments(0.25, 400.0)
        pairs = 2.0 * sum(mean**2 * c**n * (1.0 - n / 4000) for n in range(1, 400))
        self.assertAlmostEqual((square + pairs) / mean, made["coil-13"].kuhn, delta=0.002)

    def test_bonds_cut_in_two(self):
        """The same polygon: equal contour and ends, twice the bonds."""
        chains = self.draw.normal(size=(3, 7, 3)).cumsum(axis=1)
        cut = MEASURE.split(chains)
        self.assertEqual(cut.shape, (3, 13, 3))
        numpy.testing.assert_allclose(primitive.lengths(cut), primitive.lengths(chains))
        numpy.testing.assert_array_equal(cut[:, ::2], chains)
        self.assertLess(numpy.abs(primitive.across(cut, numpy.repeat(chains, 1, axis=0)[:, [0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6]])).max(), 1e-20)

    def test_verdicts(self):
        def words(text):
            return {v.id.removeprefix("primitive."): v.verdict for v in PRIMITIVE.evaluate({"known": result(text)}, "quick").verdicts}
        self.assertEqual(words(known_text()), {"posts": "pass", "links": "pass", "lattice": "pass", "softened": "pass"})
        self.assertEqual(words(known_text(0.99)), {"posts": "fail", "links": "fail", "lattice": "fail", "softened": "pass"})
        self.assertEqual(words(known_text().replace(",3,0", ",900,0"))["softened"], "fail")
        self.assertEqual({v.verdict for v in PRIMITIVE.evaluate({}, "quick").verdicts}, {"undecided"})

    def test_points_of_made_up_tables(self):
        """Chains of 19 strands each: the modified S-coil finds them, whatever k adds to L_pp."""
        draw = numpy.random.Generator(numpy.random.PCG64(5))
        _, chains, vertices, rest, spring, persistence, *_ = PRIMITIVE.POINTS["coil-6"]
        exact, kuhn = primitive.coil(vertices - 1, rest, spring, persistence)
        square = exact * draw.chisquare(3, chains) / 3.0
        length = math.sqrt(20.0 * exact) * numpy.ones(chains)
        lines = ["stages", "k,drift,contacts,softened,rigid", *(f"{k},0.0005,1000000,100,0" for k in (30, 90, 270, 810)), "chains", "R2,contour,sigma2,L30,L90,L270,L810"]
        lines += [",".join(f"{x:.9g}" for x in (s, 1.0, 0.1, *(one * (1.0 + 5.0 / k) for k in (30, 90, 270, 810)))) for s, one in zip(square, length)]
        point = PRIMITIVE.Point("coil-6", "\n".join(lines))
        value, error = point.strand()
        self.assertAlmostEqual(value / point.mean, (vertices - 1) / 19.0, 6)
        self.assertLess(error / value, 1e-6)
        self.assertAlmostEqual(point.kuhn, kuhn, 12)
        self.assertIn("rigid", PRIMITIVE.prose({"coil-6": point}))


if __name__ == "__main__":
    unittest.main()
