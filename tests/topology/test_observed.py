#!/usr/bin/python3
"""observe.topology: what a run counts while it goes is what `uncross topology` finds in its frames; restarts, refusals."""
import csv
import json
import os
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import FolderTest, uncross  # noqa: E402
from test_topology import FIBERS, PHANTOM, table  # noqa: E402

OBSERVED = "observe: {topology: {every: %d}}\n"
THICK = FIBERS.replace("bending: 2}", "bending: 2, diameter: 0.1}").replace("count: 26", "count: 12")


class Observed(FolderTest):
    def run_of(self, name, text, *more):
        (self.dir / f"{name}.yaml").write_text(text)
        done = uncross("run", self.dir / f"{name}.yaml", "--out", self.dir / name, "--quiet", *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.row(self.dir / name)

    def row(self, folder):
        with open(folder / "topology.csv", encoding="ascii") as file:
            [row] = csv.DictReader(file)
        return {name: float(value) for name, value in row.items()}

    def frames(self, name):
        return table(uncross("topology", self.dir / name / "trajectory.h5").stdout)

    def test_what_frames_say(self):
        """Phantoms, at strides 1 and 5; and fibers that cannot cross, by all rules."""
        for name, text, every in (("one", PHANTOM, 1), ("five", PHANTOM, 5), ("event", FIBERS, 1), ("paper", FIBERS + "crossing: {rule: sequential}\n", 1), ("thick", THICK, 1)):
            with self.subTest(name):
                row = self.run_of(name, text + OBSERVED % every, "--steps", "200")
                intervals, crossed, net, odd, _, rate = self.frames(name)[every]
                self.assertEqual([row[key] for key in ("intervals", "crossed", "net", "odd_pairs", "unsure")], [intervals, crossed, net, odd, 0])
                self.assertAlmostEqual(row["rate"], rate, delta=1e-5 * rate)
                self.assertEqual(crossed > 60, text == PHANTOM)
                self.assertGreater(row["looked_at"], intervals)

    def test_when(self):
        row = self.run_of("when", PHANTOM + OBSERVED % 1)
        uncross("topology", self.dir / "when" / "trajectory.h5", "--csv", self.dir / "found.csv")
        with open(self.dir / "found.csv", encoding="ascii") as file:
            times = [float(line["time"]) for line in csv.DictReader(file) if line["stride"] == "1"]
        self.assertGreater(len(times), 10)
        self.assertAlmostEqual(row["first_time"], min(times), 7)
        self.assertAlmostEqual(row["last_time"], max(times), 7)
        self.assertGreater(row["rate_error"], 0)
        self.assertEqual(uncross("plot", self.dir / "when", "--out", self.dir / "page.html").returncode, 0)
        self.assertIn(f"{row['crossed']:.0f} crossings of bonds in 40 intervals", (self.dir / "page.html").read_text())

    def test_a_run_that_goes_on_is_the_same(self):
        text = PHANTOM + OBSERVED % 2
        whole = self.run_of("whole", text, "--steps", "41")
        self.run_of("parts", text, "--steps", "17")
        self.run_of("parts", text, "--steps", "41", "--resume")
        self.assertGreater(whole["crossed"], 5)
        self.assertEqual((self.dir / "parts" / "topology.csv").read_bytes(), (self.dir / "whole" / "topology.csv").read_bytes())

    def test_frames_analyzed(self):
        row = self.run_of("run", PHANTOM + OBSERVED % 2)
        done = uncross("analyze", self.dir / "run" / "trajectory.h5", "--out", self.dir / "again")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.dir / "again" / "topology.csv").read_bytes(), (self.dir / "run" / "topology.csv").read_bytes())
        self.assertGreater(row["crossed"], 5)

    def test_refused(self):
        plane = PHANTOM.replace("[4, 4, 4]", "[4, 4, 1]").replace("time_step", "dimensions: 2\ntime_step")
        sheared = FIBERS.replace("medium: {kind: private, rate: 1}\n", "solvent: {per_cell: 5, collision_interval: 0.02}\nshear: {rate: 0.1}\n")
        points = "box: [4, 4, 4]\ntime_step: 0.01\nsteps: 1\nmedium: {kind: private, rate: 1}\nfibers: [{name: point, count: 3, vertices: 1, mass: 1}]\n"
        for text, said in (plane, "in a plane bonds meet"), (sheared, "a fiber that leaves a sheared box is replaced by an image"), (points, "there are no bonds"):
            (self.dir / "s.yaml").write_text(text + OBSERVED % 1)
            done = uncross("check", self.dir / "s.yaml")
            self.assertEqual(done.returncode, 2, done.stdout)
            self.assertIn("observe.topology: " + said, done.stderr)

    def test_what_it_costs_is_told(self):
        """Twice as many samples, twice the time; nothing of it where nobody asks."""
        times = []
        for text in OBSERVED % 1, OBSERVED % 2, "":
            (self.dir / "s.yaml").write_text(FIBERS + text)
            said = uncross("check", self.dir / "s.yaml").stdout
            times += [float(value) for value in re.findall(r"time of observe.topology +([0-9.e-]+) s +more", said)]
        self.assertEqual(len(times), 2)
        self.assertAlmostEqual(times[0] / times[1], 2, 4)

    def test_the_state_is_the_same(self):
        """Who is looked at does not move."""
        hashes = set()
        for name, more in ("seen", OBSERVED % 1), ("alone", ""):
            (self.dir / f"{name}.yaml").write_text(FIBERS + more)
            self.assertEqual(uncross("run", self.dir / f"{name}.yaml", "--out", self.dir / name, "--quiet").returncode, 0)
            hashes.add(json.loads((self.dir / name / "run.json").read_text())["state_hash"])
        self.assertEqual(len(hashes), 1)


if __name__ == "__main__":
    os.environ.pop("LANG", None)
    unittest.main()
