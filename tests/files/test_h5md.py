"""Others read our files: h5py finds what H5MD 1.1 (https://nongnu.org/h5md/h5md.html) asks for, and everything that the
H5MDReader of MDAnalysis 2.x touches (coordinates/H5MD.py), and the numbers are those that the program had in memory."""
import os
import pathlib
import subprocess
import tempfile
import unittest

import h5py
import numpy

BUILD = pathlib.Path(os.environ.get("BUILD", "build"))
CELLS = (6, 5, 7)
LATTICE = 2.0**40


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        subprocess.run([BUILD / "tests/files/test_trajectory", "sample", cls.folder.name], check=True)
        lines = pathlib.Path(cls.folder.name, "expected.txt").read_text().splitlines()
        cls.step, cls.vertices, cls.solvent = map(int, lines[0].split())
        rows = [line.split() for line in lines[1:]]
        cls.lattice = numpy.array([[int(x) for x in row[:3]] for row in rows])
        cls.velocity = numpy.array([[float.fromhex(x) for x in row[3:6]] for row in rows])
        cls.next = numpy.array([int(row[6]) for row in rows])
        cls.mass = numpy.array([float(row[7]) for row in rows])

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def open(self, name):
        file = h5py.File(pathlib.Path(self.folder.name, name), "r")
        self.addCleanup(file.close)
        return file

    def each(self):
        for name, rows in ("all.h5", self.vertices + self.solvent), ("fibers.h5", self.vertices):
            yield self.open(name), rows

    def test_h5md_metadata(self):
        for file, _ in self.each():
            h5md = file["h5md"]
            self.assertEqual(list(h5md.attrs["version"]), [1, 1])
            self.assertTrue(numpy.issubdtype(h5md.attrs["version"].dtype, numpy.integer))
            self.assertEqual(h5md["author"].attrs["name"], b"uncross")
            self.assertEqual(h5md["creator"].attrs["name"], b"uncross")
            self.assertTrue(h5md["creator"].attrs["version"])
            self.assertLessEqual(set(file), {"h5md", "particles", "connectivity", "parameters"})

    def test_h5md_box(self):
        for file, _ in self.each():
            box = file["particles/trajectory/box"]
            self.assertEqual(box.attrs["dimension"], 3)
            self.assertEqual(list(box.attrs["boundary"]), [b"periodic"] * 3)
            self.assertEqual(box["edges/value"].shape, (6, 3, 3))
            self.assertTrue((box["edges/value"][:] == numpy.diag(CELLS)).all())

    def test_h5md_time(self):
        """One step and one time for all elements, as hard links."""
        for file, _ in self.each():
            group = file["particles/trajectory"]
            for name in "step", "time":
                for element in "velocity", "box/edges":
                    self.assertEqual(group["position"][name], group[element][name])
                    self.assertIsInstance(group[element].get(name, getlink=True), h5py.HardLink)
            self.assertEqual(list(group["position/step"]), [5, 10, 15, 20, 25, 30])
            self.assertTrue(numpy.issubdtype(group["position/step"].dtype, numpy.integer))
            self.assertTrue((group["position/time"][:] == 0.01 * group["position/step"][:]).all())

    def test_h5md_particles(self):
        for file, rows in self.each():
            group = file["particles/trajectory"]
            for element in "position", "velocity":
                self.assertEqual(group[element]["value"].shape, (6, rows, 3))
                self.assertEqual(group[element]["value"].dtype, "<f8")
            self.assertTrue((group["id"][:] == numpy.arange(rows)).all())
            self.assertTrue((group["mass"][: self.vertices] == self.mass).all())
            self.assertTrue((group["mass"][self.vertices :] == 1.0).all())
            names = h5py.check_enum_dtype(group["species"].dtype)
            self.assertEqual(names, {"kind1": 0, "kind2": 1, "solvent": 2})
            self.assertTrue((group["species"][:] == [0] * 40 + [1] * 18 + [2] * (rows - 58)).all())

    def test_numbers(self):
        for file, _ in self.each():
            position = file["particles/trajectory/position/value"][-1]
            self.assertTrue((position[: self.vertices] * LATTICE == self.lattice).all())
            self.assertTrue((file["particles/trajectory/velocity/value"][-1][: self.vertices] == self.velocity).all())
            solvent = position[self.vertices :]
            self.assertTrue(((solvent >= 0) & (solvent < CELLS)).all())

    def test_connectivity(self):
        for file, _ in self.each():
            bonds = file["connectivity/bonds"]
            self.assertEqual(file[bonds.attrs["particles_group"]], file["particles/trajectory"])
            bonded = numpy.flatnonzero(self.next >= 0)
            self.assertTrue((bonds[:] == numpy.stack([bonded, self.next[bonded]], axis=1)).all())

    def test_as_mdanalysis_reads(self):
        """The accesses of H5MDReader (convert_units=False), in its order; both its older and its newer way with a box."""
        for file, rows in self.each():
            self.assertEqual(list(file["particles"]), ["trajectory"])
            group = file["particles"][list(file["particles"])[0]]
            self.assertEqual(group["box"].attrs["dimension"], 3)
            has = {name: name in group for name in ("position", "velocity", "force")}
            self.assertEqual(has, {"position": True, "velocity": True, "force": False})
            self.assertEqual(group["position"]["value"].shape[1], rows)
            self.assertNotIn("observables", file)
            for element in group["position/value"], group["velocity/value"], group["position/time"]:
                self.assertNotIn("unit", element.attrs)  # a unit that is not in MDAnalysis' list is an error
            for frame in range(group["position"]["value"].shape[0]):
                self.assertEqual(group["position"]["step"][frame], 5 * frame + 5)
                cell = numpy.zeros((3, 3))
                cell[:] = group["box/edges/value"][frame, :]  # 2.0: a vector would be broadcast to a wrong cell
                self.assertTrue((cell == numpy.diag(CELLS)).all())
                self.assertEqual(group["box/edges/value"][frame, :].shape, (3, 3))  # 2.1 on: triclinic_box(*edges)
                for element in "position", "velocity":
                    into = numpy.zeros((rows, 3), dtype=numpy.float32)
                    group[f"{element}/value"].read_direct(into, source_sel=numpy.s_[frame, :])
                    self.assertTrue(into.any())
                self.assertAlmostEqual(group["position"]["time"][frame], 0.05 * (frame + 1))

    def test_scene_and_times(self):
        """The scene is in the file; no object carries the time of day."""
        for file, _ in self.each():
            self.assertEqual(file["parameters/uncross/scene"][()], b"a: 1\n")
            names = ["."]
            file.visit(names.append)
            for name in names:
                self.assertEqual(h5py.h5g.get_objinfo(file[name].id).mtime, 0, name)

    def test_checkpoint(self):
        file = self.open("checkpoint.h5")
        self.assertEqual(file.attrs["format"], b"uncross checkpoint")
        self.assertEqual(file["state"].attrs["step"], self.step)
        self.assertEqual(file["state/vertex_position"].dtype, "<i8")
        self.assertTrue((file["state/vertex_position"][:] == self.lattice).all())
        self.assertTrue((file["state/vertex_velocity"][:] == self.velocity).all())
        self.assertEqual(file["state/solvent_position"].shape, (self.solvent, 3))
        self.assertEqual(list(file["structure"].attrs["cells"]), list(CELLS))


if __name__ == "__main__":
    unittest.main()
