#!/usr/bin/python3
"""All constructed inputs of reference-data/ are what reference-data/construct makes. A minute."""
import gzip
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "oracle"))
from packs import TOP, check_constructed, run  # noqa: E402


class Constructed(unittest.TestCase):
    def test_crossing(self):
        check_constructed(self, "edges", "crossing")

    def test_contact_search(self):
        check_constructed(self, "contacts", "contact_search")

    def test_meetings(self):
        check_constructed(self, "topology/meetings", "meeting")

    def test_touches(self):
        data = TOP / "reference-data"
        for scene in "tubes/mixed", "beads/company":
            with tempfile.TemporaryDirectory() as folder:
                emitted, longer, pack = (pathlib.Path(folder) / word for word in ("emitted.h5", "longer.h5", "pack.h5"))
                self.assertEqual(run("emit", data / f"{scene}.yaml", "-o", emitted), (0, ""))
                subprocess.run([data / "construct", "touches", emitted, longer], check=True)
                self.assertEqual(run("answer", "--whole", longer, pack), (0, ""))
                self.assertEqual(pack.read_bytes(), (data / f"{scene}.pack.h5").read_bytes())


if __name__ == "__main__":
    unittest.main()
