"""Logarithm, exponential, cosine, sine and error function in IEEE operations of a fixed order (docs/elementary.md).

NumPy rounds + - * / and sqrt of doubles as IEEE 754 says, each by itself, so the bits are those of uncross. Arguments may be
arrays of any shape."""

from fractions import Fraction
from math import factorial

import numpy as np

ROUND = 1.5 * 2.0**52
LN2, LN2_REST = (float.fromhex(x) for x in ("0x1.62e42fefa38p-1", "0x1.ef35793c7673p-45"))
QUARTER, QUARTER_REST = (float.fromhex(x) for x in ("0x1.921fb54p+0", "0x1.10b4611a62633p-30"))
DEGREE, DEGREE_REST = (float.fromhex(x) for x in ("0x1.1df46a4p-6", "-0x1.ad62c6ea3e274p-34"))
PER_LN2, PER_ROOT_PI = (float.fromhex(x) for x in ("0x1.71547652b82fep+0", "0x1.20dd750429b6dp+0"))
UPPER_26_BITS = 0xFFFFFFFFF8000000


def bits(x):
    return np.asarray(x, float).view(np.uint64)


def from_bits(word):
    return np.asarray(word, np.uint64).view(float)


def u64(number):
    return np.uint64(number)


def horner(w, coefficients):
    """c0 + w (c1 + w (c2 + ...)), summed from the last term."""
    result = np.full_like(w, coefficients[-1])
    for c in coefficients[-2::-1]:
        result = c + w * result
    return result


def inverse_factorials(*numbers):
    """1/n! of each, rounded once; a negative n stands for -1/n!."""
    return [float(Fraction(1 if n > 0 else -1, factorial(abs(n)))) for n in numbers]


def log(x):
    x = np.asarray(x, float)
    one, root_half = 0x3FF0000000000000, 0x3FE6A09E667F3BCD
    t = bits(x) + u64(one - root_half)
    e = from_bits((t >> u64(52)) | u64(0x4330000000000000)) - (2.0**52 + 1023.0)
    f = from_bits((t & u64(0x000FFFFFFFFFFFFF)) + u64(root_half)) - 1.0
    h, s = 0.5 * f * f, f / (2.0 + f)
    z = s * s
    w = z * z
    odd = horner(w, [2.0 / n for n in (3, 7, 11, 15, 19)])
    even = horner(w, [2.0 / n for n in (5, 9, 13, 17, 21)])
    rest = s * (h + (z * odd + w * even)) - h
    whole = e * LN2
    total = whole + f
    lost = (whole - total) + f
    return total + (rest + (lost + e * LN2_REST))


def exp(x):
    x = np.asarray(x, float)
    inside = np.where((x >= -708.0) & (x <= 709.0), x, 0.0)
    turned = inside * PER_LN2 + ROUND
    n = turned - ROUND
    near, rest = inside - n * LN2, n * LN2_REST
    r = near - rest
    lost, w = (near - r) - rest, r * r
    even = horner(w, inverse_factorials(2, 4, 6, 8, 10, 12))
    odd = horner(w, inverse_factorials(3, 5, 7, 9, 11, 13))
    less_one = r + (lost + w * (even + r * odd))
    result = (1.0 + less_one) * from_bits((bits(turned) + u64(1023)) << u64(52))
    return np.where(x < -708.0, 0.0, np.where(x > 709.0, np.inf, np.where(np.isnan(x), x, result)))


def circle(t, high, low, quarters):
    """(cosine, sine) at angle quarters pi/2 + t (high + low)."""
    t1 = from_bits(bits(t) & u64(UPPER_26_BITS))
    t2 = t - t1
    exact, rest = t1 * high, t2 * high + t * low
    x = exact + rest
    lost, z = rest - (x - exact), x * x
    w = z * z
    s0, s1 = horner(w, inverse_factorials(-3, -7, -11, -15)), horner(w, inverse_factorials(5, 9, 13, 17))
    c0, c1 = horner(w, inverse_factorials(4, 8, 12, 16)), horner(w, inverse_factorials(-6, -10, -14))
    along = x + (lost + x * (z * (s0 + z * s1)))
    h = 0.5 * z
    less = 1.0 - h
    across = less + (((1.0 - less) - h) + (w * (c0 + z * c1) - x * lost))
    odd = (quarters & u64(1)) == 1
    sine = np.where(odd, across, along) * np.where(quarters & u64(2), -1.0, 1.0) + 0.0
    cosine = np.where(odd, along, across) * np.where((quarters + u64(1)) & u64(2), -1.0, 1.0) + 0.0
    return cosine, sine


def circle_turns(u):
    quarters = 4.0 * np.asarray(u, float)
    turned = quarters + ROUND
    return circle(quarters - (turned - ROUND), QUARTER, QUARTER_REST, bits(turned))


def circle_degrees(angle):
    angle = np.asarray(angle, float)
    turned = angle / 90.0 + ROUND
    return circle(angle - 90.0 * (turned - ROUND), DEGREE, DEGREE_REST, bits(turned))


def bell(a):
    """exp(-a^2)"""
    b = from_bits(bits(a) & u64(UPPER_26_BITS))
    return exp(-(b * b)) * exp(-((a - b) * (a + b)))


def erf(x):
    x = np.asarray(x, float)
    a = np.minimum(np.abs(x), 6.0)
    near, far = np.minimum(a, 0.875), np.maximum(a, 0.875)
    y, series, fraction = near * near, np.ones_like(near), far.copy()
    for n in range(20, 1, -1):
        series = 1.0 - y * (2.0 * n - 1.0) / (n * (2.0 * n + 1.0)) * series
    for n in range(280, 0, -1):
        fraction = far + 0.5 * n / fraction
    p = PER_ROOT_PI * near
    of_near = p - p * (y / 3.0 * series)
    of_far = 1.0 - 0.5 * PER_ROOT_PI * bell(far) / fraction
    result = np.where(a < 0.875, of_near, np.where(a < 6.0, of_far, 1.0))
    return np.where(x < 0.0, -result, result)
