"""Tables of bench.json and peers.json, for the documents: between <!-- bench: NAME --> and <!-- end of NAME -->."""
import math
import re

import common
from efficiency import DIFFUSIONS, ESTIMATORS, VISCOSITIES
from precision import ORDERS, SPLIT, STEPS
from scaling import FIBERS, LENGTHS
from scenes import ROWS
from speed import BOXES, SWEEP_DENSITIES


def number(value, digits=3):
    """A value to so many significant digits, without an exponent if it can be read without."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g}"
    power = math.floor(math.log10(abs(value)))
    if power < -4:
        mantissa = f"{value / 10.0**power:.{digits - 1}f}"
        return mantissa + "·10" + "".join("⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".index(c)] for c in str(power))
    return f"{value:.{max(0, digits - 1 - power)}f}"


def with_error(row):
    """Value ± spread, both to the spread's first digit, or its second if the first is 1; small ones in millionths."""
    if row is None:
        return ""
    value, error = row["value"], row["spread"]
    if not error or error < 1e-9 * abs(value):  # none, or rounding
        return number(value)
    if abs(value) < 1e-3:
        return f"({with_places(1e6 * value, 1e6 * error)})·10⁻⁶"
    return with_places(value, error)


def with_places(value, error):
    power = math.floor(math.log10(error))
    places = max(0, 1 - power if error < 2 * 10.0**power else -power)
    return f"{value:.{places}f} ± {error:.{places}f}".replace("-", "−")


def table(head, lines):
    rows = [head, ["---"] * len(head), *lines]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in rows)


def wanted(rows):
    """The figures that speed is held against."""
    solvent = [rows[f"speed/solvent {edge}^3"]["value"] for edge in BOXES]
    lines = [
        ["solvent, 32³ × 5: times faster than LAMMPS at its best", "7", "12",
         with_error(rows.get("peers/lammps best over uncross"))],
        ["… than LAMMPS as its manual advises", "", "", with_error(rows.get("peers/lammps manual over uncross"))],
        ["the same, ns per particle and collision", "12", "8", with_error(rows["speed/solvent 32^3"])],
        ["16³ to 100³: dearest over cheapest particle", "1.6", "1.3", number(max(solvent) / min(solvent))],
        *([f"cL³ = {density} over its solvent alone{rule}", least, aim,
           with_error(rows[f"speed/cL^3 = {density}{rule} over solvent"])]
          for density, rule, least, aim in ((100, "", "1.5", "1.3"), (100, ", event-driven", "1.3", "1.15"),
                                            (1000, "", "8", "4"), (1000, ", event-driven", "5.5", "4"))),
        ["contacts, cL³ = 1000, ns per vertex and step, event-driven", "40", "25",
         with_error(rows["detection/cL^3 = 1000 in 32^3, event-driven"])],
        ["crossing detection: exponent of the cost per vertex in size", "0", "", number(exponent(*by_size(rows)), 2)],
        ["… in density", "1", "", number(exponent(*by_density(rows)), 2)],
        *([f"memory per {what}, bytes", least, "", number(rows[f"memory/{name}"]["value"])]
          for what, least, name in (("solvent particle", "80", "solvent particle"), ("cell", "96", "cell"),
                                    ("vertex", "1000", "vertex, cL^3 = 1000"))),
    ]
    return table(["", "required", "aim", "measured"], lines)


def by_size(rows):
    found = [(int(match.group(1)), row["value"]) for name, row in rows.items()
             if (match := re.fullmatch(r"detection/(\d+) vertices at cL\^3 = 300", name))]
    return tuple(zip(*sorted(found)))


def by_density(rows):
    return SWEEP_DENSITIES, [rows[f"detection/cL^3 = {density} in 32^3"]["value"] for density in SWEEP_DENSITIES]


def exponent(x, y):
    """Of a power law between the first and the last point."""
    return math.log(y[-1] / y[0]) / math.log(x[-1] / x[0])


def speed(rows):
    floor = {mb: rows[f"floor/triad of {mb} MB"] for mb in (12, 600)}
    cached, far = (number(128 / floor[mb]["value"], 2) for mb in (12, 600))
    sizes = by_size(rows)[0]

    def cells(pattern, values):
        return [with_error(rows[pattern.format(value)]) for value in values]

    return "\n".join([
        f"The floor: a triad draws {with_error(floor[12])} GB/s from the caches (12 MB), {with_error(floor[600])} GB/s "
        "from memory (600 MB).",
        f"The 128 bytes of a particle and collision would take {cached} and {far} ns.",
        "",
        table(["solvent alone, box", *(f"{edge}³" for edge in BOXES)],
              [["ns per particle and collision", *cells("speed/solvent {}^3", BOXES)]]),
        "",
        table(["crossing detection at cL³ = 300, vertices", *map(str, sizes)],
              [["ns per vertex and step", *cells("detection/{} vertices at cL^3 = 300", sizes)],
               ["the same, event-driven", *cells("detection/{} vertices at cL^3 = 300, event-driven", sizes)]]),
        "",
        table(["crossing detection in 32³ cells, cL³", *map(str, SWEEP_DENSITIES)],
              [["ns per vertex and step", *cells("detection/cL^3 = {} in 32^3", SWEEP_DENSITIES)],
               ["the same, event-driven", *cells("detection/cL^3 = {} in 32^3, event-driven", SWEEP_DENSITIES)],
               ["the rest of a step of fibers alone", *cells("phantoms/cL^3 = {} in 32^3", SWEEP_DENSITIES)]])])


