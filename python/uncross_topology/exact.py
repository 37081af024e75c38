"""Meetings of two bonds between two frames, decided in integers, whatever their places are: of pairs that `uncross crossings`
leaves unsure. src/topology/pair.h has the formulas.

A polynomial in t is a list of integers, the lowest power first, without zeros at its end. A vector that is linear in t is
three of them."""
import collections
import math

Root = collections.namedtuple("Root", "poly at depth")  # poly None: t is at/2^depth; else: its one root between at and at + 1 of these

Meetings = collections.namedtuple("Meetings", "crossings touched")  # crossings: of Crossing, in the order of time
Crossing = collections.namedtuple("Crossing", "sign t s other")


# --- polynomials ----------------------------------------------------------------------------------------------------------

def trim(a):
    while a and a[-1] == 0:
        a.pop()
    return a


def plus(a, b, factor=1):
    return trim([(a[k] if k < len(a) else 0) + factor * (b[k] if k < len(b) else 0) for k in range(max(len(a), len(b)))])


def times(a, b):
    product = [0] * (len(a) + len(b) - 1) if a and b else []
    for j, x in enumerate(a):
        for k, y in enumerate(b):
            product[j + k] += x * y
    return product


def slope(a):
    return [k * a[k] for k in range(1, len(a))]


def dot(a, b):
    return plus(plus(times(a[0], b[0]), times(a[1], b[1])), times(a[2], b[2]))


def cross(a, b):
    return [plus(times(a[j], b[k]), times(a[k], b[j]), -1) for j, k in ((1, 2), (2, 0), (0, 1))]


def remainder(a, b):
    """Of a, times a positive number, by b."""
    a = a[:]
    while len(a) >= len(b):
        lead, shift = a[-1] * (1 if b[-1] > 0 else -1), len(a) - len(b)
        a = [abs(b[-1]) * x for x in a]
        for k, x in enumerate(b):
            a[k + shift] -= lead * x
        trim(a)
    return a


