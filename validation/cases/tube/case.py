"""Fig. 4: what hydrodynamics and uncrossability do to d^2(t) in the densest suspension."""
import math

import numpy

from lib import dilute, figures, shape, stats
from lib import semidilute as sd
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "The tube: hydrodynamics and uncrossability"
PAPER = "Fig. 4"
USES = ("galilean",)  # its comoving54 bounces; and other starts

# name -> (solvent, crossings forbidden)
CASES = {"hi-entangled": (sd.SOLVENT, "true"), "hi-free": (sd.SOLVENT, "false"),
         "off-entangled": (sd.BATH, "true"), "off-free": (sd.BATH, "false")}
# The same with other choices: none of them may move d^2, neither before fibers meet nor in the tube.
CHOICES = {"none": {"solvent": sd.FREE_SOLVENT},
           "maxwell-boltzmann": {"solvent": "thermostat: maxwell-boltzmann"},
           "bounce": {"refusal": "bounce"},
           "dt5": {"dt": 0.005},
           "events": {"rule": "event-driven", "solvent": sd.FREE_SOLVENT}}
# What tau_r is measured in: run -> fibers in it.
AXIS = {"hi": {f"axis-hi-{n}": 4 for n in range(1, 9)}, "off": {"axis-off": 40}}
CROWD = {"axis-many-1": 24}  # and what more fibers in a box do to it
LATE = ("maxwell-boltzmann", "dt5", "events")  # not `none`: by the paper's rule it would be half as hot again by then
# The same suspension from other starts, up to 1000 t0. In faster flows the lag, squared, is more than 2 % of d^2 at 512 t0.
STARTS = ("hi-entangled", *(f"late-{name}" for name in LATE), "galilean/flow00", "galilean/flow09", "galilean/flow18", "galilean/comoving54")
START_LAGS = (128.0, 512.0)  # t0: at the bend, and in the tube
MOBILE = 40  # of the 1000 fibers, where the others are frozen
BONDS = ("loose", "free", "forbidden")  # vertices without bonds; with bonds that may cross; with bonds that may not
WAVE = tuple(0.64 * look for look in range(1, 21))  # t0
# Of the quick tier: the same fibers at the same density, an eighth of the volume, one look. The box is half as long as they are.
SHORT_WAVE = {"edge": 16, "vertices": 64, "count": 125, "time": 2.4, "pairs": 16}


