"""Formulas that claims are held against and that no C code has, each once. Units a0 = kT = m = 1."""
import math


def occupancy(gamma):
    """gamma - 1 + exp(-gamma): mean of (n - 1) over cells with n >= 1 Poisson members."""
    return gamma - 1.0 + math.exp(-gamma)


def viscosity(gamma=5.0, dt_c=0.02, alpha=90.0):
    """Shear viscosity of the solvent (kinetic, collisional): Padding 2009, Eqs. (30), (31)."""
    a = math.radians(alpha)
    kinetic = gamma * dt_c * (5.0 * gamma / (occupancy(gamma) * (4.0 - 2.0 * math.cos(a) - 2.0 * math.cos(2.0 * a))) - 0.5)
    return kinetic, (1.0 - math.cos(a)) / (18.0 * dt_c) * occupancy(gamma)


def kinematic_viscosity(gamma=5.0, dt_c=0.02, alpha=90.0):
    return sum(viscosity(gamma, dt_c, alpha)) / gamma


def self_diffusion(gamma=5.0, dt_c=0.02, alpha=90.0):
    """Of a solvent particle, molecular chaos: the Green-Kubo sum of a velocity that keeps c per collision."""
    return dt_c * (1.0 / (1.0 - retention(gamma, alpha)) - 0.5)


def retention(gamma=5.0, alpha=90.0):
    """What a solvent particle keeps of its velocity per collision: 1 - (2/3)(1 - cos alpha)(gamma - 1 + exp(-gamma))/gamma."""
    return 1.0 - 2.0 / 3.0 * (1.0 - math.cos(math.radians(alpha))) * occupancy(gamma) / gamma


# Lattice sum of a point force in a periodic cube: D falls by PERIODIC kT/(6 pi eta L) to leading order (Hasimoto 1959).
PERIODIC = 2.837297
SOUND_SPEED = math.sqrt(5.0 / 3.0)
