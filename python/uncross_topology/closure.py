"""Open chains as closed polygons: only so have they a knot, and another closure may give another one."""
import numpy

WAYS = {"sphere": "both ends go straight, away from the center of mass, to a sphere of 10 R_g about it, and are joined there",
        "directions": "both ends go straight in one direction, and are joined 20 R_g away; 100 directions, evenly spread"}
DIRECTIONS = 100


def unit(vector):
    """Along x if it has no length."""
    length = numpy.linalg.norm(vector)
    return vector / length if length > 0 else numpy.array([1.0, 0.0, 0.0])


def on_sphere(at, radius):
    """From the last vertex straight out, along a great circle in parts of 30 degrees at most, and back to the first."""
    first, last = unit(at[0]), unit(at[-1])
    aside = first - (first @ last) * last
    if numpy.linalg.norm(aside) < 1e-9:  # of opposite ends any great circle: the chain is inside the sphere
        aside = numpy.cross(last, numpy.eye(3)[numpy.argmin(abs(last))])
    angle = numpy.arccos(numpy.clip(first @ last, -1, 1))
    turns = numpy.linspace(0, angle, 2 + int(angle / (numpy.pi / 6)))[:, None]
    return [radius * (numpy.cos(turns) * last + numpy.sin(turns) * unit(aside))]


def along_directions(at, radius):
    """Both ends are moved by the same vector: of a Fibonacci lattice on the sphere."""
    k = numpy.arange(DIRECTIONS) + 0.5
    height, turn = 1 - 2 * k / DIRECTIONS, numpy.pi * (3 - 5**0.5) * k
    around = numpy.sqrt(1 - height**2)
    for direction in numpy.stack([around * numpy.cos(turn), around * numpy.sin(turn), height], axis=1):
        yield 2 * radius * direction + at[[-1, 0]]


ADDED = {"sphere": on_sphere, "directions": along_directions}


def close(position, way):
    """The polygons of a chain, int64 [..][3]: vertices in order, and those that are added. A chain that reaches further than half the
    radius gets a larger one."""
    middle = numpy.rint(position.mean(axis=0)).astype(numpy.int64)
    at = (position - middle).astype(float)
    distance = numpy.linalg.norm(at, axis=1)
    radius = max(10 * numpy.sqrt(numpy.mean(distance**2)), 2 * distance.max())
    for added in ADDED[way](at, radius):
        yield numpy.concatenate([position, numpy.rint(added).astype(numpy.int64) + middle])
