"""Figures that look alike and come out the same to the byte."""
import io
import re

import matplotlib
import numpy
matplotlib.use("svg")
from matplotlib import pyplot, ticker  # noqa: E402

# Distinguishable without colours, too, if each has its marker.
COLORS = ("#0b5394", "#c0392b", "#2e7d32", "#8e5ea2", "#b26a00", "#00838f", "#6d4c41", "#444444")
MARKERS = "osD^vP*X"
STYLE = {
    "svg.hashsalt": "uncross", "svg.fonttype": "path", "font.family": "DejaVu Sans", "font.size": 9.5,
    "mathtext.fontset": "dejavusans", "axes.spines.top": False, "axes.spines.right": False, "axes.linewidth": 0.8,
    "axes.labelsize": 10, "axes.titlesize": 10, "axes.prop_cycle": matplotlib.cycler(color=COLORS),
    "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.5, "legend.frameon": False, "legend.fontsize": 8.5,
    "lines.linewidth": 1.4, "lines.markersize": 4.5, "errorbar.capsize": 2, "figure.dpi": 110,
    "figure.constrained_layout.use": True, "xtick.direction": "in", "ytick.direction": "in",
}


def styled():
    """A context in which all figures are drawn."""
    return matplotlib.rc_context(STYLE)


def with_residuals(width=6.6, height=5.0, columns=1, share=0.3):
    """(figure, panels, residual panels): a row of panels, and under each a flatter one for residuals, with the same x."""
    figure, axes = pyplot.subplots(2, columns, figsize=(width, height), sharex="col", squeeze=False,
                                   gridspec_kw={"height_ratios": [1.0, share]})
    for below in axes[1]:
        below.axhline(0.0, color="#444444", linewidth=0.8)
    return (figure, *axes) if columns > 1 else (figure, axes[0][0], axes[1][0])


def plain(width=6.6, height=4.0, columns=1):
    """(figure, axes): a row of panels, or one."""
    figure, axes = pyplot.subplots(1, columns, figsize=(width, height))
    return figure, axes


def points(axes, x, y, errors=None, number=0, **options):
    """Measured points with error bars, in the number-th colour and marker."""
    style = {"color": COLORS[number % len(COLORS)], "marker": MARKERS[number % len(MARKERS)], "linestyle": "none",
             "elinewidth": 1.0}
    bars = None if errors is None else numpy.abs(errors)  # relative to something that came out negative, they may be, too
    return axes.errorbar(x, y, yerr=bars, **{**style, **options})


def theory(axes, x, y, **options):
    """A line of theory, or of the paper."""
    return axes.plot(x, y, **{"color": "#222222", "linestyle": "-", "linewidth": 1.1, "zorder": 1, **options})


def readable(axis):
    """A logarithmic scale of less than two decades gets labels at 1, 2 and 5 of each. Without this it would have one label or none."""
    low, high = axis.get_view_interval()
    if axis.get_scale() == "log" and isinstance(axis.get_major_locator(), ticker.LogLocator) and high < 100.0 * low:
        axis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter(ticker.FuncFormatter(lambda x, _: f"{x:g}"))
        axis.set_minor_formatter(ticker.NullFormatter())


def legend(axes, **options):
    """A legend, where there is something to name: runs may be missing."""
    if axes.get_legend_handles_labels()[0]:
        axes.legend(**options)


def svg(figure):
    """The figure as SVG text without date, version or XML prologue; closes it."""
    for axes in figure.axes:
        readable(axes.xaxis)
        readable(axes.yaxis)
    out = io.StringIO()
    figure.savefig(out, format="svg", metadata={"Date": None, "Creator": None})
    pyplot.close(figure)
    text = out.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.S)
    return text[text.index("<svg"):]
