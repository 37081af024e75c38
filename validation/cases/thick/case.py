"""Thick fibers: rods whose excluded volume, contacts and pressure are known."""
import math

import numpy
from scipy import optimize

from lib import figures, stats
from lib import semidilute as sd
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "Thick fibers: excluded volume, contacts, pressure, nematic order, swelling, tube"
PAPER = "Sec. III C (an outlook there); Onsager (1949), McGrother, Williamson and Jackson (1996)"

SHAPES = ((1.0, 0.5), (2.5, 0.5), (2.0, 0.02))  # length, diameter of pairs laid at random
FLIGHTS = {"thin": (12, 400, 0.001), "slim": (12, 200, 0.1), "stout": (20, 200, 0.5)}  # edge, rods, diameter
FRACTIONS = (0.1, 0.2)
LENGTH, DIAMETER = 1.001, 0.2  # of the rods of the equation of state: mean length at k = 2000
DRAWS = {"quick": 1000000, "campaign": 20000000}
RUNS = {"quick": {"thin": (40, 12), "slim": (40, 30), "stout": (40, 30)},  # runs, t0
        "campaign": {"thin": (400, 12), "slim": (400, 30), "stout": (400, 30)}}
STATE = {"quick": (4, 20, 2), "campaign": (5, 40, 10)}  # edge, blocks, t0

# Spherocylinders with L/D = 5 in Monte Carlo at constant pressure, some 1000 rods: volume fraction, P v0/kT, S. McGrother et al., Table
# V, as quoted with Allen and Tildesley's programs (README.md).
LITERATURE = ((0.310, 2.53, 0.041), (0.352, 3.63, 0.053), (0.397, 4.89, 0.136), (0.400, 5.05, 0.170), (0.419, 5.40, 0.574),
              (0.436, 5.80, 0.714), (0.448, 6.20, 0.754))
LITERATURE_Z = 0.03  # what its Z is taken to be known to: volume fractions have three digits, and Z rises by 5 % from 0.01 to the next
STARTS_KNOWN = 0.06  # by which S may remember its start
HALF_ORDER = 0.4     # S at the transition: between 0.17 and 0.57 of the two states there
# name -> (start, volume fraction); edge, blocks, t0 of each block
ORDER = {"quick": {"aligned-0.436": (4, 12, 5)},
         "campaign": {"aligned-0.352": (5, 12, 10), "aligned-0.397": (5, 100, 10), "aligned-0.41": (5, 100, 10), "aligned-0.419": (5, 100, 10),
                      "aligned-0.436": (5, 20, 10), "grown-0.397": (5, 100, 10), "grown-0.436": (5, 100, 10)}}


SWOLLEN = 0.2     # diameter of the chains whose exponent is measured
THINNEST = 0.0001  # of a chain that is ideal but for 0.1 %
NU = 0.5876       # renormalization (des Cloizeaux 0.5876, Guida and Zinn-Justin 0.5882), walks on lattices (Clisby 0.587597)
NU_KNOWN = {"quick": 0.03, "campaign": 0.015}  # what corrections of short chains may be
LENGTHS = {"quick": (16, 32, 64, 128), "campaign": (16, 32, 64, 128, 256, 512)}
STRENGTHS = (1.0, 4.0)  # z of the slides' rule
SWELL = {"quick": 1.5e6, "campaign": 1e7}
Z_KNOWN = 0.03    # of the extrapolated swelling: the next order in N^(-1/2)
FLIGHT_BONDS = 16

# The paper's fibers at c L^3 = 1000, in an eighth of its box.
WIDTHS = (0.0, 0.05, 0.1, 0.15)
TUBE = (16, 125, 64, 600)  # edge, fibers, vertices, t0
TUBE_LAG = 64.0
TUBE_KNOWN = 0.4  # a theory of scaling

KINDS = {"sides": "side on side", "edges": "end on side", "ends": "end on end"}


