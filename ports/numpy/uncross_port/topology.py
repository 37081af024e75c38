"""The operator `meeting` (docs/topology.md): two bonds between two frames, decided in whole numbers and fractions.

Polynomials are lists of coefficients, the constant first. What a polynomial's sign is at another one's root is counted by Sturm's
sequences (Tarski; Basu, Pollack and Roy, Algorithms in Real Algebraic Geometry, 2.2.2): no root is ever computed."""

from fractions import Fraction

APART, CROSSED, TOUCHED = 0, 1, 2


def poly_trim(a):
    while a and a[-1] == 0:
        a.pop()
    return a


def poly_plus(a, b, factor=1):
    return poly_trim([x + factor * y for x, y in zip(a + [0] * (len(b) - len(a)), b + [0] * (len(a) - len(b)))])


def poly_times(a, b):
    product = [0] * max(len(a) + len(b) - 1, 0)
    for j, x in enumerate(a):
        for k, y in enumerate(b):
            product[j + k] += x * y
    return poly_trim(product)


def poly_dot(a, b):
    return poly_plus(poly_plus(poly_times(a[0], b[0]), poly_times(a[1], b[1])), poly_times(a[2], b[2]))


def poly_cross(a, b):
    return [poly_plus(poly_times(a[j], b[k]), poly_times(a[k], b[j]), -1) for j, k in ((1, 2), (2, 0), (0, 1))]


def poly_divide(a, b):
    """Quotient and remainder."""
    a, quotient = [Fraction(x) for x in a], []
    while len(a) >= len(b):
        factor, shift = a[-1] / b[-1], len(a) - len(b)
        quotient.append(factor)
        a = [x - factor * (b[k - shift] if k >= shift else 0) for k, x in enumerate(a)][:-1]
    return quotient[::-1], poly_trim(a)


def poly_common(a, b):
    """The greatest common divisor."""
    while b:
        a, b = b, poly_divide(a, b)[1]
    return a


def poly_slope(a):
    return [k * x for k, x in enumerate(a)][1:]


def poly_value(a, t):
    return sum((x * t**k for k, x in enumerate(a)), Fraction(0))


def sign_of(x):
    return (x > 0) - (x < 0)


def signs_at_roots(f, g, low, high):
    """Sum of the signs of g at the roots of f between low and high, neither of which is one. f has simple roots only."""
    chain = [f, poly_divide(poly_times(poly_slope(f), g), f)[1]]
    while chain[-1]:
        chain.append([-x for x in poly_divide(chain[-2], chain[-1])[1]])

    def changes_of_sign(t):
        signs = [s for s in (sign_of(poly_value(a, t)) for a in chain) if s]
        return sum(x != y for x, y in zip(signs, signs[1:]))

    return changes_of_sign(low) - changes_of_sign(high)


def isolated_roots(f, low, high):
    """Intervals of one root each, in order, of a polynomial with simple roots, none of them at the ends."""
    count = signs_at_roots(f, [1], low, high) if len(f) > 1 else 0
    if count < 2:
        return [(low, high)] * count
    middle = next(t for t in (low + (high - low) * Fraction(k, 11) for k in (5, 6, 4, 7)) if poly_value(f, t) != 0)
    return isolated_roots(f, low, middle) + isolated_roots(f, middle, high)


def bonds_meet(first, last):
    """Class and signs of vectors p, q, w at both frames."""
    p, q, w = ([poly_trim([int(a), int(b) - int(a)]) for a, b in zip(*ends)] for ends in zip(first, last))
    n = poly_cross(p, q)
    f, square = poly_dot(n, w), poly_dot(n, n)
    s, other = poly_dot(poly_cross(w, q), n), poly_dot(poly_cross(w, p), n)
    within = [s, poly_plus(square, s, -1), other, poly_plus(square, other, -1)]
    touched, signs = False, []
    for end in (0, 1):
        if poly_value(f, end) == 0:
            touched |= min(poly_value(a, end) for a in within) >= 0
        while f and poly_value(f, end) == 0:
            f = poly_divide(f, [-end, 1])[0]
    repeated = poly_common(f, poly_slope(f)) if f else []
    simple = poly_divide(f, repeated)[0] if repeated else f
    for low, high in isolated_roots(simple, Fraction(0), Fraction(1)):
        places = [signs_at_roots(simple, a, low, high) for a in within]
        way = signs_at_roots(simple, poly_slope(f), low, high)
        if min(places) > 0 and way:
            signs.append(way)
        else:
            touched |= min(places) >= 0
    if touched:
        return TOUCHED, [0, 0, 0]
    return (CROSSED if signs else APART), (signs + [0, 0, 0])[:3]
