"""What tests of committed packs share: the program's `oracle` commands, and that packs and traces are those of this code."""
import gzip
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


def check_constructed(test, name, *operators):
    """A constructed pack is what the program makes of its inputs, and those of these operators are what reference-data/construct
    makes today."""
    data = TOP / "reference-data"
    kept = gzip.open(data / f"{name}.pack.txt.gz", "rt").read()
    with tempfile.TemporaryDirectory() as folder:
        text, made, pack = (pathlib.Path(folder) / word for word in ("made.txt", "made.h5", "pack.h5"))
        text.write_text(subprocess.run([data / "construct", name, *operators], check=True, capture_output=True, text=True).stdout)
        test.assertEqual(run("answer", "--whole", text, made), (0, ""))
        test.assertEqual(run("answer", "--whole", data / f"{name}.pack.h5", pack), (0, ""))
        test.assertEqual(run("dump", "--decimal", pack), (0, kept))
        wanted = [line for line in kept.splitlines() if line.split()[0] in ("#", "model", *operators)]
        test.assertEqual(run("dump", "--decimal", made)[1].splitlines(), wanted)


def check_made_but_for(test, folder, name, *operators):
    """The pack of a scene in a folder of reference-data/ is what the program makes today, but that these operators have constructed
    rows behind those of the scene; and what came out of all is what the program makes of the inputs."""
    kept = gzip.open(folder / f"{name}.pack.txt.gz", "rt").read()
    with tempfile.TemporaryDirectory() as made:
        emitted, pack = (pathlib.Path(made) / word for word in ("emitted.h5", "pack.h5"))
        test.assertEqual(run("emit", folder / f"{name}.yaml", "-o", emitted), (0, ""))
        scene, all_rows = run("dump", "--decimal", emitted)[1].splitlines(), kept.splitlines()
        test.assertEqual(set(scene) - set(all_rows), set())
        more = [line.split()[0] for line in set(all_rows) - set(scene)]
        test.assertEqual(set(more), set(operators))
        test.assertEqual(run("answer", "--whole", folder / f"{name}.pack.h5", pack), (0, ""))
        test.assertEqual(run("dump", "--decimal", pack), (0, kept))
