#!/usr/bin/python3
"""`uncross sweep`: averages are those of NumPy's plain formulas, a sweep that was killed ends with the same bytes, bad grids
are refused before anything runs, and the script for Slurm holds every run once."""
import csv
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
import unittest

import numpy

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import UNCROSS, FolderTest  # noqa: E402

SCENE = """box: [5, 5, 5]
time_step: 0.02
steps: 1000
solvent: {per_cell: 3, collision_interval: 0.04}
fibers:
  - {name: rods, count: 6, vertices: 4, mass: 3, bond_length: 0.5, spring: 50, bending: 2}
observe:
  from: 100
  temperature: {every: 30}
  collisions: {every: 30}
  statics: {every: 10}
  dynamics: {every: 10, longest_lag: 200}
"""
GRID = ("--grid", "fibers.rods.count=5,9", "--grid", "time_step=0.01,0.02", "--seeds", "1..2")
POINTS = [f"fibers.rods.count={count}_time_step={step}" for count in (5, 9) for step in (0.01, 0.02)]


def read(path):
    with open(path, encoding="ascii") as file:
        rows = list(csv.DictReader(file))
    return {name: [row[name] for row in rows] for name in rows[0]}


def numbers(path):
    return {name: numpy.array([float(x) for x in values]) for name, values in read(path).items()}


