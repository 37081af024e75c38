"""Damages files, one bit or one cut at a time, and lets every reader of the program look at each.

Three things must never happen: the program dies or hangs; it ends well with another result than from the whole file; it
keeps what is damaged without a word. An isolated process that dies of a damage (src/files/apart.h) is no death of the
program, but is counted.
"""
import collections
import pathlib
import random
import re
import shutil
import subprocess
import sys

import h5py

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import UNCROSS  # noqa: E402

SCENE = """box: [4, 4, 4]
time_step: 0.01
steps: 20
seed: 1
solvent: {per_cell: 3, collision_interval: 0.02}
fibers:
  - {name: a, count: 2, vertices: 5, mass: 5, bond_length: 0.5, spring: 100, bending: 4}
crossing: {rule: sequential}
trajectory: {every: 5, velocities: true, solvent: true}
observe:
  conserved: {every: 5}
  statics: {every: 5}
"""
LIMIT = 60  # seconds for one command: it takes milliseconds
SUITE = {"checkpoint": ("resume", "start", "info", "verify", "export"),
         "trajectory": ("append", "start", "info", "verify", "export", "analyze"),
         "pack": ("dump", "compare", "verify"),
         "port": ("dump", "compare", "verify")}
UNCHECKED = ("port",)  # what a port writes carries no checksum: it may be read with other numbers, but nothing dies


