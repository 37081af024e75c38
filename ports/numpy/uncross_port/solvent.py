"""Streaming and the SRD collision, each step of it a function (docs/porting.md, "The operators")."""

import numpy as np

from . import random
from .lattice import CELL, cross, dot, to_lattice, wrap


def stream(model, position, velocity, time):
    """Free flight under the body force: new (position, velocity)."""
    flight = velocity * time + 0.5 * model.acceleration * time * time
    return wrap(position + to_lattice(flight), model.box), velocity + model.acceleration * time


def grid_shift(model, step):
    """[3], in lattice units: words are multiples of 2^-32 a0."""
    return random.words(model.seed, random.GRID_SHIFT, 0, step, 0)[:3].astype(np.int64) * 2**8


def cell_of(model, position, shift):
    """Number of the cell that holds each position, shifted and wrapped."""
    x, y, z = (wrap(position + shift, model.box) // CELL).T
    return (z * model.box[1] + y) * model.box[0] + x


def members(model, solvent_cell, vertex_cell, solvent, vertex):
    """Cells, masses and velocities of all particles: the solvent, then the vertices."""
    mass = np.concatenate([np.ones(len(solvent)), model.mass])
    return np.concatenate([solvent_cell, vertex_cell]), mass, np.concatenate([solvent, vertex])


def sum_cells(model, cell, mass, velocity):
    """Sums over each cell in integers: momentum [cells, 3] in 2^-44, load [cells, 2] of members and mass in 2^-16."""
    momentum, load = np.zeros((model.cells, 3), np.int64), np.zeros((model.cells, 2), np.int64)
    np.add.at(momentum, cell, np.rint(mass[:, None] * 2.0**44 * velocity).astype(np.int64))
    np.add.at(load, cell, np.stack([np.ones(len(mass)), mass * 2**16], axis=1).astype(np.int64))
    return momentum, load


def mean(model, momentum, load):
    """Which cells collide, and their momentum over their mass; zeros where a cell does not collide."""
    active, center = load[:, 0] >= 2, np.zeros((model.cells, 3))
    center[active] = momentum[active] * (2.0**-44 / (load[active, 1:] * 2.0**-16))
    return active, center


def solve(model, step, momentum, load):
    """The same, and the axes of cells that collide."""
    (active, center), axis = mean(model, momentum, load), np.zeros((model.cells, 3))
    axis[active] = random.axes(model.seed, random.AXIS, step, np.flatnonzero(active))
    return active, center, axis


def relative_energy(model, cell, mass, velocity, center, load):
    """Twice the kinetic energy of each cell relative to its center, in integers of 2^-32 kT; 0 for a single member."""
    w = velocity - center[cell]
    relative = np.zeros(model.cells, np.int64)
    np.add.at(relative, cell, np.rint(2.0**32 * mass * dot(w, w)).astype(np.int64))
    return np.where(load[:, 0] >= 2, relative, 0)


def rescale(model, load, relative):
    """One factor for all cells that brings their relative energy to 3 (N - 1) kT/2 each on average."""
    active = load[:, 0] >= 2
    wanted, present = 0.0, 0.0
    for count, energy in zip(load[active, 0], relative[active]):
        wanted += 3.0 * (count - 1)
        present += energy * 2.0**-32
    return np.where(active, np.sqrt(wanted / present) if present > 0 else 1.0, 1.0)


def maxwell_boltzmann(model, step, load, relative):
    """A factor for each cell that draws its relative energy from the canonical distribution."""
    factor = np.ones(model.cells)
    for cell in np.flatnonzero((load[:, 0] >= 2) & (relative > 0)):
        energy = random.gamma(model.seed, step, cell, 1.5 * (load[cell, 0] - 1))
        factor[cell] = np.sqrt(energy / (0.5 * (relative[cell] * 2.0**-32)))
    return factor


def turn(model, w, n):
    """R w, right-handed about n."""
    along = dot(n, w)[:, None]
    if model.cosine == 0:
        return n * along + cross(n, w)
    return model.cosine * w + (1 - model.cosine) * along * n + model.sine * cross(n, w)


def rotate(model, cell, velocity, active, center, axis, factor):
    """New velocities of one kind of particle."""
    turned = center[cell] + factor[cell, None] * turn(model, velocity - center[cell], axis[cell])
    return np.where(active[cell, None], turned, velocity)


def draw(model, step):
    """The rule at-a: Maxwell velocities of the solvent and of the vertices, drawn anew."""
    solvent = random.drawn(model.seed, random.ANDERSEN_PARTICLE, step, np.arange(model.particles))
    vertex = random.drawn(model.seed, random.ANDERSEN_VERTEX, step, np.arange(len(model.mass)))
    return solvent, vertex * (1.0 / np.sqrt(model.mass))[:, None]


def give(cell, velocity, active, center, drawn):
    """New velocities of one kind of particle by the rule at-a."""
    return np.where(active[cell, None], center[cell] + drawn, velocity)


def swap_order(model, step, particles):
    return random.permutation(model.seed, random.VELOCITY_SWAP, 0, step, particles)
