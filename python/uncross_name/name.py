"""What a difference means, in one line."""
import math

import numpy as np

from . import anything, catalogue, evidence, rows, search
from . import case as cases

SECONDS = 50  # for guesses; what is said then takes a few more
MANY = 6  # changes that make the same numbers: a name is one of many causes then
AT_ROUNDING = 5  # for orders of operations that make each bit
UNKNOWN = "none of those known"
AS_ROUNDING = ("no larger than rounding: another order of operations, fused multiply-add, library functions, or a bug whose effect is "
               "as small")
AS_SINGLE = ("right to 5 to 8 digits, with errors of either sign: as of single precision, or of a number that is off by so little")


def is_rounding(found):
    """Nothing but last bits: what a mistake does here is nothing else than what rounding does."""
    with np.errstate(invalid="ignore"):
        return found.real and bool((np.abs(found.theirs - found.ours) <= 2.0**-30 * np.abs(found.ours)).all())


def _any_operator(found):
    """A guess that needs no operator: of the columns that are wrong. Name, or None; and what is right in all wrong values
    only, or None."""
    right = ~found.wrong.any(axis=0)
    said = f" (in {', '.join(name for name, good in zip(found.columns, right) if not good)} only)" if right.any() else ""
    fits, partial, tried = [], None, 0
    for text, guess, free in anything.guesses(found):
        tried += 1
        guess = np.where(right, found.theirs, guess)
        how = found.judge(guess)
        if how == evidence.NOT:
            continue
        bits = found.bits(guess, free)
        if how == evidence.WHOLE:
            fits.append((text + said, bits, free))
        elif partial is None and bits >= evidence.SURE + math.log2(tried):
            partial = text + said
    names, choice = [], evidence.ways(found.rows, int(found.wrong_rows.sum()))
    for text, bits, free in fits:
        if bits + choice >= evidence.SURE + math.log2(tried) and not (free and names) and text not in names:
            names.append(text)
    return "; or: ".join(names[:search.MOST_NAMES]), partial


def _which_table(case):
    """Of an operator that has tables of one kind, all others may be right."""
    first = case.first
    like = [found for found in case.others if found.columns == first.columns and found.rows]
    if case.operator not in ("bin", "rotate", "exchange") or not like or any(found.beyond.any() for found in like):
        return ""
    return f" (in {first.table} only; {f'its like are' if len(like) > 1 else f'{like[0].table} is'} right)"


def _moves_are_right(case):
    return not any(found.beyond.any() for found in case.others if found.table in ("out.position", "out.velocity"))


def _first_hit(case):
    """Of rows that follow from earlier ones, the first one that differs counts; None if all else is right."""
    first = case.first
    if first.table not in search.FOLLOW:
        return None
    if _moves_are_right(case):
        said = None if first.same_shape else rows.unreported(next(found for found in case.tables if found.table == "out.event"))
        return said and f"{UNKNOWN}; all vertices end where they should, but {said}"
    bad = first.beyond
    if not bad.any():
        return f"{UNKNOWN}; theirs has another number of rows, {first.table} of the first {first.rows} rows is right"
    row = int(np.flatnonzero(bad.any(axis=1))[0])
    _, own = first.part_of(row)
    names = ", ".join(name for name, wrong in zip(first.columns, bad[row]) if wrong)
    return f"{UNKNOWN}; the first row that differs, {own}, is wrong in {names}"


def _size(found):
    """How far off the wrong values are."""
    with np.errstate(invalid="ignore"):
        off = np.abs(found.theirs - found.ours)[found.wrong & np.isfinite(found.theirs)]
    return f"; off by {off.min():.3g} to {off.max():.3g}" if off.size and off.max() > 0 else ""


def _description(case, partial):
    """Which rows are wrong, by an exact rule if there is one; and what their values are, if that is known."""
    first = case.first
    exact, text = rows.describe(first)
    if not exact and first.different.sum() > first.wrong.sum():
        first.take_all()
        exact, again = rows.describe(first)
        text = again if exact else text
    side = partial or anything.one_sided(first)
    return ("" if exact else f"{UNKNOWN}; ") + (f"{side}; " if side else "") + text + ("" if exact else _size(first))


def _alternatives(said, case, outputs, generic=()):
    """A mistake that is known, and what else makes the same numbers here."""
    fits = search.changed(case, outputs, search.SHORT) if outputs.changes else []
    fits = [fit for fit in fits if not fit.only]
    more = [*(text for text in generic if text != said), *([search.sentence(fits, 2)] if fits else [])]
    doubt = "this pack does not tell which: " if len(fits) > MANY else ""
    return doubt + said + (f"; the same numbers here: {'; or: '.join(more)}" if more else "")


def name(case, mistakes, outputs):
    """outputs: of search.Outputs(case)."""
    first = case.first
    beyond = bool(first.beyond.any()) or not first.same_shape
    digits = anything.printed(case)
    if digits:
        return digits
    if not beyond:
        first.take_all()
        fits = search.rounded(case, outputs, AT_ROUNDING) if outputs.changes and not case.single and first.wrong.sum() > 1 else []
        if fits:
            return f"within tolerance; bit for bit: {search.sentence(fits)}"
        if is_rounding(first):
            return anything.one_sided(first) or AS_ROUNDING
    moves_follow = first.table in search.FOLLOW and not (first.same_shape and _moves_are_right(case))
    found, other = _any_operator(first) if first.wrong.any() and not moves_follow else (None, None)
    fits, few = search.planted(case, mistakes, outputs)
    sure = [fit for fit in fits if not fit.only]
    if sure:
        return _alternatives(search.sentence(sure), case, outputs, [found] if found else [])
    if found:
        return _alternatives(found + _which_table(case), case, outputs)
    if anything.is_single(first) and not case.single:
        return AS_SINGLE
    if not beyond:
        return anything.one_sided(first) or AS_ROUNDING
    changed = search.changed(case, outputs, outputs.clock.left()) if outputs.changes else []
    whole = [fit for fit in changed if not fit.only]
    if whole:
        return search.sentence(whole)
    part = [fit for fit in fits or changed if fit.only != "in some rows only"]
    if part and not few:
        return search.sentence(part)
    if fits or (changed and not other):  # a mistake that somebody has written down says more than what any operator may do
        other = f"the wrong values are those of {search.sentence(fits or changed)}"
    return few or anything.pattern(first) or _first_hit(case) or _description(case, other)


def read_and_name(path, seconds=SECONDS):
    clock = search.Clock(seconds)
    case = cases.read(path)
    return name(case, catalogue.read(), search.Outputs(case, clock, True))
