"""The Andersen collision rule MPC-AT-a: its viscosity from decaying shear waves, from fluctuations of the stress, and by theory."""
import collections
import math

import numpy

from lib import figures, flow, stats, theory
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "The Andersen collision rule: viscosity by two independent ways"
PAPER = "not in the paper; Noguchi, Kikuchi and Gompper (2007)"
USES = ("solvent",)  # the shear waves of SRD

Point = collections.namedtuple("Point", "gamma dt_c")
THIN, DENSE = Point(5, 0.1), Point(10, 0.02)
NAMES = {THIN: "dt0.1", DENSE: "dense"}
EDGES = (32, 16)  # boxes of the shear waves: 8 x EDGE x 8
STRESS_BOX = 8
# Collisions until particles have got to know each other (as in case `solvent`): shear waves leave so many out, and the integral
# of the stress's autocorrelation ends there.
MEMORY = {THIN: 15, DENSE: 25}
LAGS = {THIN: 40, DENSE: 60}  # more, to see that nothing comes after
PAIRS = {"quick": {THIN: 20, DENSE: 10}, "campaign": {THIN: 200, DENSE: 150}}
COLLISIONS = {"quick": {THIN: 120000, DENSE: 60000}, "campaign": {THIN: 2000000, DENSE: 3200000}}
SRD_COLLISIONS = {"quick": 80000, "campaign": 1000000}
CHAOS = 0.08  # theory is molecular chaos: off by some per cent, nobody can say in advance by how many


def runs(tier):
    found = []
    for point, name in NAMES.items():
        pairs, collisions = PAIRS[tier][point], COLLISIONS[tier][point]
        found.append(Run("shear-" + name, hours=pairs * 1.5e-4, program=[
            "shear_decay", *point, "at-a", 0.6, MEMORY[point], pairs, 11, *EDGES]))
        found.append(Run("stress-" + name, hours=collisions * point.gamma * 3e-9, program=[
            "green_kubo", STRESS_BOX, *point, "at-a", LAGS[point], collisions, 21]))
    found.append(Run("stress-srd", hours=SRD_COLLISIONS[tier] * 1e-8, program=[
        "green_kubo", STRESS_BOX, *THIN, 90, LAGS[THIN], SRD_COLLISIONS[tier], 22]))
    return found


# --- what runs say ----------------------------------------------------------------------------------------------------

def from_stress(table, point):
    """(eta, error): the integral of the stress's autocorrelation up to MEMORY."""
    row = MEMORY[point]
    return table["eta"][row], table["eta_error"][row]


class Measured:
    """Both ways at one point."""

    def __init__(self, name, words, point, parts, waves, stress):
        self.name, self.words, self.point, self.parts, self.stress_table = name, words, point, parts, stress.columns
        self.theory = sum(parts)
        self.waves = flow.from_waves(waves.columns, point.gamma, *parts)
        self.stress = from_stress(self.stress_table, point)

    @property
    def ratio(self):
        """(stress over waves, error)."""
        value = self.stress[0] / self.waves[0]
        return value, value * math.hypot(self.stress[1] / self.stress[0], self.waves[1] / self.waves[0])


SRD_WAVES = "solvent/shear-g5-dt0.1-a90"


def words(point):
    return f"γ {point.gamma}, dt_c {point.dt_c:g}"


def sources():
    """(name, words, point, theory's parts, run of the waves, run of the stress) of each comparison."""
    found = [(name, f"MPC-AT-a, {words(point)}", point, theory.andersen_viscosity(*point), "shear-" + name, "stress-" + name)
             for point, name in NAMES.items()]
    return found + [("srd", f"SRD, 90°, {words(THIN)}", THIN, theory.viscosity(*THIN, 90), SRD_WAVES, "stress-srd")]


def measured(results):
    """name -> Measured, of the comparisons whose runs are there."""
    return {name: Measured(name, text, point, parts, results[waves], results[stress])
            for name, text, point, parts, waves, stress in sources() if waves in results and stress in results}


# --- verdicts ---------------------------------------------------------------------------------------------------------

BLOCKS = 32  # that an error of measure/green_kubo.c comes from
AGREE = 0.015


