/* elementary_log and the cosine of elementary_circle_turns once more (elementary.h), of LANES numbers at once: the same
 * operations in the same order. */
#ifndef UNCROSS_BASE_ELEMENTARY_LANES_H
#define UNCROSS_BASE_ELEMENTARY_LANES_H

#include "base/elementary.h"
#include "base/registers.h"

INLINE reals elementary_log_lanes(reals x)
{
  const uint64_t one = 0x3ff0000000000000, root_half = 0x3fe6a09e667f3bcd; /* 1 and sqrt(1/2) */
  const words t = (words)x + (one - root_half);
  const reals e = (reals)((t >> 52) | 0x4330000000000000) - (0x1p52 + 1023.0);
  const reals f = (reals)((t & 0x000fffffffffffff) + root_half) - 1.0;
  const reals h = 0.5 * f * f, s = f / (2.0 + f), z = s * s, w = z * z;
  const reals odd = 2.0 / 3.0 + w * (2.0 / 7.0 + w * (2.0 / 11.0 + w * (2.0 / 15.0 + w * (2.0 / 19.0))));
  const reals even = 2.0 / 5.0 + w * (2.0 / 9.0 + w * (2.0 / 13.0 + w * (2.0 / 17.0 + w * (2.0 / 21.0))));
  const reals rest = s * (h + (z * odd + w * even)) - h;
  const reals whole = e * ELEMENTARY_LN2, sum = whole + f, lost = (whole - sum) + f;
  return sum + (rest + (lost + e * ELEMENTARY_LN2_REST));
}

/* cos(2 pi u) */
INLINE reals elementary_cosine_turns_lanes(reals u)
{
  const double high = ELEMENTARY_QUARTER, low = ELEMENTARY_QUARTER_REST;
  const reals quarters = 4.0 * u, turned = quarters + ELEMENTARY_ROUND, t = quarters - (turned - ELEMENTARY_ROUND);
  const reals t1 = (reals)((words)t & 0xfffffffff8000000), t2 = t - t1;
  const reals exact = t1 * high, rest = t2 * high + t * low;
  const reals x = exact + rest, lost = rest - (x - exact), z = x * x, w = z * z;
  const reals s0 = -1.0 / 6.0 + w * (-1.0 / 5040.0 + w * (-1.0 / 39916800.0 + w * (-1.0 / 1307674368000.0)));
  const reals s1 = 1.0 / 120.0 + w * (1.0 / 362880.0 + w * (1.0 / 6227020800.0 + w * (1.0 / 355687428096000.0)));
  const reals along = x + (lost + x * (z * (s0 + z * s1)));
  const reals c0 = 1.0 / 24.0 + w * (1.0 / 40320.0 + w * (1.0 / 479001600.0 + w * (1.0 / 20922789888000.0)));
  const reals c1 = -1.0 / 720.0 + w * (-1.0 / 3628800.0 + w * (-1.0 / 87178291200.0));
  const reals h = 0.5 * z, less = 1.0 - h;
  const reals across = less + (((1.0 - less) - h) + (w * (c0 + z * c1) - x * lost));
  const words n = (words)turned, a = (words)along, c = (words)across;
  const words exchange = (a ^ c) & (0 - (n & 1)), sign = ((n + 1) & 2) << 62;
  return (reals)(c ^ exchange ^ sign) + 0.0;
}

#endif
