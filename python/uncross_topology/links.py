"""Links and knots of one frame: linking numbers of all pairs of closed curves with their images, Alexander's polynomial of each
curve and of linked groups; open chains by a stated closure."""
import collections
import itertools

import numpy

from uncross_topology import diagram, frame as frames, knots

CLOSURES = {"sphere": "both ends go straight, away from the center of mass, to a sphere of 10 R_g about it, and are joined there",
            "random": "both ends go straight in one direction, the same for both, and are joined at a distance of 20 R_g; 100 directions"}

# status: diagram.FINE, or why there is no number (diagram.WORDS). name: of knots.knot_name, None without a number.
Knot = collections.namedtuple("Knot", "curve status crossings polynomial name")
# image: three whole numbers; the second curve stands in this image, as both curves are stored (unwrapped). polynomial: its values at
# places other than -1 belong to the orientation in which vertices are listed. It is None where the curves were seen to be split:
# one lies above the other, and lk and det are 0.
Pair = collections.namedtuple("Pair", "one other image status lk polynomial name")
# curves: (curve, image) of each; wound: the group meets its own image, and has no polynomial.
Group = collections.namedtuple("Group", "curves wound status crossings polynomial name")
Links = collections.namedtuple("Links", "knots pairs groups judged")


def lattice_cell(frame):
    """The three edges of the cell, as rows."""
    return numpy.array([frames.image(frame, row) for row in numpy.eye(3, dtype=int).tolist()], dtype=numpy.int64)


def image_of(frame, shift):
    """The numbers of the image in which a point `shift` from the origin lies, -1/2 to 1/2 edges away; 0 along axes that are not periodic."""
    cell, number = lattice_cell(frame), [0, 0, 0]
    for axis in 2, 1, 0:  # of the sheared edge before the one that it leans along
        if frame.periodic[axis]:
            number[axis] = (2 * int(shift[axis]) + int(cell[axis][axis])) // (2 * int(cell[axis][axis]))
            shift = [int(a) - number[axis] * int(b) for a, b in zip(shift, cell[axis])]
    return number


def polygons_of(frame, curves):
    """The closed curves as polygons. Refused if one closes only through the box."""
    found = []
    for number, curve in curves:
        at = frame.position[numpy.asarray(curve.vertices)]
        if any(image_of(frame, at[0] - at[-1])):
            raise frames.Refused(f"curve {number} (vertices {curve.vertices[0]} to {curve.vertices[-1]}) closes only through the box: it has "
                                 "no linking number and no knot; allowed: curves that are closed as they are stored, unwrapped")
        found.append(diagram.clean(at))
        if len(found[-1]) < 3:
            raise frames.Refused(f"curve {number}: fewer than 3 different vertices; allowed: 3 or more")
    return found


# --- pairs ---------------------------------------------------------------------------------------------------------------


