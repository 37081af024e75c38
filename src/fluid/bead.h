/* Flights around a bead. */
#ifndef UNCROSS_FLUID_BEAD_H
#define UNCROSS_FLUID_BEAD_H

#include "system/bead.h"
#include "system/fluid.h"

/* Two points that move: from one to the other, and by how much that grows in a tick; lattice units. */
struct approach {
  struct point apart, rate;
};

/* The last whole tick, 0 to most, at which the distance is not below the radius while the next one is below; exact.
 * If it is below already, 0 where they approach each other. -1 if there is no such tick. Components of `apart` are
 * below 2^51 and of `rate` below 2^40; the radius is below 2^50. */
int64_t bead_touch(const struct approach *approach, int64_t radius, int64_t most);

/* The state's bead at the start: at its place, with a velocity from the Maxwell distribution. */
void bead_start(struct state *state, const struct model *model);

/* `steps` of struct fluid. */
extern const struct bead_steps bead_flight_steps;

#endif
