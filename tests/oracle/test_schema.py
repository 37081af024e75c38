#!/usr/bin/python3
"""The table of operators (`uncross oracle schema`) against committed packs and starts, which were made before there was a table; and
what is made of it: tables of docs/port/operators.md, names of columns of the port to NumPy.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import h5py
from packs import TOP, UNCROSS, run

sys.path.insert(0, str(TOP / "ports/numpy"))
from uncross_port import operators, pack  # noqa: E402  pylint: disable=wrong-import-position


def schema():
    status, said = run("schema")
    assert status == 0, said
    return json.loads(said)["operators"]


class Schema(unittest.TestCase):
    def test_packs_have_these_tables(self):
        known = {(o["name"], t["name"]): t for o in schema() for t in o["tables"]}
        seen = set()
        for path in sorted((TOP / "reference-data").glob("**/*.pack.h5")):
            with h5py.File(path) as file:
                for place in file:
                    operator = place.rpartition(".")[0]
                    for name, data in file[place].items():
                        with self.subTest(pack=path.name, place=place, table=name):
                            table = known[operator, name]
                            self.assertEqual(table["type"], "real" if data.dtype.kind == "f" else "integer")
                            self.assertEqual(" ".join(table["columns"]), data.attrs["components"].decode())
                            seen.add((operator, name))
        self.assertEqual({of for of in known if of[0] != "start"}, seen, "each table is in some pack")

    def test_packs_have_no_other_tables(self):
        for name in ("mixed", "flow/wave"):
            with self.subTest(pack=name), tempfile.TemporaryDirectory() as folder:
                made = pathlib.Path(folder) / "made.h5"
                self.assertEqual(run("emit", TOP / f"reference-data/{name}.yaml", "-o", made), (0, ""))
                with h5py.File(TOP / f"reference-data/{name}.pack.h5") as old, h5py.File(made) as new:
                    self.assertEqual({place: set(old[place]) for place in old}, {place: set(new[place]) for place in new})

    def test_tables_stand_in_the_order_of_packs(self):
        for operator in schema():
            kinds = [table["name"].partition(".")[0] for table in operator["tables"]]
            self.assertEqual(kinds, sorted(kinds, key=lambda kind: kind != "in"), operator["name"])
            self.assertTrue(all(("exact" in table) == table["name"].startswith("out.") for table in operator["tables"]))

    def test_what_is_made_of_it_is_in_step(self):
        done = subprocess.run([TOP / "tools/document-oracle", "--check", UNCROSS], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_the_port_has_these_operators(self):
        self.assertEqual(set(operators.OPERATORS), {o["name"] for o in schema()} - {"model", "start"})
        self.assertEqual(pack.columns("swap", "out.order"), "particle")
        self.assertEqual(pack.columns("sum", "out.momentum"), "x y z")


if __name__ == "__main__":
    unittest.main()
