"""libuncross, loaded with the declarations of its own header."""
import os
import pathlib
import re

try:
    import cffi
    import numpy as np
except ModuleNotFoundError as missing:
    raise ModuleNotFoundError(f"uncross needs {missing.name}: install python3-{missing.name} (Debian, Ubuntu), or `pip install {missing.name}`",
                              name=missing.name) from None

HERE = pathlib.Path(__file__).resolve().parent


def declarations(header):
    """What cffi wants of a header: no comments, no lines of the preprocessor, no C++."""
    text = re.sub(r"/\*.*?\*/", "", header, flags=re.S)
    text = re.sub(r"#ifdef __cplusplus.*?#endif", "", text, flags=re.S)
    return re.sub(r"^[ \t]*#.*$|\bUNCROSS_API\b", "", text, flags=re.M)


def open_library(ffi, name):
    """$UNCROSS_LIBRARY; or the first that can be loaded of the libraries of the prefix that this package is installed in, whatever its
    LIBDIR, and the system's."""
    chosen = os.environ.get("UNCROSS_LIBRARY")
    installed = HERE.parent.name in ("dist-packages", "site-packages")  # PREFIX/lib/python3.N/site-packages/uncross
    beside = [str(path) for below in ("lib*", "lib*/*") if installed for path in sorted(HERE.parents[3].glob(f"{below}/{name}"))]
    for place in [chosen] if chosen else [*beside, name]:
        try:
            return ffi.dlopen(place)
        except OSError as error:
            why = error
    raise ImportError(f"uncross needs the library {name}, which `make install` or the package lib{name[3:].replace('.so.', '')} installs; "
                      f"UNCROSS_LIBRARY may name it ({why})")


HEADER = (HERE / "uncross.h").read_text(encoding="ascii")
INTERFACE = int(re.search(r"^#define UNCROSS_INTERFACE (\d+)$", HEADER, re.M)[1])
AGE = int(re.search(r"^#define UNCROSS_INTERFACE_AGE (\d+)$", HEADER, re.M)[1])

ffi = cffi.FFI()
ffi.cdef(declarations(HEADER))
lib = open_library(ffi, f"libuncross.so.{INTERFACE}")
if lib.uncross_interface() != INTERFACE or lib.uncross_interface_age() < AGE:
    raise ImportError(f"libuncross has interface {lib.uncross_interface()}.{lib.uncross_interface_age()}, "
                      f"this package needs {INTERFACE}.{AGE}")
