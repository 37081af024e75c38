/* Formulas of lattice.h once more, of LANES numbers at once: the same bits. */
#ifndef UNCROSS_BASE_LATTICE_LANES_H
#define UNCROSS_BASE_LATTICE_LANES_H

#include "base/lattice.h"
#include "base/registers.h"

/* n differences q - p of coordinates, as point_difference has them: d[n], a0. */
static inline void lattice_differences(const int64_t *restrict q, const int64_t *restrict p, uint32_t n,
                                       double *restrict d)
{
  uint32_t k = 0;
  for (; k + LANES <= n; k += LANES)
    store_reals(&d[k], reals_from_signed(load_words(&q[k]) - load_words(&p[k])) * LATTICE_UNIT);
  for (; k < n; k++)
    d[k] = (double)(q[k] - p[k]) * LATTICE_UNIT;
}

#endif
