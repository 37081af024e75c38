"""Trajectories of any code as frames on the lattice (frame.py). A reader has

topology   the bonds;
said       sentences that its user must know, about what was made of the file; more may come with frames;
rounding   how far positions as they are stored may be from those of the code, in units of length; 0 if they are doubles;
frames()   the frames, one by one;
close()"""
import collections
import contextlib
import itertools
import math
import re

import numpy

from uncross_export import frames as own

from .frame import LATTICE_BITS, Frame, Refused, Topology, curves, on_lattice

# A frame as a file has it. ids: None if rows are in order. edge: None without a box. tilt: of the second edge along x. position: real [N][3];
# image: whole numbers [N][3], None if positions may be wrapped, or 0 if they are not.
Raw = collections.namedtuple("Raw", "step time ids edge periodic tilt position image")

SHORTEST = 2**20  # lattice units: of a bond, so that rounding is below 10^-6 of it
DIGITS = 15  # as many are taken for a double
NO_BONDS = ("{}: has no bonds; give them with --bonds FILE (LAMMPS data, or two numbers of atoms on each line), or say with --chain N or --ring N "
            "that each N atoms which follow one another are a chain or a ring")


# --- bonds ----------------------------------------------------------------------------------------------------------------

def read_bonds(path):
    """Pairs of atoms' numbers: the section Bonds of LAMMPS data, or all lines."""
    pairs, inside, is_data = [], True, False
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = file.readlines()
    titles = [k for k, line in enumerate(lines) if re.match(r"\s*Bonds\b(\s*#.*)?$", line)]
    if titles:
        is_data, inside = True, False
    for number, line in enumerate(lines, 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        if is_data and words[0][0].isalpha():
            inside = words == ["Bonds"]
            continue
        if not inside:
            continue
        try:
            if len(words) != (4 if is_data else 2):
                raise ValueError
            pairs.append([int(word) for word in words[-2:]])
            if max(map(abs, pairs[-1])) >= 2**62:
                raise ValueError
        except ValueError:
            raise Refused(f"{path}:{number}:1: no bond; allowed: {'number, type and two atoms' if is_data else 'two numbers of atoms'}") from None
    if not pairs:
        raise Refused(f"{path}: has no bonds")
    return numpy.array(pairs)


def in_order(ids, length, closed):
    """Each `length` that follow one another."""
    if len(ids) % length:
        raise Refused(f"{len(ids)} atoms are no multiple of {length}, which --{'ring' if closed else 'chain'} says")
    rows = numpy.sort(ids).reshape(-1, length)
    following = numpy.roll(rows, -1, axis=1)
    pairs = numpy.stack([rows, following], axis=-1)
    return (pairs if closed else pairs[:, :-1]).reshape(-1, 2)


def make_topology(pairs, path):
    """Only atoms with bonds are vertices."""
    pairs = numpy.unique(numpy.sort(numpy.asarray(pairs, dtype=numpy.int64), axis=1), axis=0)
    if numpy.any(pairs[:, 0] == pairs[:, 1]):
        raise Refused(f"{path}: a bond leads from an atom to itself")
    ids, rows = numpy.unique(pairs, return_inverse=True)
    bonds = rows.reshape(-1, 2).astype(numpy.int32)
    found = curves(bonds, len(ids))
    if found:  # a sign is of bonds that lead along their curve
        after = numpy.full(len(ids), -1)
        for curve in found:
            after[curve.vertices[:-1]] = curve.vertices[1:]
            if curve.closed:
                after[curve.vertices[-1]] = curve.vertices[0]
        turned = after[bonds[:, 0]] != bonds[:, 1]
        bonds[turned] = bonds[turned][:, ::-1]
    return Topology(ids, bonds, found)


# --- what all other codes' files go through ---------------------------------------------------------------------------------

class Reader:
    """raw: the frames as the file has them. about: what else it says, as soon as the first frame was read: "pairs", "rounding". first_id: of the
    first row where the file has no ids."""

    def __init__(self, path, raw, about, options, first_id):
        self.path, self.said, self.first_id = path, [], first_id
        self.first = next(raw, None)
        if self.first is None:
            raise Refused(f"{path}: has no frame")
        self.raw = itertools.chain([self.first], raw)
        pairs, self.rounding = about.get("pairs"), about.get("rounding", 0.0)
        ids = self._ids(self.first)
        if len(numpy.unique(ids)) != len(ids):
            raise Refused(f"{path}: two atoms of a frame have one number")
        for name, closed in ("--chain", False), ("--ring", True):
            if name in options:
                pairs = in_order(ids, int(options[name]), closed)
        if "--bonds" in options:
            pairs = read_bonds(options["--bonds"])
        if pairs is None:
            raise Refused(NO_BONDS.format(path))
        self.topology = make_topology(pairs, path)
        self.slides = False

    def _ids(self, raw):
        return raw.ids if raw.ids is not None else numpy.arange(len(raw.position)) + self.first_id

    def _say(self, text):
        if text not in self.said:
            self.said.append(text)

    def _rows(self, ids):
        """Of the vertices, in the order of the topology."""
        if not len(ids):
            raise Refused(f"{self.path}: a frame has no atoms")
        order = numpy.argsort(ids, kind="stable")
        found = numpy.searchsorted(ids, self.topology.ids, sorter=order)
        rows = order[numpy.minimum(found, len(ids) - 1)]
        lost = self.topology.ids[ids[rows] != self.topology.ids]
        if len(lost):
            raise Refused(f"{self.path}: atom {lost[0]} has a bond, and is not in a frame")
        return rows

    def frames(self):
        before = None
        for raw in self.raw:
            edge = [0, 0, 0] if raw.edge is None else on_lattice(raw.edge).tolist()
            periodic = [False] * 3 if raw.edge is None else list(raw.periodic)
            if any(p and e <= 0 for p, e in zip(periodic, edge)):
                raise Refused(f"{self.path}: an edge of the box is not above 0")
            rows = self._rows(self._ids(raw))
            position = on_lattice(raw.position[rows])
            slide = int(on_lattice(raw.tilt))
            if raw.image is not None and not isinstance(raw.image, int):
                image = raw.image[rows].astype(numpy.int64)
                position += image * numpy.array(edge)
                position[:, 0] += image[:, 1] * slide
            if before and (slide != before.offset or self.slides):  # as a file has it, modulo Lx
                self.slides = True
                slide = before.offset + nearest(slide - before.offset, edge[0])
                self._say("the box leans by another length in each frame. The file gives this length only up to whole edges of the box: the nearest was taken; a box that is sheared "
                          "by half an edge or more between two frames is read wrong")
            frame = Frame(raw.step, raw.time, edge, periodic, slide, None, position)
            if raw.image is None and any(periodic):
                frame = self._unwrapped(frame, before)
            if not before:
                look_at_bonds(self.path, frame, self.topology)
            before = frame
            yield frame

    def close(self):
        self.raw = None

    def _unwrapped(self, frame, before):
        """Along bonds at first, then from frame to frame."""
        position = frame.position.copy()
        if before:
            position = before.position + nearest_image(position - before.position, frame)
        else:
            walk(self.topology, lambda here, there: position.__setitem__(there, position[here] + nearest_image((frame.position[there] - position[here])[None], frame)[0]))
        if not numpy.array_equal(position, frame.position):
            self._say("positions are wrapped into the box, without numbers of images: each was taken to be where it is nearest to its place in the frame "
                      "before (at first: to its neighbor along the bond); a vertex that moves half a box between two frames is read wrong")
        return frame._replace(position=position)

def look_at_bonds(path, frame, topology):
    if numpy.median(numpy.abs(frame.position[topology.bonds[:, 1]] - frame.position[topology.bonds[:, 0]]).max(axis=1)) < SHORTEST:
        raise Refused(f"{path}: most bonds are shorter than {SHORTEST} units of the lattice, 2^-{LATTICE_BITS} of a unit of length; scale the file's lengths "
                      "so that a bond is about 1")
    bonds, edges = topology.bonds, [e for e, p in zip(frame.edge, frame.periodic) if p]
    way = numpy.abs(frame.position[bonds[:, 1]] - frame.position[bonds[:, 0]])
    for axis in range(3):
        if edges and frame.periodic[axis] and numpy.any(2 * way[:, axis] > frame.edge[axis]):
            a, b = topology.ids[bonds[numpy.argmax(way[:, axis])]]
            raise Refused(f"{path}: the bond {a} {b} is longer than half an edge of the box; it leads through the box, or numbers of images are wrong")


def nearest_image(way, frame):
    """Of ways [N][3]: the image that is the shortest along each periodic edge."""
    way = way.copy()
    for axis in (2, 1, 0):
        if frame.periodic[axis]:
            turns = (2 * way[:, axis] + frame.edge[axis]) // (2 * frame.edge[axis])
            way[:, axis] -= turns * frame.edge[axis]
            if axis == 1:
                way[:, 0] -= turns * frame.offset
    return way


def nearest(way, edge):
    return way - (2 * way + edge) // (2 * edge) * edge if edge else way


def walk(topology, visit):
    """visit(here, there) along bonds: each vertex but the first of its group is `there` once, after it was reached."""
    neighbors = [[] for _ in topology.ids]
    for a, b in topology.bonds.tolist():
        neighbors[a].append(b)
        neighbors[b].append(a)
    seen = [False] * len(neighbors)
    for first in range(len(neighbors)):
        todo = [] if seen[first] else [first]
        seen[first] = True
        while todo:
            here = todo.pop()
            for there in neighbors[here]:
                if not seen[there]:
                    seen[there] = True
                    visit(here, there)
                    todo.append(there)


# --- text -------------------------------------------------------------------------------------------------------------------

class Lines:
    """Of a text file, with their number."""

    def __init__(self, path):
        self.path, self.number, self.file = path, 0, open(path, "rb")

    def line(self):
        self.number += 1
        return self.file.readline()

    def whole(self, what):
        word = self.line().strip()
        if not word.isdigit() or len(word) > 18:
            raise self.wrong(f"{what}: no whole number from 0 on")
        return int(word)

    def rows(self, count, what):
        lines = list(itertools.islice(self.file, count))
        self.number += len(lines)
        if len(lines) < count:
            raise self.wrong(f"the file ends within {what}")
        return lines

    def wrong(self, text):
        return Refused(f"{self.path}:{max(self.number, 1)}:1: {text}")

    def table(self, count, columns, what, wanted):
        """Columns, by their places, of so many lines with so many words each: reals [count][wanted]. And the lines."""
        lines = self.rows(count, what)
        with contextlib.suppress(ValueError, IndexError):
            if count == 0:
                return numpy.zeros((0, len(wanted))), lines
            if len(lines[0].split()) == columns:
                return numpy.loadtxt(lines, usecols=wanted, ndmin=2, comments=None), lines
        begin = self.number - count
        for k, line in enumerate(lines, 1):
            words = line.split()
            self.number = begin + k
            if len(words) != columns:
                raise self.wrong(f"{len(words)} columns; {what} have {columns}")
            for column in wanted:
                if not is_number(words[column]):
                    raise self.wrong(f"column {column + 1} is no number")
        raise self.wrong("no numbers")


def digits(word):
    """Significant digits as they are written."""
    return len(re.sub(rb"[eE].*|[^0-9]", b"", word).lstrip(b"0"))


def rounding_of(lines, columns, position):
    """Of decimal numbers: half of the last digit of the largest, if they have fewer than a double. What the first lines have is taken for all."""
    most = max((digits(words[k]) for words in (line.split() for line in lines[:1000]) for k in columns), default=DIGITS)
    if not numpy.all(numpy.isfinite(position)):
        raise Refused("a coordinate is no number, or beyond all bounds")
    largest = float(numpy.max(numpy.abs(position), initial=0.0))
    return 0.5 * 10.0 ** (math.floor(math.log10(largest)) + 1 - most) if most < DIGITS and largest > 0 else 0.0


def is_number(word):
    with contextlib.suppress(ValueError):
        return math.isfinite(float(word))
    return False


def lammps(path, about):
    """A dump of style atom or custom."""
    file, step, time, count, box = Lines(path), None, None, None, None
    while True:
        line = file.line()
        if not line:
            return
        item, _, rest = line.strip().partition(b":")
        words = rest.split()
        if item != b"ITEM" or not words:
            raise file.wrong("no ITEM of a LAMMPS dump")
        if words[0] == b"TIMESTEP":
            step = file.whole("TIMESTEP")
        elif words[0] == b"TIME":
            time = float(file.table(1, 1, "TIME", [0])[0][0, 0])
        elif words[:2] == [b"NUMBER", b"OF"]:
            count = file.whole("NUMBER OF ATOMS")
        elif words[:2] == [b"BOX", b"BOUNDS"]:
            leans = words[2:5] == [b"xy", b"xz", b"yz"]
            bounds, _ = file.table(3, 3 if leans else 2, "BOX BOUNDS", range(3 if leans else 2))
            periodic = [word == b"pp" for word in words[5 if leans else 2:]] or [True] * 3
            tilt, *others = bounds[:, 2] if leans else (0.0, 0.0)
            if any(others):
                raise file.wrong("a box that leans along z; allowed: xy only")
            low, high = bounds[:, 0].copy(), bounds[:, 1].copy()
            low[0] -= min(0.0, tilt)
            high[0] -= max(0.0, tilt)
            box = low, high - low, periodic, tilt
        elif words[0] == b"ATOMS":
            if count is None or box is None:
                raise file.wrong("ATOMS before NUMBER OF ATOMS and BOX BOUNDS")
            yield Raw(step, time, *_atoms(file, about, words[1:], count, *box))
            time = None
        elif words[0] == b"UNITS":
            file.line()
        else:
            raise file.wrong(f"an unknown ITEM: {rest.strip().decode(errors='replace')}")


def _atoms(file, about, names, count, low, edge, periodic, tilt):
    names = [name.decode(errors="replace") for name in names]
    ways = {"xu": ("xu", "yu", "zu"), "xsu": ("xsu", "ysu", "zsu"), "x": ("x", "y", "z"), "xs": ("xs", "ys", "zs")}
    way = next((ways[name] for name in ways if set(ways[name]) <= set(names)), None)
    if not way:
        raise file.wrong(f"ATOMS have no positions; allowed: {', '.join(' '.join(columns) for columns in ways.values())}")
    flags = [name for name in ("ix", "iy", "iz") if name in names] if way[0] in ("x", "xs") else []
    ids = ["id"] if "id" in names else []
    values, lines = file.table(count, len(names), "atoms", [names.index(name) for name in (*way, *flags, *ids)])
    position = values[:, :3]
    if "rounding" not in about:
        about["rounding"] = rounding_of(lines, [names.index(name) for name in way], position) * (max(edge) if "s" in way[0] else 1.0)
    if "s" in way[0]:
        position = position * edge + low
        position[:, 0] += values[:, 1] * tilt
    image = 0 if way[0] in ("xu", "xsu") else numpy.rint(values[:, 3:6]) if len(flags) == 3 else None
    return values[:, -1].astype(numpy.int64) if ids else None, edge, periodic, tilt, position, image


def _lattice(file, words):
    """Of nine numbers: edges, and how much the second leans along x."""
    if len(words) != 9 or not all(map(is_number, words)):
        raise file.wrong("Lattice is not nine numbers")
    cell = numpy.array(words, dtype=float).reshape(3, 3)
    tilt = cell[1, 0]
    if numpy.any(cell != [[cell[0, 0], 0, 0], [tilt, cell[1, 1], 0], [0, 0, cell[2, 2]]]):
        raise file.wrong("a box that leans; allowed: a second edge that leans along x only")
    return numpy.diag(cell), tilt


def xyz(path, about):
    """XYZ, or extended XYZ."""
    file = Lines(path)
    while True:
        line = file.line()
        if not line:
            return
        if not line.strip():
            continue
        if not line.strip().isdigit():
            raise file.wrong("no number of atoms")
        keys = dict((a.lower(), b.strip('"')) for a, b in re.findall(r'(\w+)=("[^"]*"|\S+)', file.line().decode(errors="replace")))
        columns, at = {}, 0
        kinds = keys.get("properties", "species:S:1:pos:R:3").split(":")
        for name, width in zip(kinds[0::3], kinds[2::3]):
            if not width.isdigit():
                raise file.wrong("Properties are not name:type:number of columns, and so on")
            columns[name], at = at, at + int(width)
        if "pos" not in columns:
            raise file.wrong("Properties have no pos")
        edge, tilt = _lattice(file, keys["lattice"].split()) if "lattice" in keys else (None, 0.0)
        periodic = [word[:1] in "Tt1" for word in keys.get("pbc", "T T T").split()]
        if len(periodic) != 3:
            raise file.wrong("pbc is not three words; allowed: pbc=\"T T T\"")
        extra = [name for name in ("id", "next") if name in columns]
        places = [columns["pos"] + k for k in range(3)] + [columns[name] for name in extra]
        values, lines = file.table(int(line), at if "properties" in keys else _width(file), "atoms", places)
        if "rounding" not in about:
            about["rounding"] = rounding_of(lines, places[:3], values[:, :3])
        ids = values[:, 3].astype(numpy.int64) if "id" in columns else None
        if "next" in columns and "pairs" not in about:
            following = values[:, -1].astype(numpy.int64)
            here = numpy.arange(len(following)) if ids is None else ids
            about["pairs"] = numpy.stack([here, following], axis=1)[following >= 0]
        yield Raw(int(keys["step"]) if keys.get("step", "").isdigit() else None, float(keys["time"]) if is_number(keys.get("time", "")) else None,
                  ids, edge, periodic, tilt, values[:, :3], None)


def _width(file):
    """Columns of the next line, of a file that does not say it."""
    place = file.file.tell()
    width = len(file.file.readline().split())
    file.file.seek(place)
    return max(width, 4)


def _atoms_of(file, word):
    """VTF: "3", "3:7"."""
    match = re.fullmatch(rb"(\d+)(?::(\d+))?", word)
    if not match:
        raise file.wrong("no atoms; allowed: a number, or two and a colon between")
    return range(int(match[1]), int(match[2] or match[1]) + 1)


def _bonds_of(file, words):
    """VTF: "0:1, 4::9"."""
    for piece in b" ".join(words).replace(b" ", b"").split(b","):
        match = re.fullmatch(rb"(\d+)(::?)(\d+)", piece)
        if not match:
            raise file.wrong("no bond; allowed: two numbers and one colon between, or two colons for a chain")
        first, last = int(match[1]), int(match[3])
        yield from zip(range(first, last), range(first + 1, last + 1)) if match[2] == b"::" else [(first, last)]


def vtf(path, about):
    """VTF: structure, then frames whose coordinates are ordered or indexed."""
    file, pairs, box, position, atoms = Lines(path), [], None, None, 0
    lines, indexed = None, False

    def frame():
        nonlocal position
        if len(pairs) and "pairs" not in about:
            about["pairs"] = numpy.array(pairs)
        values = numpy.array([line.split()[:3 + indexed] for line in lines], dtype=float)
        position = numpy.full((max(atoms, len(values)), 3), numpy.nan) if position is None else position.copy()
        rows = values[:, 0].astype(int) if indexed else numpy.arange(len(values))
        if len(rows) and (numpy.min(rows) < 0 or numpy.max(rows) >= len(position) or values.shape[1] != 3 + indexed):
            raise file.wrong("coordinates of an atom that is none, or not three of them")
        position[rows] = values[:, -3:]
        if "rounding" not in about:
            about["rounding"] = rounding_of(lines, range(indexed, indexed + 3), position)
        return Raw(None, None, None, box, [True] * 3, 0.0, position, None)

    while True:
        line = file.line()
        words = line.split()
        if lines is not None and words and (words[0][:1].isdigit() or words[0][:1] in b"+-."):
            lines.append(line)
            continue
        if lines and (words and words[0][:1] != b"#" or not line):
            try:
                yield frame()
            except ValueError:
                raise file.wrong("the frame before this line has a coordinate that is no number") from None
            lines = None
        if not line:
            return
        if not words or words[0][:1] == b"#":
            continue
        if words[0] in (b"timestep", b"coordinates", b"t", b"c", b"ordered", b"indexed", b"o", b"i"):
            lines, indexed = [], words[-1] in (b"indexed", b"i")
        elif words[0] in (b"pbc", b"unitcell", b"p", b"u"):
            if len(words) not in (4, 7) or not all(map(is_number, words[1:])) or any(float(word) != 90 for word in words[4:]):
                raise file.wrong("no box; allowed: three edges, and angles of 90")
            box = numpy.array(words[1:4], dtype=float)
        elif words[0] in (b"bond", b"b"):
            pairs += _bonds_of(file, words[1:])
        elif words[0] in (b"atom", b"a") and len(words) > 1 and words[1] != b"default":
            atoms = max([atoms] + [_atoms_of(file, word)[-1] + 1 for word in words[1].split(b",")])


# --- HDF5 -------------------------------------------------------------------------------------------------------------------

def h5md(path, about):
    """H5MD of other codes."""
    import h5py
    with h5py.File(path, "r") as file:
        groups = [name for name, group in file.get("particles", {}).items() if "position/value" in group]
        if not groups or len(groups) > 1 and "all" not in groups:
            raise Refused(f"{path}: {'several groups of' if groups else 'no'} particles with positions; allowed: one group, or one that is called all")
        particles = file["particles"]["all" if "all" in groups else groups[0]]
        tables = [table for table in file.get("connectivity", {}).values() if isinstance(table, h5py.Dataset) and table.ndim == 2 and table.shape[1] == 2]
        if tables:
            about["pairs"] = numpy.concatenate([table[:] for table in tables])
        value = particles["position/value"]
        if value.dtype.itemsize < 8:
            largest = float(numpy.max(numpy.abs(value[0]), initial=0.0))
            about["rounding"] = float(numpy.spacing(value.dtype.type(largest))) / 2
        boundary = [word.decode() if isinstance(word, bytes) else word for word in particles["box"].attrs.get("boundary", ["none"] * 3)]
        at = lambda name, frame: None if name not in particles else particles[name][()] if isinstance(particles[name], h5py.Dataset) else particles[name + "/value"][frame]
        for frame in range(len(value)):
            edge = at("box/edges", frame)
            if edge is not None and edge.ndim == 2:
                if numpy.any(edge != numpy.diag(numpy.diag(edge))):
                    raise Refused(f"{path}: box/edges: a box that leans; allowed: a rectangular one")
                edge = numpy.diag(edge)
            step, time = (_of_frame(particles["position"], name, frame) for name in ("step", "time"))
            yield Raw(None if step is None else int(step), None if time is None else float(time), at("id", frame), edge, [word == "periodic" for word in boundary],
                      0.0, value[frame].astype(float), at("image", frame))


def _of_frame(group, name, frame):
    """H5MD: a number for each frame, or a fixed increment."""
    if name not in group:
        return None
    values = group[name]
    return values[frame] if values.ndim else values[()] * frame + values.attrs.get("offset", 0)


class Own:
    """Trajectories and checkpoints of this program, by `uncross frames`."""

    def __init__(self, path, options):
        if "--bonds" in options or "--chain" in options or "--ring" in options:
            raise Refused(f"{path}: has its own bonds; --bonds, --chain and --ring are for files of other programs")
        self.path, self.said, self.rounding, self.file = path, [], 0.0, own.File(path)
        following = numpy.array(self.file.next)
        rows = numpy.flatnonzero(following >= 0)
        if not len(rows):
            raise Refused(f"{path}: has no bonds")
        self.topology = make_topology(numpy.stack([rows, following[rows]], axis=1), path)

    def frames(self):
        before = None
        for number in range(self.file.frames):
            try:
                f = self.file.read(number)
            except own.Damaged as damaged:
                raise Refused(str(damaged)) from None
            edge, slide, rate = on_lattice(f.edge).tolist(), int(on_lattice(f.tilt)), int(on_lattice(f.speed))
            if before:  # the file's slide is modulo Lx: the turns come from the rate
                expected = before.offset + int(0.5 * (before.rate + rate) * (f.time - before.time))
                slide = expected + nearest(slide - expected, edge[0])
                if rate != before.rate:
                    self._say("the rate of shear changes: the images of the box are taken to slide evenly from frame to frame")
            position = on_lattice(numpy.array(f.position).reshape(-1, 3)[self.topology.ids])
            frame = Frame(f.step, f.time, edge, f.periodic, slide, rate, position)
            if before and f.leans:  # a run takes fibers that leave a sheared box along y back into it
                frame = frame._replace(position=before.position + nearest_image(position - before.position, frame))
            before = frame
            yield frame

    def close(self):
        self.file.close()

    def _say(self, text):
        if text not in self.said:
            self.said.append(text)


# --- which one --------------------------------------------------------------------------------------------------------------

FORMATS = {"LAMMPS dump": (lammps, 1), "XYZ": (xyz, 1), "VTF": (vtf, 0), "H5MD": (h5md, 0)}  # with the number of the first atom


def guess(path):
    with open(path, "rb") as file:
        begin = file.read(4096)
    if begin[:8] == b"\x89HDF\r\n\x1a\n":
        return "H5MD"
    words = next((line.split() for line in begin.splitlines() if line.strip() and not line.startswith(b"#")), [])
    if words[:1] == [b"ITEM:"]:
        return "LAMMPS dump"
    if len(words) == 1 and words[0].isdigit():
        return "XYZ"
    if words and words[0] in (b"atom", b"a", b"bond", b"b", b"pbc", b"unitcell", b"timestep", b"coordinates", b"p", b"u", b"t", b"c"):
        return "VTF"
    raise Refused(f"{path}:1:1: no trajectory that is known; allowed: H5MD, {', '.join(list(FORMATS)[:3])}")


def is_own(path):
    """Of this program, or what only this program should open: where h5py is missing it is asked, too."""
    try:
        import h5py
    except ModuleNotFoundError:
        return True
    with contextlib.suppress(OSError):
        with h5py.File(path, "r") as file:
            return "parameters/uncross" in file or "state" in file or "particles" not in file
    return True


def open_file(path, options):
    name = guess(path)
    if name == "H5MD" and is_own(path):
        return Own(path, options)
    read, first_id = FORMATS[name]
    about = {}
    return Reader(path, read(path, about), about, options, first_id)
