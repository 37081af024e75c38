"""The pack `contacts`: bonds that touch when they are parallel, on one line, end on end, in one plane, in the first tick or the last;
near misses by some lattice units; impulses about the bounds of the rebound; a drift with many contacts in one tick."""

from dataclasses import dataclass

from .edges import BOX, CHAINS, DRIFT, KINDS as PAIRS_AND_CHAINS, PAIRS, SEED, Scaffold
from .exact import CELL, TICKS, at_tick, coefficients, dot, first_contact, is_excluded, one_sign, plus, times
from .inputs import MASSES, PART, Dice, Pack, corner_of

NEEDLES, STIFF, RINGS, FAR = 20, 10, 4, 8
KINDS = PAIRS_AND_CHAINS + [
    (NEEDLES, 2, False, 2, 0.5, 20, 0, (0, 0, 0)), (STIFF, 4, False, 3, 0.3, 100, 5, (0.5, -2, 1)),
    (RINGS, 4, True, 7.5, 0.3, 50, 2, (0, 0, 0)), (FAR, 2, False, 2, 0.5, 20, 0, (0, 0, 0))]


# --- searches ---

ZERO = (0, 0, 0)


@dataclass
class Kind:
    """A kind of contact: how many; powers of two for the sizes of bonds and of motions in a tick; off: the bonds miss each other by up
    to so many lattice units. doubtful: kept only if doubles alone give another tick."""

    rows: int
    bond: int
    rate: int
    direction: str = "any"
    place: str = "any"
    motion: str = "any"
    when: str = "any"
    off: int = 0
    doubtful: bool = False


SEARCHES = [
    Kind(24, 39, 20),
    Kind(12, 39, 20, direction="parallel"),
    Kind(12, 39, 20, direction="parallel then"),
    Kind(12, 39, 20, direction="on one line", place="end on end"),
    Kind(16, 39, 16, direction="in a plane"),
    Kind(12, 38, 19, direction="nearly parallel"),
    Kind(12, 39, 20, place="end on bond"),
    Kind(12, 39, 20, place="end on end"),
    Kind(12, 39, 20, motion="grazing"),
    Kind(8, 39, 20, when="first tick"),
    Kind(8, 39, 20, when="last tick"),
    Kind(8, 39, 20, when="at the end", motion="no turn"),
    Kind(24, 39, 20, place="end on end", off=1 << 18),
    Kind(24, 39, 12, place="end on end", off=1 << 10),
    Kind(12, 39, 12, place="end on bond", off=1 << 10),
    Kind(24, 6, 4, off=4),
    Kind(24, 10, 5, place="end on end", off=6),
    Kind(12, 48, 8, direction="nearly parallel", doubtful=True),
    Kind(12, 39, 4, direction="nearly parallel", doubtful=True),
    Kind(12, 39, 16, direction="in a plane", doubtful=True),
    Kind(8, 45, 12, motion="grazing", doubtful=True),
]
AT_REST = 8


def make_pair(dice, kind):
    """Bonds that touch at half / 2 ticks, at s = a/8 and t = b/8: w = s p - t q - time V, and its rate s p' - t q' + V. All vectors are
    multiples of 8, and V is even, so all are integers. Returns p, q, w and their rates."""
    half = {"any": dice.number(2 * TICKS - 4) + 2, "first tick": 1, "last tick": 2 * TICKS - 1, "at the end": 2 * TICKS}[kind.when]
    bond, rate = 1 << max(kind.bond - 3, 0), 1 << max(kind.rate - 3, 0)
    first = dice.number(2)
    a, b = (1 + dice.number(7) if kind.place == "any" or (kind.place == "end on bond" and inside) else dice.number(2) * 8
            for inside in (first, not first))
    p, q, p_rate, q_rate, v = (dice.point(size) for size in (bond, bond, rate, rate, rate))
    factor = 2 if dice.number(2) else -1
    if kind.motion != "any" or kind.direction == "on one line":
        p_rate = q_rate = ZERO
    if kind.direction == "parallel":
        q, q_rate = times(factor, p), times(factor, p_rate)
    if kind.direction == "on one line":
        v = tuple(x >> (kind.bond - kind.rate) for x in p)
        p = times(1 << (kind.bond - kind.rate), v)
        q = times(factor, p)
    if kind.direction == "parallel then":  # at the time of contact; times 2, since the time is a half
        turn = dice.point(rate)
        q, q_rate = plus(times(2 * factor, p), turn, -half), plus(times(2 * factor, p_rate), turn, 2)
        p, p_rate = times(2, p), times(2, p_rate)
    if kind.direction == "nearly parallel":
        q, q_rate = plus(times(factor, p), dice.point(2)), plus(times(factor, p_rate), dice.point(1))
    if kind.direction == "in a plane":
        one, other = dice.point(1 << 9), dice.point(1 << 9)
        p, q, p_rate, q_rate, v = (plus(times(dice.integer(size), other), one, dice.integer(size))
                                   for size in (1 << 26, 1 << 26, 1 << 4, 1 << 4, 1 << 4))
    if kind.motion == "grazing":  # V in the plane of p and q: f = 0 twice
        v = tuple((3 * x - y) >> (kind.bond - kind.rate) for x, y in zip(p, q))
    w = plus(plus(plus(times(a, p), q, -b), v, -half), dice.point(kind.off))
    w_rate = plus(plus(times(a, p_rate), q_rate, -b), v, 2)
    return times(8, p), times(8, q), w, times(8, p_rate), times(8, q_rate), w_rate