def tables(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*.csv"))}


class SweepTest(FolderTest):
    def setUp(self):
        super().setUp()
        self.scene = self.dir / "scene.yaml"
        self.scene.write_text(SCENE)
        self.out = self.dir / "out"

    def words(self, *words, out=None):
        return [UNCROSS, "sweep", self.scene, "--out", out or self.out, "--jobs", "2", *words]

    def sweep(self, *words, code=0, says="", out=None):
        done = subprocess.run(list(map(str, self.words(*words, out=out))), capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertIn(says, done.stdout + done.stderr)
        return done

    def close(self, found, expected):
        numpy.testing.assert_allclose(found, expected, rtol=1e-13, atol=1e-15)

    # --- averages

    def test_averages_are_those_of_numpy(self):
        self.sweep(*GRID, says="8 of 8 runs finished")
        self.assertEqual(sorted(path.name for path in self.out.iterdir() if path.is_dir()), sorted(POINTS))
        summary = numbers_or_text(self.out / "summary.csv")
        for k, point in enumerate(POINTS):
            folders = [self.out / point / f"seed-{seed}" for seed in (1, 2)]
            for name in "temperature", "collisions", "statics-rods", "dynamics-rods":
                self.check_table(numbers(self.out / point / f"{name}.csv"), [numbers(f / f"{name}.csv") for f in folders])
            self.check_summary({name: values[k] for name, values in summary.items()}, self.out / point, folders)
        runs = read(self.out / "runs.csv")
        self.assertEqual(sorted(runs["folder"]), sorted(f"{point}/seed-{seed}" for point in POINTS for seed in (1, 2)))
        self.assertEqual(set(runs["exit_code"]), {"0"})
        self.assertEqual(summary["fibers.rods.count"], [5, 5, 9, 9])
        self.assertEqual(summary["time_step"], [0.01, 0.02, 0.01, 0.02])
        self.assertEqual(len(set(runs["state_hash"])), 8)
        self.assertEqual((runs["stream"], set(runs["start_state"])), (runs["seed"], {""}))

    def check_table(self, made, of):
        self.assertTrue((made["seeds"] == 2).all())
        for name in of[0]:
            a, b = of[0][name], of[1][name]
            if name in ("step", "time"):
                numpy.testing.assert_array_equal(made[name], a)
            elif name in ("samples", "intervals"):
                numpy.testing.assert_array_equal(made[name], a + b)
            elif name.endswith("_error"):
                self.close(made[name.replace("_error", "_block_error")], numpy.sqrt(a**2 + b**2) / 2)
            else:
                self.close(made[name], (a + b) / 2)
                self.close(made[name + "_error"], abs(a - b) / 2)

    def check_summary(self, row, point, folders):
        self.assertEqual((row["folder"], row["seeds"]), (point.name, 2))
        values, errors, rates = [], [], []
        for folder in folders:
            table = numbers(folder / "temperature.csv")
            kept = table["solvent"][table["step"] >= 100]
            levels = [kept, (kept[0:30:2] + kept[1:30:2]) / 2]
            self.assertEqual((len(kept), len(levels[1])), (30, 15))  # so only the first level has 16 blocks
            values.append(kept.mean())
            errors.append(kept.std(ddof=1) / math.sqrt(30))
            counts = numbers(folder / "collisions.csv")
            first, last = list(counts["step"]).index(120), len(counts["step"]) - 1
            time_passed = counts["time"][last] - counts["time"][first]
            vertices = 4 * row["fibers.rods.count"]
            rates.append((counts["executed"][last] - counts["executed"][first]) / time_passed / vertices)
        self.close(row["temperature_solvent"], sum(values) / 2)
        self.close(row["temperature_solvent_error"], abs(values[0] - values[1]) / 2)
        self.close(row["temperature_solvent_block_error"], math.hypot(*errors) / 2)
        self.close(row["collision_rate"], sum(rates) / 2)
        self.close(row["collision_rate_error"], abs(rates[0] - rates[1]) / 2)
        dynamics = numbers(point / "dynamics-rods.csv")
        at = numpy.flatnonzero(dynamics["intervals"] >= 32)[-1]
        self.assertEqual(row["lag_rods"], dynamics["time"][at])
        self.assertLess(at, len(dynamics["time"]) - 1)
        for name in "D", "D_error", "D_block_error", "D_about_mean", "D_cumulative", "drift_x_error":
            column = name.replace("_block_error", "").replace("_error", "")
            part = name[len(column):]
            self.assertEqual(row[f"{column}_rods{part}"], dynamics[name][at], name)
        self.assertEqual(row["Ree2_rods"], numbers(point / "statics-rods.csv")["Ree2"][0])

    def test_one_seed_keeps_its_own_errors(self):
        self.sweep("--grid", "fibers.rods.count=6,9", "--set", "seed=5", says="2 of 2 runs finished")
        for name in "statics-rods", "dynamics-rods":
            point = self.out / "fibers.rods.count=6"
            made, own = read(point / f"{name}.csv"), read(point / f"seed-5/{name}.csv")
            for column, values in own.items():
                self.assertEqual(made[column], values, column)
            self.assertEqual(made["g_cm_block_error" if "dyn" in name else "l_block_error"],
                             own["g_cm_error" if "dyn" in name else "l_error"])
            self.assertEqual(set(made["seeds"]), {"1"})

    # --- killed, resumed

    def test_killed_and_resumed(self):
        grid = ("--grid", "fibers.rods.count=6,12", "--seeds", "3,4", "--steps", "4000")
        whole = self.dir / "whole"
        self.sweep(*grid, out=whole)
        for number, code in (signal.SIGKILL, -9), (signal.SIGINT, 5):
            shutil.rmtree(self.out, ignore_errors=True)
            with subprocess.Popen(list(map(str, self.words(*grid))), stderr=subprocess.DEVNULL,
                                  stdout=subprocess.DEVNULL) as process:
                begun = self.wait_for(lambda: len(list(self.out.glob("*/seed-4/run.json"))) > 0)
                process.send_signal(number)
                self.assertEqual((begun, process.wait()), (True, code))
            done = [path for path in self.out.rglob("run.json") if '"status": "finished"' in path.read_text()]
            self.assertIn(len(done), (1, 2, 3))
            self.sweep(*grid, code=2, says="go on with --resume")
            self.sweep(*grid, "--resume", says="4 of 4 runs finished")
            self.assertEqual(tables(self.out), tables(whole))
            before = {path: path.stat().st_mtime_ns for path in self.out.rglob("run.json")}
            self.sweep(*grid, "--resume", says="4 of 4 runs finished")  # nothing is run again
            self.assertEqual({path: path.stat().st_mtime_ns for path in self.out.rglob("run.json")}, before)

    def test_runs_do_not_outlive_their_sweep(self):
        record = self.out / "all/seed-1/run.json"
        with subprocess.Popen(list(map(str, self.words("--steps", 10**12))), stderr=subprocess.DEVNULL) as process:
            self.assertTrue(self.wait_for(record.exists))
            process.kill()
        self.assertTrue(self.wait_for(lambda: '"status": "interrupted"' in record.read_text()))

    def wait_for(self, condition):
        give_up = time.monotonic() + 60
        while not condition() and time.monotonic() < give_up:
            time.sleep(0.005)
        return condition()

    def test_a_sweep_grows(self):
        self.sweep("--seeds", "1..2")
        self.sweep("--seeds", "1..3", "--resume", says="3 of 3 runs finished")
        self.assertEqual(set(read(self.out / "all/statics-rods.csv")["seeds"]), {"3"})
        self.sweep("--seeds", "1..3", "--set", "box=[6, 5, 5]", "--resume", code=2, says="a finished run of another scene")

    def test_what_is_observed_stays(self):
        """Averages are over runs that observed alike."""
        self.sweep("--seeds", "1", "--steps", "300")
        before = tables(self.out)
        for change in ("observe.from=200", "observe.statics.every=20", "observe.temperature.every=60", "observe.memory.every=10"):
            self.sweep("--seeds", "1..2", "--steps", "300", "--set", change, "--resume", code=2, says="holds a finished run that observed otherwise")
        self.assertEqual(tables(self.out), before)
        self.sweep("--seeds", "1..2", "--steps", "300", "--resume", says="2 of 2 runs finished")

    # --- bad input

    def test_tables_that_are_not_whole(self):
        """A finished run whose table is gone, emptied, cut or of other columns: no average is made of the rest."""
        self.sweep("--seeds", "1..2", "--steps", "300")
        before = tables(self.out)
        for name in "temperature.csv", "statics-rods.csv", "dynamics-rods.csv":
            path = self.out / "all" / "seed-2" / name
            text = path.read_text()
            lines = text.splitlines(True)
            damages = {"gone": None, "empty": "", "precious": "precious\n", "cut": "".join(lines[:-1]),
                       "other": text.replace(lines[0].split(",")[-1].strip(), "other", 1)}
            for what, damage in damages.items():
                path.unlink() if damage is None else path.write_text(damage)
                told = self.sweep("--seeds", "1..2", "--steps", "300", "--resume", code=2).stderr
                self.assertIn(f"seed-2/{name}", told, what)
                path.write_text(text)
                self.assertEqual(tables(self.out), before, f"{name}: {what}")
        self.sweep("--seeds", "1..2", "--steps", "300", "--resume", code=0)
        (self.out / "all" / "seed-2" / "statics-rods.csv").unlink()  # of the only run that is asked for
        self.sweep("--seeds", "2..2", "--steps", "300", "--resume", code=2, says="statics-rods.csv")

    def test_bad_grids(self):
        for grid, says in (("fibers.rods.cuont=5,9", "--set fibers.rods.cuont=5: unknown key 'cuont' in fibers; did you mean"),
                           ("time_step=0.01,2", "--set time_step=2: time_step: '2' is out of range"),
                           ("time_step=0.01,0.02,", "allowed: KEY=VALUE,VALUE"), ("time_step", "allowed: KEY=VALUE,VALUE"),
                           ("seed=1,2", "use --seeds"), ("box=[5, 5, 5],[5, 5, 5]", "a value is given twice"),
                           ("observe.from=0,1001", "observe.from: averages would begin at step 1001")):
            self.sweep("--grid", grid, code=2, says=says)
            self.assertFalse(self.out.exists())
        for seeds in "4..1", "1,1", "1..18446744073709551616":
            self.sweep(f"--seeds={seeds}", code=2, says="--seeds")
        self.sweep("--jobs", "0", code=2, says="--jobs 0: not a whole number from 1")
        self.sweep("--flavour", "x", code=2, says="uncross: sweep: unrecognized option '--flavour'")
        self.assertFalse(self.out.exists())
        (self.dir / "mine").mkdir()
        (self.dir / "mine/notes.txt").write_text("mine\n")
        self.sweep(out=self.dir / "mine", code=2, says="holds notes.txt already")

    def test_a_key_has_one_value(self):
        """Of two values of one key one would be dropped without a word, by whatever names and options they are given."""
        for words, says in ((("--grid", "fibers.0.mass=1,2", "--grid", "fibers.rods.mass=3,4"), "'mass' is set already, by '--set fibers.0.mass=1'"),
                            (("--grid", "time_step=0.01,0.02", "--set", "time_step=0.01"), "'time_step' is set already"),
                            (("--set", "fibers.0.mass=1", "--set", "fibers.rods.mass=2"), "'mass' is set already"),
                            (("--grid", "steps=10,20", "--steps", "5"), "--steps 5: steps is a key of --grid"),
                            (("--set", "steps=10", "--steps", "5"), "--steps 5: steps is a key of --set"),
                            (("--set", "seed=9", "--seeds", "1"), "--seeds 1: seed is a key of --set"),
                            (("--grid", "time_step=0.01,0.010"), "time_step=0.01 and time_step=0.010 are the same scene")):
            with self.subTest(words=words):
                self.sweep(*words, "--list", code=2, says=says)
                self.assertFalse(self.out.exists())

    def test_a_grid_of_steps_has_a_column_of_its_own(self):
        self.sweep("--grid", "steps=300,400", "--set", "observe={}", "--quiet")
        with open(self.out / "runs.csv", encoding="ascii") as file:
            names = next(csv.reader(file))
        self.assertEqual(len(set(names)), len(names))
        self.assertEqual([read(self.out / "runs.csv")[name] for name in ("steps", "steps_done")], [["300", "400"]] * 2)

    def test_nobody_listens(self):
        """All descriptors closed, as of a daemon; a full disk under standard error; warnings of packages that shall be errors."""
        for number, closed in enumerate(('<&- >&- 2>&-', '2>/dev/full')):
            out = self.dir / f"unheard{number}"
            done = subprocess.run(["sh", "-c", f'exec "$@" {closed}', "sh", *map(str, self.words("--steps", "200", "--set", "observe.from=0", out=out))],
                                  check=False, stdout=subprocess.DEVNULL, env=dict(os.environ, PYTHONWARNINGS="error"))
            self.assertEqual((done.returncode, (out / "summary.csv").exists()), (0, True), closed)

    def test_a_missing_package_is_named(self):
        (self.dir / "numpy.py").write_text("raise ModuleNotFoundError('gone', name='numpy')\n")
        done = subprocess.run(list(map(str, self.words())), capture_output=True, text=True, check=False,
                              env=dict(os.environ, PYTHONPATH=str(self.dir)))
        self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
        self.assertIn("numpy is missing; `apt-get install python3-numpy` installs it", done.stderr)

    def test_a_run_that_stops(self):
        """Its exit code is in the table and the sweep's; the others are averaged."""
        self.sweep("--grid", "fibers.rods.force=[0, 0, 0],[0, 0, 1e6]", "--seeds", "1..2", code=3, says="2 of 4 runs finished")
        runs, summary = read(self.out / "runs.csv"), read(self.out / "summary.csv")
        self.assertEqual(runs["exit_code"], ["0", "3", "0", "3"])
        self.assertEqual([bool(message) for message in runs["message"]], [False, True, False, True])
        self.assertEqual(summary["seeds"], ["2", "0"])
        self.assertEqual(summary["Ree2_rods"][1], "nan")
        self.assertEqual(summary["fibers.rods.force"], ["[0, 0, 0]", "[0, 0, 1e6]"])

    # --- lists

    def test_slurm_and_list(self):
        out = self.dir / "a folder"
        whole = self.dir / "whole"
        self.sweep(*GRID, out=whole)
        listed = self.sweep(*GRID, "--list", out=out).stdout.splitlines()
        script = self.dir / "array.sbatch"
        script.write_text(self.sweep(*GRID, "--slurm", out=out).stdout)
        self.assertFalse(out.exists())
        subprocess.run(["bash", "-n", script], check=True)
        self.assertIn("\n#SBATCH --array=0-7\n", script.read_text())
        lines = [line.partition("set -- ")[2].removesuffix(" ;;") for line in script.read_text().splitlines()
                 if line.partition(")")[0].strip().isdigit()]
        self.assertEqual(lines, listed)
        self.assertEqual(len(set(listed)), 8)
        for point in POINTS:
            for seed in 1, 2:
                self.assertEqual(sum(f"/{point}/seed-{seed}'" in line for line in listed), 1)
        for task in range(8):
            environment = dict(os.environ, SLURM_ARRAY_TASK_ID=str(task))
            subprocess.run(["bash", script], env=environment, check=True, stdout=subprocess.DEVNULL)
        done = subprocess.run(["bash", script], env=dict(os.environ, SLURM_ARRAY_TASK_ID="8"), stderr=subprocess.DEVNULL,
                              check=False)
        self.assertEqual(done.returncode, 1)
        self.sweep(*GRID, "--resume", out=out, says="8 of 8 runs finished")
        self.assertEqual(tables(out), tables(whole))


def numbers_or_text(path):
    def value(text):
        try:
            return float(text)
        except ValueError:
            return text
    return {name: [value(text) for text in values] for name, values in read(path).items()}


if __name__ == "__main__":
    unittest.main()
