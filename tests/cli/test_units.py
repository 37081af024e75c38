#!/usr/bin/python3
"""SI units: `check --units`, `map`, and docs/units.md.

Expected numbers are made here from the definitions, with CODATA's constants and none of the program's formulas: the
viscosity from Eqs. (30) and (31) of the paper, the mean bond by a sum, the bending constant by bisection.
"""
import math
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
UNCROSS = pathlib.Path(os.environ.get("UNCROSS", TOP / "build/uncross")).resolve()
PAGE = TOP / "docs/units.md"
BOLTZMANN = 1.380649e-23  # J/K, exact
DALTON = 1.66053906660e-27  # kg, CODATA 2018
PREFIX = {"z": 1e-21, "a": 1e-18, "f": 1e-15, "p": 1e-12, "n": 1e-9, "u": 1e-6, "m": 1e-3, "": 1.0, "k": 1e3, "M": 1e6,
          "G": 1e9}


def run(*words, code=0, folder=None):
    done = subprocess.run([UNCROSS, *words], capture_output=True, text=True, check=False, cwd=folder)
    assert done.returncode == code, f"{words}: {done.returncode}\n{done.stderr}"
    return done.stdout if code == 0 else done.stderr


def number(text):
    """'470.04 us' -> 4.7004e-4; '2.3506e-13 m^2/s' -> 2.3506e-13."""
    value, _, unit = text.partition(" ")
    for base in ("m/s", "N/m", "Pa s", "m", "s", "J", "N"):
        if unit.endswith(base) and unit[:-len(base)] in PREFIX and unit not in ("1/m", "kg/s"):
            return float(value) * PREFIX[unit[:-len(base)]]
    return float(value)


ROW = re.compile(r"  (.{38}) (.{9}) +(\S+) (.{9}) (.*)")


def rows(report):
    """{name: (value, unit, SI text)} of the rows of a report that have a unit; the last of a name counts."""
    found = {}
    for line in report.partition("\nParts of the program")[0].splitlines():
        at = ROW.fullmatch(line.ljust(75))
        if at and re.fullmatch(r"[-+.\de]+|nan", at[3]):
            found[at[1].strip()] = (float(at[3]), at[4].strip(), re.split(r"  +", at[5].strip() + "  ")[0])
    return found


def viscosity(gamma, interval, degrees):
    """Padding 2009, Eqs. (30) and (31), in m/(a0 t0)."""
    cos, partners = math.cos(math.radians(degrees)), gamma - 1 + math.exp(-gamma)
    kinetic = gamma * interval * (5 * gamma / (partners * (4 - 2 * cos - 2 * math.cos(2 * math.radians(degrees)))) - 0.5)
    return kinetic + (1 - cos) / (18 * interval) * partners


def mean_bond(spring, rest):
    lengths = [(i + 0.5) * 1e-5 for i in range(200000)]
    weights = [l * l * math.exp(-0.5 * spring * (l - rest) ** 2) for l in lengths]
    return sum(l * w for l, w in zip(lengths, weights)) / sum(weights)


def langevin_inverse(cosine):
    low, high = 1e-6, 1e6
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if 1 / math.tanh(middle) - 1 / middle < cosine else (low, middle)
    return high


def wormlike(length, persistence):
    x = length / persistence
    return math.sqrt(2 * persistence * length * (1 - (1 - math.exp(-x)) / x))


ETA = viscosity(5, 0.02, 90)


