#!/usr/bin/python3
"""The notebook of examples/python, run on a small run with rods, rings, beads and a solvent."""
import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, FolderTest, uncross  # noqa: E402

NOTEBOOK = TOP / "examples/python/look_at_a_run.ipynb"
SCENE = """box: [8, 8, 8]
time_step: 0.01
steps: 200
seed: 1
solvent: {per_cell: 5, collision_interval: 0.02}
fibers:
  - {name: rod, count: 4, vertices: 8, mass: 5, bond_length: 0.5, spring: 100, bending: 40}
  - {name: ring, count: 2, vertices: 8, mass: 5, ring: true, bond_length: 0.5, spring: 100, bending: 3}
  - {name: bead, count: 3, vertices: 1, mass: 5, bond_length: 0, spring: 1}
observe: {conserved: {every: 10}, statics: {every: 2}, dynamics: {every: 2}}
trajectory: {every: 20, solvent: true}
"""


class Notebook(FolderTest):
    def test_is_committed_without_results(self):
        for cell in json.loads(NOTEBOOK.read_text(encoding="utf-8"))["cells"]:
            self.assertFalse(cell.get("outputs"))
            self.assertIsNone(cell.get("execution_count"))

    def test_runs(self):
        if not shutil.which("jupyter-nbconvert"):
            self.skipTest("no jupyter-nbconvert (tools/install-dependencies readers)")
        folder = self.dir
        (folder / "scene.yaml").write_text(SCENE)
        uncross("run", "scene.yaml", "--out", "run1", "--quiet", cwd=folder, check=True)
        shutil.copy(NOTEBOOK, folder)
        environment = {**os.environ, "PATH": "/usr/bin:" + os.environ["PATH"], "HOME": str(folder)}
        environment.pop("MPLBACKEND", None)
        done = subprocess.run(["jupyter-nbconvert", "--to", "notebook", "--execute", "--output", "done.ipynb",
                               "--ExecutePreprocessor.shutdown_kernel=immediate", NOTEBOOK.name], cwd=folder, env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        cells = json.loads((folder / "done.ipynb").read_text())["cells"]
        outputs = [output for cell in cells for output in cell.get("outputs", [])]
        said = "".join("".join(output["text"]) for output in outputs if output["output_type"] == "stream"
                       and output["name"] == "stdout")
        self.assertEqual(sum("image/png" in output.get("data", {}) for output in outputs), 3)
        self.assertEqual([output["text"] for output in outputs if output.get("name") == "stderr"], [])
        run = json.loads((folder / "run1/run.json").read_text())
        self.assertIn(run["state_hash"], said)
        with open(folder / "run1/statics-ring.csv", encoding="utf-8") as file:
            row = next(csv.DictReader(file))
        shape = re.search(r"\nring\n  l +(\S+) \+- (\S+)\n", said)
        self.assertAlmostEqual(float(shape[1]), float(row["l"]), 4)


if __name__ == "__main__":
    unittest.main()
