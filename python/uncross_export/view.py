"""What of a file is printed, and where: numbers of rows and fibers, places in the cell, numbers as text."""
import math


def real(x):
    """In the fewest digits that read back to it, of 15, 16 or 17: as tables have them (text_shortest, src/base/text.c)."""
    for form in "%.15g", "%.16g":
        text = form % x
        if float(text) == x:
            return text
    return "%.17g" % x


def reals(numbers):
    return " ".join(map(real, numbers))


def name(text):
    """Of a kind: no character has a meaning in any format."""
    return text.translate(dict.fromkeys(map(ord, "\" \t\r\n=\\:"), "_"))


def _fold(x, edge):
    """Into [0, edge). Files of others may hold any numbers that are finite."""
    ratio = x / edge
    r = x - edge * (float(math.floor(ratio)) if math.isfinite(ratio) else ratio)
    return r if r < edge else 0.0


def _round(x):
    return math.copysign(math.floor(abs(x) + 0.5), x) if abs(x) < 2.0**52 else x  # else it is whole, or no number


def fibers(file):
    """For each particle (fiber, place along it), both from 0; (-1, -1) for solvent. Fibers are numbered in the order of their first
    rows. Open ones begin where no bond leads to; what is left then are rings. In a file of another program bonds may lead
    anywhere: a row keeps the first place that it gets."""
    place = [(-1, -1)] * file.particles
    reached = {row for row in file.next if row >= 0}
    for rings in False, True:
        for first in range(file.particles):
            if file.is_solvent(first) or not (rings or first not in reached):
                continue
            row, along = first, 0
            while row >= 0 and place[row][0] < 0:
                place[row], along, row = (first, along), along + 1, file.next[row]
    number = {row: k for k, row in enumerate(row for row in range(file.particles) if place[row][1] == 0)}
    return [(number.get(first, -1), along) for first, along in place]


class View:
    """A file, and the frame at hand. number: {row: its number among those that are printed, from 0}."""

    def __init__(self, path, file, solvent, wrapped):
        self.path, self.file, self.wrapped, self.frame = path, file, wrapped, None
        self.fibers, self.previous = fibers(file), {b: a for a, b in enumerate(file.next) if b >= 0}
        solid = [row for row in range(file.rows) if not file.is_solvent(row)]
        self.solvent = solvent or not solid  # it is shown: asked for, or there is nothing else
        self.shown = range(file.rows) if self.solvent else solid
        self.number = self.shown if self.solvent else {row: k for k, row in enumerate(solid)}  # of all rows: each its own

    def place(self, row):
        """(x, image): folded into the cell along the edges that are periodic, if that is asked for, and how many of each edge were
        taken off."""
        f, image = self.frame, [0.0, 0.0, 0.0]
        x = list(f.position[3 * row:3 * row + 3])
        for k in (2, 1, 0) if self.wrapped else ():  # x is last: it slides when y is folded
            begin = 0.0 if k else f.tilt * (x[1] / f.edge[1])
            folded = _fold(x[k] - begin, f.edge[k]) + begin
            if f.periodic[k]:
                image[k], x[k] = _round((x[k] - folded) / f.edge[k]), folded
            if k == 1:
                x[0] -= image[1] * f.tilt
        return x, image

    def velocity(self, row, image):
        """Of the image that is shown: in a sheared box slower by the speed of the images between."""
        u = self.frame.velocity[3 * row:3 * row + 3]
        return (u[0] - image[1] * self.frame.speed, u[1], u[2])

    def has_bond(self, row):
        """With both ends printed."""
        return row < self.file.particles and row in self.number and self.file.next[row] in self.number
