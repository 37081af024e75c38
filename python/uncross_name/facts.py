"""Facts about the rows, or the single values, of a table: which units they are true of, and how many bits each costs."""
import math
from dataclasses import dataclass

import numpy as np
from uncross_port import flow, lattice, pack, random, sweep

LARGE = 1e6  # integers that have no values of their own
MOST_VALUES = 64  # of a number of which each value is a fact
NUMBER, COUNT = "sign range", "equal range"  # sorts of facts
TRIES = 64  # points tried for an axis

MEMBERS = ("in.solvent_cell", "in.vertex_cell")  # tables of cells

# (operator, table): what a row of it is.
ROWS = {(operator["name"], table["name"]): table["row"] for operator in pack.SCHEMA["operators"] for table in operator["tables"]}


@dataclass
class Fact:
    text: str
    cost: float
    holds: np.ndarray  # [units] of bool


class Step:
    """The rows of the table at one step, with what the pack has of them."""

    def __init__(self, evidence, part):
        self.evidence, self.step, self.last = evidence, part.step, part.ours_rows - 1
        self.tables, self.model = part.tables, part.model
        self.row = np.arange(part.rows)
        self.ours = evidence.ours[part.first : part.first + part.rows]
        self.box = part.model.get("in.box", np.zeros((1, 3), np.int64))[0]
        walls = "in.boundary" in part.model and part.model["in.boundary"][0, 0] == flow.WALLS
        self.grid = self.box + [0, walls, 0]  # cells, of which there are more between walls
        self.input = "in." + evidence.table.removeprefix("out.")  # the table of what the output was before
        self.cells = self.input + "_cell"  # and the cells of its members

    def at(self, table, column=0, rows=None):
        """Numbers of a column at these rows, or at the own ones; NaN where there are none."""
        rows = np.asarray(self.row if rows is None else rows, float)
        value = np.full(len(rows), np.nan)
        if table is not None and column < table.shape[1]:
            there = (rows >= 0) & (rows < len(table))
            value[there] = table[rows[there].astype(int), column]
        return value

    def column(self, name, column=0, rows=None):
        return self.at(self.tables.get(name), column, rows)

    def vectors(self, name, columns=3):
        return np.stack([self.column(name, k) for k in range(columns)], axis=1)

    def chain(self, column):
        """Of the vertex of each row: the next one, the one before, or the number of its fiber. NaN: rows are no vertices."""
        table = self.model.get("in.chain", np.zeros((0, 3)))
        vertices = ROWS.get((self.evidence.operator, self.evidence.table)) == "vertex" and self.evidence.table != "out.order"
        return self.at(table, column) if vertices and len(table) == self.last + 1 else np.full(len(self.row), np.nan)

    def cell(self):
        """The cell of each row: its number, or that of its member, or what comes out. NaN: it has none."""
        if self.cells in self.tables:
            return self.column(self.cells)
        if self.evidence.columns[0] == "cell":
            return self.ours[:, 0]
        are_cells = self.last + 1 == self.grid.prod() and ("in.load" in self.tables or "in.solvent_cell" in self.tables)
        return self.row.astype(float) if are_cells else np.full(len(self.row), np.nan)

    def coordinate(self, axis):
        """Of the cell, along an axis."""
        return self.cell() // self.grid[:axis].prod() % self.grid[axis]

    def at_edge(self, side, axis):
        """1 if the cell is the first (side 0) or last (1) one along an axis, 0 if not, NaN if there is none."""
        coordinate = self.coordinate(axis)
        return np.where(np.isnan(coordinate), np.nan, coordinate == side * (self.grid[axis] - 1))

    def members(self, *names):
        """How many the cell has of both or one of the tables of cells; NaN: not known."""
        tables = [np.sort(self.tables[name][:, 0]) for name in names if name in self.tables]
        cell = self.cell()
        if not tables:
            return np.full(len(cell), np.nan)
        return np.where(np.isnan(cell), np.nan, sum(t.searchsorted(cell, "right") - t.searchsorted(cell) for t in tables))

    def rank(self):
        """Members of the same table before this one in its cell."""
        cell, rank = self.cell(), np.full(len(self.row), np.nan)
        if self.cells in self.tables:
            order = np.argsort(cell, kind="stable")
            rank[order] = self.row - np.searchsorted(cell[order], cell[order])
        return rank

    def load(self):
        """Members of the cell: of the table of loads if there is one, else counted."""
        return self.column("in.load", 0, self.cell()) if "in.load" in self.tables else self.members(*MEMBERS)

    def shifted(self):
        """Positions plus shift, lattice units."""
        return self.tables[self.input][: len(self.row)] + self.tables["in.shift"]

    def event(self, name):
        return self.column("out.event", self.evidence.names("out.event").index(name))

    def beyond(self, name):
        """Which components of positions are beyond the upper edge."""
        return self.vectors(name) >= self.box * float(lattice.CELL)


