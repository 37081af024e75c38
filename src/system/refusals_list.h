/*
 * What may not stand together: one row each, in the order in which a model is checked. system/refusals.c makes of this
 * list both the conditions and the table, so it is included twice, with another REFUSE each time, and has no guard.
 *
 *   REFUSE(when, key, condition, why)
 *
 * when: the moment of the check. key: that which is to blame. condition: of the model m and, where `key` is one of a
 * kind of fibers, of the kind k; true refuses. why: what is wrong, and what is allowed.
 */
#ifndef REFUSE
#define REFUSE(when, key, condition, why) /* a tool that reads this file alone */
#endif

/* --- a medium ---------------------------------------------------------------------------------------------------- */

REFUSE(AT_MEDIUM, "medium", m->solvent.per_cell != 0.0 || m->solvent.collision_interval != 0.0,
       "there is a solvent of collision cells too; allowed: one of the two")
REFUSE(AT_MEDIUM, "dumbbells", m->dumbbells.spring != 0.0,
       "only a solvent of collision cells has springs; allowed without a medium")
REFUSE(AT_MEDIUM, "walls", has_walls(m),
       "only a solvent of collision cells has rules for walls; allowed without a medium")
REFUSE(AT_MEDIUM, "medium.inextensible", m->medium.inextensible && !model_is_overdamped(m),
       "only vertices without velocities are held by tension; allowed with kind: overdamped")
REFUSE(AT_MEDIUM, "shear", is_sheared(m),
       "only a solvent of collision cells has rules for images that slide; allowed without a medium")

REFUSE(AT_MEDIUM_KIND, "medium.kind", is_private(m) && m->kinds == 0,
       "a private bath is one of vertices, and there are no fibers; allowed: pairs")
REFUSE(AT_MEDIUM_KIND, "medium.density", is_private(m) && m->medium.density != 0.0,
       "a private bath has no particles; allowed with kind: pairs")
REFUSE(AT_MEDIUM_KIND, "medium.weight", is_private(m) && m->medium.weight != WEIGHT_HAT,
       "a private bath knows no distances; allowed: hat, which has no effect there")
REFUSE(AT_MEDIUM_KIND, "medium.kind", is_private(m) && model_repels(m),
       "a private bath knows no distances, so no repulsion; allowed with it: pairs")

REFUSE(AT_MEDIUM_KIND, "dimensions", has_pairs(m) && m->dimensions != 3,
       "pairs are in space; allowed with this medium: 3")
/* Pairs are found in cells of edge 1 a0 and their neighbors: three along each edge, so that no pair is met twice. */
REFUSE(AT_MEDIUM_KIND, "box", has_pairs(m) && box_shortest_edge(&m->box) < 3,
       "pairs up to 1 a0 apart, and an edge of the box is less than 3 a0; allowed with this medium: 3 and more")
REFUSE(AT_MEDIUM_KIND, "medium.kind", has_pairs(m) && !(m->medium.density > 0.0),
       "pairs without a density; allowed with a density above 0")
REFUSE(AT_PAIR_FORCES, "medium.repulsion", m->medium.repulsion < 0.0 && !(m->medium.many.repulsion > 0.0),
       "an attraction without many_body, under which all members fall onto each other; allowed: 0 and more")
REFUSE(AT_PAIR_FORCES, "crossing.rule",
       model_repels(m) && m->crossing.forbidden && m->crossing.rule == CROSSING_EVENT_DRIVEN && m->kinds > 0,
       "forces of particles are known once in a step, and contacts need them at their own time; allowed with "
       "repulsion: sequential")

REFUSE(AT_MEDIUM_KIND, "medium.kind", model_is_overdamped(m) && m->kinds == 0,
       "overdamped motion is one of vertices, and there are no fibers; allowed: pairs")
REFUSE(AT_MEDIUM_KIND, "dimensions", model_is_overdamped(m) && m->dimensions != 3,
       "tensors are those of space; allowed with overdamped motion: 3")
REFUSE(AT_MEDIUM_KIND, "crossing.forbidden", model_is_overdamped(m) && m->crossing.forbidden,
       "overdamped vertices have no velocities, so bonds cannot exchange momentum; allowed with this medium: false")
