"""SI units of a scene. a0 and T give the units of length and energy (kT). One more number is needed for the unit of time t0, or,
which is the same, for the unit of mass m = kT t0^2/a0^2: the mass of a solvent particle, the density of the solvent, or its
viscosity. The solvent is no liquid, so only one of these can be right."""
import collections
import math

from .quantity import Refused, read, shown

BOLTZMANN = 1.380649e-23  # J/K: exact, Resolution 1 of the 26th CGPM (2018)
# Liquid water at 25 C and 0.1 MPa: density and speed of sound (IAPWS-95), viscosity (IAPWS 2008), self-diffusion coefficient
# (Holz, Heil, Sacco, Phys. Chem. Chem. Phys. 2, 4740 (2000)).
WATER_DENSITY, WATER_VISCOSITY, WATER_SOUND, WATER_DIFFUSION = 997.05, 8.900e-4, 1496.7, 2.299e-9

KEYS = {"a0": "length", "T": "temperature", "eta": "viscosity", "rho": "density", "mass": "mass", "t0": "time"}
# What fixes the unit of time: what is right then, what is wrong, and what is right where vertices load the fluid.
CHOICES = {
    "eta": ("lengths, energies, forces, and the times of all that viscosity governs (diffusion, relaxation, drag)",
            "the density, so inertia and Reynolds numbers are too large by its ratio; sound; the Schmidt number",
            "lengths, energies, forces, and the viscosity of the solvent alone"),
    "rho": ("lengths, energies, forces, and inertia: masses, thermal velocities of vertices",
            "the viscosity, so whatever it governs (diffusion, relaxation) is faster by 1 over its ratio; sound; the Schmidt number",
            "lengths, energies, forces, masses, and the density of the solvent alone"),
    "mass": ("lengths, energies, forces, and masses", "the solvent's density and viscosity, as listed; sound; the Schmidt number",
             "lengths, energies, forces, and masses"),
    "t0": ("lengths, energies, forces", "the solvent's density and viscosity, as listed; sound; the Schmidt number",
           "lengths, energies, forces")}

# As `uncross check --numbers` tells them, in units of a0, kT and m. loaded: of the fluid with its vertices; heavy: how many times as
# viscous it is where their load is told.
Solvent = collections.namedtuple("Solvent", "viscosity density sound schmidt loaded_viscosity loaded_density heavy")

# Of each unit of a report: the SI unit, whether it takes a prefix, and its powers of length, energy and time.
UNITS = {"a0": ("m", True, 1, 0, 0), "a0^2": ("m^2", False, 2, 0, 0), "1/a0^2": ("1/m^2", False, -2, 0, 0),
         "1/a0^3": ("1/m^3", False, -3, 0, 0), "t0": ("s", True, 0, 0, 1), "1/t0": ("1/s", False, 0, 0, -1),
         "a0/t0": ("m/s", True, 1, 0, -1), "a0/t0^2": ("m/s^2", False, 1, 0, -2), "a0^2/t0": ("m^2/s", False, 2, 0, -1),
         "kT": ("J", True, 0, 1, 0), "kT/a0": ("N", True, -1, 1, 0), "kT/a0^2": ("N/m", True, -2, 1, 0), "m": ("kg", False, -2, 1, 2),
         "m/t0": ("kg/s", False, -2, 1, 1), "m/a0^3": ("kg/m^3", False, -5, 1, 2), "m/a0 t0": ("Pa s", True, -3, 1, 1)}


def given(text):
    """{key: value} of --units. At most one fixes the unit of time."""
    found = read("--units", text, KEYS)
    times = sum(key in found for key in CHOICES)
    if times > 1:
        raise Refused(f"--units: eta, rho, mass, t0: one of them fixes the unit of time; {times} are given")
    return found


def choice(found):
    return next((key for key in CHOICES if key in found), None)


