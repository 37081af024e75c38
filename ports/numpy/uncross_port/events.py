"""Drifts of all vertices at once: bonds that touch exchange momentum at the time of contact.

When bonds touch is decided in Python's integers. Doubles describe a contact once found, and suggest planes to try.
"""

import math

import numpy as np

from . import tubes
from .lattice import CELL, UNIT, closest, cross, dot

TICKS = 65536
MOST_CONTACTS = 1000
NONE, FULL, SOFTENED = 0, 1, 2


# --- integers: vectors are lists of three ---


def idot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def icross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def plus(a, b):
    return [a[0] + b[0], a[1] + b[1], a[2] + b[2]]


def minus(a, b):
    return [a[0] - b[0], a[1] - b[1], a[2] - b[2]]


def sign(x):
    return (x > 0) - (x < 0)


def all_on_one_side(values):
    return all(x > 0 for x in values) or all(x < 0 for x in values)


# --- the search ---


def at_tick(pair, tick):
    """p, q and w of a pair (p, q, w and their rates) at a tick."""
    return [[x + tick * rate for x, rate in zip(pair[k], pair[3 + k])] for k in range(3)]


def coefficients(start, end):
    """(i): of the volume over an interval, from its two ends; two of them times 3."""
    (p, q, w), (p_end, q_end, w_end) = start, end
    n, n_end, n_p, n_q = icross(p, q), icross(p_end, q_end), icross(p_end, q), icross(p, q_end)
    second = idot(n_p, w) + idot(n_q, w) + idot(n, w_end)
    third = idot(n_end, w) + idot(n_p, w_end) + idot(n_q, w_end)
    return [idot(n, w), second, third, idot(n_end, w_end)]


def corners(start, end):
    """(ii): the eight points."""
    points = []
    for p, q, w in (start, end):
        points += [w, plus(w, q), minus(w, p), minus(plus(w, q), p)]
    return points


def suggested_plane(start):
    """A direction in which the bonds are apart: any will do, a good one saves time."""
    p, q, w = (np.array(v, float) * UNIT for v in start)
    gap = closest(p, q, w)[2]
    size = abs(gap).max()
    return [int(x) for x in gap / size * 2.0**40] if size > 0 else [0, 0, 0]


def line_separates(points, n):
    """Points of one plane through the origin, with normal n: does a line have all strictly on one side?"""

    def is_first(a):
        for c in points:
            if c is a:
                continue
            side = idot(icross(a, c), n)
            if side < 0 or (side == 0 and idot(a, c) <= 0):
                return False
        return True

    return any(any(a) and is_first(a) for a in points)


def plane_separates(points):
    """Does a plane through the origin have all points strictly on one side?"""
    for k, a in enumerate(points):
        for b in points[:k]:
            n = icross(a, b)
            if not any(n):
                continue
            sides = [sign(idot(n, c)) for c in points]
            if min(sides) * max(sides) >= 0:
                return line_separates([c for c, side in zip(points, sides) if side == 0], n)
    return all(idot(points[0], c) > 0 for c in points) and not any(any(icross(points[0], c)) for c in points)


def excluded(start, end, single):
    """Is an interval certainly without a contact? Of a single tick: by (i) and (ii), exactly."""
    if all_on_one_side(coefficients(start, end)):
        return True
    points = corners(start, end)
    if any(all(idot(plane, point) > 0 for point in points) for plane in (suggested_plane(start), suggested_plane(end))):
        return True
    return single and plane_separates(points)


def first_contact(pair, start):
    """The first tick from `start` on that is not excluded; TICKS if all are."""
    if not any(any(rate) for rate in pair[3:]):
        return TICKS
    intervals = [(start, TICKS)]
    while intervals:
        first, last = intervals.pop()
        if excluded(at_tick(pair, first), at_tick(pair, last), last - first == 1):
            continue
        if last - first == 1:
            return first
        middle = first + (last - first) // 2
        intervals += [(middle, last), (first, middle)]
    return TICKS  # none


# --- a contact ---


def levers(s, t):
    return [1 - s, s, t - 1, -t]


def normal_of(volume, p, q, gap, velocity):
    """The direction of the push, from the first bond to the other. velocity: of the first one's point of contact."""
    normal = cross(p, q)
    approach = dot(normal, velocity)
    if volume < 0 or (volume == 0 and approach < 0):
        normal, approach = -normal, -approach
    parallel = not dot(normal, normal) > 1e-24 * dot(p, p) * dot(q, q)
    if parallel or (volume == 0 and not approach > 0):
        normal = gap
        if not dot(gap, gap) > 0:
            normal = velocity + -dot(velocity, q) / dot(q, q) * q
    return 1 / np.sqrt(dot(normal, normal)) * normal


def rebound(a, h):
    """Speed after the contact, of the approach a; and which kind of answer it is."""
    straight, size = a + 2 * h, abs(h)
    if straight < 0.2 * a:
        return a * size / (size + 1.6 * a), SOFTENED
    if 0.2 * straight > a:
        return a * size / (size - 1.6 * a), SOFTENED
    return straight, FULL


