#!/usr/bin/python3
"""The validation case settings: what it makes of made-up values, errors and times; its scenes; its page."""
import collections
import pathlib
import re
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TREE / "validation"))
from lib import case  # noqa: E402

SETTINGS = case.load("settings")


def row(value, error, spent, time=1.0, quantity="chain", words="", family="a"):
    return SETTINGS.Row(SETTINGS.Setting(quantity, family, "s", 0.01, words, None), value, error, spent, time)


class Compared(unittest.TestCase):
    def test_alone(self):
        """An error of 4 % after 2 s is one of 1 % after 32 s, and there is nothing to be off from."""
        one = row(5.0, 0.2, 2.0, time=30.0)
        SETTINGS.compare([one], None)
        self.assertAlmostEqual(one.seconds, 32.0)
        self.assertIsNone(one.off)
        self.assertFalse(one.late)

    def test_family(self):
        """Variances are averaged, after one t0 of each; the first has the answer; its error counts in the distances."""
        first, other, wrong = row(1.0, 0.02, 10.0, time=100.0), row(1.005, 0.01005, 4.0, time=200.0), row(1.1, 0.0, 1.0, time=100.0)
        SETTINGS.compare([first, other, wrong], None)
        variance = (0.04 + 0.02 + 0.0) / 3.0
        for one, per_time in ((first, 0.1), (other, 0.02), (wrong, 0.01)):
            self.assertAlmostEqual(one.seconds, variance / 1e-4 * per_time)
        self.assertEqual(first.off, (0.0, 0.02))
        self.assertAlmostEqual(other.off[0], 0.005)
        self.assertAlmostEqual(other.off[1], 1.005 * (0.01**2 + 0.02**2) ** 0.5)
        self.assertAlmostEqual(wrong.off[1], 1.1 * 0.02)
        self.assertEqual([one.late for one in (first, other, wrong)], [False, False, True])
        self.assertIs(SETTINGS.cheapest([first, other, wrong]), other)  # wrong is cheaper, and never right

    def test_late(self):
        """What is off by more than 1 %, and surely so."""
        for value, error, late in ((1.03, 0.002, True), (1.03, 0.0125, False), (1.03, 0.0095, True), (1.008, 0.001, False), (0.97, 0.002, True)):
            one = row(value, error, 1.0)
            SETTINGS.compare([one], 1.0)
            self.assertEqual(one.late, late, (value, error))
        lone = row(1.2, 0.001, 1.0)
        SETTINGS.compare([lone], 1.0)
        self.assertIsNone(SETTINGS.cheapest([lone]))

    def test_late_by_theory(self):
        """x^2/12 - x^4/720 + ... (the series of x/2 coth x/2): 0.33 % at 0.2, 1.33 % at 0.4, whatever was measured."""
        for step in (0.1, 0.2, 0.4):
            self.assertAlmostEqual(SETTINGS.leap_frog(step), step**2 / 12 - step**4 / 720, delta=1e-6)
            one = SETTINGS.Row(SETTINGS.Setting("vertex", "private bath", "s", step, "", None), 0.2, 0.002, 1.0, 1.0)
            SETTINGS.compare([one], 0.2)
            self.assertEqual(one.late, step == 0.4)
        self.assertFalse(row(1.0, 0.1, 1.0, quantity="tube", family="private bath").late)

    def test_ways_of_a_viscosity_have_variances_of_their_own(self):
        waves, box = row(1.0, 0.01, 1.0, quantity="viscosity", words="waves"), row(1.0, 0.1, 1.0, quantity="viscosity", words="sheared box")
        SETTINGS.compare([waves, box], None)
        self.assertAlmostEqual(waves.seconds, 1.0)
        self.assertAlmostEqual(box.seconds, 100.0)


class Verdicts(unittest.TestCase):
    Run = collections.namedtuple("Run", "program")
    Result = collections.namedtuple("Result", "run columns")

    def test_theory(self):
        """SRD at dt_c 0.05 by hand, Padding's Eqs. (30), (31) at 90 degrees: n' = 5 - 1 + e^-5, kinetic (5 dt/2)(5/(2 n' 0.6) - 1) per particle, collisional n'/(18 5 dt) as much."""
        nu = 4.58691 / 5.0
        for factor, word in ((1.0, "pass"), (1.3, "not reproduced"), (0.7, "not reproduced")):
            result = self.Result(self.Run(["shear_decay"]), {"nu": [factor * nu], "nu_error": [0.002 * nu]})
            found = {one.id: one.verdict for one in SETTINGS.verdicts({"waves-srd-0.05": result})}
            self.assertEqual(found["settings.viscosity.srd.0.05"], word)
            self.assertEqual(found["settings.viscosity.at-a.0.02"], "undecided")


class Scenes(unittest.TestCase):
    def test_names_and_steps(self):
        runs = SETTINGS.runs("campaign")
        self.assertEqual(len({run.name for run in runs}), len(runs))
        self.assertEqual(SETTINGS.runs("quick"), [])
        with self.assertRaises(ValueError):
            SETTINGS.sampled(0.6, 0.035)

    def test_families_begin_with_the_smallest_step(self):
        """The first is the answer, unless theory has it: no step is smaller, no thermostat acts."""
        families = {}
        for one in SETTINGS.settings():
            families.setdefault((one.quantity, one.family), []).append(one)
        for key, family in families.items():
            dt = [float(re.search(r"^time_step: (.*)", one.run.scene, re.M)[1]) if one.run.scene else 0.0 for one in family]
            self.assertEqual(dt[0], min(dt), key)
            self.assertNotRegex(family[0].run.scene or "", "thermostat: (rescale|maxwell)", key)


@unittest.skipUnless((TREE / "reference-data/campaign/settings").exists(), "no campaign yet")
class Page(unittest.TestCase):
    def test_tables_are_those_of_the_runs(self):
        told = subprocess.run([TREE / "validation/cases/settings/table", "--print"], capture_output=True, text=True, check=True).stdout
        page = (TREE / "docs/claims/settings.md").read_text(encoding="utf-8")
        for block in told.strip().split("\n\n"):
            self.assertGreater(block.count("\n"), 3)
            self.assertIn(block + "\n<!-- end of", page)


if __name__ == "__main__":
    unittest.main()
