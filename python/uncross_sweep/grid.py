"""Which runs a sweep is made of: points of a grid, and seeds."""
import dataclasses
import hashlib
import itertools
import os
import pathlib
import re
import subprocess

from . import escape

MOST_RUNS = 1000000
MOST_NAME = 120  # characters of a point's folder
MOST_SEED = 2**64 - 1


class Refused(Exception):
    """A sweep that cannot be made as asked: exit code 2, and nothing has been written."""


def split(text):
    """Values between commas; commas within brackets belong to a value: "[8, 8, 8],[9, 9, 9]" are two."""
    values, depth = [""], 0
    for letter in text:
        depth += (letter in "[{") - (letter in "]}")
        if letter == "," and depth == 0:
            values.append("")
        else:
            values[-1] += letter
    return [value.strip() for value in values]


def read_axis(text):
    """(key, values) of "KEY=V1,V2,..."."""
    key, equals, rest = text.partition("=")
    values = split(rest)
    if not equals or not key or "" in values:
        raise Refused(f"--grid {text}: allowed: KEY=VALUE,VALUE,..., as --grid fibers.0.count=10,20,40")
    if len(set(values)) < len(values):
        raise Refused(f"--grid {text}: a value is given twice")
    if key == "seed":
        raise Refused(f"--grid {text}: seeds are not averaged as values of a grid; use --seeds")
    return key, values


def read_seeds(text):
    """Seeds of "1..4" or "1,5,9" or both."""
    seeds = []
    for part in text.split(","):
        found = re.fullmatch(r"(\d+)(?:\.\.(\d+))?", part.strip())
        first, last = (int(found[1]), int(found[2] or found[1])) if found else (0, -1)
        if not first <= last <= MOST_SEED or last - first >= MOST_RUNS:
            raise Refused(f"--seeds {text}: '{part}' is no seed and no range; allowed: FIRST..LAST or SEED,SEED,..., each a "
                          f"whole number 0 .. {MOST_SEED}")
        seeds.extend(range(first, last + 1))
    if len(set(seeds)) < len(seeds):
        raise Refused(f"--seeds {text}: a seed is given twice")
    return seeds


@dataclasses.dataclass
class Point:
    """A combination of values. What `uncross check` says of its scene comes from `look`."""
    values: dict  # key: value, as text
    name: str  # of its folder
    fingerprint: str = ""
    scene: str = ""  # all keys with their values
    seed: int = 0  # of the scene
    steps: int = 0
    start: int = 0  # observe.from
    observe: str = ""  # lines of the effective scene
    seconds: float = 0.0  # estimated time of a run
    warnings: tuple = ()


def name_of(values):
    """A folder's name made of keys and values."""
    name = re.sub(r"[^A-Za-z0-9._=,+-]+", "-", "_".join(f"{key}={value}" for key, value in values.items())) or "all"
    if len(name) <= MOST_NAME and not name.startswith("."):
        return name
    return name[:MOST_NAME].lstrip(".") + "-" + hashlib.sha256(repr(values).encode()).hexdigest()[:8]


def points_of(axes):
    """All combinations of the axes' values, the last axis changing first."""
    keys = [key for key, _ in axes]
    if len(set(keys)) < len(keys):
        raise Refused(f"--grid: {max(keys, key=keys.count)} is given twice")
    points = []
    for values in itertools.product(*(values for _, values in axes)):
        if len(points) == MOST_RUNS:
            raise Refused(f"--grid: more than {MOST_RUNS} points")
        pairs = dict(zip(keys, values))
        points.append(Point(pairs, name_of(pairs)))
    if len({point.name for point in points}) < len(points):  # letters that no folder has were all that differed
        for point in points:
            point.name += "-" + hashlib.sha256(repr(point.values).encode()).hexdigest()[:8]
    return points


@dataclasses.dataclass
class Sweep:
    uncross: str
    scene: str
    out: pathlib.Path
    points: list
    seeds: list = None  # None: the scene's own
    sets: tuple = ()  # "KEY=VALUE", for all points
    steps: int = None

    def look(self):
        """Asks `uncross check` about each point. Refused, with its message, if a scene cannot be read."""
        for point in self.points:
            steps = [] if self.steps is None else [f"steps={self.steps}"]
            words = [self.uncross, "check", escape.path(self.scene), *self.settings(point, steps)]
            done = subprocess.run(words, capture_output=True, text=True, errors="replace", check=False)
            if done.returncode != 0:
                raise Refused(done.stderr.strip().removeprefix("uncross: ") or f"check ends with {done.returncode}")
            read_report(point, done.stdout)
        known = {}
        for point in self.points:
            same = known.setdefault(point.scene, point)
            if same is not point:
                raise Refused(f"--grid: {same.name} and {point.name} are the same scene; allowed: values that differ")

    def settings(self, point, more=(), seed=True):
        """seed: whether that of --set is among them; a run gets it as --seed."""
        given = [*(text for text in self.sets if seed or text.partition("=")[0] != "seed"), *(f"{key}={value}" for key, value in point.values.items()), *more]
        return [word for setting in given for word in ("--set", setting)]

    def runs(self):
        """All runs; every point's first seed comes first."""
        seeds = [None] if self.seeds is None else self.seeds
        return [Run(self, point, point.seed if seed is None else seed) for seed in seeds for point in self.points]


def observed(text):
    """The lines of an effective scene that say what is observed."""
    found = re.search(r"^observe:\n((?:  .*\n)*)", text, re.M)
    return found[1] if found else ""


def read_report(point, report):
    """Takes from the report of `uncross check` what a sweep needs."""
    def find(pattern, absent=None):
        found = re.search(pattern, report, re.M)
        if not found and absent is None:
            raise Refused(f"{point.name}: `uncross check` does not say {pattern}")
        return found[1] if found else absent

    point.fingerprint = find(r"\(fingerprint ([0-9a-f]{16})\)$")
    point.scene = report.partition("\n\n")[2].partition("\n\n")[0]
    point.seed = int(find(r"^seed: (\d+)$"))
    point.steps = int(find(r"^steps: (\d+)$"))
    point.start = int(find(r"^observe:\n  from: (\d+)$", "0"))
    point.observe = observed(report)
    point.seconds = float(find(r"^  time +(\S+) s$", "0"))
    point.warnings = tuple(re.findall(r"^  warning: (.*)$", report, re.M))


@dataclasses.dataclass
class Run:
    sweep: Sweep
    point: Point
    seed: int
    code: int = None  # exit code; None: not run by this sweep
    message: str = ""

    @property
    def name(self):
        return f"{self.point.name}/seed-{self.seed}"

    @property
    def folder(self):
        return self.sweep.out / self.point.name / f"seed-{self.seed}"

    def command(self):
        """Its words, without --resume."""
        s = self.sweep
        steps = [] if s.steps is None else ["--steps", str(s.steps)]
        return [s.uncross, "run", escape.path(s.scene), "--out", escape.path(self.folder), "--seed", str(self.seed), *steps,
                *s.settings(self.point, seed=False), "--quiet"]

    def words(self):
        return escape.words(self.command())


def is_begun(run):
    return (run.folder / "checkpoint.h5").exists()


def find_program():
    """The program that started this one, or that of the path."""
    return os.environ.get("UNCROSS") or "uncross"