def campaign():
    # c L^3 = 1000. 8,300,000 steps are one tau_r by the paper, with hydrodynamics; 0.3 of it are 2,500,000.
    long = {"hi-entangled": (8300000, 11.0, ((300000, 0), (2500000, 1))),
            "hi-free": (8300000, 6.4, ((300000, 0), (2500000, 1))),
            "off-entangled": (4800000, 10.7, ((300000, 0), (1200000, 1))),
            "off-free": (4800000, 4.3, ((300000, 0), (1200000, 1)))}
    found = []
    for number, (name, (solvent, forbidden)) in enumerate(CASES.items()):
        steps, hours, goals = long[name]
        found.append(Run(name, scene=sd.scene(count=1000, solvent=solvent, forbidden=forbidden), steps=steps,
                         hours=hours,
                         seed=400 + number, priority=2, goals=goals))
        found.append(Run(name + "-short", steps=4000, hours=0.012, seed=410 + number,
                         scene=sd.scene(count=1000, solvent=solvent, forbidden=forbidden, every=1, longest_lag=1024,
                                  series=100)))
    for number, (name, values) in enumerate(CHOICES.items()):
        scale = int(round(0.01 / values.get("dt", 0.01)))
        found.append(Run("choice-" + name, steps=4000 * scale, hours=0.012 * scale, seed=420 + number,
                         scene=sd.scene(count=1000, every=scale, longest_lag=1024 * scale, series=100, **values)))
    for number, name in enumerate(LATE):
        scale = int(round(0.01 / CHOICES[name].get("dt", 0.01)))
        found.append(Run("late-" + name, steps=100000 * scale, hours=0.15 * scale, seed=440 + number, priority=1,
                         scene=sd.scene(count=1000, every=50 * scale, longest_lag=100000 * scale, series=1000 * scale,
                                        **CHOICES[name])))
    # 40 of the 1000 fibers move, and the tube that the others make is held. The others take the same part in the bath as if they moved.
    for name, solvent, hours in (("held-off", sd.BATH, 0.7), ("held-hi", sd.SOLVENT, 1.0)):
        found.append(Run(name, steps=400000, hours=hours, seed=460 + (name == "held-hi"), priority=1,
                         scene=sd.scene(count=MOBILE, solvent=solvent, others=sd.frozen_network(1000 - MOBILE), longest_lag=204800)))
    # Where everybody moves: how much of it is a motion of a fiber together with its neighbors, those nearer than two mesh sizes?
    found.append(Run("cage-off", steps=200000, hours=0.4, seed=470, priority=1, after=("cage", round(2.0 * sd.mesh_size(1000, 32.0, 32.0), 2)),
                     scene=sd.scene(count=1000, solvent=sd.BATH, longest_lag=102400) + "trajectory: {every: 1000}\n"))
    # Four fibers in one box: each is dilute, and four times the turning is seen for the same solvent. 24 are no longer dilute: the
    # stress of those that are bonded makes the fluid a quarter more viscous for one that turns (`crowded`). 40 without hydrodynamics,
    # where nobody feels anybody. Who crosses freely does not heat.
    found.append(Run("axis-off", steps=2000000, hours=0.12, seed=3200, priority=1,
                     scene=sd.scene(count=40, solvent=sd.BATH, forbidden="false", every=1000, longest_lag=256000)))
    # The first three have a thermostat, which these fibers do not need.
    found += [Run(name, steps=1000000, hours=0.28 if number < 3 else 0.21, seed=3101 + number, priority=1,
                  scene=sd.scene(count=fibers, solvent=sd.SOLVENT if number < 3 else sd.FREE_SOLVENT, forbidden="false", every=1000,
                                 longest_lag=256000))
              for number, (name, fibers) in enumerate(AXIS["hi"].items())]
    found += [Run(name, steps=1000000, hours=0.35, seed=3102, priority=1,
                  scene=sd.scene(count=fibers, solvent=sd.FREE_SOLVENT, forbidden="false", every=1000, longest_lag=256000))
              for name, fibers in CROWD.items()]
    # How much does the fluid that the fibers make resist shear, when they are bonded? A wave of the box's length.
    found += [Run(f"wave-{bonds}", hours=0.05, priority=0,
                  program=["suspension_wave", bonds, 0.2, WAVE[-1], len(WAVE), 8, 480 + number, 32])
              for number, bonds in enumerate(BONDS)]
    return found


def quick():
    # c L^3 = 400 of fibers of 24 vertices, L = 12: a mesh of 1.04 a0, a tube that shows within 100 t0.
    small = {"box": 10, "vertices": 24, "count": 231, "every": 10, "longest_lag": 12288, "series": 1000}
    found = [Run(name, scene=sd.scene(solvent=solvent, forbidden=forbidden, **small), steps=24576, seed=440 + number,
                 hours=0.007 if forbidden == "true" else 0.002)
             for number, (name, (solvent, forbidden)) in enumerate(CASES.items()) if name != "off-entangled"]
    found += [Run("choice-" + name, scene=sd.scene(**{**small, **CHOICES[name]}), steps=6000, seed=451 + number,
                  hours=0.002)
              for number, name in enumerate(SYSTEMS["quick"]["choices"])]
    found += [Run(f"wave-{bonds}", hours=0.001,
                  program=["suspension_wave", bonds, 0.2, SHORT_WAVE["time"], 1, SHORT_WAVE["pairs"], 480 + number, SHORT_WAVE["edge"]])
              for number, bonds in enumerate(BONDS[:2])]
    return found


def runs(tier):
    return quick() if tier == "quick" else campaign()



# --- what runs say ----------------------------------------------------------------------------------------------------

# Of each tier: fiber (L = l_p by the paper's count; its mean contour), cells along an edge, number; lags (t0) at which
# curves are compared: before fibers meet, while hydrodynamics still counts most, and for other choices of the method.
SYSTEMS = {"quick": {"length": 12.0, "contour": 23 * sd.BOND, "box": 10, "count": 231, "early": 0.1, "fast": 3.2,
                     "choice": 3.2, "choices": ("bounce",), "late": 50.0},
           "campaign": {"length": 32.0, "contour": 63 * sd.BOND, "box": 32, "count": 1000, "early": 0.04, "fast": 2.56,
                        "choice": 5.12, "choices": tuple(CHOICES), "late": 512.0}}
LABELS = {"hi-entangled": "hydrodynamics on, uncrossable", "hi-free": "on, crossing free",
          "off-entangled": "off, uncrossable", "off-free": "off, crossing free"}
