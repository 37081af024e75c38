"""Tables of observables as figures: points with the errors that a table has, lines where it has none."""
import csv
import math

import numpy

from uncross_sweep import averages
from uncross_sweep.opening import read_table

from . import columns, style

EXACT = {"l": ("mean bond length", 1), "cos": ("mean cosine of a bend", 1),  # statics: rows of `uncross check`, and powers
         "lp": ("effective persistence length", 1), "Ree2": ("end-to-end distance, rms", 2)}


class Table:
    """name; data: {column: array}; x: the name of the column that others are drawn over."""

    def __init__(self, name, data):
        self.name, self.data = name, data
        self.x = "time" if "time" in data else next(iter(data)) if self.rows > 1 else None
        self.values = [c for c in data if c not in (self.x, "step") and not self.is_error(c)]

    def is_error(self, name):
        return any(name.endswith(end) and name[:-len(end)] in self.data for end in ("_error", "_block_error"))

    def errors(self, name):
        """Of two errors of an average over seeds that of blocks, where there is one: with few seeds it is the better known."""
        scatter, blocks = self.data.get(name + "_error"), self.data.get(name + "_block_error")
        return scatter if blocks is None else numpy.where(numpy.isfinite(blocks), blocks, scatter)

    def column(self, name):
        """nan in each row if there is none."""
        return self.data.get(name, numpy.full(self.rows, math.nan))

    def bars(self, name):
        """Errors of a column; nan in each row if it has none."""
        errors = self.errors(name)
        return numpy.full(self.rows, math.nan) if errors is None else errors

    @property
    def places(self):
        """The x of each row; 0 for the one row of a table without x."""
        return self.data[self.x] if self.x else numpy.zeros(self.rows)

    @property
    def rows(self):
        return len(next(iter(self.data.values())))

    @property
    def empty(self):
        """Columns without a number: nan in every row."""
        return [c for c in self.values if not numpy.isfinite(self.data[c]).any()]

    @property
    def has_errors(self):
        return any(self.is_error(c) for c in self.data)


def read(path, name, growing=False):
    """A table; ValueError, with file, line and column, if it is none. Of one that is growing the last line may be a part."""
    try:
        text = read_table(path)
        lines = list(csv.reader((text[:text.rfind("\n") + 1] if growing else text).splitlines()))
    except (csv.Error, ValueError) as error:
        raise ValueError(f"{path}: not a table: {error}") from error
    if not lines or not lines[0] or len(set(lines[0])) != len(lines[0]) or not all(lines[0]):
        raise ValueError(f"{path}:1:1: not a table: a first line of column names is needed")
    rows = []
    for number, line in enumerate(lines[1:], 2):
        if len(line) != len(lines[0]):
            raise ValueError(f"{path}:{number}:1: {len(line)} values for {len(lines[0])} columns")
        try:
            rows.append([float(word) for word in line])
        except ValueError:
            bad = next(k for k, word in enumerate(line) if not _is_number(word))
            raise ValueError(f"{path}:{number}:{1 + sum(len(w) + 1 for w in line[:bad])}: '{line[bad][:40]}' is not a "
                             "number") from None
    return Table(name, dict(zip(lines[0], numpy.array(rows, float).reshape(-1, len(lines[0])).T)))


def _is_number(word):
    try:
        float(word)
    except ValueError:
        return False
    return True


def blocked_error(series):
    """Standard error of the mean of a correlated series, from blocks of values."""
    return averages.blocked_mean(series)[1] if len(series) else math.nan


# --- one table ---------------------------------------------------------------------------------------------------------

def _scales(axes, panel, x, ys):
    """Logarithmic where the panel asks for it and the numbers allow it."""
    def fits(values):
        values = values[numpy.isfinite(values)]
        return len(values) > 1 and values.max() > 1.5 * abs(values.min()) and (values > 0).sum() > 1
    if panel.log_x and fits(x):
        axes.set_xscale("log")
    if panel.log_y and fits(numpy.concatenate(ys)):
        axes.set_yscale("log", nonpositive="mask")


def _draw(axes, table, panel, guides=()):
    x, drawn = table.data[table.x], []
    positive = panel.log_y and any((table.data[c] > 0).any() for c in panel.columns)  # else all is 0, and is drawn as that
    for number, names in enumerate(_alike(table, panel.columns)):
        y, errors = table.data[names[0]], table.errors(names[0])
        y = y - y[0] if panel.change else y
        if positive:
            y = numpy.where(y > 0, y, numpy.nan)
        label = ("\n= " if len(names) < 4 else " = ").join(columns.column(c).short if len(names) < 4 else columns.column(c).symbol or c for c in names)
        if errors is not None or table.rows < 4:
            style.points(axes, x, y, errors, number, label=label)
        else:
            style.line(axes, x, y, number, label=label)
        drawn.append(y)
    _scales(axes, panel, x, drawn)
    _guide(axes, panel, guides, x)
    axes.set(title=panel.title, xlabel=columns.LAG_LABEL if panel.log_x else columns.column(table.x).label,
             ylabel=panel.y or columns.column(panel.columns[0]).label)
    if len(panel.columns) > 1 or len(axes.get_legend_handles_labels()[0]) > 1:
        style.legend(axes, fontsize=7.5, loc="upper left", bbox_to_anchor=(-0.02, -0.26), borderaxespad=0.0)


