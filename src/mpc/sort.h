/* Exchange of velocities (physics: hydrodynamics off), and of places in memory (speed only). */
#ifndef UNCROSS_MPC_SORT_H
#define UNCROSS_MPC_SORT_H

#include "mpc/mpc.h"

/* Permutes the solvent's velocities at random over the particles (Padding 2009, Sec. V B 2): particle id takes the
 * velocity of particle order[id], order the permutation of this step. mpc->order is then the places in memory of the
 * particles order[0], order[1], ... */
void mpc_swap_velocities(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step);

/* Sorts particles in memory by the cells of the unshifted grid. No effect on results. */
void mpc_sort(struct state *state, const struct model *model, struct mpc *mpc);

#endif