# Lags (t0). Those tau_r may begin with, and the last one (sd.rotation_time).
HELD_LAG = 512.0  # t0: long after the bend, and seen several times
ROTATION = ((10.0, 20.0, 40.0, 80.0, 160.0), 2000.0)


def curve(results, name):
    """Short lags from the short run, the rest from the long one."""
    return sd.joined(sd.table(results.get(name + "-short"), least=4), sd.table(results.get(name)))


def size(system):
    """(vertices of a fiber, fibers, edge of the box)"""
    return round(system["contour"] / sd.BOND) + 1, system["count"], system["box"]


def width(system):
    """L_perp of Eq. (35)."""
    mesh = sd.mesh_size(system["count"], system["length"], system["box"])
    return sd.tube_width(mesh, system["length"], system["length"])


def expected_rotation(which, system):
    """tau_r of a lone fiber, 1/(2 D_r): with hydrodynamics a rigid rod of b = 0.6 a0 in this box; without, vertices whose friction acts
    at the radius of gyration, less than that of vertices alone (sd.shared_diffusion, among as many as the run has)."""
    vertices, _, box = size(system)
    if which == "hi":
        return sd.rod_rotation_time(system["contour"], 0.6, dilute.ETA, box**3)
    gyration = 82.036 if vertices == 64 else system["contour"]**2 / 12.0  # exact: sum of <R^2> of all pairs of 64 vertices
    return vertices * gyration / (2.0 * sd.shared_diffusion(AXIS["off"]["axis-off"], box, vertices))


def crowded(system, fibers):
    """(how much more viscous than the solvent the fluid is for one of so many fibers that turns, what of it is known by half only). Their
    mass adds to what collisions hand on. And rods that cannot be stretched resist a flow: a slender one adds pi c L^3/[90 (ln L/b -
    0.66)] to the viscosity (Kirkwood and Auer), for waves that are longer than it is."""
    vertices, count, box = size(system)
    length = system["contour"]
    rods = math.pi * (fibers - 1) * (length / box)**3 / (90.0 * (math.log(length / 0.6) - 0.66))
    return dilute.heavy_fluid(sd.crowd(vertices, fibers, box))[0] / dilute.ETA + rods, 0.5 * rods


def turned(results, runs):
    """(tau_r, error, intercept) as measured in these runs (name -> fibers), or None."""
    return sd.rotation_time([sd.table(results.get(name), least=2) for name in runs], *ROTATION, runs.values())


def rotation(results, which, system):
    """(tau_r of a lone fiber, error, intercept), or None: less what the other fibers of its box do, half of which is an error."""
    found = turned(results, AXIS[which])
    if found is None or which == "off":
        return found
    share, known = crowded(system, next(iter(AXIS["hi"].values())))
    return found[0] / share, math.hypot(found[1] / share, known / share**2 * found[0]), found[2]


def crowd_verdict(results, system):
    few, many = turned(results, AXIS["hi"]), turned(results, CROWD)
    (one, known), (more, unknown) = (crowded(system, next(iter(runs.values()))) for runs in (AXIS["hi"], CROWD))
    verdict = Verdict("tube.rotation.crowd", "τ_r of 24 fibers in a box over that of four", more / one,
                      "the mass of the others' vertices, and the stress of rods, known by half; without their stress "
                      f"{(more - 2.0 * unknown) / (one - 2.0 * known):.2f}", (unknown - known) / one,
                      rival=(more - 2.0 * unknown) / (one - 2.0 * known))
    return sd.measured(verdict, dilute.over(many, few) if few and many else None, (unknown - known) / one)


def ratio(one, other, name, time):
    """(ratio, error) of two curves at a lag, or None."""
    a, b = sd.at(one, name, time), sd.at(other, name, time)
    if a is None or b is None:
        return None
    return a[0] / b[0], a[0] / b[0] * math.hypot(a[1] / a[0], b[1] / b[0])


# --- verdicts ---------------------------------------------------------------------------------------------------------

def early_verdicts(curves, system, asked):
    """Fibers that have not met yet do not know whether they may cross. By collision theory so many per cent of the
    vertices have been refused a move by then; nobody's displacement changes by more."""
    bonds = (size(system)[0] - 1) * system["count"]
    met = 4.0 * sd.collision_rate(bonds, system["box"]**3) * system["box"]**3 / bonds * system["early"]
    return [sd.measured(Verdict(f"tube.early.{which}", f"d² uncrossable / crossing free at {system['early']} t0, "
                             + ("hydrodynamics on" if which == "hi" else "off"), 1.0,
                             "the same dynamics until fibers meet (paper, Fig. 4)", met),
                     ratio(curves[f"{which}-entangled"], curves[f"{which}-free"], "d2", system["early"]), met)
            for which in ("hi", "off") if f"{which}-entangled" in asked]


