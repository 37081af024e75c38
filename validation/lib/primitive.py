"""Estimators of primitive paths: lengths, steps, entanglements, and the width of a tube (docs/claims/primitive.md).

Positions are unwrapped: [chains, vertices, 3], a0. N counts the bonds of a chain. <R^2> is the mean square of the end-to-end distance, which
stays while ends are held.

    a_pp = <R^2>/<L_pp>                               step of the path
    modified S-coil   N_e = N/(<L_pp^2>/<R^2> - 1)    Hoy, Foteinopoulou and Kroeger, Phys. Rev. E 80, 031803 (2009)
    classical S-coil  N_e = N <R^2>/<L_pp>^2          counts the ends: a path of Z + 1 steps has N/(Z + 1)

Both are of coils. A path that is stiffer than its strands are long has L_pp close to its contour, and they return its Kuhn length."""
import math

import numpy

from lib import stats

C_XI = 0.06


def uchida(x):
    """L_e/l_K at x = rho l_K^2, by Uchida, Grest and Everaers, J. Chem. Phys. 128, 044902 (2008). From memory: the paper was not at hand. Three melts
    agree with it within 20 % of c_xi."""
    scaled = C_XI * numpy.asarray(x, float)
    return scaled**-0.4 + scaled**-2.0


def uchida_slope(x):
    """d ln(L_e/l_K)/d ln x of it."""
    scaled = C_XI * numpy.asarray(x, float)
    return (-0.4 * scaled**-0.4 - 2.0 * scaled**-2.0) / (scaled**-0.4 + scaled**-2.0)


def moments(rest, spring):
    """(<l>, <l^2>) of a bond, in closed form."""
    s = 1.0 / spring
    return (rest**3 + 3.0 * rest * s) / (rest**2 + s), (rest**4 + 6.0 * rest**2 * s + 3.0 * s**2) / (rest**2 + s)


def mean_cosine(kappa):
    """Of the angle between bonds whose energy is kappa (1 - cos)."""
    return 1.0 / math.tanh(kappa) - 1.0 / kappa


def coil(bonds, rest, spring, persistence):
    """(<R^2>, l_K) of an ideal chain, kappa = l_p/l0: <b_i.b_j> = <l>^2 c^|i - j|. l_K is <R^2> over the contour of a chain without end."""
    mean, square = moments(rest, spring)
    c = mean_cosine(persistence / rest)
    exact = bonds * square + 2.0 * mean**2 * c / (1.0 - c) * (bonds - (1.0 - c**bonds) / (1.0 - c))
    return exact, (square + 2.0 * mean**2 * c / (1.0 - c)) / mean


def hinsch(rho, persistence):
    """sigma of a tight tube, per transverse component: 0.32 xi^(6/5) l_p^(-1/5), xi = sqrt(3/rho) (Hinsch, Wilhelm and Frey, cond-mat/0703096)."""
    return 0.32 * math.sqrt(3.0 / rho) ** 1.2 / persistence**0.2


def unfolded(positions, vertices):
    """[chains, vertices, 3] of rows that stand chain by chain."""
    positions = numpy.asarray(positions, float)
    return positions.reshape(*positions.shape[:-2], -1, vertices, 3)


def lengths(paths):
    """Contour length of each path, [..., chains]."""
    return numpy.linalg.norm(numpy.diff(paths, axis=-2), axis=-1).sum(axis=-1)


def spans(paths):
    """Squared end-to-end distance of each path, [..., chains]."""
    ends = paths[..., -1, :] - paths[..., 0, :]
    return numpy.einsum("...k,...k->...", ends, ends)


def step(length, square):
    """a_pp of chains with these contour lengths of their paths and these squares of their spans."""
    return numpy.mean(square) / numpy.mean(length)


def classical(length, square, bonds):
    """Bonds of an entanglement strand by the classical S-coil."""
    return bonds * numpy.mean(square) / numpy.mean(length) ** 2


def modified(length, square, bonds):
    """Bonds of an entanglement strand by the modified S-coil."""
    return bonds / (numpy.mean(numpy.square(length)) / numpy.mean(square) - 1.0)


def known_square(length, square, exact):
    """<L_pp^2>/<R^2> and its standard error, with the exact <R^2> of the ensemble in place of the sample's. A longer chain has a longer path: the
    part of L_pp^2 that goes with R^2 is taken off (a control variate)."""
    x, y = numpy.asarray(square, float), numpy.square(length)
    slope = numpy.cov(x, y)[0, 1] / numpy.var(x, ddof=1)
    left = y - slope * (x - exact)
    return left.mean() / exact, left.std(ddof=1) / numpy.sqrt(len(left)) / exact


def at_rest(stiffness, values, errors):
    """(value, error) of <L> at 1/k = 0. A taut path of bonds l has <L> = L_0 (1 + kT/(k l^2) + ...): a parabola in 1/k through three springs, a line
    through two."""
    x = 1.0 / numpy.asarray(stiffness, float)
    found = stats.fit([x**n for n in range(min(len(x), 3))], values, errors)
    return float(found.value[0]), float(found.error[0])


def nearest(points, path):
    """[points, 3]: from each point of a chain to the nearest point of a path of as many vertices, anywhere along it."""
    start, bond = path[:-1], numpy.diff(path, axis=0)
    square = numpy.maximum(numpy.einsum("bk,bk->b", bond, bond), 1e-300)
    away = points[:, None] - start
    along = numpy.clip(numpy.einsum("pbk,bk->pb", away, bond) / square, 0.0, 1.0)
    gap = along[..., None] * bond - away
    best = numpy.argmin(numpy.einsum("pbk,pbk->pb", gap, gap), axis=1)
    return gap[numpy.arange(len(points)), best]


def across(chains, paths):
    """[chains, vertices]: the square of each vertex's distance from the path of its chain, per transverse component. The nearest point lies across the
    path, so the distance has two components."""
    return numpy.array([numpy.square(nearest(chain, path)).sum(axis=1) / 2.0 for chain, path in zip(chains, paths)])


def beside(chains, means):
    """The same about the mean place of each vertex: the part of the distance that is across the mean path."""
    tangent = numpy.gradient(means, axis=1)
    tangent /= numpy.linalg.norm(tangent, axis=2, keepdims=True)
    away = chains - means
    along = numpy.einsum("cvk,cvk->cv", away, tangent)
    return (numpy.square(away).sum(axis=2) - along**2) / 2.0


def inner(values, share):
    """[chains]: the mean of [chains, vertices] without a share of the vertices at each end: where an end is held, there is no room."""
    skip = int(round(share * values.shape[1]))
    return values[:, skip:values.shape[1] - skip].mean(axis=1)
