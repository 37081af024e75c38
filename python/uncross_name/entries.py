"""The catalogue of mistakes, as it is written: mistakes/*.yaml, a file for each room of src/. docs/extending.md says what the keys are."""
import pathlib

import yaml

WORDS = {"name", "text", "says", "twins", "with", "why", "rank"}
PARTS = {"numpy": {"file", "line", "replacement", "also", "at", "pack", "trace", "exit", "operators"},
         "c": {"name", "file", "old", "new", "tests", "claims", "needs"}, "python": {"name", "file", "old", "new", "tests"}}
MUST = {"numpy": {"file", "line", "replacement", "at"}, "c": {"file", "old", "new"}, "python": {"file", "old", "new", "tests"}}


class Trouble(Exception):
    """The catalogue cannot be read, or does not fit what it is planted in."""


def _check(entry, where):
    """Complains of keys that are unknown or missing."""
    if not isinstance(entry, dict) or not isinstance(entry.get("name"), str):
        raise Trouble(f"{where}: an entry has no name")
    where = f"{where}: '{entry['name']}'"
    unknown = entry.keys() - WORDS - PARTS.keys()
    if unknown or not entry.keys() & PARTS.keys():
        raise Trouble(f"{where}: {', '.join(sorted(unknown)) or 'no part'}; allowed: {', '.join(sorted(WORDS))}, and parts: numpy, c, python")
    for part, keys in PARTS.items():
        for one in [entry[part]] if part == "numpy" and part in entry else entry.get(part, []):
            wrong = (one.keys() - keys) | (MUST[part] - one.keys())
            if wrong:
                raise Trouble(f"{where}: {', '.join(sorted(wrong))} unknown or missing in {part}; allowed: {', '.join(sorted(keys))}")
    if not all(c.keys() & {"tests", "claims"} for c in entry.get("c", [])):
        raise Trouble(f"{where}: tests or claims missing in c: what sees it?")


def parse(text, where):
    """The entries of one file."""
    try:
        entries = yaml.load(text, yaml.CSafeLoader) or []
    except yaml.YAMLError as wrong:
        raise Trouble(f"{where}: {wrong}") from wrong
    for entry in entries:
        _check(entry, where)
    return entries


def read(folder):
    """All entries, file by file."""
    files = sorted(pathlib.Path(folder).glob("*.yaml"))
    if not files:
        raise Trouble(f"{folder}: there is no catalogue of mistakes")
    return [entry for file in files for entry in parse(file.read_text(encoding="utf-8"), file)]
