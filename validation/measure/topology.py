#!/usr/bin/python3
"""What `uncross topology` says of a trajectory, as a table.

usage: topology.py TRAJECTORY crossings > topology.csv     a row for each step: time, crossings, their signs' sum, pairs that touched, bonds
       topology.py TRAJECTORY links > topology.csv         a row for each frame: rings, those with a knot, pairs within reach, linked
                                                       ones; mean square of the distance across half a ring, of the radius of gyration

A ring has a knot if its polynomial is not that of the unknot, or is not known; a pair is linked if its linking number or its
polynomial is not 0. Errors: scatter of rings.
"""
import contextlib
import itertools
import os
import pathlib
import sys

import numpy

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TREE / "python"), str(TREE / "validation")]
os.environ.setdefault("UNCROSS", str(TREE / "build/uncross"))
from lib import stats  # noqa: E402
from uncross_topology import crossings, frame, links, readers  # noqa: E402


def crossed(reader):
    print("time,crossings,net,touched,bonds")
    with contextlib.closing(crossings.Finder(reader.topology)) as finder:
        for first, last in itertools.pairwise(reader.frames()):
            if last.step != first.step + 1:
                sys.exit("topology.py: frames are not of every step")
            found = finder.between(first, last)
            print(f"{last.time:.10g},{len(found.crossings)},{sum(net for _, net in found.count.values())},{len(found.touches)},{len(finder.bonds)}")


def ring_sizes(places):
    """Means and errors over rings [rings, vertices, 3]: of |r_i - r_(i + N/2)|^2, of R_g^2."""
    half = places.shape[1] // 2
    across = ((places - numpy.roll(places, half, axis=1))**2).sum(axis=2).mean(axis=1)
    about = ((places - places.mean(axis=1, keepdims=True))**2).sum(axis=2).mean(axis=1)
    return [number for values in (across, about) for number in stats.mean(values)]


def linked(reader):
    print("time,rings,knots,pairs,linked,R2,R2_error,Rg2,Rg2_error")
    curves = reader.topology.curves
    for one in reader.frames():
        polygons = list(links.polygons_of(one, curves).values())
        knots = sum(knot.name != "0_1" for knot in links.find_knots(polygons))
        pairs, judged = links.find_pairs(one, polygons)
        size = ring_sizes(numpy.array([one.position[curve.vertices] for curve in curves]) / 2**frame.LATTICE_BITS)
        print(f"{one.time:.10g},{len(polygons)},{knots},{judged},{len(pairs)},"
              + ",".join(f"{number:.7g}" for number in size), flush=True)


def main():
    path, what = sys.argv[1:]
    reader = readers.open_file(path, {})
    try:
        {"crossings": crossed, "links": linked}[what](reader)
    finally:
        reader.close()


if __name__ == "__main__":
    main()
