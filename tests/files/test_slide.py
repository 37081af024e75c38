"""Images of a sheared box slide. A run that starts from a snapshot goes on from where they were.

Without noise a run of N + M steps and a run of M steps from the snapshot at step N are the same motion: positions are
compared modulo the box, whose image beyond y = L has slid by rate L t.
"""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import h5py
import numpy

UNCROSS = os.environ.get("UNCROSS", "build/uncross")
EDGE, RATE, STEP, FIRST, ALL = 6, 0.13, 0.01, 300, 500
SHEARED = f"box: [{EDGE}, {EDGE}, {EDGE}]\ntime_step: {STEP}\nshear: {{rate: {RATE}}}\n" \
          "trajectory: {every: 100, solvent: true, velocities: true}\n"
# No bath and no solvent: only contacts, most of them across the faces.
FIBERS = SHEARED + "crossing: {rule: event-driven}\n" \
                   "fibers: [{name: a, count: 24, vertices: 4, mass: 1, bond_length: 1, spring: 20}]\n"
# Solvent that never collides.
SOLVENT = SHEARED + "solvent: {per_cell: 1, collision_interval: 10}\n"


def slide(steps):
    """Of the image beyond y = L, a0."""
    return RATE * EDGE * STEP * steps


def apart(one, other, steps):
    """The largest distance of two frames along an axis, modulo the box of this step."""
    d = one - other
    image = numpy.rint(d[:, 1] / EDGE)
    d[:, 0] -= image * slide(steps)
    d[:, 1] -= image * EDGE
    d -= numpy.rint(d / EDGE) * EDGE
    return numpy.abs(d).max()


class Slide(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def call(self, *arguments, code=0):
        done = subprocess.run([UNCROSS, *arguments], capture_output=True, text=True, check=False, timeout=120, cwd=self.dir)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def run_to(self, text, steps, out, snapshot=None, *options):
        start = f"start: {{snapshot: {snapshot}}}\n" if snapshot else ""
        (self.dir / f"{out}.yaml").write_text(f"{text}steps: {steps}\n{start}")
        return self.call("run", f"{out}.yaml", "--out", out, *options)

    def frame(self, out):
        """The last one: positions, velocities."""
        with h5py.File(self.dir / out / "trajectory.h5") as file:
            group = file["particles/trajectory"]
            return group["position/value"][-1], group["velocity/value"][-1]

    def same_motion(self, text, rounding):
        """A run as a whole, against its second part from a checkpoint, and from a frame."""
        self.run_to(text, ALL, "whole")
        self.run_to(text, FIRST, "first")
        place, velocity = self.frame("whole")
        self.assertGreater(abs(slide(ALL) % EDGE - slide(ALL - FIRST) % EDGE), 1)  # else nothing would be seen
        for snapshot in ("checkpoint", "trajectory"):
            with self.subTest(snapshot=snapshot):
                done = self.run_to(text, ALL - FIRST, f"of-{snapshot}", f"first/{snapshot}.h5")
                its_place, its_velocity = self.frame(f"of-{snapshot}")
                self.assertLessEqual(apart(its_place, place, ALL), rounding)
                # a fiber that is shown by another image has that image's velocity
                image = numpy.rint((its_place[:, 1] - place[:, 1]) / EDGE)
                its_velocity[:, 0] -= image * RATE * EDGE
                self.assertLessEqual(numpy.abs(its_velocity - velocity).max(), rounding)
                self.assertNotIn("slide", done.stderr)

    def test_fibers_meet_the_same_partners(self):
        """Each position and velocity is taken on as it is, so the motion is the same to the bit, but for images."""
        self.same_motion(FIBERS, 1e-9)
        contacts = json.loads((self.dir / "whole/run.json").read_text())
        self.assertGreater(contacts["collisions"]["executed"], 20)

    def test_solvent_comes_back_at_the_same_places(self):
        """Free flight, rounded to 2^-40 a0 once more."""
        self.same_motion(SOLVENT, 1e-10)

    def test_snapshot_of_a_snapshot_and_resume(self):
        self.run_to(FIBERS, ALL, "whole")
        self.run_to(FIBERS, 200, "first")
        self.run_to(FIBERS, 100, "second", "first/checkpoint.h5")
        self.call("run", "second.yaml", "--out", "second", "--resume", "--steps", "200")
        self.run_to(FIBERS, 100, "third", "second/checkpoint.h5")
        self.assertLessEqual(apart(self.frame("third")[0], self.frame("whole")[0], ALL), 1e-9)

    def test_export_knows_where_the_images_are(self):
        self.run_to(FIBERS, FIRST, "first")
        self.run_to(FIBERS, ALL - FIRST, "second", "first/checkpoint.h5")
        for file in ("trajectory", "checkpoint"):
            text = self.call("export", f"second/{file}.h5").stdout
            cell = [float(x) for x in text[text.rindex('Lattice="') + 9:].split('"')[0].split()]
            leans = slide(ALL) - EDGE * round(slide(ALL) / EDGE)
            numpy.testing.assert_allclose(cell, [EDGE, 0, 0, leans, EDGE, 0, 0, 0, EDGE], rtol=0, atol=1e-9)

    def test_packs_do_not_know_a_slide(self):
        """A port derives it from the time, which begins at 0."""
        self.run_to(SOLVENT, FIRST, "first")
        self.run_to(SOLVENT.replace("interval: 10", "interval: 0.1"), 10, "second", "first/checkpoint.h5")
        for what in ("start", "trace", "emit"):
            said = self.call("oracle", what, "second.yaml", "--out", what, code=2).stderr
            self.assertIn("start.snapshot: the images of its sheared box have slid", said)


if __name__ == "__main__":
    unittest.main()
