"""Fibers of a checkpoint or trajectory, drawn from the bonds that the file holds.

A bond is drawn once in every image of the box that it passes through, clipped to the box: a bond across a face leaves the
picture there and comes in at the other side. A vertex without bonds is drawn as a bead. Near things cover far ones, each
with a rim of the background's colour, so that the eye sees who passes before whom.
"""
import dataclasses
import io
import math
import os
import re

os.environ.setdefault("HDF5_USE_FILE_LOCKING", "FALSE")  # a run that is still going locks its trajectory
import h5py  # noqa: E402
import numpy  # noqa: E402
from PIL import Image, ImageDraw  # noqa: E402

from . import style  # noqa: E402

LATTICE_UNIT = 2.0**-40  # a0
WIDTH, HEIGHT = 900, 800
MOST_VECTORS = 8000  # pieces of bonds; more are drawn as pixels
MOST_FRAMES = 80
FRAMES_PER_SECOND = 15
BEAD = 0.28  # a0, about the hydrodynamic radius of a vertex
CORE = 0.4  # width of a hollow stroke's core
WHITE = (255, 255, 255)


@dataclasses.dataclass
class Structure:
    """What stays the same from frame to frame. Rows are vertices, without the solvent."""
    path: str
    edges: numpy.ndarray  # [3], a0
    kinds: list  # names
    kind: numpy.ndarray  # [rows] numbers of kinds
    bonds: numpy.ndarray  # [bonds][2] rows
    fiber: numpy.ndarray  # [rows] numbers of fibers, from 0 in the order of rows
    scene: str

    @property
    def rings(self):
        """Numbers of the kinds whose fibers are closed: they have as many bonds as vertices."""
        bonds = numpy.bincount(self.kind[self.bonds[:, 0]], minlength=len(self.kinds))
        return set(numpy.flatnonzero(bonds == numpy.bincount(self.kind, minlength=len(self.kinds))).tolist())

    @property
    def diameters(self):
        """Of each kind, a0: what its scene says after the kind's name. 0: a thin line, or nothing is said."""
        found = []
        for name in self.kinds:
            text = re.search(rf"name:\s*[\"']?{re.escape(name)}\b.*?(?=name:|\Z)", self.scene, re.S)
            number = re.search(r"^[^#]*\bdiameter:\s*(\d+\.?\d*(?:[eE][+-]?\d+)?)", text[0], re.M) if text else None
            found.append(float(number[1]) if number else 0.0)
        return found

    @property
    def beads(self):
        """Rows without a bond."""
        bonded = numpy.zeros(len(self.kind), bool)
        bonded[self.bonds.ravel()] = True
        return numpy.flatnonzero(~bonded)


def components(rows, bonds):
    """Number of the fiber of each row: rows that bonds connect are one fiber."""
    first = list(range(rows))

    def root(v):
        while first[v] != v:
            first[v] = first[first[v]]
            v = first[v]
        return v

    for a, b in bonds:
        a, b = root(int(a)), root(int(b))
        first[max(a, b)] = min(a, b)
    return numpy.unique([root(v) for v in range(rows)], return_inverse=True)[1]


def _structure(path, group, bonds, edges, scene):
    names = h5py.check_enum_dtype(group["species"].dtype) or {}
    names = {number: name for name, number in names.items()}
    species = group["species"][:]
    solid = numpy.flatnonzero([names.get(s) != "solvent" for s in species])
    row_of = {int(i): k for k, i in enumerate(group["id"][:][solid])}
    pairs = [(row_of[int(a)], row_of[int(b)]) for a, b in bonds] if bonds is not None else []
    pairs = numpy.array(pairs, int).reshape(-1, 2)
    present = sorted(set(species[solid].tolist()))
    kind = numpy.searchsorted(present, species[solid])
    return Structure(path, numpy.array(edges, float), [names.get(s, f"kind {s}") for s in present], kind, pairs,
                     components(len(solid), pairs), scene), solid


def _text(dataset):
    value = dataset[()]
    return value.decode(errors="replace") if isinstance(value, bytes) else str(value)


