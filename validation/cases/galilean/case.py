"""Fig. 3: a suspension in a uniform flow."""
import math

import numpy

from lib import figures, stats
from lib import semidilute as sd
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "Galilean invariance, and the lag behind a flow"
PAPER = "Fig. 3"
USES = ("tube",)  # its late-events is the event-driven rule at rest
FLOWS = (0, 0.09, 0.18, 0.36, 0.54)
QUICK = {"flow00": {}, "flow54": {"flow": 0.54}}  # moves in the frame of the flow: run `lag`


def campaign():
    hours = {0: 0.28, 0.09: 0.29, 0.18: 0.31, 0.36: 0.36, 0.54: 0.42}
    common = {"count": 1000, "longest_lag": 100000, "series": 1000}
    found = [Run(f"flow{round(100 * v):02d}", scene=sd.scene(flow=v, **common), steps=100000, hours=hours[v],
                 seed=300 + k)
             for k, v in enumerate(FLOWS)]
    found.append(Run("comoving54", steps=100000, hours=0.28, seed=310,
                     scene=sd.scene(flow=0.54, refusal="bounce", frame="flow", **common)))
    for k, v in enumerate((0, 0.54)):  # no thermostat: what becomes of the energy
        found.append(Run(f"isolated{round(100 * v):02d}", steps=10000, hours=0.04, seed=320 + k,
                         scene=sd.scene(flow=v, solvent=sd.FREE_SOLVENT, **{**common, "series": 100})))
    # Each contact at its own time: nobody lags, and nothing heats, so there is no thermostat. At rest: tube/late-events.
    found.append(Run("events54", steps=100000, hours=0.2, seed=340, priority=1,
                     scene=sd.scene(flow=0.54, rule="event-driven", solvent=sd.FREE_SOLVENT, **common)))
    # How far the vertices fall behind, for each rule: as many per volume in 16^3 cells.
    found.append(Run("lag", hours=0.1,
                     program=["refused_moves", 16, 208, 38, 0.54, 144, 330, "kick-split", 0.02, 0.01, 0.005]))
    return found


def quick():
    # As many vertices per volume, in an eighth of the box.
    common = {"box": 16, "vertices": 38, "count": 208, "longest_lag": 2560, "every": 10, "series": 50,
              "persistence": 32}
    found = [Run(name, scene=sd.scene(**common, **values), steps=6000, hours=0.004, seed=340 + k)
             for k, (name, values) in enumerate(QUICK.items())]
    found.append(Run("isolated54", steps=3000, hours=0.001, seed=350,
                     scene=sd.scene(flow=0.54, solvent=sd.FREE_SOLVENT, **common)))
    found.append(Run("lag", hours=0.007, program=["refused_moves", 16, 208, 38, 0.54, 96, 351, "kick-split", 0.01,
                                                  "--",
                                                  "stay", "bounce-flow"]))
    return found


def runs(tier):
    return quick() if tier == "quick" else campaign()



# --- what runs say ----------------------------------------------------------------------------------------------------

# L and its paper's tau_r (a rigid rod's in the quick tier), c L^3 of 64 vertices; lags (t0) at which g is compared.
SYSTEMS = {"quick": {"length": 19.0, "tau": sd.rod_rotation_time(37 * sd.BOND, 0.6, 11.184), "lags": (1.6, 12.8),
                     "names": {"flow00": 0.0, "flow54": 0.54}},
           "campaign": {"length": 32.0, "tau": sd.PAPER_ROTATION_TIME, "lags": (16.0, 256.0, 768.0),
                        "names": {**{f"flow{round(100 * v):02d}": v for v in FLOWS}, "comoving54": 0.54}}}
# A refused vertex moves faster than the average before it is refused, the more the longer the step: 1.06 at dt 0.01.
LAG_BIAS = 0.1


def lag_rows(results):
    """Rows of the program: {rule, dt, lag, lag_error, rate, ...}."""
    if "lag" not in results or not results["lag"].text:
        return []
    table = results["lag"].columns
    return [{key: table[key][k] for key in table} for k in range(len(table["dt"]))]


def lag_row(results, rule, dt=0.01):
    return next((row for row in lag_rows(results) if row["rule"] == rule and abs(row["dt"] - dt) < 1e-9), None)


def refused_share(result):
    """Of all trial moves, those refused: the predicted lag of a run, in units of its flow."""
    try:
        table = result.table("collisions")
    except KeyError:
        return math.nan
    return table["executed"][-1] / table["moves"][-1] if table["moves"][-1] else math.nan


