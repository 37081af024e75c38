#!/usr/bin/python3
"""Packs and traces of dumbbells: they are those of this code, and their flights are those that a spring, integrated in small
steps, makes between the same walls and images.
"""
import math
import unittest

import numpy as np

from packs import TOP, check_made_anew, run

DATA = TOP / "reference-data/dumbbells"
NAMES = ("periodic", "walls", "slip", "shear")
UNIT = 2.0**-40


def tables(name):
    """{(operator, step): {table: rows of numbers}} of a pack."""
    cells = {}
    for line in run("dump", DATA / f"{name}.pack.h5")[1].splitlines():
        if not line.startswith("#"):
            operator, step, row, component, value = line.split()
            table, _, column = component.rpartition(".")
            rows = cells.setdefault((operator, int(step)), {}).setdefault(table, {})
            rows.setdefault(int(row), {})[column] = float.fromhex(value) if "0x" in value else int(value)
    return {place: {table: np.array([list(rows[k].values()) for k in sorted(rows)]) for table, rows in found.items()}
            for place, found in cells.items()}


def flights(pack, operator):
    return [table for (name, _), table in pack.items() if name == operator]


class DumbbellPacks(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.pack = {name: tables(name) for name in NAMES}

    def test_they_are_those_of_this_code(self):
        check_made_anew(self, DATA, NAMES)

    def test_operators_of_points_are_left_out(self):
        for name, pack in self.pack.items():
            operators = {operator for operator, _ in pack}
            self.assertIn("dumbbell_start", operators, name)
            self.assertFalse(operators & {"stream", "wall_stream", "shear_stream", "swap"}, name)

    def test_swing_is_that_of_a_spring(self):
        """The vector after a flight: cosine and sine of sqrt(2 K) t, of this machine's library."""
        crossed = 0
        for name, operator in (("periodic", "dumbbell_stream"), ("shear", "dumbbell_shear_stream")):
            model = self.pack[name]["model", 0]
            height, w = model["in.box"][0][1], math.sqrt(2.0 * model["in.spring"][0][0])
            for t in flights(self.pack[name], operator):
                n, time = len(t["in.vector"]), t["in.time"][0][0]
                first, second = t["in.position"][0:2 * n:2], t["in.position"][1:2 * n:2]
                speed = t["in.speed"][0][0] if "in.speed" in t else 0.0
                image = np.rint(((first - t["in.vector"] - second)[:, 1]) * UNIT / height) * (name == "shear")
                crossed += np.count_nonzero(image)
                u = t["in.velocity"][0:2 * n:2] - t["in.velocity"][1:2 * n:2]
                u[:, 0] -= image * speed
                r = t["in.vector"] * UNIT
                wanted = r * math.cos(w * time) + u / w * math.sin(w * time)
                self.assertLess(abs(t["out.vector"] * UNIT - wanted).max(), 1e-10)
        self.assertGreater(crossed, 20)

    @staticmethod
    def integrate(model, t, steps):
        """Velocity Verlet of dumbbells between walls, all at once. y, v at the end; hits of each particle."""
        k, _, depth, reach = model["in.spring"][0]
        reach /= math.sqrt(k)
        height, slip, a = model["in.box"][0][1], model["in.boundary"][0][1], model["in.reals"][0][3:6].copy()
        a[1] = 0.0
        n, dt = len(t["in.vector"]), t["in.time"][0][0] / steps
        x = (t["in.position"][:2 * n] * UNIT).reshape(n, 2, 3)
        x[:, 1, 0::2] = x[:, 0, 0::2] - (t["in.vector"] * UNIT)[:, 0::2]
        v, hits = t["in.velocity"][:2 * n].reshape(n, 2, 3).copy(), np.zeros((n, 2), int)

        def force():
            r, middle = x[:, 0] - x[:, 1], 0.5 * (x[:, 0, 1] + x[:, 1, 1])
            f = np.stack([-k * r, k * r], axis=1) + a
            f[:, :, 1] += (0.5 * depth / reach * ((middle > height - reach) * 1.0 - (middle < reach)))[:, None]
            return f

        for _ in range(steps):
            v += 0.5 * dt * force()
            x += dt * v
            for wall, beyond in ((0, x[:, :, 1] < 0.0), (1, x[:, :, 1] > height)):
                late = np.where(beyond, (x[:, :, 1] - wall * height) / np.where(beyond, v[:, :, 1], 1.0), 0.0)
                after = v * (1.0, -1.0, 1.0) if slip else np.stack(
                    [2 * t["in.wall"][wall][0] - v[..., 0], -v[..., 1], 2 * t["in.wall"][wall][2] - v[..., 2]], axis=-1)
                x += np.where(beyond[..., None], late[..., None] * (after - v), 0.0)
                v = np.where(beyond[..., None], after, v)
                hits += beyond
            v += 0.5 * dt * force()
        return x, v, hits

    def test_flights_between_walls(self):
        """Those of small steps, dumbbells with several hits among them. A step of 2e-4 t0 at accelerations of some 20 a0/t0^2 puts
        a velocity wrong by 4e-3 a0/t0 and a place by as much times the flight; a hit forgotten is wrong by 0.1 and more."""
        several = 0
        for name in ("walls", "slip"):
            model = self.pack[name]["model", 0]
            edge = model["in.box"][0]
            for t in flights(self.pack[name], "dumbbell_wall_stream"):
                n = len(t["in.vector"])
                x, v, hits = self.integrate(model, t, 4000)
                ours = (t["out.position"][:2 * n] * UNIT).reshape(n, 2, 3)
                off = ours - x
                off[..., 0::2] -= edge[0::2] * np.rint(off[..., 0::2] / edge[0::2])
                self.assertLess(abs(off).max(), 1e-2, name)
                self.assertLess(abs(t["out.velocity"][:2 * n].reshape(n, 2, 3) - v).max(), 4e-2, name)
                several += np.count_nonzero(hits.sum(axis=1) > 1)
                self.assertGreater(np.count_nonzero(hits), 5, name)
        self.assertGreater(several, 5)

    def test_start_is_a_sample(self):
        """Components of the vectors have the variance kT/K, and the particles are half of a vector from the center."""
        model, t = self.pack["periodic"]["model", 0], flights(self.pack["periodic"], "dumbbell_start")[0]
        r, edge = t["out.vector"] * UNIT, model["in.box"][0]
        apart = (t["out.position"][0::2] - t["out.position"][1::2]) * UNIT - r
        self.assertLess(abs(apart - edge * np.rint(apart / edge)).max(), 1e-11)
        squares = model["in.spring"][0][0] * (r * r).ravel()
        self.assertLess(abs(squares.mean() - 1.0), 5.0 * math.sqrt(2.0 / len(squares)))


if __name__ == "__main__":
    unittest.main()
