"""Docstrings are plain text: names stay as they are written, an indented paragraph is code."""
import re


def rewrite(_app, _what, _name, _object, _options, lines):
    plain, code = [], False
    for line in lines:
        if line.startswith("    "):
            if not code:
                plain += ["", ".. code-block:: python", ""]
            code = True
        elif line.strip():
            if code:
                plain.append("")
            code = False
            line = re.sub(r"([*|\\])", r"\\\1", line)
            line = re.sub(r"`([^`]+)`", r"``\1``", line)
            line = re.sub(r"\b(\w*_)(?!\w)", r"\1\\", line)
        plain.append(line)
    lines[:] = plain


def setup(app):
    app.connect("autodoc-process-docstring", rewrite)
    return {"parallel_read_safe": True}
