/* What `gather` of struct kernel does with a block of particles, of LANES of them at once: their flight, their cells,
 * and what they add to the sums of these. */
#ifndef UNCROSS_MPC_GATHER_LANES_H
#define UNCROSS_MPC_GATHER_LANES_H

#include "fluid/flight_lanes.h"
#include "mpc/cell_lanes.h"
#include "mpc/mpc.h"

/* How particles get to their places: by a periodic flight; by one in which a block of them stays clear of what is at
 * the ends of the box along y, or else flies by the plain kernel; or they are there, for dumbbells do not fly alone. */
enum course { COURSE_PERIODIC, COURSE_CLEAR, COURSE_THERE };

/* An axis: the flight along it, and the grid. */
struct gather_axis {
  struct flight flight;
  uint64_t shift;
  uint32_t cells;
};

static inline struct gather_axis gather_axis_of(const struct state *state, const struct model *model,
                                                const struct mpc *c, int axis)
{
  return (struct gather_axis){.flight = flight_along(state, model, axis),
                              .shift = (uint64_t)(const int64_t[]){c->shift.x, c->shift.y, c->shift.z}[axis],
                              .cells = (uint32_t)model->box.rows[axis]};
}

/* Flight of LANES particles from place i on, and their places on the grid. */
INLINE words gather_places_lanes(const struct gather_axis *a, uint32_t i, const enum course course,
                                 const bool accelerated, reals *v, words *seen)
{
  if (course != COURSE_THERE)
    return cell_places_lanes(flight_lanes(&a->flight, i, accelerated, v, seen), a->shift, a->cells);
  *v = load_reals(&a->flight.v[i]);
  return cell_places_lanes(load_words(&a->flight.x[i]), a->shift, a->cells);
}

/* For n particles, a multiple of LANES: flight, cells, and what each adds to the sums of its cell, in the order of
 * store_records: its velocity, less the drawn one if there is one. *span: the bitwise or of the sizes of momenta. The
 * sign bit of the result is set where that of boundary_fly_periodic is. */
INLINE uint64_t gather_records_lanes(const struct gather_axis axis[3], const struct mpc *c, uint32_t first, uint32_t n,
                                     const enum course course, const bool accelerated, const bool draws, double *record,
                                     uint64_t *span)
{
  const struct gather_axis x = axis[0], y = axis[1], z = axis[2];
  words seen[3] = {{0}, {0}, {0}}, size = {0};
  uint32_t *cell = c->solvent_cell;
  const double *const xi[3] = {c->drawn[0], c->drawn[1], c->drawn[2]};
  for (uint32_t k = 0; k < n; k += LANES) {
    const uint32_t i = first + k;
    reals v[3];
    const words cx = gather_places_lanes(&x, i, course, accelerated, &v[0], &seen[0]),
                cy = gather_places_lanes(&y, i, course, accelerated, &v[1], &seen[1]),
                cz = gather_places_lanes(&z, i, course, accelerated, &v[2], &seen[2]);
    store_narrow(&cell[i], multiply(multiply(cz, y.cells) + cy, x.cells) + cx);
    for (int a = 0; draws && a < 3; a++)
      v[a] -= load_reals(&xi[a][i]);
    reals column[4] = {cell_momenta_lanes(v[0], &size), cell_momenta_lanes(v[1], &size),
                       cell_momenta_lanes(v[2], &size), (reals)((words){0} + cell_load(1.0))};
    store_records(&record[(size_t)4 * k], column);
  }
  *span = any(size);
  return any(was_outside(seen[0], x.flight.edge) | was_outside(seen[1], y.flight.edge) |
             was_outside(seen[2], z.flight.edge));
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
