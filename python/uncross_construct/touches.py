"""Rows of two tubes, and of a bond and a bead, as scenes seldom have them: parallel, end on end, slow, grazing, at rest. They are the same
in each pack, behind the rows of the scene (docs/port/tubes.md, bead.md)."""

import itertools
import math
import pathlib
import sys
from dataclasses import dataclass

import h5py
import numpy

from .exact import TICKS, cross, dot, plus, times
from .inputs import Dice

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "ports/numpy"))
from uncross_port import lattice, tubes  # noqa: E402

ZERO = (0, 0, 0)
AT_REST = 6


@dataclass
class Kind:
    """Bonds of 2^bond units along each axis at most, whose ends move by 2^rate units in a tick. graze: the bodies pass by each other in a
    depth of 2^graze units; 0: as they come."""

    rows: int
    bond: int
    rate: int
    direction: str = "any"
    place: str = "any"
    graze: int = 0


TUBES = [
    Kind(30, 39, 20), Kind(20, 39, 20, place="end on side"), Kind(20, 39, 20, place="end on end"), Kind(16, 39, 20, "parallel"),
    Kind(16, 39, 20, "nearly parallel"), Kind(12, 39, 20, "on one line", "end on end"), Kind(20, 39, 6), Kind(12, 36, 20, place="end on side"),
    Kind(16, 39, 21, graze=26), Kind(16, 39, 21, place="end on end", graze=26), Kind(10, 39, 21, "nearly parallel", graze=30)]
CONTACTS = [
    Kind(20, 39, 0), Kind(20, 39, 0, place="end on side"), Kind(20, 39, 0, place="end on end"), Kind(20, 39, 0, "parallel"),
    Kind(10, 39, 0, "on one line", "end on end"), Kind(10, 36, 0, place="end on side")]
BEADS = [
    Kind(30, 39, 20), Kind(30, 39, 20, place="end"), Kind(20, 39, 6), Kind(20, 36, 20, place="end"), Kind(20, 39, 21, graze=26),
    Kind(20, 39, 21, place="end", graze=26)]


def size(v):
    return math.sqrt(dot(v, v))


def floats(v):
    return tuple(map(float, v))


def units(r):
    return tuple(map(round, r))  # ties to even


# --- places of two bodies that touch ---


def draw_gap(dice, p, q, s, t):
    """A unit vector, perpendicular to the bonds that are touched at their sides."""
    n, both = dice.vector(1.0), cross(p, q)
    side_p, side_q = 0.0 < s < 1.0, 0.0 < t < 1.0
    if side_p and side_q and size(both) > 1e-3 * size(p) * size(q):
        n = both
    elif side_p or side_q:
        along = p if side_p else q
        n = plus(n, along, -dot(n, along) / dot(along, along))
    return times(1.0 / size(n), n)


def draw_tubes(dice, kind, reach):
    """p, q and w, the axes `reach` apart at the points s and t, or nearer where that is no nearest line."""
    bond = 1 << kind.bond
    p, q = dice.point(bond), dice.point(bond)
    s, t = (float(dice.number(2)) if end else dice.between(0.1, 0.9)
            for end in (kind.place != "any", kind.place == "end on end"))
    if kind.direction != "any":
        q = times(2 if dice.number(2) else -1, p)
    if kind.direction == "nearly parallel":
        q = plus(q, dice.point(bond >> 12))
    along, other = floats(p), floats(q)
    gap = draw_gap(dice, along, other, s, t)
    if kind.direction == "on one line":
        gap = times((1.0 if s > 0.5 else -1.0) / size(along), along)
    return p, q, units(plus(plus(times(s, along), other, -t), gap, float(reach)))


def draw_reach_of_tubes(dice):
    return (1 << 36) + dice.integer(1 << 35)


def draw_beside_bead(dice, kind, reach):
    """A bond, and a center at the reach from its side, or from an end and beyond it; a bead is a tube without length."""
    bond = dice.point(1 << kind.bond)
    p, n = floats(bond), dice.vector(1.0)
    s, along = float(dice.number(2)) if kind.place == "end" else dice.between(0.1, 0.9), dot(n, p)
    if kind.place == "end":
        n = times(1.0 if (s > 0.5) == (along > 0.0) else -1.0, n)
    else:
        n = plus(n, p, -along / dot(p, p))
    return bond, ZERO, units(plus(times(s, p), n, float(reach) / size(n)))


def draw_reach_of_bead(dice):
    """R + D/2 of 1.5 to 2 a0."""
    return 3 * (1 << 39) + dice.integer(1 << 38) + (1 << 38)


