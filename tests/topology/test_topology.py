#!/usr/bin/python3
"""`uncross topology`: files of all formats, what is said of them, verdicts, exit codes; and this program's own runs."""
import os
import pathlib
import random
import re
import sys
import tempfile
import unittest

import h5py
import numpy

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import FolderTest, uncross  # noqa: E402

# Short stiff fibers, close to each other, in a private bath.
FIBERS = """box: [4, 4, 4]
time_step: 0.01
steps: 40
seed: 3
medium: {kind: private, rate: 1}
fibers:
  - {name: chain, count: 26, vertices: 8, mass: 1, bond_length: 0.5, spring: 100, bending: 2}
  - {name: ring, count: 6, vertices: 7, ring: true, mass: 1, bond_length: 0.5, spring: 100, bending: 2}
trajectory: {every: 1}
"""
# Velocities that are forgotten in two steps: what has crossed often comes back.
PHANTOM = FIBERS.replace("rate: 1}", "rate: 50}") + "crossing: {forbidden: false}\n"


def make(folder, name, text, *more):
    (folder / f"{name}.yaml").write_text(text)
    done = uncross("run", folder / f"{name}.yaml", "--out", folder / name, "--quiet", *more)
    assert done.returncode == 0, done.stderr
    return folder / name / "trajectory.h5"


def table(text):
    """{stride: [intervals, crossings, net, odd, touched, rate]}"""
    return {int(words[0]): [int(word) for word in words[1:6]] + [float(words[6])] for words in map(str.split, text.splitlines())
            if len(words) == 7 and words[0] in ("1", "2", "5", "10")}


class Topology(FolderTest):
    def look(self, code, *words):
        done = uncross("topology", *words, cwd=self.dir)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done


class OwnRuns(Topology):
    def test_noncrossing_runs_do_not_cross(self):
        thick = FIBERS.replace("bending: 2}", "bending: 2, diameter: 0.1}")
        sheared = FIBERS + "shear: {rate: 1.7}\n"
        for name, text in (("event", FIBERS), ("paper", FIBERS + "crossing: {rule: sequential}\n"), ("thick", thick.replace("count: 26", "count: 12")),
                           ("sheared", sheared.replace("steps: 40", "steps: 150").replace("medium: {kind: private, rate: 1}\n", ""))):
            with self.subTest(name):
                rows = table(self.look(0, make(self.dir, name, text)).stdout)
                self.assertEqual(rows[1][1:5], [0, 0, 0, 0])
                self.assertGreaterEqual(rows[1][0], 40)

    def test_phantoms_cross(self):
        done = self.look(10, make(self.dir, "phantom", PHANTOM, "--steps", "200"), "--csv", "found.csv")
        rows = table(done.stdout)
        self.assertEqual([rows[stride][0] for stride in (1, 2, 5, 10)], [200, 100, 40, 20])
        self.assertGreater(rows[1][1], 80)
        for stride, more in ((1, 2), (2, 5), (5, 10)):
            self.assertGreater(rows[stride][1], rows[more][1])  # what crosses and comes back is not seen
        bonds = 26 * 7 + 6 * 7
        for stride, (_, crossed, _, _, _, rate) in rows.items():
            self.assertAlmostEqual(rate / (crossed / bonds / 2.0), 1, 4, stride)
        self.assertIn("verdict: CROSSED", done.stdout)
        lines = (self.dir / "found.csv").read_text().splitlines()
        self.assertEqual(len(lines) - 1, sum(row[1] for row in rows.values()))
        first = [line.split(",") for line in lines[1:] if line.startswith("1,")]
        self.assertEqual(sum(int(words[11]) for words in first), rows[1][2])
        self.assertIn(f"first crossed: between frames {first[0][1]} and", done.stdout)

    def test_refused(self):
        path = make(self.dir, "own", FIBERS.replace("steps: 40", "steps: 2"))
        for code, text, *words in ((2, "has its own bonds", path, "--chain", "8"), (2, "no-such", "no-such.xyz"), (2, "no trajectory that is known", "own.yaml"),
                                   (2, "nothing is written over", path, "--csv", "own.yaml")):
            self.assertIn(text, self.look(code, *words).stderr)


