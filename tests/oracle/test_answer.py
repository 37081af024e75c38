#!/usr/bin/python3
"""`uncross oracle answer`: outputs follow from the inputs of committed packs alone, bit by bit."""
import os
import pathlib
import random
import resource
import subprocess
import sys
import tempfile
import unittest

import h5py
from packs import TOP, UNCROSS, run

sys.path.insert(0, str(TOP / "python"))
from uncross_construct.exact import CELL, deviates, permuted  # noqa: E402

OPERATORS = {"random", "permutation", "crossing", "meeting", "exchange", "contact_search", "tube_search", "tube_contact", "bead_search", "bead_contact", "impulse"}
OF_STATES = {"sweep", "long_sweep", "event_drift", "long_event_drift", "bin", "bond_force", "bend_force", "force"}
PLAIN = ("dense", "mixed", "coarse", "edges", "contacts", "events", "andersen")  # fibers and points in a periodic box
PACKS = (*PLAIN, "tubes/mixed", "beads/company", "topology/meetings")


def with_value(table, row, column, value):
    def change(pack):
        values, attributes = pack[table][:], dict(pack[table].attrs)
        values[row, column] = value
        del pack[table]
        pack.create_dataset(table, data=values).attrs["components"] = attributes["components"]
    return change


def without(table):
    return lambda pack: pack.pop(table)


REALS = "time_step cosine sine acceleration_x acceleration_y acceleration_z"
NUMBERS = "seed_low seed_high particles interval forbidden exclusion_paper"


def text_of(tables):
    """A pack in text, of {(operator, step, table): (columns, rows)}."""
    return "".join(f"{operator} {step} {k} {table}.{column} {value!r}\n" for (operator, step, table), (columns, rows) in tables.items()
                   for k, row in enumerate(rows) for column, value in zip(columns.split(), row, strict=True))


def model_of(box, numbers, vertices, time_step=0.02):
    """The head of a pack, with one fiber of so many vertices."""
    chain = [(k + 1 if k + 1 < vertices else -1, k - 1, 0) for k in range(vertices)]
    return {("model", 0, "in.box"): ("x y z", [box]), ("model", 0, "in.numbers"): (NUMBERS, [numbers]),
            ("model", 0, "in.reals"): (REALS, [(time_step, 0.0, 1.0, 0.0, 0.0, 0.0)]),
            ("model", 0, "in.chain"): ("next prev fiber", chain),
            ("model", 0, "in.vertex"): ("mass bond_length spring bending force_x force_y force_z", [(1.0, 1.0, 3.0, 0.5, 0.0, 0.0, 0.0)] * vertices)}


