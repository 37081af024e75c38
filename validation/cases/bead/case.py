"""A driven bead: drag in a periodic box, what it does in a trap, and fibers around it."""
import math

import numpy
from scipy import optimize

from lib import figures, slit as slit_images, stats
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "A bead in the solvent and among fibers"
PAPER = "outlook; Hasimoto (1959), Lee and Kapral (2004), Padding and Louis (2006)"

GAMMA, STEP = 5.0, 0.1
RADIUS = 2.0
FORCE = 20.0       # kT/a0, in the box of 12
SPRING = 100.0     # kT/a0^2
SHORT, LONG = 40, 20  # parts of a run, for errors (validation/measure/bead.py)
SLIP_KNOWN = 0.06  # of the drag: the slip of a curved surface is not that of a flat one
RIGHT = 0.02       # of k<x^2>: omega^2 dt^2/4, and more than that
# Campaign: (rule, box, steps).
BOXES = (("srd", 12, 300000), ("srd", 16, 150000), ("srd", 24, 60000), ("at-a", 12, 120000))

# Networks: fibers of 16 vertices in 14^3, and beads of three radii, under a force of 6 R.
NETWORK_STEP, NETWORK_BOX = 0.05, 14
BOND = 0.52        # a0: mean length of a bond
VERTEX_MASS = 10.0
COUNTS = {1.5: (0, 25, 50, 100, 200, 400), 2.0: (0, 25, 50, 100, 200, 400), 3.0: (0, 25, 50, 100, 200)}
PULL = 6.0         # kT/a0 for each a0 of the radius
# Forces on a bead of 2 a0 among 100 fibers, with steps: the smaller the force, the longer.
PULLED, FORCES = 100, ((3.0, 80000), (6.0, 80000), (12.0, 60000), (24.0, 40000), (48.0, 20000))
# Moduli, in the solvent and among 200 fibers: (period in t0, spring in kT/a0^2, amplitude) of traps that swing.
DENSE = 200
SWINGS, SWING_STEPS, FREE_STEPS = ((60, 45, 0.5), (20, 60, 0.5), (6, 100, 0.4)), 73200, {0: 400000, DENSE: 240000}
OMEGAS = tuple(2 * math.pi / period for period in (120, 60, 35, 20, 11, 6, 3.5))
# Between walls: (their distance, height of the trap), which moves along them; Faxen's series for that place. Boxes of SLIT_LENGTH along them.
SLITS = {"middle": (12, 6.0), "quarter": (16, 4.0), "near-one": (24, 3.5)}
SLIT_LENGTH, SLIT_SPRING, SLIT_SPEED, SLIT_STEPS = 28, 20.0, 0.06, 160000
NANOSECONDS = {"srd": 8, "at-a": 26, "vertex": 100}  # CPU time of a particle or a vertex in a step


# --- runs -------------------------------------------------------------------------------------------------------------

def evaluated(name, scene, steps, seed, bead, rest, begin=50.0, kept=False, **more):
    """A run whose bead.csv makes the table `numbers` (validation/measure/bead.py). bead: (radius, mass); rest: mass of all else. more:
    options of that program."""
    radius, mass = bead
    words = [f"{rest / mass:.9g}", f"{radius:g}", f"{mass:.9g}", "--from", f"{begin:g}"]
    for key, value in more.items():
        words += [f"--{key}"] + ([] if value is True else [f"{x:.9g}" for x in numpy.atleast_1d(value)])
    return Run(name, scene=scene, steps=steps, seed=seed, after=("bead", *words), after_from="bead.csv", after_to="numbers",
               dropped=() if kept else ("bead",))


