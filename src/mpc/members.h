/* cell_add for many solvent particles at once, in loops that vectorise. */
#ifndef UNCROSS_MPC_MEMBERS_H
#define UNCROSS_MPC_MEMBERS_H

#include "mpc/mpc.h"

/* Adds n members of mass 1 with these velocities, a0/t0, [n] each, to the cells of particles `first` .. first + n - 1
 * (mpc->solvent_cell). Returns the bitwise or of what cell_add returns for each. */
uint64_t members_add(struct mpc *mpc, uint32_t first, uint32_t n, const double *vx, const double *vy, const double *vz);

/* Asks for the turns of the cells of particles first .. first + n - 1, if mpc->prefetch says that it helps. */
static inline void members_prefetch_turns(const struct mpc *mpc, uint32_t first, uint32_t n)
{
  for (uint32_t i = first; mpc->prefetch && i < first + n; i++)
    __builtin_prefetch(&mpc->turn[mpc->solvent_cell[i]]);
}

#endif
