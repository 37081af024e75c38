#!/usr/bin/python3
"""The head of `uncross check`: how long a run is beside what it has to last, and what it writes. Files of a real run are the
measure of what it says it would write; its tau_r is that of the rows below."""
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import FolderTest, uncross  # noqa: E402

SCENE = """box: [8, 8, 8]
time_step: 0.01
steps: 400
solvent: {per_cell: 5, collision_interval: 0.02}
fibers: [{name: rod, count: 40, vertices: 12, mass: 5, bond_length: 0.5, spring: 100, persistence_length: 50}]
observe: {dynamics: {every: 1, longest_lag: 100}, statics: {every: 10}}
trajectory: {every: 4, velocities: true}
"""


class Head(FolderTest):
    def head(self, text):
        (self.dir / "scene.yaml").write_text(text)
        done = uncross("check", self.dir / "scene.yaml")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = []
        for line in done.stdout.splitlines():
            if not line.startswith("#"):
                break
            lines.append(line)
        return " ".join(lines), done.stdout

    def test_how_long_it_must_be(self):
        head, told = self.head(SCENE)
        tau = float(re.search(r"rotational relaxation, stiff +tau_r +(\S+) t0", told)[1])
        self.assertIn(f"It lasts 4 t0. The slowest time known is that in which a fiber turns of 'rod', {tau:.4g} t0: averages still show the start", head)
        steps = int(re.search(r"steps: (\d+) is that long", head)[1])
        self.assertAlmostEqual(steps * 0.01 / tau, 1.0, delta=1e-4)
        head, _ = self.head(SCENE.replace("steps: 400", "steps: 100000000"))
        self.assertNotIn("still show", head)
        self.assertIn("in which a fiber turns", head)
        head, _ = self.head(SCENE.replace("solvent: {", "walls: {kind: no-slip}\nsolvent: {acceleration: [0.001, 0, 0], thermostat: maxwell-boltzmann, ").partition("fibers")[0])
        self.assertIn("in which the flow becomes steady", head)

    def size(self, head, what):
        found = re.search(rf"([\d.e+]+) (MB|GB) of {what}", head)
        return float(found[1]) * {"MB": 1e6, "GB": 1e9}[found[2]]

    def test_what_it_writes(self):
        head, _ = self.head(SCENE)
        self.assertEqual(uncross("run", self.dir / "scene.yaml", "--out", self.dir / "run", "--quiet").returncode, 0)
        for what in ("checkpoint", "trajectory"):
            real = (self.dir / "run" / f"{what}.h5").stat().st_size
            self.assertLess(self.size(head, what), 1.1 * real, what)
            self.assertGreater(self.size(head, what), 0.4 * real, what)

    def test_memory_of_observables(self):
        """A checkpoint holds what they keep, and memory holds it before: here more than all else."""
        head, told = self.head(SCENE.replace("statics: {every: 10}", "profile: {every: 1, slabs: 4096}"))
        self.assertEqual(uncross("run", self.dir / "scene.yaml", "--out", self.dir / "run", "--steps", "0", "--quiet").returncode, 0)
        real = (self.dir / "run" / "checkpoint.h5").stat().st_size
        memory = float(re.search(r"^  memory +(\S+) MiB", told, re.M)[1]) * 2**20
        most = float(re.search(r"^  ... while a checkpoint is written +(\S+) MiB", told, re.M)[1]) * 2**20
        self.assertGreater(memory, 0.95 * real)
        self.assertGreater(most, 3 * real)
        self.assertAlmostEqual(self.size(head, "checkpoint") / real, 1.0, delta=0.05)
        self.assertIn("that for observables", head)


if __name__ == "__main__":
    unittest.main()
