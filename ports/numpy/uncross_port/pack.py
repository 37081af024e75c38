"""Packs in and out, as HDF5 or text (docs/porting.md, "Formats").

A pack is {(operator, step): {table: array of [rows, columns]}}; names of tables begin with `in.` or `out.`.
"""

import h5py
import numpy as np

# Columns of our outputs; x y z where nothing is said.
COLUMNS = {
    "word": "0 1 2 3",
    "uniform": "0 1",
    "normal": "first second",
    "load": "members mass",
    "relative": "energy",
    "factor": "factor",
    "active": "active",
    "event": "vertex moving standing image_x image_y image_z executed",
    "hit": "time s s_standing normal_x normal_y normal_z momentum",
}
COLUMNS_AT = {("order", "order"): "vertex", ("swap", "order"): "particle"}
COLUMNS_AT |= {("bin", "solvent"): "cell", ("bin", "vertex"): "cell"}


class Tables(dict):
    """Tables of one operator by name. The text form has no lines for a table without rows, so a missing one is empty."""

    def __missing__(self, name):
        return np.zeros((0, 3), np.int64)


def columns(operator, name):
    return COLUMNS_AT.get((operator, name)) or COLUMNS.get(name, "x y z")


def read(path):
    return read_hdf5(path) if h5py.is_hdf5(path) else read_text(path)


def read_hdf5(path):
    pack = {}
    with h5py.File(path) as file:
        for group in file:
            operator, step = group.rsplit(".", 1)
            pack[operator, int(step)] = {name: file[group][name][:] for name in file[group]}
    return pack


def number(text):
    if "0x" in text:
        return float.fromhex(text)
    return float(text) if any(letter in text for letter in ".en") else int(text)


def read_text(path):
    """Columns in the order in which a table's names come first."""
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
            names = list(rows[0])
            pack[group][table] = np.array([[rows[row][name] for name in names] for row in range(len(rows))])
    return pack


def write(path, pack):
    (write_text if str(path).endswith(".txt") else write_hdf5)(path, pack)


def write_hdf5(path, pack):
    with h5py.File(path, "w") as file:
        file.attrs["format"] = np.bytes_("uncross pack")
        file.attrs["version"] = np.int32(1)
        for (operator, step), tables in pack.items():
            group = file.create_group(f"{operator}.{step}")
            for table, values in tables.items():
                data = group.create_dataset(table, data=values)
                data.attrs["components"] = np.bytes_(columns(operator, table.split(".")[1]))


def write_text(path, pack):
    with open(path, "w", encoding="ascii") as file:
        for (operator, step), tables in pack.items():
            for table, values in tables.items():
                for row, line in enumerate(values.tolist()):
                    for name, value in zip(columns(operator, table.split(".")[1]).split(), line):
                        text = value.hex() if isinstance(value, float) else str(value)
                        file.write(f"{operator} {step} {row} {table}.{name} {text}\n")
