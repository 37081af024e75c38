"""One solute in a periodic box: the growth of its mean square displacement, and the effects of box, neighbors and images.

Units a0 = kT = m = t0 = 1. In it: Green-Kubo for a fluid of decaying transverse modes, images, Kirkwood, Rouse, and vertices
that share collision cells.
"""
import dataclasses
import math

import numpy
from scipy import special

from lib import stats, theory
from lib.case import Verdict

MASS, PER_CELL, INTERVAL = 5.0, 5.0, 0.02  # of a vertex; of the solvent, per cell; between collisions
NU, NU_ERROR = 2.148, 0.008  # kinematic viscosity at the paper's point, from shear waves: docs/accuracy.md
ETA = PER_CELL * NU
D_VERTEX, D_VERTEX_ERROR = 0.0179, 0.0001  # of one vertex in an infinite box: docs/accuracy.md, and the case `mobility`
DAMPING = 1.2  # of sound, Gamma in exp(-Gamma k^2 t): [nu + (2/3) D_T]/2
SHORTEST_WAVE = 2.0  # k a0; waves shorter than 3 cells have left their mark within 0.2 t0
# Lags from here on, t0: the first octave that passes the rule of lib/lags.py for chains and for rods of the campaign. From 6.4 t0
# on one local memory, c/t, still describes vertices in all boxes, but chains and rods come out 1 to 2 % larger.
FIRST_LAG = 12.8


def last_lag(box, first=FIRST_LAG):
    """The longest lag of a fit: the longest memory of the box, 2/nu k^2 of its longest wave, but at least two octaves of lags."""
    return max(4.0 * first, 2.0 * box ** 2 / (4.0 * math.pi ** 2 * NU))


# Seconds of one core, estimated: per solvent particle and collision, growing with the box out of the cache, and per
# vertex and step; a velocity swap costs as much again as the solvent, phantoms cost by the vertex.
BOXES, PARTICLE_SECONDS = (20, 40, 60), (9e-9, 12e-9, 17e-9)
VERTEX_SECONDS, PHANTOM_SECONDS = 1e-7, 2e-7


def hours(box, vertices, time, bath="hydrodynamics", time_step=INTERVAL):
    """CPU hours, estimated, of `time` t0."""
    if bath == "phantoms":
        return round(time / INTERVAL * vertices * PHANTOM_SECONDS / 3600.0, 4)
    collision = (2.0 if bath == "swap" else 1.0) * PER_CELL * box ** 3 * numpy.interp(box, BOXES, PARTICLE_SECONDS)
    return round((time / INTERVAL * collision + time / time_step * vertices * VERTEX_SECONDS) / 3600.0, 4)


# --- hydrodynamics ----------------------------------------------------------------------------------------------------

def stokes(length, eta=ETA):
    """kT/(6 pi eta length)."""
    return 1.0 / (6.0 * math.pi * eta * length)


def image_shift(box, gyration2=0.0, eta=ETA):
    """The amount by which periodic images reduce D: kT/(6 pi eta L) [2.837297 - (4 pi/3) R_g^2/L^2]."""
    return stokes(box, eta) * (theory.PERIODIC - 4.0 * math.pi / 3.0 * gyration2 / box ** 2)


def closed_box(solutes, mass, box):
    """The factor by which a closed box slows the diffusion of one of its n solutes: the momentum that they exchange
    with the fluid moves all of it the other way, 1 - (1 - (M_solvent/M_total)^2)/n; `mass` of each solute."""
    solvent = PER_CELL * box ** 3
    return 1.0 - (1.0 - (solvent / (solvent + solutes * mass)) ** 2) / solutes


def gaussian_form(vertices, bond2=1.0):
    """P(k) of a Gaussian chain."""
    distance = numpy.arange(1, vertices)
    weight = 2.0 * (vertices - distance)

    def form(k):
        x = numpy.multiply.outer(numpy.atleast_1d(k) ** 2, distance * bond2 / 6.0)
        return (vertices + (weight * numpy.exp(-x)).sum(axis=-1)) / vertices ** 2
    return form


def rod_form(vertices, spacing):
    """P(k) of a straight row of points."""
    distance = numpy.arange(1, vertices)
    weight = 2.0 * (vertices - distance)

    def form(k):
        x = numpy.multiply.outer(numpy.atleast_1d(k), distance * spacing)
        return (vertices + (weight * numpy.sinc(x / math.pi)).sum(axis=-1)) / vertices ** 2
    return form


def point_form(k):
    """P(k) of a point."""
    return numpy.ones_like(numpy.atleast_1d(k))


