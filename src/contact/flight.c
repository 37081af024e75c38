#include "contact/flight.h"

#include "contact/capsule.h"
#include "contact/determinant.h"
#include "contact/hull.h"

/* The pair at one tick, exact: in lattice units, and in a0. */
struct knot {
  struct difference exact_p, exact_q, exact_w;
  struct vec3 p, q, w;
};

static struct difference at_tick(struct point at, struct point rate, int64_t tick)
{
  const struct point place = flight_place(at, rate, tick);
  return (struct difference){place.x, place.y, place.z};
}

static struct vec3 in_a0(struct difference d)
{
  return (struct vec3){(double)d.x * LATTICE_UNIT, (double)d.y * LATTICE_UNIT, (double)d.z * LATTICE_UNIT};
}

static struct knot knot_at(const struct flight_pair *pair, int32_t tick)
{
  struct knot k;
  k.exact_p = at_tick(pair->p, pair->p_rate, tick);
  k.exact_q = at_tick(pair->q, pair->q_rate, tick);
  k.exact_w = at_tick(pair->w, pair->w_rate, tick);
  k.p = in_a0(k.exact_p), k.q = in_a0(k.exact_q), k.w = in_a0(k.exact_w);
  return k;
}

static double size_of(struct vec3 a, struct vec3 b)
{
  return fmax(fabs(a.x) + fabs(a.y) + fabs(a.z), fabs(b.x) + fabs(b.y) + fabs(b.z));
}

/* --- (i): the volume keeps its sign ------------------------------------------------------------------------------- */

enum volume_sign {
  VOLUME_KEEPS_SIGN, /* certainly */
  VOLUME_CHANGES,    /* perhaps */
  VOLUME_IN_DOUBT    /* it is zero all the time, as far as doubles can tell */
};

/* A determinant rounds its terms 7 times in all, each by at most half an ulp; the sum of the sizes of its terms is at
 * most the product of the sizes of its vectors (sums of components); a coefficient has three determinants, and two more
 * sums. 23 half ulps are enough; 32 leave room for rounding of the bound itself. */
static enum volume_sign sign_of_volume(const struct knot *a, const struct knot *b)
{
  const struct vec3 aa = vec3_cross(a->p, a->q), ab = vec3_cross(a->p, b->q), ba = vec3_cross(b->p, a->q),
                    bb = vec3_cross(b->p, b->q);
  const double first = vec3_dot(aa, a->w), last = vec3_dot(bb, b->w);
  const double second = vec3_dot(ba, a->w) + vec3_dot(ab, a->w) + vec3_dot(aa, b->w); /* three times the coefficient */
  const double third = vec3_dot(bb, a->w) + vec3_dot(ba, b->w) + vec3_dot(ab, b->w);
  const double doubt = 3.0 * 32.0 * 0x1p-53 * size_of(a->p, b->p) * size_of(a->q, b->q) * size_of(a->w, b->w);
  if ((first > doubt && second > doubt && third > doubt && last > doubt) ||
      (first < -doubt && second < -doubt && third < -doubt && last < -doubt))
    return VOLUME_KEEPS_SIGN;
  const double largest = fmax(fmax(fabs(first), fabs(last)), fmax(fabs(second), fabs(third)));
  return largest > doubt ? VOLUME_CHANGES : VOLUME_IN_DOUBT;
}

static int sign_of_sum(const struct knot *const k[3][3])
{
  struct wide sum = {0, 0};
  for (int i = 0; i < 3; i++)
    wide_add_determinant(&sum, k[i][0]->exact_p, k[i][1]->exact_q, k[i][2]->exact_w);
  const double value = wide_value(sum);
  return (value > 0.0) - (value < 0.0);
}

static int sign_at(const struct knot *k)
{
  const double value = determinant(k->exact_p, k->exact_q, k->exact_w);
  return (value > 0.0) - (value < 0.0);
}

/* The same in exact integers. */
static bool volume_keeps_exact_sign(const struct knot *a, const struct knot *b)
{
  const int sign = sign_at(a);
  const struct knot *const second[3][3] = {{b, a, a}, {a, b, a}, {a, a, b}}, *const third[3][3] = {
                                                                                 {b, b, a}, {b, a, b}, {a, b, b}};
  return sign != 0 && sign_at(b) == sign && sign_of_sum(second) == sign && sign_of_sum(third) == sign;
}

/* --- (ii): a plane separates the corners from the origin ---------------------------------------------------------- */

/* The least of d.(w + s' q - s p) at one tick, by corners. */
static double least_along(struct vec3 d, const struct knot *k)
{
  return vec3_dot(d, k->w) + fmin(0.0, vec3_dot(d, k->q)) - fmax(0.0, vec3_dot(d, k->p));
}

/* Each scalar product rounds 5 times at most, and there are two sums: 8 half ulps of the sizes are enough. */
static bool plane_separates(struct vec3 d, const struct knot *a, const struct knot *b)
{
  const double doubt = 16.0 * 0x1p-53 * (fabs(d.x) + fabs(d.y) + fabs(d.z)) *
                       (size_of(a->w, b->w) + size_of(a->q, b->q) + size_of(a->p, b->p));
  return least_along(d, a) > doubt && least_along(d, b) > doubt;
}

/* From bond p to bond q, where they are closest: a direction in which the bonds are apart. Inexact where they are
 * nearly parallel, or so close that rounding turns it. */
static struct vec3 gap_of(const struct knot *k)
{
  double s, t;
  capsule_closest(k->p, k->q, k->w, &s, &t);
  return capsule_between(k->p, k->q, k->w, s, t);
}

