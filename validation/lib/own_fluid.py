#!/usr/bin/python3
"""A solute makes the fluid around itself heavier, and this slows the solute down.

Vertices transfer momentum in collisions, the more the heavier they are. So eta grows with their number per cell (Eq. (31) with
the members' masses, dilute.heavy_fluid), and a little more if they share cells. This also holds inside a coil, for its own
vertices. The loss of D is found from Stokes' equation for a solute that is driven by a unit force, shared by its vertices. The
equation is solved twice: with the viscosity that the vertices make, eta(r) = eta (1 + gain n(r)), on a periodic grid, by
conjugate gradients, and with eta alone. Forces and densities are smeared over one cell, that is half of the variance by which
lib/dilute.py smears a pair of vertices. To first order the loss is 2 int delta eta e:e dr, where e is the rate of strain; all
orders together are a quarter less.

usage: validation/lib/own_fluid.py chain|rod N SHAPES     prints delta D/D of the hydrodynamic part, and its error
"""
import math
import sys

import numpy
from scipy import fft

SPACING = 0.5  # of the grid, a0
AXES = range(3)


class Grid:
    """Fields of a periodic box, in Fourier space."""

    def __init__(self, cells):
        self.cells, self.volume = cells, (cells * SPACING)**3
        whole, half = 2.0 * math.pi * fft.fftfreq(cells, SPACING), 2.0 * math.pi * fft.rfftfreq(cells, SPACING)
        self.waves = (whole, whole, half)
        self.k = numpy.meshgrid(*self.waves, indexing="ij", sparse=True)
        self.square = sum(k * k for k in self.k)
        good = (self.square > 0.0) & numpy.all(numpy.broadcast_arrays(*[abs(k) < 0.999 * math.pi / SPACING for k in self.k]), axis=0)
        self.inverse = numpy.where(good, 1.0 / numpy.where(good, self.square, 1.0), 0.0)  # the shortest have no derivative
        self.twice = numpy.full(half.shape, 2.0)  # a real field has each wave twice, but for those of the two end planes
        self.twice[[0, -1]] = 1.0

    def points(self, points, spread):
        """Points smeared by a Gaussian of variance `spread` per axis."""
        x, y, z = (numpy.exp(-1j * numpy.outer(points[:, axis], self.waves[axis])) for axis in AXES)
        return numpy.einsum("ia,ib,ic->abc", x, y, z, optimize=True) * numpy.exp(-0.5 * spread * self.square)

    def real(self, field):
        return fft.irfftn(field, s=(self.cells,) * 3) / SPACING**3

    def waves_of(self, field):
        return fft.rfftn(field) * SPACING**3

    def product(self, a, b):
        """Integral of the product of two vector fields."""
        return sum(float(((x.conj() * y).real * self.twice).sum()) for x, y in zip(a, b)) / self.volume

    def incompressible(self, field):
        along = sum(self.k[a] * field[a] for a in AXES) * self.inverse
        return [field[a] - self.k[a] * along for a in AXES]

    def stokes(self, force):
        """Flow of a force field where the viscosity is 1 everywhere."""
        return [f * self.inverse for f in self.incompressible(force)]

    def strain(self, flow):
        """Rate of strain in space: (a, b) -> field, a <= b."""
        return {(a, b): self.real(0.5j * (self.k[a] * flow[b] + self.k[b] * flow[a])) for a in AXES for b in range(a, 3)}

    def friction(self, flow, viscosity):
        """The force field that keeps a flow going: -div(2 eta e), without the pressure's part."""
        stress = {key: self.waves_of(2.0 * viscosity * e) for key, e in self.strain(flow).items()}
        return self.incompressible([-1j * sum(self.k[b] * stress[min(a, b), max(a, b)] for b in AXES) for a in AXES])


