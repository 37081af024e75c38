#!/usr/bin/python3
"""What whole steps of a port begin from, and what they are held against: starts with their switches, scenes outside of the contract,
digests that do not depend on an order, traces of runs that stop, and of every n-th step.

Digests are computed here from the words of docs/conventions.md, with the xxHash library.
"""
import contextlib
import csv
import gzip
import json
import os
import pathlib
import random
import subprocess
import tempfile
import unittest

import h5py
import numpy as np
import xxhash

TOP = pathlib.Path(__file__).resolve().parents[2]
DATA = TOP / "reference-data"
UNCROSS = os.environ.get("UNCROSS", str(TOP / "build/uncross"))
SOLVENT = "solvent: {per_cell: 5, collision_interval: 0.02%s}\n"
FIBERS = "fibers: [{name: a, count: 2, vertices: 3, mass: 5, bond_length: 0.5, spring: 100%s}]\n"
BOX = "box: [4, 4, 4]\ntime_step: 0.02\nsteps: 4\n"
EVENTS = "crossing: {rule: event-driven}\n"


def run(*words):
    done = subprocess.run([UNCROSS, *map(str, words)], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.dir = pathlib.Path(self.folder.name)

    def scene(self, text, name="scene.yaml"):
        path = self.dir / name
        path.write_text(text)
        return path

    def start(self, scene):
        """{table: {column: [rows]}} of the operator start."""
        path = self.dir / "start.h5"
        path.unlink(missing_ok=True)
        self.assertEqual(run("oracle", "start", scene, "-o", path), (0, "", ""))
        with h5py.File(path) as file:
            return {name: {word: data[:][:, k] for k, word in enumerate(data.attrs["components"].decode().split())}
                    for name, data in file["start.0"].items()}


class SwitchesTest(Folder):
    NONE = {"version": 2} | dict.fromkeys(("crossing", "exclusion", "collision", "thermostat", "order", "swap", "boundary", "dumbbells",
                                          "medium", "repulsion", "thick"), 0)
    KNOWN = (
        (SOLVENT % "" + "order: paper\n", {}),
        (SOLVENT % ", hydrodynamics: false", {"swap": 1, "order": 1}),
        (SOLVENT % ", rule: at-a" + "order: kick-split\n", {"collision": 1, "order": 1}),
        (SOLVENT % ", rule: at+a" + "order: drift-split\n", {"collision": 2, "order": 2}),
        (SOLVENT % ", thermostat: rescale", {"order": 1, "thermostat": 1}),
        (SOLVENT % ", thermostat: maxwell-boltzmann", {"order": 1, "thermostat": 2}),
        (FIBERS % "" + "crossing: {rule: sequential}\n", {"order": 1, "crossing": 1}),
        (FIBERS % "" + "crossing: {rule: sequential, exclusion: paper}\n", {"order": 1, "crossing": 1, "exclusion": 1}),
        (FIBERS % "" + EVENTS, {"order": 1, "crossing": 2}),
        (FIBERS % "" + "crossing: {forbidden: false}\n", {"order": 1}),
        (FIBERS % ", diameter: 0.05" + EVENTS, {"order": 1, "crossing": 2, "thick": 1}),
        ("dumbbells/periodic", {"dumbbells": 1}),
        ("dumbbells/walls", {"dumbbells": 1, "boundary": 1}),
        ("flow/shear", {"boundary": 2}),
        ("media/langevin", {"medium": 1}),
        ("media/dpd", {"medium": 2, "repulsion": 1, "order": 2}),
        ("media/brownian", {"medium": 3}),
    )

    def test_switches(self):
        for text, others in self.KNOWN:
            path = self.scene(BOX + text) if "\n" in text else DATA / f"{text}.yaml"
            found = {name: column.tolist() for name, column in self.start(path)["in.switches"].items()}
            wanted = {name: [value] for name, value in (self.NONE | others).items()}
            if "\n" not in text:  # of scenes of reference-data only what is named here
                keep = {"boundary", "dumbbells", "medium", "repulsion", "thick", "version", *others}
                found, wanted = ({k: v for k, v in of.items() if k in keep} for of in (found, wanted))
                self.assertEqual(set(found), keep, text)
            self.assertEqual(found, wanted, text)

    def test_ports_refuse_what_they_do_not_know(self):
        """The NumPy port: a new switch that is not 0. One that is 0 is nothing new, and a start of version 1 has none."""
        lines = gzip.open(DATA / "coarse.start.txt.gz", "rt").read().splitlines()
        old = [line for line in lines if "in.switches" not in line]
        self.assertEqual(len(lines) - len(old), 12)
        path, out = self.dir / "start.txt", self.dir / "out.csv"
        for start, code in ((old, 0), (lines + ["start 0 0 in.switches.magnet 0"], 0), (lines + ["start 0 0 in.switches.magnet 1"], 1),
                            ([line.replace("thermostat 0", "thermostat 9") for line in lines], 1)):
            out.unlink(missing_ok=True)
            path.write_text("\n".join(start) + "\n")
            done = subprocess.run([TOP / "ports/numpy/port", "--trace", path, out], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, code, done.stderr)
            if code:
                self.assertIn("this port does not know the switch", done.stderr)
            else:
                self.assertEqual(out.read_text().split(",")[12], (DATA / "coarse.trace.csv").read_text().split(",")[12])

    def test_outside_of_the_contract(self):
        """No start and no trace: a port would compute other physics."""
        for text, why in ((SOLVENT % ", profile: sine, acceleration: [0.1, 0, 0]", "solvent.profile: it is not uniform"),
                          ("dimensions: 2\n" + SOLVENT % "", "dimensions: they are 2"),
                          (SOLVENT % "" + "bead: {radius: 1.5, center: [4, 4, 4]}\n", "bead: there is one"),
                          (SOLVENT % "" + FIBERS % "" + "shear: {rate: 0.1}\n", "fibers: there are some, in walls or shear"),
                          (SOLVENT % ", hydrodynamics: false, bath: phantoms" + FIBERS % "", "solvent.bath: it is phantoms"),
                          (FIBERS % ", frozen: true" + EVENTS, "fibers.frozen or fibers.held: vertices are held"),
                          (FIBERS % ", held: ends" + EVENTS, "fibers.frozen or fibers.held: vertices are held"),
                          (FIBERS % "" + "crossing: {rule: sequential, refusal: bounce}\n", "crossing.refusal or crossing.frame"),
                          (FIBERS % "" + "crossing: {rule: sequential, frame: flow}\n", "crossing.refusal or crossing.frame")):
            box = BOX.replace("[4, 4, 4]", "[4, 4, 1]" if "dimensions" in text else "[8, 8, 8]")
            scene = self.scene(box + text)
            for action in "start", "trace", "emit":
                out = self.dir / "out"
                code, _, said = run("oracle", action, scene, "-o", out)
                self.assertEqual((code, out.exists()), (2, False), (action, text, said))
                self.assertIn(f"{scene}: {why}", said)
                self.assertIn("outside of the contract (docs/port/formats.md)", said)


def digest_of(*words):
    """XXH64 with seed 0 of words of 64 bits."""
    return xxhash.xxh64(b"".join((int(w) % 2**64).to_bytes(8, "little") for w in words)).intdigest()


def bits(values):
    return np.asarray(values, "<f8").view("<u8").tolist()


def state_digest(step, lag, tables):
    """tables: of solvent, vertices, dumbbells: rows of positions and velocities, or of vectors."""
    sizes = [len(tables[0]), len(tables[1]), *(len(t) for t in tables[2:] if len(t))]
    total = digest_of(0, step, lag, *sizes)
    for kind, table in enumerate(tables, 1):
        rows = list(enumerate(table))
        random.Random(5).shuffle(rows)
        total += sum(digest_of(kind, k, *row) for k, row in rows)
    return f"{total % 2**64:016x}"


class DigestTest(Folder):
    def state_of(self, start):
        def rows(*names):
            position, velocity = (start.get(name) for name in names)
            if position is None:
                return []
            return [[*(position[k][i] for k in "xyz"), *bits([velocity[k][i] for k in "xyz"])] for i in range(len(position["x"]))]

        vectors = start.get("in.vector", {"x": []})
        tables = (rows("in.solvent", "in.solvent_velocity"), rows("in.vertex", "in.vertex_velocity"),
                  [[vectors[k][i] for k in "xyz"] for i in range(len(vectors["x"]))])
        return state_digest(start["in.counters"]["step"][0], start["in.counters"]["lag"][0], tables)

    def trace(self, scene, *options):
        code, said, wrong = run("oracle", "trace", scene, *options)
        self.assertEqual((code, wrong), (0, ""))
        return list(csv.DictReader(said.splitlines()))

    def test_of_starts(self):
        for name in ("mixed", "dumbbells/periodic"):
            scene = DATA / f"{name}.yaml"
            self.assertEqual(self.trace(scene)[0]["digest"], self.state_of(self.start(scene)), name)

    def test_a_worked_value(self):
        """The state of the worked hash in port/contract.md: step 0, lag 0, one vertex."""
        one = state_digest(0, 0, ([], [[2**40, -1, 5, *bits([1, -0.5, 0.25])]]))
        self.assertIn(f"its digest is {one}", (TOP / "docs/port/contract.md").read_text())

    @contextlib.contextmanager
    def resealed(self, path):
        """The checkpoint, to be changed: docs/files.md has the seal."""
        path.write_bytes(path.read_bytes()[:-32])
        with h5py.File(path, "r+") as file:
            yield file
        data = path.read_bytes()
        path.write_bytes(data + b"uncross seal v1\n" + len(data).to_bytes(8, "little") + xxhash.xxh64(data).intdigest().to_bytes(8, "little"))

    def test_of_files(self):
        """run.json and the checkpoint say the digest of the last row of the trace; old checkpoints have none, and are read."""
        scene = self.scene(BOX + SOLVENT % "" + FIBERS % "" + EVENTS)
        last = self.trace(scene)[-1]
        self.assertEqual(run("run", scene, "--quiet", "--out", self.dir / "run")[0], 0)
        record = json.loads((self.dir / "run/run.json").read_text())
        self.assertEqual((record["state_hash"], record["state_digest"]), (last["state_hash"], last["digest"]))
        path = self.dir / "run/checkpoint.h5"
        with self.resealed(path) as file:
            self.assertEqual(f"{int(file['head'].attrs['state_digest']):016x}", last["digest"])
            file["head"].attrs.modify("state_digest", np.uint64(1))
        code, said, wrong = run("run", scene, "--quiet", "--out", self.dir / "run", "--resume", "--steps", 8)
        self.assertEqual(code, 2, said + wrong)
        self.assertIn("its state has digest", wrong)
        with self.resealed(path) as file:
            del file["head"].attrs["state_digest"]
        code, said, wrong = run("run", scene, "--quiet", "--out", self.dir / "run", "--resume", "--steps", 8)
        self.assertEqual(code, 0, said + wrong)

    def test_of_contacts(self):
        """The sum of one hash for each row: of no row it is 0, of one row it is the hash of all rows."""
        rows = self.trace(DATA / "events.yaml")
        few = {n: [row for row in rows if row["contacts"] == str(n)] for n in range(4)}
        self.assertTrue(few[0] and few[1] and few[2])
        self.assertEqual({row["contacts_digest"] for row in few[0]}, {"0" * 16})
        for row in few[1]:
            self.assertEqual(row["contacts_digest"], row["contacts_hash"])
        for row in few[2]:
            self.assertNotEqual(row["contacts_digest"], row["contacts_hash"])

    def test_columns_that_were(self):
        """All columns from before digests keep their bytes: the traces of reference-data without the new columns are the old files."""
        old = json.loads((TOP / "tests/oracle/old-traces.json").read_text())
        self.assertGreater(len(old), 15)
        for name, wanted in old.items():
            rows = list(csv.reader((DATA / f"{name}.trace.csv").read_text().splitlines()))
            keep = [k for k, word in enumerate(rows[0]) if "digest" not in word]
            text = "".join(",".join(row[k] for k in keep) + "\n" for row in rows)
            self.assertEqual(xxhash.xxh64(text.encode()).hexdigest(), wanted, name)

    def test_either_hash_will_do(self):
        """A port may leave out the serial hashes; old traces have no digests."""
        lines = (DATA / "events.trace.csv").read_text().splitlines()
        rows = [line.split(",") for line in lines]
        for leave in (("state_hash", "contacts_hash"), ("digest", "contacts_digest")):
            keep = [k for k, word in enumerate(rows[0]) if word not in leave]
            self.assertEqual(len(keep), len(rows[0]) - 2)
            path = self.dir / f"{leave[0]}.csv"
            path.write_text("".join(",".join(row[k] for k in keep) + "\n" for row in rows))
            for pair in ((DATA / "events.trace.csv", path), (path, DATA / "events.trace.csv")):
                code, said, wrong = run("oracle", "compare", *pair)
                self.assertEqual(code, 0, (leave, said, wrong))
            for column, word in (("digest", "state digest"), ("contacts_digest", "contacts_digest")) if leave[0] == "state_hash" else ():
                at = [rows[0][k] for k in keep].index(column)
                changed = [[row[k] for k in keep] for row in rows]
                changed[9][at] = "0123456789abcdef"
                path.write_text("".join(",".join(row) + "\n" for row in changed))
                code, said, _ = run("oracle", "compare", DATA / "events.trace.csv", path)
                self.assertEqual(code, 7)
                self.assertIn(word, said)
        path.write_text("step,stage\n0,start\n")
        code, _, said = run("oracle", "compare", DATA / "events.trace.csv", path)
        self.assertEqual(code, 2)
        self.assertIn("no column state_hash or digest", said)


class TracesTest(Folder):
    STOPS = BOX.replace("steps: 4", "steps: 4000") + FIBERS % ", force: [100, 0, 0]" + EVENTS  # faster and faster

    def test_rows_up_to_a_stop(self):
        scene, out = self.scene(self.STOPS), self.dir / "trace.csv"
        code, _, said = run("oracle", "trace", scene, "-o", out)
        self.assertEqual(code, 3, said)
        rows = list(csv.DictReader(out.read_text().splitlines()))
        self.assertEqual([row["stage"] for row in rows[:2]], ["start", "drift"])
        self.assertTrue(out.read_text().endswith("\n"))
        self.assertLess(int(rows[-1]["step"]), 4000)
        self.assertEqual(run("oracle", "trace", scene)[:2], (3, out.read_text()))

    def test_every(self):
        """Rows start, end of each third step, and of the last one; contacts are counted since the row before."""
        scene = DATA / "events.yaml"
        whole = list(csv.DictReader(run("oracle", "trace", scene)[1].splitlines()))
        some = list(csv.DictReader(run("oracle", "trace", scene, "--every", 3)[1].splitlines()))
        last = int(whole[-1]["step"])
        self.assertEqual([(row["step"], row["stage"]) for row in some],
                         [("0", "start"), *((str(k), "end") for k in range(1, last + 1) if k % 3 == 0 or k == last)])
        ends = {row["step"]: row for row in whole if row["stage"] in ("start", "end")}
        for row in some:
            self.assertEqual((row["state_hash"], row["digest"]), (ends[row["step"]]["state_hash"], ends[row["step"]]["digest"]))
        self.assertEqual(sum(int(row["contacts"]) for row in some), sum(int(row["contacts"]) for row in whole))
        self.assertGreater(sum(int(row["contacts"]) for row in some), 10)


if __name__ == "__main__":
    unittest.main()
