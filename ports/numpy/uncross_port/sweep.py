"""Trial moves of the vertices, one at a time, and what happens where a bond would cross another.

Whether a move crosses is decided in Python's integers, which are exact. Doubles only describe a crossing once found.
"""

from dataclasses import dataclass

import numpy as np

from .lattice import CELL, UNIT, cross, dot, to_lattice

FAR = 64  # boxes
HOME = (0, 0, 0)  # the image that is the bond itself


@dataclass
class Hit:
    """A crossing of one move. In the order of its fields it sorts as docs/conventions.md says: time, then numbers."""

    time: float
    moving: int
    standing: int
    image: tuple
    pivot: int
    s: float
    s_standing: float
    normal: np.ndarray

    def key(self):
        return self.time, self.moving, self.standing, self.image


def volume(p, q, r):
    """(p x q) . r of integer vectors, exactly."""
    return (
        (p[1] * q[2] - p[2] * q[1]) * r[0] + (p[2] * q[0] - p[0] * q[2]) * r[1] + (p[0] * q[1] - p[1] * q[0]) * r[2]
    )


def difference(p, q):
    return [x - y for x, y in zip(p, q)]


def crosses(start, end, pivot, a, b, flip):
    """Does the bond from the moving vertex (start to end) to the pivot cross the bond a b? Points are lists of integers."""

    def positive(value):
        return value > 0 or (value == 0 and not flip)

    bond, arm = difference(b, a), difference(pivot, a)
    from_a, to_a = difference(start, a), difference(end, a)
    side = positive(volume(bond, arm, from_a))
    if positive(volume(bond, arm, to_a)) == side:
        return False
    if (volume(bond, from_a, to_a) >= 0) != side:
        return False
    move, leg = difference(end, start), difference(pivot, start)
    return (volume(move, leg, difference(a, start)) >= 0) != (volume(move, leg, difference(b, start)) >= 0)


def in_doubles(p, q, r):
    """(p x q) . r in doubles of a0^3, and whether they can tell its sign."""
    p, q, r = (np.array(v) * UNIT for v in (p, q, r))
    value, size = dot(cross(p, q), r), np.abs([p, q, r])
    (px, py, pz), (qx, qy, qz), (rx, ry, rz) = size
    bound = rx * (py * qz + pz * qy) + ry * (pz * qx + px * qz) + rz * (px * qy + py * qx)
    return value, abs(value) > 16 * 2.0**-53 * bound


def rounded_volume(p, q, r):
    """The same; where doubles cannot tell, the exact integer, rounded."""
    value, certain = in_doubles(p, q, r)
    if certain:
        return value
    exact = volume(p.tolist(), q.tolist(), r.tolist())
    high, low = divmod(abs(exact), 2**64)
    rounded = np.float64((float(high) * 2.0**64 + float(low)) * UNIT**3)
    return rounded if exact >= 0 else -rounded


def excluded(model, vertex, moving):  # pylint: disable=unused-argument
    """Bonds (by their number) that the moving bond of a vertex is not tested against, and neither against their images."""
    ends = (moving, model.next[moving])
    return np.isin(model.bonds, ends) | np.isin(model.next[model.bonds], ends)


def linked(model, vertex):
    """Bonds that share a vertex with either bond of the moving vertex: the paper tests only their images."""
    if model.exclusion_paper:
        bonds = [bond for bond in (model.prev[vertex], vertex) if bond >= 0 and model.next[bond] >= 0]
        ends = [end for bond in bonds for end in (bond, model.next[bond])]
        return {int(bond) for end in ends for bond in (model.prev[end], end) if bond >= 0 and model.next[bond] >= 0}
    return set()


