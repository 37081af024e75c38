"""One chain in several media: overdamped with and without hydrodynamic interactions, Langevin; and the fluid of DPD."""
import math

import numpy

from lib import dilute, figures, filaments, integrators, interfaces, media
from lib.case import Figure, Outcome, Verdict, again
from lib.media import BLOCKS, at, fill, mean_of
from lib.runs import Run

TITLE = "Media around a chain"
PAPER = "not in the paper; Ermak and McCammon (1978), Rotne and Prager (1969), Groot and Warren (1997)"

RADIUS = 0.25  # over the rms bond: D of a chain scales as 1/sqrt(N) from few vertices on
RADII = (0.05, 0.1, 0.5)  # others, of chains of ten
STEP = 0.01    # b^2/D0
EVERY = 20     # steps between samples
CHAINS = {5: 200, 10: 100, 20: 50}
LENGTH = {"quick": 1, "campaign": 10}
OF_CHAINS = {"quick": 0.4, "campaign": 10}  # the same for chains, whose verdicts allow more than their errors
QUICK_STEPS = 200000
FIRST = 0.05    # b^2/D0: 5 steps; at the first lag a chain has hardly changed its shape
DPD_PRESSURE, DPD_KNOWN = 23.65, 0.02  # rho 3, a 25: a program of its own, small steps
PARTS = (integrators, interfaces, filaments)  # of the campaign


