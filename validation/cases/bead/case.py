"""A driven bead: drag in a periodic box, what it does in a trap, and fibers around it."""
import importlib.util
import math

import numpy

from lib import figures, stats
from lib.case import Figure, Outcome, Verdict
from lib.runs import TREE, Run

TITLE = "A bead in the solvent and among fibers"
PAPER = "outlook; Hasimoto (1959), Lee and Kapral (2004), Padding and Louis (2006)"

GAMMA, STEP = 5.0, 0.1
RADIUS = 2.0
FORCE = 20.0       # kT/a0, in the box of 12
SPRING = 100.0     # kT/a0^2
PARTS = 40         # of a run, for errors
SLIP_KNOWN = 0.06  # of the drag: the slip of a curved surface is not that of a flat one
RIGHT = 0.02       # of k<x^2>: omega^2 dt^2/4, and more than that
# Campaign: (rule, box, steps).
BOXES = (("srd", 12, 300000), ("srd", 16, 150000), ("srd", 24, 60000), ("at-a", 12, 840000))
# A network: fibers of 16 vertices in 14^3; beads of radius 2, and of 1.5 and 3 in the middle density.
NETWORK_STEP, NETWORK_STEPS, NETWORK_FORCE, NETWORK_BOX = 0.05, 24000, 12.0, 14
NETWORKS = ((0, 2.0), (50, 2.0), (100, 2.0), (200, 2.0), (400, 2.0), (0, 1.5), (200, 1.5), (0, 3.0), (200, 3.0))


