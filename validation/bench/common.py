"""What the benchmarks share: programs and their CPU time, medians, results that survive an interruption."""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import threading
import time

import numpy

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BASELINE = HERE / "baseline.json"


def say(text):
    print(f"{time.strftime('%H:%M:%S')}  {text}", flush=True)


def digest(*paths):
    """Hash of files: what was measured with other programs, or by other rules, is measured anew."""
    total = hashlib.sha256()
    for path in paths:
        total.update(pathlib.Path(path).read_bytes())
    return total.hexdigest()[:16]


class Store:
    """A JSON file of what programs printed, by command line, written after each run; what other programs printed is
    dropped. `jobs` runs at a time where several are asked for and their speed is not the point."""

    def __init__(self, path, stamp, programs, jobs):
        self.path, self.stamp, self.programs, self.jobs = pathlib.Path(path), stamp, programs, jobs
        self.items, self.lock = {}, threading.Lock()
        self.path.parent.mkdir(parents=True, exist_ok=True)
        try:
            old = json.loads(self.path.read_text())
            if old["stamp"] == stamp:
                self.items = old["items"]
        except (OSError, ValueError, KeyError, TypeError):
            pass

    def run(self, *command):
        """What this program of validation/bench prints, from the file if it is there."""
        command = [str(c) for c in command]
        key = " ".join(command)
        if key not in self.items:
            say(key if len(key) < 110 else key[:107] + "...")
            _, _, text = run_program([self.programs / command[0], *command[1:]], cwd=HERE)  # scene files are found from there
            with self.lock:
                self.items[key] = text
                write_json(self.path, {"stamp": self.stamp, "items": self.items})
        return self.items[key]

    def run_all(self, commands):
        """What each of these prints."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            return list(pool.map(lambda command: self.run(*command), commands))


def write_json(path, content):
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    aside = path.with_suffix(".new")
    aside.write_text(json.dumps(content, indent=1) + "\n")
    aside.replace(path)


def run_program(command, environment=None, cwd=None):
    """(CPU seconds user + system, greatest resident set in bytes, standard output) of a program that must succeed."""
    with tempfile.TemporaryFile() as out:
        child = subprocess.Popen([str(c) for c in command], stdout=out, stdin=subprocess.DEVNULL, cwd=cwd,
                                 env=dict(os.environ, OMP_NUM_THREADS="1", **(environment or {})))
        try:
            _, status, usage = os.wait4(child.pid, 0)
        except BaseException:
            child.kill()
            raise
        child.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        text = out.read().decode(errors="replace")
    if child.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit status {child.returncode}\n{text}")
    return usage.ru_utime + usage.ru_stime, 1024 * usage.ru_maxrss, text


def median(values):
    return float(numpy.median(values))


def spread(values):
    """Half the distance between the quartiles."""
    low, high = numpy.percentile(values, [25, 75])
    return float(0.5 * (high - low))


def load_baseline():
    return json.loads(BASELINE.read_text()) if BASELINE.exists() else {}


def row(name, unit, values=None, value=None, error=None):
    """An entry of bench.json: of several readings (median, spread), or of a value with its error. An error that a
    short run cannot tell is none.
    """
    if values is not None:
        value, error = median(values), spread(values)
    if error is not None and not numpy.isfinite(error):
        error = None
    return {"name": name, "value": value, "unit": unit, "spread": error, "baseline": load_baseline().get(name)}


def quantities(text):
    """{name: (value, error, ...)} of lines "name value error ..."."""
    lines = (line.split() for line in text.splitlines())
    return {name: tuple(map(float, numbers)) for name, *numbers in lines}


def show(rows):
    width = max(len(r["name"]) for r in rows)
    for r in rows:
        was = "" if r["baseline"] is None else f"   (baseline {r['baseline']:.4g})"
        print(f"{r['name']:{width}}  {r['value']:10.4g} +- {r['spread'] or 0:<9.2g} {r['unit']}{was}")
