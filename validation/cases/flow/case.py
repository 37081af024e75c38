"""The solvent in flow: viscosities by shear, by forces and by fluctuations; slip at walls; oscillating walls; viscous heat."""
import math

import numpy

from lib import figures, flow, stats, theory
from lib.case import Figure, Outcome, Verdict
from lib.flow_estimates import (KEY, POWERS, conductivity, couette, driven, fluctuations, heat, heated_flow, oscillation, poiseuille,
                                quotient, sheared, sheared_by_walls, wall_stress, waves)
from lib.flow_runs import HEAT_POINT, HEAT_RATE, PERIODS, POINTS, QUICK_RULES, RATE, RULES, SPEED, runs  # noqa: F401

TITLE = "The solvent in flow: shear, walls, forces, oscillation, heat"
PAPER = "not in the paper; Tao, Götze and Gompper (2008)"
USES = ("solvent", "andersen")  # shear waves of both rules in three dimensions

CHAOS = {3: 0.30}  # what molecular chaos may be off by, by particles per cell; else:
CHAOS_DENSE = 0.08
NAMES = {"srd": "SRD", "at-a": "MPC-AT-a", "at+a": "MPC-AT+a"}


COUETTE = {"planar-L10": ("srd", "planar"), "paper-L10": ("srd", "paper"), "planar-L20": ("srd", "planar"), "paper-L20": ("srd", "paper"),
           "planar-L20-at-a": ("at-a", "planar")}
QUICK_COUETTE = ("planar-L10",)


def words(name):
    point = POINTS[name]
    return f"{point.d}D, n {point.n}, dt_c {point.dt:g}"


def within(error, agreed):
    """A tolerance agreed on beforehand where four errors fit in, else that of the errors."""
    return agreed if error < 0.25 * agreed else stats.tolerance(error)


def filled(verdict, pair, agreed=None, systematic=0.0, error=0.0):
    """The verdict with (value, error) and a tolerance: `agreed`, see within(), or errors and a systematic part."""
    if pair is not None:
        verdict.measured, verdict.error = pair
        total = math.hypot(verdict.error, error)
        verdict.tolerance = within(total, agreed) if agreed else stats.tolerance(total, systematic=systematic)
    return verdict


# --- viscosities ------------------------------------------------------------------------------------------------------

def others(results, tier):
    """(point, rule, word, what it is, value, agreed) of each value of a viscosity that no sheared box made."""
    thin, dense = POINTS["3d-n5"], POINTS["3d-n10"]
    found = [("3d-n5", "srd", "waves", "shear waves of case solvent", waves(results, "solvent/shear-g5-dt0.1-a90", thin,
                                                                           theory.viscosity(5, 0.1, 90)), None),
             ("3d-n5", "at-a", "waves", "shear waves of case andersen", waves(results, "andersen/shear-dt0.1", thin,
                                                                             theory.andersen_viscosity(5, 0.1)), None)]
    kolmogorov = [("2d-n10", "at-a")] if tier == "quick" else [(name, rule) for name in ("2d-n10", "2d-n3") for rule in RULES] + [
        ("3d-n5", "at+a"), ("3d-n10", "at+a")]
    if tier != "quick":
        found += [("3d-n10", "srd", "waves", "shear waves of case solvent", waves(results, "solvent/shear-g10-dt0.02-a90", dense,
                                                                                 theory.viscosity(10, 0.02, 90)), None),
                  ("3d-n10", "at-a", "waves", "shear waves of case andersen", waves(results, "andersen/shear-dense", dense,
                                                                                   theory.andersen_viscosity(10, 0.02)), None),
                  ("3d-n5", "at+a", "stress", "fluctuations in equilibrium", fluctuations(results, "stress-3d-n5-atpa"), None),
                  ("2d-n10", "at-a", "reverse", "reverse Poiseuille flow", driven(results, "2d-n10", "at-a", "reverse"), 0.015)]
        found += [("2d-n10", rule, "couette-" + name, f"Couette flow, {name}", sheared_by_walls(results, name), 0.02)
                  for name, (rule, _) in COUETTE.items()]
    found += [(name, rule, "kolmogorov", "Kolmogorov flow", driven(results, name, rule), 0.015) for name, rule in kolmogorov]
    for name in ("2d-n10",) if tier == "quick" else ("2d-n10", "3d-n5"):
        known = poiseuille(results, name)
        found.append((name, "at-a", "poiseuille", "Poiseuille flow", known and known[0], 0.02))
    return found


