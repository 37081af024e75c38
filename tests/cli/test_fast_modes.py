#!/usr/bin/python3
"""What a time step does to the fastest mode of a fiber: a leap-frog has one formula, overdamped motion another one, and what
stands still has none. Expected: 4 k D_0 dt of springs and 16 kappa D_0 dt/b^2 of bends, 1/(1 - lambda dt/2) of a mode's mean square."""
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import FolderTest, uncross  # noqa: E402

SCENE = """box: [16, 16, 16]
time_step: {dt}
steps: 10
crossing: {{forbidden: false}}
medium: {{kind: {medium}}}
fibers: [{{name: a, vertices: 8, count: 4, mass: 2, bond_length: {bond}, spring: {spring}, bending: {bending}{more}}}]
"""


class Modes(FolderTest):
    def check(self, medium="overdamped, rate: 5", dt=0.01, spring=50, bending=0, bond=0, more=""):
        (self.dir / "scene.yaml").write_text(SCENE.format(medium=medium, dt=dt, spring=spring, bending=bending, bond=bond, more=more))
        done = uncross("check", self.dir / "scene.yaml")
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def warning(self, told):
        return " ".join(re.findall(r"^  warning: (.*)$", told, re.M))

    def test_overdamped_springs(self):
        """D_0 = 1/(2 5): 4 50 0.1 0.01 = 0.2, a mean square 1/(1 - 0.1) = 1.11 times as large; 2 % at lambda dt = 0.0392, dt = 0.00196."""
        told = self.check()
        self.assertNotIn("omega dt", told)
        self.assertNotIn("energy error", told)
        said = self.warning(told)
        self.assertIn("11 % too large", said)
        step = float(re.search(r"time_step ([\d.e-]+)", said)[1])
        self.assertTrue(0.5 * 0.00196 < step <= 0.00196, step)
        self.assertNotIn("too large", self.warning(self.check(dt=step)))
        self.assertNotIn("too large", self.warning(self.check(spring=5)))

    def test_overdamped_bends(self):
        """16 20 0.1 0.01/0.8^2 = 0.5 of bends; springs alone have 0.2. Bonds of spring 50 are some 5 % longer than 0.8."""
        excess = float(re.search(r"(\d+) % too large", self.warning(self.check(bending=20, bond=0.8)))[1])
        self.assertTrue(22 < excess < 34, excess)  # 1/(1 - 0.25) - 1 = 33 %, and 22 % at a bond 10 % longer

    def test_unstable(self):
        self.assertIn("unstable", self.warning(self.check(spring=600)))  # 2.4
        self.assertIn("unstable", self.warning(self.check(bending=100, bond=0.5, spring=50)))  # 6.4

    def test_filaments_have_no_springs(self):
        """Springs have no effect there: only the fastest bend counts, 16 4 0.1 0.01/0.5^2 = 0.256."""
        more = ", force: [0, 0, 1], start: straight"
        told = self.check("overdamped, rate: 5, inextensible: true", spring=1e6, bending=4, bond=0.5, more=more)
        self.assertNotIn("omega dt", told)
        self.assertNotIn("too large", told)
        self.assertNotIn("unstable", self.warning(told))
        self.assertIn("unstable", self.warning(self.check("overdamped, rate: 5, inextensible: true", spring=1e6, bending=40, bond=0.5, more=more)))

    def test_what_moves_by_a_leap_frog(self):
        moving = self.check("private, rate: 5", spring=2000)
        self.assertIn("omega dt", self.warning(moving))  # 2 sqrt(2000/2) 0.01 = 0.63
        frozen = self.check("private, rate: 5", spring=2000, more=", frozen: true")
        self.assertNotIn("omega dt", self.warning(frozen))


if __name__ == "__main__":
    unittest.main()
