"""What the surroundings of a program do not decide: whether somebody listens, and which warnings of packages are errors."""
import contextlib
import sys
import warnings


class Said:
    """Standard error. What cannot be said, as of a daemon whose descriptors are closed, or on a full disk, ends no work."""

    def __init__(self, stream):
        self.stream = stream

    def write(self, text):
        with contextlib.suppress(OSError, ValueError):
            if self.stream is not None:
                self.stream.write(text)
        return len(text)

    def flush(self):
        with contextlib.suppress(OSError, ValueError):
            if self.stream is not None:
                self.stream.flush()

    def isatty(self):
        return self.stream is not None and self.stream.isatty()


def keep_out():
    """At the begin of a program. Warnings of packages are for those who write it; its tests make them errors."""
    sys.stderr = Said(sys.stderr)
    warnings.resetwarnings()
    warnings.simplefilter("ignore")
