"""The command line. src/cli/options.c has looked at the options before."""
import collections
import contextlib
import getopt
import os
import signal
import sys
import time

import numpy

from uncross_export import frames as own
from uncross_sweep import escape

from . import crossings, links, readers
from .frame import LATTICE_BITS, Refused

DONE, TROUBLE, BAD_INPUT, NOT_WRITTEN, CROSSED = 0, 1, 2, 4, 10
STRIDES = 1, 2, 5, 10
UNIT = 2**LATTICE_BITS


class Unwritten(Exception):
    """A file or standard output: the message says which."""


def say(text):
    """To standard error, if there is one that takes it."""
    with contextlib.suppress(OSError):
        if sys.stderr:
            print(escape.shown(text), file=sys.stderr)


class Stride:
    """What intervals between every n-th frame gave, all together."""

    def __init__(self):
        self.intervals = self.crossings = self.net = self.odd = self.touched = 0
        self.time = self.steps = 0

    def add(self, found, first, last):
        self.intervals += 1
        self.crossings += len(found.crossings)
        self.touched += len(found.touches)
        self.net += sum(net for _, net in found.count.values())
        self.odd += sum(crossings % 2 for crossings, _ in found.count.values())
        self.time += 0 if None in (first.time, last.time) else last.time - first.time
        self.steps += 0 if None in (first.step, last.step) else last.step - first.step

    def rate(self, bonds):
        """Per bond and unit of time, or step, or frame, whichever the file has; and which."""
        for amount, unit in (self.time, "unit of time"), (self.steps, "step"), (self.intervals, "interval"):
            if amount > 0:
                return self.crossings / bonds / amount, unit
        return 0.0, "interval"


class Table:
    """One line for each meeting, of a file that must not exist."""

    COLUMNS = "stride,frame,what,first_a,first_b,second_a,second_b,image_x,image_y,image_z,time,sign,s,s_second"

    def __init__(self, path):
        self.path, self.file = path, None
        if path:
            try:
                self.file = open(path, "x", encoding="ascii")
            except FileExistsError:
                raise Refused(f"{path}: exists; nothing is written over") from None
            except OSError as error:
                raise Unwritten(f"{path}: cannot create: {error.strerror}") from None
            self._write(self.COLUMNS)

    def _write(self, line):
        try:
            self.file.write(line + "\n")
        except OSError as error:
            raise Unwritten(f"{self.path}: cannot write: {error.strerror}") from None

    def add(self, topology, stride, number, found, first, last):
        for meeting in [*found.crossings, *found.touches] if self.file else []:
            rest = ",,,"
            if isinstance(meeting, crossings.Crossing):
                when = moment(first, last, meeting.t)
                rest = f"{'' if when is None else repr(when)},{meeting.sign},{meeting.s!r},{meeting.other!r}"
            ends = ",".join(str(vertex) for bond in meeting.bonds for vertex in topology.ids[topology.bonds[bond]])
            self._write(f"{stride},{number - stride},{'touched' if rest == ',,,' else 'crossed'},{ends},{','.join(map(str, meeting.image))},{rest}")

    def close(self):
        if self.file:
            try:
                self.file.close()
            except OSError as error:
                raise Unwritten(f"{self.path}: cannot write: {error.strerror}") from None


def moment(first, last, t):
    return None if None in (first.time, last.time) else first.time + t * (last.time - first.time)


class Page:
    """A page about all of it, a file that must not exist. The packages that it needs are read before any frame."""

    def __init__(self, path):
        if os.path.lexists(path):
            raise Refused(f"{path}: exists; nothing is written over")
        from . import page
        self.path, self.make = path, page.html

    def write(self, text):
        made = False
        try:
            with open(self.path, "x", encoding="utf-8", errors="backslashreplace") as file:
                made = True
                file.write(text)
        except OSError as error:
            if made:
                os.remove(self.path)
            raise Unwritten(f"{self.path}: cannot write: {error.strerror}") from None