def alone(name, rule, box, drive, steps, seed, **more):
    """A bead of 2 a0 in its solvent."""
    scene = (f"box: [{box}, {box}, {box}]\ntime_step: {STEP}\n"
             f"solvent: {{per_cell: {GAMMA:g}, collision_interval: {STEP}, rule: {rule}}}\n"
             f"bead: {{radius: {RADIUS:g}, center: [{box / 2}, {box / 2}, {box / 2}], drive: {{{drive}}}}}\n"
             "observe: {bead: {every: 5}, conserved: {every: 100}}\n")
    bead, rest = masses(box)
    run = evaluated(name, scene, steps, seed, (RADIUS, bead), rest, **more)
    run.hours = NANOSECONDS[rule] * box**3 * GAMMA * steps / 3.6e12
    return run


def slit(place, seed):
    """A bead that a trap draws along walls at rest. Walls take up the momentum: all else does not move back, REST is without end."""
    distance, height = SLITS[place]
    scene = (f"box: [{SLIT_LENGTH}, {distance}, {SLIT_LENGTH}]\ntime_step: {STEP}\nwalls: {{kind: no-slip}}\n"
             f"solvent: {{per_cell: {GAMMA:g}, collision_interval: {STEP}}}\n"
             f"bead: {{radius: {RADIUS:g}, center: [{SLIT_LENGTH / 2:g}, {height:g}, {SLIT_LENGTH / 2:g}], "
             f"drive: {{spring: {SLIT_SPRING:g}, velocity: [{SLIT_SPEED:g}, 0, 0]}}}}\n"
             "observe: {bead: {every: 5}}\n")
    run = evaluated(f"slit-{place}", scene, SLIT_STEPS, seed, (RADIUS, masses(SLIT_LENGTH)[0]), 1e12, spring=SLIT_SPRING)
    run.hours = NANOSECONDS["srd"] * SLIT_LENGTH**2 * distance * GAMMA * SLIT_STEPS / 3.6e12
    return run


def network(name, count, radius, drive, steps, seed, every=20, **more):
    """A bead among so many fibers, with a drive or without one."""
    half = NETWORK_BOX / 2
    fibers = (f"fibers: [{{name: net, count: {count}, vertices: 16, mass: {VERTEX_MASS:g}, bond_length: 0.5, spring: 50, bending: 16}}]\n"
              "crossing: {rule: event-driven}\n") if count else ""
    wake = "wake: {every: 40}, from_time: 50, " if count and "force" in drive else ""
    drive = f", drive: {{{drive}}}" if drive else ""
    scene = (f"box: [{NETWORK_BOX}, {NETWORK_BOX}, {NETWORK_BOX}]\ntime_step: {NETWORK_STEP}\n"
             f"solvent: {{per_cell: {GAMMA:g}, collision_interval: {NETWORK_STEP}}}\n{fibers}"
             f"bead: {{radius: {radius:g}, center: [{half}, {half}, {half}]{drive}}}\n"
             f"observe: {{{wake}bead: {{every: {every}}}, conserved: {{every: 2000}}}}\n")
    bead, rest = masses(NETWORK_BOX, radius, count * 16 * VERTEX_MASS)
    run = evaluated(name, scene, steps, seed, (radius, bead), rest, **more)
    run.hours = (NANOSECONDS["srd"] * NETWORK_BOX**3 * GAMMA + NANOSECONDS["vertex"] * 16 * count) * steps / 3.6e12
    return run


def crowd(steps, hours, seed):
    """Thick and thin fibers, thermal bead, nothing pulls: momentum, energy and temperature."""
    kind = "vertices: 10, mass: 5, bond_length: 0.5, spring: 100, bending: 10"
    every = 10 if steps < 10000 else 50
    scene = ("box: [10, 10, 10]\ntime_step: 0.02\nsolvent: {per_cell: 5, collision_interval: 0.02}\n"
             f"fibers:\n  - {{name: thin, count: 60, {kind}}}\n  - {{name: thick, count: 30, {kind}, diameter: 0.2}}\n"
             "crossing: {rule: event-driven}\nbead: {radius: 1.5, center: [5, 5, 5]}\n"
             f"observe: {{bead: {{every: {every}}}, conserved: {{every: {5 * every}}}, collisions: {{every: 1000}}}}\n")
    return Run("crowd", scene=scene, steps=steps, hours=hours, seed=seed)


