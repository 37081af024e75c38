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

/* The grid of this step is shifted by a uniform random vector in [0,1)^3 cells: a position p lies in the cell of
 * p + shift. Lattice units. */
struct point solvent_grid_shift(const struct model *model, uint64_t step);

/* Cell number (z Ly + y) Lx + x of a position anywhere, on the grid shifted by this much. */
uint32_t solvent_cell_of(const struct box *box, struct point position, struct point shift);

/* The cells of all solvent particles and vertices on this grid, into work->collision; particles must be in the box. */
void solvent_bin(const struct state *state, const struct model *model, struct work *work, struct point shift);

/* The collision of step number `step`: grid shift, cell sums over solvent and vertices, rotation, thermostat, and the
 * velocity swap where hydrodynamics is off. Positions must stand at the time of the collision.
 * False, with the fault recorded, if a cell exceeds the range of its sums. */
bool solvent_collide(struct state *state, const struct model *model, struct work *work, uint64_t step);

/* Solvent velocities permuted at random over the particles (Padding 2009, Sec. V B 2): particle id takes the velocity
 * of particle order[id]. */
void solvent_swap_velocities(struct state *state, const struct model *model, struct work *work, uint64_t step);

/* Particles reordered in memory by the cells of the unshifted grid; no effect on results. */
void solvent_sort(struct state *state, const struct model *model, struct work *work);

/* Uniform positions, Maxwell velocities (kT = 1). Momentum is taken out by start.c. */
void solvent_start(struct state *state, const struct model *model);

#endif
