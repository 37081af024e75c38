"""run.json, as a run or somebody else has written it: what programs in Python read of it is what they expect, or it is refused.

One table says what a key may hold. Keys that are not in it may hold anything, and are shown as text. null is the same as no key.
"""
import json
import math

from .opening import MOST_JSON, read_text

MOST_COUNT = 2**64 - 1
NAMES = {type(None): "null", bool: "true or false", int: "a number", float: "a number", str: "text", list: "a list", dict: "a mapping"}


class Foreign(ValueError):
    """No run.json; the message begins with the file."""


def _is_text(value):
    return isinstance(value, str) and not any("\ud800" <= letter <= "\udfff" for letter in value)


def _is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e300 and math.isfinite(value)


def _is_count(value):
    return isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= MOST_COUNT


TEXT, NUMBER = (_is_text, "text"), (_is_number, "a number")
COUNT = (_is_count, "a whole number from 0 on")
SEED = (lambda value: _is_text(value) or _is_count(value), "a whole number, or its digits as text")  # JSON's numbers have too few bits
KEYS = {
    "status": TEXT, "reason": TEXT, "program": TEXT, "version": TEXT, "commit": TEXT, "compiler": TEXT, "flags": TEXT,
    "seed": SEED, "stream": TEXT, "stream_from": {"stream": TEXT, "step": COUNT, "state": TEXT}, "scene_fingerprint": TEXT,
    "steps": COUNT, "steps_wanted": COUNT, "time": NUMBER, "wall_seconds": NUMBER, "steps_per_second": NUMBER,
    "collisions": {name: COUNT for name in ("moves", "possible", "executed", "negative", "softened", "rigid")},
    "warnings": [TEXT], "start": {"energy": NUMBER, "momentum": [NUMBER]}, "end": {"energy": NUMBER, "momentum": [NUMBER]},
    "state_hash": TEXT, "state_digest": TEXT, "scene": TEXT,
}


def _refuse(path, value, needed):
    raise Foreign(f"{f'{path!r} is' if path else 'is'} {NAMES[type(value)]}; {needed} is needed")


def _checked(value, kind, path=""):
    """The value without what is null."""
    if isinstance(kind, dict):
        if not isinstance(value, dict):
            _refuse(path, value, "a mapping")
        above = f"{path}." if path else ""
        return {key: _checked(v, kind[key], above + key) if key in kind else v for key, v in value.items() if v is not None}
    if isinstance(kind, list):
        if not isinstance(value, list):
            _refuse(path, value, "a list")
        return [_checked(v, kind[0], f"{path}.{k}") for k, v in enumerate(value)]
    fits, needed = kind
    if not fits(value):
        if NAMES[type(value)] == needed:
            raise Foreign(f"{path!r} is {needed} that cannot be used: not finite, or not Unicode")
        _refuse(path, value, needed)
    return value


def _no_number(word):
    raise ValueError(f"{word} is no number of JSON")


def read(path, text=None):
    """A record, a dict of which KEYS are as they should be. Foreign if the file is none; OSError if it cannot be read."""
    try:
        return _checked(json.loads(read_text(path, MOST_JSON) if text is None else text, parse_constant=_no_number), KEYS)
    except RecursionError as error:
        raise Foreign(f"{path}: lists within lists without end") from error
    except ValueError as error:
        raise Foreign(f"{path}: {' '.join(str(error).split())}") from error
