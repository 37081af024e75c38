"""Figures of bench.json, one per section, as SVG. A section of which nothing was measured has none."""
import re

import matplotlib

matplotlib.use("Agg")
matplotlib.rcParams.update({"svg.hashsalt": "uncross", "svg.fonttype": "none", "font.size": 9, "axes.grid": True,
                            "grid.alpha": 0.3, "legend.frameon": False, "font.family": "sans-serif"})
import matplotlib.pyplot as plt
from matplotlib import ticker

COLORS = {"paper": "#b5482a", "kick-split": "#2a6fb5", "drift-split": "#3a8f4d"}
BLACK, RED, BLUE, GRAY = "black", "#b5482a", "#2a6fb5", "gray"


def select(rows, pattern):
    """(numbers x, values, spreads) of the rows whose name is this pattern, with a number in its group."""
    found = []
    for name, row in rows.items():
        match = re.fullmatch(pattern, name)
        if match:
            found.append((float(match.group(1)), row["value"], row["spread"] or 0.0))
    return tuple(zip(*sorted(found))) or ((), (), ())


def points(axes, series, **style):
    x, y, error = series
    axes.errorbar(x, y, yerr=error, marker="o", markersize=4, linewidth=1, capsize=2, **style)


def logarithmic_x(axes, ticks):
    axes.set_xscale("log")
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()


def logarithmic_y(axes):
    """Over less than two decades with 1, 2 and 5 named of each; else a scale is left with one number or none."""
    axes.set_yscale("log")
    low, high = axes.get_ylim()
    if high < 100.0 * low:
        axes.yaxis.set_major_locator(ticker.LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_major_formatter(ticker.FuncFormatter(lambda y, _: f"{y:g}"))
        axes.yaxis.set_minor_formatter(ticker.NullFormatter())


def save(figure, out, name):
    figure.tight_layout()
    figure.savefig(out / name, metadata={"Date": None})
    plt.close(figure)


def speed(rows, out):
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(11, 3.4))
    points(left, select(rows, r"speed/solvent (\d+)\^3"), color=BLACK)
    for mb, style in ((12, ":"), (600, "--")):
        floor = 128 / rows[f"floor/triad of {mb} MB"]["value"]
        left.axhline(floor, linestyle=style, color=GRAY, label=f"128 bytes, at a triad of {mb} MB")
    left.set(xlabel="edge of the box, a0", ylabel="ns per particle and collision", title="solvent alone")
    left.set_ylim(bottom=0)
    left.legend(fontsize=7)
    for rule, fill in (("", BLACK), (", event-driven", "white")):
        points(middle, select(rows, rf"speed/cL\^3 = (\d+){rule} over solvent"), color=BLACK, markerfacecolor=fill,
               label=rule[2:] or "sequential")
    middle.legend(fontsize=8)
    middle.plot((100, 1000), (1.5, 8), "v", color=GRAY, label="wanted at most")
    middle.set(xlabel="cL³", ylabel="time over the solvent's", title="fibers of 64 vertices, dt 0.01")
    logarithmic_y(middle)
    logarithmic_x(middle, (30, 100, 300, 1000))
    middle.legend()
    points(right, select(rows, r"detection/cL\^3 = (\d+) in 32\^3"), color=BLACK, label="density, in 32³ cells")
    vertices, *rest = select(rows, r"detection/(\d+) vertices at cL\^3 = 300")
    points(right, (tuple(n / 64 for n in vertices), *rest), color=RED, label="size, at cL³ = 300")
    right.set(xlabel="fibers", ylabel="ns per vertex and step", title="cost of crossing detection")
    logarithmic_x(right, (30, 100, 300, 1000))
    right.set_ylim(bottom=0)
    right.legend()
    save(figure, out, "bench-speed.svg")


