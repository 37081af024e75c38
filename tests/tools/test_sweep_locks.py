"""Sweeps on a file system without locks go on, with a warning. Needs UNCROSS and a C compiler."""
import errno
import json
import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "files"))
from damage import SCENE  # noqa: E402
from support import FolderTest, uncross  # noqa: E402
from test_locks import SOURCE  # noqa: E402


@unittest.skipIf("ASAN_OPTIONS" in os.environ, "a sanitizer must be loaded before all others")
class SweepLocks(FolderTest):
    def setUp(self):
        super().setUp()
        (self.dir / "flock.c").write_text(SOURCE)
        subprocess.run([os.environ.get("CC", "gcc"), "-shared", "-fPIC", "flock.c", "-o", "flock.so"], cwd=self.dir, check=True)
        (self.dir / "s.yaml").write_text(SCENE)

    def test_sweeps_go_on(self):
        done = uncross("sweep", "s.yaml", "--out", "sweep", "--seeds", "1..2", cwd=self.dir,
                       env=dict(os.environ, NO_LOCKS=str(errno.ENOLCK), LD_PRELOAD=str(self.dir / "flock.so")))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("uncross: sweep/.lock: locks cannot be had here (No locks available): see to it yourself that no "
                      "other process sweeps in this folder\n", done.stderr)
        records = list((self.dir / "sweep").glob("**/run.json"))
        self.assertEqual([json.loads(record.read_text())["status"] for record in records], ["finished"] * 2)


if __name__ == "__main__":
    unittest.main()
