/* Inside the oracle: numbers for constructed inputs (splitmix64: Steele, Lea and Flood 2014). They have no addresses,
 * and nothing of a run depends on them. */
#ifndef UNCROSS_ORACLE_DICE_H
#define UNCROSS_ORACLE_DICE_H

#include "base/lattice.h"

struct dice {
  uint64_t state;
};

static inline uint64_t dice_u64(struct dice *d)
{
  uint64_t z = (d->state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

static inline double dice_between(struct dice *d, double low, double high)
{
  return low + (high - low) * ((double)(dice_u64(d) >> 11) * 0x1p-53);
}

/* -size .. size */
static inline int64_t dice_integer(struct dice *d, int64_t size)
{
  return (int64_t)(dice_u64(d) % (2 * (uint64_t)size + 1)) - size;
}

static inline struct point dice_point(struct dice *d, int64_t size)
{
  const int64_t x = dice_integer(d, size), y = dice_integer(d, size), z = dice_integer(d, size);
  return (struct point){x, y, z};
}

static inline struct vec3 dice_vector(struct dice *d, double size)
{
  const double x = dice_between(d, -size, size), y = dice_between(d, -size, size), z = dice_between(d, -size, size);
  return (struct vec3){x, y, z};
}

#endif