def moduli_runs():
    found = []
    for k, count in enumerate((DENSE, 0)):
        found.append(network(f"free-n{count}", count, RADIUS, "", FREE_STEPS[count], 940 + k, every=2, omega=OMEGAS))
        found += [network(f"swing-n{count}-T{period}", count, RADIUS,
                          f"spring: {spring}, amplitude: [{amplitude:g}, 0, 0], period: {period}", SWING_STEPS, 942 + 3 * k + i, every=2,
                          begin=60.0, spring=spring, omega=2 * math.pi / period, swings=True)
                  for i, (period, spring, amplitude) in enumerate(SWINGS)]
    return found


def network_runs():
    found = [network(f"force-{force:g}", PULLED, RADIUS, f"force: [{force:g}, 0, 0]", steps, 990 + k, parts=LONG)
             for k, (force, steps) in enumerate(FORCES)]
    for k, (radius, counts) in enumerate(COUNTS.items()):
        found += [network(f"network-R{radius:g}-n{count}", count, radius, f"force: [{PULL * radius:g}, 0, 0]", 40000 if count < 400 else 20000,
                          960 + 10 * k + i, parts=LONG)
                  for i, count in enumerate(counts) if (radius, count) != (RADIUS, PULLED)]  # force-12 is this one
    return found


def runs(tier):
    if tier == "quick":
        return [alone("pull-srd-L12", "srd", 12, f"force: [{FORCE:g}, 0, 0]", 30000, 901),
                alone("trap", "srd", 12, f"spring: {SPRING:g}", 30000, 902, begin=20.0, spring=SPRING), crowd(8000, 0.0007, 903)]
    found = [alone(f"pull-{rule}-L{box}", rule, box, "force: [6, 0, 0]", steps, 910 + k) for k, (rule, box, steps) in enumerate(BOXES)]
    found += [alone("trap", "srd", 12, f"spring: {SPRING:g}", 160000, 920, begin=20.0, spring=SPRING), crowd(60000, 0.03, 921)]
    found += [slit(place, 930 + k) for k, place in enumerate(SLITS)]
    return found + moduli_runs() + network_runs()


# --- what is known ----------------------------------------------------------------------------------------------------

def viscosity(rule):
    """Of molecular chaos, at kT = m = a0 = 1: kinetic and collisional part (SRD at 90 degrees: Kikuchi et al. 2003; Andersen without
    angular momentum: Noguchi and Gompper 2008). `uncross check` prints the same."""
    kept = GAMMA - 1.0 + math.exp(-GAMMA)
    if rule == "srd":
        return GAMMA * STEP * (5.0 / 6.0 * GAMMA / kept - 0.5) + kept / (18.0 * STEP)
    return GAMMA * STEP * (GAMMA / kept - 0.5) + kept / (12.0 * STEP)


def hasimoto(ratio):
    """Drag in a cubic lattice over that alone, of radius over edge; Hasimoto (1959), Eq. (61)."""
    return 1.0 / (1.0 - 2.837297 * ratio + 4.0 / 3.0 * math.pi * ratio**3 - 27.4 * ratio**6)


SLIP = {"srd": 0.078, "at-a": 0.131}  # a0: of a flat wall (docs/flow.md), at 5 particles per cell and dt 0.1


def drag(rule, box, radius=RADIUS):
    """6 pi eta R_h in the periodic box, R_h that of a sphere with this slip length."""
    slip = SLIP[rule]
    effective = radius * (radius + 2.0 * slip) / (radius + 3.0 * slip)
    return 6.0 * math.pi * viscosity(rule) * effective * hasimoto(effective / box)


