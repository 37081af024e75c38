"""Tables and JSON of runs, and words for durations. The campaign (validation/lib/runs.py) uses them too."""
import csv
import fcntl
import json
import sys

import numpy

from . import escape
from .opening import MOST_JSON, read_text, write_text


def columns(text):
    """Comma-separated values under a line of names as a dict of arrays, of floats where all are numbers. A last line
    without its end is yet being written."""
    whole = text[:text.rfind("\n") + 1]
    rows = list(csv.reader(line for line in whole.splitlines() if line and not line.startswith("#")))
    table = {}
    for k, name in enumerate(rows[0] if rows else []):
        values = [row[k] for row in rows[1:]]
        try:
            table[name] = numpy.array([float(x) for x in values])
        except ValueError:
            table[name] = numpy.array(values)
    return table


def read_json(path):
    try:
        return json.loads(read_text(path, MOST_JSON))
    except FileNotFoundError:
        return {}


def write_json(path, data):
    write_text(path, json.dumps(data, indent=2, sort_keys=True) + "\n")


def take_lock(file, how, what):
    """flock, whose BlockingIOError says that another process has it. Where there are no locks, work goes on without, with a
    warning that nobody else may do `what`."""
    try:
        fcntl.flock(file, how)
    except BlockingIOError:
        raise
    except OSError as error:
        print(f"uncross: {escape.shown(file.name)}: locks cannot be had here ({error.strerror}): see to it yourself that no other process "
              f"{what}", file=sys.stderr, flush=True)


def duration(seconds):
    return f"{seconds / 3600:.1f} h" if seconds >= 5400 else f"{seconds / 60:.0f} min" if seconds >= 90 else f"{seconds:.0f} s"
