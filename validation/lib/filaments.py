"""A filament under a force (validation/measure/filament.c): shapes, and alignment with the axis of a force that turns."""
import numpy

from lib import figures, stats
from lib.case import Verdict
from lib.runs import Run

SHAPES = (1, 30, 100, 300, 1000, 3000, 15000)  # B = F L^2/kappa
RATES = (0, 0.005, 0.015, 0.05, 0.15, 0.5)  # of the force, radians per b^2/D0 and kappa = 1; N = 11, B = 20
BENDING = 22  # b^2/D0, for a line in the figure: read off the points
STEADY = 0.05  # of L: what the ends' distance may change in the second half of the run


def runs():
    return [Run("filament-across", program=["filament", "across", 21, 0.5, 0.01, 1500, 0.1, *SHAPES], hours=0.005),
            Run("filament-turn", program=["filament", "rotating", 11, 0.5, 0.05, 20000, 20, *RATES], hours=0.003)]


def rows(results, name, key):
    """{value of the column `key`: the row}; empty without the run."""
    if name not in results:
        return {}
    table = results[name].columns
    return {float(x): {column: float(values[k]) for column, values in table.items()} for k, x in enumerate(table[key])}


def exact(verdict, measured, systematic):
    """A number without an error bar: the bound alone decides."""
    verdict.measured, verdict.tolerance = measured, stats.tolerance(0.0, systematic=systematic)
    return verdict


def verdicts(results):
    found, shapes, turns = [], rows(results, "filament-across", "B"), rows(results, "filament-turn", "rate")
    for b in (300, 3000):
        verdict = Verdict(f"media.filament.steady.{b}", f"filament at B = {b}: range of the ends' distance over L, late", 0.0,
                          f"a steady shape: below {STEADY}", STEADY)
        found.append(exact(verdict, shapes[b]["most"] - shapes[b]["least"], STEADY) if b in shapes else verdict)
    slow = Verdict("media.filament.slow", "filament in a force that turns slowly: rate of alignment with the axis, over half of that across a constant force", 1.0,
                   "averaged over a turn; 10 %", 0.1)
    found.append(exact(slow, 2.0 * turns[0.005]["decay"] / turns[0.0]["decay"], 0.1) if 0.0 in turns and 0.005 in turns else slow)
    rises = Verdict("media.filament.rises", "turns of the force that end with a larger angle to its axis than the one before, all rates", 0.0, "none: it aligns", 0.0, detects=1.0)
    if turns:
        rises.measured = sum(row["rises"] for rate, row in turns.items() if rate > 0.0)
    return [*found, rises]


def draw(results):
    figure, (left, right) = figures.plain(width=9.2, height=3.8, columns=2)
    shapes, turns = rows(results, "filament-across", "B"), rows(results, "filament-turn", "rate")
    if shapes:
        b = sorted(shapes)
        for number, (column, label) in enumerate((("ends", "distance of the ends"), ("depth", "depth"))):
            figures.points(left, b, [abs(shapes[x][column]) for x in b], None, number, label=label)
        figures.theory(left, [1, 300], [1.12418e-3 * x for x in (1, 300)], label="depth, linear: 0.00112 $B$")
        left.set(xscale="log", yscale="log", xlabel="$B = FL^2/\\kappa$", ylabel="over $L$", ylim=(5e-4, 3.0))
        figures.legend(left, loc="lower right")
    if 0.0 in turns:
        rates = sorted(rate for rate in turns if rate > 0.0)
        figures.points(right, rates, [2.0 * turns[rate]["decay"] / turns[0.0]["decay"] for rate in rates], None, 2, label="rate of alignment")
        right.axhline(1.0, color=figures.PALE, linewidth=0.8)
        x = numpy.geomspace(0.003, 0.7, 60)
        figures.theory(right, x, 1.0 / (1.0 + (BENDING * x) ** 2), label=f"one bending time of {BENDING} $b^2/D_0$")
        figures.legend(right, loc="lower left")
        right.set(xscale="log", xlabel="rate of the force ($D_0/b^2$, $\\kappa = kT b$)", ylabel="over that of slow turns", ylim=(0.0, 1.2))
    return figure
