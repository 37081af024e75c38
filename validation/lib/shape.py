"""The loss of D because a solute changes its shape, at any lag; and shapes of the paper's rods.

Kirkwood's D is that of short times. Internal forces then move the center of mass, through the mobilities of the present shape
(lib/brownian.py), so that g_cm/6t is lower by a share that grows with the lag. Units a0 = kT = m = t0 = 1.
"""
import functools
import math

import numpy

from lib import brownian, dilute

SPRING, REST = 100.0, 0.5  # of a rod's bonds
BOND = (REST**3 + 3.0 * REST / SPRING) / (REST**2 + 1.0 / SPRING)  # <l>: r^2 exp(-k (r - l0)^2/2) in closed form
BOND2 = (REST**4 + 6.0 * REST**2 / SPRING + 3.0 / SPRING**2) / (REST**2 + 1.0 / SPRING)  # <l^2>

# What the images in a periodic box take from D_r of a slender rod, times eta V/kT, averaged over directions: of the torque 1/6, as for
# a sphere, and of the strain that a turning rod makes 1/10.
IMAGES = 4.0 / 15.0

LATE = brownian.LAGS[-1]  # of D "at long times"

# Share of D that a flexible chain's g_cm/6t lacks at brownian.LAGS, and its error at the last of them: the last column of
# `validation/lib/brownian.py N CHAINS 210`, with 256, 256, 256, 128, 96 and 6 chains.
CHAINS = {5: ((0.0003, 0.0006, 0.0009, 0.0014, 0.0019, 0.0023, 0.0025), 0.0002),
          10: ((0.0008, 0.0015, 0.0024, 0.0036, 0.0048, 0.0059, 0.0067), 0.0005),
          20: ((0.0015, 0.0027, 0.0043, 0.0063, 0.0082, 0.0101, 0.0120), 0.0013),
          40: ((0.0022, 0.0038, 0.0061, 0.0088, 0.0115, 0.0145, 0.0182), 0.0029),
          80: ((0.0026, 0.0045, 0.0073, 0.0106, 0.0141, 0.0182, 0.0217), 0.0042),
          160: ((0.0022, 0.0039, 0.0061, 0.0087, 0.0119, 0.0139, 0.0127), 0.0108)}

def chain_share(n, times):
    """Share of the short-time D that g_cm/6t of a flexible chain lacks at lags `times`, from CHAINS."""
    known = numpy.concatenate([[0.0], CHAINS[n][0]])
    return numpy.interp(numpy.log(numpy.atleast_1d(times)), numpy.log((0.2, *brownian.LAGS)), known)


def chain_error(n):
    """Its standard error at the longest lag; a common factor of all lags, nearly."""
    return CHAINS[n][1]


@functools.lru_cache(maxsize=None)
def rod_modes(n):
    """[(weight, share of the center of mass in each mode, rates)] of a straight rod along and across itself: small stretches and
    bends, dx/dt = -H K x + noise, with what vertices have without the field and the field smeared over cells."""
    apart = numpy.zeros((n, n, 3))
    apart[..., 0] = BOND * numpy.subtract.outer(numpy.arange(n), numpy.arange(n))
    field = brownian.smeared_oseen(apart, dilute.ETA, dilute.CELL_SPREAD)
    alone = dilute.sharing_matrix(lambda draw: dilute.rod_shape(n, BOND, draw))
    first, second = numpy.diff(numpy.eye(n), axis=0), numpy.diff(numpy.eye(n), 2, axis=0)
    found = []
    for weight, one, stiff in ((1.0, field[..., 0, 0], SPRING * first.T @ first),
                               (2.0, field[..., 1, 1], 2.0 * n / BOND2 * second.T @ second)):
        w, u = numpy.linalg.eigh(alone + one)
        root = (u * numpy.sqrt(w)) @ u.T
        rate, mode = numpy.linalg.eigh(root @ stiff @ root)
        found.append((weight, (root @ mode).mean(axis=0)**2, numpy.maximum(rate, 1e-12)))
    return found


def rod_share(n, times):
    """The same of a rod that is straight but for small bends and stretches, in closed form: each mode of rate w has the share
    [1 - exp(-w t)]/(w t) of its D left. From Kirkwood's D at once to that of a rigid rod after the slowest mode."""
    t = numpy.atleast_1d(times)[:, None]
    left = sum(weight * (part * -numpy.expm1(-rate * t) / (rate * t)).sum(axis=1) for weight, part, rate in rod_modes(n))
    return 1.0 - left / sum(weight * part.sum() for weight, part, _ in rod_modes(n))


