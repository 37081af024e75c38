"""Instructions that a run of uncross executes, counted by valgrind's callgrind: what tools/counts and tools/skips share.

Counts are exact and the same on each run and on a loaded machine. What happens once (start, end, files) is left out: callgrind writes down what
it has counted whenever a step begins.
"""
import collections
import functools
import json
import pathlib
import re
import subprocess
import tempfile

TREE = pathlib.Path(__file__).resolve().parent.parent


class Unusable(Exception):
    """Why nothing can be counted on this machine."""


class Counts:
    """Instructions of a run: all of them, by function with what it calls, and by address within the program."""

    def __init__(self, total, inclusive, address):
        self.total, self.inclusive, self.address = total, inclusive, address


def mean(every):
    """Counts of a step, from those of several."""
    def of(name):
        total = collections.Counter()
        for counts in every:
            total.update(getattr(counts, name))
        return {key: value / len(every) for key, value in total.items()}

    return Counts(sum(counts.total for counts in every) / len(every), of("inclusive"), of("address"))


def parse(text, program):
    """Counts from a file of callgrind (--dump-instr=yes; the format is in valgrind's manual)."""
    names = {"fn": {}, "ob": {}}
    total, inclusive, address = 0, collections.Counter(), collections.Counter()
    function = here = None
    position, is_call = 0, False
    for line in text.splitlines():
        first = line[:1]
        if first in "0123456789+-*" and first:
            at, _, cost = line.split()
            position = position + int(at, 0) if first in "+-" else position if first == "*" else int(at, 0)
            inclusive[function] += int(cost)
            if not is_call:
                total += int(cost)
                if here == program:
                    address[position] += int(cost)
            is_call = False
        elif line.startswith("calls="):
            is_call = True
        else:
            spec = re.match(r"c?(fn|ob)=\((\d+)\)(?: (.*))?$", line)
            if spec:
                kind, number, name = spec.groups()
                if name:
                    names[kind][number] = name
                if line.startswith("fn"):
                    function = names["fn"][number]
                elif line.startswith("ob"):
                    here = names["ob"][number]
    return Counts(total, inclusive, address)


class Counter:
    """Counts runs of one build of uncross. A scene is a mapping, as in docs/scene.md, or the text of a scene file."""

    def __init__(self, program):
        self.program = str(pathlib.Path(program).resolve())
        try:
            self.version = subprocess.run([self.program, "--version"], capture_output=True, text=True, check=True).stdout
            subprocess.run(["valgrind", "--version"], capture_output=True, check=True)
        except (OSError, subprocess.CalledProcessError) as error:
            raise Unusable(f"this machine runs no valgrind, or not the program built for it: {error}") from error
        symbols = subprocess.run(["nm", "--defined-only", self.program], capture_output=True, text=True, check=True).stdout
        self.functions = set(re.findall(r" [Tt] (\w+)$", symbols, re.M))

    def __hash__(self):
        return id(self)

    def run(self, scene, steps):
        return self._run(scene if isinstance(scene, str) else json.dumps(scene), steps)

    @functools.lru_cache(maxsize=None)
    def _run(self, scene, steps):
        return self._parts(scene, steps)[0]

    def _parts(self, scene, steps, *options):
        """Counts of a run, or of its parts if `options` make callgrind write some on the way; the last part comes first."""
        with tempfile.TemporaryDirectory() as folder:
            path, out = pathlib.Path(folder, "scene.yaml"), pathlib.Path(folder, "counts")
            path.write_text(scene)
            done = subprocess.run(["valgrind", "--tool=callgrind", "--dump-instr=yes", f"--callgrind-out-file={out}", *options,
                                   self.program, "run", path, "--out", folder + "/run", "--steps", str(steps), "--quiet",
                                   "--set", "checkpoint.seconds=0"],  # else a slow machine writes one on the way
                                  capture_output=True, text=True, check=False)
            if done.returncode != 0:
                raise RuntimeError(f"{' '.join(map(str, done.args))}:\n{done.stderr}")
            parts = [out, *sorted(out.parent.glob("counts.*"), key=lambda path: int(path.suffix[1:]))]
            return [parse(part.read_text(), self.program) for part in parts]

    def per_step(self, scene, first=4, last=10):
        """Counts of the steps first + 1 .. last, per step: from the beginning of one to that of the next."""
        return self._per_step(scene if isinstance(scene, str) else json.dumps(scene), first, last)

    @functools.lru_cache(maxsize=None)
    def _per_step(self, scene, first, last):
        parts = self._parts(scene, last + 1, "--dump-before=step_advance")  # the end, the start, step 1, 2, ...
        if len(parts) != last + 2:
            raise RuntimeError(f"{len(parts) - 1} steps counted, not {last + 1}")
        return mean(parts[first + 2:])

    def inclusive(self, counts, name):
        """Of one function. That it is gone must not look as if it were not called."""
        if name not in self.functions:
            raise KeyError(f"the program has no function {name}: name the one that does this now")
        return counts.inclusive.get(name, 0)

    @functools.cached_property
    def square_roots(self):
        """Addresses of the program's instructions that take square roots; and of all instructions."""
        listing = subprocess.run(["objdump", "-d", "--no-show-raw-insn", self.program], capture_output=True, text=True,
                                 check=True).stdout
        found = re.findall(r"^ +([0-9a-f]+):\t(\S+)", listing, re.M)
        return {int(at, 16) for at, name in found if re.match(r"v?f?sqrt", name)}, {int(at, 16) for at, _ in found}

    def square_roots_taken(self, counts):
        roots, every = self.square_roots
        unknown = sum(value for at, value in counts.address.items() if at not in every)
        if unknown:
            raise KeyError(f"{unknown} instructions per step at addresses that are no instruction's")
        return sum(value for at, value in counts.address.items() if at in roots)
