#!/usr/bin/python3
"""The pack of fibers around a bead: it is that of this code, and what it says is true in Python's fractions. Up to the tick of an answer
the bond is further from the center than the reach, and within the tick it comes near it; contacts are at the nearest point; impulses
keep momentum, and turn the velocity of the contact round.
"""
import gzip
import math
import unittest
from fractions import Fraction

from packs import TOP, check_made_but_for
from test_edges import Text
from test_tube_packs import to_segment
from uncross_construct.exact import TICKS, at_tick, dot, plus

DATA = TOP / "reference-data/beads"
STEPS = (1, 1200)
VECTORS = ("p", "q", "w", "p_rate", "q_rate", "w_rate")


class BeadPacks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pack = Text(gzip.open(DATA / "company.pack.txt.gz", "rt").read())

    def searches(self, step):
        """p, q, w and rates; reach; first tick; answer."""
        rows = zip(*(self.pack.rows("bead_search", step, f"in.{name}") for name in VECTORS))
        numbers = zip(*(self.pack.rows("bead_search", step, *names) for names in
                        (("in.reach", "reach"), ("in.from", "tick"), ("out.tick", "tick"))))
        return [(row, *(value for value, in number)) for row, number in zip(rows, numbers)]

    def test_it_is_that_of_this_code(self):
        check_made_but_for(self, DATA, "company", "bead_search", "bead_contact")

    def test_never_late_and_not_invented(self):
        apart, answers, of_the_run = 0, 0, 0
        for step in STEPS:
            for row, reach, first, tick in self.searches(step):
                self.assertFalse(any(row[1]) or any(row[4]))  # a point
                if not any(any(rate) for rate in row[3:]):
                    self.assertEqual(tick, TICKS)
                    continue
                for time in {first + (tick - first) * k // 19 for k in range(20)} | {max(first, tick - k) for k in range(3)}:
                    p, _, w = at_tick(row, time)
                    self.assertGreater(to_segment(w, p), reach * reach)
                    apart += 1
                if tick < TICKS:
                    way = sum(math.sqrt(dot(rate, rate)) for rate in row[3:])
                    times = (at_tick(row, tick + Fraction(k, 16)) for k in range(17))
                    near = min(to_segment(w, p) for p, _, w in times)
                    self.assertLessEqual(near, Fraction(reach + 3 + 2 * way * way / reach + way / 32) ** 2)
                    answers += 1
                of_the_run += reach in (2 * 2**40, round(2.175 * 2**40), round(2.05 * 2**40), round(2.1 * 2**40))
        self.assertGreater(apart, 5000)
        self.assertGreater(answers, 300)
        self.assertGreater(of_the_run, 150)

    def test_contacts(self):
        """s is that of the nearest point, t is 0, and n points from there to the center."""
        for step in STEPS:
            rows = zip(*(self.pack.rows("bead_contact", step, *name) for name in
                         (("in.p",), ("in.w",), ("out.contact", "s t"), ("out.normal",))))
            ends = 0
            for p, w, (s, t), n in rows:
                gap = plus(w, p, -Fraction(s))
                size = math.sqrt(dot(gap, gap))
                self.assertEqual(t, 0)
                self.assertLess(size, math.sqrt(to_segment(w, p)) * (1 + 1e-12))
                for x, y in zip(gap, n):
                    self.assertAlmostEqual(float(x) / size, y, delta=1e-12)
                ends += s in (0, 1)
            self.assertGreaterEqual(ends, 40)

    def test_impulses(self):
        """Momentum and, where no force acts and the rebound is not softened, the energy of bond and bead are kept."""
        names = [(name,) for end in ("p0", "p1", "q0", "q1") for name in (f"in.{end}", f"out.{end}", f"in.force_{end}")]
        names += [("in.mass", "p0 p1 q0 q1"), ("in.contact", "s t"), ("in.normal",), ("in.tau", "tau"), ("out.answer", "answer")]
        rows = list(zip(*(self.pack.rows("impulse", STEPS[1], *name) for name in names)))
        self.assertGreater(len(rows), 50)
        plain = 0
        for *ends, mass, (s, t), n, (tau,), (answer,) in rows:
            before, after, force = ends[0::3], ends[1::3], ends[2::3]
            self.assertEqual(t, 0)
            self.assertEqual(before[3], after[3])
            self.assertEqual(mass[3], 1)
            for axis in range(3):
                gain = sum(m * (b[axis] - a[axis]) for m, a, b in zip(mass, before, after))
                self.assertAlmostEqual(gain, 0, delta=1e-12 * mass[2])
            if answer == 0:
                continue
            lever = (1 - s, s, -1)

            def approach(velocity, shifted):
                return sum(x * (dot(v, n) + shifted * dot(f, n) / m) for x, v, f, m in zip(lever, velocity, force, mass))

            self.assertGreater(approach(before, 0.0), 0)
            self.assertLess(approach(after, 0.0), 0)
            if answer == 1:
                self.assertAlmostEqual(approach(before, tau), -approach(after, tau), delta=1e-10)
                plain += 1
        self.assertGreater(plain, 30)


if __name__ == "__main__":
    unittest.main()
