"""What all operators share: the table `model` of a pack, with names."""

from dataclasses import dataclass

import numpy as np

from . import dumbbells as pairs
from . import flow as flows
from . import media


@dataclass
class Model:
    """A system's constants. Arrays have one row per vertex."""

    seed: int
    box: np.ndarray  # cells
    particles: int
    interval: int  # steps between collisions
    forbidden: bool
    exclusion_paper: bool
    dt: float
    cosine: float
    sine: float
    acceleration: np.ndarray
    next: np.ndarray
    prev: np.ndarray
    fiber: np.ndarray
    mass: np.ndarray
    bond_length: np.ndarray
    spring: np.ndarray
    bending: np.ndarray
    constant_force: np.ndarray
    flow: flows.Flow | None = None  # walls or shear
    dumbbells: pairs.Dumbbells | None = None
    radius: np.ndarray | None = None  # of tubes, lattice units; None: all fibers are thin
    blind: np.ndarray | None = None  # bonds, along the fiber
    medium: media.Medium | None = None  # another bath than collision cells

    @property
    def rows(self):
        """Of cells along y: between walls one more than the box has cells."""
        return int(self.box[1]) + (self.flow is not None and self.flow.walls)

    @property
    def cells(self):
        return int(self.box[0]) * self.rows * int(self.box[2])

    @property
    def bonds(self):
        """Numbers of the vertices that have a bond to a next one."""
        return np.flatnonzero(self.next >= 0)


def from_tables(tables):
    """The model of `model.0`: {name of an input: [rows, columns]}."""
    seed_low, seed_high, particles, interval, forbidden, paper = (int(x) for x in tables["numbers"][0])
    reals, vertex, chain = tables["reals"][0], tables["vertex"].reshape(-1, 7), tables["chain"]
    return Model(
        seed=seed_low + (seed_high << 32),
        box=tables["box"][0],
        particles=particles,
        interval=interval,
        forbidden=bool(forbidden),
        exclusion_paper=bool(paper),
        dt=float(reals[0]),
        cosine=float(reals[1]),
        sine=float(reals[2]),
        acceleration=reals[3:6],
        next=chain[:, 0],
        prev=chain[:, 1],
        fiber=chain[:, 2],
        mass=vertex[:, 0],
        bond_length=vertex[:, 1],
        spring=vertex[:, 2],
        bending=vertex[:, 3],
        constant_force=vertex[:, 4:7],
        flow=flows.from_tables(tables),
        dumbbells=pairs.from_tables(tables),
        radius=tables["tubes"][:, 0] if len(tables["tubes"]) else None,
        blind=tables["tubes"][:, 1] if len(tables["tubes"]) else None,
        medium=media.from_tables(tables),
    )
