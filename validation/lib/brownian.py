#!/usr/bin/python3
"""The loss of D of a flexible chain because it changes its shape: Brownian dynamics with hydrodynamic interactions.

Kirkwood's D is that of short times. At later times the internal forces F move the center of mass, through the mobility of the
present shape, with the velocity A = (1/N) sum_ij mu_ij F_j, and D(t) = D_K - int_0^t <A(0).A(s)>/3 ds (Fixman, J. Chem. Phys. 78, 1594,
1983). Oseen's tensor, smeared over collision cells as in lib/dilute.py, is positive and has no divergence, so Ermak and
McCammon's step needs no drift: x(t + dt) = x + mu F dt + sqrt(2 dt) L w, L L^T = mu.

usage: validation/lib/brownian.py N CHAINS TIME     prints the share of D_K lost at some lags t: of dg/6dt, with its error, and of g/6t
"""
import math
import sys

import numpy
from scipy import special


def smeared_oseen(apart, eta, spread):
    """Oseen's tensor, smeared by a Gaussian of variance `spread` per axis, over the last axis of `apart`: 3 x 3."""
    r = numpy.maximum(numpy.sqrt((apart**2).sum(axis=-1)), 1e-3 * math.sqrt(spread))
    x = r / math.sqrt(2.0 * spread)
    whole, edge = special.erf(x), numpy.exp(-x * x) / (math.sqrt(math.pi) * x)
    across = whole * (1.0 + 0.5 / x**2) - edge
    along = whole * (1.0 - 1.5 / x**2) + 3.0 * edge
    unit = apart / r[..., None]
    scale = 1.0 / (8.0 * math.pi * eta * r)
    return (scale * across)[..., None, None] * numpy.eye(3) + (scale * along)[..., None, None] * unit[..., :, None] * unit[..., None, :]


def mobility(shapes, alone, eta, spread):
    """Of chains x vertices x 3: matrices of 3N x 3N; alone: what each vertex has without the field."""
    count, n, _ = shapes.shape
    blocks = smeared_oseen(shapes[:, :, None] - shapes[:, None], eta, spread)
    blocks[:, range(n), range(n)] += alone * numpy.eye(3)
    return blocks.transpose(0, 1, 3, 2, 4).reshape(count, 3 * n, 3 * n)


def spring_forces(shapes, spring):
    bonds = spring * numpy.diff(shapes, axis=1)
    force = numpy.zeros_like(shapes)
    force[:, :-1] += bonds
    force[:, 1:] -= bonds
    return force


def slowing(vertices, chains, time, alone, eta, spread, spring=3.0, dt=0.25, seed=1):
    """(times, share of D_K lost by then, errors, <R^2> over its exact value) of Gaussian chains that start in equilibrium."""
    random = numpy.random.Generator(numpy.random.PCG64(seed))
    x = numpy.cumsum(random.normal(0.0, math.sqrt(1.0 / spring), (chains, vertices, 3)), axis=1)
    drift, kirkwood = [], 0.0
    steps = round(time / dt)
    for _ in range(steps):
        mu = mobility(x, alone, eta, spread)
        velocity = (mu @ spring_forces(x, spring).reshape(chains, -1, 1)).reshape(x.shape)
        drift.append(velocity.mean(axis=1))
        kirkwood += numpy.einsum("cikjk->", mu.reshape(chains, vertices, 3, vertices, 3)) / (3.0 * vertices**2 * chains * steps)
        noise = numpy.linalg.cholesky(mu) @ random.normal(size=(chains, 3 * vertices, 1))
        x = x + velocity * dt + math.sqrt(2.0 * dt) * noise.reshape(x.shape)
    drift, half = numpy.array(drift), steps // 2
    memory = numpy.array([(drift[:half] * drift[lag:half + lag]).mean(axis=(0, 2)) for lag in range(half)])
    lost = (numpy.cumsum(memory, axis=0) - 0.5 * (memory[0] + memory)) * dt / kirkwood
    size = ((x[:, -1] - x[:, 0])**2).sum(axis=1).mean() * spring / (3.0 * (vertices - 1.0))
    return dt * numpy.arange(half), lost.mean(axis=1), lost.std(axis=1, ddof=1) / math.sqrt(chains), size


LAGS = (1.6, 3.2, 6.4, 12.8, 25.6, 51.2, 102.4)


def main():
    from lib import case, dilute
    vertices, chains, time = (int(word) for word in sys.argv[1:4])
    alone = vertices * case.load("chains").sharing(vertices)[0]
    times, lost, error, size = slowing(vertices, chains, time, alone, dilute.ETA, dilute.CELL_SPREAD)
    print(f"N = {vertices}; <R^2> over exact: {size:.3f}")
    summed = numpy.concatenate([[0.0], numpy.cumsum(0.5 * (lost[1:] + lost[:-1]))]) * times[1]  # g(t) is its integral
    for t in LAGS:
        if t <= times[-1]:
            now, off = (float(numpy.interp(t, times, y)) for y in (lost, error))
            print(f"{t:6.1f} t0   {now:.4f} +- {off:.4f}   {float(numpy.interp(t, times, summed)) / t:.4f}", flush=True)


if __name__ == "__main__":
    import pathlib
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
    main()
