"""Moves that follow each other, from where ours and theirs part: a change is tried on a few moves, before it is tried on all of them.

A sweep goes on with one vertex, a drift of the rule event-driven with the contacts around the first that differs. What other moves
need is what the right port has made before.
"""
import contextlib
import copy
import functools

import numpy as np
from uncross_port.pack import Tables

from . import changes

BEFORE = 1  # contacts before the first that differs
DRIFTS = ("event_drift", "long_event_drift")


class Other(Exception):
    """This event is not theirs."""


class _Watched(list):
    """Rows of events that must be theirs."""

    def __init__(self, theirs):
        super().__init__()
        self.theirs = theirs

    def append(self, row):
        if len(self) >= len(self.theirs) or row != self.theirs[len(self)]:
            raise Other
        super().append(row)


@functools.cache
def _of_search():
    """Names of the functions that say when a contact is found: planes that doubles suggest save time, and change nothing."""
    names, new = set(), {"first_contact"}
    bodies = {path[-1]: tree for path, tree in changes.definitions("events").values() if path != ("suggested_plane",)}
    while new:
        names |= new
        new = {word for name in new for word in changes.words_of(bodies[name]) if word in bodies} - names
    return names


@contextlib.contextmanager
def hurried(modules, change, theirs, known, search):
    """A drift that ends at its first event that is not one of theirs. search: of the right port; known: what it has found."""
    events = modules["events"]
    right, begin = events.first_contact, events.Drift.__init__

    def first_contact(pair, start):
        key = (*(tuple(vector) for vector in pair), start)
        if key not in known:
            known[key] = search(pair, start)
        return known[key]

    def init(self, *given):
        begin(self, *given)
        self.rows = _Watched(theirs)
    if not _of_search() & changes.functions_of(change):
        events.first_contact = first_contact
    events.Drift.__init__ = init
    try:
        yield
    finally:
        events.first_contact, events.Drift.__init__ = right, begin



def _first(case):
    """(part, number of the first row in which events or hits of ours and theirs differ), of the first step that has one."""
    event = next(found for found in case.tables if found.table == "out.event")
    hit = next((found for found in case.tables if found.table == "out.hit"), None)
    for part in event.parts:
        bad = event.beyond[part.first : part.first + part.rows].any(axis=1)
        also = [other for other in hit.parts if other.step == part.step] if hit else []
        for other in also:
            its = hit.beyond[other.first : other.first + other.rows].any(axis=1)
            bad[: len(its)] |= its[: len(bad)]
        if bad.any() or part.ours_rows != part.theirs_rows:
            return part, int(np.append(np.flatnonzero(bad), part.rows)[0])
    return None


def sweep(case, outputs):
    """Says whether a change makes theirs at the vertex at which the first event differs."""
    found = _first(case)
    if found is None:
        return None
    part, row = found
    given, ours, theirs = outputs.inputs[part.step], part.tables["out.event"], part.every["theirs.event"]
    order = given["order"][:, 0].tolist()
    place = min(order.index(int(table[row, 0])) for table in (ours, theirs) if row < len(table))
    run = outputs.right["operators"].OPERATORS[case.operator]
    before = run(outputs.model, part.step, Tables({**given, "order": given["order"][:place]}))
    one = Tables({**given, "order": given["order"][place : place + 1], "position": before["position"], "velocity": before["velocity"]})
    wanted = theirs[theirs[:, 0] == order[place]]

    def makes(change):
        with change.apply():
            made = outputs.clock.call(2, run, outputs.model, part.step, one)
        return made is not None and np.array_equal(np.asarray(made["event"]), wanted)
    return makes


def _copied(flight):
    other = copy.copy(flight)
    for name, value in vars(flight).items():
        if isinstance(value, (np.ndarray, list, dict)):
            setattr(other, name, value.copy())
    return other


def _go_on(flight):
    tick, bond, other, image = min((tick, *key) for key, tick in flight.events.items())
    flight.answer(bond, other, image, tick)


def _follow(flight, rows, answers):
    """Goes on until there are so many rows, or nothing happens for long."""
    while flight.events and len(flight.rows) < rows and answers:
        _go_on(flight)
        answers -= 1
    return flight


def drift(case, outputs):
    """Says whether a change makes theirs at the first contact that differs."""
    found = _first(case)
    if found is None:
        return None
    part, row = found
    given, theirs = outputs.inputs[part.step], part.every["theirs.event"]
    hits = part.every["theirs.hit"]
    if row >= len(theirs):
        return None
    flight = outputs.right["events"].Drift(outputs.model, given["position"], given["velocity"], *given["time"][0])
    flight.search({int(bond) for bond in flight.model.bonds}, 0)
    begin, answers, states = max(0, row - BEFORE), 0, [_copied(flight)]
    while flight.events and len(flight.rows) <= row:
        _go_on(flight)
        answers += 1
        if len(flight.rows) == begin and len(states) == 1 and begin:
            states.append(_copied(flight))
            answers = 0
    known = states[-1]

    def go():
        flight = _copied(known)
        flight.model, (flight.time, flight.start) = outputs.model, outputs.inputs[part.step]["time"][0]
        return _follow(flight, row + 1, 3 * answers + 20)

    def makes(change):
        with change.apply():
            made = outputs.clock.call(3, go)
        if made is None or len(made.rows) <= row or not np.array_equal(np.array(made.rows[: row + 1]), theirs[: row + 1]):
            return False
        return bool(np.allclose(np.array(made.hits[begin : row + 1], float), hits[begin : row + 1], 1e-6, 1e-9, equal_nan=True))
    return makes


OF = {"sweep": sweep, "long_sweep": sweep, **dict.fromkeys(DRIFTS, drift)}
