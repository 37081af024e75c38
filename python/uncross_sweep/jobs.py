"""Runs of a sweep as processes, several at a time, with progress and the time that is left."""
import contextlib
import ctypes
import fcntl
import os
import signal
import subprocess
import sys
import tempfile
import time

from . import escape, record
from .files import duration, take_lock
from .grid import Refused, is_begun, observed
from .opening import writing

INTERRUPTED = 5  # exit code of `uncross run` after a signal
PATIENCE = 30.0  # s; for runs that a killed sweep left, which write their checkpoints
PR_SET_PDEATHSIG = 1  # prctl


class Busy(Exception):
    """Another process works in the folder: exit code 4."""


@contextlib.contextmanager
def locked(folder):
    """Keeps other sweeps out of the folder. Runs inherit the open file: should this process be killed, the folder is
    theirs until they have ended."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / ".lock", "a", encoding="ascii", opener=writing) as lock:
        give_up = time.monotonic() + PATIENCE
        while True:
            try:
                take_lock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB, "sweeps in this folder")
                break
            except BlockingIOError:
                if time.monotonic() > give_up:
                    raise Busy(f"{folder}: another sweep, or runs that it left, is at work here") from None
                time.sleep(0.2)
        yield lock.fileno()


def record_of(run):
    """run.json, or nothing; one that cannot be read is refused."""
    try:
        return record.read(run.folder / "run.json")
    except FileNotFoundError:
        return {}
    except record.Foreign as error:
        raise Refused(str(error)) from error
    except OSError as error:
        raise Refused(f"{run.folder}/run.json: cannot be read: {error.strerror or error}") from error


def is_finished(run):
    """Whether the folder holds the whole run. A run of another scene or seed is refused."""
    told = record_of(run)
    if not told:
        return False
    # a fingerprint of today may differ from that of a run that was begun with older defaults: `uncross run` decides
    if str(told.get("seed")) != str(run.seed):  # a string where JSON numbers have too few bits
        raise Refused(f"{run.folder}: holds a run of seed {told.get('seed')}, not {run.seed}")
    done = told.get("status") == "finished" and told.get("steps", 0) >= run.point.steps
    if done and told.get("scene_fingerprint") != run.point.fingerprint:
        raise Refused(f"{run.folder}: holds a finished run of another scene (fingerprint {told.get('scene_fingerprint')}, not "
                      f"{run.point.fingerprint}); name another folder, or leave this one's scene as it was")
    scene = told.get("scene")
    if done and isinstance(scene, str) and observed(scene) != run.point.observe:
        raise Refused(f"{run.folder}: holds a finished run that observed otherwise; averages are over runs that observe the same. Name "
                      "another folder, or leave the section observe as it was")
    return done


def die_with_parent():
    """A run that has lost its sweep writes its checkpoint and ends."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


class Pool:
    """Runs `runs`, at most `jobs` at a time. A signal ends the runs at hand, with checkpoints, and starts no more."""

    def __init__(self, runs, jobs, lock, progress):
        self.waiting, self.jobs, self.lock, self.progress = list(runs), jobs, lock, progress
        self.active, self.stopped, self.stopped_by = {}, False, None

    def stop(self, number=None, _frame=None):
        self.stopped, self.stopped_by = True, self.stopped_by or number
        for child, _ in self.active.values():
            with contextlib.suppress(ProcessLookupError):
                child.terminate()

    def start(self, run):
        run.folder.parent.mkdir(parents=True, exist_ok=True)
        words = run.command() + (["--resume"] if is_begun(run) else [])
        told = tempfile.TemporaryFile()
        child = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=told,
                                 pass_fds=[self.lock], preexec_fn=die_with_parent)  # pylint: disable=subprocess-popen-preexec-fn
        self.active[run.name] = child, (run, told)
        if self.stopped:  # the signal came in between
            child.terminate()

    def collect(self):
        for name, (child, (run, told)) in list(self.active.items()):
            if child.poll() is None:
                continue
            told.seek(0)
            lines = told.read().decode(errors="replace").strip().splitlines()
            told.close()
            del self.active[name]
            run.code, run.message = child.returncode, (lines[-1].removeprefix("uncross: ") if lines else "")
            self.progress.ended(run)

    def work(self):
        before = {number: signal.signal(number, self.stop) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
        try:
            while self.active or (self.waiting and not self.stopped):
                while self.waiting and len(self.active) < self.jobs and not self.stopped:
                    run = self.waiting.pop(0)
                    self.start(run)
                    self.progress.started(run)
                time.sleep(0.02)
                self.collect()
                self.progress.tell()
        finally:
            self.stop()
            for number, handler in before.items():
                signal.signal(number, handler)
        self.progress.end()


class Progress:
    """Says on standard error how many runs are done, and how long the rest may take: the estimates of `uncross check`,
    scaled by what the runs that have ended took."""

    def __init__(self, total, runs, jobs, quiet):
        self.total, self.finished, self.failed = total, total - len(runs), 0
        self.left = {run.name: run.point.seconds for run in runs}
        self.jobs, self.quiet, self.terminal = jobs, quiet, sys.stderr.isatty()
        self.begun, self.estimated, self.spent = {}, 0.0, 0.0
        self.told = 0.0

    def started(self, run):
        self.begun[run.name] = time.monotonic()

    def ended(self, run):
        spent = time.monotonic() - self.begun.pop(run.name)
        estimate = self.left.pop(run.name)
        if run.code == 0:
            self.finished += 1
            self.estimated, self.spent = self.estimated + estimate, self.spent + spent
        elif run.code not in (INTERRUPTED, -signal.SIGTERM):
            self.failed += 1
            self.say(f"{run.name}: exit code {run.code}: {run.message}", True)
        if not self.terminal:
            self.say(self.words(), False)

    def seconds_left(self):
        scale = self.spent / self.estimated if self.estimated > 0.0 else 1.0
        now = time.monotonic()
        parts = [max(scale * estimate - (now - self.begun.get(name, now)), 0.0) for name, estimate in self.left.items()]
        return max(sum(parts) / self.jobs, max(parts, default=0.0))

    def words(self):
        failed = f", {self.failed} failed" if self.failed else ""
        return f"{self.finished} of {self.total} runs finished{failed}, about {duration(self.seconds_left())} left"

    def tell(self):
        if self.terminal and not self.quiet and time.monotonic() - self.told > 0.5:
            self.told = time.monotonic()
            sys.stderr.write(f"\r\033[K{self.words()}")
            sys.stderr.flush()

    def say(self, text, always):
        if always or not self.quiet:
            self.end()
            print(f"uncross sweep: {escape.shown(text)}", file=sys.stderr, flush=True)

    def end(self):
        if self.terminal and not self.quiet:
            sys.stderr.write("\r\033[K")


def processors():
    return len(os.sched_getaffinity(0))


def stream_of(run):
    """Which random numbers a run draws, and the state of the snapshot that it begins with; "" where there is none."""
    told = record_of(run)
    return told.get("stream", ""), told.get("stream_from", {}).get("state", "")


def status_of(run):
    """(status, steps, state hash) that run.json tells."""
    try:
        told = record_of(run)
    except Refused:
        told = {}
    return told.get("status", "none"), told.get("steps", 0), told.get("state_hash", "")