class Formats(Topology):
    """One phantom run, as files of other programs: the same crossings."""

    @classmethod
    def setUpClass(cls):
        cls.shared = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.shared.cleanup)
        cls.folder = pathlib.Path(cls.shared.name)
        cls.path = make(cls.folder, "phantom", PHANTOM, "--steps", "20")
        cls.wanted = table(uncross("topology", cls.path).stdout)
        for form in "xyz", "lammps-dump", "vtf":
            (cls.folder / form).write_text(uncross("export", cls.path, "--format", form).stdout)
        (cls.folder / "data").write_text(uncross("export", cls.path, "--format", "lammps").stdout)

    def same(self, done, rate=1.0):
        rows = table(done.stdout)
        for stride, wanted in self.wanted.items():
            self.assertEqual(rows[stride][:5], wanted[:5])
            self.assertAlmostEqual(rows[stride][5] / wanted[5] / rate, 1, 4)
        return done

    def shuffled(self, text):
        """A LAMMPS dump with each frame's atoms in another order."""
        draw, out, atoms = random.Random(1), [], []
        for line in text.splitlines():
            if line.startswith("ITEM") or not line[:1].isdigit() or len(line.split()) < 5:
                draw.shuffle(atoms)
                out += atoms
                atoms = []
                out.append(line)
            else:
                atoms.append(line)
        draw.shuffle(atoms)
        return "\n".join(out + atoms) + "\n"

    def test_xyz(self):
        self.same(self.look(10, self.folder / "xyz"))
        text = re.sub(r"next:I:1", "other:I:1", (self.folder / "xyz").read_text())
        (self.dir / "bare.xyz").write_text(text)
        self.assertIn("has no bonds", self.look(2, "bare.xyz").stderr)

    def test_lammps(self):
        dump = (self.folder / "lammps-dump").read_text()
        self.assertIn("ix iy iz", dump)
        self.same(self.look(10, self.folder / "lammps-dump", "--bonds", self.folder / "data"), 0.01)  # per step
        self.assertIn("--bonds", self.look(2, self.folder / "lammps-dump").stderr)
        self.assertIn("--chain says", self.look(2, self.folder / "lammps-dump", "--chain", "9").stderr)

    def test_ids_in_any_order(self):
        (self.dir / "d").write_text(self.shuffled((self.folder / "lammps-dump").read_text()))
        self.same(self.look(10, "d", "--bonds", self.folder / "data"), 0.01)

    def test_wrapped_without_images(self):
        dump = (self.folder / "lammps-dump").read_text().replace(" ix iy iz", " a b c")
        (self.dir / "d").write_text(self.shuffled(dump))
        done = self.same(self.look(10, "d", "--bonds", self.folder / "data"), 0.01)
        self.assertIn("positions are wrapped", done.stderr)

    def test_vtf(self):
        done = self.look(10, self.folder / "vtf", "--every-step")
        rows = table(done.stdout)
        self.assertEqual([rows[stride][:5] for stride in (1, 2, 5, 10)], [self.wanted[stride][:5] for stride in (1, 2, 5, 10)])
        self.assertIn("they are not known to be of every step", self.look(10, self.folder / "vtf").stdout)

    def h5md(self, name, kind=float, bonds=True, ids=None, image=False):
        with h5py.File(self.path) as ours, h5py.File(self.dir / name, "w") as file:
            position = ours["particles/trajectory/position/value"][:]
            order = numpy.arange(position.shape[1]) if ids is None else ids
            group = file.create_group("particles/polymer")
            turns = numpy.floor(position / 4).astype(int)
            group["position/value"] = ((position - 4 * turns) if image else position)[:, order].astype(kind)
            group["position/step"], group["position/time"] = ours["particles/trajectory/position/step"][:], ours["particles/trajectory/position/time"][:]
            group["id"] = order
            if image:
                group["image/value"] = turns[:, order]
            group.create_group("box").attrs["boundary"] = ["periodic"] * 3
            group["box/edges"] = [4.0] * 3
            if bonds:
                file["connectivity/bonds"] = ours["connectivity/bonds"][:]

    def test_h5md_of_others(self):
        self.h5md("all.h5", ids=numpy.random.default_rng(1).permutation(26 * 8 + 6 * 7), image=True)
        self.same(self.look(10, "all.h5"))
        self.h5md("bare.h5", bonds=False)
        self.assertIn("has no bonds", self.look(2, "bare.h5").stderr)

    def test_single_precision_is_said(self):
        self.h5md("single.h5", "f4")
        done = self.look(10, "single.h5")
        self.assertRegex(done.stdout, r"positions are stored to 2.4e-07: [0-9]+ pairs of bonds were nearer than twice that")
        dump = re.sub(r"(\d\.\d\d)\d+", r"\1", (self.folder / "lammps-dump").read_text())
        (self.dir / "d").write_text(dump)
        rough = self.look(10, "d", "--bonds", self.folder / "data").stdout
        near = re.search(r"stored to 0.005: ([0-9]+) pairs", rough)
        self.assertGreater(int(near[1]), 10)
        self.assertNotIn("stored to", self.look(10, self.folder / "xyz").stdout)

    def test_frames_of_every_step(self):
        self.assertIn("in a step", self.look(10, self.path).stdout)
        frames = (self.folder / "lammps-dump").read_text().split("ITEM: TIMESTEP\n")
        (self.dir / "d").write_text("ITEM: TIMESTEP\n".join([frames[0], *frames[1::5]]))
        bonds = "--bonds", self.folder / "data"
        self.assertIn("not known to be of every step", self.look(10, "d", *bonds).stdout)
        self.assertIn("5 steps apart", self.look(2, "d", *bonds, "--every-step").stderr)

    def test_bad_lines(self):
        lines = (self.folder / "lammps-dump").read_text().splitlines(keepends=True)
        for line, text, said in ((12, "1 2 3\n", "d:13:1: 3 columns; atoms have"), (12, "x" + lines[12], "d:13:1: column 1 is no number"),
                                 (0, "hallo\n", "no trajectory that is known")):
            (self.dir / "d").write_text("".join([*lines[:line], text, *lines[line + 1:]]))
            self.assertIn(said, self.look(2, "d", "--bonds", self.folder / "data").stderr)
        (self.dir / "d").write_text("".join(lines[:30]))
        self.assertIn("the file ends within atoms", self.look(2, "d", "--bonds", self.folder / "data").stderr)
        (self.dir / "b").write_text("1 2\n2 3 4\n")
        self.assertIn("b:2:1: no bond", self.look(2, self.folder / "lammps-dump", "--bonds", "b").stderr)
        (self.dir / "b").write_text("1 999\n")
        self.assertIn("atom 999 has a bond, and is not in a frame", self.look(2, self.folder / "lammps-dump", "--bonds", "b").stderr)


