#!/usr/bin/python3
"""What to distrust is the same on every page: of a run, of a point, of a sweep and of a comparison."""
import html
import json
import os
import pathlib
import re
import sys
import unittest
import unittest.mock

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, UNCROSS, FolderTest, uncross  # noqa: E402

os.environ["UNCROSS"] = str(UNCROSS)
sys.path.insert(0, str(TOP / "python"))
from uncross_plot import compare, page, runs, sweeps  # noqa: E402

CHANNEL = """box: [6, 6, 6]
time_step: 0.02
steps: 100
solvent: {per_cell: 5, collision_interval: 0.02, rule: at-a}
walls: {kind: no-slip, shear_rate: 0.05}
fibers: [{name: p, count: 600, vertices: 1, mass: 5}]
crossing: {forbidden: false}
observe: {profile: {every: 5, slabs: 6}, temperature: {every: 10}}
"""
POINTS = """box: [8, 8, 8]
time_step: 0.02
steps: %d
medium: {kind: private, rate: 4, draw: relax}
fibers: [{name: p, count: 64, vertices: 1, mass: 2}]
crossing: {forbidden: false}
observe: {dynamics: {every: 2}}
"""


def doubts(text):
    """The items under What to distrust."""
    box = re.search(r"<dt>What to distrust</dt><dd>(.*?)</dd>", text, re.S)[1]
    return [html.unescape(item) for item in re.findall("<li>(.*?)</li>", box, re.S)]


class Pages(FolderTest):
    def setUp(self):
        super().setUp()
        nothing = page.Section("", [])
        for where, name, none in ((sweeps, "figure", ""), (page, "figure_of", []), (page, "picture_of", nothing), (compare, "_section", (nothing, []))):
            patch = unittest.mock.patch.object(where, name, lambda *_, none=none: none)  # words are tested here, and figures take seconds
            patch.start()
            self.addCleanup(patch.stop)

    def sweep(self, name, scene, *words):
        (self.dir / f"{name}.yaml").write_text(scene)
        out = self.dir / name
        done = uncross("sweep", self.dir / f"{name}.yaml", "--out", out, "--quiet", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return out

    def one(self, told, *words):
        """The one doubt that has all these words."""
        fits = [text for text in told if all(word in text for word in words)]
        self.assertEqual(len(fits), 1, told)
        return fits[0]

    def test_warnings_of_runs_are_on_each_page(self):
        """Two masses, two seeds: every run warns of the load, with another number for each mass, and of the unsteady flow."""
        out = self.sweep("load", CHANNEL, "--grid", "fibers.p.mass=5,6", "--seeds", "1..2")
        record = json.loads((out / "fibers.p.mass=5" / "seed-1" / "run.json").read_text())
        self.assertEqual(len(record["warnings"]), 2)
        told = doubts(sweeps.page_of(str(out)))
        self.assertIn("(4 of 4 runs", self.one(told, "Vertices load the fluid"))
        self.assertIn("(4 of 4 runs", self.one(told, "the flow starts at rest"))
        told = doubts(page.page_of(runs.read(str(out / "fibers.p.mass=5"))))
        self.assertIn("(2 of 2 runs)", self.one(told, "Vertices load the fluid"))
        self.assertIn("(2 of 2 runs)", self.one(told, "the flow starts at rest"))
        self.assertEqual([text for text in told if "run.json" in text], [])
        both = doubts(compare.page_of(*(runs.read(str(out / "fibers.p.mass=5" / f"seed-{seed}")) for seed in (1, 2))))
        self.assertIn("(both)", self.one(both, "Vertices load the fluid"))
        # a warning of one run is counted as that, and one whose record is lost is named
        path = out / "fibers.p.mass=6" / "seed-2" / "run.json"
        path.write_text(json.dumps({**json.loads(path.read_text()), "warnings": ["a contact was odd"]}))
        told = doubts(sweeps.page_of(str(out)))
        self.assertIn("(1 of 4 runs: fibers.p.mass=6/seed-2)", self.one(told, "contact was odd"))
        self.assertIn("(3 of 4 runs", self.one(told, "Vertices load the fluid"))
        path.unlink()
        self.one(doubts(sweeps.page_of(str(out))), "fibers.p.mass=6/seed-2", "run.json")

    def test_a_flow_that_is_not_steady(self):
        """What the page finds out itself, where run.json has no warning of it: earlier programs wrote none."""
        out = self.sweep("unsteady", CHANNEL, "--seeds", "1..2")
        for path in out.glob("all/seed-*/run.json"):
            path.write_text(json.dumps({**json.loads(path.read_text()), "warnings": []}))
        for text in (sweeps.page_of(str(out)), page.page_of(runs.read(str(out / "all")))):
            self.one(doubts(text), "profile: the flow has not become steady")

    def test_d_of_a_point(self):
        """0.5 t0 of particles that forget their velocity in 0.25 t0: D still grows."""
        out = self.sweep("moving", POINTS % 200, "--seeds", "1..2")
        text = page.page_of(runs.read(str(out / "all")))
        self.one(doubts(text), "D of 'p' is not final: it grows")
        self.assertIn("(still moving)", text)
        self.one(doubts(sweeps.page_of(str(out))), "all: D of 'p' is not final: it grows")

    def test_runs_that_begin_with_one_state(self):
        """Seeds alone, no grid: from one snapshot, with streams of their own and with the stream that the scene asks for."""
        (self.dir / "first.yaml").write_text(POINTS % 2)
        self.assertEqual(uncross("run", self.dir / "first.yaml", "--out", self.dir / "first", "--quiet").returncode, 0)
        scene = POINTS % 100 + f"start: {{snapshot: {self.dir}/first/checkpoint.h5}}\n"
        for name, words in (("own", ()), ("asked", ("--set", "start.stream=seed"))):
            out = self.sweep(name, scene, "--seeds", "2..3", *words)
            for text in (sweeps.page_of(str(out)), page.page_of(runs.read(str(out / "all"))),
                         compare.page_of(*(runs.read(str(out / "all" / f"seed-{seed}")) for seed in (2, 3)))):
                self.one(doubts(text), "begin with the same state of a snapshot")
        out = self.sweep("fresh", POINTS % 100, "--seeds", "2..3")
        for text in (sweeps.page_of(str(out)), page.page_of(runs.read(str(out / "all")))):
            self.assertEqual([t for t in doubts(text) if "same state" in t], [])


if __name__ == "__main__":
    unittest.main()