class Answers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def pack(self, name):
        return TOP / f"reference-data/{name}.pack.h5"

    def test_answers_are_those_of_the_packs(self):
        answered = set()
        for name in PACKS:
            with self.subTest(pack=name):
                inputs, out = self.folder / "inputs.h5", self.folder / f"{name.replace('/', '-')}.h5"
                with h5py.File(self.pack(name)) as pack, h5py.File(inputs, "w") as stripped:  # what came out is not there
                    stripped.attrs["format"], stripped.attrs["version"] = "uncross pack", 2
                    operators = OPERATORS | OF_STATES if name in PLAIN else OPERATORS
                    places = [place for place in pack if place.rpartition(".")[0] in operators]
                    for place in ["model.0", *places]:
                        for table in pack[place]:
                            if table.startswith("in."):
                                pack.copy(f"{place}/{table}", stripped.require_group(place))
                status, said = run("answer", inputs, out)
                self.assertEqual((status, said), (0, ""))
                with h5py.File(self.pack(name)) as pack, h5py.File(out) as answers:
                    self.assertEqual(sorted(answers), sorted(places))
                    for place in places:
                        answered.add(place.rpartition(".")[0])
                        self.assertEqual(sorted(answers[place]), sorted(t for t in pack[place] if not t.startswith("in.")))
                        for table in answers[place]:
                            self.assertEqual(answers[place][table][:].tobytes(), pack[place][table][:].tobytes(), (place, table))
                inputs.unlink()
        self.assertEqual(answered, OPERATORS | OF_STATES)

    def test_every_pack_has_answers(self):
        """Of those that are not plain, rows that stand for themselves. They are those of the pack."""
        for number, path in enumerate(sorted((TOP / "reference-data").glob("*/*.pack.h5"))):
            out = self.folder / f"{number}.h5"
            self.assertEqual(run("answer", path, out), (0, ""), path)
            with h5py.File(path) as pack, h5py.File(out) as answers:
                first = "meeting" if path.parent.name == "topology" else "random"  # the one has no scene
                self.assertIn(f"{first}.{min(int(place.rpartition('.')[2]) for place in answers)}", answers)
                for name in (f"{place}/{table}" for place in answers for table in answers[place]):
                    self.assertEqual(answers[name][:].tobytes(), pack[name][:].tobytes(), (path, name))

    def test_a_whole_pack(self):
        """All else is as it was."""
        for name in "contacts", "tubes/mixed", "flow/walls", "media/lowe":
            out = self.folder / f"{name.replace('/', '-')}.h5"
            self.assertEqual(run("answer", "--whole", self.pack(name), out), (0, ""))
            self.assertEqual(out.read_bytes(), self.pack(name).read_bytes(), name)

    def refused(self, name, table, change, *flags):
        inputs = self.folder / "inputs.h5"
        with h5py.File(self.pack(name)) as pack, h5py.File(inputs, "w") as changed:
            changed.attrs["format"], changed.attrs["version"] = "uncross pack", 2
            for place in pack:
                pack.copy(place, changed)
            change(changed)
        status, said = run("answer", *flags, inputs, self.folder / "answers.h5")
        self.assertEqual(status, 2, said)
        self.assertIn(table, said)
        self.assertFalse((self.folder / "answers.h5").exists())
        inputs.unlink()

    def test_what_cannot_be_asked_is_refused(self):
        self.refused("contacts", "search 7", with_value("contact_search.1/in.p", 7, 1, 2**60))
        for value in 2**32 + 5, -1:  # neither is taken for what its low 32 bits are
            self.refused("dense", "address 3", with_value("random.2/in.address", 3, 3, value))
            self.refused("edges", "permutation 0", with_value("permutation.1/in.address", 0, 3, value))
            self.refused("contacts", "search 2", with_value("contact_search.1/in.from", 2, 0, value))
        self.refused("edges", "in.flip", lambda pack: pack["crossing.1"].pop("in.flip"))
        self.refused("edges", "in.box", lambda pack: pack.pop("model.0"))
        self.refused("media/langevin", "seed", lambda pack: pack["model.0"].pop("in.numbers"))

    def test_a_state_that_cannot_be_is_refused(self):
        for place in "sweep.1/in.position", "bin.1/in.vertex":
            self.refused("edges", "vertex 5 is beyond", with_value(place, 5, 1, 2**62))
        self.refused("edges", "particle 7 is beyond", with_value("bin.1/in.solvent", 7, 2, 3 * 2**40))
        self.refused("edges", "particle 7 is beyond", with_value("bin.1/in.solvent", 7, 0, -1))
        self.refused("edges", "bin, step 1: in.shift: row 0", with_value("bin.1/in.shift", 0, 0, 1))
        self.refused("edges", "in.order: vertex 0 is beyond", with_value("sweep.1/in.order", 0, 0, 117))
        self.refused("edges", "sweep, step 1: in.time: row 0", with_value("sweep.1/in.time", 0, 0, -0.25))
        self.refused("contacts", "event_drift, step 1: in.time: row 0", with_value("event_drift.1/in.time", 0, 1, 0.0))
        for value in 1e9, float("nan"):
            self.refused("edges", "vertex 2 ", with_value("sweep.1/in.velocity", 2, 0, value))
            self.refused("contacts", "vertex 2 ", with_value("event_drift.1/in.velocity", 2, 0, value))

    def test_a_model_that_cannot_be_is_refused(self):
        for table, row, column, value, told in (
                ("box", 0, 1, 0, "box"), ("box", 0, 1, 2**32 + 5, "box"), ("numbers", 0, 2, -1, "per_cell"),
                ("numbers", 0, 3, 2**40, "collision_interval"), ("reals", 0, 0, float("nan"), "time_step"),
                ("chain", 3, 1, 9, "in.chain: row 3"), ("chain", 0, 2, 1, "a ring of 1"), ("vertex", 0, 0, 0.0, "mass"),
                ("vertex", 0, 2, -1.0, "spring")):
            self.refused("edges", told, with_value(f"model.0/in.{table}", row, column, value))

    def answers_of(self, tables, memory=None):
        """{place/table: rows} that a pack in text is answered with. memory: the most that may be asked for, bytes."""
        inputs, out = self.folder / "inputs.txt", self.folder / "out.h5"
        inputs.write_text(text_of(tables))
        out.unlink(missing_ok=True)
        done = subprocess.run([UNCROSS, "oracle", "answer", inputs, out], capture_output=True, text=True, check=False,
                              preexec_fn=lambda: memory and resource.setrlimit(resource.RLIMIT_AS, (memory, memory)))
        if done.returncode:
            return done.returncode, done.stderr
        found = {}
        with h5py.File(out) as pack:
            pack.visititems(lambda name, table: found.update({name: table[:].tolist()}) if isinstance(table, h5py.Dataset) else None)
        return found

    def test_an_operator_that_the_model_has_not_is_refused(self):
        with h5py.File(self.pack("edges")) as edges, h5py.File(self.pack("contacts")) as contacts:
            self.assertEqual(*(pack["model.0/in.numbers"][0, :2].tolist() for pack in (edges, contacts)))
            shift = edges["bin.1/in.shift"][:]

        def with_bin(pack):  # there is no particle
            place = pack.create_group("bin.1")
            for table, columns, values in (("in.shift", 3, shift), ("in.solvent", 3, []), ("in.vertex", 3, pack["event_drift.1/in.position"][:])):
                place.create_dataset(table, (len(values), columns), "<i8", values if len(values) else None).attrs["components"] = b"x y z"

        self.refused("contacts", "bin, step 1: the model of the pack has no such operator; allowed: a solvent", with_bin)
        for flags in (), ("--whole",):
            self.refused("contacts", "event_drift, step 1: the model of the pack has no such operator; allowed: the rule event-driven",
                         with_value("model.0/in.numbers", 0, 4, 0), *flags)

    def test_the_time_of_a_sweep_is_the_one_given(self):
        """(t/dt) dt is another number than t. Displacements are t v, rounded once, to the nearest lattice unit."""
        time, time_step, dice = 1.998, 0.02, random.Random(4)
        other = time / time_step * time_step
        self.assertNotEqual(other, time)

        def moved(velocity, time):
            return [round(time * v * CELL) for v in velocity]

        velocities = []
        while len(velocities) < 3:
            velocity = [dice.uniform(150.0, 250.0) for _ in range(3)]
            if moved(velocity, time) != moved(velocity, other):
                velocities.append(velocity)
        positions = [(k * CELL, 0, 0) for k in range(3)]
        order = permuted(deviates(7, 3, 0, 1, 3))
        for forbidden in 0, 1:
            found = self.answers_of(model_of((1024, 1024, 1024), (7, 0, 0, 0, forbidden, 0), 3, time_step) | {
                ("sweep", 1, "in.time"): ("dt", [(time,)]), ("sweep", 1, "in.order"): ("vertex", [(k,) for k in order]),
                ("sweep", 1, "in.position"): ("x y z", positions), ("sweep", 1, "in.velocity"): ("x y z", velocities)})
            expected = [[a + b for a, b in zip(at, moved(velocity, time))] for at, velocity in zip(positions, velocities)]
            self.assertEqual(found["sweep.1/out.position"], expected)

    def test_memory_is_asked_for_what_is_given_not_for_what_is_claimed(self):
        """2^30 cells and 2^31 particles take more than 100 GB: without them, operators of fibers do what they do in any box."""
        most = 0 if "ASAN_OPTIONS" in os.environ else 2**30  # sanitizers map terabytes
        large, one = (1024, 1024, 1024), [(5 * CELL, 6 * CELL, 7 * CELL)]
        with h5py.File(self.pack("edges")) as edges:
            low, high = edges["model.0/in.numbers"][0, :2].tolist()
            shift = edges["bin.1/in.shift"][0].tolist()

        def binned(particles, given):
            return self.answers_of(model_of(large, (low, high, particles, 1, 1, 0), 1) | {
                ("bin", 1, "in.shift"): ("x y z", [shift]), ("bin", 1, "in.solvent"): ("x y z", given), ("bin", 1, "in.vertex"): ("x y z", one)}, most)

        found = self.answers_of(model_of(large, (low, high, 2**31 - 1, 1, 1, 0), 1) | {("force", 1, "in.position"): ("x y z", one)}, most)
        self.assertEqual(found, {"force.1/out.force": [[0.0, 0.0, 0.0]]})
        status, said = binned(2**31 - 1, one * 2)
        self.assertEqual((status, "bin, step 1: in.solvent: allowed: integers in 2147483647 rows" in said), (2, True), said)
        points = [(0, 0, 0), (1023 * CELL + 5, 3 * CELL, CELL - 1)]
        cells = [[[sum((x + s) // CELL % 1024 * 1024**k for k, (x, s) in enumerate(zip(at, shift)))] for at in places] for places in (points, one)]
        self.assertEqual(binned(2, points), {"bin.1/out.solvent": cells[0], "bin.1/out.vertex": cells[1]})

    def test_a_seed_is_enough_for_rows_that_stand_for_themselves(self):
        with h5py.File(self.pack("edges")) as pack, h5py.File(self.folder / "seed.h5", "w") as seed:
            seed.attrs["format"], seed.attrs["version"] = "uncross pack", 2
            pack.copy("model.0/in.numbers", seed.require_group("model.0"))
            for place in "permutation.1", "crossing.1":
                pack.copy(place, seed)
        out = self.folder / "out.h5"
        self.assertEqual(run("answer", self.folder / "seed.h5", out), (0, ""))
        with h5py.File(self.pack("edges")) as pack, h5py.File(out) as answers:
            for name in "permutation.1/out.order", "crossing.1/out.crosses", "crossing.1/out.hit":
                self.assertEqual(answers[name][:].tobytes(), pack[name][:].tobytes(), name)
        self.refused("edges", "sweep, step 1: in.time", with_value("sweep.1/in.time", 0, 0, -1.0))
        self.refused("edges", "model, step 0: in.reals is missing", without("model.0/in.reals"))

    def test_an_operator_without_an_input_is_refused(self):
        """Whichever it is: one that is not answered would be missed by nobody."""
        for flags in (), ("--whole",):
            for name, table in (("edges", "sweep.1/in.time"), ("edges", "sweep.1/in.velocity"), ("edges", "crossing.1/in.from"),
                                ("edges", "permutation.1/in.address"), ("contacts", "event_drift.1/in.time")):
                place, _, word = table.partition("/")
                self.refused(name, f"{place[:-2]}, step 1: {word} is missing", without(table), *flags)

    def test_a_table_of_no_rows_may_be_missing(self):
        """Text has no line for it: a solvent without fibers is answered in both forms."""
        with h5py.File(self.pack("edges")) as pack:
            low, high = pack["model.0/in.numbers"][0, :2].tolist()
            shift, points, cells = (pack[f"bin.1/{table}"][:].tolist() for table in ("in.shift", "in.solvent", "out.solvent"))
            head = model_of(pack["model.0/in.box"][0].tolist(), (low, high, len(points), 1, 1, 0), 0)
        found = self.answers_of(head | {("bin", 1, "in.shift"): ("x y z", shift), ("bin", 1, "in.solvent"): ("x y z", points)})
        self.assertEqual(found, {"bin.1/out.solvent": cells, "bin.1/out.vertex": []})

    def test_tables_in_any_order_give_the_same_pack(self):
        unknown = {(name, 1, f"in.{table}"): ("x", [(k,)]) for k, name in enumerate(("first", "second")) for table in "abcdefgh"}
        made = []
        for turn in 1, -1:
            text, out = self.folder / f"{turn}.txt", self.folder / f"{turn}.h5"
            text.write_text(text_of(model_of((4, 4, 4), (1, 2, 0, 0, 1, 0), 2) | dict(list(unknown.items())[::turn])))
            self.assertEqual(run("answer", "--whole", text, out), (0, ""))
            made.append((run("dump", text), run("dump", out), out.read_bytes()))
        self.assertEqual(*made)


if __name__ == "__main__":
    unittest.main()
