"""Packs in and out, as HDF5 or text (docs/port/formats.md, "Formats").

A pack is {(operator, step): {table: array of [rows, columns]}}; names of tables begin with `in.` or `out.`.
"""

import h5py
import numpy as np

# Columns of tables, by name and by operator and name; x y z where nothing is said.
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
COLUMNS |= {
    "step": "step",  # of an operator without other inputs
    "time": "dt",
    "solvent_cell": "cell",
    "vertex_cell": "cell",
    "order": "vertex",
    "crosses": "crosses",
    "flip": "flip",
    "mass": "moving pivot a b",
    "contact": "s s_standing",
    "box": "x y z",
    "numbers": "seed_low seed_high particles interval forbidden exclusion_paper",
    "reals": "time_step cosine sine acceleration_x acceleration_y acceleration_z",
    "chain": "next prev fiber",
    "run": "steps scheme thermostat hydrodynamics",
    "counters": "step lag",
    "switches": "version crossing exclusion collision thermostat order swap boundary dumbbells medium repulsion thick",
    "tick": "tick",
    "tau": "tau",
    "answer": "answer",
    "rule": "event_driven",
    "collision": "rule",
    "boundary": "kind slip fill intervals early",
    "flow": "per_cell rate",
    "wave": "cosine",
    "interval": "interval",
    "half_steps": "half_steps",
    "flight": "lower_x lower_y lower_z upper_x upper_y upper_z",
    "end": "lower_x lower_y lower_z upper_x upper_y upper_z",
    "filled": "number x y z",
    "rate": "rate",
    "offset": "offset",
    "speed": "speed",
    "change": "rate",
    "dumbbells": "number",
    "spring": "spring frequency depth range",
    "begin": "offset",
    "second": "xx yy zz yz zx xy",
    "medium": "kind draw weight tensor second",
    "pair": "first second",
    "crowd": "crowd",
    "tensor": "entry",
    "root": "entry",
}
COLUMNS_AT = {
    ("swap", "out.order"): "particle",
    ("permutation", "out.order"): "entry",
    ("bin", "out.solvent"): "cell",
    ("bin", "out.vertex"): "cell",
    ("wall_bin", "out.solvent"): "cell",
    ("crossing", "out.hit"): "time s s_standing normal_x normal_y normal_z",
    ("exchange", "out.momentum"): "momentum",
    ("exchange", "in.normal"): "x y z",
    ("random", "in.address"): "purpose draw step entity",
    ("permutation", "in.address"): "purpose draw step size",
    ("contact_search", "in.from"): "tick",
    ("tube_search", "in.from"): "tick",
    ("tube_search", "in.reach"): "reach",
    ("tube_contact", "out.contact"): "s t",
    ("tube_contact", "out.normal"): "x y z",
    ("bead_search", "in.from"): "tick",
    ("bead_search", "in.reach"): "reach",
    ("bead_contact", "out.contact"): "s t",
    ("bead_contact", "out.normal"): "x y z",
    ("model", "in.tubes"): "radius blind",
    ("impulse", "in.normal"): "x y z",
    ("impulse", "in.mass"): "p0 p1 q0 q1",
    ("impulse", "in.contact"): "s t",
    ("impulse", "out.momentum"): "momentum",
    ("pairs", "out.bath"): "loss noise",
    ("pair_bath", "in.bath"): "loss noise",
    ("model", "in.bath"): "rate radius repulsion between many_body many_body_range flow_x flow_y flow_z",
    ("model", "in.vertex"): "mass bond_length spring bending force_x force_y force_z",
}
for drift in ("event_drift", "long_event_drift"):
    COLUMNS_AT[drift, "in.time"] = "dt start"
    COLUMNS_AT[drift, "out.event"] = "bond other image_x image_y image_z tick"
    COLUMNS_AT[drift, "out.hit"] = "s t normal_x normal_y normal_z momentum"


LARGEST = dict(zip(COLUMNS["switches"].split(), (2, 2, 1, 2, 3, 2, 1, 2, 1, 3, 1, 1)))  # values of switches that this port knows


class Tables(dict):
    """Tables of one operator by name. The text form has no lines for a table without rows, so a missing one is empty."""

    def __missing__(self, name):
        return np.zeros((0, 3), np.int64)


def columns(operator, name):
    """Names of the columns of a table, `in.` or `out.`, in the order in which this port has them."""
    if name.startswith("bound."):
        return "condition"
    return COLUMNS_AT.get((operator, name)) or COLUMNS.get(name.partition(".")[2], "x y z")


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