REFUSE(AT_MEDIUM_KIND, "medium.density", model_is_overdamped(m) && m->medium.density != 0.0,
       "overdamped motion has no particles; allowed with kind: pairs")
REFUSE(
    AT_MEDIUM_KIND, "medium.kind",
    model_is_overdamped(m) && (m->medium.weight != WEIGHT_HAT || m->medium.draw != DRAW_REPLACE || model_repels(m)),
    "overdamped motion knows no pairs and draws no velocities: no draw, weight or repulsion; allowed with them: pairs")
REFUSE(AT_MEDIUM_KIND, "medium.tensor", is_coupled(m) && !(m->medium.radius > 0.0),
       "a tensor needs a radius above 0, and a radius a tensor; allowed: both or none")
REFUSE(AT_MEDIUM_KIND, "medium.radius", model_is_overdamped(m) && !is_coupled(m) && m->medium.radius > 0.0,
       "a tensor needs a radius above 0, and a radius a tensor; allowed: both or none")
REFUSE(AT_MEDIUM_KIND, "medium.inextensible",
       model_is_overdamped(m) && m->medium.inextensible && !(shortest_bond(m) > 0.0),
       "a kind of fibers has the bond_length 0, which no tension can hold; allowed with inextensible: above 0")
REFUSE(AT_MEDIUM_KIND, "medium.tensor", is_coupled(m) && longest_fiber(m) > MOST_COUPLED,
       "a fiber has more than 1000 vertices, and its matrix more than 72 MB; allowed with a tensor: up to 1000")

/* --- a solvent: phantoms are a heat bath by themselves, which has no memory, and nothing can act on them -------------
 */

REFUSE(AT_SOLVENT, "solvent.thermostat", model_rule_is_thermal(m) && m->solvent.thermostat != THERMOSTAT_NONE,
       "the collision rule holds the temperature by itself; allowed with it: none")
REFUSE(AT_SOLVENT, "solvent.bath", model_has_phantoms(m) && m->solvent.per_cell == 0.0,
       "phantoms without a per_cell; allowed with a per_cell above 0")
REFUSE(AT_SOLVENT, "solvent.bath", model_has_phantoms(m) && m->solvent.hydrodynamics,
       "phantoms carry no hydrodynamic interactions; allowed with hydrodynamics: false")
REFUSE(AT_SOLVENT, "solvent.bath", model_has_phantoms(m) && m->solvent.thermostat != THERMOSTAT_NONE,
       "phantoms are a thermostat; allowed with thermostat: none")
REFUSE(AT_SOLVENT, "solvent.bath", model_has_phantoms(m) && vec3_norm(m->solvent.acceleration) != 0.0,
       "phantoms are not accelerated; allowed with acceleration: [0, 0, 0]")
REFUSE(AT_SOLVENT, "solvent.bath", model_has_phantoms(m) && !(m->solvent.per_cell <= MOST_PHANTOMS),
       "too many phantoms; allowed with a per_cell of at most 1000")
REFUSE(AT_SOLVENT, "solvent.bath", model_has_phantoms(m) && m->kinds == 0,
       "phantoms are drawn for fibers only, and there are none; allowed: particles")

REFUSE(AT_DUMBBELLS, "dumbbells", m->dumbbells.spring != 0.0 && !model_has_solvent(m),
       "they are pairs of solvent particles, and there are none; allowed with a solvent of particles")
REFUSE(AT_DUMBBELLS, "solvent.hydrodynamics", m->dumbbells.spring != 0.0 && !m->solvent.hydrodynamics,
       "velocities that are permuted are not those of springs; allowed with dumbbells: true")

/* --- a plane, a flow --------------------------------------------------------------------------------------------- */

REFUSE(AT_FLOW, "box", model_is_flat(m) && m->box.cells[2] != 1,
       "with dimensions: 2 the box is one cell thick; allowed: [Lx, Ly, 1]")
REFUSE(AT_FLOW, "flow", model_is_flat(m) && m->flow.z != 0.0,
       "with dimensions: 2 nothing moves along z; allowed: a z component of 0")
