/* Capsules: all places where a bond may be whose ends stay within a reach of two points. */
#ifndef UNCROSS_CAPSULE_H
#define UNCROSS_CAPSULE_H

#include <stdbool.h>

#include "base/vec3.h"

#define CAPSULE_SLACK 0x1p-18 /* a0: far above all rounding of capsules_apart, far below any reach that matters */

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

/* Is there a plane between two capsules, perpendicular to an axis of the box or to both bonds? If so, nothing in one
 * can touch anything in the other; if not, they may still be apart. Relative rounding errors, 1e-15, are covered by the
 * slack unless the bonds are nearly parallel. */
static inline bool capsules_apart(const struct capsule *c, const struct capsule *d)
{
  const double reach = c->reach + d->reach + CAPSULE_SLACK;
  const double x = capsule_gap(c->a.x, c->b.x, d->a.x, d->b.x), y = capsule_gap(c->a.y, c->b.y, d->a.y, d->b.y),
               z = capsule_gap(c->a.z, c->b.z, d->a.z, d->b.z);
  const struct vec3 p = vec3_sub(c->b, c->a), q = vec3_sub(d->b, d->a), n = vec3_cross(p, q);
  const double across = vec3_dot(n, vec3_sub(d->a, c->a)), nn = vec3_dot(n, n);
  const bool beside = capsule_most(capsule_most(x, y), z) > reach;
  const bool above = nn > 1e-12 * vec3_dot(p, p) * vec3_dot(q, q);
  return beside | (above & (across * across > reach * reach * nn)); /* no branch, so that loops vectorise */
}

#endif
