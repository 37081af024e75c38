#!/usr/bin/python3
"""The JSON schema of scenes: shipped scenes and those of the reference data fit it, and what a scene may not say does not.

Ranges and keys are checked by jsonschema, which knows nothing of this program.
"""
import copy
import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

import jsonschema
import yaml

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


class Loader(yaml.SafeLoader):
    """YAML as the program reads it: 1e-3 is a number."""


Loader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"^[-+]?[0-9.]+[eE][-+]?[0-9]+$"), list("-+.0123456789"))


def load(path):
    return yaml.load(path.read_text(), Loader)


def schema():
    said = subprocess.run([os.environ["UNCROSS"], "schema"], check=True, capture_output=True, text=True).stdout
    return json.loads(said)


class Schema(unittest.TestCase):
    def setUp(self):
        self.schema = schema()
        self.validator = jsonschema.Draft202012Validator(self.schema)
        self.scene = load(ROOT / "scenes" / "semidilute.yaml")

    def test_is_a_schema(self):
        jsonschema.Draft202012Validator.check_schema(self.schema)

    def test_scenes_fit(self):
        paths = sorted([*ROOT.glob("scenes/*.yaml"), *ROOT.glob("reference-data/*.yaml"), *ROOT.glob("tests/files/old/*.yaml")])
        self.assertGreaterEqual(len(paths), 10)
        for path in paths:
            with self.subTest(path=path.name):
                self.validator.validate(load(path))

    def refuse(self, part, change):
        scene = copy.deepcopy(self.scene)
        change(scene)
        errors = list(self.validator.iter_errors(scene))
        self.assertTrue(errors, part)
        self.assertTrue(any(part in error.message for error in errors), [error.message for error in errors])

    def test_what_does_not_fit(self):
        self.validator.validate(self.scene)
        self.refuse("'sead' was unexpected", lambda s: s.update(sead=1))
        self.refuse("'percell' was unexpected", lambda s: s["solvent"].update(percell=1))
        self.refuse("'bendign' was unexpected", lambda s: s["fibers"][0].update(bendign=1))
        self.refuse("'steps' is a required property", lambda s: s.pop("steps"))
        self.refuse("'spring' is a required property", lambda s: s["fibers"][0].pop("spring"))
        self.refuse("'bond_length' is a required property", lambda s: s["fibers"][0].pop("bond_length"))
        bead = copy.deepcopy(self.scene)
        bead["fibers"].append({"name": "bead", "count": 1, "vertices": 1, "mass": 5})
        self.validator.validate(bead)
        self.refuse("'spring' is a required property", lambda s: s["fibers"].append({**bead["fibers"][-1], "vertices": 2}))
        self.refuse("less than or equal to the minimum", lambda s: s.update(time_step=0))
        self.refuse("greater than the maximum", lambda s: s.update(seed=2 ** 64))
        self.refuse("is too short", lambda s: s.update(box=[4, 4]))
        self.refuse("greater than the maximum", lambda s: s.update(box=[4, 4, 1025]))
        self.refuse("is not one of", lambda s: s.update(order="kicksplit"))
        self.refuse("is not of type 'boolean'", lambda s: s["crossing"].update(forbidden="yes"))
        self.refuse("does not match", lambda s: s["fibers"][0].update(name="a b"))
        self.refuse("does not have enough properties", lambda s: s.update(shear={}))
        self.refuse("should not be valid", lambda s: s["fibers"][0].update(bending=1, persistence_length=1))

    def test_documents_hold_the_tables_of_the_program(self):
        done = subprocess.run([ROOT / "tools/document-keys", "--check", os.environ["UNCROSS"]], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_texts_and_defaults(self):
        solvent = self.schema["properties"]["solvent"]["properties"]
        self.assertEqual(solvent["rotation_angle"]["default"], 90)
        self.assertEqual(solvent["thermostat"]["default"], "none")
        self.assertEqual(solvent["acceleration"]["default"], [0, 0, 0])
        self.assertIn("1/a0^3", solvent["per_cell"]["description"])

        def described(node):
            for key, value in node.get("properties", {}).items():
                self.assertTrue(value.get("description"), key)
                described(value)
                described(value.get("items", {}))

        described(self.schema)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