# --- verdicts ---------------------------------------------------------------------------------------------------------

def lag_verdicts(results):
    paper, comoving = lag_row(results, "stay"), lag_row(results, "bounce-flow")
    one = Verdict("galilean.lag.paper", "lag behind the flow over the share of refused moves, the paper's rule", 1.0,
                  "a refused vertex stands still for one step; 10 %: fast ones are refused more often", LAG_BIAS)
    two = Verdict("galilean.lag.comoving", "lag behind the flow over the flow, moves made in the frame of the flow",
                  0.0,
                  "exact", 0.0)
    if paper:
        share = paper["rate"] * paper["dt"]
        sd.measured(one, (paper["lag"] / share, math.hypot(paper["lag_error"],
                                                           paper["lag"] * paper["rate_error"] / paper["rate"])
                       / share), LAG_BIAS, sd.PARTS)
    if comoving:
        sd.measured(two, (comoving["lag"], comoving["lag_error"]), values=sd.PARTS)
    return [one, two]


def displacement_verdicts(results, system, apart=()):
    """g and g_cm of a moving system over those of the one at rest, less what the lag adds: (lag v t)^2. apart: (run, column, lag)
    of a number that another verdict is about."""
    rest = sd.table(results.get("flow00"))
    return [displacement_verdict(results.get(name), rest, name, flow, column, lag)
            for name, flow in system["names"].items() if flow > 0.0
            for column in ("g", "g_cm") for lag in system["lags"] if (name, column, lag) not in apart]


def fastest(system):
    """(run, column, lag) at which the lag shows most."""
    name = max((name for name in system["names"] if name.startswith("flow")), key=system["names"].get)
    return name, "g_cm", system["lags"][-1]


def paper_verdict(results, system):
    """What the figure says: curves at all speeds are one."""
    name, _, lag = fastest(system)
    flow = system["names"][name]
    verdict = Verdict("galilean.paper", f"g_cm at {flow} a0/t0 over at rest, {lag:g} t0, the lag left in", 1.0,
                      "paper, Fig. 3: the curves coincide", 0.0, kind="paper",
                      reason="Refused moves leave the fibers behind: (lag v t)² is added, which at short times nobody sees.")
    a, b = sd.at(sd.table(results.get(name)), "g_cm", lag), sd.at(sd.table(results.get("flow00")), "g_cm", lag)
    ratio = a[0] / b[0] if a and b else None
    return sd.measured(verdict, ratio and (ratio, ratio * math.hypot(a[1] / a[0], b[1] / b[0])))


def displacement_verdict(result, rest, name, flow, column, lag):
    verdict = Verdict(f"galilean.{column}.{name}.{lag:g}", f"{column} at {flow} a0/t0 over at rest, {lag:g} t0", 1.0,
                      "Galilean invariance, and the lag", 0.0)
    a, b = sd.at(sd.table(result), column, lag), sd.at(rest, column, lag)
    if a is None or b is None:
        return verdict
    share = refused_share(result) if name.startswith("flow") else 0.0
    verdict.expected = 1.0 + (share * flow * lag)**2 / b[0]
    ratio = a[0] / b[0]
    return sd.measured(verdict, (ratio, ratio * math.hypot(a[1] / a[0], b[1] / b[0])), 0.01)


def event_verdicts(results, lags):
    """The event-driven rule: in a flow as at rest, without a lag; and at rest as by the paper's rule."""
    rest, moving, paper = (sd.table(results.get(name)) for name in ("tube/late-events", "events54", "flow00"))
    found = []
    for column in ("g", "g_cm"):
        for lag in lags:
            for name, words, one, other in (("flow", "0.54 a0/t0 over at rest", moving, rest),
                                            ("rule", "at rest over that by the paper's rule", rest, paper)):
                a, b = sd.at(one, column, lag), sd.at(other, column, lag)
                ratio = a[0] / b[0] if a and b else None
                found.append(sd.measured(
                    Verdict(f"galilean.events.{name}.{column}.{lag:g}", f"{column} by the event-driven rule {words}, {lag:g} t0", 1.0,
                            "Galilean invariance without a lag" if name == "flow" else "the same suspension", 0.0),
                    ratio and (ratio, ratio * math.hypot(a[1] / a[0], b[1] / b[0])), 0.01))
    return found


