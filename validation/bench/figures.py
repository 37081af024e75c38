"""Figures of bench.json, one per section, as SVG. A section of which nothing was measured has none."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
from uncross_plot import style  # noqa: E402
from matplotlib import pyplot  # noqa: E402

SERIES = ("paper", "kick-split", "drift-split", "kick-split, event-driven", "drift-split, event-driven")
RULES = {"sequential": "", "event-driven": ", event-driven"}  # and how rows name them
GRAY = style.PALE
WIDE = 6.6  # inches: the text of a sheet


def select(rows, pattern):
    """(numbers x, values, spreads) of the rows whose name is this pattern, with a number in its group."""
    found = []
    for name, row in rows.items():
        match = re.fullmatch(pattern, name)
        if match:
            found.append((float(match.group(1)), row["value"], row["spread"] or 0.0))
    return tuple(zip(*sorted(found))) or ((), (), ())


def points(axes, series, number=0, **look):
    x, y, error = series
    style.points(axes, x, y, error, number, **{"linestyle": style.STROKES[number], "linewidth": 1, **look})


def logarithmic_x(axes, ticks):
    axes.set_xscale("log")
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()


def save(figure, out, name):
    (out / name).write_text(style.svg(figure), encoding="utf-8")


def panels(height, *, head=0.0):
    """(figure, four panels, head or None): two rows of two panels, and above them a strip of so many inches for a legend."""
    rows = [["head", "head"]] * bool(head) + [["a", "b"], ["c", "d"]]
    shares = [head] * bool(head) + [0.5 * (height - head)] * 2
    figure, axes = pyplot.subplot_mosaic(rows, figsize=(WIDE, height), gridspec_kw={"height_ratios": shares})
    figure.get_layout_engine().set(wspace=0.06, hspace=0.06)
    if head:
        axes["head"].axis("off")
    return figure, [axes[name] for name in "abcd"], axes.get("head")


def speed(rows, out):
    figure, (alone, over, density, size), _ = panels(5.6)
    points(alone, select(rows, r"speed/solvent (\d+)\^3"), label="measured")
    for mb, stroke in ((12, ":"), (600, "--")):
        floor = 128 / rows[f"floor/triad of {mb} MB"]["value"]
        alone.axhline(floor, linestyle=stroke, color=GRAY, label=f"128 bytes, triad of {mb} MB")
    alone.set(xlabel="edge of the box ($a_0$)", ylabel="ns per particle and collision", title="solvent alone")
    alone.set_ylim(0, 1.75 * max(select(rows, r"speed/solvent (\d+)\^3")[1]))  # room for the legend
    for number, (rule, named) in enumerate(RULES.items()):
        points(over, select(rows, rf"speed/cL\^3 = (\d+){named} over solvent"), number, label=rule)
        points(density, select(rows, rf"detection/cL\^3 = (\d+) in 32\^3{named}"), number, label=rule)
        points(size, select(rows, rf"detection/(\d+) vertices at cL\^3 = 300{named}"), number, label=rule)
    over.plot((100, 1000), (1.5, 8), "v", color=GRAY, label="wanted at most, sequential")
    over.set(xlabel="cL³", ylabel="time over the solvent's", title="fibers of 64 vertices, $dt$ 0.01", yscale="log")
    density.set(xlabel="cL³", ylabel="ns per vertex and step", title="crossing detection in 32³ cells")
    size.set(xlabel="vertices", ylabel="ns per vertex and step", title="crossing detection at cL³ = 300")
    logarithmic_x(over, (30, 100, 300, 1000))
    logarithmic_x(density, (30, 100, 300, 1000))
    logarithmic_x(size, (3000, 10000, 30000))
    for axes in (density, size):
        axes.set_ylim(bottom=0)
    for axes in (alone, over, density):
        axes.legend(loc="upper left")
    size.legend(loc="lower right")
    save(figure, out, "bench-speed.svg")


def scaling(rows, out):
    figure, axes, _ = panels(5.4)
    titles = (("solvent, box", "edge ($a_0$)", "solvent", (8, 16, 32, 64)),
              ("cL^3 = 300, box", "edge ($a_0$)", "cL³ = 300 in solvent", (16, 24, 32, 48)),
              ("fibers alone, cL^3", "cL³", "fibers alone", (10, 100, 1000)),
              ("6400 vertices alone, fiber length", "vertices per fiber", "6400 vertices alone", (8, 32, 128)))
    for panel, (name, label, title, ticks) in zip(axes, titles):
        points(panel, select(rows, f"scaling/{re.escape(name)} (\\d+)"), label="alone")
        power = f"{rows[f'scaling/exponent, {name}']['value']:.2f}".replace("-", "−")
        panel.set(xlabel=label, ylabel="ms per step", title=f"{title}: exponent {power}")
        logarithmic_x(panel, ticks)
    low, high = axes[3].get_ylim()
    axes[3].set_ylim(0.3 * low, 3 * high)
    for panel in axes:
        panel.set_yscale("log")
    save(figure, out, "bench-scaling.svg")


def precision(rows, out):
    figure, (dilute, dense, motion, drifts), head = panels(6.4, head=0.6)
    for number, order in enumerate(SERIES):
        dt, value, error = select(rows, f"precision/stiffest, {order}, dt ([0-9.]+)")
        like = order if order != "paper" else "kick-split"
        for panel, density in ((dilute, 100), (dense, 1000)):
            steps, seconds, _ = select(rows, f"precision/cost, cL\\^3 = {density}, {like}, dt ([0-9.]+)")
            cost = dict(zip(steps, seconds))
            points(panel, ([cost[step] for step in dt], [v - 1.0 for v in value], error), number)
            if order == "kick-split":
                for step, v in zip(dt, value):
                    panel.annotate(f"{step:g}", (cost[step], v - 1.0), (5, 2), textcoords="offset points", fontsize=8,
                                   color=style.COLORS[number])
        points(motion, select(rows, f"precision/g\\(10 t0\\), {order}, dt ([0-9.]+)"), number)
        drift(drifts, select(rows, f"precision/drift, refused, {order}, dt ([0-9.]+)"), number)
        points(head, ((), (), ()), number, label=order)
    for panel, title in ((dilute, "cL³ = 100 in 32³ cells"), (dense, "cL³ = 1000 in 16³ cells")):
        panel.axhspan(-0.01, 0.01, color=GRAY, alpha=0.25, linewidth=0)
        panel.set_yscale("symlog", linthresh=0.01, linscale=0.6)
        panel.set_yticks((-0.1, -0.01, 0, 0.01, 0.1), ("−0.1", "−0.01", "0", "0.01", "0.1"))
        panel.set(xlabel="CPU s per $t_0$", ylabel="error of the stiffest mode", title=title, ylim=(-0.12, 0.8))
        panel.margins(x=0.12)
    motion.axhline(1, color=GRAY, linestyle="--")
    motion.set(xlabel="$dt$ ($t_0$)", ylabel="$g(10\\,t_0)$ over its reference")
    drifts.set(xlabel="$dt$ ($t_0$)", ylabel="energy drift ($kT$ per $t_0$ and freedom)", yscale="log", ylim=(1e-8, 1))
    logarithmic_x(motion, (0.0025, 0.005, 0.01, 0.02))
    logarithmic_x(drifts, (0.0025, 0.005, 0.01, 0.02, 0.04))
    head.legend(loc="center", ncols=3)
    save(figure, out, "bench-precision.svg")


def drift(axes, series, number):
    """Drifts with their errors. Where a drift is less than two errors, an arrow: at most the drift and two errors."""
    sure = [row for row in zip(*series) if row[1] > 2 * row[2]]
    limits = [(dt, abs(value) + 2 * error) for dt, value, error in zip(*series) if value <= 2 * error]
    points(axes, tuple(zip(*sure)) or ((), (), ()), number, linestyle="none")
    if limits:
        dt, most = zip(*limits)
        style.points(axes, dt, most, [0.6 * m for m in most], number, uplims=True)


def efficiency(rows, out):
    start, end = "efficiency/", ", CPU for 1 %"
    price = {name[len(start):-len(end)]: row["value"] for name, row in rows.items()
             if name.startswith(start) and name.endswith(end)}
    kinds = ("viscosity", "vertex", "chain")
    names = sorted(price, key=lambda name: (-kinds.index(name.split(",")[0]), -price[name]))
    figure, axes = style.plain(WIDE, 0.24 * len(names) + 1)
    for number, kind in enumerate(kinds):
        some = [name for name in names if name.split(",")[0] == kind]
        style.points(axes, [price[name] for name in some], [names.index(name) for name in some], number=number,
                     markersize=6)
    axes.set_yticks(range(len(names)), [name.replace("^3", "³") for name in names])
    axes.set(xscale="log", xlabel="CPU s for an error of 1 % (0.3 %: 11 times as many)", xlim=(1, 1000))
    save(figure, out, "bench-efficiency.svg")


def draw(rows, out):
    with style.styled():
        for figure in (speed, scaling, precision, efficiency):
            if any(name.startswith(figure.__name__ + "/") for name in rows):
                figure(rows, out)
