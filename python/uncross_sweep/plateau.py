"""Whether a diffusion coefficient has stopped moving with the lag: pages of runs, sweeps and comparisons ask here.

The growth of g_cm in one octave of lags, from t/2 to t, is compared with that in the octave before (docs/observables.md,
D_cumulative), and with the D that is shown, g_cm/6t: it comes later to its end, since it holds the motion at short lags, too. The
numbers come from the same steps of the same fibers. Each has an error that counts correlations in time. The
error of the difference is taken as if they were independent; for a random walk that is 1.3 to 1.4 times too large.

False alarms, of random walks that do not change at all (tests/tools/test_plateau.py): 6 of 1000 with one fiber, 1 of 1000
with 8 fibers and more.
"""
import dataclasses
import math

import numpy

ALARM = 2.5  # errors; a larger change of D is no chance
LEAST_CHANGE = 0.01  # of D; a smaller change is not worth a word
MOST_DOUBT = 0.25  # of D; with a larger error (two of them) of the change nobody can say whether D has stopped
LEAST_PAIRS = 16  # pairs of times in each run; with fewer the error comes from the scatter over fibers alone
OCTAVES = {"D": "D_cumulative", "D_about_mean": "D_cumulative_about_mean"}


def _is_more_than_chance(gap, error):
    return abs(gap) > max(ALARM * error, LEAST_CHANGE)


@dataclasses.dataclass
class Plateau:
    """D in the last octave of lags, less D in the octave before; and less the D that is shown, g_cm/6t, which holds all lags from 0
    on. Both relative to the first, with the errors of that."""
    lag: float
    change: float = math.nan
    error: float = math.nan
    behind: float = 0.0
    behind_error: float = math.inf

    @property
    def grows(self):
        return _is_more_than_chance(self.change, self.error)

    @property
    def lags_behind(self):
        return _is_more_than_chance(self.behind, self.behind_error)

    @property
    def moves(self):
        return self.grows or self.lags_behind

    @property
    def unknown(self):
        return not self.moves and not 2.0 * self.error < MOST_DOUBT

    @property
    def word(self):
        """Behind a value; empty for one that has stopped moving."""
        return "still moving" if self.moves else "not known to be final" if self.unknown else ""

    def doubt(self, name):
        """A sentence for those who read the value `name`; empty if it has stopped moving."""
        if self.grows:
            return (f"{name} is not final: it {'grows' if self.change > 0 else 'falls'} by {abs(self.change):.0%} from one octave of "
                    f"lags to the next, at lag {self.lag:.3g} t0 ({abs(self.change) / self.error:.1f} errors). A longer run has longer lags.")
        if self.lags_behind:
            return (f"{name} is not final: it is {abs(self.behind):.0%} {'below' if self.behind > 0 else 'above'} what the last octave of lags "
                    f"alone gives, at lag {self.lag:.3g} t0 ({abs(self.behind) / self.behind_error:.1f} errors), since it still holds the motion at "
                    "short lags. A longer run has longer lags.")
        known = math.isfinite(self.error)
        why = (f"at lag {self.lag:.3g} t0 its change from one octave of lags to the next is {self.change:+.0%}, known to "
               f"{2.0 * self.error:.0%} (two errors)" if known else
               f"below lag {self.lag:.3g} t0 there are no two octaves of lags with errors")
        return f"Nobody can say whether {name} has stopped moving: {why}." if self.unknown else ""


def last_lag(table, seeds=1):
    """The row of the longest lag with LEAST_PAIRS intervals in each of the runs, or None."""
    pairs = table.get("intervals")
    everywhere = table.get("seeds", seeds) == seeds
    rows = [] if pairs is None else numpy.flatnonzero((pairs >= LEAST_PAIRS * seeds) & everywhere)
    return int(rows[-1]) if len(rows) else None


def octaves(table, row, column="D"):
    """(row of half the lag, column of the octave before it), or None. At lags of 1 and 3 samples there is no smaller lag to
    compare with, and what stands for the octave is D up to there."""
    lags, name = table["time"], OCTAVES[column]
    half = numpy.flatnonzero(numpy.abs(lags - 0.5 * lags[row]) < 1e-6 * lags[row])
    if name not in table or not len(half):
        return None
    return int(half[0]), name if numpy.isfinite(table[name][half[0]]) else column


def change(table, row, column="D", errors=("_error",)):
    """(change, error of each kind) of D from the octave before to the last one, a0^2/t0. errors: what the columns of errors
    are called. nan where there is none. table: {column: array} of dynamics."""
    found = octaves(table, row, column)
    if found is None:
        return (math.nan,) * (1 + len(errors))
    half, before = found
    now = OCTAVES[column]
    both = [(table.get(now + e), table.get(before + e)) for e in errors]
    return (float(table[now][row] - table[before][half]),
            *(math.nan if a is None or b is None else math.hypot(a[row], b[half]) for a, b in both))


def behind(table, row, column="D"):
    """(D of the last octave less D, error). g up to the lag is that up to half of it and the growth from there, so that this is half
    the difference of two numbers that are measured apart. nan where there is none."""
    found, now = octaves(table, row, column), OCTAVES[column]
    errors = table.get(now + "_error"), table.get(column + "_error")
    if found is None or errors[0] is None or errors[1] is None:
        return math.nan, math.nan
    return float(table[now][row] - table[column][row]), 0.5 * math.hypot(errors[0][row], errors[1][found[0]])


def plateau(table, row, column="D"):
    """A Plateau of a table of dynamics at this row."""
    found = numpy.array([*change(table, row, column), *behind(table, row, column)])
    base = abs(table[OCTAVES[column]][row]) if OCTAVES[column] in table else math.nan
    with numpy.errstate(divide="ignore", invalid="ignore"):
        return Plateau(float(table["time"][row]), *map(float, found / base))
