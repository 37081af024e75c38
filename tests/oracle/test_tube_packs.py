#!/usr/bin/python3
"""The pack and the trace of thick fibers: they are those of this code, and what they say is true in Python's fractions: up to the
tick of an answer the axes are further apart than the reach, and within the tick they come near it.
"""
import gzip
import math
import unittest
from fractions import Fraction

from packs import TOP, check_made_but_for, run
from test_edges import Text  # and so the next module is found
from uncross_construct.exact import TICKS, at_tick, cross, dot, plus, times

DATA = TOP / "reference-data/tubes"
STEPS = (2, 40)
VECTORS = ("p", "q", "w", "p_rate", "q_rate", "w_rate")


def to_segment(point, bond):
    """Squared distance of a point from a bond that begins at the origin, exactly."""
    length = dot(bond, bond)
    s = min(max(Fraction(dot(point, bond), length), 0), 1) if length else 0
    gap = plus(point, bond, -s)
    return dot(gap, gap)


def squared_distance(p, q, w):
    """Of two bonds, exactly: the least of four ends against the other bond, and of the insides of both."""
    back = times(-1, w)
    found = [to_segment(w, p), to_segment(plus(w, q), p), to_segment(back, q), to_segment(plus(back, p), q)]
    pp, qq, pq, pw, qw = dot(p, p), dot(q, q), dot(p, q), dot(p, w), dot(q, w)
    under = pp * qq - pq * pq
    if under > 0:
        s, t = Fraction(pw * qq - pq * qw, under), Fraction(pq * pw - pp * qw, under)
        if 0 <= s <= 1 and 0 <= t <= 1:
            gap = plus(plus(w, q, t), p, -s)
            found.append(dot(gap, gap))
    return min(found)


class TubePacks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pack = Text(gzip.open(DATA / "mixed.pack.txt.gz", "rt").read())

    def searches(self, step):
        """p, q, w and rates; reach; first tick; answer."""
        rows = zip(*(self.pack.rows("tube_search", step, f"in.{name}") for name in VECTORS))
        numbers = zip(*(self.pack.rows("tube_search", step, *names) for names in
                        (("in.reach", "reach"), ("in.from", "tick"), ("out.tick", "tick"))))
        return [(row, *(value for value, in number)) for row, number in zip(rows, numbers)]

    def test_they_are_those_of_this_code(self):
        check_made_but_for(self, DATA, "mixed", "tube_search", "tube_contact")
        status, said = run("trace", DATA / "mixed.yaml")
        self.assertEqual(status, 0, said)
        self.assertEqual(said.splitlines(), (DATA / "mixed.trace.csv").read_text().splitlines())

    def test_never_late(self):
        """At the answer, and at some twenty times before it, the axes are apart. So they are where there is none."""
        seen = 0
        for step in STEPS:
            for row, reach, first, tick in self.searches(step):
                if not any(any(rate) for rate in row[3:]):
                    self.assertEqual(tick, TICKS)
                    continue
                times = {first + (tick - first) * k // 19 for k in range(20)} | {max(first, tick - k) for k in range(3)}
                for time in times:
                    self.assertGreater(squared_distance(*at_tick(row, time)), reach * reach)
                    seen += 1
        self.assertGreater(seen, 5000)

    def test_not_invented(self):
        """Within the tick of the answer, or at its end, the axes come within the reach and a doubt of 2 + 2 v^2/reach units."""
        answers = 0
        for step in STEPS:
            for row, reach, _, tick in self.searches(step):
                if tick < TICKS:
                    way = sum(math.sqrt(dot(rate, rate)) for rate in row[3:])
                    doubt = 3 + 2 * way * way / reach
                    near = min(squared_distance(*at_tick(row, tick + Fraction(k, 16))) for k in range(17))
                    self.assertLessEqual(near, Fraction(reach + doubt + way / 32) ** 2)
                    answers += 1
        self.assertGreater(answers, 300)

    def test_contacts(self):
        """s and t are of a shortest line, and n is along it."""
        for step in STEPS:
            names = (("in.p",), ("in.q",), ("in.w",), ("out.contact", "s t"), ("out.normal",))
            rows = list(zip(*(self.pack.rows("tube_contact", step, *name) for name in names)))
            self.assertGreaterEqual(len(rows), 100)
            parallel = 0
            for p, q, w, (s, t), n in rows:
                gap = plus(plus(w, q, Fraction(t)), p, -Fraction(s))
                size, least = math.sqrt(dot(gap, gap)), math.sqrt(squared_distance(p, q, w))
                self.assertLess(size, least * (1 + 1e-9))
                for x, y in zip(gap, n):
                    self.assertAlmostEqual(float(x) / size, y, delta=1e-8)
                if not any(cross(p, q)) and 0 < s < 1:
                    along = sorted((0, 1, Fraction(dot(w, p), dot(p, p)), Fraction(dot(plus(w, q), p), dot(p, p))))
                    self.assertAlmostEqual(s, float(along[1] + along[2]) / 2, delta=1e-12)
                    parallel += 1
            self.assertGreaterEqual(parallel, 15)


if __name__ == "__main__":
    unittest.main()