def measure():
    """The program that reads bead.csv: validation/measure/bead.py."""
    spec = importlib.util.spec_from_file_location("measure_bead", TREE / "validation/measure/bead.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


# --- runs -------------------------------------------------------------------------------------------------------------

def alone(name, rule, box, drive, steps, hours, seed):
    scene = (f"box: [{box}, {box}, {box}]\ntime_step: {STEP}\n"
             f"solvent: {{per_cell: {GAMMA:g}, collision_interval: {STEP}, rule: {rule}}}\n"
             f"bead: {{radius: {RADIUS:g}, center: [{box / 2}, {box / 2}, {box / 2}], drive: {{{drive}}}}}\n"
             "observe: {bead: {every: 5}, conserved: {every: 100}}\n")
    return Run(name, scene=scene, steps=steps, hours=hours, seed=seed)


def network(name, count, radius, steps, hours, seed):
    half = NETWORK_BOX / 2
    fibers = (f"fibers: [{{name: net, count: {count}, vertices: 16, mass: 10, bond_length: 0.5, spring: 50, bending: 16}}]\n"
              "crossing: {rule: event-driven}\n") if count else ""
    scene = (f"box: [{NETWORK_BOX}, {NETWORK_BOX}, {NETWORK_BOX}]\ntime_step: {NETWORK_STEP}\n"
             f"solvent: {{per_cell: {GAMMA:g}, collision_interval: {NETWORK_STEP}}}\n{fibers}"
             f"bead: {{radius: {radius:g}, center: [{half}, {half}, {half}], drive: {{force: [{NETWORK_FORCE:g}, 0, 0]}}}}\n"
             "observe: {bead: {every: 10}, conserved: {every: 1000}}\n")
    return Run(name, scene=scene, steps=steps, hours=hours, seed=seed)


def crowd(steps, hours, seed):
    """Thick and thin fibers, thermal bead, nothing pulls: momentum, energy and temperature."""
    kind = "vertices: 10, mass: 5, bond_length: 0.5, spring: 100, bending: 10"
    scene = ("box: [10, 10, 10]\ntime_step: 0.02\nsolvent: {per_cell: 5, collision_interval: 0.02}\n"
             f"fibers:\n  - {{name: thin, count: 60, {kind}}}\n  - {{name: thick, count: 30, {kind}, diameter: 0.2}}\n"
             "crossing: {rule: event-driven}\nbead: {radius: 1.5, center: [5, 5, 5]}\n"
             "observe: {bead: {every: 10}, conserved: {every: 50}, collisions: {every: 100}}\n")
    return Run("crowd", scene=scene, steps=steps, hours=hours, seed=seed)


def runs(tier):
    if tier == "quick":
        return [alone("pull-srd-L12", "srd", 12, f"force: [{FORCE:g}, 0, 0]", 30000, 0.0015, 901),
                alone("trap", "srd", 12, f"spring: {SPRING:g}", 30000, 0.0015, 902), crowd(8000, 0.0007, 903)]
    found = [alone(f"pull-{rule}-L{box}", rule, box, "force: [6, 0, 0]", steps, 1.3e-10 * box**3 * GAMMA * steps * 0.5, 910 + k)
             for k, (rule, box, steps) in enumerate(BOXES)]
    found += [alone("trap", "srd", 12, f"spring: {SPRING:g}", 160000, 0.02, 920), crowd(60000, 0.03, 921)]
    return found + [network(f"network-R{radius:g}-n{count}", count, radius, NETWORK_STEPS, 0.02 + 0.0002 * count, 930 + k)
                    for k, (count, radius) in enumerate(NETWORKS)]


# --- what is known ----------------------------------------------------------------------------------------------------

def viscosity(rule):
    """Of molecular chaos, at kT = m = a0 = 1: kinetic and collisional part (SRD at 90 degrees; Andersen without angular
    momentum)."""
    kept = GAMMA - 1.0 + math.exp(-GAMMA)
    if rule == "srd":
        kinetic = GAMMA * STEP * (GAMMA / kept - 0.5)
        return kinetic + kept / (18.0 * STEP)
    return GAMMA * STEP * (GAMMA / kept - 0.5) + kept / (12.0 * STEP)


def hasimoto(ratio):
    """Drag in a cubic lattice over that alone, of radius over edge; Hasimoto (1959), Eq. (61)."""
    return 1.0 / (1.0 - 2.837297 * ratio + 4.0 / 3.0 * math.pi * ratio**3 - 27.4 * ratio**6)


SLIP = {"srd": 0.078, "at-a": 0.131}  # a0: of a flat wall (docs/walls.md), at 5 particles per cell and dt 0.1


def drag(rule, box, radius=RADIUS):
    """6 pi eta R_h in the periodic box, R_h that of a sphere with this slip length."""
    slip = SLIP[rule]
    effective = radius * (radius + 2.0 * slip) / (radius + 3.0 * slip)
    return 6.0 * math.pi * viscosity(rule) * effective * hasimoto(effective / box)


def masses(box, radius=RADIUS, vertices=0.0):
    """(of the bead, of all else)"""
    bead = GAMMA * 4.0 / 3.0 * math.pi * radius**3
    return bead, GAMMA * box**3 - bead + vertices


# --- verdicts ---------------------------------------------------------------------------------------------------------

def pulled(result, rest, begin=50.0):
    """((friction of the force, error), (of diffusion across it, error)), or None."""
    tool = measure()
    table = result.table("bead")
    kept = table["time"] >= begin
    table = {name: column[kept] for name, column in table.items()}
    time, place, force = table["time"], tool.vectors(table, "place"), tool.vectors(table, "force")
    across = tool.passive_friction(time, place[1:])  # of ten parts: lags are long
    tool.PARTS = PARTS
    return tool.active_friction(time, place, force, rest), across


def filled(verdict, pair, systematic=0.0, values=PARTS):
    verdict.measured, verdict.error = float(pair[0]), float(pair[1])
    verdict.tolerance = stats.tolerance(verdict.error, systematic=systematic, values=values)
    return verdict


def drag_verdicts(results, rule, box, tier):
    expected = drag(rule, box)
    word = f"R {RADIUS:g} in {box}³, {rule}"
    active = Verdict(f"bead.drag.{rule}.L{box}", f"drag over 6πηR_h in the box, {word}", 1.0,
                     f"Hasimoto, slip of a flat wall, η of molecular chaos; known to {100 * SLIP_KNOWN:.0f} %", SLIP_KNOWN)
    passive = Verdict(f"bead.passive.{rule}.L{box}", f"kT/D across the force over the drag, {word}", 1.0, "Einstein", 0.1)
    name = f"pull-{rule}-L{box}"
    if name in results and results[name].exists:
        bead, rest = masses(box)
        (value, error), (across, spread) = pulled(results[name], rest / bead)
        filled(active, (value / expected, error / expected), SLIP_KNOWN)
        ratio = across / value
        filled(passive, (ratio, ratio * math.hypot(spread / across, error / value)), values=10)
    return [active] if tier == "quick" else [active, passive]


def parted(values, parts=PARTS):
    """(mean, standard error) of parts of a series."""
    blocks = values[:len(values) // parts * parts].reshape(parts, -1).mean(axis=1)
    return float(blocks.mean()), float(blocks.std(ddof=1) / math.sqrt(parts))


def trap_verdicts(results):
    width = Verdict("bead.trap", "k⟨x²⟩ (1 + M/m) of a bead in a trap, kT", 1.0,
                    "equipartition, the momentum of the rest taken off; 2 % of the leap-frog", RIGHT)
    if "trap" in results and results["trap"].exists:
        bead, rest = masses(12)
        table = results["trap"].table("bead")
        kept = table["time"] >= 20.0
        square = sum((table[f"place_{axis}"] - table[f"trap_{axis}"])[kept]**2 for axis in "xyz") / 3.0
        filled(width, parted(SPRING * (1.0 + bead / rest) * square), RIGHT)
    return [width]


def crowd_verdicts(results):
    momentum = Verdict("bead.momentum", "largest total momentum of solvent, fibers and bead, m a0/t0", 0.0,
                       "conserved at every hit and contact; 10⁻⁸ for rounding", 1e-8)
    energy = Verdict("bead.energy", "growth of the energy less the bead's heat, of itself per t0", 0.0,
                     "conserved but for what the leap-frog loses; 10⁻⁶", 1e-6)
    heat = Verdict("bead.temperature", "M⟨V²⟩/3 of a bead among fibers over its mean at fixed momentum, kT", 1.0, "equipartition", 0.1)
    if "crowd" in results and results["crowd"].exists:
        result = results["crowd"]
        bead, rest = masses(10, 1.5, 900 * 5.0)
        table, motion = result.table("conserved"), result.table("bead")
        momentum.measured = float(max(numpy.abs(table[axis]).max() for axis in ("px", "py", "pz")))
        given = numpy.interp(table["time"], motion["time"], motion["heat"])
        less = table["total"] - given
        half = len(less) // 2
        span = table["time"][half:].mean() - table["time"][:half].mean()
        energy.measured = float((less[half:].mean() - less[:half].mean()) / span / less[0])
        square = sum(motion[f"velocity_{axis}"]**2 for axis in "xyz") / 3.0
        filled(heat, parted(bead * (1.0 + bead / rest) * square[motion["time"] >= 5.0]))
    return [momentum, energy, heat]


# --- friction among fibers --------------------------------------------------------------------------------------------

def mesh(count):
    """(length density)^(-1/2) of the network, a0."""
    return math.inf if count == 0 else (NETWORK_BOX**3 / (count * 15 * 0.52)) ** 0.5


def network_rows(results):
    """(fibers, radius, friction, error)"""
    found = []
    for count, radius in NETWORKS:
        name = f"network-R{radius:g}-n{count}"
        if name in results and results[name].exists:
            bead, rest = masses(NETWORK_BOX, radius, count * 160.0)
            found.append((count, radius, *pulled(results[name], rest / bead)[0]))
    return found


def ratio(rows, count, radius):
    """Friction over that without fibers, and its error; None if a run is missing."""
    known = {(n, r): (value, error) for n, r, value, error in rows}
    if (count, radius) not in known or (0, radius) not in known:
        return None
    (a, da), (b, db) = known[count, radius], known[0, radius]
    return a / b, a / b * math.hypot(da / a, db / b)


def draw(rows):
    figure, panel = figures.plain(width=5.5, height=4.0)
    for number, radius in enumerate((1.5, 2.0, 3.0)):
        shown = [(radius / mesh(count), *ratio(rows, count, radius)) for count, r, _, _ in rows
                 if r == radius and count and ratio(rows, count, radius)]
        if shown:
            x, y, error = (numpy.array(column) for column in zip(*shown))
            figures.points(panel, x, y, error, number=number, markersize=4, label=f"R = {radius:g} $a_0$")
    panel.set(xlabel="R over the mesh size", ylabel="friction over that without fibers")
    figures.legend(panel)
    return figure


def evaluate(results, tier):
    boxes = [("srd", 12)] if tier == "quick" else [(rule, box) for rule, box, _ in BOXES]
    verdicts = [v for rule, box in boxes for v in drag_verdicts(results, rule, box, tier)] + trap_verdicts(results) + crowd_verdicts(results)
    rows = [] if tier == "quick" else network_rows(results)
    shown = [Figure("network", "Friction of a bead among fibers over that in the solvent alone, in the same box, against its radius over the mesh size, "
                    "which is (length density)^(-1/2).", lambda: draw(rows))] if rows else []
    return Outcome(verdicts, shown)