class Units(unittest.TestCase):
    def near(self, found, wanted, digits=4.5e-5, what=""):
        self.assertLess(abs(found / wanted - 1), digits, f"{what}: {found} for {wanted}")

    def units_of(self, words):
        """a0, kT, t0, m in SI units, of a solvent at the paper's point."""
        given = dict(word.split("=") for word in words.split(","))
        a0, kt = float(given["a0"][:-2]) * 1e-9, BOLTZMANN * float(given["T"][:-1])
        if "eta" in given:  # eta = eta* kT t0/a0^3
            t0 = float(given["eta"][:-4]) * 1e-3 * a0 ** 3 / (ETA * kt)
            mass = kt * t0 * t0 / a0 ** 2
        elif "rho" in given:  # gamma m = rho a0^3
            mass = float(given["rho"][:-5]) * a0 ** 3 / 5
            t0 = a0 * math.sqrt(mass / kt)
        elif "mass" in given:
            mass = float(given["mass"][:-3]) * 1e3 * DALTON
            t0 = a0 * math.sqrt(mass / kt)
        else:
            t0 = float(given["t0"][:-2]) * 1e-6
            mass = kt * t0 * t0 / a0 ** 2
        return {"a0": a0, "kT": kt, "t0": t0, "m": mass}

    def test_every_row(self):
        """Units such as "m/a0 t0" are read word by word: what is left of the slash over what is right of it."""
        for scene in ("semidilute", "chains", "solvent"):
            for words in ("a0=50nm,T=300K,eta=1mPas", "a0=50nm,T=300K,rho=1000kg/m3", "a0=30nm,T=280K,mass=2kDa",
                          "a0=50nm,T=300K,t0=3us"):
                unit = self.units_of(words)
                more = ("--set", "flow=[0.1, 0, 0]", "--set", "solvent.acceleration=[0, 0.1, 0]")
                more += () if scene == "solvent" else ("--set", "fibers.0.force=[0, 0, 2]")
                found = rows(run("check", TOP / f"scenes/{scene}.yaml", "--units", words, *more))
                self.assertGreater(len(found), 15)
                for name, (value, reduced, si) in found.items():
                    if reduced in ("", "degrees") or name == "box":
                        continue
                    wanted, above = value, True
                    for word in re.findall(r"/|[^/ ]+", reduced):
                        base, _, power = word.partition("^")
                        if word == "/":
                            above = False
                        elif base != "1":
                            wanted *= unit[base] ** (int(power or 1) * (1 if above else -1))
                    self.assertTrue(si, f"{name}: no SI value of {reduced}")
                    if wanted != 0:
                        self.near(number(si), wanted, 6e-5, f"{scene}, {words}, {name}")

    def test_beside_water(self):
        said = run("check", TOP / "scenes/semidilute.yaml", "--units", "a0=50nm,T=300K,eta=1mPas")
        unit = self.units_of("a0=50nm,T=300K,eta=1mPas")
        density = 5 * unit["m"] / unit["a0"] ** 3
        sound = math.sqrt(5 / 3) * unit["a0"] / unit["t0"]
        for name, ratio in (("density", density / 997.05), ("viscosity", 1e-3 / 0.89e-3), ("speed of sound", sound / 1496.7),
                            ("kinematic viscosity", 1e-3 / density / (0.89e-3 / 997.05))):
            self.near(float(re.search(rf"\n  {name} .* ratio (\S+)", said)[1]), ratio, 5e-3, name)
        self.assertIn("wrong:  the density", said)
        said = run("check", TOP / "scenes/semidilute.yaml", "--units", "a0=50nm,T=300K,rho=997.05kg/m3")
        self.assertRegex(said, r"\n  density .* ratio 1\n")
        self.assertIn("wrong:  the viscosity", said)

    def test_without_time(self):
        said = run("check", TOP / "scenes/semidilute.yaml", "--units", "a0=50nm,T=300K")
        found = rows(said)
        self.assertEqual(found["persistence length"][2], "1.6 um")
        self.near(number(found["elastic modulus"][2]), 50 * BOLTZMANN * 300 / 50e-9)
        self.assertNotRegex(said.partition("\nParts of")[0], r"[\d] [num]?s\b|kg|nan")
        self.assertIn("The unit of time is not fixed: one of eta=, rho=, mass=, t0=", said)
        self.assertNotIn("SI units", run("check", TOP / "scenes/semidilute.yaml"))

    def test_same_value_in_other_units(self):
        scene = TOP / "scenes/solvent.yaml"
        first = run("check", scene, "--units", "a0=50nm,T=300K,eta=1mPas")
        for words in ("a0=0.05um,T=0.3kK,eta=1e-3Pas", "T=300K,a0=5e-8 m,eta=1 mPa.s", "a0=50nm,T=300K,eta=1cP",
                      "a0=50nm,T=300K,eta=0.01P", "a0=.05µm,T=300K,eta=1mPa s"):
            self.assertEqual(first, run("check", scene, "--units", words), words)
        first = run("check", scene, "--units", "a0=50nm,T=300K,rho=1000kg/m3")
        self.assertEqual(first, run("check", scene, "--units", "a0=50nm,T=300K,rho=1g/cm^3"))

    def test_numbers(self):
        """For programs: the rows of the report, with all digits."""
        scene = TOP / "scenes/semidilute.yaml"
        exact = [line.split("\x1f")[1:] for line in run("check", scene, "--numbers").splitlines() if "\x1f" in line]
        report, many = run("check", scene), 0
        for name, symbol, value, unit, source in (row for row in exact if row[0] != "units"):
            shown = f"  {name:38} {symbol:9} {float(value):12.6g} {unit:9} {source}".rstrip()
            if not name.startswith("  edge along"):
                self.assertIn(shown if source else shown[:64].rstrip(), report)
                many += len(value) > 12
        self.assertGreater(many, 20)
        self.near(float(next(row for row in exact if row[0] == "units")[1]), ETA, 1e-12)

    def test_refused(self):
        scene = TOP / "scenes/solvent.yaml"
        for words, why in (("a0=50nn,T=300K", "a0=50nn: not a length, such as 50nm; units: m, with a prefix"),
                           ("a0=50,T=300K", "not a length"), ("a0=-5nm,T=300K", "not a length"),
                           ("a0=0nm,T=300K", "not a length"), ("a0=infm,T=3K", "not a length"),
                           ("a0=0x1nm,T=3K", "not a length"), ("a0=50nm,T=27C", "T=27C: not a temperature"),
                           ("a0=50nm,T=300K,eta=1mPa", "not a viscosity"), ("a0=50nm", "T is missing"),
                           ("T=300K", "a0 is missing"), ("a0=50nm,a0=60nm", "a0 is given twice"),
                           ("a0=50nm,T=300K,eta=1mPas,t0=1us", "one of them fixes the unit of time; 2 are given"),
                           ("b0=50nm", "none of KEY=VALUE with the keys a0, T, eta, rho, mass, t0"),
                           ("a0", "none of KEY=VALUE"), ("", "an empty value; allowed: a0="), ("a0=50nm,", "none of KEY=VALUE")):
            self.assertIn(why, run("check", scene, "--units", words, code=2), words)
        for words, why in (("length=1um", "persistence is missing"), ("persistence=1um", "length is missing"),
                           ("length=1um,persistence=1um,vertices=2", "2 vertices: a fiber takes 3"),
                           ("length=1um,persistence=1um,vertices=40nm", "vertices=40nm: not a number"),
                           ("length=1um,persistence=1um,vertices=5000", "is too large; use fewer vertices"),
                           ("length=1um,persistence=1000m", "too stiff"),
                           ("length=1um,persistence=1um,mesh=1pm", "use a wider mesh"),
                           ("size=1um", "with the keys length, persistence, diameter, mesh, vertices")):
            self.assertIn(why, run("map", words, "--units", "T=300K,eta=1mPas", code=2), words)
        self.assertIn("T is missing", run("map", "length=1um,persistence=1um", "--units", "eta=1mPas", code=2))
        self.assertIn("one follows from the other",
                      run("map", "length=1um,persistence=1um,vertices=9", "--units", "T=300K,a0=9nm", code=2))
        with tempfile.TemporaryDirectory() as folder:
            dry = pathlib.Path(folder) / "dry.yaml"
            dry.write_text("box: [8, 8, 8]\ntime_step: 0.01\nsteps: 1\nfibers:\n  - {name: a, count: 1, vertices: 4, mass: 5, "
                           "bond_length: 0.5, spring: 100}\n")
            self.assertIn("the scene has no solvent", run("check", dry, "--units", "a0=9nm,T=300K,eta=1mPas", code=2))
            said = run("check", dry, "--units", "a0=9nm,T=300K,t0=1us")
            self.assertEqual(rows(said)["time step"][2], "10 ns")