def sheared_points(tier):
    return [("2d-n10", rule) for rule in QUICK_RULES] + [("3d-n5", rule) for rule in RULES] + [("2d-n3", "at-a")] if tier == "quick" else [
        (name, rule) for name in POINTS for rule in RULES]


def theory_verdict(results, name, rule):
    point = POINTS[name]
    expected, allowed = sum(flow.viscosity(point, rule)), CHAOS.get(point.n, CHAOS_DENSE)
    verdict = Verdict(f"flow.theory.{name}.{KEY[rule]}", f"η of a sheared box at {RATE:g}/t0, {NAMES[rule]}, {words(name)}", expected,
                      f"molecular chaos, known to {100.0 * allowed:.0f} %", allowed * expected)
    return filled(verdict, sheared(results, name, rule), systematic=allowed * expected)


def ways_verdict(results, name, rule, word, what, value, agreed):
    box = sheared(results, name, rule)
    verdict = Verdict(f"flow.ways.{name}.{KEY[rule]}.{word}", f"η from {what} over that of the sheared box, {NAMES[rule]}, {words(name)}", 1.0,
                      "one fluid", agreed or 0.01)
    return filled(verdict, value and box and quotient(value, box), agreed=agreed or 0.01)


def straight_verdict(results, tier):
    """No kink where images meet: the slope of the profile is the rate, and not by a force on the total momentum."""
    slopes = []
    for name, rule in sheared_points(tier):
        run = f"shear-{name}-{KEY[rule]}"
        if run in results:
            profile = flow.Profile(results[run], POINTS[name])
            eta = sum(flow.viscosity(POINTS[name], rule))
            fit = flow.generalised([profile.y - 0.5 * profile.height, numpy.ones(len(profile.y))], profile.table["vx"],
                                   profile.covariance(flow.periodic(profile.y, profile.height, eta)))
            slopes.append((fit.value[0] / RATE, fit.error[0] / RATE))
    verdict = Verdict("flow.straight", "slope of the profile in sheared boxes over the rate, mean over rules and points", 1.0,
                      "exact: no place of a sheared box is special", 0.005)
    return filled(verdict, stats.weighted_mean(*numpy.transpose(slopes))[:2] if slopes else None)


# --- walls ------------------------------------------------------------------------------------------------------------

def slip_words(name):
    rule, fill = COUETTE[name]
    return f"{NAMES[rule]}, fill {fill}, {words('2d-n10')}, L {20 if 'L20' in name else 10}"


MILNE_SOURCE = "Milne's problem less bounce-back, Eqs. (2.41), (2.42)"


def slip_verdict(results, name):
    """b from the slope in the bulk."""
    rule, fill = COUETTE[name]
    expected = flow.slip_length(POINTS["2d-n10"], rule, fill)
    verdict = Verdict(f"flow.slip.{name}", f"slip length from the shear rate of the bulk, {slip_words(name)}", expected, MILNE_SOURCE, 0.03)
    if f"couette-{name}" in results:
        (slope, error), profile, _ = couette(results, name, rule, expected)
        filled(verdict, (SPEED / slope - 0.5 * profile.height, SPEED / slope * error / slope), agreed=0.03)
    return verdict


def slip_by_stress_verdict(results, name):
    """b from the stress on the walls and the viscosity of a sheared box: V eta/sigma - L/2."""
    rule, fill = COUETTE[name]
    verdict = Verdict(f"flow.slip-stress.{name}", f"slip length from the stress on the walls and η of the sheared box, {slip_words(name)}",
                      flow.slip_length(POINTS["2d-n10"], rule, fill), MILNE_SOURCE, 0.03)
    box = sheared(results, "2d-n10", rule)
    if f"couette-{name}" in results and box:
        ratio, error = quotient(box, wall_stress(results, name))
        filled(verdict, (SPEED * ratio - 0.5 * flow.scene_of(results[f"couette-{name}"])["box"][1], SPEED * error), agreed=0.03)
    return verdict


