"""Files of earlier releases (tests/files/kept, made by its `make` at each release): all releases of the same first number read them, and go on
from them to the same state.

A release that changes bits on purpose (CHANGELOG.md) reads the files all the same; its states then stand beside the old ones in expected.txt.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, UNCROSS, FolderTest  # noqa: E402

KEPT = sorted(path for path in (TOP / "tests/files/kept").iterdir() if path.is_dir())


class Kept(FolderTest):
    def call(self, *words, code=0):
        done = subprocess.run([str(word) for word in (UNCROSS, *words)], cwd=self.dir, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, code, f"{words}: {done.stdout}{done.stderr}")
        return done.stdout

    def hash(self, *words):
        return re.search(r"^state hash (\w+)$", self.call("run", *words), re.M)[1]

    def test_this_release_is_kept(self):
        version = re.search(r'UNCROSS_VERSION "(.*)"', (TOP / "src/version.h").read_text())[1]
        self.assertIn(version, [path.name for path in KEPT], "tests/files/kept/make keeps the files of a new release")

    def test_all(self):
        for kept in KEPT:
            with self.subTest(kept.name):
                here = self.dir / kept.name
                shutil.copytree(kept, here)
                expected = dict(line.split() for line in (kept / "expected.txt").read_text().splitlines())
                scene, run = here / "scene.yaml", here / "run"
                self.call("check", scene)
                self.call("verify", run, here / "pack.h5", here / "start.h5")
                for path in sorted(run.iterdir()):
                    self.call("info", path)
                self.assertEqual(self.call("export", run / "trajectory.h5"), (kept / "export.xyz").read_text())
                self.call("analyze", run / "trajectory.h5", "--out", here / "analyzed")
                self.call("topology", run / "trajectory.h5")
                for name, snapshot in ("started", "trajectory.h5"), ("again", "checkpoint.h5"):
                    self.assertEqual(self.hash(scene, "--set", f"start.snapshot={run / snapshot}", "--out", here / name, "--steps", 20), expected[name])
                self.assertEqual(self.hash(scene, "--out", run, "--resume", "--steps", 40), expected["resumed"])
                self.call("verify", run)
                self.call("oracle", "compare", here / "pack.h5", here / "pack.txt")
                self.call("oracle", "emit", scene, "--out", here / "new.h5")
                self.call("oracle", "compare", here / "new.h5", here / "pack.h5")
                self.call("oracle", "start", scene, "--out", here / "new-start.h5")
                self.assertEqual(self.call("oracle", "dump", here / "new-start.h5"), self.call("oracle", "dump", here / "start.h5"))
                (here / "new.csv").write_text(self.call("oracle", "trace", scene))
                self.call("oracle", "compare", here / "new.csv", here / "trace.csv")
                self.call("info", here / "sweep/summary.csv")


if __name__ == "__main__":
    unittest.main()
