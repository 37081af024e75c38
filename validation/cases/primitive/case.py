"""Primitive paths of chains without width: known ones, and those of entangled chains from loose coils to tight stiff fibers."""
import csv
import math

import numpy

from lib import figures, primitive, stats
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "Primitive paths"
PAPER = "not in the paper"

# name: box, chains, vertices, l0, k, l_p, seed, LEAST, MOST, mobile, time of a held tube, hours (measure/primitive.py); cheapest and sharpest first.
# Of coils LEAST is the first spring that counts.
POINTS = {
    "stiff-962": (24, 340, 64, 0.5, 100, 16, 4106, 90, 270, 40, 100, 0.05),
    "coil-13": (5, 45, 64, 0.5, 100, 0.5, 4101, 90, 810, 0, 0, 0.03),
    "stiff-552": (15, 98, 128, 0.5, 100, 8, 4105, 90, 270, 14, 100, 0.04),
    "coil-6": (8, 34, 160, 0.5, 100, 0.5, 4102, 90, 810, 0, 0, 0.04),
    "stiff-3906": (24, 340, 64, 0.5, 100, 32, 4107, 90, 270, 40, 100, 0.03),
    "coil-3": (12, 27, 320, 0.5, 100, 0.5, 4103, 90, 810, 0, 0, 0.05),
    "stiff-97": (6, 42, 64, 0.5, 100, 2, 4108, 90, 270, 8, 100, 0.02),
    "stiff-125": (12, 97, 64, 0.5, 100, 4, 4109, 90, 270, 16, 100, 0.02),
    "coil-2": (14, 19, 512, 0.5, 100, 0.5, 4104, 90, 810, 0, 0, 0.06),
    "coil-13-fine": (5, 45, 128, 0.25, 400, 0.5, 4110, 270, 2430, 0, 0, 0.08),
    "coil-6-again": (8, 34, 160, 0.5, 100, 0.5, 4111, 90, 810, 0, 0, 0.04),
}
KNOWN = {"posts": "a ring about two posts, over twice their distance", "links": "two linked rings, each pinned at its far end, over what symmetry says",
         "lattice": "a chain in a lattice of posts, over its polygon"}
SOFT = 1e-3  # of contacts
ALLOWED = 0.2  # of c_xi, by three melts
OF_TUBE = 0.2  # of sigma: 0.31 and 0.32 are two values of the prefactor, and fibers here are 2 to 4 persistence lengths of their tube


