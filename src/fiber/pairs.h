/*
 * Pairs of bonds, and images of bonds, that are near each other: one flat list in no order, read through once per
 * sweep.
 *
 * A pair knows how many times its two bonds had looked for partners when it was found. When one of them looks again,
 * all its pairs are out of date, with nobody having to find them: what is near is found anew, and the old ones are
 * dropped when they are next read.
 */
#ifndef UNCROSS_PAIRS_H
#define UNCROSS_PAIRS_H

#include "state/work.h"

/* A pair that has just been found, due in the next sweep. False if memory is short. */
bool pairs_add(struct neighbors *nb, uint32_t bond, struct neighbor n);

/* Pair k goes, and the last one takes its place. */
void pairs_drop(struct neighbors *nb, uint32_t k);

/* Was pair k found before one of its bonds last looked for partners? Then the list has it anew, or they are apart. */
static inline bool pairs_out_of_date(const struct neighbors *nb, uint32_t k)
{
  const struct pair_list *p = &nb->pairs;
  return p->generation[k] != nb->clock[p->bond[k]].generation + nb->clock[p->other[k]].generation;
}

#endif
