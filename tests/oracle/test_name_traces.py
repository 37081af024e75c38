#!/usr/bin/python3
"""What `uncross oracle check` says of a trace that differs: whole steps of the port to NumPy with one change each. The port
whose trace is named has a mistake that no list has.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TOP / "python"), str(TOP / "ports/numpy")]

from uncross_name import catalogue, traces  # noqa: E402
from uncross_port import pack  # noqa: E402

UNCROSS = pathlib.Path(os.environ.get("UNCROSS", TOP / "build/uncross")).resolve()
SECONDS = 30  # of this process, at most, for each
traces.MORE = 0.2  # seconds for others that make the same


class TraceTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def start(self, name):
        subprocess.run([UNCROSS, "oracle", "start", TOP / f"reference-data/{name}.yaml", "-o", self.dir / "start.h5"], check=True)
        return self.dir / "start.h5"

    def named(self, scene, *changes):
        """changes: (line of step.py, what stands there)."""
        mistake = catalogue.Mistake("", "", tuple(("step.py", *change) for change in changes), "", {})
        start = self.start(scene)
        catalogue.plant(mistake)["step"].write_trace(pack.read(start), self.dir / "theirs.csv")
        return traces.read_and_name(start, self.dir / "theirs.csv", SECONDS)

    def test_an_address_of_the_step_before(self):
        said = self.named("mixed", ("shift = solvent.grid_shift(model, step)", "shift = solvent.grid_shift(model, step - 1)"))
        self.assertEqual(said, "solvent.grid_shift is given 1 less as step")
        self.assertNotIn("looks like", said)

    def test_a_hash_of_something_else(self):
        counts = "counts = self.finished, self.lag, len(self.solvent), len(self.vertex)"
        head = 'digest = xxhash.xxh64(struct.pack(f"<{4 + len(optional)}Q", *counts, *optional))'
        said = self.named("mixed", (head, head.replace("4 +", "3 +")), (counts, counts.replace(" self.lag,", "")))
        self.assertIn("the state hash is made without the lag", said)

    def test_a_statement_elsewhere(self):
        """Velocities are swapped before the collision, not after it."""
        swapped = "self.solvent_velocity[solvent.swap_order(model, step, model.particles)]"
        said = self.named("mixed", (f"self.solvent_velocity = {swapped}", "pass"),
                          ("shift = solvent.grid_shift(model, step)", "shift = solvent.grid_shift(model, step); "
                           f"self.solvent_velocity = self.solvent_velocity if self.scene.hydrodynamics else {swapped}"))
        self.assertIn("`if not self.scene.hydrodynamics:`", said)
        self.assertNotIn("looks like", said)

    def test_what_a_stage_leaves(self):
        said = self.named("mixed", ("self.vertex, self.vertex_velocity = moved[:2]", "self.vertex, self.vertex_velocity = moved[0] % (self.model.box * 2**40), moved[1]"))
        self.assertIn("drift wraps the positions of vertex into the box", said)

    def test_one_of_two_calls(self):
        """No change of a line makes it."""
        said = self.named("mixed", ("self.vertex_velocity = solvent.rotate(model, cells[1], self.vertex_velocity, *turn)",
                                    "self.vertex_velocity = solvent.rotate(model, cells[1], self.vertex_velocity, *turn[:3], np.ones_like(factor))"))
        self.assertEqual(said, "the second solvent.rotate is given ones as factor")

    def test_another_stage(self):
        said = self.named("mixed", ('"drift-split": [("drift", 0.5), ("collide", None), ("drift", 0.5), ("force", None), ("kick", 1.0)],',
                                    '"drift-split": [("drift", 0.5), ("drift", 0.5), ("collide", None), ("force", None), ("kick", 1.0)],'))
        self.assertEqual(said, "step 3 has the stages drift, collide, drift, force, kick, end; theirs has drift, drift, collide, force, kick, end")

    def test_states_that_are_right(self):
        """Traces whose hashes are all right, or that have no rows, or too many."""
        start, lines = self.start("mixed"), (TOP / "reference-data/mixed.trace.csv").read_text().splitlines()
        for text, words in ((lines, "all states and contacts are right"), (lines[:1], "theirs has no rows"),
                            ([*lines, lines[-1]], "theirs has rows after the last step")):
            (self.dir / "theirs.csv").write_text("\n".join(text) + "\n")
            self.assertIn(words, traces.read_and_name(start, self.dir / "theirs.csv", SECONDS))

    def test_no_change_makes_it(self):
        """A hash of nothing has no name."""
        start = self.start("mixed")
        rows = (TOP / "reference-data/mixed.trace.csv").read_text().splitlines()
        rows[3] = rows[3].replace(rows[3].split(",")[2], "0123456789abcdef")
        (self.dir / "theirs.csv").write_text("\n".join(row.rsplit(",", 1)[0] for row in rows) + "\n")
        self.assertEqual(traces.read_and_name(start, self.dir / "theirs.csv", traces.LAST + 0.3), traces.UNKNOWN)


if __name__ == "__main__":
    unittest.main()
