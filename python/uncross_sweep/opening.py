"""The one way in which programs in Python open files that may be anything: uncross_plot and the campaign use it too.

Reading: regular files only, so that no pipe is waited for. Writing: never through a link, never into what is no regular
file, never over a file that was not looked at."""
import contextlib
import errno
import os
import stat


class NoFile(OSError):
    """What is there is no regular file."""

    def __str__(self):
        return f"{self.filename}: {self.strerror}"


def _regular(fd, path):
    if not stat.S_ISREG(os.fstat(fd).st_mode):
        os.close(fd)
        raise NoFile(errno.EINVAL, "not a file but a folder, a pipe or a device", str(path))
    return fd


def reading(path, flags):
    """An `opener` of open: `open(path, opener=reading)`."""
    return _regular(os.open(path, flags | os.O_NONBLOCK | os.O_CLOEXEC | os.O_NOCTTY), path)


def writing(path, flags):
    """The same. A file that is there is emptied (mode "w") only once it is known to be one."""
    try:
        fd = os.open(path, flags & ~os.O_TRUNC | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC | os.O_NOCTTY, 0o666)
    except OSError as error:  # a link; a pipe that nobody reads
        if error.errno in (errno.ELOOP, errno.ENXIO):
            raise NoFile(errno.EINVAL, "is a link, a folder, a pipe or a device; nothing is written there", str(path)) from None
        raise
    _regular(fd, path)
    if flags & os.O_TRUNC:
        os.ftruncate(fd, 0)
    return fd


MOST_JSON = 16 << 20  # bytes; RECORD_MOST_BYTES of src/files/record.h


def read_text(path, most=None):
    """most: bytes; a larger file is refused before memory is taken for it."""
    with open(path, encoding="utf-8", opener=reading) as file:
        if most is not None and os.fstat(file.fileno()).st_size > most:
            raise ValueError(f"larger than {most} bytes")
        return file.read()


MOST_LINE = 65535  # characters of a line of a table; TEXT_LONGEST_LINE of src/base/text.h


def read_table(path):
    """The text of a table. A line that is longer than any that a run writes is refused before it is in memory: a file of one
    line, or of holes."""
    lines = []
    with open(path, encoding="utf-8", newline="", opener=reading) as file:
        while line := file.readline(MOST_LINE + 1):
            if len(line) > MOST_LINE:
                raise ValueError(f"line {len(lines) + 1} has more than {MOST_LINE} characters")
            lines.append(line)
    return "".join(lines)


def _look(path):
    """Nothing is put in the place of what is no file."""
    with contextlib.suppress(FileNotFoundError):
        if not stat.S_ISREG(os.lstat(path).st_mode):
            raise NoFile(errno.EINVAL, "is a link, a folder, a pipe or a device; nothing is written there", str(path))


def write_text(path, text):
    """In place of an earlier file, at once. It is made beside that, as PATH.part."""
    aside = path.with_name(path.name + ".part")
    _look(aside)
    _look(path)
    aside.unlink(missing_ok=True)  # a program that was killed left it
    with open(aside, "x", encoding="utf-8", opener=writing) as file:
        file.write(text)
    aside.replace(path)
