#!/usr/bin/python3
"""`uncross oracle compare` asks uncross-name which mistake makes a difference: from the verdict in C to the name, with mistakes
planted in the port to NumPy. `ports/numpy/check` does so for the whole catalogue, in one process.
"""
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import types
import unittest
import unittest.mock

import h5py
import numpy as np

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TOP / "python"), str(TOP / "ports/numpy")]

from uncross_name import anything, case, catalogue, evidence, search  # noqa: E402
from uncross_port import operators, pack  # noqa: E402

UNCROSS = pathlib.Path(os.environ.get("UNCROSS", TOP / "build/uncross")).resolve()
DATA = TOP / "reference-data"
MISTAKES = {mistake.name: mistake for mistake in catalogue.read()}


def compare(theirs, *options, ours="mixed", **how):
    words = [UNCROSS, "oracle", "compare", ours if isinstance(ours, pathlib.Path) else DATA / f"{ours}.pack.h5", theirs, *options]
    return subprocess.run(words, capture_output=True, text=True, check=False, **how)


def meaning(said):
    lines = [line for line in said.splitlines() if line.startswith("this pattern: ")]
    return lines[0].removeprefix("this pattern: ") if lines else None


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def broken(self, name, *names, ours="mixed"):
        """A port's outputs with a mistake in these operators."""
        modules, given = catalogue.plant(MISTAKES[name]), pack.read(DATA / f"{ours}.pack.h5")
        out = modules["operators"].run({place: tables for place, tables in given.items() if place[0] in ("model", *names)})
        pack.write(self.dir / "theirs.h5", out)
        return self.dir / "theirs.h5"