def flow_of(force, viscosity, grid, accuracy=1e-4):
    """Flow of a force field in a fluid whose viscosity is a field of space. Conjugate gradients; each step as Stokes would
    with viscosity 1."""
    flow = grid.stokes(force)
    rest = [f - w for f, w in zip(grid.incompressible(force), grid.friction(flow, viscosity))]
    ahead = grid.stokes(rest)
    way, left = ahead, grid.product(rest, ahead)
    first = grid.product(force, flow)
    for _ in range(100):
        if left <= accuracy**2 * first:
            return flow
        back = grid.friction(way, viscosity)
        far = left / grid.product(way, back)
        flow = [u + far * w for u, w in zip(flow, way)]
        rest = [r - far * w for r, w in zip(rest, back)]
        ahead = grid.stokes(rest)
        left, before = grid.product(rest, ahead), left
        way = [s + left / before * w for s, w in zip(ahead, way)]
    raise ArithmeticError(f"Stokes' equation: {left:g} of {first:g} is left")


def mobilities(points, grid, spread, gain):
    """((without, with) what its own vertices add, for each direction of the force), times eta."""
    density = grid.points(points, spread)
    viscosity = 1.0 + gain * grid.real(density)
    found = []
    for axis in AXES:
        force = [density / len(points) if a == axis else numpy.zeros_like(density) for a in AXES]
        found.append((grid.product(force, grid.stokes(force)), grid.product(force, flow_of(force, viscosity, grid))))
    return found


def cells_for(size):
    """Cells of a box of ten radii of gyration, 24 a0 at least: a multiple of 16."""
    return 16 * math.ceil(max(24.0, 10.0 * size) / SPACING / 16.0)


def gain_of(shapes, shifts, random):
    """d ln eta/d(vertices per cell) of vertices that share cells as those of these shapes do: a cell of l vertices and n
    solvent particles hands on m - sum m_i^2/m, Eq. (31) with the members' masses."""
    from lib import dilute, theory
    n, weight = dilute.poisson(dilute.PER_CELL)
    alone = float(weight @ (n - 1.0 + (n == 0)))
    total = shared = 0.0
    for points in shapes:
        for shift in random.uniform(size=(shifts, 3)):
            counts = numpy.unique(numpy.floor(points + shift) @ dilute.CELL_NUMBER, return_counts=True)[1]
            heavy, squares = dilute.MASS * counts[:, None] + n, dilute.MASS**2 * counts[:, None] + n
            shared += float(((heavy - squares / heavy) @ weight - alone).sum())
            total += len(points)
    return shared / total / theory.occupancy(dilute.PER_CELL)


def share(draw, size, count, spread, seed=1):
    """(delta D, error), times eta, mean over so many shapes: draw(generator) gives points, size is their radius of gyration.
    Each shape is driven along three axes, so that only shapes scatter, not directions."""
    random, grid = numpy.random.Generator(numpy.random.PCG64(seed)), Grid(cells_for(size))
    shapes = [draw(random) for _ in range(count)]
    gain = gain_of([draw(random) for _ in range(40)], 20, random)
    found = [numpy.mean([without - own for without, own in mobilities(points, grid, spread, gain)]) for points in shapes]
    return float(numpy.mean(found)), float(numpy.std(found, ddof=1) / math.sqrt(count)) if count > 1 else 0.0


def main():
    from lib import case, dilute
    kind, n, shapes = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    if kind == "chain":
        draw, size = lambda random: dilute.gaussian_shape(n, 1.0, random), math.sqrt((n * n - 1.0) / (6.0 * n))
        whole = dilute.cells_chain(n, 0.0)
    else:
        bond = case.load("rods").BOND
        draw, size = lambda random: dilute.rod_shape(n, bond, random), bond * math.sqrt((n * n - 1.0) / 12.0)
        whole = dilute.cells_rod(n, bond, 0.0)
    value, error = share(draw, size, shapes, 0.5 * dilute.CELL_SPREAD)
    print(f"{kind} N = {n}: {value / dilute.ETA / whole:.4f} +- {error / dilute.ETA / whole:.4f}")


if __name__ == "__main__":
    import pathlib
    sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
    main()
