#!/usr/bin/python3
"""The oracle: this code against its own packs and traces in reference-data/, and the comparison of packs against ports
that are wrong in known ways. Each wrong port is made from the text of a right one, by formulas written out here.
"""
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
DATA = TOP / "reference-data"

UNCROSS = os.environ.get("UNCROSS", str(TOP / "build/uncross"))
FLOWS = ("walls", "paper", "slip", "shear", "wave")
SCENES = ("dense", "mixed", "coarse", "events", "andersen", "flow/spin")
CELL = 1 << 40  # lattice units

# In a process of its own: the memory of this one is that of programs that it starts.
NAME = """
import sys
from uncross_name import case, catalogue, name, search
found = case.read(sys.argv[1])
print(name.name(found, catalogue.read() if sys.argv[2] else [], search.Outputs(found, search.Clock(20))))
"""

# What uses log, exp, sin or cos: these bits belong to the C library.
LIBM = ("random", "maxwell_boltzmann")


def run(*words):
    done = subprocess.run([UNCROSS, "oracle", *map(str, words)], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def number(text):
    if "0x" in text:
        return float.fromhex(text)
    return int(text) if text.lstrip("-").isdigit() else float(text)


def philox(counter, key):
    """Philox 4x32-10, as docs/port/contract.md writes it."""
    c, k = list(counter), list(key)
    for _ in range(10):
        a, b = 0xD2511F53 * c[0], 0xCD9E8D57 * c[2]
        c = [b >> 32 ^ c[1] ^ k[0], b & 0xFFFFFFFF, a >> 32 ^ c[3] ^ k[1], a & 0xFFFFFFFF]
        k = [(k[0] + 0x9E3779B9) & 0xFFFFFFFF, (k[1] + 0xBB67AE85) & 0xFFFFFFFF]
    return c


class Port:
    """The numbers of a pack, to be made wrong: port[operator, step][row, "table.component"]."""

    def __init__(self, text):
        self.places = {}
        for line in text.splitlines():
            if not line.startswith("#"):
                name, step, row, component, value = line.split()
                self.places.setdefault((name, int(step)), {})[int(row), component] = number(value)

    def rows(self, place, component):
        return sum(1 for _, name in self.places[place] if name == component)

    def vector(self, place, row, table):
        return [self.places[place][row, f"{table}.{k}"] for k in "xyz"]

    def set_vector(self, place, row, table, values):
        for k, value in zip("xyz", values):
            self.places[place][row, f"{table}.{k}"] = value

    def text(self):
        lines = []
        for (name, step), values in self.places.items():
            for (row, component), value in values.items():
                lines.append(f"{name} {step} {row} {component} {value.hex() if isinstance(value, float) else value}")
        return "\n".join(lines) + "\n"


class OracleTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.dir = pathlib.Path(cls.folder.name)
        cls.dumps = {}
        for name in SCENES:
            status, cls.dumps[name] = run("dump", DATA / f"{name}.pack.h5")
            assert status == 0, cls.dumps[name]

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def compare(self, port, *options, ours="dense"):
        path = self.dir / "theirs.txt"
        path.write_text(port if isinstance(port, str) else port.text())
        return run("compare", DATA / f"{ours}.pack.h5", path, *options)

    def differ(self, port, *options, ours="dense"):
        """compare without the name, which takes longer."""
        return self.compare(port, "--no-name", *options, ours=ours)

    def assert_named(self, port, *words, known=True):
        """By the catalogue alone. The search for what nobody has written down takes longer, and has tests of its own: test_name.py."""
        path = self.dir / "case.h5"
        path.unlink(missing_ok=True)
        status, said = self.compare(port, "--case", path)
        self.assertEqual(status, 7, said)
        if path.exists():
            said += subprocess.run([sys.executable, "-c", NAME, path, "known" if known else ""], check=True, capture_output=True, text=True,
                                   env={**os.environ, "PYTHONPATH": f"{TOP}/python:{TOP}/ports/numpy"}).stdout
        for word in words:
            self.assertIn(word, said)

    def assert_described(self, port, *words):
        """As if no mistake were known."""
        self.assert_named(port, *words, known=False)

    # --- the code itself ---

    def test_packs_are_those_of_this_code(self):
        for name in SCENES:
            pack = self.dir / f"{name.replace('/', '-')}.h5"
            self.assertEqual(run("emit", DATA / f"{name}.yaml", "-o", pack), (0, ""))
            status, said = run("compare", DATA / f"{name}.pack.h5", pack)
            self.assertIn(status, (0, 6), said)
            exact = [p for p in dict.fromkeys(place for place, _ in Port(self.dumps[name]).places)
                     if p not in LIBM and p != "model" and (p != "rotate" or name != "mixed")]
            status, said = run("compare", DATA / f"{name}.pack.h5", pack, "--only", ",".join(exact))
            self.assertEqual(status, 0, said)

    def test_traces_are_those_of_this_code(self):
        for name in ("dense", "coarse", "events", "andersen", "flow/spin"):
            status, said = run("trace", DATA / f"{name}.yaml")
            self.assertEqual(status, 0, said)
            self.assertEqual(said.splitlines(), (DATA / f"{name}.trace.csv").read_text().splitlines())
        # mixed turns by 130 degrees: its bits belong to the C library after the first collision
        status, said = run("trace", DATA / "mixed.yaml")
        wanted = (DATA / "mixed.trace.csv").read_text().splitlines()
        until = next(k for k, line in enumerate(wanted) if ",collide," in line)
        self.assertEqual(said.splitlines()[:until], wanted[:until])

    def test_packs_of_flows_are_those_of_this_code(self):
        for name in FLOWS:
            pack = self.dir / f"{name}.h5"
            self.assertEqual(run("emit", DATA / f"flow/{name}.yaml", "-o", pack), (0, ""))
            status, said = run("compare", DATA / f"flow/{name}.pack.h5", pack)
            self.assertIn(status, (0, 6), said)
            if name != "paper":  # it turns by 130 degrees: bits of the C library
                self.assertEqual(status, 0, said)
                status, said = run("trace", DATA / f"flow/{name}.yaml")
                self.assertEqual(status, 0, said)
                self.assertEqual(said.splitlines(), (DATA / f"flow/{name}.trace.csv").read_text().splitlines())

    def test_packs_of_flows_show_what_matters(self):
        """Hits of both walls, lone members in cut cells, changes of image, particles that enter."""
        for name in ("walls", "paper", "slip"):
            port = Port(run("dump", DATA / f"flow/{name}.pack.h5")[1])
            hits = [v for place, t in port.places.items() if place[0] == "wall_stream"
                    for (_, c), v in t.items() if c == "out.given.y"]
            self.assertTrue(any(v > 0 for v in hits) and any(v < 0 for v in hits), name)
        walls = Port(run("dump", DATA / "flow/walls.pack.h5")[1])
        cells = [table[k, "in.load.members"] for (operator, _), table in walls.places.items() if operator == "fill"
                 for k in range(64) if table[k, "out.load.members"] > table[k, "in.load.members"]]
        self.assertGreater(cells.count(1), 3)
        shear = Port(run("dump", DATA / "flow/shear.pack.h5")[1])
        for operator in ("shear_stream", "enter"):
            moved = 0
            for (name, _), table in shear.places.items():
                if name == operator:
                    moved += sum(abs(table[k, "out.velocity.x"] - v) > 1 for (k, c), v in table.items() if c == "in.velocity.x")
            self.assertGreater(moved, 2, operator)

    def test_packs_refuse_what_they_lack(self):
        scene = self.dir / "refused.yaml"
        text = (DATA / "flow/walls.yaml").read_text().split("start:")[0]
        scene.write_text(text.replace("thermostat: rescale-layers", "rule: at-a"))
        status, said = run("emit", scene, "-o", self.dir / "refused.h5")
        self.assertEqual(status, 2, said)
        self.assertIn("solvent.rule: it is not srd, between walls", said)

    def test_packs_show_what_matters(self):
        """Crossings through faces, several hits of a move, negative dP, and cells of one member and of none."""
        port = Port(self.dumps["dense"])
        for place in (("long_sweep", 2), ("long_sweep", 20)):
            values = port.places[place]
            events = range(port.rows(place, "out.event.vertex"))
            self.assertTrue(any(values[k, "out.event.image_x"] for k in events))
            self.assertTrue(any(not values[k, "out.event.executed"] for k in events))
            self.assertTrue(any(values[k, "out.hit.momentum"] < 0 for k in events))
        mixed = Port(self.dumps["mixed"])
        loads = {v for (_, name), v in mixed.places["sum", 3].items() if name == "out.load.members"}
        self.assertTrue({0, 1, 2} <= loads, loads)

    def test_coarse_shows_what_needs_luck(self):
        port = Port(self.dumps["coarse"])
        place = "long_sweep", 1
        values, events = port.places[place], range(port.rows(place, "out.event.vertex"))
        self.assertTrue(any(abs(values[k, "out.event.image_x"]) > 1 for k in events))
        self.assertTrue(any(values[k, "out.hit.time"] in (0.0, 1.0) for k in events))
        self.assertEqual(port.rows(("order", 1), "out.order.vertex") % 2, 1)
        self.assertEqual(port.rows(("swap", 1), "out.order.particle") % 2, 1)
        shift = port.vector(("bin", 1), 0, "in.shift")
        on_faces = sum((port.places["bin", 1][k, "in.solvent.x"] + shift[0]) % CELL == 0
                       for k in range(port.rows(("bin", 1), "in.solvent.x")))
        self.assertGreaterEqual(on_faces, 40)
        moves = [line.split(",")[2] for line in (DATA / "coarse.trace.csv").read_text().splitlines() if ",drift," in line]
        self.assertEqual(len(moves), 16)

    def test_events_show_what_matters(self):
        """Contacts through faces, of rings, softened ones; both drifts of a step; and traces that tell other contacts."""
        port = Port(self.dumps["events"])
        self.assertFalse({"order", "crossing", "exchange", "sweep", "long_sweep"} & {name for name, _ in port.places})
        answers, images = [], []
        for step in (2, 40):
            answers += [v for (_, name), v in port.places["impulse", step].items() if name == "out.answer.answer"]
            images += [v for (_, name), v in port.places["long_event_drift", step].items() if name.startswith("out.event.image")]
        self.assertTrue(answers.count(1) >= 10 and answers.count(2) >= 10 and any(images))
        rows = [line.split(",") for line in (DATA / "events.trace.csv").read_text().splitlines()]
        rows = [row[:-1] for row in rows]
        self.assertEqual(rows[0][-2:], ["contacts", "contacts_hash"])
        drifts = [row for row in rows[1:] if row[1] == "drift"]
        self.assertEqual(len(drifts), 60)
        self.assertGreaterEqual(sum(int(row[-2]) for row in drifts), 10)
        self.assertEqual({row[-1] for row in rows[1:] if row[-2] == "0"}, {"ef46db3751d8e999"})
        at = next(k for k, row in enumerate(rows[1:], 1) if row[-2] == "1")
        for column, other in ((-2, "2"), (-1, "0123456789abcdef")):
            changed = [list(row) for row in rows]
            changed[at][column] = other
            path = self.dir / "theirs.csv"
            path.write_text("".join(",".join(row) + "\n" for row in changed))
            status, said = run("compare", DATA / "events.trace.csv", path)
            self.assertEqual(status, 7, said)
            self.assertIn(f"step {rows[at][0]}, stage drift: the same state, other sums", said)
            self.assertIn(("contacts", "contacts_hash")[column + 2] + " ", said)

    def test_long_sweep_fits_the_box(self):
        """Moves of 32 steps would be longer than half an edge: 16, 8, ... are taken."""
        scene = self.dir / "fast.yaml"
        scene.write_text("box: [2, 2, 2]\ntime_step: 0.03\nsteps: 4\nseed: 3\n"
                         "solvent: {per_cell: 3, collision_interval: 0.06}\n"
                         "fibers: [{name: chain, count: 3, vertices: 4, mass: 1, bond_length: 0.3, spring: 100, bending: 1}]\n"
                         "crossing: {rule: sequential}\n")
        self.assertEqual(run("emit", scene, "-o", self.dir / "fast.h5"), (0, ""))
        port = Port(run("dump", self.dir / "fast.h5")[1])
        times = [port.places["long_sweep", step][0, "in.time.dt"] / 0.03 for step in (2, 4)]
        self.assertTrue(all(t in (1, 2, 4, 8, 16) for t in times), times)

    def test_text_holds_every_bit(self):
        for name in SCENES:
            status, said = self.compare(self.dumps[name], ours=name)
            self.assertEqual(status, 0, said)

    def test_random_numbers_by_the_contract(self):
        port = Port(self.dumps["dense"])
        model, values = port.places["model", 0], port.places["random", 2]
        key = model[0, "in.numbers.seed_low"], model[0, "in.numbers.seed_high"]
        for row in range(port.rows(("random", 2), "in.address.purpose")):
            purpose, draw, step, entity = (values[row, f"in.address.{k}"]
                                           for k in ("purpose", "draw", "step", "entity"))
            words = philox((entity, purpose + 256 * draw, step & 0xFFFFFFFF, step >> 32), key)
            self.assertEqual(words, [values[row, f"out.word.{k}"] for k in range(4)])
            self.assertEqual(((words[0] + (words[1] << 32) >> 12) + 0.5) * 2.0**-52, values[row, "out.uniform.0"])
            if f"{purpose}, {draw}, {step}, {entity}" in ("1, 0, 2, 0", "2, 0, 2, 0", "3, 1, 1, 0"):
                page = (TOP / "docs/port/contract.md").read_text()
                self.assertIn(" ".join(map(str, words)) + f" | {values[row, 'out.uniform.0']!r}", page)

    # --- other codes ---

    def test_one_ulp_is_close(self):
        port = Port(self.dumps["dense"])
        values = port.places["kick", 2]
        values[17, "out.velocity.y"] = math.nextafter(values[17, "out.velocity.y"], 1e9)
        status, said = self.compare(port)
        self.assertEqual(status, 6, said)
        self.assertIn("kick, step 2, vertex 17, out.velocity.y", said)
        self.assertIn(": 1 ulps", said)

    def test_nan_differs(self):
        port = Port(self.dumps["dense"])
        port.places["kick", 2][17, "out.velocity.y"] = math.nan
        self.assert_named(port, "kick, step 2, vertex 17, out.velocity.y")

    def test_missing_operator_differs(self):
        port = Port(self.dumps["dense"])
        del port.places["stream", 20]
        self.assert_named(port, "stream", "not there")
        self.assertEqual(self.compare(port, "--only", "kick,bin")[0], 0)

    def test_another_input_differs(self):
        port = Port(self.dumps["dense"])
        port.places["kick", 2][3, "in.force.z"] += 1.0
        self.assert_named(port, "kick", "for another input: in.force")

    def binned(self, tables, sign, transpose=False):
        port = Port(self.dumps["dense"])
        box = [port.places["model", 0][0, f"in.box.{k}"] for k in "xyz"]
        for step in (2, 20):
            place = "bin", step
            shift = port.vector(place, 0, "in.shift")
            for table in tables:
                for row in range(port.rows(place, f"out.{table}.cell")):
                    r = port.vector(place, row, f"in.{table}")
                    x, y, z = ((p + sign * s) // CELL % n for p, s, n in zip(r, shift, box))
                    cell = (x * box[1] + y) * box[2] + z if transpose else (z * box[1] + y) * box[0] + x
                    port.places[place][row, f"out.{table}.cell"] = cell
        return port

    def test_grid(self):
        self.assertEqual(self.compare(self.binned(("solvent", "vertex"), 1))[0], 0)
        self.assert_named(self.binned(("solvent", "vertex"), -1), "grid shift sign")
        self.assert_named(self.binned(("vertex",), 0), "solvent only")
        self.assert_named(self.binned(("solvent", "vertex"), 0), "no grid shift")
        self.assert_named(self.binned(("solvent", "vertex"), 1, transpose=True), "x slowest")

    def rotated(self, sense, with_factor):
        """R w = n (n.w) +- n x w, at 90 degrees."""
        port = Port(self.dumps["dense"])
        for place in (("rotate", 2), ("rotate", 20)):
            values = port.places[place]
            for table in ("solvent", "vertex"):
                for row in range(port.rows(place, f"in.{table}_cell.cell")):
                    cell = values[row, f"in.{table}_cell.cell"]
                    if not values[cell, "in.active.active"]:
                        continue
                    n, c = port.vector(place, cell, "in.axis"), port.vector(place, cell, "in.center")
                    w = [a - b for a, b in zip(port.vector(place, row, f"in.{table}"), c)]
                    along = sum(a * b for a, b in zip(n, w))
                    cross = [n[1] * w[2] - n[2] * w[1], n[2] * w[0] - n[0] * w[2], n[0] * w[1] - n[1] * w[0]]
                    f = values[cell, "in.factor.factor"] if with_factor else 1.0
                    port.set_vector(place, row, f"out.{table}",
                                    [c[k] + f * (along * n[k] + sense * cross[k]) for k in range(3)])
        return port

    def test_rotation(self):
        self.assertIn(self.compare(self.rotated(1, True))[0], (0, 6))
        self.assert_named(self.rotated(-1, True), "rotate, step 2", "rotation transposed")
        self.assert_named(self.rotated(1, False), "factor")

    def changed(self, place, table, change, *places):
        port = Port(self.dumps["dense"])
        for place in (place, *places):
            for (row, name), value in list(port.places[place].items()):
                if name.startswith(table + "."):
                    port.places[place][row, name] = change(port.places[place], row, name, value)
        return port

    def test_kick(self):
        def half(values, row, name, value):
            before = values[row, name.replace("out.", "in.")]
            return before + 0.5 * (value - before)
        self.assert_named(self.changed(("kick", 2), "out.velocity", half), "kick by half of the time", "where the step is 2")
        self.assert_named(self.changed(("kick", 2), "out.velocity", half, ("kick", 20)), "kick by half of the time")

    def test_forces(self):
        self.assert_named(self.changed(("bend_force", 2), "out.force", lambda *a: -a[3]), "bend_force", "sign of the forces of bends", "rows where the step is 2")

    def test_single_precision(self):
        port = self.changed(("force", 2), "out.force", lambda *a: struct.unpack("f", struct.pack("f", a[3]))[0])
        self.assert_named(port, "single precision")
        status, said = self.compare(port, "--single")
        self.assertEqual(status, 6, said)

    def test_stream(self):
        edge = 4 * CELL
        def unwrapped(values, row, name, value):
            return value + edge if name.endswith(".x") and value < CELL // 8 else value
        self.assert_named(self.changed(("stream", 2), "out.position", unwrapped), "a constant offset: 4398046511104 more", "wrong exactly in 4 of 480 rows")

    def drawn(self, change):
        """Words of other counters or keys, at both steps."""
        port = Port(self.dumps["dense"])
        model = port.places["model", 0]
        key = model[0, "in.numbers.seed_low"], model[0, "in.numbers.seed_high"]
        for step in (2, 20):
            values = port.places["random", step]
            for row in range(port.rows(("random", step), "in.address.purpose")):
                address = [values[row, f"in.address.{k}"] for k in ("purpose", "draw", "step", "entity")]
                for k, word in enumerate(change(*address, key)):
                    values[row, f"out.word.{k}"] = word
        return port

    def test_random_words(self):
        def counter(purpose, draw, step, entity):
            return entity, purpose + 256 * draw, step & 0xFFFFFFFF, step >> 32

        def short(purpose, draw, step, entity, key):
            return philox(counter(purpose, draw, step, entity & 0xFFFF), key)

        def early(purpose, draw, step, entity, key):
            return philox(counter(purpose, draw, step & 0xFFFFFFFF, entity), key)

        def turned(purpose, draw, step, entity, key):
            return philox(counter(purpose, draw, step, entity), key[::-1])

        def other(purpose, draw, step, entity, key):
            return philox(counter(purpose, draw, step, entity)[::-1], key)

        self.assertEqual(self.compare(self.drawn(lambda *a: philox(counter(*a[:4]), a[4])))[0], 0)
        self.assert_named(self.drawn(short), "random", "entities cut to 16 bits")
        for wrong in (early, turned, other):  # their names: mistakes/base.yaml
            self.assertEqual(self.differ(self.drawn(wrong))[0], 7)

    def test_few_ulps_are_not_single(self):
        """2 ulps off everywhere in one direction: beyond the tolerance of uniforms."""
        port = Port(self.dumps["dense"])
        for step in (2, 20):
            values = port.places["random", step]
            for row in range(port.rows(("random", step), "out.uniform.0")):
                values[row, "out.uniform.0"] -= 2.0**-51
        self.assert_named(port, "a constant offset: 4.44089")

    def test_mass_and_center(self):
        port = Port(self.dumps["dense"])
        for step in (2, 20):
            values, time = port.places["kick", step], port.places["kick", step][0, "in.time.dt"]
            for row in range(port.rows(("kick", step), "in.force.x")):
                for k in "xyz":
                    values[row, f"out.velocity.{k}"] = (values[row, f"in.velocity.{k}"] +
                                                        time * values[row, f"in.force.{k}"])
        self.assert_named(port, "kick without the mass")

    # --- sweeps: the events of a long one, changed ---

    def events(self, keep=lambda event: True, change=lambda event: event):
        port = Port(self.dumps["dense"])
        for place in (("long_sweep", 2), ("long_sweep", 20)):
            values = port.places[place]
            rows = [{name: values.pop((row, name)) for r, name in list(values) if r == row and
                     name.startswith(("out.event.", "out.hit."))} for row in range(port.rows(place, "out.event.vertex"))]
            for row, event in enumerate(change(event) for event in rows if keep(event)):
                for name, value in event.items():
                    values[row, name] = value
        return port

    def test_events(self):
        def across(event):
            return not any(event[f"out.event.image_{k}"] for k in "xyz")

        def half(event):
            return event | {"out.hit.momentum": 0.5 * event["out.hit.momentum"]}

        self.assertEqual(self.compare(self.events())[0], 0)
        self.assert_described(self.events(keep=across), "all vertices end where they should", "42 events are not reported", "the partner is an image")
        self.assert_described(self.events(change=half), "a constant factor: 0.5")
        count = [0]

        def all_but_third(event):
            count[0] += across(event)
            return count[0] != 3 or not across(event)
        self.assert_described(self.events(keep=all_but_third), "1 events are not reported")

    # --- bad input ---

    def test_names_cannot_act_on_a_terminal(self):
        """A pack and a trace come from anywhere: escape sequences in their names are shown, and not sent."""
        escape, place = "\x1b[31m", "ki\x1b[31mck 2 0 out.velo\x1b[1mcity"
        files = {"ours": f"{place}.x\x1b[2m 1.0\n", "other": f"{place}.x\x1b[2m 2.0\n", "none": "kick 2 0 out.velocity.x 1.0\n",
                 "two": f"{place}.x\x1b[2m 1.0\n{place}.y\x1b[3m 1.0\n",
                 "half": f"{place}.x\x1b[2m 1.0\n{place}.y\x1b[3m 2.0\n",
                 "input": f"{place}.x\x1b[2m 1.0\n{place.replace('out', 'in')}.x 1.0\n",
                 "changed": f"{place}.x\x1b[2m 1.0\n{place.replace('out', 'in')}.x 2.0\n",
                 "trace": f"step,stage,state_hash,{escape}sum\n1,dr{escape}ift,a{escape},1{escape}\n",
                 "later": f"step,stage,state_hash,{escape}sum\n1,dr{escape}ift,b{escape},2{escape}\n",
                 "longer": f"step,stage,state_hash,{escape}sum\n" + f"1,dr{escape}ift,a{escape},1{escape}\n" * 2}
        for name, text in files.items():
            (self.dir / f"{name}.txt").write_text(text)
        shown = {("ours", "other"): ["ki\\x1b[31mck", "out.velo\\x1b[1mcity.x\\x1b[2m: 1 here"],
                 ("ours", "none"): ["ki\\x1b[31mck", "out.velo\\x1b[1mcity not there"],
                 ("two", "half"): ["this pattern: wrong exactly in column y\\x1b[3m"],
                 ("two", "ours"): ["columns that are not there: y\\x1b[3m"],
                 ("ours", "two"): ["unknown column y\\x1b[3m"],
                 ("input", "changed"): ["for another input: in.velo\\x1b[1mcity"],
                 ("trace", "later"): ["stage dr\\x1b[31mift", "a\\x1b[31m here, b\\x1b[31m there", "1\\x1b[31m here, 2"],
                 ("longer", "trace"): ["stage dr\\x1b[31mift: missing"]}
        for (ours, theirs), words in shown.items():
            said = run("compare", self.dir / f"{ours}.txt", self.dir / f"{theirs}.txt")[1]
            self.assertNotIn("\x1b", said)
            for word in words:
                self.assertIn(word, said)
        said = run("dump", self.dir / "ours.txt")[1]
        self.assertNotIn("\x1b", said)
        self.assertIn("ki\\x1b[31mck 2 0 out.velo\\x1b[1mcity.x\\x1b[2m 0x1p+0", said)

    def test_bad_text(self):
        for text, where in (("kick 2 0 out.velocity.x\n", ":1:"), ("# fine\nkick two 0 out.v.x 1\n", ":2:6:"),
                            ("kick 2 0 velocity 1\n", ":1:10:"), ("kick 2 0 out.v.x 1y\n", ":1:18:"),
                            ("kick 2 1 out.v.x 1\n", "1 values for 2 rows"), ("", "holds no values"),
                            ("kick 2 0 out.v.x 1\n# x is missing in row 1\nkick 2  0 out.v.x 1\nkick 2 0 out.v.y 1\n"
                             "kick 2 1 out.v.y 1\n", ":3:11: given before"),
                            ("kick 2 0 out.v.x 1\0 7 nonsense\n", ":1:19: a NUL byte"),
                            ("kick 2 0 out.v.x 1\n\0\n", ":2:1: a NUL byte"),
                            ("kick 2 9 out.v.x 1\nkick 2 0 out.v.x 1\nkick 2 9 out.v.x 1\n", ":3:10: given before")):
            status, said = self.compare(text)
            self.assertEqual(status, 2, said)
            self.assertIn(where, said)

    @unittest.skipIf("ASAN_OPTIONS" in os.environ, "the sanitizer's realloc copies what nobody has touched")
    def test_memory_is_of_what_is_given(self):
        """A row of a large number, where the room for rows grows by a factor, and what is there is moved."""
        path, most = self.dir / "far.txt", 100  # MB
        path.write_text("op 1 1048574 in.a.x 1\nop 1 1048576 in.a.x 2\n")
        dumped = subprocess.Popen([UNCROSS, "oracle", "dump", path], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                  text=True)
        with dumped.stderr:
            said = dumped.stderr.read()
        _, status, usage = os.wait4(dumped.pid, 0)
        dumped.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(dumped.returncode, 2, said)
        self.assertIn("2 values for 1048577 rows", said)
        self.assertLess(usage.ru_maxrss, most * 1024)  # KiB

    def test_values_of_any_order(self):
        """All columns of a table, and rows from the last to the first: each number where it belongs."""
        names = "abcdefghijklmnop"
        lines = [f"op 1 {row} in.a.{name} {100 * row + k}" for row in range(200) for k, name in enumerate(names)]
        path = self.dir / "order.txt"
        path.write_text("\n".join(lines[:16] + lines[:15:-1]) + "\n")
        self.assertEqual(run("dump", path), (0, self.dumps["dense"].splitlines()[0] + "\n" + "\n".join(lines) + "\n"))
        path.write_text("\n".join(lines) + "\nop 1 7 in.a.p 1\n")
        status, said = run("dump", path)
        self.assertEqual(status, 2)
        self.assertIn(":3201:8: given before", said)

    def test_comments_of_any_length(self):
        comment = "# " + "as long as it takes, " * 1000 + "\n"
        self.assertEqual(self.compare(comment + self.dumps["dense"] + comment)[0], 0)

    def test_bad_words(self):
        self.assertEqual(run("emit", DATA / "dense.yaml")[0], 2)
        self.assertEqual(run("compare", DATA / "dense.pack.h5")[0], 2)
        self.assertEqual(run("compare", DATA / "dense.pack.h5", DATA / "dense.pack.h5", "--only", "kic")[0], 2)
        self.assertEqual(run("dump", DATA / "dense.start.h5")[0], 2)
        self.assertEqual(run("--help")[0], 0)

    def test_nothing_is_written_over(self):
        """Nor is a step made in vain: these are many, and in the end a bond is too long for so small a box."""
        scene = self.dir / "long.yaml"
        scene.write_text((DATA / "dense.yaml").read_text().replace("steps: 20", "steps: 1000000000")
                         .replace("dense.start.h5", str(DATA / "dense.start.h5")))
        there = self.dir / "there"
        there.write_text("mine")
        for action in "emit", "trace":
            status, said = run(action, scene, "-o", there)
            self.assertEqual((status, there.read_text()), (2, "mine"), said)
            self.assertIn("there: cannot create: File exists", said)
            self.assertEqual(run(action, scene, "-o", self.dir / "nowhere" / "out")[0], 4)
        self.assertEqual(run("dump", DATA / "dense.pack.h5", "-o", there)[0], 2)

    def test_what_is_killed_leaves_no_empty_file(self):
        """The file is there when the pack is made: what is called again is not refused."""
        scene, out = self.dir / "long.yaml", self.dir / "out"
        scene.write_text("box: [8, 8, 8]\ntime_step: 0.01\nsteps: 1000000000\nsolvent: {per_cell: 5, collision_interval: 0.01}\n")
        with subprocess.Popen([UNCROSS, "oracle", "emit", scene, "-o", out], stderr=subprocess.PIPE) as emits:
            with self.assertRaises(subprocess.TimeoutExpired):
                emits.wait(timeout=1)
            emits.kill()
        self.assertFalse(out.exists())

    def test_scenes_that_use_little(self):
        """Packs hold every operator of particles and vertices, also where the scene uses few: free crossings, lone vertices."""
        kinds = {"free": "fibers: [{name: a, count: 2, vertices: 3, mass: 5, bond_length: 0.5, spring: 100}]\n"
                         "crossing: {forbidden: false}\n",
                 "lone": "fibers: [{name: a, count: 3, vertices: 1, mass: 5, bond_length: 0, spring: 1}]\n", "bare": ""}
        for name, fibers in kinds.items():
            scene, pack = self.dir / f"{name}.yaml", self.dir / f"{name}.h5"
            scene.write_text("box: [4, 4, 4]\ntime_step: 0.02\nsteps: 4\nsolvent: {per_cell: 5, collision_interval: 0.02}\n"
                             + fibers)
            self.assertEqual(run("emit", scene, "-o", pack), (0, ""), name)

    def test_packs_of_few_vertices(self):
        """Two fibers that never touch, by the rule `event-driven`: operators without rows."""
        scene, pack = self.dir / "few.yaml", self.dir / "few.h5"
        scene.write_text("box: [4, 4, 4]\ntime_step: 0.02\nsteps: 4\n"
                         "fibers: [{name: a, count: 2, vertices: 3, mass: 5, bond_length: 0.5, spring: 100}]\n"
                         "crossing: {rule: event-driven}\n")
        self.assertEqual(run("emit", scene, "-o", pack), (0, ""))
        self.assertEqual(run("compare", pack, pack)[0], 0)
        self.assertEqual(run("trace", scene)[0], 0)

    def test_packs_of_other_collision_rules(self):
        """A pack of the rules at-a and at+a has its own operators, in place of those of srd."""
        for rule, own, others in (("at-a", {"mean", "give"}, {"moments", "spin", "give_spin"}),
                                  ("at+a", {"moments", "spin", "give_spin"}, {"mean", "give"})):
            scene, pack = self.dir / f"{rule}.yaml", self.dir / f"{rule}.h5"
            scene.write_text("box: [4, 4, 4]\ntime_step: 0.02\nsteps: 4\n"
                             f"solvent: {{per_cell: 5, collision_interval: 0.02, rule: {rule}}}\n")
            self.assertEqual(run("emit", scene, "-o", pack), (0, ""))
            status, said = run("dump", pack)
            operators = {line.split()[0] for line in said.splitlines() if not line.startswith("#")}
            self.assertEqual(status, 0)
            self.assertLessEqual({"draw", "sum"} | own, operators)
            self.assertFalse(operators & (others | {"solve", "rotate", "rescale", "maxwell_boltzmann"}))
            status, said = run("trace", scene)
            self.assertEqual((status, said.count(",collide,")), (0, 4))


if __name__ == "__main__":
    unittest.main()
