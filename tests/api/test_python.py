"""The package python/uncross: views without copies and how long they live, errors, scenes by hand, runs in folders.

Needs BUILD, the build folder (default build), with the libraries in it.
"""
import gc
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np

TOP = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("BUILD", TOP / "build")).resolve()
os.environ["UNCROSS_LIBRARY"] = str(BUILD / "lib/libuncross.so")
sys.path.insert(0, str(TOP / "python"))
import uncross  # pylint: disable=wrong-import-position
from uncross._library import ffi, lib  # pylint: disable=wrong-import-position

SCENE = {"box": [5, 5, 5], "time_step": 0.01, "steps": 20, "seed": 2,
         "solvent": {"per_cell": 4, "collision_interval": 0.02},
         "fibers": [{"name": "rod", "count": 6, "vertices": 5, "mass": 5, "bond_length": 0.5, "spring": 100, "bending": 8},
                    {"name": "ring", "count": 1, "vertices": 4, "mass": 5, "bond_length": 0.5, "spring": 100, "ring": True}],
         "observe": {"conserved": {"every": 5}, "dynamics": {"every": 5}}}


def address(pointer):
    return int(ffi.cast("uintptr_t", pointer))


class Python(unittest.TestCase):
    def test_views_are_the_memory_of_the_run(self):
        run = uncross.Run(SCENE)
        view = lib.uncross_sim_view(run._sim)
        for name, field, shape, kind in (("positions", "position", (34, 3), np.int64),
                                         ("velocities", "velocity", (34, 3), np.float64),
                                         ("solvent_x", "x", (500,), np.int64), ("solvent_vz", "vz", (500,), np.float64),
                                         ("solvent_id", "id", (500,), np.uint32), ("first", "first", (8,), np.uint32)):
            array = getattr(run, name)
            self.assertEqual((array.shape, array.dtype), (shape, kind), name)
            self.assertEqual(array.__array_interface__["data"][0], address(getattr(view, field)), name)
            self.assertTrue(np.shares_memory(array, getattr(run, name)), name)
            self.assertFalse(array.flags.owndata or array.flags.writeable, name)
            with self.assertRaises(ValueError):
                array[0] = 1
        positions, before = run.positions, run.positions.copy()
        run.advance(3)
        self.assertFalse(np.array_equal(positions, before))
        self.assertTrue(np.array_equal(positions * uncross.LATTICE_UNIT, run.positions_a0()))
        self.assertEqual(list(run.next[-4:]), [31, 32, 33, 30])
        self.assertEqual(run.kinds, ["rod", "ring"])
        self.assertEqual(list(run.fiber[[0, 4, 5, 33]]), [0, 0, 1, 6])

    def test_warnings_of_a_start(self):
        """A run in memory tells what `uncross run` tells: here that its noise is drawn once more."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "first.h5"
            uncross.Run(SCENE).advance(3).save(path)
            for stream, again in (("seed", True), ("own", False)):
                scene = uncross.Scene(SCENE, start={"snapshot": str(path), "stream": stream})
                run = uncross.Run(scene)
                self.assertEqual([w for w in run.warnings if w.startswith("start.stream:")] != [], again, run.warnings)
                self.assertEqual([w for w in run.warnings if not w.startswith("start.")], scene.warnings)

    def test_views_cannot_be_made_writeable(self):
        run = uncross.Run(SCENE)
        for name in ("positions", "velocities", "mass", "next", "first", "solvent_x", "solvent_vx", "solvent_id"):
            array = getattr(run, name)
            for view in (array, array[1:], array.T):
                with self.assertRaises(ValueError, msg=name):
                    view.flags.writeable = True
                self.assertTrue(memoryview(view).readonly, name)

    def test_text_after_nul_is_not_cut(self):
        """A text that ends early in C is refused: a path would name another file, a seed another run."""
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "scene.yaml"
            path.write_text(uncross.Scene(SCENE).text)
            run, scene, cut = uncross.Run(SCENE), uncross.Scene(SCENE), "\0 and more"
            calls = {"path": lambda: uncross.Run(f"{path}{cut}"), "setting": lambda: uncross.Run(path, seed=f"7{cut}"),
                     "key": lambda: uncross.Run(path, **{f"seed{cut}": 7}), "word": lambda: uncross.Scene({**SCENE, "seed": f"7{cut}"}),
                     "text": lambda: uncross.Scene.parse(scene.text + cut), "name": lambda: uncross.Scene.parse(scene.text, f"a{cut}"),
                     "get": lambda: scene.get(f"seed{cut}"), "number": lambda: scene.number(f"seed{cut}"),
                     "save": lambda: run.save(f"{folder}/c.h5{cut}"), "resume": lambda: uncross.Run(scene, resume=f"{path}{cut}"),
                     "folder": lambda: uncross.FolderRun(scene, f"{folder}/run{cut}")}
            for name, call in calls.items():
                with self.assertRaisesRegex(uncross.BadInput, "NUL", msg=name):
                    call()
            self.assertEqual(list(pathlib.Path(folder).iterdir()), [path])

    def test_ctrl_c_is_seen_within_a_second(self):
        """However long a step takes: here 64 of them take several seconds."""
        code = (f"import signal, sys; sys.path.insert(0, {str(TOP / 'python')!r}); import uncross, tempfile\n"
                "signal.signal(signal.SIGINT, signal.default_int_handler)  # what a shell runs behind itself ignores it\n"
                "scene = dict(box=[16, 16, 16], time_step=0.01, steps=100000, seed=1,\n"
                "             medium=dict(kind='pairs', density=5, rate=9, draw='relax', weight='quadratic', repulsion=25))\n"
                "run = uncross.Run(scene) if sys.argv[1] == 'sim' else uncross.FolderRun(scene, tempfile.mkdtemp() + '/run')\n"
                "print('begun', flush=True)\n"
                "run.advance(100000)\n")
        for kind in ("sim", "run"):
            program = subprocess.Popen(["/usr/bin/python3", "-c", code, kind], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.assertEqual(program.stdout.readline(), b"begun\n")
            time.sleep(0.3)
            program.send_signal(signal.SIGINT)
            started = time.monotonic()
            _, said = program.communicate(timeout=60)
            self.assertIn(b"KeyboardInterrupt", said)
            self.assertLess(time.monotonic() - started, 3, kind)  # a look every 0.1 s and a step, on a busy machine

    def test_ctrl_c_is_seen_while_a_start_is_laid(self):
        """Thick fibers that do not fit: laying them goes on for many seconds before it is given up."""
        code = (f"import signal, sys; sys.path.insert(0, {str(TOP / 'python')!r}); import uncross, tempfile\n"
                "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
                "scene = uncross.Scene(dict(box=[12, 12, 12], time_step=0.01, steps=1, solvent=dict(per_cell=3, collision_interval=0.02),\n"
                "             fibers=[dict(name='f', count=900, vertices=10, mass=5, bond_length=0.5, spring=1000, bending=100, diameter=0.5)]))\n"
                "print('begun', flush=True)\n"
                "run = uncross.Run(scene) if sys.argv[1] == 'sim' else uncross.FolderRun(scene, tempfile.mkdtemp() + '/run')\n")
        for kind in ("sim", "run"):
            program = subprocess.Popen(["/usr/bin/python3", "-c", code, kind], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            self.assertEqual(program.stdout.readline(), b"begun\n")
            time.sleep(0.3)
            self.assertIsNone(program.poll())
            program.send_signal(signal.SIGINT)
            started = time.monotonic()
            _, said = program.communicate(timeout=120)
            self.assertTrue(said.rstrip().endswith(b"KeyboardInterrupt"), said)
            self.assertNotIn(b"From cffi", said)
            self.assertLess(time.monotonic() - started, 3, kind)

    def test_what_is_missing_is_named(self):
        """A package that Python has not: as if it were not installed."""
        for name in "cffi", "numpy":
            done = subprocess.run([sys.executable, "-c", f"import sys; sys.modules['{name}'] = None; import uncross"], capture_output=True, text=True,
                                  check=False, env={**os.environ, "PYTHONPATH": str(TOP / "python")})
            self.assertIn(f"uncross needs {name}: install python3-{name}", done.stderr)

    def test_a_run_goes_forward(self):
        run = uncross.Run(SCENE)
        for steps in (-1, -2 ** 70):
            with self.assertRaisesRegex(uncross.BadInput, "allowed: whole number 0 "):
                run.advance(steps)
        self.assertEqual(run.advance(0).step, 0)
        with tempfile.TemporaryDirectory() as folder, uncross.FolderRun(SCENE, f"{folder}/r") as kept:
            with self.assertRaisesRegex(uncross.BadInput, "allowed: whole number 0 "):
                kept.advance(-1)

    def test_steps_have_an_end(self):
        """An integer of Python has none."""
        run = uncross.Run(SCENE).advance(3)
        for steps in (2**63, 2**64, 2**200, 2**63 - 3):
            with self.assertRaisesRegex(ValueError, r"allowed: whole number 0 \.\. 9223372036854775804"):
                run.advance(steps)
        self.assertEqual(run.step, 3)
        with tempfile.TemporaryDirectory() as folder, uncross.FolderRun(SCENE, f"{folder}/r") as kept:
            with self.assertRaisesRegex(ValueError, "allowed: whole number 0"):
                kept.advance(2**63)
            self.assertEqual(kept.step, 0)
        for key in "steps", "seed":
            for value in (2**64, -1, 2**200):
                with self.assertRaisesRegex(ValueError, key):
                    uncross.Scene({**SCENE, key: value})

    def test_an_empty_section_is_refused(self):
        """As in YAML, whether it has keys that must be there (walls) or none (crossing)."""
        for name in "walls", "crossing", "shear", "checkpoint":
            with self.assertRaisesRegex(uncross.BadInput, f"{name}: is empty"):
                uncross.Scene(SCENE, **{name: {}})
            with self.assertRaisesRegex(uncross.BadInput, f"{name}: is empty"):
                uncross.Scene({**SCENE, name: {}})

    def test_a_view_keeps_the_run_alive(self):
        freed = []
        run = uncross.Run(SCENE).advance(2)
        handle, copy = run._sim, run.positions.copy()
        watched = ffi.gc(ffi.cast("uncross_sim *", handle), lambda _pointer: freed.append(True))
        run._sim = run._owner = watched
        run._kept = None
        part = run.positions[3:7]
        del run, watched
        gc.collect()
        self.assertEqual(freed, [])
        self.assertTrue(np.array_equal(part, copy[3:7]))
        del part
        gc.collect()
        self.assertEqual(freed, [True])

    def test_views_of_runs_that_are_gone(self):
        """Read in a process whose freed memory is overwritten: a view of freed memory would not show positions."""
        code = (f"import sys; sys.path.insert(0, {str(TOP / 'python')!r}); import uncross, gc\n"
                f"scene = {SCENE!r}\n"
                "views = [uncross.Run(scene).advance(4).positions for _ in range(20)]\n"
                "gc.collect(); junk = [uncross.Run(scene, seed=k).advance(1) for k in range(20)]\n"
                "assert all((v == views[0]).all() for v in views[1:]); print('same')\n")
        done = subprocess.run(["/usr/bin/python3", "-c", code], capture_output=True, text=True, check=False,
                              env={**os.environ, "MALLOC_PERTURB_": "165"})
        self.assertEqual(done.stdout, "same\n", done.stderr)

    def test_errors_are_exceptions(self):
        with self.assertRaisesRegex(uncross.BadInput, "per_cel"):
            uncross.Run(SCENE, solvent={"per_cel": 3})
        with self.assertRaisesRegex(uncross.BadInput, r"^bad.yaml:2:1: "):
            uncross.Scene.parse("box: [4, 4, 4]\nstep: 3\n", "bad.yaml")
        with self.assertRaisesRegex(ValueError, "/nowhere.yaml"):
            uncross.Run("/nowhere.yaml")
        with self.assertRaises(uncross.NotWritten):
            uncross.Run(SCENE).save("/nowhere/c.h5")
        run = uncross.Run(SCENE, **{"fibers.0.force": [1e5, 0, 0]})
        with self.assertRaisesRegex(uncross.Stopped, "moves too far in one time step") as caught:
            run.advance(100)
        error = caught.exception
        self.assertEqual((error.code, error.cause), (lib.UNCROSS_STOPPED, lib.UNCROSS_CAUSE_VERTEX_MOVE))
        self.assertEqual(error.step, run.step)
        self.assertGreater(error.value, error.limit)
        self.assertLess(error.entity, 34)

    def test_against_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = uncross.Scene(SCENE)
            path = pathlib.Path(folder) / "scene.yaml"
            path.write_text(scene.text)
            subprocess.run([BUILD / "uncross", "run", path, "--out", f"{folder}/program", "--quiet"], check=True)
            record = json.loads(pathlib.Path(f"{folder}/program/run.json").read_text())
            run = uncross.Run(path).advance(20)
            self.assertEqual(f"{run.hash:016x}", record["state_hash"])
            self.assertEqual(run.counts["moves"], record["collisions"]["moves"])
            self.assertEqual(run.conserved["total"], record["end"]["energy"])

            with uncross.FolderRun(scene, f"{folder}/ours") as ours:
                ours.advance(7)
                with self.assertRaisesRegex(uncross.NotWritten, "in use"):
                    uncross.FolderRun(scene, f"{folder}/ours")
            with uncross.FolderRun(scene, f"{folder}/ours", resume=True) as ours:
                self.assertEqual((ours.step, ours.wanted), (7, 20))
                ours.advance()
            self.assertEqual(ours.hash, run.hash)
            for table in ("conserved", "dynamics-rod"):
                theirs = pathlib.Path(f"{folder}/program/{table}.csv").read_bytes()
                self.assertEqual(pathlib.Path(f"{folder}/ours/{table}.csv").read_bytes(), theirs, table)
                columns = theirs.decode().splitlines()[0].split(",")
                values = np.array([[float(x) for x in line.split(",")] for line in theirs.decode().splitlines()[1:]])
                self.assertEqual(list(run.tables[table]), columns)
                for k, column in enumerate(columns):
                    np.testing.assert_array_equal(run.tables[table][column], values[:, k], f"{table} {column}")

            resumed = uncross.Run(scene, resume=f"{folder}/program/checkpoint.h5")
            self.assertEqual((resumed.step, resumed.hash), (20, run.hash))
            run.save(f"{folder}/again.h5")
            self.assertEqual(uncross.Run(scene, resume=f"{folder}/again.h5").advance(5).hash, run.advance(5).hash)

    def test_scenes(self):
        scene = uncross.Scene(SCENE, seed=9, solvent={"per_cell": 6})
        self.assertEqual((scene.number("seed"), scene.number("solvent.per_cell"), scene.number("solvent.collision_interval")),
                         (9, 6, 0.02))
        self.assertEqual(scene.get("fibers.1.name").strip(), "ring")
        self.assertTrue(uncross.Scene(SCENE, **{"fibers.0.force": [1, 0, 0]}).warnings)
        with self.assertRaises(TypeError):
            uncross.Run(scene, seed=3)
        position, velocity = uncross.Run(scene).solvent()
        self.assertEqual(position.shape, (750, 3))
        self.assertLess(abs(velocity.var() - 1), 0.2)  # 2250 numbers of variance 1 +- 0.03

    def test_without_fibers_or_solvent(self):
        bath = uncross.Run({key: SCENE[key] for key in ("box", "time_step", "steps", "solvent")}).advance(2)
        self.assertEqual((bath.positions.shape, bath.solvent_x.shape), ((0, 3), (500,)))
        dry = uncross.Run({key: SCENE[key] for key in ("box", "time_step", "steps", "fibers")}).advance(2)
        self.assertEqual((dry.positions.shape, dry.solvent_x.shape), ((34, 3), (0,)))


if __name__ == "__main__":
    unittest.main()
