"""The same Gaussian chain in fluids that are there particle by particle: Lowe-Andersen, DPD, SRD. Their runs, and D in an infinite box.

Units a0 = kT = m = t0 = 1. Each fluid has the viscosity and the D of one vertex that its own runs give. So its chains are
compared with Kirkwood's sum for spheres of its own a = kT/(6 pi eta D0).
"""
import dataclasses
import math

import numpy

from lib import dilute, figures, stats, theory
from lib.case import Verdict
from lib.runs import Run


@dataclasses.dataclass(frozen=True)
class Fluid:
    """What a scene and a wave need. spring: makes bonds of about 4 a. repulsion: kT/a0."""
    title: str
    rate: float
    draw: str
    weight: str
    repulsion: float
    step: float
    order: str
    spring: float
    wave: tuple  # amplitude, t0 left out, pairs of runs
    density: float = 3.0

    def scene(self, vertices, count, box, every, memory, frames):
        """Vertices have the mass of a particle, and take the place of one: the density of all members is the fluid's."""
        solvent = self.density - vertices * count / box ** 3
        medium = (f"{{kind: pairs, density: {solvent:.10g}, rate: {self.rate:g}, draw: {self.draw}, weight: {self.weight}"
                  + (f", repulsion: {self.repulsion:g}" if self.repulsion else "") + "}")
        return (f"box: [{box}, {box}, {box}]\ntime_step: {self.step}\norder: {self.order}\nmedium: {medium}\n"
                + chain_lines(vertices, count, 1, self.spring, round(20.0 / self.step), every, memory)
                + (f"trajectory: {{every: {frames}, velocities: false}}\n" if frames else ""))

    def wave_run(self, name, hours, seed=1):
        return Run(name, program=["medium_wave", self.density, self.rate, self.draw, self.weight, self.repulsion, self.step,
                                  *self.wave, seed, 10], hours=hours)


def chain_lines(vertices, count, mass, spring, first, every, memory):
    bonds = f"bond_length: 0, spring: {spring}" if vertices > 1 else "bond_length: 1, spring: 1"
    return (f"crossing: {{forbidden: false}}\nfibers: [{{name: chain, count: {count}, vertices: {vertices}, mass: {mass}, {bonds}}}]\n"
            f"observe: {{from: {first}, dynamics: {{every: {every}}}, statics: {{every: {every}}}"
            + (f", memory: {{every: {memory}}}" if memory else "") + "}\n")


FLUIDS = {
    "la": Fluid("Lowe-Andersen, ρ = 3, Γ = 10", 10.0, "replace", "hat", 0.0, 0.02, "drift-split", 3.47, (0.5, 0.5, 30)),
    "la1": Fluid("Lowe-Andersen, ρ = 3, Γ = 1", 1.0, "replace", "hat", 0.0, 0.05, "drift-split", 3.0, (0.4, 1.0, 160)),
    "hat": Fluid("thermostat of DPD with the hat, ρ = 3, Γ = 1", 1.0, "relax", "hat", 0.0, 0.05, "drift-split", 3.0, (0.4, 1.0, 160)),
    **{f"{key}{rate}": Fluid(f"{title}, ρ = 3, Γ = {rate}", float(rate), draw, "hat", 0.0, step, "drift-split", 3.0, (0.5, skip, pairs))
       for key, title, draw in (("la", "Lowe-Andersen", "replace"), ("hat", "thermostat of DPD with the hat", "relax"))
       for rate, step, skip, pairs in ((3, 0.03, 0.7, 60), (10, 0.02, 0.5, 60), (30, 0.006, 0.3, 60)) if (key, rate) != ("la", 10)},
    **{f"la-rho{density}": Fluid(f"Lowe-Andersen, ρ = {density}, Γ = 3", 3.0, "replace", "hat", 0.0, 0.02, "drift-split", 3.0, (0.5, 0.7, pairs), float(density))
       for density, pairs in ((1, 180), (6, 15), (10, 10))},
    "dpd": Fluid("DPD, ρ = 3, a = 25, γ = 4.5", 9.0, "relax", "quadratic", 25.0, 0.04, "kick-split", 6.0, (0.4, 1.0, 8)),
}
# fluid: N: box, chains, steps, CPU hours
SYSTEMS = {"la1": {1: (8, 60, 16000, 0.004)}, "hat": {1: (8, 60, 16000, 0.004)},
           **{f"{key}{rate}": {1: (10, 100, steps, hours)} for key in ("la", "hat")
              for rate, steps, hours in ((3, 12000, 0.004), (10, 20000, 0.006), (30, 50000, 0.015)) if (key, rate) != ("la", 10)},
           "la-rho1": {1: (10, 33, 20000, 0.001)}, "la-rho6": {1: (8, 100, 6000, 0.006)}, "la-rho10": {1: (8, 100, 4000, 0.01)},
           "la": {1: (10, 100, 10000, 0.003), 5: (8, 8, 55000, 0.006), 10: (10, 6, 60000, 0.013), 20: (12, 4, 45000, 0.016)},
           "dpd": {1: (8, 60, 8000, 0.002), 5: (8, 8, 16000, 0.004), 10: (10, 6, 16000, 0.007), 20: (10, 4, 20000, 0.009)}}
