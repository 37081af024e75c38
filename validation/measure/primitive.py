#!/usr/bin/python3
"""Primitive paths of chains without width: their ends are held, and their bonds become ever stiffer springs without a rest length.

usage: primitive.py FOLDER BUILD BOX CHAINS VERTICES BOND SPRING PERSISTENCE SEED LEAST MOST MOBILE TIME [NAME=VALUE ...] > output.txt

The start is an exact sample of ideal chains, which is the equilibrium of chains that cannot cross. In FOLDER each spring k = 30, 90, 270 ... up to
MOST has a run of its own, of the rule `event-driven` at kT = 1, from the end of the run before. Masses are 1. A run lasts `pace` times (1) as long as a
wave needs along a chain, a third of it below LEAST. Its time step is `step` (0.1) of M v/f, which is half of the time for which a taut bond bounces. With
`split` of 2 (1) each bond of the start is cut in two before the first of them: the same polygons, with twice the vertices. Runs that were interrupted go on.

With MOBILE > 0, so many chains then move for TIME t0 by their own energy, their ends held, among the others, which are frozen where they were at the
start: a tube that is held.

Prints tables. `stages`: the mean L_pp of the last half of a run, how much the last quarter differs from the one before, contacts, and those that were
softened or rigid. `chains`: of each chain R^2, the contour, L_pp at each k, and sigma^2 of the start about the path at the largest k. `profile`: the
same sigma^2 along the chain, by vertices from the nearer end, with its error from chains. `held`: of each mobile chain sigma^2 about the mean of
places, sigma^2 of the start about the path, a quarter of d^2 from the middle of the run to its end, and sigma^2 of the start about the mean of places.
"""
import json
import pathlib
import signal
import subprocess
import sys

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from lib import primitive  # noqa: E402

FRAMES, ENDS = 32, 0.2  # ENDS: share of vertices left out at each end
OPTIONS = {"step": 0.1, "pace": 1.0, "split": 1.0}

SCENE = """box: [{box}, {box}, {box}]
time_step: {dt:.6g}
steps: {steps}
seed: {seed}
medium: {{kind: private, rate: {rate:.6g}, draw: relax}}
fibers:
{kinds}
crossing: {{rule: event-driven}}
checkpoint: {{seconds: 60}}
"""
KIND = "  - {{name: {name}, count: {count}, vertices: {vertices}, mass: 1, bond_length: {bond:g}, spring: {spring:g}, {more}}}"
LATER = """start: {{snapshot: {before}}}
trajectory: {{every: {every}, velocities: false}}
observe: {{temperature: {{every: {every}}}}}
"""
children = []


def stop(number, _frame):
    for child in children:
        child.send_signal(number)


def run(folder, build, name, scene):
    """Runs a scene of this folder, or goes on with it."""
    (folder / f"{name}.yaml").write_text(scene)
    command = [build / "uncross", "run", folder / f"{name}.yaml", "--out", folder / name, "--quiet"]
    if (folder / name / "checkpoint.h5").exists():
        command.append("--resume")
    child = subprocess.Popen(command, stdin=subprocess.DEVNULL)
    children[:] = [child]
    code = child.wait()
    if code:
        sys.exit(code)
    return json.loads((folder / name / "run.json").read_text())


def last_frame(folder, vertices):
    with h5py.File(folder / "checkpoint.h5") as file:
        return primitive.unfolded(file["state/vertex_position"][:] * 2.0**-40, vertices)


def frames(folder, vertices):
    with h5py.File(folder / "trajectory.h5") as file:
        return primitive.unfolded(file["particles/trajectory/position/value"][:], vertices)


def write_start(path, box, rows, bonds):
    """A snapshot at rest."""
    with h5py.File(path, "w") as file:
        file.create_group("h5md").attrs["version"] = (1, 1)
        group = file.create_group("particles/all")
        edges = group.create_group("box")
        edges.attrs["dimension"], edges.attrs["boundary"] = 3, numpy.array([b"periodic"] * 3)
        edges["edges"] = numpy.full(3, float(box))
        for name, value in (("position", rows), ("velocity", numpy.zeros_like(rows))):
            group[f"{name}/value"], group[f"{name}/step"], group[f"{name}/time"] = value[None], [0], [0.0]
        group["id"] = numpy.arange(len(rows))
        file["connectivity/bonds"] = numpy.array(bonds)
        file["connectivity/bonds"].attrs["particles_group"] = group.ref


def split(chains):
    """The same polygons with a vertex in the middle of each bond."""
    found = numpy.empty((len(chains), 2 * chains.shape[1] - 1, 3))
    found[:, ::2], found[:, 1::2] = chains, 0.5 * (chains[:, 1:] + chains[:, :-1])
    return found


def nearest_ends(rows):
    """[vertices/2, chains x 2] of rows [chains, vertices]: vertex by vertex from either end."""
    half = rows.shape[1] // 2
    return numpy.concatenate([rows[:, :half], rows[:, ::-1][:, :half]]).T


