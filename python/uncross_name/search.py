"""Which mistakes make what a port has made: the operator is run with each of them planted, those of the catalogue first."""
import contextlib
import dataclasses
import functools
import itertools
import math
import signal
import time

import numpy as np
from uncross_port import operators

from . import catalogue, changes, evidence, replay

SHORT = 6  # seconds for other changes that make the same numbers
FOR_CHANGES = 25  # seconds that the catalogue leaves for them
MOST_FOUND = 24  # changes of the port that make the same
MOST_NAMES = 3  # that are told of one difference
FOLLOW = ("out.event", "out.hit")  # tables whose rows, and whose number of rows, follow from earlier ones
LOOSE = 2.0**-26  # relative; of what follows from earlier events, rounding grows


class Late(Exception):
    """The time for a guess is over."""


class Clock:
    """Time for guesses, in seconds of this process from now on: on a busy machine no fewer are tried."""

    def __init__(self, seconds):
        self.end = time.process_time() + seconds

    def left(self):
        return self.end - time.process_time()

    def call(self, seconds, function, *arguments):
        """function(*arguments); None if it takes longer, or fails: a mistake may be of any kind."""
        def ring(*_):
            raise Late

        before = signal.signal(signal.SIGPROF, ring)
        signal.setitimer(signal.ITIMER_PROF, max(0.01, min(seconds, self.left())))
        try:
            with np.errstate(all="ignore"):
                return function(*arguments)
        except Exception:  # pylint: disable=broad-exception-caught
            return None
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
            signal.signal(signal.SIGPROF, before)


# --- what the operator gives with a mistake ---


class Outputs:
    """What the operator of a case gives with each mistake, step by step, as far as it was asked for."""

    def __init__(self, case, clock, made_changes=False):
        """made_changes: mistakes that are not in the catalogue are looked for, too."""
        self.case, self.clock, self.changes = case, clock, made_changes
        self.known, self.planted, self.seconds = {}, {}, {}
        self.model = self.inputs = self.right = None
        self.root = self
        self.beside, self.searched, self.clean = {}, {}, None

    def of(self, other):
        """The same of another operator of the pack."""
        if other.operator not in self.beside:
            made = self.beside[other.operator] = Outputs(other, self.clock)
            made.root, made.planted, made.right_seconds, made.inputs = self, self.planted, {}, dict(other.inputs)
        self.beside[other.operator].right = self.right
        return self.beside[other.operator]

    def _run(self, modules, step):
        broken, own = modules["operators"], modules is self.right
        inputs = self.inputs if own else self.case.inputs
        model = self.root.model if own else broken.models.from_tables(self.case.model)
        given = broken.OPERATORS[self.case.operator](model, step, inputs[step])
        return {f"out.{name}": np.asarray(values) for name, values in given.items()}

    def _hurried(self, modules, step, change):
        """Of drifts, the same while its events are theirs."""
        theirs = next((part.every["theirs.event"] for part in self.case.first.parts if part.step == step and "theirs.event" in part.every), None)
        if self.case.operator not in replay.DRIFTS or theirs is None:
            return self._run(modules, step)
        self.clean = self.clean or catalogue.plant(catalogue.RIGHT)["events"].first_contact
        with replay.hurried(modules, change, theirs.tolist(), self.searched, self.clean):
            return self._run(modules, step)

    def changed(self, change, step):
        """The same with a change of the port that is made in place; None if it fails or takes much longer than the right one."""
        try:
            with change.apply():
                return self.clock.call(0.2 + 4 * self.longer(step) * self.right_seconds.get(step, 1), self._hurried, self.right, step, change)
        except Exception:  # pylint: disable=broad-exception-caught
            return None

    def longer(self, step):
        """How many times as many events as ours theirs has, if more."""
        return max([1.0, *(part.theirs_rows / part.ours_rows for part in self.case.first.parts if part.step == step and part.ours_rows)])

    def run_right(self):
        """The right port at all steps, in a copy whose changes are made in place."""
        if self.right:
            return
        self.right, self.right_seconds = catalogue.plant(catalogue.RIGHT), {}
        self.model, self.inputs = self.right["operators"].models.from_tables(self.case.model), dict(self.case.inputs)
        for step in self.inputs:
            begun = time.process_time()
            self._run(self.right, step)
            self.right_seconds[step] = time.process_time() - begun

    def __call__(self, mistake, step):
        """{table: values}, or None."""
        if isinstance(mistake, changes.Change):
            return self.changed(mistake, step)
        if (mistake, step) not in self.known:
            if mistake not in self.planted:
                self.planted[mistake] = self.clock.call(5, catalogue.plant, mistake)
            modules, begun = self.planted[mistake], time.process_time()
            longest = 1 + 4 * self.seconds.get(step, 60)
            self.known[mistake, step] = modules and self.clock.call(longest, self._hurried, modules, step, mistake)
            self.seconds[step] = min(self.seconds.get(step, 60), time.process_time() - begun)
        return self.known[mistake, step]


