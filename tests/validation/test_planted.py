"""Bugs that claims should see (validation/planted): their cases and runs exist."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TREE / part) for part in ("validation", "python")]

from lib import case as cases
from uncross_name import entries


class Planted(unittest.TestCase):
    """That each can be planted: tools/mutants --check."""

    @classmethod
    def setUpClass(cls):
        bugs = [c for entry in entries.read(TREE / "mistakes") for c in entry.get("c", [])]
        cls.claims = [pair for bug in bugs for pair in bug.get("claims", {}).items()]

    def test_cases_and_runs_exist(self):
        for case, pattern in self.claims:
            with self.subTest(case=case, pattern=pattern):
                names = [run.name for run in cases.load(case).runs("quick")]
                self.assertTrue(any(re.fullmatch(pattern, name) for name in names))

    def test_the_program_reads_them(self):
        """With `none` it plants nothing, and prints the table of nothing."""
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([TREE / "validation/planted", "--build", folder, "none"], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr, done.stdout.splitlines()[-1]), (0, "", "0 passed, 0 failed"))

    def test_every_case_has_one(self):
        gated = {name for name in cases.names() if cases.load(name).runs("quick")}
        self.assertEqual(gated - {case for case, _ in self.claims} - {"cost"}, set())  # cost is a matter of time, not of bugs


if __name__ == "__main__":
    unittest.main()
