"""The solvent in flow."""
from lib.case import Outcome
from lib.flow_runs import runs  # noqa: F401

TITLE = "The solvent in flow"
PAPER = "not in the paper; Tao, Götze and Gompper (2008)"


def evaluate(results, tier):
    return Outcome([])
