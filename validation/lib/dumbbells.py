"""The fluid of dumbbells: theory, and what runs of case `dumbbells` say, each as (value, standard error). Units a0 = kT = m = 1; None without
the run."""
import cmath
import math

import numpy
from scipy import special

from lib import flow, stats
from lib.dumbbell_runs import DT, N, PERIODS, POTENTIAL, RATES, RULES, SPEED, key, relaxation  # noqa: F401
from lib.flow_runs import Point

NUMBER = 0.5 * N  # n_d: dumbbells per volume
WIDTH = 0.6  # of the gap, about its middle, in which the rate of the bulk is fitted (Tao et al.: beyond a few R_0 from the walls)


def point(dt=DT):
    return Point(2, N, dt)


def quotient(a, b):
    value = a[0] / b[0]
    return value, abs(value) * math.hypot(a[1] / a[0], b[1] / b[0])


def scaled(pair, factor):
    return pair and (pair[0] * factor, abs(pair[1] * factor))


# --- theory -----------------------------------------------------------------------------------------------------------

def solvent_viscosity(rule="at-a", dt=DT):
    return sum(flow.viscosity(point(dt), rule))


def rate_of_relaxation(spring, rule="at-a", dt=DT):
    """omega_H in molecular chaos. AT+a: the share c_v of a velocity is kept by one cell's average."""
    if rule == "at+a":
        return 4.0 * spring * dt * (1.0 / (1.0 - 0.14997) - 0.5)
    return 1.0 / relaxation(spring, dt)


def modulus(omega, eta, omega_h):
    """G' + i G''."""
    x = omega / omega_h
    return complex(NUMBER * x * x / (1.0 + x * x), eta * omega + NUMBER * x / (1.0 + x * x))


def inertia(omega, g, height):
    """cosh(kL/2): stress on the walls over that of the strain in the middle."""
    return cmath.cosh(0.5 * height * omega * cmath.sqrt(-N / g))


def density(y, potential):
    """Particles at y (in sqrt(kT/K)) from one wall, over the bulk's."""
    if not potential:
        return 0.5 * (1.0 + special.erf(y / math.sqrt(2.0)))
    depth, reach = POTENTIAL
    s, e = 0.5, 0.25 * depth / reach
    root, low = s * math.sqrt(2.0), 0.5 * y
    within = numpy.exp(depth * (1.0 - y / reach) + 0.5 * e * depth / reach) * 0.5 * (special.erf((reach - y + e) / root) - special.erf((low - y + e) / root))
    return numpy.where(low < reach, within, 0.0) + 0.5 * special.erfc((numpy.maximum(low, reach) - y) / root)


EXCESS = {False: -0.3989423, True: -0.01828}  # a0 for K = 1: the integral of density - 1 at one wall


# --- steady shear -----------------------------------------------------------------------------------------------------

class Sheared:
    """A sheared box: stress, and shape of dumbbells."""

    def __init__(self, result):
        scene = flow.scene_of(result)
        self.result, self.rate, self.spring = result, scene["shear"]["rate"], scene["dumbbells"]["spring"]
        self.shape = {name: column[0] for name, column in result.table("dumbbells").items()}

    def over_rate(self, *names):
        return scaled(flow.stress(self.result, *names), 1.0 / self.rate)

    @property
    def eta(self):
        return self.over_rate("sigma_xy")

    @property
    def springs(self):
        return self.over_rate("sigma_xy_spring")

    @property
    def solvent(self):
        """Kinetic and collisional."""
        return self.over_rate("sigma_xy", "-sigma_xy_spring")

    @property
    def omega(self):
        """omega_H := rate kT/(K <r_x r_y>)."""
        value = self.rate / (self.spring * self.shape["rxry"])
        return value, value * self.shape["rxry_error"] / self.shape["rxry"]

    @property
    def weissenberg(self):
        return self.spring * self.shape["rxry"], self.spring * self.shape["rxry_error"]


def sheared(results, spring, rule="at-a", dt=DT):
    name = f"shear-K{spring:g}-{key(rule)}" + (f"-dt{dt:g}" if dt != DT else "")
    return Sheared(results[name]) if name in results else None


# --- oscillation ------------------------------------------------------------------------------------------------------

def harmonic(result, *names):
    """Amplitude of the mean of these columns of the stress, sigma = Re[a exp(i omega t)], complex, from each period."""
    table, scene = result.table("stress"), flow.scene_of(result)
    section = scene.get("shear") or scene["walls"]
    period, begin = section["period"], scene["observe"]["from"]
    every = float(numpy.median(numpy.diff(table["time"])))  # not the scene's: a series that is kept may be thinned
    rows, omega = round(period / every), 2.0 * math.pi / period
    keep = table["step"] > begin
    time, sigma = table["time"][keep] - 0.5 * every, numpy.mean([table[name][keep] for name in names], axis=0)
    count = len(time) // rows
    smooth = 0.5 * omega * every / math.sin(0.5 * omega * every)  # a row is a mean
    waves = 2.0 * smooth * numpy.exp(-1j * omega * time[:count * rows]) * sigma[:count * rows]
    return omega, waves.reshape(count, rows).mean(axis=1)