class HookTest(Folder):
    def test_names(self):
        for name, operator in (("kick without the mass", "kick"), ("momentum without the mass", "sum"), ("bonds push", "bond_force")):
            done = compare(self.broken(name, operator), "--only", operator)
            self.assertEqual(done.returncode, 7, done.stderr)
            self.assertIn(MISTAKES[name].text, meaning(done.stdout))

    def test_the_simplest_operator_is_asked(self):
        """A constant force that is read wrongly shows in drifts, too, which come first in a pack."""
        mistake = catalogue.Mistake("", "", (("model.py", "constant_force=vertex[:, 4:7],", "constant_force=vertex[:, 3:6],"),), "", {})
        given = pack.read(DATA / "events.pack.h5")
        some = {place: tables for place, tables in given.items() if place[0] in ("model", "long_event_drift", "force")}
        pack.write(self.dir / "theirs.h5", catalogue.plant(mistake)["operators"].run(some))
        done = compare(self.dir / "theirs.h5", "--only", "long_event_drift,force", ours="events")
        self.assertIn("first difference: long_event_drift", done.stdout)
        self.assertIn("in force: constant force of the model is read from columns 4 to 6 of vertex", meaning(done.stdout))

    def changed(self, ours, names, *changes):
        """A port's outputs of these operators with changes of lines, (file, line, what stands there), that no list has."""
        given = pack.read(DATA / f"{ours}.pack.h5")
        some = {place: tables for place, tables in given.items() if place[0] in ("model", *names)}
        pack.write(self.dir / "theirs.h5", catalogue.plant(catalogue.Mistake("", "", changes, "", {}))["operators"].run(some))
        return meaning(compare(self.dir / "theirs.h5", "--only", ",".join(names), ours=ours).stdout)

    def test_other_operators_say_no(self):
        """A wrong product of vectors would show in exchanges, too, which are right."""
        said = self.changed("mixed", ("bend_force", "exchange"), ("fiber.py", "cosine, stiffness = dot(unit0, unit1)[:, None], model.bending[middle, None]",
                                                                   "cosine, stiffness = dot(unit1, unit1)[:, None], model.bending[middle, None]"))
        self.assertIn("`dot(unit1, unit1)` for `dot(unit0, unit1)` (fiber.add_bends)", said)
        self.assertNotIn("lattice.dot", said)

    def test_what_else_makes_the_same_numbers(self):
        """Rest lengths are 1/2 in this pack: a stretch relative to them is twice the stretch."""
        said = self.changed("andersen", ("bond_force",), ("fiber.py", "pull = spring * (length - rest) * ((1 / length) * vector)",
                                                          "pull = 2 * spring * (length - rest) * ((1 / length) * vector)"))
        self.assertIn("the stretch relative to l0", said)
        self.assertIn("the same numbers here: ", said)
        self.assertIn("2.0 * (spring * (length - rest)", said)
        self.assertTrue(said.startswith("this pack does not tell which: "), said)

    def test_contacts_that_differ(self):
        """Of a drift, what follows the first contact that differs is not run with each change."""
        said = self.changed("contacts", ("event_drift",), ("events.py", "if volume < 0 or (volume == 0 and approach < 0):",
                                                           "if volume > 0 or (volume == 0 and approach < 0):"))
        self.assertIn("`volume > 0 or (volume == 0 and approach < 0)` for `volume < 0", said)

    def test_digits_that_are_lost(self):
        ours = pack.read(DATA / "mixed.pack.h5")
        out = {place: {name: np.vectorize(lambda x: float(f"{x:.12g}"))(values) if values.dtype.kind == "f" and values.size else values
                       for name, values in tables.items() if name.startswith("out.")} for place, tables in ours.items() if place[0] in ("random", "kick")}
        pack.write(self.dir / "theirs.h5", out)
        self.assertIn("reals are written with 12 significant digits only", meaning(compare(self.dir / "theirs.h5").stdout))

    def test_what_says_nothing_of_digits(self):
        """Zeros in place of residues, whatever they were; and numbers of 100 to 900, of which whole ones have three digits."""
        def said(ours, theirs):
            found = types.SimpleNamespace(real=True, same_shape=True, ours=np.array(ours), theirs=np.array(theirs))
            return anything.printed(types.SimpleNamespace(tables=[found], elsewhere=[]))
        residues = [k * 1e-13 for k in range(1, 40)]
        self.assertIsNone(said(residues, [0.0] * 39))
        self.assertIsNone(said(residues, [math.nan] * 39))
        sizes = [100.3 + 20.1 * k for k in range(39)]
        self.assertIn("written with 3 significant digits or 0 digits after the point only", said(sizes, [round(x) for x in sizes]))
        sizes = [1.03 * 1.4**k for k in range(39)]
        self.assertIn("written with 2 digits after the point only", said(sizes, [round(x, 2) for x in sizes]))

    def test_time_that_is_over(self):
        """An operator that could not be asked says neither yes nor no, and that is said."""
        class Clock:
            def left(self):
                return 0.5
        outputs = types.SimpleNamespace(clock=Clock(), of=lambda other: None)
        mistake = catalogue.Mistake("", "", (), "", {})
        fit = search.Fit(mistake, evidence.WHOLE, 100.0, True, "")
        with unittest.mock.patch.object(catalogue, "reaches", lambda *_: True):
            held = search.held([fit], types.SimpleNamespace(elsewhere=[types.SimpleNamespace(operator="kick")]), outputs)
        self.assertEqual([one.only for one in held], [search.UNASKED])

    def test_one_table_only(self):
        """What is rotated the wrong way round are the vertices alone."""
        said = self.changed("mixed", ("rotate",), ("solvent.py", "turned = center[cell] + factor[cell, None] * turn(model, velocity - center[cell], axis[cell])",
                                                   "turned = center[cell] + factor[cell, None] * turn(model, velocity - center[cell], axis[cell] * (1 if len(velocity) == model.particles else -1))"))
        self.assertIn("rotation transposed: turned by -alpha", said)
        self.assertIn("(in out.vertex only)", said)

    def test_another_order_of_operations(self):
        """All is within tolerance, but each bit is that of one other order."""
        said = self.changed("mixed", ("bond_force",), ("lattice.py", "return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]",
                                                       "return a[..., 0] * b[..., 0] + (a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2])"))
        self.assertIn("within tolerance; bit for bit: `a[..., 0] * b[..., 0] + (a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2])` for ", said)

    def test_other_rounding_is_still_named(self):
        """A port in another language is off by last bits, too."""
        path = self.broken("kick without the mass", "kick")
        with h5py.File(path, "r+") as file:
            for group in file.values():
                values = group["out.velocity"][:]
                group["out.velocity"][...] = np.where(np.arange(len(values))[:, None] % 2, np.nextafter(values, 9), values)
        self.assertIn(MISTAKES["kick without the mass"].text, meaning(compare(path, "--only", "kick").stdout))

    def test_no_name(self):
        path = self.broken("kick without the mass", "kick")
        done = compare(path, "--only", "kick", "--no-name")
        self.assertEqual((done.returncode, meaning(done.stdout)), (7, None))
        self.assertIn("first difference: kick", done.stdout)

    def test_case(self):
        """The file has what the operator is given, what both give, and how much that may differ."""
        path = self.broken("kick without the mass", "kick")
        done = compare(path, "--only", "kick", "--case", self.dir / "case.h5")
        self.assertEqual((done.returncode, meaning(done.stdout)), (7, None))
        ours, theirs = pack.read(DATA / "mixed.pack.h5"), pack.read(path)
        found = case.read(self.dir / "case.h5")
        self.assertEqual((found.operator, found.first.table, found.single), ("kick", "out.velocity", False))
        for part in found.first.parts:
            rows = slice(part.first, part.first + part.rows)
            self.assertTrue((found.first.ours[rows] == ours["kick", part.step]["out.velocity"]).all())
            self.assertTrue((found.first.theirs[rows] == theirs["kick", part.step]["out.velocity"]).all())
            self.assertTrue((part.tables["in.force"] == ours["kick", part.step]["in.force"]).all())
        self.assertTrue(((found.first.tolerance > 0) & (found.first.tolerance < 1e-12)).all())
        with self.assertRaises(ValueError):  # a mistake may write where it should read
            found.inputs[part.step]["force"][0, 0] = 1.0
        self.assertEqual(compare(path, "--only", "kick", "--case", self.dir / "case.h5").returncode, 2, "it is there already")

    def stand_in(self, text):
        """A copy of the program, beside which another uncross-name stands."""
        program = self.dir / "build/uncross"
        (program.parent / "libexec").mkdir(parents=True)
        program.write_bytes(UNCROSS.read_bytes())
        program.chmod(0o755)
        if text:
            (program.parent / "libexec/uncross-name").write_text(text)
            (program.parent / "libexec/uncross-name").chmod(0o755)
        return program

    def test_without_the_program(self):
        """The verdict stays; the line says what is missing."""
        path = self.broken("kick without the mass", "kick")
        for text, said in ((None, "no name: there is no program "), ("#!/nowhere/python3\n", "it needs /usr/bin/python3, which `apt-get install python3` installs"),
                           ("#!/bin/sh\nexit 3\n", "no name: uncross-name ended with exit code 3"), ("#!/bin/sh\n", "no name: uncross-name says nothing"),
                           ("#!/bin/sh\nprintf 'a\\033[31mb\\nc\\n'\n", "a\\x1b[31mb")):
            program = self.stand_in(text)
            words = [program, "oracle", "compare", DATA / "mixed.pack.h5", path, "--only", "kick"]
            done = subprocess.run(words, capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 7, done.stderr)
            self.assertIn(said, meaning(done.stdout))
            subprocess.run(["rm", "-r", program.parent], check=True)

    def test_surroundings(self):
        """Settings of Python do not change a name; a folder for scratch that is not there is said."""
        path = self.broken("kick without the mass", "kick")
        done = compare(path, "--only", "kick", env=os.environ | {"PYTHONWARNINGS": "error", "PYTHONPATH": str(self.dir)})
        self.assertIn(MISTAKES["kick without the mass"].text, meaning(done.stdout))
        done = compare(path, "--only", "kick", env=os.environ | {"TMPDIR": str(self.dir / "nowhere")})
        self.assertEqual(done.returncode, 7)
        self.assertRegex(meaning(done.stdout), "^no name: .*/nowhere/.*: cannot create: ")

    def test_tables_that_no_operator_has(self):
        """A pack may come from anywhere, and may have tables of the case's own names."""
        ours = self.dir / "ours.h5"
        ours.write_bytes((DATA / "mixed.pack.h5").read_bytes())
        path = self.broken("kick without the mass", "kick")
        with h5py.File(ours, "r+") as file:
            for place in [place for place in file if place.startswith("kick.")]:
                for name in "tolerance.velocity", "theirs.velocity", "first.velocity":
                    file.copy(file[place]["out.velocity"], file[place], name)
        done = compare(path, "--only", "kick", ours=ours)
        self.assertEqual(done.returncode, 7, done.stderr)
        self.assertIn(MISTAKES["kick without the mass"].text, meaning(done.stdout))

    def test_interrupt(self):
        """Ctrl-C ends uncross-name, too, and leaves no folder."""
        program = self.stand_in(f"#!/bin/sh\necho $$ >{self.dir}/pid\nexec sleep 1000\n")
        words = [program, "oracle", "compare", DATA / "mixed.pack.h5", self.broken("kick without the mass", "kick"), "--only", "kick"]
        (self.dir / "tmp").mkdir()
        def hear():  # also where this test runs in the background
            signal.signal(signal.SIGINT, signal.SIG_DFL)
        with subprocess.Popen(words, stdout=subprocess.DEVNULL, env=os.environ | {"TMPDIR": str(self.dir / "tmp")}, preexec_fn=hear) as done:
            while not (self.dir / "pid").exists() or not (self.dir / "pid").read_text().strip():
                time.sleep(0.02)
            self.assertEqual(len(list((self.dir / "tmp").iterdir())), 1)
            done.send_signal(signal.SIGINT)
            self.assertEqual(done.wait(60), -signal.SIGINT)
        self.assertEqual(list((self.dir / "tmp").iterdir()), [])
        self.assertFalse(pathlib.Path(f"/proc/{(self.dir / 'pid').read_text().strip()}").exists())