SRD_BOX, SRD_CHAINS, SRD_STEPS = 12, 4, 200000  # of ten vertices
# The fluid of DPD alone, in 6^3
STATES = (("dpd-rho4", "density: 4, repulsion: 25", 0.02, 5000), ("dpd-rho5", "density: 5, repulsion: 25", 0.02, 5000),
          ("dpd-rho8", "density: 8, repulsion: 25", 0.02, 4000),
          ("many-rho6", "density: 6, repulsion: -40, many_body: {repulsion: 25}", 0.01, 6000),
          ("many-rho7", "density: 7, repulsion: -40, many_body: {repulsion: 25}", 0.01, 6000))
LAGS = {"la": 25.6, "dpd": 12.8, "srd": 51.2}  # t0: D is that of times from half of it to it; 2 to 4 b^2/D0, SRD 1
FREE_LAG = 6.4
NAMED = {"dpd": ("apart", 0.2)}  # these chains are not Gaussian: Kirkwood's sum over their own shapes, and the radius of overlaps


def runs():
    found = []
    for key, systems in SYSTEMS.items():
        fluid = FLUIDS[key]
        found.append(fluid.wave_run(f"{key}-wave", 0.006 if fluid.wave[2] > 100 else 0.002))
        for vertices, (box, count, steps, hours) in systems.items():
            shapes = NAMED.get(key) if vertices > 1 else None
            found.append(Run(name_of(key, vertices), steps=steps, hours=hours, after=shapes or (),
                             scene=fluid.scene(vertices, count, box, 20 if vertices == 1 or key == "dpd" else 40,
                                               5 if vertices == 10 else 0, 100 if shapes else 0)))
    for name, medium, step, steps in STATES:
        scene = (f"box: [6, 6, 6]\ntime_step: {step}\norder: kick-split\nmedium: {{kind: pairs, rate: 9, draw: relax, weight: quadratic, "
                 f"{medium}}}\nobserve: {{pressure: {{every: 10}}, temperature: {{every: 10}}}}\n")
        found.append(Run(name, scene=scene, steps=steps, hours=0.003))
    scene = (f"box: [{SRD_BOX}, {SRD_BOX}, {SRD_BOX}]\ntime_step: 0.02\norder: kick-split\n"
             "solvent: {per_cell: 5, collision_interval: 0.02}\n" + chain_lines(10, SRD_CHAINS, 5, 3, 1000, 40, 5))
    found.append(Run("isotropy", program=["isotropy", 12, 80, 5], hours=0.008))
    return [*found, Run("srd-N10", scene=scene, steps=SRD_STEPS, hours=0.008)]


def name_of(key, vertices):
    return f"{key}-free" if vertices == 1 else f"{key}-N{vertices}"


# --- D of an infinite box ---------------------------------------------------------------------------------------------

def at(table, name, time):
    """(value, error) of the dynamics at the lag next to this time; nan while the run has no such lag."""
    if len(table["time"]) == 0 or table["time"][-1] < 0.8 * time:
        return math.nan, math.nan
    row = int(numpy.argmin(abs(table["time"] - time)))
    return table[name][row], table[name + "_error"][row]


