"""D of all solutes of one kind at once: short-time D, each system's own, and what is common to them.

    g_cm/6t + waves(t) = D [1 - share(t)] - tau D_0/t

waves: of the box (dilute.memory); share: what the change of shape takes (lib/shape.py); tau: the memory that has decayed before
the first lag, in units of theory's D_0, one number for all systems. The first lag is chosen by a rule for all systems at once
(`rule`), and what it leaves open is an error of every D (`Joint.estimator`).
"""
import dataclasses
import math

import numpy

from lib import dilute, stats

LEAST = 0.05  # of the combined p at the first lag that is taken


@dataclasses.dataclass
class System:
    """A table of dilute.merged, the waves of its box, theory's short-time D there, the share taken by changes of shape."""
    table: dict
    waves: object
    theory: float
    share: object
    box: int

    def correction(self, t):
        return self.waves(t) + self.theory * self.share(t)

    def reaches(self, first):
        """Has it two lags or more from here on?"""
        chosen = dilute.nested(self.table["time"], first, dilute.last_lag(self.box, first))
        return (self.table["D_error"][chosen] > 0.0).sum() >= 2

    def alone(self, first):
        """Its own fit, with a local memory of its own; None with too few lags."""
        return dilute.long_time([(self.table, self.correction)], first, [dilute.last_lag(self.box, first)])


@dataclasses.dataclass
class Joint:
    """Short-time D of each system in its box, their covariance, tau and its error, the p of each system alone, and the
    change of all D alike if the first lag is doubled: (change, error), None where lags do not reach."""
    value: numpy.ndarray
    covariance: numpy.ndarray
    tau: float
    chances: list
    doubled: tuple

    @property
    def p(self):
        """Fisher's: the chance that all scatter as much as they do."""
        return stats.fisher(self.chances)

    @property
    def estimator(self):
        """Relative systematic error of every D: what the choice of the first lag is seen to do, or could do unseen."""
        return max(abs(self.doubled[0]), self.doubled[1]) if self.doubled else 0.0


def together(systems, first):
    return dilute.long_time([(s.table, s.correction) for s in systems], first, [dilute.last_lag(s.box, first) for s in systems],
                            [s.theory for s in systems])


def common(systems, limit):
    """(mean, error) of D over theory's in the box, all systems."""
    scale = numpy.array([s.theory for s in systems])
    return stats.fair_mean(limit.value / scale, limit.covariance / numpy.outer(scale, scale))[:2]


def joint(systems, first=dilute.FIRST_LAG):
    """None if a system has too few lags. Lags from 2t on are a part of those from t on, so the variance of the change is the
    difference of the variances."""
    if not systems or not all(s.reaches(first) for s in systems):
        return None
    limit = together(systems, first)
    alone = [one for one in (s.alone(first) for s in systems) if one]
    both, doubled = [s for s in systems if s.reaches(2.0 * first)], None
    if both:
        now, then = (common(both, together(both, t)) for t in (first, 2.0 * first))
        doubled = then[0] / now[0] - 1.0, math.sqrt(max(then[1]**2 - now[1]**2, 0.05 * then[1]**2)) / now[0]
    return Joint(limit.value, limit.covariance, limit.local, [one.p for one in alone], doubled)


def rule(systems, tries=(1.6, 3.2, 6.4, 12.8)):
    """The first lag from which on every lag tried passes: all systems together scatter about their models as they should, Fisher's
    p >= LEAST, and if the lag is doubled, all D alike change by at most two standard errors; and (lag, p, change, error) of every
    lag tried. Later lags are not tried: two octaves from 25.6 t0 on are no longer there for all systems."""
    rows = []
    for first in tries:
        found = joint(systems, first)
        if found and found.doubled:
            rows.append((first, found.p, *found.doubled))
    bad = [i for i, (_, p, change, error) in enumerate(rows) if p < LEAST or abs(change) > 2.0 * error]
    first = bad[-1] + 1 if bad else 0
    return (rows[first][0] if first < len(rows) else None), rows


def pulled(columns, system, first=dilute.FIRST_LAG):
    """(short-time D, error) of a system in its box from its answer to a force (validation/measure/pulled_fibers.c): the mean
    displacement over the force is g/6, so that the same memory applies. From `first` to the last row it grows by D t - t correction(t),
    and what had decayed before `first`, tau D_0, drops out. `since_error` is the error of this growth; it is 0 at `first`."""
    t, way = columns["time"], columns["way"]
    k = int(numpy.argmin(columns["since_error"]))
    if abs(t[k] - first) > 1e-6 * first:
        raise ValueError(f"a run whose errors begin at {t[k]:g} t0, not at {first:g}")
    ends = t[[k, -1]]
    time, lost = ends[1] - ends[0], numpy.diff(ends * system.correction(ends))[0]
    return (way[-1] - way[k] + lost) / time, columns["since_error"][-1] / time


