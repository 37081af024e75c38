"""What a folder or file holds, and what a reader should know of it: run.json, tables, the numbers of `uncross check`."""
import dataclasses
import math
import os
import re
import subprocess
import tempfile

import numpy

from uncross_sweep import plateau
from uncross_sweep import record as records
from uncross_sweep.opening import reading

from . import columns, fibers, tables

LEAST_PAIRS = plateau.LEAST_PAIRS
PROGRAM = os.environ.get("UNCROSS", "uncross")


class BadInput(Exception):
    """What was asked for cannot be shown; the message begins with the file."""


@dataclasses.dataclass
class Number:
    """A row of `uncross check`."""
    name: str
    symbol: str
    value: str
    unit: str
    source: str
    si: str = ""  # value and unit, if asked for


@dataclasses.dataclass
class Run:
    """A folder of a run, or one of its files. What is not there is None or empty."""
    path: str
    record: dict = None
    written: float = None  # when run.json was
    tables: list = dataclasses.field(default_factory=list)
    frames: fibers.File = None  # the trajectory, else the checkpoint
    moving: bool = False  # there is a trajectory
    scene: str = ""
    derived: list = dataclasses.field(default_factory=list)  # (heading, [Number])
    units: str = ""  # that SI values are made of, as `uncross check --units` takes them
    units_words: list = dataclasses.field(default_factory=list)  # what is right and what is wrong with them
    trouble: list = dataclasses.field(default_factory=list)  # files that are damaged, numbers that are missing

    @property
    def name(self):
        return os.path.basename(os.path.abspath(self.path))

    @property
    def rings(self):
        """Names of the kinds that are rings."""
        return {self.frames.structure.kinds[k] for k in self.frames.structure.rings} if self.frames else set()

    def exact(self, table):
        """{column: value} that theory gives for a table; the phantom chain's hold for open fibers."""
        kind = columns.split(table.name)[1]
        return {} if self.frames is None or kind in self.rings else tables.exact_values(table, self.numbers(kind))

    def numbers(self, kind):
        """{name: value} of `uncross check` for a kind of fiber."""
        for heading, rows in self.derived:
            if heading == f"Fibers '{kind}'":
                return {row.name: float(row.value) for row in rows if _is_real(row.value)}
        return {}

    def table(self, name):
        return next((t for t in self.tables if t.name == name), None)


def _is_real(text):
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


# --- reading -----------------------------------------------------------------------------------------------------------

def call(*words):
    """(exit code, standard output, standard error) of uncross."""
    done = subprocess.run([PROGRAM, *words], stdin=subprocess.DEVNULL, capture_output=True, check=False)
    return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")


def open_frames(path):
    """A checkpoint or trajectory. uncross looks at it first: a damaged file may end the process that reads it with HDF5."""
    code, told, complaint = call("verify", path)
    if code:
        raise BadInput(f"{path}: {_reason(told + complaint, path)}")
    try:
        return fibers.File(path)
    except (OSError, ValueError, RuntimeError) as error:
        raise BadInput(f"{path}: neither a trajectory nor a checkpoint that can be drawn ({_one_line(error)})") from error


def _one_line(text):
    return " ".join(str(text).split())


def _reason(told, path):
    lines = [line.strip() for line in told.splitlines() if line.strip()]
    return lines[0].removeprefix("uncross: ").removeprefix(f"{path}: ") if lines else "cannot be read"


def _of_sweep(path):
    """What can be shown of a sweep: docs/running.md."""
    folder = path if os.path.isdir(path) else os.path.dirname(path) or "."
    points = sorted(entry for entry in os.listdir(folder) if os.path.isdir(os.path.join(folder, entry)))
    return (f"{path}: of a sweep; give the folder of one of its points, whose tables are averages over seeds, or of one "
            f"of its runs" + (f": {os.path.join(folder, points[0])}" if points else ""))


def read_folder(path, units=""):
    names = sorted(os.listdir(path))
    run = Run(path, units=units)
    if "run.json" in names:
        _read_record(run, os.path.join(path, "run.json"))
    growing = (run.record or {}).get("status") == "running"
    for name in names:
        if name.endswith(".csv"):
            try:
                run.tables.append(tables.read(os.path.join(path, name), name[:-len(".csv")], growing))
            except (OSError, ValueError) as error:
                run.trouble.append(str(error))
    for name in ("trajectory.h5", "checkpoint.h5"):
        if name in names and run.frames is None:
            try:
                frames = open_frames(os.path.join(path, name))
                run.frames, run.moving = frames, name == "trajectory.h5" and len(frames.steps) > 1
            except BadInput as error:
                run.trouble.append(str(error))
            if run.frames is not None and len(run.frames.steps) == 0:
                run.frames = None
    if "runs.csv" in names and "summary.csv" in names:
        raise BadInput(_of_sweep(path))
    if run.record is None and run.frames is None and not run.tables:
        raise BadInput(run.trouble[0] if run.trouble else f"{path}: not the folder of a run: no run.json, table, "
                       "trajectory or checkpoint is in it")
    order = list(columns.TITLES)
    run.tables.sort(key=lambda t: (order.index(columns.split(t.name)[0]) if columns.split(t.name)[0] in order
                                   else len(order), t.name))
    run.scene = (run.record or {}).get("scene") or (run.frames.structure.scene if run.frames else "")
    _derive(run)
    return run