REFUSE(AT_FLOW, "solvent.acceleration", model_is_flat(m) && m->solvent.acceleration.z != 0.0,
       "with dimensions: 2 nothing moves along z; allowed: a z component of 0")
REFUSE(AT_FLOW, "walls", model_is_flat(m) && (m->walls.lower.z != 0.0 || m->walls.upper.z != 0.0),
       "with dimensions: 2 nothing moves along z; allowed: velocities with a z component of 0")
REFUSE(AT_FLOW, "crossing.forbidden", model_is_flat(m) && m->kinds > 0 && m->crossing.forbidden,
       "in a plane fibers cannot pass over each other, so the rule has no side on which to keep them; allowed with "
       "dimensions: 2: false")
REFUSE(AT_FLOW, "solvent.bath", model_is_flat(m) && model_has_phantoms(m),
       "phantoms are drawn in space; allowed with dimensions: 2: particles")
REFUSE(AT_FLOW, "solvent.hydrodynamics", model_is_flat(m) && !m->solvent.hydrodynamics,
       "velocities are not permuted in a plane; allowed with dimensions: 2: true")
REFUSE(AT_FLOW, "solvent.profile", has_profile(m) && has_boundary(m),
       "the profile repeats with the box; allowed between walls and with shear: uniform")
REFUSE(AT_FLOW, "solvent.acceleration", has_profile(m) && m->solvent.acceleration.y != 0.0,
       "a force along y that depends on y compresses the solvent; allowed with this profile: a y component of 0")
REFUSE(AT_FLOW, "solvent.hydrodynamics", has_profile(m) && is_permuted(m),
       "velocities that are permuted have no profile; allowed with this profile: true")
REFUSE(AT_FLOW, "solvent.profile", has_profile(m) && model_has_phantoms(m),
       "phantoms are not accelerated; allowed: uniform")
REFUSE(AT_FLOW, "solvent.acceleration", has_walls(m) && m->solvent.acceleration.y != 0.0,
       "the solvent would be pressed against a wall; allowed between walls: a y component of 0")
REFUSE(AT_FLOW, "solvent.acceleration", is_sheared(m) && m->solvent.acceleration.y != 0.0,
       "the solvent would be moved across the shear; allowed with shear: a y component of 0")

REFUSE(AT_WALLS, "walls.strain", has_walls(m) && m->walls.strain != 0.0 && m->walls.period == 0.0,
       "a strain without a period; allowed with a period above 0")
REFUSE(AT_WALLS, "walls.shear_rate",
       has_walls(m) && m->walls.shear_rate != 0.0 &&
           (vec3_norm(m->walls.lower) != 0.0 || vec3_norm(m->walls.upper) != 0.0),
       "velocities of the walls are given too; allowed: one of the two")
REFUSE(AT_SHEAR, "shear.strain", m->shear.strain != 0.0 && m->shear.period == 0.0,
       "a strain without a period; allowed with a period above 0")
REFUSE(AT_SHEAR, "shear.period", m->shear.rate == 0.0 && m->shear.period != 0.0,
       "a period without a rate or strain; allowed: with one of the two")

REFUSE(AT_BOUNDARY, "shear", has_walls(m) && is_sheared(m), "walls and shear are both along y; allowed: one of the two")
REFUSE(AT_BOUNDARY, "walls", has_walls(m) && model_has_phantoms(m),
       "phantoms are drawn about the same velocity everywhere; allowed with bath: particles")
REFUSE(AT_BOUNDARY, "walls", has_walls(m) && !model_has_solvent(m) && m->kinds == 0,
       "they act on solvent and fibers, and there are none; allowed with solvent particles or fibers")
REFUSE(AT_BOUNDARY, "shear", is_sheared(m) && !model_has_solvent(m) && m->kinds == 0,
       "they act on solvent and fibers, and there are none; allowed with solvent particles or fibers")
REFUSE(AT_BOUNDARY, "box",
       is_sheared(m) && m->kinds > 0 && m->crossing.forbidden && m->box.cells[0] % m->box.cells[1] != 0,
       "with shear and bonds that must not cross, the edge along x is a whole multiple of that along y, so that images "
       "stay on the lattice; allowed: [2, 1, 1] times any number, for example")