def faxen(place, radius):
    """Drag along walls over that without them: Faxen's series (Happel and Brenner, Low Reynolds number hydrodynamics, Chapter 7). Near one wall what the far one adds is added."""
    distance, height = SLITS[place]
    x = radius / height
    if place == "middle":
        return 1.0 / (1.0 - 1.004 * x + 0.418 * x**3 + 0.21 * x**4 - 0.169 * x**5)
    if place == "quarter":
        return 1.0 / (1.0 - 0.6526 * x + 0.1475 * x**3 - 0.131 * x**4 - 0.0644 * x**5)
    near, far = (1.0 / (1.0 - 9.0 / 16.0 * x + x**3 / 8.0 - 45.0 / 256.0 * x**4 - x**5 / 16.0) for x in (x, radius / (distance - height)))
    return near + far - 1.0


def slit_drag(place, radius):
    """Drag along walls in m/t0, in the box of the runs."""
    eta, (distance, height) = viscosity("srd"), SLITS[place]
    return 1.0 / (1.0 / (6.0 * math.pi * eta * radius * faxen(place, radius)) + slit_images.images(height, distance, SLIT_LENGTH) / eta)


def masses(box, radius=RADIUS, vertices=0.0):
    """(of the bead, of all else)"""
    bead = GAMMA * 4.0 / 3.0 * math.pi * radius**3
    return bead, GAMMA * box**3 - bead + vertices


# --- verdicts ---------------------------------------------------------------------------------------------------------

def numbers(results, name):
    """{what: (value, error)} of a run, from its table `numbers`; empty without it."""
    if name not in results or not results[name].exists or "numbers" not in results[name].tables():
        return {}
    table = results[name].table("numbers")
    return {what: (float(value), float(error)) for what, value, error in zip(table["what"], table["value"], table["error"])}


def over(a, b):
    """A ratio with its error."""
    return a[0] / b[0], abs(a[0] / b[0]) * math.hypot(a[1] / a[0], b[1] / b[0])


def filled(verdict, pair, systematic=0.0, values=SHORT):
    verdict.measured, verdict.error = pair[0], float(pair[1])
    verdict.tolerance = stats.tolerance(verdict.error, verdict.expected_error, systematic=systematic, values=values)
    return verdict


def drag_verdicts(results, rule, box, tier):
    active = Verdict(f"bead.drag.{rule}.L{box}", f"drag over 6πηR_h in the box, R {RADIUS:g} in {box}³, {rule}", 1.0,
                     f"Hasimoto, slip of a flat wall, η of molecular chaos; known to {100 * SLIP_KNOWN:.0f} %", SLIP_KNOWN)
    passive = Verdict(f"bead.passive.{rule}.L{box}", f"kT/D across the force over the drag, R {RADIUS:g} in {box}³, {rule}", 1.0, "Einstein", 0.1)
    found = numbers(results, f"pull-{rule}-L{box}")
    if found:
        filled(active, over(found["active friction"], (drag(rule, box), 0.0)), SLIP_KNOWN)
        filled(passive, over(found["passive friction"], found["active friction"]), values=LONG)
    return [active] if tier == "quick" else [active, passive]


def radius_of(results):
    """(R_h, its error) of the bead in periodic boxes, srd: that of which 6 pi eta R_h in the box is the drag; None without runs."""
    found = []
    for rule, box, _ in BOXES:
        friction_ = numbers(results, f"pull-{rule}-L{box}").get("active friction")
        if rule == "srd" and friction_:
            unit = 6.0 * math.pi * viscosity(rule)
            radius = optimize.brentq(lambda r, box=box, known=friction_[0], unit=unit: unit * r * hasimoto(r / box) - known, 0.5, 4.0)
            slope = unit * (1.01 * radius * hasimoto(1.01 * radius / box) - radius * hasimoto(radius / box)) / (0.01 * radius)
            found.append((radius, friction_[1] / slope))
    return weighted(found) if found else None


