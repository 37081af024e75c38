"""Links and knots of one frame: linking numbers of all pairs of closed curves with their images, Alexander's polynomial of each
curve and of linked groups; open chains by a stated closure."""
import collections
import itertools

import numpy

from . import closure as closures
from . import diagram, knots
from . import frame as frames

# status: diagram.FINE, or why there is no number (diagram.WORDS). name: of knots.knot_name, None without a number.
Knot = collections.namedtuple("Knot", "curve status crossings polynomial name")
# image: three whole numbers; the second curve stands in this image, as both curves are stored (unwrapped). polynomial: its values at
# places other than -1 belong to the orientation in which vertices are listed. It is None where the curves were seen to be split:
# one lies above the other, and lk and det are 0.
Pair = collections.namedtuple("Pair", "one other image status lk polynomial name")
# curves: (curve, image) of each; wound: the group meets its own image, and has no polynomial.
Group = collections.namedtuple("Group", "curves wound status crossings polynomial name")
# A chain closed in one way, or in several: names is {name: how often}.
Chain = collections.namedtuple("Chain", "curve names")
# judged: pairs and images whose boxes overlap; closure: a key of closure.WAYS, or None, and then chains is empty.
Links = collections.namedtuple("Links", "knots pairs groups judged closure chains")


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
    """The closed ones of the curves as polygons, by number. Refused if one closes only through the box."""
    found = {}
    for number, curve in enumerate(curves):
        if not curve.closed:
            continue
        at = frame.position[numpy.asarray(curve.vertices)]
        if any(image_of(frame, at[0] - at[-1])):
            raise frames.Refused(f"curve {number} (vertices {curve.vertices[0]} to {curve.vertices[-1]}) closes only through the box: it has "
                                 "no linking number and no knot; allowed: curves that are closed as they are stored, unwrapped")
        found[number] = diagram.clean(at)
        if len(found[number]) < 3:
            raise frames.Refused(f"curve {number}: fewer than 3 different vertices; allowed: 3 or more")
    return found


# --- pairs ---------------------------------------------------------------------------------------------------------------