def scaling(rows, out):
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.2))
    panels = (("solvent, box", "edge, a0", "solvent alone", (8, 16, 32, 64)),
              ("fibers alone, cL^3", "cL³", "fibers alone", (10, 100, 1000)),
              ("6400 vertices alone, fiber length", "vertices per fiber", "6400 vertices alone", (8, 32, 128)))
    for panel, (name, label, title, ticks) in zip(axes, panels):
        points(panel, select(rows, f"scaling/{re.escape(name)} (\\d+)"), color=BLACK)
        power = rows[f"scaling/exponent, {name}"]["value"]
        panel.set(xlabel=label, ylabel="ms per step", title=f"{title}: exponent {power:.2f}")
        logarithmic_x(panel, ticks)
    points(axes[0], select(rows, r"scaling/cL\^3 = 300, box (\d+)"), color=RED, label="cL³ = 300")
    axes[0].legend()
    low, high = axes[2].get_ylim()
    axes[2].set_ylim(0.3 * low, 3 * high)
    for panel in axes:
        logarithmic_y(panel)
    save(figure, out, "bench-scaling.svg")


def precision(rows, out):
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(11, 3.6))
    for order, color in COLORS.items():
        like = order if order != "paper" else "kick-split"
        steps, seconds, _ = select(rows, f"precision/cost, cL\\^3 = 100, {like}, dt ([0-9.]+)")
        cost = dict(zip(steps, seconds))
        dt, value, error = select(rows, f"precision/stiffest, {order}, dt ([0-9.]+)")
        points(left, ([cost[step] for step in dt], [abs(v - 1.0) for v in value], error), color=color, label=order)
        for step, v in zip(dt, value):
            if abs(v - 1.0) > 0.003:
                left.annotate(f"{step:g}", (cost[step], abs(v - 1.0)), (4, 3), textcoords="offset points", fontsize=7)
        points(middle, select(rows, f"precision/g\\(10 t0\\), {order}, dt ([0-9.]+)"), color=color, label=order)
        for rule, fill in (("", color), (", event-driven", "white")):
            dt, value, error = select(rows, f"precision/drift, refused, {order}{rule}, dt ([0-9.]+)")
            if dt:
                points(right, (dt, [abs(v) for v in value], error), color=color, label=order + rule, markerfacecolor=fill)
    left.axhline(0.01, color=GRAY, linestyle="--")
    left.set(xlabel="CPU s per t0, cL³ = 100; beside the points: dt", ylabel="|error| of the stiffest mode",
             yscale="log", ylim=(3e-4, 0.5))
    middle.axhline(1, color=GRAY, linestyle="--")
    middle.set(xlabel="dt, t0", ylabel="g(10 t0) over its reference")
    right.set(xlabel="dt, t0", ylabel="|energy drift|, kT per t0 and freedom", yscale="log", ylim=(1e-7, 1))
    for axes, ticks in ((middle, (0.0025, 0.005, 0.01, 0.02)), (right, (0.0025, 0.005, 0.01, 0.02, 0.04))):
        logarithmic_x(axes, ticks)
    for axes in (left, middle, right):
        axes.legend(fontsize=8)
    save(figure, out, "bench-precision.svg")


def efficiency(rows, out):
    start, end = "efficiency/", ", CPU for 1 %"
    price = {name[len(start):-len(end)]: row["value"] for name, row in rows.items()
             if name.startswith(start) and name.endswith(end)}
    names = sorted(price, key=price.get, reverse=True)
    names.sort(key=lambda name: ["viscosity", "vertex", "chain"].index(name.split(",")[0]), reverse=True)
    figure, axes = plt.subplots(figsize=(8, 0.26 * len(names) + 1))
    axes.barh(names, [price[name] for name in names], color=BLUE)
    axes.set(xscale="log", xlabel="CPU s for an error of 1 % (0.3 %: 11 times as many)")
    save(figure, out, "bench-efficiency.svg")


def draw(rows, out):
    for figure in (speed, scaling, precision, efficiency):
        if any(name.startswith(figure.__name__ + "/") for name in rows):
            figure(rows, out)
