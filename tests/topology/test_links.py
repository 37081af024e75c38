#!/usr/bin/python3
"""Links and knots of one frame: python/uncross_topology, `uncross links`.

Expected numbers are of torus knots' formula, of standard tables, of Burau's matrices and of Gauss's integral (shapes.py), none of
which knows crossings or arcs."""
import os
import subprocess
import sys
import pathlib
import unittest

import numpy

sys.dont_write_bytecode = True
sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent), str(pathlib.Path(__file__).resolve().parents[1])]
from support import TOP, UNCROSS, FolderTest, uncross  # noqa: E402

sys.path.insert(0, str(TOP / "python"))
os.environ["UNCROSS"] = str(UNCROSS)
import shapes  # noqa: E402
from uncross_topology import diagram, frame as frames, knots, links  # noqa: E402

# Braids: V. F. R. Jones, Ann. Math. 126, 335 (1987), table; det and name from section 1.4's table and Rolfsen's.
BRAIDS = [("0_1", [1, -2], 3, 1), ("3_1 = T(2,3)", [1] * 3, 2, 3), ("4_1", [1, -2] * 2, 3, 5), ("5_1 = T(2,5)", [1] * 5, 2, 5),
          ("5_2", [1, 1, 1, 2, -1, 2], 3, 7), ("6_1 or 9_46", [1, 1, 2, -1, -3, 2, -3], 4, 9), ("6_2", [-1, 2, -1, 2, 2, 2], 3, 11),
          ("6_3", [-1, -1, 2, -1, 2, 2], 3, 13), ("8_19 = T(3,4)", [1, 1, 1, 2] * 2, 3, 3), ("10_124 = T(3,5)", [1, 2] * 5, 3, 1),
          ("3_1#3_1 or 8_20", [1, 1, 1, -2, -1, -1, -1, -2], 3, 9), ("3_1#3_1 or 8_20", [1] * 3 + [2] * 3, 3, 9),
          ("3_1#3_1 or 8_20", [1] * 3 + [-2] * 3, 3, 9)]
# Of links: |lk| of the pairs that have one.
LINKS = [("Hopf's link = T(2,2)", [1, 1], 2, 2, [1]), ("T(2,4)", [1] * 4, 2, 4, [2]), ("T(2,6)", [-1] * 6, 2, 6, [3]),
         ("Whitehead's link", [1, -2, 1, -2, -2], 3, 8, []), ("the Borromean rings", [1, -2] * 3, 3, 16, [])]
SIZE = 2**31


def on_lattice(polygons, size=SIZE):
    return [numpy.rint(size * polygon).astype(numpy.int64) for polygon in polygons]


def polynomial(polygons):
    status, _, found = links.find_polynomials(polygons, [[(k, (0, 0, 0)) for k in range(len(polygons))]])[0]
    assert status == diagram.FINE, diagram.WORDS[status]
    return found


def by_burau(word, strands):
    return knots.polynomial([shapes.alexander(word, strands, t, prime) for t, prime in diagram.FULL])


def frame_of(polygons, edge=None, offset=0):
    """A frame and its curves, all closed. Without an edge the box is not periodic."""
    ends = numpy.cumsum([0] + [len(polygon) for polygon in polygons])
    curves = [frames.Curve(list(range(a, b)), True) for a, b in zip(ends, ends[1:])]
    return frames.Frame(0, 0.0, edge or [2**40] * 3, [edge is not None] * 3, offset, None, numpy.concatenate(polygons)), curves


def views(polygons, rng):
    """The same curves turned at random, begun elsewhere, backwards, in another order, mirrored."""
    turn = shapes.turned(rng) * (-1 if rng.random() < 0.5 else 1)
    seen = [numpy.roll(polygon @ turn, rng.integers(len(polygon)), axis=0)[::rng.choice([-1, 1])] for polygon in polygons]
    return [seen[k] for k in rng.permutation(len(seen))]