def ways_verdict(known, name, text):
    """Two ways that share neither runs nor estimator. The gate is 1.5 % where errors allow it (four of them fit in)."""
    verdict = Verdict(f"andersen.ways.{name}", f"η from the stress over η from shear waves, {text}", 1.0,
                      "exact for long waves and long lags", AGREE)
    if name in known:
        verdict.measured, verdict.error = known[name].ratio
        verdict.tolerance = AGREE if verdict.error < 0.25 * AGREE else stats.tolerance(verdict.error, values=BLOCKS)
    return verdict


def theory_verdict(known, point):
    name, expected = NAMES[point], sum(theory.andersen_viscosity(*point))
    verdict = Verdict(f"andersen.theory.{name}", f"η from shear waves, MPC-AT-a, {words(point)}", expected,
                      "molecular chaos, known to 8 %", CHAOS * expected)
    if name in known:
        verdict.measured, verdict.error = known[name].waves
        verdict.tolerance = stats.tolerance(verdict.error, systematic=CHAOS * expected)
    return verdict


def equilibrium_verdicts(results, point):
    """What an equilibrium run holds besides: the rule's own temperature, and momentum."""
    name = NAMES[point]
    heat = Verdict(f"andersen.temperature.{name}", f"kT of a closed box, MPC-AT-a, {words(point)}", 1.0,
                   "exact: the rule draws velocities at kT = 1", 0.01)
    drift = Verdict(f"andersen.momentum.{name}", f"largest momentum per particle, MPC-AT-a, {words(point)}", 0.0,
                    "conserved, to the rounding of the cells' sums", 1e-10)
    if "stress-" + name in results:
        table = results["stress-" + name].columns
        heat.measured, heat.error, drift.measured = table["kT"][0], table["kT_error"][0], table["momentum"][0]
        heat.tolerance = stats.tolerance(heat.error, values=BLOCKS)
    return [heat, drift]


# --- figures ----------------------------------------------------------------------------------------------------------

def draw_integral(known):
    figure, axes = figures.plain(width=9.5, height=4.4, columns=len(known))
    for number, (panel, one) in enumerate(zip(numpy.atleast_1d(axes), known.values())):
        table, (value, error) = one.stress_table, one.waves
        panel.axhspan((value - error) / one.theory, (value + error) / one.theory, color="#999999", alpha=0.5, linewidth=0,
                      label="shear waves")
        figures.points(panel, table["time"], table["eta"] / one.theory, table["eta_error"] / one.theory, number=number,
                       markersize=2.5, label="$C_0/2 + C_1 + \\ldots + C_k$")
        panel.axvline(MEMORY[one.point] * one.point.dt_c, color="#444444", linewidth=0.8, linestyle=":", label="read here")
        panel.axhline(1.0, color=figures.INK, linewidth=1.1, label="molecular chaos")
        panel.set(title=one.words, xlabel="lag ($t_0$)", ylim=(0.95, 1.09))
        figures.legend(panel, loc="upper right")
    numpy.atleast_1d(axes)[0].set_ylabel("$\\eta$ over molecular chaos")
    return figure


def evaluate(results, tier):
    known = measured(results)
    verdicts = [ways_verdict(known, name, text) for name, text, *_ in sources()]
    verdicts += [theory_verdict(known, point) for point in NAMES]
    verdicts += [verdict for point in NAMES for verdict in equilibrium_verdicts(results, point)]
    drawn = [Figure("integral", "The integral of the stress's autocorrelation against its upper limit, over the viscosity of molecular "
                    "chaos. Gray: the viscosity from shear waves, ± one standard error. Dotted: the lag at which the integral is read. "
                    "Errors at different lags are correlated.", lambda: draw_integral(known))] if known else []
    return Outcome(verdicts, drawn, prose(known))


def prose(known):
    if not known:
        return "No pair of runs yet."
    return "\n\n".join(
        f"{one.words}: η is {one.waves[0]:.3f} ± {one.waves[1]:.3f} from shear waves and {one.stress[0]:.3f} ± {one.stress[1]:.3f} "
        f"from the stress, {100.0 * (one.waves[0] / one.theory - 1.0):+.1f} % and {100.0 * (one.stress[0] / one.theory - 1.0):+.1f} % of "
        f"molecular chaos ({one.theory:.3f})." for one in known.values())
