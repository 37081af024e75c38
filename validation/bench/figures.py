"""Figures of bench.json, one per section, as SVG. A section of which nothing was measured has none."""
import re

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
from uncross_plot import style  # noqa: E402

ORDERS = ("paper", "kick-split", "drift-split")
GRAY = style.PALE
WIDE = 9.5  # inches of three panels


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


def speed(rows, out):
    figure, (left, middle, right) = style.plain(WIDE, 3.8, 3)
    points(left, select(rows, r"speed/solvent (\d+)\^3"), label="measured")
    for mb, stroke in ((12, ":"), (600, "--")):
        floor = 128 / rows[f"floor/triad of {mb} MB"]["value"]
        left.axhline(floor, linestyle=stroke, color=GRAY, label=f"128 bytes, at a triad of {mb} MB")
    left.set(xlabel="edge of the box ($a_0$)", ylabel="ns per particle and collision", title="solvent alone")
    left.set_ylim(bottom=0)
    left.legend(loc="lower right", fontsize=7.5)
    for number, rule in enumerate(("", ", event-driven")):
        points(middle, select(rows, rf"speed/cL\^3 = (\d+){rule} over solvent"), number, label=rule[2:] or "sequential")
    middle.plot((100, 1000), (1.5, 8), "v", color=GRAY, label="wanted at most")
    middle.set(xlabel="cL³", ylabel="time over the solvent's", title="fibers of 64 vertices, dt 0.01")
    middle.set_yscale("log")
    logarithmic_x(middle, (30, 100, 300, 1000))
    middle.legend()
    points(right, select(rows, r"detection/cL\^3 = (\d+) in 32\^3"), label="density, in 32³ cells")
    vertices, *rest = select(rows, r"detection/(\d+) vertices at cL\^3 = 300")
    points(right, (tuple(n / 64 for n in vertices), *rest), number=1, label="size, at cL³ = 300")
    right.set(xlabel="fibers", ylabel="ns per vertex and step", title="cost of crossing detection")
    logarithmic_x(right, (30, 100, 300, 1000))
    right.set_ylim(bottom=0)
    right.legend()
    save(figure, out, "bench-speed.svg")


def scaling(rows, out):
    figure, axes = style.plain(WIDE, 3.4, 3)
    panels = (("solvent, box", "edge ($a_0$)", "solvent alone", (8, 16, 32, 64)),
              ("fibers alone, cL^3", "cL³", "fibers alone", (10, 100, 1000)),
              ("6400 vertices alone, fiber length", "vertices per fiber", "6400 vertices alone", (8, 32, 128)))
    for panel, (name, label, title, ticks) in zip(axes, panels):
        points(panel, select(rows, f"scaling/{re.escape(name)} (\\d+)"), label="alone")
        power = rows[f"scaling/exponent, {name}"]["value"]
        panel.set(xlabel=label, ylabel="ms per step", title=f"{title}: exponent {power:.2f}")
        logarithmic_x(panel, ticks)
    points(axes[0], select(rows, r"scaling/cL\^3 = 300, box (\d+)"), number=1, label="cL³ = 300")
    axes[0].legend()
    low, high = axes[2].get_ylim()
    axes[2].set_ylim(0.3 * low, 3 * high)
    for panel in axes:
        panel.set_yscale("log")
    save(figure, out, "bench-scaling.svg")


def precision(rows, out):
    figure, (left, middle, right) = style.plain(WIDE, 4.2, 3)
    for number, order in enumerate(ORDERS):
        like = order if order != "paper" else "kick-split"
        steps, seconds, _ = select(rows, f"precision/cost, cL\\^3 = 100, {like}, dt ([0-9.]+)")
        cost = dict(zip(steps, seconds))
        dt, value, error = select(rows, f"precision/stiffest, {order}, dt ([0-9.]+)")
        points(left, ([cost[step] for step in dt], [abs(v - 1.0) for v in value], error), number=number, label=order)
        for step, v in zip(dt, value):
            if abs(v - 1.0) > 0.003:
                left.annotate(f"{step:g}", (cost[step], abs(v - 1.0)), (4, 3 - 11 * (number % 2)), textcoords="offset points",
                              fontsize=8, color=style.COLORS[number])
        points(middle, select(rows, f"precision/g\\(10 t0\\), {order}, dt ([0-9.]+)"), number=number, label=order)
        for more, rule in enumerate(("", ", event-driven")):
            dt, value, error = select(rows, f"precision/drift, refused, {order}{rule}, dt ([0-9.]+)")
            if dt:
                points(right, (dt, [abs(v) for v in value], error), number + 3 * more, label=order + rule)
    left.axhline(0.01, color=GRAY, linestyle="--")
    left.set(xlabel="CPU s per $t_0$, cL³ = 100\nbeside the points: $dt$ ($t_0$)", ylabel="|error| of the stiffest mode",
             yscale="log", ylim=(3e-4, 0.5))
    middle.axhline(1, color=GRAY, linestyle="--")
    middle.set(xlabel="$dt$ ($t_0$)", ylabel="$g(10\\,t_0)$ over its reference")
    right.set(xlabel="$dt$ ($t_0$)", ylabel="|energy drift| ($kT$ per $t_0$ and freedom)", yscale="log", ylim=(1e-7, 1))
    for axes, ticks in ((middle, (0.0025, 0.005, 0.01, 0.02)), (right, (0.0025, 0.005, 0.01, 0.02, 0.04))):
        logarithmic_x(axes, ticks)
    for axes in (left, middle, right):
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0))
    save(figure, out, "bench-precision.svg")


def efficiency(rows, out):
    start, end = "efficiency/", ", CPU for 1 %"
    price = {name[len(start):-len(end)]: row["value"] for name, row in rows.items()
             if name.startswith(start) and name.endswith(end)}
    names = sorted(price, key=price.get, reverse=True)
    names.sort(key=lambda name: ["viscosity", "vertex", "chain"].index(name.split(",")[0]), reverse=True)
    figure, axes = style.plain(6.6, 0.26 * len(names) + 1)
    axes.barh([name.replace("^3", "³") for name in names], [price[name] for name in names], color=style.COLORS[0])
    axes.set(xscale="log", xlabel="CPU s for an error of 1 % (0.3 %: 11 times as many)")
    save(figure, out, "bench-efficiency.svg")


def draw(rows, out):
    with style.styled():
        for figure in (speed, scaling, precision, efficiency):
            if any(name.startswith(figure.__name__ + "/") for name in rows):
                figure(rows, out)