# --- how a guess does ---


def _follows(found, part, guess):
    """Of a table whose rows follow from earlier ones: is theirs this guess, row by row?"""
    theirs = part.theirs
    if guess.shape != theirs.shape:
        return False
    if guess.dtype.kind == theirs.dtype.kind == "i":
        return np.array_equal(guess, theirs)
    finite = np.where(np.isfinite(found.tolerance), found.tolerance, 0.0)
    bound = np.maximum(finite.max(axis=0, initial=0.0), LOOSE * np.maximum(1.0, np.abs(guess)))
    with np.errstate(invalid="ignore"):
        near = np.abs(guess - theirs) <= bound
    return bool((near | (np.isnan(guess) & np.isnan(theirs))).all())


def _as_guess(found, part, guess):
    """The rows of a part that both have; None if the guess has not as many."""
    guess = np.asarray(guess)
    if guess.ndim != 2 or guess.shape[1] != len(found.columns) or len(guess) < part.rows:
        return None
    return evidence.as_guess(guess[: part.rows])


@dataclasses.dataclass
class Fit:
    """A mistake that makes the first table; all_tables: the operator's other ones, too."""

    mistake: catalogue.Mistake
    how: int
    bits: float
    all_tables: bool
    only: str = ""  # where theirs is this, if it is not so everywhere


def _judge_follow(found, outputs, mistake):
    """WHOLE and bits of a guess of rows that follow from earlier ones; NOT otherwise."""
    guesses = []
    for part in found.parts:
        made = outputs(mistake, part.step)
        guess = None if made is None else made.get(found.table)
        if guess is None or not _follows(found, part, guess):
            return evidence.NOT, 0.0
        guesses.append(_as_guess(found, part, guess))
    number = sum(math.log2(2 + part.theirs_rows) for part in found.parts if part.ours_rows != part.theirs_rows)
    which = evidence.ways(found.rows, int(found.wrong_rows.sum()))
    return evidence.WHOLE, found.bits(np.concatenate(guesses)) + number + which


def _judge(found, outputs, mistake):
    """How a guess does in one table, and its bits. Steps that tell most come first: most guesses end there."""
    if found.table in FOLLOW:
        return _judge_follow(found, outputs, mistake)
    guess = np.full(found.ours.shape, np.nan)
    wrong = found.wrong_rows
    for part in sorted(found.parts, key=lambda part: not wrong[part.first : part.first + part.rows].any()):
        rows = slice(part.first, part.first + part.rows)
        made = outputs(mistake, part.step)
        values = None if made is None else made.get(found.table)
        values = None if values is None or values.ndim != 2 or len(values) != part.theirs_rows else _as_guess(found, part, values)
        if values is None or not found.fits(values, rows)[found.wrong[rows]].all():
            if values is not None:
                guess[rows] = values
                found.judge(guess)  # rows that it moves count
            return evidence.NOT, 0.0
        guess[rows] = values
    how = found.judge(guess)
    return how, found.bits(guess)


