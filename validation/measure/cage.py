#!/usr/bin/python3
"""Displacement of the middle of a fiber beside its tube, and relative to the cage of its neighbors.

usage: cage.py TRAJECTORY REACH > cage.csv

The cage of a middle vertex are the vertices of other fibers that are nearer than REACH (a0) at the origin of time. A neighbor can only
push across itself. So the shift C of the cage is the one that explains best how far the neighbors' contours have moved sideways: the
least squares of P_j (s_j - C), s_j from where vertex j was to the nearest point of its fiber's contour now, P_j across the fiber. With
C of the same place, |P (s - C)|^2 is `cage`; with none it is `d2`; with C of another fiber's place, which has the same error and nothing
to do with this one, `null`. If neighbors move together, `cage` is below `null`. Errors: scatter of fibers.
"""
import sys

import h5py
import numpy
from scipy.spatial import cKDTree

BESIDE = 8  # bonds on either side, in which the nearest point is looked for: a fiber slides along itself by less


def shifts(origin, now):
    """[fibers, vertices, 3]: from each vertex of `origin` to the nearest point of its fiber's contour in `now`, near that vertex."""
    best = numpy.full(origin.shape[:2], numpy.inf)
    found = numpy.zeros_like(origin)
    vertices = origin.shape[1]
    start, bond = now[:, :-1], now[:, 1:] - now[:, :-1]
    squares = numpy.einsum("fbk,fbk->fb", bond, bond)
    for offset in range(-BESIDE, BESIDE):
        first, last = max(0, -offset), min(vertices, vertices - 1 - offset)  # vertices that have a bond this far away
        own, bonds = slice(first, last), slice(first + offset, last + offset)
        apart = origin[:, own] - start[:, bonds]
        along = numpy.clip(numpy.einsum("fbk,fbk->fb", apart, bond[:, bonds]) / squares[:, bonds], 0.0, 1.0)
        away = along[..., None] * bond[:, bonds] - apart
        distance = numpy.einsum("fbk,fbk->fb", away, away)
        nearer = distance < best[:, own]
        best[:, own] = numpy.where(nearer, distance, best[:, own])
        found[:, own] = numpy.where(nearer[..., None], away, found[:, own])
    return found


def across(positions):
    """[fibers, vertices, 3, 3]: projectors across the fiber, at each vertex."""
    tangent = numpy.gradient(positions, axis=1)
    tangent /= numpy.linalg.norm(tangent, axis=2, keepdims=True)
    return numpy.eye(3) - tangent[..., :, None] * tangent[..., None, :]


def neighbors(positions, edges, reach):
    """(fiber, fiber of the neighbor, its vertex) of each vertex in reach of a middle one, in a periodic box."""
    fibers, vertices = positions.shape[:2]
    folded = positions.reshape(-1, 3) % edges
    middle = positions[:, vertices // 2] % edges
    lists = cKDTree(folded, boxsize=edges).query_ball_point(middle, reach)
    owner = numpy.repeat(numpy.arange(fibers), [len(found) for found in lists])
    other = numpy.concatenate([numpy.asarray(found, int) for found in lists])
    keep = other // vertices != owner
    return owner[keep], other[keep] // vertices, other[keep] % vertices


def cage_shift(pairs, projectors, moved, fibers):
    """[fibers, 3]: C of each; not a number without two neighbors that are not parallel."""
    owner, fiber, vertex = pairs
    matrix, side = numpy.zeros((fibers, 3, 3)), numpy.zeros((fibers, 3))
    numpy.add.at(matrix, owner, projectors[fiber, vertex])
    numpy.add.at(side, owner, numpy.einsum("nij,nj->ni", projectors[fiber, vertex], moved[fiber, vertex]))
    known = numpy.linalg.det(matrix) > 1e-6
    found = numpy.full((fibers, 3), numpy.nan)
    found[known] = numpy.linalg.solve(matrix[known], side[known][..., None])[..., 0]
    return found


def measure(frames, edges, reach):
    """{lag in frames: ([3, fibers], [fibers])}: means of d2, cage and null of each fiber, and over how many origins."""
    count, (fibers, vertices) = len(frames), frames[0].shape[:2]
    lags = [1 << k for k in range(count.bit_length()) if 3 << k <= count]
    sums = {lag: numpy.zeros((3, fibers)) for lag in lags}
    times = {lag: numpy.zeros(fibers) for lag in lags}  # a fiber was in a cage, and so was the one that lends its own for `null`
    middle = vertices // 2
    for first in range(0, count - 1):
        due = [lag for lag in lags if first % max(1, lag // 2) == 0 and first + lag < count]
        if not due:
            continue
        projectors = across(frames[first])
        pairs = neighbors(frames[first], edges, reach)
        for lag in due:
            moved = shifts(frames[first], frames[first + lag])
            shift = cage_shift(pairs, projectors, moved, fibers)
            lent = numpy.roll(shift, fibers // 2, axis=0)
            caged = ~numpy.isnan(shift + lent).any(axis=1)
            for row, taken in enumerate((0.0 * shift, shift, lent)):
                beside = numpy.einsum("fij,fj->fi", projectors[:, middle], moved[:, middle] - taken)[caged]
                sums[lag][row, caged] += numpy.einsum("fi,fi->f", beside, beside)
            times[lag] += caged
    return {lag: (sums[lag] / numpy.maximum(times[lag], 1), times[lag]) for lag in lags}


def main(path, reach):
    with h5py.File(path) as file:
        particles = file["particles/trajectory"]
        times = particles["position/time"][:]
        edges = numpy.diagonal(particles["box/edges/value"][0])
        bonds = file["connectivity/bonds"][:]
        rows = particles["position/value"].shape[1]
        fibers = rows - len(bonds)
        frames = [particles["position/value"][k].reshape(fibers, rows // fibers, 3) for k in range(len(times))]
    print("time,intervals,d2,d2_error,cage,cage_error,null,null_error,share,share_error")
    for lag, (means, origins) in measure(frames, edges, reach).items():
        means = means[:, origins > 0]
        root = numpy.sqrt(means.shape[1])
        value, error = means.mean(axis=1), means.std(axis=1, ddof=1) / root
        share = value[1] / value[2]  # the error of a ratio: from the fibers' deviations from it
        scatter = (means[1] - share * means[2]).std(ddof=1) / root / value[2]
        print(f"{lag * (times[1] - times[0]):.6g},{origins.max():.0f}," + ",".join(f"{v:.6g},{e:.3g}" for v, e in zip(value, error)) + f",{share:.5f},{scatter:.5f}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], float(sys.argv[2]))
