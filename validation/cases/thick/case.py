"""Thick fibers: rods whose excluded volume, contacts and pressure are known."""
import math

from lib import figures, stats
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "Thick fibers: excluded volume, rates of contacts, pressure"
PAPER = "Sec. III C (an outlook there); Onsager (1949), Nezbeda (1976)"

SHAPES = ((1.0, 0.5), (2.5, 0.5), (2.0, 0.02))  # length, diameter of pairs laid at random
FLIGHTS = {"thin": (12, 400, 0.001), "slim": (12, 200, 0.1), "stout": (20, 200, 0.5)}  # edge, rods, diameter
FRACTIONS = (0.1, 0.2)
LENGTH, DIAMETER = 1.0005, 0.2  # of the rods of the equation of state: mean length at k = 2000
NEZBEDA = 0.03  # what this approximation is taken to be off by at these fractions
DRAWS = {"quick": 1000000, "campaign": 20000000}
RUNS = {"quick": {"thin": (40, 12), "slim": (40, 30), "stout": (40, 30)},  # runs, t0
        "campaign": {"thin": (400, 12), "slim": (400, 30), "stout": (400, 30)}}
STATE = {"quick": (4, 20, 2), "campaign": (5, 40, 10)}  # edge, blocks, t0
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
    return found


# --- what is known ----------------------------------------------------------------------------------------------------

def second_virial(length, diameter):
    return 2 / 3 * math.pi * diameter**3 + math.pi * length * diameter**2 + math.pi / 4 * length**2 * diameter


def nezbeda(phi):
    """Z of hard convex bodies of this shape: alpha = (mean radius) (surface)/(3 volume)."""
    radius, surface = LENGTH / 4 + DIAMETER / 2, math.pi * DIAMETER * (LENGTH + DIAMETER)
    alpha = radius * surface / (3 * math.pi * (DIAMETER**2 * LENGTH / 4 + DIAMETER**3 / 6))
    return (1 + (3 * alpha - 2) * phi + (alpha**2 + alpha - 1) * phi**2 - alpha * (5 * alpha - 4) * phi**3) / (1 - phi)**3


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
    verdict = Verdict(f"thick.z.{fraction:g}", f"Z over Nezbeda's at a volume fraction of {fraction:g}, L/D = 5", 1.0,
                      f"Nezbeda (1976), an approximation, taken to be known to {100 * NEZBEDA:.0f} %", NEZBEDA)
    if name in results:
        table, blocks = results[name].columns, int(results[name].run.program[3])
        known = nezbeda(float(table["phi"][0]))
        fill(verdict, (float(table["Z"][0]) / known, float(table["Z_error"][0]) / known), NEZBEDA, values=blocks // 2)
    return verdict


# --- figure -----------------------------------------------------------------------------------------------------------

def draw(results):
    figure, panel = figures.plain(width=5.5, height=4.0)
    grid = [0.25 * k / 100 for k in range(101)]
    figures.theory(panel, grid, [nezbeda(phi) for phi in grid], label="Nezbeda")
    v0 = math.pi * (DIAMETER**2 * LENGTH / 4 + DIAMETER**3 / 6)
    figures.theory(panel, grid, [1 + second_virial(LENGTH, DIAMETER) / v0 * phi for phi in grid], label="to second order")
    known = [results[f"state-{fraction:g}"].columns for fraction in FRACTIONS if f"state-{fraction:g}" in results]
    figures.points(panel, [float(t["phi"][0]) for t in known], [float(t["Z"][0]) for t in known],
                   [float(t["Z_error"][0]) for t in known], number=0, label="measured")
    panel.set(xlabel="volume fraction $\\phi$", ylabel="$Z = PV/NkT$")
    figures.legend(panel)
    return figure


def evaluate(results, tier):
    verdicts = overlap_verdicts(results)
    for name in FLIGHTS:
        verdicts += flight_verdicts(results, name)
    verdicts += [state_verdict(results, fraction) for fraction in FRACTIONS]
    drawn = [Figure("state", "Pressure of spherocylinders with L/D = 5 against volume fraction, with Nezbeda's equation and the "
                    "second virial coefficient alone.", lambda: draw(results))] if results else []
    return Outcome(verdicts, drawn, "" if results else "No run yet.")
