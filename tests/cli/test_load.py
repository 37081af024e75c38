#!/usr/bin/python3
"""Vertices load the fluid: `check`, `map` and run.json say so, with the viscosity of the fluid that they make.

What is expected is a double sum over Poisson numbers of particles and vertices in a cell, made here; and `map` never prints
a scene that `check` refuses.
"""
import json
import math
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import FolderTest, uncross  # noqa: E402

HEAVY = """box: [12, 12, 12]
time_step: 0.02
steps: 20
solvent: {per_cell: 5, collision_interval: 0.02, thermostat: maxwell-boltzmann}
shear: {rate: 0.05}
fibers:
  - {name: point, count: 6939, vertices: 1, mass: 5}
"""


def poisson(mean, most):
    return [math.exp(n * math.log(mean) - mean - math.lgamma(n + 1)) for n in range(most)]


def handed_on(gamma, vertices, mass):
    """<m_cell - sum m^2/m_cell> over cells of Poisson numbers of particles of mass 1 and of vertices."""
    total = 0.0
    for n, p in enumerate(poisson(gamma, int(gamma + 12 * math.sqrt(gamma) + 30))):
        for v, q in enumerate(poisson(vertices, 60)):
            cell = n + v * mass
            total += p * q * (cell - (n + v * mass**2) / cell if cell > 0 else 0.0)
    return total


def viscosity(gamma, vertices, mass, interval=0.02):
    """(bare, loaded): Eqs. (30) and (31) at 90 degrees; the collisional part with the members' masses."""
    partners = gamma - 1.0 + math.exp(-gamma)
    kinetic = gamma * interval * (5.0 * gamma / (partners * 6.0) - 0.5)
    return kinetic + partners / 18.0 / interval, kinetic + handed_on(gamma, vertices, mass) / 18.0 / interval


