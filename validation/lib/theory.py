"""Formulas that validation cases compare with, and that are not in the C code, each once. Units a0 = kT = m = 1."""
import math

import numpy


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


def andersen_viscosity(gamma, dt_c):
    """Shear viscosity of MPC-AT-a in three dimensions (kinetic, collisional), molecular chaos: of the kinetic stress a collision
    leaves 1 - P/gamma, P = gamma - 1 + exp(-gamma), and it hands on P/12 (Noguchi and Gompper, Phys. Rev. E 78, 016706 (2008))."""
    partners = occupancy(gamma)
    return gamma * dt_c * (gamma / partners - 0.5), partners / (12.0 * dt_c)


def self_diffusion(gamma=5.0, dt_c=0.02, alpha=90.0):
    """Of a solvent particle, molecular chaos: the Green-Kubo sum of a velocity that keeps c per collision."""
    return dt_c * (1.0 / (1.0 - retention(gamma, alpha)) - 0.5)


def heat_diffusion(gamma=5.0, dt_c=0.02, alpha=90.0):
    """Diffusivity of heat of the solvent at constant density (kinetic, collisional): conductivity over (3/2) n k, molecular chaos.

    Kinetic: 5/3 of what holds at constant pressure, to first order in 1/gamma (Tuzel, Strauss, Ihle, Kroll, Phys. Rev. E 68, 036701
    (2003)). Collisional: in a cell of n members the energies of particles come nearer to their mean by (4/3)(1 - cos alpha)/n of the
    difference: a rotation changes a member's energy through u.w only, u the cell's velocity, w the member's relative one. It spreads over
    the cell as momentum does. The same as in Ihle, Tuzel, Kroll, Phys. Rev. E 72, 046707 (2005), at constant pressure."""
    turn = 1.0 - math.cos(math.radians(alpha))
    kinetic = 5.0 / 6.0 * dt_c * (3.0 / turn - 1.0 + 6.0 / gamma * (0.8 - 0.5 / turn))
    most = int(gamma + 20.0 * math.sqrt(gamma)) + 20
    partners = sum(math.exp(n * math.log(gamma) - gamma - math.lgamma(n + 1.0)) * (n - 1.0) / n for n in range(1, most))
    return kinetic, turn / (9.0 * dt_c) * partners / gamma


def retention(gamma=5.0, alpha=90.0):
    """Share of its velocity that a solvent particle keeps per collision: 1 - (2/3)(1 - cos alpha)(gamma - 1 + exp(-gamma))/gamma."""
    return 1.0 - 2.0 / 3.0 * (1.0 - math.cos(math.radians(alpha))) * occupancy(gamma) / gamma


# Lattice sum of a point force in a periodic cube: D falls by PERIODIC kT/(6 pi eta L) to leading order (Hasimoto 1959).
PERIODIC = 2.837297
SOUND_SPEED = math.sqrt(5.0 / 3.0)


def shear_modes(cells, largest=40):
    """(k^2, how many) of the waves of a periodic cube with this edge, all but k = 0, up to `largest` per direction."""
    n = numpy.arange(-largest, largest + 1)
    squares = (n[:, None, None]**2 + n[:, None]**2 + n**2).ravel()
    values, counts = numpy.unique(squares[(squares > 0) & (squares <= largest**2)], return_counts=True)
    return (2.0 * math.pi / cells)**2 * values, counts


# a0^2: half the mean square distance, per axis, by which velocity is handed on in two collisions, by members anywhere in their
# cells. At most so much: what a cell hands on is in the viscosity already, in part.
CELL = 1.0 / 6.0


def longitudinal(k2, damping, heat, speed=SOUND_SPEED):
    """The matrix M of d(r, v, s)/dt = -M (r, v, s): density, velocity and temperature of a longitudinal wave, each in units of its
    thermal fluctuation, by the linear equations of continuity, of Navier and Stokes, and of heat:

        M = [[0, ik, 0], [ik, nu' k^2, iak], [0, iak, heat k^2]],  a^2 = c^2 - 1,  2 damping = nu' + heat a^2/c^2

    damping: Gamma of long waves; heat: diffusivity of heat at constant density. Shape: that of k2, then (3, 3)."""
    k2 = numpy.asarray(k2, float)
    matrix = numpy.zeros((*k2.shape, 3, 3), complex)
    matrix[..., 0, 1] = matrix[..., 1, 0] = 1j * numpy.sqrt(k2)
    matrix[..., 1, 2] = matrix[..., 2, 1] = 1j * numpy.sqrt((speed**2 - 1.0) * k2)
    matrix[..., 1, 1] = (2.0 * damping - heat * (1.0 - speed**-2)) * k2
    matrix[..., 2, 2] = heat * k2
    return matrix


