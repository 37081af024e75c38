"""Streaming and the SRD collision, each step of it a function (docs/port/contract.md, "The operators")."""

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
    wanted = 3.0 * float(sum(int(count) - 1 for count in load[active, 0]))
    present = float(sum(int(energy) for energy in relative[active])) * 2.0**-32
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


def places(position, shift):
    """Places in their cells, relative to the middle of the cell, lattice units."""
    return (position + shift) % CELL - CELL // 2


def double(whole):
    """A whole number of up to 118 bits as a double, in the order of docs/port/flow.md, *The rule at+a*."""
    size = abs(whole)
    value = float(size >> 64) * 2.0**64 + float(size >> 32 & 0xFFFFFFFF) * 2.0**32 + float(size & 0xFFFFFFFF)
    return -value if whole < 0 else value


PAIRS = (0, 0), (1, 1), (2, 2), (1, 2), (2, 0), (0, 1)


def cell_moments(place, mass, momentum):
    """Of one cell: middle, beyond, second moments and angular momentum about the centre of mass; in whole numbers first.

    place: [members][3]; mass, in 2^-16 m, and momentum, in 2^-44, of each member: lists of int."""
    total = sum(mass)
    first = [sum(m * y[k] for m, y in zip(mass, place)) for k in range(3)]
    middle = [round(float(f) / float(total)) for f in first]
    rest = [f - total * x for f, x in zip(first, middle)]
    off, inverse = [float(r) for r in rest], 1.0 / float(total)
    second = []
    for a, b in PAIRS:
        moved = sum(m * y[a] * y[b] for m, y in zip(mass, place))
        moved += -middle[a] * rest[b] - middle[b] * rest[a] - total * middle[a] * middle[b]
        second.append(2.0**-96 * (double(moved) - inverse * off[a] * off[b]))
    beyond = np.array([2.0**-40 * inverse * x for x in off])
    whole = [sum(p[k] for p in momentum) for k in range(3)]
    about = []
    for k in range(3):
        a, b = (k + 1) % 3, (k + 2) % 3
        spin = sum(y[a] * p[b] - y[b] * p[a] for y, p in zip(place, momentum))
        about.append(2.0**-84 * double(spin - middle[a] * whole[b] + middle[b] * whole[a]))
    center = np.array(whole) * (2.0**-44 / (total * 2.0**-16))
    return middle, beyond, second, np.array(about) - cross(beyond, total * 2.0**-16 * center)


def moments(model, cell, mass, velocity, place, load):
    """The same of all cells that collide, zeros elsewhere: middle, beyond, second, angular."""
    found = np.zeros((model.cells, 3), np.int64), *(np.zeros((model.cells, n)) for n in (3, 6, 3))
    momentum = np.rint(mass[:, None] * 2.0**44 * velocity).astype(np.int64)
    heavy = (mass * 2**16).astype(np.int64)
    for k in np.flatnonzero(load[:, 0] >= 2):
        inside = cell == k
        for table, values in zip(found, cell_moments(*(x[inside].tolist() for x in (place, heavy, momentum)))):
            table[k] = values
    return found


def rate_of_line(second, trace, angular):
    """All members on one line, along the largest column of C."""
    xx, yy, zz, yz, zx, xy = second
    largest = max(range(3), key=lambda k: second[k])
    along = np.array(((xx, xy, zx), (xy, yy, yz), (zx, yz, zz))[largest])
    along = 1.0 / np.sqrt(dot(along, along)) * along
    return 1.0 / trace * (angular + -dot(along, angular) * along)


def spin_rate(second, angular):
    """Omega of Pi Omega = L, Pi = tr C - C; without the part along a line on which all members are."""
    trace = second[0] + second[1] + second[2]
    xx, yy, zz = second[1] + second[2], second[2] + second[0], second[0] + second[1]
    yz, zx, xy = -second[3], -second[4], -second[5]
    minors = yy * zz - yz * yz, zz * xx - zx * zx, xx * yy - xy * xy
    determinant = xx * minors[0] + xy * (yz * zx - xy * zz) + zx * (xy * yz - yy * zx)
    if not trace > 0:
        return np.zeros(3)
    if not determinant > 1e-12 * 2.0 * trace * (minors[0] + minors[1] + minors[2]):
        return rate_of_line(second, trace, angular)
    t21, t31 = xy / xx, zx / xx
    d2, below = yy - t21 * xy, yz - t21 * zx
    t32 = below / d2
    d3 = zz - t31 * zx - t32 * below
    b2 = angular[1] - t21 * angular[0]
    b3 = angular[2] - t31 * angular[0] - t32 * b2
    z = b3 / d3
    y = b2 / d2 - t32 * z
    return np.array([angular[0] / xx - t21 * y - t31 * z, y, z])


def spin(model, momentum, load, beyond, second, angular):
    """Which cells collide; the mean velocity at their middle, and the rate at which they turn."""
    (active, center), rate = mean(model, momentum, load), np.zeros((model.cells, 3))
    for k in np.flatnonzero(active):
        rate[k] = spin_rate(second[k].tolist(), angular[k])
    return active, center - cross(rate, beyond), rate


def give_spin(cell, velocity, place, active, center, rate, middle, drawn):
    """New velocities of one kind of particle by the rule at+a."""
    turned = center[cell] + cross(rate[cell], (place - middle[cell]) * 2.0**-40)
    return np.where(active[cell, None], turned + drawn, velocity)


def swap_order(model, step, particles):
    return random.permutation(model.seed, random.VELOCITY_SWAP, 0, step, particles)