class Page(unittest.TestCase):
    """Runs the commands of docs/units.md. Lines of "..." stand for lines that the page leaves out."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.output = {}
        cls.shown = []
        for block in re.findall(r"```\n(\$ .*?)```", PAGE.read_text(encoding="utf-8"), re.S):
            for part in re.split(r"^\$ ", block, flags=re.M)[1:]:
                command, *lines = part.splitlines()
                shell = command.replace("uncross ", f"{UNCROSS} ", 1)
                done = subprocess.run(["bash", "-c", shell], cwd=cls.folder.name, capture_output=True, text=True, check=False)
                cls.output[command] = done.stdout + done.stderr
                cls.shown.append((command, lines))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_shown_is_said(self):
        self.assertGreater(len(self.shown), 8)
        for command, lines in self.shown:
            said, at = self.output[command].splitlines(), 0
            gap = False
            for line in lines:
                if line == "...":
                    gap = True
                    continue
                where = said.index(line, at) if line in said[at:] else -1
                self.assertNotEqual(where, -1, f"{command}: {line}")
                self.assertTrue(gap or where == at, f"{command}: lines are missing above: {line}")
                at, gap = where + 1, False
            self.assertTrue(gap or at == len(said) or command.endswith(".yaml"), f"{command}: lines are missing at the end")

    def report(self, name):
        text = (pathlib.Path(self.folder.name) / name).read_text()
        report = next(out for command, out in self.output.items() if command.startswith(f"uncross check {name}"))
        said = re.search(r"--units (\S+)", text)[1]
        self.assertIn(f"--units {said}", PAGE.read_text(encoding="utf-8"))
        return text, rows(report), report

    def near(self, found, wanted, digits=6e-5, what=""):
        self.assertLess(abs(found / wanted - 1), digits, f"{what}: {found} for {wanted}")

    def stiff(self, name, length, persistence, vertices, kelvin, eta=None, rho=None):
        """A stiff fiber's report, held against its SI numbers. Returns a0, t0, rows, text."""
        text, found, said = self.report(name)
        bond, kt = mean_bond(100, 0.5), BOLTZMANN * kelvin
        a0 = length / ((vertices - 1) * bond)
        mass = rho * a0 ** 3 / 5 if rho else None
        t0 = eta * a0 ** 3 / (ETA * kt) if eta else a0 * math.sqrt(mass / kt)
        mass = mass or kt * t0 * t0 / a0 ** 2
        kappa = langevin_inverse(math.exp(-bond * a0 / persistence))
        self.near(float(re.search(r"bending: (\S+)", text)[1]), kappa, 1e-6, "kappa")
        edge = int(re.search(r"box: \[(\d+)", text)[1])
        thick, long = 0.6 * a0, vertices * 0.5 * a0
        shape = long / (2 * 0.25 * a0)
        turn = 3 * kt / (math.pi * t0 * kt * ETA / a0 ** 3 * long ** 3) * (
            math.log(shape) - 0.662 + 0.917 / shape - 0.050 / shape ** 2)
        slide = kt / (3 * math.pi * t0 * kt * ETA / a0 ** 3 * long) * (math.log(long / thick) + 0.312)
        for row, wanted in (("unit of length", a0), ("unit of energy", kt), ("unit of time", t0),
                            ("unit of mass, a solvent particle", mass), ("contour length", length),
                            ("effective persistence length", persistence), ("mass of a vertex", 5 * mass),
                            ("time step", 0.01 * t0), ("simulated time", 100 * t0), ("edge along x", edge * a0),
                            ("dilute diffusion coefficient, stiff", slide),
                            ("rotational relaxation, stiff", 1 / (2 * turn))):
            self.near(number(found[row][2]), wanted, what=f"{name}: {row}")
        # the chain is discrete: its R_e differs from that of a thread by the order of (bond/l_p)^2 / 12, plus its stretch
        self.near(number(found["end-to-end distance, rms"][2]), wormlike(length, persistence), 0.025, "R_e")
        density = 5 * mass / a0 ** 3
        self.near(float(re.search(r"\n  density .* ratio (\S+)", said)[1]), density / 997.05, 5e-3, "density")
        eta_si = ETA * mass / (a0 * t0)
        self.near(float(re.search(r"\n  viscosity .* ratio (\S+)", said)[1]), eta_si / 8.9e-4, 5e-3, "viscosity")
        return a0, t0, found, text

    def thinner(self, text, a0, length, diameter):
        """The model's diffusion over that of a fiber as thin as the real one: Eq. (40) twice."""
        found = float(re.search(r"diffuses (\S+) times", text)[1])
        self.near(found, (math.log(length / (0.6 * a0)) + 0.312) / (math.log(length / diameter) + 0.312), 1e-3, "ratio")
        return found

    def test_actin(self):
        a0, t0, found, text = self.stiff("actin.yaml", 10e-6, 17e-6, 64, 300, eta=0.85e-3)
        self.near(self.thinner(text, a0, 10e-6, 7e-9), 0.57, 1e-2)
        # in the words of the page: 26 s, 5.5 million steps; momentum crosses 9.4 um in 0.2 s, in water in 0.1 ms
        turns = number(found["rotational relaxation, stiff"][2])
        self.near(turns, 26, 0.02)
        self.near(turns / (0.01 * t0), 5.5e6, 0.01)
        nu = number(found["kinematic viscosity"][2])
        self.near(nu, 4.1e-10, 0.01)
        self.near((32 * a0) ** 2 / nu, 0.2, 0.1)
        self.near((32 * a0) ** 2 / (0.89e-3 / 997.05), 1e-4, 0.01)

    def test_dna(self):
        a0, _, found, text = self.stiff("dna.yaml", 1500 * 0.34e-9, 50e-9, 32, 298.15, rho=997)
        self.thinner(text, a0, 510e-9, 2e-9)
        ratio = number(found["viscosity"][2]) / 0.89e-3
        self.near(1 / ratio, 15, 0.03)
        t0 = 0.89e-3 * a0 ** 3 / (ETA * BOLTZMANN * 298.15)
        self.near(5 * BOLTZMANN * 298.15 * t0 ** 2 / a0 ** 5 / 997.05, 236, 3e-3)

    def test_lambda(self):
        text, found, _ = self.report("lambda.yaml")
        size, kt = wormlike(16.5e-6, 50e-9), BOLTZMANN * 298.15
        a0 = size / math.sqrt(39)  # <R^2> = 39 bonds of <l^2> = 1 a0^2
        self.near(float(re.search(r"spring: (\S+)", text)[1]), 3.0, 1e-12)
        self.near(number(found["unit of length"][2]), a0)
        self.near(number(found["end-to-end distance, rms"][2]), size)
        self.near(number(found["dilute diffusion coefficient"][2]), 0.196 * kt / (0.89e-3 * size))  # Eq. (39)
        self.near(number(found["unit of time"][2]), 0.89e-3 * a0 ** 3 / (ETA * kt))
        self.assertNotIn("bending:", text)

    def test_fd(self):
        a0, _, found, text = self.stiff("fd.yaml", 880e-9, 2.8e-6, 40, 298.15, eta=0.89e-3)
        self.thinner(text, a0, 880e-9, 6.6e-9)
        density = 5.0 / 1.64e4 * 6.02214076e23  # 5 kg/m^3 over kg/mol, times Avogadro's number
        self.near(density, 1.84e20, 5e-3)
        self.near(density * 880e-9 ** 3, 125, 5e-3)
        mesh = math.sqrt(3 / (density * 880e-9))
        self.near(mesh, 136e-9, 5e-3)
        count, volume = int(re.search(r"count: (\d+)", text)[1]), (20 * a0) ** 3
        self.assertEqual(count, round(3 / 136e-9 ** 2 / 880e-9 * volume))
        self.near(number(found["mesh size"][2]), math.sqrt(3 * volume / (count * 20 * a0)))
        self.near(number(found["mesh size"][2]) / 136e-9, 1.02, 5e-3)
        self.near(3.3 / (density * math.pi * 880e-9 ** 2 * 6.6e-9 / 4), 4.5, 0.02)  # "some four times"

    def test_table(self):
        """The two numbers of the page's table, from its own formulas, per nanometre of a0, for water."""
        kt, a0 = BOLTZMANN * 298.15, 1e-9
        t0 = 0.89e-3 * a0 ** 3 / (ETA * kt)
        self.near(5 * kt * t0 ** 2 / a0 ** 5 / 997.05, 8, 0.05)
        mass = 997.05 * a0 ** 3 / 5
        self.near(ETA * math.sqrt(mass * kt) / a0 ** 2 / 0.89e-3, 0.36, 0.02)


