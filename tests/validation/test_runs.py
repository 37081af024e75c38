"""Runs are resumed where a signal stopped them, extended by more steps, and never mixed up with others."""
import contextlib
import fcntl
import io
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "validation"))

import numpy

from lib import runs

UNCROSS = pathlib.Path(os.environ.get("UNCROSS", "build/uncross")).resolve()
SCENE = """box: [6, 6, 6]
time_step: 0.02
solvent: {per_cell: 5, collision_interval: 0.02}
observe: {conserved: {every: 100}}
"""
AVERAGES = """fibers: [{name: chain, count: 2, vertices: 5, mass: 5, bond_length: 0.5, spring: 100}]
"""
# Executes a run in a process of its own, so that signals can be sent to it.
CHILD = """import sys, json
sys.path.insert(0, sys.argv[1])
from lib import runs
sys.exit(runs.execute(runs.Run(**json.loads(sys.argv[2])), sys.argv[3], sys.argv[4]))
"""


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.work, self.build = pathlib.Path(folder.name) / "work", pathlib.Path(folder.name) / "build"
        (self.build / "validation/measure").mkdir(parents=True)
        (self.build / "uncross").symlink_to(UNCROSS)

    def program(self, text):
        path = self.build / "validation/measure/made-up"
        path.write_text("#!/bin/sh\n" + text)
        path.chmod(0o755)

    def scene(self, steps, text=SCENE):
        return runs.Run("a", scene=text, steps=steps, seed=3, case="made-up")

    def execute(self, run, name="a", **options):
        return runs.execute(run, self.work / name, self.build, **options)

    def interrupt(self, run, file, old=None):
        """Exit code of a run that got SIGTERM once its folder held this file, another one than that with the inode `old`."""
        child = subprocess.Popen([sys.executable, "-c", CHILD, str(pathlib.Path(runs.__file__).parents[1]), json.dumps(
            {"name": run.name, "scene": run.scene, "steps": run.steps, "seed": run.seed, "program": run.program}),
            str(self.work / "a"), str(self.build)])
        deadline = time.monotonic() + 60
        path = self.work / "a" / file
        while not (path.exists() and path.stat().st_ino != old) and time.monotonic() < deadline:
            time.sleep(0.01)
        time.sleep(0.3)
        child.send_signal(signal.SIGTERM)
        return child.wait(60)

    def state_hash(self, name):
        return runs.read_json(self.work / name / "run.json")["state_hash"]

    def test_interrupted_resumed_extended(self):
        """The state is that of a run in one go."""
        self.assertEqual(self.interrupt(self.scene(10**7), "conserved.csv"), runs.INTERRUPTED)
        stopped = runs.Result(self.work / "a", self.scene(10**7))
        self.assertFalse(stopped.finished)
        self.assertGreater(stopped.steps, 0)
        more = stopped.steps + 200
        self.assertEqual(self.execute(self.scene(more)), 0)
        self.assertEqual(self.execute(self.scene(more + 100)), 0)
        self.assertEqual(self.execute(self.scene(more + 100), "b"), 0)
        self.assertEqual(self.state_hash("a"), self.state_hash("b"))
        result = runs.Result(self.work / "a", self.scene(more + 100))
        self.assertTrue(result.finished)
        self.assertAlmostEqual(result.time, 0.02 * (more + 100), 9)
        self.assertGreater(len(result.table("conserved")["total"]), 2)

    def test_finished_is_not_run_again(self):
        self.assertEqual(self.execute(self.scene(100)), 0)
        before = (self.work / "a/run.json").stat().st_mtime_ns
        self.assertEqual(self.execute(self.scene(100)), 0)
        self.assertEqual(self.execute(self.scene(50)), 0)
        self.assertEqual((self.work / "a/run.json").stat().st_mtime_ns, before)

    def test_another_scene(self):
        """Days of work are not thrown away for it, seconds are."""
        self.assertEqual(self.execute(self.scene(100)), 0)
        other = self.scene(100, SCENE.replace("per_cell: 5", "per_cell: 4"))
        self.assertTrue(runs.Result(self.work / "a", self.scene(100)).exists)
        self.assertFalse(runs.Result(self.work / "a", other).exists)
        with self.assertRaises(runs.Refused):
            self.execute(other)
        self.assertEqual(self.execute(other, fresh=True), 0)
        self.assertIn("per_cell: 4", (self.work / "a/scene.yaml").read_text())

    def test_killed_before_its_first_checkpoint(self):
        self.assertEqual(self.execute(self.scene(100), "b"), 0)
        (self.work / "a").mkdir(parents=True)
        (self.work / "a/conserved.csv").write_text("time\n")
        (self.work / "a/trajectory.h5").write_text("half a file")
        (self.work / "a/run.json").write_text('{"status": "stopped", "steps": 0}')
        self.assertEqual(self.execute(self.scene(100)), 0)
        self.assertEqual((self.work / "a/conserved.csv").read_text(), (self.work / "b/conserved.csv").read_text())

    def test_killed_while_its_child_goes_on(self):
        """Nothing of the child's is taken from it; who comes next waits, and goes on from its checkpoint."""
        run = self.scene(10**9)
        child = subprocess.Popen([sys.executable, "-c", CHILD, str(pathlib.Path(runs.__file__).parents[1]), json.dumps(
            {"name": run.name, "scene": run.scene, "steps": run.steps, "seed": run.seed, "program": run.program}),
            str(self.work / "a"), str(self.build)])
        table, deadline = self.work / "a/conserved.csv", time.monotonic() + 60
        while not table.exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        orphan = int(subprocess.run(["pgrep", "-P", str(child.pid)], capture_output=True, text=True, check=True).stdout)
        child.kill()
        child.wait()
        inode = table.stat().st_ino
        later = threading.Timer(1.0, lambda: os.kill(orphan, signal.SIGTERM))
        later.start()
        checkpoint = (self.work / "a/checkpoint.h5").stat().st_ino
        self.assertEqual(self.interrupt(run, "checkpoint.h5", checkpoint), runs.INTERRUPTED)
        self.assertEqual(table.stat().st_ino, inode)

    def test_program(self):
        self.program("echo n,x; echo 1,$1")
        run = runs.Run("a", program=["made-up", 7], case="made-up")
        self.assertEqual(self.execute(run), 0)
        result = runs.Result(self.work / "a", run)
        self.assertTrue(result.finished)
        self.assertEqual(result.columns["x"][0], 7.0)

    def test_program_that_fails_has_no_result(self):
        self.program("echo n,x; exit 3")
        run = runs.Run("a", program=["made-up"], case="made-up")
        self.assertEqual(self.execute(run), 3)
        self.assertFalse(runs.Result(self.work / "a", run).exists)

    def test_program_that_is_interrupted(self):
        self.program("echo n,x; exec sleep 60")
        run = runs.Run("a", program=["made-up"], case="made-up")
        self.assertEqual(self.interrupt(run, "output.part"), runs.INTERRUPTED)
        self.assertFalse(runs.Result(self.work / "a", run).exists)

    def test_harvest(self):
        """Keeps what counts, not checkpoints."""
        self.assertEqual(self.execute(self.scene(100), "made-up/a"), 0)
        self.assertTrue(runs.harvest(self.scene(100), self.work, self.work / "kept"))
        kept = sorted(path.name for path in (self.work / "kept/made-up/a").iterdir())
        self.assertEqual(kept, ["conserved.csv", "run.json", "scene.yaml", "session.json"])

    def test_harvest_names_no_folder_of_this_machine(self):
        self.assertEqual(self.execute(self.scene(100), "made-up/a"), 0)
        self.assertTrue(runs.harvest(self.scene(100), self.work, self.work / "kept"))
        record = (self.work / "kept/made-up/a/run.json").read_text()
        self.assertNotIn(str(self.work), record)
        self.assertIn("build/campaign/made-up/a/scene.yaml", record)

    def test_harvest_of_a_run_that_goes_on(self):
        """Half a row on the disk is no row."""
        self.assertEqual(self.execute(self.scene(100), "made-up/a"), 0)
        table = self.work / "made-up/a/conserved.csv"
        rows = table.read_text()
        with table.open("a") as more:
            more.write(rows.splitlines()[-1][:20])
        whole = runs.columns(rows)["time"]
        self.assertTrue(numpy.array_equal(runs.columns(table.read_text())["time"], whole))
        self.assertTrue(runs.harvest(self.scene(100), self.work, self.work / "kept"))
        self.assertEqual((self.work / "kept/made-up/a/conserved.csv").read_text(), rows)

    def averaged(self):
        """A run with averages, and where its tables are."""
        run = self.scene(100, SCENE.replace("every: 100}", "every: 100}, statics: {every: 10}") + AVERAGES)
        self.assertEqual(self.execute(run, "made-up/a"), 0)
        return run, self.work / "made-up/a", self.work / "kept/made-up/a"

    def checkpoint(self, folder, step, averages_only=False):
        """What a run does at a checkpoint, in its order."""
        (folder / "statics-chain.csv").write_text(f"l,l_error\n{step},0\n")
        if averages_only:
            return
        with (folder / "conserved.csv").open("a") as more:
            more.write(f"{step},0\n")
        text = re.sub(r'"steps": \d+', f'"steps": {step}', (folder / "run.json").read_text())
        (folder / "run.json").write_text(re.sub(r'"status": "\w+"', '"status": "running"', text))

    def test_harvest_between_checkpoints(self):
        """Rows that a run has written since its last checkpoint are not of the step of run.json."""
        run, folder, kept = self.averaged()
        rows = (folder / "conserved.csv").read_text()
        with (folder / "conserved.csv").open("a") as more:
            more.write(rows.splitlines()[-1].replace("100,", "200,", 1) + "\n")
        self.assertTrue(runs.harvest(run, self.work, self.work / "kept"))
        self.assertEqual((kept / "conserved.csv").read_text(), rows)

    def test_harvest_during_a_checkpoint(self):
        """A checkpoint that comes between two reads: averages and run.json are of one step all the same."""
        run, folder, kept = self.averaged()
        read, came = pathlib.Path.read_bytes, []

        def read_and_go_on(path):
            content = read(path)
            if path.name == self.late and not came:
                came.append(path)
                self.checkpoint(folder, 200)
            return content
        for self.late in ("run.json", "session.json", "conserved.csv", "statics-chain.csv"):
            came.clear()
            (folder / "conserved.csv").write_text("step,time\n")
            self.checkpoint(folder, 100)
            with unittest.mock.patch.object(pathlib.Path, "read_bytes", read_and_go_on), unittest.mock.patch.object(
                    runs, "HARVEST_PAUSE", 0.0):
                self.assertTrue(runs.harvest(run, self.work, self.work / "kept"))
            self.assertTrue(came)
            step = json.loads((kept / "run.json").read_text())["steps"]
            self.assertEqual((kept / "statics-chain.csv").read_text(), f"l,l_error\n{step},0\n", self.late)
            self.assertEqual((kept / "conserved.csv").read_text().splitlines()[-1], f"{step},0", self.late)

    def test_harvest_of_half_a_checkpoint(self):
        """Averages are newer than run.json: what was kept before stays, until the run is through with it."""
        run, folder, kept = self.averaged()
        self.checkpoint(folder, 100)
        self.assertTrue(runs.harvest(run, self.work, self.work / "kept"))
        before = {path.name: path.read_bytes() for path in kept.iterdir()}
        late = (folder / "run.json").stat().st_mtime_ns + 10**9
        self.checkpoint(folder, 200, averages_only=True)
        os.utime(folder / "statics-chain.csv", ns=(late, late))
        with unittest.mock.patch.object(runs, "HARVEST_PAUSE", 0.0), contextlib.redirect_stderr(io.StringIO()) as told:
            self.assertFalse(runs.harvest(run, self.work, self.work / "kept"))
        self.assertIn("made-up/a is between two checkpoints", told.getvalue())
        self.assertEqual(before, {path.name: path.read_bytes() for path in kept.iterdir()})

    def test_harvest_of_a_run_that_is_extended(self):
        """Until its first checkpoint run.json says `finished`, of fewer steps."""
        run, folder, kept = self.averaged()
        late = (folder / "run.json").stat().st_mtime_ns + 10**9
        self.checkpoint(folder, 200, averages_only=True)
        os.utime(folder / "statics-chain.csv", ns=(late, late))
        with open(folder.with_name("a.lock"), "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            with unittest.mock.patch.object(runs, "HARVEST_PAUSE", 0.0), contextlib.redirect_stderr(io.StringIO()):
                self.assertFalse(runs.harvest(run, self.work, self.work / "kept"))
        self.assertFalse(kept.exists())

    def test_harvest_of_a_table_made_afterwards(self):
        """It is newer than run.json, and of the same step."""
        run, folder, kept = self.averaged()
        run.after = ("cage", 1)
        self.checkpoint(folder, 100)
        (folder / "cage.csv").write_text("x\n1\n")
        late = (folder / "run.json").stat().st_mtime_ns + 10**9
        os.utime(folder / "cage.csv", ns=(late, late))
        self.assertTrue(runs.harvest(run, self.work, self.work / "kept"))
        self.assertEqual((kept / "cage.csv").read_text(), "x\n1\n")

    def test_long_series_are_thinned(self):
        """Rows of equal intervals: the mean stays, the row before the first interval goes, and step and time are the ends."""
        self.work.mkdir(parents=True, exist_ok=True)
        path = self.work / "stress.csv"
        steps = range(0, 50, 10)
        path.write_text("step,time,sigma\n" + "".join(f"{k},{0.1 * k},{k if k else 'nan'}\n" for k in steps))
        runs.thin(path, most=2)
        self.assertEqual(path.read_text(), "step,time,sigma\n20,2,15\n40,4,35\n")
        runs.thin(path, most=2)
        self.assertEqual(path.read_text(), "step,time,sigma\n20,2,15\n40,4,35\n")


if __name__ == "__main__":
    unittest.main()
