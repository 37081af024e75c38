"""Which random numbers a run draws that starts from a file: a stream of its own (src/system/stream.h).

The noise of two segments is compared by the correlation of their displacements. For equal noise it is 1, for independent
noise 0 +- 1/sqrt(number of displacements), apart from what a memory leaves that is short against a segment. The mean
square displacement of both segments together is then 2 times that of one, not 4 times. The bounds are 5 standard
errors: a false alarm in 1.7 million for each.
"""
import json
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import h5py
import numpy

UNCROSS = os.environ.get("UNCROSS", "build/uncross")
POINTS = 300
HEAD = "box: [8, 8, 8]\ncrossing: {forbidden: false}\ntrajectory: {every: 100, velocities: true, solvent: true}\n"
FIBERS = f"fibers: [{{name: p, count: {POINTS}, vertices: 1, mass: 5}}]\n"
BATHS = {  # the memory of a velocity is at most a tenth of a segment
    "overdamped": ("time_step: 0.01\nsteps: 100\nmedium: {kind: overdamped, rate: 1}\n", 0.0),
    "langevin": ("time_step: 0.1\nsteps: 400\nmedium: {kind: private, rate: 2}\n", 0.02),
    "pairs": ("time_step: 0.1\nsteps: 400\nmedium: {kind: pairs, density: 3, rate: 10}\n", 0.1),
    "andersen": ("time_step: 0.1\nsteps: 400\nsolvent: {per_cell: 3, collision_interval: 0.1, rule: at-a}\n", 0.1),
    "phantoms": ("time_step: 0.1\nsteps: 400\nsolvent: {per_cell: 3, collision_interval: 0.1, hydrodynamics: false, bath: phantoms}\n", 0.1),
}
MASK = (1 << 64) - 1
PRIMES = (11400714785074694791, 14029467366897019727, 1609587929392839161, 9650029242287828579, 2870177450012600261)


def rotate(x, bits):
    return (x << bits | x >> 64 - bits) & MASK


def xxh64_of_words(words):
    """XXH64, seed 0, of four 64-bit words: one stripe of 32 bytes (the specification of xxHash)."""
    one, two, three, four, _ = PRIMES

    def mix(lane, word):
        return rotate((lane + word * two) & MASK, 31) * one & MASK

    lanes = [mix(start & MASK, word) for start, word in zip((one + two, two, 0, -one), words)]
    total = sum(rotate(lane, bits) for lane, bits in zip(lanes, (1, 7, 12, 18))) & MASK
    for lane in lanes:
        total = ((total ^ mix(0, lane)) * one + four) & MASK
    total = (total + 32) & MASK
    total = (total ^ total >> 33) * two & MASK
    total = (total ^ total >> 29) * three & MASK
    return total ^ total >> 32


