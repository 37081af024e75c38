#!/usr/bin/python3
"""The pack topology/meetings: its verdicts are those of two exact codes that know nothing of the program; a port answers it."""
import collections
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
from packs import TOP, run

sys.dont_write_bytecode = True
sys.path[:0] = [str(TOP / part) for part in ("python", "tests/topology")]
import sturm  # noqa: E402
from uncross_topology import exact  # noqa: E402

PACK = TOP / "reference-data/topology/meetings.pack.h5"
IN = "p", "q", "w", "p_last", "q_last", "w_last"


def rows():
    with h5py.File(PACK) as file:
        tables = file["meeting.1"]
        vectors = [tables[f"in.{name}"][:].tolist() for name in IN]
        return list(zip(zip(*vectors), tables["out.class"][:].ravel().tolist(), tables["out.sign"][:].tolist()))


class Meetings(unittest.TestCase):
    def test_verdicts(self):
        count = collections.Counter()
        for vectors, kind, signs in rows():
            p, q, w = (exact.linear(vectors[k], vectors[k + 3]) for k in range(3))
            found = exact.meetings(p, q, w)
            self.assertEqual((kind, [s for s in signs if s]), (2, []) if found.touched else (int(bool(found.crossings)), [c.sign for c in found.crossings]))
            seen, touched = sturm.meet(*(vectors[k + 3 * t] for k in range(3) for t in (0, 1)))
            self.assertEqual((found.touched, [c.sign for c in found.crossings]), (touched, seen))
            count[kind, len(found.crossings)] += 1
            if found.touched:  # of the special places only those that docs/port/packs.md speaks of
                self.assertTrue(exact.dot(exact.cross(p, q), w))
        for kind in ((0, 0), (1, 1), (1, 2), (1, 3), (2, 0)):
            self.assertGreaterEqual(count[kind], 2, kind)

    def test_the_pack_is_of_this_program_and_a_port_answers_it(self):
        with tempfile.TemporaryDirectory() as folder:
            made, theirs = pathlib.Path(folder) / "made.h5", pathlib.Path(folder) / "port.h5"
            self.assertEqual(run("answer", "--whole", PACK, made), (0, ""))
            self.assertEqual(run("compare", PACK, made)[0], 0)
            subprocess.run([TOP / "ports/numpy/port", PACK, theirs], check=True)
            status, said = run("compare", PACK, theirs)
            self.assertEqual(status, 0, said)

    def test_what_is_out_of_reach_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            text = pathlib.Path(folder) / "far.txt"
            text.write_text(run("dump", "--decimal", PACK)[1].replace("meeting 1 0 in.p.x ", f"meeting 1 0 in.p.x {2**52}\n# "))
            status, said = run("answer", text, pathlib.Path(folder) / "out.h5")
            self.assertEqual(status, 2)
            self.assertIn("meeting", said)


if __name__ == "__main__":
    unittest.main()
