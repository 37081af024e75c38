"""The pack `edges`: permutations that single precision gets wrong, tests for a crossing that hang on one sign, exchanges, hits at the
same time, places beside faces of cells."""

import math
from fractions import Fraction

import numpy

from .exact import CELL, cross, deviates, determinant, determinants, dot, minus, permuted, philox, plus, times, verdict
from .inputs import MASSES, PART, Dice, Pack, corner_of

SEED, BOX = 1311768467463790320, (4, 5, 3)
GRID_SHIFT, VERTEX_ORDER = 1, 3
PAIRS, CHAINS, PARTICLES = 44, 10, 120
KINDS = [(PAIRS, 2, False, 1.5, 0, 30, 0, (0, 0, 0)), (CHAINS, 3, False, 4, 0, 30, 0, (0, 0, 0))]
DRIFT = 0.25  # t0


# --- a permutation ---

PERMUTED = 4096


def single_indices(r, n):
    """Ways to make an index below n of 64 bits in single precision: from all bits, the high word, 24 bits, the uniform of 52 bits."""
    uniform = ((r >> numpy.uint64(12)).astype(float) + 0.5) * 2.0**-52
    scaled = ((r, 64), (r >> numpy.uint64(32), 32), (r >> numpy.uint64(40), 24))
    ways = [x.astype(numpy.float32) * numpy.float32(2.0**-bits) for x, bits in scaled] + [uniform.astype(numpy.float32)]
    return [numpy.minimum((way * n.astype(numpy.float32)).astype(int), n - 1) for way in ways]


def put_permutation(pack):
    """The first step at which each of these ways gets an index wrong."""
    n, step, wrong = numpy.arange(1, PERMUTED + 1), 0, [False]
    while not all(wrong):
        step += 1
        numbers = deviates(SEED, VERTEX_ORDER, 0, step, PERMUTED)
        exact = numpy.array([r * (k + 1) >> 64 for k, r in enumerate(numbers)])
        wrong = [(way != exact).any() for way in single_indices(numpy.array(numbers, numpy.uint64), n)]
    pack.put("permutation", "address", "purpose draw step size", [(VERTEX_ORDER, 0, step, PERMUTED)])


# --- tests for a crossing ---
# Five points are drawn: from, to, pivot, a, b. Then one is moved so that one of the five determinants is nearly or exactly zero, and
# all others are far from it. Only such tests are kept for which the determinants in doubles, with zero as positive, say something else
# than the exact ones: whoever leaves the exact integers out is wrong in each of them.

USUAL, WIDE = 1 << 39, 1 << 49  # sizes of differences: a bond as usual, and one in the largest box
BEFORE, AFTER, PATH, SIDE_OF_A, SIDE_OF_B = range(5)
NEARLY, EXACTLY, SYMMETRIC, GRID, PLAIN = 12, 6, 4, 100, 40  # how many
NUMBERS = 15  # of five points


def drawn_points(numbers, size, grid):
    """Five points of integers, or of arrays of them."""
    most = size // grid
    numbers = (numbers % numpy.uint64(2 * most + 1)).astype(numpy.int64) - most
    return [tuple(grid * numbers[3 * k + axis] for axis in range(3)) for k in range(5)]


def blend(o, s, u, t, v):
    """o + s (u - o) + t (v - o), rounded."""
    return tuple(a + numpy.rint(s * (b - a) + t * (c - a)).astype(numpy.int64) for a, b, c in zip(o, u, v))


def nearly_zero(numbers, which, size):
    """The bond meets the other at a share of the way to the pivot, or of the standing bond."""
    points = start, end, pivot, a, b = drawn_points(numbers[:NUMBERS], size, 1)
    bounds = ((0.2, 0.8), (1.2, 2.0), (0.1, 0.45), (0.1, 0.45))
    share, further, corner, other = (
        low + (high - low) * ((x >> numpy.uint64(11)).astype(float) * 2.0**-53) for (low, high), x in zip(bounds, numbers[NUMBERS:]))
    on_a_line, on_the_way = (further * (1.0 - share), further * share), (corner, other)
    (s, t), o, u, v = {BEFORE: (on_a_line, pivot, a, b), AFTER: (on_a_line, pivot, a, b), PATH: (on_a_line, a, start, end),
                       SIDE_OF_A: (on_the_way, pivot, start, end), SIDE_OF_B: (on_the_way, pivot, start, end)}[which]
    points[MOVED[which]] = blend(o, s, u, t, v)
    return points


MOVED = {BEFORE: 0, AFTER: 1, PATH: 4, SIDE_OF_A: 3, SIDE_OF_B: 4}