class Bench:
    """A finished run and a pack, and what each reader makes of the whole files."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.counts = collections.Counter()
        (self.folder / "s.yaml").write_text(SCENE)
        start = SCENE.replace("steps: 20", "steps: 2").replace("seed: 1\n", "seed: 1\nstart: {snapshot: victim.h5}\n")
        start = "".join(line for line in start.splitlines(True) if not line.startswith("trajectory"))
        (self.folder / "start.yaml").write_text(start)
        self.run("run", "s.yaml", "--out", "whole", "--quiet")
        self.run("oracle", "emit", "s.yaml", "--out", "pack.h5")
        self.victims = {"checkpoint": self.folder / "whole/checkpoint.h5",
                        "trajectory": self.folder / "whole/trajectory.h5", "pack": self.folder / "pack.h5",
                        "port": self.folder / "port.h5"}
        with h5py.File(self.folder / "pack.h5") as ours, h5py.File(self.folder / "port.h5", "w", libver="v108") as port:
            port.attrs.update({"format": "uncross pack", "version": 1})
            for place in ours:
                for table in ours[place]:
                    port.create_dataset(f"{place}/{table}", data=ours[place][table])
                    port[place][table].attrs["components"] = ours[place][table].attrs["components"]
        self.data = {name: path.read_bytes() for name, path in self.victims.items()}
        self.right = {}
        for name, readers in SUITE.items():
            self.put(name, self.data[name])
            for reader in readers:
                code, output, said = getattr(self, reader)()
                if code != 0:
                    raise AssertionError(f"{reader} of the whole {name}: {said}")
                self.right[name, reader] = output

    def run(self, *words):
        """Exit code, standard output, standard error. A code below 0 is a death, None a hang."""
        try:
            done = subprocess.run([UNCROSS, *words], cwd=self.folder, capture_output=True, timeout=LIMIT,
                                  check=False)
        except subprocess.TimeoutExpired:
            return None, b"", b""
        return done.returncode, done.stdout, done.stderr

    def put(self, name, data):
        (self.folder / "victim.h5").write_bytes(data)
        shutil.rmtree(self.folder / "run", ignore_errors=True)
        shutil.copytree(self.folder / "whole", self.folder / "run")
        (self.folder / "run" / self.victims[name].name).write_bytes(data)

    # --- readers: (exit code, what came out, what was said)

    def state_after(self, code, said, folder):
        code2, output, _ = self.run("info", f"{folder}/checkpoint.h5") if code == 0 else (code, b"", b"")
        return code if code else code2, b"".join(re.findall(rb"state hash .*", output)), said

    def resume(self):
        code, _, said = self.run("run", "s.yaml", "--out", "run", "--resume", "--steps", "22", "--quiet")
        return self.state_after(code, said, "run")

    def append(self):
        """A resume that appends a frame: the file holds all frames, or was set aside with a word."""
        code, _, said = self.run("run", "s.yaml", "--out", "run", "--resume", "--steps", "25", "--quiet")
        if code == 0 and b".damaged." in said:
            return 1, b"", said
        code2, output, _ = self.run("export", "--solvent", "run/trajectory.h5") if code == 0 else (code, b"", b"")
        return code if code else code2, output, said

    def start(self):
        shutil.rmtree(self.folder / "started", ignore_errors=True)
        code, _, said = self.run("run", "start.yaml", "--out", "started", "--quiet")
        return self.state_after(code, said, "started")

    def analyze(self):
        shutil.rmtree(self.folder / "tables", ignore_errors=True)
        code, _, said = self.run("analyze", "victim.h5", "--out", "tables")
        tables = sorted((self.folder / "tables").glob("*.csv")) if code == 0 else []
        return code, b"".join(path.read_bytes() for path in tables), said

    def info(self):
        return self.run("info", "victim.h5")

    def verify(self):
        return self.run("verify", "victim.h5")

    def export(self):
        return self.run("export", "--solvent", "victim.h5")

    def dump(self):
        return self.run("oracle", "dump", "victim.h5")

    def compare(self):
        code, output, said = self.run("oracle", "compare", "victim.h5", "pack.h5")
        return code, output, said

    # --- damages

    def judge(self, name, what):
        """Lets all readers look at the victim; what went wrong, as lines."""
        wrong, accepted = [], []
        for reader in SUITE[name]:
            code, output, said = getattr(self, reader)()
            self.counts["readings"] += 1
            self.counts["isolated deaths"] += b"HDF5 dies" in output + said
            if code is None:
                wrong.append(f"{name}, {what}: {reader} hangs")
                self.counts["hangs"] += 1
            elif code < 0 or b"ended early" in output + said or b"Sanitizer" in said:
                wrong.append(f"{name}, {what}: {reader} dies ({code}): {(output + said)[-300:]}")
                self.counts["crashes"] += 1
            elif name in UNCHECKED:
                pass
            elif code == 0 and output != self.right[name, reader]:
                wrong.append(f"{name}, {what}: {reader} ends well with another result")
                self.counts["wrong results accepted"] += 1
            elif code == 0:
                accepted.append(reader)
            elif not (said.strip() or output.strip()):
                wrong.append(f"{name}, {what}: {reader} fails without a word")
        if accepted and name in ("checkpoint", "pack"):
            wrong.append(f"{name}, {what}: accepted by {accepted}, and every byte is under a seal")
            self.counts["wrong results accepted"] += 1
        self.counts["accepted, same result"] += bool(accepted)
        return wrong

    def flip(self, name, dice):
        """One bit, every second one among the first 8192 bytes, where the metadata are."""
        data = bytearray(self.data[name])
        at = dice.randrange(len(data) if dice.random() < 0.5 else min(len(data), 8192))
        bit = dice.randrange(8)
        data[at] ^= 1 << bit
        self.put(name, bytes(data))
        self.counts["flips"] += 1
        return self.judge(name, f"bit {bit} of byte {at}")

    def cut(self, name, dice):
        size = dice.randrange(len(self.data[name]))
        self.put(name, self.data[name][:size])
        self.counts["cuts"] += 1
        return self.judge(name, f"cut to {size} bytes")

    def attack(self, flips, cuts, seed):
        dice = random.Random(seed)
        wrong = []
        for act, times in ((self.flip, flips), (self.cut, cuts)):
            for k in range(times):
                wrong += act(list(SUITE)[k % len(SUITE)], dice)
        return wrong