def _alike(table, names):
    """Groups of columns with the same numbers: a line drawn over its like would hide it."""
    groups = []
    for name in names:
        for group in groups:
            if numpy.array_equal(table.data[group[0]], table.data[name], equal_nan=True):
                group.append(name)
                break
        else:
            groups.append([name])
    return groups


def _guide(axes, panel, guides, x):
    low, high = axes.get_ylim()
    if panel.level is not None:
        axes.axhline(panel.level, color=style.INK, linewidth=0.8, linestyle=(0, (6, 3)), zorder=1)
    for label, function, stroke in guides if panel.columns[0] in ("g", "vx") else ():
        places = numpy.geomspace(x.min(), x.max(), 60) if panel.log_x and x.min() > 0 else numpy.linspace(x.min(), x.max(), 120)
        y = numpy.array([function(t) for t in places])
        seen = (y > low / 3) & (y < 3 * high) if panel.log_y else numpy.isfinite(y)
        if seen.any():
            style.theory(axes, places[seen], y[seen], label=label, linestyle=stroke)


NARROW, WIDE = 3.4, 4.4  # inches: letters of 9 points can be read where a panel is as wide as a telephone


def figure(table, guides=()):
    """[(SVG, whether it is wide)] of the panels of a table of several rows, each a picture of its own: pages put them beside
    each other, or below each other where there is no room."""
    shown = columns.panels(table.name, [c for c in table.values if c not in table.empty])
    if not shown:
        return [(nothing("No numbers: nan in every row"), True)]
    narrow = [panel for panel in shown if not panel.wide]
    alone = narrow[:len(narrow) % 2]
    drawn = []
    with style.styled():
        for panel in [p for p in shown if p.wide] + narrow:
            wide = panel.wide or panel in alone
            drawing, axes = style.plain(WIDE if wide else NARROW, 3.0 if wide else 2.7)
            _draw(axes, table, panel, guides)
            drawn.append((style.svg(drawing), wide))
    return drawn


def nothing(text):
    """SVG that says why there is no figure."""
    with style.styled():
        drawing, axes = style.plain(WIDE, 0.7)
        axes.set_axis_off()
        axes.text(0.5, 0.5, text, ha="center", va="center", color=style.PALE)
        return style.svg(drawing)


def exact_values(table, derived):
    """{column: the value that theory gives} of statics of open fibers, from the rows of `uncross check` for this kind."""
    if columns.split(table.name)[0] != "statics" or table.rows != 1:
        return {}
    return {c: derived[row]**power for c, (row, power) in EXACT.items() if row in derived}


def single_row(table, exact):
    """SVG of a table of one row: each value relative to theory where there is one, else its relative error alone, without a
    point. None if nothing has an error, or all is 0, as for single beads."""
    names = [c for c in table.values if table.errors(c) is not None and numpy.isfinite(table.data[c][0]) and table.data[c][0] != 0]
    if not names:
        return None
    with style.styled():
        drawing, axes = style.plain(WIDE, 0.6 + 0.34 * max(3, len(names)))
        axes.axvline(0.0, color=style.INK, linewidth=0.8)
        for place, name in enumerate(reversed(names)):
            value, error = table.data[name][0], table.errors(name)[0]
            base = exact.get(name, value)
            known = name in exact
            axes.errorbar([100 * (value / base - 1.0) if known else 0.0], [place],
                          xerr=None if math.isnan(error) else [abs(100 * error / base)], linestyle="none",
                          marker=style.MARKERS[0] if known else "none", color=style.COLORS[0 if known else 1])
            if not known:  # a point on the line would look like agreement
                axes.text(1.0, place, "no theory", transform=axes.get_yaxis_transform(), ha="right", va="center",
                          color=style.PALE)
        axes.set_yticks(range(len(names)), [columns.column(c).short for c in reversed(names)])
        axes.set(ylim=(-0.6, max(1, len(names)) - 0.4),
                 xlabel="difference from theory / %; without a point: error alone" if exact else "error / %: no theory")
        axes.margins(x=0.2)
        return style.svg(drawing)


# --- two tables --------------------------------------------------------------------------------------------------------

def common(a, b):
    """Rows of a and of b that stand at the same x."""
    x, y = a.places, b.places
    if not len(x) or not len(y):
        return numpy.zeros(0, int), numpy.zeros(0, int)
    near = numpy.searchsorted(y, x)
    before, near = (numpy.clip(near + shift, 0, len(y) - 1) for shift in (-1, 0))
    near = numpy.where(numpy.abs(y[before] - x) < numpy.abs(y[near] - x), before, near)
    same = numpy.abs(y[near] - x) <= 1e-9 * numpy.maximum(1.0, numpy.abs(x))
    return numpy.flatnonzero(same), near[same]


