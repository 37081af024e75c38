"""Chains and rings without width that must not cross: statics of phantoms, and the onset of the tube."""
import math
import pathlib
import random
import string

import numpy
from scipy import special

from lib import dilute, entangled, figures, stats
from lib import semidilute as sd
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "Entangled chains and rings"
PAPER = "not in the paper"

HERE = pathlib.Path(__file__).resolve().parent
STANDARD = {"dt": 0.01, "persistence": 0.5, "series": 1000, "every": 10, "longest_lag": 1310720}
RULES = {"": "true", "-free": "false"}  # end of a run's name -> crossing forbidden
# One density and one chain, of three lengths: vertices -> edge of the box, chains. N_e is 17 bonds.
CHAINS = {384: (16, 112), 96: (8, 56), 48: (8, 112), 24: (8, 224)}
RINGS = {64: (12, 283), 32: (8, 168)}
FIBERS = {"box": 14, "count": 794, "vertices": 24}  # c L^3 = 500 of L = 12, by the paper's count
STIFFNESS = {"1.5": 1.5, "3": 3, "6": 6, "12": 12, "24": 24}  # l_p = L/8 to 2 L
SOLVENT = "solvent: {per_cell: 5, collision_interval: 0.02}"


def bath(rate):
    return f"medium: {{kind: private, rate: {rate}, draw: relax}}"


def filled(name, **values):
    return string.Template((HERE / name).read_text()).substitute({**STANDARD, "bath": bath(1), **values})


def chains(vertices, forbidden, **values):
    box, count = CHAINS[vertices]
    return filled("chains.yaml", **{"box": box, "count": count, "vertices": vertices, "forbidden": forbidden, **values})


def with_frames(scene, every):
    return scene + f"trajectory: {{every: {every}, velocities: false}}\n"


def circles(count, box, seed):
    """Places of circles in parallel planes of their own, centers anywhere."""
    draw = random.Random(seed)
    return "\n".join(f"      - {{center: [{draw.uniform(0, box):.4f}, {draw.uniform(0, box):.4f}, {box * (number + 0.5) / count:.6f}], direction: [0, 0, 1]}}"
                     for number in range(count))


def rings(vertices, forbidden, start, frames, size=None, **values):
    box, count = size or RINGS[vertices]
    return filled("rings.yaml", **{"box": box, "count": count, "vertices": vertices, "forbidden": forbidden, "start": start, "frames": frames,
                                   "places": circles(count, box, vertices), **values})