class File:
    """A checkpoint or trajectory that is open: .structure, .steps, .times, .positions(frame) [rows][3] in a0."""

    def __init__(self, path):
        self.file = h5py.File(path, "r")
        try:
            read = self._open_checkpoint if "state/vertex_position" in self.file else self._open_trajectory
            read(path)
        except (KeyError, IndexError) as error:
            self.file.close()
            raise ValueError(f"{path}: neither a trajectory nor a checkpoint: {error}") from error

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.file.close()

    def _open_checkpoint(self, path):
        group = self.file["structure"]
        self.structure, self.rows = _structure(path, group, group["bonds"][:], group.attrs["cells"],
                                               _text(self.file["scene"]))
        self.steps = numpy.array([self.file["state"].attrs["step"]])
        self.times = self.steps * group.attrs["time_step"]
        self.value, self.unit = self.file["state/vertex_position"][:][None], LATTICE_UNIT

    def _open_trajectory(self, path):
        group = self.file["particles/trajectory"]
        bonds = self.file["connectivity/bonds"][:] if "connectivity/bonds" in self.file else None
        edges = numpy.diag(group["box/edges/value"][0])
        scene = _text(self.file["parameters/uncross/scene"]) if "parameters/uncross/scene" in self.file else ""
        self.structure, self.rows = _structure(path, group, bonds, edges, scene)
        self.value, self.unit = group["position/value"], 1.0
        self.steps, self.times = group["position/step"][:], group["position/time"][:]

    def positions(self, frame):
        return self.value[frame][self.rows] * self.unit

    def slide(self, frame):
        """How far the image beyond y = L of a sheared box has slid along x, a0: the strain times L."""
        shear = re.search(r"(?m)^shear:(.*\n?(?:[ \t]+.*\n?)*)", self.structure.scene)
        keys = dict(re.findall(r"\b(rate|period): *([-+.\deE]+)", shear[1])) if shear else {}
        try:
            rate, period = float(keys.get("rate", 0.0)), float(keys.get("period", 0.0))
        except ValueError:
            return 0.0
        time = float(self.times[frame])
        phase = 2.0 * math.pi * time / period if period > 0.0 else 0.0
        return rate * self.structure.edges[1] * (math.sin(phase) * period / (2.0 * math.pi) if period > 0.0 else time)


# --- geometry ----------------------------------------------------------------------------------------------------------

def folded(structure, points, slide=0.0):
    """Places in the box. slide: that of the image beyond y = L along x."""
    edges, places = structure.edges, points.copy()
    places[:, 0] -= slide * numpy.floor(places[:, 1] / edges[1])
    return places - edges * numpy.floor(places / edges)


def pieces(structure, points, slide=0.0):
    """(ends [n][2][3] within the box, number of the bond [n]): the parts of bonds in each image of the box."""
    edges = structure.edges
    slide -= edges[0] * round(slide / edges[0])
    a = points[structure.bonds[:, 0]]
    step = points[structure.bonds[:, 1]] - a
    step -= edges * numpy.round(step / edges)  # the shortest image: bonds are below half the shortest edge
    a = folded(structure, a, slide)
    ends, numbers = [], []
    images = numpy.stack(numpy.meshgrid(*[[-1, 0, 1]] * 3, indexing="ij"), -1).reshape(-1, 3)
    for image in images:
        start = a - image * edges - numpy.array([slide * image[1], 0.0, 0.0])
        with numpy.errstate(divide="ignore", invalid="ignore"):
            faces = numpy.stack([-start / step, (edges - start) / step])
        outside = (step == 0.0) & ((start < 0.0) | (start >= edges))
        enter = numpy.fmax(numpy.nanmax(numpy.where(step == 0.0, -numpy.inf, faces.min(axis=0)), axis=1), 0.0)
        leave = numpy.fmin(numpy.nanmin(numpy.where(step == 0.0, numpy.inf, faces.max(axis=0)), axis=1), 1.0)
        inside = numpy.flatnonzero((enter < leave) & ~outside.any(axis=1))
        ends.append(start[inside, None] + numpy.stack([enter, leave], 1)[inside, :, None] * step[inside, None])
        numbers.append(inside)
    return numpy.concatenate(ends), numpy.concatenate(numbers)


class Camera:
    """Perspective view of the box from a corner above."""

    def __init__(self, edges):
        self.edges = edges
        turn, tilt = math.radians(28.0), math.radians(20.0)
        across = numpy.array([math.cos(turn), -math.sin(turn), 0.0])
        into = numpy.array([math.sin(turn), math.cos(turn), 0.0])
        up = numpy.array([0.0, 0.0, 1.0])
        self.axes = numpy.stack([across, math.cos(tilt) * up + math.sin(tilt) * into,
                                 math.cos(tilt) * into - math.sin(tilt) * up])
        self.distance = 3.4 * edges.max()
        corners = self.corners()
        self.scale, self.middle = 1.0, numpy.zeros(2)
        flat = self(corners)[:, :2]
        low, high = flat.min(axis=0), flat.max(axis=0)
        self.scale = min(0.96 * WIDTH / (high - low)[0], 0.96 * HEIGHT / (high - low)[1])
        self.middle = numpy.array([WIDTH, HEIGHT]) / 2 - self.scale * (low + high) / 2
        depth = self.depth(corners)
        self.near, self.far = depth.min(), depth.max()

    def corners(self):
        return numpy.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * self.edges

    def depth(self, points):
        return (points - self.edges / 2) @ self.axes[2]

    def __call__(self, points):
        """[n][4]: picture coordinates in pixels, size of one a0 in pixels, nearness from 0 (far) to 1 (near)."""
        x, y, depth = ((points - self.edges / 2) @ self.axes.T).T
        size = self.scale * self.distance / (self.distance + depth)
        flat = numpy.stack([x, -y], 1) * size[:, None] + self.middle
        near = 0.0 if self.scale == 1.0 else (self.far - depth) / (self.far - self.near)
        return numpy.column_stack([flat, size, numpy.broadcast_to(near, size.shape)])


