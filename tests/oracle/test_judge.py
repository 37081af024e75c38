#!/usr/bin/python3
"""`uncross oracle judge`: tables of right and wrong codes that tools/judge-power measured; exit codes, bad input."""
import csv
import math
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
REFERENCE = TOP / "reference-data/observables.csv"
POWER = TOP / "reference-data/judge/power"
UNCROSS = os.environ.get("UNCROSS", str(TOP / "build/uncross"))
HEADER = "observable,value,error,blocks\n"
REFERENCE_HEADER = "observable,value,error,blocks,theory,resolve\n"


def judge(*words):
    done = subprocess.run([UNCROSS, "oracle", "judge", *map(str, words)], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def rows(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def differing(said):
    return [line.split()[0] for line in said.splitlines() if line.endswith("DIFFERS")]


class JudgeTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.dir = pathlib.Path(self.folder.name)

    def judge_text(self, theirs, ours=None, *options):
        (self.dir / "theirs.csv").write_text(theirs)
        if ours is not None:
            (self.dir / "ours.csv").write_text(ours)
        return judge(REFERENCE if ours is None else self.dir / "ours.csv", self.dir / "theirs.csv", *options)

    def test_codes_that_were_measured(self):
        """Each table names, by hand, the observable that must see its bug; one has no bug."""
        tables = sorted(POWER.glob("*.csv"))
        self.assertGreaterEqual(len(tables), 8)
        for path in tables:
            seen_by = re.search(r"^# seen by: (\w+)$", path.read_text(), re.M).group(1)
            with self.subTest(path.name):
                code, said = judge(REFERENCE, path)
                if seen_by == "nothing":
                    self.assertEqual(code, 0, said)
                else:
                    self.assertEqual(code, 7, said)
                    self.assertIn(seen_by, differing(said))
                    self.assertEqual(judge(REFERENCE, path, "--only", seen_by)[0], 7)

    def test_viscosity_of_two_per_cent_is_seen_by_itself(self):
        """At the errors of the default measurement 2 % is more than what is found with 90 % probability."""
        _, said = judge(REFERENCE, POWER / "same.csv")
        sees = next(line.split()[10] for line in said.splitlines() if line.startswith("viscosity"))
        self.assertLess(float(sees), 2.0)

    def test_numbers_that_are_printed(self):
        code, said = self.judge_text(HEADER + "a,1.02,0.004,40\n", REFERENCE_HEADER + "a,1,0.003,320,1.5,0.05\n")
        self.assertEqual(code, 7, said)
        # Welch: (9 + 16)^2/(81/319 + 256/39) = 91.7; scipy.stats.t.sf(4, 91) * 2 = 1.2878e-4;
        # limit = scipy.stats.t.isf(.5e-3, 91); the d with scipy.stats.nct.sf(limit, 91, d) = .9 is .023565/.005
        self.assertEqual(said.splitlines()[1].split(), ["a", "1.5", "1", "0.003", "1.02", "0.004", "+2.000", "0.500",
                                                       "+4.00", "0.00013", "2.36", "5.00", "DIFFERS"])

    def test_exit_codes(self):
        ours = REFERENCE_HEADER + "a,1,0.001,320,,0.02\nb,2,0.001,320,1.9,0.02\n"
        for theirs, wanted in (("a,1.001,0.001,40\nb,2.001,0.001,40\n", 0), ("a,1.001,0.001,40\n", 8),
                               ("a,1.001,0.01,40\nb,2.001,0.001,40\n", 8), ("a,1.001,0.001,9\nb,2.001,0.001,40\n", 8),
                               ("a,1.01,0.001,40\n", 7), ("a,0,0,40\nb,2,0,40\n", 7),
                               ("a,1.001,0,40\nb,2.001,0,40\n", 0), ("a,1.01,0.001,40\nb,2.001,0.1,40\n", 7)):
            code, said = self.judge_text(HEADER + theirs, ours)
            self.assertEqual(code, wanted, said)

    def test_the_rate_can_be_chosen(self):
        ours, theirs = REFERENCE_HEADER + "a,1,0.003,320,,0.05\n", HEADER + "a,1.02,0.004,40\n"
        self.assertEqual(self.judge_text(theirs, ours, "--false-alarm", "1e-4")[0], 0)  # p = 1.29e-4
        self.assertEqual(self.judge_text(theirs, ours, "--false-alarm", "1.3e-4")[0], 7)
        for rate in ("0", "0.6", "1e-10", "x", "nan", ""):
            self.assertEqual(self.judge_text(theirs, ours, "--false-alarm", rate)[0], 2)

    def test_only(self):
        theirs = HEADER + "bond_length,0.5386,0.0001,40\n"
        self.assertEqual(self.judge_text(theirs)[0], 8)
        self.assertIn(self.judge_text(theirs, None, "--only", "bond_length")[0], (0, 7))
        for only in ("bond", "bond_length,", "bond_length,x", "", "x" * 100):
            code, said = self.judge_text(theirs, None, "--only", only)
            self.assertEqual(code, 2, said)
        longest = "x" * 47
        for more, wanted in (("", 0), ("x", 2)):
            code, said = self.judge_text(HEADER + f"{longest},1,0.001,40\n",
                                         REFERENCE_HEADER + f"{longest},1,0.001,40,,0.1\n", "--only", longest + more)
            self.assertEqual(code, wanted, said)

    def test_forms_that_are_allowed(self):
        ours = "# a comment\r\nresolve,observable,blocks,error,value\r\n\r\n0.02, a ,320,1e-3,+1\r\n"
        self.assertEqual(self.judge_text("blocks,theory,observable,error,value\n40,,a,.001,1.0", ours)[0], 0)

    def test_bad_tables(self):
        long = "x" * 600
        for text, where in (("", "holds no observables"), (HEADER, "holds no observables"),
                            ("observable,value,error\n", ":1:1: no column 'blocks'"),
                            ("observable,value,error,blocks,z\n", ":1:31: 'z' is no column"),
                            ("observable,value,error,blocks,,\n", ":1:31: nothing is no column"),
                            ("observable,value,value,blocks\n", ":1:18: 'value' is there twice"),
                            (HEADER + "temperature,1,0.1\n", ":2:1: fewer"),
                            (HEADER + "temperature,1,0.1,40,5\n", ":2:1: more"),
                            (HEADER + "temperature,1,0.1,40,5,6,7,8\n", ":2:1: more"),
                            (HEADER + "# x\ntemperature,one,0.1,40\n", ":3:13: 'one' is not a number"),
                            (HEADER + "temperature,nan,0.1,40\n", ":2:13: 'nan' is not a number"),
                            (HEADER + "temperature,1e999,0.1,40\n", ":2:13: "),
                            (HEADER + "temperature,1,,40\n", ":2:15: nothing is not a number"),
                            (HEADER + "temperature,1, -1,40\n", ":2:16: '-1' is out of range; allowed is one standard"),
                            (HEADER + "temperature,1,0.1,1\n", ":2:19: '1' is out of range; allowed is a whole number"),
                            (HEADER + "temperature,1,0.1,40.5\n", ":2:19: "),
                            (HEADER + "temprature,1,0.1,40\n", ":2:1: 'temprature' is no observable of the reference"),
                            (HEADER + ",1,0.1,40\n", ":2:1: nothing is no name"),
                            (HEADER + f"{'x' * 48},1,0.1,40\n", ":2:1: "),
                            (HEADER + 2 * "temperature,1,0.1,40\n", ":3:1: 'temperature' is there twice"),
                            (HEADER + long, ":2:1: no line of text"), (HEADER + "a\0b\nc\n", ":2:1: no line of text")):
            code, said = self.judge_text(text)
            self.assertEqual(code, 2, said)
            self.assertIn(where, said)
            self.assertNotIn("verdict", said)

    def test_bad_reference(self):
        many = "".join(f"a{k},1,0.1,40,,1\n" for k in range(65))
        for text, where in ((HEADER + "a,1,0.1,40\n", ":1:1: no column 'resolve'"),
                            (REFERENCE_HEADER + "a,0,0.1,40,,1\n", ":2:3: '0' is out of range; values and errors of"),
                            (REFERENCE_HEADER + "a,1,0,40,,1\n", ":2:5: '0' is out of range; values and errors of"),
                            (REFERENCE_HEADER + "a,1,0.1,40,x,1\n", ":2:12: 'x' is not a number"),
                            (REFERENCE_HEADER + "a,1,0.1,40,,0\n", ":2:13: '0' is out of range"),
                            (REFERENCE_HEADER + many, ":66:1: too many rows")):
            code, said = self.judge_text(HEADER + "a,1,0.1,40\n", text)
            self.assertEqual(code, 2, said)
            self.assertIn(where, said)

    def test_a_verdict_that_cannot_be_printed(self):
        for words in (("judge", REFERENCE, POWER / "same.csv"), ("compare", *[TOP / "reference-data/dense.pack.h5"] * 2)):
            with open("/dev/full", "w", encoding="utf-8") as full:
                done = subprocess.run([UNCROSS, "oracle", *map(str, words)], stdout=full, stderr=subprocess.DEVNULL,
                                      check=False)
            self.assertEqual(done.returncode, 4)

    def test_bad_words(self):
        self.assertEqual(judge(REFERENCE)[0], 2)
        code, said = judge(REFERENCE, self.dir / "missing.csv")
        self.assertEqual((code, "cannot open" in said), (2, True), said)
        self.assertEqual(judge(REFERENCE, self.dir)[0], 2)

    def test_reference_agrees_with_theory_where_it_should(self):
        """Temperatures and the memory of one collision are exact, statics but for the heat of crossings."""
        for row in rows(REFERENCE):
            value, error = float(row["value"]), float(row["error"])
            if row["observable"] in ("temperature", "vertex_temperature", "solvent_memory"):
                self.assertLess(abs(value - float(row["theory"])), 4.0 * error, row)
            elif row["observable"] in ("bond_length", "bend_cosine", "end_to_end_square"):
                self.assertLess(abs(value / float(row["theory"]) - 1.0), 0.01, row)
            self.assertTrue(math.isfinite(error) and error > 0.0)


if __name__ == "__main__":
    unittest.main()
