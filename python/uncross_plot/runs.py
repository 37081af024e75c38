"""What a folder or file holds: run.json, tables, the numbers of `uncross check`."""
import dataclasses
import math
import os
import re
import subprocess
import tempfile

from uncross_sweep import record as records
from uncross_sweep.opening import reading

from . import columns, fibers, tables

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
    members: list = dataclasses.field(default_factory=list)  # of a point of a sweep: (folder, record or None) of each run

    @property
    def name(self):
        return os.path.basename(os.path.abspath(self.path))

    @property
    def records(self):
        """Of the run itself, or of the runs that are averaged; those that are there."""
        return [record for _, record in self.members if record] or ([self.record] if self.record else [])

    @property
    def warnings(self):
        """All of run.json, of any of the runs."""
        return [text for record in self.records for text in record.get("warnings", [])]

    @property
    def time(self):
        """That the run lasted, t0, or the shortest run; None if not known."""
        lasted = [record["time"] for record in self.records if record.get("time")]
        return min(lasted) if lasted else self.frames.times[-1] if self.frames else None

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
    elif run.record is None and run.frames is None:
        _read_members(run, names)
    if run.record is None and run.frames is None and not run.tables and not run.members:
        raise BadInput(run.trouble[0] if run.trouble else f"{path}: not the folder of a run: no run.json, table, "
                       "trajectory or checkpoint is in it")
    order = list(columns.TITLES)
    run.tables.sort(key=lambda t: (order.index(columns.split(t.name)[0]) if columns.split(t.name)[0] in order
                                   else len(order), t.name))
    run.scene = next((r["scene"] for r in run.records if r.get("scene")), run.frames.structure.scene if run.frames else "")
    _derive(run)
    return run


def record_of(folder):
    """The record of a run's folder, or None if there is none that can be read."""
    try:
        return records.read(os.path.join(folder, "run.json"))
    except (records.Foreign, OSError):
        return None


def _read_members(run, names):
    """The runs below a point of a sweep (docs/running.md), whose averages its tables are."""
    for name in names:
        folder = os.path.join(run.path, name)
        if name.startswith("seed-") and os.path.isdir(folder):
            run.members.append((name, record_of(folder)))


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


# Headings of `uncross check` whose rows follow from the scene's.
DERIVED = ("Solvent", "Medium", "Dumbbells", "Walls", "Shear", "Flow by", "Bead", "Fibers", "Suspension", "SI units")
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
        if number and heading.startswith(DERIVED):
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