# --- what is drawn -----------------------------------------------------------------------------------------------------

def _rgb(text):
    return tuple(int(text[k:k + 2], 16) for k in (1, 3, 5))


def _mix(colour, other, weight):
    return tuple(round(weight * c + (1.0 - weight) * o) for c, o in zip(colour, other))


def marked_fiber(structure):
    """The fiber that stands out where all are alike: the middle one of a single kind of 10 or more; or -1."""
    fibers = int(structure.fiber.max(initial=-1)) + 1
    return fibers // 2 if len(structure.kinds) == 1 and fibers >= 10 and len(structure.bonds) else -1


def fiber_colours(structure):
    """One colour for each fiber: of its kind, in shades that part neighbours; the marked one in the second colour."""
    marked = marked_fiber(structure)
    kind_of = numpy.zeros(int(structure.fiber.max(initial=-1)) + 1, int)
    kind_of[structure.fiber] = structure.kind
    colours = []
    for fiber, kind in enumerate(kind_of):
        own = _rgb(style.COLORS[kind % len(style.COLORS)])
        colours.append(_rgb(style.COLORS[1]) if fiber == marked else _mix(own, WHITE, (1.0, 0.68, 0.84)[fiber % 3]))
    return colours


def is_hollow(kind):
    """Every second kind has a white core: so kinds differ in grey, too."""
    return kind % 2 == 1


@dataclasses.dataclass
class Mark:
    """A stroke from a to b, or a disc if they are one; in pixels."""
    near: float
    a: tuple
    b: tuple
    width: float
    colour: tuple
    number: int  # of the bond, or of the bead's row
    hollow: bool = False


def marks(structure, points, camera, slide=0.0):
    """All bonds and beads as they are painted, far ones first."""
    ends, bond = pieces(structure, points, slide)
    beads = structure.beads
    colours, marked = fiber_colours(structure), marked_fiber(structure)
    line = min(0.16, 0.05 + 0.8 / max(1.0, len(structure.kind))**0.5)  # a0, for what has no diameter
    thick = [diameter or line for diameter in structure.diameters]
    found = []
    flat = camera(ends.reshape(-1, 3)).reshape(-1, 2, 4)
    for piece, number in zip(flat, bond):
        fiber = structure.fiber[structure.bonds[number, 0]]
        near = piece[:, 3].mean()
        kind = structure.kind[structure.bonds[number, 0]]
        width = max(1.0, thick[kind] * piece[:, 2].mean()) * (2.0 if fiber == marked and thick[kind] == line else 1.0)
        colour = _mix(colours[fiber], WHITE, 1.0 if fiber == marked else 0.4 + 0.6 * near)
        found.append(Mark(near, tuple(piece[0, :2]), tuple(piece[1, :2]), width, colour, int(number),
                          is_hollow(kind)))
    inside = folded(structure, points[beads], slide)
    for place, row in zip(camera(inside) if len(beads) else (), beads):
        colour = _mix(colours[structure.fiber[row]], WHITE, 0.4 + 0.6 * place[3])
        found.append(Mark(place[3], tuple(place[:2]), tuple(place[:2]), max(2.0, 2 * BEAD * place[2]), colour, int(row),
                          is_hollow(structure.kind[row])))
    return sorted(found, key=lambda mark: mark.near)


def box_lines(camera):
    """(pairs of points behind the fibers, pairs before them): edges of the box."""
    corners = camera.corners()
    flat = camera(corners)
    far = int(numpy.argmin(flat[:, 3]))
    pairs = [(i, j) for i in range(8) for j in range(i) if (corners[i] != corners[j]).sum() == 1]
    drawn = [((tuple(flat[i, :2]), tuple(flat[j, :2])), far in (i, j)) for i, j in pairs]
    return [pair for pair, back in drawn if back], [pair for pair, back in drawn if not back]


BOX = (150, 158, 170)


def _hex(colour):
    return "#%02x%02x%02x" % colour


