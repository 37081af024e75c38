"""Whole steps: the operators in the three orders of docs/conventions.md, and the state hash after every stage."""

import csv
import struct
from dataclasses import dataclass

import numpy as np
import xxhash

from . import dumbbells, events, fiber, flow, media, operators, solvent, sweep
from .lattice import UNIT, dot

# Stages of a step: name and duration in steps. A collision has none; other steps are drift, force, kick.
QUIET = [("drift", 1.0), ("force", None), ("kick", 1.0)]
COLLIDING = {
    "paper": [("drift", 1.0), ("collide", None), ("force", None), ("kick", 1.0)],
    "kick-split": [("drift", 1.0), ("force", None), ("kick", 0.5), ("collide", None), ("kick", 0.5)],
    "drift-split": [("drift", 0.5), ("collide", None), ("drift", 0.5), ("force", None), ("kick", 1.0)],
}
OVERDAMPED = [("force", None), ("move", None)]
THERMOSTATS = ["none", "rescale", "maxwell-boltzmann", "rescale-layers"]
CONTACT_COLUMNS = ["contacts", "contacts_hash", "contacts_digest"]
COLUMNS = "momentum_x momentum_y momentum_z solvent_kinetic vertex_kinetic bond bend digest".split()


def digest_of(rows):
    """Sum of the hashes of rows of 64-bit words."""
    return sum(xxhash.xxh64(row.tobytes()).intdigest() for row in np.asarray(rows, "<i8")) % 2**64


@dataclass
class Run:
    """What a start says besides the model and the state."""

    steps: int
    order: str
    thermostat: str
    hydrodynamics: bool


def run_of(row):
    """Of the row of `in.run`."""
    steps, scheme, thermostat, hydrodynamics = (int(x) for x in row)
    return Run(steps, list(COLLIDING)[scheme], THERMOSTATS[thermostat], bool(hydrodynamics))


