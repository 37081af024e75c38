"""Runs: how they are described, executed, resumed, and read again.

A run has a folder <work>/<case>/<run>/. The folder of a scene has the files of `uncross run` (docs/files.md) and the
scene.yaml that it was given. The folder of a program has output.txt. Both have session.json: CPU time, and whether the run
is finished.
"""
import dataclasses
import fcntl
import hashlib
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

import numpy

TREE = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(TREE / "python"))
from uncross_sweep.files import columns, duration, read_json, take_lock, write_json  # noqa: E402
from uncross_sweep.opening import writing  # noqa: E402

INTERRUPTED = 5  # exit code of `uncross run` after a signal, and of `validation/run one`
CHECKPOINT_SECONDS = 120


@dataclasses.dataclass
class Run:
    """Either a scene, which `uncross run` runs to `steps` (more steps later extend the same run), or a program of
    validation/measure with its arguments. hours: CPU time on one core, estimated. priority: 0 comes first."""
    name: str
    scene: str = None
    steps: int = 0
    seed: int = 1
    program: list = None
    hours: float = 0.0
    priority: int = 0
    goals: tuple = ()  # (steps, priority), ...: stops on the way to `steps`, so that every figure is coarse before one is fine
    after: tuple = ()  # (NAME, arguments ...): when the run is finished, validation/measure/NAME.py prints a table from a file of it
    after_from: str = "trajectory.h5"  # this file
    after_to: str = ""  # the table's name; NAME if there is none
    dropped: tuple = ()  # series that are not kept: too large, and told by the table
    case: str = None  # set by whoever lists the runs
    stage: bool = False  # a stop on the way, not the whole run

    def __post_init__(self):
        if (self.scene is None) == (self.program is None):
            raise ValueError(f"{self.name}: a run has either a scene or a program")
        if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_.-]*", self.name):
            raise ValueError(f"{self.name!r} is no name of a run")

    @property
    def path(self):
        return f"{self.case}/{self.name}" + (f"@{self.steps}" if self.stage else "")

    def stages(self):
        """The run to each of its goals, then to its end; hours are those since the goal before."""
        found, before = [], 0
        for steps, priority in (*self.goals, (self.steps, self.priority)):
            hours = self.hours * (steps - before) / self.steps if self.steps else self.hours
            found.append(dataclasses.replace(self, steps=steps, priority=priority, hours=hours, goals=(),
                                             stage=steps < self.steps))
            before = steps
        return found

    @property
    def scene_text(self):
        """The scene with the keys that a Run sets: steps, seed, and the cadence of checkpoints."""
        text = re.sub(r"^(steps|seed):.*\n?", "", self.scene, flags=re.M).rstrip("\n")
        text += f"\nsteps: {self.steps}\nseed: {self.seed}\n"
        if not re.search(r"^checkpoint:", text, re.M):
            text += f"checkpoint: {{seconds: {CHECKPOINT_SECONDS}}}\n"
        return text

    @property
    def identity(self):
        """A hash of the scene or of the arguments. It does not depend on the number of steps."""
        what = re.sub(r"^steps:.*\n", "", self.scene_text, flags=re.M) if self.scene else json.dumps(self.program)
        return hashlib.sha256(what.encode()).hexdigest()[:16]


class Result:
    """The results of a run so far. Results of another scene or of other arguments count as none."""

    def __init__(self, folder, run):
        self.folder, self.run = pathlib.Path(folder), run
        self.session, self.record, self.text = read_json(self.folder / "session.json"), {}, ""
        if self.session.get("identity", run.identity) != run.identity:
            self.session = {}
            return
        self.record = read_json(self.folder / "run.json")
        text = self.folder / "output.txt"
        self.text = text.read_text() if text.exists() else ""

    @property
    def digest(self):
        """A hash of all files that are kept of the run, so that a changed number shows even if no case uses it."""
        total = hashlib.sha256()
        for path in sorted(path for pattern in HARVESTED for path in self.folder.glob(pattern)):
            total.update(path.name.encode() + b"\0" + path.read_bytes())
        return total.hexdigest()[:16]

    @property
    def exists(self):
        return bool(self.record or self.text)

    @property
    def finished(self):
        return self.steps >= self.run.steps if self.run.scene else bool(self.text)

    @property
    def steps(self):
        return self.record.get("steps", 0)

    @property
    def time(self):
        """The time that it has reached, in t0."""
        return self.record.get("time", 0.0)

    @property
    def cpu_seconds(self):
        return self.session.get("cpu_seconds", 0.0)

    @property
    def done_fraction(self):
        if self.finished:
            return 1.0
        return self.steps / self.run.steps if self.run.steps else 0.0

    def table(self, name):
        """Columns of NAME.csv, as arrays. KeyError without the file."""
        path = self.folder / f"{name}.csv"
        if not path.exists():
            raise KeyError(f"{self.run.path}: no table {name}")
        return columns(path.read_text())

    def tables(self):
        return sorted(path.stem for path in self.folder.glob("*.csv"))

    @property
    def columns(self):
        """What a program printed, if it is a table: comma-separated under a line of names; `#` begins a comment."""
        return columns(self.text)


