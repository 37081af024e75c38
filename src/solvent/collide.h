/*
 * The parts of a collision, one by one, in the order in which solvent_collide does them after solvent_bin: for oracles
 * and tests. Each reads and fills work->collision only, but for the last.
 */
#ifndef UNCROSS_COLLIDE_H
#define UNCROSS_COLLIDE_H

#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

/* sum of every cell, from the cells of all members. False, with the fault recorded, if one exceeds its range. */
bool collide_sum(const struct state *state, const struct model *model, struct work *work, uint64_t step);

/* turn of every cell, from its sum: v_cm and axis where there are two members or more, factor 1. */
void collide_solve(const struct model *model, struct work *work, uint64_t step);

/* relative of every cell, and the thermostat's factor from it; the model has one. False, with the fault recorded, if
 * the energies exceed their range. */
bool collide_thermostat(const struct state *state, const struct model *model, struct work *work, uint64_t step);

/* Velocities of all members, from the turns of their cells (srd_apply). */
void collide_turn(struct state *state, const struct model *model, const struct work *work);

#endif
