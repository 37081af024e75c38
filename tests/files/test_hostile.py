"""Files made to reach other files, to claim what they do not hold, or that are no files at all: refused, with a word,
and nothing else is opened. h5py makes them. Needs UNCROSS."""
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile
import unittest

import h5py

import damage

UNCROSS = os.path.abspath(os.environ.get("UNCROSS", "build/uncross"))
POSITION = "particles/trajectory/position"
SECRET = 1.2345678912345  # what another file holds


def change(path, act):
    with h5py.File(path, "r+") as file:
        act(file)


def external_storage(file):
    group = file[POSITION]
    shape = group["value"].shape
    del group["value"]
    how = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    how.set_external(b"secret.bin", 0, shape[0] * shape[1] * shape[2] * 8)
    h5py.h5d.create(group.id, b"value", h5py.h5t.IEEE_F64LE, h5py.h5s.create_simple(shape), dcpl=how)


def virtual(file):
    group = file[POSITION]
    shape = group["value"].shape
    del group["value"]
    layout = h5py.VirtualLayout(shape=shape, dtype="f8")
    layout[:] = h5py.VirtualSource("other.h5", POSITION + "/value", shape=shape)
    group.create_virtual_dataset("value", layout)


def external_link(file, target="other.h5"):
    del file[POSITION]["value"]
    file[POSITION]["value"] = h5py.ExternalLink(target, "/" + POSITION + "/value")


def external_group(file):
    del file["particles"]
    file["particles"] = h5py.ExternalLink("other.h5", "/particles")


def soft_link(file):
    del file[POSITION]["value"]
    file["out"] = h5py.ExternalLink("other.h5", "/particles")
    file[POSITION]["value"] = h5py.SoftLink("/out/trajectory/position/value")


def pipe_link(file):
    external_link(file, "pipe.h5")


def claim(file):
    del file[POSITION]["value"]
    file[POSITION].create_dataset("value", shape=(1, 2**31 - 2, 3), dtype="f8", chunks=(1, 1024, 3))


FORMS = [external_storage, virtual, external_link, external_group, soft_link, pipe_link, claim]

# (group, attribute, value): numbers that no checkpoint has
NUMBERS = [("structure", "cells", [0, 0, 0]), ("structure", "cells", [2147483647] * 3), ("structure", "cells", [-1, 4, 4]),
           ("structure", "particles", 2**32 - 1), ("structure", "vertices", 2**32 - 1), ("structure", "vertices", 9),
           ("structure", "time_step", float("nan")), ("structure", "time_step", 0.0), ("state", "step", 2**63),
           ("head", "wall_seconds", -1.0), ("state", "solvent_lag", 2**32 - 1)]


