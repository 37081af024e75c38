#!/usr/bin/python3
"""`uncross export` in every format, and the recipes of docs/files.md.

What is printed is read here by parsers of its own, written from the formats' documents, and held against the datasets of
the file. LAMMPS reads the data and tells its energies, if `lmp` is installed; ASE runs its recipe, if it is.
"""
import contextlib
import importlib.util
import io
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, UNCROSS, uncross  # noqa: E402

EDGES = (6.0, 5.0, 7.0)
SCENE = """box: [6, 5, 7]
time_step: 0.01
steps: 40
seed: 3
solvent: {per_cell: 2, collision_interval: 0.02}
fibers:
  - {name: rod, count: 3, vertices: 5, mass: 2, bond_length: 0.5, spring: 100, bending: 20}
  - {name: ring, count: 2, vertices: 6, mass: 4, ring: true, bond_length: 0.5, spring: 50, bending: 3}
  - {name: bead, count: 4, vertices: 1, mass: 3, bond_length: 0, spring: 1}
  - {name: chain, count: 2, vertices: 4, mass: 1.5, bond_length: 0, spring: 3}
trajectory: {every: 10, velocities: true, solvent: true}
"""
BETWEEN_COLLISIONS = """box: [4, 4, 1]
dimensions: 2
time_step: 0.02
steps: 20
solvent: {per_cell: 10, collision_interval: 0.06, rule: at-a}
dumbbells: {spring: 2}
shear: {rate: 0.1}
trajectory: {every: 20, solvent: true}
"""
# of each kind: fibers, vertices, ring, mass, l0, k, kappa
KINDS = [(3, 5, False, 2, 0.5, 100, 20), (2, 6, True, 4, 0.5, 50, 3), (4, 1, False, 3, 0, 1, 0), (2, 4, False, 1.5, 0, 3, 0)]


def fibers():
    """(kind, its vertices) of each fiber."""
    found, first = [], 0
    for kind, (count, vertices, *_) in enumerate(KINDS):
        for _ in range(count):
            found.append((kind, list(range(first, first + vertices))))
            first += vertices
    return found


def bonds_and_angles():
    """Triples (kind, a, b) and (kind, a, b, c), by the scene alone."""
    bonds, angles = [], []
    for kind, v in fibers():
        n, (_, _, ring, _, _, _, bending) = len(v), KINDS[kind]
        bonds += [(kind, v[i], v[(i + 1) % n]) for i in range(n if ring else n - 1)]
        if bending:
            angles += [(kind, v[i - 1], v[i], v[(i + 1) % n]) for i in range(0 if ring else 1, n if ring else n - 1)]
    return bonds, angles


def energies(x):
    """Eqs. (1) and (2) of the paper, for unwrapped positions."""
    bonds, angles = bonds_and_angles()
    stretch = sum(0.5 * KINDS[k][5] * (math.dist(x[a], x[b]) - KINDS[k][4]) ** 2 for k, a, b in bonds)
    bend = 0.0
    for k, a, b, c in angles:
        p, q = x[b] - x[a], x[c] - x[b]
        bend += KINDS[k][6] * (1.0 - p @ q / math.sqrt((p @ p) * (q @ q)))
    return stretch, bend


def sections(text):
    """LAMMPS data: ({header word: number}, {section: rows})."""
    lines = text.splitlines()
    header, found, at = {}, {}, None
    for line in lines[1:]:  # the first line is a title
        words = line.partition("#")[0].split()
        if not words:
            continue
        if re.fullmatch(r"[A-Z][A-Za-z ]*", " ".join(words)):
            at = found.setdefault(" ".join(words), [])
        elif at is None:
            numbers = [float(w) for w in words if re.fullmatch(r"[-+.\deE]+", w)]
            header[" ".join(words[len(numbers):])] = numbers
        else:
            at.append([float(w) for w in words])
    return header, found


