#!/usr/bin/python3
"""Which pairs of bonds are looked at: all images that moves reach, of boxes that are small, sheared, change or are closed along an axis.

Held against a loop over all pairs and many images, each decided by sturm.py or by a second code in floating point; and against theory.
"""
import itertools
import math
import os
import pathlib
import random
import subprocess
import sys
import unittest

import numpy

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[k]) for k in (0, 1)] + [str(pathlib.Path(__file__).resolve().parents[2] / "python")]
from support import UNCROSS  # noqa: E402
import sturm  # noqa: E402
from uncross_topology import crossings, frame  # noqa: E402

os.environ["UNCROSS"] = str(UNCROSS)


def whole(bonds, places, edges, periodic, slides):
    """The same of whole numbers: places[vertex][t]."""
    frames = [frame.Frame(t, float(t), edges[t], periodic, slides[t], None, numpy.array([place[t] for place in places], dtype=numpy.int64)) for t in (0, 1)]
    finder = crossings.Finder(frame.Topology(numpy.arange(len(places)), numpy.array(bonds, dtype=numpy.int32), None))
    try:
        return finder.between(*frames)
    finally:
        finder.close()


def by_all_images(bonds, places, edges, periodic, slides, most):
    """{(i, j, image): (signs, touched)}, of all pairs and images up to `most` along each axis. Bonds that share a vertex are left out."""
    numbers = numpy.array(list(itertools.product(*(range(-most, most + 1) if p else (0,) for p in periodic))))
    shifts = [numbers * edges[t] + numpy.outer(numbers[:, 1], (slides[t], 0, 0)) for t in (0, 1)]
    found = {}
    for (i, (a, b)), (j, (c, d)) in itertools.combinations_with_replacement(enumerate(bonds), 2):
        vector = lambda x, y: [[v - u for u, v in zip(places[x][t], places[y][t])] for t in (0, 1)]
        p, q, w = vector(a, b), vector(c, d), vector(a, c)
        # most are far apart: along an axis, all corners of w + s' q - s p are on one side
        corners = numpy.array([shifts[t] + w[t] + numpy.multiply(s, q[t]) - numpy.multiply(r, p[t]) for t in (0, 1) for s in (0, 1) for r in (0, 1)])
        for k in numpy.flatnonzero(~numpy.any((corners.min(axis=0) > 0) | (corners.max(axis=0) < 0), axis=1)):
            image = tuple(numbers[k].tolist())
            if image <= (0, 0, 0) if i == j else not any(image) and {a, b} & {c, d}:
                continue
            signs, touched = sturm.meet(*p, *q, *([x + y for x, y in zip(w[t], shifts[t][k].tolist())] for t in (0, 1)))
            if signs or touched:
                found[i, j, image] = signs, touched
    return found


CHAINS = [[0, 1], [1, 2], [2, 3], [4, 5], [5, 6], [7, 8]]  # three chains


def draw_places(draw, edges, size, move):
    places = []
    for k in range(9):
        begin = [x + draw.randint(-size, size) for x in places[-1][0]] if [k - 1, k] in CHAINS else [draw.randrange(e) for e in edges]
        places.append([begin, [x + draw.randint(-move, move) for x in begin]])
    return places


def as_found(result, bonds):
    """As by_all_images has it."""
    found = {}
    for crossing in result.crossings:
        found.setdefault((*crossing.bonds, crossing.image), ([], False))[0].append(crossing.sign)
    for touch in result.touches:
        if any(touch.image) or not set(bonds[touch.bonds[0]]) & set(bonds[touch.bonds[1]]):
            found[(*touch.bonds, touch.image)] = found.get((*touch.bonds, touch.image), ([], False))[0], True
    return found


