"""Common code of the cases with many fibers: their scenes, and the formulas that they are compared with.

Units a0 = kT = m = 1, time in t0. The paper's fiber: 64 vertices of mass 5, k = 100, l0 = 0.5, kappa = 64, so that
L = l_p = 32 by the paper's count (vertices times l0); its mean contour is 63 x 0.5385 = 33.92."""
import functools
import itertools
import math
import pathlib
import string

import numpy
from scipy import linalg, special

from lib import bending, dilute, shape, stats

BOND = (0.5**3 + 3 * 0.5 * 0.01) / (0.5**2 + 0.01)  # <l> of k = 100, l0 = 0.5: r^2 exp(-k (r - l0)^2/2) in closed form, 0.538462
BOND2 = (0.5**4 + 6 * 0.5**2 * 0.01 + 3 * 0.01**2) / (0.5**2 + 0.01)  # <l^2>, 0.299231
MASS = 5.0
SPRING = 100.0  # k, kT/a0^2
PERSISTENCE = -BOND / math.log(1.0 / math.tanh(64.0) - 1.0 / 64.0)  # -<l>/ln<cos>, 34.19
VERTEX_DIFFUSION = 0.010662  # molecular chaos: what a vertex has without hydrodynamics (src/solvent, docs/accuracy.md)
DENSITIES = (30, 100, 300, 1000)  # c L^3 of Fig. 5, which is the number of fibers in a box of edge L
PAPER_ROTATION_TIME = 8.3e4  # tau_r with hydrodynamics, Sec. IV D


TEMPLATE = pathlib.Path(__file__).resolve().parent / "fibers.yaml"
SOLVENT = "thermostat: rescale"  # with hydrodynamics: see validation/cases/tube/README.md for why
FREE_SOLVENT = "thermostat: none"
BATH = "hydrodynamics: false\n  bath: phantoms"  # without
STANDARD = {"box": 32, "dt": 0.01, "flow": 0, "solvent": SOLVENT, "vertices": 64, "forbidden": "true",
            "rule": "sequential", "refusal": "stay", "others": "",
            "frame": "laboratory", "series": 10000, "every": 50, "longest_lag": 3276800}


def scene(**values):
    """Text of fibers.yaml filled in; `count` must be given, for what else is not, see STANDARD."""
    values = {**STANDARD, **values}
    values.setdefault("persistence", values["vertices"] / 2)
    return string.Template(TEMPLATE.read_text()).substitute(values)


def frozen_network(count, vertices=64, persistence=32.0):
    """The value of `others`: a second kind, that stands still but takes the same part in the bath."""
    return (f"\n  - name: net\n    count: {count}\n    vertices: {vertices}\n    mass: 5\n    bond_length: 0.5\n    spring: 100\n"
            f"    persistence_length: {persistence}\n    frozen: true")


def mesh_size(count, length, box):
    """Eq. (34): xi = sqrt(3/(c L))."""
    return math.sqrt(3.0 * box**3 / (count * length))


def tube_width(xi, length, persistence):
    """Eq. (35): L_perp, root mean square of one transverse component."""
    x, p = xi / length, persistence / length
    return length * (0.31 * x**1.2 / p**0.2 + 0.56 * x**2)


def bending_law(t, friction, persistence=PERSISTENCE):
    """Two transverse components of an interior point's mean square displacement, before an end or a tube matters, for a
    friction per length: 2 x 2 Gamma(1/4)/(3 pi) (kT l_p t/zeta)^(3/4)/l_p."""
    return 4.0 * special.gamma(0.25) / (3.0 * math.pi) * (persistence * numpy.asarray(t) / friction)**0.75 / persistence


def crowd(vertices, count, box):
    """Vertices of other fibers per collision cell, for one of `count` fibers."""
    return (count - 1) * vertices / box**3


@functools.lru_cache
def shared_diffusion(count=1, box=32, vertices=64):
    """kT over the friction of a vertex that moves along with its whole fiber, one of `count`, without hydrodynamics,
    straight fibers.

    Bonds are half a cell long, so a collision cell holds 1.8 vertices of a fiber, and the bath brakes them together:
    less than each alone."""
    return vertices * dilute.sharing_diffusion(lambda draw: dilute.rod_shape(vertices, BOND, draw),
                                               crowd=crowd(vertices, count, box))[0]


