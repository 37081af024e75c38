#!/usr/bin/python3
"""A million variants of a run.json: what uncross_sweep and uncross_plot read of it is a record, or one line of words; and the
words of a page can be made of every record. About ten minutes."""
import json
import os
import pathlib
import random
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import foreign_records  # noqa: E402
from support import TOP, UNCROSS, FolderTest, uncross  # noqa: E402

os.environ["UNCROSS"] = str(UNCROSS)
sys.path.insert(0, str(TOP / "python"))
from uncross_plot import page, runs  # noqa: E402
from uncross_sweep import record  # noqa: E402

VARIANTS = int(os.environ.get("VARIANTS", 1000000))
SCENE = """box: [4, 4, 4]
time_step: 0.02
steps: 20
solvent: {per_cell: 3, collision_interval: 0.04}
fibers: [{name: rods, count: 3, vertices: 4, mass: 3, bond_length: 0.5, spring: 50, bending: 2}]
"""


class Records(FolderTest):
    def test_variants(self):
        (self.dir / "scene.yaml").write_text(SCENE)
        self.assertEqual(uncross("run", self.dir / "scene.yaml", "--out", self.dir / "run", "--quiet").returncode, 0)
        good, read = json.loads((self.dir / "run" / "run.json").read_text()), 0
        for text in foreign_records.variants(good, random.Random(1), VARIANTS):
            try:
                found = record.read("run.json", text.decode(errors="replace"))
            except record.Foreign as error:
                self.assertTrue(str(error).startswith("run.json: ") and str(error).isprintable(), text[:200])
                continue
            read += 1
            run = runs.Run(str(self.dir), found, 0.0, scene=found.get("scene", ""))
            page.provenance(run)
            page.front(run)
        print(f"{VARIANTS} variants, {read} of them records")
        self.assertGreater(read, VARIANTS // 20)


if __name__ == "__main__":
    unittest.main()
