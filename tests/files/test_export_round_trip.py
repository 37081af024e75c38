#!/usr/bin/python3
"""What `uncross export` prints, read back by parsers of its own: every format, in every box.

Positions are those of the file modulo the cell that the text names, along the axes that it calls periodic; bonds have the
energy that they have in the file; velocities are of the image that is shown. The cell of a sheared box is known in closed
form: its image beyond y = L has slid by rate t L.
"""
import pathlib
import re
import sys
import tempfile
import unittest

import h5py
import numpy

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from support import uncross  # noqa: E402
from test_formats import sections  # noqa: E402

EDGES = numpy.array([8.0, 4.0, 6.0])
RATE, DT, SPRING, LENGTH = 0.75, 0.01, 100.0, 0.5
SCENE = f"""box: [8, 4, 6]
time_step: {DT}
steps: 250
seed: 11
solvent: {{per_cell: 3, collision_interval: 0.02, rule: at-a}}
trajectory: {{every: 50, velocities: true, solvent: true}}
"""
FIBERS = f"""fibers:
  - {{name: fiber, count: 6, vertices: 8, mass: 2, bond_length: {LENGTH}, spring: {SPRING:g}, bending: 4}}
"""
BOXES = {"periodic": ("", "TTT"), "sheared": (f"shear: {{rate: {RATE}}}\n", "TTT"),
         "walls": ("walls: {kind: no-slip, shear_rate: 0.1}\n", "TFT")}


def slide(step):
    """Of the image beyond y = L, a0."""
    return RATE * step * DT * EDGES[1]


class Frame:
    """cell: the three vectors that repeat it; image: numbers of them taken off, where the format tells them."""

    def __init__(self, cell, periodic, x, v, image=None):
        self.cell, self.periodic, self.x, self.v, self.image = numpy.array(cell), periodic, numpy.array(x), numpy.array(v), image


def read_xyz(text):
    """([frames], {(a, b)})"""
    lines, frames, bonds, at = text.splitlines(), [], set(), 0
    while at < len(lines):
        n, comment = int(lines[at]), lines[at + 1]
        rows = [line.split() for line in lines[at + 2:at + 2 + n]]
        cell = numpy.array([float(w) for w in re.search(r'Lattice="([^"]*)"', comment)[1].split()]).reshape(3, 3)
        periodic = re.search(r'pbc="([^"]*)"', comment)[1].replace(" ", "")
        number = {row[7]: k for k, row in enumerate(rows)}
        bonds = {(number[row[7]], number[row[8]]) for row in rows if row[8] != "-1"}
        frames.append(Frame(cell, periodic, [[float(w) for w in row[1:4]] for row in rows], [[float(w) for w in row[4:7]] for row in rows]))
        at += 2 + n
    return frames, bonds


def words_of_boundary(words):
    return "".join("T" if word.strip("p") == "" else "F" for word in words)


def read_data(text):
    header, found = sections(text)
    cell = numpy.diag([header[f"{k}lo {k}hi"][1] for k in "xyz"])
    cell[1, 0] = header.get("xy xz yz", [0.0])[0]
    atoms = numpy.array(found["Atoms"])
    periodic = words_of_boundary(re.search(r"boundary (.) (.) (.)", text.splitlines()[0]).groups())
    frame = Frame(cell, periodic, atoms[:, 3:6], numpy.array(found["Velocities"])[:, 1:], atoms[:, 6:9])
    return [frame], {(int(row[2]) - 1, int(row[3]) - 1) for row in found.get("Bonds", [])}


def read_dump(text):
    frames = []
    for block in text.split("ITEM: TIMESTEP\n")[1:]:
        items = dict(re.findall(r"ITEM: (NUMBER OF ATOMS|BOX BOUNDS|ATOMS)[^\n]*\n((?:[^I][^\n]*\n)*)", block))
        kinds = re.search(r"ITEM: BOX BOUNDS ([^\n]*)", block)[1].split()
        names = re.search(r"ITEM: ATOMS ([^\n]*)", block)[1].split()
        bounds = [[float(w) for w in line.split()] for line in items["BOX BOUNDS"].splitlines()]
        tilt = bounds[0][2] if kinds[0] == "xy" else 0.0
        low = bounds[0][0] - min(0.0, tilt), bounds[1][0], bounds[2][0]
        high = bounds[0][1] - max(0.0, tilt), bounds[1][1], bounds[2][1]
        assert low == (0.0, 0.0, 0.0)
        cell = numpy.diag(high)
        cell[1, 0] = tilt
        rows = numpy.array([[float(w) for w in line.split()] for line in items["ATOMS"].splitlines()])
        assert len(rows) == int(items["NUMBER OF ATOMS"])
        rows = rows[rows[:, names.index("id")].argsort()]
        pick = lambda *these: rows[:, [names.index(name) for name in these]]  # noqa: E731
        frames.append(Frame(cell, words_of_boundary(kinds[-3:]), pick("x", "y", "z"), pick("vx", "vy", "vz"), pick("ix", "iy", "iz")))
    return frames, None


def read_vtf(text):
    frames, bonds, cell = [], set(), None
    for line in text.splitlines():
        words = line.partition("#")[0].split()
        if not words or words[0] == "atom":
            continue
        if words[0] == "unitcell":
            a, b, c, *angles = [float(w) for w in words[1:]]
            alpha, beta, gamma = numpy.radians(angles or [90.0] * 3)
            assert abs(numpy.cos(alpha)) < 1e-15 and abs(numpy.cos(beta)) < 1e-15
            cell = numpy.array([[a, 0, 0], [b * numpy.cos(gamma), b * numpy.sin(gamma), 0], [0, 0, c]])
            if frames:
                frames[-1].cell = cell
        elif words[0] == "bond":
            bonds.add(tuple(int(w) for w in words[1].split(":")))
        elif words[0] == "timestep":
            frames.append(Frame(cell, None, [], []))
        else:
            frames[-1].x = numpy.append(frames[-1].x, [float(w) for w in words])
    for frame in frames:
        frame.x = frame.x.reshape(-1, 3)
    return frames, bonds


