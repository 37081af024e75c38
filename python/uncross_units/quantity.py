"""Physical quantities as people write them: "a0=50nm,T=300K"."""
import math
import os
import re

# name, factor, shown in results
PREFIXES = (("z", 1e-21, True), ("a", 1e-18, True), ("f", 1e-15, True), ("p", 1e-12, True), ("n", 1e-9, True), ("u", 1e-6, True),
            ("µ", 1e-6, False), ("μ", 1e-6, False), ("m", 1e-3, True), ("c", 1e-2, False), ("", 1.0, True), ("k", 1e3, True),
            ("M", 1e6, True), ("G", 1e9, True))
# of each kind: what it is, and (unit, factor, takes a prefix)
KINDS = {"length": ("a length, such as 50nm", (("m", 1.0, True),)),
         "temperature": ("a temperature, such as 300K", (("K", 1.0, True),)),
         "time": ("a time, such as 2us", (("s", 1.0, True),)),
         "mass": ("a mass, such as 18Da or 3e-23kg", (("g", 1e-3, True), ("Da", 1.66053906660e-27, True))),  # CODATA 2018
         "density": ("a density, such as 1000kg/m3", (("kg/m^3", 1.0, False), ("kg/m3", 1.0, False), ("g/cm^3", 1e3, False), ("g/cm3", 1e3, False))),
         "viscosity": ("a viscosity, such as 1mPas", (("Pas", 1.0, True), ("Pa.s", 1.0, True), ("Pa s", 1.0, True), ("P", 0.1, True))),
         "number": ("a number, such as 64", (("", 1.0, False),))}


class Refused(Exception):
    """What was asked for cannot be had."""


def _factor(kind, text):
    """Of a unit with its prefix; 0 if there is none of this kind."""
    return next((factor * size for unit, size, takes in KINDS[kind][1] for prefix, factor, _ in PREFIXES
                 if text == prefix + unit and (takes or not prefix)), 0.0)


def _allowed(kind):
    """"; units: m, with a prefix or none: z a f p n u ..." """
    units = KINDS[kind][1]
    named = "; units: " + ", ".join(unit for unit, _, _ in units) if units[0][0] else ""
    return named + (", with a prefix or none:" + "".join(" " * bool(prefix) + prefix for prefix, _, _ in PREFIXES) if units[0][2] else "")


def read(option, text, keys):
    """{key: value in SI units, above 0} of "key=value,key=value"; keys: {key: kind}."""
    found = {}
    for word in os.fsencode(text).decode(errors="surrogateescape").split(","):
        key, equals, value = word.partition("=")
        if not equals or key not in keys:
            raise Refused(f"{option}: '{key}' is none of KEY=VALUE with the keys {', '.join(keys)}")
        if key in found:
            raise Refused(f"{option}: {key} is given twice")
        number = re.match(r"(?!0[xX])(\d+\.?\d*|\.\d+)([eE][-+]?\d+)? *", value)
        size = float(number[0]) * _factor(keys[key], value[number.end():]) if number else 0.0
        if not 0.0 < size < math.inf:
            raise Refused(f"{option}: {key}={value}: not {KINDS[keys[key]][0]}{_allowed(keys[key])}")
        found[key] = size
    return found


def shown(value, unit, takes_prefix):
    """For people: four digits and a prefix ("50 nm") where the unit takes one, else a power of ten ("2.299e-09 m^2/s")."""
    for prefix, factor, used in reversed(PREFIXES):
        if takes_prefix and used and factor * (1.0 - 1e-9) <= abs(value) < factor * 1000.0 * (1.0 - 1e-9):
            return f"{value / factor:.5g} {prefix}{unit}"
    return f"{value:.5g}{' ' * bool(unit)}{unit}"
