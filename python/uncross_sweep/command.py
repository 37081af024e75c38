"""The command line. The options are declared in src/cli/options.c too, which has looked at them before."""
import argparse
import collections
import errno
import os
import pathlib
import sys

from . import averages, escape, grid, jobs, slurm

DONE, BAD_INPUT, NOT_WRITTEN = 0, 2, 4


class Full(Exception):
    """Standard output cannot be written: exit code 4."""


def _joined(words):
    """A value of its own word may begin with a dash, as a folder's name may: argparse takes it for an option."""
    takes, made = ("--out", "-o", "--grid", "--seeds", "--set", "--steps", "--jobs"), []
    for word in words:
        if made and made[-1] in takes:
            made[-1] += word if made[-1] == "-o" else f"={word}"
        else:
            made.append(word)
    return made


def read_arguments(words):
    parser = argparse.ArgumentParser(prog="uncross sweep", allow_abbrev=True)
    parser.add_argument("scene")
    parser.add_argument("--out", "-o", type=pathlib.Path, required=True)
    parser.add_argument("--grid", action="append", default=[], metavar="KEY=V1,V2,...")
    parser.add_argument("--seeds", metavar="A..B")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE")
    parser.add_argument("--steps", type=int)
    parser.add_argument("--jobs", type=int, default=jobs.processors())
    for switch in "--resume", "--list", "--slurm", "--quiet":
        parser.add_argument(switch, action="store_true")
    return parser.parse_args(_joined(words))


def look_for_twice(options):
    """An option and a key that it stands for: one of the two would be dropped. Two settings of one key `uncross check` refuses."""
    for option, key, value in (("--steps", "steps", options.steps), ("--seeds", "seed", options.seeds)):
        for other, texts in (("--grid", options.grid), ("--set", options.set)):
            if value is not None and any(text.partition("=")[0] == key for text in texts):
                raise grid.Refused(f"{option} {value}: {key} is a key of {other}, too; allowed: one of them")


def make_sweep(options):
    look_for_twice(options)
    points = grid.points_of([grid.read_axis(text) for text in options.grid])
    seeds = None if options.seeds is None else grid.read_seeds(options.seeds)
    sweep = grid.Sweep(grid.find_program(), options.scene, options.out, points, seeds, tuple(options.set), options.steps)
    sweep.look()
    if len(points) * len(seeds or [0]) > grid.MOST_RUNS:
        raise grid.Refused(f"more than {grid.MOST_RUNS} runs")
    return sweep


def tell_warnings(sweep):
    told = collections.Counter(warning for point in sweep.points for warning in point.warnings)
    for warning, count in told.items():
        where = "" if len(sweep.points) == 1 else f" ({count} of {len(sweep.points)} points)"
        print(f"uncross: warning: {escape.shown(warning)}{where}", file=sys.stderr)


def check_folder(sweep, runs, resume):
    """Nothing is written over: a folder that holds something is gone on with, or left alone."""
    out = sweep.out
    if out.exists() and not out.is_dir():
        raise grid.Refused(f"{out}: is no folder")
    left = sorted(path.name for path in out.iterdir() if path.name != ".lock") if out.is_dir() else []
    if left and not resume:
        raise grid.Refused(f"{out}: holds {left[0]} already; go on with --resume, or name another folder")
    for folder in dict.fromkeys(path for run in runs for path in (run.folder.parent, run.folder)):
        if folder.is_symlink():
            raise grid.Refused(f"{folder}: is a link; nothing is written there")
    for name in averages.OWN:
        averages.refuse_others(out / name)
    return [run for run in runs if not jobs.is_finished(run)]


def write_results(sweep, runs):
    """All tables, from the runs that are finished. They depend on the runs alone."""
    done = {id(run) for run in runs if jobs.is_finished(run)}
    keys = list(sweep.points[0].values)
    listed = []
    for run in runs:
        status, steps, state = jobs.status_of(run)
        code = 0 if id(run) in done else "" if run.code is None else run.code
        stream, start = jobs.stream_of(run)
        listed.append({"folder": run.name, **run.point.values, "seed": run.seed, "stream": stream, "start_state": start, "exit_code": code, "status": status,
                       "steps_done": steps, "state_hash": state, "message": "" if id(run) in done else run.message})
    averages.write_rows(sweep.out / "runs.csv",
                        ["folder", *keys, "seed", "stream", "start_state", "exit_code", "status", "steps_done", "state_hash", "message"], listed)
    rows = []
    for point in sweep.points:
        finished = [run for run in runs if run.point is point and id(run) in done]
        folders, numbers = [run.folder for run in finished], {}
        if folders:
            tables = averages.write_averages(sweep.out / point.name, folders, [jobs.status_of(run)[1] for run in finished])
            numbers = averages.final_numbers(folders, tables, point.start)
        rows.append({"folder": point.name, **point.values, "seeds": len(folders), **numbers})
    names = list(dict.fromkeys(name for row in rows for name in row))
    averages.write_rows(sweep.out / "summary.csv", names, rows)
    return len(done)


def run_all(sweep, options):
    runs = sweep.runs()
    with_folder = check_folder(sweep, runs, options.resume)
    if not options.quiet:
        tell_warnings(sweep)
    with jobs.locked(sweep.out) as lock:
        left = [run for run in with_folder if not jobs.is_finished(run)]
        pool = jobs.Pool(left, max(options.jobs, 1), lock, jobs.Progress(len(runs), left, max(options.jobs, 1), options.quiet))
        pool.work()
        done = write_results(sweep, runs)
    failed = [run for run in runs if run.code not in (None, 0, jobs.INTERRUPTED) and not (pool.stopped_by and run.code < 0)]
    if not options.quiet:
        say(f"{done} of {len(runs)} runs finished\nresults in {escape.shown(sweep.out)}/summary.csv"
            + ("\ngo on with the same command and --resume" if done < len(runs) else ""), closing=True)
    return abs(failed[0].code) if failed else DONE if done == len(runs) else jobs.INTERRUPTED


def say(text, closing=False):
    """On standard output. Closing words, which nobody may want to hear: not where it is closed."""
    try:
        print(text, flush=True)
    except OSError as error:
        sys.stdout = open(os.devnull, "w", encoding="ascii")  # what could not be written is not tried again at the end
        if closing and error.errno == errno.EBADF:
            return
        raise Full(f"standard output: cannot write: {error.strerror}") from error


def main(words):
    options = read_arguments(words)
    try:
        sweep = make_sweep(options)
        if options.list:
            say("\n".join(run.words() for run in sweep.runs()))
            return DONE
        if options.slurm:
            say(slurm.script(sweep.runs(), sweep.out).removesuffix("\n"))
            return DONE
        return run_all(sweep, options)
    except (grid.Refused, averages.BadTable) as refused:
        code, text = BAD_INPUT, refused
    except (jobs.Busy, Full, OSError) as trouble:
        code, text = NOT_WRITTEN, trouble
        if isinstance(trouble, OSError) and trouble.filename is not None:
            text = f"{trouble.filename}: {trouble.strerror}"
    print(f"uncross: {escape.shown(text)}", file=sys.stderr)
    return code
