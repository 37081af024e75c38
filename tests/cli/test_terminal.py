"""Text of scenes and files on a terminal: no control character of theirs reaches it, in no command and no message."""
import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import h5py
import numpy

UNCROSS = os.environ.get("UNCROSS", "build/uncross")
NASTY = ("\x1b[31mred", "\x1b]0;title\x07", "bell\x07", "back\x08\x08", "\x9b1m", "\x7f", "right\u202eleft", "line\u2028end",
         "\u2066", "a\rb", "a\nb", "a\tb")
SCENE = """box: [4, 4, 4]
time_step: 0.01
steps: 20
solvent: {per_cell: 3, collision_interval: 0.02}
fibers:
  - {name: NAME, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100, bending: 4}
crossing: {rule: sequential}  # a scene that leaves out no changed default is kept as it is
observe: {statics: {every: 1}}
trajectory: {every: 10, velocities: true}
"""


def acting(text):
    """Characters that act on a terminal. Lines end with a line feed; a tab is no harm."""
    return [c for c in text if (ord(c) < 0x20 and c not in "\n") or 0x7f <= ord(c) <= 0x9f
            or c in "\u200e\u200f\u2028\u2029\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069\ufeff"]


def quoted(text):
    return json.dumps(text)  # YAML reads it as JSON does


class Terminal(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.looked_at = 0

    def clean(self, *words, code=None):
        done = subprocess.run([UNCROSS, *words], capture_output=True, check=False, timeout=60)
        if code is not None:
            self.assertEqual(done.returncode, code, done.stderr)
        told = (done.stdout + done.stderr).decode()  # or it is no UTF-8
        self.assertEqual(acting(told), [], (words, told))
        self.looked_at += 1
        return told

    def write(self, name, content):
        path = self.dir / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    def test_scenes(self):
        """A name of a kind is letters and digits; what else a scene says is a path."""
        first = self.write("first.yaml", SCENE.replace("NAME", "a"))
        self.clean("run", first, "--out", self.dir / "first", code=0)
        for k, nasty in enumerate(NASTY[1::3]):
            (self.dir / nasty).write_bytes((self.dir / "first/checkpoint.h5").read_bytes())
            good = self.write(f"{k}.yaml", SCENE.replace("NAME", "a") + f"start: {{snapshot: {quoted(nasty)}}}\n")
            told = self.clean("check", good, code=0)
            again = self.write("again.yaml", told[:told.index("\n\nParameters")])
            self.assertEqual(*(re.search("fingerprint ([0-9a-f]+)", text)[1] for text in (told, self.clean("check", again))))
            out = self.dir / str(k)
            self.clean("run", good, "--out", out, code=0)
            for file in "checkpoint.h5", "trajectory.h5", "run.json":
                self.clean("info", out / file, code=0)
            self.clean("export", out / "trajectory.h5", code=0)
            with h5py.File(out / "checkpoint.h5") as file:  # the scene itself is kept
                self.assertEqual(file["scene"][()].decode(), good.read_text())
            for bad in (SCENE.replace("NAME", "a") + quoted(nasty) + ": 1\n", SCENE.replace("NAME", "a, x: " + quoted(nasty)),
                        SCENE.replace("4, 4, 4", f"4, 4, {quoted(nasty)}"), f"{{{quoted(nasty)}: {{}}}}",
                        SCENE.replace("NAME", "a") + f"start: {{snapshot: {quoted(nasty)}}}\n", nasty):
                scene = self.write("bad.yaml", bad)
                self.clean("check", scene)
                self.clean("info", scene)
                self.clean("run", scene, "--out", self.dir / "none")
            self.clean("check", good, "--set", f"{nasty}=1")
            self.clean("check", good, "--set", f"fibers[0].name={nasty}")

    def test_names_of_files(self):
        scene = self.write("scene.yaml", SCENE.replace("NAME", "a"))
        for nasty in NASTY[::3]:
            self.clean("run", scene, "--out", self.dir / nasty, code=0)
            self.clean("run", scene, "--out", self.dir / nasty, code=2)
            for command in (["info"], ["check"], ["export"], ["analyze", "--out", self.dir / ("to" + nasty)]):
                self.clean(*command, self.dir / nasty / "checkpoint.h5")
                self.clean(*command, self.dir / nasty)
            self.clean("export", scene, "--first", nasty)
            self.clean(nasty)
            self.clean("run", scene, "--out", self.dir, "--seed", nasty)

    def test_files(self):
        for nasty in NASTY:
            for name, content in (("t.csv", f"step,{nasty}\n1,2\n"), ("t.json", json.dumps({nasty: nasty})),
                                  ("t.xyz", f"1\nProperties={nasty}\nC 0 0 0\n"), ("t", nasty), ("t.yaml", nasty),
                                  ("u.csv", f"step,{nasty}".encode("latin-1", "replace"))):
                self.clean("info", self.write(name, content))

    def test_trajectories_of_others(self):
        for nasty in NASTY:
            path = self.dir / "other.h5"
            with h5py.File(path, "w") as file:
                file.create_group("h5md/author").attrs["name"] = nasty
                file.create_group("h5md/creator").attrs["name"] = nasty
                file["h5md/creator"].attrs["version"] = nasty
                group = file.create_group("particles/" + nasty.replace("/", ""))
                group["position/value"] = numpy.zeros((1, 2, 3))
                group["position/step"] = numpy.arange(1)
                group["position/time"] = numpy.arange(1.0)
                kind = h5py.enum_dtype({nasty: 0, "b": 1}, basetype="i4")
                group.create_dataset("species", data=numpy.array([0, 1]), dtype=kind)
                group.create_group("box").attrs["dimension"] = 3
            self.clean("info", path)
            self.clean("export", path)

    def test_steps_that_do_not_increase(self):
        """Not about a terminal: frames in another order would be averaged as if they were in order."""
        scene = self.write("scene.yaml", SCENE.replace("NAME", "a"))
        self.clean("run", scene, "--out", self.dir / "r", code=0)
        path = self.dir / "r/trajectory.h5"
        for steps in [0, 10, 10], [0, 10, 5], [10, 0, 20]:
            with h5py.File(path, "a") as file:
                if "checksum" in file["parameters/uncross"]:  # the checksums would find it first
                    del file["parameters/uncross/checksum"]
                    file["parameters/uncross"].attrs["format_version"] = numpy.int32(1)
                file["particles/trajectory/position/step"][:] = steps
            told = self.clean("analyze", path, "--out", self.dir / "tables", code=2)
            self.assertRegex(told, r"frame \d: its step \d+ does not come after \d+, the step of the frame before")
            self.assertFalse((self.dir / "tables").exists())


if __name__ == "__main__":
    unittest.main()
