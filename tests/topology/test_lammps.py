#!/usr/bin/python3
"""Trajectories that LAMMPS has written, a frame of every step: bonds that repel each other (pair style srp), and bonds that feel nothing.

lammps/chains.yaml makes the start (`uncross run --steps 0`, `export --format lammps --wrapped`), lammps/chains.lammps the frames. The crossings are those of a loop over
all pairs and images, decided over the rationals (sturm.py).
"""
import functools
import itertools
import pathlib
import re
import sys
import unittest

import numpy

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[k]) for k in (0, 1)]
from support import uncross  # noqa: E402
from test_search import by_all_images  # noqa: E402

FILES = pathlib.Path(__file__).resolve().parent / "lammps"
VERTICES, EDGE, UNIT = 5, 3, 2**32
BONDS = [[k, k + 1] for k in range(50) if (k + 1) % VERTICES]


def read(name):
    """[frame][atom] of whole multiples of 2^-32 a0, by a reader of its own."""
    frames = []
    for text in (FILES / name).read_text().split("ITEM: ATOMS id xu yu zu\n")[1:]:
        rows = sorted((line.split() for line in text.partition("ITEM")[0].splitlines()), key=lambda row: int(row[0]))
        frames.append([[round(float(x) * UNIT) for x in row[1:]] for row in rows])
    return frames


@functools.lru_cache
def count(name):
    """Crossings, their sum of signs, and touches, of all intervals."""
    crossed = net = touches = 0
    for first, last in itertools.pairwise(read(name)):
        home = [[first[k - k % VERTICES][d] // (EDGE * UNIT) * EDGE * UNIT for d in range(3)] for k in range(len(first))]  # chains begin in the box
        places = [[[x - h for x, h in zip(frame[k], home[k])] for frame in (first, last)] for k in range(len(first))]
        found = by_all_images(BONDS, places, numpy.full((2, 3), EDGE * UNIT), (1, 1, 1), (0, 0), 2)
        crossed += sum(len(signs) for signs, _ in found.values())
        net += sum(sum(signs) for signs, _ in found.values())
        touches += sum(touched for _, touched in found.values())
    return crossed, net, touches


class Lammps(unittest.TestCase):
    def judge(self, name, code):
        done = uncross("topology", FILES / name, "--bonds", FILES / "chains.data")
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        row = re.search(r"^ *1 +12 +(\d+) +(-?\d+) +\d+ +(\d+) ", done.stdout, re.M)
        self.assertEqual(tuple(map(int, row.groups())), count(name))
        return done.stdout

    def test_bonds_that_repel_do_not_cross(self):
        self.assertIn("verdict: no crossing; if vertices move straight in a step, none is possible", self.judge("srp.dump", 0))

    def test_bonds_that_feel_nothing_cross(self):
        self.assertIn("verdict: CROSSED: if vertices move straight in a step, this code lets bonds through", self.judge("ghosts.dump", 10))
        self.assertEqual(count("ghosts.dump")[:2], (5, -1))


if __name__ == "__main__":
    unittest.main()