REFUSE(AT_BOUNDARY, "solvent.hydrodynamics", has_boundary(m) && is_permuted(m),
       "velocities that are permuted have no profile; allowed between walls and with shear: true")
REFUSE(AT_BOUNDARY, "flow", has_boundary(m) && m->flow.y != 0.0,
       "a flow across walls or shear; allowed: a y component of 0")
REFUSE(AT_BOUNDARY, "walls", has_walls(m) && (m->walls.lower.y != 0.0 || m->walls.upper.y != 0.0),
       "a wall that leaves its plane; allowed: velocities with a y component of 0")
REFUSE(AT_BOUNDARY, "walls.fill", m->walls.kind == WALL_SLIP && m->walls.fill != FILL_PLANAR,
       "slip walls have no virtual particles; allowed: planar, which has no effect there")
REFUSE(AT_BOUNDARY, "dumbbells.spring",
       has_walls(m) && m->dumbbells.spring != 0.0 && 4.0 > m->dumbbells.spring * m->box.cells[1] * m->box.cells[1],
       "a dumbbell at rest is longer than half of the gap; allowed between walls: sqrt(kT/spring) up to L/2")
REFUSE(AT_BOUNDARY, "dumbbells.depth", m->dumbbells.depth != 0.0 && !has_walls(m),
       "a potential of walls, and there are none; allowed with walls")
REFUSE(AT_BOUNDARY, "dumbbells.range",
       m->dumbbells.depth != 0.0 && 2.0 * m->dumbbells.range > m->box.cells[1] * sqrt(m->dumbbells.spring),
       "the potentials of the two walls overlap; allowed: range/sqrt(spring) up to half of L")
REFUSE(AT_BOUNDARY, "walls.fill",
       has_walls(m) && m->walls.fill == FILL_PAPER && m->solvent.rule == RULE_AT_PLUS_A &&
           m->solvent.per_cell != nearbyint(m->solvent.per_cell),
       "per_cell less the members of a cell is not a whole number of virtual particles, and at+a gives each a place; "
       "allowed with at+a: planar or none, or a whole per_cell")

/* --- a kind of fibers -------------------------------------------------------------------------------------------- */

REFUSE(AT_BENDING, "fibers.persistence_length", k->persistence_length != 0.0 && k->bending != 0.0,
       "bending is given too; allowed: one of the two")
REFUSE(AT_BENDING, "fibers.persistence_length", k->persistence_length != 0.0 && k->bond_length == 0.0,
       "bending = persistence_length/bond_length needs a bond_length above 0; allowed: give bending instead")
REFUSE(AT_SPRING, "fibers.keeps", k->stands_for == 0 && k->keeps != SIZE_ENDS,
       "there is no finer chain; allowed with stands_for")
REFUSE(AT_SPRING, "fibers.stands_for",
       k->stands_for != 0 && (k->bond_length != 0.0 || k->bending != 0.0 || k->ring || k->vertices < 2),
       "only an open Gaussian chain of 2 vertices or more stands for another one; allowed: bond_length 0, no bending, "
       "no ring")
REFUSE(AT_FROZEN, "fibers.frozen", k->frozen && !is_zero(k->force),
       "frozen fibers together with a force; allowed: false, or a periodic box at rest")
REFUSE(AT_FROZEN, "fibers.frozen", k->frozen && !is_zero(m->flow),
       "frozen fibers together with a flow; allowed: false, or a periodic box at rest")
REFUSE(AT_FROZEN, "fibers.frozen", k->frozen &&has_walls(m),
       "frozen fibers together with walls; allowed: false, or a periodic box at rest")
REFUSE(AT_FROZEN, "fibers.frozen", k->frozen &&model_is_sheared(m),
       "frozen fibers together with shear; allowed: false, or a periodic box at rest")
REFUSE(AT_FROZEN, "fibers.held", k->frozen && k->held != HELD_NONE,
       "all vertices of a frozen fiber are held; allowed: none")
