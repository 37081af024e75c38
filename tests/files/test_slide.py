"""Images of a sheared box slide. A run that starts from a snapshot goes on from where they were.

Without noise a run of N + M steps and a run of M steps from the snapshot at step N are the same motion: positions are
compared modulo the box, whose image beyond y = L has slid by rate L t.
"""
import json
import os
import pathlib
import resource
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

    def call(self, *arguments, code=0, **more):
        done = subprocess.run([UNCROSS, *arguments], capture_output=True, text=True, check=False, timeout=120, cwd=self.dir, **more)
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

    def same_motion(self, text):
        """A run as a whole, against its second part from a checkpoint, and from a frame."""
        rounding = 2 * ALL * 2.0**-41 + 1e-10  # images slide a whole number of 2^-40 a0 in each half step; places
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
        self.same_motion(FIBERS)
        contacts = json.loads((self.dir / "whole/run.json").read_text())
        self.assertGreater(contacts["collisions"]["executed"], 20)

    def test_solvent_comes_back_at_the_same_places(self):
        self.same_motion(SOLVENT)

    def test_snapshot_of_a_snapshot_and_resume(self):
        for name, text in (("fibers", FIBERS), ("solvent", SOLVENT)):
            with self.subTest(name):
                whole, first, second, third = (f"{name}-{k}" for k in range(4))
                self.run_to(text, ALL, whole)
                self.run_to(text, 200, first)
                self.run_to(text, 100, second, f"{first}/checkpoint.h5")
                self.call("run", f"{second}.yaml", "--out", second, "--resume", "--steps", "200")
                self.run_to(text, 100, third, f"{second}/checkpoint.h5")
                self.assertLessEqual(apart(self.frame(third)[0], self.frame(whole)[0], ALL), 1e-9)

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

    def change(self, out, how):
        """A trajectory as an earlier program wrote it: frames without checksums."""
        with h5py.File(self.dir / out / "trajectory.h5", "a") as file:
            own = file["parameters/uncross"]
            own.pop("checksum", None)
            own.attrs.modify("format_version", numpy.int32(1))
            how(file)

    def test_bonds_touch_across_the_faces_where_images_are(self):
        rods = SHEARED + "crossing: {rule: event-driven}\n" \
                         "fibers: [{name: r, count: 2, vertices: 2, mass: 1, bond_length: 1, spring: 20}]\n"
        self.run_to(rods, FIRST, "first")
        for x, touch in ((3 - slide(FIRST), True), (3, False)):
            def lay(file, x=x):
                place = file["particles/trajectory/position/value"]
                place[-1] = [[3, 5.5, 3], [3, 6.5, 3], [x - 0.5, 0.25, 3], [x + 0.5, 0.25, 3]]
                file["particles/trajectory/velocity/value"][-1] = 0
            self.change("first", lay)
            if touch:
                (self.dir / "no.yaml").write_text(f"{rods}steps: 1\nstart: {{snapshot: first/trajectory.h5}}\n")
                self.assertIn("touches another", self.call("run", "no.yaml", "--out", "no", code=2).stderr)
            else:
                self.run_to(rods, 1, "yes", "first/trajectory.h5")

    def test_files_that_say_less(self):
        """An earlier program's file has no slide, which was 0 at its step 0. Another program's has nothing."""
        self.run_to(FIBERS, ALL, "whole")
        self.run_to(FIBERS, FIRST, "first")
        self.change("first", lambda file: file["parameters/uncross"].attrs.pop("slide", None))
        self.run_to(FIBERS, ALL - FIRST, "old", "first/trajectory.h5")
        self.assertLessEqual(apart(self.frame("old")[0], self.frame("whole")[0], ALL), 1e-9)
        self.change("first", lambda file: file["parameters/uncross"].pop("scene"))
        (self.dir / "no.yaml").write_text(f"{FIBERS}steps: 1\nstart: {{snapshot: first/trajectory.h5}}\n")
        said = self.call("run", "no.yaml", "--out", "no", code=2).stderr
        self.assertIn("its scene cannot be read, so nobody knows how far the images of a sheared box have slid", said)
        with h5py.File(self.dir / "first/trajectory.h5", "a") as file:
            file.pop("parameters")
        words = "start.snapshot: the file does not say how far the images of the sheared box have slid"
        for stream in ("own", "seed"):
            start = f"start: {{snapshot: first/trajectory.h5, stream: {stream}}}\n"
            self.assertIn("warning: " + words, self.run_to(f"{FIBERS}{start}", 1, stream).stderr)
            self.call("run", f"{stream}.yaml", "--out", stream, "--resume", "--steps", "2")
            self.assertIn(words, " ".join(json.loads((self.dir / stream / "run.json").read_text())["warnings"]))
            self.assertIn(words, self.call("check", f"{stream}.yaml").stdout)

    def test_a_scene_that_claims_memory(self):
        """A file's scene is read for its shear and its time step. How many fibers it claims costs nothing: 12 GB in lists."""
        self.run_to(FIBERS, ALL, "whole")
        self.run_to(FIBERS, FIRST, "first")

        def claim(file):
            own = file["parameters/uncross"]
            text = own["scene"][()].replace(b"count: 24", b"count: 100000000")
            del own["scene"]
            own["scene"] = numpy.bytes_(text)
        self.change("first", claim)
        (self.dir / "again.yaml").write_text(f"{FIBERS}steps: {ALL - FIRST}\nstart: {{snapshot: first/trajectory.h5}}\n")
        bound = 2**31 if "ASAN_OPTIONS" not in os.environ else resource.RLIM_INFINITY  # sanitizers map terabytes
        self.call("run", "again.yaml", "--out", "again", preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (bound, bound)))
        self.assertLessEqual(apart(self.frame("again")[0], self.frame("whole")[0], ALL), 1e-9)


if __name__ == "__main__":
    unittest.main()