def campaign():
    found = []
    for number, (end, forbidden) in enumerate(RULES.items()):
        crossed = forbidden == "false"
        # tau_R is 1.4e6 steps.
        found.append(Run("N384" + end, scene=chains(384, forbidden), steps=1310720, seed=4101, hours=0.6 if crossed else 9.0, priority=1,
                         goals=((40960, 0), (81920, 0), (163840, 0), (327680, 1), (655360, 1))))
        found.append(Run("half" + end, scene=chains(384, forbidden, bath=bath(0.5)), steps=40960, seed=4101, hours=0.03 if crossed else 0.3, priority=1,
                         goals=((4096, 0), (8192, 0), (16384, 0))))
        found.append(Run("solvent" + end, scene=chains(384, forbidden, bath=SOLVENT, series=64), steps=2048, seed=4101, hours=0.003 if crossed else 0.02))
        for vertices, steps in (96, 655360), (48, 655360), (24, 81920):
            after = {"after": ("sizes", *entangled.DECILES)} if vertices == 24 else {}
            scene = chains(vertices, forbidden)
            found.append(Run(f"N{vertices}{end}", scene=with_frames(scene, 16384) if after else scene, steps=steps, seed=4102,
                             hours=steps * (3e-7 if crossed else 1e-6), priority=1, goals=tuple(goal for goal in ((40960, 0), (163840, 0)) if goal[0] < steps), **after))
        for vertices, steps, start in (32, 16384, 4096), (64, 65536, 16384):
            found.append(Run(f"rings{vertices}{end}", scene=rings(vertices, forbidden, start, start // 2), steps=steps, seed=4103,
                             hours=steps * vertices * (1e-8 if crossed else 6e-8), priority=0, after=("topology", "links")))
        for word, persistence in STIFFNESS.items():
            found.append(Run(f"lp{word}{end}", steps=8192, seed=4104, hours=0.003 if crossed else 0.02,
                             scene=filled("chains.yaml", forbidden=forbidden, persistence=persistence, **FIBERS)))
    return found + certified(400)


def quick():
    found = []
    for end, forbidden in RULES.items():
        found.append(Run("N24" + end, scene=chains(24, forbidden, box=6, count=94, series=100), steps=3072, seed=4102, hours=0.001))
        found.append(Run("rings32" + end, scene=rings(32, forbidden, 256, 512, size=(6, 40)), steps=1024, seed=4103, hours=0.0005,
                         after=("topology", "links")))
    return found + certified(100)


def certified(steps):
    """Frames of every step, of chains in a box that is smaller than those of the other runs."""
    return [Run("certified" + end, scene=with_frames(chains(24, forbidden, box=6, count=94, series=1), 1), steps=steps, seed=4105, hours=0.0003,
                after=("topology", "crossings")) for end, forbidden in RULES.items()]


def runs(tier):
    return quick() if tier == "quick" else campaign()


# --- what runs say ----------------------------------------------------------------------------------------------------

N_E = entangled.entanglement()  # bonds
ALLOWED = 0.17  # of g_1 in a tube: 20 % of the curve's c_xi are 35 % of N_e, and g_1 grows as its root
# Of g_1 of chains that may cross, by Gaussian bonds of the same second moments, from 12.8 t0 on. That theory is exact at long times and at
# the shortest; in between, at 1 t0, where bonds of nearly fixed length turn, it is 15 % too large.
LINEAR = 0.05
EARLY = 0.1  # t0: the first lag
CELLS = 2.0 / 3.0 / 0.02  # at which SRD of many members forgets a velocity, per t0; 9 % of it is that of the cell, which stays, and moves the ratio by 0.003
SPANS = {"4": (51.2, 204.8), "15": (204.8, 819.2), "60": (819.2, 3276.8)}  # t/tau_e -> two lags of the long chains, t0
FRICTIONS = (12.8, 51.2)  # t0 at Gamma = 1, where no chain feels its ends yet; at Gamma = 1/2 half as long
DIFFUSING = 3.0  # tau_R from which on D is taken


def tau_e(rate=1.0):
    return entangled.rouse_time(N_E, entangled.MASS * rate)


def curve(results, name):
    return sd.table(results.get(name), "dynamics-chain")


def share(results, name, column, time, base=None):
    """(ratio, error) of chains that must not cross to those that may, at a lag; None without both."""
    one, other = sd.at(curve(results, name), column, time), sd.at(curve(results, (base or name) + "-free"), column, time)
    return dilute.over(one, other) if one and other else None


def shares(results, name, column="g_middle"):
    """(t, ratio, error) at all lags that both runs have."""
    one, other = curve(results, name), curve(results, name + "-free")
    if one is None or other is None:
        return numpy.zeros((3, 0))
    found = [(t, *share(results, name, column, t)) for t in one["time"] if sd.at(other, column, t)]
    return numpy.array(found).T


def contact_rate(result):
    """(contacts per vertex and t0, error) of chains that must not cross."""
    rows = result.table("collisions")["rate_per_vertex"][1:] if result is not None and result.exists else []
    return stats.average(rows) if len(rows) >= stats.LEAST_BLOCKS else None


def crossing_rate(result, chain=24):
    """The same of crossings, from frames of every step."""
    if result is None or not result.exists or "topology" not in result.tables():
        return None
    table = result.table("topology")
    vertices = table["bonds"][0] * chain / (chain - 1)
    value, error = stats.average(table["crossings"])
    interval = table["time"][1] - table["time"][0]
    return value / vertices / interval, error / vertices / interval


def size(result, column):
    table = result.table("statics-chain") if result is not None and result.exists else None
    return (float(table[column][0]), float(table[column + "_error"][0])) if table else None


# --- verdicts ---------------------------------------------------------------------------------------------------------

def static_verdicts(results, tier):
    lengths = (24,) if tier == "quick" else (24, 48, 96)
    found = [dilute.held(f"entangled.{word}.N{n}", f"⟨{symbol}²⟩ of chains of {n} that must not cross, over that of chains that may", 1.0,
                         "exact: lines exclude no volume, so that statics are those of phantoms", sd.over(size(results.get(f"N{n}"), column), exact(n)), 0.0,
                         must_see=None if tier == "quick" else 0.25)
             for n in lengths for word, symbol, column, exact in (("size", "R", "Ree2", entangled.end_to_end), ("gyration", "R_g", "Rg2", entangled.gyration))]
    if tier == "campaign":
        found += [dilute.scatter(f"entangled.distances{end}", "end-to-end distances of chains of 24 in ten ranges that are equally probable for ideal chains, "
                                 + ("crossing free" if end else "crossing forbidden"), distances(results.get("N24" + end))) for end in RULES]
    rate, crossings = contact_rate(results.get("N24")), crossing_rate(results.get("certified-free"))
    return found + [
        dilute.held("entangled.contacts", "contacts of chains that must not cross, over crossings of the same chains if they may", 1.0,
                    "equal flux through the surface of contact in equilibrium; crossings by uncross topology, frames of every step",
                    dilute.over(rate, crossings) if rate and crossings else None, 0.0, must_see=0.5),
        crossing_verdict(results)]


def distances(result):
    """p of chi^2 of ten shares of 1/10 that add up to 1."""
    if result is None or "sizes" not in result.tables():
        return None
    table = result.table("sizes")
    return float(special.chdtrc(len(table["share"]) - 1, (((table["share"] - 0.1) / table["share_error"])**2).sum() * 0.9))


def crossing_verdict(results):
    """Of the run that must not cross: any crossing, or pair that touched, would be one too many."""
    result = results.get("certified")
    table = result.table("topology") if result is not None and "topology" in result.tables() else None
    crossings = crossing_rate(results.get("certified-free"))
    possible = f"; the same chains, if they may, have {crossings[0] * table['bonds'][0] * 24 / 23 * table['time'][-1]:.0f} in this time" if table and crossings else ""
    return Verdict("entangled.crossings", f"crossings and touches from step to step{possible}", 0.0, "uncross topology, frames of every step", 0.5,
                   float((table["crossings"] + table["touched"]).sum()) if table else None, detects=1.0)


def early_verdicts(results, tier):
    """An elastic contact of thermal bonds changes velocities by sum M dv^2 = 4 a^2/c, a the speed of approach and c the inverse mass.
    a has the weight a exp(-a^2/2ckT), so the mean is 8 kT, whatever the levers are. Energy is kept: sum M v.dv = -4 kT. So
    contacts make velocities forget at the rate 4/3 per contact of a vertex: Gamma_c = (4/3) nu."""
    found = []
    for name, words, friction, bound in (("N24", "chains of 24", 1.0, 0.003), ("N384", "chains of 384", 1.0, 0.003), ("solvent", "chains of 384 in SRD", CELLS, 0.006)):
        if tier == "quick" and name != "N24":
            continue
        rate, expected, known = contact_rate(results.get(name)), 1.0, 0.0
        if rate:
            own, known = 4.0 / 3.0 * rate[0], 4.0 / 9.0 * rate[1] * EARLY
            expected = kept((friction + own) * EARLY) / kept(friction * EARLY)
        found.append(dilute.held(f"entangled.early.{name}", f"mean square displacement at {EARLY} t0, crossing forbidden over free, {words}", expected,
                                 "contacts forget velocities at 4/3 of their rate per vertex", share(results, name, "g", EARLY) if rate else None, bound, known))
    return found


def kept(x):
    """2 (x - 1 + exp -x)/x^2: what a friction leaves of the ballistic displacement."""
    return 2.0 * (x + math.expm1(-x)) / x**2


def free_verdicts(results, tier):
    lengths = {24: (12.8,)} if tier == "quick" else {24: (12.8, 102.4), 384: (12.8, 102.4, 409.6)}
    return [dilute.held(f"entangled.free.N{n}.{t:g}", f"mean square displacement at {t:g} t0 of chains of {n} that may cross, over linear theory", 1.0,
                        "Gaussian bonds of the same second moments, with inertia", sd.over(sd.at(curve(results, f"N{n}-free"), "g" if tier == "quick" else "g_middle", t),
                        float(entangled.displacement(t, n, where="all" if tier == "quick" else "middle")[0])), LINEAR)
            for n, times in lengths.items() for t in times]


def onset_verdicts(results):
    found = []
    for n, word in [(384, word) for word in SPANS] + [(96, "4")]:
        (first, last), name = SPANS[word], word if n == 384 else f"N{n}"
        one, other = (sd.at(curve(results, f"N{n}"), "g_middle", t) for t in (first, last))
        exact = entangled.displacement([first, last], n)
        free = math.log(exact[1] / exact[0]) / math.log(last / first)
        found.append(dilute.held(f"entangled.exponent.{name}", f"local exponent of g_1 at {word} τ_e, chains of {n}, crossing forbidden (free: {free:.3f})", 0.25,
                                 "a tube that stands: t^(1/4) from τ_e to τ_R", exponent(one, other, last / first), 0.0, kind="paper", rival=free, reason=ONSET))
        square = float(entangled.tube_line(last, N_E) / entangled.rouse_line(last))
        found.append(dilute.held(f"entangled.tube.{name}", f"g_1 of chains of {n} at {last / tau_e():.0f} τ_e, crossing forbidden over free", square,
                                 "(0.35 τ_e/t)^(1/4), N_e = 17 by the curve of Uchida, Grest and Everaers from memory: 17 %",
                                 share(results, f"N{n}", "g_middle", last), ALLOWED * square, kind="paper", rival=1.0, reason=ONSET))
    return found


ONSET = "An onset, and an earlier one than the curve has: contacts slow these chains from 1 t0 on."


def exponent(one, other, span):
    """(exponent, error) of two values (value, error)."""
    if not one or not other:
        return None
    return math.log(other[0] / one[0]) / math.log(span), math.hypot(one[1] / one[0], other[1] / other[0]) / math.log(span)


def scaling_verdicts(results):
    found = []
    for t in FRICTIONS:
        one, other = share(results, "half", "g_middle", t / 2), share(results, "N96", "g_middle", t)
        found.append(dilute.held(f"entangled.friction.{t:g}", f"g_1, crossing forbidden over free, of chains of 384 at half the friction and {t / 2:g} t0, over chains of 96 at {t:g} t0",
                                 1.0, "time in units of the bath's friction", dilute.over(one, other) if one and other else None, 0.0, kind="paper", must_see=0.5,
                                 reason="Contacts are a friction of their own, which does not halve with the bath's: by 4/3 of their rate, 0.85."))
    for n, t in ((96, 102.4), (24, 25.6)):
        one, other = share(results, f"N{n}", "g_middle", t), share(results, "N384", "g_middle", t)
        found.append(dilute.held(f"entangled.length.N{n}", f"g_1, crossing forbidden over free, of chains of {n} (Z = {(n - 1) / N_E:.1f}) over chains of 384, {t / tau_e():.1f} τ_e",
                                 1.0, "a segment does not feel the ends before τ_R", dilute.over(one, other) if one and other else None, 0.0, kind="paper",
                                 reason="Ends let a short chain go."))
    for n in (24, 48):
        lag = next(0.1 * 2**k for k in range(30) if 0.1 * 2**k >= DIFFUSING * entangled.rouse_time(n - 1))
        rate = contact_rate(results.get(f"N{n}"))
        slow, known = (1.0 / (1.0 + 4.0 / 3.0 * rate[0]), 4.0 / 3.0 * rate[1] / (1.0 + 4.0 / 3.0 * rate[0])**2) if rate else (1.0, 0.0)
        for end, kind, expected, error, source in (("-free", "gate", 1.0, 0.0, "Rouse"), ("", "paper", slow, known, "Rouse, and contacts as a friction of 4/3 of their rate")):
            pair = sd.over(sd.at(curve(results, f"N{n}{end}"), "D_cumulative", lag), 1.0 / (n * entangled.MASS))
            found.append(dilute.held(f"entangled.D.N{n}{end}", f"D N ζ/kT of chains of {n} (Z = {(n - 1) / N_E:.1f}), crossing {'free' if end else 'forbidden'}, {lag:.0f} t0", expected,
                                     source, pair if end or rate else None, 0.0, error, kind=kind, must_see=0.5, rival=None if end else 1.0,
                                     reason="" if end else "Contacts are not independent of each other: chains meet the same neighbors again."))
    return found


def fiber_height(results, word):
    """(d^2, error) in the middle third where it is half of that of fibers that may cross; None if it never is."""
    t, ratio, error = shares(results, f"lp{word}", "d2_third")
    below = numpy.flatnonzero(ratio < 0.5)
    if not len(below) or below[0] == 0:
        return None
    k = below[0]
    slope = math.log(ratio[k] / ratio[k - 1])
    at = math.log(0.5 / ratio[k - 1]) / slope
    ends = [sd.at(curve(results, f"lp{word}"), "d2_third", lag) for lag in t[k - 1:k + 1]]
    growth = math.log(ends[1][0] / ends[0][0])
    height = ends[0][0] * math.exp(at * growth)
    return height, height * math.hypot(ends[1][1] / ends[1][0], growth / slope * error[k] / ratio[k])


def fiber_verdicts(results):
    xi = sd.mesh_size(FIBERS["count"], 12.0, FIBERS["box"])
    found = []
    for word, persistence in STIFFNESS.items():
        if persistence >= 6:
            width = 2.0 * sd.tube_width(xi, 12.0, persistence)**2
            found.append(dilute.held(f"entangled.fibers.{word}", f"d² where it is half of that of fibers that may cross, over 2 L⊥², l_p = {word} a0, L = 12 a0", 1.0,
                                     "Eq. (35), a theory of scaling known to 40 %", sd.over(fiber_height(results, word), width), 0.4, kind="paper",
                                     reason="The theory is one of scaling, and this height is a convention; the power of l_p is that of the theory."))
    return found


def ring_verdicts(results, tier):
    found = []
    for n in (32,) if tier == "quick" else RINGS:
        tables = {end: results[f"rings{n}{end}"].table("topology") if f"rings{n}{end}" in results and "topology" in results[f"rings{n}{end}"].tables() else None for end in RULES}
        table, free = tables.values()
        words = f"; of those that may cross, {free['linked'][-1]:.0f} in {free['pairs'][-1]:.0f} pairs within reach" if free else ""
        found.append(Verdict(f"entangled.links.N{n}", f"linked pairs and knots of rings of {n} that must not cross, in all frames{words}", 0.0,
                             "rings that start unlinked stay so; uncross topology: linking numbers and Alexander's polynomial", 0.5,
                             float((table["linked"] + table["knots"]).sum()) if table and free and free["linked"][-1] > 0 else None, detects=1.0))
        if tier == "quick":
            continue
        for word, symbol, column, exact in (("size", "R", "Ree2", None), ("gyration", "R_g", "Rg2", entangled.ring_gyration(n))):
            if exact:
                found.append(dilute.held(f"entangled.rings.free.N{n}", f"⟨{symbol}²⟩ of rings of {n} that may cross, over (N² − 1) b²/12N", 1.0,
                                         "Gaussian rings; bends and bonds change it in order 1/N", sd.over(ring_size(results, f"rings{n}-free"), exact), 1.0 / n, must_see=0.5))
        one, other = ring_size(results, f"rings{n}"), ring_size(results, f"rings{n}-free")
        found.append(dilute.held(f"entangled.rings.N{n}", f"⟨R_g²⟩ of unlinked rings of {n} ({n / N_E:.1f} N_e) over that of rings that may cross", 1.0,
                                 "phantoms from the same start", dilute.over(one, other) if one and other else None, 0.0, kind="paper",
                                 reason="Rings that are unlinked and unknotted have another size than all rings together."))
    return found


def ring_size(results, name):
    """(<R_g^2>, error) of the frames of the second half; Moving if its two halves differ by more than their errors."""
    result = results.get(name)
    if result is None or "topology" not in result.tables():
        return None
    table = result.table("topology")
    late = table["time"] > table["time"][-1] / 2 * 1.001
    value, error = table["Rg2"][late], table["Rg2_error"][late]
    first, second = (part.mean() for part in numpy.array_split(value, 2))
    each = math.sqrt(float((error**2).mean()))
    mean = float(value.mean())
    if abs(second - first) > stats.SIGMAS * math.sqrt(2.0) * each:
        mean = stats.Moving(mean, f"it still moves: {first:.4g} in the first half of the frames, {second:.4g} in the second", abs(second - first) / (first + second))
    return mean, each  # frames of one run are taken as one: rings are the independent samples


# --- figures ----------------------------------------------------------------------------------------------------------

LENGTH_RUNS = (("N384", 384, 1.0, "N = 384"), ("half", 384, 0.5, "N = 384, half the friction"), ("N96", 96, 1.0, "N = 96"), ("N48", 48, 1.0, "N = 48"), ("N24", 24, 1.0, "N = 24"))


def draw_onset(results):
    figure, axes, below = figures.with_residuals(height=6.4, share=0.6)
    for number, (name, rate, label) in enumerate((("N384", 1.0, "N = 384, crossing forbidden"), ("N384-free", 1.0, "N = 384, free"), ("half", 0.5, "N = 384, forbidden, half the friction"),
                                                 ("N96", 1.0, "N = 96, forbidden"))):
        columns, unit = curve(results, name), tau_e(rate)
        if columns is None:
            continue
        keep = columns["time"] > 2.0 / rate
        figures.points(axes, columns["time"][keep] / unit, columns["g_middle"][keep], columns["g_middle_error"][keep], number, label=label, markersize=3.5)
        t, found, errors = sd.exponents(columns, "g_middle")
        keep = (t > 4.0 / rate) & (errors < 0.15)
        figures.points(below, t[keep] / unit, found[keep], errors[keep], number, markersize=3.5)
    span = curve(results, "N384-free")
    times = numpy.geomspace(2.0, span["time"][-1] if span is not None else 1e4, 120)
    exact = entangled.displacement(times, 384)
    figures.theory(axes, times / tau_e(), exact, label="linear theory, free")
    middle = numpy.sqrt(times[1:] * times[:-1])
    figures.theory(below, middle[middle > 8.0] / tau_e(), (numpy.diff(numpy.log(exact)) / numpy.diff(numpy.log(times)))[middle > 8.0])
    late = times[times > 0.35 * tau_e()]
    figures.theory(axes, late / tau_e(), entangled.tube_line(late, N_E), linestyle="--", label="a tube that stands, $N_e$ = 17")
    below.axhline(0.25, color=figures.INK, linewidth=0.9, linestyle="--")
    axes.set(xscale="log", yscale="log", ylabel="$g_1$ ($a_0^2$)")
    below.set(xlabel="$t/\\tau_e$", ylabel="local exponent", ylim=(0.0, 1.0))
    figures.legend_above(axes)
    return figure


def draw_lengths(results):
    figure, axes = figures.plain()
    longest = 1.0
    for number, (name, _, rate, label) in enumerate(LENGTH_RUNS):
        t, ratio, error = shares(results, name)
        keep = (t > 0.2) & (error < 0.25 * ratio)
        if keep.any():
            figures.points(axes, t[keep] / tau_e(rate), ratio[keep], error[keep], number, label=label, linestyle="-", linewidth=0.7, markersize=3.5)
            longest = max(longest, t[keep][-1] / tau_e(rate))
    times = numpy.geomspace(0.35, longest, 50)
    figures.theory(axes, times, (math.pi / 9.0 / times)**0.25, linestyle="--", label="$(0.35\\,\\tau_e/t)^{1/4}$")
    axes.set(xscale="log", xlabel="$t/\\tau_e$", ylabel="$g_1$, crossing forbidden over free", ylim=(0.0, 1.1))
    figures.legend_above(axes, columns=3)
    return figure


def draw_fibers(results):
    figure, (left, right) = figures.plain(columns=2, height=3.6)
    for number, word in enumerate(STIFFNESS):
        t, ratio, error = shares(results, f"lp{word}", "d2_third")
        if len(t):
            figures.points(left, t, ratio, error, number, label=f"$l_p$ = {word}", linestyle="-", linewidth=0.7, markersize=3.5)
        pair = fiber_height(results, word)
        if pair:
            figures.points(right, STIFFNESS[word], pair[0], pair[1], number)
    xi = sd.mesh_size(FIBERS["count"], 12.0, FIBERS["box"])
    lengths = numpy.geomspace(6.0, 24.0, 20)
    figures.theory(right, lengths, [2.0 * sd.tube_width(xi, 12.0, length)**2 for length in lengths], label="2 $L_\\perp^2$, Eq. (35)")
    left.axhline(0.5, color=figures.PALE, linewidth=0.8)
    left.set(xscale="log", xlabel="$t/t_0$", ylabel="$d^2$, crossing forbidden over free", ylim=(0.0, 1.1))
    right.set(xscale="log", xlabel="$l_p$ ($a_0$)", ylabel="$d^2$ at one half ($a_0^2$)", ylim=(0.0, None))
    figures.legend_above(left, right)
    return figure


def draw_rings(results):
    figure, axes = figures.plain(height=3.6)
    number = 0
    for n in RINGS:
        for end, words in (("", "crossing forbidden"), ("-free", "free")):
            result = results.get(f"rings{n}{end}")
            if result is not None and "topology" in result.tables():
                table, unit = result.table("topology"), entangled.rouse_time(n) / 4.0
                figures.points(axes, table["time"] / unit, table["Rg2"] / entangled.ring_gyration(n), table["Rg2_error"] / entangled.ring_gyration(n), number,
                               label=f"N = {n}, {words}", linestyle="-", linewidth=0.7)
            number += 1
    axes.axhline(1.0, color=figures.INK, linewidth=0.9)
    axes.set(xlabel="t over the ring's Rouse time", ylabel="$R_g^2$ over that of Gaussian rings", ylim=(0.0, None))
    figures.legend_above(axes)
    return figure


def pictures(results, tier):
    if tier == "quick":
        return []
    made = [("onset", "g₁(t), the mean square displacement of the middle vertex of chains of 384 (Z = 22) and of 96 (Z = 5.6), and below its local exponent, over a factor of 4 in t. "
             "Full line: linear theory of chains that may cross, nothing fitted. Broken: a tube that stands, width √N_e b, exponent 1/4; N_e = 17 by a formula from memory.", draw_onset),
            ("lengths", "g₁ of chains that must not cross over that of chains that may, from the same starts, at equal t/τ_e: three other lengths (Z = 5.6, 2.8, 1.3), and half the friction. "
             "Broken: where the lines of Rouse and of a tube that stands meet.", draw_lengths),
            ("fibers", "Fibers of L = 12 a0 at c L³ = 500, l_p = L/8 to 2 L. Left: d² (middle third) over that of fibers that may cross. Right: d² where this is one half.", draw_fibers),
            ("rings", "R_g² of rings that start as circles in parallel planes, unlinked and unknotted. Those that must not cross stay so.", draw_rings)]
    return [Figure(name, caption, lambda draw=draw: draw(results)) for name, caption, draw in made]


def told(results):
    lines = [f"τ_e is {tau_e():.1f} t0 at Γ = 1, by N_e = {N_E:.0f} bonds; τ_R of chains of 384 is {entangled.rouse_time(383):.0f} t0. The long run has reached {results['N384'].time:.0f} t0."
             ] if "N384" in results else []
    rows = []
    for name, n, _, label in LENGTH_RUNS:
        one, other = contact_rate(results.get(name)), sd.at(curve(results, name), "g_middle", 25.6)
        if one and other:
            rows.append(f"{label}: {one[0]:.3f} contacts per vertex and t0")
    return "\n\n".join([*lines, "; ".join(rows) + "." if rows else ""])


def evaluate(results, tier):
    found = static_verdicts(results, tier) + early_verdicts(results, tier) + free_verdicts(results, tier) + ring_verdicts(results, tier)
    if tier == "campaign":
        found += onset_verdicts(results) + scaling_verdicts(results) + fiber_verdicts(results)
    return Outcome(found, pictures(results, tier), PROSE + told(results))


PROSE = """Chains of bonds of 0.54 a0 with l_p = 0.5 a0, 10.5 bonds per a0³, in a private bath. They have no width: what they may not do is cross, and this changes motion, not statics.
Every curve has a control, the same chains from the same starts with the same random numbers, crossing allowed.

"""
