/* Who meets the bead: the particles that may come so near in a drift that they follow ticks (bead/flight.c). */
#ifndef UNCROSS_BEAD_MEET_H
#define UNCROSS_BEAD_MEET_H

#include <math.h>

#include "bead/flight.h"
#include "fluid/boundary.h"

/* Takes those who may meet the bead while it is off its free flight by at most `slack`, a0, but not those who may while
 * it is off by `known`: they have been taken. What walls give them in a flight without a bead is taken back. False,
 * with the fault recorded, if memory is short. */
bool bead_meet(const struct state *state, const struct model *model, double known, double slack,
               struct bead_flight *all, struct fault *fault);

/* The rate of a velocity in a flight of so many t0, lattice units per tick. */
static inline struct point bead_rate(struct vec3 velocity, double time)
{
  const double scale = time * LATTICE_PER_A0 / FLIGHT_TICKS;
  return (struct point){llrint(velocity.x * scale), llrint(velocity.y * scale), llrint(velocity.z * scale)};
}

/* The drift that begins now: it takes a time step. */
static inline struct span bead_span(const struct state *state, const struct model *model)
{
  struct span span = boundary_lag(state, model);
  span.time = model->time_step;
  return span;
}

#endif
