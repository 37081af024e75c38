"""Bounds before memory: what a file claims does not decide how much memory is taken; and what `uncross check` says of memory is
what a run takes. Needs UNCROSS."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
UNCROSS = os.path.abspath(os.environ.get("UNCROSS", "build/uncross"))
MOST = 64.0  # MiB; the program with a small scene takes some 15
FACTOR = 1.25  # between the estimate and the largest resident memory

# Observables that remember much, of systems that do not.
DYNAMICS = """box: [40, 40, 40]
time_step: 0.01
steps: 1000000000
fibers: [{name: a, count: 2000, vertices: 20, mass: 5, bond_length: 0.5, spring: 100}, {name: b, count: 20000, vertices: 1, mass: 5}]
crossing: {forbidden: false}
observe: {dynamics: {every: 1}, memory: {every: 1}}
"""
PROFILE = """box: [4, 4, 4]
time_step: 0.02
steps: 5
solvent: {per_cell: 3, collision_interval: 0.02}
observe: {profile: {every: 1, slabs: 8192}}
"""
# 41 pairs for each particle, a list of 90 MiB; and the forces of pairs, which observables sum anew.
PAIRS = """box: [12, 12, 12]
time_step: 0.02
steps: 5
medium: {kind: pairs, density: 20, rate: 9, draw: relax, weight: quadratic}
"""
FORCES = PAIRS.replace("density: 20", "density: 10").replace("}", ", repulsion: -40, many_body: {repulsion: 25, range: 0.75}}") + \
    "observe: {pressure: {every: 1}}\n"
CHOSEN = PAIRS.replace("draw: relax, weight: quadratic", "draw: replace")


class Memory(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)

    def tearDown(self):
        self.temporary.cleanup()

    def run_words(self, *words):
        """Exit code, output, largest resident memory in MiB."""
        with tempfile.TemporaryFile() as said:
            program = subprocess.Popen([UNCROSS, *words], cwd=self.folder, stdout=said, stderr=subprocess.STDOUT)
            _, status, usage = os.wait4(program.pid, 0)
            program.returncode = os.waitstatus_to_exitcode(status)
            said.seek(0)
            return program.returncode, said.read().decode(errors="replace"), usage.ru_maxrss / 1024

    def small(self, wanted, *words):
        code, said, memory = self.run_words(*words)
        self.assertEqual(code, wanted, said)
        self.assertLess(memory, MOST, words)
        return said

    def test_tables_without_an_end(self):
        """Of 200 GB of holes, and of one line of 200 MB: pages and averages refuse them by the line."""
        (self.folder / "s.yaml").write_text(PROFILE.replace("observe: {profile: {every: 1, slabs: 8192}}", "observe: {conserved: {every: 1}}"))
        self.assertEqual(self.run_words("sweep", "s.yaml", "--out", "sweep", "--quiet")[0], 0)
        table = next((self.folder / "sweep/all").glob("seed-*/conserved.csv"))
        for hole in True, False:
            with open(table, "w", encoding="ascii") as file:
                for _ in range(0 if hole else 200):
                    file.write("1" * 1_000_000)
                file.truncate(200 << 30 if hole else None)
            for words in ("plot", str(table), "--out", "page.html"), ("sweep", "s.yaml", "--out", "sweep", "--resume"):
                code, said, memory = self.run_words(*words)
                self.assertEqual(code, 2, said)
                self.assertIn("line 1 has more than 65535 characters", said)
                self.assertLess(memory, 250.0, words)  # NumPy and matplotlib take some 120

    def test_rows_that_are_claimed(self):
        """Each table claims two million rows, in one line."""
        lines = [f"o {k} 2097152 t.x 1" for k in range(300)]
        (self.folder / "pack.txt").write_text("\n".join(lines) + "\n")
        said = self.small(2, "oracle", "dump", "pack.txt")
        self.assertRegex(said, r"pack.txt:\d+:\d+: so many rows cannot be in a file of this size")

    def test_files_with_holes(self):
        """A port's output, a table, a trace, a record: 300 GB of nothing, and of one line."""
        for name in "out", "table.csv", "run.json":
            for begin in b"", b"# uncross pack 2\n" if name == "out" else b"step,time\n":
                with open(self.folder / name, "wb") as file:
                    file.write(begin)
                    file.truncate(300 * 2**30)
                for words in (["oracle", "dump", name], ["oracle", "compare", name, name], ["verify", name], ["info", name],
                              ["export", name]):
                    code, said, memory = self.run_words(*words)
                    self.assertLess(memory, MOST, words)
                    self.assertFalse(code == 0 and words[0] != "info", (words, said))
        (self.folder / "port").write_text('#!/bin/sh\nfor out; do :; done\ntruncate -s 200M "$out"\n')
        (self.folder / "port").chmod(0o755)
        said = self.small(7, "oracle", "check", "./port", "--only", "rotate")
        self.assertRegex(said, "failed: .*(a line of more than|NUL byte)")
        (self.folder / "port").write_text('#!/bin/sh\nfor out; do :; done\ntruncate -s 300M "$out"\n')
        said = self.small(7, "oracle", "check", "./port", "--only", "rotate")
        self.assertRegex(said, "failed: .*the port writes a file of more than 268435456 bytes")

    def test_long_lines(self):
        for name, begin in (("pack.txt", b"# uncross pack 2\n"), ("table.csv", b"step,time\n0,0\n"), ("run.json", b'{"a": "')):
            with open(self.folder / name, "wb") as file:
                file.write(begin)
                for _ in range(200):  # a process begins with the size of the one that started it: this one stays small
                    file.write(b"7" * 2**20)
        self.small(2, "oracle", "dump", "pack.txt")
        self.assertIn("more than 65535 bytes", self.small(9, "verify", "table.csv"))
        self.assertIn("larger than", self.small(9, "verify", "run.json"))
        self.small(2, "info", "run.json")
        self.assertIn("more than 65535 bytes", self.small(2, "info", "table.csv"))

    def test_all_columns_of_a_table_are_told(self):
        """Of a first line that is longer than what tells sorts of files apart."""
        names = [f"column_{k:03}" for k in range(500)]
        (self.folder / "wide.csv").write_text(f"{','.join(names)}\n{','.join('0' * 500)}\n")
        said = self.small(0, "info", "wide.csv")
        self.assertIn("table of 500 columns and 1 rows", said)
        self.assertIn(f"columns: {','.join(names)}\n", said)

    def test_the_estimate(self):
        scenes = []
        for name, text in (("dynamics", DYNAMICS), ("profile", PROFILE), ("pairs", PAIRS), ("forces", FORCES), ("chosen", CHOSEN)):
            scenes.append(self.folder / f"{name}.yaml")
            scenes[-1].write_text(text)
        scenes += [TOP / f"scenes/{name}.yaml" for name in ("semidilute", "bead-fibers", "dumbbells", "couette", "thick", "rings")]
        for scene in scenes:
            code, said, _ = self.run_words("check", scene)
            self.assertEqual(code, 0, said)
            wanted = float(re.search(r"^  \.\.\. while a checkpoint is written +(\S+) MiB", said, re.M)[1])
            out = self.folder / scene.stem
            code, said, memory = self.run_words("run", scene, "--out", out, "--steps", "1", "--set", "observe.from=0", "--quiet")
            self.assertEqual(code, 0, said)
            print(f"# {scene.stem}: memory {memory:.1f} MiB, said {wanted:.1f}")
            factor = 1.1 if "profile" in scene.stem else FACTOR  # all of it is memory of observables, and of the program
            with self.subTest(scene=scene.stem):
                self.assertTrue(1 / factor < memory / wanted <= 1.0, (memory, wanted))  # "at most"


if __name__ == "__main__":
    unittest.main()
