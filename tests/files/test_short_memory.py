"""Memory that runs short while a run is begun or resumed (ulimit -v): the program says so with an exit code of its own. No file
is called damaged or moved for it, and a resumed folder stays as it was. Needs UNCROSS."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from damage import SCENE  # noqa: E402
from support import UNCROSS, uncross  # noqa: E402

STEP = 200  # KiB; windows in which one sort of failure was seen are 200 to 1000 KiB wide
BELOW = 60  # limits below the first one with which all goes well


@unittest.skipIf("ASAN_OPTIONS" in os.environ, "sanitizers map terabytes")
class ShortMemory(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.dir = pathlib.Path(place.name)
        (self.dir / "s.yaml").write_text(SCENE)
        uncross("run", "s.yaml", "--out", "begun", "--steps", "10", "--quiet", cwd=self.dir, check=True)

    def limited(self, kib, *words):
        return subprocess.run(["bash", "-c", f'ulimit -v {kib}; exec "$@"', "limited", UNCROSS, *words], cwd=self.dir,
                              capture_output=True, text=True, check=False)

    def loads(self, kib):
        """Whether the libraries can be loaded at all: with less, the initializers of some (GnuTLS) end the process by a signal."""
        return self.limited(kib, "--version").returncode == 0

    def try_all(self, act):
        """act(limit): True if the work was done. From a limit that is enough, downwards, as long as the program can be loaded."""
        def done(limit):
            return self.loads(limit) and act(limit)

        few, many = 4000, 400000
        self.assertTrue(done(many))
        while many - few > STEP:
            middle = (few + many) // 2
            few, many = (few, middle) if done(middle) else (middle, many)
        for limit in range(many - STEP, many - BELOW * STEP, -STEP):
            done(limit)

    def test_resume(self):
        folder = self.dir / "run"
        whole = {path.name: path.read_bytes() for path in (self.dir / "begun").iterdir()}

        def act(limit):
            shutil.rmtree(folder, ignore_errors=True)
            shutil.copytree(self.dir / "begun", folder)
            done = self.limited(limit, "run", "s.yaml", "--out", "run", "--resume", "--quiet")
            told = f"ulimit -v {limit}: {done.returncode}: {done.stderr}"
            self.assertIn(done.returncode, (0, 1, 2, 4), told)
            self.assertNotRegex(done.stderr, "damaged|dies of it", told)
            self.assertEqual(list(folder.glob("*.damaged*")), [], told)
            if done.returncode != 0:
                self.assertNotEqual(done.stderr, "", told)
                left = {path.name: path.read_bytes() for path in folder.iterdir()}
                if left != whole:  # it had begun
                    self.assertEqual(json.loads(left["run.json"])["status"], "stopped", told)
                    told += uncross("run", "s.yaml", "--out", "run", "--resume", "--quiet", cwd=self.dir).stderr
                    self.assertEqual(uncross("verify", "run", cwd=self.dir).returncode, 0, told)
            return done.returncode == 0

        self.try_all(act)

    def test_readers(self):
        """What HDF5 is not asked for is no bad input."""
        few, enough = 4000, 400000  # to be loaded
        while enough - few > STEP:
            middle = (few + enough) // 2
            few, enough = (few, middle) if self.loads(middle) else (middle, enough)
        for words in (["info", "begun/checkpoint.h5"], ["info", "begun"], ["frames", "begun/trajectory.h5"],
                      ["analyze", "begun/trajectory.h5", "--out", "tables"],
                      ["run", "s.yaml", "--out", "begun", "--resume", "--quiet"]):
            done = self.limited(enough + 4000, *words)
            self.assertEqual(done.returncode, 1, f"{words}: {done.stderr}")
            self.assertRegex(done.stderr, "memory")

    def test_new_run(self):
        folder = self.dir / "run"

        def act(limit):
            shutil.rmtree(folder, ignore_errors=True)
            done = self.limited(limit, "run", "s.yaml", "--out", "run", "--quiet")
            told = f"ulimit -v {limit}: {done.returncode}: {done.stderr}"
            self.assertIn(done.returncode, (0, 1, 2, 4), told)
            self.assertTrue(done.returncode == 0 or done.stderr, told)
            self.assertFalse(re.search("damaged|exists", done.stderr), told)
            self.assertTrue(done.returncode == 0 or not folder.exists() or (folder / "checkpoint.h5").exists(), told)
            return done.returncode == 0

        self.try_all(act)


if __name__ == "__main__":
    unittest.main()
