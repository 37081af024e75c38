"""The report: its verdicts, its determinism; and the committed one follows from the committed results of runs."""
import contextlib
import dataclasses
import importlib.machinery
import io
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock
import xml.etree.ElementTree as xml

import numpy
from matplotlib import pyplot

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TREE / "validation"))

from lib import case as cases
from lib import figures, report, runs, stats

CAMPAIGN = TREE / "reference-data/campaign"
CASE = '''
from lib import figures
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE, PAPER = "Made up & so on", "Fig. 0"


def runs(tier):
    return [Run("there", program=["made-up"]), Run("absent", program=["made-up"])]


def draw():
    figure, axes = figures.plain()
    figures.points(axes, [1, 2], [3, 4], [1, 1])
    return figure


def evaluate(results, tier):
    x = results["there"].columns["x"][0]
    return Outcome([Verdict("a.b", "x < 2 & more", 1.0, "nowhere", 0.5, measured=x, error=0.25)],
                   [Figure("f", "caption", draw)], "Some `code`.")
'''


def differences(a, b, where=""):
    """Where two reports differ by more than what another processor's arithmetic may change."""
    if isinstance(a, dict) and isinstance(b, dict):
        return [d for key in sorted({*a, *b}) for d in differences(a.get(key), b.get(key), f"{where}.{key}")]
    if isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        return [d for k, (x, y) in enumerate(zip(a, b)) for d in differences(x, y, f"{where}[{k}]")]
    if isinstance(a, float) and isinstance(b, float):
        return [] if math.isclose(a, b, rel_tol=1e-6, abs_tol=1e-12) else [f"{where}: {a} {b}"]
    return [] if a == b else [f"{where}: {a!r} {b!r}"]


