"""The operators of docs/port/operators.md: each takes the model, the step and the `in.` tables, and gives its `out.` ones."""

import numpy as np

from . import dumbbells, events, fiber, flow, media, random, solvent, topology, tubes
from . import model as models
from . import sweep as sweeps
from .pack import Tables


def scalar(table):
    return table[0, 0]


def column(values):
    return np.asarray(values)[:, None]


def random_operator(model, step, given):
    purpose, draw, steps, entity = given["address"].T
    word = random.words(model.seed, purpose, draw, steps, entity)
    axis = [random.axes(model.seed, p, s, [e])[0] for p, s, e in zip(purpose, steps, entity)]
    normal = [random.normal_pair(row) for row in word]
    return {"word": word.astype(np.int64), "uniform": random.uniforms(word), "normal": normal, "axis": axis}


def permutation(model, step, given):
    purpose, draw, step, size = (int(x) for x in given["address"][0])
    return {"order": column(random.permutation(model.seed, purpose, draw, step, size))}


def crossing(model, step, given):
    crosses, hit = [], []
    for *points, flip in zip(*(given[name] for name in ("from", "to", "pivot", "a", "b")), given["flip"][:, 0]):
        found = sweeps.crosses(*(point.tolist() for point in points), bool(flip))
        crosses.append(found)
        time, s, s_standing, normal = sweeps.describe(*points) if found else (0.0, 0.0, 0.0, np.zeros(3))
        hit.append([time, s, s_standing, *normal])
    return {"crosses": column(np.array(crosses, np.int64)), "hit": np.array(hit, float).reshape(-1, 6)}


def meeting(model, step, given):
    found = [topology.bonds_meet(row[:3], row[3:]) for row in zip(*(given[name].tolist() for name in ("p", "q", "w", "p_last", "q_last", "w_last")))]
    classes, signs = zip(*found) if found else ((), ())
    return {"class": column(np.array(classes, np.int64)), "sign": np.array(signs, np.int64).reshape(-1, 3)}


ENDS = "moving", "pivot", "a", "b"


def exchange(model, step, given):
    velocity = np.stack([given[end] for end in ENDS], axis=1)
    momentum, after = np.zeros(len(velocity)), velocity.copy()
    for row, contact in enumerate(given["contact"]):
        momentum[row], after[row] = sweeps.exchange(given["mass"][row], velocity[row], *contact, given["normal"][row])
    return {"momentum": column(momentum)} | {end: after[:, k] for k, end in enumerate(ENDS)}


def order(model, step, given):
    return {"order": column(fiber.vertex_order(model, step, 0))}


def sweep(model, step, given):
    position, velocity, event, hit = sweeps.sweep(
        model, given["order"][:, 0], given["position"], given["velocity"], scalar(given["time"])
    )
    return {"event": event, "hit": hit, "position": position, "velocity": velocity}


def contact_search(model, step, given):
    vectors = zip(*(given[name].tolist() for name in ("p", "q", "w", "p_rate", "q_rate", "w_rate")))
    return {"tick": column([events.first_contact(pair, int(first)) for pair, first in zip(vectors, given["from"][:, 0])])}


def tube_search(model, step, given):
    vectors = zip(*(given[name].tolist() for name in ("p", "q", "w", "p_rate", "q_rate", "w_rate")))
    how = zip(given["reach"][:, 0].tolist(), given["from"][:, 0].tolist())
    return {"tick": column([tubes.first_contact(pair, *row) for pair, row in zip(vectors, how)])}


def tube_contact(model, step, given):
    contact, normal = [], []
    for row in zip(*(given[name].tolist() for name in ("p", "q", "w"))):
        s, t, gap = tubes.touch(*(tubes.in_a0(vector) for vector in row))
        contact.append([s, t])
        normal.append(tubes.direction(gap))
    return {"contact": np.array(contact), "normal": np.array(normal)}


FOUR = "p0", "p1", "q0", "q1"


