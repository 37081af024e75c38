#!/usr/bin/python3
"""Puts the vertices of a checkpoint on a grid of a0/4, up to three boxes away, and every second particle on faces of cells.

Moves of 32 steps of 2^-7 t0 at 1 a0/t0 are one spacing of that grid: full of determinants that are zero, and of hits at
the same time. The solvent is at rest, so that it stays on the faces of the first collision's cells. In a box of two cells fibers along x
of long bonds meet their own images: the image of the bond after the next.

usage: coarse.py CHECKPOINT PACK SEED [along]  PACK: of the scene that starts from this checkpoint, as it was before; along: along x
"""

import struct
import sys
from pathlib import Path

import h5py
import numpy as np
import xxhash

from uncross_port import lattice, pack, solvent, step
from uncross_port.operators import model_of

GRID = lattice.CELL // 4


SEAL = b"uncross seal v1\n"


def set_seal(path):
    """Writes the seal of docs/files.md behind the data, in the place of the old one if that is still there."""
    data = path.read_bytes()
    if data[-32:-16] == SEAL:
        data = data[:-32]
    path.write_bytes(data + SEAL + struct.pack("<QQ", len(data), xxhash.xxh64(data).intdigest()))


def set_state(path, **tables):
    """Writes tables of a checkpoint anew, with the checksums and the seal that docs/files.md asks for."""
    with h5py.File(path, "r+") as file:
        state = file["state"]
        for name, values in tables.items():
            state[name][...] = values
            state[name].attrs.modify("xxh64", np.uint64(xxhash.xxh64(state[name][:].tobytes()).intdigest()))
        system = step.System.__new__(step.System)
        system.solvent, system.solvent_velocity = state["solvent_position"][:], state["solvent_velocity"][:]
        system.vertex, system.vertex_velocity = state["vertex_position"][:], state["vertex_velocity"][:]
        system.finished, system.lag = int(state.attrs["step"]), int(state.attrs["solvent_lag"])
        file["head"].attrs.modify("state_hash", np.uint64(int(system.state_hash(), 16)))
        file["head"].attrs.modify("state_digest", np.uint64(int(system.digest(), 16)))
    set_seal(Path(path))


def on_faces(fresh, draw):
    """Positions of the solvent of a pack, every second one at the corner of a cell of the first collision."""
    constants, given = model_of(fresh), fresh["bin", 1]["in.solvent"].copy()
    corners = draw.integers(0, constants.box, given.shape) * lattice.CELL - solvent.grid_shift(constants, 1)
    given[::2] = lattice.wrap(corners, constants.box)[::2]
    return given


def rewrite(start, packed, seed, along=False):
    """Writes the state of a checkpoint anew."""
    draw, fresh = np.random.default_rng(seed), pack.read(packed)
    with h5py.File(start) as file:
        bonds = file["structure/bonds"][:]
        vertices, particles = file["state/vertex_position"].shape[0], file["state/solvent_position"].shape[0]
    edge = 4 * model_of(fresh).box
    position = draw.integers(-4, 4, (vertices, 3)) + edge * draw.integers(-3, 4, (vertices, 3))
    for first, second in bonds:
        position[second] = position[first] + ([3, *draw.integers(-1, 2, 2)] if along else draw.integers(-2, 3, 3))
    set_state(
        start,
        vertex_position=position * GRID,
        vertex_velocity=draw.integers(-1, 2, (vertices, 3)) * 1.0,
        solvent_velocity=np.zeros((particles, 3)),
        solvent_position=on_faces(fresh, draw),
    )


if __name__ == "__main__":
    rewrite(sys.argv[1], sys.argv[2], int(sys.argv[3]), sys.argv[4:] == ["along"])
