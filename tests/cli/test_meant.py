"""What is typed by somebody who knows other codes: a key by another name, a mapping for a list, --cite; and no row of `check`
without a value. Needs UNCROSS."""
import json
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import FolderTest, uncross  # noqa: E402

SCENE = "box: [4, 4, 4]\ntime_step: 0.01\nsteps: 2\nsolvent: {per_cell: 3, collision_interval: 0.02}\n"
KEYS = {"dt": "time_step", "timestep": "time_step", "msd": "observe.dynamics", "density": "solvent.per_cell", "n_steps": "steps",
        "nsteps": "steps", "rdf": None, "gravity": "solvent.acceleration", "body_force": "solvent.acceleration", "angle": "solvent.rotation_angle",
        "random_seed": "seed", "dump": "trajectory", "restart": "checkpoint"}
SENTENCES = {"viscosity": "`uncross check`", "temperature": "always 1", "kT": "always 1"}
# Nothing bends and nothing pulls: force over bending has no value.
NO_VALUE = """box: [10, 10, 10]
time_step: 0.01
steps: 10
medium: {kind: overdamped, rate: 10, tensor: rpy, radius: 0.25, inextensible: true}
fibers: [{name: a, count: 1, vertices: 10, mass: 1, bond_length: 0.5, spring: 100, bending: 0, force: [0, 0, 0]}]
crossing: {forbidden: false}
"""


class Meant(FolderTest):
    def said(self, text, *more):
        (self.dir / "s.yaml").write_text(text)
        done = uncross("check", self.dir / "s.yaml", *more)
        return done.returncode, done.stdout + done.stderr

    def test_keys_by_another_name(self):
        schema = json.loads(uncross("schema").stdout)
        for word, key in KEYS.items():
            code, said = self.said(f"{SCENE}{word}: 1\n")
            self.assertEqual(code, 2)
            self.assertIn(f"unknown key '{word}'; " + (f"did you mean '{key}'?" if key else "allowed: box"), said)
            self.assertEqual(self.said(SCENE, "--set", f"{word}=1")[1].partition("; ")[2], said.partition("; ")[2])
            part = schema
            for name in key.split(".") if key else ():
                part = part["properties"][name]
        for word, says in SENTENCES.items():
            code, said = self.said(f"{SCENE}{word}: 1\n")
            self.assertEqual(code, 2)
            self.assertIn(says, said)
            self.assertNotIn("allowed:", said)

    def test_a_mapping_is_no_list(self):
        self.assertIn("fibers: a mapping is not a list; allowed: a list of mappings", self.said(SCENE + "fibers: {name: a}\n")[1])
        self.assertIn("steps: a list is not a whole number", self.said(SCENE.replace("steps: 2", "steps: [2]"))[1])

    def test_rows_have_values(self):
        code, said = self.said(NO_VALUE)
        self.assertEqual(code, 0, said)
        self.assertNotRegex(said, r"\b(nan|inf)\b")

    def test_cite(self):
        done = uncross("--cite")
        self.assertEqual(done.returncode, 0)
        for part in ("@article{", "Padding", "144903", "10.1063/1.3105339", "@software{", "version = {0.1.0"):
            self.assertIn(part, done.stdout)


if __name__ == "__main__":
    unittest.main()