def waves(box):
    """Wave numbers of a cubic box up to SHORTEST_WAVE, and how many wave vectors have each."""
    reach = int(SHORTEST_WAVE * box / (2.0 * math.pi))
    n = numpy.arange(-reach, reach + 1)
    square = (n[:, None, None] ** 2 + n[None, :, None] ** 2 + n[None, None, :] ** 2).ravel()
    count = numpy.bincount(square)[:reach ** 2 + 1]
    found = numpy.flatnonzero(count)
    found = found[found > 0]
    return 2.0 * math.pi / box * numpy.sqrt(found), count[found]


def memory(times, box, nu=NU, form=point_form, sound=theory.SOUND_SPEED, damping=DAMPING):
    """The difference of D(t) = g_cm/6t from its limit, at lags `times`, through the box's long waves.

    A solute is carried by the thermal waves of the fluid. Transverse ones decay as exp(-nu k^2 t), two for each k;
    sound is a damped oscillation, whose share in the displacement does not grow: with amplitudes kT P(k)/3 rho V per
    component

        D - g/6t = (1/3 rho V t) sum_k P(k) { 2 [1 - exp(-nu k^2 t)]/(nu k^2)^2 - [1 - phi(t)]/(c k)^2 }

    phi: exp(-Gamma k^2 t) [cos wt + (Gamma k^2/w) sin wt], w^2 = (c k)^2 - (Gamma k^2)^2; -[1 - phi]/(c k)^2 is what the two decays
    of theory.sound_decays add up to. (With heat as well D would change by 0.02 to 0.2 %, since a fit's c/t takes up nearly all.)
    """
    k, count = waves(box)
    t = numpy.atleast_1d(times)[:, None]
    decays = [(2.0, nu * k ** 2)] + theory.sound_decays(k ** 2, damping, sound)
    each = sum(amplitude * -numpy.expm1(-rate * t) / rate ** 2 for amplitude, rate in decays).real
    return (count * form(k) * each).sum(axis=1) / (3.0 * PER_CELL * box ** 3 * t[:, 0])


def monomer_pair(distance, radius):
    """(1/3) Tr of the mobility of two spheres, times 6 pi eta: 1/r, and Rotne-Prager-Yamakawa's where they overlap."""
    r = numpy.asarray(distance, dtype=float)
    return numpy.where(r >= 2.0 * radius, 1.0 / numpy.maximum(r, 1e-9), (1.0 - r / (4.0 * radius)) / radius)


def kirkwood_chain(vertices, radius, bond2=1.0):
    """Short-time D of a Gaussian chain of spheres in an infinite box, Kirkwood's double sum."""
    x = numpy.linspace(0.0, 8.0, 4001)[1:]  # distance over its standard deviation per component
    chi = math.sqrt(2.0 / math.pi) * x ** 2 * numpy.exp(-x ** 2 / 2.0)
    total = vertices / radius
    for distance in range(1, vertices):
        pair = monomer_pair(x * math.sqrt(distance * bond2 / 3.0), radius)
        total += 2.0 * (vertices - distance) * numpy.trapz(chi * pair, x)
    return stokes(1.0) * total / vertices ** 2


def kirkwood_rod(vertices, spacing, radius):
    """The same of a straight rod."""
    distance = numpy.arange(1, vertices)
    total = vertices / radius + (2.0 * (vertices - distance) * monomer_pair(spacing * distance, radius)).sum()
    return stokes(1.0) * total / vertices ** 2


# Vertices are no spheres: what holds them in the fluid is the collision cell. A vertex gives its momentum to whoever
# shares its cell, within a triangle of variance 1/6 a0^2 along each axis, since the grid is shifted at random; another
# one takes what it takes, later, from the same kind of cell around itself. Oseen's field is smeared by both, nearly a
# Gaussian. Members of one cell that are braked together at once, the rest, is what they have without hydrodynamics.
CELL_SPREAD = 1.0 / 3.0
CELLS = 0.04  # a lone vertex so taken has 0.0173 a0^2/t0, and 0.0179 is measured: so good is the theory


def smeared_pair(distance):
    """(1/3) Tr of Oseen's tensor between two vertices, smeared over their cells, times 6 pi eta."""
    r = numpy.maximum(numpy.asarray(distance, dtype=float), 1e-6)
    return special.erf(r / math.sqrt(2.0 * CELL_SPREAD)) / r


