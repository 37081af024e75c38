"""The mistakes that the port to NumPy can have: each is lines of it and what stands there instead; and the port with one in it."""
import dataclasses
import functools
import inspect
import itertools
import pathlib
import sys
import types

import uncross_port
from uncross_port import operators

from . import entries
from .entries import Trouble

PORT = pathlib.Path(uncross_port.__file__).resolve().parent
FOLDER = PORT.parents[2] / "mistakes"
# Modules in the order in which they import each other.
MODULES = ("elementary", "random", "lattice", "pack", "solvent", "flow", "dumbbells", "media", "model", "fiber", "sweep", "tubes",
           "events", "topology", "operators", "step")


MODEL = "from_tables"  # functions that every operator uses


@dataclasses.dataclass(frozen=True)
class Mistake:
    """name: what is wrong; text: how it is told; changes: (file, line, replacement); at: where it is first seen; entry: all
    that the catalogue says of it."""

    name: str
    text: str
    changes: tuple
    at: str
    entry: dict = dataclasses.field(hash=False, compare=False)


RIGHT = Mistake("", "", (), "", {})  # none


def _filled(value, numbers):
    """Texts with {n} replaced by the number of n."""
    if isinstance(value, str):
        for name, number in numbers.items():
            value = value.replace(f"{{{name}}}", str(number))
    if isinstance(value, list):
        value = [_filled(each, numbers) for each in value]
    if isinstance(value, dict):
        value = {key: _filled(each, numbers) for key, each in value.items()}
    return value


def members(entry):
    """The entry; of a family, one for each of its numbers."""
    family = entry.get("with", {})
    for numbers in itertools.product(*family.values()):
        yield _filled({key: value for key, value in entry.items() if key not in ("with", "c", "numpy", "python")}, dict(zip(family, numbers)))


def _mistake(entry):
    places = [entry, *entry.get("also", [])]
    changes = tuple((place["file"], place["line"], place["replacement"]) for place in places)
    return Mistake(entry["name"], entry.get("text", entry["name"]), changes, entry["at"], entry)


def read(folder=FOLDER):
    """All mistakes that the port to NumPy can have; families are members one by one."""
    ours = [{**entry, **entry["numpy"]} for entry in entries.read(folder) if "numpy" in entry]
    return [_mistake(member) for entry in ours for member in members(entry)]


# --- the port with a mistake in it ---


@functools.cache
def _lines(file):
    return (PORT / file).read_text(encoding="utf-8").splitlines()


@functools.cache
def _code(file):
    return compile("\n".join(_lines(file)) + "\n", str(PORT / file), "exec")


@functools.cache
def line_number(file, line):
    """Counted from 0."""
    found = [number for number, text in enumerate(_lines(file)) if text.strip() == line]
    if len(found) != 1:
        raise Trouble(f"{len(found)} lines of {file} are that; there must be one: {line}")
    return found[0]


def _broken_code(file, changes):
    lines = list(_lines(file))
    for line, replacement in changes:
        number = line_number(file, line)
        lines[number] = lines[number][: -len(line)] + replacement
    return compile("\n".join(lines) + "\n", str(PORT / file), "exec")


def plant(mistake):
    """A copy of the port's modules with the mistake in it, {name: module}; those of this process stay as they are."""
    package = types.ModuleType("broken_port")
    package.__path__ = []
    modules = {"broken_port": package}
    sys.modules["broken_port"] = package
    for name in MODULES:
        file = f"{name}.py"
        changes = [(line, replacement) for where, line, replacement in mistake.changes if where == file]
        module = types.ModuleType(f"broken_port.{name}")
        module.__package__, module.__file__ = "broken_port", str(PORT / file)
        sys.modules[module.__name__] = modules[name] = module
        setattr(package, name, module)
        exec(_broken_code(file, changes) if changes else _code(file), module.__dict__)  # pylint: disable=exec-used
    return modules


# --- what an operator uses ---


def _codes(code):
    """A code object and all that are defined in it."""
    yield code
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from _codes(constant)


@functools.cache
def _functions():
    """{name: [code]} of all functions, methods and classes of the port."""
    found = {}
    for module in MODULES:
        for code in _code(f"{module}.py").co_consts:
            if isinstance(code, types.CodeType):
                for inner in _codes(code):
                    found.setdefault(inner.co_name, []).append(inner)
    return found


@functools.cache
def _uses(operator):
    """Names that an operator's function, and all functions that it may call, use; and the identities of those functions."""
    function = operators.OPERATORS[operator]
    wrapped = [cell.cell_contents for cell in function.__closure__ or ()]
    names, codes, new = set(), {}, {function.__name__, *(inner.__name__ for inner in wrapped if callable(inner))}
    while new:
        names |= new
        found = {id(inner): inner for name in new for code in _functions().get(name, []) for inner in _codes(code) if id(inner) not in codes}
        codes |= found
        new = {name for code in found.values() for name in code.co_names} - names
    return names, codes


@functools.cache
def _spans(file):
    """(first line, last line, identity) of all functions and methods of a file; of one that makes the model, a name for identity."""
    tops = [code for code in _code(file).co_consts if isinstance(code, types.CodeType)]
    found = [code for top in tops for code in _codes(top) if code.co_flags & inspect.CO_OPTIMIZED]
    lines = [[line for _, _, line in code.co_lines() if line] for code in found]
    return [(min(some), max(some), MODEL if code.co_name == MODEL else id(code)) for some, code in zip(lines, found)]


def _functions_around(file, number):
    """The functions that a line is in; none around a line of a module or of a class."""
    return [code for first, last, code in _spans(file) if first <= number + 1 <= last]


def reaches(mistake, operator):
    """Whether the operator may come out otherwise with this mistake."""
    names, codes = _uses(operator)
    for file, line, _ in mistake.changes:
        around = _functions_around(file, line_number(file, line))
        if any(code == MODEL or code in codes for code in around) or (not around and line.split()[0].rstrip(":,") in names):
            return True
    return False


def is_at(mistake, operator):
    """Whether the mistake is first seen at this operator, or at one that is the same function."""
    return operators.OPERATORS.get(mistake.at) is operators.OPERATORS[operator]