class Load(FolderTest):
    def check(self, text, *words):
        (self.dir / "scene.yaml").write_text(text)
        done = uncross("check", self.dir / "scene.yaml", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def number(self, told, name):
        return next(float(line[50:].split()[0]) for line in told.splitlines() if line[2:40].strip() == name)

    def test_check_says_how_viscous_the_fluid_is(self):
        for mass, per_cell, count in ((5, 5, 6939), (0.7, 5, 3000), (12, 9, 2000)):
            told = self.check(HEAVY.replace("mass: 5", f"mass: {mass}").replace("per_cell: 5", f"per_cell: {per_cell}")
                              .replace("6939", str(count)))
            bare, loaded = viscosity(per_cell, count / 12**3, mass)
            row = re.search(r"^  viscosity of the loaded fluid +eta_l +(\S+) m/a0 t0", told, re.M)
            self.assertAlmostEqual(float(row[1]) / loaded, 1.0, delta=1e-5)
            mass_row = re.search(r"^  mass per cell +rho +(\S+) m/a0\^3", told, re.M)
            self.assertAlmostEqual(float(mass_row[1]), per_cell + mass * count / 12**3, delta=1e-4)
            warned = "vertices load the fluid" in told
            self.assertEqual(warned, loaded / bare > 1.25, (mass, loaded / bare))

    def test_the_run_keeps_the_warning(self):
        (self.dir / "heavy.yaml").write_text(HEAVY)
        self.assertEqual(uncross("run", self.dir / "heavy.yaml", "--out", self.dir / "run", "--quiet").returncode, 0)
        warnings = json.loads((self.dir / "run" / "run.json").read_text())["warnings"]
        bare, loaded = viscosity(5, 6939 / 12**3, 5)
        self.assertTrue(any(f"{loaded / bare:.3g} times as viscous" in text for text in warnings), warnings)

    def test_units_are_not_right_about_viscosity(self):
        told = self.check(HEAVY, "--units", "a0=50nm,T=300K,eta=1mPas")
        right = re.search(r"^  right: .*$", told, re.M)[0]
        self.assertNotIn("viscosity governs", right)
        self.assertRegex(told, r"(?m)^  wrong: .*5\.\d+ times")
        light = self.check(HEAVY.replace("6939", "60"), "--units", "a0=50nm,T=300K,eta=1mPas")
        self.assertIn("viscosity governs", re.search(r"^  right: .*$", light, re.M)[0])

    def test_no_hydrodynamics_no_load(self):
        told = self.check(HEAVY.replace("shear: {rate: 0.05}", "").replace("per_cell: 5,", "per_cell: 5, hydrodynamics: false,"))
        self.assertNotIn("loaded fluid", told)
        self.assertNotIn("load the fluid", told)


    def test_rows_of_a_flow_are_of_the_loaded_fluid(self):
        """Couette and Poiseuille flow, and a force with a profile: stress, velocity, Reynolds number and transient of the fluid with its
        vertices, whose mass goes along; the force is on the solvent alone."""
        _, eta = viscosity(5, 6939 / 12**3, 5)
        nu = eta / (5 + 5 * 6939 / 12**3)
        walled = HEAVY.replace("shear: {rate: 0.05}", "walls: {kind: no-slip, shear_rate: 0.05}")
        told = self.check(walled)
        slip, effective = self.number(told, "slip length"), self.number(told, "effective shear rate")
        self.assertAlmostEqual(effective, 0.05 / (1 + 2 * slip / 12), delta=1e-7)
        self.assertAlmostEqual(self.number(told, "shear stress") / (eta * effective), 1.0, delta=1e-5)
        self.assertAlmostEqual(self.number(told, "Reynolds number") / (0.3 * 12 / nu), 1.0, delta=1e-5)
        self.assertAlmostEqual(self.number(told, "time to become steady") / (144 / (4 * math.pi**2 * nu)), 1.0, delta=1e-5)
        pushed = HEAVY.replace("shear: {rate: 0.05}", "walls: {kind: no-slip}").replace("per_cell: 5,", "per_cell: 5, acceleration: [0.02, 0, 0],")
        self.assertAlmostEqual(self.number(self.check(pushed), "largest velocity by the force") /
                               (5 * 0.02 * 144 / (8 * eta) * (1 + 4 * slip / 12)), 1.0, delta=1e-5)
        waves = HEAVY.replace("shear: {rate: 0.05}", "").replace("per_cell: 5,", "per_cell: 5, acceleration: [0.02, 0, 0], profile: sine,")
        told, k = self.check(waves), 2 * math.pi / 12
        self.assertAlmostEqual(self.number(told, "largest velocity") / (5 * 0.02 / (eta * k * k)), 1.0, delta=1e-5)
        self.assertAlmostEqual(self.number(told, "time to become steady") * nu * k * k, 1.0, delta=1e-5)

    def test_frozen_vertices_do_not_go_with_the_flow(self):
        scene = HEAVY.replace("shear: {rate: 0.05}", "").replace("mass: 5}", "mass: 5, frozen: true}")
        told = self.check(scene)
        for words in ("load the fluid", "eta_l", "  mass per cell "):
            self.assertFalse(words in told, words)
        mixed = self.check(scene + "  - {name: loose, count: 3000, vertices: 1, mass: 5}\n")
        self.assertAlmostEqual(self.number(mixed, "viscosity of the loaded fluid") / viscosity(5, 3000 / 12**3, 5)[1], 1.0, delta=1e-5)
        chains = self.check(scene + "  - {name: held, count: 1000, vertices: 5, mass: 5, bond_length: 0.5, spring: 100, held: ends}\n")
        self.assertAlmostEqual(self.number(chains, "viscosity of the loaded fluid") / viscosity(5, 3000 / 12**3, 5)[1], 1.0, delta=1e-5)

    def test_a_fluid_of_pairs(self):
        """A pair hands on momentum as its reduced mass: sum n_i n_j 2 mu_ij in place of rho^2, 1.736 vertices of mass 10 beside 3."""
        scene = "\n".join(line for line in HEAVY.replace("mass: 5}", "mass: 10}").replace("6939", "3000").splitlines()
                          if not line.startswith(("shear", "solvent"))) + "\nmedium: {kind: pairs, density: 3, rate: 9, draw: relax}\n"
        told, n = self.check(scene, "--units", "a0=50nm,T=300K,eta=1mPas"), 3000 / 12**3
        collisional = self.number(told, "collisional viscosity")
        expected = self.number(told, "viscosity") + collisional * ((9 + 2 * 3 * n * 20 / 11 + n * n * 10) / 9 - 1)
        self.assertAlmostEqual(self.number(told, "viscosity of the loaded fluid") / expected, 1.0, delta=1e-4)
        self.assertAlmostEqual(self.number(told, "mass per cell"), 3 + 10 * n, delta=1e-3)
        self.assertRegex(told, r"vertices load the fluid: they add 17\.4 m per a0\^3 to the solvent's 3 .*medium\.density=12")
        self.assertNotIn("viscosity governs", re.search(r"^  right: .*$", told, re.M)[0])


class Map(FolderTest):
    def map(self, what, units="T=300K,eta=1mPas"):
        done = uncross("map", what, "--units", units)
        (self.dir / "mapped.yaml").write_text(done.stdout)
        return done

    def test_actin_at_a_milligram(self):
        """Vertices 4 per cell, as `check` counts them: the comment says the load, offers lighter vertices and more solvent, and
        says which part of the volume the flow sees filled."""
        done = self.map("length=10um,persistence=17um,diameter=7nm,mesh=0.34um")
        self.assertEqual(done.returncode, 0, done.stderr)
        comment = " ".join(line.lstrip("# ") for line in done.stdout.splitlines() if line.startswith("#"))
        count, edge = (int(re.search(rf"{key}: \[?(\d+)", done.stdout)[1]) for key in ("count", "box"))
        per_cell = count * 64 / edge**3
        self.assertAlmostEqual(per_cell, 4.0, delta=1.0)
        bare, loaded = viscosity(5, per_cell, 5)
        self.assertIn(f"{5 * per_cell:.3g} m per cell", comment)
        self.assertIn(f"{loaded / bare:.3g} times as viscous", comment)
        bare, lighter = viscosity(5, per_cell, 2.5)
        self.assertIn(f"--set fibers.fiber.mass=2.5 ({lighter / bare:.3g} times)", comment)
        self.assertRegex(comment, r"--set solvent\.per_cell=\d+")
        filled = count * 63 * 0.53 * math.pi * 0.3**2 / edge**3  # a bond is some 0.53 a0 long
        found = float(re.search(r"fills? (\d+) % of the volume", comment)[1])
        self.assertAlmostEqual(found / (100 * filled), 1.0, delta=0.03)

    def test_one_fiber_is_no_load(self):
        self.assertNotIn("times as viscous", self.map("length=10um,persistence=17um").stdout)

    def test_check_takes_what_map_prints(self):
        printed = 0
        for persistence in ("17um", "1e4um", "1e6um", "1e12um", "2nm"):
            for length, vertices in (("1um", 3), ("1um", 64), ("100um", 8), ("100um", 64), ("10um", 200)):
                done = self.map(f"length={length},persistence={persistence},vertices={vertices}")
                if done.returncode:
                    self.assertEqual((done.returncode, done.stdout), (2, ""))
                    self.assertRegex(done.stderr, r"^uncross: map: [^\n]+\n$")
                    continue
                printed += 1
                told = uncross("check", self.dir / "mapped.yaml")
                self.assertEqual(told.returncode, 0, told.stderr)
                self.assertNotIn("omega dt", told.stdout.partition("Warnings")[2])
        self.assertGreater(printed, 8)


if __name__ == "__main__":
    unittest.main()