def impulse(model, step, given):
    velocity = np.stack([given[end] for end in FOUR], axis=1).astype(float)
    force = np.stack([given[f"force_{end}"] for end in FOUR], axis=1)
    answer, momentum, after = np.zeros(len(velocity), np.int64), np.zeros(len(velocity)), velocity.copy()
    for row, (s, t) in enumerate(given["contact"]):
        how = s, t, given["normal"][row], scalar(given["tau"][row : row + 1])
        answer[row], momentum[row], after[row] = events.impulse(given["mass"][row], velocity[row], force[row], *how)
    return {"answer": column(answer), "momentum": column(momentum)} | {end: after[:, k] for k, end in enumerate(FOUR)}


def event_drift(model, step, given):
    position, velocity, event, hit = events.drift(model, given["position"], given["velocity"], *given["time"][0])
    return {"event": event, "hit": hit, "position": position, "velocity": velocity}


def bond_force(model, step, given):
    force = np.zeros(given["position"].shape)
    fiber.add_bonds(model, given["position"], force)
    return {"force": force}


def bend_force(model, step, given):
    force = np.zeros(given["position"].shape)
    fiber.add_bends(model, given["position"], force)
    return {"force": force}


def force(model, step, given):
    return {"force": fiber.forces(model, given["position"])}


def kick(model, step, given):
    return {"velocity": fiber.kick(model, given["velocity"], given["force"], scalar(given["time"]))}


def stream(model, step, given):
    position, velocity = solvent.stream(model, given["position"], given["velocity"], scalar(given["time"]))
    return {"position": position, "velocity": velocity}


def shift(model, step, given):
    return {"shift": solvent.grid_shift(model, step)[None]}


def bin_operator(model, step, given):
    return {kind: column(solvent.cell_of(model, given[kind], given["shift"][0])) for kind in ("solvent", "vertex")}


def members(model, given):
    cells = given["solvent_cell"][:, 0], given["vertex_cell"][:, 0]
    return solvent.members(model, *cells, given["solvent"], given["vertex"])


def sum_operator(model, step, given):
    momentum, load = solvent.sum_cells(model, *members(model, given))
    return {"momentum": momentum, "load": load}


def solve(model, step, given):
    active, center, axis = solvent.solve(model, step, given["momentum"], given["load"])
    return {"active": column(active.astype(np.int64)), "center": center, "axis": axis}


def rescale(model, step, given):
    relative = solvent.relative_energy(model, *members(model, given), given["center"], given["load"])
    return {"relative": column(relative), "factor": column(solvent.rescale(model, given["load"], relative))}


def maxwell_boltzmann(model, step, given):
    relative = solvent.relative_energy(model, *members(model, given), given["center"], given["load"])
    factor = solvent.maxwell_boltzmann(model, step, given["load"], relative)
    return {"relative": column(relative), "factor": column(factor)}


def rotate(model, step, given):
    cells = given["active"][:, 0] != 0, given["center"], given["axis"], given["factor"][:, 0]
    return {
        kind: solvent.rotate(model, given[f"{kind}_cell"][:, 0], given[kind], *cells) for kind in ("solvent", "vertex")
    }


KINDS = "solvent", "vertex"


def draw(model, step, given):
    return dict(zip(KINDS, solvent.draw(model, step)))


def mean(model, step, given):
    active, center = solvent.mean(model, given["momentum"], given["load"])
    return {"active": column(active.astype(np.int64)), "center": center}


def give(model, step, given):
    active, center = given["active"][:, 0] != 0, given["center"]
    return {
        kind: solvent.give(given[f"{kind}_cell"][:, 0], given[kind], active, center, given[f"{kind}_drawn"])
        for kind in KINDS
    }


def moments(model, step, given):
    place = np.concatenate([given["solvent_place"], given["vertex_place"]])
    found = solvent.moments(model, *members(model, given), place, given["load"])
    return dict(zip(("middle", "beyond", "second", "angular"), found))


