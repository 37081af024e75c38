#!/usr/bin/python3
"""Verdicts of the validation case peer on made-up tables: alike, apart by one per cent, absent; and its line of molecular chaos."""
import pathlib
import sys
import unittest

import numpy

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "validation"))

from lib import case, theory

PEER = case.load("peer")


class Made:
    """A result with these columns."""

    def __init__(self, columns):
        self.columns = columns


def made(change=1.0, names=("uncross", "box-axes", "lammps")):
    """C = c^n, and 0.01 later on; D of molecular chaos; with noise of 0.1 % of D and 0.0005 of C; uncross has `change`
    times that D."""
    random = numpy.random.Generator(numpy.random.PCG64(1))
    n = numpy.arange(PEER.LENGTH)
    kept = theory.retention()
    diffusion = numpy.array([0.0] + [PEER.chaos_diffusion(k, kept) for k in n[1:]])
    results = {}
    for name in names:
        for seed in PEER.SEEDS:
            factor = change if name == "uncross" else 1.0
            results[f"{name}-{seed}"] = Made({"vacf": kept**n + 0.01 * (n > 3) + 5e-4 * random.normal(size=len(n)),
                                              "D": factor * diffusion * (1.0 + 1e-3 * random.normal(size=len(n)))})
    return results


def words(results):
    return {verdict.id: verdict.verdict for verdict in PEER.evaluate(results, "campaign").verdicts}


class PeerTest(unittest.TestCase):
    def test_chaos(self):
        # sum over pairs of flights, written out; and its limit
        i = numpy.arange(7)
        self.assertAlmostEqual(PEER.chaos_diffusion(7, 0.4), 0.02 / 14 * (0.4 ** abs(i[:, None] - i)).sum(), 14)
        kept = theory.retention()
        self.assertAlmostEqual(PEER.chaos_diffusion(10**6, kept), theory.self_diffusion(), 7)

    def test_tail(self):
        self.assertAlmostEqual(PEER.long_time_tail(1.0), 8.8e-4, 5)  # 2/15 (4 pi (2.2368 + 0.0274))^(-3/2)

    def test_alike(self):
        self.assertEqual(set(words(made()).values()), {"pass"})

    def test_apart(self):
        found = words(made(1.01))
        self.assertEqual({name for name, word in found.items() if word == "fail"},
                         {"peer.diffusion.10", "peer.diffusion.50", "peer.diffusion.249", "peer.axes"})

    def test_absent(self):
        found = words(made(names=("uncross", "box-axes")))
        self.assertEqual(found["peer.first.uncross"], "pass")
        self.assertEqual(found["peer.axes"], "pass")
        self.assertEqual(sum(word == "undecided" for word in found.values()), 9)
        self.assertEqual(set(words({}).values()), {"undecided"})

    def test_quick_tier_needs_no_lammps(self):
        self.assertEqual(PEER.runs("quick"), [])
        self.assertEqual(PEER.evaluate({}, "quick").verdicts, [])


if __name__ == "__main__":
    unittest.main()
