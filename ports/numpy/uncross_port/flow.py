"""The solvent between walls and in a sheared box (docs/port/flow.md, "Walls" and "Shear"). Such scenes have no fibers."""

from dataclasses import dataclass

import numpy as np

from . import elementary, random, solvent
from .lattice import CELL, UNIT, to_lattice

WALLS, SHEAR = 1, 2
PLANAR, PAPER, NONE = 0, 1, 2
LOWER, UPPER = 0, 1
LARGEST_PART = 256.0


@dataclass
class Flow:
    """Tables of the model that only such scenes have."""

    kind: int
    slip: bool
    fill: int
    intervals: int  # of a period; 0: the motion is constant
    early: int  # half steps by which collisions are early
    per_cell: float
    rate: float
    wall: np.ndarray  # [2, 3]
    cosine: np.ndarray  # [2 intervals]

    @property
    def walls(self):
        return self.kind == WALLS


def from_tables(tables):
    """None for a periodic box."""
    if not len(tables["boundary"]):
        return None
    kind, slip, fill, intervals, early = (int(x) for x in tables["boundary"][0])
    per_cell, rate = (float(x) for x in tables["flow"][0])
    return Flow(kind, bool(slip), fill, intervals, early, per_cell, rate, tables["wall"], tables["wave"][:, 0])


# --- motion


def wave(flow, half_intervals):
    return float(flow.cosine[half_intervals % (2 * flow.intervals)]) if flow.intervals else 1.0


def wall_velocity(flow, half_intervals):
    """[2, 3] after so many half intervals."""
    return wave(flow, half_intervals) * flow.wall


def during(interval):
    """The middle of an interval, in half intervals."""
    return 2 * interval + 1


def end_of(interval):
    return 2 * interval + 2


def interval_at(model, half_steps):
    return (half_steps + model.flow.early) // (2 * model.interval)


def shear_rate(flow, interval):
    return flow.rate * wave(flow, during(interval))


def slide(model, interval):
    """Lattice units by which the image slides in a half step, in Python's integers."""
    displacement = shear_rate(model.flow, interval) * float(model.box[1]) * 0.5 * model.dt
    return int(np.rint(displacement * 2.0**40))


def slide_until(model, half_steps):
    """From the beginning of interval 0."""
    each, period = 2 * model.interval, model.flow.intervals
    whole, rest = divmod(half_steps, each)
    if period:
        table = [slide(model, k) for k in range(period)]
        slid = whole // period * sum(table) + sum(table[: whole % period])
    else:
        slid = whole * slide(model, 0)
    return slid * each + rest * slide(model, whole)


def shear_offset(model, half_steps):
    early, edge = model.flow.early, int(model.box[0]) * CELL
    return (slide_until(model, half_steps + early) - slide_until(model, early)) % edge


# --- walls


def free_flight(model, x, v, time, axis):
    """Along an axis without walls."""
    a = model.acceleration[axis]
    return (x + to_lattice(v * time + 0.5 * a * time * time)) % (model.box[axis] * CELL), v + a * time


class Way:
    """A particle on its way from wall to wall: its velocity is sign v + change."""

    def __init__(self, model, wall, v):
        self.model, self.wall, self.v = model, wall, v
        self.sign, self.change, self.moved = 1.0, np.zeros(3), np.zeros(3)
        self.given = np.zeros((2, 3), np.int64)

    def go_on(self, time):
        a = self.model.acceleration
        self.moved = (self.moved + time * self.change) + 0.5 * time * time * a
        self.change = self.change + time * a

    def hit(self, which):
        if self.model.flow.slip:
            gain = np.array([0.0, -2.0 * self.sign * self.v[1], 0.0])
        else:
            w = self.wall[which]
            gain = 2.0 * (w - (self.change + self.sign * self.v))
            self.change = 2.0 * w - self.change
        self.given[which] += np.rint(2.0**44 * gain).astype(np.int64)
        self.sign = -self.sign

    def follow(self, y, d, time):
        """From wall to wall; y at the end."""
        edge, per_unit, left, down = int(self.model.box[1]) * CELL, time / float(abs(d)), abs(d), d < 0
        reach = y if down else edge - y
        while left > reach:
            self.go_on(per_unit * float(reach))
            self.hit(LOWER if down else UPPER)
            left, y, down, reach = left - reach, 0 if down else edge, not down, edge
        self.go_on(per_unit * float(left))
        return y - left if down else y + left