def friction_verdicts(curves, system):
    """Fibers that cross freely have nothing that is left to fit, with hydrodynamics or without, as long as the others'
    stiffness does not resist the flow (lib/bending.py)."""
    fast = system["fast"]
    expected = {which: sd.free_fiber([fast], *size(system), which == "hi")[0] for which in ("hi", "off")}
    words = {"hi": ("on", "Oseen's field in a fluid that vertices make heavier and more viscous"),
             "off": ("off", "vertices that share cells; others as heavier solvent, which forgets them though they stay")}
    found = [sd.measured(Verdict(f"tube.friction.{which}", f"d² over that of a straight fiber, nothing fitted, "
                                 f"hydrodynamics {on}, crossing free, {fast} t0", 1.0, f"lib/bending.py: {why}: 8 %", 0.08),
                         sd.over(sd.at(curves[f"{which}-free"], "d2_contour", fast), expected[which]), 0.08)
             for which, (on, why) in words.items()]
    share = expected["off"] / expected["hi"]
    below = sd.measured(Verdict("tube.hydrodynamics", f"d² without hydrodynamics / with, crossing free, {fast} t0", share,
                                "paper, Fig. 4: below 1; how far, by lib/bending.py to 8 % each", 0.12 * share),
                        ratio(curves["off-free"], curves["hi-free"], "d2_contour", fast), 0.12 * share)
    return [*found, below]


def plateau_verdicts(curves, system):
    """Is there a plateau, and how high is the curve where free motion becomes hindered, at the paper's line?"""
    found = []
    for which, on in (("hi", "on"), ("off", "off")):
        columns = curves[f"{which}-entangled"]
        flat = Verdict(f"tube.flat.{which}", f"exponent of d²(t) (contour) over the last factor of 8 in t, hydrodynamics {on}",
                       0.0, "a plateau: below 0.1; 3/8 is half of what it was before the bend", 0.1, kind="paper", rival=0.25,
                       reason="The curve bends and goes on rising: the tube is not fixed, it shifts as its neighbors move.")
        height = Verdict(f"tube.height.{which}", f"d² (contour) at the transition from free to hindered (local exponent 3/8) over "
                         f"2 L⊥², hydrodynamics {on}", 1.0,
                         "paper, Fig. 4: the transition agrees with the line of Eq. (35), L = l_p = 32, a theory of scaling to some 40 %",
                         0.4, kind="paper", reason="Eq. (35) is a theory of scaling.")
        sd.measured(flat, sd.last_exponent(columns), 0.1)
        found += [flat, sd.measured(height, sd.over(sd.bend(columns), 2.0 * width(system)**2), 0.4)]
    return found


def held_verdicts(held, system):
    """Does d^2 of fibers in a tube that is held end, and where? Both positions that it compares fluctuate, by L_perp^2 per component."""
    found = []
    for which, on in (("hi", "on"), ("off", "off")):
        flat = Verdict(f"tube.held.flat.{which}", f"exponent of d²(t) (middle third) over the last factor of 8 in t, tube held, hydrodynamics {on}",
                       0.0, "a plateau: below 0.1; 3/8 is half of what it was before the bend", 0.1, kind="paper", rival=0.375)
        height = Verdict(f"tube.held.height.{which}", f"d² (middle third) in a tube that is held, {HELD_LAG:g} t0, over 4 L⊥², hydrodynamics {on}",
                         1.0, "Eq. (35), L = l_p = 32, a theory of scaling to some 40 %; both positions fluctuate", 0.4, kind="paper",
                         reason="Eq. (35) is a theory of scaling.")
        sd.measured(flat, sd.last_exponent(held[which], "d2_third"), 0.1)
        found += [flat, sd.measured(height, sd.over(sd.at(held[which], "d2_third", HELD_LAG), 4.0 * width(system)**2), 0.4)]
    return found


