/* random_axis once more (random.h), of LANES entities at once: the same operations in the same order. */
#ifndef UNCROSS_BASE_AXIS_LANES_H
#define UNCROSS_BASE_AXIS_LANES_H

#include "base/philox_lanes.h"

/* Unit vectors by the words of this draw: as random_axis_from, but in lanes where both pairs of words are outside the
 * unit disk z <= -1. */
INLINE void axis_lanes(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step, words entity,
                       reals axis[3])
{
  words w[4];
  philox_words(seed, purpose, draw, step, entity, w);
  const reals u0 = reals_in_square(w[0]), v0 = reals_in_square(w[1]);
  const reals u1 = reals_in_square(w[2]), v1 = reals_in_square(w[3]);
  const reals s0 = u0 * u0 + v0 * v0, s1 = u1 * u1 + v1 * v1;
  const wholes first = s0 < 1.0;
  const reals u = choose(first, u0, u1), v = choose(first, v0, v1), s = choose(first, s0, s1);
  const reals root = square_root(1.0 - s);
  axis[0] = 2.0 * u * root;
  axis[1] = 2.0 * v * root;
  axis[2] = 1.0 - 2.0 * s;
}

#endif