@functools.lru_cache(maxsize=None)
def rod_shapes(n, samples=3000, kappa=None):
    """Independent shapes of the paper's rods, of their exact distribution, or of fibers with another stiffness: vertices x 3 x samples."""
    random = numpy.random.Generator(numpy.random.PCG64(n))
    kappa, count = kappa or 2.0 * n, (n - 1, samples)
    length = random.normal(REST, math.sqrt(1.0 / SPRING), (16, *count))  # density times l^2: of 16 tries the first accepted
    accepted = (length > 0.0) & (random.uniform(size=length.shape) < length**2)
    length = numpy.take_along_axis(length, accepted.argmax(axis=0)[None], axis=0)[0]
    cosine = 1.0 + numpy.log(random.uniform(math.exp(-2.0 * kappa), 1.0, count)) / kappa
    sine, azimuth = numpy.sqrt(1.0 - cosine**2), random.uniform(0.0, 2.0 * math.pi, count)
    u, v = numpy.tile([[0.0], [0.0], [1.0]], samples), numpy.tile([[1.0], [0.0], [0.0]], samples)
    places = [numpy.zeros((3, samples))]
    for bond in range(n - 1):
        places.append(places[-1] + length[bond] * u)
        side = numpy.cos(azimuth[bond]) * v + numpy.sin(azimuth[bond]) * numpy.cross(u, v, axis=0)
        u, v = cosine[bond] * u + sine[bond] * side, cosine[bond] * side - sine[bond] * u
    return numpy.array(places)


def pair_mean(n, pair, samples=400):
    """Mean over shapes and all pairs i, j of a rod's vertices, i = j included, of pair(distance)."""
    places, total = rod_shapes(n)[..., :samples], 0.0
    for one in places:
        total += pair(numpy.sqrt(((places - one)**2).sum(axis=1))).mean(axis=1).sum()
    return total / n**2


def turning_rates(shapes, alone, eta, spread):
    """Rates [of each shape] at which the regression axis of fibers forgets its direction, 2 D_r, kT = 1; shapes: fibers x vertices x 3. Twice:
    as long as bends have not relaxed, when each vertex moves by itself, as in Kirkwood's D; and with a frozen shape, whose vertices share
    one velocity and one rotation. alone: what each vertex has without the field, and what they share: a matrix."""
    count, n, _ = shapes.shape
    places = shapes - shapes.mean(axis=1, keepdims=True)
    blocks = brownian.smeared_oseen(places[:, :, None] - places[:, None], eta, spread) + alone[..., None, None] * numpy.eye(3)
    along = numpy.arange(n) - 0.5 * (n - 1.0)
    axis = numpy.einsum("i,kia->ka", along, places)
    length2 = (axis**2).sum(axis=1)
    across = numpy.eye(3) - axis[:, :, None] * axis[:, None] / length2[:, None, None]
    free = numpy.einsum("i,j,kijab,kab->k", along, along, blocks, across) / length2
    rigid = numpy.zeros((count, n, 3, 6))
    rigid[..., :3] = numpy.eye(3)
    for k in range(3):
        rigid[..., 3 + k] = numpy.cross(numpy.eye(3)[k], places)
    rigid = rigid.reshape(count, 3 * n, 6)
    friction = rigid.transpose(0, 2, 1) @ numpy.linalg.solve(blocks.transpose(0, 1, 3, 2, 4).reshape(count, 3 * n, 3 * n), rigid)
    moving = numpy.linalg.pinv(friction, 1e-12, hermitian=True)  # a straight row turns freely about itself
    return free, (moving[:, 3:, 3:] * across).sum(axis=(1, 2))


@functools.lru_cache(maxsize=None)
def turning_times(n, kappa, box, samples=300):
    """(tau_r, of bends that have not relaxed; of frozen shapes; the larger standard error) of a lone fiber in a periodic box, nothing
    fitted: the field smeared over cells, less what images take from D_r. Without the field: of a straight row. Left out: what the
    fiber's own vertices make heavier."""
    alone = dilute.sharing_matrix(lambda draw: dilute.rod_shape(n, BOND, draw))
    shapes = numpy.moveaxis(rod_shapes(n, samples, kappa), 2, 0)
    parts = [turning_rates(some, alone, dilute.ETA, dilute.CELL_SPREAD) for some in numpy.array_split(shapes, 10)]
    rates = numpy.concatenate(parts, axis=1) - 2.0 * IMAGES / (dilute.ETA * box**3)
    times = 1.0 / rates.mean(axis=1)
    return *times, float((rates.std(axis=1, ddof=1) / math.sqrt(samples) * times**2).max())
