#!/usr/bin/python3
"""All constructed inputs of reference-data/ are what reference-data/construct makes. Half a minute."""
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "oracle"))
from packs import check_constructed  # noqa: E402


class Constructed(unittest.TestCase):
    def test_crossing(self):
        check_constructed(self, "edges", "crossing")

    def test_contact_search(self):
        check_constructed(self, "contacts", "contact_search")


if __name__ == "__main__":
    unittest.main()
