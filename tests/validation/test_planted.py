"""Every planted bug can still be planted, compiles, and its cases and runs exist."""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import yaml

sys.dont_write_bytecode = True
TREE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TREE / "validation"))

from lib import case as cases


def complaints(bug):
    """What the compiler says of the file with the bug in it; nothing if it compiles."""
    include = bug["file"].removeprefix("src/")
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder) / include
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text((TREE / bug["file"]).read_text().replace(bug["old"], bug["new"]))
        program = pathlib.Path(folder) / "bug.c"
        program.write_text(f'#include "{include}"\n')
        paths = [f"-I{path}" for path in (folder, TREE / "src", TREE / "include")]
        command = [os.environ.get("CC", "cc"), "-std=c11", "-D_POSIX_C_SOURCE=200809L", "-w", "-fsyntax-only", *paths, str(program)]
        return subprocess.run(command, capture_output=True, text=True, check=False).stderr


class Planted(unittest.TestCase):
    def test_they_compile(self):
        for bug in yaml.safe_load((TREE / "validation/planted/bugs.yaml").read_text()):
            with self.subTest(bug["id"]):
                self.assertEqual(complaints(bug), "")

    def test_bugs(self):
        bugs = yaml.safe_load((TREE / "validation/planted/bugs.yaml").read_text())
        self.assertEqual(len({bug["id"] for bug in bugs}), len(bugs))
        for bug in bugs:
            with self.subTest(bug["id"]):
                text = (TREE / bug["file"]).read_text()
                self.assertEqual(text.count(bug["old"]), 1)
                self.assertNotIn(bug["new"], text)
                for case, pattern in bug["cases"].items():
                    names = [run.name for run in cases.load(case).runs("quick")]
                    self.assertTrue(any(re.fullmatch(pattern, name) for name in names), (case, pattern))

    def test_every_case_has_one(self):
        bugs = yaml.safe_load((TREE / "validation/planted/bugs.yaml").read_text())
        held = {case for bug in bugs for case in bug["cases"]}
        gated = {name for name in cases.names() if cases.load(name).runs("quick")}
        self.assertEqual(gated - held - {"cost"}, set())  # cost is a matter of time, not of bugs


if __name__ == "__main__":
    unittest.main()
