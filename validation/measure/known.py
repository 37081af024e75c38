#!/usr/bin/python3
"""Primitive paths whose length is known: a ring about two posts, two linked rings, a chain in a lattice of posts.

usage: known.py FOLDER BUILD SEED > output.txt

Each is laid somewhat longer than it will be, as a start in H5MD, and has a run for each of three springs k. <L> at 1/k = 0 is L_0. Prints a
row per path and k: path, k, L_0 by geometry, <L> and its error from blocks, contacts, softened, rigid.
"""
import pathlib
import sys

import h5py
import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import primitive as paths  # noqa: E402
from primitive import primitive  # noqa: E402

BOX, SPRINGS, BLOCKS, FRAMES = 16, (1000, 3000, 9000), 8, 320
DT = 0.05  # of a bounce: what is pressed between two strands needs a smaller step than a network
POST = "  - {{name: post, count: {0}, vertices: 2, mass: 1, bond_length: {1:g}, spring: 100, start: straight, frozen: true}}"


def circle(center, axes, radius, count):
    angle = 2.0 * numpy.pi * numpy.arange(count) / count
    return center + radius * (numpy.cos(angle)[:, None] * axes[0] + numpy.sin(angle)[:, None] * axes[1])


def polygon(corners, count):
    """Evenly spaced points along a polygon."""
    corners = numpy.asarray(corners, float)
    where = numpy.concatenate([[0.0], numpy.cumsum(numpy.linalg.norm(numpy.diff(corners, axis=0), axis=1))])
    at = numpy.linspace(0.0, where[-1], count)
    return numpy.stack([numpy.interp(at, where, corners[:, k]) for k in range(3)], axis=1)


def length(points, closed):
    return primitive.lengths(numpy.concatenate([points, points[:1]]) if closed else numpy.asarray(points, float))


X, Y, Z = numpy.eye(3)


def about_posts():
    """A ring of 48 springs about two posts 3 a0 apart: it is taut when it goes to and fro."""
    posts = [(8 + 1.5 * s, 8.0 + 0.01 * s, 5.0) for s in (-1, 1)]
    apart = numpy.linalg.norm(numpy.subtract(posts[1], posts[0]))
    return "posts", posts, 6.0, [(circle(numpy.array([8.0, 8.0, 8.0]), (X, Y), 1.8, 48), True, "")], 2.0 * apart


def linked():
    """Two linked rings of 48 springs, each pinned at its far end: by symmetry each is drawn to the middle, and has twice half the distance."""
    middle = numpy.array([8.0, 8.0, 8.0])
    rings = [circle(middle - 0.75 * X, (-X, Y), 1.25, 48), circle(middle + 0.75 * X, (X, Z), 1.25, 48)]
    return "links", [], 0.0, [(ring, True, "held: first") for ring in rings], 2.0 * numpy.linalg.norm(rings[0][0] - rings[1][0])


def among_posts():
    """A chain of 95 springs whose ends are held, in a square lattice of 4 x 4 posts, past three of them on alternating sides."""
    posts = [(4.0 + 2 * i, 4.0 + 2 * j, 5.0) for i in range(4) for j in range(4)]
    corner = [numpy.array(c) for c in ((3.0, 5.1, 8.0), (6.0, 4.0, 8.0), (8.0, 8.0, 8.0), (10.0, 6.0, 8.0), (11.3, 9.1, 8.0))]
    turns = [numpy.cross(b - a, c - b)[2] for a, b, c in zip(corner, corner[1:], corner[2:])]
    wide = [corner[0], *(c + 0.3 * outward(a, c, b) for a, c, b in zip(corner, corner[1:], corner[2:])), corner[-1]]
    if not (turns[0] > 0 > turns[1] and turns[2] > 0):
        raise AssertionError(turns)
    return "lattice", posts, 6.0, [(polygon(wide, 96), False, "held: ends")], length(corner, False)


def outward(a, corner, b):
    """The unit vector from a corner away from the inside of the turn."""
    inside = (a - corner) / numpy.linalg.norm(a - corner) + (b - corner) / numpy.linalg.norm(b - corner)
    return -inside / numpy.linalg.norm(inside)


def measure(folder, build, seed, case, k):
    name, posts, long, lines, exact = case
    kinds, rows, bonds = [], [], []
    if posts:
        kinds.append(POST.format(len(posts), long))
        rows += [numpy.add(post, z * Z) for post in posts for z in (0.0, long)]
        bonds += [(2 * n, 2 * n + 1) for n in range(len(posts))]
    for number, (points, closed, how) in enumerate(lines):
        more = ", ".join(word for word in ("ring: true" if closed else "", how) if word)
        kinds.append(paths.KIND.format(name=f"path{number}", count=1, vertices=len(points), bond=0, spring=k, more=more))
        first, count = len(rows), len(points)
        bonds += [(first + n, first + (n + 1) % count) for n in range(count - (not closed))]
        rows += list(points)
    paths.write_start(folder / f"{name}.h5", BOX, numpy.array(rows), bonds)
    size = sum(len(points) for points, _, _ in lines)
    bond = exact / (size - sum(not closed for _, closed, _ in lines))
    dt = float(f"{DT / (k * bond):.3g}")
    rate = 2.0 * numpy.pi * k**0.5 / len(lines[0][0])
    steps = int(100.0 / rate / dt) // FRAMES * FRAMES
    told = paths.run(folder, build, f"{name}{k}", paths.SCENE.format(box=BOX, dt=dt, steps=steps, seed=seed, rate=rate, kinds="\n".join(kinds))
                     + paths.LATER.format(before=f"{name}.h5", every=steps // FRAMES))
    with h5py.File(folder / f"{name}{k}/trajectory.h5") as file:
        frames = file["particles/trajectory/position/value"][FRAMES // 10:]
    first, total = 2 * len(posts), 0.0
    if not (frames[:, :first] == frames[0, :first]).all():
        sys.exit("known.py: a post has moved")
    for points, closed, _ in lines:
        line = frames[:, first:first + len(points)]
        total = total + primitive.lengths(numpy.concatenate([line, line[:, :1]], axis=1) if closed else line)
        first += len(points)
    blocks = numpy.array([block.mean() for block in numpy.array_split(total, BLOCKS)])
    hit = told["collisions"]
    print(f"{name},{k},{exact:.9g},{total.mean():.9g},{blocks.std(ddof=1) / BLOCKS**0.5:.3g},{hit['executed']},{hit['softened']},{hit['rigid']}", flush=True)


def main(arguments):
    folder, build, seed = pathlib.Path(arguments[0]).resolve(), pathlib.Path(arguments[1]).resolve(), int(arguments[2])
    print("path,k,exact,L,error,contacts,softened,rigid")
    for case in (about_posts(), linked(), among_posts()):
        for k in SPRINGS:
            measure(folder, build, seed, case, k)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(sys.argv[1:])
