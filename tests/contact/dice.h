/* Numbers for tests (splitmix64: Steele, Lea and Flood 2014), without addresses. */
#ifndef UNCROSS_TESTS_DICE_H
#define UNCROSS_TESTS_DICE_H

#include <stdint.h>

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

/* -size .. size */
static inline int64_t dice_integer(struct dice *d, int64_t size)
{
  return (int64_t)(dice_u64(d) % (2 * (uint64_t)size + 1)) - size;
}

#endif