def free_fiber(times, vertices, count, box, hydrodynamics):
    """d^2 at lags `times` of a straight fiber that crosses others freely, l_p = L, nothing fitted (lib/bending.py). With
    hydrodynamics the fiber is alone in the fluid: the effect of other fibers on the flow is left out."""
    stiffness = vertices  # kappa = l_p/l0, l_p = vertices x l0
    return bending.lone(tuple(float(t) for t in times), box, vertices, BOND, stiffness, BOND2, hydrodynamics,
                        crowd(vertices, count, box))


def rod_rotation_time(length, diameter, viscosity, volume=math.inf):
    """1/(2 D_r), D_r by Tirado and Garcia de la Torre; in a periodic box less what images take (shape.IMAGES)."""
    p = length / diameter
    rotation = 3.0 / (math.pi * viscosity * length**3) * (math.log(p) - 0.662 + 0.917 / p - 0.050 / p**2)
    return 1.0 / (2.0 * (rotation - shape.IMAGES / (viscosity * volume)))


PARTS = 24  # of a run, from which refused_moves has its errors (validation/measure/refusal.h)

# int ds ds' sqrt((1-s)^2 + s^2 + (1-s')^2 + s'^2) over the unit square.
LEVERS = 1.151155


def collision_rate(bonds, volume):
    """Bond collisions per volume and t0 of isotropic bonds with Maxwell velocities, all moving at once."""
    density = bonds / volume
    return math.pi / 8.0 * density**2 * BOND**2 * math.sqrt(2.0 / (math.pi * MASS)) * LEVERS


def table(result, name="dynamics-fiber", least=1):
    """The dynamics of a run as arrays, lags with at least so many intervals; None if there are none yet."""
    try:
        columns = result.table(name)
    except (AttributeError, KeyError):
        return None
    keep = columns["intervals"] >= least
    return {key: values[keep] for key, values in columns.items()} if keep.any() else None


def joined(*tables):
    """Tables of the same system with short lags first: of each later one, only lags longer than those before."""
    found, longest = [], 0.0
    for one in tables:
        if one is None:
            continue
        keep = one["time"] > longest * 1.001
        found.append({key: values[keep] for key, values in one.items()})
        longest = max(longest, one["time"].max())
    return {key: numpy.concatenate([one[key] for one in found]) for key in found[0]} if found else None


def at(columns, name, time):
    """(value, error) of a column at a lag; None where it is not."""
    if columns is None:
        return None
    k = numpy.flatnonzero(numpy.abs(columns["time"] - time) < 1e-6 * time)
    return (float(columns[name][k[0]]), float(columns[name + "_error"][k[0]])) if len(k) else None


def over(pair, expected):
    """(value, error) of a measured pair over an exact number; None without it."""
    return pair and (pair[0] / expected, pair[1] / expected)


def exponents(columns, name="d2_contour", span=4.0):
    """(t, d ln y/d ln t, error) from lags that are a factor `span` apart, t in their middle."""
    t, y, error = columns["time"], columns[name], columns[name + "_error"] / columns[name]
    pairs = [(i, j) for i in range(len(t)) for j in range(i + 1, len(t)) if abs(t[j] / t[i] / span - 1.0) < 1e-6]
    i, j = (numpy.array(column, dtype=int) for column in zip(*pairs)) if pairs else (numpy.zeros(0, dtype=int),) * 2
    found = numpy.log(y[j] / y[i]) / math.log(span)
    return numpy.sqrt(t[i] * t[j]), found, numpy.hypot(error[i], error[j]) / math.log(span)