def primitive(a):
    common = math.gcd(*a)
    return [x // common for x in a]


def gcd(a, b):
    while b:
        a, b = b, remainder(a, b)
        b = primitive(b) if b else b
    return primitive(a)


def divided(a, b):
    """a / b up to a factor, where b divides it."""
    quotient = []
    for _ in range(len(a) - len(b) + 1):
        common = math.gcd(a[-1], b[-1])
        up, lead = abs(b[-1]) // common, a[-1] // common * (1 if b[-1] > 0 else -1)
        shift, a = len(a) - len(b), [up * x for x in a]
        quotient = [up * x for x in quotient] + [lead]
        for k, x in enumerate(b):
            a[k + shift] -= lead * x
        a.pop()
    return primitive(trim(quotient[::-1]))


def value(a, at, depth):
    """The sign's carrier: a at at/2^depth, times a power of two."""
    total = 0
    for k in range(len(a) - 1, -1, -1):
        total = total * at + (a[k] << depth * (len(a) - 1 - k))
    return total


def sign(x):
    return (x > 0) - (x < 0)


def local(a, at, depth):
    """The polynomial on the interval from at to at + 1 of 2^-depth, as one of x from 0 to 1, times a power of two."""
    a = [x << depth * (len(a) - 1 - k) for k, x in enumerate(a)]
    for begin in range(len(a) - 1):  # Taylor's shift
        for k in range(len(a) - 2, begin - 1, -1):
            a[k] += at * a[k + 1]
    return a


def changes(a):
    """Changes of sign among the coefficients of Bernstein of a polynomial on 0 to 1: as many roots within, or an even number more."""
    a = a[::-1]
    for begin in range(len(a) - 1):
        for k in range(len(a) - 2, begin - 1, -1):
            a[k] += a[k + 1]
    signs = [x > 0 for x in a if x]
    return sum(x != y for x, y in zip(signs, signs[1:]))


# --- roots ----------------------------------------------------------------------------------------------------------------

def roots(a):
    """All in [0, 1], each once, of a polynomial that is not 0. In order."""
    found = []
    if len(a) < 2 or a[0] and sum(a) and changes(a) == 0:
        return found
    common = gcd(a, slope(a))
    a = divided(a, common) if len(common) > 1 else a
    if a[0] == 0:
        found.append(Root(None, 0, 0))
    _isolate(a, 0, 0, found)
    if sum(a) == 0:
        found.append(Root(None, 1, 0))
    return found


def _isolate(a, at, depth, found):
    """Those strictly within an interval."""
    part = local(a, at, depth)
    part = part[1:] if part[0] == 0 else part  # a root at the beginning is not within
    if sum(part) == 0:  # nor is one at the end: a division by x - 1
        part = [-sum(part[:k + 1]) for k in range(len(part) - 1)]
    count = changes(part)
    if count == 1:
        found.append(Root(a, at, depth))
    elif count > 1:
        _isolate(a, 2 * at, depth + 1, found)
        if value(a, 2 * at + 1, depth + 1) == 0:
            found.append(Root(None, 2 * at + 1, depth + 1))
        _isolate(a, 2 * at + 1, depth + 1, found)


def halved(root):
    """The same root in half of its interval."""
    a, middle, depth = root.poly, 2 * root.at + 1, root.depth + 1
    at_middle = sign(value(a, middle, depth))
    if at_middle == 0:
        return Root(None, middle, depth)
    return Root(a, middle if at_middle == _sign_after(root) * -1 else middle - 1, depth)


def _sign_after(root):
    """Of its polynomial between the root and the end of the interval."""
    end = sign(value(root.poly, root.at + 1, root.depth))
    return end if end else -sign(value(slope(root.poly), root.at + 1, root.depth))  # another root at the end, a simple one


EAGER = 12  # halvings before a common root is looked for


def sign_at(a, root):
    """Of a at a root; and the root, with a smaller interval if one was needed."""
    tries = 0
    while a and root.poly:
        part = local(a, root.at, root.depth)
        if part[0] and changes(part) == 0:  # none within; one at the end may be
            return sign(part[0]), root
        tries += 1
        if tries == EAGER:
            common = gcd(a, root.poly)
            if len(common) > 1 and any(_is_within(other, root) for other in roots(common)):
                return 0, root
        root = halved(root)
    return (sign(value(a, root.at, root.depth)) if a else 0), root


def _is_within(other, root):
    """Whether a root of a divisor of root.poly is this root: the only one in the interval."""
    while True:
        middle_from, middle_to = other.at << max(root.depth - other.depth, 0), root.at << max(other.depth - root.depth, 0)
        width_from, width_to = 1 << max(root.depth - other.depth, 0), 1 << max(other.depth - root.depth, 0)
        if other.poly is None:
            return middle_to < middle_from < middle_to + width_to
        if middle_to <= middle_from and middle_from + width_from <= middle_to + width_to:
            return True
        if middle_from + width_from <= middle_to or middle_to + width_to <= middle_from:
            return False
        other = halved(other)


def fine(root):
    """The same to a double's precision or so."""
    while root.poly and root.depth < 60:
        root = halved(root)
    return root


# --- meetings -------------------------------------------------------------------------------------------------------------

def linear(first, last):
    """A vector that goes evenly from the one to the other."""
    return [trim([int(a), int(b) - int(a)]) for a, b in zip(first, last)]


def apart_along_axis(p, q, w):
    """True if w + s' q - s p lies on one side of 0 along x, y or z, throughout."""
    for a, b, c in zip(p, q, w):
        ends = [(sum(c[:k]) + max(sum(b[:k]), 0) - min(sum(a[:k]), 0), sum(c[:k]) + min(sum(b[:k]), 0) - max(sum(a[:k]), 0)) for k in (1, 2)]
        if all(high < 0 for high, _ in ends) or all(low > 0 for _, low in ends):
            return True
    return False


def meetings(p, q, w):
    """Of bonds p and q, w from the start of p to the start of q: vectors that are linear in t, 0 to 1. A crossing is a meeting at
    a simple root of f, strictly within bonds and interval; any other meeting makes them touch."""
    if apart_along_axis(p, q, w):
        return Meetings([], False)
    n = cross(p, q)
    f, square = dot(n, w), dot(n, n)
    on = dot(cross(w, q), n), dot(cross(w, p), n)
    bounds = [on[0], plus(square, on[0], -1), on[1], plus(square, on[1], -1)]
    # A first meeting is at t = 0, or where one of the conditions for it becomes an equation.
    times_of = [f] if f else [[0, 1], *bounds, square, *(x for a, b in ((w, p), (w, q), (p, q)) for x in cross(a, b)), *_line(p, q, w), *_line(q, p, w), *w]
    crossings, touched = [], False
    for polynomial in times_of:
        for root in roots(polynomial) if polynomial else []:
            on_square, root = sign_at(square, root)
            signs = []
            for bound in bounds if on_square else []:
                found, root = sign_at(bound, root)
                signs.append(found)
                if found < 0:
                    break
            if on_square and min(signs) < 0 or not on_square and not _meet_on_line(p, q, w, root):
                continue
            simple, root = sign_at(slope(f), root) if f else (0, root)
            if on_square and min(signs) > 0 and simple and root not in (Root(None, 0, 0), Root(None, 1, 0)):
                root = fine(root)
                crossings.append(Crossing(simple, root.at / 2**root.depth, *(_ratio(a, square, root) for a in on)))
            else:
                touched = True
                if not f:
                    return Meetings([], True)
    return Meetings(sorted(crossings, key=lambda crossing: crossing.t), touched)


def _ratio(a, b, root):
    a, b = (value(c, root.at, root.depth) << root.depth * (5 - len(c)) if c else 0 for c in (a, b))
    return a / b if b else math.nan


def _line(d, other, w):
    """Where d's ends 0 and d stand against the other bond's, along d: zeros are where two ends meet, if all is on one line."""
    begin, along = dot(w, d), dot(d, d)
    end = plus(begin, dot(other, d))
    return [along, begin, end, plus(begin, along, -1), plus(end, along, -1)]


def _meet_on_line(p, q, w, root):
    """Parallel bonds, or points: whether they meet at this time."""
    is_zero = lambda v: all(sign_at(x, root)[0] == 0 for x in v)
    if not is_zero(cross(w, p)) or not is_zero(cross(w, q)):
        return False
    d, other, back = (p, q, w) if not is_zero(p) else (q, p, [[-x for x in a] for a in w])
    if is_zero(d):
        return is_zero(w)
    _, begin, end, begin_beyond, end_beyond = (sign_at(x, root)[0] for x in _line(d, other, back))
    return not (begin < 0 and end < 0) and not (begin_beyond > 0 and end_beyond > 0)


def folds(p, q):
    """Whether two bonds that begin at one vertex lie on each other at some time: parallel, and on the same side."""
    n, along = cross(p, q), dot(p, q)
    times_of = [a for a in n if a][:1] or [[0, 1], [-1, 1], slope(along)]
    return any(sign_at(along, root)[0] > 0 and all(sign_at(a, root)[0] == 0 for a in n) for a in times_of if a for root in roots(a))


# --- one symbolic perturbation --------------------------------------------------------------------------------------------

def direction(vertex):
    """Where a vertex is moved to, by an infinitesimal step, if a tie is broken: whole numbers, the same in all frames and images."""
    numbers, state = [], int(vertex) * 3 + 1
    for k in range(3):  # Steele, Lea and Flood 2014: SplitMix64
        x = (state + k) * 0x9E3779B97F4A7C15 & 2**64 - 1
        x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9 & 2**64 - 1
        x = (x ^ x >> 27) * 0x94D049BB133111EB & 2**64 - 1
        numbers.append((x ^ x >> 31) >> 32)
    return numbers


def perturbed(ends, places):
    """Meetings after the step. ends: vertices, two of each bond. places: of each, at t = 0 and 1, whole numbers.

    The step is 2^-finer, and short enough to stand for one that is as small as one likes: what decides (discriminant of f,
    resultants of f and the bounds of s, f at t = 0 and 1) are polynomials in the step with whole coefficients. Those whose
    sum is below 2^finer have no root between 0 and 2^-finer. With differences below 2^bits each component of a vector has a
    sum below 2^(bits + 2), f one below 6 2^(3 bits + 6), a bound below 24 2^(4 bits + 8), and Sylvester's determinant of both below
    (6 2^(3 bits + 6))^4 (24 2^(4 bits + 8))^3 < 2^(24 bits + 73)."""
    steps = [direction(vertex) for vertex in ends]
    bits = max([33] + [abs(int(a) - int(b)).bit_length() for one in places for other in places for t in (0, 1) for a, b in zip(one[t], other[t])])
    finer = 24 * bits + 73
    moved = [[[(int(x) << finer) + step for x, step in zip(place[t], steps[k])] for t in (0, 1)] for k, place in enumerate(places)]
    vector = lambda a, b: linear(*([y - x for x, y in zip(moved[a][t], moved[b][t])] for t in (0, 1)))
    return meetings(vector(0, 1), vector(2, 3), vector(0, 2))