class System:
    """A state and the stages that change it. Positions in lattice units; `lag`: half steps the solvent is behind."""

    account = None  # what walls have given: in hits, in collisions
    vector = None  # of dumbbells

    def __init__(self, model, start):
        self.model, self.scene = model, run_of(start["run"][0])
        self.solvent, self.solvent_velocity = start["solvent"], start["solvent_velocity"]
        self.vertex, self.vertex_velocity = start["vertex"], start["vertex_velocity"]
        self.finished, self.lag = (int(x) for x in start["counters"][0])
        if model.dumbbells is not None:
            self.vector = start["vector"]
        self.force = self.pushes = None
        self.event_driven = bool(start["rule"].any())
        self.rule = int(start["collision"].sum())  # 0 srd, 1 at-a, 2 at+a
        self.contacts = []  # rows of events since the last row of the trace
        self.streamed = 0  # half steps that the solvent has flown
        if model.flow is not None and model.flow.walls:
            self.account = np.zeros((4, 3), np.int64)

    def stream(self):
        model, particles = self.model, (self.solvent, self.solvent_velocity)
        if self.lag and model.dumbbells:
            self.stream_dumbbells()
        elif self.lag:
            time = self.lag * (0.5 * self.model.dt)
            end = self.streamed + self.lag
            if model.flow is None:
                particles = solvent.stream(model, *particles, time)
            elif model.flow.walls:
                wall = flow.wall_velocity(model.flow, flow.during(flow.interval_at(model, self.streamed)))
                *particles, given = flow.wall_stream(model, wall, *particles, time)
                self.account[:2] += given
            else:
                slide = flow.shear_offset(model, end), self.slide_speed(flow.interval_at(model, self.streamed))
                particles = flow.shear_stream(model, *slide, *particles, time)
            self.solvent, self.solvent_velocity = particles
            self.lag, self.streamed = 0, end

    def stream_dumbbells(self):
        model, given = self.model, (self.solvent, self.solvent_velocity, self.vector)
        time, end = self.lag * (0.5 * self.model.dt), self.streamed + self.lag
        if model.flow is None:
            moved = dumbbells.stream(model, given, time, solvent.stream)
        elif model.flow.walls:
            wall = flow.wall_velocity(model.flow, flow.during(flow.interval_at(model, self.streamed)))
            *moved, gain = dumbbells.wall_stream(model, wall, given, time)
            self.account[:2] += gain
        else:
            offsets = (flow.shear_offset(model, at) for at in (self.streamed, end))
            speed = self.slide_speed(flow.interval_at(model, self.streamed))
            moved = dumbbells.shear_stream(model, *offsets, speed, given, time)
        self.solvent, self.solvent_velocity, self.vector = moved
        self.lag, self.streamed = 0, end

    def slide_speed(self, interval):
        return flow.shear_rate(self.model.flow, interval) * float(self.model.box[1])

    def drift(self, share, sweep_number):
        self.lag += int(2 * share)
        if self.event_driven:
            time = share * self.model.dt
            start = sweep_number * time - 0.5 * self.model.dt
            moved = events.drift(self.model, self.vertex, self.vertex_velocity, time, start)
            self.vertex, self.vertex_velocity, self.contacts = moved[:3]
            return
        order = fiber.vertex_order(self.model, self.finished + 1, sweep_number)
        moved = sweep.sweep(self.model, order, self.vertex, self.vertex_velocity, share * self.model.dt)
        self.vertex, self.vertex_velocity = moved[:2]

    def kick(self, share):
        time = share * self.model.dt
        if self.pushes is not None:
            velocity = self.solvent_velocity, self.vertex_velocity
            self.solvent_velocity, self.vertex_velocity = media.repulsion_kick(self.model, time, self.pushes, *velocity)
        self.vertex_velocity = fiber.kick(self.model, self.vertex_velocity, self.force, share * self.model.dt)

    def find_forces(self):
        model = self.model
        self.force = fiber.forces(model, self.vertex)
        if model.medium is not None and model.medium.repels:
            self.stream()
            place = self.solvent, self.vertex
            crowd = media.crowds(model, *place) if model.medium.many_body else None
            self.pushes = media.repulsion(model, *place, crowd)

    def move(self):
        model, tensor, root = self.model, [], []
        if model.medium.tensor != media.NONE:
            tensor = media.tensors(model, self.vertex)
            root = [media.root_of(d) for d in tensor]
        self.vertex = media.move(model, self.finished + 1, self.vertex, self.force, tensor, root)

    def meet(self):
        """The bath of a medium."""
        model, step, velocity = self.model, self.finished + 1, (self.solvent_velocity, self.vertex_velocity)
        if model.medium.kind == media.PRIVATE:
            self.vertex_velocity = media.private_bath(model, step, self.vertex_velocity)
            return
        self.stream()
        pairs = media.pairs(model, step, self.solvent, self.vertex)
        self.solvent_velocity, self.vertex_velocity = media.pair_bath(model, *pairs, *velocity)

    def collide(self):
        model, step = self.model, self.finished + 1
        if model.medium is not None:
            self.meet()
            return
        self.stream()
        shift = solvent.grid_shift(model, step)
        sheared = model.flow is not None and not model.flow.walls
        if sheared:
            self.change_image(flow.enter, shift)
        bin_cells = flow.wall_cells if model.flow is not None and model.flow.walls else solvent.cell_of
        cells = bin_cells(model, self.solvent, shift), bin_cells(model, self.vertex, shift)
        if self.rule:
            (self.collide_andersen if self.rule == 1 else self.collide_spin)(step, cells, shift)
        else:
            self.collide_srd(step, cells, shift)
        if sheared:
            self.change_image(flow.leave, shift)
        if sheared and model.flow.intervals:
            begins = flow.interval_at(model, self.streamed)
            change = flow.shear_rate(model.flow, begins) - (flow.shear_rate(model.flow, begins - 1) if begins else 0.0)
            self.solvent_velocity = flow.affine_kick(model, change, self.solvent, self.solvent_velocity)
        if not self.scene.hydrodynamics:
            self.solvent_velocity = self.solvent_velocity[solvent.swap_order(model, step, model.particles)]

    def change_image(self, change, shift):
        ended = max(flow.interval_at(self.model, self.streamed) - 1, 0)
        slide = flow.shear_offset(self.model, self.streamed), self.slide_speed(ended)
        self.solvent, self.solvent_velocity = change(self.model, shift, *slide, self.solvent, self.solvent_velocity)

    def collide_andersen(self, step, cells, shift):
        model, velocity = self.model, (self.solvent_velocity, self.vertex_velocity)
        drawn = solvent.draw(model, step)
        members = solvent.members(model, *cells, velocity[0] - drawn[0], velocity[1] - drawn[1])
        turn = solvent.mean(model, *solvent.sum_cells(model, *members))
        self.solvent_velocity = solvent.give(cells[0], velocity[0], *turn, drawn[0])
        self.vertex_velocity = solvent.give(cells[1], velocity[1], *turn, drawn[1])

    def collide_spin(self, step, cells, shift):
        model, velocity = self.model, (self.solvent_velocity, self.vertex_velocity)
        drawn = solvent.draw(model, step)
        changes = solvent.members(model, *cells, *(old - new for old, new in zip(velocity, drawn)))
        momentum, load = solvent.sum_cells(model, *changes)
        places = solvent.places(self.solvent, shift), solvent.places(self.vertex, shift)
        middle, *about = solvent.moments(model, *changes, np.concatenate(places), load)
        turn = *solvent.spin(model, momentum, load, *about), middle
        self.solvent_velocity = solvent.give_spin(cells[0], velocity[0], places[0], *turn, drawn[0])
        self.vertex_velocity = solvent.give_spin(cells[1], velocity[1], places[1], *turn, drawn[1])

    def collide_srd(self, step, cells, shift):
        model, filled = self.model, np.zeros((0, 4))
        members = solvent.members(model, *cells, self.solvent_velocity, self.vertex_velocity)
        momentum, load = solvent.sum_cells(model, *members)
        if model.flow is not None and model.flow.walls:
            wall = flow.wall_velocity(model.flow, flow.end_of(step // model.interval - 1))
            filled, momentum, load = flow.fill(model, step, shift, wall, momentum, load)
        active, center, axis = solvent.solve(model, step, momentum, load)
        factor = self.thermostat(step, members, center, load, filled)
        turn = active, center, axis, factor
        if len(filled):
            self.account[2:] += flow.account(model, filled, *turn)
        self.solvent_velocity = solvent.rotate(model, cells[0], self.solvent_velocity, *turn)
        self.vertex_velocity = solvent.rotate(model, cells[1], self.vertex_velocity, *turn)

    def thermostat(self, step, members, center, load, filled):
        if self.scene.thermostat == "none":
            return np.ones(self.model.cells)
        relative = solvent.relative_energy(self.model, *members, center, load)
        if self.scene.thermostat == "rescale":
            return solvent.rescale(self.model, load, relative)
        if self.scene.thermostat == "rescale-layers":
            return flow.rescale_layers(self.model, load, relative, filled)
        return solvent.maxwell_boltzmann(self.model, step, load, relative)

    def plan(self):
        medium = self.model.medium
        if medium is not None and medium.kind == media.OVERDAMPED:
            return OVERDAMPED
        alone = self.model.particles == 0 and medium is None
        collides = not alone and (self.finished + 1) % self.model.interval == 0
        return COLLIDING[self.scene.order] if collides else QUIET

    def step(self):
        """One step; yields the name of each stage after it."""
        sweeps = 0
        for stage, share in self.plan():
            if stage in ("force", "kick") and not len(self.vertex) and self.model.medium is None:
                continue
            if stage == "drift":
                self.drift(share, sweeps)
                sweeps += 1
            elif stage == "force":
                self.find_forces()
            elif stage == "kick":
                self.kick(share)
            elif stage == "move":
                self.move()
            else:
                self.collide()
            yield stage
        self.finished += 1
        yield "end"

    def state_hash(self):
        counts = self.finished, self.lag, len(self.solvent), len(self.vertex)
        walls = self.account is not None
        optional = [len(self.vector)] if self.vector is not None else []
        optional += [4] if walls else []
        digest = xxhash.xxh64(struct.pack(f"<{4 + len(optional)}Q", *counts, *optional))
        for position, velocity in ((self.solvent, self.solvent_velocity), (self.vertex, self.vertex_velocity)):
            digest.update(np.hstack([position, velocity.view(np.int64)]).astype("<i8").tobytes())
        if self.vector is not None:
            digest.update(self.vector.astype("<i8").tobytes())
        if walls:
            digest.update(self.account.astype("<i8").tobytes())
        return digest.hexdigest()

    def digest(self):
        """The sum of a hash for each row of the state."""
        tables = [(1, self.solvent, self.solvent_velocity.view(np.int64)), (2, self.vertex, self.vertex_velocity.view(np.int64))]
        optional = [(3, table) for table in (self.vector,) if table is not None] + [(4, table) for table in (self.account,) if table is not None]
        head = [0, self.finished, self.lag, *(len(table[1]) for table in tables + optional)]
        total = digest_of([head])
        for kind, *parts in tables + optional:
            n = len(parts[0])
            if n:
                total += digest_of(np.hstack([np.full((n, 1), kind), np.arange(n)[:, None], *parts]))
        return f"{total % 2**64:016x}"

    def take_contacts(self):
        """Number of contacts since it was asked last, hash and digest of their rows; nothing where drifts have no events."""
        if not self.event_driven:
            return []
        rows, self.contacts = self.contacts, []
        return [len(rows), xxhash.xxh64(np.asarray(rows, "<i8").tobytes()).hexdigest(), f"{digest_of(rows):016x}"]

    def sums(self):
        """Momentum, kinetic energies of solvent and vertices, bond and bend energy: plain sums."""
        model = self.model
        momentum = self.solvent_velocity.sum(axis=0) + (model.mass[:, None] * self.vertex_velocity).sum(axis=0)
        kinetic = [
            0.5 * (mass * dot(velocity, velocity)).sum()
            for mass, velocity in ((1.0, self.solvent_velocity), (model.mass, self.vertex_velocity))
        ]
        vector = fiber.bond_vectors(model, self.vertex)
        length = np.sqrt(dot(vector, vector))
        bond = (0.5 * model.spring[model.bonds] * (length - model.bond_length[model.bonds]) ** 2).sum()
        middle = np.flatnonzero((model.next >= 0) & (model.prev >= 0) & (model.bending != 0))
        before = (self.vertex[middle] - self.vertex[model.prev[middle]]) * UNIT
        after = (self.vertex[model.next[middle]] - self.vertex[middle]) * UNIT
        cosine = dot(before, after) / np.sqrt(dot(before, before) * dot(after, after))
        return [*momentum, *kinetic, bond, (model.bending[middle] * (1 - cosine)).sum()]


def trace(model, start):
    """Rows of a trace: step, stage, hash, sums, contacts. start: {name: table} of the operator `start`."""
    system = System(model, start)
    yield 0, "start", system.state_hash(), [*system.sums(), system.digest()], system.take_contacts()
    for step in range(1, system.scene.steps + 1):
        for stage in system.step():
            yield step, stage, system.state_hash(), [*system.sums(), system.digest()], system.take_contacts()


def write_trace(start, path):
    """The trace of a run as CSV. start: tables of the pack of `uncross oracle start`."""
    model, tables = operators.model_of(start), operators.inputs(start["start", 0])
    with open(path, "w", encoding="ascii", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["step", "stage", "state_hash", *COLUMNS, *(CONTACT_COLUMNS if tables["rule"].any() else [])])
        for number, stage, state_hash, sums, contacts in trace(model, tables):
            table.writerow([number, stage, state_hash, *(f"{value:.17g}" for value in sums[:-1]), sums[-1], *contacts])
