"""Positions are whole numbers of 2^-40 a0 in int64; vectors are rows [..., 3] of doubles.

dot and cross write their sums out, since the order of operations is part of the contract (docs/port/contract.md, Arithmetic).
"""

import numpy as np

CELL = 1 << 40  # lattice units per a0
UNIT = 2.0**-40
TINY = 2.0**-1000


def to_lattice(displacement):
    """Nearest lattice vector of a displacement in a0, ties to even."""
    return np.rint(displacement * 2.0**40).astype(np.int64)


def wrap(position, box):
    """Into 0 <= x < edge; box in cells."""
    return position % (box * CELL)


def dot(a, b):
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def cross(a, b):
    (ax, ay, az), (bx, by, bz) = (np.moveaxis(np.asarray(v), -1, 0) for v in (a, b))
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)


def clamp(x):
    return max(min(x, 1.0), 0.0)


def closest(p, q, w):
    """s and t of the points of two bonds that are closest to each other, and the gap between them."""
    n = cross(p, q)
    pp, qq, nn = dot(p, p) + TINY, dot(q, q) + TINY, dot(n, n) + TINY
    pq, pw, qw = dot(p, q), dot(p, w), dot(q, w)
    of_lines = clamp((pw * qq - pq * qw) / nn)
    t = clamp((of_lines * pq - qw) / qq)
    s = clamp((t * pq + pw) / pp)
    return s, t, (w + t * q) + -s * p
