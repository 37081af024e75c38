"""Primitive paths of chains without width: known ones, and those of entangled chains from loose coils to tight stiff fibers."""
import csv
import math

import numpy

from lib import figures, primitive, stats
from lib.case import Figure, Outcome, Verdict
from lib.runs import Run

TITLE = "Primitive paths"
PAPER = "not in the paper"

# name: box, chains, vertices, l0, k, l_p, seed, LEAST, MOST, mobile, time of a held tube, options, hours (measure/primitive.py); cheapest and sharpest first.
# Of coils LEAST is the first spring that counts.
SHORT = "step=0.025"  # with 0.1 more pairs of bonds that are pressed together go rigid
POINTS = {
    "stiff-962": (24, 340, 64, 0.5, 100, 16, 4106, 90, 270, 40, 100, "", 0.05),
    "coil-13": (5, 45, 64, 0.5, 100, 0.5, 4101, 90, 810, 0, 0, SHORT, 0.01),
    "stiff-552": (15, 98, 128, 0.5, 100, 8, 4105, 90, 270, 14, 100, SHORT, 0.04),
    "coil-6": (8, 34, 160, 0.5, 100, 0.5, 4102, 90, 810, 0, 0, SHORT, 0.03),
    "stiff-3906": (24, 340, 64, 0.5, 100, 32, 4107, 90, 270, 40, 100, "", 0.03),
    "coil-3": (12, 27, 320, 0.5, 100, 0.5, 4103, 90, 810, 0, 0, "", 0.06),
    "stiff-97": (6, 42, 64, 0.5, 100, 2, 4108, 90, 270, 8, 100, "", 0.02),
    "stiff-125": (12, 97, 64, 0.5, 100, 4, 4109, 90, 270, 16, 100, "", 0.02),
    "coil-2": (14, 19, 512, 0.5, 100, 0.5, 4104, 90, 810, 0, 0, "", 0.08),
    "coil-1": (14, 10, 480, 0.5, 100, 0.5, 4112, 90, 810, 0, 0, "", 0.04),
}
# The same with one thing changed. Where the seed and the box are the same, the start is the same, too. `coil-alone` is `coil-1` in a box where chains meet little but themselves.
CHANGED = {
    "coil-alone": (60, 10, 480, 0.5, 100, 0.5, 4112, 90, 810, 0, 0, "", 0.03),
    "coil-13-slow": (5, 45, 64, 0.5, 100, 0.5, 4101, 90, 810, 0, 0, SHORT + " pace=3", 0.03),
    "coil-13-step0.05": (5, 45, 64, 0.5, 100, 0.5, 4101, 90, 810, 0, 0, "step=0.05", 0.01),
    "coil-13-step0.1": (5, 45, 64, 0.5, 100, 0.5, 4101, 90, 810, 0, 0, "", 0.01),
    "coil-13-split": (5, 45, 64, 0.5, 100, 0.5, 4101, 270, 2430, 0, 0, "step=0.05 split=2", 0.03),
    "coil-13-fine": (5, 45, 127, 0.25, 400, 0.5793, 4110, 270, 2430, 0, 0, "step=0.05", 0.03),
    "coil-6-seed": (8, 34, 160, 0.5, 100, 0.5, 4111, 90, 810, 0, 0, "", 0.03),
    "coil-13-wide": (6, 78, 64, 0.5, 100, 0.5, 4113, 90, 810, 0, 0, "step=0.05", 0.03),
    "stiff-552-slow": (15, 98, 128, 0.5, 100, 8, 4105, 90, 270, 14, 200, "pace=2", 0.04),
    "stiff-552-wide": (18, 169, 128, 0.5, 100, 8, 4114, 90, 270, 24, 100, "", 0.03),
}
ALL = {**POINTS, **CHANGED}
KNOWN = {"posts": "a ring about two posts, over twice their distance", "links": "two linked rings, each pinned at its far end, over what symmetry says",
         "lattice": "a chain in a lattice of posts, over its polygon"}
SOFT = 1e-3  # of contacts
FROM_MEMORY = "the curve is from memory"
ALLOWED = 0.2  # of c_xi, by three melts
TIGHT = ("stiff-552", "stiff-962", "stiff-3906")  # where L_d is below a quarter of l_p
OF_TUBE = 0.2  # of sigma: 0.31 and 0.32 are two values of the prefactor, and fibers here are 2 to 4 persistence lengths of their tube