def impulse(mass, velocity, force, s, t, normal, tau):
    """Of the four ends: kind of answer, momentum, and [4, 3] velocities after it."""
    lever, inverse_mass = levers(s, t), [1 / m for m in mass]
    approach, pull, compliance = 0.0, 0.0, 0.0
    for k in range(4):
        approach += lever[k] * dot(velocity[k], normal)
        pull += lever[k] * (dot(force[k], normal) * inverse_mass[k])
        compliance += lever[k] * lever[k] * inverse_mass[k]
    if not approach > 0:
        return NONE, 0.0, velocity
    speed, answer = rebound(approach, tau * pull)
    momentum = (approach + speed) / compliance
    after = [velocity[k] + -lever[k] * momentum * inverse_mass[k] * normal for k in range(4)]
    return answer, momentum, np.array(after)


# --- the force on one vertex ---


class Bond:
    """A bond at the time of a contact; of a missing one the pull is zero."""

    def __init__(self, model, place, first, last):
        self.exists = first >= 0 and last >= 0
        self.pull = np.zeros(3)
        if self.exists:
            vector = (place(last) - place(first)) * UNIT
            length = np.sqrt(dot(vector, vector))
            self.inverse = 1 / length
            self.unit = self.inverse * vector
            spring, rest = model.spring[first], model.bond_length[first]
            self.pull = spring * vector if rest == 0 else spring * (length - rest) * self.unit


def bend(bending, before, after):
    """Forces of a bend on the vertices before and after its own."""
    cosine = dot(before.unit, after.unit)
    return (
        -bending * before.inverse * (after.unit - cosine * before.unit),
        bending * after.inverse * (before.unit - cosine * after.unit),
    )


def force_on(model, vertex, place):
    """The force on a vertex, with all vertices at place(vertex), in lattice units."""
    bending = model.bending[vertex]
    before_it, after_it = model.prev[vertex], model.next[vertex]
    before, after = Bond(model, place, before_it, vertex), Bond(model, place, vertex, after_it)
    force = (model.constant_force[vertex] - before.pull) + after.pull
    if bending == 0:
        return force
    if before.exists:
        far = Bond(model, place, model.prev[before_it], before_it)
        if far.exists:
            force = force + bend(bending, far, before)[1]
    if before.exists and after.exists:
        on_before, on_after = bend(bending, before, after)
        force = force - (on_before + on_after)
    if after.exists:
        far = Bond(model, place, after_it, model.next[after_it])
        if far.exists:
            force = force + bend(bending, after, far)[0]
    return force


# --- a drift ---