def runs(tier):
    n = DRAWS[tier]
    shapes = [number for shape in SHAPES for number in shape]
    found = [Run("overlap", program=["thick_rods", "overlap", 1931, n, *shapes], hours=1.2e-9 * n)]
    for name, flight in FLIGHTS.items():
        count, time = RUNS[tier][name]
        found.append(Run(name, program=["thick_rods", "flight", 1932, *flight, count, time], hours=1e-6 * count * time))
    edge, blocks, time = STATE[tier]
    for fraction in FRACTIONS:
        found.append(Run(f"state-{fraction:g}", program=["thick_state", edge, 1 / DIAMETER, blocks, time, "random", fraction],
                         hours=6e-8 * blocks * time * edge**3 * fraction / 0.1))
    return found + order_runs(tier) + swelling_runs(tier) + tube_runs(tier)


def order_runs(tier):
    found = []
    for name, (edge, blocks, time) in ORDER[tier].items():
        start, fraction = name.split("-")
        found.append(Run(name, program=["thick_state", edge, 1 / DIAMETER, blocks, time, start, fraction], hours=6e-7 * blocks * time * edge**3))
    return found


def swelling_runs(tier):
    effort, lengths = SWELL[tier], LENGTHS[tier]
    pairs = [(THINNEST, 32)] + [(SWOLLEN, n) for n in lengths]
    found = [Run("swelling", program=["thick_swelling", 1933, f"{effort:g}", *(x for pair in pairs for x in pair)],
                 hours=1.2e-10 * effort * len(pairs))]
    if tier == "campaign":
        for z in STRENGTHS:
            pairs = [(f"{strength_diameter(z, n):.6f}", n) for n in lengths]
            found.append(Run(f"strength-{z:g}", program=["thick_swelling", 1934, f"{effort:g}", *(x for pair in pairs for x in pair)],
                             hours=1.2e-10 * effort * len(pairs)))
        found.append(Run("chains", scene=CHAINS, steps=150000, seed=1935, hours=0.02))
    return found


def tube_runs(tier):
    edge, fibers, vertices, time = TUBE
    return [Run(f"tube-{width:g}", program=["thick_tube", 1936, edge, fibers, vertices, WIDTHS[-1], width, time],
                hours=3.5e-5 * time) for width in WIDTHS] if tier == "campaign" else []


# Chains in a bath, with contacts: so few that they hardly meet.
CHAINS = f"""box: [32, 32, 32]
time_step: 0.01
solvent: {{per_cell: 5, collision_interval: 0.02, hydrodynamics: false, bath: phantoms}}
fibers: [{{name: chain, count: 60, vertices: {FLIGHT_BONDS + 1}, mass: 5, bond_length: 0.5, spring: 100, bending: 0, diameter: {SWOLLEN}}}]
crossing: {{rule: event-driven}}
observe: {{statics: {{every: 1000}}}}
"""


# --- what is known ----------------------------------------------------------------------------------------------------

def second_virial(length, diameter):
    return 2 / 3 * math.pi * diameter**3 + math.pi * length * diameter**2 + math.pi / 4 * length**2 * diameter


# Virial coefficients of L/D = 5 over powers of B2: B3/B2^2, B4/B2^3, B5/B2^4, by Monte Carlo integration (README.md).
VIRIALS = (0.41946, 0.052749, 0.011084)


def rod_volume(length=LENGTH, diameter=DIAMETER):
    return math.pi * (diameter**2 * length / 4 + diameter**3 / 6)


def virial(phi):
    """(Z to fifth order, its last term)"""
    x = second_virial(LENGTH, DIAMETER) / rod_volume() * phi
    terms = [1.0, x, *(c * x**(k + 2) for k, c in enumerate(VIRIALS))]
    return math.fsum(terms), terms[-1]


def nezbeda(phi):
    """Z of hard convex bodies of this shape: alpha = (mean radius) (surface)/(3 volume)."""
    radius, surface = LENGTH / 4 + DIAMETER / 2, math.pi * DIAMETER * (LENGTH + DIAMETER)
    alpha = radius * surface / (3 * rod_volume())
    return (1 + (3 * alpha - 2) * phi + (alpha**2 + alpha - 1) * phi**2 - alpha * (5 * alpha - 4) * phi**3) / (1 - phi)**3


def strength(diameter, bonds):
    """z of the slides: B2 sqrt(N)/b^3, B2 of one bond alone, b^2 = <l^2>."""
    return second_virial(sd.BOND, diameter) * math.sqrt(bonds) / sd.BOND2**1.5


def strength_diameter(z, bonds):
    return optimize.brentq(lambda d: strength(d, bonds) - z, 1e-6, 0.5)


