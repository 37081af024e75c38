#!/usr/bin/python3
"""`uncross oracle answer`: the outputs of operators without a state follow from the inputs of committed packs alone, bit by bit."""
import pathlib
import tempfile
import unittest

import h5py
from packs import TOP, run

OPERATORS = {"random", "permutation", "crossing", "exchange", "contact_search", "tube_search", "tube_contact", "bead_search", "bead_contact", "impulse"}
PACKS = ("dense", "mixed", "edges", "contacts", "events", "tubes/mixed", "beads/company")


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
                    places = [place for place in pack if place.rpartition(".")[0] in OPERATORS]
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
        self.assertEqual(answered, OPERATORS)

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
        def with_value(table, row, column, value):
            def change(pack):
                values, attributes = pack[table][:], dict(pack[table].attrs)
                values[row, column] = value
                del pack[table]
                pack.create_dataset(table, data=values).attrs["components"] = attributes["components"]
            return change

        self.refused("contacts", "search 7", with_value("contact_search.1/in.p", 7, 1, 2**60))
        for value in 2**32 + 5, -1:  # neither is taken for what its low 32 bits are
            self.refused("dense", "address 3", with_value("random.2/in.address", 3, 3, value))
            self.refused("edges", "permutation 0", with_value("permutation.1/in.address", 0, 3, value))
            self.refused("contacts", "search 2", with_value("contact_search.1/in.from", 2, 0, value))
        self.refused("edges", "in.flip", lambda pack: pack["crossing.1"].pop("in.flip"))
        self.refused("edges", "seed", lambda pack: pack.pop("model.0"))


if __name__ == "__main__":
    unittest.main()
