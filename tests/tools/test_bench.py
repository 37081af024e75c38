"""The benchmarks' bookkeeping, with made-up times of which the answers are known, and a short run of each program."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
BENCH = pathlib.Path(__file__).resolve().parents[2] / "validation/bench"
sys.path.insert(0, str(BENCH))

import common
import efficiency
import precision
import scaling
import scenes
import speed
import tables

BUILD = pathlib.Path(os.environ.get("BUILD", "build")).resolve()
MEMBERS = 1000  # of each scene file of the made-up world, where a member and step takes 1 ns, and one more for each letter of the scene
FIELDS = {"name", "value", "unit", "spread", "baseline"}


def scene_of(text):
    scene = {"cells": 32, "per_cell": 5, "fibers": 0, "vertices": 64, "dt": 0.01, "crossing": 1, "order": 1}
    scene.update((key, float(value)) for key, value in (part.split("=") for part in text.split(",")))
    return scene


def seconds_of(text):
    """Of a step in a made-up world: 10 ns per solvent particle, 100 ns per vertex, 60 of them for crossings, 80 and 40 event-driven."""
    if text.startswith("triad="):
        return float(text[6:]) / 1e3 / 50.0  # 50 GB/s
    if ".yaml" in text:
        return 1e-9 * MEMBERS * (1 + len(text))
    s = scene_of(text)
    vertices = s["fibers"] * s["vertices"]
    return 1e-9 * (10 * s["per_cell"] * s["cells"]**3 + (40, 100, 80)[int(s["crossing"])] * vertices)


class MadeUp:
    """Prints what the programs would in that world. The stiffest mode has 1/(1 - 100 dt^2), with drift-split 1."""

    def run(self, program, *arguments):
        return getattr(self, program)(*map(str, arguments))

    def run_all(self, commands):
        return [self.run(*command) for command in commands]

    def steps(self, rounds, _, *scenes):
        lines = [f"{r}\t{k}\t7\t{7 * seconds_of(scene) * (1 + 0.1 * r)}"
                 for r in range(int(rounds)) for k, scene in enumerate(scenes)]
        lines += [f"members\t{k}\t{MEMBERS - 300}\t300" for k, scene in enumerate(scenes) if ".yaml" in scene]
        memory = sum(70 * s["per_cell"] * s["cells"]**3 + 90 * s["cells"]**3 for s in map(scene_of, scenes)
                     ) if scenes[0].startswith("cells") or scenes[0].startswith("per_cell") else 0
        return "\n".join([*lines, f"peak\t{memory / 1024:.0f}"])

    def precision(self, scene, _):
        s = scene_of(scene)
        if s["order"] == 0 and s["dt"] > 0.01 and not s.get("thermostat"):
            return "fault 7 0\n"
        stiffest = 1.0 / (1.0 - 100.0 * s["dt"]**2) if s["order"] < 2 else 1.0
        return f"cpu 1 0\nstiffest {stiffest} 0.0001\nbend 1 0.001\nmsd 2 0.01\ndrift 0 1e-6\n"

    def efficiency(self, mode, *_):
        if mode == "diffusion":
            return "msd 0.02 0.0004 10\ngreen-kubo 0.02 0.0008 10\n"
        return f"{mode} 2.0 0.04 10\n"


def rows_of(module):
    return {row["name"]: row for measure in module.ITEMS.values() for row in measure(MadeUp(), 1.0)}


class Rows(unittest.TestCase):
    def test_all_rows_have_their_fields_and_names_of_their_own(self):
        rows = [row for module in (speed, scenes, scaling, precision, efficiency) for measure in module.ITEMS.values()
                for row in measure(MadeUp(), 1.0)]
        self.assertEqual(len({row["name"] for row in rows}), len(rows))
        for row in rows:
            self.assertEqual(set(row), FIELDS, row)
            self.assertIsInstance(row["value"], float, row)
            self.assertIsInstance(row["unit"], str, row)
        json.dumps(rows, allow_nan=False)

    def test_speed(self):
        rows = rows_of(speed)
        middle = 1.3  # the made-up machine slows down from round to round: 1.0, 1.1 ... 1.6
        self.assertAlmostEqual(rows["floor/triad of 12 MB"]["value"], 50.0 / middle)
        self.assertAlmostEqual(rows["speed/solvent 64^3"]["value"], 10 * middle)
        self.assertAlmostEqual(rows["speed/solvent 64^3 over 32^3"]["value"], 1.0)
        expected = 1 + 100 * 6400 / (10 * 5 * 32**3)
        self.assertAlmostEqual(rows["speed/cL^3 = 100 over solvent"]["value"], expected)
        self.assertAlmostEqual(rows["speed/cL^3 = 100 over solvent"]["spread"], 0.0)
        self.assertAlmostEqual(rows["detection/cL^3 = 1000 in 32^3"]["value"], 60 * middle)
        self.assertAlmostEqual(rows["detection/cL^3 = 1000 in 32^3, event-driven"]["value"], 40 * middle)
        self.assertAlmostEqual(rows["memory/solvent particle"]["value"], 70, delta=0.01)
        self.assertAlmostEqual(rows["memory/cell"]["value"], 90, delta=0.01)

    def test_scenes(self):
        rows, middle = rows_of(scenes), 1.4  # nine rounds
        for name in ("AT+a", "DPD, 41472", "observers"):
            scene, beside = map(len, scenes.ROWS[name])
            self.assertAlmostEqual(rows[f"scenes/{name}"]["value"], middle * (1 + scene))
            self.assertAlmostEqual(rows[f"scenes/{name}, ratio"]["value"], (1 + scene) / (1 + beside))
        self.assertNotIn("scenes/SRD, ratio", rows)

    def test_scaling(self):
        rows = rows_of(scaling)
        self.assertAlmostEqual(rows["scaling/exponent, solvent, box"]["value"], 3.0)
        self.assertAlmostEqual(rows["scaling/exponent, fibers alone, cL^3"]["value"], 1.0)
        self.assertAlmostEqual(rows["scaling/exponent, 6400 vertices alone, fiber length"]["value"], 0.0)

    def test_precision(self):
        rows = rows_of(precision)
        self.assertAlmostEqual(rows["precision/c of 1/(1 - c dt^2), kick-split"]["value"], 100.0)
        self.assertAlmostEqual(rows["precision/dt for 1 %, kick-split"]["value"], (0.01 / 1.01 / 100)**0.5)
        self.assertEqual(rows["precision/largest dt within 1 %, kick-split"]["value"], 0.005)
        self.assertEqual(rows["precision/largest dt within 1 %, drift-split"]["value"], 0.04)
        self.assertNotIn("precision/dt for 1 %, drift-split", rows)
        self.assertAlmostEqual(rows["precision/g(10 t0), paper, dt 0.02"]["value"], 1.0)
        self.assertNotIn("precision/g(10 t0), paper, dt 0.04", rows)
        self.assertEqual(rows["precision/fault, free, paper, dt 0.02"]["value"], 7.0)

    def test_efficiency(self):
        rows = rows_of(efficiency)
        self.assertAlmostEqual(rows["efficiency/viscosity, decaying waves, 8^3, CPU for 1 %"]["value"], 40.0)
        self.assertAlmostEqual(rows["efficiency/viscosity, decaying waves, 8^3, CPU for 0.3 %"]["value"], 40.0 / 0.09)
        # 2.837297/(6 pi 10.74 8) = 0.0017519: THEORY of images, by hand
        name = "efficiency/vertex, 8 in 8^3, mean square displacement"
        self.assertAlmostEqual(rows[name + ", with images"]["value"], 0.0217519, delta=1e-7)
        self.assertAlmostEqual(rows[name + ", CPU for 1 %"]["value"], 10 * (0.0004 / 0.0217519 / 0.01)**2, delta=1e-3)


class Tables(unittest.TestCase):
    def test_values_with_errors(self):
        shown = {(2.14837, 0.0081): "2.148 ± 0.008", (2.14837, 0.0131): "2.148 ± 0.013", (21.3, 1.26): "21.3 ± 1.3",
                 (-3.4e-7, 4.1e-7): "(−0.3 ± 0.4)·10⁻⁶", (1.21e-4, 1.3e-5): "(121 ± 13)·10⁻⁶", (14.237, None): "14.2",
                 (0.02, 0.0): "0.0200", (221.4, None): "221"}
        for (value, error), text in shown.items():
            self.assertEqual(tables.with_error({"value": value, "spread": error}), text)

    def test_documents(self):
        modules = (speed, scenes, scaling, precision, efficiency)
        rows = {name: row for module in modules for name, row in rows_of(module).items()}
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            (root / "docs").mkdir()
            for document in ("docs/speed.md", "docs/accuracy.md"):
                marks = [f"<!-- bench: {n} -->\nold {n}\n<!-- end of {n} -->\n"
                         for n, (d, *_) in tables.TABLES.items() if d == document]
                (root / document).write_text("before\n" + "between\n".join(marks) + "after\n")
            tables.write({name: row for name, row in rows.items() if not name.startswith("scaling/")}, root)
            speed_page, accuracy_page = ((root / page).read_text() for page in ("docs/speed.md", "docs/accuracy.md"))
        self.assertIn("| cL³ = 100 over its solvent alone | 1.5 | 1.3 | 1.39 |", speed_page)  # 1 + 6400 100/(10 163840)
        over = rows["scenes/AT+a, ratio"]["value"]
        self.assertIn(f"| AT+a | SRD | {tables.number(over)} |", speed_page)
        self.assertIn("| observers | the same without |", speed_page)
        self.assertIn("| thick fibers | cL³ = 1000, event-driven |", speed_page)
        self.assertIn("old scaling", speed_page)
        with tempfile.TemporaryDirectory() as name:  # a section that was not measured leaves its tables as they were
            root = pathlib.Path(name)
            (root / "docs").mkdir()
            for document in ("docs/speed.md", "docs/accuracy.md"):
                (root / document).write_text("".join(f"<!-- bench: {n} -->\nold {n}\n<!-- end of {n} -->\n" for n, (
                    d, *_) in tables.TABLES.items() if d == document))
            tables.write(dict(rows_of(speed)), root)
            for table in ("precision", "answer", "efficiency"):
                self.assertIn(f"old {table}\n", (root / "docs/accuracy.md").read_text())
        self.assertNotIn("old speed", speed_page)
        self.assertIn("| `paper` | 0.02 |", accuracy_page)
        self.assertIn("stops at 7 t0", accuracy_page)
        self.assertIn("| `kick-split`, from the fit | 0.00995", accuracy_page)  # (0.01/1.01/100)^0.5
        for page in (speed_page, accuracy_page):
            self.assertTrue(page.startswith("before\n<!-- bench: ") and page.endswith("-->\nafter\n"))


class Kept(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        program = self.folder / "count"
        program.write_text("#!/bin/sh\necho run >> \"$0.runs\"\necho \"$1 1 2\"\n")
        program.chmod(0o755)

    def store(self, stamp="a"):
        return common.Store(self.folder / "store.json", stamp, self.folder, 2)

    def runs(self):
        return len((self.folder / "count.runs").read_text().split())

    def test_nothing_is_measured_twice_but_for_another_program(self):
        self.assertEqual(self.store().run("count", "x"), "x 1 2\n")
        self.assertEqual(self.store().run_all([("count", "x"), ("count", "y")]), ["x 1 2\n", "y 1 2\n"])
        self.assertEqual(self.runs(), 2)
        self.store("b").run("count", "x")
        self.assertEqual(self.runs(), 3)

    def test_a_spoiled_file_is_measured_anew(self):
        self.store().run("count", "x")
        (self.folder / "store.json").write_text("{")
        self.store().run("count", "x")
        self.assertEqual(self.runs(), 2)

    def test_a_program_that_fails_ends_it(self):
        (self.folder / "count").write_text("#!/bin/sh\nexit 3\n")
        with self.assertRaises(SystemExit):
            self.store().run("count")


class Programs(unittest.TestCase):
    def run_one(self, *command, **where):
        return common.run_program([BUILD / "validation/bench" / command[0], *command[1:]], **where)

    def test_steps(self):
        _, memory, text = self.run_one("steps", 2, 0.0, "triad=1", "cells=4", "cells=6,fibers=4,vertices=8")
        lines = [line.split("\t") for line in text.splitlines()]
        self.assertEqual([line[:2] for line in lines[:-1]], [[r, k] for r in "12" for k in "012"])
        self.assertTrue(all(int(line[2]) > 0 and float(line[3]) >= 0 for line in lines[:-1]))
        self.assertEqual(int(lines[1][2]), 200)  # 100 collisions, a whole period of sorting
        self.assertTrue(1 << 20 < 1024 * int(lines[-1][1]) <= memory + (1 << 20))

    def test_scene_files(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "a.yaml"
            scene.write_text("box: [4, 4, 4]\ntime_step: 0.01\nsteps: 1\nsolvent: {per_cell: 5, collision_interval: 0.02}\n"
                             "observe: {conserved: {every: 10}}\n")
            command = ("steps", 1, 0.0, f"{scene} solvent.per_cell=7 seed=9", "cells=4", scene)
            text = self.run_one(*command, environment={"TMPDIR": folder})[2]
            lines = [line.split("\t") for line in text.splitlines()]
            self.assertEqual([line[:3] for line in lines[:3]], [["1", "0", "200"], ["1", "1", "200"], ["1", "2", "200"]])
            self.assertEqual(lines[3:5], [["members", "0", "448", "0"], ["members", "2", "320", "0"]])
            self.assertEqual([path.name for path in pathlib.Path(folder).iterdir()], ["a.yaml"])  # its runs are removed
            for wrong in (f"{scene} solvent.colour=7", f"{scene} seed", f"{folder}/b.yaml"):
                done = subprocess.run([BUILD / "validation/bench/steps", "1", "0", wrong], capture_output=True, check=False)
                self.assertEqual((done.returncode, done.stdout), (2, b""), wrong)

    def test_precision(self):
        text = self.run_one("precision", "cells=4,fibers=2,vertices=5,dt=0.02,bending=4", 80)[2]
        quantities = common.quantities(text)
        self.assertEqual(set(quantities), {"cpu", "stiffest", "bend", "msd", "drift"})
        self.assertTrue(0.2 < quantities["stiffest"][0] < 3.0)  # two fibers: only the order of magnitude

    def test_efficiency(self):
        scene = "cells=4,fibers=2,vertices=1,dt=0.02"
        quantities = common.quantities(self.run_one("efficiency", "diffusion", scene, 60, 1, 3)[2])
        self.assertEqual(set(quantities), {"msd", "green-kubo"})
        for mode in ("wave", "current"):
            text = self.run_one("efficiency", mode, "cells=6,dt=0.02", 60)[2]
            (nu, error, seconds), = common.quantities(text).values()
            self.assertTrue(abs(nu - 2.15) < 0.4 + 5 * error and seconds > 0, (mode, nu, error))

    def test_what_they_do_not_understand(self):
        for command in (["steps"], ["steps", "1", "0", "cell=4"], ["steps", "1", "0", "cells=x"],
                        ["precision", "cells=4", "1"], ["efficiency", "wave"]):
            done = subprocess.run([BUILD / "validation/bench" / command[0], *command[1:]], capture_output=True,
                                  check=False)
            self.assertEqual((done.returncode, done.stdout), (2, b""), command)


if __name__ == "__main__":
    unittest.main()
