/*
 * Two bonds between two frames: do they meet while their ends move straight and evenly, t from 0 to 1?
 *
 * With bonds p and q and w from the start of p to the start of q, all linear in t, the lines meet at the roots of the
 * cubic f = (p x q).w, and there at the fractions s = (w x q).n / n^2 of p and s' = (w x p).n / n^2 of q, n = p x q.
 * All differences are whole numbers, so they are exact; what floating point makes of them is held against bounds of its
 * error. What these cannot decide is UNSURE, and left to exact numbers (python/uncross_topology/exact.py).
 */
#ifndef UNCROSS_TOPOLOGY_PAIR_H
#define UNCROSS_TOPOLOGY_PAIR_H

#include <stdbool.h>

#include "base/vec3.h"

#define PAIR_REACH 0x1p50 /* lattice units: sums of three differences below it are exact */

/* At t = 0 and 1, in whole lattice units. */
struct pair {
  struct vec3 p[2], q[2], w[2];
};

enum pair_verdict { PAIR_APART, PAIR_CROSSED, PAIR_UNSURE };

/* sign: of f's derivative. t, s, s': to some 1e-7. */
struct crossing {
  int sign;
  double t, s[2];
};

/* Up to three crossings, in the order of time. PAIR_CROSSED: they are all meetings, and strictly inside bonds and
 * interval. */
enum pair_verdict pair_decide(const struct pair *a, struct crossing crossing[3], int *crossings);

/* Of bonds that share a vertex, from which p and q begin: PAIR_APART if they never fold, PAIR_UNSURE if they might. */
enum pair_verdict pair_folds(const struct pair *a);

/* Whether inner points of the bonds are nearer than `near` lattice units at t = 0, up to rounding. */
bool pair_is_near(const struct pair *a, double near);

#endif