def runs(tier):
    found = [Run("known", program=["known.py", 4120], hours=0.004)]
    if tier == "campaign":
        found += [Run(name, program=["primitive.py", *point[:-2], *point[-2].split()], hours=point[-1], priority=number // 3)
                  for number, (name, point) in enumerate(ALL.items())]
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
        box, self.chains, self.vertices, rest, spring, self.persistence, _, self.least, *_ = ALL[name]
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
    found = {name: Point(name, results[name].text) for name in ALL if name in results and results[name].exists}
    return {name: point for name, point in found.items() if "chains" in point.tables}


def network(found):
    """Verdicts of the campaign's points."""
    coils, stiff = ({name: found.get(name) for name in POINTS if name.startswith(word)} for word in ("coil", "stiff"))
    made = [contact_verdict(found.values(), *words) for words in (("softened", SOFT), ("rigid", 0.0))]
    made += [coil_verdict(name, point) for name, point in coils.items()]
    made += [local_verdict(a, b, found, Point.strand) for a, b in (("coil-1", "coil-2"), ("coil-2", "coil-3"), ("coil-3", "coil-6"), ("coil-6", "coil-13"))]
    made += loose_verdicts([p for p in coils.values() if p])
    made += [width_verdict(name, found.get(name)) for name in TIGHT]
    made += [local_verdict(a, b, found, Point.deflection) for a, b in (("stiff-125", "stiff-552"), ("stiff-552", "stiff-962"), ("stiff-962", "stiff-3906"))]
    made += [tight_verdict("tight", "held tubes", [p for p in stiff.values() if p]), tight_verdict("tightest", "held tubes with L_d ≪ l_p", [found[name] for name in TIGHT if name in found])]
    for name in ("stiff-552", "stiff-962"):
        made += tube_verdicts(name, found.get(name))
    return made + changed_verdicts(found)


def coil_verdict(name, point):
    statement = f"L_e/l_K by primitive paths over the curve, {name.removeprefix('coil-')} = ρ l_K², rounded"
    source = "Uchida, Grest and Everaers 2008, from memory; 20 % of c_xi"
    if point is None:
        return Verdict(f"primitive.length.{name.removeprefix('coil-')}", statement, 1.0, source, ALLOWED, kind="paper")
    value, error = point.strand()
    curve = float(primitive.uchida(point.x)) * point.kuhn
    allowed = abs(float(primitive.uchida(point.x / (1.0 + ALLOWED)) / primitive.uchida(point.x)) - 1.0)
    return Verdict(f"primitive.length.{name.removeprefix('coil-')}", statement, 1.0, source, stats.tolerance(error / curve, systematic=allowed), value / curve, error / curve, kind="paper",
                   reason=FROM_MEMORY)


def contact_verdict(points_found, kind, allowed):
    """Of the contacts at the springs that count, those that were not plain: of all points, but not of those whose step is too long on purpose."""
    used = [p for p in points_found if not p.name.startswith("coil-13-step")]
    total, count = (sum(p.stages[name][p.counted].sum() for p in used) for name in ("contacts", kind))
    return Verdict(f"primitive.contacts.{kind}", f"contacts of entangled chains that were {kind}, of all", 0.0, "a bounce is resolved", allowed, count / total if used else None, 0.0, kind="paper",
                   reason=f"{count:.0f} of {total / 1e6:.1f} million: two bonds that are pressed together bounce ever faster" if used else "")


def local_verdict(a, b, found, of):
    """The exponent between two neighboring points."""
    coil = a.startswith("coil")
    what, source = ("L_e/l_K", "the curve, from memory") if coil else ("L_d/l_K", "−2/5: binary collisions (Morse)")
    names = [name.partition("-")[2] for name in (a, b)]
    said = f"primitive.local.{names[0]}", f"exponent of {what} in ρ l_K² from {names[0]} to {names[1]}"
    if a not in found or b not in found:
        return Verdict(*said, -0.4 if not coil else -1.8, source, 0.2, kind="paper")
    p, q = found[a], found[b]
    value, error = local_exponent(p, q, of)
    expected = math.log(float(primitive.uchida(q.x) / primitive.uchida(p.x))) / math.log(q.x / p.x) if coil else -0.4
    return Verdict(*said, expected, source, stats.tolerance(error), value, error, kind="paper", reason=FROM_MEMORY if coil else "")


def local_exponent(p, q, of):
    """(value, error) between two points."""
    (a, da), (b, db), decade = of(p), of(q), math.log(q.x / p.x)
    return math.log(b / q.kuhn / (a / p.kuhn)) / decade, math.hypot(da / a, db / b) / decade


def loose_verdicts(coils):
    """All coils against the curve's own mean exponent; the three loosest against the power of a thread with one length."""
    curve = "the curve's own mean exponent there, from memory; rival −4/3: a fixed number of contacts per a³"
    thread = "−2: packing length alone; rival −4/3: a fixed number of contacts per a³"
    said = ("loose", "exponent of L_e/l_K in ρ l_K², coils", curve, -1.74), ("loosest", "the same, three loosest coils", thread, -2.0)
    made = []
    for (name, statement, source, expected), used in zip(said, (coils, sorted(coils, key=lambda p: p.x)[:3])):
        if len(coils) < 4:
            made.append(Verdict(f"primitive.exponent.{name}", statement, expected, source, 0.2, kind="paper", rival=-4.0 / 3.0))
            continue
        x, (values, errors) = [p.x for p in used], zip(*(p.strand() for p in used))
        fit = stats.power(x, [v / p.kuhn for v, p in zip(values, used)], [e / p.kuhn for e, p in zip(errors, used)])
        if name == "loose":
            expected = float(stats.power(x, primitive.uchida(x), [float(primitive.uchida(p.x)) * e / v for v, e, p in zip(values, errors, used)]).value[1])
        error = float(fit.error[1])
        made.append(Verdict(f"primitive.exponent.{name}", statement, expected, source, stats.tolerance(error), float(fit.value[1]), error, kind="paper", rival=-4.0 / 3.0,
                            reason=f"χ² of the power law {fit.chi2:.1f}, degrees of freedom {fit.freedom}"))
    return made


def forms(coils):
    """exponent n -> Fit of L_e/l_K = A x^(-2/5) + B x^(-n), n = 4/3 and 2."""
    x, (values, errors) = numpy.array([p.x for p in coils]), zip(*(p.strand() for p in coils))
    kuhn = numpy.array([p.kuhn for p in coils])
    return {n: stats.fit([x**-0.4, x**-n], numpy.array(values) / kuhn, numpy.array(errors) / kuhn) for n in (4.0 / 3.0, 2.0)}


# name: (changed, point, what is compared, statement, source, allowed)
LENGTH, WIDTH, PATH = (lambda p: p.lengths()), (lambda p: p.tables["held"]["mean"]), (lambda p: p.tables["chains"]["sigma2"])
SAME = {
    "step.13": ("coil-13-step0.1", "coil-13", LENGTH, 1.0, "L_pp with steps four times as long over L_pp, same start, ρ l_K² = 13", "1 %", 0.01),
    "rate.13": ("coil-13-slow", "coil-13", LENGTH, 1.0, "L_pp of cooling three times as slow over L_pp, same start, ρ l_K² = 13", "1 %", 0.01),
    "vertices.13": ("coil-13-split", "coil-13", LENGTH, 1.0, "L_pp with bonds cut in two over L_pp, same start, ρ l_K² = 13", "2 %", 0.02),
    "rate.552": ("stiff-552-slow", "stiff-552", PATH, 0.5, "σ of the start about the path, cooling half as fast, over σ, same start, ρ l_K² = 552", "2 %", 0.02),
    "time.552": ("stiff-552-slow", "stiff-552", WIDTH, 0.5, "σ in a held tube in 200 t0 over σ in 100 t0, same start, ρ l_K² = 552", "2 %", 0.02),
}
OTHER = {
    "bonds.13": ("coil-13-fine", "coil-13", Point.strand, "L_e with bonds of half the length and the same l_K over L_e, ρ l_K² = 13"),
    "box.13": ("coil-13-wide", "coil-13", Point.strand, "L_e in a box of 6 over L_e in one of 5, ρ l_K² = 13"),
    "seed.6": ("coil-6-seed", "coil-6", Point.strand, "L_e of another seed over L_e, ρ l_K² = 6"),
    "box.552": ("stiff-552-wide", "stiff-552", Point.width, "σ in a held tube in a box of 18 over σ in one of 15, ρ l_K² = 552"),
}


def changed_verdicts(found):
    """What must not matter: of the same start chain by chain, and of other starts."""
    made = []
    for name, (changed, plain, of, power, statement, source, allowed) in SAME.items():
        said = f"primitive.{name}", statement, 1.0, f"nothing but what is resolved may matter; {source}"
        if changed in found and plain in found:
            value, error = stats.jackknife(numpy.stack([of(found[changed]), of(found[plain])], axis=1), lambda mean, power=power: (mean[0] / mean[1]) ** power)
            made.append(Verdict(*said, stats.tolerance(float(error), systematic=allowed), float(value), float(error), kind="paper"))
        else:
            made.append(Verdict(*said, allowed, kind="paper"))
    for name, (changed, plain, of, statement) in OTHER.items():
        said = f"primitive.{name}", statement, 1.0, "nothing but l_K and ρ matters; 2 %"
        if changed in found and plain in found:
            (a, da), (b, db) = of(found[changed]), of(found[plain])
            error = a / b * math.hypot(da / a, db / b)
            made.append(Verdict(*said, stats.tolerance(error, systematic=0.02), a / b, error, kind="paper"))
        else:
            made.append(Verdict(*said, 0.02, kind="paper"))
    return made


def width_verdict(name, point):
    at = name.removeprefix("stiff-")
    statement, source = f"σ in a held tube over 0.32 ξ^(6/5) l_p^(−1/5), ρ l_K² = {at}", "Hinsch, Wilhelm and Frey, cond-mat/0703096; 20 %"
    if point is None or "held" not in point.tables:
        return Verdict(f"primitive.width.{at}", statement, 1.0, source, OF_TUBE, kind="paper")
    (value, error), theory = point.width(), primitive.hinsch(point.rho, point.persistence)
    return Verdict(f"primitive.width.{at}", statement, 1.0, source, stats.tolerance(error / theory, systematic=OF_TUBE), value / theory, error / theory, kind="paper")


def tight_verdict(name, which, stiff):
    statement, source = f"exponent of L_d/l_K in ρ l_K², stiff fibers, {which}", "−2/5: binary collisions (Morse); rival −1/3: effective medium"
    stiff = [p for p in stiff if "held" in p.tables]
    if len(stiff) < 3:
        return Verdict(f"primitive.exponent.{name}", statement, -0.4, source, 0.03, kind="paper", rival=-1.0 / 3.0)
    found = [p.deflection() for p in stiff]
    fit = stats.power([p.x for p in stiff], [value / p.kuhn for (value, _), p in zip(found, stiff)], [error / p.kuhn for (_, error), p in zip(found, stiff)])
    error = float(fit.error[1]) * max(1.0, math.sqrt(fit.chi2 / max(fit.freedom, 1)))
    return Verdict(f"primitive.exponent.{name}", statement, -0.4, source, stats.tolerance(error), float(fit.value[1]), error, kind="paper", rival=-1.0 / 3.0,
                   reason=f"χ² of the power law {fit.chi2:.1f}, degrees of freedom {fit.freedom}")


def tube_verdicts(name, point):
    """The same chains in a tube that is held: d^2 of two times against the width about the mean, and the static width against that."""
    at = name.removeprefix("stiff-")
    said = {"plateau": (f"held tube: a quarter of d² over σ² about the mean places, ρ l_K² = {at}", "two fluctuating places; 1 where the plateau is reached"),
            "start": (f"σ of the start about the mean places over σ in the held tube, ρ l_K² = {at}", "1: the start is a sample of the tube"),
            "static": (f"σ of the start about the path over σ in the held tube, ρ l_K² = {at}", "1, if a path that moves its obstacles and a tube that is held say the same")}
    if point is None or "held" not in point.tables:
        return [Verdict(f"primitive.tube.{kind}.{at}", *words[:1], 1.0, words[1], 0.1, kind="paper") for kind, words in said.items()]
    held = point.tables["held"]
    made = []
    for kind, top, bottom, power, allowed in (("plateau", "d2", "mean", 1.0, 0.1), ("start", "start", "mean", 0.5, 0.1), ("static", "path", "mean", 0.5, 0.1)):
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
                     f"the last quarter of the last run differs from the one before by {100 * point.stages['drift'][-1]:.2f} %. "
                     + ("L_e {0:.2f} ± {1:.2f} a0".format(*point.strand()) if point.is_coil else "Start about its path: σ {0:.3f} ± {1:.3f} a0".format(*point.width("chains", "sigma2"))) + ".")
    coils = [point for name, point in made.items() if name in POINTS and point.is_coil]
    if len(coils) > 2:
        lines.append("L_e/l_K = A x^(−2/5) + B x^(−n): " + "; ".join(
            f"n = {n:.3g}: A {fit.value[0]:.2f} ± {fit.error[0]:.2f}, B {fit.value[1]:.0f} ± {fit.error[1]:.0f}, χ² {fit.chi2:.1f} with {fit.freedom} degrees of freedom"
            for n, fit in forms(coils).items()) + ".")
    return "\n\n".join(lines)


