"""The page: what a run, or two, come to as one HTML file. page.html.jinja is its form."""
import dataclasses
import functools
import math
import os
import re
import time

import jinja2
import numpy

from . import columns, distrust, fibers, flow, style, tables


@dataclasses.dataclass
class Figure:
    title: str
    src: str
    alt: str
    caption: str = ""
    name: str = ""  # of the table
    keys: list = dataclasses.field(default_factory=list)  # (colour, text)
    hollow: tuple = ()  # numbers of keys
    round: tuple = ()
    width: int = 0  # pixels, at most; 0: that of the page
    panels: list = dataclasses.field(default_factory=list)  # (address, whether it is wide): in place of src


@dataclasses.dataclass
class Rows:
    title: str
    rows: list
    head: tuple = ()
    caption: str = ""
    numbers: tuple = ()  # columns that hold numbers
    name: str = ""  # of the table, if no figure shows it


@dataclasses.dataclass
class Text:
    title: str
    text: str


@dataclasses.dataclass
class Section:
    title: str
    blocks: list
    words: str = ""


@functools.cache
def _form():
    here = os.path.dirname(os.path.abspath(__file__))
    return jinja2.Environment(loader=jinja2.FileSystemLoader(here), autoescape=True, trim_blocks=True,
                              undefined=jinja2.ChainableUndefined).get_template("page.html.jinja")


def render(title, front, sections, lead=""):
    """HTML of a page. front: (label, text) or (label, [text, item, ...]) for each line of its box."""
    return _form().render(title=title, front=front, sections=[s for s in sections if s.blocks], lead=lead)


def with_error(value, error):
    """'0.0123 ± 0.0004': the error with two digits, the value with as many places."""
    if value is None or not math.isfinite(value):
        return "nan"
    if error is None or not math.isfinite(error) or error <= 0.0:
        return f"{value:.6g}" if error is None else f"{value:.3g} (error unknown)" if error != 0.0 else f"{value:.6g}"
    size = math.floor(math.log10(error))
    if abs(value) >= 1e6 or max(abs(value), error) < 1e-3:
        power = math.floor(math.log10(max(abs(value), error)))
        return f"({with_error(value / 10.0**power, error / 10.0**power)})e{power}"
    places = max(0, 1 - size)
    return f"{value:.{places}f} ± {error:.{places}f}"


def plain(text):
    """A label without the signs of mathematical text, for words."""
    for old, new in (("_\\mathrm", "_"), ("\\langle ", "⟨"), ("\\langle", "⟨"), ("\\rangle", "⟩"), ("\\cos", "cos "), ("\\theta", "θ"),
                     ("\\Delta", "Δ"), ("\\cdot", "·"), ("\\,", " "), ("_0", "0"), ("^2", "²"), ("^{-1}", "⁻¹"), ("$", ""),
                     ("{", ""), ("}", ""), ("R_g", "Rg"), ("l_p", "lp"), ("k_B", "kB")):
        text = text.replace(old, new)
    return text


WALLED = " between two walls, in a box"
SHEARED = " in a sheared box"
ENDS = {WALLED: ", except at the walls, which nothing crosses", SHEARED: "; images across the shear have slid along x"}
PLACES = ((r"(?m)^walls:", WALLED), (r"(?m)^shear:", SHEARED),
          (r"\bprofile: *(sine|reverse)\b", ", driven by a force with a profile, in a periodic box"))


def place(scene):
    """The box that a scene has, in words."""
    return next((words for pattern, words in PLACES if re.search(pattern, scene)), " in a periodic box")


# --- pictures of fibers ------------------------------------------------------------------------------------------------

def picture_of(frames, movie=False):
    structure = frames.structure
    box = " × ".join(f"{e:g}" for e in structure.edges)
    shown = f"{fibers.words(structure)}{place(structure.scene)} of {box} a0"
    ways = ENDS.get(place(structure.scene), "")
    keys = []
    for kind, name in enumerate(structure.kinds):
        keys.append((style.COLORS[kind % len(style.COLORS)], name))
    if fibers.marked_fiber(structure) >= 0:
        keys.append((style.COLORS[1], "one fiber, marked"))
    last = f"step {frames.steps[-1]}, time {frames.times[-1]:g} t0"
    blocks = [Figure("Fibers at the end", fibers.picture(frames), f"Perspective picture of {shown}, at {last}.",
                     f"{shown[0].upper()}{shown[1:]}, at {last}. A bond that crosses a face of the box comes in again at "
                     f"the opposite one{ways}.", keys=keys,
                     hollow=tuple(k for k in range(len(structure.kinds)) if fibers.is_hollow(k)),
                     round=tuple({int(structure.kind[row]) for row in structure.beads}))]
    if movie:
        src, numbers = fibers.movie(frames)
        span = f"{frames.times[0]:g} to {frames.times[-1]:g} t0"
        blocks.append(Figure("Fibers in motion", src, f"Animated picture of {shown}, {span}.",
                             f"{len(numbers)} of {len(frames.steps)} frames, {span}, again and again.", width=640))
    return Section("Fibers", blocks)