def _fit(case, outputs, mistake):
    first = case.first
    how, bits = _judge(first, outputs, mistake)
    if how == evidence.NOT:
        return None
    others = [_judge(found, outputs, mistake) for found in case.others]
    if how == evidence.WRONG:
        return Fit(mistake, how, bits, False, _where(first, outputs, mistake))
    everything = all(other == evidence.WHOLE for other, _ in others)
    if everything:  # then what the other tables say counts, too
        bits = max([bits, *(more for _, more in others)])
    return Fit(mistake, how, bits, everything, "" if everything else f"in {first.table} only")


def _where(found, outputs, mistake):
    """In which columns theirs is this guess, where others are right."""
    wrong = found.wrong.any(axis=0)
    for part in found.parts if not wrong.all() and found.table not in FOLLOW else ():
        rows = slice(part.first, part.first + part.rows)
        if not found.fits(_as_guess(found, part, outputs(mistake, part.step)[found.table]), rows)[:, wrong].all():
            return "in some rows only"
    return f"in {', '.join(name for name, bad in zip(found.columns, wrong) if bad)} only" if not wrong.all() else "in some rows only"


# --- other operators of the pack ---

SLOW = ("sweep", "long_sweep", *replay.DRIFTS)


UNASKED = "other operators were not asked: the time was over"


def _says_no(case, outputs, mistake):
    """Whether an operator would not give theirs with this mistake in the port; UNASKED if the time was over before it had answered."""
    for found in case.tables:
        guess = np.full(found.ours.shape, np.nan)
        for part in found.parts:
            made = outputs(mistake, part.step)
            if made is None and outputs.clock.left() <= 1:
                return UNASKED
            values = None if made is None else made.get(found.table)
            if values is None or values.ndim != 2 or len(values) != part.theirs_rows or values.shape[1] != len(found.columns):
                return True
            guess[part.first : part.first + part.rows] = evidence.as_guess(values[: part.rows])
        if found.judge(guess) != evidence.WHOLE:
            return True
    return False


def contradiction(mistake, case, outputs):
    """The first other operator that says no to a mistake that makes the first one: its case; UNASKED if the time was over before; or None."""
    for other in case.elsewhere:
        if other.operator in SLOW and (other.operator in replay.DRIFTS or outputs.clock.left() < FOR_CHANGES):
            continue
        if isinstance(mistake, changes.Change) and mistake.of_input:
            continue
        if not isinstance(mistake, changes.Change) and not (
                other.operator in mistake.entry.get("operators", (other.operator,)) and catalogue.reaches(mistake, other.operator)):
            continue
        answer = _says_no(other, outputs.of(other), mistake) if outputs.clock.left() > 1 else UNASKED
        if answer:
            return UNASKED if answer is UNASKED else other
    return None


def candidates(case, mistakes):
    """Two lists: mistakes that are first seen at this operator, and all others that can reach it."""
    if case.operator not in operators.OPERATORS:
        return [], []
    first = [mistake for mistake in mistakes if catalogue.is_at(mistake, case.operator)]
    seen = set(first)
    return first, [mistake for mistake in mistakes if mistake not in seen and catalogue.reaches(mistake, case.operator)]


def told(fits, case, tried):
    """Of the guesses that are theirs in all tables, else in the first one, else wherever theirs is wrong, those that chance would hardly make."""
    whole = [fit for fit in fits if fit.how == evidence.WHOLE]
    whole = [fit for fit in whole if fit.all_tables] or whole or [fit for fit in fits if fit.only != "in some rows only"] or fits
    least = evidence.SURE + math.log2(tried) - case.first.choice_of_rows()
    sure = [fit for fit in whole if fit.bits >= least]
    best = max((fit.bits for fit in sure), default=0.0)
    return [fit for fit in sure if fit.bits >= best - evidence.SURE]


def held(fits, case, outputs):
    """Those of which no other table and no other operator says no; where there is none, those that would change what is
    right, each with where it is right."""
    good, bad = [], []
    for fit in fits:
        other = contradiction(fit.mistake, case, outputs) if fit.all_tables else None
        if other is None:
            (good if fit.all_tables else bad).append(fit)
        elif other is UNASKED:
            good.append(dataclasses.replace(fit, only=UNASKED))
        elif not any(found.beyond.any() or not found.same_shape for found in other.tables):
            bad.append(dataclasses.replace(fit, only=f"in {case.operator} only; {other.operator} is right"))
    return good or bad


