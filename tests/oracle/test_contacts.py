#!/usr/bin/python3
"""The pack of contacts at their own time (reference-data/contacts.pack.h5) against exact arithmetic: Python's integers and
fractions, by docs/port/contacts.md alone. And whether it shows what it is made for."""
import gzip
import sys
import unittest
from fractions import Fraction

from packs import TOP, check_constructed
from test_edges import Text

sys.path.insert(0, str(TOP / "python"))
from uncross_construct.exact import TICKS, at_tick, coefficients, dot, is_excluded, one_sign, plus  # noqa: E402

DATA = TOP / "reference-data"
U = Fraction(1, 2**53)
ENDS = ("p0", "p1", "q0", "q1")


def all_excluded(row, first, last):
    if first == last or is_excluded(row, first, last):
        return True
    middle = (first + last) // 2
    return last - first > 1 and all_excluded(row, first, middle) and all_excluded(row, middle, last)


class Contacts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pack = Text(gzip.open(DATA / "contacts.pack.txt.gz", "rt").read())
        names = ("p", "q", "w", "p_rate", "q_rate", "w_rate")
        cls.searches = list(zip(*(cls.pack.rows("contact_search", 1, f"in.{name}") for name in names)))
        cls.first = [tick for tick, in cls.pack.rows("contact_search", 1, "in.from", "tick")]
        cls.ticks = [tick for tick, in cls.pack.rows("contact_search", 1, "out.tick", "tick")]

    def test_pack_is_that_of_this_code(self):
        """`contact_search` is constructed by tests/stress/stress_construct.py."""
        check_constructed(self, "contacts", "impulse", "event_drift")

    # --- searches ---

    def test_ticks(self):
        """The first tick that is not excluded."""
        self.assertGreaterEqual(len(self.ticks), 300)
        for row, (search, first, tick) in enumerate(zip(self.searches, self.first, self.ticks)):
            if not any(any(rate) for rate in search[3:]):
                self.assertEqual(tick, TICKS)
                continue
            self.assertTrue(first <= tick <= TICKS, row)
            self.assertTrue(all_excluded(search, first, tick), row)
            if tick < TICKS:
                self.assertFalse(is_excluded(search, tick, tick + 1), row)

    def test_searches_show_what_matters(self):
        alone, doubles, none = [0, 0], 0, 0
        for search, tick in zip(self.searches, self.ticks):
            none += tick == TICKS
            if tick == TICKS or not any(any(rate) for rate in search[3:]):
                continue
            a, b = at_tick(search, tick), at_tick(search, tick + 1)
            alone[0] += one_sign(coefficients(at_tick(search, max(tick - 1, 0)), a))
            doubles += one_sign(coefficients(*([tuple(map(float, v)) for v in knot] for knot in (a, b))))
        self.assertGreaterEqual(alone[0], 60)
        self.assertGreaterEqual(doubles, 40)
        self.assertGreaterEqual(none, 50)
        self.assertGreaterEqual(self.ticks.count(0), 8)
        self.assertGreaterEqual(self.ticks.count(TICKS - 1), 12)
        self.assertGreaterEqual(sum(first > 0 for first in self.first), 30)

    # --- impulses ---

    def test_impulses(self):
        """In fractions: the answer, dP, momentum, and the rebound."""
        rows = {name: self.pack.rows("impulse", 1, name) for end in ENDS for name in (f"in.{end}", f"in.force_{end}", f"out.{end}")}
        mass = self.pack.rows("impulse", 1, "in.mass", " ".join(ENDS))
        contact, normal = self.pack.rows("impulse", 1, "in.contact", "s t"), self.pack.rows("impulse", 1, "in.normal")
        tau, momentum = self.pack.rows("impulse", 1, "in.tau", "tau"), self.pack.rows("impulse", 1, "out.momentum", "momentum")
        answers = [a for a, in self.pack.rows("impulse", 1, "out.answer", "answer")]
        for row, (s, t) in enumerate(contact):
            s, t, n, m = Fraction(s), Fraction(t), [Fraction(x) for x in normal[row]], [Fraction(x) for x in mass[row]]
            lever = [1 - s, s, t - 1, -t]
            v, f, after = ([[Fraction(x) for x in rows[name + end][row]] for end in ENDS] for name in ("in.", "in.force_", "out."))
            a = sum(l * dot(x, n) for l, x in zip(lever, v))
            h = Fraction(tau[row][0]) * sum(l * dot(x, n) / w for l, x, w in zip(lever, f, m))
            size = sum(l * l / w for l, w in zip(lever, m))
            if a <= 0:
                self.assertEqual((answers[row], momentum[row][0]), (0, 0), row)
                self.assertEqual(v, after)
                continue
            straight, wanted = a + 2 * h, 1
            if straight * 5 < a or straight > 5 * a:
                wanted = 2
                straight = a * abs(h) / (abs(h) + Fraction(8, 5) * a * (1 if h < 0 else -1))
            self.assertEqual(answers[row], wanted, row)
            room = 1000 * U * (1 + sum(map(abs, lever)) * 20 + 30 * abs(h)) / size
            self.assertLessEqual(abs(Fraction(momentum[row][0]) - (a + straight) / size), room, row)
            for k in range(4):
                change = plus(after[k], v[k], -1)
                for c in range(3):
                    self.assertLessEqual(abs(change[c] + lever[k] * (a + straight) / size / m[k] * n[c]), 2 * room / m[k] + 20 * U)
        for kind, least in ((0, 10), (1, 50), (2, 30)):
            self.assertGreaterEqual(answers.count(kind), least)

    # --- a drift ---

    def test_drift(self):
        events = self.pack.rows("event_drift", 1, "out.event", "tick bond other image_x image_y image_z")
        start, end, velocity = (self.pack.rows("event_drift", 1, name) for name in ("in.position", "out.position", "in.velocity"))
        (time, begin), = self.pack.rows("event_drift", 1, "in.time", "dt start")
        following = [next_one for next_one, in self.pack.rows("model", 0, "in.chain", "next")]
        self.assertEqual(begin, -time / 2)
        self.assertEqual(events, sorted(events))
        self.assertGreaterEqual(len(events), 40)
        self.assertGreaterEqual(max(sum(e[0] == tick for e in events) for tick in {e[0] for e in events}), 10)
        self.assertTrue(any(max(map(abs, e[3:])) > 1 for e in events))
        self.assertTrue(all(e[1] < e[2] for e in events))
        touched = {v for e in events for bond in e[1:3] for v in (bond, following[bond])}
        bent = []
        for vertex, (a, b, v) in enumerate(zip(start, end, velocity)):
            straight = tuple(x + TICKS * round(Fraction(time) * Fraction(y) * 2**24) for x, y in zip(a, v))
            if straight != b and vertex not in touched:
                bent.append(vertex)
        self.assertEqual(len(bent), 6 + 12)  # three clusters, of three bonds each, two of which join: they have no rows

    FAR = 214  # the first of the last 16 vertices

    def test_bonds_that_are_long_for_their_box(self):
        """They touch in an image that is not the nearest one: their first ends are further apart than half of the edge."""
        events = self.pack.rows("event_drift", 1, "out.event", "bond other image_x image_y image_z")
        start = self.pack.rows("event_drift", 1, "in.position")
        edge = self.pack.rows("model", 0, "in.box")[0][2] << 40
        self.assertIn((self.FAR, self.FAR + 2, 0, 0, 0), events)
        apart = start[self.FAR + 2][2] - start[self.FAR][2]
        self.assertEqual(round(Fraction(apart, edge)), 1)

    def test_clusters_that_fly_and_join(self):
        """A pair is one cluster from tick 2 on, at the mean rate of its ends, cut toward zero; when the needle of the one meets that of
        the other, all have the rate of the first."""
        start, end, velocity = (self.pack.rows("event_drift", 1, name) for name in ("in.position", "out.position", "in.velocity"))
        (time,), = self.pack.rows("event_drift", 1, "in.time", "dt")
        rate = [tuple(int(Fraction(time) * Fraction(y) * 2**24) for y in v) for v in velocity]
        first, second = range(self.FAR + 4, self.FAR + 8), range(self.FAR + 10, self.FAR + 14)
        means = [tuple(Fraction(sum(rate[v][c] for v in pair), 4) for c in range(3)) for pair in (first, second)]
        cut = [tuple(map(int, mean)) for mean in means]  # int() cuts toward zero
        self.assertNotIn(cut[0], ((0, 0, 0), tuple(map(round, means[0])), tuple(x.numerator // x.denominator for x in means[0])))
        for v in first:
            self.assertEqual(end[v], plus(plus(start[v], rate[v], 2), cut[0], TICKS - 2))
        ticks = set()
        for v in second:
            alone = plus(plus(start[v], rate[v], 2), cut[1], TICKS - 2)
            moved = plus(end[v], alone, -1)
            late = Fraction(moved[1], cut[0][1] - cut[1][1])  # ticks with the rate of the first
            self.assertEqual(moved, tuple(late * (a - b) for a, b in zip(*cut)))
            ticks.add(TICKS - late)
        self.assertEqual(len(ticks), 1)
        self.assertTrue(30000 < min(ticks) < 60000 and min(ticks).denominator == 1, ticks)


if __name__ == "__main__":
    unittest.main()
