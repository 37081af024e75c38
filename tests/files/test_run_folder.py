"""A run's folder has one writer, loses nothing, and says what became of the run."""
import fcntl
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py
import numpy

sys.dont_write_bytecode = True  # nothing is left in the source tree
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from support import BUILD, UNCROSS, FolderTest, uncross  # noqa: E402

FAULTS = BUILD / "uncross-faults"  # tests/faults/inject.h
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


def without_checksums(file):
    """An H5MD file of version 1."""
    del file["parameters/uncross/checksum"]
    file["parameters/uncross"].attrs.modify("format_version", numpy.int32(1))


class RunFolder(FolderTest):
    def setUp(self):
        super().setUp()
        self.run_folder = self.dir / "r"

    def scene(self, text, name="scene.yaml"):
        (self.dir / name).write_text(text)
        return self.dir / name

    def uncross(self, *words, code=0, said=""):
        """What the program says, after its exit code and a part of its words were looked at."""
        done = uncross(*words, timeout=120)
        self.assertEqual(done.returncode, code, done.stderr)
        self.assertIn(said, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def run_scene(self, text, *words, folder=None, **expected):
        return self.uncross("run", self.scene(text), "--out", folder or self.run_folder, *words, **expected)

    def start(self, text, wait_for, *words, program=UNCROSS, before=None, **settings):
        """A run in a process of its own, once this file is there."""
        words_said = tempfile.TemporaryFile("w+")
        self.addCleanup(words_said.close)
        process = subprocess.Popen([program, "run", self.scene(text, "own.yaml"), "--out", self.run_folder,
                                    *map(str, words)], stdout=subprocess.DEVNULL, stderr=words_said, preexec_fn=before,
                                   env=dict(os.environ, **settings))
        process.said = lambda: (words_said.seek(0), words_said.read())[1]
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        self.wait_until((self.run_folder / wait_for).exists)
        self.assertIsNone(process.poll())
        return process

    @staticmethod
    def wait_until(condition):
        """How far a run comes in a fraction of a second depends on the machine; the test's own lines say whether it came."""
        deadline = time.monotonic() + 60
        while not condition() and time.monotonic() < deadline:
            time.sleep(0.01)

    def contents(self):
        return {path.name: path.read_bytes() for path in self.run_folder.iterdir()}

    def refused(self, text, said, *words, code=2):
        """Nothing in the folder changes."""
        before = self.contents()
        told = self.run_scene(text, *words, code=code, said=said)
        self.assertEqual(self.contents(), before, told)
        return told

    def checkpoint_step(self, folder=None):
        told = self.uncross("info", (folder or self.run_folder) / "checkpoint.h5")
        return int(re.search(r"^  step (\d+),", told, re.M)[1])

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

    def test_zero_has_no_sign(self):
        """A particle alone: its stress about its own velocity is 0, and not -0."""
        self.run_scene("box: [8, 8, 8]\ntime_step: 0.01\nsteps: 10\nsolvent: {per_cell: 0.002, collision_interval: 0.02}\n"
                       "observe: {stress: {every: 2}}\n")
        rows = [row.split(",") for row in (self.run_folder / "stress.csv").read_text().splitlines()[1:]]
        self.assertEqual({cell for row in rows for cell in row[2:]}, {"0"})

    def test_dumbbells_in_two_parts(self):
        """Sums over springs do not know where dumbbells stand in memory: a checkpoint sorts them. Nor is a table without a row
        yet in the way of a resume."""
        text = ("box: [6, 6, 6]\ntime_step: 0.02\nseed: 5\nsteps: 60\nsolvent: {per_cell: 3, collision_interval: 0.02}\n"
                "dumbbells: {spring: 10}\nobserve: {conserved: {every: 5}, pressure: {every: 5}, stress: {every: 40}, "
                "temperature: {every: 5}, dumbbells: {every: 5}}\n")
        self.run_scene(text, folder=self.dir / "whole")
        self.run_scene(text, "--steps", 30)
        self.run_scene(text, "--resume", "--steps", 60)
        tables = {path.name: path.read_bytes() for path in (self.dir / "whole").glob("*.csv")}
        self.assertEqual(len(tables), 5)
        self.assertEqual({path.name: path.read_bytes() for path in self.run_folder.glob("*.csv")}, tables)
        self.assertEqual(self.record()["end"], json.loads((self.dir / "whole/run.json").read_text())["end"])

    def test_numbers_and_units_of_tables(self):
        """The shortest decimals that read back, and a unit for each column."""
        self.run_scene(SCENE)
        units = self.record()["units"]
        self.assertEqual(units["time"], "t0")
        self.assertEqual(units["total"], "kT")
        for path in self.run_folder.glob("*.csv"):
            names, *rows = [line.split(",") for line in path.read_text().splitlines()]
            self.assertEqual([n for n in names if n != "step" and n.removesuffix("_error") not in units], [], path.name)
            for text in (cell for row in rows for cell in row if cell != "nan"):
                digits = re.sub(r"e.*|[-.]", "", text).strip("0")
                shortest = re.sub(r"e.*|[-.]", "", repr(float(text))).strip("0")
                self.assertEqual(len(digits), len(shortest), text)

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

    def test_a_folder_that_is_moved(self):
        """The lock is of the folder, not of its name: another run may take the name, and each keeps to its folder."""
        text, moved = SCENE + FRAMES + "checkpoint: {seconds: 0.05}\n", self.dir / "moved"
        first = self.start(text, "run.json", *FOR_EVER)
        self.run_folder.rename(moved)
        self.run_scene(text)
        before = self.contents()
        self.uncross("run", self.dir / "scene.yaml", "--out", moved, "--resume", *FOR_EVER, code=4, said="in use by")
        self.wait_until(lambda: self.checkpoint_step(moved) > 40)
        first.send_signal(signal.SIGTERM)
        self.assertEqual(first.wait(60), 5)
        self.assertIn(f"{self.run_folder}: this name no longer leads to the folder that was locked", first.said())
        self.assertEqual(self.contents(), before)
        other, self.run_folder = self.run_folder, moved
        self.assertEqual(self.checkpoint_step(), self.record()["steps"])
        self.assertEqual(self.record()["status"], "interrupted")
        self.assertGreater(self.checkpoint_step(), 40)
        self.run_scene(text, "--resume", "--steps", self.checkpoint_step() + 10)
        shutil.rmtree(other)

    def test_a_folder_that_is_removed(self):
        first = self.start(SCENE + "checkpoint: {seconds: 0.05}\n", "run.json", *FOR_EVER)
        while self.run_folder.exists():  # again, if the run has written into it meanwhile
            shutil.rmtree(self.run_folder, ignore_errors=True)
        self.assertEqual(first.wait(60), 4)
        self.assertFalse(self.run_folder.exists())

    def test_links_are_not_followed(self):
        victim = self.dir / "victim"
        victim.write_text("mine")
        self.run_folder.mkdir()
        parts = ["checkpoint.h5.part", "run.json.part", "statics-a.csv.part", "dynamics-a.csv.part"]
        for name in parts:
            (self.run_folder / name).symlink_to(victim)
        self.run_scene(SCENE + FRAMES)
        self.assertEqual(victim.read_text(), "mine")
        self.assertEqual([name for name in parts if os.path.lexists(self.run_folder / name)], [])
        for name, code in ("conserved.csv", 2), ("trajectory.h5", 4):
            path, away = self.run_folder / name, self.dir / name
            path.rename(away)
            path.symlink_to(away)
            before = away.read_bytes()
            self.run_scene(SCENE + FRAMES, "--resume", "--steps", 60, code=code, said=name)
            self.assertEqual(away.read_bytes(), before)
            path.unlink()
            away.rename(path)
        self.run_scene(SCENE + FRAMES, "--resume", "--steps", 60)

    def test_pipes_are_not_waited_for(self):
        self.run_scene(SCENE)
        (self.run_folder / "conserved.csv").unlink()
        os.mkfifo(self.run_folder / "conserved.csv")
        self.run_scene(SCENE, "--resume", "--steps", 60, code=2, said="conserved.csv")

    def table(self, name, folder=None):
        rows = [line.split(",") for line in ((folder or self.run_folder) / f"{name}.csv").read_text().splitlines()]
        return {key: [float(row[k]) for row in rows[1:]] for k, key in enumerate(rows[0])}

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
            file.attrs.modify("format_version", numpy.int32(1))
            for key in "dynamics.every", "dynamics.longest_lag", "statics.every":
                del file["observers"][key]
        self.run_scene(text, "--resume", "--steps", 60)

    def test_averages_keep_their_beginning(self):
        late = SCENE.replace("observe:", "observe:\n  from: 20")
        self.run_scene(late)
        self.assertEqual(self.table("statics-a")["samples"], [21])
        self.assertEqual(len(self.table("conserved")["step"]), 21)
        self.refused(SCENE, "observe.from: 0 in the scene, but 20 in the run", "--resume", "--steps", 50)
        self.refused(late, "observe.from: averages would begin at step 20, after the run's 10 steps", "--resume", "--steps",
                     10)
        self.run_scene(late, "--resume", "--steps", 50)
        resumed = {path.name: path.read_text() for path in self.run_folder.glob("*.csv")}
        whole = self.dir / "whole"
        self.run_scene(late, "--steps", 50, folder=whole)
        self.assertEqual(resumed, {path.name: path.read_text() for path in whole.glob("*.csv")})
        in_time = late.replace("from: 20", "from_time: 0.195")
        self.run_scene(in_time, "--steps", 50, folder=self.dir / "in-time")
        self.assertEqual(resumed["statics-a.csv"], (self.dir / "in-time/statics-a.csv").read_text())
        short = self.dir / "short"
        self.run_scene(late.replace("steps: 40", "steps: 10"), "--steps", 50, folder=short)  # the steps that count
        self.assertEqual(resumed["statics-a.csv"], (short / "statics-a.csv").read_text())

    def test_a_checkpoint_from_before_drifts_were_known(self):
        """What it knows goes on; what it cannot know is nan, to the end of the run."""
        self.run_scene(SCENE)
        with h5py.File(self.run_folder / "checkpoint.h5", "a") as file:
            file.attrs.modify("format_version", numpy.int32(1))
            for key in "dynamics-later", "from":
                del file["observers"][key]
        self.run_scene(SCENE, "--resume", "--steps", 60)
        whole = self.dir / "whole"
        self.run_scene(SCENE, "--steps", 60, folder=whole)
        before, now = self.table("dynamics-a", whole), self.table("dynamics-a")
        unknown = [name for name in now if name.startswith("drift") or "about" in name or "cumulative" in name]
        self.assertEqual(len(unknown), 14)
        for name, values in now.items():
            if name in unknown:
                self.assertTrue(numpy.isnan(values).all(), name)
            else:
                numpy.testing.assert_array_equal(values, before[name], name)

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
                               (rows[:20], "is missing, has other columns, or holds nothing of this run"), ("\0" * len(rows), "is missing, has other columns, or holds nothing of this run"),
                               (rows.replace("bend", "bent", 1), "is missing, has other columns, or holds nothing of this run"),
                               (rows.replace("\n30,", "\n\0\0,"), "ends at step 28")):
            table.write_text(damaged)
            self.refused(SCENE, f"conserved.csv: {where}, but went to step 40", "--resume", "--steps", 50)
        table.unlink()
        self.refused(SCENE, "conserved.csv: is missing, has other columns, or holds nothing of this run, but went to step 40", "--resume", "--steps", 50)
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
            file.attrs.modify("format_version", numpy.int32(1))
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

    def test_killed_in_its_first_moment(self):
        """The first checkpoint is there before anything else, and before anything is sampled."""
        self.run_scene(SCENE + FRAMES, folder=self.dir / "straight")
        right = {path.name: path.read_bytes() for path in (self.dir / "straight").glob("*.csv")}
        for name in "checkpoint.h5", "trajectory.h5", "conserved.csv", "run.json":
            first = self.start(SCENE + FRAMES, name, *FOR_EVER)
            first.kill()
            first.wait()
            self.assertEqual(self.checkpoint_step(), 0)
            self.refused(SCENE + FRAMES, "holds a run already (checkpoint.h5); continue it with --resume")
            self.run_scene(SCENE + FRAMES, "--resume")
            for table, rows in right.items():
                self.assertEqual((self.run_folder / table).read_bytes(), rows, (name, table))
            with h5py.File(self.run_folder / "trajectory.h5") as file:
                self.assertEqual(list(file["particles/trajectory/position/step"])[-1], 40)
            shutil.rmtree(self.run_folder)

    def test_a_checkpoint_that_is_lost(self):
        """Nobody is told to remove what may be of worth."""
        self.run_scene(SCENE)
        (self.run_folder / "checkpoint.h5").unlink()
        for words in (), ("--resume",):
            told = self.refused(SCENE, "holds run.json but no checkpoint.h5", *words)
            self.assertNotIn("remove", told)

    def test_killed_in_its_first_minutes(self):
        """A checkpoint after 10 s, though the next one is due after an hour; a clock that is 50 times as fast."""
        for every, found in ("", True), ("checkpoint: {seconds: 3600}\n", True), ("checkpoint: {seconds: 0}\n", False):
            run = self.start(SCENE + every, "run.json", *FOR_EVER, program=FAULTS, UNCROSS_HASTE="50")
            time.sleep(0.5)
            self.wait_until(lambda: not found or self.checkpoint_step() > 0)
            run.kill()
            run.wait()
            self.assertEqual(self.checkpoint_step() > 0, found, every)
            self.run_scene(SCENE + every, "--resume", "--steps", self.checkpoint_step() + 10)
            shutil.rmtree(self.run_folder)

    # --- signals

    def test_signals_end_a_run_with_a_checkpoint(self):
        for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1, signal.SIGXCPU:
            # nohup, under which all of this may run, ignores SIGHUP
            run = self.start(SCENE, "run.json", *FOR_EVER, *(["--resume"] if self.run_folder.exists() else []),
                             before=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL))
            self.wait_until(lambda: self.record()["status"] == "running")
            run.send_signal(number)
            self.assertEqual(run.wait(60), 5, number)
            self.assertEqual(self.record()["status"], "interrupted")
            self.assertEqual(self.checkpoint_step(), self.record()["steps"])

    def test_nohup(self):
        run = self.start(SCENE, "run.json", *FOR_EVER, before=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        run.send_signal(signal.SIGHUP)
        time.sleep(0.3)
        self.assertIsNone(run.poll())
        run.send_signal(signal.SIGTERM)
        self.assertEqual(run.wait(60), 5)

    def test_a_second_signal(self):
        """A disk that does not answer: the first checkpoint waits for it. `timeout` sends SIGTERM twice at once."""
        for number in signal.SIGINT, signal.SIGTERM:
            run = self.start(SCENE, ".", *FOR_EVER, program=FAULTS, UNCROSS_SLOW="60")
            time.sleep(0.2)
            for other in signal.SIGUSR1, number, number, signal.SIGHUP:
                run.send_signal(other)
                time.sleep(0.01)
            time.sleep(1.2)
            run.send_signal(signal.SIGXCPU)  # which the system sends every second
            time.sleep(0.1)
            self.assertIsNone(run.poll())
            run.send_signal(number)
            self.assertEqual(run.wait(10), -number)
            shutil.rmtree(self.run_folder)

    # --- a run that cannot be opened

    def test_what_fails_late_is_found_first(self):
        """And leaves nothing, neither files nor folders."""
        text = SCENE + "  temperature: {every: 1}\n  collisions: {every: 1}\n" + FRAMES
        for most in range(4, 9):
            done = subprocess.run(["bash", "-c", f'ulimit -n {most}; exec "$@"', "limited", UNCROSS, "run",
                                   self.scene(text), "--out", self.run_folder / "a/b", "--quiet"], capture_output=True,
                                  text=True, check=False)
            self.assertIn(done.returncode, (2, 4), done.stderr)
            self.assertRegex(done.stderr, "Too many open files|unable to open|no memory")
            self.assertFalse(self.run_folder.exists())
        done = subprocess.run(["bash", "-c", 'ulimit -n 12; exec "$@"', "limited", UNCROSS, "run", self.scene(text),
                               "--out", self.run_folder / "a/b", "--quiet"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        shutil.rmtree(self.run_folder)

    def test_a_long_path(self):
        text = SCENE + FRAMES
        for length in 4000, 4001, 4078, 4090, 4200:
            path = str(self.run_folder)
            while len(path) < length:
                path += "/" + "d" * min(200, length - len(path) - 1) if length - len(path) > 1 else "d"
            self.assertEqual(len(path), length)
            if length == 4000:
                self.run_scene(text, folder=path)
                self.run_scene(text, "--resume", "--steps", 50, folder=path)
                shutil.rmtree(self.run_folder)
            else:
                self.run_scene(text, folder=path, code=2, said=f"a path of {length} bytes; a run's folder may have one "
                               "of at most 4000")
            self.assertFalse(self.run_folder.exists())

    def test_a_table_that_cannot_be_made(self):
        """Files of others stay."""
        self.run_folder.mkdir()
        (self.run_folder / "run.json.part").mkdir()
        (self.run_folder / "mine").write_text("mine")
        self.run_scene(SCENE + FRAMES, code=4, said="run.json: cannot write it")
        self.assertEqual(sorted(path.name for path in self.run_folder.iterdir()), ["mine", "run.json.part"])

    def test_a_fault_is_recorded(self):
        """With the numbers of the last checkpoint, or of the start."""
        text = SCENE.replace("bending: 4}", "bending: 4, force: [3000, 0, 0]}").replace("steps: 40", "steps: 1000")
        told = self.run_scene(text, "--quiet", code=3)
        record = self.record()
        self.assertEqual((record["status"], record["steps"], record["steps_wanted"]), ("stopped", 0, 1000))
        self.assertEqual(told, f"uncross: {record['reason']}\n")
        self.assertEqual(record["end"], record["start"])
        self.assertEqual(sorted(self.contents()), ["checkpoint.h5", "conserved.csv", "run.json"])
        self.assertEqual(self.run_scene(text, "--resume", "--quiet", code=3), told)

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
        done = subprocess.run(["bash", "-c", 'ulimit -f 128; exec "$@"', "limited", UNCROSS, "run",
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
            without_checksums(file)
        self.uncross("analyze", self.run_folder / "trajectory.h5", "--out", self.dir / "new/tables", code=2,
                     said="the position of particle 1 is not a finite number")
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
