"""Variants of a run.json as somebody else may have written it: keys that are missing or of another type, numbers that are none,
damaged text. tests/tools/test_records.py takes some hundred of them, tests/stress/stress_records.py a million."""
import json

DEEP = "[" * 3000 + "]" * 3000
# JSON, or what passes for it
VALUES = ("null", "true", "false", "0", "-1", "7", "0.5", "-0.0", "1e308", "1e400", "-1e400", "NaN", "Infinity", "1" + "0" * 30, "9" * 6000,
          '""', '"x"', '"finished"', '"1"', r'"\ud800"', r'"\u0000"', r'"a\nb\u001b[2J"', '"<script>alert(1)</script>"', '"' + "y" * 100000 + '"',
          "[]", "[1]", "[null]", '["x", 2]', "[[[[]]]]", DEEP, "{}", '{"energy": "x"}', '{"energy": null}', '{"executed": []}', '{"executed": -3}',
          '{"rigid": "5"}', '{"momentum": [1, 2]}', '"start: {snapshot: x}\\nbox: [1, 1, 1]"', '"observe:\\n  from: ' + "9" * 400 + '"')


def paths(record, above=()):
    """Of all values of a record: keys and places."""
    found = [above] if above else []
    parts = record.items() if isinstance(record, dict) else enumerate(record) if isinstance(record, list) else ()
    for key, value in parts:
        found += paths(value, (*above, key))
    return found


def _text(value):
    """JSON; a value that is a string of VALUES stands as it is."""
    if isinstance(value, _Raw):
        return str(value)
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)}: {_text(v)}" for key, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_text, value)) + "]"
    return json.dumps(value)


class _Raw(str):
    pass


def changed(value, path, new):
    """The record with another value at this path; without it if new is None."""
    if not path:
        return new
    key, rest = path[0], path[1:]
    if isinstance(value, dict):
        made = {k: changed(v, rest, new) if k == key else v for k, v in value.items()}
        return made if new is not None or rest else {k: v for k, v in made.items() if k != key}
    return [changed(v, rest, new) if k == key else v for k, v in enumerate(value) if new is not None or rest or k != key]


def variants(record, random, count):
    """[bytes] of `count` variants. random: of NumPy or of Python, seeded; it needs randrange."""
    where = paths(record)
    text = json.dumps(record).encode()
    for number in range(count):
        kind = random.randrange(8)
        if kind == 0:  # damaged bytes
            at = random.randrange(len(text))
            yield text[:at] + bytes([random.randrange(256)]) + text[at + random.randrange(2):]
        elif kind == 1:
            yield text[:random.randrange(len(text))]
        elif kind == 2 and number % 16 == 0:  # another thing altogether
            yield VALUES[random.randrange(len(VALUES))].encode("utf-8", "surrogatepass")
        else:
            made = record
            for _ in range(1 + random.randrange(2)):
                path = where[random.randrange(len(where))]
                new = None if random.randrange(4) == 0 else _Raw(VALUES[random.randrange(len(VALUES))])
                try:
                    made = changed(made, path, new)
                except (AttributeError, TypeError):  # the first change took away what the second is about
                    pass
            yield _text(made).encode()