class Hostile(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.place.name)
        (cls.folder / "s.yaml").write_text(damage.SCENE)
        cls.run_words("run", "s.yaml", "--out", "run", "--quiet")
        shutil.copy(cls.folder / "run/trajectory.h5", cls.folder / "other.h5")
        (cls.folder / "secret.bin").write_bytes(struct.pack("<d", SECRET) * 10**5)
        os.mkfifo(cls.folder / "pipe.h5")
        start = damage.SCENE.replace("seed: 1\n", "seed: 1\nstart: {snapshot: bad.h5}\n")
        (cls.folder / "start.yaml").write_text(start)

    @classmethod
    def tearDownClass(cls):
        cls.place.cleanup()

    @classmethod
    def run_words(cls, *words):
        """The program within 2 GB of address space: what a file claims is not allocated."""
        limit = "" if "ASAN_OPTIONS" in os.environ else "ulimit -v 2000000; "  # sanitizers map terabytes
        return subprocess.run(["bash", "-c", limit + 'exec "$0" "$@"', UNCROSS, *words], cwd=cls.folder,
                              capture_output=True, timeout=60, check=False)

    def refused(self, what, *words):
        done = self.run_words(*words)
        self.assertIn(done.returncode, (2, 9), f"{what}: {words}: {done}")
        self.assertNotIn(b"1.23456789", done.stdout, what)
        self.assertRegex(done.stdout + done.stderr, rb".{10,}", what)
        self.assertNotIn(b"dies", done.stdout + done.stderr, what)

    def test_no_other_file_is_read(self):
        for form in FORMS:
            shutil.copy(self.folder / "other.h5", self.folder / "bad.h5")
            change(self.folder / "bad.h5", form)
            for words in (["export", "--solvent", "bad.h5"], ["info", "bad.h5"], ["verify", "bad.h5"],
                          ["analyze", "bad.h5", "--out", "tables"], ["run", "start.yaml", "--out", "started", "--quiet"],
                          ["oracle", "dump", "bad.h5"]):
                self.refused(form.__name__, *words)

    def test_no_other_file_is_written(self):
        before = (self.folder / "other.h5").read_bytes()
        for form in FORMS:
            place = self.folder / f"resumed-{form.__name__}"
            shutil.copytree(self.folder / "run", place)
            change(place / "trajectory.h5", form)
            for name in "other.h5", "secret.bin":
                shutil.copy(self.folder / name, place / name)
            done = self.run_words("run", "s.yaml", "--out", place.name, "--resume", "--steps", "25", "--quiet")
            self.assertEqual(done.returncode, 0, form.__name__)
            self.assertIn(b"trajectory.damaged.1.h5", done.stderr, form.__name__)
            self.assertEqual((place / "other.h5").read_bytes(), before, form.__name__)

    def test_what_is_no_file_is_refused(self):
        for path in "pipe.h5", "/dev/zero", ".":
            for words in (["export", path], ["info", path], ["oracle", "dump", path], ["oracle", "compare", path, path]):
                self.refused(path, *words)
        self.refused("pipe.h5", "verify", "pipe.h5")

    def test_numbers_are_within_their_ranges(self):
        for group, name, value in NUMBERS:
            shutil.copy("tests/files/old/checkpoint.h5", self.folder / "bad.h5")  # version 1: no seal to make anew
            with h5py.File(self.folder / "bad.h5", "r+") as file:
                file[group].attrs.modify(name, value)
            for words in ["export", "--solvent", "bad.h5"], ["verify", "bad.h5"], ["info", "bad.h5"]:
                self.refused(f"{group}/{name} = {value}", *words)

    def test_whole_numbers_that_no_run_has(self):
        """Differences of them, and sums with a few more, must be 64-bit numbers: what is remembered of steps, places and counts."""
        observed = damage.SCENE.partition("trajectory")[0] + ("observe: {collisions: {every: 5}, dynamics: {every: 5}, memory: {every: 5}, "
                                                              "orientation: {every: 5}, statics: {every: 5}, profile: {every: 5, slabs: 4}}\n")
        (self.folder / "observed.yaml").write_text(observed)
        self.run_words("run", "observed.yaml", "--out", "observed", "--quiet")
        whole = (self.folder / "observed/checkpoint.h5").read_bytes()
        with h5py.File(self.folder / "observed/checkpoint.h5") as file:
            blocks = [name for name, data in file["observers"].items() if name.endswith("-integers") and data.size > 1]
            counts = [name for name in file["state"].attrs if name in ("executed", "moves", "solvent_time", "softened")]
        self.assertGreaterEqual(len(blocks), 4)
        self.assertEqual(len(counts), 4)
        resume = ["run", "observed.yaml", "--out", "observed", "--resume", "--steps", "30", "--quiet"]
        for name, value in [*((block, value) for block in blocks for value in (-2**63, 2**63 - 1)), *((count, 2**63) for count in counts)]:
            (self.folder / "observed/checkpoint.h5").write_bytes(whole)
            with h5py.File(self.folder / "observed/checkpoint.h5", "r+") as file:  # as version 1: no seal to make anew
                file.attrs.modify("format_version", 1)
                if name in blocks:
                    file["observers"][name][1:] = value  # the first says which step was last
                else:
                    file["state"].attrs.modify(name, value)
            self.refused(f"{name} = {value}", *resume)

    def test_packs_without_a_seal_are_read(self):
        """Those of ports are made by h5py; one that says it has a seal must have it."""
        self.run_words("oracle", "emit", "s.yaml", "--out", "p.h5")
        with h5py.File(self.folder / "p.h5", "r") as ours, h5py.File(self.folder / "q.h5", "w") as port:
            port.attrs.update({"format": "uncross pack", "version": 1})
            for name in ours:
                ours.copy(name, port)
        self.assertEqual(self.run_words("oracle", "compare", "p.h5", "q.h5").returncode, 0)
        said = self.run_words("verify", "p.h5", "q.h5")
        self.assertEqual(said.returncode, 0)
        self.assertRegex(said.stdout, rb"p.h5: whole: .*\nq.h5: readable: .* carries no checksum")
        data = (self.folder / "p.h5").read_bytes()
        (self.folder / "bad.h5").write_bytes(data[:-32])
        self.refused("seal cut off", "oracle", "dump", "bad.h5")


if __name__ == "__main__":
    unittest.main()
