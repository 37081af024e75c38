#!/usr/bin/python3
"""What a run counts since its start begins at 0 in a run from a snapshot, and row 0 tells the snapshot's own state."""
import csv
import json
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import FolderTest, uncross  # noqa: E402

BEAD = """box: [12, 12, 12]
time_step: 0.1
steps: {steps}
order: {order}
solvent: {{per_cell: 4, collision_interval: 0.1}}
fibers: [{{name: rod, count: 4, vertices: 2, mass: 3, bond_length: 0.8, spring: 50}}]
observe: {{bead: {{every: 1}}, conserved: {{every: 1}}}}
bead: {{radius: 2, center: [6, 6, 6]{drive}}}
"""
DRIVES = {"none": "", "force": ", drive: {force: [10, -5, 3]}", "trap": ", drive: {spring: 10}"}

WALLS = """box: [6, 6, 6]
time_step: 0.05
steps: 40
solvent: {per_cell: 5, collision_interval: 0.1}
walls: {kind: no-slip, lower: [-0.1, 0, 0], upper: [0.1, 0, 0]}
trajectory: {every: 20, solvent: true, velocities: true}
observe: {stress: {every: 20}}
"""


class BeginsAnew(FolderTest):
    def run_of(self, text, out, snapshot=None):
        (self.dir / f"{out}.yaml").write_text(text + (f"start: {{snapshot: {snapshot}}}\n" if snapshot else ""))
        done = uncross("run", f"{out}.yaml", "--out", out, "--quiet", cwd=self.dir)
        self.assertEqual(done.returncode, 0, done.stderr)

    def rows(self, out, table):
        with open(self.dir / out / f"{table}.csv", encoding="utf-8") as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def test_bead_between_walls(self):
        """The flow of a scene is given to what is drawn, and not once more to a snapshot, where walls keep no momentum."""
        scene = BEAD.replace("fibers:", "walls: {{kind: no-slip}}\nflow: [0.05, 0, 0]\n#").format(steps=20, order="kick-split", drive=DRIVES["force"])
        self.run_of(scene, "first")
        self.run_of(scene.replace("steps: 20", "steps: 1"), "second", "first/checkpoint.h5")
        end, begin = self.rows("first", "bead")[-1], self.rows("second", "bead")[0]
        for key in "velocity_x", "velocity_y", "velocity_z":
            self.assertAlmostEqual(end[key], begin[key], delta=1e-9, msg=key)

    def test_bead(self):
        """A state has one velocity of the bead, one momentum and one kinetic energy, whatever drives the bead next. The
        half step of force is 10 x 0.1 / 2 M, some 0.004 a0/t0: M = 134."""
        for order in "kick-split", "paper":
            for before, drive in DRIVES.items():
                first = f"{order}-{before}"
                self.run_of(BEAD.format(steps=20, order=order, drive=drive), first)
                last, kept = self.rows(first, "bead")[-1], self.rows(first, "conserved")[-1]
                self.assertGreater(last["hits"], 0)
                for after, next_drive in DRIVES.items():
                    with self.subTest(order=order, before=before, after=after):
                        out = f"{first}-{after}"
                        self.run_of(BEAD.format(steps=1, order=order, drive=next_drive), out, f"{first}/checkpoint.h5")
                        row, conserved = self.rows(out, "bead")[0], self.rows(out, "conserved")[0]
                        for name in "work", "heat", "hits":
                            self.assertEqual(row[name], 0, name)
                        for name in "velocity_x", "velocity_y", "velocity_z":
                            self.assertAlmostEqual(row[name], last[name], delta=1e-9, msg=name)
                        for name in "px", "py", "pz", "solvent_kinetic", "vertex_kinetic":
                            self.assertAlmostEqual(conserved[name], kept[name], delta=1e-7, msg=name)

    def test_walls(self):
        """One state, from a checkpoint or from a frame, is one start: it has one hash, and so one stream."""
        self.run_of(WALLS, "first")
        told = []
        for file in "checkpoint", "trajectory":
            self.run_of(WALLS.replace("steps: 40", "steps: 20"), file, f"first/{file}.h5")
            record = json.loads((self.dir / file / "run.json").read_text())
            told.append((record["stream"], record["stream_from"], record["state_hash"]))
        self.assertEqual(told[0], told[1])


if __name__ == "__main__":
    unittest.main()