def half_free(curves, which, system):
    """d^2 over 2 L_perp^2 where uncrossable is half of crossing free, between two lags; None where it is not."""
    one, other = curves[f"{which}-entangled"], curves[f"{which}-free"]
    lags = [t for t in one["time"] if sd.at(other, "d2_contour", t)] if one is not None and other is not None else []
    shares = [ratio(one, other, "d2_contour", t)[0] for t in lags]
    for k in range(1, len(lags)):
        if shares[k] < 0.5 <= shares[k - 1]:
            heights = [sd.at(one, "d2_contour", t)[0] for t in lags[k - 1:k + 1]]
            return float(numpy.interp(-0.5, [-shares[k - 1], -shares[k]], heights)) / (2.0 * width(system)**2)
    return None


# d^2 (contour) uncrossable over crossing free at 102.4 t0 of the quick tier's fibers, uncrossable by the other rule: four runs of the
# event-driven rule, three free ones, `validation/run list`'s scenes with other seeds (--set crossing.rule=event-driven).
HINDERED = (0.534, 0.018)


def hindered_verdict(curves):
    """Of the quick tier: the paper's rule against the event-driven one, which shares no search and no exchange with it."""
    expected, error = HINDERED
    verdict = Verdict("tube.hindered", "d² uncrossable / crossing free at 102.4 t0, hydrodynamics on", expected,
                      "the event-driven rule, other seeds; without a tube 1", 0.0, expected_error=error, must_see=0.5)
    return sd.measured(verdict, ratio(curves["hi-entangled"], curves["hi-free"], "d2_contour", 102.4))


def normalized_verdict(curves, times, measured):
    """At equal t/tau_r, each its own, as the paper's figure has it."""
    at = 3e-4
    verdict = Verdict("tube.below", f"d² without hydrodynamics / with, crossing free, at t/τ_r = {at:g} each", 0.0,
                      "paper, Fig. 4: “systematically below”, that is, below 1", 1.0, kind="paper", detects=0.1,
                      reason="Without hydrodynamics friction is the same at all lengths. With them it is lower for long "
                             "waves than for short ones, and lowest for the turning of the whole: in units of τ_r short "
                             "waves are slower. At equal time (tube.hydrodynamics) the curve without is below.")
    values, errors = [], []
    for which in ("off", "hi"):
        columns = curves[which + "-free"]
        t = at * times[which]
        if columns is None or not columns["time"][0] <= t <= columns["time"][-1]:
            return verdict
        values.append(math.exp(numpy.interp(math.log(t), numpy.log(columns["time"]), numpy.log(columns["d2"]))))
        if measured[which]:  # d^2 grows as t^(1/2) or so there, and t is as good as tau_r
            errors.append(0.5 * measured[which][1] / measured[which][0])
    share, error = values[0] / values[1], values[0] / values[1] * math.hypot(*errors)
    if abs(share - 1.0) > stats.SIGMAS * error:  # else it is too rough to say
        verdict.measured, verdict.error = share, error
    if verdict.measured is None:
        verdict.statement += f" (so far {share:.2f} ± {error:.2f})"
    return verdict


def choice_verdicts(results, curves, system):
    words = {"none": "no thermostat", "maxwell-boltzmann": "canonical thermostat", "bounce": "refused vertices bounce", "events": "each contact at its own time, no thermostat",
             "dt5": "half the time step"}
    return [sd.measured(Verdict(f"tube.choice.{name}", f"d² of `{name}` ({words[name]}) over that of the run, "
                             f"{system['choice']} t0, before fibers meet", 1.0, "choices of method do not move the result", 0.0),
                     ratio(sd.table(results.get("choice-" + name), least=2), curves["hi-entangled"], "d2_contour",
                           system["choice"]), 0.01)
            for name in system["choices"]]


def late_verdicts(results, curves, system):
    """The same when fibers have long met."""
    others = {**{name: ("late-" + name, f"`{name}`") for name in LATE},
              "bounce": ("galilean/comoving54", "`bounce`, in the frame of a flow of 0.54")}
    return [sd.measured(Verdict(f"tube.late.{name}", f"d² of {words} over that of the run, {system['late']:g} t0", 1.0,
                                "choices of method do not move the result", 0.0),
                        ratio(sd.table(results.get(run)), curves["hi-entangled"], "d2_contour", system["late"]), 0.01)
            for name, (run, words) in others.items()]


def start_verdicts(results):
    """Do runs from other starts differ by more than their own errors say?"""
    found = []
    for lag in START_LAGS:
        pairs = [pair for pair in (sd.at(sd.table(results.get(name)), "d2_contour", lag) for name in STARTS) if pair]
        p, words = None, ""
        if len(pairs) > 1:
            mean, error, p = dilute.fair_mean(*zip(*pairs))
            words = f" ({len(pairs)} starts: {mean:.3f} ± {error:.3f} a0²)"
        found.append(dilute.scatter(f"tube.starts.{lag:g}", f"scatter of d² (contour) over independent starts, {lag:g} t0, in standard errors{words}", p))
    return found


