/* The solvent: streaming, and the collision step that couples it to the fibers (Padding 2009, Sec. III, steps 2, 4). */
#ifndef UNCROSS_SOLVENT_H
#define UNCROSS_SOLVENT_H

#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

/* Lets every solvent particle fly for the time it lags behind (Eqs. (3) and (7) at once, exact for the constant body
 * force), and wraps it into the box. Afterwards the lag is 0.
 * False, with the fault recorded, if a particle would move too far. */
bool solvent_stream(struct state *state, const struct model *model, struct work *work);

/* The same for n particles from number `first` on, whose lag stays as it is. */
bool solvent_stream_some(struct state *state, const struct model *model, struct work *work, uint32_t first, uint32_t n);

/* The grid of this step is shifted by a uniform random vector in [0,1)^3 cells: a position p lies in the cell of
 * p + shift. Lattice units. */
struct point solvent_grid_shift(const struct model *model, uint64_t step);

/* Cell number (z Ly + y) Lx + x of a position anywhere, on the grid shifted by this much. */
uint32_t solvent_cell_of(const struct box *box, struct point position, struct point shift);

/* The cells of all solvent particles and vertices on this grid, into work->collision; particles must be in the box. */
void solvent_bin(const struct state *state, const struct model *model, struct work *work, struct point shift);

/* The same for n particles from number `first` on, and for the vertices. */
void solvent_bin_some(const struct state *state, const struct model *model, struct work *work, struct point shift,
                      uint32_t first, uint32_t n);
void solvent_bin_vertices(const struct state *state, const struct model *model, struct work *work, struct point shift);

/* The collision of step number `step`: solvent particles fly for the time that they lag behind (as solvent_stream has
 * it), then grid shift, cell sums over solvent and vertices, rotation, thermostat, and the velocity swap where
 * hydrodynamics is off. Positions of vertices must stand at the time of the collision.
 * False, with the fault recorded, if a particle would move too far or a cell exceeds the range of its sums. */
bool solvent_collide(struct state *state, const struct model *model, struct work *work, uint64_t step);

/* Solvent velocities permuted at random over the particles (Padding 2009, Sec. V B 2): particle id takes the velocity
 * of particle order[id]. */
void solvent_swap_velocities(struct state *state, const struct model *model, struct work *work, uint64_t step);

/* Particles reordered in memory by the cells of the unshifted grid; no effect on results. */
void solvent_sort(struct state *state, const struct model *model, struct work *work);

/* Uniform positions, Maxwell velocities (kT = 1). Momentum is taken out by start.c. */
void solvent_start(struct state *state, const struct model *model);

#endif