# --- execution --------------------------------------------------------------------------------------------------------

class Refused(Exception):
    """A run that cannot be made as asked."""


def program_hash(path):
    return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()[:16]


def command_of(run, folder, build):
    """What to execute in `folder`, the first word being a program of this build."""
    if run.program:
        if run.program[0].endswith(".py"):
            return [str(TREE / "validation/measure" / run.program[0]), str(folder), str(build), *map(str, run.program[1:])]
        return [str(build / "validation/measure" / run.program[0]), *map(str, run.program[1:])]
    command = [str(build / "uncross"), "run", str(folder / "scene.yaml"), "--out", str(folder), "--steps",
               str(run.steps), "--quiet"]
    return command + (["--resume"] if (folder / "checkpoint.h5").exists() else [])


def prepare(run, folder, build, fresh):
    """Prepares the folder for the run. fresh: results of another scene or another program are removed (quick tier).
    Otherwise they are an error, because they may have taken days."""
    session = read_json(folder / "session.json")
    program = program_hash(command_of(run, folder, build)[0])
    other = session and (session["identity"] != run.identity or (fresh and session["program"] != program))
    if other and not fresh:
        raise Refused(f"{folder}: holds another run ({run.path} has changed since); remove it to begin anew")
    if other:
        shutil.rmtree(folder)
        session = {}
    folder.mkdir(parents=True, exist_ok=True)
    if run.scene:
        if not (folder / "checkpoint.h5").exists():
            for left in [*folder.glob("*.csv"), *folder.glob("*.h5*"), *folder.glob("run.json")]:
                left.unlink()  # ended before its first checkpoint
        (folder / "scene.yaml").write_text(run.scene_text)
    version = subprocess.run([str(build / "uncross"), "--version"], capture_output=True, text=True, check=True).stdout
    session.update(identity=run.identity, program=program, version=version.strip(), command=[
        run.program[0], *map(str, run.program[1:])] if run.program else ["uncross", "run"])
    session.setdefault("cpu_seconds", 0.0)
    return session


def execute(run, folder, build, fresh=False):
    """Runs to the end, or resumes; 0 when finished, INTERRUPTED after SIGTERM or SIGINT, else what went wrong.

    The signal is passed on: `uncross run` writes its checkpoint, a program begins anew next time. The lock is handed on, too:
    should this process be killed, its child still keeps others out until it ends."""
    folder, build = pathlib.Path(folder), pathlib.Path(build)
    folder.parent.mkdir(parents=True, exist_ok=True)
    with open(folder.with_name(folder.name + ".lock"), "a", encoding="ascii", opener=writing) as lock:
        take_lock(lock, fcntl.LOCK_EX, "makes this run")  # two stages of one run take turns
        return execute_locked(run, folder, build, fresh, lock.fileno())


def execute_locked(run, folder, build, fresh, lock):
    session = prepare(run, folder, build, fresh)
    if Result(folder, run).finished and (session.get("finished") or run.stage):
        return 0
    write_json(folder / "session.json", dict(session, finished=False))
    with open(folder / "output.part", "wb") as output:
        code, seconds, caught = call(command_of(run, folder, build), output, lock)
    session["cpu_seconds"] = round(session["cpu_seconds"] + seconds, 2)
    session["finished"] = code == 0
    if run.program and code == 0:
        (folder / "output.part").replace(folder / "output.txt")
    else:
        (folder / "output.part").unlink()
    if run.after and code == 0 and not run.stage:
        code = evaluate_after(run, folder)
        session["finished"] = code == 0
    write_json(folder / "session.json", session)
    return INTERRUPTED if caught and code != 0 else code


def evaluate_after(run, folder):
    """Exit code of the evaluation of a file of the run, into a table beside it."""
    name, *arguments = run.after
    script = pathlib.Path(__file__).resolve().parent.parent / f"measure/{name}.py"
    part = folder / f"{name}.part"
    with open(part, "wb") as output:
        code = subprocess.run([sys.executable, str(script), str(folder / run.after_from), *map(str, arguments)],
                              stdout=output, check=False).returncode
    if code == 0:
        part.replace(folder / f"{run.after_to or name}.csv")
    return code


def call(command, output, lock):
    """(exit code, CPU seconds, whether a signal came) of a command that gets SIGTERM when we do, and the open file `lock`."""
    caught, children = [], []

    def pass_on(number, _frame):
        caught.append(number)
        for child in children:
            child.send_signal(signal.SIGTERM)
    before = {number: signal.signal(number, pass_on) for number in (signal.SIGTERM, signal.SIGINT)}
    children.append(subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=output, pass_fds=[lock]))
    if caught:  # in between
        children[0].send_signal(signal.SIGTERM)
    _, status, usage = os.wait4(children[0].pid, 0)
    children[0].returncode = os.waitstatus_to_exitcode(status)
    for number, handler in before.items():
        signal.signal(number, handler)
    return children[0].returncode, usage.ru_utime + usage.ru_stime, bool(caught)


# --- many of them -----------------------------------------------------------------------------------------------------

