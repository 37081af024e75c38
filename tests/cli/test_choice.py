#!/usr/bin/python3
"""`check` says which choice is far cheaper and as right, where docs/claims/settings.md measured it; and nothing elsewhere.

Expected steps: a frequency by hand (a chain of n bonds k between masses M: 2 sqrt(k/M) cos(pi/2n)), and the bounds of the page. Expected ratios: those of the steps where a step
costs the same, else of the numbers of ns that the page itself prints.
"""
import math
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, FolderTest, uncross  # noqa: E402

PRIVATE = "medium: {{kind: private, rate: {rate:g}, draw: relax}}"
PAIRS = "medium: {{kind: pairs, density: {density:g}, rate: 9, draw: relax, weight: quadratic, repulsion: {repulsion:g}}}"
CHAINS = "fibers: [{name: chain, count: 20, vertices: 10, mass: 5, bond_length: 0, spring: 3}]\ncrossing: {forbidden: false}"
FIBERS = "fibers: [{name: fiber, count: 1000, vertices: 24, mass: 5, bond_length: 0.5, spring: 100, bending: 24%s}]"
FREE = "crossing: {forbidden: false}"
LOOSE = "fibers: [{{name: vertex, count: {count}, vertices: 1, mass: 5}}]\ncrossing: {{forbidden: false}}"
SWAP = "solvent: {per_cell: 5, collision_interval: 0.02, hydrodynamics: false%s}"


class Choice(FolderTest):
    def told(self, step, *parts, order="kick-split", box=14, height=None):
        """(times, what to choose) or None, and the whole report."""
        (self.dir / "scene.yaml").write_text(f"box: [{box}, {box}, {height or box}]\ntime_step: {step:g}\norder: {order}\nsteps: 100\n" + "\n".join(parts) + "\n")
        done = uncross("check", self.dir / "scene.yaml")
        self.assertEqual(done.returncode, 0, done.stderr)
        found = re.findall(r"^  this scene takes (\S+) times as long as with (.*), where .* \(docs/claims/settings\.md\)$", done.stdout, re.M)
        self.assertLessEqual(len(found), 1)
        self.assertEqual(bool(found), "settings.md" in done.stdout)
        return (float(found[0][0]), found[0][1]) if found else None

    def test_short_steps_of_fibers(self):
        omega = 2.0 * math.sqrt(3.0 / 5.0) * math.cos(math.pi / 20.0)
        self.assertTrue(0.1 < 0.283 / omega < 0.2)  # 0.1 is the largest step of one digit, 1, 2 or 4
        for step, expected in ((0.02, (5.0, "time_step: 0.1")), (0.025, (4.0, "time_step: 0.1")), (0.01, (10.0, "time_step: 0.1")), (0.03, None), (0.1, None), (0.2, None)):
            self.assertEqual(self.told(step, PRIVATE.format(rate=1), CHAINS), expected, step)

    def test_step_of_a_bath(self):
        """A bath of 10/t0 forgets in 0.1 t0: rate dt is 0.2 at 0.02."""
        self.assertEqual(self.told(0.005, PRIVATE.format(rate=10), CHAINS), (4.0, "time_step: 0.02"))
        self.assertIsNone(self.told(0.008, PRIVATE.format(rate=10), CHAINS))

    def test_what_collisions_cost_is_no_step(self):
        """In a solvent the step is a small part of the cost; among phantoms it is most of it."""
        solvent = "solvent: {per_cell: 5, collision_interval: 0.02, thermostat: rescale}"
        self.assertIsNone(self.told(0.002, solvent, CHAINS))
        phantoms = "solvent: {per_cell: 5, collision_interval: 0.02, hydrodynamics: false, bath: phantoms}"
        times, words = self.told(0.0005, phantoms, CHAINS)
        self.assertEqual(words, "time_step: 0.02")  # the interval: no step is longer
        self.assertAlmostEqual(times, (25 / 0.0005 + 170 / 0.02) / (25 / 0.02 + 170 / 0.02), delta=0.06)

    def test_pairs(self):
        liquid = PAIRS.format(density=3, repulsion=25)
        self.assertEqual(self.told(0.005, liquid), (round(8.0 / 1.4, 1), "time_step: 0.04 and order: drift-split"))
        self.assertEqual(self.told(0.01, liquid, order="drift-split"), (4.0, "time_step: 0.04"))
        for step, order, medium in ((0.01, "kick-split", liquid), (0.0125, "drift-split", liquid), (0.001, "drift-split", PAIRS.format(density=3, repulsion=30)),
                                    (0.001, "drift-split", PAIRS.format(density=4, repulsion=25)), (0.001, "drift-split", PAIRS.format(density=3, repulsion=0))):
            self.assertIsNone(self.told(step, medium, order=order), (step, order, medium))
        self.assertEqual(self.told(0.0004, liquid, order="drift-split"), (100.0, "time_step: 0.04"))
        for parts in ((liquid.replace("relax", "replace"),), (liquid.replace("rate: 9", "rate: 20"),), (liquid.replace("quadratic", "hat"),),
                      (liquid, "fibers: [{name: light, count: 32, vertices: 1, mass: 0.01}]", FREE)):  # which would move too far
            self.assertIsNone(self.told(0.001, *parts, order="drift-split"), parts)

    def test_swap(self):
        times, words = self.told(0.02, SWAP % "", LOOSE.format(count=32), box=8)
        self.assertEqual(words, "solvent.bath: phantoms")
        self.assertAlmostEqual(times, 15 * 2560 / (32 * (170 + 25)) * (1.0 + 32 * 25 / (15 * 2560)), delta=0.06)
        self.assertEqual(self.told(0.02, SWAP % ", thermostat: rescale", LOOSE.format(count=32), box=8), (times, "solvent.bath: phantoms, thermostat: none"))
        self.assertIsNone(self.told(0.02, SWAP % "", LOOSE.format(count=2000), box=8))  # four in a cell: a phantom for each costs as much
        for parts in ((SWAP % "",), (SWAP.replace("per_cell: 5", "per_cell: 1001") % "", LOOSE.format(count=32)), (SWAP % ", rule: at-a", LOOSE.format(count=32)),
                      (SWAP % "", CHAINS.replace("crossing: {forbidden: false}", ""))):  # refused, refused, not measured, must not cross
            self.assertIsNone(self.told(0.02, *parts, box=8), parts)

    def test_nothing_is_said_of_what_was_not_measured(self):
        held, closed = "solvent: {per_cell: 1, collision_interval: 0.02, thermostat: rescale}", "solvent: {per_cell: 1, collision_interval: 0.02}"
        self.assertEqual(self.told(0.001, held, FIBERS % "", FREE)[1], "time_step: 0.01")
        for parts in ((closed, FIBERS % "", FREE), (held, FIBERS % ""), (held, FIBERS.replace("1000", "10") % ", diameter: 0.1", "crossing: {rule: event-driven}"),
                      (held, "walls: {kind: no-slip}", FIBERS % "", FREE), (held, "shear: {rate: 0.05}", FIBERS % "", FREE),
                      (held, FIBERS % ", held: ends", FREE), (held, FIBERS % ", force: [0, 0, 1]", FREE)):
            self.assertIsNone(self.told(0.001, *parts), parts)
        self.assertIsNone(self.told(0.001, held, "dimensions: 2", FIBERS % "", FREE, height=1))

    def test_no_scene_that_comes_with_the_program_is_far(self):
        for scene in sorted((TOP / "scenes").glob("*.yaml")):
            self.assertNotIn("settings.md", uncross("check", scene).stdout, scene.name)


if __name__ == "__main__":
    unittest.main()