class Survey:
    """All frames of a file, one after the other."""

    def __init__(self, path, reader, options, table):
        self.path, self.reader, self.table, self.quiet = path, reader, table, "--quiet" in options
        self.strides = {stride: Stride() for stride in STRIDES}
        self.frames = self.near = 0
        self.gaps, self.begin, self.end = set(), None, None
        self.worst = {}  # "crossed", "touched": of stride 1, the first
        self.told = time.monotonic()

    def look(self):
        finder = crossings.Finder(self.reader.topology)
        with contextlib.closing(finder):
            recent = collections.deque(maxlen=max(STRIDES))
            for frame in self.reader.frames():
                self._take(finder, recent, frame)
                recent.append(frame)
                self.frames += 1
                self._progress()

    def _take(self, finder, recent, frame):
        self.begin, self.end = self.begin or frame, frame
        if recent:
            self.gaps.add(None if None in (recent[-1].step, frame.step) else frame.step - recent[-1].step)
        for stride, result in self.strides.items():
            if self.frames % stride or self.frames < stride:
                continue
            first = recent[-stride]
            near = int(numpy.ceil(self.reader.rounding * UNIT)) * 2 if stride == 1 else 0
            found = finder.between(first, frame, near)
            result.add(found, first, frame)
            self.table.add(self.reader.topology, stride, self.frames, found, first, frame)
            if stride == 1:
                self.near += found.near
                for what, meetings in ("crossed", found.crossings), ("touched", found.touches):
                    if meetings and what not in self.worst:
                        self.worst[what] = self.frames, first, frame, min(meetings, key=lambda meeting: getattr(meeting, "t", 0))

    def _progress(self):
        if not self.quiet and time.monotonic() - self.told > 5:
            self.told = time.monotonic()
            say(f"frame {self.frames}: {self.strides[1].crossings} crossings")

    def every_step(self, options):
        known = self.gaps == {1}
        if "--every-step" in options and not known and self.gaps and self.gaps != {None}:
            raise Refused(f"{self.path}: --every-step, but its frames are {', '.join(map(str, sorted(self.gaps - {None})))} steps apart")
        return known or "--every-step" in options


def plural(number, word):
    return f"{number} {word}{'' if number == 1 else 's'}"


def describe(survey):
    """Lines about the file."""
    topology, frame = survey.reader.topology, survey.begin
    made = "branched" if topology.curves is None else " and ".join(
        plural(count, word) for word, closed in (("chain", False), ("ring", True)) if (count := sum(curve.closed == closed for curve in topology.curves)))
    yield f"{plural(survey.frames, 'frame')}, {plural(len(topology.bonds), 'bond')}: {made}"
    axes = "".join(axis for axis, periodic in zip("xyz", frame.periodic) if periodic)
    leans = ", sheared" if any(f.offset for f in (survey.begin, survey.end)) else ""
    yield f"box {' '.join(f'{edge / UNIT:.10g}' for edge in frame.edge)}, periodic along {axes}{leans}" if axes else "no periodic box"


def where(survey, what):
    """Of the first meeting: frame, bonds, time."""
    number, first, last, meeting = survey.worst[what]
    topology = survey.reader.topology
    bonds = " and ".join(" ".join(str(vertex) for vertex in topology.ids[topology.bonds[bond]]) for bond in meeting.bonds)
    image = f" in image {' '.join(map(str, meeting.image))}" if any(meeting.image) else ""
    text = f"first {what}: between frames {number - 1} and {number}, bonds {bonds}{image}"
    if what == "crossed":
        when = moment(first, last, meeting.t)
        text += f", at {meeting.t:.6g} of the way" + (f", time {when:.10g}" if when is not None else "") + f", sign {meeting.sign:+d}"
    return text


