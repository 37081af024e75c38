"""Two runs in the same figures: `uncross plot --compare`."""
import difflib
import math
import os

from . import columns, distrust, flow, page, runs, style, tables

DOUBT = 4.0  # a difference of more errors than this is named on the front page


def names_of(a, b):
    """What the two are called: their names, or the paths where these are alike."""
    return (a.name, b.name) if a.name != b.name else (a.path, b.path)


def pairs_of(a, b):
    """(name, table of a, table of b) of the tables that both have; of two files, these two."""
    if not any(os.path.isdir(run.path) for run in (a, b)) and len(a.tables) == len(b.tables) == 1:
        return [(a.tables[0].name, a.tables[0], b.tables[0])]
    return [(t.name, t, b.table(t.name)) for t in a.tables if b.table(t.name) is not None]


def scene_changes(a, b):
    """Lines of the scenes that differ, as '- that of a' and '+ that of b'."""
    lines = [[line.rstrip() for line in run.scene.splitlines() if not line.startswith("#")] for run in (a, b)]
    return [line[0] + " " + line[1:].strip() for line in difflib.unified_diff(*lines, n=0, lineterm="")
            if line[:1] in "+-" and line[:3] not in ("+++", "---") and line[1:].strip()]


def _shown(value, error):
    return page.with_error(value, error) if math.isfinite(error) else f"{value:.6g}"


def _rows(ours, theirs):
    """(rows of words, [(|z|, sentence)]) for the columns that both have."""
    rows, found = [], []
    for name in (c for c in ours.values if c in theirs.values):
        told = tables.summary(ours, theirs, name)
        if told is None:
            continue
        a, a_error, b, b_error, z, x, count = told
        label = columns.column(name)
        where = "" if x is None else f"at {x:.4g} t0, the largest of {count}"
        rows.append((page.plain(label.name), page.plain(label.symbol), _shown(a, a_error), _shown(b, b_error),
                     f"{z:+.1f}" if math.isfinite(z) else "", where))
        if math.isfinite(z):
            found.append((abs(z), f"{columns.title(ours.name)}, {label.name}: {z:+.1f} errors {where}".rstrip() + "."))
    return rows, found


def _section(name, ours, theirs, names):
    rows, found = _rows(ours, theirs)
    blocks = []
    if min(ours.rows, theirs.rows) > 1:
        shared = len(tables.common(ours, theirs)[0])
        words = f"{names[0]}: filled or full; {names[1]}: open or dashed. Below: {names[1]} minus {names[0]}"
        words += (", over its error; dashed: two errors." if ours.has_errors and theirs.has_errors else ".")
        words += f" {shared} rows are at the same place."
        panels = [(style.data_uri(svg), False) for svg in tables.compare(ours, theirs, names)]
        alt = f"{columns.title(name)} of {names[0]} and {names[1]}, and their difference."
        blocks += [page.Figure(columns.title(name), "", alt, words, name, panels=panels)] if panels else []
    else:
        svg = tables.compare_rows(ours, theirs, names)
        blocks += [page.Figure(columns.title(name), style.data_uri(svg), f"{columns.title(name)}: differences over their errors.",
                               f"{names[1]} minus {names[0]}, over its error; dashed: two errors.", name)] if svg else []
    if rows:
        caption = ("Where a table has an error for each row, the row where the two differ most." if ours.has_errors else
                   "Means over all rows, errors from blocks of rows. Sums and counts since the start: their last values.")
        blocks.append(page.Rows(f"{columns.title(name)}, in numbers", rows,
                                ("", "symbol", names[0], names[1], "difference / error", ""), caption, (2, 3, 4), "" if blocks else name))
    return page.Section(columns.title(name), blocks), found


def flow_table(a, b, names):
    """What both have of a flow (flow.py), side by side; a section without blocks if one of them has no flow."""
    ours, theirs = (flow.Flow(run).measured() for run in (a, b))
    rows, left = [], list(theirs)
    for one in ours:
        other = next((m for m in left if m.name == one.name), None)  # of two viscosities the first goes with the first
        if other is None:
            continue
        left.remove(other)
        error = math.hypot(one.error, other.error)
        rows.append((one.name, page.with_error(one.value, one.error), page.with_error(other.value, other.error), one.unit,
                     f"{(other.value - one.value) / error:+.1f}" if error > 0 else "", one.source.partition(";")[0]))
    return page.Section("Flow", [page.Rows("The flow, measured", rows, ("", *names, "unit", "difference / error", "from"),
                                           "Of profile.csv and stress.csv. Errors of fits are bounds, so that differences over them are "
                                           "too small rather than too large.", (1, 2, 4))] if rows else [])


def page_of(a, b, movie=False):
    names = names_of(a, b)
    pairs = pairs_of(a, b)
    if not pairs:
        raise runs.BadInput(f"{b.path}: has no table in common with {a.path}")
    sections, found = [], []
    for name, ours, theirs in pairs:
        section, more = _section(name, ours, theirs, names)
        sections.append(section)
        found += more
    found.sort(reverse=True)
    far = [text for z, text in found if z > DOUBT]
    came = f"{len(found)} columns have an error in both; {len(far)} differ by more than {DOUBT:g} errors"
    changes = scene_changes(a, b)
    front = [(names[0], [page._how(a), page._what(a)]), (names[1], [page._how(b), page._what(b)]),
             ("Scenes", ["They differ in:", *changes] if changes else
              "The same." if a.scene and b.scene else "Not known of both."),
             ("What came out", [came + (":" if found else "."), *(far[:8] or [text for _, text in found[:1]])]),
             ("What to distrust", page._doubts(distrust.of_pair(names, a, b)))]
    pictures = [page.picture_of(run.frames, movie and run.moving) for run in (a, b) if run.frames and run.frames.structure.kinds]
    for section, name in zip(pictures, [n for n, run in zip(names, (a, b)) if run.frames is not None]):
        section.title = f"Fibers of {name}"
    return page.render(f"{names[0]} and {names[1]}", front, pictures + sections + [flow_table(a, b, names)] + [
        page.Section(f"Provenance of {name}", page.provenance(run)) for name, run in zip(names, (a, b))])