# --- searches ---


def draw_search_of_tubes(dice, kind):
    reach, rate, tick = draw_reach_of_tubes(dice), 1 << kind.rate, dice.number(TICKS)
    places = draw_tubes(dice, kind, reach)
    rates = [dice.point(rate) for _ in range(3)]
    if kind.direction in ("parallel", "on one line"):
        rates[:2] = ZERO, ZERO
    return [*(plus(place, v, -tick) for place, v in zip(places, rates)), *rates], reach


def draw_search_of_bead(dice, kind):
    reach, rate, tick = draw_reach_of_bead(dice), 1 << kind.rate, dice.number(TICKS)
    places = draw_beside_bead(dice, kind, reach)
    rates = [dice.point(rate), ZERO, dice.point(rate)]
    return [*(plus(place, v, -tick) for place, v in zip(places, rates)), *rates], reach


def touch(pair, reach):
    return tubes.first_contact(pair, reach, 0) < TICKS


def grazing(pair, reach, least, graze):
    """The reach with which bodies touch in a depth of 2^graze that would just pass by; 0: they would not."""
    if not touch(pair, reach) or touch(pair, least):
        return 0
    while reach - least > 1:
        middle = least + (reach - least) // 2
        least, reach = (least, middle) if touch(pair, middle) else (middle, reach)
    return reach + (1 << graze)


def is_legal(pair):
    return all(abs(x) < 1 << 52 for place in pair[:3] for x in place)


def searches(seed, kinds, draw, least):
    """All with a contact within the drift, and then some at rest, every other one with one body in the other."""
    dice, rows = Dice(seed), []
    for kind in kinds:
        end = len(rows) + kind.rows
        while len(rows) < end:
            pair, reach = draw(dice, kind)
            if kind.graze:
                reach = grazing(pair, reach, least, kind.graze)
            if (not kind.graze or reach > 1 << 34) and is_legal(pair):
                start = tubes.Knot(pair, 0)
                if tubes.apart(start, start, reach) and 0 < tubes.first_contact(pair, reach, 0) < TICKS - 1:
                    rows.append((*pair, reach))
    for k, (p, q, w, *_, reach) in enumerate(rows[:AT_REST]):
        rows.append((p, q, (reach // 2, 0, 0) if k % 2 else w, ZERO, ZERO, ZERO, reach))
    names = ("p", "q", "w", "p_rate", "q_rate", "w_rate", "reach")
    return dict(zip(names, zip(*rows))) | {"from": (0,) * len(rows)}


def contacts(draws):
    """The first so many of each kind, not in each other."""
    rows = []
    for number, draw in draws:
        apart = (row for row in iter(draw, None) if size(lattice.closest(*(tubes.in_a0(v) for v in row))[2]) > 2.0**-6)
        rows += itertools.islice(apart, number)
    return dict(zip(("p", "q", "w"), zip(*rows)))


def tube_contacts():
    dice = Dice(83)
    return contacts((kind.rows, lambda kind=kind: draw_tubes(dice, kind, draw_reach_of_tubes(dice))) for kind in CONTACTS)


def bead_contacts():
    dice = Dice(97)
    return contacts((20, lambda kind=kind: draw_beside_bead(dice, kind, draw_reach_of_bead(dice))) for kind in BEADS[:4])


OPERATORS = {
    "tube_search": lambda: searches(79, TUBES, draw_search_of_tubes, 1 << 20),
    "tube_contact": tube_contacts,
    "bead_search": lambda: searches(89, BEADS, draw_search_of_bead, 1 << 40),
    "bead_contact": bead_contacts,
}


def append(path, made, operators=tuple(OPERATORS)):
    """Copies the pack of a scene to a new file, with these rows behind those of the scene. What came out of them is for `uncross oracle
    answer --whole` to make anew."""
    rows = {}
    with h5py.File(path) as pack, h5py.File(made, "w") as longer:
        longer.attrs["format"], longer.attrs["version"] = "uncross pack", 2
        for place in pack:
            operator, group = place.rpartition(".")[0], longer.create_group(place)
            if operator not in operators:
                for table in pack[place]:
                    pack.copy(f"{place}/{table}", group)
                continue
            rows[operator] = rows.get(operator) or OPERATORS[operator]()
            for name, values in rows[operator].items():
                kept = pack[place][f"in.{name}"]
                more = numpy.array(values, kept.dtype).reshape(-1, kept.shape[1])
                group.create_dataset(f"in.{name}", data=numpy.concatenate([kept[:], more]))
                group[f"in.{name}"].attrs["components"] = kept.attrs["components"]