def images_within(frame, extent):
    """Whole numbers of all images whose boxes of curves can overlap with those of curves whose centers are in the box."""
    reach = [range(-1 - int(e) // edge, 2 + int(e) // edge) if periodic else range(1)
             for e, edge, periodic in zip(extent, frame.edge, frame.periodic)]
    for z, y in itertools.product(reach[2], reach[1]):
        turns, rest = divmod(-y * frame.offset, frame.edge[0]) if frame.periodic[0] else (0, 0)
        yield from ((x + turns, y, z) for x in range(reach[0].start, reach[0].stop + (rest > 0)))


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


def find_linking(frame, polygons):
    """Of all pairs and images whose boxes overlap: i, j, image, shift, what was answered, lk (0 where they touch)."""
    i, j, image, shift = candidates(frame, polygons)
    seen = diagram.ask(polygons, jobs_of_pairs(i, j, shift))
    return i, j, image, shift, seen, linking(numpy.where(seen.status[:, None] == diagram.FINE, seen.signs, 0))


def linking_numbers(frame, curves):
    """{(curve, other, image): lk} of all pairs of closed curves with lk other than 0."""
    rings = polygons_of(frame, curves)
    numbers = list(rings)
    if not numbers:
        return {}
    i, j, image, _, _, lk = find_linking(frame, list(rings.values()))
    return {(numbers[i[k]], numbers[j[k]], tuple(image[k].tolist())): int(lk[k]) for k in numpy.nonzero(lk)[0]}


def find_pairs(frame, polygons):
    """Pairs that are linked or may be: those with lk or det other than 0, and those that touch. And how many were judged."""
    if not polygons:
        return [], 0
    i, j, image, shift, seen, lk = find_linking(frame, polygons)
    open_ = numpy.nonzero((seen.status != diagram.FINE) | numpy.all(seen.above > 0, axis=1))[0]
    full = diagram.ask(polygons, jobs_of_pairs(i[open_], j[open_], shift[open_]), diagram.SCREEN)
    linked = (full.status != diagram.FINE) | (lk[open_] != 0) | numpy.any(full.value != 0, axis=1)
    chosen = open_[linked]
    full = diagram.ask(polygons, jobs_of_pairs(i[chosen], j[chosen], shift[chosen]), diagram.FULL)
    pairs = []
    for place, k in enumerate(chosen):
        found = known(full.status[place], full.value[place])
        pairs.append(Pair(int(i[k]), int(j[k]), tuple(image[k].tolist()), int(full.status[place]), int(lk[k]) if seen.status[k] == diagram.FINE else None, found,
                          knots.link_name(2, [lk[k]], found) if found else None))
    return pairs, len(i)


# --- curves and groups ---------------------------------------------------------------------------------------------------


def find_polynomials(polygons, sets):
    """Of each set of polygons together, given as pairs of number and shift: status, crossings of the diagram, polynomial or None."""
    jobs = [word for members in sets for word in (len(members), *(x for number, shift in members for x in (number, *shift)))]
    full = diagram.ask(polygons, jobs, diagram.FULL)
    return [(int(status), int(crossings), known(status, value)) for status, crossings, value in zip(full.status, full.crossings, full.value)]


def known(status, value):
    """The polynomial, if there is one."""
    return knots.polynomial(value) if status == diagram.FINE else None


def find_knots(polygons):
    found = find_polynomials(polygons, [[(number, (0, 0, 0))] for number in range(len(polygons))])
    return [Knot(number, *one, one[-1] and knots.knot_name(one[-1])) for number, one in enumerate(found)]


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
    finite = [[(curve, frames.image(frame, image)) for curve, image in curves.items()] for curves, wound in gathered if not wound]
    answers, groups = iter(find_polynomials(polygons, finite)), []
    for curves, wound in gathered:
        status, crossings, found = (diagram.FINE, 0, None) if wound else next(answers)
        numbers = [pair.lk or 0 for pair in pairs if pair.one in curves]
        groups.append(Group(list(curves.items()), wound, status, crossings, found, found and knots.link_name(len(curves), numbers, found)))
    return groups


def find_chains(frame, curves, way):
    """Knots of the open chains, each closed in this way."""
    polygons, owner = [], []
    for number, curve in enumerate(curves):
        for polygon in [] if curve.closed else closures.close(frame.position[numpy.asarray(curve.vertices)], way):
            polygons.append(diagram.clean(polygon))
            owner.append(number)
    names = collections.defaultdict(collections.Counter)
    for number, knot in zip(owner, find_knots(polygons)):
        names[number][knot.name or diagram.WORDS[knot.status]] += 1
    return [Chain(number, dict(counts)) for number, counts in sorted(names.items())]


def look(frame, curves, way=None):
    """Links of one frame. way: of closure.WAYS, or None: open chains are left out."""
    rings = polygons_of(frame, curves)
    numbers, polygons = list(rings), list(rings.values())
    pairs, judged = find_pairs(frame, polygons)
    groups = find_groups(frame, polygons, pairs)
    return Links([knot._replace(curve=numbers[knot.curve]) for knot in find_knots(polygons)],
                 [pair._replace(one=numbers[pair.one], other=numbers[pair.other]) for pair in pairs],
                 [group._replace(curves=[(numbers[curve], image) for curve, image in group.curves]) for group in groups],
                 judged, way, find_chains(frame, curves, way) if way else [])


# --- what is printed -----------------------------------------------------------------------------------------------------


def value(polynomial, status):
    """det in words."""
    if polynomial is None:
        return diagram.WORDS[status]
    rest = " (but Delta is not 0)" if polynomial.det == 0 and any(map(any, polynomial.values)) else ""
    return "det above 2^60" if polynomial.det is None else f"det = {polynomial.det}{rest}"


def lines(links):
    """Text of all that was found."""
    counts = collections.Counter(knot.name or diagram.WORDS[knot.status] for knot in links.knots)
    yield f"rings: {len(links.knots)}" + "".join(f"; {name}: {count}" for name, count in counts.most_common())
    for knot in links.knots:
        if knot.name != "0_1":
            yield f"ring {knot.curve}: {value(knot.polynomial, knot.status)}, {knot.name or 'no polynomial'}"
    numbers = collections.Counter(abs(pair.lk) for pair in links.pairs if pair.lk)
    yield (f"pairs and images: {links.judged} within reach; lk or polynomial other than 0: {len(links.pairs)}"
           + "".join(f"; |lk| = {lk}: {count}" for lk, count in sorted(numbers.items())) + "; all others: lk = 0 and det = 0")
    for pair in links.pairs:
        yield (f"rings {pair.one} and {pair.other}, image {' '.join(map(str, pair.image))}: "
               f"{'no lk' if pair.lk is None else f'lk = {pair.lk}'}, {value(pair.polynomial, pair.status)}, {pair.name or 'no polynomial'}")
    for group in links.groups:
        if len(group.curves) > 2 or group.wound:
            yield (f"group of {len(group.curves)} rings: " + ("it meets its own image: no polynomial" if group.wound else
                   f"{value(group.polynomial, group.status)}, {group.name or 'no polynomial'}; rings {' '.join(str(curve) for curve, _ in group.curves)}"))
    if links.closure:
        yield f"chains, closed so: {closures.WAYS[links.closure]}"
    for chain in links.chains:
        yield f"chain {chain.curve}: " + ", ".join(f"{name} ({count} of {sum(chain.names.values())})" for name, count in chain.names.items())
    if links.knots or links.chains:
        yield "a name stands for all knots or links with its polynomial: mirror images and some others are not told apart (docs/topology.md)"


def choose(reader, word):
    """The frame that --links names, and its number."""
    if word not in ("first", "last") and not word.isdecimal():
        raise frames.Refused(f"--links {word}: not first, last, or the number of a frame, from 0")
    number, found = -1, None
    for number, found in enumerate(reader.frames()):
        if word == "first" or word == str(number):
            return number, found
    if word != "last" or found is None:
        raise frames.Refused(f"--links {word}: the file has {number + 1} frames, numbered from 0")
    return number, found


def of_file(reader, word, way):
    """Lines about one frame of a file."""
    curves = reader.topology.curves
    if curves is None:
        raise frames.Refused("a vertex has more than two bonds: branched molecules have no links; allowed: chains and rings")
    if way not in (None, *closures.WAYS):
        raise frames.Refused(f"--closure {way}: allowed: {', '.join(closures.WAYS)}")
    number, frame = choose(reader, word)
    yield f"frame {number}; curves are numbered from 0, chains before rings, each by its first vertex: {len(curves)}"
    yield from lines(look(frame, curves, way))