def last_exponent(columns, name="d2_contour", span=8.0):
    """(exponent, error, lag) of a power law through the last lags, a factor `span` of them, that were seen twice; None
    without enough. Errors are enlarged by as much as points scatter about the law more than they should."""
    if columns is None:
        return None
    known = columns["intervals"] >= 2
    t, y, error = (columns[key][known] for key in ("time", name, name + "_error"))
    last = t >= t[-1] / (1.001 * span) if len(t) else known
    if last.sum() < 5:
        return None
    fit = stats.power(t[last], y[last], error[last])
    return float(fit.value[1]), float(fit.error[1] * math.sqrt(max(1.0, fit.chi2 / fit.freedom))), float(t[last].mean())


def bend(columns, name="d2_contour", half=0.375):
    """(height, error, lag) where the local exponent falls to half of 3/4: the size of a tube, up to a factor that is the
    same at all densities: by a line through the exponents within a factor of 4 of where they are first below. Exponents over a
    factor of 4 share lags with their neighbors, so that only as many count as fit side by side; and the error is enlarged by
    as much as they scatter about the line more than they should. None if none is below by twice its error."""
    if columns is None:
        return None
    t, found, errors = exponents(columns, name)
    if not (found + 2.0 * errors < half).any():
        return None
    first = numpy.flatnonzero(found < half)[0]
    near = abs(numpy.log(t / t[first])) < math.log(4.001)
    fit = stats.line(numpy.log(t[near]), found[near], numpy.maximum(errors[near], 1e-9))
    at = (half - fit.value[0]) / fit.value[1]
    spread = fit.covariance[0, 0] + 2.0 * at * fit.covariance[0, 1] + at**2 * fit.covariance[1, 1]  # of the line, there
    beside = max(2.0, 1.0 + math.log(t[near][-1] / t[near][0]) / math.log(4.0))
    worse = max(1.0, fit.chi2 / max(fit.freedom, 1)) * max(1.0, near.sum() / beside)
    apart = math.sqrt(worse * spread) / abs(fit.value[1])
    height = math.exp(numpy.interp(at, numpy.log(columns["time"]), numpy.log(columns[name])))
    return height, half * apart * height, math.exp(at)


def turning(tables, fibers):
    """(t, <a(0).a(t)>, its error) of the regression axis at the lags of all runs, pooled by intervals and `fibers` of each run. 1 - cos
    of a small angle is a sum of two squares, so its mean over n intervals of all fibers has the relative error 1/sqrt(n)."""
    lags = sorted(set.intersection(*(set(one["time"]) for one in tables)))
    rows = [[(one["axis_unit"][k], count * one["intervals"][k]) for one, count in zip(tables, fibers)
             for k in numpy.flatnonzero(one["time"] == t)] for t in lags]
    cosine = numpy.array([sum(c * n for c, n in row) / sum(n for _, n in row) for row in rows])
    count = numpy.array([sum(n for _, n in row) for row in rows])
    return numpy.array(lags), cosine, (1.0 - cosine) / numpy.sqrt(count)


def rotation_fit(t, c, error, shortest, longest, least=4):
    """(tau_r, error, intercept) from <a(0).a(t)> = A exp(-t/tau_r), lags shortest to longest; None with too few. The angles of a
    random walk at two lags have the correlation sqrt(shorter/longer), as short intervals are parts of long ones: generalized
    least squares."""
    keep = (t >= shortest) & (t <= longest) & (c > 0.1)
    if keep.sum() < least:
        return None
    t, c, error = t[keep], c[keep], error[keep] / c[keep]
    covariance = numpy.outer(error, error) * numpy.sqrt(numpy.minimum.outer(t, t) / numpy.maximum.outer(t, t))
    basis = numpy.column_stack([numpy.ones_like(t), t])
    weighted = numpy.linalg.solve(covariance, numpy.column_stack([basis, -numpy.log(c)]))
    inverse = numpy.linalg.inv(basis.T @ weighted[:, :2])
    intercept, rate = inverse @ basis.T @ weighted[:, 2]
    return (1.0 / rate, math.sqrt(inverse[1, 1]) / rate**2, math.exp(-intercept)) if rate > 0 else None