FREE_MOST = 6.0  # a0 beyond eta/xi: "several" of the theory


def free_verdict(results):
    """Walls that only reverse velocities take sqrt(2kT/pi) n (v - v_w) per area from particles that come from the bulk, and so slip by eta/xi at
    least; near them the viscosity is lower, since cells are cut, and the slip is larger by some a0 that no formula gives."""
    point = POINTS["2d-n10"]
    least = sum(flow.viscosity(point, "srd")) / (math.sqrt(2.0 / math.pi) * point.n)
    verdict = Verdict("flow.slip.none", f"slip length without virtual particles, SRD, {words('2d-n10')}, L 20", least + 0.5 * FREE_MOST,
                      f"between η/ξ = {least:.2f}, bounce-back alone, and some a0 more", stats.Tolerance(0.0, 0.5 * FREE_MOST))
    if "couette-none-L20" in results:
        (slope, error), profile, _ = couette(results, "none-L20", "srd", least)
        verdict.measured = SPEED / slope - 0.5 * profile.height
        verdict.error = SPEED / slope * error / slope
        verdict.detects = 0.5 * FREE_MOST + 2.0 * stats.SIGMAS * verdict.error
    return verdict


def heated_slip_verdict(results):
    """At dt_c 0.1 bounce-back takes 0.09 of the 0.23."""
    expected = flow.slip_length(HEAT_POINT, "srd")
    verdict = Verdict("flow.slip.dt0.1", f"slip length from the shear rate of the bulk, SRD, fill planar, 2D, n {HEAT_POINT.n}, dt_c {HEAT_POINT.dt:g}, L 10",
                      expected, "Milne's problem less bounce-back, to first order in dt_c, Eqs. (2.41), (2.42)", 0.03)
    known = heated_flow(results)
    if known:
        half, (slope, error) = 5.0, known[0]
        filled(verdict, (HEAT_RATE * half / slope - half, HEAT_RATE * half / slope * error / slope), agreed=0.03)
    return verdict


def balance_verdict(results, name):
    """The account of both walls holds the whole force."""
    run = f"poiseuille-{name}"
    verdict = Verdict(f"flow.balance.{name}", f"momentum that the walls take per t0 and area over n g L, Poiseuille flow, {words(name)}", 1.0,
                      "exact: the flow is steady", 0.01)
    if run in results:
        scene = flow.scene_of(results[run])
        force = POINTS[name].n * scene["solvent"]["acceleration"][0] * scene["box"][1]
        pair = flow.stress(results[run], "sigma_lower", "-sigma_upper")
        filled(verdict, (pair[0] / force, pair[1] / force))
    return verdict


def poiseuille_verdict(results, name):
    expected = flow.slip_length(POINTS[name], "at-a")
    verdict = Verdict(f"flow.slip.poiseuille-{name}", f"slip length from the parabola of Poiseuille flow, MPC-AT-a, {words(name)}", expected,
                      "Milne's problem less bounce-back, Eqs. (2.41), (2.42)", 0.05)
    known = poiseuille(results, name)
    return filled(verdict, known and known[1], agreed=0.05)


# --- oscillation ------------------------------------------------------------------------------------------------------

def oscillation_verdicts(results, name):
    text = f"v(y) between oscillating walls, period {PERIODS[name]} t0, MPC-AT-a, {words('2d-n10')}"
    source = "Stokes' problem in a gap with η of the sheared box and b of theory, Eq. (2.56)"
    amplitude = Verdict(f"flow.oscillation.{name}.amplitude", f"amplitude over theory's, {text}", 1.0, source, 0.02)
    phase = Verdict(f"flow.oscillation.{name}.phase", f"phase ahead of theory's, degrees, {text}", 0.0, source, 1.0)
    known = oscillation(results, name)
    if known:
        filled(amplitude, (known[0], known[2]), agreed=0.02)
        filled(phase, (known[1], math.degrees(known[2])), agreed=1.0)
    return [amplitude, phase]


