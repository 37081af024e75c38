"""Means, fits and their standard errors. Values must be independent where a function says so: blocks longer than any
correlation, or separate runs. tests/validation/test_stats.py holds each against exact numbers."""
import dataclasses
import math
import pathlib
import sys

import numpy
from scipy import stats

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
from uncross_sweep.averages import LEAST_BLOCKS, blocked_mean, mean  # noqa: E402, F401


def weighted_mean(values, errors):
    """(mean, standard error, p): of values with known errors; p is the chance of a scatter as large as theirs."""
    f = fit([numpy.ones(len(values))], values, errors)
    return f.value[0], f.error[0], f.p


@dataclasses.dataclass
class Fit:
    value: numpy.ndarray  # of each coefficient
    error: numpy.ndarray
    covariance: numpy.ndarray
    chi2: float
    freedom: int

    @property
    def p(self):
        """Chance of a chi^2 as large as this, if the model is right; 1 where nothing is left to scatter."""
        return float(stats.chi2.sf(self.chi2, self.freedom)) if self.freedom > 0 else 1.0


def fit(basis, y, errors):
    """y = sum of coefficients times basis functions (a list of arrays over the points), by weighted least squares. Errors
    are taken as they are, not scaled by chi^2."""
    errors, y = numpy.asarray(errors, float), numpy.asarray(y, float)
    if len(y) < len(basis):
        raise ValueError(f"{len(y)} points for {len(basis)} coefficients")
    a = numpy.array([numpy.asarray(f, float) for f in basis]).T / errors[:, None]
    q, r = numpy.linalg.qr(a)
    back = numpy.linalg.inv(r)
    value, covariance = back @ (q.T @ (y / errors)), back @ back.T
    residual = y / errors - a @ value
    return Fit(value, numpy.sqrt(covariance.diagonal()), covariance, float(residual @ residual), len(y) - len(basis))


def fit_correlated(basis, y, covariance):
    """The same of correlated values."""
    half = numpy.linalg.cholesky(numpy.asarray(covariance, float))
    white = numpy.linalg.solve(half, numpy.array([numpy.asarray(f, float) for f in basis] + [numpy.asarray(y, float)]).T)
    return fit(list(white.T[:-1]), white.T[-1], numpy.ones(len(white)))


def fair_mean(values, covariance):
    """(mean, error, p) of correlated values, with weights from relative errors: those of diffusion coefficients grow with the
    values, and errors as they are would favor small ones."""
    values = numpy.asarray(values, float)
    relative = numpy.asarray(covariance, float) / numpy.outer(values, values)
    f = fit_correlated([numpy.ones(len(values))], values, relative * values.mean()**2)
    return float(f.value[0]), float(f.error[0]), f.p


def fisher(chances):
    """Fisher's combined p of independent tests."""
    return float(stats.chi2.sf(-2.0 * sum(math.log(max(p, 1e-300)) for p in chances), 2 * len(chances))) if chances else None


def line(x, y, errors):
    """y = value[0] + value[1] x."""
    x = numpy.asarray(x, float)
    return fit([numpy.ones_like(x), x], y, errors)


def power(x, y, errors):
    """ln y = value[0] + value[1] ln x: exponent value[1], prefactor exp(value[0]). Right for small relative errors."""
    y = numpy.asarray(y, float)
    return line(numpy.log(numpy.asarray(x, float)), numpy.log(y), numpy.asarray(errors, float) / y)


def sigmas(false_alarms, tests=1, freedom=math.inf):
    """How many standard errors one of `tests` normal values exceeds, either way, at this rate for all of them together;
    freedom: of the errors, if they come from few values themselves (Student's t)."""
    return float(stats.t.isf(-math.expm1(math.log1p(-false_alarms) / tests) / 2.0, freedom))


def normal(p):
    """The normal value, in standard errors, that is exceeded with chance p."""
    return float(stats.norm.isf(max(p, 1e-300)))


# A verdict of the quick tier: at most 100 of them, and one false alarm in a thousand new sets of seeds.
RATE, VERDICTS = 1e-3, 100
SIGMAS = sigmas(RATE, VERDICTS)  # 4.4
DOUBT = 2.0 * float(stats.norm.sf(3.0))  # of one verdict: from here on, it wants a second run


