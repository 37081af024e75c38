#!/usr/bin/python3
"""docs/port-ci.yml, the workflow for a port's repository: its shell steps are run here, in a folder of their own, with the
port to NumPy. The step that installs packages is not run; its packages are held against tools/install-dependencies. Compiling
takes a minute, so make is stood in for by a copy of the program, unless UNCROSS_TEST_PORT_CI=whole.
"""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import yaml

TOP = pathlib.Path(__file__).resolve().parents[2]
UNCROSS = pathlib.Path(os.environ.get("UNCROSS", TOP / "build/uncross")).resolve()
WHOLE = os.environ.get("UNCROSS_TEST_PORT_CI") == "whole"


class PortCiTest(unittest.TestCase):
    def setUp(self):
        self.workflow = yaml.safe_load((TOP / "docs/port-ci.yml").read_text())
        self.steps = {step["name"]: step["run"] for step in self.workflow["jobs"]["oracle"]["steps"] if "run" in step}
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.environment = {**os.environ, **{key: str(value) for key, value in self.workflow["env"].items()},
                            "UNCROSS_REVISION": "HEAD", "PORT_OPTIONS": "--no-traces"}
        for name in [name for name in self.environment if name.startswith(("MAKE", "MFLAGS"))]:
            del self.environment[name]

    def repository(self):
        """The sources, or only the packs if nothing is compiled: a repository of one commit."""
        repository = self.dir / "origin"
        files = subprocess.run(["git", "-C", TOP, "ls-files", "-co", "--exclude-standard", *([] if WHOLE else ["reference-data"])], capture_output=True, text=True,
                               check=False)
        if files.returncode != 0:
            self.skipTest("no repository")
        kept = [name for name in files.stdout.splitlines() if not name.startswith("reference-data/campaign") and (TOP / name).is_file()]
        repository.mkdir()
        subprocess.run(["cp", "--parents", *kept, repository], cwd=TOP, check=True)
        git = ["git", "-C", repository, "-c", "user.name=a", "-c", "user.email=a@example.org"]
        for words in (["init", "-q"], ["add", "-A"], ["commit", "-qm", "all"]):
            subprocess.run([*git, *words], check=True)
        return repository

    def stand_in(self):
        """A make that copies the program to where make would leave it."""
        tools = self.dir / "tools"
        tools.mkdir()
        make = tools / "make"
        make.write_text(f'#!/bin/bash\n[ "$*" = "-C uncross -j2 build/uncross" ] || exit 9\nmkdir -p uncross/build\ncp {UNCROSS} $2/build/\n')
        make.chmod(0o755)
        self.environment["PATH"] = f"{tools}:{self.environment['PATH']}"

    def port(self, line):
        path = self.dir / "port"
        path.write_text(f"#!/bin/bash\n{line}\n")
        path.chmod(0o755)

    def run_step(self, name):
        """As a runner does: bash that stops at the first failure."""
        return subprocess.run(["bash", "-e", "-c", self.steps[name]], cwd=self.dir, env=self.environment, capture_output=True,
                              text=True, check=False)

    def test_packages(self):
        groups = [subprocess.run(["bash", "-c", f"sed -n 's/^  \\[{name}\\]=\"\\(.*\\)\"/\\1/p' {TOP}/tools/install-dependencies"],
                                 capture_output=True, text=True, check=True).stdout.split() for name in ("run", "name")]
        packages = set(self.steps["Packages"].replace("--yes", "").split("install")[1].split())
        wanted = set(sum(groups, [])) - {"binutils", "libc6-dev", "pkgconf", "python3"}
        self.assertEqual(packages, wanted | {"pkg-config"})

    def test_steps(self):
        self.environment["UNCROSS_REPOSITORY"] = str(self.repository())
        if not WHOLE:
            self.stand_in()
        self.port(f'exec {TOP}/ports/numpy/port "$1" "$2"')
        for name in ("Oracle", "Port", "Check"):
            done = self.run_step(name)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        report = json.loads((self.dir / "oracle.json").read_text())
        self.assertEqual((report["verdict"], len(report["checks"])), ("same", 7))
        (self.dir / "oracle.json").unlink()
        self.port("exit 1")
        self.assertEqual(self.run_step("Check").returncode, 7)
        self.assertEqual(json.loads((self.dir / "oracle.json").read_text())["verdict"], "differs")

    def test_a_port_that_does_not_build(self):
        self.environment["PORT_BUILD"] = "false"
        self.assertNotEqual(self.run_step("Port").returncode, 0)


if __name__ == "__main__":
    unittest.main()
