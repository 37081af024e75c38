#!/usr/bin/python3
"""What the motion of a bead says of its surroundings, from bead.csv: friction, width of its trap, moduli G' and G''.

usage: bead.py BEAD.CSV REST RADIUS MASS [--from TIME] [--parts N] [--spring K] [--omega OMEGA ...] [--swings]

REST: mass of all that is not the bead, over that of the bead. RADIUS: a0. MASS: m. Units kT = a0 = m = 1. Printed is a CSV table `what,value,error`.

  friction, active   mean force along its direction over the mean velocity, times 1 + 1/REST: of Hasimoto's formula
  friction, drawn    mean force along the way of a trap that moves at a constant velocity, over its speed
  friction, passive  kT/D across the force, D from the slope of the mean square displacement between lags of 20 and 40 t0
  trap               k <x^2> (1 + 1/REST), 1 in equilibrium
  G' and G''         active: (F* + M omega^2 x*)/(6 pi R x*), F and x at the trap's frequency. Passive: kT/(pi R i omega m*) with
                     the transform m* of the mean square displacement in three dimensions (of components without a drift), less the inertia and the trap

The transform is that of straight lines between the points (Evans et al., Phys. Rev. E 80, 012501 (2009)). The inertia of the fluid is in
both. Errors: scatter of forty parts of the run for what is known at once (trap; active friction, but for --parts), of twenty for the rest.
"""
import argparse
import csv

import numpy

PARTS = 20        # of a run, where lags are long
SHORT_PARTS = 40  # else


def read(path, begin):
    """Columns of the table from a time on; a last line that is cut off is left out."""
    with open(path, newline="") as file:
        lines = csv.reader(file)
        names = next(lines)
        rows = [line for line in lines if len(line) == len(names)]
    columns = dict(zip(names, numpy.array(rows, dtype=float).T))
    kept = columns["time"] >= begin
    return {name: column[kept] for name, column in columns.items()}


def vectors(columns, what):
    return numpy.array([columns[f"{what}_{axis}"] for axis in "xyz"])


def parted(function, *series, parts=PARTS):
    """Mean of a function over parts of the series, and its error."""
    length = series[0].shape[-1] // parts
    values = numpy.array([function(*(s[..., k * length:(k + 1) * length] for s in series)) for k in range(parts)])
    return values.mean(axis=0), values.std(axis=0, ddof=1) / parts ** 0.5


def square_displacement(place, lags):
    """Mean square displacement per component, place: [components, times]."""
    return numpy.array([numpy.mean((place[:, lag:] - place[:, :place.shape[1] - lag]) ** 2) if lag else 0.0 for lag in lags])


def active_friction(time, place, force, rest, parts=SHORT_PARTS):
    direction = force.mean(axis=1) / numpy.linalg.norm(force.mean(axis=1))
    speed, error = parted(lambda t, x: direction @ (x[:, -1] - x[:, 0]) / (t[-1] - t[0]), time, place, parts=parts)
    friction = numpy.linalg.norm(force.mean(axis=1)) / speed * (1.0 + 1.0 / rest)
    return friction, friction * error / speed


def drawn_friction(time, trap, force):
    way = trap[:, -1] - trap[:, 0]
    direction, speed = way / numpy.linalg.norm(way), numpy.linalg.norm(way) / (time[-1] - time[0])
    value, error = parted(lambda f: direction @ f.mean(axis=1), force, parts=SHORT_PARTS)
    return value / speed, error / speed


def passive_friction(time, place, lag=40.0):
    step = time[1] - time[0]
    lags = [round(0.5 * lag / step), round(lag / step)]

    def slope(x):
        square = square_displacement(x, lags)
        return (square[1] - square[0]) / (2.0 * step * (lags[1] - lags[0]))

    diffusion, error = parted(slope, place)
    return 1.0 / diffusion, error / diffusion ** 2


