"""Philox 4x32-10, and what is made of its words (docs/conventions.md, "Random numbers have addresses")."""

import math

import numpy as np

from . import elementary

# Purposes. The names are those of the address book.
GRID_SHIFT, AXIS, VERTEX_ORDER, VELOCITY_SWAP, THERMOSTAT = 1, 2, 3, 4, 5
PHANTOM_NUMBER, PHANTOM_VELOCITY, ANDERSEN_PARTICLE, ANDERSEN_VERTEX = 6, 7, 8, 9
BATH_VERTEX, BATH_PAIR = 11, 12
DUMBBELL_CENTER, DUMBBELL_VECTOR = 24, 25

ROUNDS = 10
LOW = np.uint64(0xFFFFFFFF)


def words(seed, purpose, draw, step, entity):
    """Four 32-bit words for each address. All but the seed may be arrays: [...] in, [..., 4] out."""
    address = (np.asarray(x, np.uint64) for x in (purpose, draw, step, entity))
    purpose, draw, step, entity = np.broadcast_arrays(*address)
    c0, c1, c2, c3 = entity & LOW, (purpose + np.uint64(256) * draw) & LOW, step & LOW, step >> np.uint64(32)
    k0, k1 = seed & 0xFFFFFFFF, seed >> 32
    for _ in range(ROUNDS):
        first, second = np.uint64(0xD2511F53) * c0, np.uint64(0xCD9E8D57) * c2
        c0, c1, c2, c3 = (
            (second >> np.uint64(32)) ^ c1 ^ np.uint64(k0),
            second & LOW,
            (first >> np.uint64(32)) ^ c3 ^ np.uint64(k1),
            first & LOW,
        )
        k0, k1 = (k0 + 0x9E3779B9) & 0xFFFFFFFF, (k1 + 0xBB67AE85) & 0xFFFFFFFF
    return np.stack([c0, c1, c2, c3], axis=-1)


def integers(word):
    """The two 64-bit integers of each address: [..., 4] words in, [..., 2] out."""
    return word[..., 0::2] | (word[..., 1::2] << np.uint64(32))


def uniforms(word):
    """The two uniforms of each address, never 0 or 1."""
    return ((integers(word) >> np.uint64(12)).astype(float) + 0.5) * 2.0**-52


def normal_pairs(word):
    """Two normal deviates from the words of each address: [..., 4] in, [..., 2] out."""
    u = uniforms(word)
    radius, (cosine, sine) = np.sqrt(-2.0 * elementary.log(u[..., 0])), elementary.circle_turns(u[..., 1])
    return np.stack([radius * cosine, radius * sine], axis=-1)


def normal_pair(word):
    """The same of one address."""
    return tuple(float(x) for x in normal_pairs(word))


def normals(seed, purpose, step, entities):
    """Three normal deviates for each entity, as three columns: [3, n]."""
    first, second = (normal_pairs(words(seed, purpose, draw, step, entities)) for draw in (0, 1))
    return np.stack([first[:, 0], first[:, 1], second[:, 0]])


def minus_log(high, low):
    """-ln u of u of 40 bits, 32 of the word `high` and the first 8 of `low`: docs/elementary.md, *Three of one draw*."""
    one, root_half = np.uint64(0x3FF0000000000000), np.uint64(0x3FE6A09E667F3BCD)
    u = (one | high << np.uint64(20) | (low & np.uint64(0xFF000000)) >> np.uint64(12)).view(float) - (1.0 - 2.0**-41)
    t = u.view(np.uint64) + (one - root_half)
    e = (t >> np.uint64(52)).astype(float) - 1023.0
    f = ((t & np.uint64(0x000FFFFFFFFFFFFF)) + root_half).view(float) - 1.0
    s = f / (2.0 + f)
    w = s * s
    q = w * w
    odd = 2.0 / 3.0 + q * (2.0 / 7.0 + q * (2.0 / 11.0))
    even = 2.0 + q * (2.0 / 5.0 + q * (2.0 / 9.0 + q * (2.0 / 13.0)))
    return -(e * math.log(2.0)) - s * (even + w * odd)


