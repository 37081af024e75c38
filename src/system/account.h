/*
 * The account of the walls: the momentum that each wall has given to the solvent since the start, by particles that hit
 * it and by virtual particles in collisions (Tao, Goetze and Gompper 2008). It is kept in integers, in the units of a
 * cell's momentum (mpc/cell.h), so that it does not depend on the order of particles. Sums wrap: differences between
 * two times are right while they are below 2^19 m a0/t0.
 */
#ifndef UNCROSS_SYSTEM_ACCOUNT_H
#define UNCROSS_SYSTEM_ACCOUNT_H

#include <math.h>

#include "system/shear.h"
#include "system/state.h"

#define ACCOUNT_SCALE 0x1p44 /* momentum units per m a0/t0 */
#define ACCOUNT_UNIT 0x1p-44

/* Row of the account. */
static inline uint32_t account_row(enum account_share share, enum wall wall)
{
  return (uint32_t)share * WALLS + (uint32_t)wall;
}

/* Adds a momentum, m a0/t0, to a sum in momentum units. */
static inline void account_add(struct point *sum, struct vec3 momentum)
{
  sum->x = (int64_t)((uint64_t)sum->x + (uint64_t)llrint(ACCOUNT_SCALE * momentum.x));
  sum->y = (int64_t)((uint64_t)sum->y + (uint64_t)llrint(ACCOUNT_SCALE * momentum.y));
  sum->z = (int64_t)((uint64_t)sum->z + (uint64_t)llrint(ACCOUNT_SCALE * momentum.z));
}

/* What came in between two sums, m a0/t0. */
static inline struct vec3 account_between(struct point before, struct point after)
{
  return (struct vec3){(double)(int64_t)((uint64_t)after.x - (uint64_t)before.x) * ACCOUNT_UNIT,
                       (double)(int64_t)((uint64_t)after.y - (uint64_t)before.y) * ACCOUNT_UNIT,
                       (double)(int64_t)((uint64_t)after.z - (uint64_t)before.z) * ACCOUNT_UNIT};
}

#endif
