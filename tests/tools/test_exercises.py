#!/usr/bin/python3
"""Each exercise of docs/course.md has its scene and its line, and the program takes the scene with and without the
change."""
import pathlib
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

    def test_lines_stand_in_the_course(self):
        course = (TOP / "docs/course.md").read_text(encoding="utf-8")
        for name, (scene, _, old, _) in load(TOP / "docs/exercises/measure").EXERCISES.items():
            self.assertIn(scene.name, course)
            line = old.splitlines()[0] if old and old != "observe:" else "seed: 1" if not old else "forbidden: false"
            self.assertIn(line, course, name)


if __name__ == "__main__":
    unittest.main()