/* --- one tick, exact ---------------------------------------------------------------------------------------------- */

/* The direction of (x, y, z), in integers of at most 61 bits. */
static struct difference direction_of(int128 x, int128 y, int128 z)
{
  const uint128 bits = (uint128)(x < 0 ? -x : x) | (uint128)(y < 0 ? -y : y) | (uint128)(z < 0 ? -z : z);
  int shift = 0;
  while (bits >> shift >> 61)
    shift++;
  return (struct difference){(int64_t)(x >> shift), (int64_t)(y >> shift), (int64_t)(z >> shift)};
}

static struct difference cross_exact(struct difference a, struct difference b)
{
  return direction_of((int128)a.y * b.z - (int128)a.z * b.y, (int128)a.z * b.x - (int128)a.x * b.z,
                      (int128)a.x * b.y - (int128)a.y * b.x);
}

static int128 dot_exact(struct difference a, struct difference b)
{
  return (int128)a.x * b.x + (int128)a.y * b.y + (int128)a.z * b.z;
}

/* v - factor b */
static struct difference minus_times(struct difference v, int64_t factor, struct difference b)
{
  return (struct difference){v.x - factor * b.x, v.y - factor * b.y, v.z - factor * b.z};
}

/* least_along, without rounding: of 61 bits by 53 and a few sums. */
static bool all_beyond(struct difference d, const struct knot *k)
{
  const int128 q = dot_exact(d, k->exact_q), p = dot_exact(d, k->exact_p);
  return dot_exact(d, k->exact_w) + (q < 0 ? q : 0) - (p > 0 ? p : 0) > 0;
}

static bool separates_exactly(struct difference d, const struct knot *a, const struct knot *b)
{
  return all_beyond(d, a) && all_beyond(d, b);
}

/* (ii) with all directions that the shortest line between two bonds can have: perpendicular to both; from an end of one
 * to the other, perpendicular to that; from end to end. If the bonds are further apart at tick a than any two of their
 * points approach each other until b, the plane perpendicular to this line separates them at both ticks. */
static bool planes_separate_exactly(const struct knot *a, const struct knot *b)
{
  const struct difference none = {0, 0, 0}, p = a->exact_p, q = a->exact_q, w = a->exact_w;
  const struct difference n = cross_exact(p, q);
  if (separates_exactly(n, a, b) || separates_exactly(minus_times(none, 1, n), a, b))
    return true;
  for (int end = 0; end < 2; end++) {
    const struct difference of_q = minus_times(w, -end, q), of_p = minus_times(w, end, p);
    if (separates_exactly(cross_exact(p, cross_exact(of_q, p)), a, b) ||
        separates_exactly(cross_exact(q, cross_exact(of_p, q)), a, b) || separates_exactly(of_q, a, b) ||
        separates_exactly(minus_times(of_q, 1, p), a, b))
      return true;
  }
  return false;
}

/* --- the search --------------------------------------------------------------------------------------------------- */

/* The corners of (ii), in lattice units. */
static void corners_at(const struct knot *k, struct difference corner[4])
{
  const struct difference w = k->exact_w, p = k->exact_p, wq = minus_times(w, -1, k->exact_q);
  corner[0] = w, corner[1] = wq, corner[2] = minus_times(w, 1, p), corner[3] = minus_times(wq, 1, p);
}

/* A single tick: (i) and (ii) with any plane, exactly. */
static bool tick_excluded(const struct knot *a, const struct knot *b)
{
  struct difference corner[HULL_POINTS];
  corners_at(a, corner), corners_at(b, corner + 4);
  return volume_keeps_exact_sign(a, b) || hull_misses_origin(corner);
}

/* From knot a to knot b, `ticks` later. What doubles exclude here, tick_excluded excludes in each tick of the interval:
 * they save time, and decide nothing. */
static bool excluded(const struct knot *a, const struct knot *b, int32_t ticks)
{
  const enum volume_sign volume = sign_of_volume(a, b);
  if (volume == VOLUME_KEEPS_SIGN || plane_separates(gap_of(a), a, b) || plane_separates(gap_of(b), a, b))
    return true;
  return ticks == 1 ? tick_excluded(a, b) : volume == VOLUME_IN_DOUBT && planes_separate_exactly(a, b);
}

bool flight_excluded(const struct flight_pair *pair, int32_t from, int32_t to)
{
  const struct knot a = knot_at(pair, from), b = knot_at(pair, to);
  return excluded(&a, &b, to - from);
}

/* As flight_contact, from the knot a at tick `from` to the knot b at tick `to`. */
static int32_t contact_between(const struct flight_pair *pair, int32_t from, int32_t to, const struct knot *a,
                               const struct knot *b)
{
  if (excluded(a, b, to - from))
    return FLIGHT_TICKS;
  if (to - from == 1)
    return from;
  const int32_t middle = from + (to - from) / 2;
  const struct knot m = knot_at(pair, middle);
  const int32_t tick = contact_between(pair, from, middle, a, &m);
  return tick < FLIGHT_TICKS ? tick : contact_between(pair, middle, to, &m, b);
}

static bool is_zero(struct point p)
{
  return p.x == 0 && p.y == 0 && p.z == 0;
}

int32_t flight_contact(const struct flight_pair *pair, int32_t from)
{
  if (is_zero(pair->p_rate) && is_zero(pair->q_rate) && is_zero(pair->w_rate))
    return FLIGHT_TICKS;
  const struct knot a = knot_at(pair, from), b = knot_at(pair, FLIGHT_TICKS);
  return contact_between(pair, from, FLIGHT_TICKS, &a, &b);
}
