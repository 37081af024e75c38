"""Thick fibers: when two tubes in flight touch, and where.

Doubles decide, in the order of docs/port/tubes.md. A plane that turns with the tubes shows that they are apart.
"""

import numpy as np

from .lattice import UNIT, clamp, closest, cross, dot

TICKS = 65536
PARALLEL = 1e-12


def in_a0(vector):
    return np.array(vector, float) * UNIT


class Knot:
    """The axes at a tick, and the direction of the gap between them (0 where they meet)."""

    def __init__(self, pair, tick):
        vectors = ([x + tick * rate for x, rate in zip(pair[k], pair[3 + k])] for k in range(3))
        self.p, self.q, self.w = (in_a0(vector) for vector in vectors)
        self.n = direction(closest(self.p, self.q, self.w)[2])


def direction(gap):
    size = np.sqrt(dot(gap, gap))
    return (1 / size if size > 0 else 0.0) * gap


def size_of(a, b):
    return max(*((abs(v[0]) + abs(v[1])) + abs(v[2]) for v in (a, b)))


def least(a, b):
    """Twice what is between them and the plane: for the nearest corner."""
    w, q, p = (dot(a.n, y) + dot(b.n, x) for x, y in ((a.w, b.w), (a.q, b.q), (a.p, b.p)))
    return w + min(0.0, q) - max(0.0, p)


def apart(a, b, reach):
    """Are the tubes apart from one knot to the other, whatever the rounding?"""
    size = size_of(a.w, b.w) + size_of(a.q, b.q) + size_of(a.p, b.p)
    beyond = 2.0 * reach * UNIT * (1.0 + 2.0**-48) + 4.0 * 16.0 * 2.0**-53 * size
    return least(a, a) > beyond and least(b, b) > beyond and least(a, b) > beyond


def first_contact(pair, reach, start):
    """The first tick from `start` on in which the tubes may touch; TICKS if there is none."""
    if not any(any(rate) for rate in pair[3:]):
        return TICKS
    intervals = [(start, TICKS, Knot(pair, start), Knot(pair, TICKS))]
    while intervals:
        first, last, a, b = intervals.pop()
        if apart(a, b, reach):
            continue
        if last - first == 1:
            return first
        middle = first + (last - first) // 2
        between = Knot(pair, middle)
        intervals += [(middle, last, between, b), (first, middle, a, between)]
    return TICKS  # none


def touch(p, q, w):
    """s, t and the gap: the middle of where parallel tubes are side by side, else the nearest points."""
    n = cross(p, q)
    pp, qq = dot(p, p), dot(q, q)
    a, b = dot(w, p) / pp, dot(w + q, p) / pp
    first, last = max(0.0, min(a, b)), min(1.0, max(a, b))
    s, t, gap = closest(p, q, w)
    if not first < last or dot(n, n) > PARALLEL * PARALLEL * pp * qq:
        return s, t, gap
    s = 0.5 * (first + last)
    t = clamp((s - a) / (b - a))
    return s, t, (w + t * q) + -s * p
