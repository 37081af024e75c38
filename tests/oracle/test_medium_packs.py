#!/usr/bin/python3
"""Packs and traces of media: they are those of this code, and what is in them obeys laws that were not used to make them: momentum
and angular momentum of pairs, forces as slopes of an energy, and tensors as those of the formula, with their roots.
"""
import unittest

import h5py
import numpy as np

from packs import TOP, check_made_anew

DATA = TOP / "reference-data/media"
NAMES = ("langevin", "andersen", "lowe", "dpd", "brownian")
UNIT = 2.0**-40


def tables(name):
    """{(operator, step): {table: rows of numbers}} of a pack."""
    with h5py.File(DATA / f"{name}.pack.h5") as file:
        return {tuple(group.rsplit(".", 1)): {table: file[group][table][:] for table in file[group]} for group in file}


def of(pack, operator):
    return [table for (name, _), table in pack.items() if name == operator]


def energy(places, box, model):
    """U of src/medium/repulsion.h, from all pairs."""
    which, bath, vertices = model["in.medium"][0], model["in.bath"][0], len(model["in.vertex"])
    a, between, b, d = bath[2], bath[3], bath[4], bath[5]
    n = len(places)
    group = (np.arange(n) >= which[4]) & (np.arange(n) < n - vertices)
    i, j = np.triu_indices(n, 1)
    apart = places[i] - places[j]
    apart -= box * np.rint(apart / box)
    r = np.sqrt((apart**2).sum(axis=1))
    strength = np.where(group[i] != group[j], between, a)
    density = np.zeros(n)
    weight = 15 / (2 * np.pi * d**3) * np.maximum(1 - r / d, 0) ** 2
    np.add.at(density, i, weight)
    np.add.at(density, j, weight)
    return (0.5 * strength * np.maximum(1 - r, 0) ** 2).sum() + (np.pi * d**4 / 30 * b * density**2).sum()


class MediumPacks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pack = {name: tables(name) for name in NAMES}

    def test_they_are_those_of_this_code(self):
        check_made_anew(self, DATA, NAMES)

    def test_operators_of_cells_are_left_out(self):
        for name, pack in self.pack.items():
            have = {operator for operator, _ in pack}
            self.assertFalse(have & {"shift", "bin", "sum", "solve", "rotate", "swap"}, name)
            self.assertEqual("sweep" in have or "event_drift" in have, name != "brownian", name)

    def test_pairs_keep_momentum_and_angular_momentum(self):
        for name in ("lowe", "dpd"):
            mass = np.concatenate([np.ones(self.pack[name]["model", "0"]["in.numbers"][0, 2]),
                                   self.pack[name]["model", "0"]["in.vertex"][:, 0]])[:, None]
            for t in of(self.pack[name], "pair_bath"):
                old, new = (np.concatenate([t[f"{side}.solvent"], t[f"{side}.vertex"]]) for side in ("in", "out"))
                self.assertLess(abs((mass * (new - old)).sum(axis=0)).max(), 1e-11)
                self.assertGreater(abs(new - old).max(), 0.1)
            for t in of(self.pack[name], "pairs"):
                np.testing.assert_allclose((t["out.along"] ** 2).sum(axis=1), 1, rtol=1e-14)
                self.assertTrue((t["out.pair"][:, 0] < t["out.pair"][:, 1]).all())
                # A random order: places of pairs in the list do not go with their numbers. 5 sigma.
                n = len(t["out.pair"])
                self.assertLess(abs(np.corrcoef(np.arange(n), t["out.pair"][:, 0])[0, 1]), 5 / np.sqrt(n))

    def test_forces_are_slopes_of_the_energy(self):
        """Differences over 2e-4: what curvature and rounding leave is below 2e-5 of the largest force."""
        model = self.pack["dpd"]["model", "0"]
        box = model["in.box"][0].astype(float)
        t = of(self.pack["dpd"], "repulsion")[0]
        places = np.concatenate([t["in.solvent"], t["in.vertex"]]) * UNIT
        force, h = t["out.force"] * 2.0**-32, 1e-4
        self.assertEqual(np.abs(t["out.force"].sum(axis=0)).max(), 0)
        for member in (0, 50, 100, len(t["in.solvent"]) - 1, len(t["in.solvent"]), len(places) - 1):
            for axis in range(3):
                u = []
                for step in (-h, h):
                    moved = places.copy()
                    moved[member, axis] += step
                    u.append(energy(moved, box, model))
                self.assertAlmostEqual(-(u[1] - u[0]) / (2 * h), force[member, axis], delta=2e-5 * (1 + abs(force).max()))

    def test_tensors_and_roots(self):
        model = self.pack["brownian"]["model", "0"]
        a, fiber = model["in.bath"][0, 1], model["in.chain"][:, 2]
        overlapping = 0
        for t, root in zip(of(self.pack["brownian"], "mobility"), of(self.pack["brownian"], "root")):
            at = 0
            for number in np.unique(fiber):
                place = t["in.position"][fiber == number] * UNIT
                n = 3 * len(place)
                d, left = np.eye(n), np.zeros((n, n))
                for i in range(len(place)):
                    for j in range(len(place)):
                        r = np.linalg.norm(place[i] - place[j])
                        if i == j:
                            continue
                        e = (place[i] - place[j]) / r
                        overlapping += r < 2 * a
                        block = (1 - 9 * r / 32 / a) * np.eye(3) + 3 * r / 32 / a * np.outer(e, e) if r < 2 * a else (
                            3 * a / 4 / r * ((1 + 2 * a * a / 3 / r / r) * np.eye(3) + (1 - 2 * a * a / r / r) * np.outer(e, e)))
                        d[3 * i:3 * i + 3, 3 * j:3 * j + 3] = block
                count = n * (n + 1) // 2
                column = np.repeat(np.arange(n), np.arange(n, 0, -1))
                row = np.concatenate([np.arange(k, n) for k in range(n)])
                np.testing.assert_allclose(t["out.tensor"][at:at + count, 0], d[row, column], atol=1e-14)
                left[row, column] = root["out.root"][at:at + count, 0]
                np.testing.assert_allclose(left @ left.T, d, atol=1e-13)
                self.assertGreater(np.linalg.eigvalsh(d)[0], 0)
                at += count
        self.assertGreater(overlapping, 0)


if __name__ == "__main__":
    unittest.main()
