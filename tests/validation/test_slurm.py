#!/usr/bin/python3
"""The campaign as a job array, without Slurm: what submit hands to sbatch, and what a task does when it is told that its
time is up. sbatch and scontrol are stand-ins that write down their words; `make slurm-test` asks the real ones."""
import importlib.machinery
import importlib.util
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
VALIDATION = pathlib.Path(__file__).resolve().parents[2] / "validation"
UNCROSS = pathlib.Path(os.environ.get("UNCROSS", "build/uncross")).resolve()


def load(path):
    """A script without the ending .py as a module."""
    loader = importlib.machinery.SourceFileLoader(path.name, str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(path.name, loader))
    loader.exec_module(module)
    return module


SLURM_TEST = load(VALIDATION / "slurm/test")
STAND_IN = """#!/bin/sh
echo "$(basename "$0") $*" >>"$SAID"
env | grep '^UNCROSS_' >"$SAID.environment"
echo 7
"""


class SlurmTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.tree, self.build = SLURM_TEST.make_tree(self.dir, UNCROSS, 400000)  # ten seconds and more
        (self.dir / "bin").mkdir()
        for name in ("sbatch", "scontrol", "sleep"):
            path = self.dir / "bin" / name
            path.write_text(STAND_IN)
            path.chmod(0o755)
        self.said = self.dir / "said"
        self.environment = dict(os.environ, PATH=f"{self.dir}/bin:{os.environ['PATH']}", SAID=str(self.said))

    def submit(self, *words):
        done = subprocess.run([self.tree / "validation/slurm/submit", "--build", self.build, *words],
                              env=self.environment, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def task(self, index):
        """A task of the array that was handed over, started."""
        handed = dict(line.split("=", 1) for line in self.said.with_suffix(".environment").read_text().splitlines())
        numbers = {"SLURM_ARRAY_TASK_ID": str(index), "SLURM_ARRAY_JOB_ID": "7"}
        return subprocess.Popen([self.tree / "validation/slurm/campaign.sbatch"], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, env={**self.environment, **handed, **numbers})

    def heard(self):
        return self.said.read_text().splitlines() if self.said.exists() else []

    def test_submit(self):
        self.assertEqual(self.submit("--at-once", "2", "--", "--time=30"), (0, "7\n"))
        words = self.heard()[0].split()
        self.assertEqual(words[0], "sbatch")
        self.assertIn("--array=0-2%2", words)
        self.assertEqual(words[-2:], ["--time=30", "validation/slurm/campaign.sbatch"])
        self.assertEqual(self.submit("nothing")[0], 1)

    def test_a_task_runs_its_line(self):
        self.submit()
        task = self.task(1)
        self.assertIn("brief/shorter finished", task.communicate(timeout=300)[0])
        self.assertEqual(task.returncode, 0)
        self.assertEqual(len(self.heard()), 1)  # sbatch; nothing was requeued
        task = self.task(3)
        self.assertIn("no line 4", task.communicate(timeout=60)[0])
        self.assertEqual(task.returncode, 1)

    def interrupted(self, number):
        self.submit()
        task = self.task(0)
        folder = self.build / "campaign/brief/long"
        while not (folder / "conserved.csv").exists() and task.poll() is None:
            time.sleep(0.05)
        task.send_signal(number)
        said = task.communicate(timeout=300)[0]
        self.assertEqual(task.returncode, 5, said)
        self.assertTrue((folder / "checkpoint.h5").exists())
        self.assertLess(json.loads((folder / "run.json").read_text())["steps"], 400000)

    def test_time_is_up(self):
        self.interrupted(signal.SIGUSR1)
        self.assertIn("scontrol requeue 7_0", self.heard())

    def test_cancelled(self):
        self.interrupted(signal.SIGTERM)
        self.assertFalse([words for words in self.heard() if words.startswith("scontrol")])

    def test_hours_of_the_page(self):
        """The table of validation/slurm/README.md is that of the runs as they are planned now."""
        hours = subprocess.run([VALIDATION / "slurm/hours"], capture_output=True, text=True, check=True).stdout
        page = (VALIDATION / "slurm/README.md").read_text(encoding="utf-8")
        self.assertEqual(page.split("<!-- hours -->\n")[1].split("<!-- end of hours -->")[0], hours)


if __name__ == "__main__":
    unittest.main()
