#!/usr/bin/python3
"""The pack of constructed inputs (reference-data/edges.pack.h5) against exact arithmetic: Python's integers and fractions,
by docs/conventions.md and docs/port/packs.md alone. And whether it shows what it is made for: a port in doubles, in floats,
with ties the other way round must fail on it.
"""
import gzip
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
from fractions import Fraction

from packs import TOP, UNCROSS, check_constructed

sys.path.insert(0, str(TOP / "python"))
from uncross_construct.exact import CELL, cross, determinant, determinants, deviates, dot, minus, permuted, verdict  # noqa: E402

DATA = TOP / "reference-data"
NAMES = ("dense", "mixed", "coarse", "edges")
U = Fraction(1, 2**53)


def number(text):
    return int(text) if text.lstrip("-").isdigit() else float(text)


class Text:
    """The numbers of a pack in text: rows("crossing", 1, "in.from", "x y z") gives tuples."""

    def __init__(self, text):
        self.values = {}
        for line in text.splitlines():
            if not line.startswith("#"):
                name, step, row, component, value = line.split()
                self.values.setdefault((name, int(step)), {})[int(row), component] = number(value)

    def rows(self, name, step, table, columns="x y z"):
        at, words = self.values[name, step], columns.split()
        count = sum(1 for _, component in at if component == f"{table}.{words[0]}")
        return [tuple(at[row, f"{table}.{word}"] for word in words) for row in range(count)]


def in_doubles(triple):
    return determinant(*(tuple(map(float, v)) for v in triple))


def single(x):
    return struct.unpack("f", struct.pack("f", x))[0]


class EdgesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pack = Text(gzip.open(DATA / "edges.pack.txt.gz", "rt").read())
        points = [cls.pack.rows("crossing", 1, f"in.{name}") for name in ("from", "to", "pivot", "a", "b")]
        cls.flips = [flip for flip, in cls.pack.rows("crossing", 1, "in.flip", "flip")]
        cls.tests = list(zip(*points))
        cls.crosses = [found for found, in cls.pack.rows("crossing", 1, "out.crosses", "crosses")]

    def test_texts_are_those_of_this_code(self):
        """Every text of reference-data/ is the dump of the pack beside it."""
        for name in NAMES:
            text = gzip.open(DATA / f"{name}.pack.txt.gz", "rt").read()
            dump = subprocess.run([UNCROSS, "oracle", "dump", "--decimal", DATA / f"{name}.pack.h5"], check=True,
                                  capture_output=True, text=True).stdout
            self.assertEqual(text, dump, name)

    def test_pack_is_that_of_this_code(self):
        """`crossing` is constructed by tests/stress/stress_construct.py: half a minute."""
        check_constructed(self, "edges", "permutation", "exchange", "sweep", "bin")

    def test_starts_are_those_of_this_code(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in NAMES[:3]:
                path = pathlib.Path(folder) / name
                subprocess.run([UNCROSS, "oracle", "start", DATA / f"{name}.yaml", "-o", path], check=True)
                dump = subprocess.run([UNCROSS, "oracle", "dump", "--decimal", path], check=True, capture_output=True,
                                      text=True).stdout
                self.assertEqual(gzip.open(DATA / f"{name}.start.txt.gz", "rt").read(), dump, name)

    # --- crossing ---

    def test_verdicts_are_exact(self):
        for row, (points, flip, found) in enumerate(zip(self.tests, self.flips, self.crosses)):
            self.assertEqual(verdict([determinant(*t) for t in determinants(*points)], flip), bool(found), row)

    def test_verdicts_in_scenes_are_exact(self):
        for name in NAMES[:3]:
            pack = Text(gzip.open(DATA / f"{name}.pack.txt.gz", "rt").read())
            tested = 0
            for place in [place for place in pack.values if place[0] == "crossing"]:
                points = [pack.rows(*place, f"in.{k}") for k in ("from", "to", "pivot", "a", "b")]
                flips, found = pack.rows(*place, "in.flip", "flip"), pack.rows(*place, "out.crosses", "crosses")
                for row, at in enumerate(zip(*points)):
                    signs = [determinant(*t) for t in determinants(*at)]
                    self.assertEqual(verdict(signs, flips[row][0]), bool(found[row][0]), (name, place, row))
                    self.assertEqual(found[row][0], 1 - row % 2)
                    tested += 1
            self.assertGreater(tested, 4, name)

    def test_doubles_fail(self):
        """In 360 rows and more the verdict of doubles is wrong; for each determinant there are 72 that its exact sign alone
        mends. Differences of 2^49 overflow 128 bits in some."""
        wrong, decides, zeros, overflows = 0, [0] * 5, 0, 0
        for points, flip, found in zip(self.tests, self.flips, self.crosses):
            triples = determinants(*points)
            exact, rounded = [determinant(*t) for t in triples], [in_doubles(t) for t in triples]
            zeros += 0 in exact
            if verdict(rounded, flip) == bool(found):
                continue
            wrong += 1
            for k in range(5):
                other = list(rounded)
                other[k] = exact[k]
                decides[k] += verdict(other, flip) == bool(found)
            wrapped = [((d + 2**127) % 2**128) - 2**127 for d in exact]
            overflows += verdict(wrapped, flip) != bool(found)
        self.assertEqual(len(self.tests), 540)
        self.assertGreaterEqual(wrong, 360)
        self.assertTrue(all(k >= 72 for k in decides), decides)
        self.assertGreaterEqual(zeros, 200)
        self.assertGreaterEqual(overflows, 20)

    def test_other_rules_of_zero_fail(self):
        rules = {"zero is negative": lambda signs, flip: verdict([d if d else -1 for d in signs], flip),
                 "no flip": lambda signs, flip: verdict(signs, 0)}
        for name, rule in rules.items():
            wrong = sum(rule([determinant(*t) for t in determinants(*points)], flip) != bool(found)
                        for points, flip, found in zip(self.tests, self.flips, self.crosses))
            self.assertGreaterEqual(wrong, 30, name)

    def test_contacts(self):
        """t_I, s, s' and n against fractions: within 64 u K."""
        hits = self.pack.rows("crossing", 1, "out.hit", "time s s_standing normal_x normal_y normal_z")
        conditions = self.pack.rows("crossing", 1, "bound.hit", "condition")
        for row, (points, found, hit) in enumerate(zip(self.tests, self.crosses, hits)):
            if not found:
                self.assertEqual(set(hit), {0.0})
                continue
            start, end, pivot, a, b = points
            before, after = (determinant(*t) for t in determinants(*points)[:2])
            time = Fraction(before, before - after)
            at = tuple(x + time * m for x, m in zip(minus(start, a), minus(end, start)))
            p, q = minus(minus(pivot, a), at), minus(b, a)
            pp, pq, qq, pt, qt = dot(p, p), dot(p, q), dot(q, q), dot(p, at), dot(q, at)
            nominator = pp * qq - pq * pq
            s, standing = (pq * qt - qq * pt) / nominator, (pp * qt - pq * pt) / nominator
            n = cross(p, q)
            length = Fraction(float(dot(n, n)) ** 0.5)
            sign = 1 if dot(n, minus(end, start)) >= 0 else -1
            wanted = [time, *(min(max(x, 0), 1) for x in (s, standing)), *(sign * x / length for x in n)]
            tolerance = 64 * U * Fraction(conditions[row][0])
            for k in range(6):
                self.assertLessEqual(abs(Fraction(hit[k]) - wanted[k]), tolerance, (row, k))

    # --- exchange ---

    def test_exchanges(self):
        """dP and the velocities after it in fractions: the formula, and what it conserves."""
        velocity = [self.pack.rows("exchange", 1, f"in.{k}") for k in ("moving", "pivot", "a", "b")]
        after = [self.pack.rows("exchange", 1, f"out.{k}") for k in ("moving", "pivot", "a", "b")]
        mass = self.pack.rows("exchange", 1, "in.mass", "moving pivot a b")
        contact = self.pack.rows("exchange", 1, "in.contact", "s s_standing")
        normal, momentum = self.pack.rows("exchange", 1, "in.normal"), self.pack.rows("exchange", 1, "out.momentum", "momentum")
        signs = set()
        for row, (s, standing) in enumerate(contact):
            s, standing = Fraction(s), Fraction(standing)
            lever = [1 - s, s, standing - 1, -standing]
            n = [Fraction(x) for x in normal[row]]
            m = [Fraction(x) for x in mass[row]]
            v = [[Fraction(x) for x in velocity[k][row]] for k in range(4)]
            size = sum(l * l / w for l, w in zip(lever, m))
            impulse = 2 * sum(l * dot(w, n) for l, w in zip(lever, v)) / size
            signs.add((impulse > 0) - (impulse < 0))
            room = 200 * U * (1 + 1 / size) * 200  # some 100 roundings of sizes up to 12; this is about the formula
            self.assertLessEqual(abs(Fraction(momentum[row][0]) - impulse), room, row)
            for k in range(4):
                for c in range(3):
                    wanted = v[k][c] - lever[k] * impulse / m[k] * n[c]
                    self.assertLessEqual(abs(Fraction(after[k][row][c]) - wanted), room / m[k], (row, k, c))
            energy = [sum(w * dot(x, x) for w, x in zip(m, u)) for u in (v, [after[k][row] for k in range(4)])]
            self.assertAlmostEqual(float(energy[0]), float(energy[1]), delta=1e-10 * (1 + float(energy[0])))
        self.assertEqual(signs, {-1, 0, 1})

    # --- ties ---

    def test_ties(self):
        """Hits at the same time: over one bond and over both, the executed one by numbers; no other simple rule gives it."""
        events = self.pack.rows("sweep", 1, "out.event", "vertex moving standing image_x image_y image_z executed")
        hits = self.pack.rows("sweep", 1, "out.hit", "time s s_standing")
        moves = {}
        for event, hit in zip(events, hits):
            moves.setdefault(event[0], []).append((event, hit))
        tied = [found for found in moves.values() if len(found) > 1]
        self.assertGreaterEqual(len(tied), 12)
        rules = {"largest": lambda e, h: tuple(-x for x in e[1:6]), "nearest": lambda e, h: h[1], "farthest": lambda e, h: -h[1],
                 "standing first": lambda e, h: (e[2], e[1]), "image first": lambda e, h: e[3:6]}
        differs = dict.fromkeys(rules, 0)
        for found in tied:
            self.assertEqual({hit[0] for _, hit in found}, {0.5})
            self.assertEqual([e[1:6] for e, _ in found], sorted(e[1:6] for e, _ in found))
            self.assertEqual([e[6] for e, _ in found], [1] + [0] * (len(found) - 1))
            for name, rule in rules.items():
                differs[name] += min(found, key=lambda pair: rule(*pair)) is not found[0]
        self.assertTrue(all(count >= 2 for count in differs.values()), differs)
        self.assertTrue(any(abs(k) > 1 for event in events for k in event[3:6]))

    # --- cells ---

    def test_cells(self):
        box, = self.pack.rows("model", 0, "in.box")
        shift, = self.pack.rows("bin", 1, "in.shift")

        def cell(position, rounding, fold):
            x, y, z = (fold(rounding(p + s), n) for p, s, n in zip(position, shift, box))
            return (z * box[1] + y) * box[0] + x

        def floor(p, n):
            return int(p // CELL) % n

        below, wrong_single, wrong_double, wrong_cut = 0, 0, 0, 0
        for kind in ("solvent", "vertex"):
            positions, cells = self.pack.rows("bin", 1, f"in.{kind}"), self.pack.rows("bin", 1, f"out.{kind}", "cell")
            for position, (found,) in zip(positions, cells):
                self.assertEqual(cell(position, int, floor), found)
                below += any((p + s) % CELL == CELL - 1 for p, s in zip(position, shift))
                wrong_single += cell(position, lambda p: int(single(float(p))), floor) != found
                wrong_double += cell(position, lambda p: int(float(p)), floor) != found
                wrong_cut += cell(position, int, lambda p, n: (abs(p) // CELL * (1 if p > 0 else -1)) % n) != found
        self.assertGreaterEqual(below, 80)
        self.assertGreaterEqual(wrong_single, 60)
        self.assertGreaterEqual(wrong_double, 10)
        self.assertGreaterEqual(wrong_cut, 10)

    # --- a permutation ---

    def test_permutation(self):
        """Fisher and Yates with exact indices, and by four ways in single precision."""
        (purpose, draw, step, size), = self.pack.rows("permutation", 1, "in.address", "purpose draw step size")
        (low, high), = self.pack.rows("model", 0, "in.numbers", "seed_low seed_high")

        numbers = deviates(low | high << 32, purpose, draw, step, size)
        found = [k for k, in self.pack.rows("permutation", 1, "out.order", "entry")]
        self.assertEqual(permuted(numbers), found)
        for way in (lambda r: single(r * 2.0**-64), lambda r: single((r >> 32) * 2.0**-32), lambda r: (r >> 40) * 2.0**-24,
                    lambda r: single(((r >> 12) + 0.5) * 2.0**-52)):
            self.assertNotEqual(permuted(numbers, lambda r, n, way=way: min(int(single(way(r) * n)), n - 1)), found)


if __name__ == "__main__":
    unittest.main()
