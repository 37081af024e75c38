"""What tests of committed packs share: the program's `oracle` commands, and that packs and traces are those of this code."""
import os
import pathlib
import subprocess
import tempfile

TOP = pathlib.Path(__file__).resolve().parents[2]
UNCROSS = os.environ.get("UNCROSS", str(TOP / "build/uncross"))


def run(*words):
    """(exit code, all that is said)"""
    done = subprocess.run([UNCROSS, "oracle", *map(str, words)], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def check_made_anew(test, folder, names):
    """Packs and traces of the scenes `names` in a folder of reference-data/ are what the program makes today."""
    with tempfile.TemporaryDirectory() as made:
        for name in names:
            pack = pathlib.Path(made) / f"{name}.h5"
            test.assertEqual(run("emit", folder / f"{name}.yaml", "-o", pack), (0, ""))
            status, said = run("compare", folder / f"{name}.pack.h5", pack)
            test.assertEqual(status, 0, said)
            status, said = run("trace", folder / f"{name}.yaml")
            test.assertEqual(status, 0, said)
            test.assertEqual(said.splitlines(), (folder / f"{name}.trace.csv").read_text().splitlines())
