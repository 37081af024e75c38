"""Threads of a host that use HDF5 at the same time, by h5py or by other runs: the library reads its files all the same.

Needs BUILD, the build folder, with the libraries in it, and UNCROSS.
"""
import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import BUILD, TOP, FolderTest, uncross  # noqa: E402

BEGIN = """import os, sys, threading
import h5py, numpy
import uncross
SCENE = {"box": [4, 4, 4], "time_step": 0.01, "steps": 40, "seed": 2, "trajectory": {"every": 2},
         "solvent": {"per_cell": 4, "collision_interval": 0.02},
         "fibers": [{"name": "a", "count": 2, "vertices": 4, "mass": 5, "bond_length": 0.5, "spring": 100}],
         "observe": {"conserved": {"every": 1}, "dynamics": {"every": 2}}}
"""
# Other threads are within HDF5 most of the time.
BUSY = """
def busy(name):
    with h5py.File(name, "w") as file:
        file["a"] = numpy.zeros((400, 400))
        while not over:
            file["a"][...] = file["a"][...] + 1

over = []
threads = [threading.Thread(target=busy, args=(f"{k}.h5",)) for k in range(3)]
for thread in threads:
    thread.start()
try:
    for k in range(8):
        run = uncross.Run(SCENE, resume="saved.h5")
        assert run.step == 5
        run.save("saved.h5")
finally:
    over.append(True)
"""
# Four runs at a time, each saved and resumed, and one after the other.
MANY = """
hashes = {}

def work(name, seed):
    with uncross.FolderRun(SCENE, name, seed=seed) as run:
        run.advance(20)
    with uncross.FolderRun(SCENE, name, seed=seed, resume=True) as run:
        hashes[name] = run.advance().hash

threads = [threading.Thread(target=work, args=(f"at-once-{k}", k)) for k in range(4)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
for k in range(4):
    work(f"alone-{k}", k)
    assert hashes[f"alone-{k}"] == hashes[f"at-once-{k}"], k
"""
# The process that writes a trajectory looks at it by h5py, between frames and while another thread writes frames.
OWN = """
with uncross.FolderRun(SCENE, "run") as run:
    run.advance(10)
    with h5py.File("run/trajectory.h5") as file:
        assert list(file["particles/trajectory/position/step"]) == [0, 2, 4, 6, 8, 10]
    thread = threading.Thread(target=run.advance, args=(20,))
    thread.start()
    while thread.is_alive():
        try:
            with h5py.File("run/trajectory.h5") as file:
                assert len(file["particles/trajectory/position/value"]) >= 6
        except BlockingIOError:  # a frame is being written
            pass
    thread.join()
    with h5py.File("run/trajectory.h5") as file:
        assert len(file["particles/trajectory/position/value"]) == 16
"""


class Threads(FolderTest):
    def run_script(self, text):
        (self.dir / "script.py").write_text(BEGIN + text)
        settings = dict(os.environ, PYTHONPATH=str(TOP / "python"), UNCROSS_LIBRARY=str(BUILD / "lib/libuncross.so"))
        done = subprocess.run([sys.executable, "script.py"], cwd=self.dir, env=settings, capture_output=True, text=True,
                              timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_lock_of_hdf5_in_another_thread(self):
        self.run_script('uncross.Run(SCENE).advance(5).save("saved.h5")')
        for _ in range(2):
            self.run_script(BUSY)

    def test_the_own_trajectory(self):
        self.run_script(OWN)
        self.assertEqual(uncross("verify", self.dir / "run").returncode, 0)

    def test_runs_in_many_threads(self):
        self.run_script(MANY)
        for name in "conserved.csv", "dynamics-a.csv", "trajectory.h5":
            for k in range(4):
                self.assertEqual((self.dir / f"alone-{k}" / name).read_bytes(), (self.dir / f"at-once-{k}" / name).read_bytes())


if __name__ == "__main__":
    unittest.main()
