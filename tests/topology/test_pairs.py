#!/usr/bin/python3
"""Two bonds between two frames: apart, crossed, touched.

`uncross crossings` (C) and exact.py (integers) are held against sturm.py, which decides in another way, over the rationals. Places with 20
bits are generic; those of whole numbers up to 7 and to 3 are mostly special. PAIRS=30000 for a longer look.
"""
import itertools
import os
import pathlib
import random
import sys
import unittest

import numpy

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[k]) for k in (0, 1)] + [str(pathlib.Path(__file__).resolve().parents[2] / "python")]
from support import UNCROSS  # noqa: E402
import sturm  # noqa: E402
from uncross_topology import crossings, exact, frame  # noqa: E402

os.environ["UNCROSS"] = str(UNCROSS)
PAIRS = int(os.environ.get("PAIRS", "100"))


def vectors(places):
    """Of two bonds' ends a, b, c, d at t = 0 and 1: p, q and w at both."""
    return [[[y - x for x, y in zip(places[one][t], places[other][t])] for t in (0, 1)] for one, other in ((0, 1), (2, 3), (0, 2))]


def by_sturm(places):
    p, q, w = vectors(places)
    return sturm.meet(*p, *q, *w)


def by_integers(places):
    found = exact.meetings(*(exact.linear(*v) for v in vectors(places)))
    return [crossing.sign for crossing in found.crossings], found.touched


def found_in(bonds, places, box=None):
    """What the finder says of some vertices: places[vertex][t]."""
    edge, periodic, slides = box or ([0, 0, 0], [False] * 3, (0, 0))
    topology = frame.Topology(numpy.arange(len(places)), numpy.array(bonds, dtype=numpy.int32), None)
    frames = [frame.Frame(t, float(t), edge, periodic, slides[t], None, numpy.array([place[t] for place in places], dtype=numpy.int64)) for t in (0, 1)]
    finder = crossings.Finder(topology)
    try:
        return finder.between(*frames)
    finally:
        finder.close()


