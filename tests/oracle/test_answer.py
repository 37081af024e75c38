#!/usr/bin/python3
"""`uncross oracle answer`: outputs follow from the inputs of committed packs alone, bit by bit."""
import pathlib
import tempfile
import unittest

import h5py
from packs import TOP, run

OPERATORS = {"random", "permutation", "crossing", "exchange", "contact_search", "tube_search", "tube_contact", "bead_search", "bead_contact", "impulse"}
OF_STATES = {"sweep", "long_sweep", "event_drift", "long_event_drift", "bin", "bond_force", "bend_force", "force"}
PLAIN = ("dense", "mixed", "coarse", "edges", "contacts", "events", "andersen")  # fibers and points in a periodic box
PACKS = (*PLAIN, "tubes/mixed", "beads/company")


def with_value(table, row, column, value):
    def change(pack):
        values, attributes = pack[table][:], dict(pack[table].attrs)
        values[row, column] = value
        del pack[table]
        pack.create_dataset(table, data=values).attrs["components"] = attributes["components"]
    return change


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
                self.assertIn(f"random.{min(int(place.rpartition('.')[2]) for place in answers)}", answers)
                for name in (f"{place}/{table}" for place in answers for table in answers[place]):
                    self.assertEqual(answers[name][:].tobytes(), pack[name][:].tobytes(), (path, name))

    def test_a_whole_pack(self):
        """All else is as it was."""
        for name in "contacts", "tubes/mixed", "flow/walls", "media/lowe":
            out = self.folder / f"{name.replace('/', '-')}.h5"
            self.assertEqual(run("answer", "--whole", self.pack(name), out), (0, ""))
            self.assertEqual(out.read_bytes(), self.pack(name).read_bytes(), name)

    def refused(self, name, table, change):
        inputs = self.folder / "inputs.h5"
        with h5py.File(self.pack(name)) as pack, h5py.File(inputs, "w") as changed:
            changed.attrs["format"], changed.attrs["version"] = "uncross pack", 2
            for place in pack:
                pack.copy(place, changed)
            change(changed)
        status, said = run("answer", inputs, self.folder / "answers.h5")
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


if __name__ == "__main__":
    unittest.main()
