"""What constructed inputs are made with: dice, tables of a pack, fibers, bonds that touch a tick."""

import math

import numpy

from .exact import CELL, TICKS, dot, times

PART = CELL // 16
MASK = (1 << 64) - 1


class Dice:
    """Splitmix64 (Steele, Lea and Flood 2014)."""

    def __init__(self, seed):
        self.state = seed

    def ahead(self, n):
        """The next n numbers, as an array; they are not taken."""
        z = numpy.uint64(self.state) + numpy.arange(1, n + 1, dtype=numpy.uint64) * numpy.uint64(0x9E3779B97F4A7C15)
        z = (z ^ (z >> numpy.uint64(30))) * numpy.uint64(0xBF58476D1CE4E5B9)
        z = (z ^ (z >> numpy.uint64(27))) * numpy.uint64(0x94D049BB133111EB)
        return z ^ (z >> numpy.uint64(31))

    def skip(self, n):
        self.state = (self.state + n * 0x9E3779B97F4A7C15) & MASK

    def number(self, below=1 << 64):
        z = self.state = (self.state + 0x9E3779B97F4A7C15) & MASK
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9 & MASK
        z = (z ^ (z >> 27)) * 0x94D049BB133111EB & MASK
        return (z ^ (z >> 31)) % below

    def between(self, low, high):
        return low + (high - low) * ((self.number() >> 11) * 2.0**-53)

    def integer(self, size):
        """-size .. size"""
        return self.number(2 * size + 1) - size

    def point(self, size):
        return tuple(self.integer(size) for _ in range(3))

    def vector(self, size):
        return tuple(self.between(-size, size) for _ in range(3))

    def normal(self):
        """A unit vector, along an axis now and then."""
        n = self.vector(1.0)
        while math.sqrt(dot(n, n)) < 0.1:
            n = self.vector(1.0)
        if self.number(8) == 0:
            return ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, 1.0))[self.number(3)]
        return times(1.0 / math.sqrt(dot(n, n)), n)

    def place(self):
        """Along a bond: an end or the middle now and then."""
        k = self.number(8)
        return (0.0, 1.0, 0.5)[k] if k < 3 else self.between(0.0, 1.0)

    def velocity(self, moves):
        v = self.vector(2.0)
        return times(1.0 if self.number(8) and moves else 0.0, v)


MASSES = (1.0, 2.0, 5.0, 7.5, 100.25, 2.0**-4)


class Pack:
    """Tables that go in, as text (docs/port/formats.md)."""

    def __init__(self):
        self.lines = ["# uncross pack 2: operator step row table.component value"]

    def put(self, operator, table, columns, rows, step=1):
        for k, row in enumerate(rows):
            for word, value in zip(columns.split(), row if isinstance(row, (tuple, list)) else (row,)):
                self.lines.append(f"{operator} {step} {k} in.{table}.{word} {value!r}")

    def put_model(self, seed, box, particles, fibers):
        """fibers: (how many, vertices, ring, mass, bond length, spring, bending, force) of each kind."""
        chain, vertex = [], []
        for count, n, ring, *constants, force in fibers:
            for _ in range(count):
                first, fiber = len(chain), chain[-1][2] + 1 if chain else 0
                chain += [(first + k + 1, first + k - 1, fiber) for k in range(n)]
                chain[first] = (first + 1, first + n - 1 if ring else -1, fiber)
                chain[-1] = (first if ring else -1, first + n - 2, fiber)
                vertex += [(*map(float, constants), *map(float, force))] * n
        self.put("model", "box", "x y z", [box], 0)
        self.put("model", "numbers", "seed_low seed_high particles interval forbidden exclusion_paper",
                 [(seed & 0xFFFFFFFF, seed >> 32, particles, int(particles > 0), 1, 0)], 0)
        self.put("model", "reals", "time_step cosine sine acceleration_x acceleration_y acceleration_z",
                 [(0.0078125, 0.0, 1.0, 0.0, 0.0, 0.0)], 0)
        self.put("model", "chain", "next prev fiber", chain, 0)
        self.put("model", "vertex", "mass bond_length spring bending force_x force_y force_z", vertex, 0)

    def text(self):
        return "\n".join(self.lines) + "\n"


def construct(texts, operators):
    """The text of a pack, by a module's MODEL and its OPERATORS of these names."""
    pack = Pack()
    pack.put_model(*texts.MODEL)
    for name in operators:
        texts.OPERATORS[name](pack)
    return pack.text()


def corner_of(slot):
    """Slots of one cell each, some apart."""
    return (2 * (slot % 2) + 1) * CELL, slot // 2 % 5 * CELL, slot // 10 * CELL + 8 * PART