class AllImages(unittest.TestCase):
    def hold(self, edges, periodic, slides, size, move, most, least, rounds=3):
        """Chains whose vertices are up to `size` apart along each axis and move by up to `move`. least: crossings in all."""
        draw, crossed, images = random.Random(repr((edges, periodic, slides))), 0, set()
        for _ in range(rounds):
            places = draw_places(draw, edges[0], size, move)
            found = as_found(whole(CHAINS, places, edges, periodic, slides), CHAINS)
            self.assertEqual(found, by_all_images(CHAINS, places, edges, periodic, slides, most))
            self.assertTrue(all(abs(n) < most for key in found for n in key[2]), "the loop looked no further")
            crossed += sum(len(signs) for signs, _ in found.values())
            images |= {key[2] for key in found}
        self.assertGreaterEqual(crossed, least)
        return images

    def test_large_box(self):
        self.hold([[2500] * 3] * 2, [True] * 3, (0, 0), 1200, 900, 4, 1)

    def test_small_box_and_long_moves(self):
        """Edges shorter than bonds and moves: several images of one pair."""
        images = self.hold([[900, 1100, 1000]] * 2, [True] * 3, (0, 0), 1200, 900, 9, 15, 2)
        self.assertGreater(len(images), 12)

    def test_sheared(self):
        """The slide is of several turns of Lx, and moves on between the frames."""
        self.hold([[1100] * 3] * 2, [True] * 3, (4900, 5400), 1200, 700, 16, 4, 2)

    def test_walls(self):
        images = self.hold([[1500] * 3] * 2, [True, False, True], (0, 0), 900, 900, 5, 3)
        self.assertEqual({image[1] for image in images}, {0})

    def test_box_that_changes(self):
        self.hold([[1100] * 3, [900, 1300, 1000]], [True] * 3, (0, 0), 1200, 700, 8, 4, 2)

    def test_no_box(self):
        draw = random.Random(3)
        places = [[[draw.randint(0, 900) for _ in range(3)] for _ in (0, 1)] for _ in range(9)]
        found = as_found(whole(CHAINS, places, [[0] * 3] * 2, [False] * 3, (0, 0)), CHAINS)
        self.assertEqual(found, by_all_images(CHAINS, places, [[0] * 3] * 2, [False] * 3, (0, 0), 0))
        self.assertTrue(found)

    def test_special_places(self):
        """Whole numbers up to 5 in a box of 4: touches, bonds that lie on their own images."""
        self.hold([[4] * 3] * 2, [True] * 3, (0, 0), 2, 2, 5, 2, 2)
        long = whole([[0, 1]], [[[0, 0, 0], [0, 0, 0]], [[5, 0, 0], [5, 0, 0]]], [[4] * 3] * 2, [True] * 3, (0, 0))
        self.assertEqual([touch.image for touch in long.touches], [(1, 0, 0)])

    def test_whole_turns_and_images_change_nothing(self):
        """Chains in other images, and a slide that has whole turns of Lx more: as many crossings, with the same signs and times."""
        draw = random.Random(8)
        edges, slides = [[900] * 3] * 2, (300, 900)
        places = draw_places(draw, edges[0], 1200, 700)
        signs = lambda result: sorted((crossing.bonds, crossing.sign, crossing.t) for crossing in result.crossings)
        usual = signs(whole(CHAINS, places, edges, [True] * 3, slides))
        self.assertGreater(len(usual), 2)
        turned = signs(whole(CHAINS, places, edges, [True] * 3, [slide + 5 * 900 for slide in slides]))
        self.assertEqual(turned, usual)
        for vertex in range(4):
            for t in (0, 1):  # by the image (3, -2, 7)
                places[vertex][t] = [places[vertex][t][0] + 3 * 900 - 2 * slides[t], places[vertex][t][1] - 2 * 900, places[vertex][t][2] + 7 * 900]
        self.assertEqual(signs(whole(CHAINS, places, edges, [True] * 3, slides)), usual)


def second_code(bonds, first, last, edge):
    """{(i, j): signs} in floating point: all pairs at once, the nearest image, the cubic through four times, its roots by bisection."""
    found = {}
    a, b = bonds[:, 0], bonds[:, 1]
    i, j = numpy.triu_indices(len(bonds), 1)
    middle = 0.5 * (first[a] + first[b])
    image = numpy.rint((middle[j] - middle[i]) / edge) * edge
    close = numpy.flatnonzero(numpy.abs(middle[j] - middle[i] - image).max(axis=1) < 1.5)
    i, j, image = i[close], j[close], image[close]

    def at(t, k=slice(None)):
        a_i, b_i, a_j, b_j = (first[end] + t * (last[end] - first[end]) for end in (a[i[k]], b[i[k]], a[j[k]], b[j[k]]))
        return b_i - a_i, b_j - a_j, a_j - image[k] - a_i

    f = numpy.stack([numpy.einsum("ij,ij->i", numpy.cross(p, q), w) for p, q, w in map(at, (0, 1 / 3, 2 / 3, 1))])
    cubic = numpy.linalg.solve(numpy.vander([0, 1 / 3, 2 / 3, 1], 4), f)
    often = numpy.vander(numpy.linspace(0, 1, 65), 4) @ cubic
    part, k = numpy.nonzero(often[:-1] * often[1:] < 0)
    low, high, sign = part / 64, (part + 1) / 64, numpy.sign(often[part + 1, k])
    value = lambda t: ((cubic[0, k] * t + cubic[1, k]) * t + cubic[2, k]) * t + cubic[3, k]
    for _ in range(50):
        middle = 0.5 * (low + high)
        after = value(middle) * sign > 0
        low, high = numpy.where(after, low, middle), numpy.where(after, middle, high)
    for t, one, way in sorted(zip(low, k, sign)):
        p, q, w = at(t, one)
        n = numpy.cross(p, q)
        s = numpy.cross(w, q) @ n / (n @ n), numpy.cross(w, p) @ n / (n @ n)
        if min(s) > 0 and max(s) < 1:
            found.setdefault((int(i[one]), int(j[one])), []).append(int(way))
    return found