def difference(a, b, name):
    """(x, b - a, its error) at the x that both have; the errors are taken to be independent, and nan where there are none."""
    i, j = common(a, b)
    ours, theirs = a.errors(name), b.errors(name)
    error = numpy.full(len(i), math.nan) if ours is None or theirs is None else numpy.hypot(ours[i], theirs[j])
    return a.places[i], b.data[name][j] - a.data[name][i], error


def in_errors(gap, error):
    """Differences over their errors; nan where there is none."""
    with numpy.errstate(divide="ignore", invalid="ignore"):
        return gap / error


def summary(a, b, name):
    """(of a, its error, of b, its error, z, x or None, rows or None) of a column: means over the rows of a time series,
    with errors from blocks; the last values of what runs on, without errors; of a table with errors, the row where z is
    largest in size."""
    if a.has_errors:
        x, gap, error = difference(a, b, name)
        z = in_errors(gap, error)
        if not numpy.isfinite(z).any():
            return None
        row = int(numpy.nanargmax(numpy.where(numpy.isfinite(z), numpy.abs(z), -1.0)))
        i, j = common(a, b)
        return (a.data[name][i[row]], a.errors(name)[i[row]], b.data[name][j[row]], b.errors(name)[j[row]], z[row],
                x[row] if a.rows > 1 else None, len(i))
    ours, theirs = (t.data[name][numpy.isfinite(t.data[name])] for t in (a, b))
    if not len(ours) or not len(theirs):
        return None
    if name in columns.RUNNING:
        return ours[-1], math.nan, theirs[-1], math.nan, math.nan, None, None
    errors = blocked_error(ours), blocked_error(theirs)
    gap, error = theirs.mean() - ours.mean(), math.hypot(*errors)
    return ours.mean(), errors[0], theirs.mean(), errors[1], gap / error if error > 0 else math.nan, None, None


def compare(a, b, names):
    """SVGs that hold two tables of several rows: for each column both, and below the difference over its error. The first of
    them names the runs."""
    shown = [(panel, c) for panel in columns.panels(a.name, [v for v in a.values if v in b.values])
             for c in panel.columns if numpy.isfinite(a.data[c]).any() or numpy.isfinite(b.data[c]).any()]
    pictures = []
    with style.styled():
        for number, (panel, name) in enumerate(shown):
            drawing, grid = style.pyplot.subplots(2, 1, figsize=(NARROW, 3.7), sharex="col", gridspec_kw={"height_ratios": [1.0, 0.4]})
            _draw_pair(*grid, a, b, panel, name, None if number else names)
            pictures.append(style.svg(drawing))
    return pictures


def _draw_pair(axes, below, a, b, panel, name, names):
    for number, table in enumerate((a, b)):
        y, errors = table.data[name], table.errors(name)
        draw = style.points if errors is not None or table.rows < 4 else style.line
        bars = {"errors": errors} if draw is style.points else {}
        draw(axes, table.data[table.x], y - y[0] if panel.change else y, number=number,
             label=names[number] if names else None, **bars)
    _scales(axes, panel, a.data[a.x], [t.data[name] for t in (a, b)])
    x, gap, error = difference(a, b, name)
    known = numpy.isfinite(error) & (error > 0)
    z = in_errors(gap, error)
    below.axhline(0.0, color=style.INK, linewidth=0.8)
    if known.any():
        for two in (-2.0, 2.0):
            below.axhline(two, color=style.PALE, linewidth=0.8, linestyle=(0, (4, 3)))
        style.points(below, x[known], z[known], None, 3)
        below.set_ylabel("difference\n/ its error")
    else:
        style.line(below, x, gap, 3)
        below.set_ylabel("difference")
    label = columns.column(name)
    axes.set(title=f"{label.name}\n{label.symbol}" if label.symbol else label.name,
             ylabel=("change" if panel.change else label.symbol or "value") + (f" / {label.unit}" if label.unit else ""))
    below.set_xlabel(columns.LAG_LABEL if panel.log_x else columns.column(a.x).label)
    if names:
        style.legend(axes, fontsize=7)


def compare_rows(a, b, names):
    """SVG of two tables of one row: the difference of each value over its error. None if no error is known."""
    told = [(c, summary(a, b, c)) for c in a.values if c in b.values and a.has_errors]
    told = [(c, t[4]) for c, t in told if t is not None and math.isfinite(t[4])]
    if not told:
        return None
    with style.styled():
        drawing, axes = style.plain(WIDE, 0.6 + 0.34 * max(3, len(told)))
        for z in (-2.0, 0.0, 2.0):
            axes.axvline(z, color=style.PALE if z else style.INK, linewidth=0.8, linestyle=(0, (4, 3)) if z else "-")
        style.points(axes, [z for _, z in reversed(told)], range(len(told)), None, 3)
        axes.set_yticks(range(len(told)), [columns.column(c).short for c, _ in reversed(told)])
        axes.set(ylim=(-0.6, len(told) - 0.4), xlabel=f"{names[1]} minus {names[0]}, over its error")
        return style.svg(drawing)