def slit_verdicts(results):
    """Against Faxen's series, with the radius of periodic boxes; images in the periodic box along the walls add to the mobility."""
    verdicts, known = [], radius_of(results)
    for place, words in (("middle", "in the middle between two walls"), ("quarter", "at a quarter of their distance"), ("near-one", "near one wall")):
        verdict = Verdict(f"bead.slit.{place}", f"drag along walls over the drag of Faxén's series and images, {words}, R {RADIUS:g}, srd", 1.0,
                          "Faxén (Happel and Brenner 1965), R_h of the drag in periodic boxes; images along the walls (validation/lib/slit.py)", 0.0)
        found = numbers(results, f"slit-{place}").get("drawn friction")
        if found and known:
            low, middle, high = (slit_drag(place, r) for r in (known[0] - known[1], known[0], known[0] + known[1]))
            verdict.expected_error = (high - low) / (2.0 * middle)
            filled(verdict, (found[0] / middle, found[1] / middle))
        verdicts.append(verdict)
    return verdicts


def parted(values, parts=SHORT):
    """(mean, standard error) of parts of a series."""
    blocks = values[:len(values) // parts * parts].reshape(parts, -1).mean(axis=1)
    return stats.judged(float(blocks.mean()), values), float(blocks.std(ddof=1) / math.sqrt(parts))


def trap_verdicts(results):
    width = Verdict("bead.trap", "k⟨x²⟩ (1 + M/m) of a bead in a trap, kT", 1.0,
                    "equipartition, the momentum of the rest taken off; 2 % of the leap-frog", RIGHT)
    found = numbers(results, "trap")
    if found:
        filled(width, found["trap"], RIGHT)
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


# --- moduli -----------------------------------------------------------------------------------------------------------

def omega_of(period):
    return 2 * math.pi / period


def moduli(results, count):
    """(active, passive): {omega: (G', its error, G'', its error)} of the bead among so many fibers."""
    active, passive = {}, {}
    for period, *_ in SWINGS:
        found = numbers(results, f"swing-n{count}-T{period}")
        if found:
            active[omega_of(period)] = (*found["active G'"], *found["active G''"])
    found = numbers(results, f"free-n{count}")
    for omega in OMEGAS if found else ():
        passive[omega] = (*found[f"passive G' at {omega:g}"], *found[f"passive G'' at {omega:g}"])
    return active, passive


def differences(active, passive, k):
    """[(difference over |G|, its error)] of G' (k 0) or G'' (k 1) at the frequencies that both have."""
    found = []
    for omega in sorted(set(active) & set(passive)):
        a, b, size = active[omega], passive[omega], math.hypot(active[omega][0], active[omega][2])
        found.append(((b[2 * k] - a[2 * k]) / size, math.hypot(a[2 * k + 1], b[2 * k + 1]) / size))
    return found


def moduli_verdicts(results):
    """One for G' and one for G'': the frequencies are far enough apart for their errors to be independent."""
    verdicts = []
    for count, words in ((0, "in the solvent"), (DENSE, f"among {DENSE} fibers")):
        active, passive = moduli(results, count)
        for k, name in enumerate(("G′", "G″")):
            verdict = Verdict(f"bead.moduli.n{count}.{'storage' if k == 0 else 'loss'}",
                              f"{name} of a free bead less that of a swinging one, over |G|, mean of three frequencies, {words}", 0.0,
                              "generalized Stokes–Einstein relation", 0.1, must_see=0.6)
            found = differences(active, passive, k)
            if len(found) == len(SWINGS):
                filled(verdict, weighted(found), values=LONG)
            verdicts.append(verdict)
    return verdicts


def draw_moduli(results):
    figure, panels = figures.plain(width=9.5, height=4.4, columns=2)
    for panel, (count, title) in zip(panels, ((0, "solvent alone"), (DENSE, f"{DENSE} fibers"))):
        active, passive = moduli(results, count)
        for k, name in enumerate(("G′", "G″")):
            sign = -1.0 if k == 0 else 1.0
            label = "−G′" if k == 0 else name
            if passive:
                omega = numpy.array(sorted(passive))
                value, error = (numpy.array([passive[w][2 * k + e] for w in omega]) for e in (0, 1))
                panel.fill_between(omega, sign * value - error, sign * value + error, alpha=0.3, color=figures.COLORS[k], linewidth=0)
                panel.plot(omega, sign * value, color=figures.COLORS[k], linewidth=1, label=f"{label}, passive")
            if active:
                omega = numpy.array(sorted(active))
                figures.points(panel, omega, *(numpy.array([s * active[w][2 * k + e] for w in omega]) for e, s in ((0, sign), (1, 1.0))),
                               number=k, markersize=4, label=f"{label}, active")
        panel.axhline(0.0, color=figures.INK, linewidth=0.6)
        panel.set(xscale="log", xlabel="ω $t_0$", ylabel="modulus ($kT/a_0^3$)", title=title)
    figures.legend(panels[0])
    return figure


# --- friction among fibers --------------------------------------------------------------------------------------------

def mesh(count):
    """(length density)^(-1/2) of the network, a0."""
    return math.inf if count == 0 else (NETWORK_BOX**3 / (count * 15 * BOND)) ** 0.5


def friction(results, radius, count):
    """(friction, error) at the force of this radius, or None."""
    name = f"force-{PULL * radius:g}" if (radius, count) == (RADIUS, PULLED) else f"network-R{radius:g}-n{count}"
    return numbers(results, name).get("active friction")


def excess(results, radius, count):
    """Friction over that without fibers, and its error; None if a run is missing."""
    here, alone_ = friction(results, radius, count), friction(results, radius, 0)
    return over(here, alone_) if here and alone_ else None


def weighted(values):
    weights = numpy.array([1.0 / error**2 for _, error in values])
    return float(weights @ [value for value, _ in values] / weights.sum()), float(weights.sum() ** -0.5)


def weight(results, force):
    """(friction, error) of a force on the bead among the dense fibers, or None."""
    return numbers(results, f"force-{force:g}").get("active friction")


def linear_verdicts(results):
    verdict = Verdict("bead.linear", "friction at 24 kT/a0 over that at 3, 6 and 12 kT/a0, 100 fibers", 1.0, "linear response", 0.3)
    small = [weight(results, force) for force in (3.0, 6.0, 12.0)]
    if all(small) and weight(results, 24.0):
        filled(verdict, over(weight(results, 24.0), weighted(small)), values=LONG)
    return [verdict]


def draw_force(results):
    figure, panel = figures.plain(width=5.5, height=4.0)
    found = [(force, *weight(results, force)) for force, _ in FORCES if weight(results, force)]
    alone_ = friction(results, RADIUS, 0)
    if alone_:
        panel.axhline(alone_[0], color=figures.INK, linewidth=1.0, label="solvent alone")
    force, value, error = (numpy.array(column) for column in zip(*found))
    figures.points(panel, force, value, error, markersize=4, label=f"{PULLED} fibers")
    panel.set(xscale="log", xlabel="force ($kT/a_0$)", ylabel="friction ($m/t_0$)")
    panel.set_ylim(bottom=0.0)
    figures.legend(panel)
    return figure


def draw_network(results):
    figure, panel = figures.plain(width=5.5, height=4.0)
    for number, (radius, counts) in enumerate(COUNTS.items()):
        shown = [(radius / mesh(count), *excess(results, radius, count)) for count in counts[1:] if excess(results, radius, count)]
        if shown:
            x, y, error = (numpy.array(column) for column in zip(*shown))
            figures.points(panel, x, y, error, number=number, markersize=4, label=f"R = {radius:g} $a_0$")
    panel.axhline(1.0, color=figures.INK, linewidth=0.6)
    panel.set(xscale="log", yscale="log", xlabel="R over the mesh size", ylabel="friction over that without fibers")
    figures.legend(panel)
    return figure


# --- the network around the bead --------------------------------------------------------------------------------------

WAKE = 24.0  # kT/a0, of the force whose wake is drawn


def stokes(distance, cosine):
    """Flow along the motion over the speed of a sphere of the bead's radius without slip, in a fluid without end."""
    x = RADIUS / distance
    return 0.75 * x * (1.0 + cosine**2) + 0.25 * x**3 * (1.0 - 3.0 * cosine**2)


def draw_wake(result, speed):
    figure, panels = figures.plain(width=9.5, height=4.4, columns=2)
    table, interval = result.table("wake"), 40 * NETWORK_STEP
    for number, cosine in enumerate(sorted(set(table["cosine"]))):
        here = table["cosine"] == cosine
        label = f"cos θ = {cosine:g}"
        distance = table["distance"][here]
        figures.points(panels[0], distance, *(table[name][here] / (interval * speed) for name in ("along", "along_error")), number=number,
                       markersize=4, label=label)
        figures.points(panels[1], distance, table["number"][here], table["number_error"][here], number=number, markersize=4)
    distance = numpy.linspace(RADIUS, NETWORK_BOX / 2, 50)
    for cosine, label in ((0.25, "Stokes, cos θ = ±0.25"), (0.75, "Stokes, cos θ = ±0.75")):
        figures.theory(panels[0], distance, stokes(distance, cosine), linestyle=figures.STROKES[cosine > 0.5], label=label)
    panels[0].set(xlabel="distance from the center ($a_0$)", ylabel="displacement along the force, of the bead's")
    panels[1].set(xlabel="distance from the center ($a_0$)", ylabel="vertices per volume ($a_0^{-3}$)")
    panels[1].axhline(PULLED * 16 / (NETWORK_BOX**3 - 4.0 / 3.0 * math.pi * RADIUS**3), color=figures.INK, linewidth=0.8)
    figures.legend(panels[0])
    return figure


def shown_of(results):
    found = []
    if numbers(results, "free-n0"):
        found.append(Figure("moduli", "Moduli that a bead of 2 a0 feels, with the inertia of the fluid in them: of traps that swing (points) and of the mean "
                            "square displacement of a free bead (bands of one standard error).", lambda: draw_moduli(results)))
    if any(weight(results, force) for force, _ in FORCES):
        found.append(Figure("force", f"Friction of a bead of 2 a0 among {PULLED} fibers against the force on it.", lambda: draw_force(results)))
    if any(excess(results, radius, count) for radius, counts in COUNTS.items() for count in counts[1:]):
        found.append(Figure("network", "Friction of a bead among fibers over that in the solvent alone, in the same box, against its radius over the mesh size, "
                            "which is (length density)^(-1/2).", lambda: draw_network(results)))
    wake, name = weight(results, WAKE), f"force-{WAKE:g}"
    if wake and "wake" in results[name].tables():
        found.append(Figure("wake", f"The network around a bead of 2 a0 that is pulled with {WAKE:g} kT/a0. Left: mean displacement of vertices along the force, "
                            "over the bead's relative to all else; lines: flow around a sphere in a fluid without end. Right: number density of vertices; "
                            "line: its mean outside of the bead. θ is the angle with the force.",
                            lambda: draw_wake(results[name], WAKE / wake[0])))
    return found


def evaluate(results, tier):
    boxes = [("srd", 12)] if tier == "quick" else [(rule, box) for rule, box, _ in BOXES]
    verdicts = [v for rule, box in boxes for v in drag_verdicts(results, rule, box, tier)] + trap_verdicts(results) + crowd_verdicts(results)
    if tier == "quick":
        return Outcome(verdicts)
    return Outcome(verdicts + slit_verdicts(results) + moduli_verdicts(results) + linear_verdicts(results), shown_of(results))
