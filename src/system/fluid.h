/*
 * The contract of a fluid: what streams between collisions. The rows are in fluid/. A collision streams its fluid a
 * block at a time; it gets the row of the scene in struct mpc (work_alloc), and so mpc/ needs no header of fluid/.
 */
#ifndef UNCROSS_SYSTEM_FLUID_H
#define UNCROSS_SYSTEM_FLUID_H

#include "system/fault.h"
#include "system/model.h"
#include "system/state.h"

/* Components of a stress: momentum along the first axis, handed on along the second. */
enum { STRESS_XY, STRESS_XX, STRESS_YY, STRESS_ZZ, STRESS_COMPONENTS };

/* Flights that end at a collision, after the members beyond a sheared boundary have entered the cells there
 * (mpc/border.h). */
struct flux_frame {
  double time;               /* of the flights, t0 */
  struct vec3 at_zero, rate; /* the linear flow that is taken off: at_zero + rate y, a0/t0 */
  int64_t beyond;            /* who is here or above along y has the velocity of the image below the box */
};

/* What particles carry, in units of FLUX_UNIT, so that the order of particles does not matter. w: velocity of a
 * particle relative to the flow at half the flight. Between walls of those with 1 < y < L - 1. */
struct flux_sum {
  int64_t n, wx, wy, wz;
  int64_t product[STRESS_COMPONENTS]; /* kT: w_a w_b */
  int64_t spring[STRESS_COMPONENTS];  /* kT: K r_a r_b of dumbbells */
};

#define FLUX_SCALE 0x1p28 /* sums of up to 2^31 terms below 2^4 on average */
#define FLUX_UNIT 0x1p-28

static inline int64_t flux_fixed(double x)
{
  return lattice_round(FLUX_SCALE * x);
}

/* Acceleration of all particles in flight, a0/t0^2: of a body force without a profile, and what takes up the momentum
 * of a drive (system/bead_drive.c). It is constant until the solvent is streamed again. */
struct vec3 fluid_acceleration(const struct state *state, const struct model *model);

struct fluid {
  const char *name;

  /* Particles that stand side by side in memory, from the first on: ranges that are streamed begin at a multiple of it,
   * and end at one or with the last particle. 0: each stands alone. */
  uint32_t together;

  /* Positions and velocities at step 0: exact samples of equilibrium at kT = 1. The total momentum is taken out later
   * (start_state). */
  void (*start)(struct state *state, const struct model *model);

  /* n particles, from place `first` of memory on, fly for the time by which they are late, and stay in the box.
   * state->solvent_lag is left as it is. False, with the fault recorded, if one would move too far. */
  bool (*stream)(struct state *state, const struct model *model, uint32_t first, uint32_t n, struct fault *fault);

  /* Positions (lattice units, within the box) and velocities (a0/t0) of n particles now, with the lag made up for.
   * Either may be NULL. */
  void (*now)(const struct state *state, const struct model *model, uint32_t first, uint32_t n, struct point *position,
              struct vec3 *velocity);

  /* Adds what the particles that stand together carry. Products are means over the flight. Between walls they are those
   * of half the flight, and of the pull of a spring the share counts that the line between its particles has within
   * 1 < y < L - 1. NULL: none stand together. */
  void (*flux)(const struct state *state, const struct model *model, const struct flux_frame *frame,
               struct flux_sum *sum);
};

#endif
