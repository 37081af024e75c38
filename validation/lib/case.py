"""What a validation case returns: verdicts, figures, and text (validation/README.md)."""
import dataclasses
import importlib.util
import math
import pathlib
import sys

from lib import stats

CASES = pathlib.Path(__file__).resolve().parent.parent / "cases"
# The order of the report: the solvents, then single vertices and fibers in it, then many fibers.
ORDER = ("solvent", "andersen", "flow", "dumbbells", "bead", "mobility", "chains", "rods", "fibers-flow", "galilean", "tube", "entangled", "primitive", "msd", "conservation", "thick", "media", "cost", "settings", "peer", "rivals")
TIERS = ("quick", "campaign")
AGAIN = "-again"  # what the name of a second run ends with
VERDICTS = ("pass", "within allowance", "fail", "not reproduced", "undecided")


@dataclasses.dataclass
class Verdict:
    """A measured number compared with an expected one. `error` and `expected_error` are standard errors. `tolerance` is the
    largest difference that is allowed. `detects` is the smallest wrong effect that would be seen every time; without a
    value it is twice the tolerance. All have the same unit.

    kind "gate": a disagreement is our bug. kind "paper": a disagreement is a finding, and `reason` explains it, if known.

    `rival`, where given, is another value that the measured number must be told from. The verdict stays "undecided" while
    the measurement is too rough: while `detects` is larger than the expected number, or the rival agrees, too.

    `must_see`, where given, is the wrong effect that the verdict is there to see. While `detects` is larger, nothing that agrees
    is a pass: it stays "undecided".

    A number made of an average over a run that still moved is no result: the verdict is "undecided".

    `second` is (value, error) of an independent run that was made because the first one left a doubt.

    `timed`: measured by a clock, which other programs on the machine make uncertain. Such a number may stay "undecided" in the
    quick tier, too."""
    id: str
    statement: str
    expected: float
    source: str
    tolerance: float
    measured: float = None  # None: not there yet
    error: float = 0.0
    expected_error: float = 0.0
    detects: float = None
    kind: str = "gate"
    reason: str = ""
    rival: float = None
    must_see: float = None
    timed: bool = False
    second: tuple = None

    @property
    def verdict(self):
        if self.measured is None or not math.isfinite(self.measured):
            return "undecided"
        if self.moves:
            return "undecided"
        agrees = abs(self.measured - self.expected) <= self.tolerance
        if agrees and (self.blind or (self.doubtful and self.second is None)):
            return "undecided"
        if not agrees or (self.doubtful and self.excess(*self.second) > self.doubt):
            return "fail" if self.kind == "gate" else "not reproduced"
        return "within allowance" if self.covered else "pass"

    @property
    def moves(self):
        """How an average that one of the two numbers is made of still moved through its run (stats.Moving); "" if all were steady."""
        return getattr(self.measured, "moves", "") or getattr(self.expected, "moves", "")

    @property
    def seen(self):
        """The smallest wrong effect that would be seen every time; None as long as the tolerance is not known either."""
        if self.detects is not None:
            return self.detects
        return 2.0 * self.tolerance if self.measured is not None or self.tolerance else None

    @property
    def blind(self):
        """Is the measurement too rough: would an effect as large as the expected number be missed, or does the rival agree, too?"""
        if self.must_see is not None and max(self.seen, self.tolerance) > self.must_see:
            return True
        if self.rival is not None and abs(self.measured - self.rival) <= self.tolerance:
            return True
        return self.expected != 0.0 and max(self.seen, self.tolerance) > abs(self.expected)

    @property
    def z(self):
        """Difference in standard errors of both; None where there are none."""
        return None if self.verdict == "undecided" else self.off

    @property
    def both(self):
        """The standard error of the difference."""
        return math.hypot(self.error or 0.0, self.expected_error or 0.0)

    @property
    def off(self):
        """The same, whatever the verdict."""
        error = self.both
        return (self.measured - self.expected) / error if math.isfinite(error) and error > 0.0 else None

    @property
    def allowed(self):
        """The part of the tolerance that is no statistics: a stated bound on what theory, or the method, is off by."""
        return getattr(self.tolerance, "systematic", self.tolerance)

    @property
    def doubt(self):
        """Standard errors (3, more by Student's t) from which on chance hardly explains a difference."""
        return getattr(self.tolerance, "doubt", 3.0)

    def excess(self, value, error):
        """Standard errors by which a value differs by more than the allowance; 0 where there are no errors."""
        both = math.hypot(error or 0.0, self.expected_error or 0.0)
        beyond = abs(value - self.expected) - self.allowed
        return beyond / both if math.isfinite(both) and both > 0.0 else 0.0

    @property
    def doubtful(self):
        """Is the difference, less the allowance, larger than chance makes it in one verdict, and not in all of a report?"""
        return self.measured is not None and self.off is not None and self.excess(self.measured, self.error) > self.doubt

    @property
    def covered(self):
        """Does it agree only because of the allowance? The difference is then larger than errors explain, and it is no pass."""
        return self.off is not None and self.allowed > 0.0 and abs(self.off) > self.doubt and not self.doubtful

    @property
    def power(self):
        """The smallest change of the value that would turn the verdict red in 95 of 100 repetitions."""
        if self.measured is None and not self.tolerance:
            return None
        return self.tolerance + 1.645 * self.both


@dataclasses.dataclass
class Figure:
    """draw() is called with nothing and returns a matplotlib Figure (lib/figures.py helps)."""
    name: str
    caption: str
    draw: object


@dataclasses.dataclass
class Outcome:
    verdicts: list
    figures: list = dataclasses.field(default_factory=list)
    prose: str = ""  # paragraphs, separated by empty lines; `code` and **bold** are kept


def again(run, seed):
    """The second, independent run of one that left a doubt."""
    return dataclasses.replace(run, name=run.name + AGAIN, seed=seed)


def evaluate(module, results, tier):
    """The Outcome of a case. Its second runs take no part in a number. If the first runs leave a verdict in doubt, its `second` is the
    value from the second runs. `FIRST_ONLY(name)` of a case tells which first runs then count no more, besides those that a second
    run takes the place of."""
    first = {name: result for name, result in results.items() if not name.endswith(AGAIN)}
    second = {name.removesuffix(AGAIN): result for name, result in results.items() if name.endswith(AGAIN)}
    outcome = module.evaluate(first, tier)
    if second and any(verdict.doubtful for verdict in outcome.verdicts):
        dropped = getattr(module, "FIRST_ONLY", lambda name: False)
        others = module.evaluate({**{name: result for name, result in first.items() if not dropped(name)}, **second}, tier).verdicts
        known = {verdict.id: verdict for verdict in others}
        for verdict in outcome.verdicts:
            other = known.get(verdict.id)
            if verdict.doubtful and other and other.measured not in (None, verdict.measured) and not other.moves:
                verdict.second = other.measured, other.error
    return outcome


def load(name):
    """The module of a validation case."""
    path = CASES / name / "case.py"
    spec = importlib.util.spec_from_file_location(f"case_{name}", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def names():
    """The names of all validation cases, in the order of the report."""
    found = [path.parent.name for path in CASES.glob("*/case.py")]
    return sorted(found, key=lambda name: (ORDER.index(name) if name in ORDER else len(ORDER), name))