def partners(model, position, start, end, pivot, skip):
    """(standing bond, image) of every bond whose bounding box overlaps that of the swept triangle."""
    a, b = position[model.bonds], position[model.next[model.bonds]]
    corners = np.stack([start, end, pivot])
    edge = model.box * CELL
    lowest = -((np.maximum(a, b) - corners.min(axis=0)) // edge)  # smallest image that reaches the triangle from below
    highest = (corners.max(axis=0) - np.minimum(a, b)) // edge
    if (highest - lowest > FAR).any():
        raise OverflowError("a bond or a move is as long as many boxes")
    for row in np.flatnonzero((lowest <= highest).all(axis=1) & ~skip):
        ranges = [range(low, high + 1) for low, high in zip(lowest[row].tolist(), highest[row].tolist())]
        for image in ((i, j, k) for i in ranges[0] for j in ranges[1] for k in ranges[2]):
            yield int(model.bonds[row]), image


def describe(start, end, pivot, a, b):
    """Time, contact points (s, s') and normal of a crossing, in doubles of a0; points in lattice units."""
    before = rounded_volume(b - a, pivot - a, start - a)
    after = rounded_volume(b - a, pivot - a, end - a)
    time = min(max(before / (before - after), 0.0), 1.0)
    move = (end - start) * UNIT
    at = (start - a) * UNIT + time * move
    p, q = (pivot - a) * UNIT - at, (b - a) * UNIT
    pp, pq, qq, pt, qt = dot(p, p), dot(p, q), dot(q, q), dot(p, at), dot(q, at)
    denominator = pp * qq - pq * pq
    s, s_standing = 0.5, 0.5
    if denominator > 0:
        s = min(max((pq * qt - qq * pt) / denominator, 0.0), 1.0)
        s_standing = min(max((pp * qt - pq * pt) / denominator, 0.0), 1.0)
    normal = cross(p, q)
    if not normal.any():
        normal = move - (dot(move, q) / dot(q, q)) * q
    normal = (1 / np.sqrt(dot(normal, normal))) * normal
    if dot(normal, move) < 0:
        normal = -normal
    return float(time), s, s_standing, normal


def hits_of_move(model, position, vertex, end):
    """All crossings of one trial move, the first one first."""
    hits, left_out = [], {(bond, HOME) for bond in linked(model, vertex)}
    for moving, pivot in ((model.prev[vertex], model.prev[vertex]), (vertex, model.next[vertex])):
        if pivot < 0:
            continue
        skip = excluded(model, vertex, moving)
        for standing, image in partners(model, position, position[vertex], end, position[pivot], skip):
            if (standing, image) in left_out:
                continue
            shift = np.array(image) * model.box * CELL
            a, b = position[standing] + shift, position[model.next[standing]] + shift
            flip = moving == vertex
            if crosses(*(point.tolist() for point in (position[vertex], end, position[pivot], a, b)), flip):
                time, *contact = describe(position[vertex], end, position[pivot], a, b)
                hits.append(Hit(time, moving, standing, image, pivot, *contact))
    return sorted(hits, key=Hit.key)


def exchange(mass, velocity, s, s_standing, normal):
    """Momentum along the normal by the lever rule, mirrored: of moving vertex, pivot, a and b, [4] masses and [4, 3]
    velocities. Gives the momentum and the new velocities."""
    lever = np.array([1 - s, s, s_standing - 1, -s_standing])
    inverse_mass = 1 / mass
    approach = sum(lever * dot(velocity, normal))  # Python's sum: from left to right
    momentum = 2 * approach / sum(lever * lever * inverse_mass)
    return momentum, velocity - (lever * momentum * inverse_mass)[:, None] * normal


def execute(model, velocity, vertex, hit):
    """Answers a hit: changes the velocities of its four vertices, returns the momentum."""
    four = np.array([vertex, hit.pivot, hit.standing, model.next[hit.standing]])
    momentum, velocity[four] = exchange(model.mass[four], velocity[four], hit.s, hit.s_standing, hit.normal)
    return momentum


def sweep(model, order, position, velocity, time):
    """Moves every vertex in the given order: new position and velocity, rows of events and of hits."""
    position, velocity, events, rows = position.copy(), velocity.copy(), [], []
    for vertex in order:
        end = position[vertex] + to_lattice(time * velocity[vertex])
        hits = hits_of_move(model, position, vertex, end) if model.forbidden else []
        if not hits:
            position[vertex] = end
        for rank, hit in enumerate(hits):
            executed = rank == 0
            momentum = execute(model, velocity, vertex, hit) if executed else 0.0
            events.append([vertex, hit.moving, hit.standing, *hit.image, executed])
            rows.append([hit.time, hit.s, hit.s_standing, *hit.normal, momentum])
    return position, velocity, np.array(events, np.int64).reshape(-1, 7), np.array(rows, float).reshape(-1, 7)
