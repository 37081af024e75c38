"""Only the version: the rest is in pyproject.toml."""
import pathlib
import re

import setuptools

HEADER = pathlib.Path(__file__).resolve().parents[1] / "src/version.h"
setuptools.setup(version=re.search(r'UNCROSS_VERSION "(.*)"', HEADER.read_text(encoding="ascii"))[1])
