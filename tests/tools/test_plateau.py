#!/usr/bin/python3
"""A diffusion coefficient is shown as final only if it has stopped moving: pages of runs, of sweeps and of comparisons.

Random walks, whose D does not change, give the rate of false alarms: their intervals and errors are made here with NumPy, as
docs/observables.md has them. The scene with a D that grows is that of a reader, whose longer runs gave 1.6 times as much.
"""
import csv
import os
import pathlib
import sys
import unittest
import unittest.mock

import numpy

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, UNCROSS, FolderTest, uncross  # noqa: E402

os.environ["UNCROSS"] = str(UNCROSS)
sys.path.insert(0, str(TOP / "python"))
from uncross_plot import compare, distrust, page, runs, sweeps, tables  # noqa: E402
from uncross_sweep import averages, plateau  # noqa: E402

SHORT = """box: [16, 16, 16]
time_step: 0.01
steps: 2000
solvent: {per_cell: 5, collision_interval: 0.02}
fibers:
  - {name: micelle, count: 40, vertices: 24, mass: 5, bond_length: 0.5, spring: 100, persistence_length: 4}
observe: {dynamics: {every: 10}}
"""


def of_interval(walk, lag):
    """(mean, error) of the growth of g_cm from lag/2 to lag over 3 lag, lag even: of each interval, as docs/observables.md
    says; the larger of the errors in time and over fibers."""
    half = numpy.diff(walk[::lag // 2], axis=0)
    half = half[:len(half) // 2 * 2]
    a, b = half[::2], half[1::2]
    return errors_of((((a + b)**2).sum(-1) - ((a**2).sum(-1) + (b**2).sum(-1)) / 2.0) / (3.0 * lag))


def errors_of(values):
    """(mean, error) of values [intervals][fibers]: the larger of the errors in time and over fibers."""
    time = averages.blocked_mean(values.mean(axis=1))[1]
    fiber = values.mean(axis=0)
    over = fiber.std(ddof=1) / numpy.sqrt(len(fiber)) if len(fiber) >= 8 else numpy.nan
    return values.mean(), float(numpy.fmax(time, over))


def table_of(walk):
    """A table of dynamics at the lags 2 and 4 of a walk [times][fibers][3]."""
    found = numpy.array([of_interval(walk, lag) for lag in (2, 4)])
    total = numpy.array([errors_of((numpy.diff(walk[::lag], axis=0)**2).sum(-1) / (6.0 * lag)) for lag in (2, 4)])
    return {"time": numpy.array([2.0, 4.0]), "intervals": numpy.array([len(walk) // 2, len(walk) // 4]),
            "D": total[:, 0], "D_error": total[:, 1], "D_cumulative": found[:, 0], "D_cumulative_error": found[:, 1]}


class TestIntervals(unittest.TestCase):
    """A row of collisions.csv tells of the time since the row before; the first one of the time since the start. Tables of
    earlier programs begin with a row of step 0, which tells of no time."""

    def test_rows_whose_whole_interval_is_observed(self):
        table = {"step": numpy.array([10, 20, 30, 45]), "rate": numpy.array([1.0, 2.0, 3.0, 4.0])}
        earlier = {name: numpy.concatenate(([0], column)) for name, column in table.items()}
        for start, expected in ((0, [1, 2, 3, 4]), (1, [2, 3, 4]), (10, [2, 3, 4]), (15, [3, 4]), (30, [4]), (31, [])):
            for one in table, earlier:
                self.assertEqual(list(averages.since(one, "rate", start, True)), expected)
        self.assertEqual(list(averages.since(table, "rate", 20, False)), [2, 3, 4])


def walks(fibers, intervals, trials, growth=0.0):
    """Tables of random walks; growth: the part of each step that is that of two steps ago."""
    random = numpy.random.default_rng(36)
    for _ in range(trials):
        steps = random.normal(size=(4 * intervals, fibers, 3))
        steps[2:] = steps[2:] + growth * steps[:-2]
        yield table_of(numpy.concatenate([numpy.zeros((1, fibers, 3)), numpy.cumsum(steps, axis=0)]))


class Rule(unittest.TestCase):
    def test_false_alarms(self):
        """One fiber with 16 intervals: 0.6 % are expected, so that more than 9 of 400 come by chance once in 5000 times; 64
        fibers: 0.1 %, more than 2 of 150 once in 2000."""
        for fibers, trials, most in ((1, 400, 9), (64, 150, 2)):
            alarms = sum(plateau.plateau(table, 1).moves for table in walks(fibers, 16, trials))
            self.assertLessEqual(alarms, most, f"{fibers} fibers")

    def test_what_moves_is_seen(self):
        """Steps s(i) + s(i - 2)/2: g(n)/3 = 5n/4, and (n - 2) more from n = 2 on. It grows by 5/4 from 1 to 2 and by 9/2 from 2 to 4:
        slopes of 5/4 and of 9/4, a change of 4/9 of the latter."""
        found = plateau.plateau(next(walks(64, 2000, 1, growth=0.5)), 1)
        self.assertTrue(found.moves)
        self.assertAlmostEqual(found.change, 4.0 / 9.0, delta=4.0 * found.error)
        self.assertLess(found.error, 0.02)

    def test_by_hand(self):
        table = {"time": numpy.array([1.0, 2.0, 3.0, 4.0]), "D": numpy.array([1.0, 2.0, 2.5, 3.5]),
                 "D_error": numpy.array([0.3, 0.3, 0.3, 0.3]), "D_cumulative": numpy.array([numpy.nan, 3.0, numpy.nan, 4.0]),
                 "D_cumulative_error": numpy.array([numpy.nan, 0.3, numpy.nan, 0.4])}
        found = plateau.plateau(table, 3)  # 4 - 3, and sqrt(0.3^2 + 0.4^2) = 0.5; over 4
        self.assertAlmostEqual(found.change, 0.25, 14)
        self.assertAlmostEqual(found.error, 0.125, 14)
        self.assertFalse(found.moves)  # 2 errors
        self.assertEqual(found.word, "not known to be final")
        first = plateau.plateau(table, 1)  # there is no octave before: against D up to there, (3 - 1)/3
        self.assertAlmostEqual(first.change, 2.0 / 3.0, 14)
        self.assertTrue(first.moves)  # 2/sqrt(0.3^2 + 0.3^2) = 4.7 errors
        for row in (0, 2):
            self.assertIn("no two octaves", plateau.plateau(table, row).doubt("D"))
        table["D_cumulative_error"][:] = table["D_error"][:] = 0.01
        table["D_cumulative"][1] = 4.0
        table["D"][1] = table["D"][3] = 4.0
        self.assertEqual(plateau.plateau(table, 3).doubt("D"), "")

    def test_the_number_that_is_shown_is_tested(self):
        """Langevin particles: g = 6 D (t - tau), so that octaves have D, and g/6t has D (1 - tau/t). With tau/t = 1/20 it is 5 % below."""
        lag, tau = numpy.array([2.5, 5.0, 10.0]), 0.5
        table = {"time": lag, "D": 3.0 * (1.0 - tau / lag), "D_error": 0.03 * numpy.ones(3), "D_cumulative": 3.0 * numpy.ones(3),
                 "D_cumulative_error": 0.04 * numpy.ones(3)}
        found = plateau.plateau(table, 2)
        self.assertAlmostEqual(found.change, 0.0, 14)
        self.assertTrue(found.moves)  # 0.15 and sqrt(0.03^2 + 0.04^2)/2 = 0.025: 6 errors
        self.assertEqual(found.word, "still moving")
        self.assertRegex(found.doubt("D"), r"D is not final: it is 5% below .* at lag 10 t0 \(6\.0 errors\)")
        table["D_cumulative_error"][:] = 0.2
        self.assertFalse(plateau.plateau(table, 2).moves)  # 1.5 errors


class Pages(FolderTest):
    """The scene above, twice: by seeds of a sweep, and each against the other."""

    def test_no_page_takes_it_as_final(self):
        (self.dir / "short.yaml").write_text(SHORT)
        out = self.dir / "swept"
        done = uncross("sweep", self.dir / "short.yaml", "--out", out, "--seeds", "1..2", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        with (out / "summary.csv").open(encoding="ascii") as file:
            row = next(csv.DictReader(file))
        lag = float(row["lag_micelle"])
        with unittest.mock.patch.object(sweeps, "figure", lambda *_: ""):  # words are tested here, and figures take seconds
            text = sweeps.page_of(str(out))
        self.assertNotIn("Nothing that this page looks for", text)
        self.assertNotIn("micelle_", text[text.index("What to distrust"):text.index("What to distrust") + 2000])  # errors are no kinds
        self.assertRegex(text, rf"<li>all: D of &#39;micelle&#39; is not final: it grows by \d+% from one octave of lags to the next, at lag {lag:.3g} t0")
        self.assertIn(f"at lag {lag:.3g} t0", text.partition("<figcaption")[2])  # beside each D
        both = [runs.read(str(out / "all" / f"seed-{seed}")) for seed in (1, 2)]
        for run in both:
            told = [text for text in distrust.of_run(run) if "is not final" in text]
            self.assertEqual(len(told), 1)
            self.assertIn(f"at lag {lag:.3g} t0 (still moving)", page._result(run))
        with unittest.mock.patch.object(tables, "compare", lambda *_: []), unittest.mock.patch.object(page, "picture_of", lambda *_: page.Section("", [])):
            self.assertEqual(compare.page_of(*both).count("is not final: it grows"), 2)


if __name__ == "__main__":
    unittest.main()
