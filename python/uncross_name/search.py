"""Which mistakes of the catalogue make what a port has made: the operator is run with each of them planted."""
import dataclasses
import math
import signal
import time

import numpy as np
from uncross_port import operators

from . import catalogue, evidence

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

    def __init__(self, case, clock):
        self.case, self.clock = case, clock
        self.known, self.planted, self.seconds = {}, {}, {}

    def _run(self, modules, step):
        broken = modules["operators"]
        model = broken.models.from_tables(self.case.model)
        given = broken.OPERATORS[self.case.operator](model, step, self.case.inputs[step])
        return {f"out.{name}": np.asarray(values) for name, values in given.items()}

    def __call__(self, mistake, step):
        """{table: values}, or None."""
        if (mistake, step) not in self.known:
            if mistake not in self.planted:
                self.planted[mistake] = self.clock.call(5, catalogue.plant, mistake)
            modules, begun = self.planted[mistake], time.process_time()
            longest = 1 + 4 * self.seconds.get(step, 60)
            self.known[mistake, step] = modules and self.clock.call(longest, self._run, modules, step)
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
        values = None if values is None or len(values) != part.theirs_rows else _as_guess(found, part, values)
        if values is None or not found.fits(values, rows)[found.wrong[rows]].all():
            if values is not None:
                guess[rows] = values
                found.judge(guess)  # rows that it moves count
            return evidence.NOT, 0.0
        guess[rows] = values
    how = found.judge(guess)
    return how, found.bits(guess)


def _fit(case, outputs, mistake):
    how, bits = _judge(case.first, outputs, mistake)
    if how == evidence.NOT:
        return None
    others = [_judge(found, outputs, mistake) for found in case.others]
    everything = how == evidence.WHOLE and all(other == evidence.WHOLE for other, _ in others)
    if everything:  # then what the other tables say counts, too
        bits = max([bits, *(more for _, more in others)])
    return Fit(mistake, how, bits, everything)


# --- which are told ---


def candidates(case, mistakes):
    """Two lists: mistakes that are first seen at this operator, and all others that can reach it."""
    if case.operator not in operators.OPERATORS:
        return [], []
    first = [mistake for mistake in mistakes if catalogue.is_at(mistake, case.operator)]
    seen = set(first)
    return first, [mistake for mistake in mistakes if mistake not in seen and catalogue.reaches(mistake, case.operator)]


def told(fits, case, tried):
    """Of the guesses that are theirs in all tables, else in the first one, those that chance would hardly make."""
    whole = [fit for fit in fits if fit.how == evidence.WHOLE]
    whole = [fit for fit in whole if fit.all_tables] or whole
    least = evidence.SURE + math.log2(tried) - case.first.choice_of_rows()
    sure = [fit for fit in whole if fit.bits >= least]
    best = max((fit.bits for fit in sure), default=0.0)
    return [fit for fit in sure if fit.bits >= best - evidence.SURE]


def _sentence(fits):
    texts = list(dict.fromkeys(fit.mistake.text for fit in fits))
    more = " (the same numbers here)" if len(texts) > 1 else ""
    return "; or: ".join(texts[:MOST_NAMES]) + more


def _too_few(case, fits):
    """What makes all that is there, where so few events differ that chance would do it, too; or None."""
    fits = [fit for fit in fits if fit.all_tables]
    few = fits and case.first.table in FOLLOW
    return f"too few events to tell; among what would make them: {_sentence(fits)}" if few else None


def planted(case, mistakes, outputs):
    """(name or None, the best Fit that is right wherever theirs is wrong but not everywhere, or None)."""
    fits, tried = [], 0
    for tier in candidates(case, mistakes):
        for mistake in tier:
            if outputs.clock.left() <= 0:
                break
            tried += 1
            fit = _fit(case, outputs, mistake)
            if fit:
                fits.append(fit)
        sure = told(fits, case, max(tried, 1))
        if sure:
            return _sentence(sure), None
    few = _too_few(case, fits)
    if few:
        return few, None
    part = [fit for fit in fits if fit.how == evidence.WRONG and fit.bits >= evidence.SURE + math.log2(max(tried, 1))]
    return None, max(part, key=lambda fit: fit.bits, default=None)