class Facts:
    """Facts in the order in which they came; of two that are true of the same units, the cheaper is kept."""

    def __init__(self, units):
        self.units, self.evidence, self.known = units, units.evidence, {}
        self.steps = [Step(self.evidence, part) for part in self.evidence.parts]

    def add(self, cost, holds, yes, no=None):
        """A fact and its negation."""
        key = holds.tobytes()
        if key not in self.known or cost < self.known[key].cost:
            self.known[key] = Fact(yes, cost, holds)
        if no:
            self.add(cost + 0.5, ~holds, no)

    def value(self, of):
        """A number for each unit from of(step), which gives one for each row or for each value; NaN: not known."""
        return self.units.spread(np.concatenate([np.asarray(of(step), float) for step in self.steps]))

    def flag(self, yes, no, of):
        self.add(3.0, self.value(of) == 1.0, yes, no)

    def number(self, sorts, name, of):
        value = self.value(of)
        for sort in sorts.split():
            getattr(self, sort)(value, name)

    def sign(self, value, name):
        for cost, holds, what in ((5.0, value < 0, "negative"), (5.0, value > 0, "positive"), (4.5, value == 0, "0")):
            self.add(cost, holds, f"{name} is {what}", f"{name} is not {what}")

    def equal(self, value, name):
        """Each of a few values, in the order in which they come."""
        seen = list(dict.fromkeys(value[~np.isnan(value)].tolist()))
        for x in seen if len(seen) <= MOST_VALUES else ():
            self.add(4.0 + math.log2(len(seen)), value == x, f"{name} is {x:.10g}", f"{name} is not {x:.10g}")

    def range(self, value, name):
        """From the least that is wrong on, and up to the most: the only two ranges that can help."""
        cost, wrong = 5.0 + math.log2(len(value)), value[self.units.wrong]
        least, most = np.fmin.reduce(wrong, initial=np.inf), np.fmax.reduce(wrong, initial=-np.inf)
        self.add(cost, value >= least, f"{name} is {least:.10g} or more")
        self.add(cost, value <= most, f"{name} is {most:.10g} or less")

    def parity(self, value, name):
        self.add(4.0, np.fmod(np.abs(value), 2.0) == 1.0, f"{name} is odd", f"{name} is even")


def collect(units):
    """All that is known to tell units apart."""
    f = Facts(units)
    with np.errstate(invalid="ignore", divide="ignore"):
        for of in (of_places, of_vertices, of_cells, of_faces, of_walls, of_events, of_axes, of_tests, of_tables):
            of(f)
    return list(f.known.values())


# --- places


def of_places(f):
    e = f.evidence
    f.flag("it is the last row", "it is not the last row", lambda at: at.row == at.last)
    f.flag("it is row 0", "it is not row 0", lambda at: at.row == 0)
    f.number("parity range", "the row's number", lambda at: at.row)
    f.number("equal", "the row's number modulo 4", lambda at: at.row % 4)
    f.number("equal", "the row's number modulo 3", lambda at: at.row % 3)
    if len(e.parts) > 1:
        f.number("equal", "the step", lambda at: np.full(len(at.row), at.step))
    if f.units.values or len(e.columns) == 1:
        shape = (-1, len(e.columns)) if f.units.values else -1
        f.number(NUMBER, "the right value", lambda at: at.ours.reshape(shape))
        if not e.real:
            yes, no = "the right value is 2^31 or more", "the right value is below 2^31"
            f.flag(yes, no, lambda at: at.ours.reshape(shape) >= 2.0**31)


# --- vertices


def along_fiber(at, way):
    """Vertices of its fiber before each (way 1) or after it (-1)."""
    fiber, count = at.chain(2)[::way], np.zeros(len(at.row))
    for k in range(1, len(fiber)):
        count[k] = count[k - 1] + 1 if fiber[k] == fiber[k - 1] else 0
    return count[::way]


def is_of_ring(at):
    is_open = (at.chain(0) < 0) | (at.chain(1) < 0)
    return ~np.isin(at.chain(2), at.chain(2)[is_open])


VERTICES = (
    ("the vertex has a next one", "the vertex is the last of its fiber", lambda at: at.chain(0) >= 0),
    ("the vertex has one before", "the vertex is the first of its fiber", lambda at: at.chain(1) >= 0),
    ("the vertex is an end of its fiber", "the vertex is no end of a fiber", lambda at: (at.chain(0) < 0) | (at.chain(1) < 0)),
    ("the vertex's bond closes a ring", "the vertex's bond closes no ring", lambda at: (at.chain(0) >= 0) & (at.chain(0) < at.row)),
    ("the vertex begins a ring", "the vertex begins no ring", lambda at: at.chain(1) > at.row),
    (
        "the vertex is an end of the bond that closes a ring",
        "the vertex is no end of a bond that closes a ring",
        lambda at: (at.chain(0) >= 0) & (at.chain(0) < at.row) | (at.chain(1) > at.row),
    ),
    ("the vertex is of a ring", "the vertex is of no ring", is_of_ring),
)


