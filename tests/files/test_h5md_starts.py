"""H5MD files of other programs: what they say is used, checked or refused, in a start and in every other reading."""
import os
import pathlib
import resource
import subprocess
import tempfile
import unittest

import h5py
import numpy

UNCROSS = os.environ.get("UNCROSS", "build/uncross")
SOLVENT = "box: [8, 8, 8]\ntime_step: 0.01\nsteps: 2\nsolvent: {per_cell: 1, collision_interval: 0.02}\ntrajectory: {every: 2, solvent: true}\n"
KINDS = """crossing: {forbidden: false}
fibers:
  - {name: a, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100}
  - {name: b, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100}
"""
VERTICES, ROWS = 16, 528
PLANE = "box: [8, 8, 1]\ndimensions: 2\ntime_step: 0.01\nsteps: 2\nsolvent: {per_cell: 3, collision_interval: 0.02}\ntrajectory: {every: 2, solvent: true}\n"


def run(folder, text, out, *options):
    (folder / f"{out}.yaml").write_text(text)
    return subprocess.run([UNCROSS, "run", f"{out}.yaml", "--out", out, *options], capture_output=True, text=True, check=False,
                          timeout=120, cwd=folder)


class Foreign(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.dir, cls.tries = pathlib.Path(folder.name), 0
        done = run(cls.dir, SOLVENT + KINDS, "first")
        assert done.returncode == 0, done.stderr
        with h5py.File(cls.dir / "first/trajectory.h5") as file:
            group = file["particles/trajectory"]
            cls.place, cls.velocity = group["position/value"][-1], group["velocity/value"][-1]
            cls.species, cls.bonds = group["species"][:], file["connectivity/bonds"][:]

    def put(self, group, name, numbers, steps):
        group[f"{name}/value"] = numpy.array(numbers)
        if steps is not None:
            group[f"{name}/step"] = steps

    def make(self, change=None, places=None, velocities=None, steps=(4,), velocity_steps=None, bonds=None):
        """A file of one frame, or of those given."""
        with h5py.File(self.dir / "other.h5", "w") as file:
            group = file.create_group("particles/all")
            self.put(group, "position", [self.place] if places is None else places, steps)
            self.put(group, "velocity", [self.velocity] if velocities is None else velocities, steps if velocity_steps is None else velocity_steps)
            box = group.create_group("box")
            box["edges"] = [8.0, 8.0, 8.0]
            box.attrs["dimension"] = 3
            box.attrs["boundary"] = numpy.array([b"periodic"] * 3)
            file["connectivity/bonds"] = self.bonds if bonds is None else bonds
            if change:
                change(file)

    def again(self, words=None, scene=SOLVENT + KINDS, file="other.h5"):
        type(self).tries += 1
        done = run(self.dir, f"{scene}start: {{snapshot: {file}}}\n", f"again{self.tries}")
        self.assertEqual(done.returncode, 2 if words else 0, done.stderr)
        self.assertIn(words or "", done.stderr)
        return self.dir / f"again{self.tries}"

    def refused_by_all(self, words):
        """By a start, and by all that reads frames."""
        self.again(words)
        for command in ("export", "info"):
            done = subprocess.run([UNCROSS, command, "other.h5"], capture_output=True, text=True, check=False, timeout=60, cwd=self.dir)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(words, done.stderr)

    def test_what_is_taken(self):
        self.make()
        again = self.again()
        with h5py.File(again / "trajectory.h5") as file:
            numpy.testing.assert_allclose(file["particles/trajectory/velocity/value"][0][:VERTICES], self.velocity[:VERTICES], rtol=0, atol=0)

    def test_steps(self):
        """A frame is of one step."""
        two, three = [self.place] * 2, [self.place] * 3
        fast, faster = [self.velocity] * 2, [self.velocity] * 3
        self.make(places=three, velocities=faster, steps=(0, 10, 20))
        self.again()
        self.make(places=three, velocities=faster, steps=(0, 10, 20), velocity_steps=(0, 5, 10))
        self.refused_by_all("its velocity is of other steps than its position: row 1 is of step 5, not of 10")
        self.make(places=three, velocities=fast, steps=(0, 10, 20), velocity_steps=(0, 10))
        self.refused_by_all("its velocity has 2 rows, its position 3")
        self.make(places=two, velocities=faster, steps=(0, 10), velocity_steps=(0, 10, 20))
        self.refused_by_all("its velocity has 3 rows, its position 2")
        for which in "steps", "velocity_steps":  # fewer than rows, or none that can be read
            for few in (0, 10), ["a", "b", "c"]:
                self.make(places=three, velocities=faster, **{"steps": (0, 10, 20), "velocity_steps": (0, 10, 20), which: few})
                name = "position" if which == "steps" else "velocity"
                self.refused_by_all(f"its {name} has no step that can be read for each of its 3 rows")
        # a fixed increment, and the same steps one by one
        self.make(places=three, velocities=faster, steps=10, velocity_steps=(0, 10, 20))
        self.again()
        self.make(places=three, velocities=faster, steps=10, velocity_steps=(0, 20, 40))
        self.refused_by_all("row 1 is of step 20, not of 10")
        image = numpy.zeros((2, ROWS, 3), int)
        self.make(lambda file: self.put(file["particles/all"], "image", image, (0, 20)), places=two, velocities=fast, steps=(0, 10))
        self.refused_by_all("its image is of other steps than its position: row 1 is of step 20, not of 10")

        def edges(file):
            del file["particles/all/box/edges"]
            self.put(file["particles/all/box"], "edges", [[8.0] * 3] * 2, (0, 30))
        self.make(edges, places=two, velocities=fast, steps=(0, 10))
        self.refused_by_all("its box/edges is of other steps than its position: row 1 is of step 30, not of 10")

    def test_groups(self):
        """One group of particles, or nobody knows which."""
        self.make(lambda file: file.copy("particles/all", "particles/aaa"))
        self.refused_by_all("it holds 2 groups of particles, 'aaa', 'all'")

    def test_ids(self):
        """Bonds are pairs of ids where there are ids."""
        ids = numpy.arange(1, ROWS + 1)
        self.make(lambda file: file["particles/all"].create_dataset("id", data=ids), bonds=self.bonds + 1)
        self.again()
        self.make(lambda file: file["particles/all"].create_dataset("id", data=ids))
        self.refused_by_all("its bonds name particle 0, and no row is that")
        self.make(bonds=self.bonds + ROWS)
        self.refused_by_all(f"its bonds name particle {ROWS}, and no row is that")
        # rows in another order are found by their ids
        back = numpy.arange(ROWS)[::-1].copy()
        self.make(lambda file: file["particles/all"].create_dataset("id", data=back), places=[self.place[::-1]])
        self.again("row 1 has the id 526, after 527")
        done = subprocess.run([UNCROSS, "export", "other.h5"], capture_output=True, text=True, check=True, timeout=60, cwd=self.dir)
        self.assertEqual(done.stdout.split("\n")[0], str(ROWS))

    def named(self, numbers, *names):
        kind = h5py.special_dtype(enum=("i4", {name: k for k, name in enumerate(names)}))
        return lambda file: file["particles/all"].create_dataset("species", data=numbers, dtype=kind)

    def test_kinds(self):
        """A name that the scene knows stands where the scene's does."""
        numbers = self.species.copy()
        self.make(self.named(numbers, "a", "b", "solvent"))
        self.again()
        numbers[200] = 0
        self.make(self.named(numbers, "a", "b", "solvent"))
        self.again("row 200 is of 'a' in it, solvent in the scene")
        self.make(self.named(self.species, "a", "b", "solvent"))
        self.again("vertex 0 is of 'a' in it, of 'c' in the scene", SOLVENT + KINDS.replace("name: a", "name: c").replace("name: b", "name: a"))
        self.make(self.named(self.species, "x", "y", "water"))  # names that say nothing
        self.again()

    def test_box(self):
        for change, words in ((lambda file: file["particles/all/box"].create_dataset("offset", data=[-4.0] * 3),
                               "it holds 'box/offset', of which a run knows nothing; allowed: edges"),
                              (lambda file: file["particles/all/box"].attrs.modify("dimension", 2), "its box has 2 dimensions; allowed: 3"),
                              (lambda file: file["particles/all/box"].attrs.modify("boundary", numpy.array([b"periodic", b"reflect", b"periodic"])),
                               "its box is 'reflect' along y; allowed: periodic, none"),
                              (lambda file: file["particles/all/box"].attrs.create("boundary", numpy.bytes_(b"periodic")),
                               "its box has a boundary that is not three words; allowed: periodic, none")):
            with self.subTest(words):
                self.make(change)
                self.again(words)

    def test_units(self):
        for name in ("position/value", "velocity/value", "box/edges"):
            for unit in ("nm", numpy.bytes_(b"nm")):
                with self.subTest(name=name, unit=unit):
                    self.make(lambda file, name=name, unit=unit: file[f"particles/all/{name}"].attrs.create("unit", unit))
                    self.again(f"its {name.replace('/value', '').replace('box/', '')} has the unit 'nm'; allowed: none, numbers in a0, t0 and m")


class Bodies(unittest.TestCase):
    def test_a_hole_is_no_solvent(self):
        """Frames of a bead, or of dumbbells, are no start without them."""
        fluid = SOLVENT.replace("per_cell: 1", "per_cell: 2").replace("time_step: 0.01", "time_step: 0.02")
        for body, words in (("bead: {radius: 1.5, center: [4, 4, 4]}\n", "it is of a solvent around a bead, the scene has none"),
                            ("dumbbells: {spring: 2}\n", "dumbbells, the scene has none")):
            with self.subTest(body), tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder)
                self.assertEqual(run(path, fluid + body, "first").returncode, 0)
                with h5py.File(path / "first/trajectory.h5") as file:
                    count = file["particles/trajectory/position/value"].shape[1]
                again = fluid.replace("per_cell: 2", f"per_cell: {count / 512:.17g}") + "start: {snapshot: first/trajectory.h5}\n"
                done = run(path, again, "again")
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(words, done.stderr)


class Dimensions(unittest.TestCase):
    def test_a_plane_is_no_slice_of_space(self):
        """The file's scene says of how many dimensions its state is."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder)
            self.assertEqual(run(path, PLANE, "first").returncode, 0)
            for file in ("checkpoint", "trajectory"):
                with self.subTest(file=file):
                    start = f"start: {{snapshot: first/{file}.h5}}\n"
                    self.assertEqual(run(path, PLANE + start, f"flat-{file}").returncode, 0)
                    done = run(path, PLANE.replace("dimensions: 2", "dimensions: 3") + start, f"deep-{file}")
                    self.assertEqual(done.returncode, 2, done.stderr)
                    self.assertIn("it is of a scene with dimensions: 2, this one has 3", done.stderr)


if __name__ == "__main__":
    # Each run takes a fraction of a second.
    resource.setrlimit(resource.RLIMIT_CPU, (60, 60))
    unittest.main()
