#!/usr/bin/python3
"""Second and third virial coefficients of hard spherocylinders, by random insertion, with nothing of the program.

usage: rods_b3.py LENGTH DIAMETER [PAIRS]

B2 = V P(two overlap)/2, and B3 = V^2 P(all three pairs of three overlap)/3, for rods whose centers lie in a cube of volume V
around the first. Prints B2, its exact value, and B3 over the square of a rod's volume with its error; docs/thick.md.
"""
import sys

import numpy


def unit_vectors(dice, n):
    v = dice.normal(size=(n, 3))
    return v / numpy.linalg.norm(v, axis=1)[:, None]


def squared_distance(p, q, w):
    """Of the segments from 0 along p, and from w along q."""
    def from_edge(corner, edge):
        t = numpy.clip(-(corner * edge).sum(1) / (edge * edge).sum(1), 0, 1)
        return ((corner + t[:, None] * edge) ** 2).sum(1)

    least = numpy.min([from_edge(w, q), from_edge(w - p, q), from_edge(w, -p), from_edge(w + q, -p)], axis=0)
    n = numpy.cross(p, q)
    square, s, t = (n * n).sum(1), (numpy.cross(w, q) * n).sum(1), (numpy.cross(w, p) * n).sum(1)
    inside = (s > 0) & (s < square) & (t > 0) & (t < square)
    return numpy.where(inside, numpy.minimum(least, (w * n).sum(1) ** 2 / numpy.maximum(square, 1e-300)), least)


def main():
    length, diameter = float(sys.argv[1]), float(sys.argv[2])
    pairs, again = int(sys.argv[3]) if len(sys.argv) > 3 else 1500000, 12
    dice, half = numpy.random.default_rng(7), length + diameter
    volume = (2 * half) ** 3
    rod = numpy.pi / 4 * diameter**2 * length + numpy.pi / 6 * diameter**3

    def draw(n):
        u = unit_vectors(dice, n) * length
        return u, dice.uniform(-half, half, (n, 3)) - u / 2

    first = unit_vectors(dice, pairs) * length
    second, start = draw(pairs)
    hit = squared_distance(first, second, start + first / 2) <= diameter**2
    share, one, two, at = hit.mean(), first[hit], second[hit], start[hit]
    shares = []
    for _ in range(again):
        three, its = draw(len(one))
        both = squared_distance(one, three, its + one / 2) <= diameter**2
        shares.append((squared_distance(two[both], three[both], its[both] - at[both]) <= diameter**2).sum() / len(one))
    exact = 2 / 3 * numpy.pi * diameter**3 + numpy.pi * length * diameter**2 + numpy.pi / 4 * length**2 * diameter
    third = volume**2 / 3 * share * numpy.array(shares) / rod**2
    error = numpy.hypot(third.std(ddof=1) / again**0.5, third.mean() * ((1 - share) / (share * pairs)) ** 0.5)
    print(f"B2 {share * volume / 2:.4f} (exact {exact:.4f}) a0^3, B2/v {exact / rod:.4f}, B3/v^2 {third.mean():.2f} +- {error:.2f}")


main()