# --- figures of tables -------------------------------------------------------------------------------------------------

def guides(run, kind):
    """(label, function of t, stroke): the lines of theory beside mean square displacements of a kind."""
    known, found = run.numbers(kind), []
    if "tube plateau of d^2(t)" in known:
        plateau = known["tube plateau of d^2(t)"]
        found.append((r"tube, $2L_\perp^2$ (Eq. 35)", lambda t: plateau, "-."))
    bond, persistence, friction = (known.get(name) for name in ("mean bond length", "effective persistence length", "vertex friction, without HI"))
    if bond and persistence and friction and persistence >= 0.8 * known.get("contour length", math.inf):
        friction /= bond
        # One interior point of a stiff filament, two components, no hydrodynamics, kT = 1.
        size = 1.538757 / persistence * (persistence / friction)**0.75
        found.append((r"$t^{3/4}$ of a stiff fiber, without hydrodynamics", lambda t: size * t**0.75 if t > 0.3 else 0.0, "--"))
    return found


def flow_guides(run):
    """The profile that theory expects of a steady flow."""
    found = flow.Flow(run)
    y = None if not found.kind else numpy.linspace(0.0, found.edge, 200)
    expected = None if y is None else found.expected(y)
    return [] if expected is None else [("theory" + (f", {found.fluid}" if found.fluid else ""), lambda t: float(numpy.interp(t, y, expected)), "--")]


def measured_flow(run):
    """Viscosity, slip and the like of a flow, beside theory."""
    rows = []
    for m in flow.Flow(run).measured():
        known = math.isfinite(m.theory)
        away = f"{(m.value - m.theory) / m.error:+.1f}" if known and m.error > 0 and not m.fluid else ""
        theory = f"{m.theory:.6g}{f', {m.fluid}' if m.fluid else ''}" if known else ""
        rows.append((m.name, with_error(m.value, m.error), m.unit, theory, away, m.source))
    return [Rows("The flow, measured", rows, ("", "value ± error", "unit", "theory", "difference / error", "from"),
                 "Of profile.csv and stress.csv. Errors of fits are bounds: those of slabs are added as if all went the same way. "
                 "Theory: molecular chaos, some per cent off at a short mean free path; it is no exact number. Loose vertices: of "
                 "the solvent with vertices that no bonds join; solvent alone: without them. A suspension need not agree with either.", (1, 3, 4))] if rows else []


def figure_of(run, table):
    """The figure of a table; with it, for a single row, the numbers."""
    name, kind = columns.split(table.name)
    shown = [c for c in table.values if c not in table.empty]
    words = f"{table.name}.csv, {table.rows} rows." if table.rows != 1 else f"{table.name}.csv, averages of the run."
    words += " Error bars: one standard error." if table.has_errors else ""
    if table.empty:
        words += f" Without a number: {', '.join(table.empty)}."
    alt = f"{columns.title(table.name)}: " + ", ".join(plain(columns.column(c).short) for c in shown) + "."
    if table.rows == 0:
        return [Figure(columns.title(table.name), style.data_uri(tables.nothing("No row yet")), alt, words, table.name)]
    if table.rows > 1:
        drawn = tables.figure(table, guides(run, kind) if name == "dynamics" else flow_guides(run) if name == "profile" else ())
        return [Figure(columns.title(table.name), "", alt, words, table.name, panels=[(style.data_uri(svg), wide) for svg, wide in drawn])]
    exact = run.exact(table)
    rows = []
    for c in shown:
        error = table.errors(c)
        value, error = table.data[c][0], None if error is None else error[0]
        label = columns.column(c)
        away = f"{(value - exact[c]) / error:+.1f}" if c in exact and error and error > 0 else ""
        rows.append((plain(label.name), plain(label.symbol), with_error(value, error), plain(label.unit),
                     f"{exact[c]:.6g}" if c in exact else "", away))
    words += "" if exact else " No theory for this kind: only errors are drawn."
    svg = tables.single_row(table, exact)
    drawn = [Figure(columns.title(table.name), style.data_uri(svg), alt, words, table.name)] if svg else []
    return drawn + [Rows(f"{columns.title(table.name)}, in numbers", rows,
                         ("", "symbol", "value ± standard error", "unit", "theory", "difference / error"),
                         "Theory: the phantom chain, from uncross check." if exact else "", (2, 4, 5),
                         "" if svg else table.name)]


