"""Counted instructions: files of callgrind are read right, and what is off the table fails."""
import importlib.machinery
import importlib.util
import pathlib
import sys
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
sys.dont_write_bytecode = True
sys.path.insert(0, str(TOOLS))


def load(name):
    loader = importlib.machinery.SourceFileLoader(name, str(TOOLS / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


callgrind = importlib.import_module("callgrind")
counts = load("counts")
skips = load("skips")

# main (3 instructions of its own) calls work twice; work has 4 + 6 and calls sqrt of another object, which has 5. Written
# by hand after "Callgrind Format Specification" of valgrind's manual: names and addresses compressed.
FILE = """# callgrind format
version: 1
positions: instr line
events: Ir
summary: 18

ob=(1) /bin/program
fl=(1) main.c
fn=(1) main
0x100 10 1
+4 +1 1
cfi=(2) work.c
cfn=(2) work
calls=2 0x200 50
* * 15
+4 * 1

fl=(2)
fn=(2)
0x200 50 4
+8 +2 6
cob=(2) /lib/libm.so
cfi=(3) ???
cfn=(3) sqrt
calls=2 0x900 0
+4 -1 5

ob=(2)
fl=(3)
fn=(3)
0x108 0 5
"""


class Parse(unittest.TestCase):
    def test_costs(self):
        got = callgrind.parse(FILE, "/bin/program")
        self.assertEqual(got.total, 18)
        self.assertEqual(got.inclusive, {"main": 18, "work": 15, "sqrt": 5})
        self.assertEqual(got.address, {0x100: 1, 0x104: 1, 0x108: 1, 0x200: 4, 0x208: 6})  # not the 5 of 0x108 of libm

    def test_mean(self):
        other = callgrind.Counts(8, {"main": 8, "work": 5}, {0x100: 1})
        got = callgrind.mean([callgrind.parse(FILE, "/bin/program"), other])
        self.assertEqual((got.total, got.inclusive["work"], got.inclusive["sqrt"], got.address[0x200]), (13, 10, 2.5, 2))


ROWS = [("dense", "fiber_forces", "vertex", 100.0), ("dense", "fiber_kick", "vertex", 20.0)]


class Table(unittest.TestCase):
    def verdicts(self, **known):
        table = {("dense", "fiber_" + stage): value for stage, value in known.items()}
        return [passes for _, passes in counts.judge(ROWS, table)]

    def test_within_the_guard(self):
        self.assertEqual(self.verdicts(forces=104.9, kick=19.1), [True, True])

    def test_slower_fails(self):
        self.assertEqual(self.verdicts(forces=95.0, kick=20.0), [False, True])

    def test_faster_fails_too(self):
        self.assertEqual(self.verdicts(forces=100.0, kick=21.2), [True, False])

    def test_new_and_lost_stages_fail(self):
        self.assertEqual(self.verdicts(forces=100.0), [True, False])
        self.assertEqual(self.verdicts(forces=100.0, kick=20.0, other=1.0), [True, True, False])

    def test_written_and_read(self):
        build = counts.build_of("uncross 0.1.0 (commit 12ab; gcc (Debian 12.2.0-14; x) 12.2.0; -std=c11  -O3)\n")
        self.assertEqual(build, {"compiler": "gcc (Debian 12.2.0-14; x) 12.2.0", "flags": "-std=c11 -O3"})
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "table.txt")
            counts.write_table(path, build, ROWS)
            self.assertEqual(counts.read_table(path), (build, {row[:2]: row[3] for row in ROWS}))

    def test_the_table_is_whole(self):
        """Each stage of each scene stands in the committed table."""
        _, known = counts.read_table(counts.TABLE)
        stages = {"solvent": 4, "rescale": 5, "canonical": 7, "semidilute": 6, "dense": 6, "dense-events": 6, "at-a": 4, "at-plus-a": 5, "couette": 6, "shear": 6,
                  "dumbbells": 5, "bead": 7, "company": 12, "pairs": 5, "dpd": 5, "observers": 10, "private": 5, "andersen": 5, "overdamped": 3}
        self.assertEqual({s: sum(scene == s for scene, _ in known) for s in counts.SCENES}, stages)


class Skips(unittest.TestCase):
    def test_names_are_told_apart(self):
        """A function that is gone does not count as one that is not called."""
        counter = callgrind.Counter.__new__(callgrind.Counter)
        counter.functions = {"here"}
        nothing = callgrind.Counts(0, {}, {})
        self.assertEqual(counter.inclusive(nothing, "here"), 0)
        self.assertRaises(KeyError, counter.inclusive, nothing, "gone")

    def test_the_page_has_every_line(self):
        page = (TOOLS.parent / "docs" / "speed.md").read_text()
        missing = [name for name, _, bug in skips.LINES if f"| {name} | " not in page or f" | {bug} |" not in page]
        self.assertEqual(missing, [], "lines that docs/speed.md has not: make counts-baseline")


if __name__ == "__main__":
    unittest.main()
