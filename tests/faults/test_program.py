"""The program when memory, files or HDF5 fail: for n = 1, 2, 3, ... the n-th call fails, alone or with all that follow.

It must never crash; must say why it stopped; must never lose a checkpoint; and whatever it calls done must be right.
Needs BUILD, with uncross and uncross-faults. For each command FAULTS calls of HDF5 are tried at most (2), and five times as
many of the others. `make stress` tries 250.
"""
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

BUILD = pathlib.Path(os.environ.get("BUILD", "build")).resolve()
MOST = int(os.environ.get("FAULTS", "2"))
SCENE = """
box: [5, 4, 4]
time_step: 0.01
steps: 4
seed: 3
solvent:
  per_cell: 3
  collision_interval: 0.02
fibers:
  - {name: rod, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100, bending: 8}
  - {name: loop, count: 1, vertices: 5, mass: 5, bond_length: 0.4, spring: 100, bending: 0, ring: true}
  - {name: fixed, count: 1, vertices: 3, mass: 5, bond_length: 0.4, spring: 100, bending: 1, start: straight,
     places: [{center: [1, 1, 1], direction: [1, 0, 0]}]}
observe:
  conserved: {every: 1}
  temperature: {every: 1}
  statics: {every: 1}
  dynamics: {every: 1}
  collisions: {every: 1}
trajectory: {every: 2, velocities: true, solvent: true}
"""


def run(program, words, folder, **settings):
    return subprocess.run([str(BUILD / program), *words], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True,
                          timeout=60, check=False, env=dict(os.environ, **settings))


def state_hash(path):
    """Of a checkpoint, as `info` tells it, which verifies every byte; None if there is none."""
    if not path.exists():
        return None
    told = run("uncross", ["info", path], path.parent)
    found = re.search(rb"state hash ([0-9a-f]{16})", told.stdout)
    assert told.returncode == 0 and found and b": whole: every byte" in told.stdout, (told.stdout, told.stderr)
    return found[1]


