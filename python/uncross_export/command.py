"""The command line. src/cli/options.c has looked at the options before."""
import contextlib
import getopt
import os
import signal
import sys

from uncross_sweep import escape

from . import formats, frames, view

DONE, TROUBLE, BAD_INPUT, NOT_WRITTEN = 0, 1, 2, 4


class Refused(Exception):
    """What was asked for cannot be had."""


def say(text):
    """To standard error, if there is one that takes it."""
    with contextlib.suppress(OSError):
        if sys.stderr:
            print(text, file=sys.stderr)


def choose(path, file, options):
    """Numbers of the frames that are asked for."""
    first, stride = int(options.get("--first", 0)), int(options.get("--stride", 1))
    last = int(options.get("--last", 2**64 - 1))
    if first > last:
        raise Refused(f"{path}: no frames: the first asked for is {first}, the last {last}")
    if first >= file.frames:
        raise Refused(f"{path}: first frame {first} asked for; it has frames 0 to {max(file.frames - 1, 0)} ({file.frames} in all)")
    return range(first, min(last + 1, file.frames), stride)


def texts(path, file, form, options):
    """All that is printed, piece by piece."""
    chosen, begun = choose(path, file, options), False
    v = view.View(path, file, "--solvent" in options, form.folds or "--wrapped" in options)
    if form.allows:
        form.allows(v)
    for number in chosen[-1:] if form.one else chosen:
        try:
            v.frame = file.read(number)
        except frames.Damaged as error:
            if "--skip-damaged" not in options:
                raise
            say(f"uncross: left out: {error}")
            continue
        if form.begin and not begun:
            yield from form.begin(v)
        begun = True
        yield from form.frame(v)
    if form.one and not begun:
        raise Refused(f"{path}: frame {chosen[-1]} is damaged, and {form.title} hold one frame; choose another with --last")


def export(path, out, options):
    form = formats.FORMATS.get(options.get("--format", "xyz"))
    if not form:
        raise Refused(f"--format {options['--format']}: no such format; there are {', '.join(formats.FORMATS)}")
    try:
        file = frames.File(path)
    except OSError as error:
        say(f"uncross: export: cannot start the program that reads {escape.shown(path)}: {error.strerror}")
        raise frames.Ended(TROUBLE) from None
    with contextlib.closing(file):
        try:
            for text in texts(path, file, form, options):
                out.write(text)
            out.flush()
        except ValueError as error:
            raise Refused(f"{path}: {error}") from None
        except BrokenPipeError:
            raise
        except OSError as error:
            say(f"uncross: {escape.shown(path)}: {form.title} could not be written: {error.strerror}")
            raise frames.Ended(NOT_WRITTEN) from None


def end_by_pipe():
    """As a program in C ends whose reader has read enough."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    os.kill(os.getpid(), signal.SIGPIPE)


def run(path, name, options):
    """The exit code. name: of the file to be written, None for standard output."""
    try:
        out = open(name or 1, "x" if name else "w", encoding="utf-8", closefd=bool(name))
    except OSError as error:
        say(f"uncross: {escape.shown(name)}: cannot create: {error.strerror}")
        return BAD_INPUT if isinstance(error, FileExistsError) else NOT_WRITTEN
    done = False
    try:
        export(path, out, options)
        out.close()
        done = True
    except (Refused, frames.Damaged) as error:
        say(f"uncross: {escape.shown(error)}")
        return BAD_INPUT
    except frames.Ended as ended:
        if ended.args[0] > 0:
            return ended.args[0]
        say(f"uncross: {escape.shown(path)}: the program that reads it ended early")
        return TROUBLE
    except OSError as error:
        if isinstance(error, BrokenPipeError) and not name:
            end_by_pipe()
        say(f"uncross: {escape.shown(name or 'standard output')}: cannot write: {error.strerror}")
        return NOT_WRITTEN
    finally:
        if name and not done:
            os.remove(name)
    return DONE


def main(words):
    found, paths = getopt.gnu_getopt(words, "o:", ["out=", "format=", "solvent", "wrapped", "first=", "last=", "stride=", "skip-damaged"])
    names = [value for option, value in found if option in ("-o", "--out")]
    for number in signal.SIGTERM, signal.SIGHUP:
        signal.signal(number, lambda number, _: sys.exit(128 + number))  # what was begun is removed
    return run(paths[0], names[-1] if names else None, dict(found))