def sentence(fits, most=MOST_NAMES):
    """Their texts, with "or" between; if they are many, what they have in common."""
    texts = list(dict.fromkeys(fit.mistake.text + (f" ({fit.only})" if fit.only else "") for fit in fits))
    lines = {getattr(fit.mistake, "line", None) for fit in fits}
    if len(texts) <= most:
        return "; or: ".join(texts) + (" (the same numbers here)" if len(texts) > 1 else "")
    where, line = (lines.pop() if len(lines) == 1 else None) or (None, None)
    said = f"a change of `{line}` ({where}): {len(texts)} changes of it make the same numbers here, as do " if line else ""
    return said + "; or: ".join(texts[:most]) + ("" if line else f"; or {len(texts) - most} more changes that make the same numbers here")


def _too_few(case, fits, outputs):
    """What makes all that is there, where so few events differ that chance would do it, too; or None."""
    fits = [fit for fit in held(fits, case, outputs) if not fit.only] if case.first.table in FOLLOW else []
    return f"too few events to tell; among what would make them: {sentence(fits)}" if fits else None


def planted(case, mistakes, outputs):
    """(fits of mistakes of the catalogue, or none; what is to be said in their place, if there are too few events to tell)."""
    fits, tried = [], 0
    for tier in candidates(case, mistakes):
        for mistake in tier:
            if outputs.clock.left() <= (FOR_CHANGES if outputs.changes else 0):
                break
            tried += 1
            fit = _fit(case, outputs, mistake)
            if fit:
                fits.append(fit)
        sure = held(told(fits, case, max(tried, 1)), case, outputs)
        if any(not fit.only for fit in sure):
            return sure, None
    return sure, _too_few(case, fits, outputs)


# --- what nobody has written down ---


@contextlib.contextmanager
def _read_as(outputs, kind, values):
    """The model, or what the operator is given, is another for a while."""
    before = getattr(outputs, kind)
    if kind == "model":
        outputs.model = dataclasses.replace(before, **values)
    else:
        outputs.inputs = {step: type(tables)({**tables, **values[step]}) for step, tables in before.items()}
    try:
        yield
    finally:
        setattr(outputs, kind, before)


def _of_inputs(inputs):
    """The same change of what the operator is given at each step."""
    every = [list(changes.of_values(tables, "the input")) for tables in inputs.values()]
    for same in zip(*every):
        if len({text for text, _ in same}) == 1:
            yield same[0][0], {step: values for step, (_, values) in zip(inputs, same)}


def changed_ones(outputs):
    """Changes that may be at an operator, likelier ones first."""
    outputs.run_right()
    operator, inputs, model = outputs.right["operators"].OPERATORS[outputs.case.operator], outputs.inputs, outputs.model
    sorts = changes.sorts_of(model)
    sorts.update(changes.likes_of(next(iter(inputs.values()))))
    lines = changes.of_call(outputs.right, sorts, lambda: [operator(model, step, given) for step, given in inputs.items()])
    yield from (change for change in lines if change.rank == 0)
    spy = changes.Spy(model)
    with contextlib.suppress(Exception):
        for step, given in inputs.items():
            operator(spy, step, given)
    for text, values in itertools.chain(changes.of_readers(model, outputs.case.model), changes.of_values(vars(model), "the model")):
        if spy.read & values.keys():
            yield changes.Change(text, 1, functools.partial(_read_as, outputs, "model", values))
    for text, values in _of_inputs(inputs):
        yield changes.Change(text, 2, functools.partial(_read_as, outputs, "inputs", values), True)
    yield from (change for change in lines if change.rank > 0)


ALONE = ("crossing", "exchange", "impulse", "contact_search", "tube_search", "bead_search", "tube_contact", "bead_contact")  # rows stand for themselves
FEW = 6  # rows that are tried first


def _unlike(values, rows):
    """A few of the rows, with other values each."""
    return rows[np.sort(np.unique(values[rows], axis=0, return_index=True)[1])][:FEW]