# --- words -------------------------------------------------------------------------------------------------------------

SHOWN = ("viscosity", "slip length")  # of a flow, on top of the page


def _what(run):
    if run.members:
        return f"A point of a sweep: averages over {len(run.members)} run{'s' if len(run.members) > 1 else ''}."
    structure = run.frames.structure if run.frames else None
    parts = []
    for kind, name in enumerate(structure.kinds) if structure else ():
        rows = structure.kind == kind
        count, ring = len(numpy.unique(structure.fiber[rows])), kind in structure.rings
        each = int(rows.sum()) // max(1, count)
        what = "single beads" if each == 1 else f"rings of {each} vertices" if ring else f"fibers of {each} vertices"
        parts.append(f"{count} {what} ('{name}')")
    edges = f" of {' × '.join(f'{e:g}' for e in structure.edges)} a0" if structure else ""
    return (", ".join(parts) or "The solvent") + (place(run.scene) + edges if structure else "") + "."


def _how(run):
    if run.members:
        return f"{', '.join(name for name, _ in run.members)}; the shortest lasted {run.time or math.nan:g} t0."
    record = run.record or {}
    words = []
    if run.frames is not None and not record:
        count = len(run.frames.steps)
        words.append(f"{count} frame{'s' if count > 1 else ''}, to step {run.frames.steps[-1]} "
                     f"({run.frames.times[-1]:g} t0)")
    if "steps" in record:
        words.append(f"{record.get('status', 'unknown')}: step {record['steps']} of {record.get('steps_wanted', '?')}, "
                     f"{record.get('time', math.nan):g} t0, in {record.get('wall_seconds', math.nan):.3g} s")
    if "seed" in record:
        words.append(f"seed {record['seed']}")
    if "version" in record:
        words.append(f"uncross {record['version']}, commit {record.get('commit', 'unknown')}")
    return "; ".join(words)[:1].upper() + "; ".join(words)[1:] + "."


def _result(run):
    """What came out, in one line."""
    words = []
    heat = run.table("temperature")
    if heat is not None and heat.rows and "solvent" in heat.data and numpy.isfinite(heat.data["solvent"]).all():
        series = heat.data["solvent"]
        words.append(f"temperature of the solvent {with_error(series.mean(), tables.blocked_error(series))} kT/kB")
    record = run.record or {}
    begun, ended = (record.get(when, {}).get("energy") for when in ("start", "end"))
    if begun is not None and ended is not None:
        words.append(f"energy {ended:.6g} kT, changed by {ended - begun:+.3g}")
    if record.get("collisions", {}).get("executed"):
        words.append(f"{record['collisions']['executed']} contacts answered")
    crossings = run.table("topology")
    if crossings is not None and crossings.rows:
        words.append(f"{crossings.data['crossed'][0]:.0f} crossings of bonds in {crossings.data['intervals'][0]:.0f} intervals")
    for table in run.tables:
        if len(words) <= 6:
            words += _diffusion(run, table)
    for m in flow.Flow(run).measured():
        if m.name in SHOWN and math.isfinite(m.value) and math.isfinite(m.error):
            beside = (f"{with_error(m.value / m.over, m.error / m.over)} times that of the solvent alone" if math.isfinite(m.over) else
                      f"theory{f', {m.fluid},' if m.fluid else ''} {m.theory:.4g}")
            words.append(f"{m.name} {with_error(m.value, m.error)} {m.unit}, {beside} ({m.source})")
    return ("; ".join(words)[:1].upper() + "; ".join(words)[1:] + ".") if words else "No observable was asked for."