class Faults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cls.start = cls.folder / "start"  # what every try starts from: two of the four steps are made
        cls.start.mkdir()
        (cls.start / "scene.yaml").write_text(SCENE)
        (cls.start / "from.yaml").write_text(SCENE + "start: {snapshot: run/checkpoint.h5}\n")
        (cls.start / "frame.yaml").write_text(SCENE + "start: {snapshot: run/trajectory.h5}\n")
        words = ["run", "scene.yaml", "--out", "run", "--quiet"]
        assert run("uncross", words + ["--steps", "2"], cls.start).returncode == 0
        assert run("uncross", ["run", "scene.yaml", "--out", "../first", "--quiet", "--steps", "0"], cls.start).returncode == 0
        cls.first = state_hash(cls.folder / "first/checkpoint.h5")
        cls.half = state_hash(cls.start / "run/checkpoint.h5")
        whole = cls.folder / "whole"
        shutil.copytree(cls.start, whole)
        assert run("uncross", words + ["--resume"], whole).returncode == 0
        cls.whole = state_hash(whole / "run/checkpoint.h5")
        cls.series = (whole / "run/conserved.csv").read_bytes()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def one(self, words, wish, look, right_code):
        """One try: the exit code says what happened, and `look` (folder, result, wish) what else must be so."""
        with tempfile.TemporaryDirectory(dir=self.folder) as place:
            folder = pathlib.Path(place) / "f"
            shutil.copytree(self.start, folder)
            done = run("uncross-faults", words, folder, UNCROSS_FAIL=wish)
            verifies = words[0] == "verify"  # it says what it finds on standard output
            damaged = (9,) if verifies and wish.startswith("hdf5") else ()  # so HDF5 fails in a damaged file, too
            self.assertIn(done.returncode, (0, 1, 2, 3, 4, right_code, *damaged), (wish, done.stderr, done.stdout))
            if done.returncode not in (0, right_code):
                self.assertRegex(done.stdout + done.stderr if verifies else done.stderr, rb"(?m)^(uncross|run/.+): .{10,}", wish)
            look(folder, done, wish)
            return done.returncode

    def attempt(self, words, wish, look, right_code):
        """The exit code of one try, or what was wrong with it."""
        try:
            return self.one(words, wish, look, right_code)
        except AssertionError as wrong:
            return f"{wish}: {wrong}"

    def all_of(self, words, look=lambda folder, done, wish: None, right_code=0):
        """Tries failure after failure; right_code is the exit code without any."""
        with tempfile.TemporaryDirectory(dir=self.folder) as place:
            folder = pathlib.Path(place) / "f"
            shutil.copytree(self.start, folder)
            right = run("uncross-faults", words, folder, UNCROSS_CALLS="calls")
            self.assertEqual(right.returncode, right_code, right.stderr)
            look(folder, right, "none")
            calls = dict(line.split() for line in (folder / "calls").read_text().splitlines())
        del calls["signal"]  # no failures: test_a_signal_interrupts_a_call
        wishes = []
        for kind, count in calls.items():
            stride = -(-int(count) // (MOST if kind == "hdf5" else 5 * MOST)) or 1
            for n in range(1, int(count) + 1, stride):
                wishes += [f"{kind}:{n}"] if n % 3 else [f"{kind}:{n}", f"{kind}:{n}+"]
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            codes = list(pool.map(lambda wish: self.attempt(words, wish, look, right_code), wishes))
        wrong = [code for code in codes if isinstance(code, str)]
        self.assertFalse(wrong, f"{' '.join(words)}: {len(wrong)} of {len(wishes)} failures were not borne:\n"
                         + "\n".join(text[:600] for text in wrong[:20]))
        told = {code: codes.count(code) for code in sorted(set(codes))}
        print(f"# {' '.join(words)}: {calls}; exit codes of {len(wishes)} failures: {told}")
        self.assertTrue(any(code != right_code for code in codes), "no failure was noticed")
        return right

    def same_output(self, words, part=lambda text: text):
        """Exit code 0: what is printed, or this part of it, is what is printed without failures."""
        expected = []

        def look(_folder, done, wish):
            if wish == "none":
                expected.append(part(done.stdout))
            if done.returncode == 0:
                self.assertEqual(part(done.stdout), expected[0], wish)

        self.all_of(words, look)

    def test_resume(self):
        words = ["run", "scene.yaml", "--out", "run", "--quiet", "--resume"]

        def look(folder, done, wish):
            self.assertIn(state_hash(folder / "run/checkpoint.h5"), (self.half, self.whole), wish)
            if done.returncode == 0:
                self.assertEqual(state_hash(folder / "run/checkpoint.h5"), self.whole, wish)
            again = run("uncross", words, folder)
            self.assertEqual(again.returncode, 0, (wish, done.stderr, again.stderr))
            self.assertEqual(state_hash(folder / "run/checkpoint.h5"), self.whole, wish)
            self.assertEqual((folder / "run/conserved.csv").read_bytes(), self.series, (wish, done.stderr))

        self.all_of(words, look)

    def test_new_run(self):
        """It leaves nothing, or what can be resumed."""
        words = ["run", "scene.yaml", "--out", "new/run", "--quiet"]

        def look(folder, done, wish):
            found = state_hash(folder / "new/run/checkpoint.h5")
            self.assertIn(found, (None, self.first, self.whole), wish)
            if done.returncode == 0:
                self.assertEqual(found, self.whole, wish)
            if found is None:
                self.assertFalse((folder / "new").exists(), (wish, done.stderr))
            else:
                again = run("uncross", words + ["--resume"], folder)
                self.assertEqual(again.returncode, 0, (wish, done.stderr, again.stderr))
                self.assertEqual(state_hash(folder / "new/run/checkpoint.h5"), self.whole, wish)
                self.assertEqual((folder / "new/run/conserved.csv").read_bytes(), self.series, wish)

        self.all_of(words, look)

    def test_a_signal_interrupts_a_call(self):
        """It is made again, and nothing is lost."""
        words = ["run", "scene.yaml", "--out", "run", "--quiet", "--resume"]
        for n in range(1, 30):
            with tempfile.TemporaryDirectory(dir=self.folder) as place:
                folder = pathlib.Path(place) / "f"
                shutil.copytree(self.start, folder)
                done = run("uncross-faults", words, folder, UNCROSS_FAIL=f"signal:{n}", UNCROSS_CALLS="calls")
                self.assertEqual(done.returncode, 0, (n, done.stderr))
                self.assertEqual(state_hash(folder / "run/checkpoint.h5"), self.whole)
                calls = int(re.search(r"^signal (\d+)$", (folder / "calls").read_text(), re.M)[1])
            if n >= calls:
                break
        self.assertGreater(calls, 3)

    def test_start_from_checkpoint(self):
        self.all_of(["run", "from.yaml", "--out", "new", "--quiet", "--steps", "1"])

    def test_start_from_trajectory(self):
        self.all_of(["run", "frame.yaml", "--out", "new", "--quiet", "--steps", "1"])

    def test_check(self):
        self.same_output(["check", "scene.yaml"])

    def test_info(self):
        for file in "checkpoint.h5", "conserved.csv":
            self.same_output(["info", "run/" + file])
        self.same_output(["info", "scene.yaml"])
        self.same_output(["info", "run/run.json"], lambda text: len(text.splitlines()))

    def test_verify(self):
        """A whole run is never called damaged for want of memory or since the system fails."""
        self.same_output(["verify", "run"])

    def test_info_of_a_trajectory(self):
        """It tells what it can read; a failure of a detail leaves out the detail."""
        self.all_of(["info", "run/trajectory.h5"])

    def test_export(self):
        """All of it or nothing: no velocity, name, bond, step or time may be left out of what is called done."""
        self.same_output(["export", "run/trajectory.h5", "--solvent"])
        self.same_output(["export", "run/checkpoint.h5", "--solvent", "--wrapped"])

    def test_export_to_a_file(self):
        right = run("uncross", ["export", "run/trajectory.h5"], self.start).stdout

        def look(folder, done, wish):
            if done.returncode == 0:
                self.assertEqual((folder / "out.xyz").read_bytes(), right, wish)

        self.all_of(["export", "run/trajectory.h5", "--out", "out.xyz"], look)

    def test_analyze(self):
        def look(folder, done, wish):
            for table in (folder / "again").glob("*.csv") if done.returncode == 0 else ():
                self.assertEqual(table.read_bytes(), (self.start / "right" / table.name).read_bytes(), wish)

        words = ["analyze", "run/trajectory.h5", "--out"]
        self.assertEqual(run("uncross", words + ["right"], self.start).returncode, 0)
        self.all_of(words + ["again"], look)

    def test_oracle(self):
        def look(folder, done, wish):
            if done.returncode == 0:
                self.assertGreater((folder / "out").stat().st_size, 2000, wish)

        self.all_of(["oracle", "emit", "scene.yaml", "-o", "out"], look)
        self.assertEqual(run("uncross", ["oracle", "emit", "scene.yaml", "-o", "pack.h5"], self.start).returncode, 0)
        self.same_output(["oracle", "dump", "pack.h5"], lambda text: len(text.splitlines()))

    def test_trace(self):
        words = ["oracle", "trace", "scene.yaml", "-o"]
        self.assertEqual(run("uncross", words + ["right.csv"], self.start).returncode, 0)
        right = (self.start / "right.csv").read_bytes()

        def look(folder, done, wish):
            if done.returncode == 0:
                self.assertEqual((folder / "trace.csv").read_bytes(), right, wish)

        self.all_of(words + ["trace.csv"], look)

    def test_compare(self):
        """Whatever fails, different packs are never told to be equal."""
        self.assertEqual(run("uncross", ["oracle", "emit", "scene.yaml", "-o", "ours.h5"], self.start).returncode, 0)
        text = run("uncross", ["oracle", "dump", "ours.h5"], self.start).stdout
        (self.start / "same.txt").write_bytes(text)
        lines = text.splitlines(keepends=True)
        last = max(k for k, line in enumerate(lines) if line.startswith(b"kick ") and b" out.velocity.x " in line)
        lines[last] = lines[last].rsplit(b" ", 1)[0] + b" 0x1.8p+3\n"
        (self.start / "wrong.txt").write_bytes(b"".join(lines))

        self.same_output(["oracle", "compare", "ours.h5", "same.txt"])
        self.all_of(["oracle", "compare", "ours.h5", "wrong.txt"],
                    lambda folder, done, wish: self.assertNotIn(done.returncode, (0, 6), wish), right_code=7)


if __name__ == "__main__":
    unittest.main()
