#!/usr/bin/python3
"""The head of `uncross check`: how long a run is beside what it has to last, and what it writes. Files of a real run are the
measure of what it says it would write; its tau_r is that of the rows below."""
import os
import pathlib
import re
import resource
import shutil
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, FolderTest, uncross  # noqa: E402

SCENE = """box: [8, 8, 8]
time_step: 0.01
steps: 400
solvent: {per_cell: 5, collision_interval: 0.02}
fibers: [{name: rod, count: 40, vertices: 12, mass: 5, bond_length: 0.5, spring: 100, persistence_length: 50}]
observe: {dynamics: {every: 1, longest_lag: 100}, statics: {every: 10}}
trajectory: {every: 4, velocities: true}
"""
BROWNIAN = """box: [40, 40, 40]
time_step: 0.001
steps: {steps}
medium: {{kind: overdamped, rate: 10, tensor: {tensor}{more}}}
fibers: [{{name: a, count: {count}, vertices: {vertices}, mass: 1, {bonds}}}]
crossing: {{forbidden: false}}
"""
FREE, HELD = "bond_length: 0, spring: 3", "bond_length: 0.5, spring: 100, bending: 20"
TUBES = """box: [3, 3, 3]
time_step: 0.01
steps: 1
solvent: {{per_cell: 3, collision_interval: 0.02}}
fibers: [{{name: tube, count: {count}, vertices: 2, mass: 1, bond_length: 0.5, spring: 100, diameter: 0.5}}]
"""


COUNTS = TOP / "tests/counts"


class Head(FolderTest):
    def test_time_goes_with_counted_instructions(self):
        """What a particle takes in a step, over its instructions (tests/counts/baseline.txt, counted by callgrind): one number
        in all fluids, within a factor of 2 of 0.2 ns, for scenes with next to no vertices."""
        counted = dict(re.findall(r"^(\S+) +step_advance +particle +(\S+)$", (COUNTS / "baseline.txt").read_text(), re.M))
        for name in ("solvent", "at-a", "at-plus-a", "couette", "shear", "dumbbells", "pairs", "dpd"):
            told = uncross("check", COUNTS / f"{name}.yaml").stdout
            with self.subTest(name=name):
                said = float(re.search(r"from (\S+) ns per solvent particle", told)[1])
                self.assertTrue(0.1 < said / float(counted[name]) < 0.4, (said, counted[name]))

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
            self.assertAlmostEqual(self.size(head, what) / real, 1.0, delta=0.1, msg=what)

    def test_files_of_any_shape(self):
        """One bead and one frame; few vertices and many frames; more than a chunk in a frame, with the solvent; vertices alone; mostly
        solvent. Room is taken in whole chunks, and a checkpoint has masses and bonds beside the state."""
        fibers, frames = "count: 40, vertices: 12", "every: 4, velocities: true"
        for count, vertices, every, more, steps in ((1, 1, 8, "", 8), (2, 4, 1, "", 3000), (400, 12, 1, ", solvent: true", 4),
                                                    (1000, 12, 2, "", 4), (1, 4, 1, ", velocities: true, solvent: true", 20)):
            text = SCENE.replace(fibers, f"count: {count}, vertices: {vertices}").replace(frames, f"every: {every}{more}")
            head, _ = self.head(text.replace("steps: 400", f"steps: {steps}").replace("dynamics: {every: 1, longest_lag: 100}, ", ""))
            done = uncross("run", self.dir / "scene.yaml", "--out", self.dir / "run", "--quiet")
            self.assertEqual(done.returncode, 0, done.stderr)
            for what in ("checkpoint", "trajectory"):
                real = (self.dir / "run" / f"{what}.h5").stat().st_size
                self.assertAlmostEqual(self.size(head, what) / real, 1.0, delta=0.1, msg=f"{what} of {count} x {vertices}")
            shutil.rmtree(self.dir / "run")

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

    def cost(self, vertices, count=1, steps=1000000, tensor="rpy, radius: 0.25", bonds=FREE, more=""):
        """The scene, and the seconds that `check` foresees for it."""
        text = BROWNIAN.format(vertices=vertices, count=count, steps=steps, tensor=tensor, bonds=bonds, more=more)
        return text, float(re.search(r"^  time +(\S+) s", self.head(text)[1], re.M)[1])

    def test_cost_of_a_tensor_grows_as_its_root(self):
        """The root of 3N rows takes (3N)^3/6 multiplications: 8 times as many for 2N, while all else grows less. Fibers are alone."""
        held = {"bonds": HELD, "more": ", inextensible: true"}
        one = self.cost(256)[1]
        self.assertAlmostEqual(self.cost(512)[1] / one, 8.0, delta=0.5)
        self.assertAlmostEqual(self.cost(256, 10)[1] / one, 10.0, delta=0.1)
        self.assertLess(self.cost(64, tensor="none")[1], self.cost(64)[1] / 10)
        # 16 times as many bonds: the matrix of their tensions grows by 256, its root by 4096.
        ratio = self.cost(4096, tensor="none", **held)[1] / self.cost(256, tensor="none", **held)[1]
        self.assertGreater(ratio, 500)
        self.assertLess(ratio, 4096)
        self.assertGreater(self.cost(256, **held)[1], self.cost(256, tensor="none", **held)[1])

    def test_cost_of_a_tensor_is_that_of_a_run(self):
        """By processor time, within a factor of 10; a program with sanitizers is some ten times as slow."""
        factor = 100 if "ASAN_OPTIONS" in os.environ else 10
        text, foreseen = self.cost(64, count=5, steps=100)
        (self.dir / "scene.yaml").write_text(text)
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        self.assertEqual(uncross("run", self.dir / "scene.yaml", "--out", self.dir / "run", "--quiet").returncode, 0)
        took = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        print(f"# foreseen {foreseen:.3g} s, took {took:.3g} s")
        self.assertLess(foreseen / factor, took)
        self.assertLess(took, factor * foreseen)

    def test_tubes_that_cannot_be_laid(self):
        """500 tubes of 0.17 a0^3 or more (0.1 a cylinder of 0.5, 0.07 its caps) would fill three times the box. A run refuses, and `check` with the same words."""
        for command in (("check",), ("run", "--out", self.dir / "run")):
            (self.dir / "scene.yaml").write_text(TUBES.format(count=500))
            done = uncross(command[0], self.dir / "scene.yaml", *command[1:])
            self.assertEqual(done.returncode, 2, command)
            self.assertRegex(done.stderr, r"scene.yaml:5:\d+: .*fiber \d+ of 500 overlaps with others wherever it is laid, 100000 times; "
                             "allowed: thinner or fewer fibers, a larger box, or start.snapshot")
        self.head(TUBES.format(count=25))


if __name__ == "__main__":
    unittest.main()