def spin(model, step, given):
    tables = (given[name] for name in ("momentum", "load", "beyond", "second", "angular"))
    active, center, rate = solvent.spin(model, *tables)
    return {"active": column(active.astype(np.int64)), "center": center, "omega": rate}


def give_spin(model, step, given):
    turn = given["active"][:, 0] != 0, given["center"], given["omega"], given["middle"]
    return {
        kind: solvent.give_spin(
            given[f"{kind}_cell"][:, 0], given[kind], given[f"{kind}_place"], *turn, given[f"{kind}_drawn"]
        )
        for kind in KINDS
    }


def swap(model, step, given):
    permutation = solvent.swap_order(model, step, len(given["velocity"]))
    return {"order": column(permutation), "velocity": given["velocity"][permutation]}


def wall_motion(model, step, given):
    halves = [[half(int(k)) for k in given["interval"][:, 0]] for half in (flow.during, flow.end_of)]
    flight, end = (np.array([flow.wall_velocity(model.flow, h).ravel() for h in row]) for row in halves)
    return {"flight": flight, "end": end}


def shear_motion(model, step, given):
    rate = [flow.shear_rate(model.flow, int(k)) for k in given["interval"][:, 0]]
    offset = [flow.shear_offset(model, int(k)) for k in given["half_steps"][:, 0]]
    return {"rate": column(rate), "offset": column(np.array(offset, np.int64))}


def wall_stream(model, step, given):
    place = given["wall"], given["position"], given["velocity"], scalar(given["time"])
    return dict(zip(("position", "velocity", "given"), flow.wall_stream(model, *place)))


def wall_bin(model, step, given):
    return {"solvent": column(flow.wall_cells(model, given["solvent"], given["shift"][0]))}


def fill(model, step, given):
    out = flow.fill(model, step, given["shift"][0], given["wall"], given["momentum"], given["load"])
    return dict(zip(("filled", "momentum", "load"), out))


def account(model, step, given):
    turn = given["active"][:, 0] != 0, given["center"], given["axis"], given["factor"][:, 0]
    return {"given": flow.account(model, given["filled"], *turn)}


def sliding(change):
    def run(model, step, given):
        first = given["shift"][0] if len(given["shift"]) else None
        slide = int(scalar(given["offset"])), float(scalar(given["speed"])), given["position"], given["velocity"]
        return dict(zip(("position", "velocity"), change(model, first, *slide, given["time"])))

    return run


def shear_stream(model, shift, offset, speed, position, velocity, time):
    return flow.shear_stream(model, offset, speed, position, velocity, scalar(time))


def enter(model, shift, offset, speed, position, velocity, time):
    return flow.enter(model, shift, offset, speed, position, velocity)


def leave(model, shift, offset, speed, position, velocity, time):
    return flow.leave(model, shift, offset, speed, position, velocity)


def affine_kick(model, step, given):
    return {"velocity": flow.affine_kick(model, scalar(given["change"]), given["position"], given["velocity"])}


def dumbbell_start(model, step, given):
    return dict(zip(("position", "vector"), dumbbells.start(model)))


def pairs_of(given):
    return (given["position"], given["velocity"], given["vector"]), scalar(given["time"])


MOVED = "position", "velocity", "vector"


def dumbbell_stream(model, step, given):
    return dict(zip(MOVED, dumbbells.stream(model, *pairs_of(given), solvent.stream)))


def dumbbell_wall_stream(model, step, given):
    return dict(zip((*MOVED, "given"), dumbbells.wall_stream(model, given["wall"], *pairs_of(given))))


def dumbbell_shear_stream(model, step, given):
    slide = int(scalar(given["begin"])), int(scalar(given["offset"])), float(scalar(given["speed"]))
    return dict(zip(MOVED, dumbbells.shear_stream(model, *slide, *pairs_of(given))))


def rescale_layers(model, step, given):
    relative = solvent.relative_energy(model, *members(model, given), given["center"], given["load"])
    factor = flow.rescale_layers(model, given["load"], relative, given["filled"])
    return {"relative": column(relative), "factor": column(factor)}


