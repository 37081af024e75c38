"""Snapshots that no scene may start from."""
import os
import pathlib
import subprocess
import tempfile
import unittest

import h5py
import numpy

UNCROSS = os.environ.get("UNCROSS", "build/uncross")
SCENE = """box: [4, 4, 4]
time_step: 0.01
steps: 4
solvent: {per_cell: 3, collision_interval: 0.02}
trajectory: {every: 4, solvent: true, velocities: true}
"""


class Snapshot(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def start(self, text, out):
        """Exit code and words of a run."""
        (self.dir / "scene.yaml").write_text(text)
        done = subprocess.run([UNCROSS, "run", self.dir / "scene.yaml", "--out", self.dir / out], capture_output=True,
                              text=True, check=False, timeout=120)
        return done.returncode, done.stderr

    def test_a_flow_that_no_scene_may_have(self):
        """A way out is named only if it is one."""
        self.assertEqual(self.start(SCENE, "first")[0], 0)
        from_it = SCENE + "start: {snapshot: first/trajectory.h5}\n"
        for speed, words in ((50, "; allowed: that one"), (150, "; no scene starts from it (a flow is at most 100")):
            with h5py.File(self.dir / "first/trajectory.h5", "a") as file:
                velocity = file["particles/trajectory/velocity/value"]
                velocity[:, :, 0] = velocity[:, :, 0] - velocity[-1, :, 0].mean() + speed
                if "checksum" in file["parameters/uncross"]:  # as a file of version 1 has none
                    del file["parameters/uncross/checksum"]
                    file["parameters/uncross"].attrs.modify("format_version", numpy.int32(1))
            code, said = self.start(from_it, "second")
            self.assertEqual(code, 2, said)
            self.assertIn(f"moves at [{speed}, ", said)
            self.assertIn(words, said)
            self.assertFalse((self.dir / "second").exists())
        code, said = self.start(from_it + "flow: [150, 0, 0]\n", "second")
        self.assertIn("'150' is out of range", said)


if __name__ == "__main__":
    unittest.main()
