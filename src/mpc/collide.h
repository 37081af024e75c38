/*
 * One collision of the whole suspension, and its parts: for the oracle, for tests, and for src/kernel/, which does the
 * same in shorter ways. All parts but the last two change struct mpc only.
 */
#ifndef UNCROSS_MPC_COLLIDE_H
#define UNCROSS_MPC_COLLIDE_H

#include "mpc/mpc.h"
#include "mpc/thermostat.h"

/* Particles per block. A block goes through several operations while it is in the cache. Smaller blocks would keep the
 * processor from reading ahead. */
#define COLLIDE_BLOCK 16384u

/* The collision of step number `step`: particles fly for the time by which they are late (struct fluid). Then come grid
 * shift, cell sums over solvent and vertices, the collision rule, the thermostat, and the velocity swap where
 * hydrodynamics is off. Positions of vertices must be those of the time of the collision.
 * False, with the fault recorded, if a particle would move too far or a cell exceeds the range of its sums.
 * It is done by mpc->kernel; collide_plain is that of the plain one, which says what all others do. */
bool mpc_collide(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, struct fault *fault);
bool collide_plain(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, struct fault *fault);

/* Sets the sums of all cells to 0. */
void collide_clear(struct mpc *mpc);

/* Gives n particles, from place `first` of memory on, their cells, and adds them to the sums. They have flown. Returns
 * what add_particles of struct collision_rule returns. */
uint64_t collide_bin_and_add(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                             uint32_t first, uint32_t n);

/* The same of all vertices, when all particles have flown and are in the sums. *span: the bitwise or of all that was
 * returned so far; theirs is added. False, with the fault recorded, if a particle in an obstacle's way moves too far.
 */
bool collide_add_vertices(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                          uint64_t *span, struct fault *fault);

/* Looks whether the sums are in range, adds virtual members, and what the stress needs from before the turns. False,
 * with the fault recorded, if a cell exceeds its range. */
bool collide_fill(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, uint64_t span,
                  struct fault *fault);

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

/* What follows the turns: stress and account of the border, images go home, velocities are swapped, memory is sorted.
 */
void collide_leave(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step);

#endif