def decays(matrix, look, start):
    """[(amplitude, rate)]: look.exp(-matrix t) start is their sum of amplitude exp(-rate t)."""
    rates, vectors = numpy.linalg.eig(matrix)
    amplitudes = (look @ vectors) * (numpy.linalg.inv(vectors) @ start)
    return [(amplitudes[..., n], rates[..., n]) for n in range(len(start))]


def sound_decays(k2, damping, speed=SOUND_SPEED, heat=0.0):
    """[(amplitude, rate)] of the decays that a longitudinal wave of velocity is made of: the three of `longitudinal`. With heat = 0
    heat stays where it is made, and there are two:

        exp(-g t) [cos wt - (g/w) sin wt],  g = damping k^2,  w^2 = (c k)^2 - g^2

    complex below g = c k, real beyond."""
    if heat > 0.0:
        velocity = numpy.array([0.0, 1.0, 0.0])
        return decays(longitudinal(k2, damping, heat, speed), velocity, velocity)
    g = damping * k2
    w = numpy.sqrt(speed**2 * k2 - g**2 + 0j)
    return [(0.5 * (1.0 + 1j * g / w), g - 1j * w), (0.5 * (1.0 - 1j * g / w), g + 1j * w)]


def over_time(found, t):
    """The sum of decays [(amplitude, rate)] at times t."""
    return sum(amplitude * numpy.exp(-rate * t) for amplitude, rate in found).real


def sound_mode(t, k2, damping, heat=0.0):
    return over_time(sound_decays(k2, damping, heat=heat), t)


def heat_mode(t, k2, damping, heat):
    """T' - (2/3) rho'/rho, in units of its start, of a wave of temperature: what sound does not carry away. For small k it decays as
    exp(-(3/5) heat k^2 t)."""
    warming = math.sqrt(SOUND_SPEED**2 - 1.0)
    look, start = numpy.array([-warming, 0.0, 1.0]), numpy.array([0.0, 0.0, 1.0])
    return over_time(decays(longitudinal(k2, damping, heat), look, start), t)


def long_time_tail(t, cells, gamma, shear, sound, diffusion=0.0, smear=0.0, heat=0.0):
    """Velocity autocorrelation of a particle, per component and in units of kT/m, as the waves of the box carry it (Ernst,
    Hauge, van Leeuwen, Phys. Rev. Lett. 25, 1254 (1970), before the limit of long times):

        (1/3N) sum_k exp(-(D t + smear) k^2) [ 2 exp(-shear k^2 t) + sound_mode(t) ]

    shear: nu; sound: damping Gamma of sound, None: without sound; heat as for sound_decays. smear: CELL at most. For t long after the
    first collisions. In an infinite box sound dies as exp(-c^2 t/4 Gamma), and the rest is (2/3 gamma)(4 pi (nu + D) t)^(-3/2)."""
    k2, count = shear_modes(cells)
    t = numpy.asarray(t, float)[..., None]
    waves = 2.0 * numpy.exp(-shear * k2 * t) + (0.0 if sound is None else sound_mode(t, k2, sound, heat))
    return (numpy.exp(-(diffusion * t + smear) * k2) * waves * count).sum(axis=-1) / (3.0 * gamma * cells**3)


def long_time_tail_unbounded(t, gamma, spread):
    return 2.0 / (3.0 * gamma) * (4.0 * math.pi * spread * numpy.asarray(t))**-1.5


def diffusion_still_to_come(t, cells, gamma, shear, sound, diffusion=0.0, smear=0.0, heat=0.0):
    """The amount by which <r^2>/6t is below its limit in this box after a time t: (1/t) times the integral of min(s, t) C(s) ds
    of the waves of long_time_tail, which for a decay exp(-rate s) is (1 - exp(-rate t))/(rate^2 t)."""
    k2, count = shear_modes(cells)
    waves = [(2.0, shear * k2)] + ([] if sound is None else sound_decays(k2, sound, heat=heat))
    each = sum(amplitude * -numpy.expm1(-(rate + diffusion * k2) * t) / (rate + diffusion * k2)**2 for amplitude, rate in waves)
    return (count * numpy.exp(-smear * k2) * each.real).sum() / (3.0 * gamma * cells**3 * t)


def image_correction(viscosity, cells):
    """The increase of D when the box grows to infinity, to leading order: 2.837297 kT/(6 pi eta L)."""
    return PERIODIC / (6.0 * math.pi * viscosity * cells)