def wave(results, bonds):
    return results[f"wave-{bonds}"].columns if f"wave-{bonds}" in results else None


def wave_verdicts(results, vertices, count, box, times, values=None):
    """Are bonded vertices the fluid that loose ones are? Bonds resist the flow, soon more than viscosity does. values: pairs of
    runs, where they are few."""
    found = []
    for time in times:
        bonded, loose = (sd.wave_left([time], count, vertices, box, one)[0] for one in (True, False))
        share = bonded / loose
        allowed = 0.3 * (1.0 - share)
        verdict = Verdict(f"tube.wave.{time:g}", f"share of a shear wave that is left after {time:g} t0, bonds that may cross over "
                          "loose vertices", share, "springs along straight fibers; their effect is known to 30 %, for bends", allowed,
                          rival=1.0)
        rows = [wave(results, bonds) for bonds in ("free", "loose")]
        if None not in rows:
            verdict = sd.measured(verdict, share_of(*rows, time), allowed, values)
        found.append(verdict)
    return found


def share_of(one, other, time):
    """(ratio, error) of two waves at a time."""
    values = [(columns["share"][look], columns["share_error"][look]) for columns in (one, other)
              for look in [int(numpy.argmin(abs(columns["time"] - time)))]]
    ratio = values[0][0] / values[1][0]
    return ratio, abs(ratio) * math.hypot(*(error / value for value, error in values))


def rotation_verdicts(results, system):
    vertices, _, box = size(system)
    early, late, _ = shape.turning_times(vertices, float(vertices), box)
    straight = shape.turning_times(vertices, 1e5, box)[1]
    allowed = 0.15 * sd.PAPER_ROTATION_TIME
    found = [sd.measured(Verdict("tube.rotation.paper", "τ_r with hydrodynamics, t0", sd.PAPER_ROTATION_TIME, "Sec. IV D, without an error bar: 15 %",
                                 allowed, kind="paper", reason="Bent fibers in Oseen's field smeared over the cells, in this box, nothing fitted, have "
                                 f"{early:.0f} t0 while bends have not relaxed and {late:.0f} with frozen shapes; straight ones {straight:.0f}."),
                         rotation(results, "hi", system), allowed)]
    expected = expected_rotation("off", system)
    found.append(sd.measured(Verdict("tube.rotation.off", "τ_r, hydrodynamics off, t0", expected,
                                     "friction of the vertices at the radius of gyration: 20 % for bends", 0.2 * expected),
                             rotation(results, "off", system), 0.2 * expected))
    return found


# --- figures ----------------------------------------------------------------------------------------------------------