def _diffusion(run, table):
    """The diffusion coefficient, its lag, and whether it has stopped moving with the lag."""
    found = distrust.diffusion(run, table)
    if found is None:
        return []
    column, row, plateau = found
    errors = table.errors(column)
    value = with_error(table.data[column][row], None if errors is None else errors[row])
    about = " about its drift" if column == "D_about_mean" else ""
    word = f" ({plateau.word})" if plateau.word else ""
    return [f"D of '{columns.split(table.name)[1]}'{about} {value} a0²/t0 at lag {table.data['time'][row]:.3g} t0{word}"]


def _doubts(found):
    found = [text[:1].upper() + text[1:] if re.match("[a-z]+ ", text) else text for text in found]
    if not found:
        return "Nothing that this page looks for: warnings, an early end, drifts, too few values, damaged files."
    return [f"{len(found)} thing{'s' if len(found) > 1 else ''}:", *found]


def _in_si(run):
    """The run in SI units: units, box and duration."""
    numbers = {n.name: n for heading, rows in run.derived if heading in ("SI units", "Suspension") for n in rows}
    words = [f"{numbers[name].symbol.split()[-1]} = {numbers[name].si}" for name in
             ("unit of length", "unit of time", "unit of mass, a solvent particle") if name in numbers and numbers[name].si]
    if "simulated time" in numbers and numbers["simulated time"].si:
        words.append(f"{numbers['simulated time'].value} t0 = {numbers['simulated time'].si}")
    return ["; ".join(words) + ".", *run.units_words]


def front(run):
    where = (f"{len(run.tables)} table{'s' if len(run.tables) != 1 else ''}: {', '.join(t.name for t in run.tables)}"
             if run.tables else "no tables")
    where += f"; {len(run.frames.steps)} frames of a trajectory" if run.moving else ""
    return [("What ran", _what(run)), ("How", _how(run)), ("What came out", _result(run)),
            *([("In SI units", _in_si(run))] if run.units and run.derived else []),
            ("What is here", where[:1].upper() + where[1:] + "."), ("What to distrust", _doubts(distrust.of_run(run)))]


# --- pages -------------------------------------------------------------------------------------------------------------

MOST_SHOWN = 1000  # characters of a value
LONG = ("scene", "warnings", "start", "end", "collisions", "units")


def provenance(run):
    record = run.record
    if not record:
        return []
    rows = [(key.replace("_", " "), (value if isinstance(value, str) else f"{value}")[:MOST_SHOWN]) for key, value in record.items()
            if key not in LONG]
    rows.append(("run.json written", time.strftime("%Y-%m-%d %H:%M:%S UTC", time.gmtime(run.written))))
    rows.append(("again", "uncross run SCENE --out NEW-FOLDER, with the scene below: equal seed and version give the same "
                 "state hash"))
    return [Rows("Where the numbers come from", rows, caption="As run.json has it.")]


def derived(run):
    if run.units:
        return [Rows(heading, [(n.name, n.symbol, n.value, n.unit, n.si, n.source) for n in rows],
                     ("", "symbol", "value", "unit", "SI", "from"), "", (2, 4)) for heading, rows in run.derived]
    return [Rows(heading, [(n.name, n.symbol, n.value, n.unit, n.source) for n in rows],
                 ("", "symbol", "value", "unit", "from"), "", (2,)) for heading, rows in run.derived]


def sections_of(run, movie=False):
    pictures = [picture_of(run.frames, movie)] if run.frames and run.frames.structure.kinds else []
    return pictures + [
        Section("Observables", [block for table in run.tables for block in figure_of(run, table)],
                "docs/observables.md says how each column is measured."),
        Section("Flow", measured_flow(run), "docs/flow.md and docs/observables.md have the formulas."),
        Section("Derived numbers", derived(run), "What uncross check computes from the scene alone."),
        Section("Provenance", provenance(run) + ([Text("The scene", run.scene)] if run.scene else []))]


def page_of(run, movie=False):
    if run.record is None and run.frames is None and not run.members and len(run.tables) == 1 and not run.trouble:  # a table alone
        return render(columns.title(run.tables[0].name), [], sections_of(run))
    return render(run.name, front(run), sections_of(run, movie))


def page_of_many(all_runs, movie=False):
    lead, sections = f"{len(all_runs)} runs.", []
    box = [(run.path, [_how(run), _what(run), _result(run), *distrust.of_run(run)]) for run in all_runs]
    for run in all_runs:
        for section in sections_of(run, movie and run.moving):
            section.title = f"{run.name}: {section.title}"
            sections.append(section)
    return render(", ".join(run.name for run in all_runs), box, sections, lead)