def exactly_zero(numbers, which, size):
    """Two points have the same middle; or one is in the middle of the triangle."""
    points = start, end, pivot, a, b = drawn_points(numbers, size, 8)
    middle = tuple((x + y) // 4 + z // 2 for x, y, z in zip(start, end, pivot))
    points[MOVED[which]] = {BEFORE: minus(plus(a, b), pivot), AFTER: minus(plus(a, b), pivot), PATH: minus(plus(start, end), a),
                            SIDE_OF_A: middle, SIDE_OF_B: middle}[which]
    return points


def in_doubles(points, flip):
    """The verdict where a and b are seen from the pivot, that where they are seen from `from`, and the smallest determinant."""
    triples = [[tuple(x.astype(float) for x in v) for v in triple] for triple in determinants(*points)]
    start, end, pivot, a, b = points
    sides = [tuple(x.astype(float) for x in v) for v in (minus(start, pivot), minus(end, pivot), minus(a, pivot), minus(b, pivot))]
    near = [determinant(*triple) for triple in triples]
    far = near[:3] + [determinant(*sides[:2], sides[2]), determinant(*sides[:2], sides[3])]
    return verdict(far, flip), verdict(near, flip), numpy.min(numpy.abs(near), axis=0)


def integers(points, k):
    return [tuple(int(x[k]) for x in point) for point in points]


def signs_of(points):
    return [determinant(*triple) for triple in determinants(*points)]


def has_normal(points, signs):
    """Bonds that are parallel when they meet have a normal of their own; no test of a pack is of them."""
    start, end, pivot, a, b = points
    time = Fraction(signs[0], signs[0] - signs[1])
    p, ab = [tuple(map(float, v)) for v in (plus(minus(pivot, start), minus(end, start), -time), minus(b, a))]
    n = cross(p, ab)
    return math.sqrt(dot(n, n)) > 1e-3 * math.sqrt(dot(p, p) * dot(ab, ab))


class Tests:
    """Rows of `crossing`."""

    def __init__(self, seed):
        self.dice, self.rows = Dice(seed), []

    def keep(self, points, signs, flip, size):
        """Anywhere, unless the bonds are parallel. True if it is kept."""
        if verdict(signs, flip) and not has_normal(points, signs):
            return False
        by = self.dice.point(2 * size)
        self.rows.append(([plus(point, by) for point in points], int(flip)))
        return True

    def add(self, make, count, which, flip, size, wrong_in_doubles):
        """One of these tests, from so many numbers. What doubles say is looked at for many at a time."""
        tries = 32
        while True:
            tries = min(2 * tries, 1 << 14) if wrong_in_doubles else 1
            points = make(self.dice.ahead(count * tries).reshape(tries, count).T, which, size)
            far, near, smallest = in_doubles(points, flip)
            doubtful = (far == near) & (smallest < (2 * size) ** 3 * 2.0**-49) if wrong_in_doubles else numpy.array([True])
            begin = self.dice.state
            for k in numpy.flatnonzero(doubtful):
                chosen = integers(points, k)
                signs = signs_of(chosen)
                if not wrong_in_doubles or verdict(signs, flip) != far[k]:
                    self.dice.state = begin
                    self.dice.skip(count * (int(k) + 1))
                    if self.keep(chosen, signs, flip, size):
                        return
            self.dice.state = begin
            self.dice.skip(count * tries)

    def add_any(self, n, grid, with_zeros):
        """On a grid, with zeros or whatever comes; every other one crosses."""
        kept = 0
        while kept < n:
            points = integers(drawn_points(self.dice.ahead(NUMBERS).reshape(NUMBERS, 1), USUAL, grid), 0)
            self.dice.skip(NUMBERS)
            flip, signs = self.dice.number(2), signs_of(points)
            if verdict(signs, flip) == (kept % 2 == 0) and (0 in signs or not with_zeros):
                kept += self.keep(points, signs, flip, USUAL)


def put_crossing(pack):
    tests = Tests(15)
    for which in range(5):
        for flip in (False, True):
            for k in range(2 * NEARLY):
                tests.add(nearly_zero, NUMBERS + 4, which, flip, USUAL if k % 2 else WIDE, True)
            for k in range(2 * EXACTLY):
                tests.add(exactly_zero, NUMBERS, which, flip, USUAL if k % 2 else WIDE, True)
            for k in range(SYMMETRIC):
                tests.add(exactly_zero, NUMBERS, which, flip, USUAL, False)
    tests.add_any(GRID, USUAL // 2, True)
    tests.add_any(PLAIN, 1, False)
    for k, name in enumerate(("from", "to", "pivot", "a", "b")):
        pack.put("crossing", name, "x y z", [points[k] for points, _ in tests.rows])
    pack.put("crossing", "flip", "flip", [flip for _, flip in tests.rows])


# --- exchanges ---


def put_exchange(pack):
    dice, rows = Dice(28), []
    for k in range(100):
        velocity, mass = [], []
        for _ in range(4):
            velocity.append(dice.velocity(k % 16 > 0))
            mass.append(5.0 if k % 4 == 0 else MASSES[dice.number(6)])
        rows.append((*velocity, mass, (dice.place(), dice.place()), dice.normal()))
    columns = {"moving": "x y z", "pivot": "x y z", "a": "x y z", "b": "x y z", "mass": "moving pivot a b", "contact": "s s_standing",
               "normal": "x y z"}
    for (name, words), column in zip(columns.items(), zip(*rows)):
        pack.put("exchange", name, words, column)


# --- hits at the same time ---


class Scaffold:
    """Pairs and chains in slots, so that within DRIFT bonds touch at exactly half of the time, several at once, some boxes away."""

    def __init__(self):
        vertices = 2 * PAIRS + 3 * CHAINS
        self.position, self.velocity = [None] * vertices, [(0.0, 0.0, 0.0)] * vertices
        self.pair, self.chain, self.slot = 0, 2 * PAIRS, 0  # the next vertex of each kind

    def stand(self, vertex, parts, image=(0, 0, 0)):
        place = plus(corner_of(self.slot), parts, PART)
        self.position[vertex] = tuple(x + i * cells * CELL for x, i, cells in zip(place, image, BOX))

    def move(self, vertex, parts):
        """From y = 4 to 12 parts."""
        self.stand(vertex, parts)
        self.velocity[vertex] = (0.0, 0.5 / DRIFT, 0.0)

    def stand_pair(self, x):
        """Along z through (x, 8), a few boxes away."""
        up, v = 1 if self.pair % 4 else -1, self.pair
        image = (v % 3 - 1, v // 2 % 4 - 2, v // 4 % 2)
        self.stand(v, (x, 8, -4 * up), image)
        self.stand(v + 1, (x, 8, 4 * up), image)
        self.pair += 2

    def move_pair(self):
        """Its vertex at x = 8 goes through y = 8 at half of its time, its pivot at x = 0 stays there."""
        odd = self.slot % 2
        self.stand(self.pair + 1 - odd, (0, 8, 0))
        self.move(self.pair + odd, (8, 4, 0))
        self.pair += 2

    def move_chain(self):
        """Its middle vertex does so at x = 0, both its neighbors at x = -8 and 8 stay."""
        side = 8 if self.slot % 2 else -8
        self.stand(self.chain, (side, 8, 0))
        self.move(self.chain + 1, (0, 4, 0))
        self.stand(self.chain + 2, (-side, 8, 0))
        self.chain += 3

    def stand_chain(self, y, bent):
        """Along z, its middle vertex where the moving bond is at the beginning, the middle, the end of its move."""
        image = (0, self.slot % 3 - 1, 2)
        for k, parts in enumerate(((4, y + bent, -4), (4, y, 0), (4, y, 4))):
            self.stand(self.chain + k, parts, image)
        self.chain += 3

    def build(self):
        for three in ((2, 5, 7), (2, 7, 5), (5, 2, 7), (5, 7, 2), (7, 2, 5), (7, 5, 2)):
            self.move_pair()
            for x in three:
                self.stand_pair(x)
            self.slot += 1
        for both in ((4, -4), (4, -4), (-4, 4), (-4, 4), (6, -3, 3, -6), (-6, 3, -3, 6)):
            self.move_chain()
            for x in both:
                self.stand_pair(x)
            self.slot += 1
        for y, bent in ((8, 0), (8, 1), (6, 0), (10, -1)):  # at x = 4 the moving bond goes from y = 6 to 10
            self.move_pair()
            self.stand_chain(y, bent)
            self.slot += 1
        return self


def put_sweep(pack):
    s = Scaffold().build()
    pack.put("sweep", "time", "dt", [DRIFT])
    pack.put("sweep", "order", "vertex", permuted(deviates(SEED, VERTEX_ORDER, 0, 1, len(s.position))))
    pack.put("sweep", "position", "x y z", s.position)
    pack.put("sweep", "velocity", "x y z", s.velocity)


# --- cells ---


def beside_face(dice, shift, k):
    """On a face of a cell, one lattice unit below it, or one above; along the other axes too, or anywhere."""
    place = []
    for axis in range(3):
        face = dice.number(BOX[axis]) * CELL
        beside = k // 3 % 3 - 1 if axis == k % 3 else dice.integer(1)
        at = face + dice.number(CELL) if axis != k % 3 and k % 2 == 0 else face + beside
        place.append((at - shift[axis]) % (BOX[axis] * CELL))
    return tuple(place)


def put_bin(pack):
    """Vertices are so many boxes away: none, a few, or nearly as many as a vertex may go."""
    dice, vertices = Dice(40), []
    shift = times(1 << 8, philox(SEED, GRID_SHIFT, 0, 1, 0)[:3])
    particles = [beside_face(dice, shift, k) for k in range(PARTICLES)]
    for k in range(2 * PAIRS + 3 * CHAINS):
        away = dice.point((0, 3, 300000)[k % 3])
        vertices.append(tuple(x + i * cells * CELL for x, i, cells in zip(beside_face(dice, shift, k), away, BOX)))
    pack.put("bin", "shift", "x y z", [shift])
    pack.put("bin", "solvent", "x y z", particles)
    pack.put("bin", "vertex", "x y z", vertices)


MODEL = SEED, BOX, PARTICLES, KINDS
OPERATORS = {"permutation": put_permutation, "crossing": put_crossing, "exchange": put_exchange, "sweep": put_sweep, "bin": put_bin}
