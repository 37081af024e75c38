#!/usr/bin/python3
"""Each exercise of docs/course.md has its scene and its line, and the program takes the scene with and without the
change."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import TOP, load, uncross  # noqa: E402


class Exercises(unittest.TestCase):
    def test_scenes(self):
        for name, (scene, _, old, choices) in load(TOP / "docs/exercises/measure").EXERCISES.items():
            text = scene.read_text(encoding="utf-8")
            self.assertIn(old, text, name)
            for new in choices:
                with self.subTest(exercise=name, line=new), tempfile.TemporaryDirectory() as folder:
                    path = pathlib.Path(folder) / "scene.yaml"
                    path.write_text(text.replace(old, new, 1), encoding="utf-8")
                    done = uncross("check", path)
                    self.assertEqual(done.returncode, 0, done.stderr)

    def test_numbers_are_those_of_the_course(self):
        """`measure N` measures exercise N: its scene stands in the row of N, with the line that it changes."""
        measure = load(TOP / "docs/exercises/measure")
        rows = dict(re.findall(r"^\| (\d+) \| (`[\w./]*\.yaml` .*)", (TOP / "docs/course.md").read_text(encoding="utf-8"), re.M))
        self.assertEqual(set(measure.NUMBERED), set(measure.EXERCISES))
        self.assertEqual(list(rows), [str(number) for number in range(1, len(measure.NUMBERED) + 1)])
        for number, name in enumerate(measure.NUMBERED, 1):
            scene, _, old, choices = measure.EXERCISES[name]
            row = rows[str(number)]
            self.assertIn(scene.name, row)
            first, second = ({part.strip() for part in re.split(r"[{},\n]|  +", text)} for text in (choices * 2)[:2])
            changed = {part for part in first ^ second if part} or {"seed: 1"}
            self.assertTrue(any(part in row or f"`{part.split(': ')[-1]}`" in row for part in changed), (number, name, changed))

    def test_exercises_that_are_none(self):
        done = subprocess.run([TOP / "docs/exercises/measure", "38"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("there is no exercise '38'; allowed: 1 to 37, seed, ", done.stderr)

    def test_lines_stand_in_the_course(self):
        course = (TOP / "docs/course.md").read_text(encoding="utf-8")
        for name, (scene, _, old, _) in load(TOP / "docs/exercises/measure").EXERCISES.items():
            self.assertIn(scene.name, course)
            line = old.splitlines()[0] if old and old != "observe:" else "seed: 1" if not old else "forbidden: false"
            self.assertIn(line, course, name)


if __name__ == "__main__":
    unittest.main()
