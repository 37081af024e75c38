"""Flows of the solvent: theory, and what profiles along y and the stress say, with errors. Units a0 = kT = m = 1.

An average over a time T of a velocity at y has a covariance that follows from fluctuating hydrodynamics, because slow modes fluctuate with
the viscosity that damps them: (2 kT/(A T)) Re g(y, y'), A the area across y and g the velocity at y of a unit force per area at y' that
varies as exp(i omega t). So slabs are correlated, and a fit knows how. Flyvbjerg's blocks of each slab test this (`surprise`)."""
import cmath
import math

import numpy
import yaml

from lib import stats, theory

MILNE = 0.2273508  # a0: b of the Milne problem, planar fill, mean free path 0 (the C code: theory/flow.h)
PAPER_FILL = {10: 0.2282}  # the same of n - N virtual particles
# MPC-AT+a: what one collision leaves of the kinetic stress, and what it hands on, one-cell averages by Monte Carlo (to 0.7 %).
PLUS = {(2, 3): (0.362, 0.0679), (2, 10): (0.1060, 0.3549), (3, 5): (0.2850, 0.1316), (3, 10): (0.1355, 0.3364)}


def stress_loss(point, rule):
    """(1 - c_s, q): the share of the kinetic stress that a collision takes away, and the momentum that it hands on; SRD at 90 degrees."""
    partners = theory.occupancy(point.n)
    if rule == "at+a":
        kept, handed = PLUS[point.d, point.n]
        return 1.0 - kept, handed
    if rule == "at-a":
        return partners / point.n, partners / 12.0
    return (2.0 if point.d == 2 else 1.2) * partners / point.n, partners / (12.0 if point.d == 2 else 18.0)


def viscosity(point, rule):
    """(kinetic, collisional), molecular chaos."""
    loss, handed = stress_loss(point, rule)
    return point.n * point.dt * (1.0 / loss - 0.5), handed / point.dt


def slip_length(point, rule, fill="planar"):
    """b, a0: Milne's, less what bounce-back stops, sqrt(2/pi) dt/(1 - c). SRD at 90 degrees."""
    loss = theory.occupancy(point.n) / point.n * (1.0 if rule == "at-a" or point.d == 2 else 2.0 / 3.0)
    return {"planar": MILNE, "paper": PAPER_FILL.get(point.n)}[fill] - math.sqrt(2.0 / math.pi) * point.dt / loss


def heat_conductivity(point):
    """(kinetic, collisional) of SRD at 90 degrees: kappa = n c_p D_T, c_p = (d + 2)/2, D_T by Tuezel, Strauss, Ihle and Kroll, Phys. Rev. E 68,
    036701 (2003), to first order in 1/n."""
    d, n = point.d, point.n
    kinetic = 0.5 * point.dt * (2.0 - 1.0 + 2.0 * d / n * ((7.0 - d) / 5.0 - 0.25 / math.sin(math.pi / 4.0)**2))
    collisional = 1.0 / (3.0 * (d + 2.0) * point.dt * n)
    return 0.5 * (d + 2.0) * n * kinetic, 0.5 * (d + 2.0) * n * collisional


def from_waves(table, gamma, kinetic, collisional):
    """(eta, error) for k -> 0 from decaying shear waves: each box's nu(k) over 1 - (share of the collisional part) k^2/30, the width of a
    cell."""
    width = 1.0 - collisional / (kinetic + collisional) * table["k"]**2 / 30.0
    nu, error, _ = stats.weighted_mean(table["nu"] / width, table["nu_error"] / width)
    return gamma * nu, gamma * error


def scene_of(result):
    return yaml.safe_load(result.run.scene_text)


# --- response: g(y, y') -------------------------------------------------------------------------------------------------