class Verdicts(Topology):
    """Plain XYZ of two bonds."""

    def write(self, *heights):
        self.dir.joinpath("two.xyz").write_text("".join(f"4\n\nA 0 0 0\nA 2 0 0\nB 1 -1 {z}\nB 1 1 {z}\n" for z in heights))

    def test_apart(self):
        self.write("1.0000000000000001", "2.0000000000000001")
        self.assertIn("consistent with noncrossing between these frames; cannot be certified", self.look(0, "two.xyz", "--chain", "2").stdout)
        done = self.look(0, "two.xyz", "--chain", "2", "--every-step")
        self.assertIn("verdict: no crossing", done.stdout)
        self.assertIn("2 frames, 2 bonds: 2 chains\n", done.stdout)  # none from chain to chain
        self.assertEqual(done.stderr, "")

    def test_touched_is_a_warning(self):
        self.write("1.0000000000000001", "0")
        done = self.look(0, "two.xyz", "--chain", "2")
        self.assertEqual(table(done.stdout)[1][1:5], [0, 0, 0, 1])
        self.assertIn("warning", done.stderr)
        self.assertIn("first touched: between frames 0 and 1, bonds 1 2 and 3 4", done.stdout)

    def test_through_a_vertex_is_not_certified(self):
        """A chain goes through a bond with its middle vertex: no verdict that none is possible."""
        self.dir.joinpath("v.xyz").write_text("".join("5\n\n" + "".join(f"A {x} {y} 0\n" for x in (0, 1, 2)) + "B 1 0 -1\nB 1 0 1\n"
                                                      for y in ("-0.40000000000000002", "0.40000000000000002")))
        self.dir.joinpath("b").write_text("1 2\n2 3\n4 5\n")
        done = self.look(0, "v.xyz", "--bonds", "b", "--every-step")
        self.assertEqual(table(done.stdout)[1][1:5], [0, 1, 1, 2])
        self.assertIn("verdict: TOUCHED", done.stdout)
        self.assertNotIn("none is possible", done.stdout)

    def test_short_bonds_are_refused(self):
        self.dir.joinpath("si.xyz").write_text("".join(f"4\n\nA 0 0 0\nA 2e-9 0 0\nB 1e-9 -1e-9 {z}\nB 1e-9 1e-9 {z}\n" for z in ("1e-9", "-1e-9")))
        self.assertIn("scale the file's lengths", self.look(2, "si.xyz", "--chain", "2").stderr)

    def test_empty_lines_between_frames(self):
        self.write("1.5", "0.5", "-0.5")
        text = self.dir.joinpath("two.xyz").read_text()
        self.dir.joinpath("two.xyz").write_text(text.replace("4\n\n", "\n4\n\n"))
        self.assertEqual(table(self.look(10, "two.xyz", "--chain", "2").stdout)[1][:2], [2, 1])

    def test_what_is_no_frame(self):
        self.write("1.5", "0.5")
        text = self.dir.joinpath("two.xyz").read_text()
        step = "ITEM: TIMESTEP\n0\n"
        for bad in (text.replace("1.5", "inf"), text.replace("4\n\n", '4\nLattice="9 0 0 0 9 0 0 0 9" pbc="T T"\n'), text + "0\n\n",
                    step + "ITEM: ATOMS id x y z\n1 0 0 0\n", step + "ITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS id x y z\n1 0 0 0\n",
                    step + "ITEM: NUMBER OF ATOMS\n-5\n", "ITEM: TIMESTEP\nnan\n",
                    "atom 0:3\nbond 0:1,2:3\ntimestep indexed\n-1 0 0 0\n"):
            self.dir.joinpath("bad").write_text(bad)
            self.assertRegex(self.look(2, "bad", *(() if bad.startswith("atom") else ("--chain", "2"))).stderr, "^uncross: .*\n$")
        self.dir.joinpath("b").write_text("99999999999999999999 1\n")
        self.assertIn("b:1:1: no bond", self.look(2, "two.xyz", "--bonds", "b").stderr)

    def test_signs_are_of_bonds_along_their_curve(self):
        """A square ring goes over a long bond: in with one side, out with the other, and the net is 0. So it is whichever way the file lists bonds."""
        ring = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
        text = "".join("6\n\n" + "".join(f"A {x + shift} {y} 0\n" for x, y in ring) + "B 0 0.25 -5\nB 0 0.125 5\n" for shift in (-2.5, -0.5, 1.75))
        self.dir.joinpath("ring.xyz").write_text(text)
        for bonds in "1 2\n2 3\n3 4\n4 1\n5 6\n", "2 1\n2 3\n4 3\n1 4\n6 5\n":
            self.dir.joinpath("b").write_text(bonds)
            self.assertEqual(table(self.look(10, "ring.xyz", "--bonds", "b").stdout)[1][1:5], [2, 0, 2, 0])

    def test_crossed_twice_is_even(self):
        self.write("1.5", "-1.5", "0.5")
        done = self.look(10, "two.xyz", "--chain", "2")
        self.assertEqual(table(done.stdout)[1][1:5], [2, 0, 2, 0])
        self.assertEqual(table(done.stdout)[2][1:5], [0, 0, 0, 0])
        self.assertIn("at 0.5 of the way", done.stdout)

    def test_one_frame(self):
        self.write("1.5")
        self.assertIn("two frames are needed", self.look(0, "two.xyz", "--chain", "2").stdout)

    def test_bonds_through_the_box(self):
        self.dir.joinpath("ring.xyz").write_text('4\nLattice="4 0 0 0 4 0 0 0 4" Properties=species:S:1:pos:R:3\n' + "".join(f"A {x} 1 1\n" for x in range(4)))
        self.assertIn("is longer than half an edge of the box", self.look(2, "ring.xyz", "--ring", "4").stderr)
        self.look(0, "ring.xyz", "--chain", "4")


if __name__ == "__main__":
    os.environ.pop("LANG", None)
    unittest.main()