def images_within(frame, extent):
    """Whole numbers of all images whose boxes of curves can overlap with those of curves whose centers are in the box."""
    reach = [range(-1 - int(e) // edge, 2 + int(e) // edge) if periodic else range(1)
             for e, edge, periodic in zip(extent, frame.edge, frame.periodic)]
    for z, y in itertools.product(reach[2], reach[1]):
        slid = -y * frame.offset // frame.edge[0]
        yield from ((x + slid, y, z) for x in range(reach[0].start, reach[0].stop + (slid != 0)))


def candidates(frame, polygons):
    """Pairs, and images of the second, whose boxes overlap: arrays i, j, image [3], shift [3]. Of a curve's own images one of each two."""
    low, high = (numpy.array([edge(p, axis=0) for p in polygons]) for edge in (numpy.min, numpy.max))
    cell = lattice_cell(frame)
    home = numpy.array([image_of(frame, middle) for middle in (low + high) // 2])
    low, high = low - home @ cell, high - home @ cell
    found = []
    for number in images_within(frame, numpy.max(high - low, axis=0)):
        shift = numpy.array(frames.image(frame, number))
        for first in range(0, len(polygons), 1000):
            rows = slice(first, first + 1000)
            meet = numpy.ones((len(low[rows]), len(low)), dtype=bool)
            for axis in range(3):
                meet &= low[rows, None, axis] <= high[None, :, axis] + shift[axis]
                meet &= high[rows, None, axis] >= low[None, :, axis] + shift[axis]
            i, j = numpy.nonzero(meet)
            i += first
            keep = (i < j) | ((i == j) & (tuple(number) > (0, 0, 0)))
            found.append((i[keep], j[keep], numpy.array(number) + home[i[keep]] - home[j[keep]]))
    i, j, image = (numpy.concatenate(part) for part in zip(*found))
    return i, j, image, image @ cell


def jobs_of_pairs(i, j, shift):
    jobs = numpy.zeros((len(i), 9), dtype=numpy.int64)
    jobs[:, 0], jobs[:, 1], jobs[:, 5], jobs[:, 6:] = 2, i, j, shift
    return jobs.ravel()


def linking(signs):
    """lk of two closed curves is the sum of the signs where the first is above, the same where the second is, half the sum of all."""
    if numpy.any(signs[:, 0] != signs[:, 1]):
        raise AssertionError("the two sums of signs differ: a defect of this program")
    return signs[:, 0]


def find_pairs(frame, polygons):
    """Pairs that are linked or may be: those with lk or det other than 0, and those that touch. And how many were judged."""
    if not polygons:
        return [], 0
    i, j, image, shift = candidates(frame, polygons)
    seen = diagram.ask(polygons, jobs_of_pairs(i, j, shift))
    lk = linking(numpy.where(seen.status[:, None] == diagram.FINE, seen.signs, 0))
    open_ = numpy.nonzero((seen.status != diagram.FINE) | numpy.all(seen.above > 0, axis=1))[0]
    full = diagram.ask(polygons, jobs_of_pairs(i[open_], j[open_], shift[open_]), diagram.SCREEN)
    linked = (full.status != diagram.FINE) | (lk[open_] != 0) | numpy.any(full.value != 0, axis=1)
    chosen = open_[linked]
    full = diagram.ask(polygons, jobs_of_pairs(i[chosen], j[chosen], shift[chosen]), diagram.FULL)
    pairs = []
    for place, k in enumerate(chosen):
        found = knots.polynomial(full.value[place]) if full.status[place] == diagram.FINE else None
        known = seen.status[k] == diagram.FINE
        pairs.append(Pair(int(i[k]), int(j[k]), tuple(image[k].tolist()), int(full.status[place]), int(lk[k]) if known else None, found,
                          knots.link_name(2, [lk[k]], found) if found else None))
    return pairs, len(i)


# --- curves and groups ---------------------------------------------------------------------------------------------------


def known(status, value):
    return knots.polynomial(value) if status == diagram.FINE else None


def find_knots(polygons):
    jobs = numpy.zeros((len(polygons), 5), dtype=numpy.int64)
    jobs[:, 0], jobs[:, 1] = 1, numpy.arange(len(polygons))
    full = diagram.ask(polygons, jobs.ravel(), diagram.FULL)
    found = [known(status, value) for status, value in zip(full.status, full.value)]
    return [Knot(k, int(full.status[k]), int(full.crossings[k]), found[k], found[k] and knots.knot_name(found[k]))
            for k in range(len(polygons))]


def gather(pairs):
    """Curves that pairs connect: [{curve: image}], and whether each meets its own image."""
    beside = collections.defaultdict(list)
    for pair in pairs:
        beside[pair.one].append((pair.other, pair.image))
        beside[pair.other].append((pair.one, tuple(-x for x in pair.image)))
    groups, seen = [], set()
    for start in sorted(beside):
        if start in seen:
            continue
        place, wound, waiting = {start: (0, 0, 0)}, False, [start]
        while waiting:
            here = waiting.pop()
            for other, image in beside[here]:
                there = tuple(a + b for a, b in zip(place[here], image))
                if other not in place:
                    place[other] = there
                    waiting.append(other)
                wound = wound or place[other] != there
        seen |= place.keys()
        groups.append((dict(sorted(place.items())), wound))
    return groups


def find_groups(frame, polygons, pairs):
    """Groups of curves that are connected by pairs with lk or Delta other than 0."""
    gathered = gather(pair for pair in pairs if pair.lk or (pair.polynomial and any(map(any, pair.polynomial.values))))
    groups, jobs = [], []
    finite = [curves for curves, wound in gathered if not wound]
    for curves in finite:
        jobs.append(len(curves))
        for curve, image in curves.items():
            jobs += [curve, *frames.image(frame, image)]
    full = diagram.ask(polygons, jobs, diagram.FULL)
    answers = iter(zip(full.status.tolist(), full.crossings.tolist(), full.value))
    for curves, wound in gathered:
        status, crossings, value = (diagram.FINE, 0, None) if wound else next(answers)
        found = None if wound else known(status, value)
        numbers = [pair.lk for pair in pairs if pair.one in curves] if len(curves) == 2 else []
        groups.append(Group(list(curves.items()), wound, status, crossings, found,
                            found and knots.link_name(len(curves), numbers, found)))
    return groups
