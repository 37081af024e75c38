"""Forces on the vertices, and the kick. Contributions are added in the order of bonds, then of bends."""

import numpy as np

from . import random
from .lattice import UNIT, dot


def vertex_order(model, step, sweep):
    return random.permutation(model.seed, random.VERTEX_ORDER, sweep, step, len(model.next))


def bond_vectors(model, position):
    """[bonds, 3] in a0, from each vertex to the next of its fiber: never a minimum image."""
    return (position[model.next[model.bonds]] - position[model.bonds]) * UNIT


def add_bonds(model, position, force):
    """Adds the bond forces to `force`, bond by bond: +F to its first vertex, then -F to the next."""
    first = model.bonds
    vector = bond_vectors(model, position)
    spring, rest = model.spring[first, None], model.bond_length[first, None]
    length = np.sqrt(dot(vector, vector))[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        pull = spring * (length - rest) * ((1 / length) * vector)
    gaussian = (rest == 0) & (model.bending[first, None] == 0)
    pull = np.where(gaussian, spring * vector, pull)
    vertices = np.stack([first, model.next[first]], axis=1).ravel()
    np.add.at(force, vertices, np.stack([pull, -pull], axis=1).reshape(-1, 3))


def add_bends(model, position, force):
    """Adds the bend forces to `force`, vertex by vertex."""
    middle = np.flatnonzero((model.next >= 0) & (model.prev >= 0) & (model.bending != 0))
    before, after = model.prev[middle], model.next[middle]
    vector0, vector1 = (position[middle] - position[before]) * UNIT, (position[after] - position[middle]) * UNIT
    inverse0, inverse1 = 1 / np.sqrt(dot(vector0, vector0))[:, None], 1 / np.sqrt(dot(vector1, vector1))[:, None]
    unit0, unit1 = inverse0 * vector0, inverse1 * vector1
    cosine, stiffness = dot(unit0, unit1)[:, None], model.bending[middle, None]
    on_before = (-stiffness * inverse0) * (unit1 - cosine * unit0)
    on_after = (stiffness * inverse1) * (unit0 - cosine * unit1)
    on_middle = -(on_before + on_after)
    vertices = np.stack([before, after, middle], axis=1).ravel()
    np.add.at(force, vertices, np.stack([on_before, on_after, on_middle], axis=1).reshape(-1, 3))


def forces(model, position):
    """Constant forces, plus bonds, plus bends."""
    force = model.constant_force.copy()
    add_bonds(model, position, force)
    add_bends(model, position, force)
    return force


def kick(model, velocity, force, time):
    return velocity + (time * (1 / model.mass))[:, None] * force
