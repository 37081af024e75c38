"""docs/claims: the numbers and words of the pages are those of the committed report (docs/claims/tables)."""
import importlib.machinery
import importlib.util
import json
import pathlib
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
TOOL = TREE / "docs/claims/tables"
REPORT = TREE / "reference-data/campaign/report.json"
loader = importlib.machinery.SourceFileLoader("tables", str(TOOL))
tables = importlib.util.module_from_spec(importlib.util.spec_from_loader("tables", loader))
loader.exec_module(tables)


def row(name, measured, error, verdict="pass"):
    return {"id": name, "claim": name.split(".")[0], "statement": "a  number\nof it", "measured": measured, "error": error,
            "expected": 1.0, "expected_error": 0.0, "tolerance": 0.1, "z": 0.5, "verdict": verdict}


class Made(unittest.TestCase):
    CLAIMS = {one["id"]: one for one in (row("a.one", 0.15527, 0.00154, "not reproduced"), row("a.two", -0.4931, 0.0034),
                                         row("b.late", 48942.0, 5943.0, "undecided"), row("b.hi.2.56", 0.9589, 0.0022),
                                         row("b.round", 1.0, 0.0996), row("b.none", None, 0.0, "undecided"))}

    def renewed(self, text):
        return tables.renewed(text, self.CLAIMS)

    def test_numbers(self):
        for before, after in (("is 0.2(1) (`a.one`", "is 0.155(2) (`a.one`"),
                              ("is 0.2(11) (`a.one`", "is 0.1553(15) (`a.one`"),
                              ("is 0.4(1) (`a.two`", "is −0.493(3) (`a.two`"),
                              ("is 1.0(1)·10⁴ t0 (`b.late`", "is 4.9(6)·10⁴ t0 (`b.late`"),
                              ("0.9(1) (`b.hi.2.56`)", "0.959(2) (`b.hi.2.56`)"),
                              ("0.9(1) (`b.round`)", "1.0(1) (`b.round`)"),
                              ("0.9(1) (`b.none`)", "0.9(1) (`b.none`)"),
                              ("0.9(1) of it (`a.one`)", "0.9(1) of it (`a.one`)"),
                              ("0.9(1) (`no.such`)", "0.9(1) (`no.such`)")):
            self.assertEqual(self.renewed(before), after)
            self.assertEqual(self.renewed(after), after)

    def test_verdicts(self):
        self.assertEqual(self.renewed("3.0(1) (`a.one`: pass), (`a.two`: fail), (`no.such`: pass)"),
                         "0.155(2) (`a.one`: not reproduced), (`a.two`: pass), (`no.such`: pass)")

    def test_words(self):
        fits = "- **Same.** so (`a.two`).\n- **Different.** (`a.one`).\n- **Not settled.** (`b.late`).\n- **Why.** (`a.one`)."
        self.assertEqual(tables.complaints(fits, self.CLAIMS), [])
        for text in ("- **Same.** (`a.one`)", "**Same.** (`b.late`)", "- **Different.** (`a.two`)", "- **Not settled.** (`a.one`)", "- **Same.** (`no.such`)"):
            self.assertEqual(len(tables.complaints(text, self.CLAIMS)), 1, text)


@unittest.skipUnless(REPORT.exists(), "no campaign yet")
class Pages(unittest.TestCase):
    def test_pages_say_what_the_report_says(self):
        done = subprocess.run([TOOL, "--check"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stdout), (0, ""), "docs/claims/tables writes the numbers; a word that no longer fits is yours to change")

    def test_names_are_those_of_verdicts(self):
        """What paper.md names is in the report."""
        claims = {one["id"] for one in json.loads(REPORT.read_text())["claims"]}
        cases = {one.split(".")[0] for one in claims}
        named = set(tables.re.findall(tables.NAME, (TREE / "docs/claims/paper.md").read_text()))
        self.assertEqual({one for one in named if one.split(".")[0] in cases} - claims, set())
        self.assertGreater(len(named), 40)


if __name__ == "__main__":
    unittest.main()
