"""Dumbbells (docs/port/dumbbells.md, "Dumbbells"): pairs of particles with a spring, between collisions."""

import math
from dataclasses import dataclass

import numpy as np

from . import elementary, flow, random
from .lattice import CELL, UNIT, to_lattice

TURNS_PER_RADIAN = float.fromhex("0x1.45f306dc9c883p-3")
NEAR_LOWER, BETWEEN, NEAR_UPPER = 0, 1, 2


@dataclass
class Dumbbells:
    """Tables of the model that only such scenes have."""

    number: int
    spring: float
    frequency: float
    depth: float
    range: float

    @property
    def reach(self):
        """Of the potential of the walls; 0: there is none."""
        return self.range / math.sqrt(self.spring) if self.depth else 0.0

    @property
    def pull(self):
        """The acceleration of a center within the reach: a dumbbell has the mass 2."""
        return 0.5 * self.depth / self.reach if self.depth else 0.0


def from_tables(tables):
    """None without dumbbells."""
    if not len(tables["dumbbells"]):
        return None
    return Dumbbells(int(tables["dumbbells"][0, 0]), *(float(x) for x in tables["spring"][0]))


def rounded(x):
    """Of a length in a0, in lattice units."""
    return round(x * 2.0**40)


# --- one flight without hits


def swing(frequency, time):
    """Factors of r and u in the change of r/2, and of r and u in u/2 afterwards."""
    half_cosine, half_sine = (float(x) for x in elementary.circle_turns(0.5 * frequency * time * TURNS_PER_RADIAN))
    sine, square = 2.0 * half_sine * half_cosine, half_sine * half_sine
    return -square, 0.5 * sine / frequency, -0.5 * frequency * sine, 0.5 - square


class Pair:
    """Two particles: positions [particle][axis] in lattice units, not folded, and the vector, as Python's integers."""

    def __init__(self, position, velocity, vector):
        self.at = [[int(x) for x in row] for row in position]
        self.v = [[float(x) for x in row] for row in velocity]
        self.apart = [int(x) for x in vector]

    def fly(self, axis, turn, acceleration, time):
        return_r, advance_u, pull_r, keep_u = turn
        first, second = self.v[0][axis], self.v[1][axis]
        r, u, mean = self.apart[axis] * UNIT, first - second, 0.5 * (first + second)
        center = mean * time + 0.5 * acceleration * time * time
        half = return_r * r + advance_u * u
        moves = rounded(center + half), rounded(center - half)
        change, after = pull_r * r + keep_u * u, mean + acceleration * time
        self.at[0][axis] += moves[0]
        self.at[1][axis] += moves[1]
        self.apart[axis] += moves[0] - moves[1]
        self.v[0][axis], self.v[1][axis] = after + change, after - change

    def folded(self, model, axes):
        for row in self.at:
            for k in axes:
                row[k] %= int(model.box[k]) * CELL
        return self


def fly_all(model, given, time, one):
    """Each dumbbell by one(pair); independent particles are left as they are. Position, velocity, vector."""
    position, velocity, vector = (table.copy() for table in given)
    for k in range(model.dumbbells.number):
        rows = slice(2 * k, 2 * k + 2)
        pair = Pair(position[rows], velocity[rows], vector[k])
        one(pair)
        position[rows], velocity[rows], vector[k] = pair.at, pair.v, pair.apart
    return position, velocity, vector


def alone(model):
    """Particles that are in no dumbbell."""
    return slice(2 * model.dumbbells.number, model.particles)


def stream(model, given, time, fly_others):
    """In a periodic box. fly_others: the flight of independent particles."""
    a, turn = model.acceleration, swing(model.dumbbells.frequency, time)

    def one(pair):
        for axis in range(3):
            pair.fly(axis, turn, float(a[axis]), time)
        pair.folded(model, range(3))

    position, velocity, vector = fly_all(model, given, time, one)
    rest = alone(model)
    position[rest], velocity[rest] = fly_others(model, position[rest], velocity[rest], time)
    return position, velocity, vector


# --- sheared