def swelling(z):
    """<R^2>/N b^2 of a long chain (des Cloizeaux, Conte and Jannink 1985): 1 + 4/3 x - 2.075 x^2 for small x, x^0.3503 for large, and x =
    (3/2 pi)^(3/2) v sqrt(N)/b^3 with the excluded volume v = 2 B2 of a pair."""
    x = 2.0 * (1.5 / math.pi)**1.5 * z
    return (1.0 + 7.6118 * x + 12.05135 * x * x)**0.175166


def sides_strength(diameter, bonds):
    """z with the sides of a bond alone, (pi/4) <l>^2 D: its ends lie inside of its neighbors. Found after the runs were made."""
    return math.pi / 4 * sd.BOND**2 * diameter * math.sqrt(bonds) / sd.BOND2**1.5


def narrowed(room, diameter):
    """The room to the side that tubes of this diameter leave of `room` of thin ones. A stretch of length l of a fiber has the room a =
    (l^3/l_p)^(1/2) if it meets c L l (a + D) = 1 others: a^(2/3) (a + D) stays the same."""
    return optimize.brentq(lambda a: a**(2 / 3) * (a + diameter) - room**(5 / 3), 1e-9, room)


# --- verdicts ---------------------------------------------------------------------------------------------------------

def row_of(result, what):
    """(value, error) of a row of a flight."""
    table = result.columns
    row = list(table["what"]).index(what)
    return float(table["ratio"][row]), float(table["ratio_error"][row])


def fill(verdict, pair, systematic=0.0, **options):
    verdict.measured, verdict.error = pair
    verdict.tolerance = stats.tolerance(verdict.error, systematic=systematic, **options)
    return verdict


def overlap_verdicts(results):
    found = []
    for row, (length, diameter) in enumerate(SHAPES):
        verdict = Verdict(f"thick.b2.{length:g}x{diameter:g}", f"B2 of rods of length {length:g} and diameter {diameter:g}, a0³",
                          second_virial(length, diameter), "exact (Onsager)", 0.01)
        if "overlap" in results:
            table = results["overlap"].columns
            fill(verdict, (float(table["B2"][row]), float(table["B2_error"][row])))
        found.append(verdict)
    return found


def flight_verdicts(results, name):
    diameter = FLIGHTS[name][2]
    words = f"rods of length 1 and diameter {diameter:g}"
    found = []

    def judge(what, text, source, systematic=0.0):
        verdict = Verdict(f"thick.{what}.{name}", f"{text}, {words}", 1.0, source, 0.05)
        if name in results:
            runs_of = int(results[name].run.program[-2])
            fill(verdict, row_of(results[name], what), systematic, values=runs_of)
        found.append(verdict)

    if name == "thin":
        judge("lines", "contacts over those of thin lines", "kinetic theory of lines; 0.6 % more for this diameter", 0.006)
    else:
        for what, kind in KINDS.items():
            judge(what, f"contacts {kind} over kinetic theory", "area of the faces, edges or corners times the mean speed; contact value of Carnahan and Starling", 0.01)
        judge("pressure", "pressure of contacts over that of B2", "virial theorem, exact B2, the same contact value", 0.01)
    judge("energy", "energy at the end over that at the start", "contacts conserve it, up to the order of the step", 0.005)
    return found