class Moving(float):
    """An average over a run that was not steady, or a number made of one. `moves` says in words what it did, `share` is half of what
    the average changed from half to half, over itself. A verdict on it is undecided (lib/case.py). Sums, differences, products,
    quotients and powers stay Moving, with numbers of NumPy too; arrays refuse it, so that whoever needs it as plain says float()."""

    __array_ufunc__ = None

    def __new__(cls, value, moves, share):
        made = super().__new__(cls, value)
        made.moves, made.share = moves, share
        return made


def _keep_moving(name):
    plain = getattr(float, name)

    def of(self, *others):
        made = plain(self, *others)
        return made if made is NotImplemented else Moving(made, self.moves, self.share)
    setattr(Moving, name, of)


for _name in ("add", "sub", "mul", "truediv", "pow"):
    _keep_moving(f"__{_name}__")
    _keep_moving(f"__r{_name}__")
for _name in ("neg", "abs"):
    _keep_moving(f"__{_name}__")


def unsteady(series):
    """The larger of two differences, in standard errors: of the halves of a series, with the errors of blocked_mean; and of the
    means of its ten parts from one another, by their slope (Student's t of a line through ten points, as normal errors). 0 if
    the series has fewer values than two blocked means need."""
    series = numpy.asarray(series, float)
    if len(series) < 2 * LEAST_BLOCKS or not series.std() > 1e-12 * abs(series).max():
        return 0.0  # a constant series has the scatter of rounding
    (first, first_error), (second, second_error) = map(blocked_mean, numpy.array_split(series, 2))
    error = math.hypot(first_error, second_error)
    halves = abs(second - first) / error if error > 0.0 else math.inf
    parts = stats.linregress(numpy.arange(10.0), [part.mean() for part in numpy.array_split(series, 10)])
    return float(max(halves, normal(0.5 * parts.pvalue)))


def average(series):
    """(mean, standard error) of a correlated series that should be steady. The mean is Moving if the series is not, at the rate of
    false alarms of all verdicts together."""
    value, error = blocked_mean(series)
    return judged(float(value), series), error


def judged(value, series):
    """A mean of this series, Moving if the series is not steady."""
    if unsteady(series) <= SIGMAS:
        return value
    (first, first_error), (second, second_error) = map(blocked_mean, numpy.array_split(numpy.asarray(series, float), 2))
    moves = f"it still moves: {first:.4g} ± {first_error:.2g} in the first half of the run, {second:.4g} ± {second_error:.2g} in the second"
    return Moving(value, moves, abs(second - first) / max(abs(second + first), abs(second - first)))


def error_that_covers(value, error):
    """The error, or half of what an average changed from one half of its run to the other, where that is more."""
    return max(error, abs(value) * getattr(value, "share", 0.0))


class Tolerance(float):
    """A tolerance that knows which part of it is a stated bound on systematic errors, and from how many standard errors on a
    difference is in doubt."""

    def __new__(cls, statistical, systematic, freedom=math.inf):
        made = super().__new__(cls, statistical + systematic)
        made.systematic = systematic
        made.doubt = sigmas(DOUBT, 1, freedom)
        return made


def tolerance(error, expected_error=0.0, systematic=0.0, z=SIGMAS, values=None):
    """z standard errors of both numbers, plus a stated bound on systematic errors. values: the number of independent values
    that the error comes from, if they are so few that z must be larger."""
    freedom = math.inf if values is None else values - 1
    if values is not None:
        z = sigmas(RATE, VERDICTS, freedom)
    return Tolerance(z * math.hypot(error, expected_error), systematic, freedom)


def jackknife(blocks, estimate):
    """(value, standard error) of what `estimate` makes of the mean over independent blocks (rows); may be an array."""
    blocks = numpy.asarray(blocks, float)
    n, total = len(blocks), blocks.sum(axis=0)
    without = numpy.array([estimate((total - block) / (n - 1.0)) for block in blocks])
    error = numpy.sqrt((n - 1.0) / n * ((without - without.mean(axis=0))**2).sum(axis=0))
    return numpy.asarray(estimate(total / n)), error
