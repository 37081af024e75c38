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
HEADER = "observable,value,error,blocks,time\n"
REFERENCE_HEADER = "observable,value,error,blocks,time,theory,resolve\n"
BOUND_HEADER = "observable,value,error,blocks,time,theory,resolve,bound\n"


def judge(*words):
    done = subprocess.run([UNCROSS, "oracle", "judge", *map(str, words)], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def rows(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def differing(said):
    return [line.split()[0] for line in said.splitlines() if line.endswith("DIFFERS")]


def verdict(said):
    """The line of the verdict, and the lines behind it, each the words on one observable."""
    lines = said[said.index("verdict: "):].splitlines()
    return lines[0], dict(line.strip().split(": ", 1) for line in lines[1:])


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
        self.assertGreaterEqual(len(tables), 15)
        for path in tables:
            seen_by = re.search(r"^# seen by: (\w+)$", path.read_text(), re.M).group(1)
            with self.subTest(path.name):
                code, said = judge(REFERENCE, path)
                if seen_by == "nothing":
                    self.assertEqual(code, 0, said)
                else:
                    self.assertEqual(code, 7, said)
                    self.assertIn(seen_by, differing(said))
                    self.assertIn(seen_by, verdict(said)[1])
                    self.assertEqual(judge(REFERENCE, path, "--only", seen_by)[0], 7)

    def test_what_breaks_conservation_is_told(self):
        """An axis too long by e = 0.1 % multiplies velocities relative to their cell by 1 + e across it, and by (1 + e)^2
        along it. So a collision multiplies the thermal energy by 1 + (8/3) e (1 - (1 - exp(-5))/5), the bracket being the
        share of motion that is relative to cells of 5 on average. A quarter of the energy is the wave's, which turns
        to heat."""
        gain = ((1.001**4 + 2.0 * 1.001**2) / 3.0 - 1.0) * (1.0 - (1.0 - math.exp(-5.0)) / 5.0)
        heat, wave, times, energies = 3.0, 1.0, [], []
        for collision in range(161):
            if collision % 8 == 0:
                times.append(0.02 * collision)
                energies.append((heat + wave) / 4.0)
            lost = wave * (1.0 - math.exp(-2.0 * 2.1458 * (2.0 * math.pi / 16.0) ** 2 * 0.02))
            heat, wave = heat * (1.0 + gain) + lost, wave - lost
        middle = sum(times) / len(times)
        slope = (sum((t - middle) * e for t, e in zip(times, energies)) / sum((t - middle) ** 2 for t in times))
        code, said = judge(REFERENCE, POWER / "axis-long.csv", "--only", "wave_energy_drift")
        self.assertEqual(code, 7, said)
        words = verdict(said)[1]["wave_energy_drift"]
        drift = float(re.match(r"energy drifts by ([\d.]+) % per t0 .mean .[\d.]+.; it is conserved: at most 0.01 % per t0",
                               words).group(1))
        self.assertLess(abs(drift / (100.0 * slope) - 1.0), 0.02)  # 11.37
        self.assertIn("length of the rotation axis", words)
        code, said = judge(REFERENCE, POWER / "left-out.csv", "--only", "wave_momentum_change")
        self.assertEqual(code, 7, said)
        words = verdict(said)[1]["wave_momentum_change"]
        self.assertRegex(words, "^total momentum changes in a block by .* sqrt.3 M kT. .*who is summed and who is turned")
        for name, only in (("axis-long", "viscosity,solvent_memory,solvent_diffusion"), ("gain", "bond_length")):
            self.assertNotEqual(judge(REFERENCE, POWER / f"{name}.csv", "--only", only)[0], 7)

    def test_a_drift_of_energy_that_is_not_ours(self):
        """Slopes are compared as slopes: the reference's own heat is no drift, and no heat at all is one."""
        ours = BOUND_HEADER + "energy_drift,6.4e-4,1e-5,40,40,,0.2,\n"
        for theirs, wanted in ((6.5e-4, 0), (6.4e-4 + 1.2e-4, 7), (0.0, 7), (-6.4e-4, 7)):
            code, said = self.judge_text(HEADER + f"energy_drift,{theirs},1e-5,40,40\n", ours)
            self.assertEqual(code, wanted, said)
        self.assertIn("energy drifts by -0.064 % per t0, not 0.064 % per t0", verdict(said)[1]["energy_drift"])

    def test_viscosity_of_two_per_cent_is_seen_by_itself(self):
        """At the errors of the default measurement 2 % is more than what is found with 90 % probability."""
        _, said = judge(REFERENCE, POWER / "same.csv")
        sees = next(line.split()[10] for line in said.splitlines() if line.startswith("viscosity"))
        self.assertLess(float(sees), 2.0)

    def test_numbers_that_are_printed(self):
        code, said = self.judge_text(HEADER + "a,1.02,0.004,40,1\n", REFERENCE_HEADER + "a,1,0.003,320,1,1.5,0.05\n")
        self.assertEqual(code, 7, said)
        # Welch: (9 + 16)^2/(81/319 + 256/39) = 91.7; scipy.stats.t.sf(4, 91) * 2 = 1.2878e-4;
        # limit = scipy.stats.t.isf(.5e-3, 91); the d with scipy.stats.nct.sf(limit, 91, d) = .9 is .023565/.005
        self.assertEqual(said.splitlines()[1].split(), ["a", "1.5", "1", "0.003", "1.02", "0.004", "+2.000", "0.500",
                                                       "+4.00", "0.00013", "2.36", "5.00", "DIFFERS"])

    def test_exit_codes(self):
        ours = REFERENCE_HEADER + "a,1,0.001,40,2,,0.02\nb,2,0.001,40,2,1.9,0.02\n"
        for theirs, wanted in (("a,1.001,0.001,40,2\nb,2.001,0.001,40,2\n", 0), ("a,1.001,0.001,40,2\n", 8),
                               ("a,1.001,0.01,40,2\nb,2.001,0.001,40,2\n", 8),
                               ("a,1.001,0.001,9,2\nb,2.001,0.001,40,2\n", 8), ("a,1.02,0.001,40,2\n", 7),
                               ("a,0,0,40,2\nb,2,0,40,2\n", 7), ("a,1.001,0,40,2\nb,2.001,0,40,2\n", 8),
                               ("a,1.02,0.001,40,2\nb,2.001,0.1,40,2\n", 7)):
            code, said = self.judge_text(HEADER + theirs, ours)
            self.assertEqual(code, wanted, said)

    def test_why_it_cannot_tell(self):
        """Each observable that is not judged has a line that says why."""
        ours = REFERENCE_HEADER + "a,1,0.001,40,2,,0.02\n"
        for theirs, why in (("a,1,0,40,2", "all blocks are equal; do all have the same seed?"),
                            ("a,1,0.001,9,2", "too few blocks: 40 of ours, 9 of theirs; 10 are the fewest"),
                            ("a,1,0.0003,40,2", r"blocks scatter otherwise: their standard deviation is 0.30 times ours"),
                            ("a,1,0.003,40,2", r"blocks scatter otherwise: their standard deviation is 3.00 times ours"),
                            ("a,1,0.01,40,2", r"error too large: it would see 4.9 %, and must see 2 %; \d+ such blocks"),
                            ("a,1,99,40,2", "error too large: .*; no number of such blocks would do")):
            code, said = self.judge_text(HEADER + theirs + "\n", ours)
            self.assertEqual(code, 8, said)
            self.assertRegex(verdict(said)[1]["a"], "^" + why)
        code, said = self.judge_text(HEADER + "b,1,0.001,40,2\n", ours + "b,1,0.001,40,2,,0.02\n")
        self.assertEqual((code, verdict(said)[1]), (8, {"a": "missing"}))

    def test_another_time_is_another_observable(self):
        ours = REFERENCE_HEADER + "a,1,0.001,40,3.36,,0.02\n"
        self.assertEqual(self.judge_text(HEADER + "a,1,0.001,40,3.3600001\n", ours)[0], 0)
        for time, where in (("1.68", "'1.68' is another time; blocks of this observable are 3.36 t0 long"),
                            ("3.3602", "is another time"), ("0", "is out of range"), ("-3.36", "is out of range"),
                            ("nan", "is not a number"), ("", "nothing is not a number")):
            code, said = self.judge_text(HEADER + f"a,1,0.001,40,{time}\n", ours)
            self.assertEqual(code, 2, said)
            self.assertIn(":2:14: ", said)
            self.assertIn(where, said)

    def test_what_is_conserved(self):
        ours = BOUND_HEADER + "a,1,0.001,40,2,,0.02,\nc,1e-14,1e-15,40,2,0,,0.001\n"
        same = HEADER + "a,1,0.001,40,2\n"
        for row, wanted in (("c,0,0,2,2", 0), ("c,9e-4,0,2,2", 0), ("c,-9e-4,0,2,2", 0), ("c,-1.1e-3,0,2,2", 7),
                            ("c,0,2e-4,40,2", 7), ("c,0,1e-4,40,2", 0), ("", 8), ("c,nan,0,2,2", 2), ("c,0,nan,2,2", 2),
                            ("c,0,0,1,2", 2), ("c,0,0,2,1", 2)):
            code, said = self.judge_text(same + row + "\n", ours)
            self.assertEqual(code, wanted, said)
        # one average: all of the rate is its own
        self.assertIn("the first p counts below 0.001.", self.judge_text(same + "c,0,0,2,2\n", ours)[1])
        self.assertEqual(self.judge_text(same + "c,0,0,2,2\n", ours, "--only", "c")[0], 0)

    def test_the_rate_can_be_chosen(self):
        ours, theirs = REFERENCE_HEADER + "a,1,0.003,80,1,,0.05\n", HEADER + "a,1.02,0.004,40,1\n"
        self.assertEqual(self.judge_text(theirs, ours, "--false-alarm", "1e-4")[0], 0)  # p = 1.3e-4
        self.assertEqual(self.judge_text(theirs, ours, "--false-alarm", "1.5e-4")[0], 7)
        for rate in ("0", "0.6", "1e-10", "x", "nan", ""):
            self.assertEqual(self.judge_text(theirs, ours, "--false-alarm", rate)[0], 2)

    def test_only(self):
        theirs = HEADER + "bond_length,0.5386,0.00029,40,40\n"
        self.assertEqual(self.judge_text(theirs)[0], 8)
        self.assertIn(self.judge_text(theirs, None, "--only", "bond_length")[0], (0, 7))
        for only in ("bond", "bond_length,", "bond_length,x", "", "x" * 100):
            code, said = self.judge_text(theirs, None, "--only", only)
            self.assertEqual(code, 2, said)
        longest = "x" * 47
        for more, wanted in (("", 0), ("x", 2)):
            code, said = self.judge_text(HEADER + f"{longest},1,0.001,40,1\n",
                                         REFERENCE_HEADER + f"{longest},1,0.001,40,1,,0.1\n", "--only", longest + more)
            self.assertEqual(code, wanted, said)

    def test_forms_that_are_allowed(self):
        ours = "# a comment\r\nresolve,observable,time,blocks,error,value\r\n\r\n0.02, a ,2,40,1e-3,+1\r\n"
        self.assertEqual(self.judge_text("blocks,theory,time,observable,error,value\n40,,2.0,a,.001,1.0", ours)[0], 0)

    def test_bad_tables(self):
        long = "x" * 600
        for text, where in (("", "holds no observables"), (HEADER, "holds no observables"),
                            ("observable,value,error\n", ":1:1: no column 'blocks'"),
                            ("observable,value,error,blocks\n", ":1:1: no column 'time'"),
                            ("observable,value,error,blocks,z\n", ":1:31: 'z' is no column"),
                            ("observable,value,error,blocks,,\n", ":1:31: nothing is no column"),
                            ("observable,value,value,blocks\n", ":1:18: 'value' is there twice"),
                            (HEADER + "temperature,1,0.1,40\n", ":2:1: fewer"),
                            (HEADER + "temperature,1,0.1,40,400,5\n", ":2:1: more"),
                            (HEADER + "temperature,1,0.1,40,400,6,7,8,9,10\n", ":2:1: more"),
                            (HEADER + "# x\ntemperature,one,0.1,40,400\n", ":3:13: 'one' is not a number"),
                            (HEADER + "temperature,nan,0.1,40,400\n", ":2:13: 'nan' is not a number"),
                            (HEADER + "temperature,1e999,0.1,40,400\n", ":2:13: "),
                            (HEADER + "temperature,1,,40,400\n", ":2:15: nothing is not a number"),
                            (HEADER + "temperature,1, -1,40,400\n", ":2:16: '-1' is out of range; allowed is one standard"),
                            (HEADER + "temperature,1,0.1,1,400\n", ":2:19: '1' is out of range; allowed is a whole number"),
                            (HEADER + "temperature,1,0.1,40.5,400\n", ":2:19: "),
                            (HEADER + "temprature,1,0.1,40,400\n", ":2:1: 'temprature' is no observable of the reference"),
                            (HEADER + ",1,0.1,40,400\n", ":2:1: nothing is no name"),
                            (HEADER + f"{'x' * 48},1,0.1,40,400\n", ":2:1: "),
                            (HEADER + 2 * "temperature,1,0.1,40,400\n", ":3:1: 'temperature' is there twice"),
                            (HEADER + long, ":2:1: no line of text"), (HEADER + "a\0b\nc\n", ":2:1: no line of text")):
            code, said = self.judge_text(text)
            self.assertEqual(code, 2, said)
            self.assertIn(where, said)
            self.assertNotIn("verdict", said)

    def test_bad_reference(self):
        many = "".join(f"a{k},1,0.1,40,1,,1\n" for k in range(65))
        for text, where in ((HEADER + "a,1,0.1,40,1\n", ":1:1: no column 'resolve'"),
                            (REFERENCE_HEADER + "a,0,0.1,40,1,,1\n", ":2:3: '0' is out of range; values and errors of"),
                            (REFERENCE_HEADER + "a,1,0,40,1,,1\n", ":2:5: '0' is out of range; values and errors of"),
                            (REFERENCE_HEADER + "a,1,0.1,40,1,x,1\n", ":2:14: 'x' is not a number"),
                            (REFERENCE_HEADER + "a,1,0.1,40,1,,0\n", ":2:15: '0' is out of range"),
                            (REFERENCE_HEADER + "a,1,0.1,40,1,,\n", ":2:15: nothing is not enough"),
                            (BOUND_HEADER + "a,1,0.1,40,1,,,\n", ":2:15: nothing is not enough"),
                            (BOUND_HEADER + "a,1,0.1,40,1,,1,1\n", ":2:15: '1' is not enough or too much"),
                            (BOUND_HEADER + "a,1,0.1,40,1,,,0\n", ":2:16: '0' is out of range"),
                            (BOUND_HEADER + "a,1,0.1,40,1,,,1\n", ":2:3: '1' is out of range; the reference must keep"),
                            (REFERENCE_HEADER + many, ":66:1: too many rows")):
            code, said = self.judge_text(HEADER + "a,1,0.1,40,1\n", text)
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
        self.assertEqual((code, "cannot be opened" in said), (2, True), said)
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

    def test_reference_conserves(self):
        """Rounding of doubles, 2^29 times finer than single precision, leaves less than a millionth of every bound."""
        bounds = [row for row in rows(REFERENCE) if row["bound"]]
        self.assertEqual(len(bounds), 5)
        for row in bounds:
            rms = math.hypot(float(row["value"]), math.sqrt(float(row["blocks"]) - 1.0) * float(row["error"]))
            self.assertLess(rms, 1e-6 * float(row["bound"]), row)


if __name__ == "__main__":
    unittest.main()