def shear_stream(model, begin, end, speed, given, time):
    """begin, end: offset of the image above at both ends of the flight."""
    a, turn = model.acceleration, swing(model.dumbbells.frequency, time)
    edge, height = int(model.box[0]) * CELL, int(model.box[1]) * CELL

    def change_image(pair, sign, offset):
        apart = pair.at[0][1] - pair.apart[1] - pair.at[1][1]
        image = sign * (apart // height)
        if image:
            pair.at[1][0] = (pair.at[1][0] + image * offset) % edge
            pair.v[1][0] += image * speed

    def one(pair):
        change_image(pair, 1, begin)
        for axis in range(3):
            pair.fly(axis, turn, float(a[axis]) if axis != 1 else 0.0, time)
        pair.folded(model, (0, 2))
        change_image(pair, -1, end)
        for i in range(2):
            image = pair.at[i][1] // height
            pair.at[i][1] -= image * height
            pair.at[i][0] = (pair.at[i][0] - image * end) % edge
            if image:
                pair.v[i][0] -= image * speed

    position, velocity, vector = fly_all(model, given, time, one)
    rest = alone(model)
    position[rest], velocity[rest] = flow.shear_stream(model, end, speed, position[rest], velocity[rest], time)
    return position, velocity, vector


# --- between walls


class Course:
    """A dumbbell along y between two events."""

    def __init__(self, model, pair, acceleration):
        self.frequency, self.edge = model.dumbbells.frequency, float(model.box[1])
        self.middle = 0.5 * (float(pair.at[0][1]) + float(pair.at[1][1])) * UNIT
        self.velocity, self.acceleration = 0.5 * (pair.v[0][1] + pair.v[1][1]), acceleration
        self.r, self.u = pair.apart[1] * UNIT, pair.v[0][1] - pair.v[1][1]
        w = self.frequency
        self.most = abs(acceleration) + 0.5 * w * math.sqrt(w * w * self.r * self.r + self.u * self.u)

    def height(self, particle, wall, t):
        """Above a wall, and its rate."""
        return_r, advance_u, pull_r, keep_u = swing(self.frequency, t)
        sign, a = (1.0, -1.0)[particle], self.acceleration
        half = (0.5 + return_r) * self.r + advance_u * self.u
        half_rate = pull_r * self.r + keep_u * self.u
        y = self.middle + self.velocity * t + 0.5 * a * t * t + sign * half
        rate = self.velocity + a * t + sign * half_rate
        return (y, rate) if wall == flow.LOWER else (self.edge - y, -rate)

    def time_of_hit(self, particle, wall, left):
        """`left` if the wall is not reached until then."""
        least, t = 2.0**-44 * left, 0.0
        while t < left:
            f, rate = self.height(particle, wall, t)
            if f <= UNIT and rate < 0.0:
                return t
            f = max(f, 0.0)
            root = math.sqrt(rate * rate + 2.0 * self.most * f)
            if rate < 0.0:
                free = 2.0 * f / (root - rate)
            else:
                free = (rate + root) / self.most if self.most > 0.0 else left
            t += max(free, least)
        return left

    def exit(self, region, reach, pull, left):
        """Time at which the center leaves its region, and the region after it."""
        if reach == 0.0:
            return left, region
        t = left
        if region == BETWEEN:
            after = NEAR_LOWER if self.velocity < 0.0 else NEAR_UPPER
            border = reach if self.velocity < 0.0 else self.edge - reach
            if self.velocity:
                t = (border - self.middle) / self.velocity
        else:
            after, lower = BETWEEN, region == NEAR_LOWER
            away = self.velocity if lower else -self.velocity
            to_go = reach - (self.middle if lower else self.edge - self.middle)
            square = away * away - 2.0 * pull * to_go
            if away > 0.0 and square >= 0.0:
                t = 2.0 * to_go / (away + math.sqrt(square))
        return (max(t, 0.0), after) if t < left else (left, region)


class Slit:
    """Flights between walls, and what the walls give: [2, 3] in 2^-44."""

    def __init__(self, model, wall, time):
        self.model, self.wall, self.time = model, wall, time
        self.reach, self.pull = model.dumbbells.reach, model.dumbbells.pull
        self.given = np.zeros((2, 3), np.int64)
        self.hits = 0

    def give(self, wall, gain):
        self.given[wall] += np.rint(2.0**44 * np.asarray(gain)).astype(np.int64)

    def region(self, middle):
        if middle < self.reach:
            return NEAR_LOWER
        return NEAR_UPPER if middle > float(self.model.box[1]) - self.reach else BETWEEN

    def hit(self, pair, particle, wall):
        v, w = pair.v[particle], [float(x) for x in self.wall[wall]]
        if self.model.flow.slip:
            after = [v[0], -v[1], v[2]]
        else:
            after = [2.0 * w[0] - v[0], -v[1], 2.0 * w[2] - v[2]]
        self.give(wall, [new - old for new, old in zip(after, v)])
        pair.v[particle] = after
        pair.at[particle][1] = 0 if wall == flow.LOWER else int(self.model.box[1]) * CELL
        pair.apart[1] = pair.at[0][1] - pair.at[1][1]
        self.hits += 1

    def first_hit(self, course, left):
        """Its time, particle and wall; time `left` if there is none."""
        first = left, None, None
        for particle in (0, 1):
            for wall in (flow.LOWER, flow.UPPER):
                t = course.time_of_hit(particle, wall, first[0])
                if t < first[0]:
                    first = t, particle, wall
        return first

    def follow(self, pair):
        a, left = self.model.acceleration, self.time
        region = self.region(0.5 * float(pair.at[0][1] + pair.at[1][1]) * UNIT)
        while left > 0.0:
            along = (-self.pull, 0.0, self.pull)[region]
            course = Course(self.model, pair, along)
            t, particle, wall = self.first_hit(course, left)
            out, after = course.exit(region, self.reach, self.pull, t)
            if out < t:
                t, particle, region = out, None, after
            turn = swing(self.model.dumbbells.frequency, t)
            for axis, acceleration in enumerate((float(a[0]), along, float(a[2]))):
                pair.fly(axis, turn, acceleration, t)
            if along:
                self.give(flow.LOWER if along < 0.0 else flow.UPPER, [0.0, 2.0 * along * t, 0.0])
            if particle is not None:
                self.hit(pair, particle, wall)
            left -= t
        for row in pair.at:
            row[1] = min(max(row[1], 0), int(self.model.box[1]) * CELL)
        pair.apart[1] = pair.at[0][1] - pair.at[1][1]
        pair.folded(self.model, (0, 2))


def wall_stream(model, wall, given, time):
    """New positions, velocities, vectors, and what each wall gave."""
    slit, rest = Slit(model, wall, time), alone(model)
    position, velocity, vector = fly_all(model, given, time, slit.follow)
    position[rest], velocity[rest], more = flow.wall_stream(model, wall, position[rest], velocity[rest], time)
    return position, velocity, vector, slit.given + more


# --- start


def wall_energy(model, y):
    own, near = model.dumbbells, min(y, float(model.box[1]) - y)
    return -own.depth * (1.0 - near / own.reach) if own.depth and near < own.reach else 0.0


def uniform_place(word, cells):
    """Of an integer of 64 bits."""
    return (cells * (word >> 40) >> 24) * CELL + (word & (CELL - 1))


def draw(model, number):
    """Center in lattice units, and vector in a0."""
    own, height = model.dumbbells, float(model.box[1])
    length, attempt = 1.0 / math.sqrt(own.spring), 0
    while True:
        place, spring = (
            [random.words(model.seed, purpose, 2 * attempt + k, 0, number) for k in (0, 1)]
            for purpose in (random.DUMBBELL_CENTER, random.DUMBBELL_VECTOR)
        )
        (x, y), (z, _) = ([int(n) for n in random.integers(word)] for word in place)
        center = [uniform_place(n, int(cells)) for n, cells in zip((x, y, z), model.box)]
        a, b = (random.normal_pair(word) for word in spring)
        apart = [length * float(n) for n in (a[0], a[1], b[0])]
        if model.flow is None or not model.flow.walls:
            return center, apart
        at, half = center[1] * UNIT, 0.5 * abs(apart[1]) + 2.0 * UNIT
        energy = wall_energy(model, at) + max(own.depth, 0.0)
        chance = float(random.uniforms(place[1])[1])
        if at - half >= 0.0 and at + half <= height and chance < float(elementary.exp(-energy)):
            return center, apart
        attempt += 1


def start(model):
    """Positions of the particles of dumbbells, and the vectors."""
    position, vector = [], []
    walls = model.flow is not None and model.flow.walls
    for number in range(model.dumbbells.number):
        center, apart = draw(model, number)
        pair = [[x + rounded(sign * r) for x, r in zip(center, apart)] for sign in (0.5, -0.5)]
        vector.append([x - y for x, y in zip(*pair)])
        for row in pair:
            edge = [int(cells) * CELL for cells in model.box]
            inside = [x % e for x, e in zip(row, edge)]
            position.append([inside[0], row[1] if walls else inside[1], inside[2]])
    return np.array(position, np.int64), np.array(vector, np.int64)
