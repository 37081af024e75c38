"""Meetings of two bonds between two frames, decided another way: over the rationals, by Sturm's sequences. What sign a polynomial has at a
root is the difference of roots with either sign, which Tarski's query counts. Nothing is isolated by Bernstein's coefficients, and no common
divisor is asked for. Slow."""
import fractions

F = fractions.Fraction


def trimmed(a):
    while a and a[-1] == 0:
        a = a[:-1]
    return a


def add(a, b, times=1):
    long = max(len(a), len(b))
    return trimmed([(a + [F(0)] * long)[k] + times * (b + [F(0)] * long)[k] for k in range(long)])


def mul(a, b):
    out = [F(0)] * max(len(a) + len(b) - 1, 0)
    for j, x in enumerate(a):
        for k, y in enumerate(b):
            out[j + k] += x * y
    return trimmed(out)


def rem(a, b):
    while len(a) >= len(b):
        q = a[-1] / b[-1]
        a = trimmed(add(a, [F(0)] * (len(a) - len(b)) + b, -q)[:len(a) - 1])
    return a


def at(a, t):
    total = F(0)
    for x in reversed(a):
        total = total * t + x
    return total


def derivative(a):
    return trimmed([k * x for k, x in enumerate(a)][1:])


def query(f, g, low, high):
    """(roots of f in (low, high) where g > 0) - (where g < 0); f(low), f(high) are not 0."""
    sequence = [f, mul(derivative(f), g)]
    while sequence[-1]:
        sequence.append([-x for x in rem(sequence[-2], sequence[-1])])
    changes = []
    for t in low, high:
        signs = [value > 0 for value in (at(a, t) for a in sequence) if value != 0]
        changes.append(sum(x != y for x, y in zip(signs, signs[1:])))
    return changes[0] - changes[1]


ONE = [F(1)]


class Time:
    """A root of f: the only one in (low, high)."""

    def __init__(self, f, low, high):
        self.f, self.low, self.high = f, low, high

    def sign(self, g):
        return query(self.f, g, self.low, self.high) if g else 0

    def is_between_0_and_1(self):
        return self.sign([F(0), F(1)]) > 0 and self.sign([F(1), F(-1)]) > 0


def times(f):
    """All roots in [0, 1]."""
    found, todo = [], [(F(-1), F(2))]
    while todo:
        low, high = todo.pop()
        count = query(f, ONE, low, high) if at(f, low) and at(f, high) else None
        if count is None:
            low, high = (low - F(1, 97) if not at(f, low) else low), (high + F(1, 89) if not at(f, high) else high)
            todo.append((low, high))
        elif count == 1:
            time = Time(f, low, high)
            if time.sign([F(0), F(1)]) >= 0 and time.sign([F(1), F(-1)]) >= 0:
                found.append(time)
        elif count > 1:
            middle = (low + high) / 2
            while not at(f, middle):
                middle += (high - low) / 1001
            todo += [(low, middle), (middle, high)]
    return found


def vector(first, last):
    return [trimmed([F(a), F(b - a)]) for a, b in zip(first, last)]


def dot(a, b):
    return add(add(mul(a[0], b[0]), mul(a[1], b[1])), mul(a[2], b[2]))


def cross(a, b):
    return [add(mul(a[1], b[2]), mul(a[2], b[1]), -1), add(mul(a[2], b[0]), mul(a[0], b[2]), -1), add(mul(a[0], b[1]), mul(a[1], b[0]), -1)]


def points_meet(p, q, w, time):
    """Parallel bonds, at this time: an end of one lies on the other."""
    minus = lambda a, b: [add(x, y, -1) for x, y in zip(a, b)]
    zero = lambda v: all(time.sign(x) == 0 for x in v)
    on = lambda x, d: zero(x) or not zero(d) and zero(cross(x, d)) and time.sign(dot(x, d)) >= 0 and time.sign(add(dot(d, d), dot(x, d), -1)) >= 0
    none = [[], [], []]
    end = [add(a, b) for a, b in zip(w, q)]
    return on(w, p) or on(end, p) or on(minus(none, w), q) or on(minus(p, w), q)


def meet(p0, p1, q0, q1, w0, w1):
    """Signs of the crossings, in the order of time; and whether there is another meeting."""
    p, q, w = vector(p0, p1), vector(q0, q1), vector(w0, w1)
    n = cross(p, q)
    f = dot(n, w)
    if f:
        where = times(f)
    else:
        bounds = [dot(cross(w, q), n), dot(cross(w, p), n), dot(n, n)]
        ends = [dot(x, d) for d in (p, q) for x in (w, p, q, [add(a, b) for a, b in zip(w, q)], [add(a, b, -1) for a, b in zip(w, p)],
                                                    [add(add(a, b), c, -1) for a, b, c in zip(w, q, p)])]
        polynomials = [*bounds, add(bounds[2], bounds[0], -1), add(bounds[2], bounds[1], -1), *ends, *cross(w, p), *cross(w, q), *n, *w]
        where = [time for polynomial in polynomials if len(polynomial) > 1 for time in times(polynomial)] + times([F(0), F(1)]) + times([F(-1), F(1)])
    signs, touched = [], False
    for time in sorted(where, key=lambda time: time.low):
        square = dot(n, n)
        if time.sign(square) == 0:
            touched = touched or points_meet(p, q, w, time)
            continue
        inside = [time.sign(g) for on in (dot(cross(w, q), n), dot(cross(w, p), n)) for g in (on, add(square, on, -1))]
        if min(inside) < 0:
            continue
        simple = time.sign(derivative(f)) if f else 0
        if min(inside) > 0 and simple and time.is_between_0_and_1():
            signs.append(simple)
        else:
            touched = True
    return signs, touched