def momentum_verdict(results):
    return Verdict("galilean.momentum", "largest change of total momentum over 2/3 of the kinetic energy, t0/a0", 0.0,
                   "conserved by every collision; 10⁻⁹ for rounding", 1e-9,
                   measured=sd.momentum_change(one for name, one in results.items() if "/" not in name))


def energy_verdicts(results):
    """Without a thermostat. The paper saw none of this."""
    found = []
    for name in ("isolated00", "isolated54"):
        if name not in results:
            continue
        table, counts = results[name].table("conserved"), results[name].table("collisions")
        if len(table["time"]) < 8:
            continue
        rate, error = sd.first_rate(table["time"], table["total"])
        verdict = Verdict(f"galilean.energy.{name}", "energy gained per t0 over the energy, at the start, no thermostat, "
                                                     "the paper's rule",
                          0.0, "paper, Sec. V B 1: “exactly constant”", 0.0, kind="paper",
                          reason="The exchange of momentum acts between a drift and its kick, which no longer fit "
                                 "each other: "
                          "every refused move heats, by about 0.05 to 0.07 kT at dt 0.01 (claim conservation).")
        start = float(table["total"][0])
        found.append(sd.measured(verdict, (rate / start, error / start), values=len(table["time"]) - 2))
        row = lag_row(results, "stay")
        if name == "isolated54" and row:
            gained, executed = (float(column[-1] - column[0]) for column in (table["total"], counts["executed"]))
            # It heats up meanwhile, and heat per collision is in units of the kT of now.
            heat = Verdict("galilean.heat", "kT gained per refused move in a flow of 0.54, dt 0.01", row["heat"],
                           "the same by another program, energies written apart from the observables; 15 % for "
                           "another size "
                           "and for heating meanwhile", 0.0, expected_error=row["heat_error"])
            found.append(sd.measured(heat, (gained / executed, 0.5 * error * table["time"][-1] / executed),
                                     0.15 * row["heat"], sd.PARTS))
    return found


# --- figures ----------------------------------------------------------------------------------------------------------

def draw_displacements(results, system):
    figure, above, below = figures.with_residuals(height=5.6)
    scale, tau = system["length"]**2, system["tau"]
    rest = sd.table(results.get("flow00"))
    for number, (name, flow) in enumerate(system["names"].items()):
        columns = sd.table(results.get(name))
        if columns is None:
            continue
        label = f"v = {flow:g} $a_0/t_0$" + (", in its frame, bouncing" if name.startswith("co") else "")
        for column, fill in (("g", figures.COLORS[number]), ("g_cm", "none")):
            figures.points(above, columns["time"] / tau, columns[column] / scale, columns[column + "_error"] / scale,
                           number, label=label if column == "g" else None, markersize=7 - number, markerfacecolor=fill)
        if rest is None or name == "flow00":
            continue
        for column, fill, line in (("g", figures.COLORS[number], "--"), ("g_cm", "none", ":")):
            lags = [t for t in columns["time"] if sd.at(rest, column, t)]
            pairs = [(sd.at(columns, column, t), sd.at(rest, column, t)) for t in lags]
            figures.points(below, numpy.array(lags) / tau, [100 * (a[0] / b[0] - 1) for a, b in pairs],
                           [100 * a[0] / b[0] * math.hypot(a[1] / a[0], b[1] / b[0]) for a, b in pairs], number,
                           markersize=3, markerfacecolor=fill)
            if flow == 0.54 and name.startswith("flow"):
                share = refused_share(results[name])
                figures.theory(below, numpy.array(lags) / tau,
                               [100 * (share * flow * t)**2 / b[0] for t, (_, b) in zip(lags, pairs)], linestyle=line,
                               label=f"the lag's share of ${'g_{cm}' if column == 'g_cm' else 'g'}$, v = 0.54")
    above.set(xscale="log", yscale="log", ylabel="$g/L^2$ (filled), $g_{cm}/L^2$ (open)")
    below.set(xscale="log", xlabel="$t/\\tau_r$", ylabel="over rest (%)", ylim=(-15, 60))
    figures.legend_above(above, below)
    return figure


