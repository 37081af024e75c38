/* The grid of collision cells, shifted at random in each collision. */
#ifndef UNCROSS_MPC_GRID_H
#define UNCROSS_MPC_GRID_H

#include "mpc/mpc.h"

/* The shift of this step's grid: a uniform random vector in [0,1)^3 cells, in lattice units. A position p belongs to
 * the cell that contains p + shift. */
struct point grid_shift(const struct model *model, uint64_t step);

/* Cell number (z Ry + y) Lx + x of a position on the grid with this shift; Ry: rows along y. Along a periodic axis the
 * position may be outside the box. */
uint32_t grid_cell_of(const struct box *box, struct point position, struct point shift);

/* Fills mpc->shift, .solvent_cell and .vertex_cell: the cells of all solvent particles and vertices on the grid with
 * this shift. Particles must be in the box. */
void grid_bin(const struct state *state, const struct model *model, struct point shift, struct mpc *mpc);

/* The same for n particles from place `first` of memory on, and for the vertices, in a box that is periodic or has
 * walls. The shift is mpc->shift. */
void grid_bin_particles(const struct state *state, const struct model *model, uint32_t first, uint32_t n,
                        struct mpc *mpc);
void grid_bin_vertices(const struct state *state, const struct model *model, struct mpc *mpc);

#endif
