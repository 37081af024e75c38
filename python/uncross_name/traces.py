"""What a difference of two traces means: whole steps of the port to NumPy are run with one mistake each, and the state hash
of theirs is looked for. A hash that is found leaves no doubt; a mistake is told as such if it makes all rows of theirs.
"""
import contextlib
import copy
import csv
import dataclasses
import functools
import inspect
import itertools
import sys
import time
import types

import numpy as np
import xxhash
from uncross_port import pack

from . import catalogue, changes, search

UNKNOWN = "none of those known makes their hash"
MOST_NAMES = 4
HASHES = ("state_hash", "digest", "contacts_hash", "contacts_digest")
MOST_FOUND = 24
MORE = 4  # seconds for others after the first
LAST = 6  # seconds that are kept for looking at all rows


def read_rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


class Trace:
    """A run that can be begun at each step. rows: theirs."""

    def __init__(self, start, theirs, modules):
        self.modules, self.theirs = modules, theirs
        self.tables, self.model_tables = modules["operators"].inputs(start["start", 0]), modules["operators"].inputs(start["model", 0])
        self.hashes = [name for name in HASHES if name in theirs[0]]
        self.agreed = 0
        self.right, self.begun, self.alter = [], {}, lambda model: model

    def model(self):
        return self.modules["operators"].models.from_tables(self.model_tables)

    def fresh(self):
        return self.modules["step"].System(self.alter(self.model()), type(self.tables)({name: np.array(values) for name, values in self.tables.items()}))

    def row(self, system, place):
        """As the trace has it, of what theirs has."""
        contacts = dict(zip(("contacts", "contacts_hash", "contacts_digest"), map(str, system.take_contacts())))
        found = {"step": str(place[0]), "stage": place[1], **contacts}
        if "state_hash" in self.hashes:
            found["state_hash"] = system.state_hash()
        if "digest" in self.hashes:
            found["digest"] = system.digest()
        return found

    def rows(self, system, keep=False):
        """Rows from the step on that a system is at."""
        if system.finished == 0:
            yield self.row(system, (0, "start"))
        for step in range(system.finished + 1, system.scene.steps + 1):
            if keep:
                self.begun[step] = shallow(system)
            for stage in system.step():
                yield self.row(system, (step, stage))

    def same(self, row, its):
        if (row["step"], row["stage"]) != (its.get("step"), its.get("stage")):
            return False
        return all(row[name] == (its[name] or "").lower() for name in self.hashes if name in row)

    def find_first(self):
        """Number of the first row in which the right trace is not theirs; None if there is none."""
        first = None
        for k, row in enumerate(self.rows(self.fresh(), keep=True)):
            self.right.append(row)
            if first is None and (k >= len(self.theirs) or not self.same(row, self.theirs[k])):
                first = k
            if first is not None and k >= first:
                break
        self.first = first
        return first

    def stages_again(self):
        """The same for a port whose steps are as they should be: only the stages are run that may make the first difference,
        from the state before them."""
        step = int(self.right[self.first]["step"])
        if step == 0:
            return self.reaches_first()
        system, sweeps, last = self.take(self.begun[step]), 0, None
        for k, (label, share) in enumerate(self.done(step), self.number(step)):
            if k == self.first_stage:
                system = self.take(self.states[k])
            if k >= self.first_stage and label != "end":
                act(system, label, share, sweeps)
            sweeps += label == "drift"
            last = k
            if k == self.first:
                system.finished += label == "end"
                return self.same(self.row(system, (step, label)), self.theirs[k])
        return last == self.first

    def done(self, step):
        """Stages of a step that have a row, each with its share of the step."""
        system = self.begun[step]
        plan = [each for each in system.plan() if each[0] not in ("force", "kick") or len(system.vertex) or system.model.medium is not None]
        return [*plan, ("end", None)]

    def find_stages(self):
        """The states before the stages of the step of the first difference. Stages that do not show come with the next."""
        step, self.states = int(self.right[self.first]["step"]), {}
        self.first_stage = self.first
        if step == 0:
            return
        system, sweeps, start = shallow(self.begun[step]), 0, self.number(step)
        for k, (label, share) in enumerate(self.done(step)[: self.first - start + 1], start):
            self.states[k] = shallow(system)
            if label != "end":
                act(system, label, share, sweeps)
            sweeps += label == "drift"
        while self.first_stage > start and all(self.right[self.first_stage - 1][name] == self.right[self.first_stage - 2][name]
                                               for name in self.hashes if name in ("state_hash", "digest")):
            self.first_stage -= 1

    def number(self, step):
        """Of the first row of a step."""
        return next(k for k, row in enumerate(self.right) if int(row["step"]) == step)

    def begin(self):
        """(system one step before the first difference, number of the first row from there)."""
        step = max(1, int(self.right[self.first]["step"]) - 1)
        if step == 1:
            return self.fresh(), 0
        return self.take(self.begun[step]), self.number(step)

    def take(self, system):
        """It goes on by itself, with another model if one is wanted."""
        system = shallow(system)
        system.model = self.alter(system.model)
        return system

    def reaches_first(self):
        """Whether the port, as it is now, makes theirs from the step before the first difference on, up to it."""
        system, k = self.begin()
        for row in self.rows(system):
            if not self.same(row, self.theirs[k]):
                return False
            if k == self.first:
                return True
            k += 1
        return False

    def agreeing(self):
        """How many rows from the start are theirs; `agreed`, while they are counted."""
        self.agreed = 0
        for row in self.rows(self.fresh()):
            if self.agreed >= len(self.theirs) or not self.same(row, self.theirs[self.agreed]):
                break
            self.agreed += 1
        return self.agreed


