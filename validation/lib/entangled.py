"""What is exact of thin chains and rings that may cross, and what scaling says of those that may not. Units a0 = kT = m = 1.

A chain has springs (k, l0) and bends kappa (1 - cos theta). Bond lengths and angles are independent, so that all second moments of bonds
are exact: <b_i.b_j> = <l>^2 c^|i - j|, c = coth kappa - 1/kappa, and <l^2> for i = j."""
import functools
import math

import numpy

from lib import primitive

MASS, SPRING, REST = 5.0, 100.0, 0.5
DENSITY = 112 * 383 / 16**3  # bonds per a0^3 of the long chains


def bond_moments(spring=SPRING, rest=REST):
    """(<l>, <l^2>): moments of r^2 exp(-k (r - l0)^2/2), in closed form where the springs are stiff."""
    return primitive.moments(rest, spring)


def mean_cosine(persistence, rest=REST):
    return primitive.mean_cosine(persistence / rest)


def bond_matrix(bonds, persistence):
    """<b_i.b_j>."""
    mean, square = bond_moments()
    apart = numpy.abs(numpy.subtract.outer(numpy.arange(bonds), numpy.arange(bonds)))
    matrix = mean**2 * mean_cosine(persistence)**apart
    return numpy.where(apart == 0, square, matrix)


def end_to_end(vertices, persistence=0.5):
    """<R^2>."""
    return float(bond_matrix(vertices - 1, persistence).sum())


def gyration(vertices, persistence=0.5):
    """<R_g^2> = (1/N^2) sum_{i<j} <r_ij^2>."""
    places = numpy.zeros((vertices, vertices - 1))
    places[1:] = numpy.tril(numpy.ones((vertices - 1, vertices - 1)))
    places -= places.mean(axis=0)
    return float(numpy.einsum("ib,bc,ic->", places, bond_matrix(vertices - 1, persistence), places)) / vertices


def step(persistence=0.5):
    """b^2, <R^2> per bond of a long chain."""
    mean, square = bond_moments()
    c = mean_cosine(persistence)
    return square + 2.0 * mean**2 * c / (1.0 - c)


def kuhn(persistence=0.5):
    """l_K = b^2/<l>."""
    return step(persistence) / bond_moments()[0]


def entanglement(density=DENSITY, persistence=0.5):
    """N_e, bonds, of so many bonds per volume, by a curve from memory."""
    mean = bond_moments()[0]
    return float(primitive.uchida(density * mean * kuhn(persistence)**2)) * kuhn(persistence) / mean


def rouse_time(bonds, friction=MASS, persistence=0.5):
    """tau = zeta N^2 b^2/3 pi^2 kT: tau_R of a chain of so many bonds, tau_e of N_e."""
    return friction * bonds**2 * step(persistence) / (3.0 * math.pi**2)


