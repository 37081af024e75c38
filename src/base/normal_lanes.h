/* random_normal_three once more (normal.h), of LANES draws at once: the same operations in the same order.
 * tests/base/test_elementary.c holds both together, bit by bit. */
#ifndef UNCROSS_BASE_NORMAL_LANES_H
#define UNCROSS_BASE_NORMAL_LANES_H

#include "base/philox_lanes.h"

#define NORMAL_ONE 0x3ff0000000000000 /* the bits of 1; 52 bits of a fraction come after it */

/* -ln u, u = (k + 1/2) 2^-40, k the 32 bits of `high` and then the first 8 of `low`. Only the low halves of both
 * count. */
INLINE reals normal_minus_log(words high, words low)
{
  const uint64_t root_half = 0x3fe6a09e667f3bcd;
  const words fraction = (high & 0xffffffff) << 20 | (low & 0xff000000) >> 12;
  const reals u = (reals)(NORMAL_ONE | fraction) - (1.0 - 0x1p-41);
  const words t = (words)u + (NORMAL_ONE - root_half);
  const reals e = (reals)((t >> 52) | 0x4330000000000000) - (0x1p52 + 1023.0);
  const reals f = (reals)((t & 0x000fffffffffffff) + root_half) - 1.0;
  const reals s = f / (2.0 + f), w = s * s, q = w * w;
  const reals odd = 2.0 / 3.0 + q * (2.0 / 7.0 + q * (2.0 / 11.0));
  const reals even = 2.0 + q * (2.0 / 5.0 + q * (2.0 / 9.0 + q * (2.0 / 13.0)));
  return -(e * 0x1.62e42fefa39efp-1) - s * (even + w * odd);
}

/* x and y, of word 1 and root = sqrt(-ln u). */
INLINE void normal_first_two(words word, reals root, reals *x, reals *y)
{
  const reals turn = (reals)(NORMAL_ONE | (word & 0x3fffff) << 30) - (1.5 - 0x1p-23);
  const reals a = turn * 0x1.921fb54442d18p+0, w = a * a, q = w * w; /* pi/2 */
  const reals s0 = 1.0 + q * (1.0 / 120.0 + q * (1.0 / 362880.0 + q * (1.0 / 6227020800.0)));
  const reals s1 = -1.0 / 6.0 + q * (-1.0 / 5040.0 + q * (-1.0 / 39916800.0));
  const reals c0 = 1.0 + q * (1.0 / 24.0 + q * (1.0 / 40320.0 + q * (1.0 / 479001600.0)));
  const reals c1 = -1.0 / 2.0 + q * (-1.0 / 720.0 + q * (-1.0 / 3628800.0));
  const uint64_t sign = 0x8000000000000000;
  const reals sine = a * (s0 + w * s1), cosine = c0 + w * c1;
  *x = (reals)((words)(root * (cosine - sine)) ^ (word << 40 & sign));
  *y = (reals)((words)(root * (cosine + sine)) ^ (word << 41 & sign));
}

/* z, of word 3 and radius = sqrt(-2 ln u'). */
INLINE reals normal_third(words word, reals radius)
{
  const reals turn = (reals)(NORMAL_ONE | (word & 0xffffff) << 28) - (1.5 - 0x1p-25);
  const reals b = turn * 0x1.921fb54442d18p+1, w = b * b, q = w * w; /* pi */
  const reals s0 =
      1.0 + q * (1.0 / 120.0 + q * (1.0 / 362880.0 + q * (1.0 / 6227020800.0 + q * (1.0 / 355687428096000.0))));
  const reals s1 = -1.0 / 6.0 + q * (-1.0 / 5040.0 + q * (-1.0 / 39916800.0 + q * (-1.0 / 1307674368000.0)));
  return radius * (b * (s0 + w * s1));
}

INLINE void normal_three_lanes(const words w[4], reals out[3])
{
  normal_first_two(w[1], square_root(normal_minus_log(w[0], w[1])), &out[0], &out[1]);
  out[2] = normal_third(w[3], square_root(2.0 * normal_minus_log(w[2], w[3])));
}

#endif