def act(system, stage, share, sweeps):
    if stage == "drift":
        system.drift(share, sweeps)
    elif stage == "kick":
        system.kick(share)
    else:
        {"force": system.find_forces, "move": system.move, "collide": system.collide}[stage]()


def shallow(system):
    """A system that goes on by itself: arrays are made anew by each stage, but for the account of walls."""
    other = copy.copy(system)
    if system.account is not None:
        other.account = system.account.copy()
    other.contacts = list(system.contacts)
    return other


# --- mistakes of the order of stages ---


def _each(plan):
    return [[stage] for stage in plan]


def _other_plan(other, plan):
    """The stages of another order under the names of this one."""
    if ("collide", None) not in plan:
        return _each(plan)
    made = [[stage] for stage in other[: len(plan)]]
    made[-1] += other[len(plan) :]
    return made + [[]] * (len(plan) - len(made))


def _put(k, stages, plan):
    return [stages if j == k else [each] for j, each in enumerate(plan)] if k < len(plan) else _each(plan)


def _exchange(i, j, plan):
    order = list(range(len(plan)))
    if j < len(plan):
        order[i], order[j] = j, i
    return [[plan[k]] for k in order]


def _plans(step):
    """(text, what is done at each stage of a plan)."""
    for name, other in step.COLLIDING.items():
        yield f"stages as in the order {name}", functools.partial(_other_plan, other)
    yield "no collision", lambda plan: [[stage] if stage[0] != "collide" else [] for stage in plan]
    yield "a collision in each step, after its first stage", lambda plan: _each(plan) if ("collide", None) in plan else _put(0, [plan[0], ("collide", None)], plan)
    for kinds in (("collide",), ("force",), ("kick",), ("drift",), ("move",)):
        where = kinds[0]
        for nth in (0, 1):
            which = ("the first ", "the second ")[nth] + where

            def change(plan, how, where=where, nth=nth):
                found = [k for k, (stage, _) in enumerate(plan) if stage == where]
                return _put(found[nth], how(plan[found[nth]]), plan) if nth < len(found) else _each(plan)
            yield f"{which} of a step is left out", functools.partial(change, how=lambda stage: [])
            yield f"{which} of a step is done twice", functools.partial(change, how=lambda stage: [stage, stage])
            for factor in (2.0, 0.5, 0.0, -1.0):
                yield f"{which} of a step takes {factor:g} of its time", functools.partial(
                    change, how=lambda stage, factor=factor: [(stage[0], stage[1] and factor * stage[1])])
    for i, j in itertools.combinations(range(5), 2):
        yield f"stages {i + 1} and {j + 1} of a step are exchanged", functools.partial(_exchange, i, j)


def _step_of(change):
    """A step that does at each stage what the change says."""
    def step(self):
        sweeps, plan = 0, self.plan()
        for (label, _), acts in zip(plan, change(plan)):
            if label in ("force", "kick") and not len(self.vertex) and self.model.medium is None:
                continue
            for stage, share in acts:
                act(self, stage, share, sweeps)
                sweeps += stage == "drift"
            yield label
        self.finished += 1
        yield "end"
    return step


