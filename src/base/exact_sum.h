/* A sum that does not depend on the order of its terms: each is split into a multiple of 2^-16 and a multiple of 2^-50
 * (rounded), and integers are summed. Terms below 2^34; 2^29 terms. */
#ifndef UNCROSS_BASE_EXACT_SUM_H
#define UNCROSS_BASE_EXACT_SUM_H

#include "base/lattice.h"

struct exact_sum {
  int64_t coarse, fine;
};

#define EXACT_LARGEST 0x1p34 /* terms are smaller */

static inline void exact_add(struct exact_sum *sum, double x)
{
  const double coarse = (x * 0x1p16 + 0x1.8p52) - 0x1.8p52; /* the integer that lattice_round gives, as a double */
  sum->coarse += lattice_round(x * 0x1p16);
  sum->fine += lattice_round((x - coarse * 0x1p-16) * 0x1p50);
}

static inline double exact_value(const struct exact_sum *sum)
{
  return (double)sum->coarse * 0x1p-16 + (double)sum->fine * 0x1p-50;
}

#endif
