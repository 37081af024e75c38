/* Formulas of lattice.h once more, of LANES numbers at once: the same bits. */
#ifndef UNCROSS_BASE_LATTICE_LANES_H
#define UNCROSS_BASE_LATTICE_LANES_H

#include "base/lattice.h"
#include "base/registers.h"

/* Vectors q - p of n pairs of points, as point_difference has them: d[n], a0. */
static inline void point_differences(const struct point *restrict q, const struct point *restrict p, uint32_t n,
                                     struct vec3 *restrict d)
{
  const int64_t *a = &q->x, *b = &p->x;
  double *difference = &d->x;
  uint32_t k = 0;
  for (; k + LANES <= 3 * n; k += LANES)
    store_reals(&difference[k], reals_from_signed(load_words(&a[k]) - load_words(&b[k])) * LATTICE_UNIT);
  for (; k < 3 * n; k++)
    difference[k] = (double)(a[k] - b[k]) * LATTICE_UNIT;
}

#endif