def doubles_exclude(row, tick):
    """Condition (i) for one tick in doubles, without doubt about their signs."""
    return one_sign(coefficients(*([tuple(map(float, v)) for v in at_tick(row, t)] for t in (tick, tick + 1))))


def is_wanted(kind, row, start):
    """Within 2048 a0; with a contact that is not at once, and for doubtful ones such that doubles alone would miss it."""
    if any(abs(x) > 1 << 51 for tick in (0, TICKS) for v in at_tick(row, tick) for x in v):
        return False
    if kind.off or (kind.when != "first tick" and not is_excluded(row, start, start + 1)):
        return kind.off > 0
    tick = first_contact(row, start)
    return tick < TICKS and (not kind.doubtful or doubles_exclude(row, tick))


def put_contact_search(pack):
    dice, rows = Dice(53), []
    for kind in SEARCHES:
        n = 0
        while n < kind.rows:
            row = make_pair(dice, kind)
            start = dice.number(TICKS // 4) if n % 4 == 3 and kind.when == "any" else 0
            if is_wanted(kind, row, start):
                rows.append((*row, start))
                n += 1
    for k in range(AT_REST):  # no contact, even of bonds that touch; a motion of both together is not in p, q, w
        p, q, w, *_ = make_pair(dice, Kind(1, 39, 20))
        rows.append((p, q, tuple(x // 8 * 3 for x in p) if k % 2 else w, ZERO, ZERO, ZERO, 0))
    for name, column in zip(("p", "q", "w", "p_rate", "q_rate", "w_rate"), zip(*rows)):
        pack.put("contact_search", name, "x y z", column)
    pack.put("contact_search", "from", "tick", [row[6] for row in rows])


# --- impulses ---

BOUNDS = ((5, -2), (5, -2.0000000001), (5, -1.9999999999), (1, 2), (1, 2.0000000001), (1, 1.9999999999), (1, 0), (1, -0.5), (1, -1e6),
          (1, 1e6), (1e-9, 1), (1e-9, -1), (0, 1), (-1, 3), (1e-30, 1e-20))


def head_on(a, h):
    """The approach is a and what F adds to it in tau is h, exactly: two single vertices. Columns of `impulse`."""
    velocity, force = [(a, 0.25, 0), (1, 1, 1), (0, -0.5, 0), (2, 0, 1)], [(h, 3, 0), (9, 9, 9), (0, 1, 0), (7, 0, 0)]
    return velocity, force, (1, 2, 4, 8), (0, 0), (1, 0, 0), 1


def draw_impulse(dice, k):
    tau, s, t, n = (0.0, 0.005, -0.005, 0.08, -0.08)[k % 5], dice.place(), dice.place(), dice.normal()
    velocity, force, mass = [], [], []
    for _ in range(4):
        velocity.append(dice.velocity(k % 16 > 0))
        force.append(dice.vector((0.0, 10.0, 200.0, 3000.0)[k % 4]))
        mass.append(5.0 if k % 3 == 0 else MASSES[dice.number(6)])
    approach = sum(lever * dot(v, n) for lever, v in zip((1.0 - s, s, t - 1.0, -t), velocity))
    if approach < 0.0 and k % 8:  # most of them approach
        n = times(-1.0, n)
    return velocity, force, mass, (s, t), n, tau


def put_impulse(pack):
    dice = Dice(61)
    rows = [head_on(*BOUNDS[k]) if k < len(BOUNDS) else draw_impulse(dice, k) for k in range(140)]
    columns = {"mass": "p0 p1 q0 q1", "contact": "s t", "normal": "x y z"}
    for end, name in enumerate(("p0", "p1", "q0", "q1")):
        for prefix, k in (("", 0), ("force_", 1)):
            pack.put("impulse", prefix + name, "x y z", [tuple(map(float, row[k][end])) for row in rows])
    for k, (name, words) in enumerate(columns.items()):
        pack.put("impulse", name, words, [tuple(map(float, row[2 + k])) for row in rows])
    pack.put("impulse", "tau", "tau", [float(row[5]) for row in rows])


# --- a drift ---

# Needles: the slot, both ends in parts, how far both move in the drift (parts), and lattice units to be added to y.
STANDING = [
    # parallel; on one line; an end against a bond, in one plane
    (16, (0, 4, -4), (0, 4, 4), (0, 8, 0), 0), (16, (0, 8, -3), (0, 8, 5), ZERO, 0),
    (17, (-7, 8, 0), (-3, 8, 0), (6, 0, 0), 0), (17, (0, 8, 0), (5, 8, 0), ZERO, 0),
    (18, (2, 1, 0), (2, 5, 0), (0, 8, 0), 0), (18, (0, 8, 0), (6, 8, 0), ZERO, 0),
    # in the first tick; in the middle of the last; at the very end; at the very beginning: they only part
    (19, (-4, 8, 0), (4, 8, 0), (0, 8, 0), -3), (19, (0, 8, -4), (0, 8, 4), ZERO, 0),
    (20, (-4, 0, 0), (4, 0, 0), (0, 8, 0), 1 << 22), (20, (0, 8, -4), (0, 8, 4), ZERO, 0),
    (21, (-4, 0, 0), (4, 0, 0), (0, 8, 0), 0), (21, (0, 8, -4), (0, 8, 4), ZERO, 0),
    (22, (-4, 8, 0), (4, 8, 0), (0, 6, 0), 0), (22, (0, 8, -4), (0, 8, 4), ZERO, 0),
    # between two others
    (23, (0, 7, -4), (0, 7, 4), (2, 18, 0), 0), (23, (-4, 6, 1), (4, 6, 1), ZERO, 0), (23, (-4, 8, 1), (4, 9, 0), ZERO, 0),
]


class Drift:
    """Places and velocities of all vertices, one after the other."""

    def __init__(self):
        s = Scaffold().build()
        self.position, self.velocity = s.position, s.velocity

    def put(self, places, velocity):
        self.position += places
        self.velocity += [velocity] * len(places)

    def put_needle(self, origin, ends, parts):
        """Its ends in parts from the origin, and how far it moves in the drift."""
        self.put([plus(origin, end, PART) for end in ends], tuple(x / (16.0 * DRIFT) for x in parts))

    def put_tiny_pair(self, middle, fly):
        """Two needles of some lattice units that are answered in tick 2, where they part already: no impulse separates them. fly: rate of
        both, lattice units in a tick."""
        places, rates = ((1, -9, -2), (-2, 2, -5), (2, 7, 1), (-7, 2, -11)), ((3, 2, -2), (1, 0, 0), (1, -3, -3), (-2, 3, 3))
        for place, rate in zip(places, rates):
            self.put([plus(middle, place)], tuple(2.0**-24 / DRIFT * float(x) for x in plus(rate, fly)))

    def put_needles(self):
        for slot, begin, end, parts, units in STANDING:
            self.put_needle(plus(corner_of(slot), (0, units, 0)), (begin, end), parts)
        corner = corner_of(25)  # a cluster: a pair that no impulse separates, and a needle that meets both later
        self.put_tiny_pair(plus(corner, (0, 8, 0), PART), ZERO)
        self.put_needle(corner, ((0, 4, -4), (0, 4, 4)), (0, 8, 0))

    def put_tangle(self):
        """Fibers of four vertices, each some boxes away."""
        dice = Dice(71)
        for fiber in range(STIFF + RINGS):
            image = [dice.integer(most) for most in (2, 1, 3)]
            middle = plus(corner_of(26 + fiber % 3), (0, 8, 0), PART)
            at = plus([x + i * cells * CELL for x, i, cells in zip(middle, image, BOX)], dice.point(5 * PART))
            for _ in range(4):
                self.put([at], dice.vector(1.5))
                at = plus(at, dice.point(5 * PART))

    def put_long_needles(self):
        """Both are nearly half of the shortest edge, along it. They touch with their far ends, so their first ends are further apart
        than half of the edge: the nearest image of one is not the one that is touched."""
        self.put_needle(ZERO, ((30, 40, 3), (30, 40, 26)), (4, 0, 0))
        self.put_needle(ZERO, ((32, 45, 44), (32, 39, 22)), ZERO)

    def put_joining_clusters(self):
        """A pair that falls, and one that rises, at 2^22 lattice units in a tick, and some: the sum of their rates over 4 is no whole
        number. Each is met by a needle, which then flies with it. At last the two needles meet."""
        corner = corner_of(29)
        low = plus(corner, (3, 2, 3), PART)
        below = plus(low, (0, -(1 << 22) * 21845, 0))
        self.put_tiny_pair(plus(corner, (0, 8, 0), PART), (0, -(1 << 22), 0))
        self.put_needle(corner, ((0, 4, -4), (0, 4, 4)), (0, 8, 0))
        self.put_tiny_pair(low, (0, 1 << 22, 0))
        self.put_needle(below, ((-4, 0, -2), (4, 0, 2)), (0, 8, 0))


def put_event_drift(pack):
    drift = Drift()
    drift.put_needles()
    drift.put_tangle()
    drift.put_long_needles()
    drift.put_joining_clusters()
    pack.put("event_drift", "time", "dt start", [(DRIFT, -0.5 * DRIFT)])
    pack.put("event_drift", "position", "x y z", drift.position)
    pack.put("event_drift", "velocity", "x y z", drift.velocity)


MODEL = SEED, BOX, 0, KINDS
OPERATORS = {"contact_search": put_contact_search, "impulse": put_impulse, "event_drift": put_event_drift}