# --- heat -------------------------------------------------------------------------------------------------------------



def heat_verdicts(results):
    found = []
    text = f"SRD without thermostat, {HEAT_POINT.d}D, n {HEAT_POINT.n}, dt_c {HEAT_POINT.dt:g}"
    for name in POWERS:
        power = float(POWERS[name])
        verdict = Verdict(f"flow.heat.{name}", f"power p of T = T_mid − ΔT |2z/L|^p, {name.capitalize()} flow, {text}", power,
                          "constant conductivity and viscosity, Eqs. (2.23), (2.24)", 0.1 * power)
        known = heat(results, name)
        found.append(filled(verdict, known and (known[0][2], math.sqrt(known[1][2, 2])), agreed=0.1 * power))
        kappa = sum(flow.heat_conductivity(HEAT_POINT))
        verdict = Verdict(f"flow.conductivity.{name}", f"heat conductivity from ΔT, {name.capitalize()} flow, {text}", kappa,
                          "Tüzel et al. (2003), to first order in 1/n; allowed 10 %", 0.1 * kappa, kind="paper",
                          reason="The two flows agree with each other; the formula is of first order in 1/n, and is not tested otherwise here.")
        found.append(filled(verdict, conductivity(results, name), agreed=0.1 * kappa))
    verdict = Verdict("flow.heat.one", f"heat conductivity of Couette over that of Poiseuille flow, {text}", 1.0, "one fluid", 0.1)
    known = [conductivity(results, name) for name in POWERS]
    found.append(filled(verdict, quotient(*known) if all(known) else None, agreed=0.1))
    return found


# --- errors -----------------------------------------------------------------------------------------------------------

def error_verdict(results):
    """Are the errors right? Blocks of each slab know nothing of hydrodynamics."""
    found = []
    for name in (name for name in ("planar-L10", "paper-L10", "planar-L20", "paper-L20") if f"couette-{name}" in results):
        rule, fill = COUETTE[name]
        slip = flow.slip_length(POINTS["2d-n10"], rule, fill)
        _, profile, _ = couette(results, name, rule, slip)
        response = flow.between_walls(profile.y, profile.height, sum(flow.viscosity(POINTS["2d-n10"], rule)), slip)
        found.append(profile.surprise(profile.covariance(response)))
    return Verdict("flow.errors", "variance of v(y) by blocks over that of fluctuating hydrodynamics, Couette flow, mean over slabs and runs", 1.0,
                   "Landau and Lifshitz; blocks of 16 and more know a variance to some 20 %", 0.35,
                   measured=float(numpy.mean(found)) if found else None)


# --- figures ----------------------------------------------------------------------------------------------------------

MARKS = {"waves": "shear waves", "stress": "fluctuations", "kolmogorov": "Kolmogorov", "reverse": "reverse Poiseuille", "poiseuille": "Poiseuille", "couette": "Couette"}


def draw_viscosities(results, tier):
    figure, panel = figures.plain(width=9.5, height=4.4)
    places = {one: k for k, one in enumerate(sheared_points(tier))}
    rows = {"sheared box": [(one, sheared(results, *one)) for one in places]}
    for name, rule, word, _, value, _ in others(results, tier):
        rows.setdefault(MARKS[word.partition("-")[0]], []).append(((name, rule), value))
    for number, (text, row) in enumerate(rows.items()):
        known = [(places[one] + 0.12 * (number - 2), *numpy.array(value) / sum(flow.viscosity(POINTS[one[0]], one[1]))) for one, value in row if value]
        if known:
            figures.points(panel, *zip(*known), number=number, label=text, markersize=4)
    panel.axhline(1.0, color=figures.INK, linewidth=1.1)
    panel.set_xticks(list(places.values()), [f"{NAMES[rule].replace('MPC-', '')}\n{words(name).replace(', dt', chr(10) + 'dt')}" for name, rule in places],
                     fontsize=7)
    panel.set_ylabel("$\\eta$ over molecular chaos")
    figures.legend(panel)
    return figure


