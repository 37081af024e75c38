"""`uncross map`: a scene whose fibers are those of an experiment, and what it leaves wrong. docs/units.md explains the choices, which
are those of the paper's scenes. What follows from a kind of fiber `uncross check` says."""
import getopt
import math
import os
import re
import tempfile

from . import command, units
from .quantity import Refused, read, shown

KEYS = {"length": "length", "persistence": "length", "diameter": "length", "mesh": "length", "vertices": "number"}

# The paper's: Sec. V A for chains without stiffness, Sec. V B for fibers.
VERTICES = 64
BOND = 0.5  # l0 of stiff fibers, a0: twice the radius of a vertex
SPRING = 100.0  # of stiff fibers, kT/a0^2
CHAIN = 3.0  # of chains: <l^2> = 1 a0^2
DIAMETER = 0.6  # b of Eq. (40), a0
GAMMA, INTERVAL, ANGLE = 5.0, 0.02, 90.0
MOST_VERTICES = 1e6
MOST_BENDING = 1e9  # MODEL_MOST_BENDING, src/system/model_parts.h
MOST_EDGE = 1024  # LATTICE_MAX_EDGE, src/base/lattice.h
# Time steps in a collision interval: two, and more for a fiber whose fastest vibration needs them.
SPLIT, MOST_SPLIT = 2, 64
MOST_PHASE = 0.5  # omega dt
MUCH_FILLED = 0.05  # of the volume


def whole(x):
    """To the nearest; halves go up."""
    return float(math.floor(x + 0.5)) if abs(x) < 2.0**52 else x


def over(a, b):
    return a / b if b else math.inf


def wormlike_square(length, persistence):
    """<R^2> between the ends: 2 l_p L [1 - (l_p/L)(1 - exp(-L/l_p))] (Kratky and Porod, Rec. Trav. Chim. 68, 1106 (1949))."""
    x = length / persistence
    # The bracket for stiff chains is x/2 - x^2/6 ..., of which doubles lose all digits.
    bracket = x * (0.5 - x * (1.0 / 6.0 - x / 24.0)) if x < 1e-3 else 1.0 + math.expm1(-x) / x
    return 2.0 * persistence * length * bracket


def mean_bond(spring, rest):
    """<l> of p(l) ~ l^2 exp(-k (l-l0)^2/2), by half-line moments: fiber_mean_bond, src/system/fiber_kind.c."""
    c = rest * math.sqrt(spring)
    i0 = math.sqrt(0.5 * math.pi) * (1.0 + math.erf(c * math.sqrt(0.5)))
    i1 = c * i0 + math.exp(-0.5 * c * c)
    i2 = c * i1 + i0
    return (c * i2 + 2.0 * i1) / i2 / math.sqrt(spring)


def bending(mean, persistence):
    """kappa for which tangents lose their correlation over this length, a0; the paper's l_p = kappa l0 is its limit for stiff fibers."""
    low, high = 0.0, MOST_BENDING
    for _ in range(200):
        kappa = 0.5 * (low + high)
        cosine = kappa / 3.0 if kappa < 1e-3 else 1.0 / math.tanh(kappa) - 1.0 / kappa
        low, high = (kappa, high) if -mean / math.log(cosine) < persistence else (low, kappa)
    return high