def state_verdict(results, fraction):
    name = f"state-{fraction:g}"
    _, last = virial(fraction)
    verdict = Verdict(f"thick.z.{fraction:g}", f"Z over the virial series to fifth order at a volume fraction of {fraction:g}, L/D = 5", 1.0,
                      "B3, B4, B5 by Monte Carlo integration; what is left out is at most its last term", 0.03)
    if name in results:
        table, blocks = results[name].columns, int(results[name].run.program[3])
        known, last = virial(float(table["phi"][0]))
        fill(verdict, (float(table["Z"][0]) / known, float(table["Z_error"][0]) / known), last / known, values=blocks // 2)
    return verdict


def state_row(results, name):
    """{phi, Z, S, settled} of a run of order; Z and S are (value, error). Blocks are correlated near the transition: half of the difference of the
    two halves is the error where it is larger. Settled: S of the halves agrees, the criterion of equilibrium (docs/thick.md)."""
    if name not in results:
        return None
    table = {key: float(values[0]) for key, values in results[name].columns.items()}
    settled = abs(table["S_first"] - table["S_second"]) <= STARTS_KNOWN
    return {"phi": table["phi"], "settled": settled, **{key: (table[key], max(table[f"{key}_error"], abs(table[f"{key}_first"] - table[f"{key}_second"]) / 2))
                                    for key in "ZS"}}


def crossing(phi, order):
    """The volume fraction at which S rises through HALF_ORDER, between two states; and the two."""
    for k in range(len(phi) - 1):
        if order[k] < HALF_ORDER <= order[k + 1]:
            return phi[k] + (HALF_ORDER - order[k]) / (order[k + 1] - order[k]) * (phi[k + 1] - phi[k]), k
    return None, None


def order_verdicts(results, tier):
    found = []
    rows = {name: state_row(results, name) for name in ORDER[tier]}
    for phi, pressure, order in LITERATURE:
        name = f"aligned-{phi:g}"
        if name not in rows:
            continue
        row = rows[name]
        z = Verdict(f"thick.nematic.z.{phi:g}", f"Z of parallel rods that were let go, over that of McGrother et al., volume fraction {phi:g}", 1.0,
                    f"Monte Carlo at constant pressure (1996), taken to be known to {100 * LITERATURE_Z:.0f} %", LITERATURE_Z, must_see=0.2)
        s = Verdict(f"thick.nematic.s.{phi:g}", f"S of parallel rods that were let go, volume fraction {phi:g}", order,
                    "McGrother et al. (1996); 0.06 for their volume fraction, their error and another number of rods", 0.06, must_see=0.4)
        if row:
            fill(z, (row["Z"][0] * phi / pressure, row["Z"][1] * phi / pressure), LITERATURE_Z)
            fill(s, row["S"], 0.06)
        found += [z, s] if phi in (0.352, 0.436) else [z]
    return found if tier == "quick" else found + transition_verdicts(rows)


def transition_verdicts(rows):
    """Where order is lost, from above; and whether rods that start without order find it."""
    known, _ = crossing([row[0] for row in LITERATURE], [row[2] for row in LITERATURE])
    place = Verdict("thick.nematic.transition", f"volume fraction at which S of parallel rods that were let go falls through {HALF_ORDER:g}", known,
                    "McGrother et al. (1996), S between their states at 0.400 and 0.419, to half of that interval", 0.0095, must_see=0.05)
    falling = sorted((row for name, row in rows.items() if row and name.startswith("aligned")), key=lambda row: row["phi"])
    phi, order = [row["phi"] for row in falling], [row["S"][0] for row in falling]
    where, k = crossing(phi, order)
    if where is not None:
        slope = (phi[k + 1] - phi[k]) / (order[k + 1] - order[k])
        fill(place, (where, slope * max(falling[k]["S"][1], falling[k + 1]["S"][1])), 0.0095)
    starts = []
    for fraction, power in ((0.397, 0.4), (0.436, 0.4)):
        verdict = Verdict(f"thick.nematic.starts.{fraction:g}", f"S from rods without order less S from parallel rods, volume fraction {fraction:g}", 0.0,
                          f"one equilibrium; {STARTS_KNOWN:g} for what is left of the start", STARTS_KNOWN, must_see=power)
        grown, aligned = rows[f"grown-{fraction:g}"], rows[f"aligned-{fraction:g}"]
        if grown and aligned and grown["settled"]:
            fill(verdict, (grown["S"][0] - aligned["S"][0], math.hypot(grown["S"][1], aligned["S"][1])), STARTS_KNOWN)
        starts.append(verdict)
    return [place, *starts]


def sizes(results, name):
    """Arrays of a run of single chains; none without it."""
    return results[name].columns if name in results else None


def exponent(table, least):
    """(nu, error) from chains of at least so many bonds."""
    keep = (table["diameter"] == SWOLLEN) & (table["bonds"] >= least)
    fit = stats.power(table["bonds"][keep], table["R2"][keep], table["R2_error"][keep])
    return fit.value[1] / 2, fit.error[1] / 2


def long_chains(table):
    """(swelling, error) in the limit of many bonds at the same z: a line in N^(-1/2), from 32 bonds on."""
    keep = table["bonds"] >= 32
    fit = stats.line(table["bonds"][keep]**-0.5, (table["R2"] / table["ideal"])[keep], (table["R2_error"] / table["ideal"])[keep])
    return fit.value[0], fit.error[0]


def swelling_verdicts(results, tier):
    table, least = sizes(results, "swelling"), LENGTHS[tier][len(LENGTHS[tier]) // 3]
    ideal = Verdict("thick.swelling.ideal", "<R²> over that of an ideal chain, 32 bonds, the thinnest tubes", 1.0, "N<l²>, exact; 0.1 % more for the tubes", 0.001, must_see=0.2)
    nu = Verdict("thick.swelling.nu", f"exponent of R_e, chains of {least} to {LENGTHS[tier][-1]} bonds, D = {SWOLLEN:g}", NU,
                 f"renormalization group; {NU_KNOWN[tier]:g} for short chains", NU_KNOWN[tier], rival=0.5)
    if table is not None:
        row = int(numpy.argmin(table["diameter"]))
        fill(ideal, (table["R2"][row] / table["ideal"][row], table["R2_error"][row] / table["ideal"][row]), 0.001, values=32)
        fill(nu, exponent(table, least), NU_KNOWN[tier])
    if tier == "quick":
        return [ideal, nu]
    found = [ideal, nu]
    for z in STRENGTHS:
        verdict = Verdict(f"thick.swelling.z{z:g}", f"<R²> over that of an ideal chain at z = {z:g}, extrapolated to many bonds", swelling(z),
                          f"two-parameter theory (des Cloizeaux et al. 1985), to {100 * Z_KNOWN:.0f} % for the extrapolation", Z_KNOWN * swelling(z), rival=1.0, kind="paper",
                          reason="B2 of a bond alone counts its ends, which lie inside of neighbors in a chain. With its sides alone theory holds at 512 bonds.")
        if f"strength-{z:g}" in results:
            fill(verdict, long_chains(sizes(results, f"strength-{z:g}")), Z_KNOWN * swelling(z))
        found.append(verdict)
    flight = Verdict("thick.swelling.flight", f"<R²> of chains of {FLIGHT_BONDS} bonds with contacts in a bath, over that of pivots, D = {SWOLLEN:g}", 1.0,
                     "contacts keep the equilibrium; chains that meet shrink by 0.5 % at most", 0.005, must_see=0.3)
    series = mean_square(results, "chains")
    if series is not None and table is not None:
        row = int(numpy.flatnonzero((table["diameter"] == SWOLLEN) & (table["bonds"] == FLIGHT_BONDS))[0])
        ratio = series[0] / table["R2"][row]
        fill(flight, (ratio, ratio * math.hypot(series[1] / series[0], table["R2_error"][row] / table["R2"][row])), 0.005)
    return [*found, flight]


def mean_square(results, name):
    """(<R²>, error) of a scene's run: chains are laid in equilibrium, so all of it counts."""
    try:
        table = results[name].table("statics-chain")
    except KeyError:
        return None
    return float(table["Ree2"][0]), float(table["Ree2_error"][0])


def tube_row(results, width, lag=TUBE_LAG):
    """(d², error) at a lag; None without the run."""
    if f"tube-{width:g}" not in results:
        return None
    table = results[f"tube-{width:g}"].columns
    row = int(numpy.flatnonzero(table["time"] == lag)[0])
    return float(table["d2"][row]), float(table["d2_error"][row])


def expected_ratio(square, width):
    """d² over that of thin lines, `square`, by `narrowed`: the room is twice the root mean square of one component."""
    room = 2.0 * math.sqrt(square / 2.0)
    return (narrowed(room, width) / room)**2 if width > 0.0 else 1.0


def crowding_ratio(width):
    """The same if the room is that of neighbors which are not nearer than contact, and denser there by the contact value: found after the runs
    were made."""
    edge, fibers, vertices, _ = TUBE
    phi = fibers * (vertices - 1) * sd.BOND * math.pi / 4 * width**2 / edge**3
    return ((1 - phi / 2) / (1 - phi)**3)**-1.2


def tube_verdict(results):
    """How far d² falls with the diameter, over what scaling says, from all diameters together."""
    verdict = Verdict("thick.tube.narrower", f"fall of d² (middle third, {TUBE_LAG:g} t0) with D = 0.05, 0.1, 0.15, over that of scaling", 1.0,
                      f"a^(2/3) (a + D) stays the same: a theory of scaling to some {100 * TUBE_KNOWN:.0f} %", TUBE_KNOWN, rival=0.0, kind="paper",
                      detects=1.0, reason="The estimate is wrong: it counts as walls those within a + D, but nobody is within D. What is left is the contact value.")
    rows = [tube_row(results, width) for width in WIDTHS]
    if None in rows:
        return verdict
    thin, thick = rows[0], rows[1:]
    ratio = numpy.array([row[0] / thin[0] for row in thick])
    own = numpy.array([row[1] / thin[0] for row in thick])
    covariance = numpy.diag(own**2) + numpy.outer(ratio, ratio) * (thin[1] / thin[0])**2
    drop = [1.0 - expected_ratio(thin[0], width) for width in WIDTHS[1:]]
    fit = stats.fit_correlated([drop], 1.0 - ratio, covariance)
    return fill(verdict, (float(fit.value[0]), float(fit.error[0])), TUBE_KNOWN)


# --- figure -----------------------------------------------------------------------------------------------------------

def draw_state(results):
    """Z against the volume fraction, and what is left over the virial series below 0.25."""
    figure, panel = figures.plain(width=5.5, height=4.0)
    grid = [0.47 * k / 100 for k in range(101)]
    figures.theory(panel, grid, [nezbeda(phi) for phi in grid], label="Nezbeda")
    figures.theory(panel, grid, [virial(phi)[0] for phi in grid], label="virial series, fifth order", linestyle="--")
    figures.theory(panel, grid, [1 + second_virial(LENGTH, DIAMETER) / rod_volume() * phi for phi in grid], label="second order", linestyle=":")
    rows = [state_row(results, f"state-{fraction:g}") for fraction in FRACTIONS]
    rows += [state_row(results, name) for name in ORDER["campaign"] if name.startswith("aligned")]
    rows = [row for row in rows if row]
    figures.points(panel, [row[0] for row in LITERATURE], [row[1] / row[0] for row in LITERATURE], number=1, label="McGrother et al. (1996)")
    figures.points(panel, [row["phi"] for row in rows], [row["Z"][0] for row in rows], numpy.array([row["Z"][1] for row in rows]), number=0,
                   label="measured", markersize=3.5)
    panel.set(xlabel="volume fraction $\\phi$", ylabel="$Z = PV/NkT$")
    figures.legend(panel)
    return figure


def draw_order(results):
    figure, panel = figures.plain(width=5.5, height=4.0)
    figures.points(panel, [row[0] for row in LITERATURE], [row[2] for row in LITERATURE], number=1, label="McGrother et al. (1996)")
    for number, (start, label) in enumerate((("aligned", "from parallel rods"), ("grown", "from rods without order")), 0):
        rows = [state_row(results, name) for name in ORDER["campaign"] if name.startswith(start)]
        rows = [row for row in rows if row]
        figures.points(panel, [row["phi"] for row in rows], [row["S"][0] for row in rows], numpy.array([row["S"][1] for row in rows]),
                       number=(0, 2)[number], label=label)
    panel.set(xlabel="volume fraction $\\phi$", ylabel="nematic order $S$", ylim=(0.0, 1.0))
    figures.legend(panel)
    return figure


def draw_swelling(results):
    """Left: R² of swollen chains. Right: chains of one z against N^(-1/2)."""
    figure, (left, right) = figures.plain(width=6.6, height=3.4, columns=2)
    table = sizes(results, "swelling")
    if table is not None:
        keep = table["diameter"] == SWOLLEN
        n, swollen = table["bonds"][keep], (table["R2"] / table["bonds"]**(2 * NU))[keep]
        figures.points(left, n, swollen, (table["R2_error"] / table["bonds"]**(2 * NU))[keep], number=0, label=f"$D = {SWOLLEN:g}\\,a_0$")
        figures.theory(left, n, sd.BOND2 * n**(1.0 - 2 * NU), label="ideal chain")
        left.set(xscale="log", ylim=(0.0, 1.15 * swollen.max()))
    left.set(xlabel="bonds $N$", ylabel="$\\langle R^2\\rangle/N^{1.1752}$ ($a_0^2$)")
    for number, z in enumerate(STRENGTHS):
        table = sizes(results, f"strength-{z:g}")
        if table is not None:
            x = table["bonds"]**-0.5
            figures.points(right, x, table["R2"] / table["ideal"], table["R2_error"] / table["ideal"], number=number, label=f"$z = {z:g}$")
            line = long_chains(table)[0]
            figures.points(right, [0.0], [swelling(z)], number=number, color=figures.INK)
            keep = table["bonds"] >= 32
            slope = stats.line(x[keep], (table["R2"] / table["ideal"])[keep], (table["R2_error"] / table["ideal"])[keep]).value[1]
            figures.line(right, [0.0, 32**-0.5], [line, line + slope * 32**-0.5], number=number, linestyle="-")
            figures.theory(right, [*x, 0.0], [*(swelling(sides_strength(d, n)) for d, n in zip(table["diameter"], table["bonds"])), swelling(z)],
                           linestyle=":", label="theory with sides alone" if number else None)
    right.set(xlabel="$N^{-1/2}$", ylabel="$\\langle R^2\\rangle/N\\langle l^2\\rangle$")
    figures.legend(left, loc="lower left")
    figures.legend(right)
    return figure


def draw_tube(results):
    figure, (left, right) = figures.plain(width=6.6, height=3.4, columns=2)
    tables = {width: results[f"tube-{width:g}"].columns for width in WIDTHS if f"tube-{width:g}" in results}
    for number, (width, table) in enumerate(tables.items()):
        figures.points(left, table["time"], table["d2"], table["d2_error"], number=number, label=f"$D = {width:g}$", markersize=3)
    left.set(xscale="log", yscale="log", xlabel="$t$ ($t_0$)", ylabel="$d^2$ (middle third, $a_0^2$)")
    thin = tables.get(0.0)
    for number, (width, table) in enumerate(tables.items()):
        if thin is None or width == 0.0:
            continue
        ratio = table["d2"] / thin["d2"]
        figures.points(right, table["time"], ratio, table["d2_error"] / thin["d2"], number=number, markersize=3)
        keep = table["time"] >= 32.0
        figures.line(right, table["time"][keep], [expected_ratio(square, width) for square in thin["d2"][keep]], number=number, linestyle="--")
        figures.line(right, [8.0, table["time"].max()], 2 * [crowding_ratio(width)], number=number, linestyle=":")
    right.axhline(1.0, color=figures.INK, linewidth=0.8)
    right.set(xscale="log", xlabel="$t$ ($t_0$)", ylabel="$d^2$ over that of thin lines")
    figures.legend(left)
    return figure


def drawn(results):
    """The figures whose runs there are."""
    known = (("state-", "state", "Pressure of spherocylinders with L/D = 5 against volume fraction (random starts below 0.25, parallel rods that were let go "
              "above), Monte Carlo of McGrother et al., Nezbeda's equation, and the virial series.", draw_state),
             ("aligned-", "order", "Nematic order of spherocylinders with L/D = 5 against volume fraction, 1236 to 1531 rods, from parallel rods and from rods "
              "without order (bars: half of what S changes between the halves of a run, where that is more), with Monte Carlo of McGrother et al.", draw_order),
             ("swelling", "swelling", "Single flexible chains of tubes. Left: the size of chains with D = 0.2, over N to the power 2ν. Right: swelling at the same z "
              "against N to the power −1/2, lines through chains of 32 bonds and more, and the theory of long chains (black, at 0). Dotted: that theory with B2 of the sides of "
              "bonds alone.", draw_swelling),
             ("tube-", "tube", "Left: d² of the middle third at cL³ = 1000, tubes of four diameters on the same start. Right: over d² of thin lines. Broken "
              "lines: the estimate of the verdict, which is wrong. Dotted: neighbors denser at contact by the contact value, and none nearer.", draw_tube))
    return [Figure(name, caption, lambda draw=draw: draw(results)) for first, name, caption, draw in known
            if any(run.startswith(first) for run in results)]


def evaluate(results, tier):
    verdicts = overlap_verdicts(results)
    for name in FLIGHTS:
        verdicts += flight_verdicts(results, name)
    verdicts += [state_verdict(results, fraction) for fraction in FRACTIONS]
    verdicts += order_verdicts(results, tier) + swelling_verdicts(results, tier)
    if tier == "campaign":
        verdicts.append(tube_verdict(results))
    return Outcome(verdicts, drawn(results), "" if results else "No run yet.")
