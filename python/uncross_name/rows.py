"""Which rows are wrong. A rule is a fact about rows, or two or three of them joined, and is told only if it is exact: true of
every wrong row and of no right one. The simplest rule wins. A rule that would fit by chance is not told: a rule of b bits is
one of 2^b of its weight, all weights together are 1, so the odds that any rule at all fits w wrong rows of n that are drawn
at random are below 2^-10 if b + 10 <= log2 of n over w.
"""
import math
from dataclasses import replace

import numpy as np

from . import facts
from .evidence import SURE, Evidence, ways

MANY = 160  # facts of which threes are tried
LISTED = 8  # rows that are told one by one


class Units:
    """What facts are about: rows, or the single values of those columns that have wrong ones."""

    def __init__(self, evidence, values):
        self.evidence, self.values = evidence, values
        self.columns = np.flatnonzero(evidence.wrong.any(axis=0))
        self.wrong = evidence.wrong[:, self.columns].ravel() if values else evidence.wrong_rows
        self.each = "values" if values else "rows"

    def spread(self, numbers):
        """A number for each unit, from one for each row, or from one for each value of this table."""
        if numbers.ndim == 2:
            return numbers[:, self.columns].ravel()
        return np.repeat(numbers, len(self.columns)) if self.values else numbers

    def bits_of_choice(self):
        """What the choice of the wrong units is worth. If it is the same at each step, it counts once."""
        parts = self.evidence.parts
        alike = len({part.rows for part in parts}) == 1
        steps = self.wrong.reshape(len(parts) if alike else 1, -1)
        once = steps[0] if (steps == steps[0]).all() else self.wrong
        return ways(len(once), int(once.sum()))


def find_rule(units):
    """The cheapest exact rule, as (number of facts, words), or None. With `and`, facts help that hold for every wrong unit; with `or`, those that
    hold for wrong ones only. Each leaves something: right units that it holds for, or wrong ones that it does not hold for.
    A rule is exact if there is no unit that all of its facts leave."""
    known = facts.collect(units)
    cost = np.array([fact.cost for fact in known])
    cost += math.log2((2.0**-cost).sum())  # the weights 2^-cost are 1 together
    holds, wrong = np.array([fact.holds for fact in known]), units.wrong
    best, rule = units.bits_of_choice() - SURE, None
    for join, extra, helps, left in (
        (", and ", 0.0, holds[:, wrong].all(axis=1), holds[:, ~wrong]),
        (", or ", 1.0, holds.any(axis=1) & ~holds[:, ~wrong].any(axis=1), ~holds[:, wrong]),
    ):
        useful = np.flatnonzero(helps & (1.0 + cost <= best))
        c, left = cost[useful], np.packbits(left[useful], axis=1)
        for chosen, costs, leaves in candidates(c, left, extra, lambda: best):
            exact = np.flatnonzero(~leaves.any(axis=1) & (costs <= best))
            if len(exact) and (rule is None or costs[exact].min() < best):
                k = exact[costs[exact].argmin()]
                best, rule = costs[k], (len(chosen) + 1, join.join(known[useful[fact]].text for fact in (*chosen, k)))
    return rule


def candidates(cost, left, extra, best):
    """Rules of one, two and three facts: the first facts; for each last fact, the rule's cost, and what its facts leave."""
    yield (), 1.0 + cost, left
    for i in range(len(cost)):
        both = left[:i] & left[i]
        yield (i,), 3.0 + extra + cost[i] + cost[:i], both
        for j in range(i if i < MANY else 0):
            costs = 5.0 + extra + cost[i] + cost[j] + cost[:j]
            if (costs < best()).any():
                yield (i, j), costs, both[j] & left[:j]


# --- words


def describe(evidence):
    """(True, exactly which values are wrong, by a rule or by the numbers of a few rows), or (False, the first rows' numbers) if
    they are many and no rule is known, or if all of the table is wrong."""
    if not evidence.wrong.any():
        return False, "all rows that both have are right"
    rows, values = Units(evidence, False), Units(evidence, True)
    everywhere = rows.wrong.all() and len(rows.columns) == len(evidence.columns)
    whole = rows.wrong.sum() * len(rows.columns) == values.wrong.sum()  # then single values tell no more than rows
    told = []
    for units in (rows,) if whole else (values, rows):
        rule = None if units.wrong.all() else find_rule(units)
        if rule:
            told.append((rule[0], say_rule(units, rule[1])))
    if not told and rows.wrong.all() and not everywhere:
        told = [(0, say_rule(rows, None))]
    if told:
        return True, min(told, key=lambda rule: rule[0])[1]
    return (False, f"all rows: {evidence.rows} of {evidence.rows}") if everywhere else say_list(rows)


def unreported(evidence):
    """Of a table of events, which of ours are not among theirs; None if all are, and theirs are no more. Whether an event was
    executed counts not."""
    parts, values, missing, more, first = [], [], 0, 0, 0
    key = [k for k, name in enumerate(evidence.columns) if name != "executed"]
    for part in evidence.parts:
        ours, theirs = ([tuple(event) for event in table[:, key].tolist()] for table in (part.tables[evidence.table], part.theirs))
        there = np.isin(np.arange(len(ours)), [k for k, event in enumerate(ours) if event in theirs])[:, None].astype(int)
        missing, more = missing + int((1 - there).sum()), more + sum(event not in ours for event in theirs)
        parts.append(replace(part, first=first, rows=len(ours), theirs_rows=len(ours)))
        values.append([there * 0 + 1, there, there * 0])
        first += len(ours)
    if not missing + more:
        return None
    said = f"{missing} events are not reported, {more} that are none are"
    return said + (": " + describe(Evidence(evidence.operator, "out.reported", ("reported",), parts, values))[1] if missing else "")


def say_rule(units, rule):
    each, wrong, n = units.each, int(units.wrong.sum()), len(units.wrong)
    names = [units.evidence.columns[k] for k in units.columns]
    columns = "" if len(names) == len(units.evidence.columns) else f"column{'s' * (len(names) > 1)} {', '.join(names)} of "
    where = f"{each} where {rule}" if rule else f"all {each}"
    return f"wrong exactly in {columns}{where}: {wrong} of {n} {each}{', and nowhere else' if wrong < n else ''}"


def say_list(units):
    """Rows by their numbers: all if they are few."""
    evidence, wrong = units.evidence, np.flatnonzero(units.wrong)
    few, told = len(wrong) <= LISTED, []
    for row in wrong[:LISTED]:
        part, own = evidence.part_of(row)
        step = f" of step {part.step}" if few and len(evidence.parts) > 1 else ""
        told.append(f"{own}{step}{' (the last)' if few and own + 1 == part.ours_rows else ''}")
    if few:
        return True, f"wrong exactly in {len(wrong)} of {len(units.wrong)} rows, too few for a rule: {', '.join(told)}"
    return False, f"no rule known for the wrong rows, {len(wrong)} of {len(units.wrong)}: {', '.join(told)}, ..."
