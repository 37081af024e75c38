"""One output table of one operator, at all steps, ours and theirs, as flat rows; and how a guess of what theirs is does.

A mistake is named only if its guess is right wherever theirs is wrong and everywhere else, and if chance would hardly make
so many guesses fit.
"""
import dataclasses
import math

import numpy as np
from uncross_port import pack

NOT_A_NUMBER = math.inf  # the guess of what is not a number; NaN: no guess can be made of this value
SURE = 10.0  # bits: a guess is told if chance would make one of all that were tried fit once in 2^10 cases
MOST_BITS = 20.0  # of one value
PAIRS = 64  # of our value and theirs; more tell nothing new
NOT, WRONG, WHOLE = range(3)  # how a guess does: wrong where theirs is wrong; right there, but not everywhere else; theirs is this guess


@dataclasses.dataclass
class Part:
    """The rows of one step."""

    step: int
    first: int  # number of its first row among all
    rows: int  # that both have
    ours_rows: int  # of our table
    theirs_rows: int
    tables: dict  # of the operator at this step, {"in.position": array, "out.velocity": ours, ...}; columns in the port's order
    model: dict  # tables of the model, {"in.box": array, ...}
    theirs: np.ndarray = None  # their whole table
    columns: dict = dataclasses.field(default_factory=dict)  # names of tables' columns, where they are not the contract's
    every: dict = dataclasses.field(default_factory=dict)  # tables of theirs, too: {"theirs.velocity": ...}


def ways(n, chosen):
    """log2 of the number of ways to choose so many of n."""
    return (math.lgamma(n + 1) - math.lgamma(chosen + 1) - math.lgamma(n - chosen + 1)) / math.log(2)