class CatalogueTest(unittest.TestCase):
    def test_each_change_has_its_place(self):
        for mistake in MISTAKES.values():
            for file, line, _ in mistake.changes:
                catalogue.line_number(file, line)

    def test_each_is_reached(self):
        """An operator at which a mistake is first seen uses its line."""
        for mistake in MISTAKES.values():
            if mistake.at in operators.OPERATORS:
                self.assertTrue(catalogue.reaches(mistake, mistake.at), mistake.name)
        self.assertFalse(catalogue.reaches(MISTAKES["kick without the mass"], "sum"))

    def test_families(self):
        entry = {"name": "rounds {n} of {m}", "line": "{n}", "with": {"n": [1, 2], "m": ["a"]}, "also": [{"line": "{m}"}]}
        self.assertEqual([(made["name"], made["line"], made["also"]) for made in catalogue.members(entry)],
                         [("rounds 1 of a", "1", [{"line": "a"}]), ("rounds 2 of a", "2", [{"line": "a"}])])


class EvidenceTest(unittest.TestCase):
    def found(self, ours, theirs, tolerance=1e-12):
        ours, theirs = np.array(ours), np.array(theirs)
        part = evidence.Part(1, 0, len(ours), len(ours), len(theirs), {}, {}, theirs)
        return evidence.Evidence("kick", "out.velocity", "x y z".split(), [part], [(ours, theirs, np.full(ours.shape, tolerance))])

    def test_judge(self):
        """Right in all; right only where theirs is wrong; wrong there."""
        ours = np.arange(1.0, 31).reshape(10, 3)
        theirs = ours.copy()
        theirs[:5] *= 2
        found = self.found(ours, theirs)
        self.assertEqual([found.judge(guess) for guess in (theirs, 2 * ours, ours)], [evidence.WHOLE, evidence.WRONG, evidence.NOT])

    def test_bits(self):
        """A real that is hit counts 20 bits, 15 of them; integers of 0 and 1 count nothing; a bound as wide as the error leaves none."""
        ours = np.arange(1.0, 31).reshape(10, 3)
        theirs = ours.copy()
        theirs[:5] *= 2
        self.assertEqual(self.found(ours, theirs).bits(theirs), 15 * 20)
        self.assertEqual(self.found(ours, theirs).bits(theirs, 15), 0)
        self.assertLess(self.found(ours, theirs, 0.9).bits(theirs), 15 * 5.1)
        flags = np.arange(30).reshape(10, 3) % 2
        self.assertEqual(self.found(flags, 1 - flags, 0.0).bits(1 - flags), 0)

    def test_chance_is_not_told(self):
        """A guess that makes one integer of 0 and 1 right is right by chance."""
        fit = search.Fit(None, evidence.WHOLE, 3.0, True)
        found = self.found(np.arange(30.0).reshape(10, 3), np.arange(30.0).reshape(10, 3) + 1)
        one = case.Case("kick", found, [], {}, {}, False)
        self.assertEqual(search.told([fit], one, 1), [])
        self.assertEqual(search.told([search.Fit(None, evidence.WHOLE, 13.1, True)], one, 8), [search.Fit(None, evidence.WHOLE, 13.1, True)])
        self.assertEqual(search.told([search.Fit(None, evidence.WHOLE, 12.9, True)], one, 8), [])


if __name__ == "__main__":
    unittest.main()