def viscosity(key, results):
    """(eta, error) for k -> 0. Lowe-Andersen: the wave is as long as ten ranges, 75 k^2/2940 = 1 % less (molecular chaos)."""
    if key == "srd":
        return dilute.ETA, dilute.PER_CELL * dilute.NU_ERROR
    if f"{key}-wave" not in results:
        return None
    table = results[f"{key}-wave"].columns
    factor = 1.0 + (75.0 * table["k"][0] ** 2 / 2940.0 if key != "dpd" else 0.0)
    return factor * table["eta"][0], factor * table["eta_error"][0]


def system(key, vertices):
    """(box, count, mass of a chain, mass of all)"""
    if key == "srd":
        mass = dilute.MASS * vertices
        return SRD_BOX, SRD_CHAINS, mass, dilute.PER_CELL * SRD_BOX ** 3 + SRD_CHAINS * mass
    box, count, *_ = SYSTEMS[key][vertices]
    return box, count, float(vertices), FLUIDS[key].density * box ** 3


def infinite(key, vertices, results, eta, lag):
    """(D, error) of an infinite box: recoil of the closed box, then the images."""
    table = results[name_of(key, vertices)].table("dynamics-chain")
    box, count, mass, total = system(key, vertices)
    value, error = at(table, "D_cumulative", lag)
    recoil = 1.0 - (1.0 - ((total - count * mass) / total) ** 2) / count
    gyration2 = results[name_of(key, vertices)].table("statics-chain")["Rg2"][0] if vertices > 1 else 0.0
    shift = (theory.PERIODIC - 4.0 * math.pi / 3.0 * gyration2 / box ** 2) / (6.0 * math.pi * eta * box)
    return value / recoil + shift, error / recoil


@dataclasses.dataclass
class Known:
    """Of one fluid: viscosity, D of one vertex, radius of a vertex."""
    eta: float
    eta_error: float
    free: float
    free_error: float

    @property
    def radius(self):
        return 1.0 / (6.0 * math.pi * self.eta * self.free)

    def kirkwood(self, hydrodynamic):
        """(D, error) of a chain of N vertices whose D/D0 is 1/N + `hydrodynamic` with this radius: D0 counts in the first part
        alone, 1/eta in the second."""
        n, part = hydrodynamic
        own, others = self.free / n, self.free * part
        return own + others, math.hypot(own * self.free_error / self.free, others * self.eta_error / self.eta)


def known(key, results):
    """None without the runs."""
    if key == "srd":
        return Known(dilute.ETA, dilute.PER_CELL * dilute.NU_ERROR, dilute.D_VERTEX, dilute.D_VERTEX_ERROR)
    eta = viscosity(key, results)
    if eta is None or f"{key}-free" not in results:
        return None
    return Known(*eta, *infinite(key, 1, results, eta[0], FREE_LAG))


def bond2(key, vertices, results):
    return results[name_of(key, vertices)].table("statics-chain")["l2"][0] if key != "srd" else 1.0


def expected(key, vertices, results, fluid):
    """Kirkwood's D and its error: spheres of the fluid's radius in a Gaussian chain of the measured <l^2>, or in the measured shapes."""
    result = results.get(name_of(key, vertices))
    if key in NAMED and result is not None and NAMED[key][0] in result.tables():
        part = result.table(NAMED[key][0])["inverse"][0] * fluid.radius
    else:
        b = math.sqrt(bond2(key, vertices, results))
        part = dilute.kirkwood_chain(vertices, fluid.radius / b) / dilute.stokes(fluid.radius / b) - 1.0 / vertices
    return fluid.kirkwood((vertices, part))


# --- memory -----------------------------------------------------------------------------------------------------------

def memory_form(times, vertices, nu, density):
    """C(t) of the centre of a frozen Gaussian chain, bonds of 1, in an incompressible fluid without an end:
    (2 kT/3 rho N^2) sum_ij [4 pi (nu t + |i - j|/6)]^(-3/2)."""
    distance = numpy.arange(vertices)
    count = numpy.where(distance == 0, vertices, 2.0 * (vertices - distance))
    apart = 4.0 * math.pi * (nu * numpy.atleast_1d(times)[:, None] + distance / 6.0)
    return 2.0 / (3.0 * density * vertices ** 2) * (count * apart ** -1.5).sum(axis=1)


# --- verdicts ---------------------------------------------------------------------------------------------------------

def fill(verdict, pair, systematic=0.0, **options):
    if pair is not None and math.isfinite(pair[1]):  # no error: the run is too short for blocks
        verdict.measured, verdict.error = pair
        verdict.tolerance = stats.tolerance(verdict.error, systematic=systematic, **options)
    return verdict