class Microtubule(unittest.TestCase):
    """The scene of docs/units.md that a force drags, from the bending modulus and the definitions."""

    def test_numbers(self):
        scene = re.search(r"```yaml\n(# microtubule.yaml\n.*?)```", PAGE.read_text(encoding="utf-8"), re.S)[1]
        kt, a0, persistence, eta = BOLTZMANN * 300, 500e-9, 5.2e-3, 0.85e-3
        kappa, length, t0 = kt * persistence, 20 * a0, 3 * math.pi * eta * a0 ** 3 / kt
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "microtubule.yaml"
            path.write_text(scene)
            found = rows(run("check", path, "--units", "a0=500nm,T=300K,t0=241.8ms"))
            bare = run("check", path)
        self.assertLess(abs(t0 / 0.2418 - 1), 2e-4)
        force = number(found["force on a vertex"][2])
        self.assertLess(abs(21 * force * length ** 2 / kappa - 1), 1e-3)
        for value, wanted in ((21 * force, 0.22e-12), (1e-12 * length ** 2 / kappa, 4.6), (82.5 * kt / 1.5e-6 * 21, 4.8e-12), (82.5 * 21 * 20 ** 2 / 3467, 200),
                              (82.5 * kt / 1.5e-6 * 21 / 100 / 1.602176634e-19, 3.0e5), (persistence / a0, 10400), (persistence / 1.5e-6, 3467)):
            self.assertLess(abs(value / wanted - 1), 0.025, wanted)
        self.assertEqual(found["force on a vertex"][2], "10.255 fN")
        self.assertIn("\n    force over bending                   B             0.999923", bare)
        bending = number(found["time of bending"][2])
        self.assertLess(abs(bending / (20 ** 4 / 10400 * 0.2418) - 1), 1e-3)
        self.assertLess(abs(bending / 3.72 - 1), 2e-3)


if __name__ == "__main__":
    unittest.main()
