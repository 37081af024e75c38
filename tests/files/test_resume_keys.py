"""What a resumed run keeps is refused by every way of saying it otherwise, and the message names the key."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

UNCROSS = os.environ.get("UNCROSS", "build/uncross")
SCENE = """box: [6, 6, 6]
time_step: 0.01
steps: 4
seed: 7
solvent: {per_cell: 2, collision_interval: 0.02}
fibers: [{name: a, count: 2, vertices: 4, mass: 2, bond_length: 0.5, spring: 100}]
observe: {statics: {every: 2}, conserved: {every: 1}}
trajectory: {every: 2, solvent: false}
"""
KEPT = (  # key, what the scene says, another value, what the message names
    ("seed", "seed: 7", "8", "seed 7"), ("box", "box: [6, 6, 6]", "[6, 7, 6]", "box is [6, 7, 6] there, [6, 6, 6] in the run so far"),
    ("time_step", "time_step: 0.01", "0.005", "time_step is 0.005"), ("solvent.per_cell", "per_cell: 2", "3", "solvent.per_cell is 3"),
    ("fibers.0.spring", "spring: 100", "90", "fibers.0.spring is 90 there, 100 in"),
    ("fibers.0.count", "count: 2", "3", "fibers.0.count is 3 there, 2 in"),
    ("observe.statics.every", "statics: {every: 2", "1", "observe.statics.every"),
    ("trajectory.solvent", "solvent: false", "true", "its frames hold 8 particles with velocities, the scene asks for 440 with"))


class Resume(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.scene = self.dir / "scene.yaml"
        self.scene.write_text(SCENE)

    def resume(self, *words, code=2, out="run"):
        done = subprocess.run([UNCROSS, "run", self.scene, "--out", self.dir / out, "--quiet", *words], capture_output=True,
                              text=True, check=False, timeout=60)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def kept(self):
        return {path.name: path.read_bytes() for path in (self.dir / "run").iterdir() if path.is_file()}

    def test_kept_keys(self):
        self.resume(code=0)
        before = self.kept()
        for key, said, value, words in KEPT:
            with self.subTest(key=key):
                for steps in ("6", "2"):  # beyond the run's end; or before it, where nothing is left to do
                    self.assertIn(words, self.resume("--resume", "--steps", steps, "--set", f"{key}={value}"))
                name = said.rpartition(": ")[0]
                self.assertEqual(SCENE.count(said), 1)
                self.scene.write_text(SCENE.replace(said, f"{name}: {value}"))
                self.assertIn(words, self.resume("--resume", "--steps", "6"))
                self.scene.write_text(SCENE)
                self.assertTrue(self.kept() == before)

    def test_a_value_that_the_scene_left_out(self):
        """It is told, too: a default is a value."""
        self.resume("--set", "crossing.rule=event-driven", code=0)
        self.assertIn("crossing.rule is sequential there, event-driven in the run so far", self.resume("--resume", "--set", "crossing.rule=sequential"))
        self.assertIn("flow is [0.5, 0, 0] there, [0, 0, 0] in the run so far",
                      self.resume("--resume", "--set", "crossing.rule=event-driven", "--set", "flow=[0.5, 0, 0]"))
        self.assertIn("walls is given there, none in the run so far",
                      self.resume("--resume", "--set", "crossing.rule=event-driven", "--set", "walls.kind=slip"))

    def test_a_seed_from_outside(self):
        """--seed stands above the scene's, whose own seed stays what it was."""
        self.resume("--seed", "9", code=0)
        self.resume("--resume", "--steps", "6", code=0)
        record = json.loads((self.dir / "run/run.json").read_text())
        self.assertEqual((record["seed"], record["steps"]), ("9", 6))
        for words in (("--seed", "7"), ("--set", "seed=8")):
            self.assertIn("seed 9", self.resume("--resume", "--steps", "8", *words))
        self.resume("--resume", "--steps", "8", "--set", "seed=9", code=0)

    def test_the_snapshot_may_be_gone(self):
        """A resume goes on from the checkpoint, which has all of the state."""
        self.resume(code=0)
        self.scene.write_text(SCENE + "start: {snapshot: run/checkpoint.h5}\n")
        self.resume("--steps", "2", code=0, out="parts")
        self.resume("--steps", "4", code=0, out="whole")
        (self.dir / "run/checkpoint.h5").unlink()
        self.resume("--resume", "--steps", "4", code=0, out="parts")
        ends = [json.loads((self.dir / out / "run.json").read_text())["state_hash"] for out in ("parts", "whole")]
        self.assertEqual(*ends)
        words = f"{self.scene}:9:19: start.snapshot: '{self.dir}/run/checkpoint.h5' cannot be read: No such file or directory"
        self.assertIn(words, self.resume(out="new"))
        check = subprocess.run([UNCROSS, "check", self.scene], capture_output=True, text=True, check=False, timeout=60)
        self.assertEqual((check.returncode, words in check.stderr), (2, True))


if __name__ == "__main__":
    unittest.main()
