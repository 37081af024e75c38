"""The solvent in flow: viscosities by shear, by forces and by fluctuations; slip at walls; oscillating walls; viscous heat."""
import math

import numpy

from lib import figures, flow, stats, theory
from lib.case import Figure, Outcome, Verdict
from lib.flow_runs import HEAT_ACCELERATION, HEAT_POINT, HEAT_RATE, PERIODS, POINTS, RATE, RULES, SPEED, runs  # noqa: F401

TITLE = "The solvent in flow: shear, walls, forces, oscillation, heat"
PAPER = "not in the paper; Tao, Götze and Gompper (2008)"
USES = ("solvent", "andersen")  # shear waves of both rules in three dimensions

CHAOS = {3: 0.30}  # what molecular chaos may be off by, by particles per cell; else:
CHAOS_DENSE = 0.08
MARGIN = 1.0  # a0 from the walls in which a profile is not fitted: the solution of Milne's problem nears its line as exp(-4.5 y)
NAMES = {"srd": "SRD", "at-a": "MPC-AT-a", "at+a": "MPC-AT+a"}
KEY = {"srd": "srd", "at-a": "at-a", "at+a": "atpa"}  # in names of runs
GREEN_KUBO_LAG = 15  # collisions, as in case andersen
WIDTH = {"srd": 30.0, "at-a": 30.0, "at+a": 60.0}  # eta_col(k) = eta_col (1 - k^2/WIDTH): see the README


def words(name):
    point = POINTS[name]
    return f"{point.d}D, n {point.n}, dt_c {point.dt:g}"


def within(error, agreed):
    """A tolerance agreed on beforehand where four errors fit in, else that of the errors."""
    return agreed if error < 0.25 * agreed else stats.tolerance(error)


def quotient(a, b):
    """(a/b, error) of two numbers with errors."""
    value = a[0] / b[0]
    return value, abs(value) * math.hypot(a[1] / a[0], b[1] / b[0])


def filled(verdict, pair, agreed=None, systematic=0.0, error=0.0):
    """The verdict with (value, error) and a tolerance: `agreed`, see within(), or errors and a systematic part."""
    if pair is not None:
        verdict.measured, verdict.error = pair
        total = math.hypot(verdict.error, error)
        verdict.tolerance = within(total, agreed) if agreed else stats.tolerance(total, systematic=systematic)
    return verdict


# --- viscosities ------------------------------------------------------------------------------------------------------

def sheared(results, name, rule, suffix="", rate=RATE):
    """(eta, error) of a sheared box: stress over rate."""
    run = f"shear-{name}-{KEY[rule]}{suffix}"
    if run not in results:
        return None
    sigma, error = flow.stress(results[run], "sigma_xy")
    return sigma / rate, error / rate


def driven(results, name, rule, kind="kolmogorov"):
    """(eta for k -> 0, error): from the amplitude of the first harmonic. Collisions see velocities half a kick ahead of the samples'."""
    run = f"{kind}-{name}-{KEY[rule]}"
    if run not in results:
        return None
    point, profile = POINTS[name], flow.Profile(results[run], POINTS[name])
    g = flow.scene_of(results[run])["solvent"]["acceleration"][0]
    k = 2.0 * math.pi / profile.height
    half = 0.5 * k * profile.thickness
    share = 4.0 / math.pi if kind == "reverse" else 1.0  # of a force +-g, the sine
    eta = sum(flow.viscosity(point, rule))
    fit = flow.generalised([numpy.sin(k * profile.y) * math.sin(half) / half], profile.table["vx"],
                           profile.covariance(flow.periodic(profile.y, profile.height, eta)))
    amplitude, error = fit.value[0] + 0.5 * share * g * point.dt, fit.error[0]
    kinetic, collisional = flow.viscosity(point, rule)
    value = share * g * point.n / (amplitude * k * k) / (1.0 - collisional / (kinetic + collisional) * k * k / WIDTH[rule])
    return value, value * error / amplitude


def poiseuille(results, name):
    """((eta, error), (b, error), stats.Fit, Profile): parabola of the bulk. Collisions see velocities a kick ahead of the samples'."""
    run = f"poiseuille-{name}"
    if run not in results:
        return None
    point, profile = POINTS[name], flow.Profile(results[run], POINTS[name], MARGIN)
    g, height, y = flow.scene_of(results[run])["solvent"]["acceleration"][0], profile.height, profile.y
    response = flow.between_walls(y, height, sum(flow.viscosity(point, "at-a")), flow.slip_length(point, "at-a"))
    parabola = y * (height - y) - profile.thickness**2 / 12.0  # mean over a slab
    fit = flow.generalised([parabola, numpy.ones(len(y))], profile.table["vx"] + g * point.dt, profile.covariance(response))
    (bend, shift), c = fit.value, fit.covariance
    eta = point.n * g / (2.0 * bend)
    slip = shift / (bend * height)
    slip_error = abs(slip) * math.sqrt(c[1, 1] / shift**2 + c[0, 0] / bend**2 - 2.0 * c[0, 1] / (shift * bend))
    return (eta, eta * fit.error[0] / bend), (slip, slip_error), fit, profile


