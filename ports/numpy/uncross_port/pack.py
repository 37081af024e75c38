"""Packs in and out, as HDF5 or text (docs/port/formats.md, "Formats").

A pack is {(operator, step): {table: array of [rows, columns]}}; names of tables begin with `in.` or `out.`.
"""

import json
from pathlib import Path

import h5py
import numpy as np

# Columns of tables by operator and name. tools/document-oracle writes the file, from the table of operators of uncross.
SCHEMA = json.loads(Path(__file__).with_name("schema.json").read_text(encoding="ascii"))
COLUMNS = {(operator["name"], table["name"]): " ".join(table["columns"]) for operator in SCHEMA["operators"] for table in operator["tables"]}
LARGEST = dict(zip(COLUMNS["start", "in.switches"].split(), (2, 2, 1, 2, 3, 2, 1, 2, 1, 3, 1, 1)))  # values of switches that this port knows


class Tables(dict):
    """Tables of one operator by name. The text form has no lines for a table without rows, so a missing one is empty."""

    def __missing__(self, name):
        return np.zeros((0, 3), np.int64)


def columns(operator, name):
    """Names of the columns of a table, in the order in which this port has them. An operator without other inputs has a table `in.step`."""
    return COLUMNS.get((operator, name)) or ("step" if name == "in.step" else "x y z")


def refuse_unknown(switches):
    """{name: value}: what this port does not know is other physics. A start of version 1 has none."""
    for name, value in switches.items():
        if not 0 <= value <= LARGEST.get(name, 0):
            raise SystemExit(f"port: this port does not know the switch {name} with the value {value}")


def read(path):
    return read_hdf5(path) if h5py.is_hdf5(path) else read_text(path)


def read_hdf5(path):
    pack = {}
    with h5py.File(path) as file:
        for group in file:
            operator, step = group.rsplit(".", 1)
            pack[operator, int(step)] = {name: ordered(operator, name, file[group][name]) for name in file[group]}
    return pack


def ordered(operator, name, data):
    """The columns of a dataset in our order."""
    names = data.attrs["components"]
    names = (names.decode() if isinstance(names, bytes) else names).split()
    if name == "in.switches":
        refuse_unknown(dict(zip(names, data[0])))
    return data[:][:, [names.index(word) for word in columns(operator, name).split()]]


def number(text):
    if "0x" in text:
        return float.fromhex(text)
    return float(text) if any(letter in text for letter in ".en") else int(text)


def read_text(path):
    """Lines may have any order, and whole reals no point."""
    values = {}
    with open(path, encoding="ascii") as file:
        for line in file:
            if line.startswith("#"):
                continue
            operator, step, row, column, value = line.split()
            table, component = column.rsplit(".", 1)
            rows = values.setdefault((operator, int(step)), {}).setdefault(table, {})
            rows.setdefault(int(row), {})[component] = number(value)
    pack = {}
    for group, tables in values.items():
        pack[group] = {}
        for table, rows in tables.items():
            names = columns(group[0], table).split()
            if table == "in.switches":
                refuse_unknown(rows[0])
            pack[group][table] = np.array([[rows[row][name] for name in names] for row in range(len(rows))])
    return pack


def write(path, pack):
    (write_text if str(path).endswith(".txt") else write_hdf5)(path, pack)


def write_hdf5(path, pack):
    with h5py.File(path, "w") as file:
        file.attrs["format"] = np.bytes_("uncross pack")
        file.attrs["version"] = np.int32(2)
        for (operator, step), tables in pack.items():
            group = file.create_group(f"{operator}.{step}")
            for table, values in tables.items():
                data = group.create_dataset(table, data=values)
                data.attrs["components"] = np.bytes_(columns(operator, table))


def write_text(path, pack):
    with open(path, "w", encoding="ascii") as file:
        for (operator, step), tables in pack.items():
            for table, values in tables.items():
                for row, line in enumerate(values.tolist()):
                    for name, value in zip(columns(operator, table).split(), line):
                        text = value.hex() if isinstance(value, float) else str(value)
                        file.write(f"{operator} {step} {row} {table}.{name} {text}\n")