@functools.lru_cache
def modes(vertices, persistence, where):
    """(rates, weights): of a chain of Gaussian bonds with the exact second moments. The energy is (3/2) b.C^-1 b, C = <b_i.b_j>, so
    the stiffness of vertices is 3 D^T C^-1 D. Weight: the square of each mode at the middle vertex, or its mean over vertices."""
    difference = numpy.diff(numpy.eye(vertices), axis=0)
    stiffness = 3.0 * difference.T @ numpy.linalg.solve(bond_matrix(vertices - 1, persistence), difference)
    rates, vectors = numpy.linalg.eigh(stiffness)
    rates[0] = 0.0
    squares = vectors**2
    return rates, squares[(vertices - 1) // 2] if where == "middle" else squares.mean(axis=0)


def displacement(times, vertices, rate=1.0, persistence=0.5, where="middle"):
    """Mean square displacement of the middle vertex, or of all, of that Gaussian chain in a private bath: each mode of stiffness q is an
    oscillator of mass M with friction M Gamma, <|x(t) - x(0)|^2> = 2 kT/q [1 - phi(t)] per component, phi = exp(-Gamma t/2)
    [cosh st + (Gamma/2s) sinh st], s^2 = Gamma^2/4 - q/M; the center of mass has 2 kT/(M Gamma) [t - (1 - exp(-Gamma t))/Gamma]."""
    t = numpy.atleast_1d(numpy.asarray(times, float))[:, None]
    q, weight = modes(vertices, persistence, where)
    s = numpy.sqrt(0.25 * rate**2 - q[1:] / MASS + 0j)
    phi = (0.5 * ((1.0 + 0.5 * rate / s) * numpy.exp((s - 0.5 * rate) * t) + (1.0 - 0.5 * rate / s) * numpy.exp((-s - 0.5 * rate) * t))).real
    bound = (weight[1:] * 2.0 / q[1:] * (1.0 - phi)).sum(axis=1)
    free = weight[0] * 2.0 / (MASS * rate) * (t[:, 0] + numpy.expm1(-rate * t[:, 0]) / rate)
    return 3.0 * (bound + free)


def rouse_line(times, friction=MASS, persistence=0.5):
    """g_1 = 2 b sqrt(3 kT t/pi zeta): an interior vertex of a long chain, before the whole chain moves."""
    return 2.0 * numpy.sqrt(3.0 * step(persistence) * numpy.asarray(times) / (math.pi * friction))


def tube_line(times, bonds, friction=MASS, persistence=0.5):
    """The same in a tube of width a^2 = N_e b^2: the displacement along the tube is that of one component, and the tube is a random walk:
    g_1 = a <|s|>, <|s|> = sqrt(2 <s^2>/pi), <s^2> = rouse_line/3. It meets rouse_line at t = (pi/9) tau_e."""
    square = rouse_line(times, friction, persistence) / 3.0
    return math.sqrt(bonds * step(persistence)) * numpy.sqrt(2.0 * square / math.pi)


def ideal_distances(vertices, persistence, count, seed):
    """End-to-end distances of chains that are drawn one bond after the other: lengths by rejection, cosines by inverting their
    distribution."""
    random = numpy.random.default_rng(seed)
    kappa = persistence / REST
    direction = numpy.tile([0.0, 0.0, 1.0], (count, 1))
    end = numpy.zeros((count, 3))
    for number in range(vertices - 1):
        if number:
            u = random.random(count)
            cosine = 1.0 + numpy.log(u + (1.0 - u) * math.exp(-2.0 * kappa)) / kappa
            across = random.normal(size=(count, 3))
            across -= (across * direction).sum(axis=1)[:, None] * direction
            across /= numpy.linalg.norm(across, axis=1)[:, None]
            direction = cosine[:, None] * direction + numpy.sqrt(1.0 - cosine**2)[:, None] * across
            direction /= numpy.linalg.norm(direction, axis=1)[:, None]
        end += bond_lengths(random, count)[:, None] * direction
    return numpy.linalg.norm(end, axis=1)


def bond_lengths(random, count):
    """Drawn from r^2 exp(-k (r - l0)^2/2)."""
    found = numpy.zeros(0)
    most = REST + 8.0 / math.sqrt(SPRING)
    while len(found) < count:
        r = REST + random.normal(size=count) / math.sqrt(SPRING)
        found = numpy.concatenate([found, r[(r > 0.0) & (random.random(count) * most**2 < r**2)]])
    return found[:count]


# Edges of ten ranges of the end-to-end distance of 24 vertices that are equally probable: deciles(24) of 2,000,000 chains.
DECILES = 1.603, 2.1, 2.493, 2.849, 3.198, 3.556, 3.949, 4.42, 5.084


def deciles(vertices, persistence=0.5, count=2000000, seed=2):
    """The nine edges of ten ranges that are equally probable."""
    return [round(float(edge), 3) for edge in numpy.quantile(ideal_distances(vertices, persistence, count, seed), numpy.arange(1, 10) / 10.0)]


def ring_gyration(vertices, persistence=0.5):
    """(N^2 - 1)/(12 N) b^2: of a ring of independent Gaussian bonds with the step of the long chain. Bends change it in order 1/N."""
    return (vertices**2 - 1.0) / (12.0 * vertices) * step(persistence)