def read_file(path, units=""):
    run = Run(path, units=units)
    if os.path.basename(path) in ("runs.csv", "summary.csv"):
        raise BadInput(_of_sweep(path))
    if path.endswith(".csv"):
        run.tables.append(tables.read(path, os.path.basename(path)[:-len(".csv")]))
        return run
    if path.endswith(".json"):
        raise BadInput(f"{path}: give the folder of the run, which has its tables and frames too")
    with open(path, "rb", opener=reading) as file:
        if file.read(8) != b"\x89HDF\r\n\x1a\n":
            raise BadInput(f"{path}: neither a folder of a run, nor a table *.csv, a trajectory or a checkpoint")
    run.frames = open_frames(path)
    if len(run.frames.steps) == 0:
        raise BadInput(f"{path}: no frame is in it")
    run.moving = len(run.frames.steps) > 1
    run.scene = run.frames.structure.scene
    _derive(run)
    return run


def read(path, units=""):
    """A Run; BadInput if there is nothing to show. units: as of `uncross check --units`, for SI values beside."""
    try:
        return read_folder(path, units) if os.path.isdir(path) else read_file(path, units)
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror or _one_line(error)}") from error
    except ValueError as error:
        raise BadInput(_one_line(error)) from error


def _read_record(run, path):
    try:
        run.record, run.written = records.read(path), os.stat(path).st_mtime
    except records.Foreign as error:
        raise BadInput(str(error)) from error
    except OSError as error:
        run.trouble.append(f"{path}: cannot be read: {_one_line(error)}")


# Name, symbol, value, unit, source; with SI units, name, symbol, value, unit, SI value, source.
ROW = re.compile(r"  (.{38}) (.{9}) +(\S+)(?: (.{9}) (\S.*)| (\S.*))?")
ROW_SI = re.compile(r"  (.{38}) (.{9}) +(\S+)(?: (.{9})(?: (.{17}) (\S.*)| (\S.*))?| (\S.*))?")


def _derive(run):
    """The numbers of `uncross check`. A snapshot that the scene starts from changes none, and may not be there."""
    if not run.scene:
        return
    text = re.sub(r"(?m)^start:.*\n?(?:[ \t]+.*\n?|#.*\n?|\n)*", "", run.scene)
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "scene.yaml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(text)
        code, told, complaint = call("check", scene, *(("--units", run.units) if run.units else ()))
    if code and run.units and complaint.startswith("uncross: --units"):
        raise BadInput(_reason(complaint, scene))
    if code:
        run.trouble.append(f"no derived numbers: {_reason(complaint, scene).replace(scene, 'the scene')}")
        return
    heading, rows = "", []
    for line in told.splitlines():
        if line and not line[0].isspace():
            heading, rows = line, []
        if heading.startswith("The solvent beside") and line.startswith(("  right:", "  wrong:")):
            run.units_words.append(" ".join(line.split()))
        number = _number(line, bool(run.units))
        if number and heading.startswith(("Solvent", "Walls", "Shear", "Flow by", "Fibers", "Suspension", "SI units")):
            if not rows:
                run.derived.append((heading, rows))
            rows.append(number)


def _number(line, has_si):
    """The Number of a line of `uncross check`, or None."""
    match = (ROW_SI if has_si else ROW).fullmatch(line)
    if not match or not _is_real(match[3]):
        return None
    cells = [(cell or "").strip() for cell in match.groups()]
    if not has_si:
        return Number(*cells[:3], cells[3] or cells[5], cells[4])
    return Number(*cells[:3], cells[3] or cells[7], cells[5], cells[4] or cells[6])


# --- what to distrust --------------------------------------------------------------------------------------------------

def stream_and_start(record):
    """Which random numbers a run draws, and the state of the snapshot that it begins with; of each None if not known or none."""
    record = record or {}
    return record.get("stream", record.get("seed")), (record.get("stream_from") or {}).get("state")


def distrust(run):
    """Sentences, the gravest first; an empty list if nothing is known against the run."""
    return [*_ended(run), *run.trouble, *(run.record or {}).get("warnings", []), *_faults(run), *_short(run),
            *_moving(run), *_unconverged(run), *_off_theory(run)]


def _ended(run):
    record = run.record
    if record is None:
        return ["There is no run.json: how the run ended is not known."] if os.path.isdir(run.path) else []
    status, done, wanted = record.get("status"), record.get("steps", 0), record.get("steps_wanted", 0)
    if status == "finished" and done >= wanted:
        return []
    why = f": {record['reason']}" if record.get("reason") else ""
    return [f"The run did not finish: it is '{status}' at step {done} of {wanted}{why}."]


def _faults(run):
    rigid = (run.record or {}).get("collisions", {}).get("rigid", 0)
    told = any("rigid" in text for text in (run.record or {}).get("warnings", []))
    return [f"{rigid} contacts made bonds move rigidly for the rest of a drift."] if rigid and not told else []