def rebound(model, wall, position, v, d, time):
    """The flight of a particle that hits a wall: position, velocity, and what each wall gave to it."""
    way = Way(model, wall, v)
    y = way.follow(int(position[1]), d, time)
    if model.flow.slip:
        (x, vx), (z, vz) = (free_flight(model, position[k], v[k], time, k) for k in (0, 2))
        return (x, y, z), (vx, v[1] * way.sign, vz), way.given
    ahead = time * (float(y - int(position[1])) / float(d))
    x, z = (
        (position[k] + to_lattice(v[k] * ahead + way.moved[k])) % (model.box[k] * CELL) for k in (0, 2)
    )
    return (x, y, z), way.change + way.sign * v, way.given


def wall_stream(model, wall, position, velocity, time):
    """New positions, velocities and what each wall gave: [2, 3] in 2^-44."""
    position, velocity, given = position.copy(), velocity.copy(), np.zeros((2, 3), np.int64)
    d = to_lattice(velocity[:, 1] * time)
    y, edge = position[:, 1] + d, model.box[1] * CELL
    outside = (y < 0) | (y > edge)
    ends = [(i, rebound(model, wall, position[i], velocity[i], int(d[i]), time)) for i in np.flatnonzero(outside)]
    for axis in (0, 2):
        position[:, axis], velocity[:, axis] = free_flight(model, position[:, axis], velocity[:, axis], time, axis)
    position[:, 1] = y
    for i, (x, v, gain) in ends:
        position[i], velocity[i] = x, v
        given += gain
    return position, velocity, given


