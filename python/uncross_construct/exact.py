"""Crossings, contacts and random numbers in exact arithmetic, by docs/conventions.md and docs/port/ alone. Vectors are tuples."""

CELL = 1 << 40  # lattice units
TICKS = 65536


def plus(a, b, factor=1):
    return tuple(x + factor * y for x, y in zip(a, b))


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def times(factor, a):
    return tuple(factor * x for x in a)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


# --- does a move cross a bond? ---


def determinant(p, q, r):
    """As docs/conventions.md writes it: of integers exact, of floats rounded at each operation."""
    return (r[0] * (p[1] * q[2] - p[2] * q[1]) + r[1] * (p[2] * q[0] - p[0] * q[2])) + r[2] * (p[0] * q[1] - p[1] * q[0])


def determinants(start, end, pivot, a, b):
    """The five of the test: first volume at start and end, path, sides of a and of b, as triples of differences."""
    ab, arm, move, leg = minus(b, a), minus(pivot, a), minus(end, start), minus(pivot, start)
    return ((ab, arm, minus(start, a)), (ab, arm, minus(end, a)), (ab, minus(start, a), minus(end, a)),
            (move, leg, minus(a, start)), (move, leg, minus(b, start)))


def verdict(signs, flip):
    """Whether the move crosses, from the five determinants: numbers, or arrays of them."""
    before, after, path, of_a, of_b = signs
    side = before > 0 if flip else before >= 0
    return (side != (after > 0 if flip else after >= 0)) & ((path >= 0) == side) & ((of_a >= 0) != (of_b >= 0))


# --- do two bonds in flight touch? ---


def coefficients(a, b):
    """Of the volume over an interval with p, q, w at its ends; two of them times 3."""
    triples = [((a, a, a),), ((b, a, a), (a, b, a), (a, a, b)), ((b, b, a), (b, a, b), (a, b, b)), ((b, b, b),)]
    return [sum(dot(cross(k[0][0], k[1][1]), k[2][2]) for k in triple) for triple in triples]


def one_sign(values):
    return all(x > 0 for x in values) or all(x < 0 for x in values)


def has_plane(points):
    """Is there d with d.x > 0 for all points? By the elimination of Fourier and Motzkin: one component of d at a time."""
    rows = [list(point) for point in points]
    for axis in range(3):
        above, below = [r for r in rows if r[axis] > 0], [r for r in rows if r[axis] < 0]
        rows = [r for r in rows if r[axis] == 0]
        rows += [[-n[axis] * x + p[axis] * y for x, y in zip(p, n)] for p in above for n in below]
        if any(not any(r) for r in rows):  # 0 > 0
            return False
        rows = [list(r) for r in {tuple(r) for r in rows}]
    return True


def at_tick(row, tick):
    """p, q and w of a row (p, q, w and their rates)."""
    return [plus(row[k], row[3 + k], tick) for k in range(3)]


def is_excluded(row, first, last):
    a, b = at_tick(row, first), at_tick(row, last)
    points = [x for p, q, w in (a, b) for x in (w, plus(w, q), minus(w, p), minus(plus(w, q), p))]
    return one_sign(coefficients(a, b)) or has_plane(points)


def first_contact(row, first, last=TICKS):
    """The first tick in which the bonds may touch; TICKS if there is none."""
    if not any(any(rate) for rate in row[3:]) or is_excluded(row, first, last):
        return TICKS
    if last - first == 1:
        return first
    middle = (first + last) // 2
    tick = first_contact(row, first, middle)
    return tick if tick < TICKS else first_contact(row, middle, last)


# --- random numbers ---


def philox(seed, purpose, draw, step, entity):
    """The four words of an address."""
    c, key = [entity, purpose + 256 * draw, step & 0xFFFFFFFF, step >> 32], [seed & 0xFFFFFFFF, seed >> 32]
    for _ in range(10):
        a, b = 0xD2511F53 * c[0], 0xCD9E8D57 * c[2]
        c = [b >> 32 ^ c[1] ^ key[0], b & 0xFFFFFFFF, a >> 32 ^ c[3] ^ key[1], a & 0xFFFFFFFF]
        key = [(key[0] + 0x9E3779B9) & 0xFFFFFFFF, (key[1] + 0xBB67AE85) & 0xFFFFFFFF]
    return c


def deviates(seed, purpose, draw, step, size):
    """The 64-bit integers of a permutation of so many."""
    words = [w for k in range((size + 1) // 2) for w in philox(seed, purpose, draw, step, k)]
    return [words[2 * k] | words[2 * k + 1] << 32 for k in range(size)]


def permuted(numbers, index=lambda r, n: r * n >> 64):
    """Fisher and Yates. index: of an integer r among n."""
    order = list(range(len(numbers)))
    for k in range(len(numbers) - 1, 0, -1):
        other = min(index(numbers[k], k + 1), k)
        order[k], order[other] = order[other], order[k]
    return order