def _few_rows(case, outputs):
    """A function that says whether a change makes a few of the wrong rows, and some right ones; None where rows depend on others."""
    first = case.first
    if case.operator not in ALONE or not first.same_shape:
        return None
    part = max(first.parts, key=lambda part: first.wrong_rows[part.first : part.first + part.rows].sum())
    wrong = first.wrong_rows[part.first : part.first + part.rows]
    rows = np.concatenate([_unlike(part.theirs, np.flatnonzero(wrong)), _unlike(part.theirs, np.flatnonzero(~wrong))])

    def makes(change):
        with change.apply():
            given = outputs.inputs[part.step]
            some = type(given)({name: table[rows] if len(table) == part.rows else table for name, table in given.items()})
            run = outputs.right["operators"].OPERATORS[case.operator]
            made = outputs.clock.call(0.3 + outputs.right_seconds[part.step], run, outputs.model, part.step, some)
        values = made and np.asarray(made[first.table.removeprefix("out.")])
        return values is not None and values.shape == (len(rows), len(first.columns)) and bool(first.fits(evidence.as_guess(values), part.first + rows).all())
    return makes


def rounded(case, outputs, seconds):
    """Changes of rounding alone that make every bit of theirs; likelier ones first."""
    outputs.run_right()
    run, end, fits, step = outputs.right["operators"].OPERATORS[case.operator], time.process_time() + seconds, [], next(iter(outputs.inputs))
    for change in changes.of_call(outputs.right, {}, lambda: run(outputs.model, step, outputs.inputs[step]), changes.of_rounding):
        if time.process_time() > end:
            break
        made = {}
        for found in case.tables:
            for part in found.parts:
                made[part.step] = made.get(part.step) or outputs(change, part.step) or {}
                if not np.array_equal(made[part.step].get(found.table), part.theirs, equal_nan=True):
                    break
            else:
                continue
            break
        else:
            fits.append(Fit(change, evidence.WHOLE, 0.0, True))
    return fits


def _tries(case, outputs):
    """Changes, and whether each may make theirs. Of moves that follow each other, those that few moves rule out come again
    at the end: they may have had an effect before."""
    outputs.run_right()
    few, later = None, []
    with contextlib.suppress(Exception):
        few = replay.OF[case.operator](case, outputs) if case.operator in replay.OF else _few_rows(case, outputs)
    for change in changed_ones(outputs):
        good = few is None
        with contextlib.suppress(Exception):  # a change may make anything
            good = good or few(change)
        if not good and case.operator in replay.OF:
            later.append(change)
        yield change, good
    yield from ((change, True) for change in sorted(later, key=lambda change: change.line is not None and 1 + change.rank))


def _fit_of(case, outputs, change):
    with contextlib.suppress(Exception):  # a change may make anything
        return _fit(case, outputs, change)
    return None


def _at_lines(case, outputs, known):
    """Other changes of the lines of those that are known: the likeliest is seldom the first that is tried."""
    texts, lines, end = {fit.mistake.text for fit in known}, {fit.mistake.line for fit in known} - {None}, time.process_time() + SHORT
    for change in changed_ones(outputs) if lines else ():
        if time.process_time() > end or outputs.clock.left() <= 0:
            break
        if change.line in lines and change.text not in texts and change.rank < 3:
            fit = _fit_of(case, outputs, change)
            if fit and fit.all_tables:
                yield fit


def changed(case, outputs, seconds):
    """Fits of changes that make theirs, found in so many seconds; likelier ones first."""
    found, end, tried = [], time.process_time() + seconds, 0
    with contextlib.suppress(Exception):  # what the port to NumPy cannot run
        for change, good in _tries(case, outputs):
            if time.process_time() > end or outputs.clock.left() <= 0 or sum(fit.all_tables for fit in found) >= MOST_FOUND:
                break
            tried += 1
            fit = _fit_of(case, outputs, change) if good else None
            if fit:
                found.append(fit)
                end = min(end, time.process_time() + SHORT) if fit.all_tables else end
        found += _at_lines(case, outputs, [fit for fit in found if fit.all_tables])
    return sorted(held(told(found, case, max(tried, 1)), case, outputs), key=lambda fit: fit.mistake.rank)
