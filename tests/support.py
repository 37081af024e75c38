"""What tests in Python share: where the program and the tree are, and a folder of a test's own.

tests/run gives the build folder in $BUILD and the program in $UNCROSS; a test that is started by hand takes build/ of
the tree. Paths are absolute, so they hold in any folder.
"""
import importlib.machinery
import importlib.util
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[1]
BUILD = pathlib.Path(os.environ.get("BUILD", TOP / "build")).resolve()
UNCROSS = pathlib.Path(os.environ.get("UNCROSS", BUILD / "uncross")).resolve()


def uncross(*words, **how):
    """The finished program with these words: returncode, stdout and stderr. `how`: as for subprocess.run."""
    usual = {"stdin": subprocess.DEVNULL, "capture_output": True, "text": True, "check": False}
    return subprocess.run([UNCROSS, *map(str, words)], **{**usual, **how})


def load(path):
    """A script without .py in its name, as a module. Its `main` is not run. It finds what stands beside it, as when it is run."""
    sys.path.append(str(pathlib.Path(path).parent))
    name = pathlib.Path(path).name.replace("-", "_") + "_program"
    loader = importlib.machinery.SourceFileLoader(name, str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


class FolderTest(unittest.TestCase):
    """Each test has an empty folder, self.dir, which is removed after it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
