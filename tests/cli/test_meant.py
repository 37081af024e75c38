"""What is typed by somebody who knows other codes: a key by another name, a mapping for a list, --cite; and no row of `check`
without a value. Needs UNCROSS."""
import json
import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, FolderTest, uncross  # noqa: E402

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
        self.assertIn("steps: a list of 1 is not a whole number", self.said(SCENE.replace("steps: 2", "steps: [2]"))[1])

    def test_a_key_of_a_section(self):
        """At the top of a file: where it belongs, if there are not many such places. Symbols of the paper, in fibers."""
        for word, says in (("thermostat", "did you mean 'solvent.thermostat'?"), ("rate", "did you mean 'medium.rate' or 'shear.rate'?"),
                           ("persistence_length", "did you mean 'fibers.persistence_length'?"), ("longest_lag", "did you mean 'observe.dynamics.longest_lag'?"),
                           ("every", "allowed: box")):
            self.assertIn(f"unknown key '{word}'; {says}", self.said(f"{SCENE}{word}: 1\n")[1])
        for word, key in (("k", "spring"), ("N", "vertices"), ("lp", "persistence_length"), ("kappa", "bending")):
            said = self.said(f"{SCENE}fibers: [{{name: a, {word}: 3}}]\n")[1]
            self.assertIn(f"unknown key '{word}' in fibers; did you mean 'fibers.{key}'?", said)
        self.assertIn("did you mean 'dumbbells.spring'?", self.said(f"{SCENE}dumbbells: {{k: 3}}\n")[1])

    def test_examples_are_allowed(self):
        """What an empty section is told to hold may be taken at its word."""
        scene = SCENE.replace("solvent: {per_cell: 3, collision_interval: 0.02}\n", "")
        names = [key for key, what in json.loads(uncross("schema").stdout)["properties"].items() if what.get("type") == "object"]
        self.assertGreater(len(names), 8)
        for name in names:
            said = self.said(f"{scene}{name}: {{}}\n")[1]
            example = said.partition("at least one key, as ")[2].partition(", or no such section")[0]
            self.assertRegex(example, r"^\{.+\}$", said)
            if "..." in example:
                continue
            again = self.said(f"{scene}{name}: {example}\n")[1]
            self.assertNotRegex(again.partition("\n")[0], r"out of range|is not a|is no choice|is empty", (name, example))

    def test_rows_have_values(self):
        code, said = self.said(NO_VALUE)
        self.assertEqual(code, 0, said)
        self.assertNotRegex(said, r"\b(nan|inf)\b")

    def test_cite(self):
        done, version = uncross("--cite"), re.search(r'UNCROSS_VERSION "(.*)"', (TOP / "src/version.h").read_text())[1]
        self.assertEqual(done.returncode, 0)
        for part in ("@article{", "Padding", "144903", "10.1063/1.3105339", "@software{", f"version = {{{version}"):
            self.assertIn(part, done.stdout)


if __name__ == "__main__":
    unittest.main()