def chaos(rate, step, density=3.0):
    """(eta, D) of Lowe and Andersen's fluid in molecular chaos."""
    d = 9.0 / (2.0 * math.pi * density * rate)
    return density * (0.625 * d - 0.5 * step + math.pi * density * rate / 75.0), d - 0.5 * step


def free_verdicts(results):
    """Viscosity, D of one vertex, and their Schmidt number."""
    found = []
    for key, rate in (("la1", 1.0), ("la", 10.0)):
        fluid, (eta, d) = known(key, results), chaos(rate, FLUIDS[key].step)
        paper = {"kind": "paper", "reason": f"a particle collides {4.0 * math.pi * rate:.0f} times in t0, so it meets its partners again before they part"}
        where = f"Lowe-Andersen, ρ = 3, Γ = {rate:g}"
        pairs = ("viscosity", f"η of {where}", eta, fluid and (fluid.eta, fluid.eta_error)), \
            ("free", f"D of a vertex like a particle, {where}", d, fluid and (fluid.free, fluid.free_error)), \
            ("schmidt", f"Schmidt number η/ρD of {where}", eta / 3.0 / d, fluid and (
                fluid.eta / 3.0 / fluid.free,
                fluid.eta / 3.0 / fluid.free * math.hypot(fluid.eta_error / fluid.eta, fluid.free_error / fluid.free)))
        for name, statement, expected_value, pair in pairs:
            allowed = (0.15 if rate == 1.0 else 0.05) * expected_value
            found.append(fill(Verdict(f"media.{name}.gamma{rate:g}", statement, expected_value,
                                      "molecular chaos, known to 15 % at Γ = 1", allowed, **paper), pair, allowed))
    return found


def cold_verdicts(results):
    """The slides: at one Γ the viscosity does not depend on the temperature, and D is proportional to it. In units of a0 and 1/Γ the temperature of
    a fluid is 1/Γ², its viscosity ν/Γ and its diffusion D/Γ. So Γ = 10 and 30 are one fluid at two temperatures, a factor of nine apart.
    D has half a step added, which a finite step takes off."""
    warm, cold = known("la", results), known("la30", results)
    found = []
    for name, of, wanted in (("viscosity", lambda one, step: (one.eta / 3.0, one.eta_error / 3.0), 0.0), ("free", lambda one, step: (one.free + 0.5 * step, one.free_error), 1.0)):
        pair = None
        if warm is not None and cold is not None:
            value, error = ratio(of(warm, FLUIDS["la"].step), of(cold, FLUIDS["la30"].step))
            pair = math.log(3.0 * value) / math.log(9.0), error / value / math.log(9.0)
        found.append(fill(Verdict(f"media.cold.{name}", f"exponent of {'ν' if name == 'viscosity' else 'D'} against the temperature at equal Γ, Lowe-Andersen, Γ = 10 and 30",
                                  wanted, "the slides (28)", 0.0, kind="paper", reason="the colder, the more often pairs meet again before they part"), pair))
    return found


def density_verdicts(results):
    """The Schmidt number at other densities, against molecular chaos: the more partners a particle has, the seldomer it meets the same again."""
    found = []
    for density in (1, 6, 10):
        key = f"la-rho{density}"
        fluid, (eta, d) = known(key, results), chaos(3.0, FLUIDS[key].step, density)
        pair = ratio((fluid.eta, fluid.eta_error), (density * fluid.free, density * fluid.free_error)) if fluid is not None else None
        allowed = 0.05 * eta / d / density
        found.append(fill(Verdict(f"media.schmidt.rho{density}", f"Schmidt number η/ρD of {FLUIDS[key].title}", eta / d / density, "molecular chaos, 5 %", allowed,
                                  kind="paper", reason="pairs meet again before they part"), pair, allowed))
    return found


# Of one rate: the thermostat of DPD with the hat, and Lowe-Andersen.
LIMITS = {1: ("hat", "la1"), 3: ("hat3", "la3"), 10: ("hat10", "la"), 30: ("hat30", "la30")}


