"""Guesses of any table: functions of our value and of what went in, other rows, other columns. They say what the values are, and
no cause. A guess that takes numbers from theirs says how many (free)."""
import itertools
import math

import numpy as np

from .evidence import NOT_A_NUMBER

SIGNED_WORD = 2.0**31
MOST_BITS = 52  # to which an integer may be cut
ONE_SIDED = 8  # values: fewer may have errors of one sign by chance


def guesses(evidence):
    """(text, guess [rows, columns], free) from the most to the least telling."""
    given = before(evidence)
    places = itertools.chain(of_columns(evidence), of_rows(evidence))
    for text, guess in itertools.chain(of_value(evidence, given), places, of_masses(evidence, given), of_bits(evidence)):
        yield text, guess, 0
    yield from of_free_numbers(evidence, given)


def before(evidence):
    """What went in, where it has the shape of what comes out; NaN elsewhere."""
    name, steps = "in." + evidence.table.removeprefix("out."), []
    for part in evidence.parts:
        table = part.tables.get(name)
        alike = table is not None and table.shape == (part.ours_rows, len(evidence.columns))
        steps.append(table[: part.rows].astype(float) if alike else np.full((part.rows, len(evidence.columns)), np.nan))
    return np.concatenate(steps)


# --- functions of our value


def of_value(evidence, given):
    x, change = evidence.ours, evidence.ours - given
    with np.errstate(all="ignore"):
        inverse, root, single = 1.0 / x, np.sqrt(x), x.astype(np.float32).astype(float)
    yield "nothing done: what came out is what went in", given
    yield "NaN: 0/0, or the root or logarithm of a negative number", np.where(np.isnan(evidence.theirs), NOT_A_NUMBER, x)
    yield "0 came out", np.zeros_like(x)
    yield "1 came out", np.ones_like(x)
    yield "sign: the negative of what is wanted", -x
    yield "changed by half of what is wanted", given + 0.5 * change
    yield "changed by twice what is wanted", given + 2.0 * change
    yield "sign: changed by the negative of what is wanted", given - change
    yield "what went in is replaced by the change, which is to be added to it", change
    yield "the rest to 1: 1 - x for x", 1.0 - x
    yield "inverted: 1/x for x", inverse
    yield "squared, or a root that is missing: x^2 for x", x * x
    yield "a root too many: sqrt(x) for x", root
    yield "inverted and squared: 1/x^2 for x", inverse * inverse
    yield "without its sign: |x| for x", np.abs(x)
    unsigned = (x >= SIGNED_WORD) & (x < 2 * SIGNED_WORD)
    yield "a word of 32 bits taken as signed: it is unsigned", np.where(unsigned, x - 2 * SIGNED_WORD, x)
    yield "negative values cut to 0", np.maximum(x, 0.0)
    yield "rounded to single precision at the end", single


def of_bits(evidence):
    for bits, signed in itertools.product(range(8, MOST_BITS + 1) if not evidence.real else (), (False, True)):
        span = 2.0**bits
        text = f"an integer cut to {bits} bits{' with sign' if signed else ''}"
        yield text, evidence.ours - span * np.floor(evidence.ours / span + 0.5 * signed)


# --- other columns and rows


def of_columns(evidence):
    x, names = evidence.ours, evidence.columns
    wrong = np.flatnonzero(evidence.wrong.any(axis=0))
    for order in itertools.permutations(range(len(names))) if len(names) in (2, 3) else ():
        if [k for k, other in enumerate(order) if k != other] == wrong.tolist():  # only wrong columns, and all of them
            here, there = " ".join(names), " ".join(names[k] for k in order)
            yield f"columns exchanged: {here} are what {there} should be", x[:, order]
    if len(wrong) == 2 and len(names) > 3:
        a, b = wrong
        guess = x.copy()
        guess[:, [a, b]] = x[:, [b, a]]
        yield f"columns exchanged: {names[a]} is what {names[b]} should be, and {names[b]} what {names[a]} should", guess
    if len(wrong) == 1:
        for k in range(len(names)):
            guess = x.copy()
            guess[:, wrong[0]] = x[:, k]
            if k != wrong[0]:
                yield f"{names[wrong[0]]} is what {names[k]} should be", guess
    for k in range(3 if len(names) == 3 else 0):
        yield f"the same along axes: that of {names[k]}", np.repeat(x[:, k : k + 1], 3, axis=1)


