"""A signal while thick fibers are laid, which takes long where there is little room: answered at once, and nothing is left. Needs
UNCROSS."""
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

UNCROSS = os.path.abspath(os.environ.get("UNCROSS", "build/uncross"))
# Rods of length 4 a0 and diameter 1 a0: long before 6000 the box is so full that each is laid thousands of times.
SCENE = """box: [40, 40, 40]
time_step: 0.01
steps: 2
fibers: [{name: rods, count: 6000, vertices: 3, mass: 5, bond_length: 2, spring: 1000, start: straight, diameter: 1}]
"""
ANSWER = 1.0  # s; without others on the machine it is a millisecond


class Laying(unittest.TestCase):
    def test_signals(self):
        for number in signal.SIGINT, signal.SIGTERM:
            with tempfile.TemporaryDirectory() as folder:
                scene = pathlib.Path(folder) / "s.yaml"
                scene.write_text(SCENE)
                run = subprocess.Popen([UNCROSS, "run", scene, "--out", pathlib.Path(folder) / "r", "--quiet"], stderr=subprocess.PIPE)
                time.sleep(1.0)
                self.assertIsNone(run.poll(), "it is not long enough")
                spent = os.times()
                run.send_signal(number)
                asked = time.monotonic()
                said = run.communicate(timeout=60)[1].decode()
                took = time.monotonic() - asked
                used = sum(os.times()[2:4]) - sum(spent[2:4])  # with all that it computed before
                self.assertEqual(run.returncode, 5, said)
                self.assertRegex(said, r"given up while fiber \d+ of 6000 was laid")
                self.assertLess(min(took, used - 0.5), ANSWER, (took, used))
                self.assertEqual([path.name for path in pathlib.Path(folder).iterdir()], ["s.yaml"])


if __name__ == "__main__":
    unittest.main()