def private_bath(model, step, given):
    return {"velocity": media.private_bath(model, step, given["velocity"])}


def pairs(model, step, given):
    return dict(zip(("pair", "along", "bath"), media.pairs(model, step, given["solvent"], given["vertex"])))


BOTH = "solvent", "vertex"


def pair_bath(model, step, given):
    how = given["pair"], given["along"], given["bath"]
    return dict(zip(BOTH, media.pair_bath(model, *how, given["solvent"], given["vertex"])))


def crowd(model, step, given):
    return {"crowd": column(media.crowds(model, given["solvent"], given["vertex"]))}


def repulsion(model, step, given):
    return {"force": media.repulsion(model, given["solvent"], given["vertex"], given["crowd"][:, 0])}


def repulsion_kick(model, step, given):
    velocity = given["solvent"], given["vertex"]
    return dict(zip(BOTH, media.repulsion_kick(model, scalar(given["time"]), given["force"], *velocity)))


def mobility(model, step, given):
    return {"tensor": column(media.packed(media.tensors(model, given["position"])))}


def root(model, step, given):
    roots = [media.root_of(d) for d in media.unpacked(model, given["tensor"][:, 0])]
    return {"root": column(media.packed(roots))}


def move(model, step, given):
    coupled = (media.unpacked(model, given[name][:, 0]) if len(given[name]) else [] for name in ("tensor", "root"))
    return {"position": media.move(model, step, given["position"], given["force"], *coupled)}


OPERATORS = {
    "private_bath": private_bath,
    "pairs": pairs,
    "pair_bath": pair_bath,
    "crowd": crowd,
    "repulsion": repulsion,
    "repulsion_kick": repulsion_kick,
    "mobility": mobility,
    "root": root,
    "move": move,
    "dumbbell_start": dumbbell_start,
    "dumbbell_stream": dumbbell_stream,
    "dumbbell_wall_stream": dumbbell_wall_stream,
    "dumbbell_shear_stream": dumbbell_shear_stream,
    "wall_motion": wall_motion,
    "shear_motion": shear_motion,
    "wall_stream": wall_stream,
    "shear_stream": sliding(shear_stream),
    "enter": sliding(enter),
    "wall_bin": wall_bin,
    "fill": fill,
    "account": account,
    "leave": sliding(leave),
    "affine_kick": affine_kick,
    "rescale_layers": rescale_layers,
    "random": random_operator,
    "permutation": permutation,
    "order": order,
    "crossing": crossing,
    "meeting": meeting,
    "exchange": exchange,
    "long_sweep": sweep,
    "sweep": sweep,
    "contact_search": contact_search,
    "tube_search": tube_search,
    "tube_contact": tube_contact,
    "bead_search": tube_search,  # a bead is a tube without length
    "bead_contact": tube_contact,
    "impulse": impulse,
    "long_event_drift": event_drift,
    "event_drift": event_drift,
    "bond_force": bond_force,
    "bend_force": bend_force,
    "force": force,
    "kick": kick,
    "stream": stream,
    "shift": shift,
    "bin": bin_operator,
    "draw": draw,
    "sum": sum_operator,
    "solve": solve,
    "mean": mean,
    "rescale": rescale,
    "maxwell_boltzmann": maxwell_boltzmann,
    "rotate": rotate,
    "give": give,
    "moments": moments,
    "spin": spin,
    "give_spin": give_spin,
    "swap": swap,
}


def inputs(tables):
    return Tables({name.removeprefix("in."): values for name, values in tables.items() if name.startswith("in.")})


def model_of(pack):
    return models.from_tables(inputs(pack["model", 0]))


def run(pack):
    """Our outputs of every operator of a pack, from its inputs."""
    model, ours = model_of(pack), {}
    for (operator, step), tables in pack.items():
        if operator in OPERATORS:
            out = OPERATORS[operator](model, step, inputs(tables))
            ours[operator, step] = {f"out.{name}": np.asarray(values) for name, values in out.items()}
    return ours


