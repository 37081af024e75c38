/* Boundaries of the box along one axis, for particles in flight. This is the contract of the rows in boundary.c. */
#ifndef UNCROSS_FLUID_BOUNDARY_H
#define UNCROSS_FLUID_BOUNDARY_H

#include "base/lattice.h"

struct boundary {
  const char *name;

  /* n particles fly for a time t under a constant acceleration a. x: their coordinates, lattice units. v: their
   * velocities, a0/t0, which grow by a t (Padding 2009, Eq. (7), one Cartesian component). A particle that is less than
   * one edge outside the box at the end is brought inside. The sign bit of the result is set if a particle is further
   * outside, or if a flight was beyond the range of lattice_round. */
  int64_t (*fly)(uint32_t n, int64_t *restrict x, double *restrict v, double t, double a, int64_t edge);

  /* Brings a coordinate inside that `fly` has left outside. */
  int64_t (*fold)(int64_t x, int64_t edge);
};

/* The boundary of an axis. */
const struct boundary *boundary_of(const struct box *box, int axis);

/* Displacement of a particle of velocity v in a time t under a constant acceleration a, in lattice units: one component
 * of Padding 2009, Eq. (3). It is exact over any number of time steps, and valid below LATTICE_MAX_MOVE. */
static inline int64_t boundary_flight(double v, double a, double t)
{
  return lattice_from_a0(v * t + 0.5 * a * t * t);
}

#endif
