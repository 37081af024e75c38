"""Snapshots that no scene may start from, and what of another program's file is used, checked or refused."""
import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

import h5py
import numpy

UNCROSS = os.environ.get("UNCROSS", "build/uncross")
SCENE = """box: [4, 4, 4]
time_step: 0.01
steps: 4
solvent: {per_cell: 3, collision_interval: 0.02}
trajectory: {every: 4, solvent: true, velocities: true}
"""


class Start(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def start(self, text, out):
        """Exit code and words of a run."""
        (self.dir / "scene.yaml").write_text(text)
        done = subprocess.run([UNCROSS, "run", self.dir / "scene.yaml", "--out", self.dir / out], capture_output=True,
                              text=True, check=False, timeout=120)
        return done.returncode, done.stderr


class Flow(Start):
    def test_a_flow_that_no_scene_may_have(self):
        """A way out is named only if it is one."""
        self.assertEqual(self.start(SCENE, "first")[0], 0)
        from_it = SCENE + "start: {snapshot: first/trajectory.h5}\n"
        for speed, words in ((50, "; allowed: that one"), (150, "; no scene starts from it (a flow is at most 100")):
            with h5py.File(self.dir / "first/trajectory.h5", "a") as file:
                velocity = file["particles/trajectory/velocity/value"]
                velocity[:, :, 0] = velocity[:, :, 0] - velocity[-1, :, 0].mean() + speed
                if "checksum" in file["parameters/uncross"]:  # as a file of version 1 has none
                    del file["parameters/uncross/checksum"]
                    file["parameters/uncross"].attrs.modify("format_version", numpy.int32(1))
            code, said = self.start(from_it, "second")
            self.assertEqual(code, 2, said)
            self.assertIn(f"moves at [{speed}, ", said)
            self.assertIn(words, said)
            self.assertFalse((self.dir / "second").exists())
        code, said = self.start(from_it + "flow: [150, 0, 0]\n", "second")
        self.assertIn("'150' is out of range", said)


class Speed(Start):
    """What is too fast to be summed is named, wherever momentum goes; it is not for want of memory."""
    SCENES = {"bath": "medium: {kind: private, rate: 1}\n", "fluid": "solvent: {per_cell: 1, collision_interval: 0.02}\n",
              "walls": "solvent: {per_cell: 1, collision_interval: 0.02}\nwalls: {kind: no-slip}\n"}

    def test_too_fast(self):
        for name, scene in self.SCENES.items():
            text = "box: [4, 4, 4]\ntime_step: 0.01\nsteps: 2\n" + scene + "crossing: {forbidden: false}\n" \
                "fibers: [{name: a, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100}]\n" \
                f"trajectory: {{every: 2, velocities: true, solvent: {'true' if name != 'bath' else 'false'}}}\n"
            self.assertEqual(self.start(text, name)[0], 0)
            with h5py.File(self.dir / name / "trajectory.h5", "a") as file:
                file.pop("parameters")
            for row, what in ((3, "vertex 3"), (20, "solvent particle 12"))[:1 if name == "bath" else 2]:
                for speed in (2.0**17, -1e6, 1e200):
                    with self.subTest(name=name, row=row, speed=speed):
                        with h5py.File(self.dir / name / "trajectory.h5", "a") as file:
                            velocity = file["particles/trajectory/velocity/value"]
                            kept = velocity[-1, row, 1]
                            velocity[-1, row, 1] = speed
                        code, said = self.start(f"{text}start: {{snapshot: {name}/trajectory.h5}}\n", "again")
                        with h5py.File(self.dir / name / "trajectory.h5", "a") as file:
                            file["particles/trajectory/velocity/value"][-1, row, 1] = kept
                        self.assertEqual(code, 2, said)
                        self.assertIn(f"start.snapshot: {what} of '{name}/trajectory.h5' moves at {speed:.9g} a0/t0 along y", said)
                        self.assertIn("allowed: below 131072", said)


FIBERS = """box: [8, 8, 8]
time_step: 0.01
steps: 4
solvent: {per_cell: 1, collision_interval: 0.02}
trajectory: {every: 4, solvent: true}
crossing: {forbidden: false}
"""
OPEN = "fibers: [{name: a, count: 4, vertices: 6, mass: 5, bond_length: 0.5, spring: 100}]\n"


class Foreign(Start):
    """Files of other programs, made of one of ours by taking out what is ours."""
    GROUP = "particles/trajectory"

    def make(self, fibers, ours=False):
        """A trajectory, from which `again` starts."""
        shutil.rmtree(self.dir / "first", ignore_errors=True)
        self.assertEqual(self.start(FIBERS + fibers, "first")[0], 0)
        if not ours:
            self.change(lambda file: file.pop("parameters"))

    def change(self, how):
        with h5py.File(self.dir / "first/trajectory.h5", "a") as file:
            how(file)

    def again(self, fibers, words=None):
        """Starts a run from the file, which should be refused with these words."""
        self.tries = getattr(self, "tries", 0) + 1
        code, said = self.start(FIBERS + fibers + "start: {snapshot: first/trajectory.h5}\n", f"again{self.tries}")
        self.assertEqual(code, 0 if words is None else 2, said)
        self.assertIn(words or "", said)
        self.assertEqual((self.dir / f"again{self.tries}").exists(), words is None)

    def test_bonds(self):
        ring = OPEN.replace("spring: 100", "spring: 100, ring: true")
        for ours in (False, True):
            for made, asked, words in ((ring, OPEN, "vertex 5 is bonded to 0 in it, to none in the scene"),
                                       (OPEN, ring, "vertex 5 is bonded to none in it, to 0 in the scene"),
                                       (OPEN, OPEN.replace("count: 4, vertices: 6", "count: 6, vertices: 4"),
                                        "vertex 3 is bonded to 4 in it, to none in the scene")):
                with self.subTest(ours=ours, asked=asked):
                    self.make(made, ours)
                    self.again(asked, words)
                    self.again(made)

    def test_bonds_the_other_way_round(self):
        """Pairs have no direction and no order."""
        self.make(OPEN)

        def turn(file):
            pairs = file["connectivity/bonds"][:][::-1, ::-1]
            file["connectivity/bonds"][...] = pairs
        self.change(turn)
        self.change(lambda file: file["connectivity/bonds"].attrs.pop("xxh64"))
        self.again(OPEN)
        self.again(OPEN.replace("count: 4, vertices: 6", "count: 6, vertices: 4"), "vertex 3 is bonded to 4 in it")

    def test_ids(self):
        self.make(OPEN)
        rows = 24 + 512
        with h5py.File(self.dir / "first/trajectory.h5") as file:
            pairs = file["connectivity/bonds"][:]

        def name(file, ids, timed):
            self.put(file, "id", ids, timed)
            del file["connectivity/bonds"]
            file["connectivity/bonds"] = ids[pairs]
        for ids, words in ((numpy.arange(rows), None), (numpy.arange(1, rows + 1), None),
                           (numpy.roll(numpy.arange(rows), 1), "row 1 has the id 0, after 535"),
                           (numpy.arange(rows) * 2, "row 1 has the id 2, after 0")):
            for timed in (False, True):
                with self.subTest(words=words, timed=timed):
                    self.change(lambda file, ids=ids, timed=timed: name(file, ids, timed))
                    self.again(OPEN, words)

    def put(self, file, name, numbers, timed):
        """An element of the group that is fixed, or of two frames."""
        group = file[self.GROUP]
        group.pop(name, None)
        if timed:
            group[f"{name}/value"] = numpy.stack([numpy.zeros_like(numbers), numbers])
        else:
            group[name] = numbers

    def test_masses(self):
        self.make(OPEN)
        right = numpy.array([5.0] * 24 + [1.0] * 512)
        self.again(OPEN.replace("mass: 5", "mass: 4"), "vertex 0 has the mass 5 in it, 4 in the scene")
        heavy = right.copy()
        heavy[30] = 2.0
        self.change(lambda file: self.put(file, "mass", heavy, False))
        self.again(OPEN, "solvent particle 6 has the mass 2 in it, 1 in the scene")
        for numbers, timed, words in ((right.astype("f4"), False, None), (right.astype("i4"), False, None),
                                      (heavy.astype("u1"), False, "solvent particle 6 has the mass 2 in it, 1 in the scene"),
                                      (right, True, "its mass is not one number for each row"),
                                      (numpy.full(536, "1", "S1"), False, "its mass is not one number for each row")):
            self.change(lambda file, numbers=numbers, timed=timed: self.put(file, "mass", numbers, timed))
            self.again(OPEN, words)
        self.change(lambda file: file[self.GROUP].pop("mass"))
        self.again(OPEN)

    def test_masses_of_a_checkpoint(self):
        self.make(OPEN)
        code, said = self.start(FIBERS + OPEN.replace("mass: 5", "mass: 4") + "start: {snapshot: first/checkpoint.h5}\n", "no")
        self.assertEqual(code, 2, said)
        self.assertIn("vertex 0 has the mass 5 in it, 4 in the scene", said)

    def test_kinds_in_another_order(self):
        def kinds(*names):
            return "fibers:\n" + "".join(f"  - {{name: {n}, count: 2, vertices: 6, mass: 5, bond_length: 0.5, spring: 100}}\n"
                                         for n in names)
        self.make(kinds("a", "b"))
        self.again(kinds("b", "a"), "vertex 0 is of 'a' in it, of 'b' in the scene")
        self.again(kinds("c", "d"))  # other names are no contradiction
        self.again(OPEN.replace("name: a", "name: c"))
        self.again(OPEN, "vertex 12 is of 'b' in it, of 'a' in the scene")
        self.again(kinds("a", "c"))  # the file has a name of its own for the second
        self.again(kinds("c", "a"), "vertex 0 is of 'a' in it, of 'c' in the scene")

    SPECIES = h5py.enum_dtype({"a": 0, "b": 1, "solvent": 2}, "i4")

    def test_kinds_of_other_numbers(self):
        """A name that file and scene share is of the same rows."""
        def kinds(first, second):
            return "fibers:\n" + "".join(f"  - {{name: {n}, count: {c}, vertices: 6, mass: 5, bond_length: 0.5, spring: 100}}\n"
                                         for n, c in (("a", first), ("b", second)))
        self.make(kinds(1, 3))
        self.again(kinds(1, 3))
        self.again(kinds(3, 1), "vertex 6 is of 'b' in it, of 'a' in the scene")
        self.change(lambda file: self.put(file, "species", numpy.array([1] * 18 + [0] * 6 + [2] * 512).astype(self.SPECIES), False))
        self.again(kinds(1, 3), "vertex 0 is of 'b' in it, of 'a' in the scene")

    def test_kinds_with_time(self):
        """H5MD allows them: they are checked if they stay the same, and else tell no kinds to start from."""
        def kinds(*names):
            return "fibers:\n" + "".join(f"  - {{name: {n}, count: 2, vertices: 6, mass: 5, bond_length: 0.5, spring: 100}}\n"
                                         for n in names)
        self.make(kinds("a", "b"))
        row = [0] * 12 + [1] * 12 + [2] * 512
        changed = [0] * 11 + [1] * 13 + [2] * 512
        for rows, words in (([row, row], None), ([changed, row], "its species change with time: row 11 of frame 1 is another"),
                            ([row, changed], "its species change with time"), ([row], "its species has 1 rows, its position 2"),
                            (row, None)):
            def put(file, rows=rows):
                group = file[self.GROUP]
                group.pop("species", None)
                numbers = numpy.array(rows).astype(self.SPECIES)
                group["species" if numbers.ndim == 1 else "species/value"] = numbers
            self.change(put)
            self.again(kinds("a", "b"), words)
            self.again(kinds("b", "a"), words or "vertex 0 is of 'a' in it, of 'b' in the scene")
        self.change(lambda file: file[self.GROUP].pop("species"))
        self.change(lambda file: file[self.GROUP].create_dataset("species/value", data=numpy.zeros((2, 7), "i4")))
        self.again(kinds("a", "b"), "its species are not one whole number for each row")

    def test_kinds_of_a_checkpoint(self):
        """Kinds of equal numbers and masses that change their places are other fibers: their springs differ."""
        def kinds(*springs):
            return "fibers:\n" + "".join(f"  - {{name: s{s}, count: 2, vertices: 6, mass: 5, bond_length: 0.5, spring: {s}}}\n"
                                         for s in springs)
        self.make(kinds(100, 200), ours=True)
        again = "start: {snapshot: first/checkpoint.h5}\n"
        for springs, words in (((200, 100), "vertex 0 is of 's100' in it, of 's200' in the scene"), ((100, 200), None)):
            code, said = self.start(FIBERS + kinds(*springs) + again, f"of-{springs[0]}")
            self.assertEqual(code, 2 if words else 0, said)
            self.assertIn(words or "", said)

    def test_solvent_among_the_vertices(self):
        points = "fibers: [{name: a, count: 24, vertices: 1, mass: 1}]\n"
        self.make(points)

        def turn(file):
            species = file[self.GROUP]["species"]
            species[...] = species[:][::-1]
            species.attrs.pop("xxh64")
        self.change(turn)
        self.again(points, "row 0 is solvent in it, a vertex in the scene")

    def test_images_are_used(self):
        """Positions in the box and image numbers are positions that are not folded."""
        self.make(OPEN)
        path = self.dir / "first/trajectory.h5"
        with h5py.File(path, "a") as file:
            value = file[self.GROUP]["position/value"]
            value[:, :24] += numpy.array([7.9, -0.3, 16.2])  # across the boundary
            plain = value[:]
        self.again(OPEN)
        with h5py.File(path, "a") as file:
            file[self.GROUP]["image/value"] = numpy.floor(plain / 8).astype("i4")
            file[self.GROUP]["position/value"][...] = plain - 8 * numpy.floor(plain / 8)
        self.again(OPEN)
        starts = []
        for number in (1, 2):
            with h5py.File(self.dir / f"again{number}/trajectory.h5") as file:
                starts.append(file[self.GROUP]["position/value"][0])
        numpy.testing.assert_allclose(starts[1], starts[0], rtol=0, atol=1e-11)

    def test_what_no_run_knows_is_refused(self):
        self.make(OPEN)
        self.change(lambda file: file[self.GROUP].create_dataset("force/value", data=numpy.zeros((2, 536, 3))))
        self.again(OPEN)  # forces are made anew
        self.change(lambda file: self.put(file, "charge", numpy.ones(536), False))
        self.again(OPEN, "it holds 'charge', of which a run knows nothing; allowed: position, ")
        self.change(lambda file: file[self.GROUP].pop("charge"))
        self.again(OPEN)
        self.change(lambda file: file["connectivity"].create_dataset("angles", data=numpy.array([[0, 1, 2]])))
        self.again(OPEN, "it holds 'connectivity/angles', of which a run knows nothing; allowed: bonds")

    # Thin bonds that touch at the start: neither is on a side of the other. Two fibers of four vertices on lines.
    RODS = "fibers: [{name: a, count: 2, vertices: 4, mass: 5, bond_length: 1, spring: 100}]\n"
    X, Y, Z = (numpy.array(e, float) for e in ((1, 0, 0), (0, 1, 0), (0, 0, 1)))

    def rods(self, second, along, crossable=False, words=None, length=1.125):
        """The first rod begins at (3, 4, 4) and goes along x."""
        steps = numpy.arange(4)[:, None] * length

        def lay(file):
            value = file[self.GROUP + "/position/value"]
            place = value[-1]
            place[:4] = [3, 4, 4] + steps * self.X
            place[4:8] = second + steps * along
            value[-1] = place
            file[self.GROUP + "/velocity/value"][-1, :8] = 0
        self.change(lay)
        rods = self.RODS.replace("}]", ", frozen: true}]") if crossable == "frozen" else self.RODS
        scene = FIBERS if crossable is True else FIBERS.replace("crossing: {forbidden: false}\n", "")
        for rule in (("event-driven", "sequential") if crossable is not True else (None,)):
            text = scene + rods + (f"crossing: {{rule: {rule}}}\n" if rule else "")
            out = f"again{len(list(self.dir.iterdir()))}"
            code, said = self.start(text + "start: {snapshot: first/trajectory.h5}\n", out)
            refused = words and rule != "sequential"  # whose signs give each bond a side
            self.assertEqual(code, 2 if refused else 0, said)
            self.assertIn(words if refused else "", said)
            self.assertEqual((self.dir / out).exists(), not refused)

    def test_thin_bonds_that_touch(self):
        self.make(self.RODS)
        words = "scene.yaml:8:19: start.snapshot: bond 4 of fiber 1 touches another"
        for second, along in (((3, 4, 4), self.X), ((6.375, 4, 4), -self.X),     # on each other
                              ((3.5, 4, 4), self.X), ((11, 4, 4), self.X),       # in part; an image
                              ((6.375, 4, 4), self.X), ((3, 4, 4), self.Y),      # end on end
                              ((3.5, 4, 4), self.Y), ((4.125, 4, 4), self.Z)):   # an end on a side, on a vertex
            with self.subTest(second=second, along=along):
                self.rods(second, along, words=words)
        with self.subTest("across"):
            self.rods((3.5, 3, 4), self.Y, words=words)
        with self.subTest("crossable"):
            self.rods((3.5, 3, 4), self.Y, crossable=True)
        with self.subTest("frozen"):
            self.rods((3.5, 3, 4), self.Y, crossable="frozen")
        for second, along in (((3, 4, 4.000001), self.X), ((3.5, 3, 4.000001), self.Y), ((6.5, 4, 4), self.X)):
            with self.subTest(second=second, along=along):
                self.rods(second, along)


class Outside(Start):
    """Solvent that is not in the box: an image of a place in it where the box is periodic, else refused."""
    FLUID = "box: [4, 4, 4]\ntime_step: 0.01\nsteps: 4\nsolvent: {per_cell: 3, collision_interval: 0.02}\n" \
            "trajectory: {every: 4, solvent: true}\n"
    AGAIN = "start: {snapshot: first/trajectory.h5}\n"

    def make(self, boundary, shift):
        """A frame whose solvent is moved as a whole."""
        self.assertEqual(self.start(self.FLUID + boundary, "first")[0], 0)
        with h5py.File(self.dir / "first/trajectory.h5", "a") as file:
            file.pop("parameters")
            file["particles/trajectory/position/value"][-1] += numpy.array(shift)
            return file["particles/trajectory/position/value"][-1]

    def test_walls(self):
        moved = self.make("walls: {kind: no-slip}\n", [-2, -2, -2])  # the origin in the middle of the box
        code, said = self.start(self.FLUID + "walls: {kind: no-slip}\n" + self.AGAIN, "second")
        self.assertEqual(code, 2, said)
        first = int(numpy.flatnonzero(moved[:, 1] < 0)[0])
        self.assertIn(f"solvent particle {first} is at y = {moved[first, 1]}, beyond the walls at 0 and 4", said)
        self.assertFalse((self.dir / "second").exists())
        done = subprocess.run([UNCROSS, "check", self.dir / "scene.yaml"], capture_output=True, text=True, check=False, timeout=60)
        self.assertEqual((done.returncode, done.stderr), (2, said))

    def test_shear(self):
        moved = self.make("shear: {rate: 0.1}\n", [0, 1, 0])
        code, said = self.start(self.FLUID + "shear: {rate: 0.1}\n" + self.AGAIN, "second")
        self.assertEqual(code, 2, said)
        first = int(numpy.flatnonzero(moved[:, 1] >= 4)[0])
        self.assertIn(f"solvent particle {first} is at y = {moved[first, 1]}, outside of a sheared box, whose images "
                      "along y slide and have other velocities; allowed: 0 to below 4", said)

    def test_periodic(self):
        moved = self.make("", [-2, 3, 9])
        code, said = self.start(self.FLUID + self.AGAIN, "second")
        self.assertEqual(code, 0, said)
        with h5py.File(self.dir / "second/trajectory.h5") as file:
            start = file["particles/trajectory/position/value"][0]
        numpy.testing.assert_allclose(start, moved % 4, rtol=0, atol=2**-40)

    def test_just_beyond_a_wall(self):
        """A place on a wall is inside. One that is beyond by a hair is not shown as if it were on it."""
        fibers = "fibers: [{name: a, count: 4, vertices: 1, mass: 3}]\nwalls: {kind: no-slip}\n"
        above = 4 + 2.0**-40
        self.make(fibers, [0, 0, 0])
        for row, y, words in ((20, 4, None), (20, above, f"solvent particle 16 is at y = {above}, beyond the walls at 0 and 4"),
                              (3, 4, None), (3, above, f"vertex 3 is beyond a wall, at y = {above} a0; 0 to 4 is allowed")):
            with self.subTest(row=row, y=y):
                with h5py.File(self.dir / "first/trajectory.h5", "a") as file:
                    place = file["particles/trajectory/position/value"]
                    place[-1, 20, 1] = place[-1, 3, 1] = 1
                    place[-1, row, 1] = y
                code, said = self.start(self.FLUID + fibers + self.AGAIN, f"again-{row}-{y == 4}")
                self.assertEqual(code, 2 if words else 0, said)
                self.assertIn(words or "", said)

    def test_vertices_beyond_walls(self):
        fibers = "fibers: [{name: a, count: 4, vertices: 1, mass: 3}]\nwalls: {kind: no-slip}\n"
        self.make(fibers, [0, 0, 0])
        with h5py.File(self.dir / "first/trajectory.h5", "a") as file:
            file["particles/trajectory/position/value"][-1, 3, 1] = -0.01
        code, said = self.start(self.FLUID + fibers + self.AGAIN, "second")
        self.assertEqual(code, 2, said)
        self.assertIn("vertex 3", said)


class Boundary(Start):
    """What a file says of its box is compared with the scene: a box between walls is no periodic one."""
    FLUID = Outside.FLUID
    SCENES = {"periodic": "", "walls": "walls: {kind: no-slip}\n", "shear": "shear: {rate: 0.1}\n"}

    def test_our_files(self):
        """A frame gets the answer that a checkpoint gets."""
        for made in self.SCENES:
            self.assertEqual(self.start(self.FLUID + self.SCENES[made], made)[0], 0)
            for asked in self.SCENES:
                for file in ("checkpoint", "trajectory"):
                    with self.subTest(made=made, asked=asked, file=file):
                        code, said = self.start(f"{self.FLUID}{self.SCENES[asked]}start: {{snapshot: {made}/{file}.h5}}\n",
                                                f"{made}-{asked}-{file}")
                        differ = (made == "walls") != (asked == "walls")
                        self.assertEqual(code, 2 if differ else 0, said)
                        self.assertIn(f"it is of a box {'between' if made == 'walls' else 'without'} walls, the scene's box "
                                      f"has {'none' if made == 'walls' else 'walls'}" if differ else "", said)

    def test_files_of_others(self):
        """Words of fixed and of variable length; a file that says nothing is believed."""
        for asked in self.SCENES:
            self.assertEqual(self.start(self.FLUID + self.SCENES[asked], asked)[0], 0)
        words = {"periodic": "the scene's is periodic along y", "walls": "the scene has walls along y", "shear": None}
        for number, (said, fits) in enumerate(((["periodic"] * 3, ("periodic", "shear")),
                                               (["periodic", "none", "periodic"], ("walls", "shear")),
                                               (["none"] * 3, ()), (["periodic", "periodic", "none"], ()),
                                               (None, tuple(self.SCENES)))):
            for kind in ("S8", h5py.string_dtype()):
                for asked in self.SCENES:
                    with self.subTest(said=said, kind=kind, asked=asked):
                        with h5py.File(self.dir / asked / "trajectory.h5", "a") as file:
                            file.pop("parameters", None)
                            about = file["particles/trajectory/box"].attrs
                            about.pop("boundary", None)
                            if said:
                                about.create("boundary", numpy.array(said, dtype=kind if kind == "S8" else object), dtype=kind)
                        code, told = self.start(f"{self.FLUID}{self.SCENES[asked]}start: {{snapshot: {asked}/trajectory.h5}}\n",
                                                f"{number}-{kind}-{asked}")
                        self.assertEqual(code, 0 if asked in fits else 2, told)
                        if asked not in fits:
                            along_y = said[1] == ("none" if asked == "periodic" else "periodic") and asked != "shear"
                            axis = "x" if said[0] == "none" else "y" if along_y else "z"
                            self.assertIn(f"its box is {said['xyz'.index(axis)].replace('none', 'not periodic')} along {axis}", told)
                            self.assertIn(words[asked] if axis == "y" else f"the scene's is periodic along {axis}", told)


class Untold(Start):
    def test_bonds_that_no_file_tells(self):
        """Nothing tells a ring from an open fiber then: the scene's bonds are taken, with a warning."""
        ring = OPEN.replace("spring: 100", "spring: 100, ring: true")
        points = "fibers: [{name: a, count: 24, vertices: 1, mass: 5}]\n"
        words = "start.snapshot: the file says nothing of bonds, so the scene's are taken, right or wrong"
        for fibers, bonded in ((ring, True), (points, False)):
            self.assertEqual(self.start(FIBERS + fibers, f"first{bonded}")[0], 0)
            with h5py.File(self.dir / f"first{bonded}/trajectory.h5", "a") as file:
                file.pop("parameters")
                file.pop("connectivity")
            for asked in (fibers, OPEN) if bonded else (fibers,):
                out = f"{bonded}{asked == OPEN}"
                code, said = self.start(f"{FIBERS}{asked}start: {{snapshot: first{bonded}/trajectory.h5}}\n", out)
                self.assertEqual((code, words in said), (0, bonded), said)
                done = subprocess.run([UNCROSS, "run", self.dir / "scene.yaml", "--out", self.dir / out, "--resume", "--steps", "8"],
                                      capture_output=True, text=True, check=True, timeout=60)
                self.assertEqual(words in done.stderr, bonded)
                told = json.loads((self.dir / out / "run.json").read_text())["warnings"]
                check = subprocess.run([UNCROSS, "check", self.dir / "scene.yaml"], capture_output=True, text=True, check=True,
                                       timeout=60)
                self.assertEqual((words in " ".join(told), words in check.stdout), (bonded, bonded))


if __name__ == "__main__":
    unittest.main()