class Verdicts(unittest.TestCase):
    def verdict(self, measured, kind="gate"):
        return cases.Verdict("a.b", "", 1.0, "", 0.5, measured=measured, error=0.3, expected_error=0.4, kind=kind)

    def test_words(self):
        self.assertEqual(self.verdict(1.5).verdict, "pass")
        self.assertEqual(self.verdict(0.4).verdict, "fail")
        self.assertEqual(self.verdict(0.4, "paper").verdict, "not reproduced")
        self.assertEqual(self.verdict(None).verdict, "undecided")
        self.assertEqual(self.verdict(math.nan).verdict, "undecided")
        self.assertAlmostEqual(self.verdict(1.5).seen, 1.0, 14)

    def test_what_cannot_tell_from_nothing_does_not_pass(self):
        for expected, tolerance, word in ((1.0, 0.51, "undecided"), (1.0, 0.5, "pass"), (-1.0, 0.51, "undecided"), (0.0, 0.1, "pass")):
            self.assertEqual(cases.Verdict("a.b", "", expected, "", tolerance, measured=expected).verdict, word)
        self.assertEqual(cases.Verdict("a.b", "", 1.0, "", 1.2, measured=1.0, detects=0.1).verdict, "undecided")
        self.assertEqual(cases.Verdict("a.b", "", 1.0, "", 1.2, measured=3.0).verdict, "fail")

    def test_what_cannot_tell_from_a_rival_does_not_pass(self):
        for measured, word in ((1.0, "pass"), (1.04, "undecided"), (1.2, "not reproduced")):
            verdict = cases.Verdict("a.b", "", 1.0, "", 0.08, measured=measured, kind="paper", rival=1.1)
            self.assertEqual(verdict.verdict, word)

    def test_what_lacks_its_power_does_not_pass(self):
        for tolerance, measured, word in ((0.2, 1.1, "pass"), (0.3, 1.1, "undecided"), (0.3, 1.4, "fail")):
            self.assertEqual(cases.Verdict("a.b", "", 1.0, "", tolerance, measured=measured, must_see=0.5).verdict, word)

    def test_an_average_that_still_moved_decides_nothing(self):
        """Neither a pass nor a failure: the halves of its run disagree."""
        for measured in (1.0, 9.0):
            verdict = cases.Verdict("a", "", 1.0, "", 0.1, measured=stats.Moving(measured, "it still moves", 0.2), error=0.01)
            self.assertEqual(verdict.verdict, "undecided")
            self.assertEqual(report.verdict_row("case", verdict)["reason"], "it still moves")

    def test_a_second_run_decides_a_doubt_and_makes_no_number(self):
        """Three runs: one is taken again, one shall not count against it, one counts in both."""
        class Case:
            @staticmethod
            def evaluate(results, tier):
                self.assertEqual(tier, "campaign")
                self.assertFalse([name for name in results if name.endswith(cases.AGAIN)])
                found = sum(results.values()) / len(results)
                return cases.Outcome([cases.Verdict("a", "", 1.0, "", stats.tolerance(0.1), measured=found, error=0.1)])

        for runs, second, word in (
                ({"one": 1.0, "two": 1.0, "one-again": 9.0}, None, "pass"),  # no doubt
                ({"one": 1.3, "two": 1.4}, None, "undecided"),
                ({"one": 1.3, "two": 1.4, "one-again": 1.0}, 1.2, "pass"),
                ({"one": 1.3, "two": 1.4, "one-again": 1.3}, None, "undecided"),  # the same number to the last bit is no second run
                ({"one": 1.3, "two": 1.4, "one-again": 1.5}, 1.45, "fail"),
                ({"one": 1.2, "two": 1.4, "old": 1.45, "one-again": 1.2, "two-again": 1.0}, 1.1, "pass")):
            Case.FIRST_ONLY = staticmethod(lambda name: name == "old")
            verdict = cases.evaluate(Case, runs, "campaign").verdicts[0]
            self.assertEqual((verdict.verdict, verdict.second and round(verdict.second[0], 9)), (word, second), runs)
            first = [value for name, value in runs.items() if not name.endswith(cases.AGAIN)]
            self.assertAlmostEqual(verdict.measured, sum(first) / len(first), 12)
            self.assertEqual("second" in report.verdict_row("case", verdict), second is not None)

    def test_z(self):
        self.assertAlmostEqual(self.verdict(2.0).z, 2.0, 14)
        self.assertIsNone(self.verdict(None).z)

    def test_a_pass_that_only_an_allowance_explains(self):
        for measured, covered in ((1.0, False), (1.1, True)):
            verdict = cases.Verdict("a.b", "", 1.0, "", stats.tolerance(0.01, systematic=0.2), measured=measured, error=0.01)
            self.assertEqual((verdict.verdict, verdict.allowed, verdict.covered), ("within allowance" if covered else "pass", 0.2, covered))
        few = cases.Verdict("a.b", "", 1.0, "", stats.tolerance(0.01, values=5), measured=1.05, error=0.01)
        self.assertEqual((few.verdict, few.covered), ("pass", False))  # so few values explain it

    def test_what_chance_hardly_explains_wants_a_second_run(self):
        for measured, systematic, second, word in (
                (1.029, 0.0, None, "pass"), (1.035, 0.0, None, "undecided"), (1.045, 0.0, None, "fail"), (1.045, 0.0, (1.0, 0.01), "fail"),
                (1.035, 0.0, (1.01, 0.01), "pass"), (1.035, 0.0, (1.035, 0.01), "fail"), (1.045, 0.02, None, "within allowance"),
                (1.055, 0.02, None, "undecided"), (1.055, 0.02, (1.045, 0.01), "pass"), (1.055, 0.02, (1.055, 0.01), "fail")):
            verdict = cases.Verdict("a.b", "", 1.0, "", stats.tolerance(0.01, systematic=systematic), measured=measured, error=0.01, second=second)
            self.assertEqual(verdict.verdict, word, (measured, systematic, second))
            row = report.verdict_row("a", verdict)
            self.assertEqual([bad for bad in report.failures([row], "quick") if word != "fail"], [])

    def test_power(self):
        """By drawing: a value that is off by the power turns the verdict red 95 times in 100."""
        draw, error = random.Random(5), 0.01
        power = cases.Verdict("a.b", "", 1.0, "", stats.tolerance(error, systematic=0.02), measured=1.0, error=error).power
        red = sum(abs(draw.gauss(power, error)) > stats.tolerance(error, systematic=0.02) for _ in range(10000))
        self.assertAlmostEqual(red / 10000, 0.95, delta=0.01)

    def test_digits(self):
        self.assertEqual(report.plusminus(2.13917, 0.01172), "2.139 ± 0.012")
        self.assertEqual(report.plusminus(1234.5, 60.0), "1234 ± 60")
        self.assertEqual(report.plusminus(1.5e-6, 2.5e-7), "(1.50 ± 0.25)·10⁻⁶")
        self.assertEqual(report.plusminus(1.0, 1e-16), "1.00000 ± 0.00000")
        self.assertEqual(report.number(-0.000123), "−1.23·10⁻⁴")