class Knots(unittest.TestCase):
    def test_table_in_twenty_views(self):
        rng = numpy.random.default_rng(1)
        for name, word, strands, det in BRAIDS:
            braid = shapes.closed_braid(word, strands)
            expected = by_burau(word, strands)
            seen = [on_lattice(views(braid, rng))[0] for _ in range(20)]
            for knot in links.find_knots(seen):
                self.assertEqual((knot.polynomial, knot.polynomial.det, knot.name), (expected, det, name))

    def test_torus_knots(self):
        """det is 1 if both numbers are odd, else the odd one; in the fewest crossings min(p(q - 1), q(p - 1))."""
        for p, q in ((2, 3), (3, 2), (2, 5), (2, 7), (3, 4), (3, 5), (5, 3), (3, 7), (4, 5), (5, 6)):
            (_, crossings, found), = links.find_polynomials(on_lattice(shapes.torus(p, q)), [[(0, (0, 0, 0))]])
            self.assertEqual(found, knots.of_coefficients(knots.torus(p, q)))
            self.assertEqual(found.det, 1 if p * q % 2 else p if p % 2 else q)
            self.assertGreaterEqual(crossings, min(p * (q - 1), q * (p - 1)))

    def test_random_braids(self):
        """Composite knots and links of up to five strands and sixty crossings."""
        rng = numpy.random.default_rng(2)
        for _ in range(60):
            strands = int(rng.integers(2, 6))
            word = (rng.integers(1, strands, size=rng.integers(1, 60)) * rng.choice([-1, 1])).tolist()
            word = [letter * int(rng.choice([-1, 1], p=[0.3, 0.7])) for letter in word]
            self.assertEqual(polynomial(on_lattice(shapes.closed_braid(word, strands))), by_burau(word, strands), (strands, word))

    def test_polynomials_of_the_table_differ(self):
        self.assertEqual(len(knots.BY_KNOT), len(knots.KNOTS))
        self.assertEqual(len(knots.BY_LINK), len(list(knots.link_names())) - 1)  # Hopf's link is the same in both orientations

    def test_large_determinant(self):
        """3^100 is more than two primes tell, and said to be; twenty trefoils in a row have 3^20."""
        self.assertIsNone(knots.polynomial([pow(3, 100, prime) for _, prime in diagram.FULL]).det)
        self.assertEqual(polynomial(on_lattice(shapes.closed_braid([k for k in range(1, 21) for _ in range(3)], 21))).det, 3**20)