REFUSE(AT_FROZEN, "fibers.held", k->ring && k->held == HELD_ENDS, "a ring has no ends; allowed: none | first")
REFUSE(AT_FROZEN, "fibers.held", k->held != HELD_NONE && !is_zero(k->force),
       "held vertices together with a force; allowed: none, or a periodic box at rest")
REFUSE(AT_FROZEN, "fibers.held", k->held != HELD_NONE && !is_zero(m->flow),
       "held vertices together with a flow; allowed: none, or a periodic box at rest")
REFUSE(AT_FROZEN, "fibers.held", k->held != HELD_NONE && has_walls(m),
       "held vertices together with walls; allowed: none, or a periodic box at rest")
REFUSE(AT_FROZEN, "fibers.held", k->held != HELD_NONE && is_sheared(m),
       "held vertices together with shear; allowed: none, or a periodic box at rest")
REFUSE(AT_FROZEN, "fibers.held", k->held != HELD_NONE && is_coupled(m),
       "with a tensor the others would feel what holds them; allowed: none, or tensor: none")
REFUSE(AT_FROZEN, "fibers.held", k->held != HELD_NONE && m->medium.inextensible,
       "tensions know vertices that move only; allowed: none, or inextensible: false")
REFUSE(AT_PLACES, "fibers.places", k->placed > 0 && k->start == START_EQUILIBRIUM,
       "fibers that start in equilibrium are placed at random; allowed with start: straight, or for rings")
REFUSE(AT_PLANE, "fibers.force", model_is_flat(m) && k->force.z != 0.0,
       "with dimensions: 2 nothing moves along z; allowed: a z component of 0")
REFUSE(AT_TUBE, "fibers.diameter", k->diameter != 0.0 && k->vertices < 2,
       "a free point has no bond, and so no tube; allowed: 0")
REFUSE(AT_TUBE, "fibers.diameter", k->diameter != 0.0 && !m->crossing.forbidden,
       "with crossing: {forbidden: false} fibers pass through each other; allowed: 0")
REFUSE(AT_TUBE, "fibers.diameter", k->diameter != 0.0 && m->crossing.rule != CROSSING_EVENT_DRIVEN,
       "the rule sequential knows thin lines only; allowed: 0, or crossing: {rule: event-driven}")
REFUSE(AT_TUBE, "fibers.diameter", k->diameter != 0.0 && has_walls(m),
       "walls know the axes of fibers only; allowed between walls: 0")
REFUSE(AT_TUBE, "fibers.diameter", k->diameter != 0.0 && model_is_sheared(m),
       "in a sheared box bonds move in sheared coordinates, where tubes are not round; allowed there: 0")

/* --- a bead ------------------------------------------------------------------------------------------------------ */

REFUSE(AT_BEAD, "bead", !model_has_solvent(m), "it needs solvent particles, and there are none; allowed with a solvent")
REFUSE(AT_BEAD, "medium", !model_in_cells(m), "its pairs do not know the bead; allowed with a bead: no medium")
REFUSE(AT_BEAD, "walls.kind", m->walls.kind == WALL_SLIP,
       "they do not take up the momentum of a bead along them; allowed with a bead: no-slip")
REFUSE(AT_BEAD, "walls.fill", has_walls(m) && m->walls.fill != FILL_PLANAR,
       "a cell that the bead cuts has few members, and would be filled by the wall; allowed with a bead: planar")
REFUSE(AT_BEAD, "fibers", has_walls(m) && m->kinds > 0,
       "a cluster of fibers and bead does not touch walls; allowed between walls: a bead alone, or fibers alone")
REFUSE(AT_BEAD, "shear", is_sheared(m), "a bead has no image that moves; allowed with a bead: no shear")
REFUSE(AT_BEAD, "dumbbells", model_has_dumbbells(m), "springs do not touch a bead; allowed with a bead: no dumbbells")
REFUSE(AT_BEAD, "solvent.rule", m->solvent.rule == RULE_AT_PLUS_A,
       "virtual particles of a bead have no angular momentum; allowed with a bead: srd | at-a")
