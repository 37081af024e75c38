"""A run's folder has one writer, loses nothing, and says what became of the run."""
import fcntl
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import h5py
import numpy

UNCROSS = os.environ.get("UNCROSS", "build/uncross")
SCENE = """box: [4, 4, 4]
time_step: 0.01
steps: 40
solvent: {per_cell: 3, collision_interval: 0.02}
fibers:
  - {name: a, count: 2, vertices: 4, mass: 5, bond_length: 0.5, spring: 100, bending: 4}
observe:
  conserved: {every: 2}
  statics: {every: 1}
  dynamics: {every: 1, longest_lag: 20}
"""
FRAMES = "trajectory: {every: 10}\n"
FOR_EVER = ("--steps", 10**9)


class RunFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)
        self.run_folder = self.dir / "r"

    def scene(self, text, name="scene.yaml"):
        (self.dir / name).write_text(text)
        return self.dir / name

    def uncross(self, *words, code=0, said=""):
        """What the program says, after its exit code and a part of its words were looked at."""
        done = subprocess.run([UNCROSS, *map(str, words)], capture_output=True, text=True, check=False, timeout=120)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(said, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def run_scene(self, text, *words, folder=None, **expected):
        return self.uncross("run", self.scene(text), "--out", folder or self.run_folder, *words, **expected)

    def start(self, text, wait_for, *words):
        """A run in a process of its own, once this file is there."""
        process = subprocess.Popen([UNCROSS, "run", self.scene(text, "own.yaml"), "--out", self.run_folder,
                                    *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        deadline = time.monotonic() + 60
        while not (self.run_folder / wait_for).exists() and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertIsNone(process.poll())
        return process

    def contents(self):
        return {path.name: path.read_bytes() for path in self.run_folder.iterdir()}

    def refused(self, text, said, *words, code=2):
        """Nothing in the folder changes."""
        before = self.contents()
        told = self.run_scene(text, *words, code=code, said=said)
        self.assertEqual(self.contents(), before, told)
        return told

    def record(self):
        return json.loads((self.run_folder / "run.json").read_text())

    # --- one writer

    def test_a_second_process_is_kept_out(self):
        """Else a resume cuts tables that the run goes on to write."""
        text = SCENE + FRAMES
        first = self.start(text + "checkpoint: {seconds: 0.1}\n", "checkpoint.h5", *FOR_EVER)
        for words in ("--resume", *FOR_EVER), FOR_EVER:
            self.run_scene(text, *words, code=4, said=f"{self.run_folder}: in use by another process")
        first.send_signal(signal.SIGTERM)
        self.assertEqual(first.wait(60), 5)
        steps = [int(row.split(",")[0]) for row in (self.run_folder / "conserved.csv").read_text().splitlines()[1:]]
        self.assertEqual(steps, list(range(0, self.record()["steps"] + 1, 2)))

    def test_two_new_runs_in_one_folder(self):
        """Without a trajectory nothing else told one of the other before the first checkpoint."""
        first = self.start(SCENE, "conserved.csv", *FOR_EVER)
        self.run_scene(SCENE, *FOR_EVER, code=4, said="in use by another process")
        self.run_scene(SCENE, "--resume", *FOR_EVER, code=4, said="in use by another process")
        first.send_signal(signal.SIGTERM)
        self.assertEqual(first.wait(60), 5)
        self.run_scene(SCENE, "--resume", "--steps", self.record()["steps"] + 10)

    def test_analyze_is_kept_out_too(self):
        self.run_scene(SCENE + FRAMES, folder=self.dir / "other")
        self.start("\n".join(SCENE.split("\n")[:6]) + "\n", ".", *FOR_EVER)
        time.sleep(0.5)
        self.uncross("analyze", self.dir / "other/trajectory.h5", "--out", self.run_folder, code=4, said="in use by")

    # --- what is resumed is what was

    def test_averages_keep_their_cadence(self):
        text = SCENE.replace(", longest_lag: 20", "")  # else another cadence needs memory of another size
        self.run_scene(text)
        for key, old, new, before, now in (("dynamics.every", "dynamics: {every: 1", "dynamics: {every: 2", 1, 2),
                                           ("dynamics.longest_lag", "dynamics: {", "dynamics: {longest_lag: 21, ", 0, 21),
                                           ("statics.every", "statics: {every: 1}", "statics: {every: 3}", 1, 3)):
            told = self.refused(text.replace(old, new), f"observe.{key}: {now} in the scene, but {before} in the run",
                                "--resume", "--steps", 50)
            self.assertIn("checkpoint.h5", told)
        self.run_scene(text.replace("conserved: {every: 2}", "conserved: {every: 5}"), "--resume", "--steps", 50)
        with h5py.File(self.run_folder / "checkpoint.h5", "a") as file:  # as it was before
            for key in "dynamics.every", "dynamics.longest_lag", "statics.every":
                del file["observers"][key]
        self.run_scene(text, "--resume", "--steps", 60)

    def test_an_observable_that_is_new(self):
        """Its averages would be of a part of the run only, and nothing would say so."""
        self.run_scene(SCENE)
        self.refused(SCENE + "  temperature: {every: 1}\n", "not sampled by this run so far", "--resume", "--steps", 50)
        fewer = SCENE.replace("  statics: {every: 1}\n", "")
        self.run_scene(fewer, "--resume", "--steps", 50)
        self.refused(SCENE, "'statics-reals'", "--resume", "--steps", 60)

    def test_tables_that_end_too_early(self):
        self.run_scene(SCENE)
        table = self.run_folder / "conserved.csv"
        rows = table.read_text()
        for damaged, where in ((rows[:-5], "ends at step 38"), (rows[:rows.rindex("\n20,") + 1], "ends at step 18"),
                               (rows[:20], "is missing or empty"), ("\0" * len(rows), "is missing or empty"),
                               (rows.replace("\n30,", "\n\0\0,"), "ends at step 28")):
            table.write_text(damaged)
            self.refused(SCENE, f"conserved.csv: {where}, but went to step 40", "--resume", "--steps", 50)
        table.unlink()
        self.refused(SCENE, "conserved.csv: is missing or empty, but went to step 40", "--resume", "--steps", 50)
        table.write_text(rows)
        self.run_scene(SCENE, "--resume", "--steps", 50)
        self.assertTrue(table.read_text().startswith(rows))

    def test_a_trajectory_that_ends_too_early(self):
        text, path = SCENE + FRAMES, self.run_folder / "trajectory.h5"
        self.run_scene(text, "--steps", 25)
        earlier = path.read_bytes()
        self.run_scene(text, "--resume")
        path.write_bytes(earlier)
        self.refused(text, "trajectory.h5: ends at step 20, but went to step 40", "--resume", "--steps", 55)
        shutil.copytree(self.run_folder, self.dir / "old")
        path.unlink()
        told = self.run_scene(text, "--resume", "--steps", 45)
        self.assertIn("trajectory.h5: is gone, it went to step 40; the frames of a new one begin after step 40", told)
        self.run_scene(text, "--resume", "--steps", 55)
        with h5py.File(path) as file:
            self.assertEqual(list(file["particles/trajectory/position/step"]), [50])
        with h5py.File(self.dir / "old/checkpoint.h5", "a") as file:  # as it was before
            del file["head"].attrs["frames_end"]
        self.run_scene(text, "--resume", "--steps", 55, folder=self.dir / "old")

    def test_a_trajectory_that_pauses(self):
        """Where it went to is not forgotten meanwhile, and what it lacks is said."""
        text, path = SCENE + FRAMES, self.run_folder / "trajectory.h5"
        self.run_scene(text, "--steps", 20)
        earlier = path.read_bytes()
        self.run_scene(text, "--resume")
        self.run_scene(SCENE, "--resume", "--steps", 65)
        whole = path.read_bytes()
        path.write_bytes(earlier)
        self.refused(text, "trajectory.h5: ends at step 20, but went to step 40", "--resume", "--steps", 80)
        path.write_bytes(whole)
        self.run_scene(text, "--resume", "--steps", 80, said="trajectory.h5: without frames from step 40 to 65")

    def test_tables_wait_for_the_trajectory(self):
        """They are not cut before it is known that the run can go on."""
        text, path = SCENE + FRAMES, self.run_folder / "trajectory.h5"
        self.run_scene(text, "--steps", 20)
        earlier = (self.run_folder / "checkpoint.h5").read_bytes()
        self.run_scene(text, "--resume")
        (self.run_folder / "checkpoint.h5").write_bytes(earlier)
        with path.open("rb") as reader:
            fcntl.flock(reader, fcntl.LOCK_SH)
            self.refused(text, "trajectory.h5: in use by another process", "--resume", code=4)
        self.run_scene(text, "--resume")

    # --- nothing is written over

    def test_tables_are_not_written_over(self):
        self.run_scene(SCENE + FRAMES)
        before = self.contents()
        self.uncross("analyze", self.run_folder / "trajectory.h5", "--out", self.run_folder, code=2,
                     said=f"{self.run_folder}/statics-a.csv: is there already")
        self.assertEqual(self.contents(), before)
        for name in "conserved.csv", "dynamics-a.csv", "statics-a.csv":
            other = self.dir / f"with-{name}"
            other.mkdir()
            (other / name).write_text("mine\n")
            self.run_scene(SCENE, folder=other, code=2, said=f"{other}: holds {name} but no checkpoint")
            self.assertEqual([path.name for path in other.iterdir()], [name])
            self.assertEqual((other / name).read_text(), "mine\n")

    # --- how a run ends

    def test_nobody_listens(self):
        for words in (), ("--resume", "--steps", "50"):
            ours, theirs = os.pipe()
            os.close(ours)
            done = subprocess.run([UNCROSS, "run", self.scene(SCENE + FRAMES), "--out", self.run_folder, *words],
                                  stdout=theirs, stderr=theirs, check=False)
            os.close(theirs)
            self.assertEqual(done.returncode, 0)
            (self.run_folder / "trajectory.h5").write_text("damaged, which is told")
        self.assertEqual(self.record()["steps"], 50)

    def test_closed_streams(self):
        """What is said must not go to the files that would get their numbers."""
        text, path = SCENE + FRAMES, self.run_folder / "trajectory.h5"
        self.run_scene(SCENE)
        subprocess.run(["sh", "-c", 'exec "$@" >&- 2>&-', "sh", UNCROSS, "run", self.scene(text), "--out", self.run_folder,
                        "--resume", "--steps", "60"], check=True)
        with h5py.File(path) as file:
            self.assertEqual(list(file["particles/trajectory/position/step"]), [50, 60])
        closed = subprocess.run(["sh", "-c", 'exec "$@" >&-', "sh", UNCROSS, "check", self.scene(text)], check=False,
                                stderr=subprocess.DEVNULL)
        self.assertEqual(closed.returncode, 4)

    def test_killed_before_the_first_checkpoint(self):
        first = self.start(SCENE, "conserved.csv", *FOR_EVER)
        first.kill()
        first.wait()
        for words in (), ("--resume",):
            told = self.refused(SCENE, "conserved.csv but no checkpoint: a run that ended before its first", *words)
            self.assertIn("remove the folder", told)
            self.assertNotIn("--resume", told)

    def test_a_fault_is_recorded(self):
        """With the numbers of the last checkpoint, or of the start."""
        text = SCENE.replace("bending: 4}", "bending: 4, force: [3000, 0, 0]}").replace("steps: 40", "steps: 1000")
        told = self.run_scene(text, "--quiet", code=3)
        record = self.record()
        self.assertEqual((record["status"], record["steps"], record["steps_wanted"]), ("stopped", 0, 1000))
        self.assertEqual(told, f"uncross: {record['reason']}\n")
        self.assertEqual(record["end"], record["start"])
        self.assertEqual(sorted(self.contents()), ["conserved.csv", "run.json"])
        self.refused(text, "run.json but no checkpoint", "--resume")

        other = self.run_folder = self.dir / "later"
        self.run_scene(text, "--steps", 3)
        before = self.record()
        told = self.run_scene(text, "--resume", "--quiet", code=3)
        record = self.record()
        self.assertEqual(told, f"uncross: {record['reason']}\n")
        self.assertRegex(record["reason"], r"^step \d+: \w+ \d+ ")
        self.assertEqual(record["status"], "stopped")
        for key in "steps", "state_hash", "end", "time":
            self.assertEqual(record[key], before[key])
        self.uncross("info", other / "checkpoint.h5", said=f"state hash {record['state_hash']}")

    def test_the_record_is_of_the_checkpoint(self):
        """If a summary cannot be written after the checkpoint, and while a resumed run goes on."""
        self.run_scene(SCENE, "--steps", 20)
        (self.run_folder / "statics-a.csv.part").mkdir()
        self.run_scene(SCENE, "--resume", code=4, said="statics-a.csv")
        record = self.record()
        self.assertEqual((record["status"], record["steps"]), ("stopped", 40))
        self.uncross("info", self.run_folder / "checkpoint.h5", said=f"state hash {record['state_hash']}")
        (self.run_folder / "statics-a.csv.part").rmdir()
        going = subprocess.Popen([UNCROSS, "run", self.scene(SCENE), "--out", self.run_folder, "--resume", *map(str, FOR_EVER)],
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        deadline = time.monotonic() + 60
        while self.record()["status"] == "stopped" and time.monotonic() < deadline:
            time.sleep(0.01)
        going.kill()
        going.wait()
        self.assertEqual((self.record()["status"], self.record()["steps"]), ("running", 40))

    def test_a_file_that_may_not_grow(self):
        """`ulimit -f` is told as a full disk is."""
        done = subprocess.run(["bash", "-c", 'ulimit -f 8; exec "$@"', "limited", UNCROSS, "run",
                               self.scene(SCENE.replace("steps: 40", "steps: 100000")), "--out", self.run_folder, "--quiet"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 4)
        self.assertIn("File too large", done.stderr)
        self.assertEqual(self.record()["status"], "stopped")

    def test_steps_that_were_made_already(self):
        self.run_scene(SCENE)
        before = self.contents()
        self.run_scene(SCENE, "--resume", "--steps", 3, said="at step 40 already, past the 3 asked for")
        self.assertEqual(self.contents(), before)
        self.run_scene(SCENE, "--resume", "--steps", 40, said="finished at step 40 of 40")

    def test_the_most_steps(self):
        self.run_scene(SCENE, "--steps", 2**64 - 1, code=2, said="--steps 18446744073709551615: not a whole number "
                       "from 0 to 9223372036854775807")
        first = self.start(SCENE, "conserved.csv", "--steps", 2**63 - 1)
        first.send_signal(signal.SIGINT)
        self.assertEqual(first.wait(60), 5)
        self.assertEqual(self.record()["steps_wanted"], 2**63 - 1)

    # --- exit codes

    def test_a_frame_that_cannot_be_used(self):
        self.run_scene(SCENE + FRAMES)
        with h5py.File(self.run_folder / "trajectory.h5", "a") as file:
            file["particles/trajectory/position/value"][3, 1, 2] = numpy.nan
        self.uncross("analyze", self.run_folder / "trajectory.h5", "--out", self.dir / "new/tables", code=2,
                     said="frame 3: a position of particle 1 is nan")
        self.assertFalse((self.dir / "new").exists())

    @unittest.skipUnless(os.access("/dev/full", os.W_OK), "no full device here")
    def test_words_that_do_not_arrive(self):
        self.run_scene(SCENE)
        for words in (["check", self.dir / "scene.yaml"], ["info", self.run_folder / "run.json"], ["--help"],
                      ["--version"], ["oracle", "trace", self.dir / "scene.yaml"]):
            with open("/dev/full", "w", encoding="ascii") as full:
                done = subprocess.run([UNCROSS, *map(str, words)], stdout=full, stderr=subprocess.PIPE, text=True,
                                      check=False)
            self.assertEqual(done.returncode, 4, words)
            self.assertRegex(done.stderr, "^uncross: standard output: cannot write.*\n$")


if __name__ == "__main__":
    unittest.main()
