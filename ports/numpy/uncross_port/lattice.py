"""Positions are whole numbers of 2^-40 a0 in int64; vectors are rows [..., 3] of doubles.

dot and cross write their sums out, since the order of operations is part of the contract (docs/porting.md, Arithmetic).
"""

import numpy as np

CELL = 1 << 40  # lattice units per a0
UNIT = 2.0**-40


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