def draw_slip(results):
    """v - v_wall near the walls, over the shear rate of the bulk, both walls averaged: y + b."""
    figure, panel = figures.plain()
    names = [name for name in ("planar-L10", "paper-L10", "planar-L20") if f"couette-{name}" in results]
    for number, name in enumerate(names):
        rule, fill = COUETTE[name]
        (slope, _), profile, _ = couette(results, name, rule, flow.slip_length(POINTS["2d-n10"], rule, fill))
        whole = flow.Profile(results[f"couette-{name}"], POINTS["2d-n10"])
        y, v = whole.y, (whole.table["vx"] - whole.table["vx"][::-1]) / 2.0
        near = y < 4.0
        figures.points(panel, y[near], (v[near] + SPEED) / slope - y[near], whole.table["vx_error"][near] / math.sqrt(2.0) / slope, number=number,
                       label=f"fill {fill}, L {profile.height:g}")
    panel.axhline(flow.slip_length(POINTS["2d-n10"], "srd"), color=figures.INK, linewidth=1.1, label="planar: Milne less bounce-back")
    panel.axhline(0.0, color=figures.INK, linewidth=0.8, linestyle=":")
    panel.set(xlabel="distance from the wall ($a_0$)", ylabel="$(v - v_w)/\\dot\\gamma - y$ ($a_0$)", ylim=(-0.05, 0.35))
    figures.legend(panel)
    return figure


def draw_poiseuille(results, names):
    figure, tops, belows = figures.with_residuals(width=9.5, height=4.8, columns=2, share=0.4)
    for top, below, name in zip(tops, belows, names):
        known = poiseuille(results, name)
        if known is None:
            continue
        (eta, _), (slip, _), fit, profile = known
        whole = flow.Profile(results[f"poiseuille-{name}"], POINTS[name])
        g = flow.scene_of(results[f"poiseuille-{name}"])["solvent"]["acceleration"][0]

        def parabola(y):
            return fit.value[0] * (y * (profile.height - y) - profile.thickness**2 / 12.0) + fit.value[1] - g * POINTS[name].dt
        figures.theory(top, whole.y, parabola(whole.y), label="parabola, fitted")
        figures.points(top, whole.y, whole.table["vx"], whole.table["vx_error"], label=words(name))
        figures.points(below, whole.y, whole.table["vx"] - parabola(whole.y), whole.table["vx_error"])
        below.set_xlabel("y ($a_0$)")
        top.set_title(f"$\\eta$ {eta:.3g}, b {slip:.2f} $a_0$")
        figures.legend(top, loc="lower center")
    tops[0].set_ylabel("$v_x$ ($a_0/t_0$)")
    belows[0].set_ylabel("difference")
    return figure


def draw_oscillation(results, names):
    figure, panels = figures.plain(width=9.5, height=4.4, columns=2)
    for panel, name in zip(panels, names):
        known = oscillation(results, name)
        if known is None:
            continue
        _, _, _, profile, ours, theirs = known
        figures.theory(panel, profile.y, theirs.real, label="Stokes in a gap")
        figures.theory(panel, profile.y, -theirs.imag)
        figures.points(panel, profile.y, ours.real, profile.table["vx_in_phase_error"], label="in phase with the walls")
        figures.points(panel, profile.y, -ours.imag, profile.table["vx_out_of_phase_error"], number=1, label="out of phase")
        panel.set(title=f"period {PERIODS[name]} $t_0$", xlabel="y ($a_0$)")
        figures.legend(panel)
    panels[0].set_ylabel("$v_x$ ($a_0/t_0$)")
    return figure


def draw_heat(results):
    figure, panel = figures.plain()
    for number, name in enumerate(name for name in POWERS if f"heat-{name}" in results):
        _, _, profile, fixed = heat(results, name)
        whole = flow.Profile(results[f"heat-{name}"], HEAT_POINT)
        z = numpy.linspace(-1.0, 1.0, 101)
        figures.theory(panel, 0.5 * profile.height * (1.0 + z), fixed.value[0] - fixed.value[1] * abs(z)**POWERS[name],
                       label="parabola, quartic: height and drop fitted" if number == 0 else None)
        figures.points(panel, whole.y, whole.table["temperature"], whole.table["temperature_error"], number=number, label=f"{name.capitalize()} flow")
    panel.axhline(1.0, color=figures.INK, linewidth=0.8, linestyle=":")
    panel.set(xlabel="y ($a_0$)", ylabel="temperature ($kT$)")
    figures.legend(panel)
    return figure


