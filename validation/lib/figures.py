"""Figures of the claims, in the one style of all figures (python/uncross_plot/style.py)."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
from matplotlib.colors import to_rgb as rgb  # noqa: E402, F401
from uncross_plot.style import (  # noqa: E402, F401
    COLORS, INK, MARKERS, PALE, STROKES, legend, line, plain, points, styled, svg, theory, with_residuals)


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
