"""The page of a trajectory's crossings: verdict, rates at all strides, the first crossing drawn, linking numbers. Its form is that of `uncross plot`."""
import collections
import os

import numpy

from uncross_plot import style
from uncross_plot.page import Figure, Rows, Section, render

from . import frame as frames
from . import links

UNIT = 2.0**frames.LATTICE_BITS
NEIGHBORS = 3  # bonds on either side that are drawn, too
MOST_RINGS = 2000  # linking numbers of more take minutes


# --- rates ----------------------------------------------------------------------------------------------------------------

def rates(survey):
    """Figure: crossings against the stride."""
    bonds = len(survey.reader.topology.bonds)
    rows = [(stride, result) for stride, result in survey.strides.items() if result.intervals]
    unit = rows[0][1].rate(bonds)[1]
    strides = numpy.array([stride for stride, _ in rows], float)
    per = numpy.array([result.rate(bonds)[0] for _, result in rows])
    counts = numpy.array([[result.crossings, result.odd, abs(result.net)] for _, result in rows], float)
    scale = numpy.array([result.rate(bonds)[0] / max(result.crossings, 1) for _, result in rows])
    with style.styled():
        figure, axes = style.plain(6.6, 3.2)
        style.points(axes, strides, per, scale * numpy.sqrt(counts[:, 0]), 0, label="crossings")
        style.points(axes, strides, scale * counts[:, 1], None, 1, label="pairs that crossed an odd number of times")
        style.points(axes, strides, scale * counts[:, 2], None, 2, label="net, its size")
        axes.set_xscale("log")
        axes.set_xticks(strides, [f"{stride:g}" for stride in strides])
        axes.minorticks_off()
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel("stride: frames between the two that are compared")
        axes.set_ylabel(f"per bond and {unit}")
        style.legend(axes)
        src = style.data_uri(style.svg(figure))
    return Figure("Crossings against the stride", src, f"Crossings per bond and {unit} at strides {', '.join(str(stride) for stride, _ in rows)}.",
                  "Frames further apart miss what crosses and comes back, and make false crossings where paths are bent. Bars: the root of the number.")


def numbers(survey):
    bonds = len(survey.reader.topology.bonds)
    rows = [(stride, r.intervals, r.crossings, r.net, r.odd, r.touched, f"{r.rate(bonds)[0]:.6g}") for stride, r in survey.strides.items() if r.intervals]
    return Rows("The same in numbers", rows, ("stride", "intervals", "crossings", "net", "odd pairs", "touched", f"per bond and {survey.strides[1].rate(bonds)[1]}"),
                "docs/topology.md has the words.", tuple(range(7)))


# --- the first crossing -----------------------------------------------------------------------------------------------------

class Scene:
    """The two bonds of a meeting and what is near along their curves, in units of length, about the place where they meet."""

    def __init__(self, topology, first, last, meeting):
        self.first, self.last, self.meeting, self.topology = first, last, meeting, topology
        self.bonds = [topology.bonds[bond] for bond in meeting.bonds]
        at = self.places(meeting.t, self.bonds[0], 0)
        self.origin = at[0] + meeting.s * (at[1] - at[0])
        self.ids = [[int(topology.ids[vertex]) for vertex in bond] for bond in self.bonds]

    def places(self, t, vertices, which):
        """which: 1 for the second bond's curve, which stands in the meeting's image."""
        image = self.meeting.image if which else (0, 0, 0)
        ends = [(f.position[vertices] + numpy.array(frames.image(f, image))).astype(float) / UNIT for f in (self.first, self.last)]
        return (1 - t) * ends[0] + t * ends[1] - getattr(self, "origin", 0.0)

    def beside(self, which):
        """Vertices along the curve, some on either side of the bond; the bond alone where curves branch."""
        a, b = (int(vertex) for vertex in self.bonds[which])
        for curve in self.topology.curves or ():
            if a in curve.vertices:
                path, k = list(curve.vertices), list(curve.vertices).index(a)
                if curve.closed:
                    return [path[j % len(path)] for j in range(k - NEIGHBORS, k + NEIGHBORS + 2)] if len(path) > 2 * NEIGHBORS + 2 else [*path, path[0]]
                return path[max(k - NEIGHBORS, 0):k + NEIGHBORS + 2]
        return [a, b]

    def axes(self):
        """Two unit vectors of the plane of both bonds when they meet, the first along the first bond; and the normal."""
        p, q = (numpy.diff(self.places(self.meeting.t, bond, which), axis=0)[0] for which, bond in enumerate(self.bonds))
        along = p / numpy.linalg.norm(p)
        normal = numpy.cross(p, q)
        normal /= numpy.linalg.norm(normal)
        return along, numpy.cross(normal, along), normal


