"""What a resume finds in the folder of a run is what the run left there, or it says so."""
import fcntl
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import h5py

UNCROSS = os.environ.get("UNCROSS", "build/uncross")
SCENE = """box: [4, 4, 4]
time_step: 0.01
steps: 40
solvent: {per_cell: 3, collision_interval: 0.02}
fibers:
  - {name: a, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100, bending: 4}
observe:
  conserved: {every: 2}
  statics: {every: 1}
  dynamics: {every: 1, longest_lag: 20}
"""
FRAMES = "trajectory: {every: 10}\n"


class RunFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.run_folder = self.dir / "r"

    def scene(self, text, name="scene.yaml"):
        (self.dir / name).write_text(text)
        return self.dir / name

    def uncross(self, *words, code=0, said=""):
        """What the program says, after its exit code and a part of its words were looked at."""
        done = subprocess.run([UNCROSS, *map(str, words)], capture_output=True, text=True, check=False, timeout=120)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(said, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def run_scene(self, text, *words, folder=None, **expected):
        return self.uncross("run", self.scene(text), "--out", folder or self.run_folder, *words, **expected)

    def contents(self):
        return {path.name: path.read_bytes() for path in self.run_folder.iterdir()}

    def refused(self, text, said, *words, code=2):
        """Nothing in the folder changes."""
        before = self.contents()
        told = self.run_scene(text, *words, code=code, said=said)
        self.assertEqual(self.contents(), before, told)
        return told

    # --- what is resumed is what was

    def test_averages_keep_their_cadence(self):
        text = SCENE.replace(", longest_lag: 20", "")  # else another cadence needs memory of another size
        self.run_scene(text)
        for key, old, new, before, now in (("dynamics.every", "dynamics: {every: 1", "dynamics: {every: 2", 1, 2),
                                           ("dynamics.longest_lag", "dynamics: {", "dynamics: {longest_lag: 21, ", 0, 21),
                                           ("statics.every", "statics: {every: 1}", "statics: {every: 3}", 1, 3)):
            told = self.refused(text.replace(old, new), f"observe.{key}: {now} in the scene, but {before} in the run",
                                "--resume", "--steps", 50)
            self.assertIn("checkpoint.h5", told)
        self.run_scene(text.replace("conserved: {every: 2}", "conserved: {every: 5}"), "--resume", "--steps", 50)
        with h5py.File(self.run_folder / "checkpoint.h5", "a") as file:  # as it was before
            for key in "dynamics.every", "dynamics.longest_lag", "statics.every":
                del file["observers"][key]
        self.run_scene(text, "--resume", "--steps", 60)

    def test_an_observable_that_is_new(self):
        """Its averages would be of a part of the run only, and nothing would say so."""
        self.run_scene(SCENE)
        self.refused(SCENE + "  temperature: {every: 1}\n", "not sampled by this run so far", "--resume", "--steps", 50)
        fewer = SCENE.replace("  statics: {every: 1}\n", "")
        self.run_scene(fewer, "--resume", "--steps", 50)
        self.refused(SCENE, "'statics-reals'", "--resume", "--steps", 60)

    def test_tables_that_end_too_early(self):
        self.run_scene(SCENE)
        table = self.run_folder / "conserved.csv"
        rows = table.read_text()
        for damaged, where in ((rows[:-5], "ends at step 38"), (rows[:rows.rindex("\n20,") + 1], "ends at step 18"),
                               (rows[:20], "is missing or empty"), ("\0" * len(rows), "is missing or empty"),
                               (rows.replace("\n30,", "\n\0\0,"), "ends at step 28")):
            table.write_text(damaged)
            self.refused(SCENE, f"conserved.csv: {where}, but went to step 40", "--resume", "--steps", 50)
        table.unlink()
        self.refused(SCENE, "conserved.csv: is missing or empty, but went to step 40", "--resume", "--steps", 50)
        table.write_text(rows)
        self.run_scene(SCENE, "--resume", "--steps", 50)
        self.assertTrue(table.read_text().startswith(rows))

    def test_a_trajectory_that_ends_too_early(self):
        text, path = SCENE + FRAMES, self.run_folder / "trajectory.h5"
        self.run_scene(text, "--steps", 25)
        earlier = path.read_bytes()
        self.run_scene(text, "--resume")
        path.write_bytes(earlier)
        self.refused(text, "trajectory.h5: ends at step 20, but went to step 40", "--resume", "--steps", 55)
        shutil.copytree(self.run_folder, self.dir / "old")
        path.unlink()
        told = self.run_scene(text, "--resume", "--steps", 45)
        self.assertIn("trajectory.h5: there was none; its frames begin after step 40", told)
        self.run_scene(text, "--resume", "--steps", 55)
        with h5py.File(path) as file:
            self.assertEqual(list(file["particles/trajectory/position/step"]), [50])
        with h5py.File(self.dir / "old/checkpoint.h5", "a") as file:  # as it was before
            del file["head"].attrs["frames_end"]
        self.run_scene(text, "--resume", "--steps", 55, folder=self.dir / "old")

    def test_tables_wait_for_the_trajectory(self):
        """They are not cut before it is known that the run can go on."""
        text, path = SCENE + FRAMES, self.run_folder / "trajectory.h5"
        self.run_scene(text, "--steps", 20)
        earlier = (self.run_folder / "checkpoint.h5").read_bytes()
        self.run_scene(text, "--resume")
        (self.run_folder / "checkpoint.h5").write_bytes(earlier)
        with path.open("rb") as reader:
            fcntl.flock(reader, fcntl.LOCK_SH)
            self.refused(text, "trajectory.h5: in use by another process", "--resume", code=4)
        self.run_scene(text, "--resume")


if __name__ == "__main__":
    unittest.main()