def rotation_time(tables, firsts, longest, fibers):
    """(tau_r, error, intercept) of runs of the same fibers, so many in each, tau_r = 1/(2 D_r). Bends hardly tilt the regression axis; the
    intercept has what they do, and what the flow around a fiber does before it has built up. firsts: first lags to try, each twice the
    one before. The first one is taken from which on tau_r changes by at most two standard errors whenever the lag is doubled (the
    rule of lags.rule). The choice has an error of its own, in the root of the sum of squares: the change if it is doubled, or what
    this change could hide."""
    chosen = [(one, count) for one, count in zip(tables, fibers) if one is not None and "axis_unit" in one]
    if not chosen:
        return None
    seen = turning(*zip(*chosen))
    fits = list(itertools.takewhile(bool, (rotation_fit(*seen, first, longest) for first in firsts)))
    changes = [(abs(later[0] - fit[0]), math.sqrt(max(later[1]**2 - fit[1]**2, 0.05 * later[1]**2))) for fit, later in zip(fits, fits[1:])]
    bad = [k for k, (change, hidden) in enumerate(changes) if change > 2.0 * hidden]
    first = bad[-1] + 1 if bad else 0
    if first >= len(changes):
        return None
    return fits[first][0], math.hypot(fits[first][1], max(changes[first])), fits[first][2]


def first_rate(t, y):
    """(dy/dt at the start, error) of something that grows by small independent amounts, at a rate that itself changes
    steadily: a line through the increments. (A line through y would be wrong, because deviations of y from it persist.)"""
    t, rates = numpy.asarray(t, float), numpy.diff(y) / numpy.diff(t)
    middle = 0.5 * (t[1:] + t[:-1]) - t[0]
    rough = stats.line(middle, rates, numpy.ones_like(rates))
    scatter = math.sqrt(rough.chi2 / rough.freedom)
    return float(rough.value[0]), float(rough.error[0] * scatter)


def momentum_change(results):
    """Largest change of the total momentum of any run over 2/3 of its kinetic energy; None without tables."""
    worst = None
    for result in results:
        try:
            table = result.table("conserved")
        except KeyError:
            continue
        if len(table["time"]) < 2:
            continue
        change = max(float(numpy.abs(table[key] - table[key][0]).max()) for key in ("px", "py", "pz"))
        kinetic = float(table["vertex_kinetic"][0] + table["solvent_kinetic"][0])
        worst = max(worst or 0.0, 1.5 * change / kinetic)
    return worst


def wave_left(times, count, vertices, box, bonded):
    """Share of a shear wave of the box's length that is left in a suspension, to leading order in its strain.

    Vertices go with the fluid and make it heavier and more viscous (dilute.heavy_fluid). Bonds are springs along straight fibers of all
    directions n. Along a fiber the wave is u n_x cos(k n_y s); it stretches the fiber by w, which slips back with the mobility
    of a vertex: dw/dt = u - Gamma w, Gamma = mobility K <l>^2 k^2 n_y^2. The tension takes c K <l>^2 k^2 <n_x^2 n_y^2 w> from the
    momentum. Left out: bends, which make fibers softer, and ends."""
    y, share = numpy.polynomial.legendre.leggauss(16)
    y, share = 0.5 * (y + 1.0), 0.5 * share
    crowd, k = count * vertices / box**3, 2.0 * math.pi / box
    stretch = (SPRING * BOND**2 * k**2) * y**2
    rates = numpy.zeros((17, 17))
    rates[0, 0] = -dilute.heavy_fluid(crowd)[1] * k**2
    if bonded:
        rates[0, 1:] = -count * (vertices - 1) / box**3 / (dilute.PER_CELL + MASS * crowd) * share * stretch * 0.5 * (1.0 - y**2)
    rates[1:, 0] = 1.0
    rates[range(1, 17), range(1, 17)] = -VERTEX_DIFFUSION * stretch
    return numpy.array([linalg.expm(rates * t)[0, 0] for t in times])


def measured(verdict, pair, systematic=0.0, values=None):
    """Fills in (value, error) and the tolerance that follows; values: see stats.tolerance."""
    if pair is not None:
        verdict.measured, verdict.error = pair[:2]
        verdict.tolerance = stats.tolerance(verdict.error, verdict.expected_error, systematic, values=values)
    return verdict