def three_normals(word):
    """Three normal deviates from the words of each address: [..., 4] in, [..., 3] out."""
    one = np.uint64(0x3FF0000000000000)
    bits = [np.ascontiguousarray(word[..., k]) for k in range(4)]
    a = ((one | (bits[1] & np.uint64(0x3FFFFF)) << np.uint64(30)).view(float) - (1.5 - 2.0**-23)) * (math.pi / 2)
    w = a * a
    q = w * w
    s0 = 1.0 + q * (1 / 120 + q * (1 / 362880 + q * (1 / 6227020800)))
    s1 = -1 / 6 + q * (-1 / 5040 + q * (-1 / 39916800))
    c0 = 1.0 + q * (1 / 24 + q * (1 / 40320 + q * (1 / 479001600)))
    c1 = -1 / 2 + q * (-1 / 720 + q * (-1 / 3628800))
    sine, cosine = a * (s0 + w * s1), c0 + w * c1
    root = np.sqrt(minus_log(bits[0], bits[1]))
    x_sign, y_sign = (1.0 - 2.0 * (bits[1] >> np.uint64(place) & np.uint64(1)).astype(float) for place in (23, 22))

    b = ((one | (bits[3] & np.uint64(0xFFFFFF)) << np.uint64(28)).view(float) - (1.5 - 2.0**-25)) * math.pi
    w = b * b
    q = w * w
    s0 = 1.0 + q * (1 / 120 + q * (1 / 362880 + q * (1 / 6227020800 + q * (1 / 355687428096000))))
    s1 = -1 / 6 + q * (-1 / 5040 + q * (-1 / 39916800 + q * (-1 / 1307674368000)))
    radius = np.sqrt(2.0 * minus_log(bits[2], bits[3]))
    return np.stack(
        [x_sign * (root * (cosine - sine)), y_sign * (root * (cosine + sine)), radius * (b * (s0 + w * s1))], axis=-1
    )


def drawn(seed, purpose, step, entities):
    """Three normal deviates of one draw for each entity: [n, 3]."""
    return three_normals(words(seed, purpose, 0, step, entities))


def axes(seed, purpose, step, entities):
    """A unit vector for each entity, uniform on the sphere (Marsaglia 1972): [n, 3]."""
    entities = np.asarray(entities)
    axis, missing, draw = np.zeros((len(entities), 3)), np.arange(len(entities)), 0
    while len(missing):
        signed = words(seed, purpose, draw, step, entities[missing]).astype(np.uint32).view(np.int32).reshape(-1, 4)
        for pair in (signed[:, :2], signed[:, 2:]):
            u, v = ((pair + 0.5) * 2.0**-31).T
            q = u * u + v * v
            found = (q < 1) & ~axis[missing].any(axis=1)
            root = np.sqrt(1 - q[found])
            axis[missing[found]] = np.stack([2 * u[found] * root, 2 * v[found] * root, 1 - 2 * q[found]], axis=1)
        missing, draw = missing[~axis[missing].any(axis=1)], draw + 1
    return axis


def permutation(seed, purpose, draw, step, n):
    """A random order of 0 .. n - 1 (Fisher and Yates). Products of 64 bits by an index need Python's integers."""
    order = list(range(n))
    deviates = integers(words(seed, purpose, draw, step, np.arange((n + 1) // 2))).ravel()
    for k in range(n - 1, 0, -1):
        other = (k + 1) * int(deviates[k]) >> 64
        order[k], order[other] = order[other], order[k]
    return np.array(order, np.int64)


def gamma(seed, step, cell, shape):
    """A Gamma deviate (Marsaglia and Tsang 2000) from the thermostat's addresses of a cell."""
    d = shape - 1 / 3
    c = 1 / math.sqrt(9 * d)
    attempt = 0
    while True:
        x, _ = normal_pair(words(seed, THERMOSTAT, 2 * attempt, step, cell))
        w = float(uniforms(words(seed, THERMOSTAT, 2 * attempt + 1, step, cell))[0])
        root = 1 + c * x
        v = root * root * root
        if v > 0 and elementary.log(w) < 0.5 * x * x + d - d * v + d * elementary.log(v):
            return d * v
        attempt += 1