def vtf(text):
    """(atoms {number: {key: value}}, bonds, [(cell, coordinates)] of each step)."""
    atoms, bonds, steps, cell = {}, [], [], None
    for line in text.splitlines():
        words = line.partition("#")[0].split()
        if not words:
            continue
        if words[0] == "atom":
            atoms[int(words[1])] = dict(zip(words[2::2], words[3::2]))
        elif words[0] == "bond":
            bonds.append(tuple(int(w) for w in words[1].split(":")))
        elif words[0] == "unitcell":
            cell = [float(w) for w in words[1:]]
            if steps:
                steps[-1] = (cell, steps[-1][1])
        elif words[0] == "timestep":
            assert words[1] == "ordered"
            steps.append((cell, []))
        else:
            steps[-1][1].append([float(w) for w in words])
    return atoms, bonds, steps


def recipe(word):
    """The block of Python in docs/files.md that begins by importing this."""
    page = (TOP / "docs/files.md").read_text(encoding="utf-8")
    blocks = [b for b in re.findall(r"```python\n(.*?)```", page, re.S) if re.match(rf"import {word}\b", b)]
    assert len(blocks) == 1, f"{word}: {len(blocks)} blocks"
    return blocks[0]


class Formats(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        (cls.folder / "scene.yaml").write_text(SCENE)
        uncross("run", "scene.yaml", "--out", "run1", "--quiet", cwd=cls.folder, check=True)
        cls.path = cls.folder / "run1/trajectory.h5"
        with h5py.File(cls.path) as file:
            group = file["particles/trajectory"]
            cls.x, cls.v = group["position/value"][:], group["velocity/value"][:]
            cls.bonds = [tuple(pair) for pair in file["connectivity/bonds"][:].tolist()]
        cls.vertices = sum(count * vertices for count, vertices, *_ in KINDS)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def export(self, *words, path=None, code=0):
        done = uncross("export", path or self.path, *words)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stdout if code == 0 else done.stderr

    def check_lammps(self, text, frame, rows, velocities=True):
        header, found = sections(text)
        bonds, angles = bonds_and_angles()
        self.assertEqual(header["atoms"], [rows])
        self.assertEqual(header["bonds"], [len(bonds)])
        self.assertEqual(header["angles"], [len(angles)])
        for axis, edge in zip("xyz", EDGES):
            self.assertEqual(header[f"{axis}lo {axis}hi"], [0.0, edge])
        solvent = rows > self.vertices
        masses = [2, 4, 3, 1.5] + [1] * solvent
        for what in ("atom", "bond", "angle"):
            self.assertEqual(header[f"{what} types"], [4 + solvent])
        self.assertEqual(found["Masses"], [[k + 1.0, m] for k, m in enumerate(masses)])
        self.assertEqual(found["Bond Coeffs"], [[k + 1.0, kind[5] / 2, kind[4]] for k, kind in enumerate(KINDS)] + [[5, 0, 0]] * solvent)
        self.assertEqual(found["Angle Coeffs"], [[k + 1.0, kind[6]] for k, kind in enumerate(KINDS)] + [[5, 0]] * solvent)
        atoms = numpy.array(found["Atoms"])
        self.assertEqual(atoms[:, 0].tolist(), list(range(1, rows + 1)))
        molecule = [(number + 1, kind + 1) for number, (kind, v) in enumerate(fibers()) for _ in v]
        self.assertEqual([tuple(row) for row in atoms[:, 1:3]], molecule + [(0, 5)] * (rows - self.vertices))
        self.assertTrue(((atoms[:, 3:6] >= 0) & (atoms[:, 3:6] < EDGES)).all())
        unwrapped = atoms[:, 3:6] + atoms[:, 6:9] * EDGES
        self.assertLess(abs(unwrapped - self.x[frame, :rows]).max(), 1e-12)
        self.assertNotEqual(abs(atoms[:, 6:9]).max(), 0)  # or the test sees nothing of images
        self.assertEqual([tuple(row[1:]) for row in found["Bonds"]], [(k + 1, a + 1, b + 1) for k, a, b in bonds])
        self.assertEqual(sorted(tuple(row[1:]) for row in found["Angles"]),
                         sorted((k + 1, a + 1, b + 1, c + 1) for k, a, b, c in angles))
        self.assertEqual([row[0] for row in found["Bonds"]], list(range(1, len(bonds) + 1)))
        self.assertEqual(sorted((a, b) for _, a, b in bonds), sorted(self.bonds))
        if velocities:
            self.assertTrue((numpy.array(found["Velocities"])[:, 1:] == self.v[frame, :rows]).all())

    def test_lammps(self):
        self.check_lammps(self.export("--format", "lammps"), 4, self.vertices)
        self.check_lammps(self.export("--format", "lammps", "--last", "2"), 2, self.vertices)
        self.check_lammps(self.export("--format", "lammps", "--first", "0", "--stride", "3"), 3, self.vertices)
        self.check_lammps(self.export("--format", "lammps", "--solvent"), 4, self.x.shape[1])
        checkpoint = self.folder / "run1/checkpoint.h5"
        self.check_lammps(self.export("--format", "lammps", path=checkpoint), 4, self.vertices)
        self.check_lammps(self.export("--format", "lammps", "--solvent", path=checkpoint), 4, self.x.shape[1])

    def test_lammps_reads_it(self):
        if not shutil.which("lmp"):
            self.skipTest("no lmp (Debian: lammps)")
        (self.folder / "data").write_text(self.export("--format", "lammps"))
        (self.folder / "in").write_text("""units lj
atom_style molecular
bond_style harmonic
angle_style cosine
pair_style zero 2.0
comm_modify cutoff 3
read_data data
pair_coeff * *
thermo_style custom atoms ebond eangle ke
thermo_modify norm no format float %.15g
run 0
""")
        done = subprocess.run(["lmp", "-in", "in", "-log", "none"], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout)
        told = re.search(r"\nAtoms +E_bond +E_angle +KinEng *\n(.*)\n", done.stdout)[1].split()
        stretch, bend = energies(self.x[-1])
        mass = numpy.array([KINDS[kind][3] for kind, v in fibers() for _ in v])
        kinetic = 0.5 * (mass[:, None] * self.v[-1, :self.vertices] ** 2).sum()
        for found, wanted in zip(told, (self.vertices, stretch, bend, kinetic)):
            self.assertLess(abs(float(found) / wanted - 1), 1e-10, f"{found} for {wanted}")

    def check_vtf(self, text, frames, rows):
        atoms, bonds, steps = vtf(text)
        self.assertEqual(sorted(atoms), list(range(rows)))
        names = ["rod", "ring", "bead", "chain"]
        for number, (kind, v) in enumerate(fibers()):
            for vertex in v:
                self.assertEqual((atoms[vertex]["name"], atoms[vertex]["resid"], float(atoms[vertex]["mass"])),
                                 (names[kind], str(number + 1), KINDS[kind][3]))
        for row in range(self.vertices, rows):
            self.assertEqual((atoms[row]["name"], atoms[row]["type"], atoms[row]["mass"]), ("solvent", "0", "1"))
        self.assertEqual(sorted(bonds), sorted(self.bonds))
        self.assertEqual(len(steps), len(frames))
        for (cell, x), frame in zip(steps, frames):
            self.assertEqual(cell, list(EDGES))
            self.assertEqual(x, self.x[frame, :rows].tolist())  # 17 digits give back the very numbers

    def test_vtf(self):
        self.check_vtf(self.export("--format", "vtf"), [0, 1, 2, 3, 4], self.vertices)
        self.check_vtf(self.export("--format", "vtf", "--first", "1", "--stride", "2", "--solvent"), [1, 3], self.x.shape[1])
        self.check_vtf(self.export("--format", "vtf", path=self.folder / "run1/checkpoint.h5"), [4], self.vertices)
        _, _, steps = vtf(self.export("--format", "vtf", "--wrapped"))
        x = numpy.array([x for _, x in steps])
        self.assertTrue(((x >= 0) & (x < EDGES)).all())

    def check_xyz(self, text, frames, rows):
        lines = text.splitlines()
        self.assertEqual(len(lines), len(frames) * (rows + 2))
        symbols = [symbol for symbol, (count, vertices, *_) in zip("CNOF", KINDS) for _ in range(count * vertices)]
        following = {a: b for _, a, b in bonds_and_angles()[0]}
        where = [(n, place) for n, (_, v) in enumerate(fibers()) for place in range(len(v))]
        for k, frame in enumerate(frames):
            first, comment, *shown = lines[k * (rows + 2):(k + 1) * (rows + 2)]
            self.assertEqual(int(first), rows)
            self.assertEqual(comment, 'Lattice="6 0 0 0 5 0 0 0 7" Properties=species:S:1:pos:R:3:velo:R:3:id:I:1:next:I:1:fiber:I:1:place:I:1 '
                             f'pbc="T T T" Step={10 * frame} Time={frame / 10:g} kinds="C:rod N:ring O:bead F:chain{" H:solvent" * (rows > self.vertices)}"')
            for row, words in enumerate(line.split() for line in shown):
                self.assertEqual([float(word) for word in words[1:7]], [*self.x[frame, row], *self.v[frame, row]])
                wanted = [symbols[row], row, following.get(row, -1), *where[row]] if row < self.vertices else ["H", row, -1, -1, -1]
                self.assertEqual([words[0], *map(int, words[7:])], wanted)

    def test_xyz(self):
        rows = self.x.shape[1]
        self.check_xyz(self.export(), [0, 1, 2, 3, 4], self.vertices)
        self.check_xyz(self.export("--solvent"), [0, 1, 2, 3, 4], rows)
        self.check_xyz(self.export("--first", "1", "--last", "4", "--stride", "2"), [1, 3], self.vertices)
        self.check_xyz(self.export("--solvent", path=self.folder / "run1/checkpoint.h5"), [4], rows)
        self.assertIn("it has frames 0 to 4 (5 in all)", self.export("--first", "5", code=2))

    def test_plain_numbers(self):
        """docs/files.md, Plain numbers."""
        done = uncross("frames", self.path, input=b"3\n0\n", stdin=None, text=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        lines, rows = done.stdout.split(b"\n", 10), self.x.shape[1]
        self.assertEqual([*map(int, lines[0].split())], [5, rows, rows, 1, 5, 4])
        self.assertEqual(lines[1:6], [b"rod", b"ring", b"bead", b"chain", b"solvent"])
        self.assertEqual([[*map(float, line.split())] for line in lines[6:10]], [[*kind[4:7]] for kind in KINDS])
        rest = lines[10][rows * 16:]
        for frame in 3, 0:
            line, _, rest = rest.partition(b"\n")
            self.assertEqual(line.decode(), f"fine {10 * frame} {frame / 10:.17g} 6 1 5 1 7 1 0 0 0")
            for numbers in self.x, self.v:
                self.assertEqual(numpy.frombuffer(rest[:rows * 24]).reshape(rows, 3).tolist(), numbers[frame].tolist())
                rest = rest[rows * 24:]
        self.assertEqual(rest, b"")
        for word in b"5\n", b"x\n", b"-1\n", b"1" * 40:
            self.assertEqual(uncross("frames", self.path, input=word, stdin=None, text=False).returncode, 2, word)

    def test_a_program_that_ends(self):
        """Who says what the frames are may be killed in between: no half of an export is called done, and its file is gone."""
        (self.folder / "said").write_bytes(uncross("frames", self.path, input=b"0\n1\n2\n3\n4\n", stdin=None, text=False).stdout[:30000])
        program = self.folder / "stub"
        for end, code in ("exit 0", 1), ("exit 4", 4), ("kill -9 $$", 1), ("exec 0<&-\nsleep 1", 1):
            program.write_text(f"#!/bin/sh\ncat '{self.folder}/said'\n{end}\n")
            program.chmod(0o755)
            done = subprocess.run([TOP / "tools/uncross-export", self.path, "-o", self.folder / "half"], capture_output=True, check=False,
                                  env={**os.environ, "UNCROSS": str(program)}, timeout=60)
            self.assertEqual((done.returncode, done.stdout), (code, b""), done.stderr)
            self.assertEqual(b"ended early" in done.stderr, code == 1, done.stderr)
            self.assertFalse((self.folder / "half").exists())

    def test_what_ends_an_export(self):
        """Its reader has read enough; it is told to end; nobody hears its complaint. The last of two names counts."""
        program = [UNCROSS, "export", self.path]
        with subprocess.Popen([*program, "--solvent"], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as done:
            done.stdout.read(10)
            done.stdout.close()
            self.assertEqual((done.wait(60), done.stderr.read()), (-signal.SIGPIPE, b""))
        with open("/dev/full", "w", encoding="utf-8") as full:
            self.assertEqual(subprocess.run([*program, "--format", "pdb"], stderr=full, check=False).returncode, 2)
        done = subprocess.run(["sh", "-c", 'exec "$@" 2>&-', "sh", *program, "--format", "pdb"], capture_output=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (2, b""))
        stub = self.folder / "slow"
        said = uncross("frames", self.path, input=b"0\n", stdin=None, text=False).stdout
        self.assertEqual(uncross("frames", self.path, input=b"0", stdin=None, text=False).stdout, said)  # a last line may end with the file
        (self.folder / "begun").write_bytes(said[:-8])
        stub.write_text(f"#!/bin/sh\ncat '{self.folder}/begun'\nexec sleep 60\n")
        stub.chmod(0o755)
        with subprocess.Popen([TOP / "tools/uncross-export", self.path, "-o", self.folder / "cut"], env={**os.environ, "UNCROSS": str(stub)}) as done:
            while not (self.folder / "cut").exists():
                time.sleep(0.05)
            time.sleep(0.5)
            done.terminate()
            self.assertEqual(done.wait(60), 128 + signal.SIGTERM)
        self.assertFalse((self.folder / "cut").exists())
        subprocess.run([*program, "--out", self.folder / "first", "-o", self.folder / "last"], check=True)
        self.assertEqual([(self.folder / name).exists() for name in ("first", "last")], [False, True])

    def test_formats(self):
        self.assertEqual(self.export(), self.export("--format", "xyz"))
        self.assertIn("--format pdb: no such format; there are xyz, lammps, lammps-dump, vtf", self.export("--format", "pdb", code=2))

    def test_checkpoint_between_collisions(self):
        """What is between collisions flies as the scene says, with springs and in the shear, from a checkpoint as in the frame of the same step."""
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "scene.yaml").write_text(BETWEEN_COLLISIONS)
            uncross("run", f"{folder}/scene.yaml", "--out", f"{folder}/r")
            rows = [uncross("export", f"{folder}/r/{name}.h5", "--solvent").stdout.splitlines()[-160:] for name in ("checkpoint", "trajectory")]
        self.assertEqual(len(rows[0]), 160)
        for kept, shown in zip(*([[float(x) for x in row.split()[1:7]] for row in lines] for lines in rows)):
            numpy.testing.assert_allclose(kept, shown, rtol=0, atol=1e-12)

    def test_foreign(self):
        """Of a file without masses, kinds and scene: one species of mass 1, all of its bonds, no angles."""
        path = self.folder / "foreign.h5"
        with h5py.File(path, "w") as file:
            box = file.create_group("particles/all/box")
            box.attrs["dimension"] = 3
            box.attrs["boundary"] = numpy.array([b"periodic"] * 3)
            box["edges"] = numpy.array([4.0, 4.0, 4.0])
            position = file.create_group("particles/all/position")
            position["value"] = numpy.array([[[0.5, 1, 1], [-0.5, 1, 1], [9, 1, 1]]])
            position["step"] = numpy.array([7])
            position["time"] = numpy.array([0.07])
            file["connectivity/bonds"] = numpy.array([[0, 1], [1, 2]], dtype=numpy.int32)
        header, found = sections(self.export("--format", "lammps", path=path))
        self.assertEqual((header["atoms"], header["bonds"], header["angles"]), ([3], [2], [0]))
        self.assertEqual(found["Masses"], [[1, 1]])
        self.assertEqual(found["Atoms"], [[1, 1, 1, 0.5, 1, 1, 0, 0, 0], [2, 1, 1, 3.5, 1, 1, -1, 0, 0],
                                          [3, 1, 1, 1, 1, 1, 2, 0, 0]])
        self.assertNotIn("Bond Coeffs", found)
        for masses, code in (([2.0, 2.0, 2.0], 0), ([2.0, 3.0, 2.0], 2), ([0.0, 0.0, 0.0], 2), ([math.nan] * 3, 2),
                             ([[1.0, 1.0, 1.0]], 0)):
            with h5py.File(path, "a") as file:
                group = file["particles/all"]
                if "mass" in group:
                    del group["mass"]
                group["mass"] = numpy.array(masses)
            said = self.export("--format", "lammps", path=path, code=code)
            if code:
                self.assertIn("LAMMPS data have one mass for each", said)
            else:
                self.assertEqual(sections(said)[1]["Masses"], [[1, 2 if masses[0] == 2.0 else 1]])

        for species, code in (([0, 4096, 0], 0), ([0, 4097, 0], 2), ([2 ** 31 - 1] * 3, 2), ([-1, 0, 0], 0)):
            with h5py.File(path, "a") as file:
                group = file["particles/all"]
                if "species" in group:
                    del group["species"]
                group["species"] = numpy.array(species, dtype=numpy.int32)
            said = self.export("--format", "lammps", path=path, code=code)
            self.assertTrue(code == 0 or "species of row" in said, said)
            self.export("--format", "vtf", path=path)

    def test_damaged_mass(self):
        """Its checksum is looked at."""
        path = self.folder / "damaged.h5"
        shutil.copy(self.path, path)
        with h5py.File(path, "a") as file:
            file["particles/trajectory/mass"][3] = 2.5
        self.assertIn("damaged", self.export("--format", "lammps", path=path, code=2))

    def run_recipe(self, word, module):
        """What a recipe leaves in its names; run where a run's folder is the working folder."""
        text = (recipe("h5py") if word == "MDAnalysis" else "") + recipe(word)
        if module and importlib.util.find_spec(module) is None:
            self.skipTest(f"no {module}")
        names, here = {}, os.getcwd()
        try:
            os.chdir(self.folder / "run1")
            (self.folder / "run1.xyz").write_text(self.export())
            with contextlib.redirect_stdout(io.StringIO()):
                exec(compile(text, f"docs/files.md: {word}", "exec"), names)  # pylint: disable=exec-used
        finally:
            os.chdir(here)
        return names

    def test_recipe_h5py(self):
        got = self.run_recipe("h5py", None)
        kinds = ["rod", "ring", "bead", "chain", "solvent"]
        solvent = self.x.shape[1] - self.vertices
        self.assertEqual(got["types"].tolist(), [kinds[k] for k, v in fibers() for _ in v] + ["solvent"] * solvent)
        self.assertEqual(got["masses"].tolist(), [KINDS[k][3] for k, v in fibers() for _ in v] + [1.0] * solvent)
        self.assertEqual(sorted(map(tuple, got["bonds"].tolist())), sorted((a, b) for _, a, b in bonds_and_angles()[0]))
        self.assertEqual(got["fiber"].tolist()[:self.vertices], [n for n, (_, v) in enumerate(fibers()) for _ in v])
        self.assertTrue((got["frames"] == self.x).all())

    def test_recipe_mdanalysis(self):
        got = self.run_recipe("MDAnalysis", "MDAnalysis")
        universe = got["universe"]
        self.assertEqual(len(universe.bonds), len(self.bonds))
        self.assertEqual(len(universe.trajectory), 5)
        self.assertEqual(universe.select_atoms("type ring").n_atoms, 12)
        self.assertEqual(universe.residues[3].atoms.n_atoms, 6)
        self.assertLess(abs(universe.trajectory[4].positions - self.x[4]).max(), 1e-5)  # single precision

    def test_recipe_ase(self):
        got = self.run_recipe("ase", "ase")
        frames = got["frames"]
        self.assertEqual(len(frames), 5)
        last = frames[-1]
        self.assertEqual(last.get_masses().tolist(), [KINDS[k][3] for k, v in fibers() for _ in v])
        self.assertLess(abs(last.positions - self.x[4, :self.vertices]).max(), 1e-14)
        self.assertEqual(sorted(tuple(sorted(map(int, pair))) for pair in got["bonds"]),
                         sorted(tuple(sorted(pair)) for pair in self.bonds))
        self.assertEqual(last.arrays["fiber"].tolist(), [n for n, (_, v) in enumerate(fibers()) for _ in v])


if __name__ == "__main__":
    unittest.main()
