/* cell_add for many members at once, in loops that vectorise. */
#ifndef UNCROSS_MPC_MEMBERS_H
#define UNCROSS_MPC_MEMBERS_H

#include "mpc/mpc.h"

/* Adds n members of mass 1 with these velocities, a0/t0, [n] each, to the cells of particles `first` .. first + n - 1
 * (mpc->solvent_cell). Returns the bitwise or of what cell_add returns for each. */
uint64_t members_add(struct mpc *mpc, uint32_t first, uint32_t n, const double *vx, const double *vy, const double *vz);

/* The same for all vertices (mpc->vertex_cell). */
uint64_t members_add_vertices(const struct state *state, const struct model *model, struct mpc *mpc);

enum { MEMBERS_AHEAD = 24 }; /* so many vertices ahead, the sums and turns of their cells are asked for */

static inline uint32_t members_vertex_ahead(const struct state *state, uint32_t v)
{
  return v + MEMBERS_AHEAD < state->vertices ? v + MEMBERS_AHEAD : v;
}

/* Asks for the turns of the cells of particles first .. first + n - 1, if mpc->prefetch says that it helps. */
static inline void members_prefetch_turns(const struct mpc *mpc, uint32_t first, uint32_t n)
{
  for (uint32_t i = first; mpc->prefetch && i < first + n; i++)
    __builtin_prefetch(&mpc->turn[mpc->solvent_cell[i]]);
}

#endif
