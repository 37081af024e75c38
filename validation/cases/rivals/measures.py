"""What is measured of frames, by one code for all methods: d^2, pairs of bonds that are close, order, crossings that were possible."""
import math

import numpy
from scipy.spatial import cKDTree

NEAR = numpy.array([0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8])  # a0
LEVERS = 1.151155  # int ds ds' sqrt((1-s)^2 + s^2 + (1-s')^2 + s'^2) over the unit square


def tube(origin, now):
    """[fiber]: squared distance of the vertices of the middle third, now, from the nearest point of the contour then; frames are [fiber, vertex, 3]."""
    vertices = origin.shape[1]
    third = now[:, vertices // 3:vertices - vertices // 3, None]
    begin, bond = origin[:, None, :-1], numpy.diff(origin, axis=1)[:, None]
    apart = third - begin
    s = numpy.clip((apart * bond).sum(-1) / (bond**2).sum(-1), 0.0, 1.0)
    return ((apart - s[..., None] * bond) ** 2).sum(-1).min(-1).mean(-1)


def motion(frames, interval, lags):
    """Rows (lag, d^2, error, mean square displacement of the center, error, intervals) of frames [time, fiber, vertex, 3] that are `interval` apart.
    Intervals overlap; fibers are independent, and give the errors."""
    rows = []
    for lag in lags:
        step = round(lag / interval)
        if step >= len(frames):
            continue
        origins = range(0, len(frames) - step, max(1, step // 4))
        values = numpy.mean([[tube(frames[k], frames[k + step]), ((frames[k + step].mean(1) - frames[k].mean(1)) ** 2).sum(-1)] for k in origins], axis=0)
        error = values.std(1, ddof=1) / math.sqrt(values.shape[1])
        mean = values.mean(1)
        rows.append((lag, mean[0], error[0], mean[1], error[1], len(origins)))
    return rows


def close_pairs(frame, edge, near=NEAR):
    """Counts [near]: pairs of bonds of different fibers that are nearer, between points inside of both (no ends); and what lines of no thickness have on
    average, (pi/4) rho^2 V e: THEORY of an isotropic ideal solution."""
    fibers, vertices, _ = frame.shape
    bond = numpy.diff(frame, axis=1).reshape(-1, 3)
    begin = frame[:, :-1].reshape(-1, 3)
    middle = (begin + 0.5 * bond) % edge
    length = numpy.linalg.norm(bond, axis=1)
    pairs = cKDTree(middle, boxsize=edge).query_pairs(near[-1] + numpy.quantile(length, 1.0), output_type="ndarray")
    fiber = numpy.repeat(numpy.arange(fibers), vertices - 1)
    pairs = pairs[fiber[pairs[:, 0]] != fiber[pairs[:, 1]]]
    p, q = bond[pairs[:, 0]], bond[pairs[:, 1]]
    w = middle[pairs[:, 1]] - middle[pairs[:, 0]]
    w -= edge * numpy.rint(w / edge)
    normal = numpy.cross(p, q)
    size = (normal**2).sum(-1)
    s = (numpy.cross(w, q) * normal).sum(-1) / size  # from the middle, in bonds
    t = (numpy.cross(w, p) * normal).sum(-1) / size
    inside = (abs(s) < 0.5) & (abs(t) < 0.5)
    apart = abs((w * normal).sum(-1))[inside] / numpy.sqrt(size[inside])
    density = length.sum() / edge**3
    ideal = math.pi / 4.0 * density**2 * edge**3 * (1.0 - 1.0 / fibers) * near
    return numpy.searchsorted(numpy.sort(apart), near), ideal


def width(counts, ideal, near=NEAR):
    """Effective width, a0: how much of the distance 0 ... near[-1] is empty, int (1 - g) de. Zero for lines without thickness."""
    return near[-1] * (1.0 - counts[-1] / ideal[-1])


def order(frame):
    """Largest eigenvalue of <(3 b b - 1)/2> of the bonds' directions: 0 if isotropic, but for some 1/sqrt(fibers)."""
    bond = numpy.diff(frame, axis=1).reshape(-1, 3)
    bond = bond / numpy.linalg.norm(bond, axis=1)[:, None]
    return float(numpy.linalg.eigvalsh(1.5 * bond.T @ bond / len(bond) - 0.5 * numpy.eye(3))[-1])


def possible(frame, edge, mass):
    """Crossings per t0 of lines that do not feel each other: (pi/8) rho^2 V <|v_n|>."""
    length = numpy.linalg.norm(numpy.diff(frame, axis=1), axis=-1)
    density = length.sum() / edge**3
    return math.pi / 8.0 * density**2 * edge**3 * math.sqrt(2.0 / (math.pi * mass)) * LEVERS


def free_motion(times, vertices, mass, rate, stiffness, bond2):
    """(d^2, mean square displacement of the center) of a straight fiber without contacts in a private bath, kT = 1: its modes are oscillators with
    friction. d^2: both transverse directions, averaged over the middle third. That of the center is exact."""
    t = numpy.asarray(times, float)
    second = numpy.diff(numpy.eye(vertices), 2, axis=0)
    stiff, mode = numpy.linalg.eigh(stiffness / bond2 * second.T @ second)
    weight = (mode[vertices // 3:vertices - vertices // 3] ** 2).mean(0)
    drift = 2.0 / (mass * rate) * (t - (1.0 - numpy.exp(-rate * t)) / rate)
    total = numpy.zeros_like(t)
    for k, (force, share) in enumerate(zip(stiff, weight)):
        if k < 2:  # moving and turning
            total += share * drift
            continue
        turn = numpy.sqrt(complex(force / mass - rate**2 / 4.0))
        memory = sum(0.5 * (1.0 + rate / (2.0j * root)) * numpy.exp((1j * root - 0.5 * rate) * t) for root in (turn, -turn)).real
        total += share * 2.0 / force * (1.0 - memory)
    return 2.0 * total, 3.0 * drift / vertices
