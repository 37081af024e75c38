"""A process that forks while a run is open: the run stays the parent's, whatever the child does and however it ends.

Needs BUILD, the build folder, with the libraries in it, and UNCROSS.
"""
import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import BUILD, TOP, FolderTest, uncross  # noqa: E402

BEGIN = """import multiprocessing, os, sys
import uncross
SCENE = {"box": [4, 4, 4], "time_step": 0.01, "steps": 40, "seed": 2, "trajectory": {"every": 2},
         "solvent": {"per_cell": 4, "collision_interval": 0.02},
         "fibers": [{"name": "a", "count": 2, "vertices": 4, "mass": 5, "bond_length": 0.5, "spring": 100}],
         "observe": {"conserved": {"every": 1}, "temperature": {"every": 2}, "dynamics": {"every": 2}}}
"""

# Each has a run of 40 steps in the folder `run`; a child is there between steps 7 and 30, and ends after step 20.
PLAIN = """
with uncross.FolderRun(SCENE, "run") as run:
    run.advance()
"""
FORK = """
reading, writing = os.pipe()
with uncross.FolderRun(SCENE, "run") as run:
    run.advance(7)
    child = os.fork()
    if child == 0:
        os.read(reading, 1)
        %s
    run.advance(13)
    os.write(writing, b".")
    assert os.waitpid(child, 0)[1] == 0
    run.advance()
"""
POOL = """
def work(k):
    return k * k

with uncross.FolderRun(SCENE, "run") as run:
    run.advance(7)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        run.advance(13)
        assert pool.map(work, range(4)) == [0, 1, 4, 9]
    run.advance()
"""
# The child lives on, and has copies of all that the parent had open, while the parent closes its run and goes on with it.
LIVES = """
reading, writing = os.pipe()
with uncross.FolderRun(SCENE, "run") as run:
    run.advance(20)
    child = os.fork()
    if child == 0:
        os.close(writing)
        os.read(reading, 1)
        os._exit(0)
with uncross.FolderRun(SCENE, "run", resume=True) as run:
    run.advance()
os.close(writing)
assert os.waitpid(child, 0)[1] == 0
"""
STUBBORN = """
        for act in (lambda: run.advance(3), run.save):
            try:
                act()
                os._exit(1)
            except uncross.Error as error:
                if "forked" not in str(error):
                    os._exit(2)
        run.close()
        del run
        sys.exit(0)
"""
WAYS = {"sys.exit": FORK % "sys.exit(0)", "os._exit": FORK % "os._exit(0)", "close": FORK % "run.close(); sys.exit(0)",
        "exec": FORK % 'os.execvp("true", ["true"])', "stubborn": FORK % STUBBORN.strip(), "pool": POOL, "lives": LIVES}


class Fork(FolderTest):
    def run_script(self, name, text):
        folder = self.dir / name
        folder.mkdir()
        (folder / "script.py").write_text(BEGIN + text)
        settings = dict(os.environ, PYTHONPATH=str(TOP / "python"), UNCROSS_LIBRARY=str(BUILD / "lib/libuncross.so"))
        done = subprocess.run([sys.executable, "script.py"], cwd=folder, env=settings, capture_output=True, text=True,
                              timeout=60, check=False)
        self.assertEqual(done.returncode, 0, f"{name}: {done.stderr}")
        return {path.name: path.read_bytes() for path in (folder / "run").iterdir() if path.name not in ("run.json", "checkpoint.h5")}

    def test_children_leave_the_run_alone(self):
        plain = self.run_script("plain", PLAIN)
        self.assertEqual(len(plain), 4)
        for name, text in WAYS.items():
            made = self.run_script(name, text)
            self.assertEqual([file for file in plain if made.get(file) != plain[file]], [], name)
            self.assertEqual(uncross("verify", self.dir / name / "run").returncode, 0, name)


if __name__ == "__main__":
    unittest.main()
