#!/usr/bin/python3
"""run.json of somebody else: `uncross plot` and `uncross sweep --resume` answer with one line of words and exit code 2, or do
what was asked. They never end in a traceback. Neither does a full disk under their output."""
import contextlib
import io
import json
import os
import pathlib
import random
import subprocess
import sys
import unittest
import unittest.mock

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import foreign_records  # noqa: E402
from support import TOP, UNCROSS, FolderTest, load, uncross  # noqa: E402

os.environ["UNCROSS"] = str(UNCROSS)
sys.path.insert(0, str(TOP / "python"))
from uncross_plot import page, runs  # noqa: E402
from uncross_sweep import command  # noqa: E402

VARIANTS = 250
SCENE = """box: [4, 4, 4]
time_step: 0.02
steps: 100
solvent: {per_cell: 3, collision_interval: 0.04}
fibers: [{name: rods, count: 9, vertices: 4, mass: 3, bond_length: 0.5, spring: 50, bending: 2}]
observe: {temperature: {every: 10}, dynamics: {every: 2}}
"""
program = load(TOP / "tools" / "uncross-plot")


class Foreign(FolderTest):
    def setUp(self):
        super().setUp()
        (self.dir / "scene.yaml").write_text(SCENE)
        self.out = self.dir / "swept"
        self.words = ["sweep", str(self.dir / "scene.yaml"), "--out", str(self.out), "--seeds", "1", "--quiet"]
        done = uncross(*self.words)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.record = self.out / "all" / "seed-1" / "run.json"
        self.good = json.loads(self.record.read_text())

    def one_line(self, told, words):
        self.assertRegex(told, r"\Auncross: [^\n]+\n\Z", words[:200])

    def variants(self, count=VARIANTS):
        for text in foreign_records.variants(self.good, random.Random(36), count):
            self.record.write_bytes(text)
            yield text

    def plot(self, *words):
        """(code, standard error) of `uncross plot`, in this process: its packages take a second to read."""
        error = io.StringIO()
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(error), unittest.mock.patch.object(
                sys, "argv", ["uncross plot", *map(str, words)]):
            return program.main(), error.getvalue()

    def test_plot(self):
        """Everything but the figures, which do not read run.json. What `uncross check` says of a scene is asked once."""
        told, refused, folder = {}, 0, str(self.record.parent)
        real = runs.call

        def call(*words):
            scene = pathlib.Path(words[1]).read_bytes() if words[0] == "check" else words
            if scene not in told:
                told[scene] = real(*words)
            return told[scene]

        with unittest.mock.patch.object(runs, "call", call), unittest.mock.patch.object(page, "figure_of", lambda *_: []), \
                unittest.mock.patch.object(page, "picture_of", lambda *_: page.Section("", [])):
            for number, text in enumerate(self.variants()):
                out = self.dir / f"{number}.html"
                code, error = self.plot(folder, "-o", out)
                self.assertIn(code, (0, 2), text[:200])
                if code:
                    refused += 1
                    self.one_line(error, text)
                    self.assertIn("run.json: ", error)
                self.assertEqual(out.exists(), code == 0)
        self.assertGreater(refused, VARIANTS // 4)
        self.assertLess(refused, VARIANTS)

    def test_sweep(self):
        """No run is begun here: what would be run is looked at only."""
        with unittest.mock.patch.object(command.jobs.Pool, "work", lambda _: None), unittest.mock.patch.dict(os.environ, UNCROSS=str(UNCROSS)):
            sweep = command.make_sweep(command.read_arguments(self.words[1:]))
            with unittest.mock.patch.object(command, "make_sweep", lambda _: sweep):
                codes = []
                for text in self.variants(100):
                    error = io.StringIO()
                    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(error):
                        codes.append(command.main(self.words[1:] + ["--resume"]))
                    self.assertIn(codes[-1], (0, 2, 5), text[:200])
                    if codes[-1] == 2:
                        self.one_line(error.getvalue(), text)
        self.assertGreater(codes.count(2), 25)
        self.assertGreater(codes.count(0), 0)

    def test_words(self):
        for key, value, says in (("steps", "many", "'steps' is text; a whole number from 0 on is needed"),
                                 ("time", True, "'time' is true or false; a number is needed"),
                                 ("warnings", {"a": 1}, "'warnings' is a mapping; a list is needed"),
                                 ("end", {"energy": []}, "'end.energy' is a list; a number is needed"),
                                 ("collisions", [], "'collisions' is a list; a mapping is needed"),
                                 ("scene", 7, "'scene' is a number; text is needed")):
            self.record.write_text(json.dumps({**self.good, key: value}))
            code, error = self.plot(self.record.parent, "-o", self.dir / "no.html")
            self.assertEqual(code, 2)
            self.assertIn(f"{self.record}: {says}", error)

    def test_tables_of_a_sweep(self):
        table = self.record.parent / "temperature.csv"
        for text in ("step,time\n1\n", "step,time\n1,x\n", "step,step\n", "\0", ""):
            table.write_text(text)
            done = uncross(*self.words, "--resume")
            self.assertIn(done.returncode, (0, 2), text)
            self.assertTrue(done.returncode == 0 or done.stderr.startswith(f"uncross: {table}: "), done.stderr)
        self.assertNotIn("Traceback", done.stderr)

    def test_a_full_disk(self):
        for words in (["plot", str(self.record.parent / "temperature.csv"), "-o", str(self.dir / "page.html")], [*self.words[:-1], "--resume"],
                      [*self.words, "--list"], [*self.words, "--slurm"]):
            with open("/dev/full", "w", encoding="ascii") as full:
                done = subprocess.run([UNCROSS, *words], stdin=subprocess.DEVNULL, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertRegex(done.stderr, r"uncross: standard output: cannot write: No space left on device\n\Z")
            self.assertNotIn("Traceback", done.stderr)
            self.assertNotIn("Exception", done.stderr)


if __name__ == "__main__":
    unittest.main()
