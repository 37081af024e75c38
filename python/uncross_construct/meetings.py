"""The pack `topology/meetings`: pairs of bonds at two frames, of each kind of verdict. No row has bonds that are parallel when their lines
meet, or that stay in one plane."""

from uncross_topology import exact

from .exact import plus, times
from .inputs import Dice, Pack

SEED, BOX = 20111111, (4, 4, 4)
KINDS = [(2, 2, False, 1.5, 0, 30, 0, (0, 0, 0))]
BOND = 1 << 39  # half an a0
NAMES = "p", "q", "w", "p_last", "q_last", "w_last"


def polynomials(row):
    """f, and the bounds of both places: 0 and above within the bonds."""
    p, q, w = (exact.linear(row[k], row[k + 3]) for k in range(3))
    n = exact.cross(p, q)
    square, on = exact.dot(n, n), (exact.dot(exact.cross(w, q), n), exact.dot(exact.cross(w, p), n))
    return exact.dot(n, w), [bound for a in on for bound in (a, exact.plus(square, a, -1))]


class Rows:
    def __init__(self, seed):
        self.dice, self.rows = Dice(seed), []

    def pair(self, move):
        """Bonds of usual length with their middles near each other; each vector changes by up to `move`."""
        p, q, apart = (self.dice.point(BOND) for _ in range(3))
        w = tuple(a // 2 + (b - c) // 2 for a, b, c in zip(apart, p, q))
        return [p, q, w, *(plus(v, self.dice.point(move)) for v in (p, q, w))]

    def draw(self, count, move, fits):
        found = 0
        while found < count:
            row = self.pair(move)
            f, bounds = polynomials(row)
            seen = exact.meetings(*(exact.linear(row[k], row[k + 3]) for k in range(3)))
            if not seen.touched and fits(f, bounds, seen.crossings):
                self.rows.append(row)
                found += 1

    def beside(self, count, which):
        """The lines meet beyond this end of one bond, and within the other: whoever does not look there sees a crossing."""
        def fits(f, bounds, crossings):
            roots = exact.roots(f)
            return not crossings and len(roots) == 1 and [exact.sign_at(bound, roots[0])[0] < 0 for bound in bounds] == [k == which for k in range(4)]
        self.draw(count, BOND, fits)

    def near_ends(self):
        """The lines meet 10^-9 of a bond within it, and beyond it; at each of the four ends."""
        for which in range(4):
            for beyond in (-1, 1):
                p, q = (BOND, 3, 5), (7, BOND, 11)
                place = beyond * BOND // 10**9
                at = (-place, BOND + place)[which % 2]
                s, other = (at, BOND // 3) if which < 2 else (BOND // 3, at)
                w = (s, -other)
                rows = [(*w, height) for height in (BOND // 7 + 1, -BOND // 5)]
                self.rows.append([p, q, rows[0], p, q, rows[1]])

    def double_roots(self, unit):
        """q turns over while it passes above p: f is (2t - 1)^2, a little more, a little less."""
        for more in (0, unit >> 10, -(unit >> 10)):
            self.rows.append([(8 * unit, 0, 0), (unit, 2 * unit, -4 * unit), (3 * unit, -unit // 2, 2 * unit + more),
                              (8 * unit, 0, 0), (unit, 2 * unit, 4 * unit), (3 * unit, -3 * unit // 2, -2 * unit + more)])

    def special(self, unit):
        """q falls through p from one height to another, at an end of the one, of the other, or of both; or ends in it, or begins in it."""
        for heights, places in ((((-1, 1), (-1, 2), (3, -4)), ((0, -1), (2, -1), (1, 0), (1, -2), (0, 0), (2, -2), (0, -2))), (((-1, 0), (0, 1), (2, 0), (0, -3)), ((1, -1),))):
            for first, last in heights:
                for x, y in places:
                    self.rows.append([times(unit, v) for v in ((2, 0, 0), (0, 2, 0), (x, y, first), (2, 0, 0), (0, 2, 0), (x, y, last))])


def put_meeting(pack):
    rows = Rows(41)
    for move in (BOND, BOND >> 4, BOND >> 10):
        rows.draw(16, move, lambda f, bounds, crossings: len(crossings) == 1)
    rows.draw(12, 2 * BOND, lambda f, bounds, crossings: len(crossings) == 2)
    rows.draw(2, 2 * BOND, lambda f, bounds, crossings: len(crossings) == 3)
    rows.draw(10, BOND, lambda f, bounds, crossings: not crossings and len(exact.roots(f)) == 0)
    rows.draw(8, 2 * BOND, lambda f, bounds, crossings: len(crossings) == 1 and len(exact.roots(f)) > 1)
    for which in range(4):
        rows.beside(6, which)
    rows.near_ends()
    rows.double_roots(1 << 36)
    rows.special(1 << 38)
    for k, name in enumerate(NAMES):
        pack.put("meeting", name, "x y z", [row[k] for row in rows.rows])


MODEL = SEED, BOX, 0, KINDS
OPERATORS = {"meeting": put_meeting}
