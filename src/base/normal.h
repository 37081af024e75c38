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

/* The first of the pair for each of n entities, n <= RANDOM_UNIFORMS, of uniform deviates u and v: x[n]. The same bits,
 * in a loop that vectorises. */
void random_normal_firsts(const double *u, const double *v, uint32_t n, double *x);

/* Three independent standard normal deviates for each of n entities, columns of n numbers each: x and y are the pair
 * of draw 0, z is the first of the pair of draw 1. The same bits as random_normal_pair, in loops that vectorise. */
void random_normal_columns(uint64_t seed, enum random_purpose purpose, uint64_t step, const uint32_t *entity,
                           uint32_t n, double *restrict x, double *restrict y, double *restrict z);

/*
 * Three independent standard normal deviates from the words of one draw, for rules that draw a velocity for each member
 * in each collision. They have fewer random bits and fewer digits than a normal pair, and cost a third of two:
 *
 *   x, y = +- sqrt(-ln u) (cos a -+ sin a),   z = sqrt(-2 ln u') sin b,
 *
 * a uniform in (-pi/4, pi/4), b in (-pi/2, pi/2): points of the circle again, for cos(pi/4 + a) = (cos a - sin
 * a)/sqrt 2. u and u' have 40 bits, of words 0, 1 and 2, 3; the signs, a and b have the 24 bits that are left of words
 * 1 and 3. The largest magnitude is 7.54, that of u = 2^-41. Errors are below 2e-12 of the radius: the series of
 * logarithm, cosine and sine are those of elementary.h, shorter. docs/elementary.md has them operation by operation.
 */
void random_normal_three(struct random_words r, double out[3]);

/* The same of draw `draw` of each of n entities, columns of n numbers each, in loops that vectorise. */
void random_normal_three_columns(uint64_t seed, enum random_purpose purpose, uint32_t draw, uint64_t step,
                                 const uint32_t *entity, uint32_t n, double *restrict x, double *restrict y,
                                 double *restrict z);

/* The third of random_normal_three from words 2 and 3 of each of n draws, n <= RANDOM_UNIFORMS: the low halves count.
 */
void random_normal_third_column(const uint64_t *restrict word2, const uint64_t *restrict word3, uint32_t n,
                                double *restrict z);

#endif
