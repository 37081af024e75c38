"""A trajectory is read while its run goes on: by h5py as it is, and by this program. Needs UNCROSS."""
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import UNCROSS, FolderTest, uncross  # noqa: E402

SCENE = """box: [6, 6, 6]
time_step: 0.01
steps: 100000000
seed: 1
solvent: {per_cell: 5, collision_interval: 0.02}
fibers:
  - {name: a, count: 4, vertices: 5, mass: 5, bond_length: 0.5, spring: 100}
trajectory: {every: 500, velocities: true}
"""
POSITION = "particles/trajectory/position"


def opened(path):
    """The file; a frame that is just written locks it for a moment."""
    for _ in range(200):
        try:
            return h5py.File(path, "r")
        except BlockingIOError:
            time.sleep(0.01)
    raise TimeoutError(path)


def read(path):
    """(steps, positions)"""
    with opened(path) as file:
        return file[POSITION]["step"][:], file[POSITION]["value"][:]


class Growing(FolderTest):
    def setUp(self):
        super().setUp()
        os.environ.pop("HDF5_USE_FILE_LOCKING", None)
        (self.dir / "s.yaml").write_text(SCENE)
        self.path = self.dir / "run/trajectory.h5"
        self.run_process = subprocess.Popen([UNCROSS, "run", "s.yaml", "--out", "run", "--quiet"], cwd=self.dir)
        self.addCleanup(self.run_process.kill)
        give_up = time.monotonic() + 60
        while not (self.dir / "run/run.json").exists() and time.monotonic() < give_up:
            time.sleep(0.02)

    def test_it_is_read_as_it_grows(self):
        ends = []
        for _ in range(12):
            steps, positions = read(self.path)
            self.assertEqual(list(steps), list(range(0, 500 * len(steps), 500)))
            self.assertTrue(numpy.isfinite(positions).all() and (abs(positions).sum(axis=(1, 2)) > 0).all())
            ends.append(len(steps))
            time.sleep(0.05)
        self.assertGreater(ends[-1], ends[0])
        for words in ("info", self.path), ("export", self.path, "--out", self.dir / "frames.xyz"), ("verify", self.path):
            self.assertEqual(uncross(*words).returncode, 0, words)
        self.finish()

    def test_a_reader_that_stays_does_not_stop_it(self):
        with opened(self.path) as file:
            before = len(file[POSITION]["step"])
            time.sleep(2.5)
        give_up = time.monotonic() + 60  # on a busy machine
        while len(read(self.path)[0]) <= before + 2 and time.monotonic() < give_up:
            time.sleep(0.1)
        self.assertGreater(len(read(self.path)[0]), before + 2)
        self.finish()

    def finish(self):
        self.run_process.send_signal(signal.SIGTERM)
        self.assertEqual(self.run_process.wait(60), 5)
        self.assertEqual(uncross("verify", self.dir / "run").returncode, 0)


if __name__ == "__main__":
    unittest.main()