def by_program(cases, far):
    """Each case alone, far from the others along x."""
    places = [[[x + far * k * (axis == 0) for axis, x in enumerate(at)] for at in vertex] for k, case in enumerate(cases) for vertex in case]
    result = found_in([[2 * k, 2 * k + 1] for k in range(2 * len(cases))], places)
    signs, touched = [[] for _ in cases], [False] * len(cases)
    for crossing in result.crossings:
        signs[crossing.bonds[0] // 2].append(crossing.sign)
    for touch in result.touches:
        touched[touch.bonds[0] // 2] = True
    return list(zip(signs, touched))


class Random(unittest.TestCase):
    def hold(self, top, least):
        draw = random.Random(top)
        cases = [[[[draw.randint(0, top) for _ in range(3)] for _ in (0, 1)] for _ in range(4)] for _ in range(PAIRS)]
        wanted = [by_sturm(case) for case in cases]
        self.assertEqual([by_integers(case) for case in cases], wanted)
        self.assertEqual(by_program(cases, 10 * (top + 1)), wanted)
        for kind, number in least.items():  # the classes are all there
            self.assertGreaterEqual(sum((min(len(signs), 2), touched) == kind for signs, touched in wanted), number, kind)

    def test_generic(self):
        self.hold(2**20, {(0, False): 60, (1, False): 10, (0, True): 0})

    def test_up_to_7(self):
        self.hold(7, {(0, False): 50, (1, False): 8, (0, True): 2})

    def test_up_to_3(self):
        self.hold(3, {(0, False): 40, (1, False): 5, (0, True): 10})


STILL = lambda *place: [list(place), list(place)]
MOVES = lambda first, last: [list(first), list(last)]


class Special(unittest.TestCase):
    """Each by hand: signs of crossings, touched."""

    def hold(self, places, signs, touched):
        self.assertEqual(by_integers(places), (signs, touched))
        self.assertEqual(by_sturm(places), (signs, touched))
        self.assertEqual(by_program([places], 1000), [(signs, touched)])

    def through(self, z0, z1, x=1):
        """A bond along y falls through one along x, from 0 to 2."""
        return [STILL(0, 0, 0), STILL(2, 0, 0), MOVES((x, -1, z0), (x, -1, z1)), MOVES((x, 1, z0), (x, 1, z1))]

    def test_through(self):
        self.hold(self.through(-1, 1), [1], False)
        self.hold(self.through(1, -1), [-1], False)
        self.hold(self.through(1, 2), [], False)

    def test_past_the_end(self):
        self.hold(self.through(-1, 1, 3), [], False)

    def test_ends(self):
        self.hold(self.through(-1, 1, 2), [], True)  # through a vertex
        self.hold(self.through(-1, 2, 2), [], True)  # the same at t = 1/3, which no halving reaches
        self.hold(self.through(-1, 0), [], True)  # arrives at t = 1
        self.hold(self.through(0, 1), [], True)  # leaves at t = 0

    def test_three_times(self):
        """p turns by a right angle while q passes: f has a double root where it touches, or two simple ones."""
        p = [MOVES((-4, 0, 0), (-4, 0, 0)), MOVES((4, 0, 0), (4, 0, 0))]
        self.hold([*p, MOVES((0, -4, -1), (0, -4, 3)), MOVES((0, 4, 3), (0, 4, -1))], [], False)
        # heights of q's two ends are 1 - 4 t and 4 t - 3: at the fraction 1/2 always below, so the plane is met and left
        self.hold([*p, MOVES((-1, -4, 1), (1, -4, -1)), MOVES((-1, 4, 1), (1, 4, -1))], [-1], False)

    def test_double_root(self):
        """f = (1 - 2t)^2 up to a factor: the line turns over and back."""
        places = [MOVES((-1, 0, 0), (-1, 0, 0)), MOVES((1, 0, 0), (1, 0, 0)), MOVES((-1, -1, -1), (1, -1, 1)), MOVES((-1, 1, -1), (1, 1, 1))]
        self.hold(places, [1], False)
        grazing = [MOVES((-8, 0, 0), (-8, 0, 0)), MOVES((8, 0, 0), (8, 0, 0)), MOVES((0, -1, 1), (0, -3, -3)), MOVES((0, 3, -3), (0, 1, 1))]
        # where q crosses y = 0 its height is (3(1 - 4t) - ...)/4: computed by the others, and special for all
        self.assertEqual(by_integers(grazing), by_sturm(grazing))
        self.assertEqual(by_program([grazing], 1000), [by_sturm(grazing)])

    def test_parallel(self):
        side = [STILL(0, 0, 0), STILL(4, 0, 0)]
        self.hold([*side, MOVES((1, 0, -1), (1, 0, 1)), MOVES((5, 0, -1), (5, 0, 1))], [], True)  # comes to lie on it
        self.hold([*side, MOVES((5, 0, -1), (5, 0, 1)), MOVES((9, 0, -1), (9, 0, 1))], [], False)  # beside it, on one line
        self.hold([*side, MOVES((4, 0, -1), (4, 0, 1)), MOVES((9, 0, -1), (9, 0, 1))], [], True)  # end to end
        self.hold([*side, MOVES((9, 0, 0), (4, 0, 0)), MOVES((12, 0, 0), (6, 0, 0))], [], True)  # slides along it, to the end

    def test_always_in_one_plane(self):
        flat = [STILL(0, 0, 0), STILL(4, 0, 0)]
        self.hold([*flat, MOVES((1, 1, 0), (1, -1, 0)), MOVES((2, 2, 0), (2, 1, 0))], [], True)
        self.hold([*flat, MOVES((1, 3, 0), (1, 1, 0)), MOVES((2, 2, 0), (2, 1, 0))], [], False)

    def test_points(self):
        self.hold([STILL(1, 1, 1), STILL(1, 1, 1), MOVES((0, 1, 1), (2, 1, 1)), MOVES((0, 1, 1), (2, 1, 1))], [], True)
        self.hold([STILL(1, 1, 1), STILL(1, 1, 1), MOVES((0, 1, 1), (2, 1, 2)), MOVES((0, 1, 1), (2, 1, 2))], [], False)

    def test_at_rest(self):
        self.hold(self.through(0, 0), [], True)
        self.hold(self.through(1, 1), [], False)

    def test_thin_air(self):
        """A way of one lattice unit in 2^40, between bonds of 2^32."""
        long, near = 2**32, 1
        for z0, z1, signs, touched in ((-near, near, [1], False), (near, 2 * near, [], False), (-near, 0, [], True)):
            places = [STILL(-long, 0, 0), STILL(long, 1, 0), MOVES((3, -long, z0), (3, -long, z1)), MOVES((5, long, z0), (5, long, z1))]
            self.hold(places, signs, touched)


class Chains(unittest.TestCase):
    def chain(self, bent, where, closed=False, turn=lambda place: place):
        """A chain of the places `bent`, all at rest, and a bond along y that falls through it at `where`; all turned or mirrored."""
        places = [STILL(*place) for place in bent] + [MOVES((*where, 4), (*where, -4)), MOVES((where[0], where[1] + 8, 4), (where[0], where[1] + 8, -4))]
        bonds = [[k, k + 1] for k in range(len(bent) - 1)] + ([[len(bent) - 1, 0]] if closed else []) + [[len(bent), len(bent) + 1]]
        return found_in(bonds, [[turn(at) for at in place] for place in places])

    def test_through_a_vertex_counts_once(self):
        """Ties are broken the same way for the two bonds that share the vertex."""
        ways = list(itertools.product(itertools.permutations(range(3)), itertools.product((1, -1), repeat=3)))
        for number, (axes, signs) in enumerate(ways):  # turned and mirrored, as a step to one side may be right by chance
            found = self.chain([(0, 0, 0), (4, number % 7 - 3, 0), (8, 0, 0)], (4, -4), turn=lambda at: [sign * at[axis] for sign, axis in zip(signs, axes)])
            self.assertEqual(len(found.crossings), 0)
            self.assertEqual(len(found.touches), 2)
            self.assertEqual(sum(count for count, _ in found.count.values()), 1)
            self.assertEqual(abs(sum(net for _, net in found.count.values())), 1)

    def test_beside_a_corner_counts_even(self):
        """The falling bond meets the tip of a corner, whose bonds both come from one side: 0 or 2, and no net."""
        found = self.chain([(0, 0, 0), (4, 0, 0), (0, 3, 0)], (4, -4))
        self.assertEqual(len(found.touches), 2)
        self.assertIn(sum(count for count, _ in found.count.values()), (0, 2))
        self.assertEqual(sum(net for _, net in found.count.values()), 0)

    def test_closing_bond(self):
        for closed in True, False:
            found = self.chain([(0, 0, 0), (1, 9, 0), (8, 9, 0), (8, 0, 0)], (4, -4), closed)
            self.assertEqual([crossing.bonds for crossing in found.crossings], [(3, 4)] if closed else [])

    def test_next_but_one(self):
        """A chain of three bonds folds up, until its third goes through its first."""
        found = found_in([[0, 1], [1, 2], [2, 3]], [STILL(0, 0, 0), STILL(4, 0, 0), STILL(4, 2, 1), MOVES((2, -1, 3), (2, -1, -3))])
        self.assertEqual([crossing.bonds for crossing in found.crossings], [(0, 2)])

    def test_folds(self):
        """Bonds that share a vertex never cross, and touch if they lie on each other."""
        for end, touches in ((3, 0, 0), 1), ((5, 0, 0), 1), ((9, 0, 0), 0), ((3, 1, 0), 0):
            for order in ([0, 1], [1, 2]), ([1, 0], [1, 2]), ([0, 1], [2, 1]), ([1, 0], [2, 1]):
                found = found_in(order, [STILL(0, 0, 0), STILL(6, 0, 0), STILL(*end)])
                self.assertEqual((len(found.crossings), len(found.touches), found.count), (0, touches, {}))
        found = found_in([[0, 1], [1, 2]], [STILL(0, 0, 0), STILL(6, 0, 0), MOVES((3, 1, 1), (5, -1, -1))])
        self.assertEqual(len(found.touches), 1)
        found = found_in([[0, 1], [1, 2]], [STILL(0, 0, 0), STILL(6, 0, 0), MOVES((3, 1, 1), (5, -1, -2))])
        self.assertEqual(len(found.touches), 0)


class Perturbed(unittest.TestCase):
    def test_the_number_of_crossings_is_that_of_near_places(self):
        """Of special pairs, places that are moved by 2^-40 of a unit the same way cross as often."""
        draw = random.Random(5)
        seen = 0
        while seen < 40:
            places = [[[draw.randint(0, 3) for _ in range(3)] for _ in (0, 1)] for _ in range(4)]
            signs, touched = by_integers(places)
            if not touched:
                continue
            seen += 1
            steps = [exact.direction(vertex) for vertex in range(4)]
            near = [[[(x << 72) + step for x, step in zip(at, steps[k])] for at in vertex] for k, vertex in enumerate(places)]
            found = exact.perturbed(range(4), places)
            self.assertFalse(found.touched)
            self.assertEqual(([crossing.sign for crossing in found.crossings], False), by_integers(near))


if __name__ == "__main__":
    unittest.main()