# --- values of before ---

KEPT = ("solvent", "solvent_velocity", "vertex", "vertex_velocity", "force", "lag", "finished", "streamed")


@contextlib.contextmanager
def _stale(system_class, stage, name, when):
    """A stage sees what a value was at the start of its step, or of the step before; the others see what it is."""
    right, right_step = getattr(system_class, stage), system_class.step

    def stepped(self):
        self.__dict__["at_start"] = (self.__dict__.get("at_start", (None, None))[1], {kept: getattr(self, kept) for kept in KEPT})
        yield from right_step(self)

    def broken(self, *given):
        old = self.__dict__.get("at_start", (None, None))[when]
        if not old or old[name] is None:
            return right(self, *given)
        now = getattr(self, name)
        setattr(self, name, old[name])
        right(self, *given)
        if getattr(self, name) is old[name]:  # the stage only reads it
            setattr(self, name, now)
        return None

    setattr(system_class, stage, broken)
    system_class.step = stepped
    try:
        yield
    finally:
        setattr(system_class, stage, right)
        system_class.step = right_step


@contextlib.contextmanager
def _patched(place, name, value):
    right = getattr(place, name)
    setattr(place, name, value)
    try:
        yield
    finally:
        setattr(place, name, right)


STAGES = ("drift", "stream", "kick", "find_forces", "collide", "move", "meet")


def of_steps(modules):
    """Changes of the order of stages, and stages that see values of before."""
    step = modules["step"]
    for text, change in _plans(step):
        yield changes.Change(f"order of stages: {text}", 0, functools.partial(_patched, step.System, "step", _step_of(change)))
    for stage, name, (when, said) in itertools.product(STAGES, KEPT, ((1, "at the start of the step"), (0, "at the start of the step before"))):
        yield changes.Change(f"{stage} takes {name.replace('_', ' ')} as it was {said}", 1,
                             lambda stage=stage, name=name, when=when: _stale(step.System, stage, name, when))


# --- what a stage leaves ---


def _leaving(right, change):
    def broken(self, *given):
        before = {name: getattr(self, name) for name in KEPT}
        right(self, *given)
        change(self, before)
    return broken


def _kept(name):
    def change(system, before):
        setattr(system, name, before[name])
    return change


def _made(name, how):
    def change(system, _):
        if getattr(system, name) is not None:
            setattr(system, name, how(system, getattr(system, name)))
    return change


def of_states(modules):
    """A stage leaves a part of the state as it was, or makes something else of it."""
    system, lattice = modules["step"].System, modules["lattice"]
    leaves = [(f"leaves {name.replace('_', ' ')} as it was", _kept(name)) for name in ("solvent", "solvent_velocity", "vertex", "vertex_velocity", "lag")]
    for name in ("solvent", "vertex"):
        leaves += [(f"wraps the positions of {name} into the box: they are not wrapped", _made(name, lambda at, x: lattice.wrap(x, at.model.box))),
                   (f"rounds velocities of {name} to single precision", _made(f"{name}_velocity", lambda _, v: v.astype(np.float32).astype(float))),
                   (f"turns velocities of {name} round", _made(f"{name}_velocity", lambda _, v: -v)),
                   (f"sets velocities of {name} to zero", _made(f"{name}_velocity", lambda _, v: 0 * v))]
    leaves += [("sets the lag to 0", _made("lag", lambda *_: 0)), ("adds 1 to the lag", _made("lag", lambda _, lag: lag + 1)), ("takes 1 off the lag", _made("lag", lambda _, lag: lag - 1))]
    for stage, (text, change) in itertools.product(("drift", "collide", "kick", "stream", "find_forces"), leaves):
        yield changes.Change(f"{stage} {text}", 0, functools.partial(_patched, system, stage, _leaving(getattr(system, stage), change)))


# --- what is hashed ---

HEAD = ("the number of finished steps", "the lag", "the number of particles", "the number of vertices")


