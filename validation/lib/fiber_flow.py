"""Fibers in shear: a thin rod (Fokker-Planck) and a Gaussian chain without hydrodynamic interactions (Rouse). Units a0 = kT = m = 1."""
import functools
import math

import numpy
from scipy.linalg import solve_continuous_lyapunov
from scipy.optimize import least_squares
from scipy.special import roots_legendre, sph_harm

# --- a thin rod -------------------------------------------------------------------------------------------------------

class RodBasis:
    """Real spherical harmonics that are even under u -> -u and z -> -z, up to l = most, and what a linear flow along x does to them."""

    def __init__(self, most):
        x, weight = (part[most + 3:] for part in roots_legendre(2 * most + 6))  # z > 0, and y > 0: all else is their image
        phi = 2.0 * math.pi * numpy.arange(2 * most + 4) / (4 * most + 8)
        self.polar, self.around = numpy.arccos(x), phi
        self.cosine, self.phi = (grid.ravel() for grid in numpy.meshgrid(x, phi, indexing="ij"))
        self.sine = numpy.sqrt(1.0 - self.cosine**2)
        self.weight = 2.0 * numpy.repeat(weight, len(phi)) * 2.0 * math.pi / len(phi)
        self.pairs = [(l, m) for l in range(0, most + 1, 2) for m in range(-l, l + 1, 2)]
        # Jeffery: u' = W u + B (E u - (u E u) u); the parts without and with the shape factor B
        turn, dip = 0.5 * numpy.cos(2.0 * self.phi), self.sine * self.cosine * numpy.sin(self.phi) * numpy.cos(self.phi)
        step = 1e-5
        values, rotated, strained = [], [], []
        for l, m in self.pairs:
            values.append(self.harmonic(l, m, 0.0, 0.0))
            by_theta = (self.harmonic(l, m, step, 0.0) - self.harmonic(l, m, -step, 0.0)) / (2.0 * step)
            by_phi = (self.harmonic(l, m, 0.0, step) - self.harmonic(l, m, 0.0, -step)) / (2.0 * step)
            rotated.append(-0.5 * by_phi)
            strained.append(dip * by_theta + turn * by_phi)
        self.values = numpy.array(values)
        self.rotation, self.strain = ((numpy.array(part) * self.weight) @ self.values.T for part in (rotated, strained))
        self.diffusion = numpy.diag([-l * (l + 1.0) for l, _ in self.pairs])

    def harmonic(self, l, m, theta, phi):
        wave = numpy.exp(1j * abs(m) * (self.around + phi))
        y = numpy.outer(sph_harm(abs(m), l, 0.0, self.polar + theta).real, wave.real if m >= 0 else wave.imag).ravel()
        return y if m == 0 else math.sqrt(2.0) * y


@functools.lru_cache
def rod_basis(most):
    return RodBasis(most)


@functools.lru_cache
def rod(peclet, most=None, spin=1.0, shape=1.0):
    """Moments of the direction u of a rod in steady shear, at Pe = rate/D_r: xx, yy, zz, xy, and `turning`, the mean of
    (w - B cos 2 phi)/2: it turns by -rate * turning per time. D_r lap psi = div(psi u'), u' = w W u + B (E u - (u E u) u), W and E the
    rotation and the strain of the flow. shape: B, 1 for a thin rod, (p^2 - 1)/(p^2 + 1) for a spheroid of aspect ratio p (Jeffery).
    spin: w, 1 unless the fluid exerts a torque on a body that rotates with it."""
    basis = rod_basis(most or (12 if peclet <= 2 else 30 if peclet <= 20 else 44))
    matrix = basis.diffusion + peclet * (spin * basis.rotation + shape * basis.strain)
    coefficients = numpy.zeros(len(basis.pairs))
    coefficients[0] = 1.0 / math.sqrt(4.0 * math.pi)
    coefficients[1:] = numpy.linalg.solve(matrix[1:, 1:], -matrix[1:, 0] * coefficients[0])
    density = basis.weight * (coefficients @ basis.values)
    ux, uy, uz = basis.sine * numpy.cos(basis.phi), basis.sine * numpy.sin(basis.phi), basis.cosine
    return {"xx": float(density @ ux**2), "yy": float(density @ uy**2), "zz": float(density @ uz**2), "xy": float(density @ (ux * uy)),
            "turning": float(density @ (0.5 * spin - 0.5 * shape * numpy.cos(2.0 * basis.phi)))}