def draw(curves, held, cage, system, times, errors, column):
    """times: tau_r of either kind; errors: theirs, relative."""
    figure, above, below = figures.with_residuals(height=5.6)
    scale = system["length"]**2
    for number, (name, columns) in enumerate(curves.items()):
        if columns is None:
            continue
        tau = times[name.split("-")[0]]
        uncrossable = "entangled" in name  # small filled markers, in the larger open ones of those that may cross
        figures.points(above, columns["time"] / tau, columns[column] / scale, columns[column + "_error"] / scale,
                       number, label=LABELS[name], linestyle="-" if uncrossable else ":", markersize=2.6 if uncrossable else 5.5,
                       markerfacecolor=figures.COLORS[number] if uncrossable else "none", zorder=3 if uncrossable else 2)
    square = width(system)**2 / scale
    for number, (which, columns) in enumerate(held.items()):
        if columns is not None:
            figures.points(above, columns["time"] / times[which], columns[column] / scale, columns[column + "_error"] / scale,
                           4 + number, label=f"held tube, {'on' if which == 'hi' else 'off'}", linestyle="-", markersize=2.6)
    if cage is not None and column == "d2_contour":  # it is measured to the contour
        figures.points(above, cage["time"] / times["off"], cage["cage"] / scale, cage["cage_error"] / scale, 6,
                       label="relative to its cage, off", linestyle="-", markersize=2.6)
    above.axhline(2 * square, color=figures.INK, linestyle="-.", linewidth=1.1, label="$2L_\\perp^2$, Eq. (35)")
    above.axhline(4 * square, color=figures.INK, linestyle=(0, (1, 3)), linewidth=1.1, label="$4L_\\perp^2$")
    for which, line in (("hi", "-"), ("off", "--")) if column == "d2_contour" else ():  # the other has the vertices' floor
        lags = numpy.geomspace(0.5, 0.003 * times[which], 24)
        alone = sd.free_fiber(lags, *size(system), which == "hi")
        figures.theory(above, lags / times[which], alone / scale, linestyle=line,
                       label=f"straight fiber, nothing fitted, {'on' if which == 'hi' else 'off'}")
    for number, which in enumerate(("hi", "off")):
        a, b = curves[which + "-entangled"], curves[which + "-free"]
        if a is None or b is None:
            continue
        pairs = [(t, ratio(a, b, column, t)) for t in a["time"] if sd.at(b, column, t)]
        figures.points(below, [t / times[which] for t, _ in pairs], [pair[0] for _, pair in pairs],
                       [pair[1] for _, pair in pairs], 2 * number, linestyle="-", markersize=3)
    for number, which in enumerate(("hi", "off")):
        if errors[which]:
            figures.points(above, [0.1], [3e-6 * 4**number], None, 2 * number, xerr=[0.1 * errors[which]], marker="none",
                           label=f"error of $\\tau_r$, {'on' if which == 'hi' else 'off'}")
    above.set(xscale="log", yscale="log", ylabel="$\\langle d^2\\rangle/L^2$" + (", contour" if "contour" in column else ""))
    below.set(xscale="log", xlabel="$t/\\tau_r$", ylabel="uncrossable\nover free", ylim=(0, 1.2))
    below.axhline(1.0, color="#444444", linewidth=0.8)
    figures.legend_above(above)
    return figure


def draw_wave(results, system):
    figure, axes = figures.plain()
    vertices, count, box = size(system)
    words = {"loose": "loose vertices", "free": "fibers that may cross", "forbidden": "fibers that may not"}
    for number, bonds in enumerate(BONDS):
        columns = wave(results, bonds)
        if columns is not None:
            figures.points(axes, columns["time"], columns["share"], columns["share_error"], number, label=words[bonds], markersize=3.5)
    times = numpy.linspace(0.0, WAVE[-1], 80)
    for bonded, line in ((False, "-"), (True, "--")):
        figures.theory(axes, times, sd.wave_left(times, count, vertices, box, bonded), linestyle=line,
                       label="springs along straight fibers" if bonded else "heavier fluid")
    axes.axhline(0.0, color="#444444", linewidth=0.8)
    axes.set(xlabel="$t/t_0$", ylabel="share of the wave that is left")
    figures.legend_above(axes)
    return figure


WAVE_CAPTION = (
    "What is left of a shear wave as long as the box, 32 a0, in the suspension with hydrodynamics. Loose vertices make the fluid heavier "
    "and more viscous, and the wave decays. Bonded ones are stretched by the flow as well, and pull it back. Lines: theory without a "
    "fitted number. Eight pairs of runs each.")


def evaluate(results, tier):
    system = SYSTEMS[tier]
    curves = {name: curve(results, name) for name in CASES}
    held = {which: sd.table(results.get(f"held-{which}"), least=2) for which in ("hi", "off")}
    cage = sd.table(results.get("cage-off"), "cage", least=2)
    measured = {which: rotation(results, which, system) for which in ("hi", "off")}
    times = {which: measured[which][0] if measured[which] else expected_rotation(which, system) for which in measured}
    words = {which: f"({1e-5 * pair[0]:.2f} ± {1e-5 * pair[1]:.2f})·10⁵ t0" if pair else
             f"{1e-5 * times[which]:.2f}·10⁵ t0 (estimated)" for which, pair in measured.items()}
    verdicts = early_verdicts(curves, system, {run.name for run in runs(tier)}) + friction_verdicts(curves, system)
    verdicts += [] if tier == "campaign" else [hindered_verdict(curves)]  # the campaign has `height`
    verdicts += choice_verdicts(results, curves, system)
    if tier == "campaign":  # fibers of the quick tier are too short for a plateau, and nobody measures their tau_r
        verdicts += late_verdicts(results, curves, system) + start_verdicts(results)
        verdicts += plateau_verdicts(curves, system) + held_verdicts(held, system)
        verdicts += wave_verdicts(results, *size(system), (WAVE[3], WAVE[7])) + rotation_verdicts(results, system)
        verdicts += [crowd_verdict(results, system), normalized_verdict(curves, times, measured)]
    else:
        short = SHORT_WAVE
        verdicts += wave_verdicts(results, short["vertices"], short["count"], short["edge"], (short["time"],), short["pairs"])
    errors = {which: pair[1] / pair[0] if pair else None for which, pair in measured.items()}
    found = [Figure(name, what + caption, lambda column=column, axis=axis, bars=bars: draw(curves, held, cage, system, axis, bars, column))
             for name, column, axis, bars, what, caption in pictures(system, times, errors, words)]
    if tier == "campaign":
        found.append(Figure("wave", WAVE_CAPTION, lambda: draw_wave(results, system)))
    return Outcome(verdicts, found, PROSE + (half_words(curves, system) if tier == "campaign" else ""))