class Mapped:
    """The scene's fiber: vertices, a0, bond, spring, bending, split, edge, count."""

    def __init__(self, f, u):
        self.lay_out(f, u)
        said = self.said_by_check()
        self.choose_step(f, said["highest frequency"])
        self.fill_box(f, min(said["length"], 2.0 * said["end-to-end distance, rms"]))

    def lay_out(self, f, u):
        """Stiff fibers have the right contour and persistence length. Where a bond is longer than l_p, bonds are springs of no rest length:
        their chain has the right <R^2>, and no stiffness."""
        length, persistence = f["length"], f["persistence"]
        square = wormlike_square(length, persistence)
        self.bond, self.spring, self.bending, self.a0 = BOND, SPRING, 0.0, u.get("a0")
        mean = mean_bond(SPRING, BOND)
        n = 1.0 + whole(length / (mean * self.a0)) if self.a0 else whole(f.get("vertices", VERTICES))
        stiff = persistence > over(length, n - 1.0)
        if not stiff and self.a0:
            n = 1.0 + whole(over(square, self.a0 * self.a0))
        if not 3.0 <= n <= MOST_VERTICES:
            raise Refused(f"map: {n:.6g} vertices: a fiber takes 3 to {MOST_VERTICES:g} of them; choose another {'a0' if self.a0 else 'number'}")
        self.vertices = int(n)
        if not stiff:
            self.bond, self.spring, self.a0 = 0.0, CHAIN, self.a0 or math.sqrt(square / (n - 1.0))
            mean = mean_bond(CHAIN, 0.0)
        else:
            self.a0 = self.a0 or length / (mean * (n - 1.0))
            self.bending = bending(mean, persistence / self.a0)
        if not self.bending < 0.5 * MOST_BENDING:
            raise Refused(f"map: the fiber is too stiff: bending would be above {MOST_BENDING:g} kT")
        self.contour = (n - 1.0) * mean

    def said_by_check(self):
        """Of one of these fibers, alone, in a step that is short enough for any."""
        self.split, self.edge, self.count = None, MOST_EDGE, 1
        code, said, errors = check(self.scene())
        if code:
            raise Refused(f"map: no scene for these fibers: {errors}")
        return command.rows(said)

    def choose_step(self, f, omega):
        """Time steps that are short enough for the fastest vibration. A fiber that is straight anyway needs no stiffness that takes more of
        them."""
        self.split = SPLIT
        while self.split < MOST_SPLIT and omega * INTERVAL / self.split > MOST_PHASE:
            self.split *= 2
        phase = omega * INTERVAL / self.split
        if phase > MOST_PHASE:
            persistence = 0.9 * (MOST_PHASE / phase)**2 * f["persistence"]
            raise Refused(f"map: the fiber is too stiff: its fastest vibration, {omega:.3g} / t0, needs time steps below {MOST_PHASE / omega:.3g} t0; use "
                          f"a persistence length of {shown(persistence, 'm', True)} or less, which is {persistence / f['length']:.3g} times the length")

    def fill_box(self, f, reach):
        """A box in which no fiber meets its own image, and as many fibers as the mesh asks for: c L = 3/xi^2."""
        self.edge = max(math.ceil(reach * (1.0 - 1e-9)), 4)
        volume = float(self.edge)**3
        if self.edge > MOST_EDGE or GAMMA * volume > 2**31 - 1:
            raise Refused(f"map: a box of {self.edge} cells along each edge is too large; use fewer vertices")
        mesh = f.get("mesh", 0.0) / self.a0
        count = max(whole(over(3.0, mesh * mesh) * volume * self.a0 / f["length"]), 1.0) if mesh else 1.0
        if not count * self.vertices < 2**31 - 1:
            raise Refused(f"map: {count:.3g} fibers of {self.vertices} vertices are too many; use a wider mesh")
        self.count = int(count)

    def scene(self):
        alone = self.split is None
        step = 1e-7 if alone else INTERVAL / self.split
        solvent = "" if alone else f"solvent:\n  per_cell: {GAMMA:g}\n  collision_interval: {INTERVAL:g}\n  rotation_angle: {ANGLE:g}\n\n"
        bends = f"    bending: {self.bending:.{17 if alone else 9}g}\n" if self.bending > 0.0 else ""
        return (f"\nbox: [{self.edge}, {self.edge}, {self.edge}]\ntime_step: {step:.9g}\nsteps: {10000 // SPLIT * (self.split or 1)}\nseed: 1\n\n{solvent}"
                f"fibers:\n  - name: fiber\n    count: {self.count}\n    vertices: {self.vertices}\n    mass: {GAMMA:g}\n    bond_length: {self.bond:.9g}\n"
                f"    spring: {self.spring:.9g}\n{bends}\nobserve:\n  conserved: {{every: 100}}\n  statics: {{every: 100}}\n  dynamics: {{every: 10}}\n\n"
                "trajectory: {every: 100}\n")


