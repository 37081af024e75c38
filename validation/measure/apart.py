#!/usr/bin/python3
"""What Kirkwood's sum needs of the shapes of chains: (1/N^2) sum_{i != j} <f(r_ij)> from a trajectory, f = 1/r, and where spheres
overlap, r < 2a, (1 - r/4a)/a (Rotne, Prager and Yamakawa). Times a it is the part of D/D0 beyond 1/N.

usage: apart.py TRAJECTORY.H5 RADIUS

Printed is a CSV table `inverse,error,frames`. The error is the scatter of ten parts of the frames.
"""
import pathlib
import sys

import h5py
import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from lib import dilute  # noqa: E402

PARTS = 10


def chains(file):
    """Places [frames, chains, vertices, 3], all chains being of one length, and bonds that join neighboring numbers."""
    places = file["particles/trajectory/position/value"][:]
    bonds = len(file["connectivity/bonds"]) if "connectivity/bonds" in file else None
    vertices = places.shape[1]
    count = vertices - bonds
    return places.reshape(len(places), count, vertices // count, 3)


def inverse(places, radius):
    """Of each frame."""
    size = places.shape[2]
    total = 0.0
    for apart in range(1, size):
        distance = numpy.linalg.norm(places[:, :, apart:] - places[:, :, :-apart], axis=-1)
        total = total + 2.0 * dilute.monomer_pair(distance, radius).sum(axis=2).mean(axis=1)
    return total / size ** 2


def main():
    with h5py.File(sys.argv[1]) as file:
        values = inverse(chains(file), float(sys.argv[2]))
    values = values[len(values) // 10:]
    parts = numpy.array([part.mean() for part in numpy.array_split(values, PARTS)])
    print(f"inverse,error,frames\n{values.mean():.6g},{parts.std(ddof=1) / PARTS ** 0.5:.2g},{len(values)}")


if __name__ == "__main__":
    main()
