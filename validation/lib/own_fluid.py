#!/usr/bin/python3
"""A solute makes the fluid around itself heavier, and is slower for it.

Vertices hand on momentum in collisions, the more the heavier they are: eta grows with their number per cell (Eq. (31) with the
members' masses, dilute.heavy_fluid). That is so in a coil, too, where its own vertices are. To first order in what they add to
the viscosity, a solute that is driven by a unit force, shared by its vertices, loses

    delta D = 2 int delta eta(r) e(r):e(r) dr,

e being the rate of strain of the flow without it. The flow is Oseen's, on a periodic grid; forces and densities are smeared over
half of what lib/dilute.py smears a pair of vertices by, that is, over one cell.

usage: validation/lib/own_fluid.py chain|rod N SHAPES     prints delta D/D of the hydrodynamic part, and its error
"""
import math
import sys

import numpy

SPACING = 0.5  # of the grid, a0


class Grid:
    """Wave vectors of a periodic box, and what Oseen's field needs of them."""

    def __init__(self, cells):
        self.cells, self.volume = cells, (cells * SPACING)**3
        wave = 2.0 * math.pi * numpy.fft.fftfreq(cells, SPACING)
        self.wave, self.k = wave, numpy.meshgrid(wave, wave, wave, indexing="ij")
        square = sum(k * k for k in self.k)
        self.inverse = numpy.where(square > 0.0, 1.0 / numpy.where(square > 0.0, square, 1.0), 0.0)
        self.square = square

    def density(self, points, spread):
        """Fourier transform of points smeared by a Gaussian of variance `spread` per axis."""
        x, y, z = (numpy.exp(-1j * numpy.outer(points[:, axis], self.wave)) for axis in range(3))
        return numpy.einsum("ia,ib,ic->abc", x, y, z, optimize=True) * numpy.exp(-0.5 * spread * self.square)

    def real(self, field):
        return numpy.fft.ifftn(field).real / SPACING**3


def loss(points, grid, spread, others=0.0):
    """(mobility, what of it the density of vertices takes per unit of d ln eta/d density) times eta, for a unit force along z;
    a0 = 1. Of the flow that the smeared force makes. others: density of others, the same everywhere."""
    density = grid.density(points, spread)
    force = density / len(points)
    kx, ky, kz = grid.k
    along = grid.inverse * force
    flow = [-kx * kz * grid.inverse * along, -ky * kz * grid.inverse * along, along - kz * kz * grid.inverse * along]
    mobility = float((force.conj() * flow[2]).real.sum() / grid.volume)
    strain = sum(grid.real(0.5j * (grid.k[a] * flow[b] + grid.k[b] * flow[a]))**2 for a in range(3) for b in range(3))
    return mobility, float(2.0 * ((grid.real(density) + others) * strain).sum() * SPACING**3)


def cells_for(size):
    """Cells of a box of ten radii of gyration, 24 a0 at least: a multiple of 16."""
    return 16 * math.ceil(max(24.0, 10.0 * size) / SPACING / 16.0)


def share(draw, size, shapes, spread, gain, seed=1):
    """(delta D, error), times eta, mean over shapes: draw(generator) gives points, size is their radius of gyration, gain is
    d ln eta/d(vertices per cell)."""
    random, grid = numpy.random.Generator(numpy.random.PCG64(seed)), Grid(cells_for(size))
    found = [gain * loss(draw(random), grid, spread)[1] for _ in range(shapes)]
    return float(numpy.mean(found)), float(numpy.std(found, ddof=1) / math.sqrt(shapes))


def main():
    from lib import claim, dilute
    kind, n, shapes = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    gain = (dilute.heavy_fluid(1e-6)[0] / dilute.ETA - 1.0) / 1e-6
    if kind == "chain":
        draw, size = lambda random: dilute.gaussian_shape(n, 1.0, random), math.sqrt((n * n - 1.0) / (6.0 * n))
        whole = dilute.cells_chain(n, 0.0)
    else:
        bond = claim.load("rods").BOND
        draw, size = lambda random: dilute.rod_shape(n, bond, random), bond * math.sqrt((n * n - 1.0) / 12.0)
        whole = dilute.cells_rod(n, bond, 0.0)
    value, error = share(draw, size, shapes, 0.5 * dilute.CELL_SPREAD, gain)
    print(f"{kind} N = {n}: {value / dilute.ETA / whole:.4f} +- {error / dilute.ETA / whole:.4f}")


if __name__ == "__main__":
    import pathlib
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
    main()
