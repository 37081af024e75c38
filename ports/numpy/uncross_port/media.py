"""Baths other than that of collision cells, forces of pairs, and overdamped motion (docs/port/media.md, *Media*).

Members of pairs are solvent particles, then vertices, by their numbers."""

import math
from dataclasses import dataclass

import numpy as np

from . import elementary, random
from .lattice import CELL, UNIT, dot, to_lattice

PRIVATE, PAIRS, OVERDAMPED = 1, 2, 3
REPLACE, RELAX, CAYLEY = 0, 1, 2
HAT, QUADRATIC = 0, 1
NONE, OSEEN, RPY = 0, 1, 2
FIXED = 2.0**32  # units of sums per kT/a0, and per 1/a0^3


@dataclass
class Medium:
    """The tables `medium` and `bath` of the model."""

    kind: int
    draw: int
    weight: int
    tensor: int
    second: int  # number of the first particle of the second group
    rate: float
    radius: float
    repulsion: float
    between: float
    many_body: float
    many_body_range: float
    flow: np.ndarray

    @property
    def has_groups(self):
        return self.between != 0.0

    @property
    def repels(self):
        return self.repulsion != 0.0 or self.many_body != 0.0 or self.has_groups


def from_tables(tables):
    if "medium" not in tables:
        return None
    which, real = (int(x) for x in tables["medium"][0]), tables["bath"][0]
    return Medium(*which, *(float(x) for x in real[:6]), flow=np.asarray(real[6:9], float))


# --- the one operator


def lost(draw, x):
    """1 - c for each x = rate weight dt."""
    x = np.asarray(x, float)
    if draw == REPLACE:
        return np.ones_like(x)
    if draw == RELAX:
        return 1.0 - elementary.exp(-x)
    return x / (1.0 + 0.5 * x)


def amplitude(loss, inverse):
    return np.sqrt(loss * (2.0 - loss) * inverse)


def chosen(words, x):
    """Of those that the draw `replace` acts on."""
    return (words.astype(float) + 0.5) * 2.0**-32 < x


def private_bath(model, step, velocity):
    bath, vertices = model.medium, np.arange(len(velocity))
    x = bath.rate * model.dt
    loss = lost(bath.draw, x)
    normal = random.drawn(model.seed, random.BATH_VERTEX, step, vertices)
    noise = amplitude(loss, 1 / model.mass)[:, None] * normal
    u = velocity - bath.flow
    change = noise - loss * u
    if bath.draw == REPLACE:
        word = random.words(model.seed, random.BATH_VERTEX, 1, step, vertices)[:, 0]
        change[~chosen(word, x)] = 0.0
    return velocity + change


# --- pairs


def places(model, solvent, vertex):
    """Of all members, in the box, in a0."""
    return (np.concatenate([solvent, vertex]) % (model.box * CELL)) * UNIT


def near_pairs(model, place):
    """Numbers of the members of all pairs nearer than 1 a0, first < second; place of the first less that of the second, and
    its length."""
    first, second = np.triu_indices(len(place), 1)
    apart = place[first] - place[second]
    apart = apart - model.box * np.rint(apart / model.box)
    square = dot(apart, apart)
    near = (square < 1.0) & (square > 0.0)
    return first[near], second[near], apart[near], np.sqrt(square[near])


def masses(model):
    return np.concatenate([np.ones(model.particles), model.mass])


def pairs(model, step, solvent, vertex):
    """Members, line and loss and noise of the pairs on which the bath acts, in order."""
    bath, mass = model.medium, masses(model)
    first, second, apart, r = near_pairs(model, places(model, solvent, vertex))
    weight = (1.0 - r) * (1.0 - r) if bath.weight == QUADRATIC else np.ones_like(r)
    x = weight * (bath.rate * model.dt)
    word = random.words(model.seed, random.BATH_PAIR, second, step, first)
    act = chosen(word[:, 0], x) if bath.draw == REPLACE else np.ones(len(r), bool)
    order = np.flatnonzero(act)
    order = order[np.lexsort((second[order], first[order], word[order, 1]))]
    loss = lost(bath.draw, x)
    inverse = 1 / mass[first] + 1 / mass[second]
    noise = amplitude(loss, inverse) * random.three_normals(word)[:, 2]
    along = apart * (1 / r)[:, None]
    return np.stack([first, second], axis=1)[order], along[order], np.stack([loss, noise], axis=1)[order]


def pair_bath(model, pair, along, bath, solvent, vertex):
    """Velocities after the bath has acted on one pair after the other."""
    velocity, mass = np.concatenate([solvent, vertex]).astype(float), masses(model)
    for (i, j), e, (loss, noise) in zip(pair, along, bath):
        u = dot(e, velocity[i] - velocity[j])
        change, total = noise - loss * u, mass[i] + mass[j]
        velocity[i] = velocity[i] + (change * (mass[j] / total)) * e
        velocity[j] = velocity[j] + (-change * (mass[i] / total)) * e
    return velocity[: len(solvent)], velocity[len(solvent) :]


# --- forces of pairs


def whole(x):
    return np.rint(x).astype(np.int64)