def split(values):
    """((real, error), (imaginary, error)) of the mean of independent complex values."""
    n = len(values)
    return tuple((stats.judged(float(part.mean()), part), float(part.std(ddof=1) / math.sqrt(n))) for part in (values.real, values.imag))


def moduli(results, spring, word):
    """(omega, G', G'', periods) of a sheared box with strain sin(omega t): sigma = G' sin + G'' cos."""
    name = f"oscillation-K{spring:g}-{word}"
    if name not in results:
        return None
    omega, values = harmonic(results[name], "sigma_xy")
    if len(values) < 3:
        return None
    loss, storage = split(values)  # the strain is 1
    return omega, (-storage[0], storage[1]), loss, len(values)


def ratio_of_springs(results, spring, word):
    """(omega, G'/G'' of the springs, error)."""
    omega, values = harmonic(results[f"oscillation-K{spring:g}-{word}"], "sigma_xy_spring")
    loss, storage = split(values)
    return omega, *quotient((-storage[0], storage[1]), loss)


def crossing(results, spring, words):
    """The frequency at which G' of the springs is their G'': a power law between two frequencies; None without the runs."""
    if any(f"oscillation-K{spring:g}-{word}" not in results for word in words):
        return None
    (low, first, first_error), (high, second, second_error) = (ratio_of_springs(results, spring, word) for word in words)
    slope, share = math.log(second / first) / math.log(high / low), -math.log(first) / math.log(second / first)
    error = math.hypot((1.0 - share) * first_error / first, share * second_error / second) / slope
    value = low * (high / low) ** share
    return value, value * error


# --- walls ------------------------------------------------------------------------------------------------------------

def between(result, column="vx"):
    """flow.Profile of the middle of the gap."""
    height = flow.scene_of(result)["box"][1]
    return flow.Profile(result, point(), 0.5 * (1.0 - WIDTH) * height)


def effective_rate(results, name):
    """((rate in the bulk, error), applied rate)."""
    if name not in results:
        return None
    scene, profile = flow.scene_of(results[name]), between(results[name])
    eta = solvent_viscosity() + NUMBER / rate_of_relaxation(scene["dumbbells"]["spring"])
    response = flow.between_walls(profile.y, profile.height, eta, 0.5)
    fit = flow.generalised([profile.y - 0.5 * profile.height, numpy.ones(len(profile.y))], profile.table["vx"], profile.covariance(response))
    return (fit.value[0], fit.error[0]), scene["walls"]["shear_rate"]


def wall_stress(results, name):
    return scaled(flow.stress(results[name], "sigma_lower", "sigma_upper"), 0.5)


def wave(results, name):
    """(omega, stress on the walls over the strain in the middle, complex, relative error of the stress, height)."""
    if name not in results:
        return None
    result = results[name]
    omega, values = harmonic(result, "sigma_lower", "sigma_upper")
    profile = between(result)
    if len(values) < 3:
        return None
    z = profile.y - 0.5 * profile.height
    cosine, sine = (profile.table[part] @ z / (z @ z) for part in ("vx_in_phase", "vx_out_of_phase"))
    noise = numpy.hypot(profile.table["vx_in_phase_error"].mean(), profile.table["vx_out_of_phase_error"].mean()) * abs(z).sum() / (z @ z)
    strain = complex(cosine, -sine) / (1j * omega)
    real, imag = split(values)
    value = complex(real[0], imag[0]) / strain
    error = math.hypot(math.hypot(real[1], imag[1]) / math.sqrt(2.0) / abs(complex(real[0], imag[0])), noise / abs(complex(cosine, sine)))
    return omega, value, error * abs(value), profile.height


def still(results, potential, name=None):
    """(Fit of [1, density - 1] to the profile, y, measured density over the mean, its error), at rest or of another run."""
    name = name or "still-" + ("flat" if potential else "bare")
    if name not in results:
        return None
    table, height = results[name].table("profile"), flow.scene_of(results[name])["box"][1]
    if not numpy.isfinite(table["density_error"]).all():
        return None
    thickness = height / len(table["y"])
    y = table["y"][:, None] + thickness * ((numpy.arange(40) + 0.5) / 40.0 - 0.5)[None, :]  # the mean over a slab
    shape = (density(y, potential) + density(height - y, potential) - 2.0).mean(axis=1)
    fit = stats.fit([numpy.ones_like(shape), shape], table["density"], table["density_error"])
    return fit, table["y"], table["density"], table["density_error"], shape


def poiseuille(results):
    """eta from the bend of the parabola in the middle."""
    name = "poiseuille-K1"
    if name not in results:
        return None
    profile, g = between(results[name]), flow.scene_of(results[name])["solvent"]["acceleration"][0]
    eta = solvent_viscosity() + NUMBER / rate_of_relaxation(1)
    parabola = profile.y * (profile.height - profile.y)
    fit = flow.generalised([parabola, numpy.ones(len(profile.y))], profile.table["vx"], profile.covariance(flow.between_walls(profile.y, profile.height, eta, 0.5)))
    return N * g / (2.0 * fit.value[0]), N * g / (2.0 * fit.value[0]) * fit.error[0] / fit.value[0]