def results_of(runs, work):
    """The results of these runs, in their order, whether there is anything yet or not."""
    return [Result(pathlib.Path(work) / run.case / run.name, run) for run in runs]


def write_plan(runs, work):
    """All that is to be run, for `progress`."""
    work.mkdir(parents=True, exist_ok=True)
    write_json(work / "plan.json", [dataclasses.asdict(run) for run in runs])


def planned(work):
    """The runs of the plan of this folder; none without a plan."""
    return [Run(**run) for run in read_json(pathlib.Path(work) / "plan.json")]


def progress(work):
    """How far the plan of this folder has come, in words; nothing without a plan."""
    results = results_of(planned(work), work)
    if not results:
        return ""
    left = math.fsum(result.run.hours * (1.0 - result.done_fraction) for result in results)
    return (f"{sum(result.finished for result in results)} of {len(results)} runs finished, about {duration(3600.0 * left)} of "
            "CPU time left")


HARVESTED = ("scene.yaml", "run.json", "session.json", "output.txt", "*.csv")


HARVEST_TRIES, HARVEST_PAUSE = 20, 0.25  # seconds; a checkpoint takes less to be put in place


def harvest(run, work, kept):
    """Copies the results into `kept`, finished or not. True if there were any. All files are of the step that run.json states. If
    they are of none (the run was killed in the middle of a checkpoint, and has not been resumed), nothing is copied. The record
    names the run's folder in any clone (build/campaign/CASE/RUN), not the one of this machine."""
    source, target = pathlib.Path(work) / run.case / run.name, pathlib.Path(kept) / run.case / run.name
    if not Result(source, run).exists:
        return False
    for attempt in range(HARVEST_TRIES):
        time.sleep(HARVEST_PAUSE if attempt else 0.0)
        files = files_of_one_step(run, source)
        if files is not None:
            break
    else:
        print(f"validation: {run.path} is between two checkpoints: not kept anew", file=sys.stderr)
        return False
    if "run.json" in files:
        files["run.json"] = files["run.json"].replace(f"{source}/".encode(), f"build/campaign/{run.case}/{run.name}/".encode())
        files["run.json"] = re.sub(rb'"host": "[^"]*"', b'"host": null', files["run.json"])
    target.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        (target / name).write_bytes(content)
    if (target / "stress.csv").is_file():
        thin(target / "stress.csv")
    return True


def is_running(folder):
    """True if some process executes the run of this folder."""
    path = folder.with_name(folder.name + ".lock")
    if not path.exists():
        return False
    with open(path, encoding="ascii") as lock:
        try:
            take_lock(lock, fcntl.LOCK_SH | fcntl.LOCK_NB, "makes this run")
        except BlockingIOError:
            return True
    return False


def files_of_one_step(run, source):
    """What is kept of a run, name by name; None if a checkpoint came in between.

    A run appends to its series as it goes: their rows end at the step of run.json. It puts averages in place at a checkpoint, then
    run.json: averages that are newer than run.json are of the checkpoint at hand."""
    record = source / "run.json"
    if not record.exists():
        return contents(run, source)
    before, made = record.read_bytes(), record.stat().st_mtime_ns
    told = json.loads(before)
    goes_on = told["status"] == "running" or is_running(source)
    files = contents(run, source)
    for name in [name for name in files if name.endswith(".csv")]:
        if files[name].startswith(b"step,"):
            files[name] = rows_until(files[name], told["steps"])
        elif goes_on and not is_afterwards(run, name) and (source / name).stat().st_mtime_ns > made:
            return None
    return files if files["run.json"] == before else None


def contents(run, source):
    return {path.name: path.read_bytes() for pattern in HARVESTED for path in source.glob(pattern) if path.stem not in run.dropped}


def is_afterwards(run, name):
    """True of the table that is made of a finished run (Run.after)."""
    return bool(run.after) and name == f"{run.after_to or run.after[0]}.csv"


def rows_until(table, step):
    """The head and the whole rows of a series up to this step."""
    head, *rows = table[:table.rfind(b"\n") + 1].splitlines(keepends=True)
    return head + b"".join(row for row in rows if int(row.partition(b",")[0]) <= step)


def thin(path, most=2000):
    """Averages neighboring rows of a series, as many as leave at most `most` rows: step and time are those of the last one. Each
    row of stress.csv is a mean over its own interval, so that no mean changes but for the rows at the end that fill no block."""
    head = path.read_text().partition("\n")[0]
    rows = numpy.genfromtxt(path, delimiter=",", skip_header=1, ndmin=2)
    names = head.split(",")
    rows = rows[1:] if len(rows) and numpy.isnan(rows[0, 2:]).all() else rows  # the first row has no interval before it
    together = -(-len(rows) // most)
    if together < 2:
        return
    blocks = rows[:len(rows) // together * together].reshape(-1, together, len(names))
    short = blocks.mean(axis=1)
    short[:, :2] = blocks[:, -1, :2]
    path.write_text("\n".join([head, *(",".join(f"{x:.17g}" for x in row) for row in short)]) + "\n")
