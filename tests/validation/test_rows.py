"""docs/claims/rows.tsv: no row of a source is silent, and none says what the report does not."""
import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import load  # noqa: E402

TREE = pathlib.Path(__file__).resolve().parents[2]
TOOL = TREE / "docs/claims/rows"
rows = load(TOOL)


def called(*words):
    """(exit status, what it prints) of the tool."""
    with contextlib.redirect_stdout(io.StringIO()) as out:
        return rows.main(list(words)), out.getvalue()


VERDICTS = {"a.good": "pass", "a.near": "within allowance", "a.off": "not reproduced", "a.open": "undecided", "b.x.1": "pass", "b.x.2": "pass"}
MADE = """# comment
# first: S1
P1	Fig. 1	One thing holds	works	a.good a.near tests/a/test_a.c	-	-
P2	Fig. 2	Another does not	not reproduced	a.off	it is half as large	-
P3	Fig. 3	A third may	undecided	a.open	a longer run	-
P4	Sec. 1	The failure of another is what this row says	works	not:a.off	-	-
S1	7	A picture	absent	-	nobody drew it	0.5
S2	8	A part of it	coarse	notes/page.md#a-part	one of two	-
B1	b	More	works	b.x.*	-	-
"""


class Made(unittest.TestCase):
    """Each rule is broken once in a small tree made for it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.put("docs/claims/rows.tsv", MADE)
        self.put("notes/page.md", "# Page\n\n## A *part*\n")
        self.put("tests/a/test_a.c", "")
        self.put("reference-data/campaign/report.json", json.dumps({"claims": [
            {"id": name, "claim": name[0], "verdict": word, "measured": 0.5, "error": 0.25, "expected": 1.0} for name, word in VERDICTS.items()]}))

    def put(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def call(self, *options):
        return called(*options, str(self.root))

    def complain(self, old, new, words):
        self.assertIn(old, MADE)
        self.put("docs/claims/rows.tsv", MADE.replace(old, new, 1))
        for options in ((), ("--check",)):
            status, output = self.call(*options)
            self.assertEqual((status, words in output), (1, True), output)
        self.assertFalse((self.root / "docs/claims/rows.md").exists())

    def test_accepts_the_table(self):
        self.assertEqual(self.call("--check"), (1, "docs/claims/rows.md:1: out of date; run docs/claims/rows\n"))
        self.assertEqual(self.call(), (0, ""))
        self.assertEqual(self.call("--check"), (0, ""))
        page = (self.root / "docs/claims/rows.md").read_text()
        self.assertIn("| The paper | 2 | 0 | 1 | 1 | 0 | 4 | 0.0 |\n| The slides | 0 | 1 | 0 | 0 | 1 | 2 | 0.5 |\n", page)
        self.assertIn("| S1 | A picture | nobody drew it | 0.5 |\n", page)
        self.assertIn("| P1 | Fig. 1 | One thing holds | works | [`a.good`](a.md) 0.50 ± 0.25 (1); [`a.near`](a.md) 0.50 ± 0.25 (1); "
                      "[`tests/a/test_a.c`](../../tests/a/test_a.c) | – | – |\n", page)
        self.assertIn("[page](../../notes/page.md#a-part)", page)
        self.assertIn("[`b.x.*`](b.md): 2 pass", page)

    def test_verdict_that_is_not_there(self):
        self.complain("a.good", "a.best", "P1: there is no verdict a.best")
        self.complain("b.x.*", "b.y.*", "B1: there is no verdict b.y.*")

    def test_state_that_disagrees(self):
        for old, new, words in (("not reproduced\ta.off", "works\ta.off", "'works', where a verdict is 'not reproduced'"),
                                ("undecided\ta.open", "works\ta.open", "'works', where a verdict is 'undecided'"),
                                ("undecided\ta.open", "undecided\ta.open a.off", "'undecided', where a verdict is 'not reproduced'"),
                                ("works\ta.good", "not reproduced\ta.good", "'not reproduced', where no verdict is"),
                                ("absent\t-", "absent\ta.good", "'absent', and has verdicts"),
                                ("works\ta.good", "fine\ta.good", "state 'fine' is not one of"),
                                ("not:a.off", "not:a.near", "a.near is named as one that fails, and is 'within allowance'"),
                                ("# first: S1", "# first: P1", "P1 is listed as absent and first, and is 'works'")):
            self.complain(old, new, words)

    def test_what_nothing_holds(self):
        self.complain("works\tnot:a.off", "works\tnotes/page.md", "'works', and neither a verdict nor a test holds it")
        self.complain("coarse\tnotes/page.md#a-part", "coarse\t-", "'coarse', and nothing shows it")

    def test_silent(self):
        self.complain("it is half as large", "-", "P2: 'not reproduced' without a reason")
        self.complain("nobody drew it", "-", "S1: 'absent' without a reason")
        self.complain("nobody drew it", "", "7 filled fields wanted")
        self.complain("drew it\t0.5", "drew it\t-", "core-hours are given for what is absent, and for nothing else")
        self.complain("large\t-", "large\t2", "core-hours are given for what is absent, and for nothing else")
        self.complain("P3\tFig. 3\tA third may\tundecided\ta.open\ta longer run\t-\n", "", "P4 stands where P3 should")
        self.complain("P2\t", "X2\t", "X2 is no number")

    def test_links(self):
        self.complain("tests/a/test_a.c", "tests/a/test_b.c", "there is no tests/a/test_b.c")
        self.complain("#a-part", "#a-place", "there is no place #a-place in notes/page.md")

    def test_verdict_that_no_row_names(self):
        self.complain("b.x.*", "b.x.1", "no row names the verdict b.x.2")


class Committed(unittest.TestCase):
    def test_the_page_says_what_the_report_says(self):
        self.assertEqual(called("--check"), (0, ""))

    def test_the_sources_are_there(self):
        """Rows that were there stay: an absent one changes its state, and does not go."""
        table, first, _ = rows.read_table(TREE / rows.TABLE)
        counts = {source: sum(row["number"][0] == source for row in table) for source in rows.SOURCES}
        for source, least in (("P", 78), ("S", 56), ("D", 54)):
            self.assertGreaterEqual(counts[source], least)
        self.assertEqual(len(first), 10)

    def test_a_changed_report_is_seen(self):
        """Any verdict that turns: the table or the page is red."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name in ("docs", "tests", "scenes", "src"):
                (root / name).symlink_to(TREE / name)
            (root / "README.md").symlink_to(TREE / "README.md")
            report = json.loads((TREE / "reference-data/campaign/report.json").read_text())
            report["claims"][2]["verdict"] = "not reproduced"
            (root / "reference-data/campaign").mkdir(parents=True)
            (root / "reference-data/campaign/report.json").write_text(json.dumps(report))
            status, output = called("--check", folder)
            self.assertEqual(status, 1)
            self.assertIn("'works', where a verdict is 'not reproduced'", output)


if __name__ == "__main__":
    unittest.main()