def with_errors(panel, points_shown, get, **look):
    """Points at their x: get gives (value, error)."""
    values = [get(p) for p in points_shown]
    figures.points(panel, [p.x for p in points_shown], [v for v, _ in values], numpy.array([e for _, e in values]), **look)


def over_kuhn(of):
    def get(point):
        value, error = of(point)
        return value / point.kuhn, error / point.kuhn
    return get


def shown(made):
    main = sorted((p for name, p in made.items() if name in POINTS), key=lambda p: p.x)
    coils, stiff = [p for p in main if p.is_coil], [p for p in main if not p.is_coil]
    tubes = [p for p in stiff if "held" in p.tables]

    def curve():
        figure, panel = figures.plain(width=5.5, height=4.0)
        x = numpy.geomspace(0.9, 1e4, 200)
        figures.theory(panel, x, primitive.uchida(x), label="Uchida, Grest and Everaers (from memory)")
        for number, (group, label, of) in enumerate(((coils, "$L_e$ of coils, modified S-coil", Point.strand), (tubes, "$L_d$ of held tubes", Point.deflection),
                                                     (stiff, "$L_d$ of starts about their paths", lambda p: p.deflection("chains", "sigma2")))):
            if group:
                with_errors(panel, group, over_kuhn(of), number=number, label=label)
        panel.set(xscale="log", yscale="log", xlabel="$\\rho\\, l_K^2$", ylabel="length over $l_K$")
        figures.legend(panel)
        return figure

    def exponents():
        figure, panel = figures.plain(width=5.5, height=3.4)
        x = numpy.geomspace(0.9, 1e4, 200)
        figures.theory(panel, x, primitive.uchida_slope(x), label="Uchida, Grest and Everaers (from memory)")
        for value in (-2.0, -4.0 / 3.0, -2.0 / 5.0, -1.0 / 3.0):
            panel.axhline(value, color=figures.PALE, linewidth=0.8, zorder=0)
        for number, (group, of, label) in enumerate(((coils, Point.strand, "$L_e$ of coils"), ([p for p in tubes if p.x > 120], Point.deflection, "$L_d$ of held tubes"))):
            pairs = list(zip(group, group[1:]))
            if pairs:
                found = [local_exponent(p, q, of) for p, q in pairs]
                figures.points(panel, [math.sqrt(p.x * q.x) for p, q in pairs], [v for v, _ in found], numpy.array([e for _, e in found]), number=number, label=label)
        panel.set(xscale="log", xlabel="$\\rho\\, l_K^2$", ylabel="local exponent of length over $l_K$")
        figures.legend(panel)
        return figure

    def tube():
        figure, panel = figures.plain(width=5.5, height=3.4)
        for number, (label, of) in enumerate((("held tube, about the mean place", Point.width), ("start, about the mean place", lambda p: p.width("held", "start")),
                                              ("held tube, $(d^2/4)^{1/2}$", lambda p: p.width("held", "d2")),
                                              ("start about its cooled path", lambda p: p.width("chains", "sigma2")))):
            with_errors(panel, tubes, lambda p, of=of: tuple(value / primitive.hinsch(p.rho, p.persistence) for value in of(p)), number=number, label=label)
        panel.axhline(1.0, color=figures.INK, linewidth=0.8, zorder=0)
        panel.set(xscale="log", yscale="log", xlabel="$\\rho\\, l_K^2$", ylabel="$\\sigma$ over Hinsch, Wilhelm and Frey")
        figures.legend(panel)
        return figure
    return [Figure("curve", "Entanglement length over Kuhn length against ρ l_K². Coils: modified S-coil of primitive paths, exact ⟨R²⟩. Stiff fibers: the deflection length of "
                   "a harmonic tube, σ² = L_d³/8 l_p, with the σ of chains in a tube that is held, and of starts about their cooled paths; L_d differs from L_e by a factor of "
                   "order 1. Line: a formula from memory.", curve),
            Figure("exponents", "Exponents between neighboring points of Figure 1, at the geometric mean of their ρ l_K². Pale lines: −2 and −4/3 (loose), −2/5 and −1/3 (tight).", exponents),
            *([Figure("tube", "Static width beside the dynamic tube of the same chains, over 0.32 ξ^(6/5) l_p^(−1/5). d² is of two times in the held tube.", tube)] if tubes else [])]
