"""Where the packages of uncross's programs in Python stand: in the source tree, or where `make install` puts them. A package that is
missing is told in one line."""
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / part) for part in ("python", "ports/numpy", "../lib/python3/dist-packages", "../share/uncross/ports/numpy")]


def lacks(missing):
    """What to say of a ModuleNotFoundError: Debian's names are Python's, with one of uncross for all its own."""
    package = "uncross" if missing.name.startswith("uncross") else missing.name.split(".")[0].lower()
    return f"the Python package {missing.name} is missing; `apt-get install python3-{package}` installs it"


def tell(kind, error, trace):
    if kind is ModuleNotFoundError:
        print(f"uncross: {pathlib.Path(sys.argv[0]).name.removeprefix('uncross-')}: {lacks(error)}", file=sys.stderr)
    else:
        sys.__excepthook__(kind, error, trace)


sys.excepthook = tell