def draw_svg(structure, found, camera, title):
    """SVG text. Each bond's pieces are paths of class b, with its number as data-n; beads are circles."""
    def frame(pairs):
        return [f'<path d="M{a[0]:.1f} {a[1]:.1f}L{b[0]:.1f} {b[1]:.1f}" stroke="{_hex(BOX)}"/>' for a, b in pairs]

    back, front = box_lines(camera)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" stroke-linecap="round">',
           f"<title>{title}</title>", f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>', *frame(back)]
    for m in found:
        if m.a == m.b:
            at = f'<circle cx="{m.a[0]:.1f}" cy="{m.a[1]:.1f}" r='
            out.append(f'{at}"{m.width / 2:.1f}" fill="{_hex(m.colour)}" stroke="#fff" stroke-width="1.4" data-n="{m.number}"/>'
                       + (f'{at}"{CORE * m.width / 2:.1f}" fill="#fff"/>' if m.hollow else ""))
            continue
        way = f"M{m.a[0]:.1f} {m.a[1]:.1f}L{m.b[0]:.1f} {m.b[1]:.1f}"
        out.append(f'<path d="{way}" stroke="#fff" stroke-width="{m.width + 2:.1f}" stroke-linecap="butt"/>'
                   f'<path class="b" data-n="{m.number}" d="{way}" stroke="{_hex(m.colour)}" stroke-width="{m.width:.1f}"/>'
                   + (f'<path d="{way}" stroke="#fff" stroke-width="{CORE * m.width:.1f}"/>' if m.hollow else ""))
    return "\n".join(out + frame(front) + ["</svg>"])


def draw_pixels(found, camera, width):
    """The same as an image, drawn larger and made smaller, so that lines are smooth."""
    scale = 2 * width / WIDTH
    image = Image.new("RGB", (round(WIDTH * scale), round(HEIGHT * scale)), WHITE)
    pen = ImageDraw.Draw(image)

    def stroke(a, b, colour, thick):
        pen.line([scale * a[0], scale * a[1], scale * b[0], scale * b[1]], fill=colour, width=max(1, round(scale * thick)))

    def disc(at, radius, colour):
        x, y = scale * at[0], scale * at[1]
        pen.ellipse([x - scale * radius, y - scale * radius, x + scale * radius, y + scale * radius], fill=colour)

    back, front = box_lines(camera)
    for a, b in back:
        stroke(a, b, BOX, 1.0)
    for m in found:
        if m.a == m.b:
            disc(m.a, m.width / 2 + 0.7, WHITE)
            disc(m.a, m.width / 2, m.colour)
            if m.hollow:
                disc(m.a, CORE * m.width / 2, WHITE)
        else:
            stroke(m.a, m.b, WHITE, m.width + 2.0)
            stroke(m.a, m.b, m.colour, m.width)
            disc(m.a, m.width / 2, m.colour)
            disc(m.b, m.width / 2, m.colour)
            if m.hollow:
                stroke(m.a, m.b, WHITE, CORE * m.width)
    for a, b in front:
        stroke(a, b, BOX, 1.0)
    return image.resize((width, round(width * HEIGHT / WIDTH)), Image.LANCZOS)


# --- pictures ----------------------------------------------------------------------------------------------------------

def words(structure):
    """What the picture shows: '316 bonds of 26 fibers and 40 beads'."""
    beads = len(structure.beads)
    fibers = len(numpy.unique(structure.fiber)) - beads
    parts = [f"{len(structure.bonds)} bonds of {fibers} fibers"] if fibers else []
    return " and ".join(parts + ([f"{beads} single beads"] if beads else []))


def picture(file, frame=-1):
    """The address of a picture of one frame: vectors, or pixels where there are very many bonds."""
    structure = file.structure
    camera = Camera(structure.edges)
    found = marks(structure, file.positions(frame % len(file.steps)), camera, file.slide(frame % len(file.steps)))
    if len(found) <= MOST_VECTORS:
        return style.data_uri(draw_svg(structure, found, camera, words(structure)))
    out = io.BytesIO()
    draw_pixels(found, camera, 2 * WIDTH).save(out, "PNG")
    return style.data_uri(out.getvalue(), "image/png")


def movie(file, width=640):
    """(address of an animated picture, numbers of its frames): at most MOST_FRAMES frames, evenly spaced."""
    count = len(file.steps)
    numbers = numpy.unique(numpy.linspace(0, count - 1, min(count, MOST_FRAMES)).round().astype(int))
    camera = Camera(file.structure.edges)
    images = [draw_pixels(marks(file.structure, file.positions(n), camera, file.slide(n)), camera, width) for n in numbers]
    out = io.BytesIO()
    images[0].save(out, "WEBP", save_all=True, append_images=images[1:], duration=round(1000 / FRAMES_PER_SECOND),
                   loop=0, quality=55, method=2)
    return style.data_uri(out.getvalue(), "image/webp"), numbers