def of_rows(evidence):
    """The numbers of another row of the same step. A row at the end may have anything, but where others are hardly wrong."""
    at_end = evidence.theirs if evidence.wrong_rows.sum() > 2 * len(evidence.parts) else np.full_like(evidence.ours, np.nan)
    for text, way in (("the next row's numbers", -1), ("those of the row before", 1)):
        steps = []
        for part in evidence.parts:
            rows = slice(part.first, part.first + part.rows)
            guess = np.roll(evidence.ours[rows], way, axis=0)
            if part.rows > 2:
                guess[way // 2] = at_end[rows][way // 2]  # the last row, or the first
            steps.append(guess)
        yield text, np.concatenate(steps)
    backwards = [evidence.ours[part.first : part.first + part.rows][::-1] for part in evidence.parts]
    yield "rows backwards: the first has what the last should have", np.concatenate(backwards)


# --- numbers that are taken from theirs


def of_free_numbers(evidence, given):
    """The numbers are those of the wrong value of which the wanted one is largest."""
    x, theirs = evidence.ours, evidence.theirs
    largest = np.unravel_index(np.where(evidence.wrong, np.abs(x), -1.0).argmax(), x.shape)
    row = theirs[largest[0]]
    text = " ".join(f"{value:.6g}" for value in row[:4])
    yield f"the same in all rows: {text}", np.tile(row, (len(x), 1)), len(row)
    offset = theirs[largest] - x[largest]
    factor = theirs[largest] / x[largest] if x[largest] else np.nan
    if np.isfinite(factor) and factor not in (0.0, 1.0):
        yield f"a constant factor: {factor:.9g} times what is wanted", factor * x, 1
    if np.isfinite(offset):
        yield f"a constant offset: {abs(offset):.17g} {'more' if offset > 0 else 'less'} than wanted", x + offset, 1
    wanted = np.where(evidence.wrong & np.isfinite(given), x - given, 0.0)
    largest = np.unravel_index(np.abs(wanted).argmax(), x.shape)
    factor = (theirs[largest] - given[largest]) / wanted[largest] if wanted[largest] else np.nan
    if np.isfinite(factor):
        yield f"changed by {factor:.10g} times what is wanted", given + factor * (x - given), 1


# --- masses

# Powers of the vertex' own mass, of that of the next number, of that of the number before.
MASSES = (
    ((1, 0, 0), "times the mass"),
    ((-1, 0, 0), "over the mass"),
    ((2, 0, 0), "times the mass squared: it should be divided by it"),
    ((1, -1, 0), "with the mass of the next vertex"),
    ((1, 0, -1), "with the mass of the vertex before"),
    ((-1, 1, 0), "times the mass of the next vertex"),
    ((-1, 0, 1), "times the mass of the vertex before"),
)


def of_masses(evidence, given):
    vertices = evidence.parts[0].model.get("in.vertex")
    if vertices is None or not len(vertices):
        return
    mass = vertices[:, :1]
    three = mass, np.roll(mass, -1), np.roll(mass, 1)
    for powers, text in MASSES:
        factor = math.prod(m ** float(power) for m, power in zip(three, powers))
        each = [factor[: part.rows] if part.ours_rows == len(mass) else np.full((part.rows, 1), np.nan) for part in evidence.parts]
        factor = np.concatenate(each)
        yield f"changed by what is wanted {text}", given + factor * (evidence.ours - given)
        yield f"what is wanted {text}", factor * evidence.ours


# --- what is written with few digits


def printed(case):
    """Of all reals of a pack, whether theirs are ours with fewer digits: the words, or None."""
    every = [found for each in (case, *case.elsewhere) for found in each.tables if found.real and found.same_shape]
    ours, theirs = (np.concatenate([getattr(found, whose).ravel() for found in every] or [np.zeros(0)]) for whose in ("ours", "theirs"))
    off = np.flatnonzero((ours != theirs) & np.isfinite(ours) & np.isfinite(theirs) & (theirs != 0.0))  # 0 says nothing of digits
    few = off[:: max(1, len(off) // 200)]
    if len(few) < ONE_SIDED:
        return None
    said = []  # by both ways of counting digits: numbers of one size do not tell them apart
    for words, forms in (("significant digits", [(n, f".{n}g") for n in range(2, 17)]), ("digits after the point", [(n, f".{n}f") for n in range(20)])):
        fits = (n for n, form in forms if np.mean([float(format(ours[k], form)) == theirs[k] for k in few]) > 0.9)
        said += [f"{n} {words}" for n in fits][:1]
    if not said:
        return None
    return f"reals are written with {' or '.join(said)} only: 17 significant digits, or the shortest that are read back as the same number"


# --- what is no guess


def one_sided(evidence):
    """The side of all errors, if there are many and they have one; None."""
    ours, theirs = evidence.ours[evidence.wrong], evidence.theirs[evidence.wrong]
    sides = (
        (theirs < ours, "below what is wanted"),
        (theirs > ours, "above what is wanted"),
        (np.abs(theirs) < np.abs(ours), "toward zero"),
        ((ours != 0) & (np.abs(theirs) > np.abs(ours)), "away from zero"),
    )
    for of, side in sides if len(ours) >= ONE_SIDED else ():
        if of.all():
            return f"one-sided: all {len(ours)} wrong values are {side}"
    return None


def pattern(evidence):
    """What is known of numbers of which no guess is right; None."""
    if (evidence.operator, evidence.table) == ("random", "out.word"):
        right = (evidence.ours == evidence.theirs).sum()
        if 8 * right <= evidence.ours.size:
            return "hardly a word is right, so the counter, the key or the rounds of Philox differ"
    if evidence.table == "out.order":
        for part in evidence.parts:
            numbers = evidence.theirs[part.first : part.first + part.rows, 0]
            if part.theirs_rows != part.ours_rows or (np.sort(numbers) != np.arange(part.ours_rows)).any():
                return "no permutation: a number is missing"
        return "a permutation, but of other random numbers or exchanges"
    return None


def is_single(evidence):
    """Right to 5 to 8 digits, not better, and the errors scatter about 0: as rounding to 24 bits does, whose errors have either
    sign, so that the sum of n of them is within 4 sqrt(n) of their size. An error that is the same everywhere is something else,
    and so are errors of a few last bits of doubles."""
    return any(step_is_single(evidence, part) for part in evidence.parts)


def step_is_single(evidence, part):
    rows = slice(part.first, part.first + part.rows)
    ours, off = np.abs(evidence.ours[rows]), evidence.ours[rows] - evidence.theirs[rows]
    if not len(ours) or np.isnan(off).any():
        return False
    most, worst = ours.max(axis=0), np.abs(off).max(axis=0)
    scatters = np.abs(off.sum(axis=0)) <= 4 * np.sqrt((off * off).sum(axis=0))
    small = (worst <= 2.0**-16 * most) & ((worst == 0) | evidence.real | (most >= 2.0**30))
    seen = np.count_nonzero(off) >= ONE_SIDED and 2.0**-32 * most.max() < worst.max() < 2.0**-16 * most.max()
    return bool((scatters & small).all() and seen)