def line_transform(time, square, omega):
    """Integral of square(t) exp(-i omega t) over t > 0; straight lines between the points, time[0] = square[0] = 0, and the mean slope of the
    last quarter of the points beyond."""
    slopes = numpy.diff(square) / numpy.diff(time)
    turns = numpy.exp(-1j * omega * time)
    quarter = 3 * (len(time) - 1) // 4
    second = slopes @ (turns[:-1] - turns[1:]) + (square[-1] - square[quarter]) / (time[-1] - time[quarter]) * turns[-1]
    return -second / omega ** 2


def passive_moduli(time, place, radius, mass, spring, omegas, longest=80.0):
    """Values and errors, [omegas, 2]. The modulus is that of the mean of all parts, since 1/m* of one part has a bias; errors are those
    of the jackknife."""
    step = time[1] - time[0]
    lags = numpy.arange(round(longest / step) + 1)
    length = place.shape[1] // PARTS
    squares = numpy.array([3.0 * square_displacement(place[:, k * length:(k + 1) * length], lags) for k in range(PARTS)])

    def moduli(square):
        found = [1.0 / (numpy.pi * radius * 1j * w * line_transform(lags * step, square, w)) for w in omegas]
        found = [g + (mass * w * w - spring) / (6.0 * numpy.pi * radius) for g, w in zip(found, omegas)]
        return numpy.array([[g.real, g.imag] for g in found])

    others = numpy.array([moduli(numpy.delete(squares, k, axis=0).mean(axis=0)) for k in range(PARTS)])
    return moduli(squares.mean(axis=0)), others.std(axis=0) * (PARTS - 1) ** 0.5


def active_modulus(time, place, force, radius, mass, omega):
    def at_frequency(t, x, f):
        turn = numpy.exp(-1j * omega * t)
        along = numpy.argmax(f.std(axis=1))
        x_star, f_star = ((s[along] - s[along].mean()) @ turn for s in (x, f))
        modulus = (f_star + mass * omega ** 2 * x_star) / (6.0 * numpy.pi * radius * x_star)
        return numpy.array([modulus.real, modulus.imag])

    return parted(at_frequency, time, place, force)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("table")
    for name in ("rest", "radius", "mass"):
        parser.add_argument(name, type=float)
    parser.add_argument("--from", dest="begin", type=float, default=0.0)
    parser.add_argument("--spring", type=float, default=0.0)
    parser.add_argument("--omega", type=float, nargs="*", default=[])
    parser.add_argument("--parts", type=int, default=SHORT_PARTS, help="of the run, for errors of the active friction")
    parser.add_argument("--swings", action="store_true", help="the trap swings at the first omega")
    args = parser.parse_args()
    columns = read(args.table, args.begin)
    time, place, force = columns["time"], vectors(columns, "place"), vectors(columns, "force")
    rows = []
    constant = force.std() == 0.0 or args.spring == 0.0
    if constant and numpy.linalg.norm(force) > 0.0:
        rows.append(("active friction", *active_friction(time, place, force, args.rest, args.parts)))
    still = [k for k in range(3) if not constant or not force[k].any()]  # components without a drift
    if args.spring == 0.0:
        rows.append(("passive friction", *passive_friction(time, place[still])))
    elif not args.swings and numpy.ptp(vectors(columns, "trap"), axis=1).any():
        rows.append(("drawn friction", *drawn_friction(time, vectors(columns, "trap"), force)))
    elif not args.swings:
        middle = vectors(columns, "trap")
        width, error = parted(lambda x: args.spring * (1.0 + 1.0 / args.rest) * numpy.mean(x ** 2), place - middle, parts=SHORT_PARTS)
        rows.append(("trap", width, error))
    if args.swings:
        value, error = active_modulus(time, place, force, args.radius, args.mass, args.omega[0])
        rows += [("active G'", value[0], error[0]), ("active G''", value[1], error[1])]
    elif args.omega:
        values, errors = passive_moduli(time, place[still], args.radius, args.mass, args.spring, args.omega)
        for omega, value, error in zip(args.omega, values, errors):
            rows += [(f"passive G' at {omega:g}", value[0], error[0]), (f"passive G'' at {omega:g}", value[1], error[1])]
    print("what,value,error")
    for what, value, error in rows:
        print(f"{what},{value:.6g},{error:.2g}")


if __name__ == "__main__":
    main()