def limit_verdicts(results):
    """Lowe and Andersen's fluid and that of a DPD thermostat with the hat, of one rate: the slides have them equal as dt -> 0. A pair
    that draws anew loses all of its velocity now and then, one that relaxes a little each time: the kinetic stress decays by
    <1 - c>/3 - <(1 - c)^2>/15 per encounter, so that nu_kin/D is 5/8 in one and 1/2 in the other. D is the same. This is molecular
    chaos, which ends where pairs meet again before they part."""
    found = []
    for rate, (relaxing, drawn) in LIMITS.items():
        step, d, handed = FLUIDS[relaxing].step, 9.0 / (2.0 * math.pi * 3.0 * rate), math.pi * 3.0 * rate / 75.0
        eta = (0.5 * d - 0.5 * step + handed) / (0.625 * d - 0.5 * step + handed)
        relaxed = (d * rate * step / -math.expm1(-rate * step) - 0.5 * step) / (d - 0.5 * step)
        one, other = known(relaxing, results), known(drawn, results)
        both = one is not None and other is not None
        known_to = 0.05 if rate == 1 else 0.0  # of the viscosities' ratio
        end, paper = "" if rate == 1 else f".gamma{rate}", {"rival": 1.0} if rate == 1 else {
            "kind": "paper", "reason": "pairs meet again before they part, which molecular chaos leaves out"}
        found += [fill(Verdict(f"media.limit.viscosity{end}", f"η of the DPD thermostat with the hat over that of Lowe-Andersen, Γ = {rate}", eta,
                               "molecular chaos" + ("; the ratio is known to 5 %" if known_to else ""), known_to * eta, **paper),
                       ratio((one.eta, one.eta_error), (other.eta, other.eta_error)) if both else None, known_to * eta),
                  fill(Verdict(f"media.limit.free{end}", "the same of D", relaxed, "molecular chaos; the ratio is known to 3 %", 0.03,
                               **({} if rate == 1 else paper)),
                       ratio((one.free, one.free_error), (other.free, other.free_error)) if both else None, 0.03)]
    return found


def isotropy_verdicts(results):
    """The solvent of cubic cells against [100], by shear waves (validation/measure/isotropy.c)."""
    found, table = [], results["isotropy"].columns if "isotropy" in results else None
    for row, name in enumerate(("110-001", "110-1m10", "111-1m10"), start=1):
        pair = ratio((table["nu"][row], table["nu_error"][row]), (table["nu"][0], table["nu_error"][0])) if table else None
        found.append(fill(Verdict(f"media.isotropy.{name}", f"ν of SRD by waves along and across {name.replace('m', '−').replace('-', ', ')}, over that by 100, 010", 1.0,
                                  "an isotropic fluid: 1 %, after the known loss of short waves", 0.01), pair, 0.01))
    return found


CHAIN = 0.97  # of Kirkwood's D: chains that change their shape are 1 to 5 % slower, by BD of the same chain


def chain_verdicts(results):
    """D in each fluid over Kirkwood's sum for spheres of its own radius."""
    found = []
    for key in ("la", "dpd"):
        fluid = known(key, results)
        for vertices in (5, 10, 20):
            pair = None
            if fluid is not None and name_of(key, vertices) in results:
                pair = ratio(infinite(key, vertices, results, fluid.eta, LAGS[key]), expected(key, vertices, results, fluid))
            found.append(fill(Verdict(f"media.chain.{key}.N{vertices}", f"D over Kirkwood's of spheres of the fluid's own a, N = {vertices}, "
                                      f"{FLUIDS[key].title}", CHAIN, "Kirkwood's sum less the change of shape, known to 8 %: a vertex is no sphere",
                                      0.08), pair, 0.08))
    return found


def srd_verdicts(results):
    """SRD: one run beside the others, with their lags; the case `chains` has all lengths and boxes."""
    pair = None
    if "srd-N10" in results:
        fluid = known("srd", results)
        pair = ratio(infinite("srd", 10, results, fluid.eta, LAGS["srd"]), expected("srd", 10, results, fluid))
    return [fill(Verdict("media.chain.srd.N10", "D over Kirkwood's of spheres of the fluid's own a, N = 10, SRD, γ = 5, dt_c = 0.02", CHAIN,
                         "Kirkwood's sum less the change of shape, known to 8 %: a vertex is no sphere", 0.08), pair, 0.08)]


def ratio(a, b):
    return a[0] / b[0], a[0] / b[0] * math.hypot(a[1] / a[0], b[1] / b[0])