def pictures(system, times, errors, words):
    """(name, column, tau_r of either kind, relative errors to show, what it is, the rest of its caption)"""
    one = sd.PAPER_ROTATION_TIME if system["length"] == 32.0 else expected_rotation("hi", system)
    axis, none = dict.fromkeys(times, one), dict.fromkeys(times)
    same = (f"c L³ = {system['count']}, L = l_p = {system['length']:g} a0. Filled: crossing forbidden. Open: crossing free. Below: "
            "forbidden over free at the same lag. 2 L⊥²: the line that the paper draws. 4 L⊥²: where a fixed tube would end, because both positions that d² compares "
            "fluctuate. Held tube: 40 fibers move among 960 that are frozen.")
    caged = " Relative to its cage: less the motion that a fiber shares with its neighbors."
    moves = " Free motion becomes hindered near the first line. The curve passes both: the tube shifts as its neighbors move."
    shared = f" Time is in units of one τ_r for all curves, {one / 1e4:.2g}·10⁴ t0, as in Figs. 3 and 5."
    apart = (f" Each pair of curves has its own τ_r, of a lone fiber: {words['hi']} with hydrodynamics, {words['off']} without. "
             "Horizontal bars: the error of τ_r, by which a pair may be shifted sideways.")
    return (("fig4-d2", "d2", axis, none, "The paper's d²(t), to the nearest vertex. ", same + moves + shared),
            ("fig4-d2_contour", "d2_contour", axis, none, "The same to the nearest point of the contour.", caged),
            ("fig4-own", "d2_contour", times, errors, "The same with another time axis.", apart))


def half_words(curves, system):
    rows = [(on, half_free(curves, which, system)) for which, on in (("hi", "on"), ("off", "off"))]
    return "".join(f"\n\nHydrodynamics {on}: d² of fibers that may not cross is half of the others' at {height:.2f} times 2 L⊥²."
                   for on, height in rows if height)


PROSE = """Crossing is forbidden or allowed, and hydrodynamics are on or off (a bath of phantoms). All four curves are of the
same fibers. They agree until fibers meet. Then d² of those that may not cross falls behind, and bends over in their tube.
Without hydrodynamics each vertex has its own friction, and d² is lower at equal time. Over t/τ_r, with the τ_r of each curve, this is
reversed: with hydrodynamics the friction is lower for long waves than for short ones, and lowest for the rotation of the whole fiber.

The runs have a thermostat (one factor for all velocities), because rejected moves heat: without one this system gains
7·10⁻⁴ of its energy per t0. The effect of another thermostat, of `refusal: bounce` and of half the time step is
measured twice: before fibers meet (`choice`), and in the tube (`late`). τ_r is measured from rotational diffusion of the regression axis, which bends hardly tilt, at
lags that are short beside it. This needs a run of only a tenth of the correlation time of the end-to-end vector. Four fibers
that may cross share the box, so that the statistics are four times as large. The mass of the others makes the fluid 0.3 % more viscous, and their
stress 4 %; both are taken off, and half of the stress is an error. With 24 fibers in the box theory says a quarter more.

“Off” still has some coupling in so dense a suspension. Vertices that share a collision cell, two of each fiber and others, are
slowed down together, with the bath of phantoms as with the paper's swap of velocities. “On” is another fluid than the solvent. With two
vertices of mass 5 per cell, collisions transfer more momentum, and the fluid is 2.9 times as viscous. The dashed and the full line are the
modes of a straight fiber, without hydrodynamics and with, nothing fitted. Fibers that may cross follow their line until the stiffness of the
others matters, from some 3 t0 on with hydrodynamics. The mass of the vertices is a large part of the reason why hydrodynamics matter so little here."""
