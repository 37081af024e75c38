/*
 * A heat bath without solvent particles, for fibers without hydrodynamic interactions. It is what the paper's velocity
 * swap (Padding 2009, Sec. V B 2) aims at: vertices collide with solvent that has no memory.
 *
 * In each cell of the shifted grid that holds a vertex, the vertices collide with n phantom particles, n Poisson of
 * mean gamma, whose velocities are of the Maxwell distribution about the flow. The rule of solvent/srd.h needs no more
 * than their total momentum, so they are one member of mass n whose velocity has the variance kT/n per component. They
 * are drawn anew at each collision, and forgotten. The work grows with the vertices, not with the box.
 */
#ifndef UNCROSS_BATH_H
#define UNCROSS_BATH_H

#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

/* All phantoms of a cell as one: m and a0/t0. */
struct phantoms {
  double mass; /* their number; 0: none */
  struct vec3 velocity;
};

/* The phantoms of this cell at this step. */
struct phantoms bath_phantoms(const struct model *model, uint64_t step, uint32_t cell);

/* Lists the cells that hold a vertex, on the grid shifted by this much: work->collision.occupied, their number in
 * .cells, and for each vertex the place of its cell in that list, in .vertex_cell. */
void bath_bin(const struct state *state, const struct model *model, struct work *work, struct point shift);

/* The collision of step number `step` with phantoms. False, with the fault recorded, if a cell exceeds the range of its
 * sums. */
bool bath_collide(struct state *state, const struct model *model, struct work *work, uint64_t step);

#endif
