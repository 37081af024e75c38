"""Averages over seeds: a table for each table of a point's runs, and one row of final numbers for each point."""
import csv
import io
import math
import os
import stat

import numpy

from . import plateau
from .files import columns
from .opening import NoFile, read_table, write_text

LEAST_BLOCKS = 16  # of a series
KEYS = ("step", "time")  # columns that say which row it is
COUNTS = ("samples", "intervals")  # columns that are added up


class BadTable(ValueError):
    """A table of a run that is none; the message begins with the file."""


def table_of(path):
    """{column: numbers} of a table."""
    try:
        table = columns(read_table(path))
    except FileNotFoundError as error:
        raise BadTable(f"{path}: is missing; a finished run has it") from error
    except NoFile:
        raise
    except (ValueError, IndexError, csv.Error) as error:
        raise BadTable(f"{path}: not a table: {error}") from error
    bad = next((name for name, values in table.items() if values.dtype.kind != "f"), None)
    if bad is not None:
        raise BadTable(f"{path}: not a table: column {bad} holds what is no number")
    return table


def blocked_mean(series, least=LEAST_BLOCKS):
    """(mean, standard error) of a correlated series: Flyvbjerg and Petersen, J. Chem. Phys. 91, 461 (1989). Blocks of 1,
    2, 4, ... values; the largest error among levels of at least `least` blocks. nan if there are fewer values."""
    series = numpy.asarray(series, float)
    level, error = series, math.nan
    while len(level) >= least:
        error = numpy.fmax(error, level.std(ddof=1) / math.sqrt(len(level)))
        level = level[:len(level) // 2 * 2].reshape(-1, 2).mean(axis=1)
    return series.mean(), float(error)


def mean(values):
    """(mean, standard error) of independent values; the error of fewer than two is nan."""
    values = numpy.asarray(values, float)
    error = values.std(ddof=1) / math.sqrt(len(values)) if len(values) > 1 else math.nan
    return values.mean(), error


def over_seeds(values, errors):
    """(mean, error, block error) of one number of several runs. The error is that of the runs' scatter. The block error
    is what the runs' own errors give. One run has its own error for both."""
    value, error = mean(values)
    pooled = math.sqrt(math.fsum(e * e for e in errors)) / len(errors)
    return (values[0], errors[0], errors[0]) if len(values) == 1 else (value, error, pooled)


def rows_of(table):
    """Row numbers by step or by lag; a table without such a column has one row."""
    keys = [name for name in KEYS if name in table]
    if not keys:
        return {(): 0} if table and len(next(iter(table.values()))) else {}
    return {tuple(values): k for k, values in enumerate(zip(*(table[name].tolist() for name in keys)))}


def average(tables):
    """One table of several, of runs that differ by their seed. Columns are matched by name, rows by step or lag; a row has
    the number of runs that have it in the column `seeds`."""
    tables = [table for table in tables if table]
    names = [name for name in tables[0] if all(name in table for table in tables)] if tables else []
    keys = [name for name in names if name in KEYS]
    errors = {name for name in names if name.endswith("_error") and name[:-6] in names}
    rows = [rows_of(table) for table in tables]
    order = sorted({key for row in rows for key in row})
    made = {}
    for name in names:
        if name in keys:
            made[name] = [key[keys.index(name)] for key in order]
        elif name in COUNTS:
            made[name] = [math.fsum(table[name][row[key]] for table, row in zip(tables, rows) if key in row) for key in order]
        elif name not in errors:
            average_column(made, name, name + "_error" in errors, order, list(zip(tables, rows)))
    if tables:
        made["seeds"] = [float(sum(key in row for row in rows)) for key in order]
    return {name: numpy.array(values, float) for name, values in made.items()}


def average_column(made, name, has_error, order, runs):
    parts = [name, name + "_error"] + ([name + "_block_error"] if has_error else [])
    for part in parts:
        made[part] = []
    for key in order:
        there = [(table, row[key]) for table, row in runs if key in row]
        found = over_seeds([float(table[name][k]) for table, k in there],
                           [float(table[name + "_error"][k]) if has_error else math.nan for table, k in there])
        for part, value in zip(parts, found):
            made[part].append(value)


# --- final numbers ----------------------------------------------------------------------------------------------------

def since(table, name, start, intervals):
    """A column of a time series from step `start` on. intervals: each row tells of the time since the row before, the first one
    of the time since step 0; earlier programs wrote one for step 0, which tells of no time."""
    steps = table["step"]
    begins = numpy.concatenate(([0], steps[:-1])) if intervals and len(steps) else steps
    return table[name][(begins >= start) & (steps > begins if intervals else True)]


SERIES = {  # column of the summary: table, column, whether it tells of intervals
    "temperature_solvent": ("temperature", "solvent", False),
    "temperature_vertex": ("temperature", "vertex", False),
    "collision_rate": ("collisions", "rate_per_vertex", True),
    "collision_rate_over_theory": ("collisions", "rate_over_theory", True),
}
STATICS = ("Ree2", "Rg2", "lp", "bond_energy")
DYNAMICS = ("D", "D_about_mean", "D_cumulative", "D_cumulative_about_mean", "drift_x", "drift_y", "drift_z")


def put(row, name, found):
    for part, value in zip(("", "_error", "_block_error"), found):
        row[name + part] = value


def final_numbers(folders, averages, start):
    """One row: averages of time series from step `start` on, the table of statics, and the dynamics of the longest lag
    that has enough intervals in each run (plateau.py). folders: of the runs; averages: their tables, averaged."""
    row = {}
    series = {name: [table_of(folder / f"{name}.csv") for folder in folders]
              for name in ("temperature", "collisions") if name in averages}
    for name, (table, column, intervals) in SERIES.items():
        if table in series and all(column in one for one in series[table]):
            values = [since(one, column, start, intervals) for one in series[table]]
            if all(len(one) for one in values):
                put(row, name, over_seeds(*zip(*map(blocked_mean, values))))
    for name, table in averages.items():
        kind = name.partition("-")[2]
        if name.startswith("statics-"):
            for column in STATICS:
                put_cell(row, f"{column}_{kind}", table, column, 0)
        elif name.startswith("dynamics-"):
            put_dynamics(row, kind, table, len(folders))
    return row


def put_dynamics(row, kind, table, seeds):
    """The longest lag, the numbers there, and how much D changes to there from the octave of lags before."""
    last = plateau.last_lag(table, seeds)
    if last is None:
        return
    row[f"lag_{kind}"] = table["time"][last]
    for column in DYNAMICS:
        put_cell(row, f"{column}_{kind}", table, column, last)
    for column in plateau.OCTAVES:
        if f"{column}_{kind}" in row:
            put(row, f"change_{column}_{kind}", plateau.change(table, last, column, ("_error", "_block_error")))


def put_cell(row, name, table, column, k):
    if column in table and not math.isnan(table[column][k]):
        put(row, name, [table[column + part][k] for part in ("", "_error", "_block_error")])


# --- tables that are whole ---------------------------------------------------------------------------------------------

def row_names(table):
    """Rows by step or lag without that of step 0, which some earlier programs wrote and some did not."""
    return {key for key in rows_of(table) if key[:1] != (0.0,)}


def look_at(tables, steps):
    """tables: {file: its table}, of one name, of the finished runs of a point; steps: how many each run has done. Runs as long
    as each other have the same columns and rows, or one of the files is not what its run wrote."""
    first = {}
    for (path, table), count in zip(tables.items(), steps):
        if not table:
            raise BadTable(f"{path}: not a table: it has no line of names")
        known, names, rows = first.setdefault(count, (path, list(table), row_names(table)))
        if list(table) != names:
            raise BadTable(f"{path}: other columns than in {known}; `uncross verify` says whether its run is whole")
        if row_names(table) != rows:
            raise BadTable(f"{path}: other rows than in {known}, of a run as long; `uncross verify` says whether its run is whole")


# --- files ------------------------------------------------------------------------------------------------------------

def cell(value):
    if isinstance(value, float):
        if math.isnan(value):
            return "nan"
        return next(text for digits in (15, 16, 17) if float(text := f"{value:.{digits}g}") == value)
    return value


OWN = {"summary.csv": {"folder", "seeds"}, "runs.csv": {"folder", "state_hash"}}  # columns that say who made it


def refuse_others(path):
    """Nothing is written over that no sweep wrote."""
    try:
        if not stat.S_ISREG(os.lstat(path).st_mode):
            return  # write_text refuses it
    except FileNotFoundError:
        return
    if not OWN.get(path.name, {"seeds"}) <= set(_names(path)):
        raise BadTable(f"{path}: is no table of a sweep, and nothing is written over: move it away")


def _names(path):
    try:
        return next(csv.reader(read_table(path).splitlines()[:1]), [])
    except (ValueError, csv.Error):
        return []


def write_rows(path, names, rows):
    """Rows are dicts; what a row lacks is nan. In place of an earlier table of a sweep."""
    refuse_others(path)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    for row in rows:
        writer.writerow([cell(row.get(name, math.nan)) for name in names])
    write_text(path, text.getvalue())


def made_before(folder):
    """Names of the tables that a sweep made here."""
    return {path.stem for path in folder.glob("*.csv") if "seeds" in _names(path)}


def write_averages(folder, folders, steps):
    """Averages the tables of the run folders into `folder`; returns them. All of them have the same tables, and those of an
    earlier average. steps: of each run."""
    names = sorted({path.stem for run in folders for path in run.glob("*.csv")} | made_before(folder))
    found = {name: {run / f"{name}.csv": table_of(run / f"{name}.csv") for run in folders} for name in names}
    for tables in found.values():
        look_at(tables, steps)
    made = {name: average(list(tables.values())) for name, tables in found.items()}
    for name in names:
        refuse_others(folder / f"{name}.csv")
    for name, table in made.items():
        rows = [dict(zip(table, map(float, values))) for values in zip(*table.values())]
        write_rows(folder / f"{name}.csv", list(table), rows)
    return made
