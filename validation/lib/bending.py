"""Sideways motion of the middle of a lone stiff fiber, nothing fitted: the modes of a straight chain of vertices.

Units a0 = kT = m = t0 = 1. Bends cost K = (kappa/<l^2>) D^T D, D the second difference along the fiber; vertices move by
dx/dt = -H K x + noise, H their mobilities: what they have without hydrodynamics (dilute.sharing_matrix: members of one
cell are braked together) and, with hydrodynamics, Oseen's field smeared over cells (dilute.CELL_SPREAD). The field is
that of the periodic box, whose waves take 1/(nu k^2) to build up: twelve t0 for the longest of a box of 32.
"""
import functools
import math

import numpy

from lib import dilute

DIRECTIONS = 24  # of the fiber, over which mobilities are averaged
SHORTEST = 6.0  # k a0: smearing leaves 0.0025 of such a wave


def directions(count=DIRECTIONS):
    """Unit vectors evenly over half a sphere: a spiral."""
    z = (numpy.arange(count) + 0.5) / count
    angle = math.pi * (3.0 - math.sqrt(5.0)) * numpy.arange(count)
    across = numpy.sqrt(1.0 - z**2)
    return numpy.stack([across * numpy.cos(angle), across * numpy.sin(angle), z], axis=1)


@functools.lru_cache
def half_waves(box):
    """One of each pair k, -k of the wave vectors of a cubic box up to SHORTEST."""
    reach = int(SHORTEST * box / (2.0 * math.pi))
    n = numpy.stack(numpy.meshgrid(*3 * [numpy.arange(-reach, reach + 1)], indexing="ij"), axis=-1).reshape(-1, 3)
    square = (n**2).sum(axis=1)
    first = (n[:, 0] > 0) | ((n[:, 0] == 0) & ((n[:, 1] > 0) | ((n[:, 1] == 0) & (n[:, 2] > 0))))
    return 2.0 * math.pi / box * n[first & (square <= (SHORTEST * box / (2.0 * math.pi))**2)]


def field(times, box, vertices, spacing, eta=dilute.ETA, nu=dilute.NU):
    """Transverse mobility between vertices 0 ... vertices - 1 bonds apart along a straight fiber: [time, distance], kT = 1.

        G(r) = (1/eta V) sum_k (1 - (k x d)^2/2 k^2) exp(-k^2 s^2/2)/k^2 cos(k.r) {1 - [1 - exp(-nu k^2 t)]/(nu k^2 t)}

    d: direction of the fiber, averaged over; braces: what has built up on average within a lag t."""
    square, sums = shells(box, vertices, spacing)
    x = nu * square[:, None] * numpy.atleast_1d(times)
    weight = 2.0 * numpy.exp(-0.5 * dilute.CELL_SPREAD * square) / (square * eta * box**3)
    return (weight[:, None] * (1.0 + numpy.expm1(-x) / x)).T @ sums


@functools.lru_cache
def shells(box, vertices, spacing):
    """k^2 of each shell of wave vectors, and the sums of [1 - (k x d)^2/2 k^2] cos(k.r) over half of it: [shell, distance]. These
    take the time, and neither the lag nor the fluid changes them."""
    k = half_waves(box)
    length2 = (k**2).sum(axis=1)
    _, first, shell = numpy.unique(numpy.rint(length2 * (box / (2.0 * math.pi))**2), return_index=True, return_inverse=True)
    sums = numpy.zeros((vertices, len(first)))
    for d in directions():
        along = k @ d
        across = 0.5 * (1.0 + along**2 / length2)
        turn, phase = numpy.exp(1j * spacing * along), numpy.ones(len(k), complex)
        for n in range(vertices):
            sums[n] += numpy.bincount(shell, across * phase.real, len(first))
            phase *= turn
    return length2[first], sums.T / DIRECTIONS


def middle(t, mobility, kappa, bond2):
    """Mean square displacement in both transverse directions of the middle vertex of a free straight chain, a lag t
    after equilibrium: 4 sum_p a_p^2 [1 - exp(-w_p t)]/w_p, w_p of H^(1/2) K H^(1/2)."""
    vertices = len(mobility)
    second = numpy.diff(numpy.eye(vertices), 2, axis=0)
    w, u = numpy.linalg.eigh(mobility)
    if w.min() <= 0.0:
        raise ValueError("mobilities that are no mobilities: a mode would move by itself")
    root = (u * numpy.sqrt(w)) @ u.T
    rate, mode = numpy.linalg.eigh(root @ (kappa / bond2 * second.T @ second) @ root)
    rate = numpy.maximum(rate, 1e-12)  # the whole fiber's moving and turning
    return 4.0 * float(((root @ mode)[vertices // 2]**2 * -numpy.expm1(-rate * t) / rate).sum())


@functools.lru_cache
def lone(times, box, vertices, spacing, kappa, bond2, hydrodynamics, crowd):
    """d^2 at lags `times` (a tuple). crowd: vertices of other fibers per cell, which share cells with this fiber's and make
    the fluid heavier and more viscous. Their stiffness, by which they resist the flow, is left out."""
    apart = dilute.sharing_matrix(lambda draw: dilute.rod_shape(vertices, spacing, draw), crowd=crowd)
    if not hydrodynamics:
        return numpy.array([middle(t, apart, kappa, bond2) for t in times])
    distance = numpy.abs(numpy.subtract.outer(numpy.arange(vertices), numpy.arange(vertices)))
    fields = field(times, box, vertices, spacing, *dilute.heavy_fluid(crowd))
    return numpy.array([middle(t, apart + one[distance], kappa, bond2) for t, one in zip(times, fields)])