def between_walls(y, height, viscosity_, slip, rho_omega=0.0):
    """g between walls at -slip and height + slip; rho_omega is the mass density times omega."""
    low, high = numpy.minimum.outer(y, y) + slip, height + slip - numpy.maximum.outer(y, y)
    if rho_omega == 0.0:
        return low * high / (viscosity_ * (height + 2.0 * slip))
    k = cmath.sqrt(1j * rho_omega / viscosity_)
    return numpy.sinh(k * low) * numpy.sinh(k * high) / (viscosity_ * k * cmath.sinh(k * (height + 2.0 * slip)))


def periodic(y, height, viscosity_):
    """g in a periodic box, whose total momentum does not change."""
    z = abs(numpy.subtract.outer(y, y))
    return (height / 12.0 - 0.5 * z + z * z / (2.0 * height)) / viscosity_


def oscillating(y, height, viscosity_, slip, rho_omega):
    """v(y) over the velocity of the upper wall, complex; the lower wall moves against it. sinh(kz)/(sinh(kL/2) + b k cosh(kL/2))."""
    k = cmath.sqrt(1j * rho_omega / viscosity_)
    half = 0.5 * height
    return numpy.sinh(k * (y - half)) / (cmath.sinh(k * half) + slip * k * cmath.cosh(k * half))


# --- profiles -----------------------------------------------------------------------------------------------------------

class Profile:
    """The table `profile` of a run: its geometry, and the covariance of its averages. noise: variance of a sample of a particle's
    quantity over its share of the slow modes' (1 for a velocity, 2/d for a temperature)."""

    def __init__(self, result, point, margin=0.0):
        table, scene = result.table("profile"), scene_of(result)
        box = scene["box"]
        self.point, self.height, self.area = point, box[1], box[0] * box[2]
        self.inside = (table["y"] > margin) & (table["y"] < self.height - margin)
        self.all_y, self.y = table["y"], table["y"][self.inside]
        self.table = {name: column[self.inside] for name, column in table.items()}
        self.sample = scene["observe"]["profile"]["every"] * point.dt
        self.time = self.table["samples"][0] * self.sample
        self.thickness = self.height / len(table["y"])

    def covariance(self, response, noise=1.0, time=None):
        """Of averages over the run. Modes that decay faster than samples follow each other are white noise: at most so much."""
        white = noise / (self.point.n * self.area * self.thickness) * self.sample
        return (2.0 / self.area * response.real + white * numpy.eye(len(self.y))) / (time or self.time)

    def surprise(self, covariance, column="vx"):
        """Mean over slabs of the variance that blocks found over that of `covariance`."""
        return float(numpy.mean(self.table[column + "_error"]**2 / covariance.diagonal()))


def generalised(basis, y, covariance):
    """A stats.Fit of y = sum of coefficients times basis functions, with correlated errors."""
    root = numpy.linalg.cholesky(covariance)
    return stats.fit([numpy.linalg.solve(root, f) for f in basis], numpy.linalg.solve(root, y), numpy.ones(len(y)))


def curve(function, start, y, covariance):
    """(parameters, covariance) of a nonlinear fit with correlated errors, by Gauss and Newton."""
    p = numpy.array(start, float)
    for _ in range(50):
        steps = numpy.maximum(1e-5, 1e-5 * abs(p))
        slopes = [(function(p + d) - function(p - d)) / (2.0 * s) for d, s in zip(numpy.diag(steps), steps)]
        found = generalised(slopes, y - function(p), covariance)
        p = p + found.value
        if numpy.all(abs(found.value) < 1e-9):
            break
    return p, found.covariance


# --- stress -------------------------------------------------------------------------------------------------------------

def stress(result, *names):
    """(mean, error) of the mean of these columns after the transient; a name with `-` before it is subtracted."""
    table, observed = result.table("stress"), scene_of(result)["observe"]
    keep = table["step"] >= observed["from"] + observed["stress"]["every"]
    series = sum((-1.0 if name[0] == "-" else 1.0) * table[name.lstrip("-")][keep] for name in names)
    return stats.average(series)