@functools.lru_cache
def rod_fit(known, measured):
    """(w, error), (B, error), chi^2, degrees of freedom, from measured moments of rods. known: (D_r, error), fitted along.
    measured: ((rate, ((moment, (value, error)), ...)), ...), moments as `rod` has them."""
    def deviations(x):
        found = [(x[2] - 1.0) * known[0] / known[1]]
        for rate, moments in measured:
            expected = rod(rate / (known[0] * x[2]), None, x[0], x[1])
            found += [(value - expected[name]) / error for name, (value, error) in moments]
        return numpy.array(found)

    fit = least_squares(deviations, (1.0, 0.95, 1.0), diff_step=1e-4)
    free = len(fit.fun) - 3
    chi2 = 2.0 * fit.cost
    errors = numpy.sqrt(numpy.diag(numpy.linalg.inv(fit.jac.T @ fit.jac)) * max(1.0, chi2 / free))
    return (fit.x[0], errors[0]), (fit.x[1], errors[1]), chi2, free


# --- a Gaussian chain -------------------------------------------------------------------------------------------------

def retention(per_cell, mass):
    """What a collision by 90 degrees with a Poisson number of phantoms leaves of the velocity of a vertex alone in its cell."""
    share, total, k = math.exp(-per_cell), 0.0, 0
    while k < 20 * per_cell + 20:
        total += share * (mass + k / 3.0) / (mass + k)
        k += 1
        share *= per_cell / k
    return total


def friction(per_cell, mass, interval):
    """kT over the diffusion coefficient of a vertex alone in its cells: D = (kT dt/M) [1/(1 - c) - 1/2]."""
    kept = retention(per_cell, mass)
    return mass / (interval * (1.0 / (1.0 - kept) - 0.5))


def chain(vertices, spring, mass, drag, rate):
    """Stationary moments of a Gaussian chain in shear, each vertex with its own friction (Rouse), with inertia: second moments of the end-to-end
    vector, and its part of the stress, N1 and the shear stress per chain and volume."""
    matrix = numpy.zeros((vertices, vertices))
    for i in range(vertices - 1):
        matrix[i:i + 2, i:i + 2] += spring * numpy.array([[1.0, -1.0], [-1.0, 1.0]])
    stiffness, modes = numpy.linalg.eigh(matrix)
    found = {"RxRx": 0.0, "RyRy": 0.0, "RzRz": 0.0, "RxRy": 0.0, "stress": 0.0, "N1": 0.0}
    for k, ends in zip(stiffness[1:], modes[-1, 1:] - modes[0, 1:]):
        drift = numpy.array([[0, rate, 1, 0], [0, 0, 0, 1], [-k / mass, 0, -drag / mass, -rate], [0, -k / mass, 0, -drag / mass]])
        c = solve_continuous_lyapunov(drift, -numpy.diag([0, 0, 2 * drag / mass**2, 2 * drag / mass**2]))
        found["RxRx"] += ends**2 * c[0, 0]
        found["RyRy"] += ends**2 * c[1, 1]
        found["RzRz"] += ends**2 / k
        found["RxRy"] += ends**2 * c[0, 1]
        found["stress"] += k * c[0, 1] - mass * c[2, 3]
        found["N1"] += k * (c[0, 0] - c[1, 1]) - mass * (c[2, 2] - c[3, 3])
    return found
