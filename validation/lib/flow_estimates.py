"""What the runs of case `flow` say: viscosities, slip lengths, velocities, temperatures, each as (value, standard error). None without the run."""
import math

import numpy

from lib import flow
from lib.flow_runs import HEAT_ACCELERATION, HEAT_POINT, PERIODS, POINTS, RATE, SPEED

MARGIN = 1.0  # a0 from the walls in which a profile is not fitted: the solution of Milne's problem nears its line as exp(-4.5 y)
KEY = {"srd": "srd", "at-a": "at-a", "at+a": "atpa"}  # in names of runs
GREEN_KUBO_LAG = 15  # collisions, as in case andersen
WIDTH = {"srd": 30.0, "at-a": 30.0, "at+a": 60.0}  # eta_col(k) = eta_col (1 - k^2/WIDTH): see the README
POWERS = {"couette": 2, "poiseuille": 4}


def quotient(a, b):
    """(a/b, error) of two numbers with errors."""
    value = a[0] / b[0]
    return value, abs(value) * math.hypot(a[1] / a[0], b[1] / b[0])


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


def couette(results, name, rule, slip):
    """((slope, error), Profile, Fit) of the bulk between sliding walls."""
    point = POINTS["2d-n10"]
    profile = flow.Profile(results[f"couette-{name}"], point, MARGIN)
    response = flow.between_walls(profile.y, profile.height, sum(flow.viscosity(point, rule)), slip)
    fit = flow.generalised([profile.y - 0.5 * profile.height, numpy.ones(len(profile.y))], profile.table["vx"], profile.covariance(response))
    return (fit.value[0], fit.error[0]), profile, fit


def wall_stress(results, name):
    """(sigma, error): mean of both walls."""
    sigma, error = flow.stress(results[f"couette-{name}"], "sigma_lower", "sigma_upper")
    return 0.5 * sigma, 0.5 * error


def sheared_by_walls(results, name):
    """(eta, error) of Couette flow: stress on the walls over the slope in the bulk."""
    if f"couette-{name}" not in results:
        return None
    rule = "at-a" if name.endswith("at-a") else "srd"
    return quotient(wall_stress(results, name), couette(results, name, rule, flow.slip_length(POINTS["2d-n10"], rule))[0])


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


def heated_flow(results):
    """(slope of the profile, eta): of the Couette run, eta from the stress on the walls at the temperature that it has."""
    if "heat-couette" not in results:
        return None
    profile = flow.Profile(results["heat-couette"], HEAT_POINT, MARGIN)
    slip = flow.slip_length(HEAT_POINT, "srd")
    response = flow.between_walls(profile.y, profile.height, sum(flow.viscosity(HEAT_POINT, "srd")), slip)
    fit = flow.generalised([profile.y - 0.5 * profile.height, numpy.ones(len(profile.y))], profile.table["vx"], profile.covariance(response))
    sigma = flow.stress(results["heat-couette"], "sigma_lower", "sigma_upper")
    return (fit.value[0], fit.error[0]), quotient((0.5 * sigma[0], 0.5 * sigma[1]), (fit.value[0], fit.error[0]))


def conductivity(results, name):
    """(kappa, error) from the drop of the temperature towards the walls and the work of the flow."""
    known, couette_flow = heat(results, name), heated_flow(results)
    if not known or not couette_flow:
        return None
    drop, error = known[3].value[1], known[3].error[1]
    slope, eta = couette_flow
    half = 0.5 * known[2].height
    if name == "couette":
        power, power_error = eta[0] * slope[0]**2 * half**2 / 2.0, eta[1] / eta[0]
    else:
        power, power_error = (HEAT_POINT.n * HEAT_ACCELERATION)**2 / (12.0 * eta[0]) * half**4, eta[1] / eta[0]
    return power / drop, power / drop * math.hypot(error / drop, power_error)
