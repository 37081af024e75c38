/* A capsule: all places of a bond whose ends stay within a distance, the reach, of two points. */
#ifndef UNCROSS_CONTACT_CAPSULE_H
#define UNCROSS_CONTACT_CAPSULE_H

#include <stdbool.h>

#include "base/vec3.h"

#define CAPSULE_SLACK 0x1p-16 /* a0: far above the rounding of capsule_distance, far below any reach in use */

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

/* Distance of the interval between a0 and a1 from the interval between b0 and b1; negative if they overlap. */
static inline double capsule_gap(double a0, double a1, double b0, double b1)
{
  return capsule_most(capsule_least(a0, a1) - capsule_most(b0, b1), capsule_least(b0, b1) - capsule_most(a0, a1));
}

static inline double capsule_within_one(double s)
{
  return capsule_most(capsule_least(s, 1.0), 0.0);
}

/* The closest points of two bonds, p and q, w from the first end of p to that of q: s along p and t along q for which
 * |w + t q - s p| is least, 0 <= s, t <= 1. First the best s of the two lines, clamped to the bond; then the best t for
 * it, clamped; then the best s for this t. In nearly parallel bonds s and t are inexact, but the distance hardly
 * depends on them: its error is below 1e-8 of the bonds' lengths. There is no branch, so that loops vectorise. */
static inline void capsule_closest(struct vec3 p, struct vec3 q, struct vec3 w, double *s, double *t)
{
  const double none = 0x1p-1000; /* bonds without length, or parallel, divide 0 by this */
  const struct vec3 n = vec3_cross(p, q);
  const double pp = vec3_dot(p, p) + none, qq = vec3_dot(q, q) + none, nn = vec3_dot(n, n) + none;
  const double pq = vec3_dot(p, q), pw = vec3_dot(p, w), qw = vec3_dot(q, w);
  const double of_lines = capsule_within_one((pw * qq - pq * qw) / nn);
  *t = capsule_within_one((of_lines * pq - qw) / qq);
  *s = capsule_within_one((*t * pq + pw) / pp);
}

/* From the point s of bond p to the point t of bond q. */
static inline struct vec3 capsule_between(struct vec3 p, struct vec3 q, struct vec3 w, double s, double t)
{
  return vec3_add_scaled(vec3_add_scaled(w, t, q), -s, p);
}

/* Distance of two bonds, as capsule_closest has them. */
static inline double capsule_distance(struct vec3 p, struct vec3 q, struct vec3 w)
{
  double s, t;
  capsule_closest(p, q, w, &s, &t);
  return vec3_norm(capsule_between(p, q, w, s, t));
}

/* True if the two capsules have no point in common, with a slack between them. */
static inline bool capsules_apart(const struct capsule *c, const struct capsule *d)
{
  const double reach = c->reach + d->reach + CAPSULE_SLACK;
  return capsule_gap(c->a.x, c->b.x, d->a.x, d->b.x) > reach || capsule_gap(c->a.y, c->b.y, d->a.y, d->b.y) > reach ||
         capsule_gap(c->a.z, c->b.z, d->a.z, d->b.z) > reach ||
         capsule_distance(vec3_sub(c->b, c->a), vec3_sub(d->b, d->a), vec3_sub(d->a, c->a)) > reach;
}

#endif
