/* Balls of a plain simulation in long doubles, which has no ticks and no lists. */
#ifndef UNCROSS_TESTS_BEAD_BALL_H
#define UNCROSS_TESTS_BEAD_BALL_H

#include <math.h>

struct ball {
  long double x[3], v[3];
};

/* Until p touches the sphere b; INFINITY: never. */
static inline long double time_to_bead(const struct ball *p, const struct ball *b, long double radius)
{
  long double a = 0, along = 0, c = -radius * radius;
  for (int k = 0; k < 3; k++) {
    const long double x = p->x[k] - b->x[k], w = p->v[k] - b->v[k];
    a += w * w, along += x * w, c += x * x;
  }
  if (along >= 0 || along * along < a * c)
    return INFINITY;
  return c <= 0 ? 0 : c / (-along + sqrtl(along * along - a * c));
}

#endif
