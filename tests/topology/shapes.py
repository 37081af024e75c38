"""Knots and links whose polynomial is known from elsewhere: closed braids, by Burau's matrices; torus knots and links."""
import math

import numpy

# --- Burau ----------------------------------------------------------------------------------------------------------------
# Alexander's polynomial of a closed braid of n strands is det(1 - B(t)) (1 - t) / (1 - t^n), B being the product of the reduced Burau
# matrices of its letters (W. Burau, Abh. Math. Sem. Univ. Hamburg 11, 179 (1935); J. S. Birman, Braids, Links, and Mapping Class Groups
# (1974), section 3.3). Here at one t, modulo a prime. It knows nothing of arcs and crossings.


def burau(letter, n, t, prime):
    """Letter k, 1 to n - 1, or -k for its inverse."""
    matrix = [[int(i == j) for j in range(n - 1)] for i in range(n - 1)]
    k, inverse = abs(letter) - 1, pow(t, -1, prime)
    row = {0: -inverse, -1: 1, 1: inverse} if letter < 0 else {0: -t, -1: t, 1: 1}
    for step, value in row.items():
        if 0 <= k + step < n - 1:
            matrix[k][k + step] = value % prime
    return matrix


def product(a, b, prime):
    return [[sum(x * y for x, y in zip(row, column)) % prime for column in zip(*b)] for row in a]


def determinant(matrix, prime):
    rows, value = [list(row) for row in matrix], 1
    for k in range(len(rows)):
        pivot = next((i for i in range(k, len(rows)) if rows[i][k]), None)
        if pivot is None:
            return 0
        rows[k], rows[pivot] = rows[pivot], rows[k]
        value = value * rows[k][k] * (-1 if pivot != k else 1) % prime
        scale = pow(rows[k][k], -1, prime)
        for i in range(k + 1, len(rows)):
            factor = rows[i][k] * scale % prime
            rows[i] = [(a - factor * b) % prime for a, b in zip(rows[i], rows[k])]
    return value


def alexander(word, n, t, prime):
    """Delta(t) of the closed braid up to +-t^m. Of an even number of strands with one more (A. A. Markov's move), as 1 - t^n is 0 at -1."""
    if n % 2 == 0:
        word, n = [*word, n], n + 1
    matrix = [[int(i == j) for j in range(n - 1)] for i in range(n - 1)]
    for letter in word:
        matrix = product(matrix, burau(letter, n, t, prime), prime)
    less = [[(int(i == j) - matrix[i][j]) % prime for j in range(n - 1)] for i in range(n - 1)]
    return determinant(less, prime) * (1 - t) * pow(1 - pow(t, n, prime), -1, prime) % prime


# --- polygons -------------------------------------------------------------------------------------------------------------


def closed_braid(word, n):
    """Its components, real polygons about the z axis: strands at radii 3, 4, ...; letter k crosses strands k - 1 and k, within a part of a turn."""
    sectors = max(24, len(word))
    strands, where = [[] for _ in range(n)], list(range(n))  # where[place] = strand
    for sector in range(sectors):
        letter = word[sector] if sector < len(word) else 0
        for place, strand in enumerate(where):
            angle = 2 * math.pi * sector / sectors
            points = [(3 + place, angle, 0)]
            k = abs(letter)
            if letter and place in (k - 1, k):
                up = (place == k - 1) == (letter > 0)
                points.append((3 + k - 0.5, angle + math.pi / sectors, 1 if up else -1))
            strands[strand] += [(r * math.cos(a), r * math.sin(a), z) for r, a, z in points]
        if letter:
            where[k - 1], where[k] = where[k], where[k - 1]
    components, seen = [], set()
    goes_on = {strand: place for place, strand in enumerate(where)}  # the strand that begins where this one ends
    for strand in range(n):
        polygon = []
        while strand not in seen:
            seen.add(strand)
            polygon += strands[strand]
            strand = goes_on[strand]
        if polygon:
            components.append(numpy.array(polygon))
    return components


def torus(p, q, vertices=None):
    """The torus knot or link T(p, q), p times around the z axis: gcd(p, q) components on a torus of radii 2 and 1."""
    number = math.gcd(p, q)
    p, q, found = p // number, q // number, []
    for k in range(number):
        t = 2 * math.pi * numpy.arange(vertices or 30 * p + 8 * q) / (vertices or 30 * p + 8 * q)
        small = q * t + 2 * math.pi * k / number
        r = 2 + numpy.cos(small)
        found.append(numpy.stack([r * numpy.cos(p * t), r * numpy.sin(p * t), -numpy.sin(small)], axis=1))
    return found


def turned(rng):
    """A rotation at random."""
    matrix, upper = numpy.linalg.qr(rng.normal(size=(3, 3)))
    matrix = matrix * numpy.sign(numpy.diag(upper))
    return matrix * numpy.linalg.det(matrix)


def gauss(one, other):
    """Gauss's integral of two closed polygons, over 4 pi: the solid angles of pairs of bonds (T. Banchoff, Indiana Univ. Math. J. 25, 1171
    (1976); K. Klenin, J. Langowski, Biopolymers 54, 307 (2000), method 1a)."""
    a, c = one[:, None], other[None]
    b, d = numpy.roll(one, -1, axis=0)[:, None], numpy.roll(other, -1, axis=0)[None]
    r13, r14, r23, r24 = c - a, d - a, c - b, d - b
    normal = [numpy.cross(x, y) for x, y in ((r13, r14), (r14, r24), (r24, r23), (r23, r13))]
    normal = [x / numpy.maximum(numpy.linalg.norm(x, axis=-1, keepdims=True), 1e-300) for x in normal]
    angle = sum(numpy.arcsin(numpy.clip(numpy.sum(normal[k] * normal[(k + 1) % 4], axis=-1), -1, 1)) for k in range(4))
    sign = numpy.sign(numpy.sum(numpy.cross(d - c, b - a) * r13, axis=-1))
    return numpy.sum(sign * angle) / (4 * math.pi)
