/*
 * The contract of a fluid: what streams between collisions. The rows are in fluid/. A collision streams its fluid a
 * block at a time; it gets the row of the scene in struct mpc (work_alloc), and so mpc/ needs no header of fluid/.
 */
#ifndef UNCROSS_SYSTEM_FLUID_H
#define UNCROSS_SYSTEM_FLUID_H

#include "system/fault.h"
#include "system/model.h"
#include "system/state.h"

struct fluid {
  const char *name;

  /* Particles that stand side by side in memory, from the first on: ranges that are streamed begin at a multiple of it,
   * and end at one or with the last particle. 0: each stands alone. */
  uint32_t together;

  /* Positions and velocities at step 0: exact samples of equilibrium at kT = 1. The total momentum is taken out later
   * (step_start). */
  void (*start)(struct state *state, const struct model *model);

  /* n particles, from place `first` of memory on, fly for the time by which they are late, and stay in the box.
   * state->solvent_lag is left as it is. False, with the fault recorded, if one would move too far. */
  bool (*stream)(struct state *state, const struct model *model, uint32_t first, uint32_t n, struct fault *fault);

  /* Positions (lattice units, within the box) and velocities (a0/t0) of n particles now, with the lag made up for.
   * Either may be NULL. */
  void (*now)(const struct state *state, const struct model *model, uint32_t first, uint32_t n, struct point *position,
              struct vec3 *velocity);
};

#endif