class Streams(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def run_scene(self, out, text, *options, code=0):
        """run.json of a run in the folder `out`; what it said if it should end otherwise."""
        scene = self.dir / f"{out}.yaml"
        scene.write_text(text)
        done = subprocess.run([UNCROSS, "run", scene, "--out", self.dir / out, *options], capture_output=True, text=True,
                              check=False, timeout=120)
        self.assertEqual(done.returncode, code, done.stderr)
        return json.loads((self.dir / out / "run.json").read_text()) if code == 0 else done.stderr

    def moved(self, out):
        """Displacements of the points over the whole run."""
        with h5py.File(self.dir / out / "trajectory.h5") as file:
            value = file["particles/trajectory/position/value"]
            return (value[-1, :POINTS] - value[0, :POINTS]).ravel()

    def assert_independent(self, a, b, more=0.0):
        """more: what a memory of velocities may leave."""
        correlation = (a @ b) / numpy.sqrt((a @ a) * (b @ b))
        self.assertLess(abs(correlation), 5.0 / numpy.sqrt(a.size) + more)

    def test_a_second_segment_has_noise_of_its_own(self):
        """After the first one's last step, and after its step 0, where the state is the same too. Noise that is addressed by
        the cell and not by the particle shows up only there."""
        for name, (text, memory) in BATHS.items():
            with self.subTest(bath=name):
                scene = HEAD + text + FIBERS
                self.run_scene(f"{name}-begun", scene, "--steps", "0")
                self.run_scene(f"{name}-first", scene)
                first = self.moved(f"{name}-first")
                for start in ("first", "begun"):
                    out = f"{name}-after-{start}"
                    self.run_scene(out, scene + f"start: {{snapshot: {name}-{start}/checkpoint.h5}}\n")
                    second = self.moved(out)
                    self.assert_independent(first, second, memory)
                    ratio = ((first + second) @ (first + second)) / (0.5 * (first @ first + second @ second))
                    self.assertLess(abs(ratio - 2.0), 2.0 * (5.0 / numpy.sqrt(first.size) + memory))

    def test_a_frame_is_a_start_like_a_checkpoint(self):
        """Of one step of one run both are the same state, and so the same stream."""
        scene = HEAD + BATHS["overdamped"][0] + FIBERS
        self.run_scene("first", scene)
        a = self.run_scene("a", scene + "start: {snapshot: first/checkpoint.h5}\n")
        b = self.run_scene("b", scene + "start: {snapshot: first/trajectory.h5}\n")
        self.assertEqual(a["stream"], b["stream"])
        self.assertEqual(a["state_hash"], b["state_hash"])

    def test_what_a_stream_is_made_of(self):
        """The seed, the snapshot's stream and step, and the state that it gives: docs/conventions.md."""
        scene = HEAD + BATHS["overdamped"][0] + FIBERS + "seed: 18446744073709551615\n"
        first = self.run_scene("first", scene)
        self.assertEqual((first["seed"], first["stream"], first["stream_from"]), ("18446744073709551615",) * 2 + (None,))
        before = first
        for out, source, step in (("second", "first", 100), ("third", "second", 100), ("again", "first", 100)):
            made = self.run_scene(out, scene + f"start: {{snapshot: {source}/checkpoint.h5}}\n", "--seed", "5")
            source = before if out != "again" else first
            self.assertEqual(made["stream_from"], {"stream": source["stream"], "step": step, "state": self.start_hash(out)})
            words = (5, int(source["stream"]), step, int(self.start_hash(out), 16))
            self.assertEqual(int(made["stream"]), xxh64_of_words(words))
            self.assertEqual(made["seed"], "5")
            before = made

    def test_a_file_that_says_no_stream(self):
        """An earlier program's file holds its seed, which was its stream; another program's holds neither."""
        scene = HEAD + BATHS["overdamped"][0] + FIBERS
        self.run_scene("first", scene + "seed: 9\n")
        path, streams = self.dir / "first/trajectory.h5", set()
        for out, change, stream in (("ours", "attribute", "9"), ("theirs", "group", None), ("moved", "position", None)):
            with h5py.File(path, "a") as file:
                if change == "attribute":
                    del file["parameters/uncross"].attrs["stream"]
                elif change == "group":
                    del file["parameters"]
                else:
                    file["particles/trajectory/position/value"][-1, 0, 0] += 0.5
            made = self.run_scene(out, scene + "start: {snapshot: first/trajectory.h5}\n")
            self.assertEqual((made["stream_from"]["stream"], made["stream_from"]["step"]), (stream, 100))
            streams.add(made["stream"])
        self.assertEqual(len(streams), 3)

    def test_a_resume_keeps_its_stream(self):
        scene = HEAD + BATHS["overdamped"][0] + FIBERS
        self.run_scene("first", scene)
        scene += "start: {snapshot: first/checkpoint.h5}\n"
        whole, half = self.run_scene("whole", scene), self.run_scene("parts", scene, "--steps", "40")
        parts = self.run_scene("parts", scene, "--resume")
        for key in ("seed", "stream", "stream_from", "start", "end", "state_hash"):
            self.assertEqual(parts[key], whole[key], key)
        self.assertEqual(half["stream"], whole["stream"])
        self.assertNotEqual(whole["stream"], whole["seed"])

    def test_the_noise_of_the_snapshot_is_asked_for(self):
        """start.stream: seed, of the run that made the snapshot: its noise once more is what somebody asked for, and warned of."""
        scene = HEAD + BATHS["overdamped"][0] + FIBERS
        words = "start.stream: this seed is the stream of the run that made the snapshot"
        self.run_scene("first", scene)
        self.run_scene("still", scene, "--steps", "0")
        for file in ("checkpoint", "trajectory"):
            for seed, of, warned in ((1, "first", True), (2, "first", False), (1, "still", False)):
                out = f"{of}-{file}-{seed}"
                start = f"start: {{snapshot: {of}/{file}.h5, stream: seed}}\n"
                told = self.run_scene(out, scene + start, "--seed", str(seed), "--steps", "4")["warnings"]
                again = self.run_scene(out, scene + start, "--resume", "--steps", "8")
                check = subprocess.run([UNCROSS, "check", self.dir / f"{out}.yaml", "--set", f"seed={seed}"], check=True,
                                       capture_output=True, text=True, timeout=60).stdout
                self.assertEqual((again["stream"], again["stream_from"]), (str(seed), None))
                for text in (" ".join(told), " ".join(again["warnings"]), check):
                    self.assertEqual(words in text, warned, out)

    def test_ports_and_check_are_told_the_stream(self):
        """Who calls random numbers by a key gets the one that is used; docs/port/contract.md calls it the seed."""
        scene = HEAD + BATHS["andersen"][0] + FIBERS
        self.run_scene("first", scene, "--steps", "10")
        stream = self.run_scene("second", scene + "start: {snapshot: first/checkpoint.h5}\n", "--steps", "10")["stream"]
        for action in ("emit", "start"):
            path = self.dir / f"{action}.h5"
            subprocess.run([UNCROSS, "oracle", action, self.shorter("second", 4), "--out", path], check=True,
                           timeout=60)
            text = subprocess.run([UNCROSS, "oracle", "dump", path], check=True, capture_output=True, text=True, timeout=60).stdout
            found = {tuple(set(re.findall(rf"in\.numbers\.seed_{half} (\d+)$", text, re.M))) for half in ("low", "high")}
            self.assertEqual(found, {(str(int(stream) & 0xffffffff),), (str(int(stream) >> 32),)}, action)
        said = subprocess.run([UNCROSS, "check", self.dir / "second.yaml"], check=True, capture_output=True, text=True,
                              timeout=60).stdout
        self.assertIn(f"stream {stream}, of seed 1 and of the snapshot's stream 1 at step 10", said)

    def shorter(self, out, steps):
        """The scene of a run with so many steps."""
        scene = self.dir / "shorter.yaml"
        scene.write_text(re.sub(r"^steps: .*$", f"steps: {steps}", (self.dir / f"{out}.yaml").read_text(), flags=re.M))
        return scene

    def start_hash(self, out):
        """State hash at step 0, as the oracle's trace tells it."""
        done = subprocess.run([UNCROSS, "oracle", "trace", self.shorter(out, 0)], check=True, capture_output=True, text=True,
                              timeout=60)
        return done.stdout.splitlines()[1].split(",")[2]


if __name__ == "__main__":
    unittest.main()
