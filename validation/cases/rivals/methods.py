"""The rivals: the same fibers by uncross and by LAMMPS, from the same start. What is run, and the places of all vertices that come out.

A method is a word with settings, "srp:range=0.1,barrier=10,dt=0.01":

    events, sequential, plain, free      uncross: contacts at their own time, the paper's rule, the plain reversal of v, no contacts
    srp                                  LAMMPS, segmental repulsion: range (a0), barrier (kT, the energy at distance 0), skin (a0)
    wca                                  LAMMPS, beads: size (a0); vertices: of a fiber, at equal contour, stiffness and friction
    ghosts                               LAMMPS, no contacts

dt: time step (t0); build: native, or x86-64, of uncross.
"""
import dataclasses
import functools
import pathlib
import re
import resource
import string
import subprocess
import tempfile

import h5py
import numpy

EDGE = 36  # a0, longer than a fiber
VERTICES, MASS, SPRING, REST, BENDING = 64, 5.0, 100.0, 0.5, 64.0
RATE = 1.0  # Gamma of the bath
RULES = {"events": "rule: event-driven", "plain": "rule: event-driven", "sequential": "rule: sequential", "free": "forbidden: false"}
HERE = pathlib.Path(__file__).resolve().parent
PROGRAMS = {"native": "uncross", "x86-64": "rivals/x86-64/uncross", "plain": "rivals/plain/uncross"}

SCENE = string.Template("""box: [$edge, $edge, $edge]
time_step: $dt
steps: $steps
seed: $seed
medium: {kind: private, rate: $rate, draw: relax}
crossing: {$rule}
fibers: [{name: fiber, count: $count, vertices: $vertices, mass: $mass, bond_length: $rest, spring: $spring, bending: $bending}]
observe: {temperature: {every: $often}}
""")


@dataclasses.dataclass
class Method:
    kind: str
    dt: float = 0.01
    range: float = 0.1
    barrier: float = 10.0
    skin: float = 1.0
    size: float = 0.5
    vertices: int = VERTICES
    build: str = "native"

    @classmethod
    def read(cls, text):
        kind, _, rest = text.partition(":")
        values = dict(item.split("=") for item in rest.split(",") if item)
        types = {field.name: field.type for field in dataclasses.fields(cls)}
        return cls(kind, **{name: types[name](value) for name, value in values.items()})

    @property
    def is_own(self):
        return self.kind in RULES


def fibers_of(density):
    """How many fibers make c L^3 = density, L = 32 a0 by the paper's count."""
    return round(density * (EDGE / 32.0) ** 3)


def chain(vertices):
    """Mass, spring, rest length and bending constant of fibers with so many vertices, and the contour, stretch, stiffness and friction of 64."""
    ratio = (VERTICES - 1) / (vertices - 1)  # of bond lengths
    bending = BENDING if vertices == VERTICES else (BENDING - 0.5) / ratio + 0.5  # 1 - <cos> = 1/bending + ..., to second order
    return {"mass": MASS * VERTICES / vertices, "spring": SPRING / ratio**2, "rest": REST * ratio, "bending": bending}


def scene(method, count, seed, steps, often=1000):
    return SCENE.substitute(edge=EDGE, dt=method.dt, steps=steps, seed=seed, rate=RATE, rule=RULES.get(method.kind, RULES["events"]), count=count,
                            vertices=method.vertices, often=often, **chain(method.vertices))


class Failed(Exception):
    """A program that did not do what it should; the text says what it said."""


