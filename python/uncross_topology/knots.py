"""Alexander's polynomial as a few numbers, and the names of knots and links that have it.

Of Delta(t), known up to +-t^m, Delta(t) Delta(1/t) is kept: at t = -1 and at two other places, modulo two primes near 2^61. Two
different polynomials of degree n agree in one of the random places with probability n/2^61 at most. What Delta does not see: mirror
images; knots with the same polynomial (8_20 and 3_1#3_1; the granny and the square knot); knots whose polynomial is 1 (11n34, 11n42,
Whitehead doubles)."""
import collections

from uncross_topology import diagram

# det: |Delta(-1)|, None if it is 2^60 or more; values: Delta(t) Delta(1/t) at -1 and at diagram.PLACES, for each prime.
Polynomial = collections.namedtuple("Polynomial", "det values")


def polynomial(value):
    """Of the answers to diagram.FULL: one row of residues."""
    of_prime = [[int(v) for v in part] for part in (value[:5], value[5:])]
    least = [min(part[0], prime - part[0]) for part, prime in zip(of_prime, diagram.PRIMES)]
    values = tuple(tuple(product % prime for product in (part[0] * part[0], part[1] * part[2], part[3] * part[4]))
                   for part, prime in zip(of_prime, diagram.PRIMES))
    return Polynomial(least[0] if least[0] == least[1] else None, values)


def of_coefficients(coefficients):
    """Of Delta, from the highest power to the constant."""
    def at(t, prime):
        sum_ = 0
        for coefficient in coefficients:
            sum_ = (sum_ * t + coefficient) % prime
        return sum_
    return polynomial([at(t, prime) for t, prime in diagram.FULL])


def divide(dividend, divisor):
    """Of polynomials with whole coefficients; the divisor begins with 1. There is no remainder."""
    rest, quotient = list(dividend), []
    while len(rest) >= len(divisor):
        quotient.append(rest[0])
        rest = [a - rest[0] * b for a, b in zip(rest, list(divisor) + [0] * len(rest))][1:]
    assert not any(rest)
    return quotient


def multiply(one, other):
    product = [0] * (len(one) + len(other) - 1)
    for i, a in enumerate(one):
        for j, b in enumerate(other):
            product[i + j] += a * b
    return product


def power(n):
    """t^n - 1"""
    return [1] + [0] * (n - 1) + [-1]


def torus(p, q):
    """Delta of the torus knot T(p, q), p and q coprime: (t^pq - 1)(t - 1) / ((t^p - 1)(t^q - 1))."""
    return divide(divide(multiply(power(p * q), power(1)), power(p)), power(q))


# From standard tables, as in D. Rolfsen, Knots and Links (1976), appendix C; a second name is of a knot with the same polynomial.
KNOTS = {"0_1": [1], "3_1 = T(2,3)": torus(2, 3), "4_1": [1, -3, 1], "5_1 = T(2,5)": torus(2, 5), "5_2": [2, -3, 2],
         "6_1 or 9_46": [2, -5, 2], "6_2": [1, -3, 3, -3, 1], "6_3": [1, -3, 5, -3, 1], "7_1 = T(2,7)": torus(2, 7),
         "8_19 = T(3,4)": torus(3, 4), "10_124 = T(3,5)": torus(3, 5), "3_1#3_1 or 8_20": multiply(torus(2, 3), torus(2, 3)),
         "3_1#4_1": multiply(torus(2, 3), [1, -3, 1]), "4_1#4_1": multiply([1, -3, 1], [1, -3, 1])}
KNOTS |= {f"T({p},{q})": torus(p, q) for p, q in ((2, 9), (2, 11), (3, 7), (3, 8), (4, 5), (4, 7), (5, 6))}


def link_names():
    """(components, |lk| of pairs that have one, polynomial): name. T(2, 2n): with both curves in one direction (t^2n - 1)/(t + 1), with one of them
    turned round n (t - 1)."""
    yield (2, ()), [1, -3, 3, -1], "Whitehead's link"
    yield (3, ()), [1, -4, 6, -4, 1], "the Borromean rings"
    for n in range(1, 7):
        name = "Hopf's link = T(2,2)" if n == 1 else f"T(2,{2 * n})"
        yield (2, (n,)), divide(power(2 * n), [1, 1]), name
        yield (2, (n,)), [n, -n], name


BY_KNOT = {of_coefficients(coefficients): name for name, coefficients in KNOTS.items()}
BY_LINK = {(*key, of_coefficients(coefficients)): name for key, coefficients, name in link_names()}


def knot_name(found):
    """Of a single closed curve."""
    return BY_KNOT.get(found, "not in the table")


def link_name(components, numbers, found):
    """Of several; numbers: their linking numbers, but for those that are 0."""
    return BY_LINK.get((components, tuple(sorted(abs(number) for number in numbers if number)), found), "not in the table")
