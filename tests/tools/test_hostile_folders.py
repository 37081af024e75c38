"""`uncross sweep` and `uncross plot` in folders that hold links and pipes where their files would be: what a link leads to
is not touched, and a pipe is not waited for. Needs UNCROSS."""
import os
import pathlib
import signal
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import FolderTest, uncross  # noqa: E402

SCENE = """box: [4, 4, 4]
time_step: 0.02
steps: 20
seed: 1
solvent: {per_cell: 3, collision_interval: 0.02}
observe:
  temperature: {every: 5}
"""


def undo():
    """What runs behind a shell has SIGINT ignored."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


class HostileFolders(FolderTest):
    def setUp(self):
        super().setUp()
        (self.dir / "scene.yaml").write_text(SCENE)
        self.target = self.dir / "target"

    def call(self, *words):
        return uncross(*words, cwd=self.dir, timeout=60)

    def refused(self, name, code, *words):
        done = self.call(*words)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(name, done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        self.assertNotIn("Errno", done.stderr)
        return done.stderr

    def put(self, path, kind):
        path.parent.mkdir(parents=True, exist_ok=True)
        if kind == "link":
            self.target.write_text("mine\n")
            path.symlink_to(self.target)
        elif kind == "dangling link":
            path.symlink_to(self.dir / "nowhere")
        else:
            os.mkfifo(path)

    def test_sweeps_write_into_files_only(self):
        words = "sweep", "scene.yaml", "--out", "sweep", "--seeds", "1..2", "--quiet", "--resume"
        self.assertEqual(self.call(*words[:-1]).returncode, 0)
        made = [path for path in (self.dir / "sweep").rglob("*.csv") if "seed-" not in str(path)]
        self.assertEqual(sorted(path.name for path in made), ["runs.csv", "summary.csv", "temperature.csv"])
        places = [self.dir / "sweep" / name for name in (".lock", "summary.csv.part", "runs.csv")]
        for kind, paths in ("link", [*places, *made]), ("dangling link", places[:2]), ("pipe", places):
            for path in paths:
                before = path.read_bytes() if path.exists() else None
                path.unlink(missing_ok=True)
                self.put(path, kind)
                self.assertRegex(self.refused(path.name, 4, *words), "is a link, .*a pipe or a device; nothing is written there|not a file but")
                self.assertFalse((self.dir / "nowhere").exists())
                if kind == "link":
                    self.assertEqual(self.target.read_text(), "mine\n", path)
                path.unlink()
                if before is not None:
                    path.write_bytes(before)
        self.assertEqual(self.call(*words).returncode, 0)

    def test_sweeps_replace_their_own_tables_only(self):
        """Texts of somebody else under the names of a sweep's tables, and in the folder of a point: refused."""
        words = "sweep", "scene.yaml", "--out", "sweep", "--seeds", "1..2", "--quiet", "--resume"
        for name in "summary.csv", "runs.csv", "all/temperature.csv":
            path = self.dir / "sweep" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text("my,own,table\n1,2,3\n")
            told = self.refused(name, 2, *words)
            self.assertIn("is no table of a sweep", told)
            self.assertEqual(path.read_text(), "my,own,table\n1,2,3\n")
            path.unlink()
        (self.dir / "sweep" / "notes.csv").write_text("mine\n")
        (self.dir / "sweep" / "all" / "notes.csv").write_text("mine\n")
        for _ in range(2):
            self.assertEqual(self.call(*words).returncode, 0)
        for path in (self.dir / "sweep").rglob("notes.csv"):
            self.assertEqual(path.read_text(), "mine\n")

    def test_sweeps_go_into_no_folder_elsewhere(self):
        words = "sweep", "scene.yaml", "--out", "sweep", "--seeds", "1..1", "--quiet", "--resume"
        elsewhere = self.dir / "elsewhere"
        elsewhere.mkdir()
        for name in "all", "all/seed-1":
            link = self.dir / "sweep" / name
            link.parent.mkdir(parents=True, exist_ok=True)
            link.symlink_to(elsewhere)
            self.refused(f"{name}: is a link", 2, *words)
            self.assertEqual(list(elsewhere.iterdir()), [])
            link.unlink()

    def test_pages_of_sweeps_wait_for_no_pipe(self):
        self.assertEqual(self.call("sweep", "scene.yaml", "--out", "sweep", "--seeds", "1..2", "--quiet").returncode, 0)
        for name in "summary.csv", "runs.csv":
            path = self.dir / "sweep" / name
            before = path.read_bytes()
            path.unlink()
            for make in os.mkfifo, os.mkdir:
                make(path)
                done = self.call("plot", "sweep", "--out", "page.html")
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(f"{name}: not a file but a folder, a pipe or a device", done.stderr)
                self.assertNotIn("Traceback", done.stderr)
                path.rmdir() if path.is_dir() else path.unlink()
            path.write_bytes(before)

    def test_folders_begin_with_a_dash(self):
        done = self.call("sweep", "scene.yaml", "--out", "-x", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((self.dir / "-x" / "summary.csv").exists())

    def test_sweeps_wait_for_no_pipe(self):
        words = "sweep", "scene.yaml", "--out", "sweep", "--seeds", "1..1", "--quiet"
        self.assertEqual(self.call(*words).returncode, 0)
        for name in "run.json", "temperature.csv":
            path = next((self.dir / "sweep").rglob("seed-1")) / name
            before = path.read_bytes()
            path.unlink()
            os.mkfifo(path)
            done = self.call(*words, "--resume")
            self.assertIn(done.returncode, (2, 4), name)
            self.assertIn(name, done.stderr)
            self.assertNotIn("Traceback", done.stderr)
            path.unlink()
            path.write_bytes(before)

    def test_pages_wait_for_no_pipe(self):
        os.mkfifo(self.dir / "pipe.csv")
        os.mkfifo(self.dir / "pipe")
        for name in "pipe", "pipe.csv":
            self.refused(f"{name}: not a file but a folder, a pipe or a device", 2, "plot", name, "--out", "page.html")
        self.assertEqual(self.call("run", "scene.yaml", "--out", "run", "--quiet").returncode, 0)
        pipes = "run.json", "other.csv", "trajectory.h5", "checkpoint.h5"
        for name in pipes:
            (self.dir / "run" / name).unlink(missing_ok=True)
            os.mkfifo(self.dir / "run" / name)
        done = self.call("plot", "run", "--out", "page.html")
        self.assertEqual(done.returncode, 0)
        said = done.stderr + (self.dir / "page.html").read_text()
        for name in pipes:
            self.assertIn(f"{name}: not a file but a folder, a pipe or a device", said)

    def test_ctrl_c_while_packages_are_read(self):
        """The signal ends the program, without a word; it comes while NumPy is read, from a package of that name."""
        self.assertEqual(self.call("run", "scene.yaml", "--out", "run", "--quiet").returncode, 0)
        (self.dir / "packages/numpy").mkdir(parents=True)
        (self.dir / "packages/numpy/__init__.py").write_text("import os, signal, time\nos.kill(os.getpid(), signal.SIGINT)\ntime.sleep(9)\n")
        for words in ("plot", "run", "--out", "page.html"), ("sweep", "scene.yaml", "--out", "sweep"):
            done = uncross(*words, cwd=self.dir, env=dict(os.environ, PYTHONPATH=str(self.dir / "packages")), preexec_fn=undo)
            self.assertEqual((done.returncode, done.stderr), (-signal.SIGINT, ""), words)

    def test_pages_are_new_files(self):
        self.assertEqual(self.call("run", "scene.yaml", "--out", "run", "--quiet").returncode, 0)
        self.put(self.dir / "page.html", "dangling link")
        self.assertIn(self.call("plot", "run", "--out", "page.html").returncode, (2, 4))
        self.assertFalse((self.dir / "nowhere").exists())


if __name__ == "__main__":
    unittest.main()