def call(command, folder):
    """(user CPU seconds, standard output)"""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(list(map(str, command)), cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Failed(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, done.stdout


def build_folder():
    """The programs lie in BUILD/validation/measure, as this file does."""
    return HERE.parents[1]


def uncross(method):
    return build_folder() / PROGRAMS["plain" if method.kind == "plain" else method.build]


@dataclasses.dataclass
class Ran:
    seconds: float
    frames: object  # an iterator over [vertices, 3], unwrapped, or None
    temperature: float = float("nan")
    record: dict = dataclasses.field(default_factory=dict)
    bonds: object = None  # a file with the bonds, for `uncross topology`
    trajectory: object = None


def run(method, count, seed, folder, steps, every=0, first=0):
    """Runs so many steps in an empty folder, with frames every so many from step `first` on (0: none)."""
    folder.mkdir(parents=True, exist_ok=True)
    return (run_own if method.is_own else run_lammps)(method, count, seed, folder, steps, every, first)


def run_own(method, count, seed, folder, steps, every, first):
    """Frames are of every `every` steps; those before `first` are skipped, but for every = 1, where the run goes on from there."""
    program, out, text = uncross(method), folder / "run", scene(method, count, seed, max(steps, 1), max(every, 50))
    seconds, begin = 0.0, first if every == 1 else 0
    (folder / "scene.yaml").write_text(text if begin or not every else text + f"trajectory: {{every: {every}, velocities: false}}\n")
    seconds += call([program, "run", folder / "scene.yaml", "--out", out, "--quiet", "--steps", begin or steps], folder)[0]
    if begin:
        (folder / "again.yaml").write_text(text + f"trajectory: {{every: {every}, velocities: false}}\nstart: {{snapshot: run/checkpoint.h5}}\n")
        out = folder / "again"
        seconds += call([program, "run", folder / "again.yaml", "--out", out, "--quiet", "--steps", steps - begin], folder)[0]
    path = out / "trajectory.h5"
    table = numpy.genfromtxt(out / "temperature.csv", delimiter=",", names=True)
    heat = numpy.atleast_1d(table["vertices" if "vertices" in table.dtype.names else table.dtype.names[-1]])
    return Ran(seconds, read_own(path, first if not begin else 0) if every else None, float(heat[len(heat) // 8:].mean()), trajectory=path if every else None)


def read_own(path, first):
    with h5py.File(path) as file:
        position = file["particles/trajectory/position"]
        for step, frame in zip(position["step"][()], position["value"]):
            if step >= first:
                yield frame


def contacts_of(method):
    """Lines of input of the method's contacts: what takes the place of names in fibers.lammps."""
    if method.kind == "ghosts":
        return {"contacts": "pair_style zero 1.0 nocoeff\npair_coeff * *", "extra": "", "exclude": "exclude type 1 1", "ghosts": 2.5, "skin": 1.0}
    if method.kind == "srp":  # U(d) = (C/2 R) (R - d)^2 for LAMMPS' F = C (1 - d/R)
        lines = f"mass 2 1\npair_style hybrid srp {method.range} 1 min exclude yes\npair_coeff 1 1 none\npair_coeff 1 2 none\npair_coeff 2 2 srp {2.0 * method.barrier / method.range:.10g}"
        return {"contacts": lines, "extra": "extra/atom/types 1", "exclude": "exclude type 1 1 exclude type 1 2", "ghosts": method.skin + method.range + 1.2, "skin": method.skin}
    if method.kind == "wca":
        lines = f"pair_style lj/cut {2.0**(1 / 6) * method.size:.12g}\npair_modify shift yes\npair_coeff 1 1 1 {method.size}"
        return {"contacts": lines, "extra": "", "exclude": "", "ghosts": 2.5, "skin": 0.3}
    raise Failed(f"{method.kind}: no such method")


def run_lammps(method, count, seed, folder, steps, every, first):
    (folder / "start.data").write_text(start(count, seed, method.vertices))
    dump = f"dump frames vertices custom {every} frames.dump id xu yu zu\ndump_modify frames sort id format float %.17g delay {first}" if every else ""
    push = ""
    if method.kind == "wca":  # from lines to beads: moves are limited to a fiftieth of their size
        push = f"fix push vertices nve/limit {0.02 * method.size}\nthermo 100000\nrun {round(1.0 / method.dt)}\nunfix push\nreset_timestep 0"
    text = string.Template((HERE / "fibers.lammps").read_text()).substitute(
        dt=method.dt, seed=1000 + seed, thermo=max(every, 50), dump=dump, steps=steps, push=push, **contacts_of(method))
    (folder / "fibers.lammps").write_text(text)
    seconds, said = call(["lmp", "-in", "fibers.lammps", "-log", "none"], folder)
    rows = re.findall(r"^ +(\d+) +([0-9.eE+-]+) *$", said.rpartition("Step ")[2], re.M)
    heat = numpy.array([float(value) for _, value in rows])
    path = folder / "frames.dump"
    return Ran(seconds, read_dump(path) if every else None, float(heat[max(1, len(heat) // 8):].mean()) if len(heat) > 1 else float("nan"),
               bonds=folder / "start.data", trajectory=path if every else None)


@functools.lru_cache
def start(count, seed, vertices):
    """A data file of LAMMPS: an exact state of lines of no thickness, the same one for all methods of one seed and chain."""
    program = build_folder() / "uncross"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "start.yaml").write_text(scene(Method("events", vertices=vertices), count, seed, 1) + "trajectory: {every: 1}\n")
        call([program, "run", folder / "start.yaml", "--out", folder / "start", "--quiet", "--steps", 0], folder)
        return call([program, "export", folder / "start/trajectory.h5", "--format", "lammps", "--wrapped"], folder)[1]


def read_dump(path):
    with open(path, encoding="ascii") as file:
        while True:
            head = [file.readline() for _ in range(9)]
            if not head[-1]:
                return
            count = int(head[3])
            rows = numpy.fromstring("".join(file.readline() for _ in range(count)), sep=" ").reshape(count, 4)
            yield rows[:, 1:]