def draw_energy(results):
    figure, axes = figures.plain(height=3.4, columns=2)
    for number, name in enumerate(("isolated00", "isolated54", "flow54")):
        if name not in results:
            continue
        try:
            table = results[name].table("conserved")
        except KeyError:
            continue
        label = {"isolated00": "at rest, isolated", "isolated54": "v = 0.54, isolated",
                 "flow54": "v = 0.54, thermostat"}[name]
        figures.line(axes[0], table["time"], 100 * (table["total"] / table["total"][0] - 1), number, label=label)
        mass = 2.0 * float(table["vertex_kinetic"][0] + table["solvent_kinetic"][0]) / 3.0
        figures.line(axes[1], table["time"], numpy.abs(table["px"] - table["px"][0]) / mass + 1e-17, number, label=label)
    axes[0].set(xlabel="$t$ ($t_0$)", ylabel="change of total energy (%)")
    axes[1].set(xlabel="$t$ ($t_0$)", ylabel="$|\\Delta p|$ over mass ($a_0/t_0$)", yscale="log")
    for panel in axes:
        figures.legend_above(panel, columns=1)
    return figure


RULES = {"stay": "stay (the paper's rule)", "bounce": "bounce", "stay-flow": "stay, in the frame of the flow",
         "bounce-flow": "bounce, in that frame"}  # of the lag's figure


def draw_lag(results):
    figure, above, below = figures.with_residuals(height=4.2)
    rows = lag_rows(results)
    for number, rule in enumerate(dict.fromkeys(row["rule"] for row in rows)):
        mine = [row for row in rows if row["rule"] == rule]
        dt = [row["dt"] * 1.02**number for row in mine]
        figures.points(above, dt, [1e3 * row["lag"] for row in mine], [1e3 * row["lag_error"] for row in mine],
                       number, label=RULES.get(rule, rule))
        if rule == "stay":
            above.plot([row["dt"] for row in mine], [1e3 * row["rate"] * row["dt"] for row in mine], color="#222222",
                       linestyle="--", marker="_", label="share of rejected moves")
            figures.points(below, dt, [row["lag"] / row["rate"] / row["dt"] - 1 for row in mine],
                           [row["lag_error"] / row["rate"] / row["dt"] for row in mine], number)
    above.set(ylabel="lag over flow ($10^{-3}$)")
    below.set(xlabel="$dt$ ($t_0$)", ylabel="over\nshare − 1", ylim=(-0.15, 0.3), xlim=(0.0, 0.024))
    figures.legend(above)
    return figure


def evaluate(results, tier):
    system = SYSTEMS[tier]
    apart = (fastest(system),) if tier == "campaign" else ()
    verdicts = lag_verdicts(results) + displacement_verdicts(results, system, apart) + [momentum_verdict(results)]
    if tier == "campaign":
        verdicts.append(paper_verdict(results, system))
        verdicts += event_verdicts(results, system["lags"])
    found = [Figure("fig3", "Mean square displacements of vertices (filled) and of centres of mass (open), background "
                            "flow subtracted. Time is in units of τ_r, " + f"{system['tau']:.0f} t0. "
                    "Below: divided by the curves of the resting system. Lines: contribution of the lag of the fastest system to g (dashed) and to g_cm (dotted).",
                    lambda: draw_displacements(results, system)),
             Figure("lag", "Lag of the vertices behind a flow of 0.54 a0/t0 against the time step, for each rule for rejected moves. Line: the share of moves that the rule of the paper rejects. Below: the lag over this share.",
                    lambda: draw_lag(results)),
             Figure("energy", "Energy and momentum of the densest suspension at dt 0.01, by the paper's rule. Isolated: no thermostat. Right: change "
                    "of the momentum of the whole system, per unit of mass.", lambda: draw_energy(results))]
    if not any(name in results for name in system["names"]):
        found = found[1:]  # nothing to draw yet
    return Outcome(verdicts + energy_verdicts(results), found, PROSE)


PROSE = """A uniform flow has one effect on g and g_cm. A vertex whose move is rejected stands still for a step while the fluid flows on.
So the fibers lag behind the flow by the share of rejected moves: 1.05·10⁻³ of the flow with the paper's rule at the paper's highest
density. That is 0.57 a0 after 1000 t0 at the fastest flow. It adds (lag v t)² to every mean square displacement. This is invisible up to
some 100 t0, but it is a third of the small g_cm by 768 t0. With moves made in the frame of the flow the lag is gone.

Momentum is constant to rounding. The energy is **not** constant, unless a thermostat holds it: see `conservation`. The runs of
the figure have a thermostat. Without it they would end some 70 % (at rest) or 100 % (at 0.54) hotter than they began, and their g
would differ for that reason."""