def cells_chain(vertices, apart, bond2=1.0, heavier=0.0):
    """D of a Gaussian chain in an infinite box: `apart`, what it has without hydrodynamics, and the smeared field, less
    what its own vertices take by making the fluid heavier (lib/own_fluid.py). The distance of two vertices and what smears
    are both Gaussian, so <1/r> is sqrt(2/pi) over their common width."""
    distance = numpy.arange(vertices)
    count = numpy.where(distance == 0, vertices, 2.0 * (vertices - distance))
    inverse = numpy.sqrt(2.0 / math.pi / (distance * bond2 / 3.0 + CELL_SPREAD))
    return apart + (1.0 - heavier) * stokes(1.0) * (count * inverse).sum() / vertices ** 2


def cells_rod(vertices, spacing, apart, heavier=0.0):
    """The same of a straight rod."""
    distance = numpy.arange(vertices)
    count = numpy.where(distance == 0, vertices, 2.0 * (vertices - distance))
    return apart + (1.0 - heavier) * stokes(1.0) * (count * smeared_pair(spacing * distance)).sum() / vertices ** 2


def heavy_fluid(crowd):
    """(eta, nu) of a solvent with so many vertices per cell, Poisson, that go with it: collisions hand on momentum in
    proportion to <m_cell - sum m^2/m_cell>, Eq. (31) with the members' masses; n - 1 + exp(-n) if all are alike."""
    n, solvent = poisson(PER_CELL)
    others, vertices = poisson(crowd, 40)
    mass = MASS * others[:, None] + n
    squares = MASS**2 * others[:, None] + n
    passed_on = vertices @ (mass - squares / numpy.maximum(mass, 1.0)) @ solvent
    eta = ETA * float(passed_on) / theory.occupancy(PER_CELL)
    return eta, eta / (PER_CELL + MASS * crowd)


def in_pure_solvent(value, apart, crowd):
    """D corrected for the viscosity that so many vertices per cell add. apart: the part of D without hydrodynamics, which does not
    depend on the viscosity."""
    return apart + (value - apart) * heavy_fluid(crowd)[0] / ETA


# --- without hydrodynamics ----------------------------------------------------------------------------------------

def poisson(mean, most=60):
    """The numbers below `most`, and their probabilities."""
    n = numpy.arange(most)
    return n, numpy.exp(special.xlogy(n, mean) - mean - special.gammaln(n + 1.0))


def retention(vertices=1):
    """Share that the common velocity of vertices keeps per collision, in a cell with Poisson solvent, at 90 degrees:
    1 - (2/3) <n/(l M + n)>."""
    n, weight = poisson(PER_CELL)
    return 1.0 - 2.0 / 3.0 * float((weight * n / (vertices * MASS + n)).sum())


def vertex_diffusion():
    """D_0 of a lone vertex, molecular chaos: (kT dt_c/M) [1/(1 - c) - 1/2]."""
    return INTERVAL / MASS * (1.0 / (1.0 - retention()) - 0.5)


def gaussian_shape(vertices, bond2, random):
    """Positions of a Gaussian chain."""
    return numpy.cumsum(random.normal(0.0, math.sqrt(bond2 / 3.0), (vertices, 3)), axis=0)


def rod_shape(vertices, spacing, random):
    """Positions along a straight line of random direction."""
    direction = random.normal(size=3)
    return numpy.outer(numpy.arange(vertices) * spacing, direction / numpy.linalg.norm(direction))


def crowded(crowd, together, most=60):
    """How probable it is to find 0, 1, ... vertices of other fibers in a cell, of `crowd` on average. They come in
    clumps; together[j]: share of all vertices that have j vertices of their fiber in their cell, themselves included.
    Clumps of j are Poisson with mean crowd together[j]/j, so p_n = (crowd/n) sum_j together[j] p_(n-j)."""
    sizes = numpy.arange(1, len(together))
    found = numpy.zeros(most)
    found[0] = math.exp(-crowd * (together[1:] / sizes).sum())
    for n in range(1, most):
        reach = min(n, len(sizes))
        found[n] = crowd / n * (together[1:reach + 1] * found[n - reach:n][::-1]).sum()
    return found


CELL_NUMBER = numpy.array([1.0, 2.0**16, 2.0**32])  # makes one number of a cell's three, exactly