class Scale:
    """a0, kT and t0 in SI units; time 0: not known. solvent: None if the scene has none."""

    def __init__(self, found, solvent):
        key = choice(found)
        for needed in "a0", "T":
            if needed not in found:
                raise Refused(f"--units: {needed} is missing, as in --units a0=50nm,T=300K")
        if key in ("eta", "rho") and not solvent:
            raise Refused(f"--units: {key}: the scene has no solvent; use mass or t0")
        self.length, self.energy, self.time = found["a0"], BOLTZMANN * found["T"], 0.0
        cell = self.length * self.length * self.length
        if key == "eta":  # kT t0/a0^3
            self.time = found[key] * cell / (self.energy * solvent.viscosity)
        elif key in ("rho", "mass"):
            mass = found[key] * cell / solvent.density if key == "rho" else found[key]
            self.time = self.length * math.sqrt(mass / self.energy)
        elif key:
            self.time = found[key]

    def convert(self, value, unit):
        """In SI units; NaN if it takes the unit of time, and that is not known."""
        _, _, length, energy, time = UNITS[unit]
        try:
            scale = 1.0 if time == 0 else math.pow(self.time, time) if self.time > 0.0 else math.nan
            return value * math.pow(self.length, length) * math.pow(self.energy, energy) * scale
        except OverflowError:
            return math.inf

    def row(self, name, symbol, value, unit, source):
        """A line of a report: a number in units a0, kT, m, and beside it in SI units."""
        si = self.convert(value, unit) if unit in UNITS else math.nan
        text = shown(si, *UNITS[unit][:2]) if math.isfinite(si) else ""
        middle = f" {unit:<9}" if source or text else f"{' ' * bool(unit)}{unit}"
        return (f"  {name:<38} {symbol:<9} {value:12.6g}{middle}" + (f" {text:<17}" if source else f" {text}" if text else "")
                + f"{' ' * bool(source)}{source}\n")


def report(found, scale, solvent):
    """The units, how far the solvent is from water, and what follows for a run: lines of a report."""
    yield "\nSI units\n"
    yield scale.row("unit of length", "a0", 1.0, "a0", "given")
    yield scale.row("unit of energy", "kT", 1.0, "kT", "k_B T, T given")
    key = choice(found)
    if not key:
        yield "  The unit of time is not fixed: one of eta=, rho=, mass=, t0= does that (docs/units.md).\n"
        return
    yield scale.row("unit of time", "t0", 1.0, "t0", key)
    yield scale.row("unit of mass, a solvent particle", "m", 1.0, "m", "kT t0^2/a0^2")
    if not solvent:
        return
    density, eta = scale.convert(solvent.density, "m/a0^3"), scale.convert(solvent.viscosity, "m/a0 t0")
    nu_water = WATER_VISCOSITY / WATER_DENSITY
    yield "\nThe solvent beside water at 25 C\n"
    for name, ours, water, unit, prefix in (("density", density, WATER_DENSITY, "kg/m^3", False), ("viscosity", eta, WATER_VISCOSITY, "Pa s", True),
                                            ("kinematic viscosity", eta / density, nu_water, "m^2/s", False),
                                            ("speed of sound", scale.convert(solvent.sound, "a0/t0"), WATER_SOUND, "m/s", True),
                                            ("Schmidt number", solvent.schmidt, nu_water / WATER_DIFFUSION, "", False)):
        yield f"  {name:<38} {shown(ours, unit, prefix):<18} water {shown(water, unit, prefix):<18} ratio {ours / water:.3g}\n"
    right, wrong, loaded = CHOICES[key]
    factor = solvent.loaded_viscosity / solvent.viscosity
    if factor > solvent.heavy:
        right = loaded
        wrong = (f"viscosity and density of the fluid with its vertices, {factor:.3g} and {solvent.loaded_density / solvent.density:.3g} times "
                 f"the solvent's, and so the times of diffusion, relaxation and drag; {wrong}")
    yield f"  right:  {right}\n  wrong:  {wrong}\n"
