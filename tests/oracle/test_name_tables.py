#!/usr/bin/python3
"""What uncross-name says of a difference without the operator: which rows are wrong, and what their values are to ours. All
tables are made here, so that the answer is known.
"""
import itertools
import pathlib
import sys
import unittest

import numpy as np

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TOP / "python"), str(TOP / "ports/numpy")]

from uncross_name import anything, rows  # noqa: E402
from uncross_name.evidence import WHOLE, WRONG, Evidence, Part  # noqa: E402

CELL = 1 << 40
BOX = np.array([[4, 3, 2]])
# Fibers of 5, 4 and 7 vertices; those of 4 are rings.
LENGTHS, RING = 8 * (5, 4, 7), 4
VERTICES = sum(LENGTHS)
STEPS = (3, 30)


def chain():
    """Next, before, fiber of each vertex."""
    table, first = [], 0
    for fiber, n in enumerate(LENGTHS):
        for k in range(n):
            ring = n == RING
            table.append([first + (k + 1) % n if ring or k + 1 < n else -1, first + (k - 1) % n if ring or k else -1, fiber])
        first += n
    return np.array(table)


MODEL = {"in.box": BOX, "in.chain": chain(), "in.vertex": np.ones((VERTICES, 7)), "in.numbers": np.array([[7, 0, 0, 1, 0, 0]])}
MODEL["in.vertex"][:, 0] = np.array([1, 2, 4])[chain()[:, 2] % 3]


def evidence(operator, table, columns, ours, theirs, **given):
    """ours and theirs: [steps, rows, columns]; given: in-tables of each step."""
    parts, first = [], 0
    for step, mine, its in zip(STEPS, ours, theirs):
        tables = {f"in.{name}": values[len(parts)] for name, values in given.items()} | {table: mine}
        parts.append(Part(step, first, min(len(mine), len(its)), len(mine), len(its), tables, MODEL, its))
        first += parts[-1].rows
    values = [(mine, its, np.full(mine.shape, 1e-12 if mine.dtype.kind == "f" else 0.0)) for mine, its in zip(ours, theirs)]
    return Evidence(operator, table, columns.split(), parts, values)


def random(*shape):
    return np.random.default_rng(12).normal(size=shape)