def beside(name):
    """What the scene of a row is compared with, by the name of its own row; without one, the same scene without it."""
    return next((other for other, (scene, _) in ROWS.items() if scene == ROWS[name][1]), "the same without")


def scenes(rows):
    return table(["scene", "over", "ratio", "ns per particle or vertex, and step"],
                 [[name, beside(name) if f"scenes/{name}, ratio" in rows else "", with_error(rows.get(f"scenes/{name}, ratio")),
                   with_error(rows[f"scenes/{name}"])] for name in ROWS]).replace("^3", "³")


def scaling(rows):
    names = (("solvent, box", "solvent alone, 8³ to 64³ cells, against the edge", "3"),
             ("cL^3 = 300, box", "cL³ = 300 with its solvent, 16³ to 48³ cells, against the edge", "3"),
             ("fibers alone, cL^3",
              f"fibers alone in 32³ cells, cL³ = {FIBERS[0]} to {FIBERS[-1]}, against the density", "1 to 2"),
             ("6400 vertices alone, fiber length", f"6400 vertices alone, in fibers of {LENGTHS[0]} to {LENGTHS[-1]}",
              "0"))
    return table(["time of a step", "exponent, all points", "between the first two, the last two", "of a perfect memory"],
                 [[text, with_error(rows[f"scaling/exponent, {name}"]), local(rows, name), power]
                  for name, text, power in names])


def local(rows, name):
    """A series need not be a power law: its exponents at both ends."""
    x, times = zip(*sorted((int(match.group(1)), row["value"]) for key, row in rows.items()
                           if (match := re.fullmatch(f"scaling/{re.escape(name)} (\\d+)", key))))
    return f"{exponent(x[:2], times[:2]):.2f}, {exponent(x[-2:], times[-2:]):.2f}".replace("-", "−")


def scheme(order):
    return ", ".join(f"`{word}`" for word in order.split(", "))


def precision(rows):
    lines = []
    for order in ORDERS:
        for dt in STEPS:
            case = f"{order}, dt {dt}"
            cells = [with_error(rows.get(f"precision/{name}, {case}"))
                     for name in ("stiffest", "bend", "g(10 t0)", "drift, free", "drift, refused", "cost, cL^3 = 100",
                                  "cost, cL^3 = 1000")]
            for k, name in ((0, "statics"), (3, "free"), (4, "refused")):
                fault = rows.get(f"precision/fault, {name}, {case}")
                cells[k] = f"stops at {fault['value']:.0f} t0" if fault else cells[k]
            lines.append([scheme(order), f"{dt:g}", *cells])
    return table(["order", "dt", "stiffest mode", "bend energy", "g(10 t0)", "drift, crossings free", "drift, forbidden",
                  "CPU s/t0, cL³ = 100", "CPU s/t0, dense"], lines)


def answer(rows):
    """What buys 1 % of the stiffest mode."""
    lines = []
    for order in SPLIT:
        for how, dt, cost in (("largest measured", "largest dt within 1 %", "its cost"),
                              ("from the fit", "dt for 1 %", "cost of 1 %")):
            if f"precision/{dt}, {order}" in rows:
                lines.append([f"{scheme(order)}, {how}", with_error(rows[f"precision/{dt}, {order}"]),
                              *(with_error(rows[f"precision/{cost}, {density}, {order}"])
                                for density in ("cL^3 = 100", "cL^3 = 1000"))])
    return table(["1 % of the stiffest mode", "dt", "CPU s/t0, cL³ = 100", "CPU s/t0, dense"], lines)


def efficiency(rows):
    lines = []

    def line(what, how, name, shown):
        prices = [rows.get(f"efficiency/{name}, CPU for {goal} %") for goal in ("1", "0.3")]
        values = [with_error(rows.get(f"efficiency/{n}")) for n in (name, shown)]
        lines.append([what, how, *values, *(number(price["value"], 2) if price else "" for price in prices)])

    for name in VISCOSITIES:
        quantity, how, box = name.split(", ")
        line(f"{quantity}, {box}", how, name, name)
    for name in DIFFUSIONS:
        for estimator in ESTIMATORS.values():
            line(f"diffusion, {name}", estimator, f"{name}, {estimator}", f"{name}, {estimator}, with images")
    head = ["quantity, box", "estimator", "measured", "for k → 0, or an infinite box", "CPU s to 1 %", "to 0.3 %"]
    return table(head, lines).replace("^3", "³")


# document, what makes the table, section of the bench without which there is none
TABLES = {"wanted": ("docs/speed.md", wanted, "speed"), "speed": ("docs/speed.md", speed, "speed"),
          "scenes": ("docs/speed.md", scenes, "scenes"), "scaling": ("docs/speed.md", scaling, "scaling"), "precision": ("docs/accuracy.md", precision, "precision"),
          "answer": ("docs/accuracy.md", answer, "precision"),
          "efficiency": ("docs/accuracy.md", efficiency, "efficiency")}


def write(rows, root=common.ROOT):
    """Replaces what stands between the marks of each table whose rows are all there; says which stay as they were."""
    for name, (document, make, section) in TABLES.items():
        path = root / document
        try:
            if not any(row.startswith(section + "/") for row in rows):
                raise KeyError(section)
            content = make(rows)
        except KeyError as missing:
            common.say(f"table '{name}' is left as it was: nothing measured of {missing}")
            continue
        begin, end = f"<!-- bench: {name} -->\n", f"<!-- end of {name} -->"
        before, rest = path.read_text().split(begin)
        after = rest.split(end)[1]
        path.write_text(before + begin + content + "\n" + end + after)
