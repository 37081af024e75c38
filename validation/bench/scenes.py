"""What a scene may ask for, beside the solvent: a whole run with all its files, in turn with the scene that lacks just that."""
import common
from speed import blocks, rows_of_ratio

COUNTS = "../../tests/counts"
BOX = "box=[32,32,32]"  # 163,840 particles
SRD = f"{COUNTS}/solvent.yaml {BOX}"
FREE = "crossing.forbidden=false"
DPD = f"{COUNTS}/dpd.yaml medium.density=3"
DENSE = f"{COUNTS}/dense-events.yaml"
COMPANY = f"{COUNTS}/company.yaml"
SHIPPED = "../../scenes/dense.yaml"
UNSEEN = ("fibers.yaml box=[12,12,12] fibers.0.count=400 fibers.0.vertices=24 fibers.0.persistence_length=12 "
          "solvent.per_cell=5 solvent.collision_interval=0.02")  # scenes/dense.yaml without `observe` and `trajectory`

# Name: the scene, and what it is compared with.
ROWS = {
    "SRD": (SRD, SRD),
    "130 degrees": (f"{SRD} solvent.rotation_angle=130", SRD),
    "rescale": (f"{SRD} solvent.thermostat=rescale", SRD),
    "maxwell-boltzmann": (f"{SRD} solvent.thermostat=maxwell-boltzmann", SRD),
    "velocity swap": (f"{SRD} solvent.hydrodynamics=false", SRD),
    "AT-a": (f"{SRD} solvent.rule=at-a", SRD),
    "AT+a": (f"{SRD} solvent.rule=at+a", SRD),
    "walls": (f"{COUNTS}/couette.yaml {BOX}", SRD),
    "sheared": (f"{COUNTS}/shear.yaml {BOX}", SRD),
    "dumbbells": (f"{COUNTS}/dumbbells.yaml {BOX}", SRD),
    "bead": (f"{COUNTS}/bead.yaml {BOX} bead.center=[16,16,16] time_step=0.02 solvent.collision_interval=0.02", SRD),
    "DPD, 3000": (f"{DPD} box=[10,10,10] time_step=0.04", SRD),
    "DPD, 41472": (f"{DPD} box=[24,24,24] time_step=0.04", SRD),
    "Lowe-Andersen, 41472": (f"{COUNTS}/pairs.yaml medium.density=3 box=[24,24,24]", SRD),
    "Andersen": (f"fibers.yaml medium.kind=private medium.rate=10 {FREE}", SRD),
    "Langevin": (f"fibers.yaml medium.kind=private medium.rate=10 medium.draw=relax {FREE}", SRD),
    "overdamped": (f"fibers.yaml medium.kind=overdamped medium.rate=1 {FREE} time_step=0.001", SRD),
    "overdamped, rpy": ("chains.yaml", SRD),
    "cL^3 = 1000, event-driven": (DENSE, f"{DENSE} {FREE}"),
    "thick fibers": (f"{DENSE} fibers.0.diameter=0.1", DENSE),
    "bead among fibers": (COMPANY, f"{DENSE} time_step=0.02"),
    "observers": (SHIPPED, UNSEEN),
}


def members(store, rounds, seconds, scenes):
    """Particles and vertices of each scene."""
    lines = (line.split("\t") for line in store.run("steps", rounds, seconds, *scenes).splitlines())
    return {scenes[int(number)]: int(counts[0]) + int(counts[1]) for word, number, *counts in lines if word == "members"}


def scenes(store, effort):
    """Time of a member and step, and over the same of what the scene is compared with: of equal members, the ratio of runs."""
    rounds, texts = max(3, round(9 * effort)), list(dict.fromkeys(text for pair in ROWS.values() for text in pair))
    times, _ = blocks(store, rounds, 0.2, texts)
    count = members(store, rounds, 0.2, texts)
    each = {text: [1e9 * t / count[text] for t in times[text]] for text in texts}
    rows = []
    for name, (scene, beside) in ROWS.items():
        rows.append(common.row(f"scenes/{name}", "ns per particle or vertex, and step", each[scene]))
        if scene != beside:
            rows.append(rows_of_ratio(f"scenes/{name}, ratio", each, scene, beside))
    return rows


FILES = sorted({common.HERE / text.split()[0] for pair in ROWS.values() for text in pair})  # what is measured with others is measured anew
ITEMS = {"scenes": scenes}