class RowsTest(unittest.TestCase):
    def told(self, exact, text, operator, table, wrong, ours=None, columns="x y z", **given):
        """Values where wrong [steps, rows(, columns)] is true are other ones."""
        wrong = np.asarray(wrong)
        ours = random(*wrong.shape[:2], len(columns.split())) if ours is None else ours
        wrong = np.broadcast_to(wrong if wrong.ndim == 3 else wrong[:, :, None], ours.shape)
        theirs = np.where(wrong, ours + 1 + np.arange(ours.size).reshape(ours.shape) % 7, ours)
        self.assertEqual(rows.describe(evidence(operator, table, columns, ours, theirs, **given)), (exact, text))

    def test_places(self):
        odd = np.tile(np.arange(40) % 2 == 1, (2, 1))
        self.told(True, "wrong exactly in rows where the row's number is odd: 40 of 80 rows, and nowhere else", "stream", "out.velocity", odd)
        late = np.tile(np.arange(40) >= 25, (2, 1))
        text = "wrong exactly in rows where the row's number is 25 or more: 30 of 80 rows, and nowhere else"
        self.told(True, text, "stream", "out.velocity", late)
        second = np.repeat([[False], [True]], 40, axis=1)
        self.told(True, "wrong exactly in rows where the step is 30: 40 of 80 rows, and nowhere else", "stream", "out.velocity", second)

    def test_few_rows_are_listed(self):
        wrong = np.zeros((2, 40), bool)
        wrong[0, 7] = wrong[1, 39] = True
        text = "wrong exactly in 2 of 80 rows, too few for a rule: 7 of step 3, 39 of step 30 (the last)"
        self.told(True, text, "stream", "out.velocity", wrong)

    def test_a_step_without_rows(self):
        ours = [random(1, 0, 3)[0], random(1, 40, 3)[0]]
        theirs = [ours[0], ours[1] + (np.arange(40) == 7)[:, None]]
        text = "wrong exactly in 1 of 40 rows, too few for a rule: 7 of step 30"
        self.assertEqual(rows.describe(evidence("stream", "out.velocity", "x y z", ours, theirs)), (True, text))

    def test_rules_that_chance_may_fit(self):
        """Facts that are true, but of too few rows; what is the same at both steps counts once: 10.8 bits, not 23.3."""
        wrong = np.tile(np.arange(40) == 0, (2, 1))
        self.told(True, "wrong exactly in 2 of 80 rows, too few for a rule: 0 of step 3, 0 of step 30", "stream", "out.velocity", wrong)
        wrong = np.tile(np.arange(16) % 4 == 1, (2, 1))
        listed = ", ".join(f"{row} of step {step}" for step in STEPS for row in (1, 5, 9, 13))
        self.told(True, f"wrong exactly in 8 of 32 rows, too few for a rule: {listed}", "stream", "out.velocity", wrong)

    def test_vertices(self):
        after, before, fiber = chain().T
        ring = fiber % 3 == 1
        for wrong, text in (
            (after < 0, "the vertex is the last of its fiber"),
            (before < 0, "the vertex is the first of its fiber"),
            (ring, "the vertex is of a ring"),
            (ring & ((after < np.arange(VERTICES)) | (before > np.arange(VERTICES))), "the vertex is an end of the bond that closes a ring"),
            (fiber % 2 == 1, "the number of its fiber is odd"),
            (fiber == 11, "the number of its fiber is 11"),
            (fiber % 3 == 2, "mass is 4"),
            (~ring & (before >= 0), "the vertex is of no ring, and the vertex has one before"),
        ):
            text = f"wrong exactly in rows where {text}: {2 * wrong.sum()} of {2 * VERTICES} rows, and nowhere else"
            self.told(True, text, "kick", "out.velocity", np.tile(wrong, (2, 1)))

    def test_particles_are_no_vertices(self):
        """Though they are as many."""
        ours = random(2, VERTICES, 3)
        found = evidence("stream", "out.velocity", "x y z", ours, ours + (chain()[:, 1] < 0)[:, None])
        self.assertNotIn("vertex", rows.describe(found)[1])

    def test_columns(self):
        wrong = np.zeros((2, 40, 3), bool)
        wrong[:, :, 1] = True
        self.told(True, "wrong exactly in column y of all rows: 80 of 80 rows", "stream", "out.velocity", wrong)
        wrong[:, ::2, 1] = False
        text = "wrong exactly in column y of rows where the row's number is odd: 40 of 80 rows, and nowhere else"
        self.told(True, text, "stream", "out.velocity", wrong)

    def test_values(self):
        velocity = random(2, 40, 3)
        wrong = velocity < 0
        text = f"values where in.velocity along the same axis is negative: {wrong.sum()} of 240 values, and nowhere else"
        self.told(True, f"wrong exactly in {text}", "stream", "out.position", wrong, ours=random(2, 40, 3) + 9, velocity=velocity)

    def test_a_simple_rule_for_rows_wins(self):
        """One value of a wrong row is right by chance: a rule for values has to leave it out."""
        wrong = np.tile((np.arange(40) % 2 == 1)[:, None], (2, 1, 3))
        wrong[1, 7, 2] = False
        ours = random(2, 40, 3)
        ours[1, 7, 2] = 50
        self.told(True, "wrong exactly in rows where the row's number is odd: 40 of 80 rows, and nowhere else", "stream", "out.velocity", wrong, ours)

    def test_cells(self):
        cell = np.random.default_rng(5).integers(0, 24, (2, 60, 1))
        shift, vertex = np.zeros((2, 1, 3), np.int64), np.full((2, 1, 1), -1)
        x, y, z = cell[:, :, 0] % 4, cell[:, :, 0] // 4 % 3, cell[:, :, 0] // 12
        given = {"shift": shift, "solvent_cell": cell, "vertex_cell": vertex}
        for wrong, text in (
            (cell[:, :, 0] % 4 == 3, "x is in the last cell"),
            (cell[:, :, 0] // 4 % 3 == 2, "y is in the last cell"),
            (cell[:, :, 0] // 12 == 0, "z is not in the last cell"),
            ((x == 3) | (y == 2) | (z == 1), "its cell is at an upper edge"),
            ((x == 0) | (y == 0) | (z == 0), "its cell is at a lower edge"),
            (cell[:, :, 0] == 5, "the number of its cell is 5"),
        ):
            said = f"wrong exactly in rows where {text}: {wrong.sum()} of 120 rows, and nowhere else"
            if "number" not in text:  # a cell has too few members for one of 24 numbers to be told
                self.told(True, said, "rotate", "out.solvent", wrong, **given)
        wrong = np.array([[(step[:k] == step[k]).any() for k in range(60)] for step in cell])
        said = f"wrong exactly in rows where its rank in its cell is not 0: {wrong.sum()} of 120 rows, and nowhere else"
        self.told(True, said, "rotate", "out.solvent", wrong, **given)
        count = np.array([np.bincount(step[:, 0], minlength=24)[step[:, 0]] for step in cell])
        wrong = count == count.max()
        said = f"wrong exactly in rows where members of its cell is {count.max()}: {wrong.sum()} of 120 rows, and nowhere else"
        self.told(True, said, "rotate", "out.solvent", wrong, **given)
        wrong = np.array([[(step[:k] == step[k]).any() for k in range(60)] for step in cell])
        said = f"wrong exactly in rows where its rank in its cell is not 0: {wrong.sum()} of 120 rows, and nowhere else"
        self.told(True, said, "rotate", "out.solvent", wrong, **given)

    def test_active_cells(self):
        """Of a table of loads, in the cell of the row."""
        load = np.random.default_rng(5).integers(0, 4, (2, 24, 2))
        cell = np.random.default_rng(6).integers(0, 24, (2, 60, 1))
        wrong = np.array([n[at[:, 0], 0] >= 2 for n, at in zip(load, cell)])
        text = f"wrong exactly in rows where its cell is active: {wrong.sum()} of 120 rows, and nowhere else"
        self.told(True, text, "rotate", "out.solvent", wrong, solvent_cell=cell, load=load)

    def test_images(self):
        """More than one edge away from the box."""
        position = np.random.default_rng(6).integers(-4 * BOX[0] * CELL, 5 * BOX[0] * CELL, (2, 60, 3))
        wrong = ((position < -BOX[0] * CELL) | (position >= 2 * BOX[0] * CELL)).any(axis=2)
        text = f"wrong exactly in rows where it is more than one edge away: {wrong.sum()} of 120 rows, and nowhere else"
        cell, shift = np.zeros((2, 60, 1), np.int64), np.zeros((2, 1, 3), np.int64)
        self.told(True, text, "bin", "out.solvent", wrong, cell, "cell", solvent=position, shift=shift)

    def test_faces(self):
        position = np.random.default_rng(6).integers(1, CELL, (2, 60, 3))
        position[:, ::5, 1] = CELL - 100
        shift = np.full((2, 1, 3), 100)
        cell = np.zeros((2, 60, 1), np.int64)
        text = "wrong exactly in rows where it lies on a face of a cell: 24 of 120 rows, and nowhere else"
        wrong = np.tile(np.arange(60) % 5 == 0, (2, 1))
        wrong[1, 0], position[1, 0, 1], position[1, 59, 2], wrong[1, 59] = False, 5, CELL - 100, True
        self.told(True, text, "bin", "out.solvent", wrong, cell, "cell", solvent=position, shift=shift)

    def test_determinants(self):
        draw = np.random.default_rng(9)
        points = {name: draw.integers(-CELL, CELL, (2, 60, 3)) for name in ("from", "to", "pivot", "a", "b")}
        flat, kind = draw.random((2, 60)) < 0.4, draw.integers(0, 5, (2, 60))
        fours = (("a", "b", "pivot", "from"), ("a", "b", "pivot", "to"), ("a", "b", "from", "to"), ("from", "to", "pivot", "a"),
                 ("from", "to", "pivot", "b"))
        for k, four in enumerate(fours):  # the last point in the plane of the others
            p, q, r = (points[name][flat & (kind == k)] for name in four[:3])
            points[four[3]][flat & (kind == k)] = q + r - p
        text = f"wrong exactly in rows where a determinant is exactly zero: {flat.sum()} of 120 rows, and nowhere else"
        ours = np.zeros((2, 60, 1), np.int64)
        self.told(True, text, "crossing", "out.crosses", flat, ours, "crosses", flip=ours, **points)

    def test_walls(self):
        position, velocity = np.full((2, 60, 3), CELL), 0.1 * random(2, 60, 3)
        hit = np.random.default_rng(8).random((2, 60)) < 0.4
        velocity[hit, 1] = np.where(np.arange(hit.sum()) % 2, 2.5, -1.5)  # the box is 3 high
        wrong = np.zeros((2, 60, 3), bool)
        wrong[hit, 1] = True
        text = f"wrong exactly in column y of rows where the particle hits a wall: {hit.sum()} of 120 rows, and nowhere else"
        given = {"position": position, "velocity": velocity, "time": np.ones((2, 1, 1))}
        self.told(True, text, "wall_stream", "out.velocity", wrong, **given)

    def test_events_that_are_not_reported(self):
        draw = np.random.default_rng(2)
        event = draw.integers(0, 80, (2, 50, 7))
        event[:, :, 3:6] = draw.random((2, 50, 1)) < 0.3
        theirs = [step[step[:, 3] == 0] for step in event]
        columns = "vertex moving standing image_x image_y image_z executed"
        found = evidence("long_sweep", "out.event", columns, event, theirs)
        n = int(event[:, :, 3].sum())
        text = f"wrong exactly in rows where the partner is an image: {n} of 100 rows, and nowhere else"
        self.assertEqual(rows.unreported(found), f"{n} events are not reported, 0 that are none are: {text}")
        theirs = [step * [1, 1, 1, 1, 1, 1, 0] for step in event]
        theirs[1] = np.append(theirs[1], [[90] * 7], axis=0)
        found = evidence("long_sweep", "out.event", columns, event, theirs)
        self.assertEqual(rows.unreported(found), "0 events are not reported, 1 that are none are")
        self.assertIsNone(rows.unreported(evidence("long_sweep", "out.event", columns, event, event)))

    def test_chance_is_no_rule(self):
        """Wrong rows without a rule: a rule for one of 60 would be told once in 17 runs by the bound, if it is as loose as it may be."""
        draw = np.random.default_rng(3)
        for _ in range(60):
            wrong = draw.random((2, 40)) < 0.3
            ours = random(2, 40, 3)
            found = evidence("stream", "out.velocity", "x y z", ours, ours + wrong[:, :, None], velocity=random(2, 40, 3))
            exact, text = rows.describe(found)
            self.assertFalse(exact, text)
            self.assertTrue(text.startswith(f"no rule known for the wrong rows, {wrong.sum()} of 80: "), text)

    def test_all_rows(self):
        self.told(False, "all rows: 80 of 80", "stream", "out.velocity", np.ones((2, 40), bool))


class AnythingTest(unittest.TestCase):
    """Theirs is made by the formula that the text says; one guess alone is right everywhere."""

    def whole(self, found):
        return [text for text, guess, free in anything.guesses(found) if found.judge(guess) == WHOLE]

    def check(self, cases, ours, columns="x y z", operator="kick", table="out.velocity", **given):
        for text, theirs in cases:
            theirs = np.asarray(theirs)
            found = evidence(operator, table, columns, ours, theirs, **given)
            self.assertIn(text, self.whole(found))
        found = evidence(operator, table, columns, ours, ours + random(*ours.shape) ** 3, **given)
        self.assertEqual(self.whole(found), [])

    def test_functions_of_our_value(self):
        ours = random(2, VERTICES, 3)
        nan, free = np.where(ours < 0, np.nan, ours), ours.copy()
        free[:] = (0.25, -3.0, 7.0)
        self.check((
            ("0 came out", 0 * ours), ("1 came out", 0 * ours + 1), ("sign: the negative of what is wanted", -ours),
            ("NaN: 0/0, or the root or logarithm of a negative number", nan),
            ("the rest to 1: 1 - x for x", 1 - ours), ("inverted: 1/x for x", 1 / ours),
            ("squared, or a root that is missing: x^2 for x", ours ** 2),
            ("inverted and squared: 1/x^2 for x", 1 / ours ** 2), ("without its sign: |x| for x", abs(ours)),
            ("negative values cut to 0", np.where(ours < 0, 0, ours)),
            ("rounded to single precision at the end", ours.astype(np.float32).astype(float)),
            ("a constant factor: 1.75 times what is wanted", 1.75 * ours),
            ("a constant offset: 0.5 less than wanted", ours - 0.5), ("the same in all rows: 0.25 -3 7", free),
        ), ours)
        ours = abs(ours)
        self.check((("a root too many: sqrt(x) for x", np.sqrt(ours)),), ours)

    def test_changes(self):
        before, change = random(2, VERTICES, 3) + 5, random(2, VERTICES, 3)[:, ::-1]
        mass = MODEL["in.vertex"][:, :1]
        self.check((
            ("nothing done: what came out is what went in", before), ("changed by half of what is wanted", before + change / 2),
            ("changed by twice what is wanted", before + 2 * change),
            ("sign: changed by the negative of what is wanted", before - change), ("changed by 0.3 times what is wanted", before + 0.3 * change),
            ("what went in is replaced by the change, which is to be added to it", change),
            ("changed by what is wanted times the mass", before + mass * change),
            ("changed by what is wanted over the mass", before + change / mass),
            ("changed by what is wanted with the mass of the next vertex", before + change * mass / np.roll(mass, -1)),
            ("what is wanted times the mass of the vertex before", (before + change) / mass * np.roll(mass, 1)),
        ), before + change, velocity=before)

    def test_columns_and_rows(self):
        ours = random(2, VERTICES, 3)
        shifted = np.roll(ours, -1, axis=1)
        shifted[:, -1] = 77
        self.check((
            ("columns exchanged: x y z are what y x z should be", ours[:, :, [1, 0, 2]]),
            ("columns exchanged: x y z are what z x y should be", ours[:, :, [2, 0, 1]]),
            ("the same along axes: that of y", ours[:, :, [1, 1, 1]]),
            ("the next row's numbers", shifted), ("those of the row before", np.roll(ours, 1, axis=1)),
            ("rows backwards: the first has what the last should have", ours[:, ::-1]),
        ), ours)
        ours = random(2, 40, 6)
        text = "columns exchanged: lower_y is what upper_x should be, and upper_x what lower_y should"
        columns = "lower_x lower_y lower_z upper_x upper_y upper_z"
        self.check(((text, ours[:, :, [0, 3, 2, 1, 4, 5]]),), ours, columns, "wall_motion", "out.flight")

    def test_integers(self):
        ours = np.random.default_rng(4).integers(0, 1 << 32, (2, 40, 4))
        large = ours << 20
        self.check((
            ("an integer cut to 24 bits", ours % (1 << 24)),
            ("a word of 32 bits taken as signed: it is unsigned", np.where(ours >= 1 << 31, ours - (1 << 32), ours)),
            ("an integer cut to 31 bits with sign", (ours + (1 << 30)) % (1 << 31) - (1 << 30)),
        ), ours, "0 1 2 3", "random", "out.word")
        self.check((("an integer cut to 40 bits", large % (1 << 40)),), large, "0 1 2 3", "random", "out.word")

    def test_partly(self):
        """What is right wherever theirs is wrong, but not elsewhere."""
        ours, late = random(2, VERTICES, 3), np.arange(VERTICES)[:, None] >= 20
        found = evidence("kick", "out.velocity", "x y z", ours, np.where(late, -ours, ours))
        told = [text for text, guess, *_ in anything.guesses(found) if found.judge(guess) == WRONG]
        self.assertEqual(told[0], "sign: the negative of what is wanted")

    def test_one_side(self):
        ours, size = random(2, 40, 3), abs(random(2, 40, 3))
        for theirs, side in (
            (ours - size, "below what is wanted"), (ours + size, "above what is wanted"),
            (ours * np.exp(-size), "toward zero"), (ours * np.exp(size), "away from zero"),
        ):
            found = evidence("kick", "out.velocity", "x y z", ours, theirs)
            self.assertEqual(anything.one_sided(found), f"one-sided: all 240 wrong values are {side}")
        self.assertIsNone(anything.one_sided(evidence("kick", "out.velocity", "x y z", ours, ours + random(2, 40, 3)[:, ::-1])))

    def test_single(self):
        ours = random(2, 40, 3)
        half = ours.astype(np.float32).astype(float)
        x = np.arange(3) == 0
        wrong = ours + 1e-7, ours.astype(np.float16).astype(float), np.where(x, ours + 1e-7, half)
        for theirs, single in ((half, True), *((theirs, False) for theirs in wrong)):
            self.assertEqual(anything.is_single(evidence("kick", "out.velocity", "x y z", ours, theirs)), single)

    def test_patterns(self):
        order = np.stack([np.random.default_rng(k).permutation(40)[:, None] for k in (1, 2)])
        for theirs, text in (
            (order[:, ::-1], "a permutation, but of other random numbers or exchanges"), (order // 2, "no permutation: a number is missing"),
        ):
            self.assertEqual(anything.pattern(evidence("swap", "out.order", "particle", order, theirs)), text)
        words = np.random.default_rng(4).integers(0, 1 << 32, (2, 40, 4))
        text = "hardly a word is right, so the counter, the key or the rounds of Philox differ"
        for theirs, said in ((words[:, ::-1], text), (np.where(np.arange(4) < 2, words, 0), None)):
            self.assertEqual(anything.pattern(evidence("random", "out.word", "0 1 2 3", words, theirs)), said)


if __name__ == "__main__":
    unittest.main()
