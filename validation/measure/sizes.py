#!/usr/bin/python3
"""How often the end-to-end distance of a chain lies in each of several ranges.

usage: sizes.py TRAJECTORY EDGE ... > sizes.csv

EDGE ...: the edges between the ranges, a0. A row for each range: the share of all chains and frames that lie in it, and its error, the scatter
of chains, each averaged over its frames.
"""
import sys

import h5py
import numpy


def distances(file):
    """[frames, chains], all chains being of one length."""
    places = file["particles/trajectory/position/value"][:]
    count = places.shape[1] - len(file["connectivity/bonds"])
    chains = places.reshape(len(places), count, -1, 3)
    return numpy.linalg.norm(chains[:, :, -1] - chains[:, :, 0], axis=-1)


def main(path, *edges):
    with h5py.File(path) as file:
        found = distances(file)
    rank = numpy.searchsorted([float(edge) for edge in edges], found)
    print("range,share,share_error,frames")
    for number in range(len(edges) + 1):
        own = (rank == number).mean(axis=0)
        print(f"{number},{own.mean():.6g},{own.std(ddof=1) / len(own)**0.5:.3g},{len(found)}")


if __name__ == "__main__":
    main(*sys.argv[1:])