def odd_bits(n):
    """log2 of the odd part of a whole number, 2 MOST_BITS at most: a difference of so many units is no number of cells or boxes."""
    return min(2 * MOST_BITS, math.log2(n // (n & -n))) if n else 0.0


def as_guess(values):
    """A result of an operator as a guess: what is not a number is a guess, too."""
    values = np.array(values, float)
    values[np.isnan(values)] = NOT_A_NUMBER
    return values


class Evidence:
    """ours, theirs, tolerance: reals [rows, columns] of all steps, one below the other; `exact`: the same of ours and theirs
    as they stand in the file (integers of 64 bits). wrong: beyond tolerance, or different in any bit if nothing is beyond."""

    def __init__(self, operator, table, columns, parts, values):
        """columns: names; values: for each part (ours, theirs, tolerance), whose first rows are those that both have."""
        self.operator, self.table, self.columns, self.parts = operator, table, tuple(columns), parts
        cut = [[array[: part.rows] for array in arrays] for part, arrays in zip(parts, values)]
        whole = [np.concatenate(arrays).reshape(-1, len(self.columns)) for arrays in zip(*cut)]
        self.exact = whole[:2]
        self.real = whole[0].dtype.kind == "f"
        self.whole = all(values.dtype.kind == "i" for values in whole[:2])
        self.ours, self.theirs, self.tolerance = (array.astype(float) for array in whole)
        self.same_shape = all(part.ours_rows == part.theirs_rows for part in parts)
        with np.errstate(invalid="ignore"):
            self.different = self.exact[0] != self.exact[1]
            self.beyond = ~(np.abs(self.ours - self.theirs) <= self.tolerance)
        self.beyond &= self.different
        self.wrong = self.beyond.copy()
        self.moved = np.zeros(len(self.ours), bool)
        self.choice = [self._choices(column) for column in range(len(self.columns))]

    @property
    def rows(self):
        return len(self.ours)

    @property
    def wrong_rows(self):
        """Which rows have a wrong value, [rows] of bool."""
        return self.wrong.any(axis=1)

    def take_all(self):
        """From now on, what differs in any bit counts as wrong, too; guesses of integers get no tolerance."""
        self.wrong = self.different.copy()
        if not self.real:
            self.tolerance = np.zeros_like(self.tolerance)

    def _choices(self, column):
        """log2 of how many values there are in a column: with few, a guess is right by chance."""
        seen = len(np.unique(np.stack([self.ours[:, column], self.theirs[:, column]])))
        if seen <= 1:
            return 0.0
        if seen >= self.rows:  # nearly all are different: then what counts is how large they may be
            return min(MOST_BITS, math.log2(1 + np.abs(self.ours[:, column]).max()))
        return math.log2(min(seen, PAIRS) - 1)

    def fits(self, guess, rows=slice(None)):
        """Of each value whether theirs is this guess. Where theirs is wrong, the guess must be far nearer than ours: else a
        bound as wide as the error lets anything pass. rows: which of them the guess is of."""
        theirs = self.theirs[rows]
        with np.errstate(invalid="ignore", over="ignore"):
            off = np.abs(theirs - guess)
            near = (off <= self.tolerance[rows]) | (off <= 2.0**-40 * np.abs(guess))
            nearer = ~self.wrong[rows] | (off <= 2.0**-8 * np.abs(theirs - self.ours[rows]))
            fits = (off == 0) | (np.isfinite(guess) & near & nearer)
        return np.where(np.isnan(theirs), guess == NOT_A_NUMBER, fits)

    def judge(self, guess):
        """NOT, WRONG or WHOLE. Remembers which rows a guess moves, if they are not many more than are wrong."""
        with np.errstate(invalid="ignore"):
            moved = (~np.isnan(guess) & ~(np.abs(guess - self.ours) <= self.tolerance)).any(axis=1)
        if moved.sum() <= 4 * self.wrong_rows.sum():
            self.moved |= moved
        fits = self.fits(guess)
        return WHOLE if fits.all() else WRONG if fits[self.wrong].all() else NOT

    def bits(self, guess, free=0):
        """log2 of the odds against a guess being right by chance in the wrong values. Each different pair of our value and
        theirs counts: a real by how much nearer the guess is than ours, an integer by the number of values that its column
        has. free: numbers of the guess that were taken from theirs; as many pairs count nothing."""
        where = np.flatnonzero(self.wrong)
        ours, theirs = self.ours.ravel()[where], self.theirs.ravel()[where]
        pairs = np.stack([ours, np.nan_to_num(theirs, nan=NOT_A_NUMBER)], axis=1)
        _, first = np.unique(pairs, axis=0, return_index=True)
        chosen = np.sort(first)[free : PAIRS + free]
        if not self.real:
            off = [abs(int(mine) - int(its)) for mine, its in zip(*(exact.ravel()[where[chosen]] for exact in self.exact))] if self.whole else [0] * len(chosen)
            return float(sum(max(self.choice[k % len(self.columns)], odd_bits(n)) for k, n in zip(where[chosen], off)))
        ours, theirs = ours[chosen], theirs[chosen]
        guess, tolerance = np.asarray(guess).ravel()[where[chosen]], self.tolerance.ravel()[where[chosen]]
        with np.errstate(all="ignore"):
            off, error = np.abs(theirs - guess), np.abs(theirs - ours)
            doubt = np.where(error > tolerance, tolerance, 0.0)
            least = np.maximum(np.maximum(off, doubt), 2.0**-52 * np.abs(theirs))
            each = np.clip(np.log2(error / least), 0.0, MOST_BITS)
        return float(np.where(np.isnan(theirs), MOST_BITS, np.nan_to_num(each)).sum())

    def choice_of_rows(self):
        """log2 of the number of ways in which so many wrong rows could lie among those that guesses with few wrong rows
        change: what it is worth that a guess has no other row wrong."""
        n, chosen = int(self.moved.sum()), int(self.wrong_rows.sum())
        return ways(n, chosen) if n > chosen else 0.0

    def names(self, table):
        """Of the columns of a table of the operator."""
        return self.parts[0].columns.get(table) or pack.columns(self.operator, table).split()

    def part_of(self, row):
        """The part that a row, counted among all, belongs to; and its number there."""
        part = [part for part in self.parts if part.first <= row][-1]  # one without rows begins where the next one does
        return part, row - part.first
