#!/usr/bin/python3
"""docs/exercises/read: means, rows and slopes of tables whose answers are known."""
import math
import pathlib
import subprocess
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]


class Read(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.table = pathlib.Path(self.folder.name, "t.csv")
        # g_cm = 6 D t + 1 with D = 0.25; s is 3 with 1 added and taken away in turn, after ten rows of nonsense.
        self.table.write_text("time,g_cm,g_cm_error,s\n" + "".join(
            f"{t},{1 + 1.5 * t},{0.3 if t == 12 else 0.4},{99 if t < 10 else 3 + (-1) ** t}\n" for t in range(42)))

    def run_it(self, *words):
        return subprocess.run([TOP / "docs/exercises/read", self.table, *words], capture_output=True, text=True)

    def numbers(self, *words):
        done = self.run_it(*words)
        self.assertEqual(done.stderr, "")
        return [(line.split()[0], float(line.split()[1]), float(line.split()[3])) for line in done.stdout.splitlines()]

    def test_d_of_two_lags(self):
        self.assertEqual(self.numbers("g_cm", "--D", "12", "40"), [("g_cm", 0.25, 0.003)])  # 0.5/(6 * 28) = 0.00298
        self.assertEqual(self.numbers("g_cm", "--D", "12", "40", "--in", "2")[0][1], 0.375)
        self.assertEqual(self.numbers("g_cm", "--slope", "12", "40"), [("g_cm", 1.5, 0.018)])

    def test_a_row_by_its_time(self):
        self.assertEqual(self.numbers("g_cm", "--at", "12"), [("g_cm", 19.0, 0.3)])

    def test_mean_from_a_time_on(self):
        # 32 values of 2 and 4: the largest error is that of single values, sqrt(32/31)/sqrt(32); blocks of two are all alike.
        (name, value, error), = self.numbers("s", "--from", "10")
        self.assertEqual((name, value), ("s", 3.0))
        self.assertAlmostEqual(error, 1 / math.sqrt(31), delta=0.005)

    def test_a_table_of_one_row(self):
        self.table.write_text("RxRx,RxRx_error,samples\n167.5,2.5,40\n")
        self.assertEqual(self.numbers("RxRx"), [("RxRx", 167.5, 2.5)])

    def test_change_and_scatter(self):
        # s from 10 on is 4 at even times and 2 at odd ones, 41 the last: 2 - 4, and a scatter of 1.
        for words, said in ((("s", "--change", "--from", "10"), "s  -2"), (("s", "--scatter", "--from", "10"), "s  1"), (("g_cm", "--change"), "g_cm  61.5")):
            self.assertEqual(self.run_it(*words).stdout, said + "  (no error: take several seeds)\n")

    def test_a_folder(self):
        done = subprocess.run([TOP / "docs/exercises/read", self.folder.name, "s"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (2, f"read: {self.folder.name}: not a file but a folder, a pipe or a device; its tables are t.csv\n"))

    def test_what_is_not_there(self):
        for words, told in ((("x",), "there is no column x; there are time, g_cm, g_cm_error, s"), (("s", "--at", "7.5"), "there is no time 7.5; the nearest is"),
                            (("g_cm", "--D", "12", "12"), "the two times are both 12"), (("s", "--from", "50"), "there is no row from 50 on; the last is 41")):
            done = self.run_it(*words)
            self.assertEqual(done.returncode, 2)
            self.assertIn(told, done.stderr)


if __name__ == "__main__":
    unittest.main()
