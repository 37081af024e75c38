#!/usr/bin/python3
"""The displacement relative to the cage (validation/measure/cage.py), of networks whose motion is made here."""
import importlib.util
import pathlib
import unittest

import numpy

TREE = pathlib.Path(__file__).resolve().parent.parent.parent
spec = importlib.util.spec_from_file_location("cage", TREE / "validation/measure/cage.py")
cage = importlib.util.module_from_spec(spec)
spec.loader.exec_module(cage)

EDGES = numpy.array([10.0, 10.0, 10.0])


def straight(fibers=200, vertices=21, bond=0.5, seed=7):
    """Straight fibers of any direction, anywhere in the box."""
    rng = numpy.random.default_rng(seed)
    direction = rng.normal(size=(fibers, 1, 3))
    direction /= numpy.linalg.norm(direction, axis=2, keepdims=True)
    along = bond * (numpy.arange(vertices) - vertices // 2)[None, :, None]
    return rng.uniform(size=(fibers, 1, 3)) * EDGES + along * direction, direction


class Cage(unittest.TestCase):
    def test_a_shift_of_all_is_taken_off(self):
        start, _ = straight()
        shift = numpy.array([0.4, -0.3, 0.2])
        (means, _), = cage.measure([start, start + shift, start + shift], EDGES, 3.0).values()
        self.assertLess(means[1].max(), 1e-20)
        # Of the second origin nothing moves. P leaves 2/3 of the shift's square, on average over directions: |s|^2 (1 - cos^2).
        expected, error = 0.5 * shift @ shift * 2.0 / 3.0, 0.5 * shift @ shift * numpy.sqrt(4.0 / 45.0 / len(start))
        self.assertLess(abs(means[0].mean() - expected), 4.0 * error)

    def test_sliding_along_itself_moves_nobody(self):
        start, direction = straight()
        rng = numpy.random.default_rng(8)
        now = start + 1.3 * rng.uniform(-1, 1, size=(len(start), 1, 1)) * direction
        (means, _), = cage.measure([start, now, now], EDGES, 3.0).values()
        self.assertLess(means.max(), 1e-20)

    def test_neighbors_of_their_own_mind_only_add(self):
        """Each fiber goes sideways by its own Gaussian vector, of variance 0.01 per component: d2 is 0.02, halved by the second
        origin. C has nothing to do with it, of one's own cage or of another's: both add the same."""
        start, direction = straight(fibers=100)
        rng = numpy.random.default_rng(9)
        move = 0.1 * rng.normal(size=direction.shape)
        move -= (move * direction).sum(axis=2, keepdims=True) * direction
        (means, _), = cage.measure([start, start + move, start + move], EDGES, 3.0).values()

        def judged(values):
            return values.mean(), values.std(ddof=1) / numpy.sqrt(len(values))
        for values, expected in ((means[0], 0.01), (means[1] - means[2], 0.0)):
            mean, error = judged(values)
            self.assertLess(abs(mean - expected), 4.0 * error)
        added, error = judged(means[1] - means[0])
        self.assertGreater(added, 4.0 * error)

    def test_neighbors_are_found_across_the_faces(self):
        start = numpy.zeros((2, 5, 3))
        start[0, :, 0] = numpy.arange(5) - 2.0 + 0.2  # along x; the other one along y
        start[1, :, 1] = numpy.arange(5) - 2.0 + 5.0
        start[1, :, 0] = 9.9
        start[:, :, 2] = 9.0
        owner, fiber, vertex = cage.neighbors(start, EDGES, 1.0)
        self.assertEqual(len(owner), 0)
        start[1, :, 1] -= 5.0
        owner, fiber, vertex = cage.neighbors(start, EDGES, 1.0)
        # Through the face, the middle of 0 (x = 0.2) and the vertex before it (x = 9.2) are 0.3 and 0.7 from that of 1 (x = 9.9).
        self.assertEqual(sorted(zip(owner, fiber, vertex)), [(0, 1, 2), (1, 0, 1), (1, 0, 2)])


if __name__ == "__main__":
    unittest.main()
