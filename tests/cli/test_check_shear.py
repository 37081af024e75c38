#!/usr/bin/python3
"""What `check` says of fibers in a flow that shears them: the numbers of the paper's Table II by the fiber's length and by its
persistence length, and the warning. Expected values are from formulas that are written out here."""
import math
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import FolderTest, uncross  # noqa: E402

SCENE = """box: [20, 20, 20]
time_step: 0.02
steps: 10
solvent: {{per_cell: 5, collision_interval: 0.02{solvent}}}
fibers: [{{name: f, count: 1, vertices: 16, mass: 1, bond_length: 0.5, spring: 100, persistence_length: 32}}]
crossing: {{rule: event-driven}}
{more}
"""
HEIGHT, LENGTH, PERSISTENCE, SOUND = 20.0, 8.0, 32.0, math.sqrt(5.0 / 3.0)

# SRD in three dimensions at 90 degrees, gamma = 5, dt_c = 0.02: Ihle and Kroll (2003), Kikuchi et al. (2003).
PARTNERS = 5.0 - 1.0 + math.exp(-5.0)
NU = 0.01 * (5.0 * 5.0 / (3.0 * PARTNERS) - 1.0) + PARTNERS / (18.0 * 5.0 * 0.02)
# Tirado and Garcia de la Torre (1980), aspect ratio L/0.5 a0.
P = LENGTH / 0.5
TAU_R = math.pi * 5.0 * NU * LENGTH**3 / (6.0 * (math.log(P) - 0.662 + 0.917 / P - 0.050 / P**2))


class Shear(FolderTest):
    def said(self, solvent="", more=""):
        """{symbol: number} of the rows about the shear, and the warning."""
        path = self.dir / "scene.yaml"
        path.write_text(SCENE.format(solvent=solvent, more=more))
        done = uncross("check", path)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = re.findall(r"^    \w+ number of the shear\S*(?: stiff)? +(\S+) +(\S+)", done.stdout, re.M)
        return {symbol: float(value) for symbol, value in rows}, re.search(r"over their length.*", done.stdout)

    def check_rate(self, rate, *scene):
        rows, warning = self.said(*scene)
        expected = {"Ma(L)": rate * LENGTH / SOUND, "Re(L)": rate * LENGTH**2 / NU, "Ma(l_p)": rate * PERSISTENCE / SOUND,
                    "Re(l_p)": rate * PERSISTENCE**2 / NU, "Pe": rate * TAU_R}
        self.assertEqual(rows.keys(), expected.keys())
        for symbol, value in expected.items():  # 16 vertices load 40000 particles by 0.04 %
            self.assertAlmostEqual(rows[symbol] / value, 1.0, delta=1e-3, msg=symbol)
        largest = max(expected["Ma(L)"], expected["Re(L)"])
        self.assertEqual(warning is not None, largest > 0.1)
        if warning:
            slower = float(re.search(r"at least (\S+) times slower", warning[0])[1])
            self.assertAlmostEqual(slower / (largest / 0.1), 1.0, delta=0.01)

    def test_sheared_box(self):
        self.check_rate(0.03, "", "shear: {rate: 0.03}")
        self.check_rate(0.001, "", "shear: {rate: -0.001}")

    def test_oscillation(self):
        self.check_rate(0.02, "", "shear: {rate: 0.02, period: 10}")

    def test_walls(self):
        self.check_rate(0.5 / HEIGHT, "", "walls: {kind: no-slip, lower: [-0.2, 0, 0], upper: [0.3, 0, 0]}")

    def test_force_between_walls(self):
        self.check_rate(0.001 * HEIGHT / (2.0 * NU), ", acceleration: [0.001, 0, 0]", "walls: {kind: no-slip}")

    def test_profiles(self):
        self.check_rate(0.001 * HEIGHT / (2.0 * math.pi * NU), ", acceleration: [0.001, 0, 0], profile: sine")
        self.check_rate(0.001 * HEIGHT / (4.0 * NU), ", acceleration: [0.001, 0, 0], profile: reverse")

    def test_bead(self):
        """Beside a bead the solvent is no faster than the bead."""
        rows, _ = self.said("", "bead: {radius: 2, drive: {spring: 10, velocity: [0.05, 0, 0]}}")
        self.assertAlmostEqual(rows["Ma(L)"] / (0.05 / SOUND), 1.0, delta=1e-5)
        self.assertAlmostEqual(rows["Re(l_p)"] / (0.05 * PERSISTENCE / NU), 1.0, delta=1e-3)
        swing, _ = self.said("", "bead: {radius: 2, drive: {spring: 10, amplitude: [0, 1, 0], period: 100}}")
        self.assertAlmostEqual(swing["Ma(L)"] / (math.pi / 50.0 / SOUND), 1.0, delta=1e-5)
        pulled, _ = self.said("", "bead: {radius: 2, drive: {force: [5, 0, 0]}}")
        self.assertEqual(pulled["Ma(L)"], pulled["Ma(l_p)"])

    def test_nothing_without_a_shear(self):
        self.assertEqual(self.said(), ({}, None))
        self.assertEqual(self.said(", acceleration: [0.001, 0, 0]"), ({}, None))


if __name__ == "__main__":
    unittest.main()
