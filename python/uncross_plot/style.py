"""The one style of all figures of uncross: pages of runs, claims, benchmarks, demo. Figures come out the same to the byte.

    from uncross_plot import style
    with style.styled():
        figure, axes = style.plain()
        style.points(axes, x, y, errors, 0, label="g")
        style.legend(axes)
        text = style.svg(figure)

Series are told apart three times over: by colour (of different lightness, and different for colour-blind eyes), by marker,
and by the stroke of the line. So they can be told apart in grey, too.
"""
import base64
import contextlib
import functools
import io
import os
import re

import numpy


@contextlib.contextmanager
def _away():
    """In a folder of ours, without settings of the user and of the environment: matplotlib reads them when it is imported, and those
    of the current folder, which may be somebody else's, before all others."""
    kept = {name: os.environ.pop(name, None) for name in ("MPLBACKEND", "MATPLOTLIBRC")}
    os.environ["MATPLOTLIBRC"] = os.devnull
    with contextlib.ExitStack() as stack:
        with contextlib.suppress(OSError):  # there may be no current folder any more
            folder = os.open(".", os.O_RDONLY | os.O_CLOEXEC)
            stack.callback(os.close, folder)
            stack.callback(os.fchdir, folder)
        os.chdir(os.path.dirname(os.path.abspath(__file__)))
        yield
    os.environ.pop("MATPLOTLIBRC")
    os.environ.update({name: value for name, value in kept.items() if value is not None})


with _away():
    import matplotlib
    matplotlib.use("svg")
    from matplotlib import pyplot, textpath, ticker

# Matplotlib makes a parser of formulas for each figure, which reads the same labels again. All figures share one, and its cache.
if hasattr(textpath, "MathTextParser"):
    textpath.MathTextParser = functools.lru_cache(textpath.MathTextParser)

COLORS = ("#004488", "#d55e00", "#009e73", "#882255", "#b8860b", "#56a0d9", "#6d4c41", "#777777")
MARKERS = "os^DvP*X"
STROKES = ("-", (0, (5, 1.6)), (0, (1.2, 1.2)), (0, (6, 1.5, 1.2, 1.5)), (0, (3, 1, 1, 1, 1, 1)), (0, (8, 2)),
           (0, (2, 2)), (0, (8, 1.5, 1.2, 1.5)))
INK, PALE = "#222222", "#888888"  # of theory and frames; of what is secondary
# Sizes are those of print: a figure 6.6 inches wide fills the text of an A4 page, and its letters are 9 points there.
STYLE = {
    "svg.hashsalt": "uncross", "svg.fonttype": "path", "font.family": "DejaVu Sans", "font.size": 9,
    "mathtext.fontset": "dejavusans", "axes.spines.top": False, "axes.spines.right": False, "axes.linewidth": 0.8,
    "axes.edgecolor": INK, "axes.labelsize": 9.5, "axes.titlesize": 9.5, "axes.titlelocation": "left",
    "axes.prop_cycle": matplotlib.cycler(color=COLORS), "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.5,
    "axes.axisbelow": True, "axes.formatter.use_mathtext": True, "axes.formatter.limits": (-3, 4),
    "legend.frameon": False, "legend.fontsize": 8.5, "legend.handlelength": 2.6, "lines.linewidth": 1.4,
    "lines.markersize": 4.5, "errorbar.capsize": 2, "figure.dpi": 110, "savefig.dpi": 160,
    "figure.constrained_layout.use": True, "xtick.direction": "in", "ytick.direction": "in",
}


def styled():
    """A context in which all figures are drawn."""
    return matplotlib.rc_context(STYLE)


def plain(width=6.6, height=4.0, columns=1, rows=1):
    """(figure, axes): a row of panels, rows of them, or one."""
    return pyplot.subplots(rows, columns, figsize=(width, height))


def with_residuals(width=6.6, height=5.0, columns=1, share=0.3):
    """(figure, panels, residual panels): a row of panels, and under each a flatter one for residuals, with the same x."""
    figure, axes = pyplot.subplots(2, columns, figsize=(width, height), sharex="col", squeeze=False,
                                   gridspec_kw={"height_ratios": [1.0, share]})
    for below in axes[1]:
        below.axhline(0.0, color=INK, linewidth=0.8)
    return (figure, *axes) if columns > 1 else (figure, axes[0][0], axes[1][0])


def points(axes, x, y, errors=None, number=0, **options):
    """Measured points with error bars, in the number-th colour and marker. Open and filled markers take turns, so that a
    later series does not hide an earlier one."""
    color = options.get("color", COLORS[number % len(COLORS)])
    look = {"color": color, "marker": MARKERS[number % len(MARKERS)], "linestyle": "none", "elinewidth": 1.0,
            "markerfacecolor": color if number % 2 == 0 else "none"}
    known = errors is not None and numpy.isfinite(errors).any()
    bars = numpy.abs(errors) if known else None  # relative to something that came out negative, they may be, too
    return axes.errorbar(x, y, yerr=bars, **{**look, **options})


def line(axes, x, y, number=0, **options):
    """A measured curve without error bars, in the number-th colour and stroke."""
    return axes.plot(x, y, **{"color": COLORS[number % len(COLORS)], "linestyle": STROKES[number % len(STROKES)],
                              "linewidth": 1.2, **options})


def theory(axes, x, y, **options):
    """A line of theory, or of the paper."""
    return axes.plot(x, y, **{"color": INK, "linestyle": "-", "linewidth": 1.1, "zorder": 1, **options})


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
    engine = figure.get_layout_engine()
    if engine is not None:  # once; savefig would do it twice
        engine.execute(figure)
        figure.set_layout_engine("none")
    out = io.StringIO()
    figure.set_dpi(pyplot.rcParams["savefig.dpi"])
    # Not savefig, which draws everything once more beforehand.
    figure.canvas.print_svg(out, metadata={"Date": None, "Creator": None})
    pyplot.close(figure)
    text = out.getvalue()
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.S)
    return text[text.index("<svg"):]


def data_uri(content, kind="image/svg+xml"):
    """An image as the address that a page may hold instead of a file's. SVG in pages goes this way, too: the names inside
    of one picture then cannot meet those of another."""
    raw = content.encode() if isinstance(content, str) else content
    return f"data:{kind};base64," + base64.b64encode(raw).decode()