READERS = {"xyz": read_xyz, "lammps": read_data, "lammps-dump": read_dump, "vtf": read_vtf}


class RoundTrip(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        for box, (keys, _) in BOXES.items():
            for name, fibers in (("fibers", FIBERS), ("solvent", "")):
                (cls.folder / "scene.yaml").write_text(SCENE + keys + fibers)
                uncross("run", "scene.yaml", "--out", f"{box}-{name}", "--quiet", cwd=cls.folder, check=True)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def check_cell(self, frame, box, step):
        keys = numpy.diag(EDGES)
        if box == "sheared":
            keys[1, 0] = frame.cell[1, 0]
            away = (frame.cell[1, 0] - slide(step)) / EDGES[0]
            self.assertLess(abs(away - round(away)), 1e-9)
            self.assertLessEqual(abs(frame.cell[1, 0]), EDGES[0] / 2)  # which LAMMPS asks for
        numpy.testing.assert_allclose(frame.cell, keys, rtol=0, atol=1e-12)

    def check_frame(self, frame, box, step, x, v, in_box):
        """x, v: of the file. in_box: the text says that all are in the cell."""
        self.check_cell(frame, box, step)
        periodic = numpy.array([c == "T" for c in BOXES[box][1]])
        if frame.periodic is not None:
            self.assertEqual(frame.periodic, BOXES[box][1])
        self.assertEqual(frame.x.shape, x.shape)
        places = frame.x @ numpy.linalg.inv(frame.cell)
        images = (x - frame.x) @ numpy.linalg.inv(frame.cell)
        self.assertLess(abs(images - images.round()).max(), 1e-9)
        self.assertTrue((images.round()[:, ~periodic] == 0).all())
        if in_box:
            self.assertTrue((places[:, periodic] > -1e-9).all() and (places[:, periodic] < 1 + 1e-9).all())
        if frame.image is not None:
            self.assertTrue((frame.image == images.round()).all())
        if len(frame.v):
            shown = v.copy()
            shown[:, 0] -= images.round()[:, 1] * (RATE * EDGES[1] if box == "sheared" else 0.0)
            numpy.testing.assert_allclose(frame.v, shown, rtol=0, atol=1e-9)

    def stretch(self, x, bonds, cell=None):
        """Energy of the bonds, kT; with a cell, between nearest images."""
        a, b = numpy.array(sorted(bonds)).T
        d = x[b] - x[a]
        if cell is not None:
            d -= (d @ numpy.linalg.inv(cell)).round() @ cell
        return 0.5 * SPRING * ((numpy.linalg.norm(d, axis=1) - LENGTH) ** 2).sum()

    def check(self, box, name, form, file, words):
        done = uncross("export", self.folder / f"{box}-{name}/{file}.h5", "--format", form, *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        with h5py.File(self.folder / f"{box}-{name}/trajectory.h5") as h5:
            group = h5["particles/trajectory"]
            x, v = group["position/value"][:], group["velocity/value"][:]
            steps, bonds = group["position/step"][:], {tuple(pair) for pair in h5["connectivity/bonds"][:].tolist()}
        rows = x.shape[1] if "--solvent" in words or name == "solvent" else 48
        frames, told = READERS[form](done.stdout)
        first = len(steps) - 1 if form == "lammps" or file == "checkpoint" else 0
        self.assertEqual(len(frames), len(steps) - first)
        self.assertTrue(told is None or told == bonds)
        for frame, step, here, u in zip(frames, steps[first:], x[first:, :rows], v[first:, :rows]):
            folded = "--wrapped" in words or form.startswith("lammps")
            self.check_frame(frame, box, step, here, u, folded)
            if bonds:
                self.assertAlmostEqual(self.stretch(frame.x, bonds, frame.cell if folded else None), self.stretch(here, bonds), 6)

    def test_all(self):
        for box in BOXES:
            for name in ("fibers", "solvent"):
                for form in READERS:
                    for file in ("trajectory", "checkpoint"):
                        for words in ((), ("--wrapped",), ("--solvent", "--wrapped")):
                            with self.subTest(box=box, name=name, form=form, file=file, words=words):
                                self.check(box, name, form, file, words)

    def test_numbers_are_short(self):
        """As tables have them: no more digits than Python needs to read back the same number."""
        for form in READERS:
            said, many = uncross("export", self.folder / "sheared-fibers/trajectory.h5", "--format", form).stdout, 0
            for word in re.findall(r"(?<![\w.])-?\d+\.\d+(?:e[-+]\d+)?", said):
                many += 1
                self.assertLessEqual(len(re.sub(r"e.*|\D", "", word).lstrip("0")), len(re.sub(r"e.*|\D", "", repr(float(word))).lstrip("0")), (form, word))
            self.assertGreater(many, 100)

    def test_vertices_leave_the_box(self):
        """Or nothing above is folded: along y, some of them, when the image has slid by no whole number of boxes."""
        with h5py.File(self.folder / "sheared-fibers/trajectory.h5") as h5:
            y = h5["particles/trajectory/position/value"][:, :48, 1]
        self.assertGreater(((y[1:] < 0) | (y[1:] >= EDGES[1])).sum(), 10)
        self.assertGreater(min(abs(slide(step) / EDGES[0] - round(slide(step) / EDGES[0])) for step in (50, 100, 150)), 0.05)


if __name__ == "__main__":
    unittest.main()
