"""Frames of a trajectory or checkpoint as `uncross frames` hands them over: the form is in docs/files.md. HDF5 stays in that
program, which checks every number on the way and says what is wrong with a file."""
import array
import collections
import contextlib
import os
import subprocess

SOLVENT = "solvent"
Kind = collections.namedtuple("Kind", "bond_length spring bending")  # of fibers, in the scene of the file
Frame = collections.namedtuple("Frame", "step time edge periodic leans tilt speed position velocity")


class Ended(Exception):
    """The other program has ended, with this exit code: above 0 if it has said why."""


class Damaged(Exception):
    """This frame is; the message names it."""


class File:
    """names: of species; kinds: None if the file holds no scene. For each particle, a row that is no solvent of a checkpoint:
    species (or below 0), next (row that a bond goes on to, or -1), mass."""

    def __init__(self, path):
        program = os.environ.get("UNCROSS", "uncross")
        self.child = subprocess.Popen([program, "frames", "--", path], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.frames, self.rows, self.particles, self.moving, names, kinds = map(int, self._line().split())
        self.names = [self._line() for _ in range(names)]
        self.kinds = None if kinds < 0 else [Kind(*map(float, self._line().split())) for _ in range(kinds)]
        self.species, self.next, self.mass = (self._numbers(kind, self.particles) for kind in "iid")

    def _line(self):
        line = self.child.stdout.readline()
        if not line.endswith(b"\n"):
            raise Ended(self.child.wait())
        return line[:-1].decode()

    def _numbers(self, kind, count):
        numbers = array.array(kind)
        data = self.child.stdout.read(count * numbers.itemsize)
        if len(data) < count * numbers.itemsize:
            raise Ended(self.child.wait())
        numbers.frombytes(data)
        return numbers

    def read(self, number):
        if self.child.poll() is not None:
            raise Ended(self.child.returncode)
        try:
            self.child.stdin.write(b"%d\n" % number)
            self.child.stdin.flush()
        except BrokenPipeError:
            raise Ended(self.child.wait()) from None
        verdict, _, rest = self._line().partition(" ")
        if verdict != "fine":
            raise Damaged(rest)
        step, time, *box, leans, tilt, speed = rest.split()
        return Frame(int(step), float(time), [float(word) for word in box[0::2]], [word == "1" for word in box[1::2]], leans == "1",
                     float(tilt), float(speed), self._numbers("d", 3 * self.rows),
                     self._numbers("d", 3 * self.rows) if self.moving else None)

    def close(self):
        with contextlib.suppress(BrokenPipeError):  # of a number that it did not read
            self.child.stdin.close()
        self.child.stdout.close()
        try:
            self.child.wait(10)  # no number follows: it ends by itself
        except subprocess.TimeoutExpired:
            self.child.terminate()  # it has nothing to lose
            self.child.wait()

    def is_solvent(self, row):
        return row >= self.particles or (0 <= self.species[row] < len(self.names) and self.names[self.species[row]] == SOLVENT)