def sharing_matrices(shape, shapes, shifts, seed, crowd=0.0):
    """Mobilities of a fiber's vertices without hydrodynamics, where vertices share cells: one matrix for each of so many
    shapes.

    Collisions turn V into C V, with C_ij = c_1 d_ij + (1 - c_1) <M/(l M + n); i and j in one cell of l vertices>, the
    average over grid shifts and the Poisson n; c_1 = 1/3. Molecular chaos, and a shape that does not change meanwhile:
    H = (dt_c/M) [(1 - C)^-1 - 1/2]. shape: function of a generator. crowd: vertices of other fibers like this one per
    cell, which come and go like heavier solvent."""
    random = numpy.random.Generator(numpy.random.PCG64(seed))
    n, solvent = poisson(PER_CELL)
    for _ in range(shapes):
        points = shape(random)
        size = len(points)
        cells = [numpy.floor(points + shift) @ CELL_NUMBER for shift in random.uniform(size=(shifts, 3))]
        same = [cell[:, None] == cell for cell in cells]
        count = [one.sum(axis=1) for one in same]
        together = numpy.bincount(numpy.concatenate(count), minlength=size + 1) / (size * shifts)
        others = crowded(crowd, together) if crowd > 0.0 else numpy.ones(1)
        mass = MASS * numpy.arange(len(others))[:, None] + n
        share = numpy.array([0.0] + [float(others @ (MASS / (l * MASS + mass)) @ solvent) for l in range(1, size + 1)])
        matrix = sum(one * share[number][:, None] for one, number in zip(same, count))
        matrix = numpy.eye(size) / 3.0 + 2.0 / 3.0 * matrix / shifts
        yield INTERVAL / MASS * (numpy.linalg.inv(numpy.eye(size) - matrix) - 0.5 * numpy.eye(size))


def sharing_diffusion(shape, shapes=40, shifts=200, seed=1, crowd=0.0):
    """D of a fiber's center of mass without hydrodynamics: (mean, error) over shapes. With no shared cell it is D_0/N."""
    found = [float(matrix.mean()) for matrix in sharing_matrices(shape, shapes, shifts, seed, crowd)]
    return float(numpy.mean(found)), float(numpy.std(found, ddof=1) / math.sqrt(shapes))


def sharing_matrix(shape, shapes=40, shifts=200, seed=1, crowd=0.0):
    """Their mean."""
    total = sum(sharing_matrices(shape, shapes, shifts, seed, crowd)) / shapes
    return 0.5 * (total + total.T)


def rouse_time(vertices, spring, friction, p=1):
    """tau_p of a discrete Rouse chain: zeta/(4 k sin^2(p pi/2N))."""
    return friction / (4.0 * spring * numpy.sin(p * math.pi / (2.0 * vertices)) ** 2)


def rouse(times, vertices, spring, friction):
    """<R(t).R(0)>/<R^2> of a discrete Rouse chain: its odd modes."""
    p = numpy.arange(1, vertices, 2)
    angle = p * math.pi / (2.0 * vertices)
    weight = 2.0 / (vertices * (vertices - 1.0)) / numpy.tan(angle) ** 2
    tau = rouse_time(vertices, spring, friction, p)
    return (weight * numpy.exp(-numpy.atleast_1d(times)[:, None] / tau)).sum(axis=1)


# --- estimates --------------------------------------------------------------------------------------------------------

def merged(results, kind):
    """One dynamics table of several runs of one system: times, D/kT and end_to_end with errors, weighted with the
    number of intervals. None without runs. kT: the run's own, set by its start."""
    tables = []
    for result in results:
        try:
            table, heat = result.table(f"dynamics-{kind}"), result.table("temperature")
        except KeyError:
            continue
        if len(table.get("time", ())) == 0:
            continue
        phantoms = "bath: phantoms" in result.run.scene
        tables.append((table, 1.0 if phantoms else float(heat["solvent"].mean())))
    if not tables:
        return None
    times = max((table["time"] for table, _ in tables), key=len)
    merge = {"time": times, "runs": len(tables)}
    for name, power in (("D", 1), ("end_to_end", 0)):
        total, value, variance = (numpy.zeros(len(times)) for _ in range(3))
        for table, kt in tables:
            m, weight = len(table["time"]), table["intervals"]
            total[:m] += weight
            value[:m] += weight * table[name] / kt ** power
            variance[:m] += (weight * table[name + "_error"] / kt ** power) ** 2
        merge[name], merge[name + "_error"] = value / total, numpy.sqrt(variance) / total
    merge["intervals"] = total
    return merge


def nested(times, first, last):
    """Indices of lags first 2^k up to `last`: each one's intervals are made of pairs of the one before."""
    chosen, wanted = [], None
    for i, t in enumerate(times):
        if t > last * 1.000001:
            break
        if t >= first * 0.999999 and (wanted is None or abs(t / wanted - 1.0) < 1e-6):
            chosen.append(i)
            wanted = 2.0 * t
    return numpy.array(chosen, dtype=int)


