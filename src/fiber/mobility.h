/*
 * Diffusion tensors of n equal spheres of radius a in an unbounded fluid, in units of that of one of them, D0: blocks
 * D_ij = p I + q e e, with e the unit vector between spheres i and j, r apart.
 *
 *   oseen   p = 3a/4r, q = 3a/4r. Not positive where spheres are near each other (r < 3a/2 of two).
 *   rpy     r >= 2a: p = (3a/4r)(1 + 2a^2/3r^2), q = (3a/4r)(1 - 2a^2/r^2);
 *           r <  2a: p = 1 - 9r/32a, q = 3r/32a. Positive for all places.
 *
 * Rotne and Prager, J. Chem. Phys. 50, 4831 (1969), overlaps included; Yamakawa, J. Chem. Phys. 53, 436 (1970). All
 * have sum_j grad_j.D_ij = 0.
 */
#ifndef UNCROSS_FIBER_MOBILITY_H
#define UNCROSS_FIBER_MOBILITY_H

#include "system/model.h"

struct mobility {
  const char *name;

  /* The factors of two spheres at the distance r, for the radius a. NULL: no tensor, spheres do not feel each other. */
  void (*block)(double r, double a, double *p, double *q);
};

const struct mobility *mobility_of(enum medium_tensor tensor);

/* Fills the lower triangle of D/D0, [3n][3n] by columns: entry (i, k), i >= k, at k 3n + i. */
void mobility_fill(const struct mobility *mobility, double a, uint32_t n, const struct vec3 *place, double *d);

/* y = D x for such a matrix of order n. */
void mobility_apply(uint32_t n, const double *restrict d, const double *restrict x, double *restrict y);

/* Replaces D by its Cholesky factor L, D = L L^T. A pivot within 1e-12 of 0 counts as 0: spheres at one place. False if
 * D is not positive; *pivot is that which failed then. */
bool mobility_factor(uint32_t n, double *d, double *pivot);

/* y = L x. */
void mobility_root(uint32_t n, const double *restrict l, const double *restrict x, double *restrict y);

/* Replaces x by the solution of L L^T y = x. No pivot of L may be 0. */
void mobility_solve(uint32_t n, const double *restrict l, double *restrict x);

#endif
