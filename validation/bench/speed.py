"""Speed and memory: the table of docs/speed.md. Scenes are compared in turn, within one process."""
import common

BOXES = (16, 24, 32, 48, 64, 100)
DENSITIES = (30, 100, 300, 1000)       # c L^3 = fibers in 32^3 cells
SWEEP_BOXES = (16, 24, 32, 48)         # at c L^3 = 300
SWEEP_DENSITIES = (30, 100, 300, 1000, 2000)
RULES = {"": 1, ", event-driven": 2}   # how rows name a crossing rule -> `crossing` of the scene; none: sequential


def blocks(store, rounds, seconds, scenes):
    """{scene: [CPU seconds per step, one per round]}, and the peak memory in bytes."""
    times, peak = {scene: [] for scene in scenes}, 0
    for line in store.run("steps", rounds, seconds, *scenes).splitlines():
        fields = line.split("\t")
        if fields[0] == "peak":
            peak = 1024 * int(fields[1])
        elif fields[0] != "members":
            times[scenes[int(fields[1])]].append(float(fields[3]) / int(fields[2]))
    return times, peak


def rows_of_ratio(name, times, above, below):
    return common.row(name, "ratio", [a / b for a, b in zip(times[above], times[below])])


def solvent(store, effort):
    """The floor, and the solvent alone from 16^3 to 100^3: cost of a particle and collision, and relative to 32^3."""
    rounds, scenes = max(3, round(7 * effort)), {edge: f"cells={edge},dt=0.02,every=1" for edge in BOXES}
    times, _ = blocks(store, rounds, 0.4, ["triad=12", "triad=600", *scenes.values()])
    rows = [common.row(f"floor/triad of {mb} MB", "GB/s", [mb / 1e3 / t for t in times[f"triad={mb}"]])
            for mb in (12, 600)]
    for edge, scene in scenes.items():
        nanoseconds = [1e9 * t / (5 * edge**3) for t in times[scene]]
        rows.append(common.row(f"speed/solvent {edge}^3", "ns per particle and collision", nanoseconds))
        if edge != 32:
            ratios = [a / edge**3 / (b / 32**3) for a, b in zip(times[scene], times[scenes[32]])]
            rows.append(common.row(f"speed/solvent {edge}^3 over 32^3", "ratio per particle", ratios))
    return rows


def suspensions(store, effort):
    """Fibers of 64 vertices, dt 0.01, dt_c 0.02, in 32^3 cells: time of a step over the time of the solvent alone."""
    rounds, alone = max(3, round(7 * effort)), "cells=32"
    scenes = {f"{fibers}{rule}": f"cells=32,fibers={fibers},crossing={on}" for rule, on in RULES.items()
              for fibers in DENSITIES}
    times, _ = blocks(store, rounds, 0.4, [alone, *scenes.values()])
    rows = [common.row("speed/solvent 32^3, dt 0.01", "ms per step", [1e3 * t for t in times[alone]])]
    for name, scene in scenes.items():
        rows.append(common.row(f"speed/cL^3 = {name}", "ms per step", [1e3 * t for t in times[scene]]))
        rows.append(rows_of_ratio(f"speed/cL^3 = {name} over solvent", times, scene, alone))
    return rows


def detection(store, effort):
    """What refusing to cross costs: a step of the fibers alone, less the same step of phantoms, per vertex."""
    rounds = max(3, round(7 * effort))

    def measure(pairs):
        scenes = [f"per_cell=0,cells={edge},fibers={fibers},crossing={on}"
                  for edge, fibers in pairs.values() for on in (0, *RULES.values())]
        times, _ = blocks(store, rounds, 0.15, scenes)
        rows = []
        for (name, (_, fibers)), off, *forbidden in zip(pairs.items(), scenes[::3], scenes[1::3], scenes[2::3]):
            for rule, on in zip(RULES, forbidden):
                nanoseconds = [1e9 * (a - b) / (64 * fibers) for a, b in zip(times[on], times[off])]
                rows.append(common.row(f"detection/{name}{rule}", "ns per vertex and step", nanoseconds))
            rows.append(common.row(f"phantoms/{name}", "ns per vertex and step",
                                   [1e9 * t / 64 / fibers for t in times[off]]))
        return rows

    by_size = {f"{64 * round(300 * (edge / 32)**3)} vertices at cL^3 = 300": (edge, round(300 * (edge / 32)**3))
               for edge in SWEEP_BOXES}
    by_density = {f"cL^3 = {fibers} in 32^3": (32, fibers) for fibers in SWEEP_DENSITIES}
    return measure(by_size) + measure(by_density)


def memory(store, effort):
    """Bytes per particle, per cell and per vertex, from the peak of processes that differ in just that."""
    del effort

    def peak(scene):
        return blocks(store, 1, 0.0, [scene])[1]

    def slope(name, unit, count, small, large):
        return common.row(name, unit, value=(peak(large) - peak(small)) / count, error=0.0)

    return [
        slope("memory/solvent particle", "bytes", 35 * 32**3, "cells=32", "cells=32,per_cell=40"),
        slope("memory/cell", "bytes", 80**3 - 40**3, "cells=40,per_cell=8", "cells=80,per_cell=1"),
        slope("memory/vertex, cL^3 = 100", "bytes", 64 * 700, "per_cell=0,cells=32,fibers=100",
              "per_cell=0,cells=64,fibers=800"),
        slope("memory/vertex, cL^3 = 1000", "bytes", 64 * 2375, "per_cell=0,cells=32,fibers=1000",
              "per_cell=0,cells=48,fibers=3375"),
    ]


ITEMS = {"solvent": solvent, "suspensions": suspensions, "detection": detection, "memory": memory}