def check(text):
    """As for a scene called map."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "map")
        with open(path, "w", encoding="ascii") as file:
            file.write(text)
        code, said, errors = command.numbers(path)
    return code, said, errors.removeprefix("uncross: ").replace(path, "map").rstrip("\n")


def head(f, u, p):
    """The comment at the head, without what follows from the whole scene."""
    yield (f"# A fiber of length {shown(f['length'], 'm', True)} and persistence length {shown(f['persistence'], 'm', True)} at {u['T']:.6g} K, in "
           f"{p.vertices} vertices (uncross map, docs/units.md).\n# SI units of this scene: --units a0={1e9 * p.a0:.9g}nm,T={u['T']:.9g}K")
    for key, factor, unit in (("eta", 1e3, "mPas"), ("rho", 1.0, "kg/m3"), ("mass", 1.0, "kg"), ("t0", 1.0, "s")):
        yield f",{key}={factor * u[key]:.9g}{unit}" if key in u else ""
    yield "\n#\n# What differs from the experiment:\n"


def differences(f, u, p, warnings):
    if p.bending > 0.0 and "diameter" in f:
        wrong = DIAMETER * p.a0
        ratio = over(math.log(f["length"] / wrong) + 0.312, math.log(f["length"] / f["diameter"]) + 0.312)  # Eq. (40), twice
        yield (f"# - In the flow the fiber has a diameter of {shown(wrong, 'm', True)} (0.6 a0), not {shown(f['diameter'], 'm', True)}. A straight one "
               f"diffuses {ratio:.3g} times as fast.\n")
    spring = p.spring * units.BOLTZMANN * u["T"] / (p.a0 * p.a0)
    yield f"# - The springs are the paper's ({p.spring:.6g} kT/a0^2 = {shown(spring, 'N/m', True)}), not the fiber's own.\n"
    yield "# - Between contacts fibers have no width: no excluded volume.\n"
    if p.bending == 0.0:
        yield ("# - A bond is longer than l_p: the chain has no stiffness. It has the R_e of the wormlike chain, "
               f"{shown(math.sqrt(wormlike_square(f['length'], f['persistence'])), 'm', True)}.\n")
    filled = 0.25 * math.pi * DIAMETER * DIAMETER * p.count * p.contour / float(p.edge)**3
    if p.bending > 0.0 and filled > MUCH_FILLED:
        yield f"# - With the diameter that they have in the flow, 0.6 a0, fibers fill {100.0 * filled:.0f} % of the volume.\n"
    for words in re.findall(r"^  warning: (vertices load the fluid: .*)$", warnings, re.M):
        words = words.replace("vertices, mass=", "vertices, --set fibers.fiber.mass=").replace("solvent, solvent.per_cell=", "solvent, --set solvent.per_cell=")
        yield f"# - The {words}.\n"


def scene(words):
    """The text of `uncross map`."""
    options, paths = getopt.gnu_getopt(words, "", ["units="])
    u = units.given(dict(options)["--units"])
    f = read("map", paths[0], KEYS)
    for what, known in (("length", "length" in f), ("persistence", "persistence" in f), ("--units T", "T" in u)):
        if not known:
            raise Refused(f"map: {what} is missing, as in uncross map length=10um,persistence=17um --units T=300K,eta=1mPas")
    if "vertices" in f and "a0" in u:
        raise Refused("map: vertices or --units a0: one follows from the other")
    p = Mapped(f, u)
    code, said, errors = check(p.scene())  # what is printed can be run
    if code:
        raise Refused(f"map: no scene for these fibers: {errors}")
    return "".join((*head(f, u, p), *differences(f, u, p, said), p.scene()))