def _heads():
    for k, name in enumerate(HEAD):
        yield f"without {name}", lambda head, k=k: [x for j, x in enumerate(head) if j != k]
    for i, j in itertools.combinations(range(4), 2):
        yield f"with {HEAD[i]} and {HEAD[j]} exchanged", lambda head, i=i, j=j: [head[{i: j, j: i}.get(k, k)] for k in range(len(head))]
    yield "without the four numbers at its head", lambda head: head[4:]
    for text, k, how in (("one step too few", 0, lambda x: max(x - 1, 0)), ("one step too many", 0, lambda x: x + 1), ("the lag in steps", 1, lambda x: x // 2),
                         ("a lag of 0", 1, lambda x: 0), ("twice the lag", 1, lambda x: 2 * x), ("no vertices counted", 3, lambda x: 0), ("no particles counted", 2, lambda x: 0)):
        yield f"of {text}", lambda head, k=k, how=how: [how(x) if j == k else x for j, x in enumerate(head)]


def _rows_of(p, v):
    return np.hstack([p, v])


LAYOUTS = {
    "with velocities before positions": lambda box, s, sv, r, rv: [_rows_of(sv, s), _rows_of(rv, r)],
    "with all positions of a kind before its velocities": lambda box, s, sv, r, rv: [s, sv, r, rv],
    "with all positions before all velocities": lambda box, s, sv, r, rv: [s, r, sv, rv],
    "with vertices before the solvent": lambda box, s, sv, r, rv: [_rows_of(r, rv), _rows_of(s, sv)],
    "without vertices": lambda box, s, sv, r, rv: [_rows_of(s, sv)],
    "without the solvent": lambda box, s, sv, r, rv: [_rows_of(r, rv)],
    "without velocities": lambda box, s, sv, r, rv: [s, r],
    "without positions": lambda box, s, sv, r, rv: [sv, rv],
    "without velocities of vertices": lambda box, s, sv, r, rv: [_rows_of(s, sv), r],
    "with vertices wrapped into the box": lambda box, s, sv, r, rv: [_rows_of(s, sv), _rows_of(r % box, rv)],
    "column by column": lambda box, s, sv, r, rv: [_rows_of(s, sv).T, _rows_of(r, rv).T],
    "of positions as doubles": lambda box, s, sv, r, rv: [_rows_of(s.astype(float).view(np.int64), sv), _rows_of(r.astype(float).view(np.int64), rv)],
    "of positions in a0, as doubles": lambda box, s, sv, r, rv: [_rows_of((s * 2.0**-40).view(np.int64), sv), _rows_of((r * 2.0**-40).view(np.int64), rv)],
}


def _hash(system, heads, layout, end, order="<"):
    """Of a state without walls and dumbbells."""
    head = heads([system.finished, system.lag, len(system.solvent), len(system.vertex)])
    parts = layout(system.model.box * (1 << 40), system.solvent, system.solvent_velocity.view(np.int64), system.vertex, system.vertex_velocity.view(np.int64))
    pieces = [np.array(head, f"{order}i8").tobytes(), *(np.ascontiguousarray(part.astype(f"{order}i8")).tobytes() for part in parts)]
    return end(b"".join(pieces))


def of_hashes(modules):
    """The hash is another one of the same state."""
    system = modules["step"].System
    right = LAYOUTS["with velocities before positions"]
    same = lambda head: head  # noqa: E731
    plain = lambda box, s, sv, r, rv: right(box, sv, s, rv, r)  # noqa: E731
    end = lambda data: f"{xxhash.xxh64(data).intdigest():016x}"  # noqa: E731
    every = [(text, heads, plain, end, "<") for text, heads in _heads()] + [(text, same, layout, end, "<") for text, layout in LAYOUTS.items()]
    every += [("of bytes in the other order", same, plain, end, ">"), ("with the seed 1", same, plain, lambda data: xxhash.xxh64(data, 1).hexdigest(), "<"),
              ("of 32 bits", same, plain, lambda data: xxhash.xxh32(data).hexdigest(), "<"), ("of XXH3", same, plain, lambda data: xxhash.xxh3_64(data).hexdigest(), "<"),
              ("with its bytes in the other order", same, plain, lambda data: xxhash.xxh64(data).digest()[::-1].hex(), "<"),
              ("without its leading zeros", same, plain, lambda data: f"{xxhash.xxh64(data).intdigest():x}", "<")]
    for text, *how in every:
        yield changes.Change(f"the state hash is made {text}", 0, functools.partial(_patched, system, "state_hash", lambda self, how=how: _hash(self, *how)))


# --- calls that are given something else ---

CALLED = ("solvent", "fiber", "flow", "events", "sweep", "media", "dumbbells")


def _ordinal(n):
    return ("first", "second", "third", "fourth", "fifth", "sixth")[n] if n < 6 else f"{n + 1}th"


class Calls:
    """Calls of operators that a step makes. calls: (module, function, number among those of this function in
    the step, arguments, those of the step before, the function). change: of one of them."""

    def __init__(self, modules):
        self.modules, self.calls, self.counts, self.last, self.at, self.change = modules, [], {}, {}, None, None

    @contextlib.contextmanager
    def watched(self):
        with contextlib.ExitStack() as stack:
            for name in CALLED:
                for word, function in list(vars(self.modules[name]).items()):
                    if isinstance(function, types.FunctionType) and function.__module__ == self.modules[name].__name__:
                        stack.enter_context(_patched(self.modules[name], word, self._watch(name, word, function)))
            yield

    def _watch(self, name, word, function):
        own = self.modules["step"].__dict__

        def called(*given):
            frame = next((sys._getframe(k) for k in (1, 2) if sys._getframe(k).f_globals is own), None)  # pylint: disable=protected-access
            if frame is None:
                return function(*given)
            finished = getattr(frame.f_locals.get("self"), "finished", None)
            if finished != self.at:
                self.at, self.counts = finished, {}
            nth = self.counts[name, word] = self.counts.get((name, word), -1) + 1
            before, self.last[name, word, nth] = self.last.get((name, word, nth), ()), given
            if self.change and self.change[:2] == (name, word) and self.change[2] in (None, nth):
                given = self.change[3](given, before)
            self.calls.append((name, word, nth, given, before, function))
            return function(*given)
        return called


def of_calls(trace):
    """One argument of one call, or of all calls of an operator, is another."""
    seen, step = Calls(trace.modules), int(trace.right[trace.first]["step"])
    with seen.watched():
        for before in range(1, step):
            for _ in shallow(trace.begun[before]).step():
                pass
        last, seen.calls = dict(seen.last), []
        trace.stages_again()
    many = {(name, word) for name, word, nth, *_ in seen.calls if nth > 0}
    for name, word, nth, given, before, function in seen.calls:
        names = list(inspect.signature(function).parameters)
        which = f"the {_ordinal(nth)} {name}.{word}" if (name, word) in many else f"{name}.{word}"
        for k, value in enumerate(given):
            what = names[k] if k < len(names) else f"argument {k + 1}"
            for text, _ in changes.others(value, given, before[k] if k < len(before) else None):
                yield _call_change(trace.modules, last, (name, word, nth), f"{which} is given {text} as {what}", k, text)
                if nth == 0 and (name, word) in many:
                    yield _call_change(trace.modules, last, (name, word, None), f"each {name}.{word} is given {text} as {what}", k, text)


def _call_change(modules, last, place, text, k, how):
    def change(given, before):
        every = changes.others(given[k], given, before[k] if k < len(before) else None)
        return (*given[:k], next((other for word, other in every if word == how), given[k]), *given[k + 1 :])

    @contextlib.contextmanager
    def apply():
        calls = Calls(modules)
        calls.change, calls.last = (*place, change), dict(last)
        with calls.watched():
            yield
    return changes.Change(text, 0, apply)


# --- values of the model that are read as others ---


def of_models(trace):
    for text, values in changes.of_values(vars(trace.model()), 'the model'):
        yield changes.Change(text, 0, functools.partial(_patched, trace, "alter", lambda model, values=values: dataclasses.replace(model, **values)))


# --- the search ---


STEPS = ("step.System.step", "step.System.plan", "step.System.__init__", "step.trace", "step.run_of")


def _sorted(every):
    return sorted(every, key=lambda change: change.rank)


def candidates(trace):
    """(change, whether whole steps must be run)."""
    start = int(trace.right[trace.first]["step"]) == 0
    system = trace.begun.get(int(trace.right[trace.first]["step"])) or trace.fresh()
    sorts = changes.sorts_of(system, system.model)
    whole, used = (changes.Used(trace.modules, function) for function in (trace.reaches_first, trace.stages_again))
    steps = [change for each in whole.functions() if ".".join((each[0], *each[1])) in STEPS
             for change in changes.of_function(each, trace.modules[each[0]], sorts)]
    every = [change for each in used.functions() for change in changes.of_function(each, trace.modules[each[0]], sorts) if change.where not in STEPS]
    near = _sorted(change for change in every if change.where.startswith("step."))
    far = _sorted(change for change in every if not change.where.startswith("step."))
    def some(every, *ranks):
        return [change for change in every if min(change.rank, 4) in ranks]

    steps, likely = _sorted(steps), [] if start else [(of_states(trace.modules), False), (of_steps(trace.modules), True)]
    groups = [(of_hashes(trace.modules), False), (some(near, 0, 1), False), *likely]
    groups += [] if start else [(changes.of_elsewhere(list(used.functions())), False), (of_calls(trace), False), (of_models(trace), False)]
    groups += [(some(near, 2), False), (some(steps, 0, 1), True), (changes.of_catalogue(catalogue.read(), used), False), (some(far, 0, 1), False),
               (some(near, 3), False), (some(far, 2), False), (some(steps, 2, 3), True), (some(far, 3), False), (some(near, 4), False)]
    for group, is_whole in groups:
        with contextlib.suppress(Exception):  # what the port to NumPy cannot run
            yield from ((change, is_whole) for change in group)


def find(trace, clock):
    """Changes that make theirs up to the first difference, each with how many rows of theirs it makes."""
    found, until = [], LAST
    for change, whole in candidates(trace):
        if clock.left() < until or len(found) >= MOST_FOUND:
            break
        reached = False
        with contextlib.suppress(Exception), change.apply():
            reached = clock.call(0.5 + 4 * trace.seconds, trace.reaches_first if whole else trace.stages_again)
        if reached:
            found.append((change, *all_rows(change, trace, clock)))
            if found[-1][1] == len(trace.theirs) and until == LAST:  # one that makes all rows; few others are looked for
                until = max(LAST, clock.left() - MORE)
    return found


def all_rows(change, trace, clock):
    """(how many rows from the start on a change makes that makes the first difference, whether there was time for all)."""
    rows, trace.agreed = None, 0
    with contextlib.suppress(Exception), change.apply():
        rows = clock.call(LAST, trace.agreeing)
    return max(trace.first + 1, trace.agreed), rows is not None


def _stages(theirs, trace):
    """What is to be said where theirs has another stage, or no row."""
    right, step = trace.right[trace.first], trace.right[trace.first]["step"]
    its = [row["stage"] for row in theirs if row["step"] == step]
    ours = [row["stage"] for row in trace.rows(shallow(trace.begun[int(step)]))][: 8] if int(step) in trace.begun else [right["stage"]]
    ours = ours[: ours.index("end") + 1] if "end" in ours else ours
    return f"step {step} has the stages {', '.join(ours)}; theirs has {', '.join(its) or 'none'}"


def told(found, trace):
    whole = [change for change, rows, _ in found if rows == len(trace.theirs)]
    if whole:
        texts = list(dict.fromkeys(change.text for change in whole))[:MOST_NAMES]
        return "; or: ".join(texts) + (" (the same numbers here)" if len(texts) > 1 else "")
    if not found:
        return UNKNOWN
    best = max(rows for _, rows, _ in found)
    likely = [(change.text, looked) for change, rows, looked in found if rows == best]
    texts, last = list(dict.fromkeys(text for text, _ in likely))[:MOST_NAMES], trace.theirs[best - 1]
    then = "but not the next one" if all(looked for _, looked in likely) else "later ones were not looked at"
    return f"looks like {'; or: '.join(texts)}; that makes their hashes up to step {last['step']}, stage {last['stage']}, {then}"


def read_and_name(start, theirs, seconds=50):
    clock = search.Clock(seconds)
    rows = read_rows(theirs)
    if not rows:
        return "theirs has no rows"
    trace = Trace(pack.read(start), rows, catalogue.plant(catalogue.RIGHT))
    first = trace.find_first()
    if first is None and len(rows) > len(trace.right):
        return f"theirs has rows after the last step, {trace.right[-1]['step']}"
    if first is None:
        return "all states and contacts are right; what differs is computed from them"
    if first >= len(trace.theirs) or trace.theirs[first]["stage"] != trace.right[first]["stage"] or trace.theirs[first]["step"] != trace.right[first]["step"]:
        return _stages(trace.theirs, trace)
    trace.find_stages()
    begun = time.process_time()
    trace.reaches_first()
    trace.seconds = time.process_time() - begun
    return told(find(trace, clock), trace)
