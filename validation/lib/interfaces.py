"""Surfaces of dissipative particles: two liquids that do not mix, droplets of one in the other, a liquid beside its vapour.
Units a0 = kT = m = t0 = 1."""
import math

import numpy

from lib import figures, stats
from lib.case import Verdict
from lib.media import fill, mean_of, warren
from lib.runs import Run

SLAB = (8, 16, 8)  # of two liquids: a 25 within, 50 between, rho 3
LIQUID = (5, 16, 5)  # of a liquid and its vapour
DENSITY = 3.2        # on average there: half of the box is liquid
DROPS = (3, 10, 4, 12, 5, 14)  # radius, edge
TOLMAN = 0.2         # a0: how far the surface of tension may be from the equimolar one
FIT, KNOWN = 2.06, 7.5  # of Groot and Warren's fit, a 25 and 50; of Warren's many-body liquid, as later papers have it


def runs():
    pairs = "order: kick-split\ncrossing: {forbidden: false}\nmedium: {kind: pairs, rate: 9, draw: relax, weight: quadratic, "
    slab = (f"box: {list(SLAB)}\ntime_step: 0.04\n{pairs}density: 3, repulsion: 25, second: {{share: 0.5, repulsion: 50, start: slab}}}}\n"
            "observe: {pressure: {every: 5}}\n")
    liquid = (f"box: {list(LIQUID)}\ntime_step: 0.01\n{pairs}density: {DENSITY}, repulsion: -40, many_body: {{repulsion: 25}}}}\n"
              "observe: {from: 4000, pressure: {every: 10}, profile: {every: 20, slabs: 64}}\n")
    return [Run("slab", scene=slab, steps=6000, hours=0.005), Run("many-slab", scene=liquid, steps=12000, hours=0.012),
            Run("drops", program=["droplet", 25, 50, 100, 1, *DROPS], hours=0.012)]


def tension(results, name, length, first):
    """(sigma, error) of both surfaces of a slab across y: (L/2) <p_yy - (p_xx + p_zz)/2>."""
    if name not in results:
        return None
    table = results[name].table("pressure")
    value, error = mean_of(table["p_yy"] - 0.5 * (table["p_xx"] + table["p_zz"]), first)
    return 0.5 * length * value, 0.5 * length * error


def profile(results):
    """(y from the middle of the liquid, density) of the liquid beside its vapour; None without the run."""
    if "many-slab" not in results or "profile" not in results["many-slab"].tables():
        return None
    table = results["many-slab"].table("profile")
    y, density, length = table["y"], table["density"], LIQUID[1]
    phase = 2.0 * math.pi * y / length
    middle = math.atan2((density * numpy.sin(phase)).sum(), (density * numpy.cos(phase)).sum()) * length / (2.0 * math.pi)
    away = (y - middle + 0.5 * length) % length - 0.5 * length
    order = numpy.argsort(away)
    return away[order], density[order]


def liquid_density(results):
    """(density, error) within 2 a0 of the middle; the error is that of slabs that touch, one in three being independent."""
    found = profile(results)
    if found is None:
        return None
    inner = found[1][abs(found[0]) < 2.0]
    return float(inner.mean()), float(inner.std(ddof=1) / math.sqrt(len(inner) / 3.0))


def root(low, high):
    """The density between these at which Warren's fit has no pressure: that of a liquid whose vapour weighs nothing."""
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if warren(middle) < 0.0 else (low, middle)
    return low


def drops(results):
    return results["drops"].columns if "drops" in results else None


def verdicts(results):
    planar, table = tension(results, "slab", SLAB[1], 0.1), drops(results)
    found = [fill(Verdict("media.tension.planar", "tension between liquids of DPD, a = 25 within and 50 between, ρ = 3", FIT, "Groot and Warren (1997), their fit: 5 %",
                          0.05 * FIT, kind="paper"), planar, 0.05 * FIT)]
    for number, radius in enumerate(DROPS[::2]):
        expected = planar[0] if planar else FIT
        allowed = 2.0 * TOLMAN / radius * expected
        verdict = Verdict(f"media.tension.drop{radius}", f"ΔpR/2 of a droplet, R = {radius}", expected, "Laplace, with the tension of the flat surface; 2 · 0.2 a0/R",
                          allowed, expected_error=planar[1] if planar else 0.0)
        pair = (table["tension"][number], table["tension_error"][number]) if table is not None and len(table["tension"]) > number else None
        found.append(fill(verdict, pair, allowed, expected_error=verdict.expected_error, values=16))
    density = root(5.0, 7.0)
    found.append(fill(Verdict("media.many.liquid", "density of the many-body liquid beside its vapour, A = −40, B = 25, r_d = 0.75", density,
                              "where the pressure of Warren's fit is 0; 2 %", 0.02 * density, kind="paper"), liquid_density(results), 0.02 * density))
    found.append(fill(Verdict("media.many.tension", "its tension", KNOWN, "Warren's liquid, as quoted in the literature, from memory; 5 %", 0.05 * KNOWN, kind="paper"),
                      tension(results, "many-slab", LIQUID[1], 1.0 / 3.0), 0.05 * KNOWN, values=16))
    return found


def draw(results):
    """Density of the liquid and its vapour; pressure of droplets against 1/R."""
    figure, (left, right) = figures.plain(width=9.2, height=3.8, columns=2)
    found = profile(results)
    if found is not None:
        figures.points(left, *found, None, 0, label="many-body liquid", markersize=3.5)
        figures.theory(left, [-3.0, 3.0], [root(5.0, 7.0)] * 2, label="no pressure, Warren's fit", zorder=5)
    left.set(xlabel="$y$ from the middle ($a_0$)", ylabel="density ($a_0^{-3}$)")
    figures.legend_above(left, columns=1)
    table, planar = drops(results), tension(results, "slab", SLAB[1], 0.1)
    if table is not None:
        figures.points(right, 1.0 / table["radius"], table["difference"], table["difference_error"], 1, label="droplets")
    if planar is not None:
        x = numpy.linspace(0.0, 0.4, 2)
        figures.theory(right, x, 2.0 * float(planar[0]) * x, label="$2\\sigma/R$ with σ of the flat surface")
    right.set(xlabel="$1/R$ ($1/a_0$)", ylabel="$p$ inside less outside ($kT/a_0^3$)", xlim=(0.0, 0.4), ylim=(0.0, None))
    figures.legend_above(right, columns=1)
    return figure