def chain(name, medium, vertices, count, steps, hours, step=STEP, every=EVERY, first=2000, memory=""):
    scene = (f"box: [64, 64, 64]\ntime_step: {step}\norder: drift-split\nmedium: {medium}\ncrossing: {{forbidden: false}}\n"
             f"fibers: [{{name: chain, count: {count}, vertices: {vertices}, mass: 1, bond_length: 0, spring: 3}}]\n"
             f"observe: {{from: {first}, dynamics: {{every: {every}}}, statics: {{every: {every}}}{memory}}}\n")
    return Run(name, scene=scene, steps=steps, hours=hours, goals=((steps // 10, 0),) if steps > QUICK_STEPS else ())


def chains_of(tier):
    """Vertices and number of the chains with hydrodynamic interactions."""
    return CHAINS if tier == "campaign" else {10: CHAINS[10]}


def runs(tier):
    n, m = LENGTH[tier], OF_CHAINS[tier]
    rpy = f"{{kind: overdamped, rate: 1, tensor: rpy, radius: {RADIUS}}}"
    found = [chain(f"rpy-N{vertices}", rpy, vertices, count, round(40000 * m), 0.01 * m, every=5)
             for vertices, count in chains_of(tier).items()]
    if tier == "campaign":
        found += [chain(f"rpy-N10-a{radius:g}", f"{{kind: overdamped, rate: 1, tensor: rpy, radius: {radius}}}", 10, 100, 40000, 0.004, every=5) for radius in RADII]
    found.append(chain("none-N10", "{kind: overdamped, rate: 1}", 10, 100, 40000 * n, 0.002 * n))
    found.append(chain("langevin-N10", "{kind: private, rate: 10, draw: relax}", 10, 50, round(200000 * m), 0.005 * m, step=0.02,
                       every=200, first=10000, memory=", memory: {every: 5}"))
    fluid = ("box: [5, 5, 5]\ntime_step: 0.01\norder: kick-split\n"
             "medium: {kind: pairs, density: 3, rate: 9, draw: relax, weight: quadratic, repulsion: 25}\n"
             "observe: {pressure: {every: 20}, temperature: {every: 20}}\n")
    found.append(Run("dpd", scene=fluid, steps=20000 * n, hours=0.003 * n))
    parts = [run for part in PARTS for run in part.runs()]
    # in doubt: media.limit.free, D 0.5503(77); media.schmidt.rho1, 0.766(22); media.cold.free, 0.947(13)
    parts += [again(run, 2) for run in media.runs() if run.name in ("la1-free", "la-rho1-free", "la-free", "la30-free")]
    parts.append(media.FLUIDS["la-rho1"].wave_run("la-rho1-wave-again", 0.004, seed=2))
    return found + media.runs() + parts if tier == "campaign" else found + integrators.quick_runs()


# --- what is known ----------------------------------------------------------------------------------------------------

def rates(vertices):
    """Of Rouse's modes, D0/b^2."""
    p = numpy.arange(1, vertices)
    return 12.0 * numpy.sin(p * math.pi / (2 * vertices)) ** 2


def bond_square(vertices):
    """<l^2>/b^2 of steps by Euler's rule, without hydrodynamic interactions."""
    return float((1.0 / (1.0 - 0.5 * rates(vertices) * STEP)).mean())


def kirkwood(vertices):
    """D of short times over D0: the numerical integral of lib/dilute.py, not the closed form of the program."""
    return dilute.kirkwood_chain(vertices, RADIUS) / dilute.stokes(RADIUS)


# --- verdicts ---------------------------------------------------------------------------------------------------------

def chain_verdicts(results, vertices):
    """A step of 0.01 makes bonds too long by about 1 %, and D_K too low by half of it."""
    name, expected = f"rpy-N{vertices}", kirkwood(vertices)
    short = Verdict(f"media.short.N{vertices}", f"D/D0 of short times, N = {vertices}, a/b = 1/4", expected,
                    "Kirkwood's sum with Rotne-Prager-Yamakawa, known to 1 % at this step", 0.01 * expected)
    late = Verdict(f"media.late.N{vertices}", f"D of long times over Kirkwood's, N = {vertices}", 0.98,
                   "literature: 1 to 3 % below", 0.02)
    bond = Verdict(f"media.bond.N{vertices}", f"⟨l²⟩/b² with hydrodynamic interactions, N = {vertices}", 1.0,
                   "exact for small steps; known to 3 % at this one", 0.03)
    if name in results:
        table, statics = results[name].table("dynamics-chain"), results[name].table("statics-chain")
        fill(short, at(table, "D", FIRST), 0.01 * expected)
        value, error = at(table, "D_cumulative", 6.4 if vertices < 20 else 12.8)
        fill(late, (value / expected, error / expected), 0.02)
        fill(bond, (statics["l2"][0], statics["l2_error"][0]), 0.03)
    return [short, late, bond]


def radius_verdicts(results):
    """Chains of ten with other radii: at a/b of 0.05 hardly any interactions, at 0.5 twice those of 1/4."""
    found = []
    for radius in RADII:
        expected, name = dilute.kirkwood_chain(10, radius) / dilute.stokes(radius), f"rpy-N10-a{radius:g}"
        verdict = Verdict(f"media.short.a{radius:g}", f"D/D0 of short times, N = 10, a/b = {radius:g}", expected,
                          "Kirkwood's sum with Rotne-Prager-Yamakawa, known to 1 % at this step; 0.1 without interactions", 0.01 * expected)
        found.append(fill(verdict, at(results[name].table("dynamics-chain"), "D", FIRST), 0.01 * expected) if name in results else verdict)
    return found


def ideal_verdicts(results):
    free = Verdict("media.none.D", "D/D0 without hydrodynamic interactions, N = 10", 0.1, "exact at any step", 0.01)
    bond = Verdict("media.none.bond", "⟨l²⟩/b² of steps by Euler's rule, N = 10", bond_square(10), "exact", 0.01)
    langevin = Verdict("media.langevin.D", "D of a chain in a Langevin bath, N = 10", 0.001 / math.tanh(0.1),
                       "exact at any step: (dt/2N) coth(rate dt/2)", 0.001)
    if "none-N10" in results:
        fill(free, at(results["none-N10"].table("dynamics-chain"), "D", 6.4))
        statics = results["none-N10"].table("statics-chain")
        fill(bond, (statics["l2"][0], statics["l2_error"][0]))
    if "langevin-N10" in results:
        fill(langevin, at(results["langevin-N10"].table("dynamics-chain"), "D_cumulative", 64.0))
    return [free, bond, langevin]


def fluid_verdicts(results):
    pressure = Verdict("media.dpd.pressure", "pressure of DPD, ρ = 3, a = 25, kT/a0³", DPD_PRESSURE, "another program", 0.1,
                       expected_error=DPD_KNOWN)
    kinetic = Verdict("media.dpd.kinetic", "kinetic temperature of DPD, dt 0.01", 1.0, "exact, and O(dt²)", 0.01)
    inner = Verdict("media.dpd.configurational", "configurational temperature of DPD, dt 0.01", 1.0, "exact, and O(dt²)", 0.01)
    if "dpd" in results:
        table, heat = results["dpd"].table("pressure"), results["dpd"].table("temperature")
        value, error = mean_of(table["pressure"])
        fill(pressure, (value + 1.0 / 125.0, error), 0.02, expected_error=DPD_KNOWN, values=BLOCKS)  # kT/V: momentum is fixed
        fill(kinetic, mean_of(heat["solvent"]), 0.01, values=BLOCKS)
        (square, error), (laplacian, _) = mean_of(table["force_square"]), mean_of(table["laplacian"])
        fill(inner, (square / laplacian, float(error / laplacian)), 0.01, values=BLOCKS)
    return [pressure, kinetic, inner]


# --- figures ----------------------------------------------------------------------------------------------------------

def draw(results):
    figure, panel = figures.plain(width=5.5, height=4.0)
    for number, name in enumerate(name for name in ("rpy-N5", "rpy-N10", "rpy-N20", "none-N10") if name in results):
        table, vertices = results[name].table("dynamics-chain"), int(name.split("N")[1])
        known = table["intervals"] > 16
        figures.points(panel, table["time"][known], vertices * table["D"][known], vertices * table["D_error"][known],
                       number=number, markersize=3, label=("no HI, " if "none" in name else "") + f"N = {vertices}")
    panel.set(xscale="log", xlabel="lag ($b^2/D_0$)", ylabel="$N D/D_0$")
    figures.legend(panel, loc="center left", bbox_to_anchor=(0.0, 0.235))
    return figure


CAPTIONS = ("Temperatures of a fluid of DPD (ρ = 3, a = 25, γ = 4.5) by eight integrators (explicit Euler is off the scale: 4.7 and 12 at a step of 0.04). Left: kinetic, of velocities. Right: configurational, of places, which a bath does not hold.",
            "Left: density across a slab of the many-body liquid; its vapour is empty. Right: pressure of droplets of one liquid in another, against Laplace's line with the tension of a flat surface.",
            "A filament. Left: how far its ends trail behind its middle, and how far apart they are, against the force. Right: how fast it aligns with the axis of a force that turns, against how fast that turns.")


def evaluate(results, tier):
    verdicts = [verdict for vertices in chains_of(tier) for verdict in chain_verdicts(results, vertices)]
    verdicts += ideal_verdicts(results) + fluid_verdicts(results)
    drawn = [Figure("chains", "N D/D0 of chains against the lag, with and without hydrodynamic interactions. Without, it is 1 at "
                    "any lag; with them it falls from Kirkwood's value by some per cent.", lambda: draw(results))] if results else []
    if tier == "quick":
        return Outcome(verdicts + integrators.quick_verdicts(results), drawn, "" if results else "No run yet.")
    if media.costs(results):
        drawn.insert(0, Figure("six", "The same chain of ten vertices in six media. Left: error of D against CPU time; lines fall as one over the "
                               "root of the time from the point that was measured. Without hydrodynamic interactions D stays wrong by 65 %. Right: what each medium can "
                               "show in this program.", lambda: media.draw_costs(results)))
    if any(name in results for _, name, _ in media.REMEMBER):
        drawn.append(Figure("memory", "Memory of the centre of mass of a chain of ten, in units in which all fluids have one curve. The line is for a "
                            "chain that keeps its shape, in a fluid without sound and without end.", lambda: media.draw_memory(results)))
    for part, name, caption in zip(PARTS, ("integrators", "interfaces", "filament"), CAPTIONS):
        if any(run.name in results for run in part.runs()):
            drawn.append(Figure(name, caption, lambda part=part: part.draw(results)))
    verdicts += radius_verdicts(results) + media.verdicts(results) + [verdict for part in PARTS for verdict in part.verdicts(results)]
    return Outcome(verdicts, drawn, "" if results else "No run yet.")
