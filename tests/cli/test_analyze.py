#!/usr/bin/python3
"""`uncross analyze` makes the run's own tables from its frames, to the byte, where frames hold all that there is: without solvent
particles, in all media. Needs UNCROSS."""
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import FolderTest, uncross  # noqa: E402

SCENE = """box: [6, 6, 6]
time_step: 0.01
steps: 40
fibers: [{name: a, count: 4, vertices: 6, mass: 2, bond_length: 0.5, spring: 60, bending: 3}]
crossing: {forbidden: false}
observe: {conserved: {every: 5}, temperature: {every: 5}, statics: {every: 5}}
"""
ALONE = {"private": "medium: {kind: private, rate: 2}\n", "nothing": "", "sheared": "shear: {rate: 0.3}\n",
         "phantoms": "solvent: {per_cell: 3, collision_interval: 0.02, bath: phantoms, hydrodynamics: false}\n",
         "drift-split": "medium: {kind: private, rate: 2}\norder: drift-split\n"}
OVERDAMPED = SCENE.replace("temperature: {every: 5}, ", "") + "medium: {kind: overdamped, rate: 2}\n"


class Analyze(FolderTest):
    def tables(self, name, text, velocities="true"):
        """Names of the tables of the run; what analyze says; those that it makes are the run's."""
        (self.dir / f"{name}.yaml").write_text(text + f"trajectory: {{every: 5, velocities: {velocities}}}\n")
        self.assertEqual(uncross("run", self.dir / f"{name}.yaml", "--out", self.dir / name, "--quiet").returncode, 0)
        done = uncross("analyze", self.dir / name / "trajectory.h5", "--out", self.dir / f"{name}-again")
        self.assertEqual(done.returncode, 0, done.stderr)
        own = {path.name: path.read_bytes() for path in (self.dir / name).glob("*.csv")}
        again = {path.name: path.read_bytes() for path in (self.dir / f"{name}-again").glob("*.csv")}
        self.assertEqual(again, {table: own[table] for table in again})
        return set(own), set(again), done.stderr

    def test_fibers_alone(self):
        for name, line in ALONE.items():
            with self.subTest(name):
                own, again, said = self.tables(name, SCENE + line)
                self.assertEqual((own, said), (again, ""))
                self.assertEqual(len(own), 3)

    def test_overdamped_fibers_need_no_velocities(self):
        own, again, said = self.tables("overdamped", OVERDAMPED, "false")
        self.assertEqual((own, said), (again, ""))
        self.assertIn("conserved.csv", own)

    def test_observables_may_be_set_after_the_run(self):
        """The run that observed them has the same tables."""
        own, _, _ = self.tables("asked", SCENE + ALONE["private"])
        observed = SCENE.splitlines(True)[-1]
        (self.dir / "bare.yaml").write_text(SCENE.replace(observed, "") + ALONE["private"] + "trajectory: {every: 5}\n")
        self.assertEqual(uncross("run", self.dir / "bare.yaml", "--out", self.dir / "bare", "--quiet").returncode, 0)
        words = [word for name in ("conserved", "temperature", "statics") for word in ("--set", f"observe.{name}.every=5")]
        done = uncross("analyze", self.dir / "bare/trajectory.h5", "--out", self.dir / "set", *words)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for name in own:
            self.assertEqual((self.dir / "set" / name).read_bytes(), (self.dir / "asked" / name).read_bytes(), name)

    def test_only_observables_may_be_set(self):
        self.tables("run", SCENE + ALONE["private"])
        for word, said in (("fibers.0.spring=7", "allowed: keys of observe"), ("observe.statics.every=0", "allowed"), ("observe.nothing.every=5", "nothing")):
            done = uncross("analyze", self.dir / "run/trajectory.h5", "--out", self.dir / "none", "--set", word)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(said, done.stderr)
            self.assertFalse((self.dir / "none").exists())

    def test_what_frames_lack_is_named(self):
        _, again, said = self.tables("still", SCENE + ALONE["private"], "false")
        self.assertEqual(again, {"statics-a.csv"})
        self.assertEqual(said, "".join(f"uncross: {what}: left out: velocities are not in the frames\n" for what in ("conserved", "temperature")))


if __name__ == "__main__":
    unittest.main()
