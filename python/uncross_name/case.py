"""What uncross writes of a difference (src/oracle/name.h), as evidence."""
import dataclasses

import h5py
from uncross_port import operators, pack

from . import evidence


@dataclasses.dataclass
class Case:
    """first: evidence of the table that differs first; others: of the operator's other outputs; inputs: {step: in-tables};
    model: tables, too. All are as the port's operators want them. elsewhere: cases of the pack's other operators, those with
    few values first."""

    operator: str
    first: evidence.Evidence
    others: list
    inputs: dict
    model: dict
    single: bool
    elsewhere: list = dataclasses.field(default_factory=list)

    @property
    def tables(self):
        return [self.first, *self.others]


def _table(operator, group, name, of=None):
    """Names of columns, and a table; in the order in which the port has those of the table `of`. A pack may come from anywhere:
    columns that the port does not know stay as they are."""
    data = group[name]
    names = data.attrs["components"]
    names = (names.decode() if isinstance(names, bytes) else names).split(" ")
    known, values = pack.columns(operator, of or name).split(), data[:]
    if sorted(known) == sorted(names):
        names, values = known, values[:, [names.index(word) for word in known]]
    values.flags.writeable = False  # a mistake may write anywhere
    return names, values


def _evidence(operator, table, columns, steps, model):
    kind, parts, values, first = table.partition(".")[2], [], [], 0
    for step, tables in steps.items():
        if f"theirs.{kind}" not in tables or table not in tables:
            continue
        arrays = [tables[name] for name in (table, f"theirs.{kind}", f"tolerance.{kind}")]
        rows = min(len(arrays[0]), len(arrays[1]))
        seen = {name: values for name, values in tables.items() if name.split(".")[0] in ("in", "out", "bound")}
        parts.append(evidence.Part(step, first, rows, len(arrays[0]), len(arrays[1]), seen, model, arrays[1], columns, tables))
        values.append(arrays)
        first += rows
    return evidence.Evidence(operator, table, columns[table], parts, values) if parts else None


def _case(operator, steps, columns, model, first, single):
    outputs = sorted({name for tables in steps.values() for name in tables if name.startswith("out.")} - {first})
    others = [found for found in (_evidence(operator, table, columns, steps, model) for table in outputs) if found]
    inputs = {step: operators.inputs(tables) for step, tables in steps.items()}
    mine = _evidence(operator, first, columns, steps, model) if first else others.pop(0) if others else None
    return mine and Case(operator, mine, others, inputs, operators.inputs(model), single)


def read(path):
    places, columns, model, first, single, named = {}, {}, {}, None, False, None
    with h5py.File(path) as file:
        for place in file:
            operator, step = place.rsplit(".", 1)
            group = file[place]
            tables = model if operator == "model" else places.setdefault(operator, {}).setdefault(int(step), {})
            for name in group:
                kind, _, word = name.partition(".")
                if kind == "first":
                    first, single, named = f"out.{word}", bool(group[name][0, 1]), operator
                else:
                    known = columns.setdefault(operator, {})
                    known[name], tables[name] = _table(operator, group, name, f"out.{word}" if kind in ("theirs", "tolerance") else name)
    places = {operator: dict(sorted(steps.items())) for operator, steps in places.items()}
    case = _case(named, places.pop(named), columns[named], model, first, single)
    every = [_case(operator, steps, columns[operator], model, None, single) for operator, steps in places.items() if operator in operators.OPERATORS]
    case.elsewhere = sorted((other for other in every if other), key=lambda other: sum(found.ours.size for found in other.tables))
    return case
