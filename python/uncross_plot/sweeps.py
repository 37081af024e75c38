"""The page of a sweep (docs/running.md): final numbers over the values of the grid, with the errors of summary.csv."""
import csv
import math
import os

import numpy

from uncross_sweep import averages
from uncross_sweep.opening import read_table

from . import columns, distrust, page, runs, style

RESULTS = "seeds"  # columns before it are the grid's, those after it final numbers
MOST_SERIES = 8
NAMES = {"temperature_solvent": columns.Column("temperature of the solvent", "", "$(kT/k_B)$"),
         "temperature_vertex": columns.Column("temperature of the vertices", "", "$(kT/k_B)$"),
         "collision_rate": columns.COLUMNS["rate_per_vertex"], "collision_rate_over_theory": columns.COLUMNS["rate_over_theory"]}


def is_sweep(path):
    """True for the folder of a sweep, and for its two tables."""
    folder = path if os.path.isdir(path) else os.path.dirname(path) or "."
    named = os.path.isdir(path) or os.path.basename(path) in ("runs.csv", "summary.csv")
    return named and all(os.path.exists(os.path.join(folder, name)) for name in ("runs.csv", "summary.csv"))


def _read(path, *needed):
    """(names, [{column: text}]) of a table; ValueError if it has no line of names, or not the columns that are needed."""
    try:
        rows = list(csv.reader(read_table(path).splitlines()))
    except (csv.Error, ValueError) as error:
        raise ValueError(f"{path}: not a table of a sweep: {error}") from error
    if not rows or any(len(row) != len(rows[0]) for row in rows):
        raise ValueError(f"{path}: not a table of a sweep: rows of different lengths")
    missing = [name for name in needed if name not in rows[0]]
    if missing:
        raise ValueError(f"{path}: not a table of a sweep: no column {missing[0]}")
    return rows[0], [dict(zip(rows[0], row)) for row in rows[1:]]


def _number(text):
    try:
        return float(text)
    except ValueError:
        return math.nan


def _error(row, name):
    """Of the two errors that of blocks, unless there is none: with few seeds it is the better known (docs/running.md)."""
    found = [_number(row.get(f"{name}{part}", "nan")) for part in ("_block_error", "_error")]
    return next((e for e in found if math.isfinite(e)), math.nan)


def _parts(name):
    """The column that a final number is made of, and its kind: D_about_mean_rod is D_about_mean of 'rod'."""
    best = max((c for c in columns.COLUMNS if name == c or name.startswith(c + "_")), key=len, default=name)
    return best, name[len(best) + 1:]


def _label(name, short=False):
    """Of the page; short: of an axis, symbol and unit."""
    column, kind = _parts(name)
    found = NAMES.get(name) or columns.column(column)
    words = f"{found.symbol or found.name} / {found.unit}" if short and found.unit else found.symbol or found.name if short else found.name
    return words + (f", {kind}" if kind else "")


def _lag(row, kind):
    return _number(row.get(f"lag_{kind}", "nan"))


def _at_lag(rows, name):
    """Of the caption of a number that is taken at a lag."""
    column, kind = _parts(name)
    lags = sorted({_lag(row, kind) for row in rows if math.isfinite(_lag(row, kind))})
    if not lags or column not in averages.DYNAMICS:
        return ""
    return f" It is that at lag {lags[0]:.3g}{f' to {lags[-1]:.3g}' if lags[-1] > lags[0] else ''} t0."


def _places(rows, key):
    """Numbers of the values of a key, and their words if they are none."""
    words = list(dict.fromkeys(row[key] for row in rows))
    if all(math.isfinite(_number(word)) for word in words):
        return {word: _number(word) for word in words}, None
    return {word: float(k) for k, word in enumerate(words)}, words


def figure(rows, keys, name):
    """SVG of a final number over the first key of the grid; a series for each combination of the others."""
    places, words = _places(rows, keys[0])
    others = list(dict.fromkeys(tuple(row[key] for key in keys[1:]) for row in rows))
    with style.styled():
        drawing, axes = style.plain(4.4, 3.0)
        for number, other in enumerate(others[:MOST_SERIES]):
            mine = [row for row in rows if tuple(row[key] for key in keys[1:]) == other and math.isfinite(_number(row[name]))]
            x = [places[row[keys[0]]] for row in mine]
            errors = numpy.array([_error(row, name) for row in mine])
            style.points(axes, x, [_number(row[name]) for row in mine], None if numpy.isnan(errors).all() else errors, number,
                         label=", ".join(f"{key} = {value}" for key, value in zip(keys[1:], other)) or None)
        axes.set_xlabel(keys[0])
        axes.set_ylabel(_label(name, short=True))
        axes.ticklabel_format(axis="y", useOffset=False)
        if words:
            axes.set_xticks(range(len(words)), words)
        if keys[1:]:
            style.legend(axes)
        return style.svg(drawing)


def _points(folder, rows):
    """{name: Run} of the folders that are there."""
    found = {}
    for name in (row["folder"] for row in rows if "folder" in row):
        try:
            found[name] = runs.read(os.path.join(folder, name))
        except runs.BadInput:  # nothing is known of its runs, which `of_sweep` says
            continue
    return found


def page_of(path):
    """HTML of a sweep's page; ValueError if its tables are none."""
    folder = path if os.path.isdir(path) else os.path.dirname(path) or "."
    names, rows = _read(os.path.join(folder, "summary.csv"), "folder", RESULTS)
    _, made = _read(os.path.join(folder, "runs.csv"), "folder", "seed", "exit_code", "status", "message")
    keys = names[1:names.index(RESULTS)] or [names[0]]
    results = [name for name in names[names.index(RESULTS) + 1:]
               if not name.endswith("_error") and any(math.isfinite(_number(row[name])) for row in rows)]
    unfinished = [run for run in made if run.get("exit_code") != "0"]
    for run in made:
        run["record"] = runs.record_of(os.path.join(folder, run["folder"]))
    front = [("What was swept", ["Each combination of:", *(f"{key}: {', '.join(dict.fromkeys(r[key] for r in rows))}" for key in keys)]),
             ("How", f"{len(made)} runs of {len(rows)} points; seeds {', '.join(dict.fromkeys(run['seed'] for run in made))}."),
             ("What came out", f"{len(results)} final numbers of each point: summary.csv."),
             ("What is here", f"Averages over seeds in a folder for each point, such as {rows[0][names[0]]}; "
              "uncross plot shows them, and each run below it.") if rows else ("What is here", "No point is finished."),
             ("What to distrust", page._doubts([f"{run['folder']}: exit code {run['exit_code']}, {run['status']}. {run['message']}".strip()
                                                for run in unfinished] +
                                               distrust.of_sweep(_points(folder, rows), made)))]
    shown = [name for name in results if not name.startswith(("lag_", "change_"))]
    figures = [page.Figure(page.plain(_label(name)), style.data_uri(figure(rows, keys, name)),
                           f"{page.plain(_label(name))} over {keys[0]}.", f"{name} of summary.csv.{_at_lag(rows, name)} Error bars: one standard error, "
                           "of blocks of the runs where they have one, else of the scatter over seeds.", name) for name in shown]
    table = page.Rows("Final numbers", [[row[key] for key in keys] + [page.with_error(_number(row[name]), _error(row, name))
                                                                      for name in results] for row in rows],
                      (*keys, *results), "docs/running.md says how each is made.", tuple(range(len(keys) + len(results))))
    return page.render(os.path.basename(os.path.abspath(folder)), front,
                       [page.Section("Final numbers over the grid", figures), page.Section("In numbers", [table])])
