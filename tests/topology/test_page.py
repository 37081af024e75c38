#!/usr/bin/python3
"""`uncross topology --page`: what is on it, where its lines are drawn, and what is refused."""
import base64
import html
import os
import pathlib
import re
import sys
import unittest

import numpy

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, UNCROSS, FolderTest, uncross  # noqa: E402

sys.path.insert(0, str(TOP / "python"))
os.environ["UNCROSS"] = str(UNCROSS)
from uncross_topology import crossings, page, readers  # noqa: E402

RING = [(-1, -1), (1, -1), (1, 1), (-1, 1)]


def of_ring(shifts, closed=True):
    """Frames: a square ring at these places along x, and a bond along z, or another ring about it."""
    about = "B 0 0.25 -5\nB 0 0.125 5\n" + ("B 60 0.25 5.5\nB 60 0.125 -5.5\n" if closed else "")
    return "".join(f"{8 if closed else 6}\n\n" + "".join(f"A {x + shift} {y} 0\n" for x, y in RING) + about for shift in shifts)


class Page(FolderTest):
    def page_of(self, code, *words):
        (self.dir / "bonds").write_text("1 2\n2 3\n3 4\n4 1\n5 6\n6 7\n7 8\n8 5\n")
        done = uncross("topology", "rings.xyz", "--bonds", "bonds", "--page", "page.html", *words, cwd=self.dir)
        self.assertEqual(done.returncode, code, done.stderr)
        return html.unescape((self.dir / "page.html").read_text())

    def test_rings_that_become_linked(self):
        (self.dir / "rings.xyz").write_text(of_ring((-2.5, -0.5, -0.375)))
        text = self.page_of(10, "--every-step")
        self.assertIn("CROSSED: if vertices move straight", text)
        self.assertIn("3 frames, 8 bonds: 2 rings", text)
        self.assertIn("First crossed: between frames 0 and 1, bonds 2 3 and 5 6", text)
        self.assertRegex(text, r"It has changed for 1 of them")
        self.assertRegex(text, r"<tr><td class=\"n\">[-+]1</td><td class=\"n\">0</td><td class=\"n\">1</td></tr>")
        self.assertEqual(text.count("data:image/svg+xml;base64,"), 2)
        for picture in re.findall(r"base64,([^\"]+)", text):
            self.assertTrue(base64.b64decode(picture).startswith(b"<svg"))

    def test_nothing_crossed(self):
        (self.dir / "rings.xyz").write_text(of_ring((-0.5, -0.375)))
        text = self.page_of(0)
        self.assertNotIn("first crossing", text)
        self.assertIn("It has not changed for any", text)
        self.assertIn("cannot be certified", text)

    def test_what_is_drawn(self):
        """Both bonds go through the middle when they meet, and the second one does not before and after."""
        (self.dir / "rings.xyz").write_text(of_ring((-2.5, -0.5)))
        (self.dir / "bonds").write_text("1 2\n2 3\n3 4\n4 1\n5 6\n6 7\n7 8\n8 5\n")
        reader = readers.open_file(str(self.dir / "rings.xyz"), {"--bonds": str(self.dir / "bonds")})
        self.addCleanup(reader.close)
        first, last = list(reader.frames())
        finder = crossings.Finder(reader.topology)
        self.addCleanup(finder.close)
        [meeting] = finder.between(first, last).crossings
        scene = page.Scene(reader.topology, first, last, meeting)
        x, y, z = scene.axes()
        numpy.testing.assert_allclose([x @ y, y @ z, z @ x], 0, atol=1e-12)
        for which, bond in enumerate(scene.bonds):
            ends = scene.places(meeting.t, bond, which)
            numpy.testing.assert_allclose(numpy.cross(*ends), 0, atol=1e-6)  # on one line with the middle
            self.assertLess(ends[0] @ ends[1], 0)  # between the ends
        self.assertAlmostEqual(meeting.t, 0.75, 6)
        here = scene.places(0.0, scene.bonds[0], 0)
        begin = scene.places(0.0, scene.bonds[1], 1) - (here[0] + meeting.s * (here[1] - here[0]))
        self.assertGreater(numpy.abs(begin @ z).min(), 1.4)  # 1.5 of 2 units of the way are still to go
        self.assertEqual([len(scene.beside(which)) for which in (0, 1)], [5, 5])

    def test_refused(self):
        (self.dir / "rings.xyz").write_text(of_ring((-2.5, -0.5)))
        (self.dir / "page.html").write_text("mine")
        done = uncross("topology", "rings.xyz", "--ring", "4", "--page", "page.html", cwd=self.dir)
        self.assertEqual((done.returncode, (self.dir / "page.html").read_text()), (2, "mine"))
        self.assertIn("page.html: exists; nothing is written over", done.stderr)
        done = uncross("topology", "rings.xyz", "--ring", "4", "--page", "no/page.html", cwd=self.dir)
        self.assertEqual(done.returncode, 4)
        done = uncross("topology", "rings.xyz", "--ring", "4", "--page", "other.html", "--links", "last", cwd=self.dir)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--page is of crossings between frames", done.stderr)


if __name__ == "__main__":
    unittest.main()