def crowds(model, solvent, vertex):
    """Density about each member, in 2^-32 a0^-3."""
    place, d = places(model, solvent, vertex), model.medium.many_body_range
    first, second, _, r = near_pairs(model, place)
    factor = 15.0 / (2.0 * math.pi * d * d * d) * FIXED
    near = np.maximum(1.0 - r / d, 0.0)
    weight, sums = whole(factor * near * near), np.zeros(len(place), np.int64)
    np.add.at(sums, first, weight)
    np.add.at(sums, second, weight)
    return sums


def repulsion(model, solvent, vertex, crowd):
    """Force on each member, in 2^-32 kT/a0."""
    bath, place = model.medium, places(model, solvent, vertex)
    first, second, apart, r = near_pairs(model, place)
    strength = np.full(len(r), bath.repulsion)
    if bath.has_groups:
        group = np.arange(len(place)) >= bath.second
        group[model.particles :] = False
        strength[group[first] != group[second]] = bath.between
    push = strength * (1.0 - r)
    if bath.many_body:
        near = np.maximum(1.0 - r * (1 / bath.many_body_range), 0.0)
        density = crowd * 2.0**-32
        push = push + bath.many_body * near * (density[first] + density[second])
    force = whole((push / r * FIXED)[:, None] * apart)
    sums = np.zeros((len(place), 3), np.int64)
    np.add.at(sums, first, force)
    np.subtract.at(sums, second, force)
    return sums


def repulsion_kick(model, time, force, solvent, vertex):
    force = force * 2.0**-32
    n = len(solvent)
    return solvent + time * force[:n], vertex + (time * (1 / model.mass))[:, None] * force[n:]


# --- overdamped motion


def fibers(model):
    """Numbers of the vertices of each fiber."""
    return [np.flatnonzero(model.fiber == k) for k in np.unique(model.fiber)]


def factors(tensor, a, r):
    """p and q of two spheres: D = p I + q e e."""
    s = a / r
    if tensor == OSEEN:
        return 0.75 * a / r, 0.75 * a / r
    if r < 2.0 * a:
        return 1.0 - 9.0 * r / (32.0 * a), 3.0 * r / (32.0 * a)
    return 0.75 * s * (1.0 + 2.0 / 3.0 * s * s), 0.75 * s * (1.0 - 2.0 * s * s)


def tensor_of(model, place):
    """D/D0 of one fiber, [3n, 3n]; place in a0, relative to its first vertex."""
    n = len(place)
    d = np.eye(3 * n)
    for j in range(n):
        for i in range(j + 1, n):
            apart = place[i] - place[j]
            r = float(np.sqrt(dot(apart, apart)))
            p, q = factors(model.medium.tensor, model.medium.radius, r)
            e = 1 / r * apart
            block = p * np.eye(3) + q * e[:, None] * e[None, :]
            d[3 * i : 3 * i + 3, 3 * j : 3 * j + 3] = block
            d[3 * j : 3 * j + 3, 3 * i : 3 * i + 3] = block.T
    return d


def root_of(d):
    """L of D = L L^T: the lower triangle, the rest zeros."""
    left, n = np.tril(d), len(d)
    for k in range(n):
        column = left[k:, k]
        column *= 1 / np.sqrt(column[0]) if column[0] > 1e-12 else 0.0
        for j in range(k + 1, n):
            left[j:, j] -= left[j, k] * left[j:, k]
    return left


def packed(matrices):
    """Lower triangles, by columns, one fiber after the other."""
    return np.concatenate([m[np.arange(k, len(m)), k] for m in matrices for k in range(len(m))])


def unpacked(model, entries):
    """The other way, as lower triangles."""
    matrices, at = [], 0
    for fiber in fibers(model):
        n = 3 * len(fiber)
        matrix = np.zeros((n, n))
        for k in range(n):
            matrix[k:, k] = entries[at : at + n - k]
            at += n - k
        matrices.append(matrix)
    return matrices


def tensors(model, position):
    return [tensor_of(model, (position[fiber] - position[fiber[0]]) * UNIT) for fiber in fibers(model)]


def times_tensor(d, x):
    """D x, from the lower triangle: column by column."""
    y = np.zeros(len(x))
    for k in range(len(x)):
        column = d[k:, k]
        y[k + 1 :] += column[1:] * x[k]
        y[k] += np.cumsum(column * x[k:])[-1]
    return y


def times_root(left, x):
    y = np.zeros(len(x))
    for k in range(len(x)):
        y[k:] += left[k:, k] * x[k]
    return y


def move(model, step, position, force, tensor, root):
    """Positions after a step. tensor, root: lists of matrices; empty without a tensor."""
    position, bath = position.copy(), model.medium
    for number, fiber in enumerate(fibers(model)):
        pull = force[fiber].ravel()
        jump = random.drawn(model.seed, random.BATH_VERTEX, step, fiber).ravel()
        if bath.tensor != NONE:
            pull, jump = times_tensor(tensor[number], pull), times_root(root[number], jump)
        drift = 1 / model.mass[fiber[0]] / bath.rate * model.dt
        size = math.sqrt(2.0 * drift)
        flow = np.tile(bath.flow * model.dt, len(fiber))
        position[fiber] += to_lattice((drift * pull + size * jump + flow).reshape(-1, 3))
    return position
