/*
 * Standard normal deviates (Box and Muller, Ann. Math. Stat. 29, 610 (1958)) at addresses of random numbers, with the
 * logarithm, cosine and sine of elementary.h: the same bits on every machine. The largest magnitude is 8.57, that of
 * the smallest uniform number, 2^-53.
 */
#ifndef UNCROSS_BASE_NORMAL_H
#define UNCROSS_BASE_NORMAL_H

#include "base/elementary.h"
#include "base/random.h"

/* Two independent standard normal deviates: sqrt(-2 ln u) times cosine and sine of 2 pi v, with u and v the uniform
 * deviates 0 and 1 of these words. */
void random_normal_pair(struct random_words r, double out[2]);

/* Three independent standard normal deviates for each of n entities, columns of n numbers each: x and y are the pair
 * of draw 0, z is the first of the pair of draw 1. The same bits as random_normal_pair, in loops that vectorise. */
void random_normal_columns(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity,
                           uint32_t n, double *restrict x, double *restrict y, double *restrict z);

#endif
