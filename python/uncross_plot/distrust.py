"""What to distrust. All pages ask here: those of runs, of points and of sweeps, and those of comparisons."""
import math
import os
import re

import numpy

from uncross_sweep import plateau

from . import columns, tables

LEAST_PAIRS = plateau.LEAST_PAIRS


def stream_and_start(record):
    """Which random numbers a run draws, and the state of the snapshot that it begins with; of each None if not known or none. A run
    whose scene asks for the stream of its seed does not tell the state: its energy and momentum, to the last digit, stand for it."""
    record = record or {}
    state = record.get("stream_from", {}).get("state")
    if state is None and re.search(r"\bsnapshot:", record.get("scene", "")) and "start" in record:
        state = repr(sorted(record["start"].items()))
    return record.get("stream", record.get("seed")), state


def of_run(run):
    """Of a run, or of a point of a sweep. Sentences, the gravest first; an empty list if nothing is known against it."""
    return [*_ended(run), *run.trouble, *_told(run), *_faults(run), *of_means(run), *_few(run), *_unconverged(run),
            *(kin({run.name: [stream_and_start(r) for r in run.records]}) if run.members else [])]


def of_means(run):
    """What is found out from the scene and from tables, of final numbers."""
    return [*_short(run), *_moving(run), *_off_theory(run)]


def of_sweep(points, rows):
    """points: {name: Run of its folder}; rows: of runs.csv, with the record of each finished run, or None, under `record`."""
    lost = [("run.json is not there, or cannot be read: what the run warned of is not known", row["folder"]) for row in rows
            if row["record"] is None and row.get("exit_code") == "0"]
    said = [(text, row["folder"]) for row in rows for text in (row["record"] or {}).get("warnings", [])]
    found = [(text, name) for name, point in points.items() for text in of_means(point)]
    moving = [(text, name) for text, name in found if text in set(_moving(points[name]))]
    groups = {}
    for row in rows:
        stream, start = stream_and_start(row["record"])
        groups.setdefault(os.path.dirname(row["folder"]) or row["folder"], []).append(
            (stream or row.get("stream"), start or row.get("start_state")))
    return [*once(lost + said, len(rows)), *(f"{name}: {text}" for text, name in moving),
            *once([each for each in found if each not in moving], len(points), "points"), *kin(groups)]


def of_pair(names, a, b):
    """Of two runs side by side, or of two points."""
    said = {}
    for name, run in zip(names, (a, b)):
        for text in of_run(run):
            said.setdefault(text, []).append(name)
    return [f"{text.rstrip('.')} (both)." if len(who) > 1 else f"{who[0]}: {text}" for text, who in said.items()] + kin_of_pair(a, b)


def once(said, total, noun="runs"):
    """Sentences once each, with how many have it. said: [(sentence, who)]. Numbers may differ: those of the first are shown."""
    groups = {}
    for text, who in said:
        groups.setdefault(re.sub(r"[-+]?\d+(\.\d+)?(e[-+]?\d+)?", "0", text), []).append((text, who))
    for (text, who), *others in groups.values():
        where = f": {who}" if not others and total > 1 else f"; numbers of {who}" if any(text != other for other, _ in others) else ""
        yield f"{text.rstrip('.')} ({1 + len(others)} of {total} {noun}{where})." if total > 1 else text


def _told(run):
    """Warnings of run.json."""
    said = [(text, name) for name, record in run.members for text in (record or {}).get("warnings", [])]
    return once(said, len(run.members)) if run.members else run.warnings


# --- runs that are no independent ones ---------------------------------------------------------------------------------

def kin(groups):
    """What runs have in common that are averaged, or compared, as if they were independent. groups: {point: [(stream, start)]}."""
    said = []
    for name, mine in groups.items():
        streams = [stream for stream, _ in mine if stream]
        if len(set(streams)) < len(streams):
            said.append(f"{name}: runs that are averaged draw the same random numbers (a stream twice): errors are too small.")
    if any(len(starts) > len(set(starts)) for starts in ([start for _, start in mine if start] for mine in groups.values())):
        said.append("Runs of one point begin with the same state of a snapshot: they are independent only when it is forgotten.")
    if len(groups) > 1 and set.intersection(*({stream for stream, _ in mine if stream} for mine in groups.values())):
        said.append("All points have the same seeds, and draw the same random numbers: values of two points may be off in the same "
                    "way, and the error of their difference is not that of independent runs. Other seeds for each point end this.")
    return said


def kin_of_pair(a, b):
    """Differences are judged as if the two were independent."""
    (streams, starts), (others, other_starts) = (map(set, zip(*map(stream_and_start, run.records or [None]))) for run in (a, b))
    said, shared = [], sorted(str(stream) for stream in streams & others if stream)
    if shared:
        said.append(f"Both draw the same random numbers (stream {', '.join(shared)}): their fluctuations may be alike, and "
                    "differences over errors too small.")
    if any(starts & other_starts):
        said.append("Both begin with the same state of a snapshot: they are alike until it is forgotten.")
    return said


# --- how runs ended, and for how long they ran -------------------------------------------------------------------------

def _ended(run):
    if run.members:
        return [f"{name}: {text[:1].lower()}{text[1:]}" for name, record in run.members for text in _end_of(record, run.path)]
    return _end_of(run.record, run.path)


def _end_of(record, path):
    if record is None:
        return ["There is no run.json: how the run ended is not known."] if os.path.isdir(path) else []
    status, done, wanted = record.get("status"), record.get("steps", 0), record.get("steps_wanted", 0)
    if status == "finished" and done >= wanted:
        return []
    why = f": {record['reason']}" if record.get("reason") else ""
    return [f"The run did not finish: it is '{status}' at step {done} of {wanted}{why}."]