REFUSE(AT_BEAD, "solvent.thermostat", m->solvent.thermostat != THERMOSTAT_NONE,
       "its factors do not know the bead's virtual particles; allowed with a bead: none (rule: at-a holds kT = 1)")
REFUSE(AT_BEAD, "solvent.hydrodynamics", !m->solvent.hydrodynamics,
       "velocities that are permuted drag no bead; allowed with a bead: true")
REFUSE(AT_BEAD, "solvent.acceleration", vec3_norm(m->solvent.acceleration) != 0.0 && !has_walls(m),
       "nothing takes up the momentum; allowed with a bead: [0, 0, 0], or walls")
REFUSE(AT_BEAD, "time_step", m->solvent.interval_steps != 1,
       "a bead is moved with the solvent; allowed with a bead: the collision interval")
REFUSE(AT_BEAD, "order", m->scheme == SCHEME_DRIFT_SPLIT,
       "half a drift would be late between steps; allowed with a bead: paper | kick-split")
REFUSE(AT_BEAD, "crossing.forbidden", m->kinds > 0 && !m->crossing.forbidden,
       "fibers do not touch the bead; allowed with both: {forbidden: true, rule: event-driven}")
REFUSE(AT_BEAD, "crossing.rule", m->kinds > 0 && m->crossing.rule != CROSSING_EVENT_DRIVEN,
       "fibers do not touch the bead; allowed with both: {forbidden: true, rule: event-driven}")
REFUSE(AT_BEAD_FIBERS, "fibers.vertices", k->vertices < 2,
       "a vertex without a bond does not touch the bead; allowed: 2 or more")
REFUSE(AT_BEAD_FIBERS, "fibers.frozen",
       k->frozen && (m->bead.drive.spring != 0.0 || vec3_norm(m->bead.drive.force) != 0.0),
       "they do not take up the momentum of the drive; allowed with a bead that is driven: false")
REFUSE(AT_BEAD_FIBERS, "fibers.held",
       k->held != HELD_NONE && (m->bead.drive.spring != 0.0 || vec3_norm(m->bead.drive.force) != 0.0),
       "they do not take up the momentum of the drive; allowed with a bead that is driven: none")
REFUSE(AT_BEAD_FIBERS, "fibers.bond_length", !(longest_bond(k) <= LONGEST_BESIDE_BEAD),
       "a bond may be so long that it touches two images of the bead; allowed with a bead: bond, 8/sqrt(spring) and "
       "diameter of 3 a0 together")
REFUSE(AT_TRAP, "bead.drive.velocity", !has_trap(m) && vec3_norm(m->bead.drive.velocity) > 0.0,
       "there is no trap to move; allowed with a spring")
REFUSE(AT_TRAP, "bead.drive.amplitude", !has_trap(m) && swings(m), "there is no trap to move; allowed with a spring")
REFUSE(AT_TRAP, "bead.drive.amplitude", swings(m) && !(m->bead.drive.period > 0.0),
       "an oscillation needs a period; allowed with one")
REFUSE(AT_TRAP, "bead.drive.period", m->bead.drive.period != 0.0 && !swings(m),
       "nothing oscillates; allowed with an amplitude")

/* --- what only a rule knows that moves one vertex at a time --------------------------------------------------------
 */

REFUSE(AT_END, "crossing.refusal", is_event_driven(m) && m->crossing.rejection != REJECTION_STAY,
       "with rule: event-driven no move is refused: bonds bounce at the time of contact; allowed: stay, which has no "
       "effect there")
REFUSE(AT_END, "crossing.frame", is_event_driven(m) && m->crossing.frame != FRAME_LABORATORY,
       "with rule: event-driven no vertex stands still, so there is no frame of the moves; allowed: laboratory, which "
       "has no effect there")
REFUSE(AT_END, "crossing.exclusion", is_event_driven(m) && m->crossing.exclusion != EXCLUSION_SHARED_VERTEX,
       "with rule: event-driven no bond moves alone, so none is linked to it; allowed: shared-vertex")
REFUSE(
    AT_END, "", !model_collides(m) && m->kinds == 0,
    "there is nothing to simulate; a scene has a 'solvent', a 'medium' of pairs, 'fibers', or more than one of these")