def in_a_tube(folder, build, vertices, mobile, time, kind, scene):
    """`held`: rows of mobile chains among frozen ones."""
    about, chains = scene
    kinds = "\n".join(KIND.format(name=name, count=count, more=f"{kind['more']}{how}", **{k: v for k, v in kind.items() if k != "more"})
                      for name, count, how in (("mobile", mobile, "held: ends"), ("net", chains - mobile, "frozen: true")))
    dt, looks = 0.01, 256
    steps = int(time / dt) // looks * looks
    run(folder, build, "held", SCENE.format(dt=dt, steps=steps, rate=1, kinds=kinds, **about)
        + LATER.format(before="start/checkpoint.h5", every=max(steps // looks, 1)))
    return frames(folder / "held", vertices)[looks // 4:, :mobile]


def main(arguments):
    folder, build = (pathlib.Path(a).resolve() for a in arguments[:2])
    box, chains, vertices = (int(a) for a in arguments[2:5])
    bond, spring, persistence = (float(a) for a in arguments[5:8])
    seed, least, most, mobile, time = int(arguments[8]), float(arguments[9]), float(arguments[10]), int(arguments[11]), float(arguments[12])
    option = {**OPTIONS, **{name: float(value) for name, value in (word.split("=") for word in arguments[13:])}}
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, stop)
    about = {"box": box, "seed": seed}
    kind = {"vertices": vertices, "bond": bond, "spring": spring, "more": f"persistence_length: {persistence:g}, "}
    alone = {"name": "chain", "count": chains, "vertices": vertices}
    run(folder, build, "start", SCENE.format(dt=0.01, steps=0, rate=1, kinds=KIND.format(**{**alone, **kind, "more": kind["more"] + "held: ends"}), **about))
    first = now = last_frame(folder / "start", vertices)
    found, before, k = {}, "start/checkpoint.h5", 30.0
    if option["split"] == 2:
        first = now = split(first)
        vertices, before = first.shape[1], "split.h5"
        alone["vertices"] = vertices
        write_start(folder / before, box, first.reshape(-1, 3), [(n * vertices + m, n * vertices + m + 1) for n in range(chains) for m in range(vertices - 1)])
    print("stages\nk,dt,steps,time,L,drift,bond,contacts,softened,rigid,temperature,seconds")
    while k <= most:
        name = f"k{k:g}"
        longest = numpy.sqrt(numpy.mean(numpy.square(numpy.diff(now, axis=1)).sum(axis=-1)))
        dt = float(f"{option['step'] / (k * max(longest, 3.0**0.5 * k**-0.5)):.3g}")
        steps = max(int(option['pace'] * vertices / k**0.5 / dt / (1.0 if k >= least else 3.0)) // FRAMES, 20) * FRAMES
        scene = SCENE.format(dt=dt, steps=steps, rate=max(4.0 * numpy.pi * k**0.5 / vertices, 0.2),
                             kinds=KIND.format(bond=0, spring=k, more="held: ends", **alone), **about)
        told = run(folder, build, name, scene + LATER.format(before=before, every=steps // FRAMES))
        paths = frames(folder / name, vertices)
        if not (numpy.array_equal(paths[:, :, 0], numpy.broadcast_to(first[:, 0], paths[:, :, 0].shape))):
            sys.exit("primitive.py: an end that is held has moved")
        length = primitive.lengths(paths)
        half, quarter = length[-(FRAMES // 2):], FRAMES // 4
        drift = length[-quarter:].mean() / length[-2 * quarter:-quarter].mean() - 1.0
        warm = numpy.genfromtxt(folder / name / "temperature.csv", delimiter=",", names=True)["vertex"][-(FRAMES // 2):].mean()
        hit = told["collisions"]
        print(f"{k:g},{dt:.6g},{steps},{told['time']:.6g},{half.mean():.8g},{drift:.3g},{half.mean() / (vertices - 1):.6g},{hit['executed']},"
              f"{hit['softened']},{hit['rigid']},{warm:.5f},{told['wall_seconds']:.1f}", flush=True)
        found[k] = half.mean(axis=0)
        now, before, k = paths[-1], f"{name}/checkpoint.h5", 3.0 * k
    middle = paths[-(FRAMES // 2):].mean(axis=0)
    square, contour, across = primitive.spans(first), primitive.lengths(first), primitive.across(first, middle)
    sigma2 = primitive.inner(across, ENDS)
    print("chains\nR2,contour,sigma2," + ",".join(f"L{k:g}" for k in found))
    for n in range(chains):
        print(",".join(f"{x:.8g}" for x in (square[n], contour[n], sigma2[n], *(found[k][n] for k in found))))
    print("profile\nvertex,sigma2,error")
    for n, row in enumerate(nearest_ends(across)):
        print(f"{n},{row.mean():.6g},{row.std(ddof=1) / len(row)**0.5:.3g}")
    if mobile == 0:
        return
    paths = in_a_tube(folder, build, vertices, mobile, time, kind, (about, chains))
    mean, middle_of = paths.mean(axis=0), len(paths) // 2
    about_mean = numpy.mean([primitive.inner(primitive.beside(p, mean), ENDS) for p in paths], axis=0)
    twice = numpy.mean([primitive.inner(primitive.across(p, q), ENDS) for p, q in zip(paths[:middle_of], paths[middle_of:])], axis=0)
    start = primitive.inner(primitive.beside(first[:mobile], mean), ENDS)
    print("held\nmean,path,d2,start")
    for n in range(mobile):
        print(f"{about_mean[n]:.6g},{sigma2[n]:.6g},{twice[n] / 2.0:.6g},{start[n]:.6g}")


if __name__ == "__main__":
    if len(sys.argv) < 14 or any(word.partition("=")[0] not in OPTIONS for word in sys.argv[14:]):
        sys.exit(__doc__)
    main(sys.argv[1:])
