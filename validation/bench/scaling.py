"""Time of a step against volume, density and length of the fibers, with fitted exponents."""
import numpy

import common
from speed import blocks

BOXES = (8, 12, 16, 24, 32, 48, 64)
FIBERS = (10, 30, 100, 300, 1000, 2000)
LENGTHS = (8, 16, 32, 64, 128, 256)
DENSE = 300     # c L^3 of the series over volume with fibers
VERTICES = 6400 # of the series over length


def exponent(x, times):
    """Exponent of time = A x^p by least squares of the logarithms, one value per round."""
    rounds = zip(*times)
    return [float(numpy.polyfit(numpy.log(x), numpy.log(t), 1)[0]) for t in rounds]


def series(store, effort, name, x, scenes, unit, per_step=1e3):
    times, _ = blocks(store, max(3, round(5 * effort)), 0.15, scenes)
    rows = [common.row(f"scaling/{name} {value}", "ms per step", [per_step * t for t in times[scene]])
            for value, scene in zip(x, scenes)]
    rows.append(common.row(f"scaling/exponent, {name}", unit, exponent(x, [times[scene] for scene in scenes])))
    return rows


def solvent_volume(store, effort):
    return series(store, effort, "solvent, box", BOXES, [f"cells={n}" for n in BOXES], "of the edge")


def dense_volume(store, effort):
    boxes = BOXES[2:-1]
    return series(store, effort, f"cL^3 = {DENSE}, box", boxes,
                  [f"cells={n},fibers={round(DENSE * (n / 32)**3)}" for n in boxes], "of the edge")


def density(store, effort):
    """Fibers alone, which is what the density adds to the solvent's time."""
    return series(store, effort, "fibers alone, cL^3", FIBERS, [f"per_cell=0,fibers={n}" for n in FIBERS],
                  "of the density")


def length(store, effort):
    """As many vertices in fibers of other lengths, alone in 32^3 cells."""
    return series(store, effort, "6400 vertices alone, fiber length", LENGTHS,
                  [f"per_cell=0,fibers={VERTICES // n},vertices={n}" for n in LENGTHS], "of the length")


ITEMS = {"solvent volume": solvent_volume, "dense volume": dense_volume, "density": density, "length": length}
