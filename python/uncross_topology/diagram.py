"""Crossings and polynomials of closed polygons, asked of `uncross links` (docs/topology.md has the form)."""
import collections
import os
import subprocess

import numpy

from .crossings import Ended

FINE, TOUCHED, SPECIAL, TOO_FAR, TOO_MANY = range(5)  # enum diagram_status, src/topology/diagram.h
WORDS = {TOUCHED: "touches itself or another", SPECIAL: "touches itself or another, or comes too near to tell",
         TOO_FAR: "wider than 2^46 lattice units", TOO_MANY: "too many crossings"}
MOST = 20000  # crossings of a diagram whose polynomial is computed

PRIMES = 2**61 - 1, 2**61 - 31
PLACES = 1234567890123456789, 987654321987654321  # t, beside -1


def places(prime):
    """-1, and each place with its inverse."""
    return [prime - 1] + [place for t in PLACES for place in (t, pow(t, -1, prime))]


FULL = [(t, prime) for prime in PRIMES for t in places(prime)]
SCREEN = [FULL[0], FULL[1]]  # Delta(-1) and Delta at one other place, modulo one prime

# status; crossings; above: of two polygons, how often the first lies above the second, and the reverse; signs: the sums of
# the signs of these; value: [jobs][values], modulo the primes.
Answers = collections.namedtuple("Answers", "status crossings above signs value")


def ask(polygons, jobs, values=(), most=MOST):
    """polygons: list of int64 [vertices][3]. jobs: one array of int64; each is the number of polygons, and for each of them
    its number and its shift, four numbers. values: pairs of t and prime. Without values, crossings of a polygon with itself are
    left out."""
    counts = [len(polygon) for polygon in polygons]
    values = list(values)
    head = numpy.array([len(polygons), len(values), most if values else 2**31 - 1, *counts], dtype=numpy.int64)
    at = numpy.concatenate(polygons) if polygons else numpy.zeros((0, 3))
    parts = [head, at.astype(numpy.int64), numpy.array(values, dtype=numpy.uint64), numpy.asarray(jobs, dtype=numpy.int64)]
    done = subprocess.run([os.environ.get("UNCROSS", "uncross"), "links"], input=b"".join(part.tobytes() for part in parts),
                          stdout=subprocess.PIPE, check=False)
    if done.returncode:
        raise Ended(done.returncode)
    words = numpy.frombuffer(done.stdout, dtype=numpy.int64).reshape(-1, 6 + len(values))
    return Answers(words[:, 0], words[:, 1], words[:, 2:4], words[:, 4:6], words[:, 6:].view(numpy.uint64))


def clean(polygon):
    """A polygon without bonds of no length."""
    polygon = numpy.asarray(polygon, dtype=numpy.int64)
    return polygon[numpy.any(polygon != numpy.roll(polygon, 1, axis=0), axis=1)]