class MadeUp(unittest.TestCase):
    """A case of one verdict, from one run of two."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "cases/made").mkdir(parents=True)
        (self.folder / "cases/made/case.py").write_text(CASE)
        self.addCleanup(setattr, cases, "CASES", cases.CASES)
        cases.CASES = self.folder / "cases"

    def report(self, x, tier="quick"):
        """(exit code, report.json) where the run said x."""
        there = self.folder / "work/made/there"
        there.mkdir(parents=True, exist_ok=True)
        (there / "output.txt").write_text(f"n,x\n1,{x}\n")
        (there / "session.json").write_text('{"cpu_seconds": 3.0}')
        every = cases.load("made").runs(tier)
        for run in every:
            run.case = "made"
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            code = report.make(tier, every, ["made"], self.folder / "work", self.folder / "out")
        return code, json.loads((self.folder / "out/report.json").read_text())

    def test_a_case_takes_the_place_of_what_it_was(self):
        """The order is that of all cases; a case without runs has no place yet."""
        def of(*cases, x):
            return {"tier": "campaign", "claims": [{"claim": name, "measured": x} for name in cases], "sections": [{"id": name, "x": x} for name in cases],
                    "runs": [{"run": f"{name}/{n}", "x": x} for name in cases for n in (2, 1)]}

        order = ["a", "b", "c", "d"]
        self.assertEqual(report.renewed(of("a", "b", "d", x=1), of("b", x=1), order), of("a", "b", "d", x=1))
        self.assertEqual(report.renewed(of("a", "d", x=1), of("c", x=1), order), of("a", "c", "d", x=1))
        self.assertEqual(report.renewed(of("a", "gone", x=1), of("b", x=1), order), of("a", "b", x=1))
        found = report.renewed(of("a", "b", x=1), of("b", x=2), order)
        self.assertEqual([row["measured"] for row in found["claims"]], [1, 2])
        self.assertEqual([row["run"] for row in found["runs"]], ["a/2", "a/1", "b/2", "b/1"])

    def test_pass(self):
        code, said = self.report(1.25)
        self.assertEqual(code, 0)
        self.assertEqual([row["verdict"] for row in said["claims"]], ["pass"])
        self.assertEqual(said["claims"][0]["z"], 1.0)
        self.assertEqual(said["sections"][0]["absent"], ["made/absent"])
        self.assertEqual(said["sections"][0]["cpu_seconds"], 3.0)

    def test_fail(self):
        code, said = self.report(1.75)
        self.assertEqual((code, said["claims"][0]["verdict"]), (1, "fail"))
        suite = xml.parse(self.folder / "out/report.xml").getroot().find("testsuite")
        self.assertEqual(suite.get("failures"), "1")
        self.assertIn("1.75", suite.find("testcase/failure").text)

    def test_undecided_fails_only_where_all_is_run(self):
        for tier, code, failures, skipped in (("quick", 1, "1", "0"), ("campaign", 0, "0", "1")):
            self.assertEqual(self.report("nan", tier)[0], code)
            suite = xml.parse(self.folder / "out/report.xml").getroot().find("testsuite")
            self.assertEqual((suite.get("failures"), suite.get("skipped")), (failures, skipped))
            self.assertEqual(len(suite.findall("testcase/skipped")), int(skipped))

    def test_a_time_may_be_undecided_but_not_absent(self):
        timed = CASE.replace("measured=x, error=0.25", "measured=x, error=0.25, must_see=0.1, timed=True")
        (self.folder / "cases/made/case.py").write_text(timed)
        for x, code, failures, skipped in ((1.0, 0, "0", "1"), ("nan", 1, "1", "0")):
            self.assertEqual((self.report(x)[0], self.report(x)[1]["claims"][0]["verdict"]), (code, "undecided"))
            suite = xml.parse(self.folder / "out/report.xml").getroot().find("testsuite")
            self.assertEqual((suite.get("failures"), suite.get("skipped")), (failures, skipped))

    def test_a_case_that_cannot_say_fails(self):
        (self.folder / "cases/made/case.py").write_text(CASE.replace('["there"]', '["absent"]'))
        code, said = self.report(1.0)
        self.assertEqual((code, said["claims"][0]["id"], said["claims"][0]["verdict"]), (1, "made.evaluate", "fail"))

    def test_same_bytes(self):
        self.report(1.25)
        first = [(self.folder / "out" / name).read_bytes() for name in ("report.html", "report.json", "report.xml")]
        self.report(1.25)
        self.assertEqual(first, [(self.folder / "out" / name).read_bytes() for name in ("report.html", "report.json", "report.xml")])

    def test_self_contained(self):
        self.report(1.25)
        page = (self.folder / "out/report.html").read_text()
        self.assertIn("<svg", page)
        self.assertIn("Made up &amp; so on", page)
        self.assertIn("<code>code</code>", page)
        self.assertNotRegex(page, r'(src|href)="(http|/)')


def campaign_runs():
    """All runs of the campaign, in the order of validation/run."""
    loader = importlib.machinery.SourceFileLoader("validation_run", str(TREE / "validation/run"))
    module = types.ModuleType(loader.name)
    module.__file__ = loader.path
    loader.exec_module(module)
    return module.all_runs("campaign")


def grey(color):
    red, green, blue = figures.rgb(color)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def curves(axes):
    """Lines with a name, of points too."""
    named = [line for line in axes.get_lines() if not line.get_label().startswith("_")]
    return named + [bars for bars in axes.containers if bars.get_label() and not bars.get_label().startswith("_")]


def defects(figure):
    """What no picture may have: points outside of the axes; a name that no legend has; two numbers of an axis that read the same."""
    figure.canvas.draw()
    found, shown = [f"outside: {point}" for point in figures.outside(figure)], {text.get_text() for axes in figure.axes if axes.get_legend() for text in axes.get_legend().get_texts()}
    for axes in figure.axes:
        found += [f"not in a legend: {one.get_label()}" for one in curves(axes) if one.get_label() not in shown]
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            words = [tick.label1.get_text() for tick in axis.get_major_ticks()
                     if low <= tick.get_loc() <= high and tick.label1.get_visible() and tick.label1.get_text()]
            found += [f"twice on an axis: {words}"] if len(set(words)) < len(words) else []
    return found


class Pictures(unittest.TestCase):
    def test_defects_are_seen(self):
        with figures.styled():
            figure, axes = figures.plain()
            figures.points(axes, [1, 2], [3, 4], [1, 1], label="g")
            self.assertEqual(defects(figure), ["not in a legend: g"])
            figures.legend(axes)
            self.assertEqual(defects(figure), [])
            axes.set_yticks([3.0, 3.4, 4.0], ["3", "3", "4"])
            self.assertEqual(len(defects(figure)), 1)
            figures.svg(figure)

    def test_no_point_is_cut_off(self):
        with figures.styled():
            figure, axes = figures.plain()
            figures.points(axes, [1, 2, numpy.nan], [3, 4, 9], [1, 1, 1], label="g")
            self.assertEqual(figures.outside(figure), [])
            axes.set_ylim(2.5, 3.5)
            self.assertEqual(figures.outside(figure), [("g", 2.0, 4.0)])
            self.assertRaisesRegex(ValueError, "outside of the axes: .*'g', 2.0, 4.0", figures.svg, figure)

    def test_series_differ_in_grey_or_by_marker(self):
        looks = list(zip(figures.COLORS, figures.MARKERS))
        for k, (color, marker) in enumerate(looks):
            for other, its in looks[:k]:
                self.assertTrue(marker != its or abs(grey(color) - grey(other)) > 0.15, (color, other))

    def test_one_legend_of_two_panels(self):
        with figures.styled():
            figure, (left, right) = figures.plain(columns=2)
            for number, axes in enumerate((left, right)):
                figures.points(axes, [1, 2], [3, 4], label="both")
                figures.points(axes, [1, 2], [3, 4], number=1, label=f"of {number}")
            figures.legend_above(left, right)
            self.assertEqual([text.get_text() for text in left.get_legend().get_texts()], ["both", "of 0", "of 1"])
            self.assertEqual(defects(figure), [])
            figures.svg(figure)


TURNS = 5


def drawn_cases():
    """Cases whose figures are looked at: all if what draws them, or is drawn, has changed in the last three commits, or where that cannot
    be told; else one in TURNS, in turn. (All are drawn by `validation/run report --tier campaign`, which refuses points outside of the axes.)"""
    git = ["git", "-C", str(TREE)]
    changed = subprocess.run([*git, "diff", "--name-only", "HEAD~3", "--", "validation", "python/uncross_plot", "reference-data/campaign",
                              "tests/validation"], capture_output=True, text=True, check=False)
    count = subprocess.run([*git, "rev-list", "--count", "HEAD"], capture_output=True, text=True, check=False)
    if changed.returncode or changed.stdout or count.returncode:
        return cases.names()
    return cases.names()[int(count.stdout) % TURNS::TURNS]


def load_without_figures(name, load=cases.load):
    """A case that draws nothing."""
    module = load(name)

    def evaluate(results, tier):
        return dataclasses.replace(module.evaluate(results, tier), figures=[])
    return types.SimpleNamespace(**{**vars(module), "evaluate": evaluate})


class Campaign(unittest.TestCase):
    """The report of the committed results, made once, as `validation/run report --tier campaign` makes it."""

    @classmethod
    def setUpClass(cls):
        cls.drawn, cls.again, cls.chosen = [], None, drawn_cases()

        def look(drawn):
            cls.drawn.append(defects(drawn))
            pyplot.close(drawn)
            return "<svg/>"  # the page is not looked at here

        def load(name, load=cases.load):
            return load(name) if name in cls.chosen else load_without_figures(name, load)

        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(figures, "svg", look), \
                unittest.mock.patch.object(cases, "load", load), contextlib.redirect_stdout(io.StringIO()):
            report.make("campaign", campaign_runs(), cases.names(), CAMPAIGN, folder)
            cls.again = json.loads((pathlib.Path(folder) / "report.json").read_text())

    def test_differences_are_seen(self):
        self.assertEqual(differences({"a": [1.0, 2.0]}, {"a": [1.0, 2.0 + 1e-9]}), [])
        self.assertEqual(len(differences({"a": [1.0, 2.0]}, {"a": [1.0, 2.001]})), 1)
        self.assertEqual(len(differences({"a": 1}, {"b": 1})), 2)

    def test_what_is_drawn_is_named(self):
        """Every figure of the cases whose turn it is."""
        self.assertGreater(len(self.drawn), len(self.chosen) / 2)
        self.assertEqual([bad for bad in self.drawn if bad], [])

    @unittest.skipUnless((CAMPAIGN / "report.json").exists(), "no campaign yet")
    def test_the_committed_report_follows_from_the_committed_results(self):
        """What was edited by hand, or not made anew after new results: `validation/run report --tier campaign`."""
        committed = json.loads((CAMPAIGN / "report.json").read_text())
        self.assertEqual(differences(committed, self.again), [])
        page = (TREE / "docs/claims/README.md").read_text()
        self.assertEqual(report.standing(committed), page, "make it anew: validation/run report --tier campaign")

    @unittest.skipUnless((CAMPAIGN / "report.json").exists(), "no campaign yet")
    def test_a_failure_is_on_the_page_of_verdicts(self):
        summed = json.loads((CAMPAIGN / "report.json").read_text())
        row = next(row for row in summed["claims"] if row["verdict"] == "pass")
        row["verdict"] = "fail"
        failed = report.standing(summed).partition("## Fail\n")[2].partition("## Within")[0]
        self.assertIn(f"`{row['id']}`", failed)


if __name__ == "__main__":
    unittest.main()
