"""Figures of the claims, in the one style of all figures (python/uncross_plot/style.py)."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
import numpy  # noqa: E402
from matplotlib.colors import to_rgb as rgb  # noqa: E402, F401
from matplotlib.container import ErrorbarContainer  # noqa: E402
from uncross_plot import style  # noqa: E402
from uncross_plot.style import (  # noqa: E402, F401
    COLORS, INK, MARKERS, PALE, STROKES, legend, line, plain, points, styled, theory, with_residuals)


def outside(figure):
    """Points (figures.points) that lie outside of their axes, where nobody would see them: [(label, x, y)]."""
    found = []
    for axes in figure.axes:
        (left, right), (low, high) = sorted(axes.get_xlim()), sorted(axes.get_ylim())
        for bars in axes.containers:
            if isinstance(bars, ErrorbarContainer) and bars.lines[0] is not None:
                x, y = (numpy.asarray(values, float) for values in bars.lines[0].get_data())
                hidden = numpy.isfinite(x) & numpy.isfinite(y) & ~((left <= x) & (x <= right) & (low <= y) & (y <= high))
                found += [(bars.get_label(), float(one), float(other)) for one, other in zip(x[hidden], y[hidden])]
    return found


def svg(figure):
    """The figure as SVG text; an error if it does not show all points that are drawn."""
    hidden = outside(figure)
    if hidden:
        raise ValueError(f"points outside of the axes: {hidden}")
    return style.svg(figure)


def legend_above(*panels, columns=2):
    """One legend of all these panels above the first, where it covers nothing; a label that several have stands once."""
    found = {}
    for panel in panels:
        for handle, label in zip(*panel.get_legend_handles_labels()):
            found.setdefault(label, handle)
    if found:
        panels[0].legend(found.values(), found.keys(), loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.2, ncols=columns)


def named(axes, label, **look):
    """An entry of the legend for what is drawn otherwise, such as a kind of line that several series have."""
    axes.plot([], [], **{"color": INK, "linestyle": "none", "label": label, **look})
