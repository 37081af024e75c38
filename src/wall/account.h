/*
 * The account of the walls: the momentum that each wall has given to the solvent since the start, by particles that hit
 * it and by virtual particles in collisions (Tao, Goetze and Gompper 2008). It is kept in integers, in the units of a
 * cell's momentum (mpc/cell.h), so that it does not depend on the order of particles. Sums wrap, at 2^19 m a0/t0. Along
 * x, the direction of the shear stress, it is counted how often, so that differences between any two times are right.
 */
#ifndef UNCROSS_WALL_ACCOUNT_H
#define UNCROSS_WALL_ACCOUNT_H

#include <math.h>

#include "system/state.h"

#define ACCOUNT_SCALE 0x1p44 /* momentum units per m a0/t0 */
#define ACCOUNT_UNIT 0x1p-44

/* Row of the account. */
static inline uint32_t account_row(enum account_share share, enum wall wall)
{
  return (uint32_t)share * WALLS + (uint32_t)wall;
}

__extension__ typedef __int128 account_wide;
__extension__ typedef unsigned __int128 account_unsigned;

/* Adds momentum units to a sum of them. turns: how often x has passed the upper end of its range, less how often the
 * lower one; a signed number in two's complement. */
static inline void account_add_units(struct point *sum, uint64_t *turns, struct point gain)
{
  const int64_t x = sum->x;
  sum->x = (int64_t)((uint64_t)x + (uint64_t)gain.x);
  *turns += (uint64_t)((gain.x > 0 && sum->x < x) - (gain.x < 0 && sum->x > x));
  sum->y = (int64_t)((uint64_t)sum->y + (uint64_t)gain.y);
  sum->z = (int64_t)((uint64_t)sum->z + (uint64_t)gain.z);
}

/* Adds a momentum, m a0/t0, below 2^19 in size. */
static inline void account_add(struct point *sum, uint64_t *turns, struct vec3 momentum)
{
  account_add_units(sum, turns,
                    (struct point){llrint(ACCOUNT_SCALE * momentum.x), llrint(ACCOUNT_SCALE * momentum.y),
                                   llrint(ACCOUNT_SCALE * momentum.z)});
}

/* The rows of one share, by wall; without sums: nobody keeps it. */
struct account {
  struct point *sums; /* [WALLS] */
  uint64_t *turns;    /* [WALLS] */
};

static inline struct account account_of(struct state *state, enum account_share share)
{
  const uint32_t row = account_row(share, WALL_LOWER);
  return (struct account){&state->wall_momentum[row], &state->wall_turns[row]};
}

static inline void account_enter(struct account account, enum wall wall, struct vec3 momentum)
{
  if (account.sums)
    account_add(&account.sums[wall], &account.turns[wall], momentum);
}

/* What came in along x, m a0/t0, between two sums and their turns. */
static inline double account_along(int64_t before, uint64_t turns_before, int64_t after, uint64_t turns_after)
{
  const int64_t turns = (int64_t)(turns_after - turns_before);
  const account_unsigned sum = (account_unsigned)((account_wide)after - before) + ((account_unsigned)turns << 64);
  return (double)(account_wide)sum * ACCOUNT_UNIT;
}

/* What came in between two sums, m a0/t0, right below 2^19. */
static inline struct vec3 account_between(struct point before, struct point after)
{
  return (struct vec3){(double)(int64_t)((uint64_t)after.x - (uint64_t)before.x) * ACCOUNT_UNIT,
                       (double)(int64_t)((uint64_t)after.y - (uint64_t)before.y) * ACCOUNT_UNIT,
                       (double)(int64_t)((uint64_t)after.z - (uint64_t)before.z) * ACCOUNT_UNIT};
}

#endif