def drawn(scene):
    """SVG: from above both bonds, and along the first, before, at and after the meeting."""
    x, y, z = scene.axes()
    at, (above, along) = scene.meeting.t, ("along the normal of both bonds", "along the first bond")
    with style.styled():
        figure, panels = style.plain(6.6, 3.3, 2)
        for which, bond in enumerate(scene.bonds):
            color = style.COLORS[which]
            near, ends = scene.places(at, scene.beside(which), which), scene.places(at, bond, which)
            panels[0].plot(near @ x, near @ y, color=color, linewidth=1.0, alpha=0.5, marker="o", markersize=2.5)
            panels[0].plot(ends @ x, ends @ y, color=color, linewidth=2.6, marker="o", markersize=4.5, label=" ".join(map(str, scene.ids[which])))
        panels[0].plot([0], [0], color=style.INK, marker="x", markersize=8, linestyle="none")
        size = 1.6 * max(numpy.abs(scene.places(at, bond, which)).max() for which, bond in enumerate(scene.bonds))
        panels[0].set_xlim(-size, size)
        panels[0].set_ylim(-size, size)
        panels[1].plot([0], [0], color=style.COLORS[0], marker="o", markersize=6, linestyle="none", label="first bond")
        for t, stroke, word in ((0.0, "--", "frame before"), (at, "-", f"{at:.3g} of the way"), (1.0, ":", "frame after")):
            here = scene.places(t, scene.bonds[0], 0)
            place = here[0] + scene.meeting.s * (here[1] - here[0])
            ends = scene.places(t, scene.bonds[1], 1) - place
            panels[1].plot(ends @ y, ends @ z, color=style.COLORS[1], linestyle=stroke, linewidth=1.8, label=word)
        for panel, title in zip(panels, (above, along)):
            panel.set_aspect("equal", adjustable="box" if panel is panels[0] else "datalim")
            panel.set_title(title, fontsize=8.5)
            panel.legend(fontsize=7)
        return style.svg(figure)


def first_crossing(survey, where):
    """Figure of the first crossing; nothing where there is none."""
    if "crossed" not in survey.worst:
        return []
    _, first, last, meeting = survey.worst["crossed"]
    scene = Scene(survey.reader.topology, first, last, meeting)
    text = where(survey, "crossed")
    return [Figure("The first crossing", style.data_uri(drawn(scene)), f"The two bonds of the {text}.",
                   f"{text[:1].upper()}{text[1:]}. Lengths are those of the file, from the place where the bonds meet. Left: the bonds thick, with the vertices on "
                   "either side along their curves, when they meet. Right: the point of the first bond at which they meet stays in the middle; the second bond goes through it.")]


# --- linking numbers ----------------------------------------------------------------------------------------------------------

def linking(survey):
    """Table: how many pairs of rings, with images, have which linking number, in the first frame and in the last."""
    curves = survey.reader.topology.curves or []
    rings = sum(curve.closed for curve in curves)
    if rings == 0 or rings > MOST_RINGS:
        return []
    try:
        first, last = (links.linking_numbers(frame, curves) for frame in (survey.begin, survey.end))
    except frames.Refused as refused:
        return [Rows("Linking numbers", [(str(refused),)])]
    before, after = (collections.Counter(found.values()) for found in (first, last))
    rows = [(f"{number:+d}", before[number], after[number]) for number in sorted(before.keys() | after.keys())]
    changed = sum(first.get(pair, 0) != last.get(pair, 0) for pair in first.keys() | last.keys())
    words = f"Pairs of {rings} rings, each image for itself, whose linking number is not 0. " + (
        f"It has changed for {changed} of them: rings went through each other." if changed else "It has not changed for any.") + " 0 does not mean unlinked."
    return [Rows("Linking numbers", rows or [("none but 0", 0, 0)], ("lk", "pairs in the first frame", "pairs in the last frame"), words, (0, 1, 2))]


# --- all of it ----------------------------------------------------------------------------------------------------------------

def html(survey, lines, verdict, where):
    """lines: of the file; where: a meeting in words."""
    front = [("Verdict", verdict.removeprefix("verdict: ")), ("What was read", "; ".join(lines) + "."),
             *([("What to know of it", [f"{len(survey.reader.said)} thing{'s' if len(survey.reader.said) > 1 else ''}:", *survey.reader.said])] if survey.reader.said else [])]
    crossings = [rates(survey), numbers(survey)] if survey.strides[1].intervals else []
    return render(f"Crossings in {os.path.basename(survey.path)}", front,
                  [Section("Crossings", crossings + first_crossing(survey, where)), Section("Links", linking(survey))])
