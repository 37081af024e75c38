/*
 * One collision of the whole suspension, and its parts for the oracle and for tests. mpc_collide gives what these give
 * in this order, after grid_bin; where nobody reads the sums of cells, it goes shorter ways. All parts but the last
 * change struct mpc only.
 */
#ifndef UNCROSS_MPC_COLLIDE_H
#define UNCROSS_MPC_COLLIDE_H

#include "mpc/mpc.h"
#include "mpc/thermostat.h"

/* The collision of step number `step`: particles fly for the time by which they are late (struct fluid). Then come grid
 * shift, cell sums over solvent and vertices, the collision rule, the thermostat, and the velocity swap where
 * hydrodynamics is off. Positions of vertices must be those of the time of the collision.
 * False, with the fault recorded, if a particle would move too far or a cell exceeds the range of its sums. */
bool mpc_collide(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, struct fault *fault);

/* Computes `sum` of every cell, from the cells of all members. False, with the fault recorded, if one exceeds its
 * range. */
bool collide_sum(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                 struct fault *fault);

/* Computes `turn` of every cell from its sum, by the collision rule: center (and axis) of cells with two members or
 * more, and factor 1. */
void collide_solve(const struct model *model, struct mpc *mpc, uint64_t step);

/* Computes `relative` of every cell, and from it the factor of this thermostat. False, with the fault recorded, if the
 * energies exceed their range. */
bool collide_thermostat(const struct state *state, const struct model *model, struct mpc *mpc,
                        const struct thermostat *thermostat, uint64_t step, struct fault *fault);

/* Changes the velocities of all members by the turns of their cells. scaled: with the thermostat's factors. */
void collide_turn(struct state *state, const struct model *model, const struct mpc *mpc, bool scaled);

#endif
