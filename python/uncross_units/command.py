"""What `uncross check --units` and `uncross map` share. src/cli/options.c has looked at the options before."""
import getopt
import os
import subprocess
import sys

from uncross_sweep import escape

from . import units
from .quantity import Refused

PROGRAM = os.environ.get("UNCROSS", "uncross")
MARK = "\x1f"  # of rows with all digits: src/cli/sheet.h


def numbers(path, *words):
    """(exit code, output, errors) of `uncross check --numbers`."""
    done = subprocess.run([PROGRAM, "check", "--numbers", *words, "--", path], stdin=subprocess.DEVNULL, capture_output=True, check=False)
    return done.returncode, done.stdout.decode(errors="surrogateescape"), done.stderr.decode(errors="surrogateescape")


def rows(said):
    """{name: value} of the rows; the last of a name counts."""
    parts = [line.split(MARK)[1:] for line in said.splitlines() if line.startswith(MARK)]
    return {part[0].strip(): float(part[2]) for part in parts if part[0] != "units"}


def solvent_of(said):
    """None if the scene has none."""
    line = next(line for line in said.splitlines() if line.startswith(MARK + "units"))
    found = [float(word) for word in line.split(MARK)[2:]]
    return units.Solvent(*found) if found else None


def check(words):
    """The text of a report, or the exit code."""
    options, paths = getopt.gnu_getopt(words, "", ["set=", "units=", "numbers"])
    found = units.given(dict(options)["--units"])
    code, said, errors = numbers(paths[0], *(f"--set={value}" for key, value in options if key == "--set"))
    if code:
        sys.stderr.write(errors)
        return code
    solvent = solvent_of(said)
    scale = units.Scale(found, solvent)
    lines = []
    for line in said.splitlines(keepends=True):
        mark, *part = line[:-1].split(MARK)
        if mark or not part:
            lines.append(line)
        elif part[0] == "units":
            lines += units.report(found, scale, solvent)
        else:
            lines.append(scale.row(part[0], part[1], float(part[2]), *part[3:]))
    return "".join(lines)


def run(act, words):
    """The exit code."""
    try:
        said = act(words)
    except Refused as error:
        print(f"uncross: {escape.shown(error)}", file=sys.stderr)
        return 2
    if isinstance(said, int):
        return said
    try:
        sys.stdout.buffer.write(said.encode(errors="surrogateescape"))
        sys.stdout.buffer.flush()
    except OSError as error:
        os.close(1)  # what could not be written is not tried again at the end
        print(f"uncross: standard output: cannot write: {error.strerror}", file=sys.stderr)
        return 4
    return 0