def answers(results, planned, system):
    """[(N, box, fibers, force, D, error)] of the systems that were pulled: short-time D in their box, the weighted mean of the runs of one
    system. planned: {run: (N, box, fibers, force, time)}; system(N, box): the System of its theory, without a table."""
    groups = {}
    for name, (*what, _) in planned.items():
        if name in results and results[name].text:
            groups.setdefault(tuple(what), []).append(results[name].columns)
    found = []
    for (n, box, *others), tables in groups.items():
        values = [pulled(one, system(n, box)) for one in tables]
        found.append((n, box, *others, *dilute.fair_mean(*zip(*values))[:2]))
    return found


def beside(covariance, errors):
    """The covariance with further independent values behind it."""
    n = len(covariance)
    found = numpy.diag([0.0] * n + [error**2 for error in errors])
    found[:n, :n] = covariance
    return found


def per_length(lengths, values, covariance, theory):
    """{N: (D, error, p)} of several boxes, and the covariance of ln D; p: the chance that boxes differ as much as they do."""
    sizes = sorted(set(lengths))
    scale = numpy.array([theory(n) for n in lengths])
    relative = covariance / numpy.outer(values, values) * (values / scale).mean()**2
    basis = [numpy.array([float(n == one) for n in lengths]) for one in sizes]
    f = stats.fit_correlated(basis, values / scale, relative)
    found, logs = {}, f.covariance / numpy.outer(f.value, f.value)
    for i, n in enumerate(sizes):
        same = [k for k, one in enumerate(lengths) if one == n]
        p = stats.fair_mean(values[same] / scale[same], covariance[numpy.ix_(same, same)] / scale[same[0]]**2)[2]
        found[n] = (f.value[i] * theory(n), f.error[i] * theory(n), p)
    return found, logs


def mean_over(far, logs, model, estimator):
    """(value, error) of D over a model, mean over lengths; the estimator's error is common to all. None without any."""
    if not far:
        return None
    ratio = numpy.array([far[n][0] / model(n) for n in sorted(far)])
    mean, error, _ = stats.fair_mean(ratio, logs * numpy.outer(ratio, ratio))
    return mean, math.hypot(error, estimator * mean)


def image_slope(lengths, infinite, shifts, covariance, theory):
    """(slope, error) of D in a box against the images' share there, one limit for each length: theory has 1. None without a length
    in two boxes."""
    if len(lengths) < len(set(lengths)) + 1:
        return None
    scale, shifts = numpy.array([theory(n) for n in lengths]), numpy.asarray(shifts)
    basis = [numpy.array([float(n == one) for n in lengths]) for one in sorted(set(lengths))] + [-shifts / scale]
    f = stats.fit_correlated(basis, (numpy.asarray(infinite) - shifts) / scale, covariance / numpy.outer(scale, scale))
    return float(f.value[-1]), float(f.error[-1])


def words(systems, found):
    """How the first lag was chosen, in words."""
    rows = "; ".join(f"{first:g} t0: p = {p:.2g}, {100.0 * change:+.1f} ± {100.0 * error:.1f} %" for first, p, change, error in
                     rule(systems, (3.2, 6.4, 12.8))[1])
    return f"""**Lags** begin at {dilute.FIRST_LAG:g} t0. Fisher's p of the {len(found.chances)} systems, and the change of all D alike if
the first lag is doubled: {rows}. The choice of lags leaves {100.0 * found.estimator:.1f} % of every D open. The memory that has decayed
before is τ D_0/t, with τ = {found.tau:.2f} t0 for all."""


# --- verdicts ---------------------------------------------------------------------------------------------------------

def scatter_verdict(case, found):
    """Every system's own p, not only the worst's."""
    return dilute.scatter(f"{case}.lags", "Scatter of D(t) over lags about waves, change of shape and a local memory: Fisher's p of "
                          "all systems, in standard errors", found.p if found else None)


def images_verdict(case, pair):
    """Held only when it can tell half of the images' share: a sum over images that is off by a half is what a bug would make."""
    return dilute.held(f"{case}.images", "Slope of D against the images' share kT/(6πηL) (2.837297 - ...), all lengths in several "
                       "boxes", 1.0, "images of a periodic box (Hasimoto 1959), η from shear waves", pair, 0.0, must_see=0.5)