def results(survey, every_step):
    """Lines of the table and below it."""
    bonds, (_, unit) = len(survey.reader.topology.bonds), survey.strides[1].rate(1)
    yield f"{'stride':>6} {'intervals':>10} {'crossings':>10} {'net':>8} {'odd pairs':>10} {'touched':>8}   crossings per bond and {unit}"
    for stride, result in survey.strides.items():
        if result.intervals:
            yield (f"{stride:>6} {result.intervals:>10} {result.crossings:>10} {result.net:>8} {result.odd:>10} {result.touched:>8}   "
                   f"{result.rate(bonds)[0]:.6g}")
    for what in survey.worst:
        yield where(survey, what)
    if survey.reader.rounding:
        yield (f"positions are stored to {survey.reader.rounding:.2g}: {survey.near} pairs of bonds were nearer than twice that, where no crossing can be known; "
               "write them with all 17 digits, or as doubles")
    yield verdict(survey, every_step)


def verdict(survey, every_step):
    crossed = survey.strides[1].crossings > 0
    if survey.frames < 2:
        return "verdict: none; two frames are needed"
    if crossed and every_step:
        return "verdict: CROSSED: if vertices move straight in a step, this code lets bonds through"
    if crossed:
        return "verdict: CROSSED between these frames, by straight moves; they are not known to be of every step, so the code's own paths may have gone round"
    if survey.strides[1].touched:
        odd = survey.strides[1].odd
        return f"verdict: TOUCHED: no crossing strictly within bonds and frames; {odd} odd pairs if ties are broken; whether bonds went through each other is not certified"
    if every_step and not survey.reader.rounding:
        return "verdict: no crossing; if vertices move straight in a step, none is possible"
    return "verdict: consistent with noncrossing between these frames; cannot be certified" + (
        ": they are not known to be of every step" if not every_step else ": positions are rounded")


def tell(lines):
    try:
        for line in lines:
            print(escape.shown(line))
        sys.stdout.flush()
    except BrokenPipeError:
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGPIPE)
    except OSError as error:
        raise Unwritten(f"standard output: cannot write: {error.strerror}") from None


def remove(table):
    """What was begun."""
    if table and table.file:
        with contextlib.suppress(OSError):
            os.remove(table.path)


def run(path, options):
    reader = table = None
    try:
        reader = readers.open_file(path, options)
        if "--links" in options:
            for name in {"--csv", "--every-step", "--page"} & set(options):
                raise Refused(f"{name} is of crossings between frames; --links looks at one frame")
            found = list(links.of_file(reader, options["--links"], options.get("--closure")))
            for text in reader.said:
                say(f"uncross: warning: {path}: {text}")
            tell(found)
            return DONE
        if "--closure" in options:
            raise Refused("--closure is of --links")
        page = Page(options["--page"]) if "--page" in options else None
        table = Table(options.get("--csv"))
        survey = Survey(path, reader, options, table)
        survey.look()
        every_step = survey.every_step(options)
        table.close()
        if page:
            page.write(page.make(survey, list(describe(survey)), verdict(survey, every_step), where))
        for text in reader.said:
            say(f"uncross: warning: {path}: {text}")
        tell([*describe(survey), *results(survey, every_step)])
        if survey.strides[1].touched and not survey.strides[1].crossings:
            say(f"uncross: warning: {path}: bonds touched: a contact that is no crossing, or a place that is too special to be told from one")
        return CROSSED if survey.strides[1].crossings else DONE
    except Refused as refused:
        code, text = BAD_INPUT, str(refused)
    except Unwritten as unwritten:
        code, text = NOT_WRITTEN, str(unwritten)
    except (own.Ended, crossings.Ended) as ended:
        code = ended.args[0]
        code, text = (code, "") if code > 0 else (TROUBLE, f"{path}: the program that reads it ended early")
    except OSError as error:
        code, text = BAD_INPUT, f"{error.filename or path}: {error.strerror or error}"
    except BaseException:
        remove(table)
        raise
    finally:
        if reader:
            reader.close()
    remove(table)
    if text:
        say(f"uncross: {text}")
    return code


def main(words):
    found, paths = getopt.gnu_getopt(words, "", ["bonds=", "chain=", "ring=", "every-step", "csv=", "page=", "links=", "closure=", "quiet"])
    signal.signal(signal.SIGTERM, lambda number, _: sys.exit(128 + number))
    return run(paths[0], dict(found))