@dataclasses.dataclass
class Limit:
    """Long-time diffusion coefficients of several systems, their covariance, the local memory c, and the fit's p."""
    value: numpy.ndarray
    covariance: numpy.ndarray
    local: float
    p: float

    @property
    def error(self):
        return numpy.sqrt(self.covariance.diagonal())


def long_time(systems, first, last, scales=None):
    """D of systems (table, correction) that share one local memory: D(t) + correction(t) = D - c/t, by least squares
    over lags from `first` to `last` (one for each system). scales: the local memory of each is so many times c (1).

    c stands for what has decayed before `first`: the memory of the velocity, and waves shorter than SHORTEST_WAVE.
    Intervals of lag 2t are pairs of those of lag t. For independent increments D(2t) is D(t) plus independent noise, so
    the covariance of two lags is the variance of the shorter, and the differences of D between lags are independent.
    """
    rows, values = [], []
    for i, (table, correction) in enumerate(systems):
        chosen = nested(table["time"], first, last[i])
        good = numpy.isfinite(table["D_error"][chosen]) & (table["D_error"][chosen] > 0.0)
        t, y, error = (table[name][chosen][good] for name in ("time", "D", "D_error"))
        variance = numpy.maximum.accumulate(error ** 2)
        noise = numpy.sqrt(numpy.maximum(numpy.diff(variance, prepend=0.0), 0.05 * variance))
        basis = numpy.zeros((len(t), len(systems) + 1))
        basis[:, i], basis[:, -1] = 1.0, -(scales[i] if scales else 1.0) / t
        rows.append(numpy.diff(basis, axis=0, prepend=numpy.zeros((1, basis.shape[1]))) / noise[:, None])
        values.append(numpy.diff(y + correction(t), prepend=0.0) / noise)
    design, value = numpy.concatenate(rows), numpy.concatenate(values)
    if len(value) < len(systems) + 1:
        return None
    f = stats.fit(list(design.T), value, numpy.ones(len(value)))
    return Limit(f.value[:-1], f.covariance[:-1, :-1], float(f.value[-1]), f.p)


def held(name, statement, expected, source, pair, systematic, known=0.0, **options):
    """A verdict on pair, (value, error) or None: its tolerance is that of both errors and a systematic bound."""
    value, error = pair or (None, math.nan)
    bound = stats.tolerance(error, known, systematic)
    return Verdict(name, statement, expected, source, bound, value, error, known, **options)


def scatter(name, statement, p):
    """A verdict on a fit: the probability of its scatter, expressed in standard errors of a normal value."""
    return Verdict(name, statement, 0.0, "chi², the errors as they are", stats.tolerance(1.0),
                   None if p is None else stats.normal(p), 1.0)


KIRKWOOD = 0.005  # of Kirkwood's short-time D of chains and of rods: the quadrature, and the field's images in the mean


def kirkwood_held(case, pair, share):
    """A finding about Kirkwood's sum, the same for chains and rods. share: of D that is in proportion to a vertex' own."""
    known = math.hypot(share * D_VERTEX_ERROR / D_VERTEX, NU_ERROR / NU)
    return held(f"{case}.kirkwood", "Short-time D in an infinite box over Kirkwood's sum, mean over lengths", 1.0,
                "Kirkwood's sum over shapes of the exact distribution, spheres of the a_h of the claim mobility", pair, KIRKWOOD, known,
                kind="paper",
                reason="Kirkwood's vertices are spheres in Oseen's field; here that field is smeared over the "
                       f"collision cells, as wide as a bond is long, and the solute's own vertices make the fluid heavier ({case}.cells).")


def fair_mean(values, errors):
    """stats.fair_mean of independent values."""
    return stats.fair_mean(values, numpy.diag(numpy.asarray(errors, float)**2))


def mean_ratio(pairs, expected):
    """(value, error): weighted mean of measured (value, error) over expected values; None without any."""
    if not pairs:
        return None
    return fair_mean([d / e for (d, *_), e in zip(pairs, expected)],
                     [error / e for (_, error, *_), e in zip(pairs, expected)])[:2]


def over(a, b):
    """(value, error) of the ratio of two independent (value, error)."""
    return a[0] / b[0], a[0] / b[0] * math.hypot(a[1] / a[0], b[1] / b[0])


def listed(far, models):
    """Lengths, limits and their shares of models' (name: function of N), as words."""
    def shares(n, d):
        return ", ".join(f"{d / model(n):.3f} of {name}" for name, model in models.items())

    return "; ".join(f"N = {n}: {1e3 * d:.3f} ± {1e3 * error:.3f} ({shares(n, d)})" for n, (d, error, _) in far.items())