def _short(run):
    """Times that the run is too short for, and averages of too few values."""
    time = (run.record or {}).get("time") or (run.frames.times[-1] if run.frames else None)
    for heading, rows in run.derived:
        for row in rows:
            if row.name.startswith("rotational relaxation") and time and time < float(row.value):
                yield (f"{heading}: the run lasted {time:.4g} t0, and a fiber turns in {float(row.value):.4g} t0: "
                       "averages still show the start.")
            if row.name.startswith("slowest Rouse mode") and time and time < float(row.value):
                yield (f"{heading}: the run lasted {time:.4g} t0, and the slowest mode of a chain, without hydrodynamics, takes "
                       f"{float(row.value):.4g} t0: averages still show the start.")
            if row.name == "time to become steady" and time:
                yield from _unsteady(run, time, float(row.value))
    few = {}
    for table in run.tables:
        lost = [c for c in table.values if table.errors(c) is not None
                and (numpy.isfinite(table.data[c]) & numpy.isnan(table.errors(c))).any()]
        if lost:
            yield f"{table.name}: too few values for an error of {', '.join(lost)}."
        pairs = table.data.get("intervals")
        if pairs is not None and (pairs < LEAST_PAIRS).any():
            few.setdefault(f"{table.data['time'][pairs < LEAST_PAIRS][0]:.4g}", []).append(table.name)
    for lag, names in few.items():
        yield (f"{', '.join(names)}: from lag {lag} t0 on, fewer than {LEAST_PAIRS} pairs of times were compared: errors "
               "there are the scatter over fibers alone.")


MOST_START = 0.01  # of a mean over time: as src/scene/warnings.c has it


def _unsteady(run, end, tau):
    """Profiles and stresses of a flow that starts at rest. A run from a snapshot starts as that ended."""
    means = [table.name for table in run.tables if table.name in ("profile", "stress")]
    told = any("the flow starts at rest" in text for text in (run.record or {}).get("warnings", []))
    steps = (run.record or {}).get("steps")
    found = re.search(r"(?m)^ +from: (\d+)", run.scene)
    begin = float(found[1]) * end / steps if found and steps else 0.0
    if told or not means or end <= begin or re.search(r"\bsnapshot:", run.scene):
        return
    share = tau / (end - begin) * (math.exp(-begin / tau) - math.exp(-end / tau))
    if share > MOST_START:
        yield (f"{', '.join(means)}: the flow has not become steady: it starts at rest and needs {tau:.3g} t0 for each factor of e; "
               f"means from {begin:.4g} to {end:.4g} t0 hold {100.0 * share:.2g} % of the start.")


def diffusion(run, table):
    """(column, row, Plateau) of the D that the page shows of a table: at the longest lag that enough intervals have, about the
    drift where a force acts; None if it has none."""
    column = "D_about_mean" if any("contain (v t)^2" in text for text in (run.record or {}).get("warnings", [])) else "D"
    row = plateau.last_lag(table.data) if column in table.data else None
    if row is None or not numpy.isfinite(table.data[column][row]):
        return None
    return column, row, plateau.plateau(table.data, row, column)


def _moving(run):
    """Diffusion coefficients that still depend on the lag."""
    for table in run.tables:
        found = diffusion(run, table)
        if found:
            doubt = found[2].doubt(f"D of '{columns.split(table.name)[1] or table.name}'")
            if doubt:
                yield doubt


def _unconverged(run):
    """Time series whose halves differ by more than chance."""
    for table in run.tables:
        sort = columns.split(table.name)[0]
        if table.has_errors or table.rows < 64 or sort not in ("conserved", "temperature"):
            continue
        for name in table.values if sort == "temperature" else ("bond", "bend"):
            series = table.data.get(name)
            if series is None or not numpy.isfinite(series).all():
                continue
            halves = numpy.array_split(series, 2)
            error = math.hypot(*(tables.blocked_error(half) for half in halves))
            gap = halves[1].mean() - halves[0].mean()
            if error > 0 and abs(gap) > 4 * error:
                yield (f"{table.name}: {name} is not steady: its second half differs from the first by {gap:.3g}, "
                       f"{abs(gap) / error:.1f} standard errors.")


def _off_theory(run):
    """Averages that must have the values of the phantom chain, and have not."""
    for table in run.tables:
        for name, exact in run.exact(table).items():
            if table.errors(name) is None:
                continue
            value, error = table.data[name][0], table.errors(name)[0]
            if error > 0 and abs(value - exact) > 5 * error:
                yield (f"{table.name}: {name} = {value:.5g} ± {error:.2g}, where theory has {exact:.5g}: "
                       f"{abs(value - exact) / error:.1f} standard errors apart.")
    heat = run.table("temperature")
    series = heat.data.get("solvent") if heat is not None else None
    if series is not None and len(series) and numpy.isfinite(series).all():
        error = tables.blocked_error(series)
        if abs(series.mean() - 1.0) > 5 * error and abs(series.mean() - 1.0) > 0.01:
            yield (f"temperature: that of the solvent is {series.mean():.4f} ± {error:.1g} kT/kB: averages are not "
                   "those of equilibrium at 1.")