class Drift:
    """All vertices in flight: at tick T vertex v is at position[v] + T rate[v]."""

    def __init__(self, model, position, velocity, time, start):
        self.model, self.time, self.start = model, time, start
        self.position, self.velocity = position.copy(), velocity.copy()
        self.origin = position
        self.rate = self.rates(velocity)
        self.contacts = np.zeros(len(position), int)
        self.cluster = np.zeros(len(position), int)  # 0: of none
        self.clusters = 0
        self.events = {}  # (bond, other, image): tick
        self.rows, self.hits = [], []

    def rates(self, velocity):
        return np.rint(self.time * velocity * 2.0**24).astype(np.int64)

    def place(self, vertex, tick):
        return self.position[vertex] + tick * self.rate[vertex]

    def ends(self, bond):
        return bond, self.model.next[bond]

    def pair(self, bond, other, image):
        """p, q, w and their rates."""
        (i, j), (k, l) = self.ends(bond), self.ends(other)
        r, u = self.position, self.rate
        shift = np.array(image) * self.model.box * CELL
        vectors = r[j] - r[i], r[l] - r[k], (r[k] + shift) - r[i], u[j] - u[i], u[l] - u[k], u[k] - u[i]
        return [vector.tolist() for vector in vectors]

    def reach(self, bond, other):
        """Distance of the axes at a contact; 0: both are thin lines."""
        return 0 if self.model.radius is None else int(self.model.radius[bond] + self.model.radius[other])

    def never_touch(self, bond, other, image):
        """Of thick fibers; of thin ones neighbors() leaves out all images of bonds that share a vertex."""
        model = self.model
        if model.radius is None or any(image):
            return bond == other
        if set(self.ends(bond)) & set(self.ends(other)):
            return True
        between = abs(bond - other)
        if model.fiber[bond] != model.fiber[other]:
            return False
        members = np.flatnonzero(model.fiber == model.fiber[bond])
        if (model.next[members] >= 0).all():  # a ring
            between = min(between, len(members) - between)
        return between < model.blind[bond]

    def neighbors(self, bond, tick):
        """(other bond, image) of all that may come near from a tick on: boxes around their paths overlap."""
        bonds, following = self.model.bonds, self.model.next
        ends = [self.place(v, t) for v in (bonds, following[bonds]) for t in (tick, TICKS)]
        low, high = np.min(ends, axis=0), np.max(ends, axis=0)
        mine = np.flatnonzero(bonds == bond)[0]
        if self.model.radius is not None:
            pad = self.model.radius[bonds][:, None] + 2**24
            low, high = low - pad, high + pad
        edge = self.model.box * CELL
        first, last = -((high - low[mine]) // edge), (high[mine] - low) // edge
        shared = np.isin(bonds, self.ends(bond)) | np.isin(following[bonds], self.ends(bond))
        if self.model.radius is not None:
            shared[:] = False
        for row in np.flatnonzero((first <= last).all(axis=1) & ~shared):
            ranges = [range(a, b + 1) for a, b in zip(first[row].tolist(), last[row].tolist())]
            for image in ((i, j, k) for i in ranges[0] for j in ranges[1] for k in ranges[2]):
                if not self.never_touch(bond, int(bonds[row]), image):
                    yield int(bonds[row]), image

    def search_pair(self, bond, other, image, tick):
        if other < bond:
            bond, other, image = other, bond, tuple(-k for k in image)
        reach, found = self.reach(bond, other), TICKS
        if tick < TICKS and reach:
            found = tubes.first_contact(self.pair(bond, other, image), reach, tick)
        elif tick < TICKS:
            found = first_contact(self.pair(bond, other, image), tick)
        if found < TICKS:
            self.events[bond, other, image] = found

    def search(self, changed, tick):
        """Searches all pairs with one of these bonds, each once."""
        changed = sorted(changed)
        for bond in changed:
            for other, image in self.neighbors(bond, tick):
                if other not in changed or other > bond:
                    self.search_pair(bond, other, image, tick)

    def search_again(self, vertices, tick):
        """The flights of these vertices have bent."""
        changed = {int(b) for v in vertices for b in (v, self.model.prev[v]) if b >= 0 and self.model.next[b] >= 0}
        self.events = {key: found for key, found in self.events.items() if not changed & set(key[:2])}
        self.search(changed, tick)

    def steer(self, vertices, rates, tick):
        for vertex, rate in zip(vertices, rates):
            self.position[vertex] = self.place(vertex, tick) - tick * rate
            self.rate[vertex] = rate

    def answer(self, bond, other, image, tick):
        p, q, w = at_tick(self.pair(bond, other, image), tick)
        volume = idot(icross(p, q), w)
        p, q, w = (np.array(v) * UNIT for v in (p, q, w))
        thick = self.reach(bond, other) > 0
        s, t, gap = tubes.touch(p, q, w) if thick else closest(p, q, w)
        if not thick and volume == 0 and np.sqrt(dot(gap, gap)) < 2.0**-42:
            del self.events[bond, other, image]
            self.search_pair(bond, other, image, tick + 1)
            return
        four = [*self.ends(bond), *self.ends(other)]
        velocity = np.zeros(3)
        for lever, vertex in zip(levers(s, t), four):
            velocity = velocity + lever * self.velocity[vertex]
        normal = tubes.direction(gap) if thick else normal_of(volume, p, q, gap, velocity)
        if self.cluster[four].any() or (self.contacts[four] >= MOST_CONTACTS).any():
            self.make_rigid(four, tick)
            return
        force = [force_on(self.model, vertex, lambda v: self.place(v, tick)) for vertex in four]
        tau = self.start + self.time * (tick / TICKS)
        mass = self.model.mass[four]
        answer, momentum, after = impulse(mass, self.velocity[four], force, s, t, normal, tau)
        if answer == NONE:
            self.make_rigid(four, tick)
            return
        self.velocity[four] = after
        self.contacts[four] += 1
        self.rows.append([bond, other, *image, tick])
        self.hits.append([s, t, *normal, momentum])
        self.steer(four, self.rates(self.velocity[four]), tick)
        self.search_again(four, tick)

    def make_rigid(self, four, tick):
        members = [vertex for vertex in four if self.cluster[vertex]]
        total = self.rate[four].sum(axis=0)
        rate = self.rate[members[0]].copy() if members else np.sign(total) * (abs(total) // 4)
        joined = {int(self.cluster[vertex]) for vertex in members}
        everyone = sorted({int(v) for v in four} | {int(v) for v in np.flatnonzero(np.isin(self.cluster, list(joined)))})
        self.clusters += 1
        self.cluster[everyone] = self.clusters
        self.steer(everyone, [rate] * len(everyone), tick)
        self.search_again(everyone, tick)

    def run(self):
        self.search({int(bond) for bond in self.model.bonds}, 0)
        while self.events:
            tick, bond, other, image = min((tick, *key) for key, tick in self.events.items())
            self.answer(bond, other, image, tick)
        self.position += TICKS * self.rate


def drift(model, position, velocity, time, start):
    """Position and velocity after a drift, rows of events and of hits."""
    flight = Drift(model, position, velocity, time, start)
    if model.forbidden:
        flight.run()
    else:
        flight.position += TICKS * flight.rate
    return (
        flight.position,
        flight.velocity,
        np.array(flight.rows, np.int64).reshape(-1, 6),
        np.array(flight.hits, float).reshape(-1, 6),
    )
