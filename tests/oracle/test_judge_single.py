#!/usr/bin/python3
"""`uncross oracle judge` of a solvent in single precision: a port of wave.yaml in which every number is a float32 keeps the
bounds of what is conserved, and breaks them with small bugs. The port is written from Padding 2009, Eqs. (3), (5), (6),
with NumPy's random numbers."""
import math
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

TOP = pathlib.Path(__file__).resolve().parents[2]
UNCROSS = os.environ.get("UNCROSS", str(TOP / "build/uncross"))
EDGE, PER_CELL, INTERVAL, COLLISIONS, EVERY = 16, 5, 0.02, 160, 8
PARTICLES = EDGE**3 * PER_CELL
BLOCKS = 2  # of what is conserved two are enough
CONSERVED = "wave_energy_drift,wave_momentum_change"


def start(rng, number):
    """Positions, and velocities of a Maxwell distribution at rest with the wave added."""
    x, v = rng.random((PARTICLES, 3)) * EDGE, rng.standard_normal((PARTICLES, 3))
    phase = 2.0 * math.pi / EDGE * x[:, 1]
    v -= v.mean(axis=0)
    v[:, 0] += np.cos(phase)
    v[:, 2] += np.sin(phase)
    return x.astype(number), v.astype(number)


def collide(rng, x, v, number, length, left_out):
    """New velocities. length: of the axes; left_out: how many particles are turned and not summed."""
    shifted = np.floor(x + rng.random(3).astype(number)).astype(int) % EDGE
    cell = (shifted[:, 2] * EDGE + shifted[:, 1]) * EDGE + shifted[:, 0]
    order = np.argsort(cell, kind="stable")
    _, first, members = np.unique(cell[order], return_index=True, return_counts=True)
    weight = (order >= left_out).astype(number)[:, None]
    mass = np.maximum(np.add.reduceat(weight, first, dtype=number), number(1))
    center = np.repeat(np.add.reduceat(weight * v[order], first, dtype=number) / mass, members, axis=0)
    axis = rng.standard_normal((len(first), 3)).astype(number)
    axis *= number(length) / np.sqrt((axis * axis).sum(axis=1, dtype=number))[:, None]
    n, w = np.repeat(axis, members, axis=0), v[order] - center
    turned = center + n * (n * w).sum(axis=1, dtype=number)[:, None] + np.cross(n, w)
    assert turned.dtype == number
    new = np.empty_like(v)
    new[order] = np.where(np.repeat(members >= 2, members)[:, None], turned, v[order])
    return new


def block(number, seed, length=1.0, left_out=0):
    """Slope of E(t)/E(0), and the largest change of P over sqrt(3 M kT); both summed in doubles."""
    rng = np.random.default_rng(seed)
    x, v = start(rng, number)
    time, energy, momentum = [], [], []
    for k in range(COLLISIONS + 1):
        if k % EVERY == 0:
            time.append(k * INTERVAL)
            energy.append(np.sum(v.astype(float) ** 2))
            momentum.append(v.sum(axis=0, dtype=float))
        x = x + number(INTERVAL) * v
        x -= number(EDGE) * np.floor(x / number(EDGE))
        v = collide(rng, x, v, number, length, left_out)
    change = np.linalg.norm(np.array(momentum) - momentum[0], axis=1)
    return np.polyfit(time, np.array(energy) / energy[0], 1)[0], change.max() / math.sqrt(3.0 * PARTICLES)


class SinglePrecisionTest(unittest.TestCase):
    def judge(self, *how, **bug):
        """Which of both differ, and the root mean squares."""
        blocks = np.array([block(*how, seed, **bug) for seed in range(BLOCKS)])
        mean, error = blocks.mean(axis=0), blocks.std(axis=0, ddof=1) / math.sqrt(BLOCKS)
        with tempfile.TemporaryDirectory() as folder:
            table = pathlib.Path(folder) / "theirs.csv"
            table.write_text("observable,value,error,blocks,time\n" + "".join(
                f"{name},{m!r},{e!r},{BLOCKS},3.36\n" for name, m, e in
                zip(CONSERVED.split(","), mean.tolist(), error.tolist())))
            done = subprocess.run([UNCROSS, "oracle", "judge", TOP / "reference-data/observables.csv", table, "--only",
                                   CONSERVED], capture_output=True, text=True, check=False)
        differing = [line.split()[0] for line in done.stdout.splitlines() if line.endswith("DIFFERS")]
        self.assertEqual(done.returncode, 7 if differing else 0, done.stdout + done.stderr)
        return differing, np.sqrt((blocks**2).mean(axis=0))

    def test_single_precision_keeps_the_bounds(self):
        """docs/judging.md expects c u sqrt(n) = 3 2^-24 sqrt(160) = 2.3e-6 of the momentum, in order of magnitude."""
        differing, (energy, momentum) = self.judge(np.float32)
        self.assertEqual(differing, [])
        self.assertLess(energy, 1e-7)
        expected = 3.0 * 2.0**-24 * math.sqrt(COLLISIONS)
        self.assertTrue(0.3 * expected < momentum < 3.0 * expected, momentum)

    def test_small_bugs_break_them(self):
        self.assertEqual(self.judge(np.float32, length=1.00001)[0], ["wave_energy_drift"])
        self.assertIn("wave_momentum_change", self.judge(np.float32, left_out=1)[0])


if __name__ == "__main__":
    unittest.main()
