#!/usr/bin/python3
"""Files of a run that are not there, or not there yet: what was deleted is said, and a run at work is not damaged."""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import UNCROSS, uncross  # noqa: E402

SCENE = """box: [6, 6, 6]
time_step: 0.01
steps: {steps}
solvent: {{per_cell: 3, collision_interval: 0.02}}
fibers:
  - {{name: fiber, count: 4, vertices: 8, mass: 2, bond_length: 0.5, spring: 100, bending: 4}}
observe: {{conserved: {{every: 10}}, collisions: {{every: 10}}, statics: {{every: 10}}}}
trajectory: {{every: 10}}
checkpoint: {{seconds: 0.2}}
"""
FILES = ["checkpoint.h5", "trajectory.h5", "conserved.csv", "collisions.csv", "statics-fiber.csv"]


class Missing(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.dir = pathlib.Path(self.temporary.name)

    def begin(self, steps, name="r"):
        """A run at work, with its first checkpoint written."""
        (self.dir / "s.yaml").write_text(SCENE.format(steps=steps))
        run = subprocess.Popen([UNCROSS, "run", "s.yaml", "--out", name, "--quiet"], cwd=self.dir, stderr=subprocess.PIPE, text=True)
        self.addCleanup(run.stderr.close)
        self.addCleanup(run.wait)
        self.addCleanup(run.kill)
        return run

    def wait_for(self, path):
        end = time.monotonic() + 60
        while not path.exists():
            self.assertLess(time.monotonic(), end, path)
            time.sleep(0.01)

    def test_verify_knows_what_a_run_has(self):
        (self.dir / "s.yaml").write_text(SCENE.format(steps=40))
        uncross("run", "s.yaml", "--out", "r", cwd=self.dir, check=True)
        self.assertEqual(uncross("verify", "r", cwd=self.dir).returncode, 0)
        for name in FILES:
            os.rename(self.dir / "r" / name, self.dir / "aside")
            done = uncross("verify", "r", cwd=self.dir)
            self.assertNotEqual(done.returncode, 0, name)
            self.assertIn(f"r/{name}: missing", done.stdout)
            os.rename(self.dir / "aside", self.dir / "r" / name)
        self.assertEqual(uncross("verify", "r", cwd=self.dir).returncode, 0)

    def test_verify_knows_how_far_tables_go(self):
        """Tables that are well formed, and are not what the run wrote; the run has five rows and one."""
        (self.dir / "s.yaml").write_text(SCENE.format(steps=40))
        uncross("run", "s.yaml", "--out", "r", cwd=self.dir, check=True)
        for name in "conserved.csv", "statics-fiber.csv":
            path = self.dir / "r" / name
            text = path.read_text()
            lines = text.splitlines(True)
            for damage in "precious\n", lines[0], "".join(lines[:-1]), text.replace(lines[0].split(",")[1], "other", 1), text + lines[-1]:
                path.write_text(damage)
                done = uncross("verify", "r", cwd=self.dir)
                self.assertEqual(done.returncode, 9, f"{name}: {damage[:80]}: {done.stdout}")
                self.assertRegex(done.stdout, f"r/{name}[:0-9]*: ")
            path.write_text(text)
        self.assertEqual(uncross("verify", "r", cwd=self.dir).returncode, 0)

    def test_rows_follow_each_other(self):
        """At steps 0, 10, ... 40: lines that are there twice, or in disorder; and a row that is gone, which is told."""
        (self.dir / "s.yaml").write_text(SCENE.format(steps=40))
        uncross("run", "s.yaml", "--out", "r", cwd=self.dir, check=True)
        path = self.dir / "r/conserved.csv"
        lines = path.read_text().splitlines(True)
        for damage, number in ([*lines, *lines[1:]], 7), ([*lines[:2], lines[3], lines[2], *lines[4:]], 4):
            path.write_text("".join(damage))
            done = uncross("verify", "r", cwd=self.dir)
            self.assertEqual(done.returncode, 9, done.stdout)
            self.assertIn(f"r/conserved.csv:{number}: damaged: its step does not come after that of the row before", done.stdout)
        path.write_text("".join(lines[:3] + lines[4:]))
        done = uncross("verify", "r", cwd=self.dir)
        self.assertIn("r/conserved.csv: readable: rows: 4, at steps that are not evenly spaced: rows are missing", done.stdout)
        path.write_text("".join(lines))
        self.assertNotIn("evenly", uncross("verify", "r", cwd=self.dir).stdout)

    def test_a_table_that_cannot_be_read(self):
        """A disk that fails says nothing of the rows: the memory of a process is such a file."""
        (self.dir / "x.csv").symlink_to("/proc/self/mem")
        done = uncross("verify", "x.csv", cwd=self.dir)
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("x.csv: cannot be read to its end", done.stdout)
        (self.dir / "s.yaml").write_text(SCENE.format(steps=40))
        uncross("run", "s.yaml", "--out", "r", cwd=self.dir, check=True)
        for name in "conserved.csv", "statics-fiber.csv":
            os.rename(self.dir / "r" / name, self.dir / "aside")
            (self.dir / "r" / name).symlink_to("/proc/self/mem")
            done = uncross("verify", "r", cwd=self.dir)
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertNotIn("damaged", done.stdout)
            os.rename(self.dir / "aside", self.dir / "r" / name)

    def test_a_record_of_another_state(self):
        """run.json and checkpoint of one step have one state."""
        (self.dir / "s.yaml").write_text(SCENE.format(steps=40))
        uncross("run", "s.yaml", "--out", "r", cwd=self.dir, check=True)
        record = self.dir / "r/run.json"
        told = json.loads(record.read_text())
        record.write_text(json.dumps({**told, "state_hash": "0123456789abcdef"}))
        done = uncross("verify", "r", cwd=self.dir)
        self.assertEqual(done.returncode, 9, done.stdout)
        self.assertIn("damaged: its state_hash is 0123456789abcdef, in the checkpoint " + told["state_hash"], done.stdout)
        record.write_text(json.dumps({**told, "status": "running", "state_hash": "0123456789abcdef", "steps": 30}))  # as of a run that was killed
        self.assertEqual(uncross("verify", "r", cwd=self.dir).returncode, 0)

    def test_what_is_deleted_is_said(self):
        """At the next checkpoint."""
        for name in ("trajectory.h5", "conserved.csv"):
            run = self.begin(10 ** 8, name)
            self.wait_for(self.dir / name / "conserved.csv")
            self.wait_for(self.dir / name / "statics-fiber.csv")
            os.unlink(self.dir / name / name)
            _, said = run.communicate(timeout=100)
            self.assertEqual(run.returncode, 4, said)
            self.assertIn(name, said)
            self.assertIn('"stopped"', (self.dir / name / "run.json").read_text())

    def test_before_the_second_checkpoint(self):
        """What grows is there from the beginning on; averages only from the second checkpoint."""
        (self.dir / "s.yaml").write_text(SCENE.format(steps=10 ** 8).replace("seconds: 0.2", "seconds: 0"))
        run = subprocess.Popen([UNCROSS, "run", "s.yaml", "--out", "r", "--quiet"], cwd=self.dir)
        self.wait_for(self.dir / "r/run.json")
        run.kill()
        run.wait()
        done = uncross("verify", "r", cwd=self.dir)
        self.assertEqual(done.returncode, 0, done.stdout)
        for name in ("conserved.csv", "trajectory.h5"):
            os.rename(self.dir / "r" / name, self.dir / "aside")
            done = uncross("verify", "r", cwd=self.dir)
            self.assertEqual(done.returncode, 9, name)
            self.assertIn(f"r/{name}: missing", done.stdout)
            self.assertNotIn("statics", done.stdout)
            os.rename(self.dir / "aside", self.dir / "r" / name)

    def test_a_run_at_work_is_not_damaged(self):
        """From its first moment on."""
        run = self.begin(10 ** 8)
        self.wait_for(self.dir / "r/checkpoint.h5")
        for _ in range(8):
            done = uncross("verify", "r", cwd=self.dir)
            self.assertNotIn("damaged", done.stdout)
            self.assertNotIn("missing", done.stdout)
            self.assertIn("being written", done.stdout)
        run.send_signal(signal.SIGTERM)
        self.assertEqual(run.wait(60), 5)
        self.assertEqual(uncross("verify", "r", cwd=self.dir).returncode, 0)


if __name__ == "__main__":
    unittest.main()