def wall_cells(model, position, shift):
    """Rows of cells are not wrapped: there is one more of them than cells along y."""
    x, z = ((position[:, k] + shift[k]) % (model.box[k] * CELL) // CELL for k in (0, 2))
    row = (position[:, 1] + shift[1]) // CELL
    return (z * model.rows + row) * model.box[0] + x


def cut_cells(model):
    """Numbers of the cells that walls cut: [2, Lx Lz], the lower wall first."""
    z, x = np.meshgrid(np.arange(model.box[2]), np.arange(model.box[0]), indexing="ij")
    return np.stack([((z * model.rows + row) * model.box[0] + x).ravel() for row in (0, model.rows - 1)])


def poisson(mean, uniform):
    """By inversion."""
    term = float(elementary.exp(-mean))
    total, n = term, 0
    while uniform >= total and (n < mean or total + term > total):
        n += 1
        term *= mean / n
        total += term
    return n


def planar(model, step, cell, mean):
    parts = int(np.ceil(mean / LARGEST_PART))
    number = 0
    for part in range(parts):
        word = random.words(model.seed, random.PHANTOM_NUMBER, part // 2, step, cell)
        number += poisson(mean / parts, float(random.uniforms(word)[part % 2]))
    return float(number)


def paper(model, members):
    missing = model.flow.per_cell - members
    return float(np.rint(missing * 2.0**16)) * 2.0**-16 if missing > 0 else 0.0


def fill(model, step, shift, wall, momentum, load):
    """Virtual particles [2 Lx Lz, 4] of number and velocity; sums with them, as one member of each cell."""
    flow, rows, momentum, load = model.flow, [], momentum.copy(), load.copy()
    s = float(shift[1]) * UNIT
    for which, beyond in ((LOWER, s), (UPPER, 1.0 - s)):
        for cell in cut_cells(model)[which]:
            number = 0.0
            if not flow.slip and flow.fill == PLANAR:
                number = planar(model, step, cell, flow.per_cell * beyond)
            elif not flow.slip and flow.fill == PAPER:
                number = paper(model, int(load[cell, 0]))
            if number == 0:
                rows.append(np.zeros(4))
                continue
            normal = random.normals(model.seed, random.PHANTOM_VELOCITY, step, [cell])[:, 0]
            velocity = wall[which] + (1.0 / np.sqrt(number)) * normal
            rows.append(np.array([number, *velocity]))
            momentum[cell] += np.rint(number * 2.0**44 * velocity).astype(np.int64)
            load[cell] += np.array([1, int(number * 2.0**16)])
    return np.array(rows), momentum, load


def account(model, filled, active, center, axis, factor):
    """What virtual particles give to the others: [2, 3] in 2^-44."""
    given = np.zeros((2, 3), np.int64)
    for which, cells in enumerate(cut_cells(model)):
        for row, cell in zip(np.split(filled, 2)[which], cells):
            number, old = row[0], row[1:]
            if number == 0 or not active[cell]:
                continue
            turned = solvent.turn(model, (old - center[cell])[None], axis[cell][None])[0]
            new = center[cell] + factor[cell] * turned
            gain = -(number * (new - old))
            given[which] += np.rint(2.0**44 * gain).astype(np.int64)
    return given


def rescale_layers(model, load, relative, filled):
    """A factor for each row of cells along y."""
    virtual = np.zeros(model.cells)
    if len(filled):
        virtual[cut_cells(model).ravel()] = filled[:, 0]
    active = (load[:, 0] >= 2).reshape(model.box[2], model.rows, model.box[0])
    number = np.arange(model.cells).reshape(active.shape)
    factor = np.ones(model.cells)
    for row in range(model.rows):
        wanted, present = 0.0, 0
        cells = number[:, row][active[:, row]]
        for cell in cells:
            mass = load[cell, 1] * 2.0**-16
            freedoms = load[cell, 0] - 1.0
            if virtual[cell]:
                freedoms -= (mass - virtual[cell]) / mass
            wanted += 3.0 * freedoms
            present += int(relative[cell])
        if present > 0:
            factor[cells] = np.sqrt(wanted / (float(present) * 2.0**-32))
    return factor


# --- shear


def shear_stream(model, offset, speed, position, velocity, time):
    d = to_lattice(velocity[:, 1] * time)
    position, velocity, y, edge = position.copy(), velocity.copy(), position[:, 1] + d, model.box[1] * CELL
    for axis in (0, 2):
        position[:, axis], velocity[:, axis] = free_flight(model, position[:, axis], velocity[:, axis], time, axis)
    image = y // edge
    position[:, 1] = y - image * edge
    position[:, 0] = (position[:, 0] - image * offset) % (model.box[0] * CELL)
    velocity[:, 0] = np.where(image != 0, velocity[:, 0] - image * speed, velocity[:, 0])
    return position, velocity


def entered(model, shift, position):
    return position[:, 1] + shift[1] >= model.box[1] * CELL


def enter(model, shift, offset, speed, position, velocity):
    """Those beyond the boundary take place and velocity of their image."""
    position, velocity, who = position.copy(), velocity.copy(), entered(model, shift, position)
    position[who, 0] = (position[who, 0] - offset) % (model.box[0] * CELL)
    velocity[who, 0] -= speed
    return position, velocity


def leave(model, shift, offset, speed, position, velocity):
    """And take back their own after the collision."""
    position, velocity, who = position.copy(), velocity.copy(), entered(model, shift, position)
    position[who, 0] = (position[who, 0] + offset) % (model.box[0] * CELL)
    velocity[who, 0] += speed
    return position, velocity


def affine_kick(model, change, position, velocity):
    velocity = velocity.copy()
    velocity[:, 0] += (position[:, 1] - model.box[1] * CELL // 2) * UNIT * change
    return velocity