class Links(unittest.TestCase):
    def test_table_in_twenty_views(self):
        rng = numpy.random.default_rng(3)
        for name, word, strands, det, numbers in LINKS:
            braid = shapes.closed_braid(word, strands)
            self.assertEqual(polynomial(on_lattice(braid)), by_burau(word, strands), name)
            for _ in range(20):
                seen = on_lattice(views(braid, rng))
                found = polynomial(seen)
                pairs, _ = links.find_pairs(frame_of(seen)[0], seen)
                self.assertEqual(sorted(abs(pair.lk) for pair in pairs if pair.lk), numbers)
                self.assertEqual((found.det, knots.link_name(len(seen), numbers, found)), (det, name))
                self.assertEqual([pair.name for pair in pairs], [name] if len(seen) == 2 else [])

    def test_words(self):
        """lk = 0 is never called unlinked."""
        for word, pairs in (([1, -2, 1, -2, -2], "lk = 0, det = 8, Whitehead's link"), ([1, 1], "lk = 1, det = 2, Hopf's link = T(2,2)")):
            polygons = on_lattice(shapes.closed_braid(word, max(map(abs, word)) + 1))
            text = "\n".join(links.lines(links.look(*frame_of(polygons))))
            self.assertIn(f"rings 0 and 1, image 0 0 0: {pairs}", text)
            self.assertNotIn("unlinked", text)
        apart = on_lattice([shapes.torus(1, 1)[0], shapes.torus(1, 1)[0] + [1.2, 1, 1]])
        self.assertIn("all others: lk = 0 and det = 0", "\n".join(links.lines(links.look(*frame_of(apart)))))

    def test_only_delta(self):
        """A link with lk = 0 and det = 0 whose Delta is not 0: found among random braids by Burau's matrices."""
        word = [-2, 1, 2, 1, 3, -1, -2, 3, 1, -2, 3, -1, 2, -1]
        self.assertEqual(by_burau(word, 4).det, 0)
        found = links.look(*frame_of(on_lattice(shapes.closed_braid(word, 4))))
        self.assertEqual([(pair.lk, pair.polynomial) for pair in found.pairs], [(0, by_burau(word, 4))])
        self.assertIn("lk = 0, det = 0 (but Delta is not 0)", "\n".join(links.lines(found)))

    def test_gauss_integral(self):
        """Random closed walks in a small box, each pair and image, own images too; in a sheared box as well."""
        rng = numpy.random.default_rng(4)
        for offset in (0, -17 * 2**32 + 12345):
            steps = rng.normal(size=(5, 30, 3))
            at = numpy.cumsum(steps - steps.mean(axis=1, keepdims=True), axis=1) * 0.8 + rng.uniform(-9, 9, size=(5, 1, 3))
            polygons = on_lattice(at, 2**32)
            frame, _ = frame_of(polygons, [3 * 2**32, 4 * 2**32, 3 * 2**32], offset)
            pairs, _ = links.find_pairs(frame, polygons)
            lk = {(pair.one, pair.other, pair.image): pair.lk for pair in pairs if pair.lk}
            self.assertGreater(len(lk), 20)
            self.assertTrue(any(one == other for one, other, _ in lk))
            expected = {}
            for one in range(5):
                for other in range(one, 5):
                    for image in numpy.ndindex(37, 15, 19):
                        image = image[0] - 18 - round((image[1] - 7) * offset / frame.edge[0]), image[1] - 7, image[2] - 9
                        shift = numpy.array(frames.image(frame, image))
                        a, b = polygons[one], polygons[other] + shift
                        if (one == other and image <= (0, 0, 0)) or (a.max(0) < b.min(0)).any() or (b.max(0) < a.min(0)).any():
                            continue
                        number = shapes.gauss(a / 2**32, b / 2**32)
                        self.assertAlmostEqual(number, round(number), 6)
                        if round(number):
                            expected[one, other, image] = round(number)
            self.assertEqual(lk, expected)

    def test_candidates(self):
        """All images whose boxes overlap, against a loop over many more: slides of less than an edge, and of turns, to both sides."""
        rng = numpy.random.default_rng(7)
        edge = 2**20
        for offset in [int(x) for x in rng.uniform(-0.5, 0.5, size=12) * edge] + [0, 3 * edge + 7, -3 * edge - 7]:
            low = rng.integers(-edge, edge, size=(6, 3))
            polygons = [numpy.stack([a, a + rng.integers(edge // 2, edge, size=3), a]) for a in low]
            frame, _ = frame_of(polygons, [edge] * 3, offset)
            found = {(i, j, *image) for i, j, image in zip(*(part.tolist() for part in links.candidates(frame, polygons)[:2]),
                                                           map(tuple, links.candidates(frame, polygons)[2].tolist()))}
            cells = numpy.stack(numpy.meshgrid(*[numpy.arange(-5, 6)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
            cells[:, 0] -= cells[:, 1] * round(offset / edge)
            shifts = numpy.array([frames.image(frame, cell) for cell in cells])
            expected = set()
            for i in range(6):
                for j in range(i, 6):
                    a, b = polygons[i], polygons[j]
                    meet = numpy.all((a.min(0) <= b.max(0) + shifts) & (b.min(0) + shifts <= a.max(0)), axis=1)
                    expected |= {(i, j, *cell) for cell in cells[meet].tolist() if i < j or tuple(cell) > (0, 0, 0)}
            # of a ring's own images either of two may be taken
            self.assertEqual({key if key[0] < key[1] else (*key[:2], *max(key[2:], tuple(-x for x in key[2:]))) for key in found},
                             {key if key[0] < key[1] else (*key[:2], *max(key[2:], tuple(-x for x in key[2:]))) for key in expected}, offset)

    def test_images(self):
        """The multiset of linking numbers does not change if curves are moved by images, begun elsewhere or turned round."""
        rng = numpy.random.default_rng(5)
        chain = [shapes.torus(1, 1, 30)[0] @ turn + [3.0 * k, 0, 0] for k, turn in enumerate((numpy.eye(3), numpy.eye(3)[[0, 2, 1]]) * 2)]
        for offset in (0, 5 * SIZE + 77):
            seen = set()
            for _ in range(6):
                frame, _ = frame_of(on_lattice(chain), [12 * SIZE, 9 * SIZE, 9 * SIZE], offset)
                moved = [numpy.roll(polygon, rng.integers(30), axis=0)[::rng.choice([-1, 1])] + numpy.array(frames.image(frame, rng.integers(-3, 4, size=3)))
                         for polygon in on_lattice(chain)]
                frame, curves = frame_of([moved[k] for k in rng.permutation(4)], frame.edge, offset)
                found = links.look(frame, curves)
                seen.add((tuple(sorted((abs(pair.lk), pair.polynomial.det) for pair in found.pairs)), tuple((len(g.curves), g.wound) for g in found.groups)))
            self.assertEqual(seen, {(((1, 2),) * 4, ((4, True),))})  # the fourth is linked with the first, an image on

    def test_group(self):
        """A chain of three: det is the product of that of its parts, for a connected sum."""
        polygons = on_lattice(shapes.closed_braid([1, 1, 2, 2, 2, 2], 3))
        found = links.look(*frame_of(polygons))
        self.assertEqual([(len(g.curves), g.polynomial.det, g.polynomial) for g in found.groups], [(3, 8, by_burau([1, 1, 2, 2, 2, 2], 3))])

    def test_split(self):
        """The polynomial of curves of which one lies above all others, or beside them, is 0; and so is it of interlaced ones that are split."""
        trefoil, circle = shapes.torus(2, 3)[0], shapes.torus(1, 1)[0]
        for shift in ([0, 0, 9], [0, 0, -9], [9, 0, 0]):
            self.assertEqual(polynomial(on_lattice([trefoil, circle + shift])).det, 0)
            self.assertEqual(polynomial(on_lattice([circle + shift, trefoil])).det, 0)
        self.assertFalse(any(map(any, polynomial(on_lattice(shapes.closed_braid([1, -1, 1, -1, 2, 3, 3], 4)[:2])).values)))

    def test_apart(self):
        """Random small rings in cells of their own, and each above the next: no pair is reported."""
        rng = numpy.random.default_rng(6)
        places = numpy.stack(numpy.meshgrid(*[numpy.arange(4)] * 3), axis=-1).reshape(-1, 3)
        polygons = on_lattice([rng.uniform(0, 0.99, size=(12, 3)) + place for place in places])
        found = links.look(*frame_of(polygons, [4 * SIZE] * 3))
        self.assertEqual((found.pairs, found.groups, len(found.knots)), ([], [], 64))


class Special(unittest.TestCase):
    """On a coarse lattice most places are special for a projection."""

    def test_coarse_lattice(self):
        for name, word, strands, det in BRAIDS:
            self.assertEqual(polynomial(on_lattice(shapes.closed_braid(word, strands), 8)).det, det, name)

    def test_along_the_axes(self):
        """Two squares of unit bonds, each through the other; and one beside the other, in its plane."""
        square = numpy.array([(x, 0, 0) for x in range(4)] + [(4, y, 0) for y in range(4)] + [(x, 4, 0) for x in range(4, 0, -1)]
                             + [(0, y, 0) for y in range(4, 0, -1)])
        for other, expected in ((square[:, [1, 2, 0]] + [2, 2, -2], [1]), (square + [6, 0, 0], []), (square + [0, 0, 1], []), (2 * square + [-2, -2, 0], [])):
            pairs, _ = links.find_pairs(frame_of([square, other])[0], [square, other])
            self.assertEqual([abs(pair.lk) for pair in pairs], expected)

    def test_touched(self):
        square = numpy.array([(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)])
        for other in (square + [4, 4, 0], square + [1, 0, 0], square[:, [1, 2, 0]] + [2, 4, -2], square[:, [1, 2, 0]] + [4, 2, -2]):
            (pair,), _ = links.find_pairs(frame_of([square, other])[0], [square, other])
            self.assertIn(pair.status, (diagram.TOUCHED, diagram.SPECIAL))
            self.assertIsNone(pair.lk)
        for fold in ([(0, 0, 0), (4, 0, 0), (2, 0, 0), (2, 5, 1)], [(0, 0, 0), (4, 0, 0), (-2, 0, 0), (2, 5, 1)]):
            (status, _, _), = links.find_polynomials([numpy.array(fold)], [[(0, (0, 0, 0))]])
            self.assertIn(status, (diagram.TOUCHED, diagram.SPECIAL))

    def test_nearly_touching(self):
        """One lattice unit apart, above or below."""
        square = 2**36 * numpy.array([(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)])
        for unit, expected in ((-1, 0), (1, 1)):
            other = 2**36 * (numpy.array([(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)])[:, [1, 2, 0]] + [2, 4, -2]) - [0, unit, 0]
            pairs, _ = links.find_pairs(frame_of([square, other])[0], [square, other])
            self.assertEqual([abs(pair.lk) for pair in pairs if pair.lk], [1] * expected)

    def test_no_length(self):
        trefoil = on_lattice(shapes.torus(2, 3))[0]
        frame, curves = frame_of([numpy.repeat(trefoil, 2, axis=0)])
        self.assertEqual(links.look(frame, curves).knots[0].name, "3_1 = T(2,3)")

    def test_closed_through_the_box(self):
        for edge, offset in (([2**34, 2**35, 2**35], 0), ([2**35, 2**34, 2**35], 2**33 + 5)):
            line = numpy.linspace(0, 1, 8, endpoint=False)[:, None] * ([2**34, 0, 0] if not offset else [offset, 2**34, 0])
            frame, curves = frame_of([numpy.rint(line).astype(numpy.int64)], edge, offset)
            with self.assertRaisesRegex(frames.Refused, "curve 0 .* closes only through the box"):
                links.look(frame, curves)

    def test_too_wide(self):
        wide = numpy.array([(0, 0, 0), (2**46, 0, 0), (5, 2**40, 7), (1, 2, 2**40)])
        self.assertEqual(links.find_polynomials([wide], [[(0, (0, 0, 0))]])[0][0], diagram.TOO_FAR)

    def test_too_many_crossings(self):
        trefoil = on_lattice(shapes.torus(2, 3))
        self.assertEqual(diagram.ask(trefoil, [1, 0, 0, 0, 0], diagram.FULL, most=2).status.tolist(), [diagram.TOO_MANY])


class Chains(unittest.TestCase):
    def test_closures(self):
        """A trefoil and a figure of eight that are open a little, with their ends drawn out; a straight chain has no knot."""
        for word, strands, name in (([1] * 3, 2, "3_1 = T(2,3)"), ([1, -2] * 2, 3, "4_1")):
            braid = shapes.closed_braid(word, strands)[0]
            first = int(numpy.argmax(numpy.linalg.norm(braid, axis=1)))
            chain = numpy.roll(braid, -first, axis=0)
            chain = numpy.concatenate([chain[:1] * 3 - [0, 0, 5], chain, chain[-1:] * 3 + [0, 0, 5]])
            frame, _ = frame_of(on_lattice([chain]))
            curves = [frames.Curve(list(range(len(chain))), False)]
            self.assertEqual(links.look(frame, curves).chains, [])
            found = links.look(frame, curves, "sphere")
            self.assertEqual(found.chains, [links.Chain(0, {name: 1})])
            names = links.look(frame, curves, "directions").chains[0].names
            self.assertEqual((sum(names.values()), max(names, key=names.get)), (100, name))
            self.assertIn("a sphere of 10 R_g", "\n".join(links.lines(found)))
        line = numpy.arange(10)[:, None] * numpy.array([3, 1, 2])
        frame, _ = frame_of([line * 2**31])
        self.assertEqual(links.look(frame, [frames.Curve(list(range(10)), False)], "sphere").chains[0].names, {"0_1": 1})


class Command(FolderTest):
    """`uncross topology --links` of XYZ: a Hopf link, and the same rings apart."""

    def topology(self, *words):
        path = self.dir / "rings.xyz"
        with open(path, "w", encoding="ascii") as file:
            for shift in 0, 7:
                one, other = shapes.torus(2, 2, 40)
                print(80, 'Lattice="9 0 0 0 9 0 0 0 9" Properties=species:S:1:pos:R:3', sep="\n", file=file)
                for x, y, z in numpy.concatenate([one, other + [0, 0, shift]]).tolist():
                    print("C", x, y, z, file=file)
        return uncross("topology", path, *words)

    def test_frames(self):
        for word, linked in ("first", True), ("0", True), ("1", False), ("last", False):
            done = self.topology("--ring", 40, "--links", word)
            self.assertEqual((done.returncode, "lk = 1, det = 2, Hopf's link" in done.stdout), (0, linked), done)
            self.assertIn("rings: 2; 0_1: 2\n", done.stdout)

    def test_no_box(self):
        path = self.dir / "triangle.xyz"
        path.write_text("3\nno box\nC 0 0 0\nC 1 0 0\nC 0 1 0\n")
        done = uncross("topology", path, "--ring", 3, "--links", "0")
        self.assertEqual((done.returncode, "rings: 1; 0_1: 1\n" in done.stdout), (0, True), done)

    def test_chains(self):
        self.assertIn("closed so: both ends go straight, away", self.topology("--chain", 40, "--links", "0", "--closure", "sphere").stdout)
        self.assertIn("rings: 0\n", self.topology("--chain", 40, "--links", "0").stdout)

    def test_refusals(self):
        for words, said in ((["--links", "2"], "the file has 2 frames"), (["--links", "all"], "not first, last"), (["--closure", "sphere"], "is of --links"),
                            (["--links", "0", "--every-step"], "--links looks at one frame"), (["--links", "0", "--csv", "none.csv"], "--links looks at one frame"),
                            (["--links", "0", "--closure", "chord"], "allowed: sphere, directions")):
            done = self.topology("--ring", 40, *words)
            self.assertEqual((done.returncode, done.stdout, said in done.stderr), (2, "", True), done)


class Program(unittest.TestCase):
    """`uncross links` refuses what it cannot read."""

    def links(self, *words):
        data = b"".join(numpy.array(word, dtype=numpy.uint64 if max(word, default=0) > 2**62 else numpy.int64).tobytes() for word in words)
        return subprocess.run([UNCROSS, "links"], input=data, capture_output=True, check=False)

    def test_refusals(self):
        triangle, good = [0, 0, 0, 9, 0, 0, 0, 9, 0], [diagram.FULL[0][0], diagram.FULL[0][1]]
        for words, said in (([[1]], "ends too early"), ([[1, 0, 9, 2], [0] * 6], "3 or more vertices"), ([[1, 17, 9, 3], triangle], "at most"),
                            ([[1, 1, 9, 3], triangle, [1, 97]], "primes"), ([[1, 1, 9, 3], triangle, [0, diagram.PRIMES[0]]], "t from 1"),
                            ([[1, 1, 9, 3], triangle, good, [1, 1, 0, 0, 0]], "not there"), ([[1, 1, 9, 3], triangle, good, [0]], "a job of 0"),
                            ([[1, 1, 9, 3], triangle, good, [1, 0]], "ends too early"), ([[1, 1, 9, 3], [2**61] + triangle[1:], good], "beyond")):
            done = self.links(*words)
            self.assertEqual((done.returncode, said in done.stderr.decode()), (2, True), (words, done))
        done = self.links([1, 1, 9, 3], triangle, good, [1, 0, 5, 5, 5])
        self.assertEqual((done.returncode, numpy.frombuffer(done.stdout, dtype=numpy.int64).tolist()), (0, [0] * 6 + [1]))


if __name__ == "__main__":
    unittest.main()
