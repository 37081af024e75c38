/*
 * A heat bath without solvent particles, for fibers without hydrodynamic interactions. Vertices collide with a solvent
 * that has no memory, as the paper's velocity swap intends (Padding 2009, Sec. V B 2).
 *
 * In each cell of the shifted grid that holds a vertex, the vertices collide with n phantom particles, n Poisson of
 * mean gamma, whose velocities are of the Maxwell distribution about the flow. A collision rule needs only their total
 * momentum, so they are added as one member of mass n whose velocity has the variance kT/n per component. They are
 * drawn anew for each collision. The cost grows with the number of vertices, not with the box.
 */
#ifndef UNCROSS_MPC_RANDOM_SOLVENT_H
#define UNCROSS_MPC_RANDOM_SOLVENT_H

#include "mpc/mpc.h"

/* All phantoms of a cell as one member. Units m and a0/t0. */
struct phantoms {
  double mass; /* their number; 0: none */
  struct vec3 velocity;
};

/* The phantoms of this cell at this step. For tests and tools: a collision draws those of many cells at a time. */
struct phantoms random_solvent_phantoms(const struct model *model, uint64_t step, uint32_t cell);

/* Lists the cells that hold a vertex, on the grid with this shift. Fills mpc->occupied (numbers of these cells), .cells
 * (how many there are) and .vertex_cell (place of each vertex's cell in the list). */
void random_solvent_bin(const struct state *state, const struct model *model, struct point shift, struct mpc *mpc);

/* The collision of step number `step` with phantoms. False, with the fault recorded, if a cell exceeds the range of its
 * sums. */
bool random_solvent_collide(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                            struct fault *fault);

#endif