BLOCKS = 16


def mean_of(values, first=0.1):
    """(mean, standard error) over blocks, the first part left out."""
    values = values[int(len(values) * first):]
    blocks = values[:len(values) // BLOCKS * BLOCKS].reshape(BLOCKS, -1).mean(axis=1)
    return stats.judged(float(blocks.mean()), values), float(blocks.std(ddof=1) / math.sqrt(BLOCKS))


def warren(density):
    """Pressure of Warren's many-body fluid, A -40, B 25, r_d 0.75, as he fits it (Phys. Rev. E 68, 066702): alpha 0.101, c 4.16, d 18."""
    return density - 0.101 * 40.0 * density ** 2 + 0.202 * 25.0 * 0.75 ** 4 * (density ** 3 - 4.16 * density ** 2 + 18.0)


SLOPE = (-1.5, 2.0, -0.5)  # of a parabola through three points, at the first


def state_verdicts(results):
    """The pressure of DPD, (p - rho)/(a rho^2), against Groot and Warren's 0.101; many-body DPD against Warren's fit."""
    found = []
    for density in (4, 5, 8):
        name, scale = f"dpd-rho{density}", 25.0 * density ** 2
        pair = None
        if name in results:
            value, error = mean_of(results[name].table("pressure")["pressure"], 0.2)
            pair = (value + 1.0 / 216.0 - density) / scale, error / scale
        found.append(fill(Verdict(f"media.state.rho{density}", f"(p − ρkT)/aρ² of DPD, ρ = {density}, a = 25", 0.101,
                                  "Groot and Warren (1997), a fit for high densities: 1 %", 0.001, kind="paper",
                                  reason="the fit is one of high densities"), pair, 0.001))
    pair = None
    if all(name in results for name in ("dpd", "dpd-rho4", "dpd-rho5")):  # a parabola through three densities
        pressures = [mean_of(results[name].table("pressure")["pressure"], 0.2) for name in ("dpd", "dpd-rho4", "dpd-rho5")]
        # kT/V of a momentum that is fixed: the box of ρ = 3 has 125 a0^3, the others 216 a0^3, and the weights add up to 0
        pair = (sum(weight * p for weight, (p, _) in zip(SLOPE, pressures)) + SLOPE[0] / 125.0 - SLOPE[0] / 216.0,
                math.hypot(*(weight * error for weight, (_, error) in zip(SLOPE, pressures))))
    found.append(fill(Verdict("media.state.compressibility", "(1/kT) dp/dρ of DPD at ρ = 3, a = 25", 16.0, "that of water, for which aρ = 75 kT is chosen; 1 %", 0.16,
                              kind="paper"), pair, 0.16))
    pair, density = None, 7
    if "many-rho7" in results:
        value, error = mean_of(results["many-rho7"].table("pressure")["pressure"], 0.3)
        pair = value + 1.0 / 216.0, error
    allowed = 0.05 * warren(density)
    found.append(fill(Verdict("media.many.rho7", "pressure of many-body DPD, ρ = 7, A = −40, B = 25, r_d = 0.75", warren(density),
                              "Warren (2003), his fit; 5 %", allowed, kind="paper"), pair, allowed))
    return found


def verdicts(results):
    return free_verdicts(results) + cold_verdicts(results) + density_verdicts(results) + limit_verdicts(results) + isotropy_verdicts(results) + chain_verdicts(results) + srd_verdicts(results) + state_verdicts(results)


# --- cost -------------------------------------------------------------------------------------------------------------

SIX = (("Langevin", "langevin-N10", 64.0), ("Brownian, no tensor", "none-N10", 6.4), ("Brownian, RPY", "rpy-N10", 6.4),
       ("SRD", "srd-N10", LAGS["srd"]), ("Lowe-Andersen", "la-N10", LAGS["la"]), ("DPD", "dpd-N10", LAGS["dpd"]))
TARGET = 0.05


def costs(results):
    """{medium: (CPU seconds, relative error of D there, CPU seconds to 5 %)} of the chains of ten; errors fall as one over the root of
    the time."""
    found = {}
    for title, name, lag in SIX:
        if name in results and results[name].cpu_seconds > 0.0:
            value, error = at(results[name].table("dynamics-chain"), "D_cumulative", lag)
            found[title] = results[name].cpu_seconds, error / value, results[name].cpu_seconds * (error / value / TARGET) ** 2
    return found


# --- figures ----------------------------------------------------------------------------------------------------------

SHOWS = (("", "flow\nbetween\nvertices", "memory\nof the\nfluid", "tube", "fluid\nthat\nflows"),
         ("Langevin", "no", "no", "yes", "no"), ("Brownian, no tensor", "no", "no", "no", "no"), ("Brownian, RPY", "yes", "no", "no", "no"),
         ("SRD", "yes", "yes", "yes", "yes"), ("Lowe-Andersen", "yes", "yes", "yes", "no"), ("DPD", "yes", "yes", "yes", "no"))
WRONG = 1.0 - 0.1 / 0.28559  # D of a chain of ten without hydrodynamic interactions


def draw_costs(results):
    figure, (left, right) = figures.plain(width=9.2, height=4.3, columns=2)
    for number, (title, (seconds, error, _)) in enumerate(costs(results).items()):
        times = numpy.geomspace(0.01, 1e4, 61)
        falling = error * numpy.sqrt(seconds / times)
        whole = numpy.hypot(falling, WRONG) if title in ("Langevin", "Brownian, no tensor") else falling
        figures.line(left, times, whole, number)
        figures.points(left, seconds, numpy.interp(seconds, times, whole), None, number, label=title)
    left.axhline(TARGET, color=figures.PALE, linewidth=0.8)
    left.set(xscale="log", yscale="log", xlabel="CPU time of one core (s)", ylabel="error of D, of itself", xlim=(0.01, 1e4), ylim=(0.003, 3.0))
    figures.legend(left, loc="lower left")
    right.axis("off")
    cells = right.table(cellText=[row for row in SHOWS], cellLoc="center", loc="center", edges="horizontal", colWidths=[0.4, 0.17, 0.17, 0.12, 0.14],
                        bbox=(0.0, 0.0, 1.0, 1.0))
    cells.auto_set_font_size(False)
    cells.set_fontsize(8.5)
    for (row, column), cell in cells.get_celld().items():
        cell.set_edgecolor("#dddddd")
        cell.get_text().set_color(figures.PALE if cell.get_text().get_text() == "no" else figures.INK)
        if column == 0:
            cell.get_text().set_horizontalalignment("left")
            cell.PAD = 0.02
        if row == 0:
            cell.set_height(2.0 * cell.get_height())
    return figure


REMEMBER = (("SRD", "srd-N10", "srd"), ("Lowe-Andersen", "la-N10", "la"), ("DPD", "dpd-N10", "dpd"))


def draw_memory(results):
    """rho b^3 C against nu t/b^2: one curve for all fluids without sound, in a box without end."""
    figure, panel = figures.plain(width=6.6, height=4.2)
    x = numpy.geomspace(0.02, 20.0, 80)
    figures.theory(panel, x, memory_form(x, 10, 1.0, 1.0), label="frozen chain, no sound, no box")
    for number, (title, name, key) in enumerate(REMEMBER):
        fluid = known(key, results) if name in results else None
        if fluid is None:
            continue
        table, b = results[name].table("memory-chain"), math.sqrt(bond2(key, 10, results))
        density = dilute.PER_CELL if key == "srd" else FLUIDS[key].density
        scaled = fluid.eta / density * table["time"] / b ** 2
        error = noise(table, system(key, 10)[1])
        use = (scaled > 0.0) & (scaled < 3.0) & (table["center"] > 2.0 * error)
        figures.points(panel, scaled[use], density * b ** 3 * table["center"][use], density * b ** 3 * error[use], number, label=title, markersize=3.5)
    panel.set(xscale="log", yscale="log", xlabel="$\\nu t/b^2$", ylabel="$\\rho b^3 C_{cm}(t)$", ylim=(1e-4, 1.0))
    figures.legend(panel)
    return figure


def noise(table, chains):
    """Of C: origins that are one decay of C apart are independent, and C is over three components."""
    c0, step = table["center"][0], table["time"][1]
    decay = max(step, float(numpy.trapz(numpy.maximum(table["center"], 0.0)[:8], table["time"][:8])) / c0)
    return c0 / numpy.sqrt(3.0 * chains * numpy.maximum(table["intervals"], 1.0) * min(1.0, step / decay))
