#!/usr/bin/python3
"""All files of a folder are of one run: a trajectory or a run.json of another is told by verify, and not continued."""
import json
import pathlib
import shutil
import sys
import tempfile
import unittest

import h5py

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import uncross  # noqa: E402

SCENE = """box: [4, 4, 4]
time_step: 0.01
steps: 20
seed: 1
solvent: {per_cell: 2, collision_interval: 0.02}
fibers: [{name: a, count: 2, vertices: 4, mass: 2, bond_length: 0.5, spring: 100}]
observe: {conserved: {every: 10}}
trajectory: {every: 10}
"""
OTHERS = {  # each differs in one thing that a trajectory tells
    "seed": (SCENE.replace("seed: 1", "seed: 2"), "its seed is 2, the run's is 1"),
    "mass": (SCENE.replace("mass: 2", "mass: 3"), "its scene is another one"),
    "stream": (SCENE + "start: {snapshot: run/checkpoint.h5}\n", "its stream is "),
}


class OneRun(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.run_of(SCENE, "run")

    def run_of(self, text, out):
        (self.dir / f"{out}.yaml").write_text(text)
        uncross("run", f"{out}.yaml", "--out", out, "--quiet", cwd=self.dir, check=True)

    def resume(self, name, out, steps=30):
        return uncross("run", f"{name}.yaml", "--out", out, "--resume", "--steps", str(steps), "--quiet", cwd=self.dir)

    def mixed(self, what):
        """The run's folder, with a trajectory that something was done to."""
        shutil.copytree(self.dir / "run", self.dir / what)
        return self.dir / what / "trajectory.h5"

    def refused(self, out, words, name="run"):
        """By verify and by a resume, which leaves all as it is."""
        done = uncross("verify", out, cwd=self.dir)
        self.assertEqual(done.returncode, 9, done.stdout)
        self.assertRegex(done.stdout, f"(?m)^{out}/trajectory.h5: .*{words}")
        before = {p.name: p.read_bytes() for p in (self.dir / out).iterdir()}
        done = self.resume(name, out)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(f"{out}/trajectory.h5: ", done.stderr)
        self.assertIn(words, done.stderr)
        self.assertEqual({p.name: p.read_bytes() for p in (self.dir / out).iterdir()}, before)

    def test_trajectory_of_another_run(self):
        for what, (text, words) in OTHERS.items():
            with self.subTest(what):
                self.run_of(text, f"other-{what}")
                shutil.copy(self.dir / f"other-{what}/trajectory.h5", self.mixed(what))
                self.refused(what, words)

    def test_trajectory_of_nobody(self):
        """It tells neither seed nor scene: another program's."""
        with h5py.File(self.mixed("foreign"), "a") as file:
            del file["parameters"]
        self.refused("foreign", "not one of this program")

    def test_a_resume_with_other_observables_is_the_same_run(self):
        """Steps, cadences and observables are no part of what a run is."""
        (self.dir / "run.yaml").write_text(SCENE.replace("every: 10}\n", "every: 5}\n") + "checkpoint: {seconds: 100}\n")
        done = self.resume("run", "run")
        self.assertEqual(done.returncode, 0, done.stderr)
        done = uncross("verify", "run", cwd=self.dir)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_trajectory_is_not_asked_for_any_more(self):
        """Also then it is one of the run's files."""
        (self.dir / "run.yaml").write_text(SCENE.replace("trajectory: {every: 10}\n", ""))
        self.assertEqual(self.resume("run", "run").returncode, 0)
        self.assertEqual(uncross("verify", "run", cwd=self.dir).returncode, 0)
        self.run_of(OTHERS["seed"][0], "other")
        shutil.copy(self.dir / "other/trajectory.h5", self.dir / "run")
        done = uncross("verify", "run", cwd=self.dir)
        self.assertEqual(done.returncode, 9, done.stdout)

    def test_records_that_contradict_the_checkpoint(self):
        """At step 20, finished. A record is written after its checkpoint: it may be older, but not newer."""
        path = self.dir / "run/run.json"
        told = json.loads(path.read_text())
        other = told["scene"].replace("mass: 2", "mass: 3")
        self.assertNotEqual(other, told["scene"])
        older = {**told, "status": "running", "steps": 10, "state_hash": "0" * 16, "state_digest": "0" * 16}
        for record, words in (
                ([], "no record of a run"), ({}, "no record of a run"),
                ({**told, "status": "finnished"}, "its status is 'finnished'"),
                ({**told, "seed": "5"}, "seed is 5, in the checkpoint 1"),
                ({**told, "stream": "5"}, "stream is 5, in the checkpoint 1"),
                ({**told, "scene_fingerprint": "0" * 16}, "scene_fingerprint is 0000000000000000, in the checkpoint " + told["scene_fingerprint"]),
                ({**told, "state_digest": "0" * 16}, "state_digest is 0000000000000000, in the checkpoint " + told["state_digest"]),
                ({**told, "scene": other}, "its scene is another one"),
                ({**told, "scene": "nothing"}, "its scene is another one"),
                ({**told, "steps": 21}, "steps are 21, in the checkpoint 20"),
                ({**told, "steps": 10, "state_hash": "0" * 16, "state_digest": "0" * 16}, "is of a finished run of 10 steps"),
                ({k: v for k, v in told.items() if k != "stream"}, "it says no stream"),
                (older, None), (told, None)):
            with self.subTest(words=words):
                path.write_text(json.dumps(record))
                done = uncross("verify", "run", cwd=self.dir)
                self.assertEqual(done.returncode, 9 if words else 0, done.stdout)
                self.assertRegex(done.stdout, f"(?m)^run/run.json: damaged: .*{words}" if words else "run.json: readable")

    def test_files_of_the_user(self):
        """Whatever else is in the folder is none of the run's files."""
        (self.dir / "run/notes.csv").write_text("hello\n")
        (self.dir / "run/my-plot.csv").write_text("a,b\n1,2\n3")
        (self.dir / "run/statics-x.csv").write_text("kind?\n")
        (self.dir / "run/statics.csv").write_text("none of this run\n")
        done = uncross("verify", "run", cwd=self.dir)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertEqual(done.stdout.count(".csv"), 1, done.stdout)
        (self.dir / "run/conserved.csv").write_text("hello\n")
        self.assertEqual(uncross("verify", "run", cwd=self.dir).returncode, 9)


if __name__ == "__main__":
    unittest.main()
