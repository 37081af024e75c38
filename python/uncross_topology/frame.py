"""One frame of any code's trajectory, and its bonds, on a lattice: what is decided of them is decided in integers.

A position is a whole number of units of 2^-LATTICE_BITS of the file's unit of length. Every claim is of the rounded frames."""
import collections

import numpy

LATTICE_BITS = 32
REACH = 2**58  # lattice units: SEARCH_REACH of src/topology/search.h

# step: int, or None; time: float, or None. On the lattice, as int: edge, three of the box; offset, by how much the image of a
# sheared box beyond y = Ly has slid along x, with all its turns (not modulo Lx). periodic: three bools. rate: lattice units of
# that slide per unit of time, a float, or None if it is not known. position: int64 [N][3], unwrapped.
Frame = collections.namedtuple("Frame", "step time edge periodic offset rate position")

# ids: [N] of the vertices, as the file numbers them, ascending. bonds: int32 [M][2] of rows. curves: None if one vertex has
# more than two bonds.
Topology = collections.namedtuple("Topology", "ids bonds curves")

# vertices: rows in order along the bonds; closed: a bond leads from the last to the first.
Curve = collections.namedtuple("Curve", "vertices closed")


class Refused(Exception):
    """A file, or what was asked of it: the message says what is wrong and what is allowed."""


def on_lattice(values):
    """Real numbers of the file as int64: exact but for the one rounding to the lattice."""
    scaled = numpy.rint(numpy.ldexp(numpy.asarray(values, dtype=float), LATTICE_BITS))
    if not numpy.all(numpy.abs(scaled) < REACH):
        raise Refused(f"a coordinate is no number, or beyond 2^{58 - LATTICE_BITS} units of length")
    return scaled.astype(numpy.int64)


def image(frame, number):
    """The shift, three ints of the lattice, of the image with three whole numbers: the one by ny has slid by ny offsets."""
    (x, y, z), (lx, ly, lz) = map(int, number), frame.edge
    return x * lx + y * frame.offset, y * ly, z * lz


def curves(bonds, count):
    """The curves that bonds make of `count` vertices, those without bonds left out; None if a vertex has more than two."""
    neighbors = [[] for _ in range(count)]
    for a, b in numpy.asarray(bonds).tolist():
        neighbors[a].append(b)
        neighbors[b].append(a)
    if any(len(others) > 2 for others in neighbors):
        return None
    found, seen = [], [False] * count
    for closed in False, True:  # chains from their ends; what is left are rings
        for first in range(count):
            if seen[first] or len(neighbors[first]) != (2 if closed else 1):
                continue
            path, here = [], first
            while here is not None:
                path.append(here)
                seen[here] = True
                here = next((other for other in neighbors[here] if not seen[other]), None)
            found.append(Curve(path, closed))
    return found
