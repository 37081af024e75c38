#!/usr/bin/python3
"""The two halves of `uncross topology` against each other: between two frames the linking number of a pair of rings, in one image, changes by
as much as their bonds cross, with signs; and it does not change if none cross. The one half follows moves in time, the other looks at
one frame. With (p x q).w the sign of a crossing of a diagram is the opposite, so where this rises through 0 lk falls by 1. Knots change only where a ring crosses itself."""
import collections
import os
import pathlib
import sys

import numpy

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1])]
from support import TOP, UNCROSS, FolderTest, unittest, uncross  # noqa: E402

sys.path.insert(0, str(TOP / "python"))
os.environ["UNCROSS"] = str(UNCROSS)
from uncross_topology import crossings, frame, links, readers  # noqa: E402

SCENE = """box: [4, 4, 4]
seed: {seed}
time_step: 0.02
steps: {steps}
solvent: {{per_cell: 2, collision_interval: 0.04}}
fibers:
  - {{name: ring, count: 24, vertices: 12, ring: true, mass: 1, bond_length: 0.5, spring: 100, persistence_length: 1, start: circle}}
crossing: {{forbidden: {forbidden}}}
{more}
trajectory: {{every: 1}}
"""


class Invariants(FolderTest):
    def frames(self, **words):
        (self.dir / "scene.yaml").write_text(SCENE.format(**words))
        done = uncross("run", self.dir / "scene.yaml", "--out", self.dir / f"run-{words['seed']}", "--quiet")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        reader = readers.open_file(str(self.dir / f"run-{words['seed']}" / "trajectory.h5"), {})
        self.addCleanup(reader.close)
        return reader.topology, list(reader.frames())

    def follow(self, topology, frames):
        """Sums over all intervals of changes of lk, each equal to the net crossings of its pair and image."""
        finder = crossings.Finder(topology)
        self.addCleanup(finder.close)
        ring_of = {vertex: k for k, curve in enumerate(topology.curves) for vertex in curve.vertices}
        order = {(a, b): 1 for curve in topology.curves for a, b in zip(curve.vertices, numpy.roll(curve.vertices, -1))}
        numbers = [links.linking_numbers(frame_, topology.curves) for frame_ in frames]
        knots = [links.find_knots(list(links.polygons_of(frame_, topology.curves).values())) for frame_ in frames]
        total = {"crossings": 0, "changes": 0, "knots": 0}
        for first, last, before, after, knot, knot_after in zip(frames, frames[1:], numbers, numbers[1:], knots, knots[1:]):
            net, itself = collections.Counter(), set()
            for ((i, j), image), (count, sum_) in finder.between(first, last).count.items():
                total["crossings"] += count
                one, other = (ring_of[topology.bonds[bond][0]] for bond in (i, j))
                turned = numpy.prod([order.get(tuple(topology.bonds[bond]), -1) for bond in (i, j)])
                image = tuple(image)
                if one > other or (one == other and image < (0, 0, 0)):
                    one, other, image = other, one, tuple(-x for x in image)
                if one == other and not any(image):
                    itself.add(one)
                else:
                    net[one, other, image] -= int(sum_ * turned)
            change = collections.Counter(after)
            change.subtract(before)
            change, net = ({pair: value for pair, value in counter.items() if value} for counter in (change, net))
            self.assertEqual(change, net)
            changed = {k for k, (a, b) in enumerate(zip(knot, knot_after)) if a.polynomial != b.polynomial}
            self.assertLessEqual(changed, itself)
            total["changes"] += len(change)
            total["knots"] += len(changed)
        return total

    def test_rings_are_kept(self):
        for seed in 1, 2:
            topology, frames = self.frames(seed=seed, steps=30, forbidden="true", more="")
            self.assertGreater(len(links.linking_numbers(frames[0], topology.curves)), 20)
            self.assertEqual(self.follow(topology, frames), {"crossings": 0, "changes": 0, "knots": 0})

    def test_phantoms(self):
        topology, frames = self.frames(seed=1, steps=60, forbidden="false", more="")
        self.assertGreater(self.follow(topology, frames)["changes"], 100)

    def test_phantoms_in_shear(self):
        topology, frames = self.frames(seed=1, steps=40, forbidden="false", more="shear: {rate: 0.5}")
        self.assertGreater(self.follow(topology, frames)["changes"], 50)

    def test_coils(self):
        """Random closed walks that move at random: many crossings in an interval, of rings with themselves too; the box slides on."""
        rng = numpy.random.default_rng(1)
        steps = rng.normal(size=(8, 50, 3))
        at = numpy.cumsum(steps - steps.mean(axis=1, keepdims=True), axis=1) * 0.4 + rng.uniform(-6, 6, size=(8, 1, 3))
        rows = numpy.arange(400).reshape(8, 50)
        bonds = numpy.stack([rows, numpy.roll(rows, -1, axis=1)], axis=-1).reshape(-1, 2).astype(numpy.int32)
        topology = frame.Topology(numpy.arange(400), bonds, frame.curves(bonds, 400))
        moves = [at + 0.3 * rng.normal(size=at.shape) for _ in range(12)]
        frames = [frame.Frame(k, 0.02 * k, [5 * 2**32, 4 * 2**32, 6 * 2**32], [True] * 3, 2**33 + k * 2**28, 2.0**28 / 0.02,
                              frame.on_lattice(place.reshape(-1, 3))) for k, place in enumerate(moves)]
        total = self.follow(topology, frames)
        self.assertGreater(total["changes"], 100)
        self.assertGreater(total["knots"], 10)


if __name__ == "__main__":
    unittest.main()
