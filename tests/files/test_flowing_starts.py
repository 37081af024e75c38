"""A run may begin with a state of itself, whatever flows in it; with a foreign flow it may not.

In a sheared box the momentum of the laboratory fluctuates by rate M <y - L/2>, since images hand momentum on. That about
the linear flow does not. What a message advises is taken.
"""
import os
import pathlib
import re
import resource
import subprocess
import tempfile
import unittest

import h5py
import numpy

UNCROSS = os.environ.get("UNCROSS", "build/uncross")
SRD = "solvent: {per_cell: 3, collision_interval: 0.02, rule: at-a}\n"
CHAINS = "fibers: [{name: a, count: 20, vertices: 6, mass: 5, bond_length: 0.5, spring: 100, bending: 4}]\ncrossing: {forbidden: false}\n"
FRAMES = "time_step: 0.02\ntrajectory: {every: 65, solvent: true, velocities: true}\n"
TALL = "box: [4, 40, 4]\n" + FRAMES
CUBE = "box: [6, 6, 6]\n" + FRAMES
NUMBERS = re.compile(r"moves at (\[[-+0-9.e, ]+\]) a0/t0")


class Starts(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def run_of(self, text, out, steps):
        (self.dir / f"{out}.yaml").write_text(f"{text}steps: {steps}\n")
        done = subprocess.run([UNCROSS, "run", f"{out}.yaml", "--out", out], capture_output=True, text=True, check=False,
                              timeout=120, cwd=self.dir)
        return done.returncode, done.stderr

    def made(self, text, out, steps):
        code, said = self.run_of(text, out, steps)
        self.assertEqual(code, 0, said)

    def test_own_states(self):
        """A run's checkpoint and its frame start the same scene."""
        scenes = {"shear": TALL + SRD + "shear: {rate: 1}\n",
                  "shear and a flow": TALL + SRD + "shear: {rate: 1}\nflow: [0.3, 0, -0.1]\n",
                  "shear of fibers": "box: [8, 8, 8]\n" + FRAMES + CHAINS + "shear: {rate: -1.3}\n",
                  "shear of both": TALL + SRD + CHAINS + "shear: {rate: 1.5}\n",
                  "shear to and fro": TALL + SRD + "shear: {rate: 1, period: 1.6}\nflow: [0.2, 0, 0]\n",
                  "poiseuille": CUBE + SRD + "solvent: {per_cell: 3, collision_interval: 0.02, acceleration: [0.2, 0, 0]}\n"
                                             "walls: {kind: no-slip}\n",
                  "couette": CUBE + SRD + CHAINS + "walls: {kind: no-slip, shear_rate: 0.2}\nflow: [0.3, 0, 0]\n",
                  "slip walls": CUBE + SRD + "walls: {kind: slip}\nflow: [0.4, 0, 0.1]\n",
                  "frozen fibers": CUBE + SRD + CHAINS.replace("count: 20", "count: 2, frozen: true")}
        scenes["poiseuille"] = scenes["poiseuille"].replace(SRD, "")
        for number, (name, scene) in enumerate(scenes.items()):
            self.made(scene, f"of-{number}", 130)
            for file in ("checkpoint", "trajectory"):
                with self.subTest(scene=name, file=file):
                    self.made(f"{scene}start: {{snapshot: of-{number}/{file}.h5}}\n", f"again-{number}-{file}", 3)

    def foreign(self, out, flow, shear=0.0):
        """The last frame of a run, written by another program, with another velocity of everything. The velocity about
        the linear flow of its center of mass before that."""
        with h5py.File(self.dir / out / "trajectory.h5") as own, h5py.File(self.dir / f"{out}.h5", "w") as file:
            group = own["particles/trajectory"]
            place, velocity = group["position/value"][-1], group["velocity/value"][-1]
            file["particles/all/position/value"] = place[None]
            file["particles/all/velocity/value"] = (velocity + flow)[None]
            file["particles/all/box/edges"] = group["box/edges/value"][-1]
            velocity[:, 0] -= shear * (place[:, 1] - 20)
            return velocity.mean(axis=0)

    def test_foreign_flows(self):
        """They are refused by their velocity about the linear flow, which is that to write."""
        shear = "shear: {rate: 1}\n"
        for number, (name, scene, rate, flow) in enumerate([("rest", CUBE + SRD, 0, [0.5, 0.2, 0.3]), ("shear", TALL + SRD + shear, 1, [0.5, 0, 0.3]),
                                                            ("slip", CUBE + SRD + "walls: {kind: slip}\n", 0, [0.5, 0, 0.3])]):
            with self.subTest(name):
                self.made(scene, f"of-{number}", 130)
                before = self.foreign(f"of-{number}", flow, rate)
                self.assertLess(numpy.abs(before[[0, 2]]).max(), 1e-9)  # the run is at rest but for its flow
                again = scene + f"start: {{snapshot: of-{number}.h5}}\n"
                code, said = self.run_of(again, f"again-{number}", 3)
                self.assertEqual(code, 2, said)
                words = NUMBERS.search(said)
                self.assertIsNotNone(words, said)
                numpy.testing.assert_allclose([float(word) for word in words[1][1:-1].split(",")], flow, rtol=0, atol=1e-8)
                self.assertIn("allowed: that one", said)
                self.made(f"{again}flow: {words[1]}\n", f"as-said-{number}", 3)

    def test_no_advice_that_is_refused(self):
        """Across shear nothing may flow: no flow is advised then."""
        scene = TALL + SRD + "shear: {rate: 1}\n"
        self.made(scene, "first", 10)
        self.foreign("first", [0, 0.5, 0])
        code, said = self.run_of(scene + "start: {snapshot: first.h5}\n", "again", 3)
        self.assertEqual(code, 2, said)
        self.assertRegex(said, "moves at .*no scene starts from it")
        self.assertNotIn("that one", said)

    def test_beyond_all_sums(self):
        """A velocity that no sum holds is told, without a number that is none."""
        self.made(CUBE + SRD, "first", 10)
        speed = numpy.zeros((648, 3))
        speed[17, 2] = 1e6
        self.foreign("first", speed)
        code, said = self.run_of(CUBE + SRD + "start: {snapshot: first.h5}\n", "again", 3)
        self.assertEqual(code, 2, said)
        self.assertNotIn("nan", said)
        self.assertRegex(said, "solvent particle 17 of 'first.h5' moves at 999999.* a0/t0 along z, beyond what can be summed; allowed: below 131072")


if __name__ == "__main__":
    # Each run takes a fraction of a second.
    resource.setrlimit(resource.RLIMIT_CPU, (60, 60))
    unittest.main()