def runs(tier):
    found = [Run("known", program=["known.py", 4120], hours=0.004)]
    if tier == "campaign":
        found += [Run(name, program=["primitive.py", *point[:-1]], hours=point[-1], priority=number // 3) for number, (name, point) in enumerate(POINTS.items())]
    return found


# --- what runs say ----------------------------------------------------------------------------------------------------

def tables(text, names=("stages", "chains", "profile", "held")):
    """The tables of a run: name -> column -> array."""
    found, name = {}, ""
    for line in text.splitlines():
        if line in names:
            name, found[line] = line, []
        elif name:
            found[name].append(line)
    made = {}
    for name, lines in found.items():
        rows = list(csv.reader(lines))
        made[name] = {head: numpy.array([float(row[n]) for row in rows[1:]]) for n, head in enumerate(rows[0])}
    return made


def known(results):
    """path -> (L/L_0 at rest, error, rows)."""
    if "known" not in results or not results["known"].exists:
        return {}
    rows, found = list(csv.DictReader(results["known"].text.splitlines())), {}
    for path in KNOWN:
        own = [row for row in rows if row["path"] == path]
        value, error = primitive.at_rest([float(r["k"]) for r in own], [float(r["L"]) for r in own], [float(r["error"]) for r in own])
        exact = float(own[0]["exact"])
        found[path] = value / exact, error / exact, own
    return found


class Point:
    """A point of the campaign: what its tables say."""

    def __init__(self, name, text):
        box, self.chains, self.vertices, rest, spring, self.persistence, _, self.least, *_ = POINTS[name]
        self.name, self.bonds, self.mean = name, self.vertices - 1, primitive.moments(rest, spring)[0]
        self.rho = self.chains * self.bonds * self.mean / box**3
        self.square, self.kuhn = primitive.coil(self.bonds, rest, spring, self.persistence)
        self.x = self.rho * self.kuhn**2
        self.tables = tables(text)
        self.stages = self.tables["stages"]
        self.counted = self.stages["k"] >= self.least

    @property
    def is_coil(self):
        return self.name.startswith("coil")

    def lengths(self):
        """[chains] L_pp at 1/k = 0: of each chain the parabola through the springs that count."""
        k = self.stages["k"][self.counted]
        rows = numpy.array([self.tables["chains"][f"L{spring:g}"] for spring in k])
        return numpy.array([primitive.at_rest(k, column, numpy.full(len(k), 1.0))[0] for column in rows.T])

    def strand(self):
        """(L_e, error): modified S-coil, with the exact <R^2>, in a0 of contour."""
        ratio, error = primitive.known_square(self.lengths(), self.tables["chains"]["R2"], self.square)
        bonds = self.bonds / (ratio - 1.0)
        return bonds * self.mean, bonds * self.mean * error / (ratio - 1.0)

    def width(self, table="held", column="mean"):
        """(sigma, error) of chains in a held tube about the mean of their places; or of the start about the path (chains, sigma2). Without a fifth of
        the vertices at each end; chains are the samples."""
        sigma2 = self.tables[table][column]
        value, error = sigma2.mean(), sigma2.std(ddof=1) / math.sqrt(len(sigma2))
        return math.sqrt(value), 0.5 * error / math.sqrt(value)

    def deflection(self, *which):
        """(L_d, error) from sigma^2 = L_d^3/(8 l_p)."""
        sigma, error = self.width(*which)
        value = (8.0 * self.persistence * sigma**2) ** (1.0 / 3.0)
        return value, value * 2.0 / 3.0 * error / sigma


def points(results):
    found = {name: Point(name, results[name].text) for name in POINTS if name in results and results[name].exists}
    return {name: point for name, point in found.items() if "chains" in point.tables}


def network(found):
    """Verdicts of the campaign's points."""
    made = []
    for name in POINTS:
        point = found.get(name)
        if name.startswith("coil") and "-" not in name.removeprefix("coil-"):
            made.append(coil_verdict(name, point))
    coils = [p for n, p in found.items() if p.is_coil and "-" not in n.removeprefix("coil-")]
    made.append(loose_verdict(coils))
    made.append(fine_verdict(found.get("coil-13"), found.get("coil-13-fine")))
    made += [width_verdict(name, found.get(name)) for name in ("stiff-552", "stiff-962", "stiff-3906")]
    made.append(tight_verdict([p for p in found.values() if not p.is_coil]))
    for name in ("stiff-552", "stiff-962"):
        made += tube_verdicts(name, found.get(name))
    return made


def coil_verdict(name, point):
    statement = f"L_e/l_K by primitive paths over the curve, {name.removeprefix('coil-')} = ρ l_K², rounded"
    source = "Uchida, Grest and Everaers 2008, from memory; 20 % of c_xi"
    if point is None:
        return Verdict(f"primitive.length.{name.removeprefix('coil-')}", statement, 1.0, source, ALLOWED, kind="paper")
    value, error = point.strand()
    curve = float(primitive.uchida(point.x)) * point.kuhn
    allowed = abs(float(primitive.uchida(point.x / (1.0 + ALLOWED)) / primitive.uchida(point.x)) - 1.0)
    return Verdict(f"primitive.length.{name.removeprefix('coil-')}", statement, 1.0, source, stats.tolerance(error / curve, systematic=allowed), value / curve, error / curve, kind="paper",
                   reason="the curve is from memory; and where a strand has few bonds, they are longer than half the mesh")


def loose_verdict(coils):
    statement, source = "exponent of L_e/l_K in ρ l_K², loose coils", "the curve's own mean exponent there, from memory; rival −4/3: a fixed number of contacts per a³"
    if len(coils) < 3:
        return Verdict("primitive.exponent.loose", statement, -1.74, source, 0.2, kind="paper", rival=-4.0 / 3.0)
    strands = [p.strand() for p in coils]
    fit = stats.power([p.x for p in coils], [value / p.kuhn for (value, _), p in zip(strands, coils)], [error / p.kuhn for (_, error), p in zip(strands, coils)])
    curve = stats.power([p.x for p in coils], [float(primitive.uchida(p.x)) for p in coils], [error / p.kuhn for (_, error), p in zip(strands, coils)])
    return Verdict("primitive.exponent.loose", statement, float(curve.value[1]), source, stats.tolerance(float(fit.error[1])), float(fit.value[1]), float(fit.error[1]), kind="paper",
                   rival=-4.0 / 3.0)


def fine_verdict(coarse, fine):
    statement, source = "L_e with bonds of half the length over L_e, ρ l_K² = 13", "vertices per strand do not matter; 2 %"
    if coarse is None or fine is None:
        return Verdict("primitive.bonds", statement, 1.0, source, 0.02, kind="paper")
    (a, da), (b, db) = coarse.strand(), fine.strand()
    error = b / a * math.hypot(da / a, db / b)
    return Verdict("primitive.bonds", statement, 1.0, source, stats.tolerance(error, systematic=0.02), b / a, error, kind="paper")


def width_verdict(name, point):
    at = name.removeprefix("stiff-")
    statement, source = f"σ in a held tube over 0.32 ξ^(6/5) l_p^(−1/5), ρ l_K² = {at}", "Hinsch, Wilhelm and Frey, cond-mat/0703096; 20 %"
    if point is None or "held" not in point.tables:
        return Verdict(f"primitive.width.{at}", statement, 1.0, source, OF_TUBE, kind="paper")
    (value, error), theory = point.width(), primitive.hinsch(point.rho, point.persistence)
    return Verdict(f"primitive.width.{at}", statement, 1.0, source, stats.tolerance(error / theory, systematic=OF_TUBE), value / theory, error / theory, kind="paper")


def tight_verdict(stiff):
    statement, source = "exponent of L_d/l_K in ρ l_K², stiff fibers, held tubes", "−2/5: binary collisions (Morse); rival −1/3: effective medium"
    stiff = [p for p in stiff if "held" in p.tables]
    if len(stiff) < 3:
        return Verdict("primitive.exponent.tight", statement, -0.4, source, 0.03, kind="paper", rival=-1.0 / 3.0)
    found = [p.deflection() for p in stiff]
    fit = stats.power([p.x for p in stiff], [value / p.kuhn for (value, _), p in zip(found, stiff)], [error / p.kuhn for (_, error), p in zip(found, stiff)])
    error = float(fit.error[1]) * max(1.0, math.sqrt(fit.chi2 / max(fit.freedom, 1)))
    return Verdict("primitive.exponent.tight", statement, -0.4, source, stats.tolerance(error), float(fit.value[1]), error, kind="paper", rival=-1.0 / 3.0)


def tube_verdicts(name, point):
    """The same chains in a tube that is held: d^2 of two times against the width about the mean, and the static width against that."""
    at = name.removeprefix("stiff-")
    said = {"plateau": (f"held tube: a quarter of d² over σ² about the mean places, ρ l_K² = {at}", "two fluctuating places; 1 where the plateau is reached"),
            "static": (f"σ of the start about the path over σ in the held tube, ρ l_K² = {at}", "1, if a path that moves its obstacles and a tube that is held say the same")}
    if point is None or "held" not in point.tables:
        return [Verdict(f"primitive.tube.{kind}.{at}", *words[:1], 1.0, words[1], 0.1, kind="paper") for kind, words in said.items()]
    held = point.tables["held"]
    made = []
    for kind, top, bottom, power, allowed in (("plateau", "d2", "mean", 1.0, 0.1), ("static", "path", "mean", 0.5, 0.1)):
        value, error = stats.jackknife(numpy.stack([held[top], held[bottom]], axis=1), lambda mean, power=power: (mean[0] / mean[1]) ** power)
        made.append(Verdict(f"primitive.tube.{kind}.{at}", said[kind][0], 1.0, said[kind][1], stats.tolerance(float(error), systematic=allowed), float(value), float(error), kind="paper",
                            reason="without bending a path straightens over more than a deflection length, and draws its obstacles along" if kind == "static" else ""))
    return made


def evaluate(results, tier):
    verdicts, found = [], known(results)
    for path, statement in KNOWN.items():
        value, error, _ = found.get(path, (None, 0.0, None))
        tolerance = stats.tolerance(error, systematic=0.001) if value is not None else 0.01
        verdicts.append(Verdict(f"primitive.{path}", f"length at 1/k = 0 of {statement}", 1.0, "geometry", tolerance, value, error))
    rows = [row for _, _, own in found.values() for row in own]
    hits = sum(int(row["contacts"]) for row in rows)
    soft = sum(int(row["softened"]) + int(row["rigid"]) for row in rows) / hits if hits else None
    verdicts.append(Verdict("primitive.softened", "contacts of these paths that were softened or rigid, of all", 0.0, "a bounce is resolved: dt ≤ 0.2 M v/f", SOFT, soft, 0.0))
    if tier == "quick":
        return Outcome(verdicts)
    made = points(results)
    return Outcome(verdicts + network(made), shown(made) if made else [], prose(made))


def prose(made):
    lines = []
    for point in made.values():
        used = point.counted
        hits, soft, rigid = (point.stages[name][used].sum() for name in ("contacts", "softened", "rigid"))
        lines.append(f"`{point.name}`: x = {point.x:.4g}; {hits:.3g} contacts at the springs that count, of which {soft / hits:.2g} were softened and {rigid:g} rigid; "
                     f"the last quarter of the last run differs from the one before by {100 * point.stages['drift'][-1]:.2f} %.")
    return "\n\n".join(lines)


def shown(made):
    coils = [p for p in made.values() if p.is_coil]
    stiff = [p for p in made.values() if not p.is_coil]
    tubes = [p for p in stiff if "held" in p.tables]

    def curve():
        figure, panel = figures.plain(width=5.5, height=4.0)
        x = numpy.geomspace(1.0, 1e4, 200)
        figures.theory(panel, x, primitive.uchida(x), label="Uchida, Grest and Everaers (from memory)")
        for number, (group, label, get) in enumerate(((coils, "$L_e$ of coils, modified S-coil", lambda p: p.strand()),
                                                      (tubes, "$L_d$ of held tubes", lambda p: p.deflection()),
                                                      (stiff, "$L_d$ of starts about their paths", lambda p: p.deflection("chains", "sigma2")))):
            if group:
                values = [get(p) for p in group]
                figures.points(panel, [p.x for p in group], [v / p.kuhn for (v, _), p in zip(values, group)], numpy.array([e / p.kuhn for (_, e), p in zip(values, group)]),
                               number=number, label=label)
        panel.set(xscale="log", yscale="log", xlabel="$\\rho\\, l_K^2$", ylabel="length over $l_K$")
        figures.legend(panel)
        return figure
    return [Figure("curve", "Entanglement length over Kuhn length against ρ l_K². Coils: modified S-coil of primitive paths, exact ⟨R²⟩. Stiff fibers: the deflection length of "
                   "a harmonic tube, σ² = L_d³/8 l_p, with the σ of chains in a tube that is held, and of starts about their cooled paths; L_d differs from L_e by a factor of "
                   "order 1. Line: a formula from memory.", curve)]
