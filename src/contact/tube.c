#include "contact/tube.h"

#include "contact/capsule.h"

/* The axes at one tick, a0, exact; n: of length 1 to rounding, along the shortest line from the first to the other, or
 * 0 where they meet. */
struct knot {
  struct vec3 p, q, w, n;
};

/* Padding 2009, Eq. (29): the points of both bonds at this tick, and the nearest two of them. */
static struct knot knot_at(const struct flight_pair *pair, int32_t tick)
{
  struct knot k;
  double s, t;
  k.p = point_in_a0(flight_place(pair->p, pair->p_rate, tick));
  k.q = point_in_a0(flight_place(pair->q, pair->q_rate, tick));
  k.w = point_in_a0(flight_place(pair->w, pair->w_rate, tick));
  capsule_closest(k.p, k.q, k.w, &s, &t);
  const struct vec3 gap = capsule_between(k.p, k.q, k.w, s, t);
  const double size = vec3_norm(gap);
  k.n = vec3_scale(size > 0.0 ? 1.0 / size : 0.0, gap);
  return k;
}

/* Of the corners w, w + q, w - p, w + q - p: the least of what these scalar products are parts of. */
static double least_corner(double w, double q, double p)
{
  return w + fmin(0.0, q) - fmax(0.0, p);
}

static double size_of(struct vec3 a, struct vec3 b)
{
  return fmax(fabs(a.x) + fabs(a.y) + fabs(a.z), fabs(b.x) + fabs(b.y) + fabs(b.z));
}

/* Twice n(u).c(u), where it is n.c of the one knot and the other: for the least corner. */
static double least_of_both(const struct knot *a, const struct knot *b)
{
  return least_corner(vec3_dot(a->n, b->w) + vec3_dot(b->n, a->w), vec3_dot(a->n, b->q) + vec3_dot(b->n, a->q),
                      vec3_dot(a->n, b->p) + vec3_dot(b->n, a->p));
}

/* A component of n is at most 1, to rounding. A scalar product rounds 5 times at most, and three sums follow: each by
 * half an ulp of the sizes at most. 8 half ulps are enough; 16 leave room for the bound itself, and for the rounding of
 * the reach, which is taken for n that are longer than 1 by a few half ulps. */
static bool excluded(const struct knot *a, const struct knot *b, int64_t reach)
{
  const double size = size_of(a->w, b->w) + size_of(a->q, b->q) + size_of(a->p, b->p);
  const double beyond = 2.0 * (double)reach * LATTICE_UNIT * (1.0 + 0x1p-48) + 4.0 * 16.0 * 0x1p-53 * size;
  return least_of_both(a, a) > beyond && least_of_both(b, b) > beyond && least_of_both(a, b) > beyond;
}

bool tube_excluded(const struct flight_pair *pair, int64_t reach, int32_t from, int32_t to)
{
  const struct knot a = knot_at(pair, from), b = knot_at(pair, to);
  return excluded(&a, &b, reach);
}

/* As tube_contact, from the knot a at tick `from` to the knot b at tick `to`. */
static int32_t contact_between(const struct flight_pair *pair, int64_t reach, int32_t from, int32_t to,
                               const struct knot *a, const struct knot *b)
{
  if (excluded(a, b, reach))
    return FLIGHT_TICKS;
  if (to - from == 1)
    return from;
  const int32_t middle = from + (to - from) / 2;
  const struct knot m = knot_at(pair, middle);
  const int32_t tick = contact_between(pair, reach, from, middle, a, &m);
  return tick < FLIGHT_TICKS ? tick : contact_between(pair, reach, middle, to, &m, b);
}

static bool is_zero(struct point p)
{
  return p.x == 0 && p.y == 0 && p.z == 0;
}

int32_t tube_contact(const struct flight_pair *pair, int64_t reach, int32_t from)
{
  if (is_zero(pair->p_rate) && is_zero(pair->q_rate) && is_zero(pair->w_rate))
    return FLIGHT_TICKS;
  const struct knot a = knot_at(pair, from), b = knot_at(pair, FLIGHT_TICKS);
  return contact_between(pair, reach, from, FLIGHT_TICKS, &a, &b);
}