def _faults(run):
    rigid = sum(record.get("collisions", {}).get("rigid", 0) for record in run.records)
    told = any("rigid" in text for text in run.warnings)
    return [f"{rigid} contacts made bonds move rigidly for the rest of a drift."] if rigid and not told else []


def _short(run):
    """Times that the run is too short for."""
    time = run.time
    for heading, rows in run.derived:
        for row in rows:
            if row.name.startswith("rotational relaxation") and time and time < float(row.value):
                yield (f"{heading}: the run lasted {time:.4g} t0, and a fiber turns in {float(row.value):.4g} t0: "
                       "averages still show the start.")
            if row.name.startswith("slowest Rouse mode") and time and time < float(row.value):
                yield (f"{heading}: the run lasted {time:.4g} t0, and the slowest mode of a chain, without hydrodynamics, takes "
                       f"{float(row.value):.4g} t0: averages still show the start.")
            if row.name == "time to become steady" and time:
                yield from _unsteady(run, time, float(row.value))


def _few(run):
    """Averages of too few values."""
    few = {}
    for table in run.tables:
        lost = [c for c in table.values if table.errors(c) is not None
                and (numpy.isfinite(table.data[c]) & numpy.isnan(table.errors(c))).any()]
        if lost:
            yield f"{table.name}: too few values for an error of {', '.join(lost)}."
        pairs, least = table.data.get("intervals"), LEAST_PAIRS * seeds_of(table)
        if pairs is not None and (pairs < least).any():
            few.setdefault(f"{table.data['time'][pairs < least][0]:.4g}", []).append(table.name)
    for lag, names in few.items():
        yield (f"{', '.join(names)}: from lag {lag} t0 on, fewer than {LEAST_PAIRS} pairs of times were compared: errors "
               "there are the scatter over fibers alone.")


MOST_START = 0.01  # of a mean over time: as src/scene/warnings.c has it


def _unsteady(run, end, tau):
    """Profiles and stresses of a flow that starts at rest. A run from a snapshot starts as that ended."""
    means = [table.name for table in run.tables if table.name in ("profile", "stress")]
    told = any("the flow starts at rest" in text for text in run.warnings)
    steps = next((record["steps"] for record in run.records if record.get("steps")), None)
    found = re.search(r"(?m)^ +from: (\d+)", run.scene)
    begin = float(found[1]) * end / steps if found and steps else 0.0
    if told or not means or end <= begin or re.search(r"\bsnapshot:", run.scene):
        return
    share = tau / (end - begin) * (math.exp(-begin / tau) - math.exp(-end / tau))
    if share > MOST_START:
        yield (f"{', '.join(means)}: the flow has not become steady: it starts at rest and needs {tau:.3g} t0 for each factor of e; "
               f"means from {begin:.4g} to {end:.4g} t0 hold {100.0 * share:.2g} % of the start.")


def seeds_of(table):
    """How many runs are averaged in it."""
    return int(numpy.nanmax(table.data["seeds"])) if "seeds" in table.data and table.rows else 1


def diffusion(run, table):
    """(column, row, Plateau) of the D that the page shows of a table: at the longest lag that enough intervals have, about the
    drift where a force acts; None if it has none."""
    column = "D_about_mean" if any("contain (v t)^2" in text for text in run.warnings) else "D"
    row = plateau.last_lag(table.data, seeds_of(table)) if column in table.data else None
    if row is None or not numpy.isfinite(table.data[column][row]):
        return None
    errors = {f"{name}_error": table.errors(name) for name in table.values if table.errors(name) is not None}
    return column, row, plateau.plateau({**table.data, **errors}, row, column)


def _moving(run):
    """Diffusion coefficients that still depend on the lag."""
    for table in run.tables:
        found = diffusion(run, table)
        if found:
            doubt = found[2].doubt(f"D of '{columns.split(table.name)[1] or table.name}'")
            if doubt:
                yield doubt


def _unconverged(run):
    """Time series whose halves differ by more than chance."""
    for table in run.tables:
        sort = columns.split(table.name)[0]
        if table.has_errors or table.rows < 64 or sort not in ("conserved", "temperature"):
            continue
        for name in table.values if sort == "temperature" else ("bond", "bend"):
            series = table.data.get(name)
            if series is None or not numpy.isfinite(series).all():
                continue
            halves = numpy.array_split(series, 2)
            error = math.hypot(*(tables.blocked_error(half) for half in halves))
            gap = halves[1].mean() - halves[0].mean()
            if error > 0 and abs(gap) > 4 * error:
                yield (f"{table.name}: {name} is not steady: its second half differs from the first by {gap:.3g}, "
                       f"{abs(gap) / error:.1f} standard errors.")


def _off_theory(run):
    """Averages that must have the values of the phantom chain, and have not."""
    for table in run.tables:
        for name, exact in run.exact(table).items():
            if table.errors(name) is None:
                continue
            value, error = table.data[name][0], table.errors(name)[0]
            if error > 0 and abs(value - exact) > 5 * error:
                yield (f"{table.name}: {name} = {value:.5g} ± {error:.2g}, where theory has {exact:.5g}: "
                       f"{abs(value - exact) / error:.1f} standard errors apart.")
    heat = run.table("temperature")
    series = heat.data.get("solvent") if heat is not None else None
    if series is not None and len(series) and numpy.isfinite(series).all():
        error = tables.blocked_error(series)
        if abs(series.mean() - 1.0) > 5 * error and abs(series.mean() - 1.0) > 0.01:
            yield (f"temperature: that of the solvent is {series.mean():.4f} ± {error:.1g} kT/kB: averages are not "
                   "those of equilibrium at 1.")