def waves(results, path, point, parts):
    return flow.from_waves(results[path].columns, point.n, *parts) if path in results else None


def fluctuations(results, path):
    if path not in results:
        return None
    table = results[path].columns
    return table["eta"][GREEN_KUBO_LAG], table["eta_error"][GREEN_KUBO_LAG]


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
    found += [(name, rule, "kolmogorov", "Kolmogorov flow", driven(results, name, rule), 0.015) for name, rule in kolmogorov]
    for name in ("2d-n10",) if tier == "quick" else ("2d-n10", "3d-n5"):
        known = poiseuille(results, name)
        found.append((name, "at-a", "poiseuille", "Poiseuille flow", known and known[0], 0.02))
    return found


def sheared_points(tier):
    return [("2d-n10", rule) for rule in RULES] + [("3d-n5", rule) for rule in RULES] + [("2d-n3", "at-a")] if tier == "quick" else [
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

COUETTE = {"planar-L10": ("srd", "planar"), "paper-L10": ("srd", "paper"), "planar-L20": ("srd", "planar"), "paper-L20": ("srd", "paper"),
           "planar-L20-at-a": ("at-a", "planar")}
QUICK_COUETTE = ("planar-L10", "paper-L10")


def couette(results, name, rule, slip):
    """((slope, error), Profile, Fit) of the bulk between sliding walls."""
    point = POINTS["2d-n10"]
    profile = flow.Profile(results[f"couette-{name}"], point, MARGIN)
    response = flow.between_walls(profile.y, profile.height, sum(flow.viscosity(point, rule)), slip)
    fit = flow.generalised([profile.y - 0.5 * profile.height, numpy.ones(len(profile.y))], profile.table["vx"], profile.covariance(response))
    return (fit.value[0], fit.error[0]), profile, fit


def slip_verdicts(results, name, quick):
    """b from the slope in the bulk, and, in the campaign, from the stress on the walls and the viscosity of a sheared box."""
    rule, fill = COUETTE[name]
    expected = flow.slip_length(POINTS["2d-n10"], rule, fill)
    text = f"{NAMES[rule]}, fill {fill}, {words('2d-n10')}, L {20 if 'L20' in name else 10}"
    source = "Milne's problem less bounce-back, Eqs. (2.41), (2.42)"
    by_slope = Verdict(f"flow.slip.{name}", f"slip length from the shear rate of the bulk, {text}", expected, source, 0.03)
    by_stress = Verdict(f"flow.slip-stress.{name}", f"slip length from the stress on the walls and η of the sheared box, {text}", expected, source, 0.03)
    if f"couette-{name}" not in results:
        return [by_slope] if quick else [by_slope, by_stress]
    (slope, error), profile, _ = couette(results, name, rule, expected)
    half = 0.5 * profile.height
    filled(by_slope, (SPEED / slope - half, SPEED / slope * error / slope), agreed=0.03)
    box = sheared(results, "2d-n10", rule)
    if box:
        sigma = flow.stress(results[f"couette-{name}"], "sigma_lower", "sigma_upper")
        ratio, ratio_error = quotient((box[0], box[1]), (0.5 * sigma[0], 0.5 * sigma[1]))
        filled(by_stress, (SPEED * ratio - half, SPEED * ratio_error), agreed=0.03)
    return [by_slope] if quick else [by_slope, by_stress]


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
    if "heat-couette" in results:
        profile = flow.Profile(results["heat-couette"], HEAT_POINT, MARGIN)
        response = flow.between_walls(profile.y, profile.height, sum(flow.viscosity(HEAT_POINT, "srd")), expected)
        fit = flow.generalised([profile.y - 0.5 * profile.height, numpy.ones(len(profile.y))], profile.table["vx"], profile.covariance(response))
        half, slope = 0.5 * profile.height, fit.value[0]
        filled(verdict, (HEAT_RATE * half / slope - half, HEAT_RATE * half / slope * fit.error[0] / slope), agreed=0.03)
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

def oscillation(results, name):
    """(amplitude over theory's, phase after theory's in degrees, error of the amplitude's ratio, Profile, measured v, theory's v)."""
    run, box = f"oscillation-{name}", sheared(results, "2d-n10", "at-a")
    if run not in results or not box:
        return None
    point, period = POINTS["2d-n10"], PERIODS[name]
    profile = flow.Profile(results[run], point, MARGIN)
    slip, rho_omega = flow.slip_length(point, "at-a"), point.n * 2.0 * math.pi / period
    theirs = SPEED * flow.oscillating(profile.y, profile.height, box[0], slip, rho_omega)
    ours = profile.table["vx_in_phase"] - 1j * profile.table["vx_out_of_phase"]  # v = Re[v exp(i omega t)]
    time = math.floor(profile.time / period + 1e-6) * period
    each = 2.0 * profile.covariance(flow.between_walls(profile.y, profile.height, box[0], slip, rho_omega), time=time)
    norm = float((abs(theirs)**2).sum())
    ratio = (ours @ theirs.conj()) / norm
    return abs(ratio), math.degrees(numpy.angle(ratio)), math.sqrt((theirs.conj() @ each @ theirs).real) / norm, profile, ours, theirs


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

POWERS = {"couette": 2, "poiseuille": 4}


def heat(results, name):
    """(parameters, covariance, Profile): T = T_mid - drop |2z/L|^power, fitted in the bulk."""
    if f"heat-{name}" not in results:
        return None
    point = HEAT_POINT
    profile = flow.Profile(results[f"heat-{name}"], point, 1.0)
    z = abs(2.0 * profile.y / profile.height - 1.0)
    response = flow.between_walls(profile.y, profile.height, sum(flow.heat_conductivity(point)), 0.5)
    covariance = profile.covariance(response, noise=2.0 / point.d)
    p, c = flow.curve(lambda p: p[0] - p[1] * z**p[2], (1.1, 0.1, POWERS[name]), profile.table["temperature"], covariance)
    fixed = flow.generalised([numpy.ones(len(z)), -z**POWERS[name]], profile.table["temperature"], covariance)
    return p, c, profile, fixed


def conductivity(results, name):
    """(kappa, error) from the drop of the temperature towards the walls and the work of the flow."""
    known = heat(results, name)
    if not known:
        return None
    drop, error = known[3].value[1], known[3].error[1]
    eta, height = sum(flow.viscosity(HEAT_POINT, "srd")), known[2].height
    if name == "couette":
        rate = HEAT_RATE / (1.0 + 2.0 * flow.slip_length(HEAT_POINT, "srd") / height)
        power = eta * rate**2 * height**2 / 8.0
    else:
        power = (HEAT_POINT.n * HEAT_ACCELERATION)**2 / (12.0 * eta) * (0.5 * height)**4
    return power / drop, power / drop * error / drop


def heat_verdicts(results, tier):
    found = []
    text = f"SRD without thermostat, {HEAT_POINT.d}D, n {HEAT_POINT.n}, dt_c {HEAT_POINT.dt:g}"
    for name in ("couette",) if tier == "quick" else POWERS:
        power = float(POWERS[name])
        verdict = Verdict(f"flow.heat.{name}", f"power p of T = T_mid − ΔT |2z/L|^p, {name.capitalize()} flow, {text}", power,
                          "constant conductivity and viscosity, Eqs. (2.23), (2.24)", 0.1 * power)
        known = heat(results, name)
        found.append(filled(verdict, known and (known[0][2], math.sqrt(known[1][2, 2])), agreed=0.1 * power))
        kappa = sum(flow.heat_conductivity(HEAT_POINT))
        verdict = Verdict(f"flow.conductivity.{name}", f"heat conductivity from ΔT, {name.capitalize()} flow, {text}", kappa,
                          "Tüzel et al. (2003), to first order in 1/n; allowed 10 %", 0.1 * kappa, kind="paper")
        found.append(filled(verdict, conductivity(results, name), agreed=0.1 * kappa))
    return found


def evaluate(results, tier):
    quick = tier == "quick"
    verdicts = [theory_verdict(results, *one) for one in sheared_points(tier)] + [straight_verdict(results, tier)]
    verdicts += [ways_verdict(results, *one) for one in others(results, tier)]
    verdicts += [verdict for name in (QUICK_COUETTE if quick else COUETTE) for verdict in slip_verdicts(results, name, quick)]
    verdicts.append(free_verdict(results))
    for name in ("2d-n10",) if quick else ("2d-n10", "3d-n5"):
        verdicts += [balance_verdict(results, name)] + ([] if quick else [poiseuille_verdict(results, name)])
    for name in ("fast",) if quick else PERIODS:
        verdicts += oscillation_verdicts(results, name)
    verdicts += heat_verdicts(results, tier) + ([] if quick else [heated_slip_verdict(results)])
    return Outcome(verdicts)
