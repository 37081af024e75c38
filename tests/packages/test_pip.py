"""`pip install ./python` in an environment with Debian's setuptools, cffi and numpy: nothing is downloaded, and the hash is the program's.

Needs BUILD, with the libraries in it; and python3-pip, -setuptools and -venv (tools/install-dependencies packages), else it is skipped.
"""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import BUILD, TOP, FolderTest  # noqa: E402

MISSING = [name for name in ("venv", "ensurepip", "setuptools", "wheel", "cffi") if importlib.util.find_spec(name) is None]
PROGRAM = """import sys, uncross
run = uncross.Run(sys.argv[1]).advance(8)
print(f"{run.hash:016x}", uncross.version, uncross.__file__)"""


def call(*words, code=0, **environment):
    kept = {name: text for name, text in os.environ.items() if name not in ("PYTHONPATH", "UNCROSS_LIBRARY")}
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, cwd="/", env={**kept, **environment})
    if done.returncode != code:
        raise AssertionError(f"{words}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


@unittest.skipIf(MISSING, f"is not installed: {', '.join(MISSING)}")
class Pip(FolderTest):
    def test_an_environment(self):
        for name in ("python/uncross", "python/pyproject.toml", "python/setup.py", "src/version.h"):  # pip writes beside them
            (self.dir / name).parent.mkdir(parents=True, exist_ok=True)
            copy = shutil.copytree if (TOP / name).is_dir() else shutil.copy
            copy(TOP / name, self.dir / name)
        python = self.dir / "environment/bin/python"
        call("/usr/bin/python3", "-m", "venv", "--system-site-packages", self.dir / "environment")
        call(python, "-m", "pip", "install", "--no-build-isolation", "--no-index", self.dir / "python")
        version = re.search(r'UNCROSS_VERSION "(.*)"', (TOP / "src/version.h").read_text())[1]
        known = re.search(r"^scenes/semidilute\.yaml (\w+)$", (TOP / "tests/kernel/shipped.txt").read_text(), re.M)[1]
        scene = TOP / "scenes/semidilute.yaml"
        library = next((BUILD / "lib").glob("libuncross.so.*"))
        # A library that the environment has, as `make install PREFIX=environment` puts it there; one that is named; none.
        told = call(python, "-c", PROGRAM, scene, UNCROSS_LIBRARY=str(library)).split()
        self.assertEqual(told[:2], [known, version])
        self.assertTrue(pathlib.Path(told[2]).is_relative_to(self.dir / "environment"), told)
        self.assertIn(f"uncross needs the library {library.name}, which", call(python, "-c", PROGRAM, scene, code=1))
        (self.dir / "environment/lib" / library.name).symlink_to(library)
        self.assertEqual(call(python, "-c", PROGRAM, scene).split()[0], known)


if __name__ == "__main__":
    unittest.main()
