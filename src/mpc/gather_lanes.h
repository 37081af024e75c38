/* What `gather` of struct kernel does with LANES particles at once when they have flown: their cells, and what they add
 * to the sums of these. */
#ifndef UNCROSS_MPC_GATHER_LANES_H
#define UNCROSS_MPC_GATHER_LANES_H

#include "mpc/cell_lanes.h"
#include "mpc/mpc.h"

/* The grid along an axis. */
struct gather_axis {
  uint64_t shift;
  uint32_t cells;
};

static inline struct gather_axis gather_axis_of(const struct model *model, const struct mpc *c, int axis)
{
  return (struct gather_axis){.shift = (uint64_t)(const int64_t[]){c->shift.x, c->shift.y, c->shift.z}[axis],
                              .cells = (uint32_t)model->box.rows[axis]};
}

/* The cells of particles, from their coordinates. */
INLINE void gather_cells_lanes(const struct gather_axis axis[3], const words x[3], uint32_t *cell)
{
  const words cx = cell_places_lanes(x[0], axis[0].shift, axis[0].cells),
              cy = cell_places_lanes(x[1], axis[1].shift, axis[1].cells),
              cz = cell_places_lanes(x[2], axis[2].shift, axis[2].cells);
  store_narrow(cell, multiply(multiply(cz, axis[1].cells) + cy, axis[0].cells) + cx);
}

/* What particles from place i on add to the sums of their cells, in the order of store_records: their velocities, less
 * the drawn ones if there are. *span: or'ed with the sizes of momenta. */
INLINE void gather_records_lanes(reals v[3], const double *const drawn[3], uint32_t i, const bool draws, words *span,
                                 double *record)
{
  UNROLL
  for (int a = 0; a < 3 * draws; a++)
    v[a] -= load_reals(&drawn[a][i]);
  reals column[4] = {cell_momenta_lanes(v[0], span), cell_momenta_lanes(v[1], span), cell_momenta_lanes(v[2], span),
                     (reals)((words){0} + cell_load(1.0))};
  store_records(record, column);
}

/* Adds the records to the sums of these cells. */
static inline void gather_add_lanes(struct cell_sum *sum, const uint32_t *cell, uint32_t n, const double *record)
{
  for (uint32_t k = 0; k < n; k += LANES) {
    UNROLL
    for (uint32_t slot = 0; slot < LANES; slot++)
      add_record((uint64_t *)&sum[cell[k + slot_lane[slot]]], &record[(size_t)4 * (k + slot)]);
  }
}

#endif