def figures_of(results, tier):
    found = []
    if any(name.startswith("shear-") for name in results):
        found.append(Figure("viscosities", "Viscosities over molecular chaos, by point and rule. A sheared box is read by its stress, forces and decaying "
                            "waves by the flow that they make.", lambda: draw_viscosities(results, tier)))
    if "couette-planar-L10" in results:
        found.append(Figure("slip", "Couette flow near a wall: the velocity relative to the wall over the shear rate of the bulk, less the distance from "
                            "the wall. This is the slip length b as soon as the boundary layer ends, within one cell. Both walls averaged; slabs are correlated.",
                            lambda: draw_slip(results)))
    names = [name for name in ("2d-n10", "3d-n5") if f"poiseuille-{name}" in results]
    if names:
        found.append(Figure("poiseuille", "Poiseuille flow and the parabola that is fitted beyond 1 a0 from the walls. Slabs are correlated.",
                            lambda names=names: draw_poiseuille(results, names)))
    names = [name for name in PERIODS if oscillation(results, name)]
    if names:
        found.append(Figure("oscillation", "Velocity between oscillating walls, by its parts in phase and a quarter of a period behind. Line: theory with "
                            "the viscosity of the sheared box and the slip length of theory; nothing is fitted.",
                            lambda names=names: draw_oscillation(results, names)))
    if "heat-couette" in results:
        found.append(Figure("heat", "Temperature between walls at kT = 1 without a thermostat. The flow heats, and the virtual particles take the heat away.",
                            lambda: draw_heat(results)))
    return found


def percent(pair, expected):
    return f"{100.0 * (pair[0] / expected - 1.0):+.1f} ± {100.0 * pair[1] / expected:.1f} %"


def prose(results, tier):
    known = [(name, rule, sheared(results, name, rule)) for name, rule in sheared_points(tier)]
    lines = [f"{NAMES[rule]}, {words(name)}: η {eta[0]:.3f} ± {eta[1]:.3f}, {percent(eta, sum(flow.viscosity(POINTS[name], rule)))} of molecular chaos."
             for name, rule, eta in known if eta]
    text = "Sheared boxes. " + " ".join(lines) if lines else "No sheared box yet."
    rates = [(rate, sheared(results, "2d-n10", "at-a", suffix, rate)) for suffix, rate in (("-slow", 0.04), ("", RATE), ("-fast", 0.16))]
    if all(eta for _, eta in rates):
        text += "\n\nDependence on the rate, MPC-AT-a, " + words("2d-n10") + ": " + ", ".join(
            f"η {eta[0]:.2f} ± {eta[1]:.2f} at {rate:g}/t0" for rate, eta in rates) + "."
    return text


def evaluate(results, tier):
    results = {name: result for name, result in results.items() if result.run.program or result.tables()}
    quick = tier == "quick"
    ways = others(results, tier)
    known = {one[:2] for one in ways} if quick else set()  # the quick tier asks theory where no other flow does
    verdicts = [theory_verdict(results, *one) for one in sheared_points(tier) if one not in known] + [straight_verdict(results, tier)]
    verdicts += [ways_verdict(results, *one) for one in ways]
    verdicts += [slip_verdict(results, name) for name in (QUICK_COUETTE if quick else COUETTE)]
    verdicts += [] if quick else [slip_by_stress_verdict(results, "planar-L10")]
    verdicts.append(free_verdict(results))
    for name in ("2d-n10",) if quick else ("2d-n10", "3d-n5"):
        verdicts += [balance_verdict(results, name)] + ([] if quick else [poiseuille_verdict(results, name)])
    for name in ("fast",) if quick else PERIODS:
        verdicts += oscillation_verdicts(results, name)
    if not quick:
        verdicts += heat_verdicts(results) + [heated_slip_verdict(results), error_verdict(results)]
    return Outcome(verdicts, figures_of(results, tier), prose(results, tier))