class Gas(unittest.TestCase):
    """Needles that fly freely and turn: crossings are independent, and their rate is known."""

    def needles(self, count, edge, frames, step):
        """Positions [frame][2 count][3] of needles of length 1, thermal: velocities of both ends are independent and normal."""
        draw = numpy.random.default_rng(11)
        begin, axis = draw.uniform(0, edge, (count, 3)), draw.normal(size=(count, 3))
        axis /= numpy.linalg.norm(axis, axis=1)[:, None]
        places = numpy.stack([begin, begin + axis], axis=1).reshape(-1, 3)
        # straight moves of a translation: the length stays
        velocity = numpy.repeat(draw.normal(size=(count, 3)), 2, axis=0)
        return [places + step * k * velocity for k in range(frames)]

    def search(self, positions, edge, near=0.0):
        bonds = numpy.arange(len(positions[0]), dtype=numpy.int32).reshape(-1, 2)
        size = frame.on_lattice([edge] * 3).tolist()
        frames = [frame.Frame(k, float(k), size, [True] * 3, 0, None, frame.on_lattice(position)) for k, position in enumerate(positions)]
        finder = crossings.Finder(frame.Topology(numpy.arange(len(positions[0])), bonds, None))
        try:
            return bonds, [finder.between(first, last, int(near * 2**32)) for first, last in zip(frames, frames[1:])]
        finally:
            finder.close()

    def test_rate(self):
        """(pi/8) rho^2 V <|v_n|> t: v_n, the relative velocity along one direction, has variance 2, so <|v_n|> = 2/sqrt(pi)."""
        count, edge, step, frames = 8000, 12.0, 0.02, 11
        _, found = self.search(self.needles(count, edge, frames, step), edge)
        crossed = sum(len(result.crossings) for result in found)
        expected = math.pi / 8 * (count / edge**3) ** 2 * edge**3 * 2 / math.sqrt(math.pi) * step * (frames - 1)
        self.assertGreater(expected, 3000)
        self.assertLess(abs(crossed - expected), 4 * math.sqrt(expected))
        self.assertEqual(sum(len(result.touches) for result in found), 0)
        net = sum(crossing.sign for result in found for crossing in result.crossings)
        self.assertLess(abs(net), 4 * math.sqrt(expected))

    def test_near(self):
        """(pi/4) rho^2 V e pairs of inner points are nearer than e."""
        count, edge, near = 8000, 12.0, 0.05
        _, found = self.search(self.needles(count, edge, 2, 0.001), edge, near)
        expected = math.pi / 4 * (count / edge**3) ** 2 * edge**3 * near
        self.assertLess(abs(found[0].near - expected), 4 * math.sqrt(expected))

    def test_second_code(self):
        """The same pairs and signs, of moves that turn and stretch bonds."""
        count, edge = 500, 6.0
        draw, positions = numpy.random.default_rng(4), self.needles(count, edge, 1, 0.0)
        for _ in range(3):
            positions.append(positions[-1] + 0.1 * draw.normal(size=positions[0].shape))
        bonds, found = self.search(positions, edge)
        number = 0
        for result, first, last in zip(found, positions, positions[1:]):
            ours = {}
            for crossing in result.crossings:
                ours.setdefault(crossing.bonds, []).append(crossing.sign)
            self.assertEqual(ours, second_code(bonds, first, last, edge))
            number += len(result.crossings)
        self.assertGreater(number, 60)

    def test_numbers_that_nobody_has(self):
        """Sums of images stay in 64 bits, loops over images end: `uncross crossings` says so in words, or that it is too far."""
        wide, far, points = 2**40, 2**57, [(0, 0, 0), (2**30, 0, 0)]
        for head, numbers, places, code, said in (
                ("2147483647 0", "", [], 2, b"the first line"),
                ("2 1", f"1 1 1 {2**61} {2**61} {2**61} 1 1 1 0 0 0", points, 2, b"an edge of the box"),
                ("2 1", f"{wide} {wide} {wide} {wide} {3 * wide} {wide} 1 1 1 0 0 0", points, 2, b"doubles"),
                ("2 1", f"{wide} {wide} {wide} {wide} {wide} {wide} 1 1 1 {-2**63} 0 0", points, 2, b"an offset"),
                ("2 1", "1 1 1 1 1 1 1 1 1 0 0 0", points, 0, b"far"),
                ("2 1", f"{wide} 1 {wide} {wide} 1 {wide} 0 1 0 {far} {far} 0", [(0, 0, 0), (0, far, 0)], 0, b"far"),
                ("2 1", f"{wide} {wide} {wide} {wide} {wide} {wide} 1 1 1 {5 * wide} {6 * wide} 0", points, 0, b"done 0 0")):
            data = head.encode() + b"\n" + numpy.array([0, 1], "<u4").tobytes() + numbers.encode() + b"\n" + 2 * numpy.array(places, "<i8").tobytes()
            done = subprocess.run([UNCROSS, "crossings"], input=data, capture_output=True, timeout=20, check=False)
            self.assertEqual(done.returncode, code, numbers)
            self.assertIn(said, done.stderr if code else done.stdout, numbers)


if __name__ == "__main__":
    unittest.main()