def of_vertices(f):
    first = f.steps[0]
    if not len(first.row) or np.isnan(first.chain(2)[0]):
        return
    for fact in VERTICES:
        f.flag(*fact)
    f.number("equal range parity", "the number of its fiber", lambda at: at.chain(2))
    f.number(COUNT, "vertices of its fiber before it", lambda at: along_fiber(at, 1))
    f.number(COUNT, "vertices of its fiber after it", lambda at: along_fiber(at, -1))
    constants = first.model.get("in.vertex")
    yes, no = "the next number's mass is another", "the next number's mass is the same"
    f.flag(yes, no, lambda at: (at.at(constants, 0) != at.at(constants, 0, at.row + 1)) & (at.row < at.last))
    for column, name in enumerate(pack.columns("model", "in.vertex").split() if constants is not None else ()):
        f.number("sign equal range", name, lambda at, column=column: at.at(constants, column))


# --- cells


def of_cells(f):
    first = f.steps[0]
    if not len(first.row) or np.isnan(first.cell()[0]):
        return
    for axis, name in enumerate("xyz"):
        f.flag(f"{name} is in the last cell", f"{name} is not in the last cell", lambda at, axis=axis: at.at_edge(1, axis))
    for side, edge in ((1, "upper edge"), (0, "lower edge")):
        f.flag(
            f"its cell is at {'an' if side else 'a'} {edge}", f"its cell is at no {edge}",
            lambda at, side=side: np.fmax.reduce([at.at_edge(side, axis) for axis in range(3)]),
        )
    for axis, name in enumerate("xyz"):
        f.number(COUNT, f"{name} of its cell", lambda at, axis=axis: at.coordinate(axis))
    f.number("equal", "the number of its cell", Step.cell)
    if any(name in first.tables for name in MEMBERS):
        f.flag("its cell is active", "its cell is not active", lambda at: at.load() >= 2)
        f.number(COUNT, "members of its cell", lambda at: at.members(*MEMBERS))
        f.number(COUNT, "solvent in its cell", lambda at: at.members(MEMBERS[0]))
        f.number(COUNT, "vertices in its cell", lambda at: at.members(MEMBERS[1]))
        f.number(COUNT, "its rank in its cell", Step.rank)
    if first.cells in first.tables:
        for name, table in sorted(first.tables.items()):
            if name.startswith("in.") and len(table) == first.grid.prod():
                for column in range(table.shape[1]):
                    of_column(f, name, column, " of its cell", lambda at: at.column(at.cells))


