/* Capsules: all places where a bond may be whose ends stay within a reach of two points. */
#ifndef UNCROSS_CAPSULE_H
#define UNCROSS_CAPSULE_H

#include <stdbool.h>

#include "base/vec3.h"

#define CAPSULE_SLACK 0x1p-16 /* a0: far above all rounding of capsule_distance, far below any reach that matters */

/* Relative to some origin, a0. */
struct capsule {
  struct vec3 a, b;
  double reach;
};

static inline double capsule_least(double a, double b)
{
  return a < b ? a : b;
}

static inline double capsule_most(double a, double b)
{
  return a > b ? a : b;
}

/* How far the interval between a0 and a1 is from the one between b0 and b1; negative if they overlap. */
static inline double capsule_gap(double a0, double a1, double b0, double b1)
{
  return capsule_most(capsule_least(a0, a1) - capsule_most(b0, b1), capsule_least(b0, b1) - capsule_most(a0, a1));
}

static inline double capsule_within_one(double s)
{
  return capsule_most(capsule_least(s, 1.0), 0.0);
}

/* Distance of two bonds, p and q, w from the first end of p to that of q: the least |w + t q - s p|, 0 <= s, t <= 1.
 * For the best s of the two lines, cut to the bond, the best t, cut likewise; and for that, the best s again. What s
 * and t lack in nearly parallel bonds costs the distance less than 1e-8 of the bonds' lengths, since it hardly depends
 * on them. No branch, so that loops vectorise. */
static inline double capsule_distance(struct vec3 p, struct vec3 q, struct vec3 w)
{
  const double none = 0x1p-1000; /* bonds without length, or parallel, divide 0 by this */
  const struct vec3 n = vec3_cross(p, q);
  const double pp = vec3_dot(p, p) + none, qq = vec3_dot(q, q) + none, nn = vec3_dot(n, n) + none;
  const double pq = vec3_dot(p, q), pw = vec3_dot(p, w), qw = vec3_dot(q, w);
  const double of_lines = capsule_within_one((pw * qq - pq * qw) / nn);
  const double t = capsule_within_one((of_lines * pq - qw) / qq), s = capsule_within_one((t * pq + pw) / pp);
  return vec3_norm(vec3_add_scaled(vec3_add_scaled(w, t, q), -s, p));
}

/* Is there nothing that both capsules reach, and a slack between them? */
static inline bool capsules_apart(const struct capsule *c, const struct capsule *d)
{
  const double reach = c->reach + d->reach + CAPSULE_SLACK;
  return capsule_gap(c->a.x, c->b.x, d->a.x, d->b.x) > reach || capsule_gap(c->a.y, c->b.y, d->a.y, d->b.y) > reach ||
         capsule_gap(c->a.z, c->b.z, d->a.z, d->b.z) > reach ||
         capsule_distance(vec3_sub(c->b, c->a), vec3_sub(d->b, d->a), vec3_sub(d->a, c->a)) > reach;
}

#endif