def of_faces(f):
    if f.evidence.operator != "bin" or "in.shift" not in f.steps[0].tables:
        return
    yes, no = "it lies on a face of a cell", "it lies on no face of a cell"
    f.flag(yes, no, lambda at: (at.shifted() % lattice.CELL == 0).any(axis=1))
    yes, no = "it is more than one edge away", "it is one edge away at most"
    f.flag(yes, no, lambda at: (abs(at.shifted() // (at.box * lattice.CELL)) > 1).any(axis=1))


def of_walls(f):
    if f.evidence.operator != "wall_stream" or f.evidence.table == "out.given":
        return

    def hits(at):
        y, speed = at.tables["in.position"][: len(at.row), 1], at.tables["in.velocity"][: len(at.row), 1]
        y = y + lattice.to_lattice(speed * at.tables["in.time"][0, 0])
        return (y < 0) | (y > at.box[1] * lattice.CELL)

    f.flag("the particle hits a wall", "the particle hits no wall", hits)


# --- contacts and axes


def of_events(f):
    first, names = f.steps[0], f.evidence.names("out.event")
    images = [name for name in names if name.startswith("image")]
    if not images or len(first.tables.get("out.event", ())) != first.last + 1:
        return
    yes, no = "the partner is an image", "the partner is no image"
    f.flag(yes, no, lambda at: np.any([at.event(name) != 0 for name in images], axis=0))
    if "moving" in names:
        yes, no = "the moving bond is that to the next vertex", "the moving bond is that to the vertex before"
        f.flag(yes, no, lambda at: at.event("vertex") == at.event("moving"))


def tries_of_axis(at):
    """Points of the square that are tried before one is in the disk."""
    address = at.tables.get("in.address")
    purpose, _, step, entity = address.T if address is not None else (random.AXIS, 0, at.step, at.row)
    numbers = at.model["in.numbers"][0]
    seed, tries = int(numbers[0]) | int(numbers[1]) << 32, np.full(len(at.row), np.nan)
    for k in reversed(range(TRIES)):
        word = random.words(seed, purpose, k // 2, step, entity)[: len(at.row), k % 2 * 2 :][:, :2]
        point = (word.astype(np.uint32).view(np.int32).reshape(-1, 2) + 0.5) * 2.0**-31
        tries[(point * point).sum(axis=1) < 1] = k
    return tries


def of_axes(f):
    if f.evidence.table == "out.axis":
        f.number(COUNT, "points tried before the one in the disk", tries_of_axis)


POINTS = ("in.from", "in.to", "in.pivot", "in.a", "in.b")  # of a single test for a crossing


def has_zero(at):
    """A determinant of the test is exactly zero: in Python's integers."""
    start, end, pivot, a, b = (at.tables[name][: len(at.row)].astype(object).T for name in POINTS)
    fours = ((a, b, pivot, start), (a, b, pivot, end), (a, b, start, end), (start, end, pivot, a), (start, end, pivot, b))
    return np.any([sweep.volume(q - p, r - p, s - p) == 0 for p, q, r, s in fours], axis=0)


def size(at):
    """The largest side of the polygon of the test's points, a0."""
    sides = [at.tables[p][: len(at.row)] - at.tables[q][: len(at.row)] for p, q in zip(POINTS, POINTS[1:] + POINTS[:1])]
    return np.max([np.sqrt(lattice.dot(side * lattice.UNIT, side * lattice.UNIT)) for side in sides], axis=0)


def of_tests(f):
    if f.evidence.operator == "crossing" and all(name in f.steps[0].tables for name in POINTS):
        f.flag("a determinant is exactly zero", "no determinant is zero", has_zero)
        f.number("range", "the largest difference of the points", size)


# --- columns of tables with the same rows


def is_position(f, name, table):
    places = "position" in name or (f.evidence.operator == "bin" and name != "in.shift")
    return table.dtype.kind != "f" and table.shape[1] == 3 and places


def of_column(f, name, column, of="", rows=lambda at: at.row):
    """Facts of a column at these rows."""
    table = f.steps[0].tables[name]
    real, most = table.dtype.kind == "f", np.abs(table[:, column].astype(float)).max(initial=0)
    component = f.evidence.names(name)[column]
    few = "equal" if most <= 1 else "sign equal parity range"  # those of 0 and 1 are no numbers
    f.number(NUMBER if real or most >= LARGE else few, f"{name}.{component}{of}", lambda at: at.column(name, column, rows(at)))
    if is_position(f, name, table):
        f.number(COUNT, f"cell of {name}.{component}", lambda at: np.floor(at.column(name, column) * lattice.UNIT))
    elif real and table.shape[1] == 1:
        f.flag(f"{name}{of} is whole", f"{name}{of} is not whole", lambda at: at.column(name, column, rows(at)) % 1 == 0)


def of_own_columns(f, name, table):
    """Facts of the values of another table in the same row and column."""
    own, columns = f"{name} along the same axis", table.shape[1]
    f.number(NUMBER, own, lambda at: at.vectors(name, columns))
    if is_position(f, name, table):
        f.number(COUNT, f"cell of {own}", lambda at: np.floor(at.vectors(name) * lattice.UNIT))
    elif table.dtype.kind == "f":
        f.number("range", f"the size of {own}", lambda at: abs(at.vectors(name, columns)))


def of_vectors(f, name, table):
    """Any component negative; for positions, outside of the box on either side; the length."""
    outside = {"negative component": lambda at: at.vectors(name) < 0}
    if is_position(f, name, table) and f.steps[0].box.all():
        outside["component beyond the upper edge"] = lambda at: at.beyond(name)
        outside["component outside of the box"] = lambda at: (at.vectors(name) < 0) | at.beyond(name)
    for words, of in outside.items():
        f.flag(f"{name} has a {words}", f"{name} has no {words}", lambda at, of=of: of(at).any(axis=1))
    if table.dtype.kind == "f":
        f.number("range", f"the length of {name}", lambda at: np.sqrt((at.vectors(name) ** 2).sum(axis=1)))


def of_tables(f):
    first, own = f.steps[0], f.evidence.table
    for name, table in sorted(first.tables.items()):
        if len(table) != first.last + 1 or name.startswith("bound."):
            continue
        for column in range(table.shape[1]):
            if name != own or not f.units.values:
                of_column(f, name, column)
        if f.units.values and table.shape[1] == len(f.evidence.columns) and name != own:
            of_own_columns(f, name, table)
        if table.shape[1] == 3:
            of_vectors(f, name, table)
