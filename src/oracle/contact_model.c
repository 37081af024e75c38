#include "oracle/contact_model.h"

#include <math.h>
#include <stddef.h>

#include "contact/line.h"
#include "oracle/single.h"

/* --- the three conditions ----------------------------------------------------------------------------------------- */

static double volume(struct vec3 p, struct vec3 q, struct vec3 r)
{
  return vec3_dot(vec3_cross(p, q), r);
}

__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;

struct integers {
  int64_t x, y, z;
};

static struct integers less(struct point a, struct point b)
{
  return (struct integers){a.x - b.x, a.y - b.y, a.z - b.z};
}

static struct vec3 real_of(struct integers p)
{
  return (struct vec3){(double)p.x, (double)p.y, (double)p.z};
}

static int sign_of_double(double x)
{
  return (x > 0.0) - (x < 0.0);
}

/* True if doubles cannot tell the sign: docs/porting.md has the bound. */
static bool is_doubtful(struct vec3 p, struct vec3 q, struct vec3 r)
{
  const double size = fabs(r.x) * (fabs(p.y * q.z) + fabs(p.z * q.y)) +
                      fabs(r.y) * (fabs(p.z * q.x) + fabs(p.x * q.z)) + fabs(r.z) * (fabs(p.x * q.y) + fabs(p.y * q.x));
  return !(fabs(volume(p, q, r)) > 16.0 * 0x1p-53 * size);
}

static int sign_in_singles(struct vec3 p, struct vec3 q, struct vec3 r)
{
  const double yz = single_of(single_of(p.y) * single_of(q.z)), zy = single_of(single_of(p.z) * single_of(q.y));
  const double zx = single_of(single_of(p.z) * single_of(q.x)), xz = single_of(single_of(p.x) * single_of(q.z));
  const double xy = single_of(single_of(p.x) * single_of(q.y)), yx = single_of(single_of(p.y) * single_of(q.x));
  const double x = single_of(single_of(r.x) * single_of(yz - zy)), y = single_of(single_of(r.y) * single_of(zx - xz));
  return sign_of_double(single_of(single_of(x + y) + single_of(single_of(r.z) * single_of(xy - yx))));
}

static int64_t product_of_64(int64_t a, int64_t b)
{
  return (int64_t)((uint64_t)a * (uint64_t)b);
}

static int128 minor_of(bool short_words, int64_t a, int64_t b, int64_t c, int64_t d)
{
  if (short_words)
    return (int64_t)((uint64_t)product_of_64(a, b) - (uint64_t)product_of_64(c, d));
  return (int128)a * b - (int128)c * d;
}

/* Integers that are too short, or added wrongly. */
static int sign_in_integers(enum exact_rule rule, struct integers p, struct integers q, struct integers r)
{
  const bool is_short = rule == MINORS_OF_64 || rule == ALL_OF_64;
  const int128 minor[3] = {minor_of(is_short, p.y, q.z, p.z, q.y), minor_of(is_short, p.z, q.x, p.x, q.z),
                           minor_of(is_short, p.x, q.y, p.y, q.x)};
  const int64_t factor[3] = {r.x, r.y, r.z};
  int128 high = 0, low = 0;
  uint128 all = 0;
  for (int k = 0; k < 3; k++) {
    high += (minor[k] >> 64) * factor[k];
    low += (int128)(uint64_t)minor[k] * factor[k];
    all += (uint128)minor[k] * (uint128)(int128)factor[k];
  }
  if (rule == ALL_OF_64)
    return ((int64_t)(uint64_t)all > 0) - ((int64_t)(uint64_t)all < 0);
  if (rule == ALL_OF_128)
    return ((int128)all > 0) - ((int128)all < 0);
  high += rule == WITHOUT_CARRY ? 0 : low >> 64;
  return high < 0 ? -1 : high > 0 || (uint64_t)low != 0;
}

static int sign_of(const struct contact_twist *t, struct point origin, struct point u, struct point v, struct point w)
{
  if (t->exact == EXACT)
    return crossing_orientation(origin, u, v, w);
  const struct integers p = less(u, origin), q = less(v, origin), r = less(w, origin);
  const struct vec3 a = real_of(p), b = real_of(q), c = real_of(r);
  if (t->exact == IN_SINGLES)
    return sign_in_singles(a, b, c);
  if (t->exact == IN_DOUBLES || (!t->unfiltered && !is_doubtful(a, b, c)))
    return sign_of_double(volume(a, b, c));
  return t->exact == DOUBT_IS_ZERO ? 0 : sign_in_integers(t->exact, p, q, r);
}

static bool positive(const struct contact_twist *t, int sign, int condition, bool flip)
{
  const enum zero_rule rule = t->zero[condition] != ZERO_RIGHT ? t->zero[condition]
                              : condition == 0                 ? ZERO_FLIPS
                                                               : ZERO_POSITIVE;
  const bool zero_negative =
      rule == ZERO_NEGATIVE || (rule == ZERO_FLIPS && flip) || (rule == ZERO_FLIPS_OTHERWISE && !flip);
  return zero_negative ? sign > 0 : sign >= 0;
}

static bool changes(enum change_rule rule, bool before, bool after)
{
  return rule == CHANGE_ANY    ? true
         : rule == CHANGE_NONE ? before == after
         : rule == CHANGE_UP   ? after && !before
         : rule == CHANGE_DOWN ? before && !after
                               : before != after;
}

static bool passes(enum path_rule rule, bool path, bool side)
{
  return rule == PATH_ANY        ? true
         : rule == PATH_TURNED   ? path != side
         : rule == PATH_POSITIVE ? path
         : rule == PATH_NEGATIVE ? !path
                                 : path == side;
}

static bool pierces(enum side_rule rule, bool a, bool b, bool side)
{
  switch (rule) {
  case SIDES:
    return a != b;
  case SIDES_ANY:
    return true;
  case SIDES_ALIKE:
    return a == b;
  case SIDE_A_POSITIVE:
    return a;
  case SIDE_A_NEGATIVE:
    return !a;
  case SIDE_B_POSITIVE:
    return b;
  case SIDE_B_NEGATIVE:
    return !b;
  case SIDE_A_OTHER:
    return a != side;
  case SIDE_A_SAME:
    return a == side;
  case SIDE_B_OTHER:
    return b != side;
  default:
    return b == side;
  }
}

bool contact_crosses(const struct contact_twist *t, const struct contact_points *r)
{
  const int turn = t->bond_turned ? -1 : 1;
  const int before = turn * sign_of(t, r->a, r->b, r->pivot, r->from);
  const int after = turn * sign_of(t, r->a, r->b, r->pivot, r->to),
            path = turn * sign_of(t, r->a, r->b, r->from, r->to);
  const int a = sign_of(t, r->from, r->to, r->pivot, r->a), b = sign_of(t, r->from, r->to, r->pivot, r->b);
  if ((t->zero[0] == ZERO_MISSES && (!before || !after)) || (t->zero[1] == ZERO_MISSES && !path) ||
      (t->zero[2] == ZERO_MISSES && (!a || !b)))
    return false;
  const bool side = positive(t, before, 0, r->flip);
  return changes(t->change_of_sign, side, positive(t, after, 0, r->flip)) &&
         passes(t->path, positive(t, path, 1, r->flip), side) &&
         pierces(t->side, positive(t, a, 2, r->flip), positive(t, b, 2, r->flip), side);
}

/* --- what a hit is like ------------------------------------------------------------------------------------------- */

static double clamp(const struct contact_twist *t, double x)
{
  return t->unclamped ? x : fmin(fmax(x, 0.0), 1.0);
}

/* Volumes that are exactly zero enter as 0. */
static double rounded_volume(const struct contact_points *r, struct point w)
{
  const double det = volume(point_difference(r->b, r->a), point_difference(r->pivot, r->a), point_difference(w, r->a));
  return crossing_orientation(r->a, r->b, r->pivot, w) == 0 ? 0.0 : det;
}

static struct vec3 normal_of(const struct contact_twist *t, struct vec3 p, struct vec3 q, struct vec3 move)
{
  struct vec3 n = vec3_cross(p, q);
  const double squared = vec3_dot(n, n);
  const bool plain = t->normal == NORMAL_PLAIN || t->normal == NORMAL_PLAIN_TURNED;
  if (t->normal != NORMAL_UNSCALED)
    n = vec3_scale(1.0 / (t->normal == NORMAL_SQUARED ? squared : sqrt(squared)), n);
  const bool turn =
      plain ? t->normal == NORMAL_PLAIN_TURNED : (vec3_dot(n, move) < 0.0) != (t->normal == NORMAL_TURNED);
  return turn ? vec3_scale(-1.0, n) : n;
}

/* x - y with one of the terms changed. */
static double difference_of(int term, double x, double y)
{
  return (term == 1 ? -x : term == 3 ? 0.0 : x) - (term == 2 ? -y : term == 4 ? 0.0 : y);
}

static double share_at(enum contact_place place, double right)
{
  return place == AT_END ? 1.0 : place == AT_START ? 0.0 : place == AT_MIDDLE ? 0.5 : right;
}

struct contact_hit contact_describe(const struct contact_twist *t, const struct contact_points *r)
{
  const double before = rounded_volume(r, r->from), after = rounded_volume(r, r->to);
  const double right = clamp(t, before / (t->time_of_sum ? before + after : before - after));
  const double share = share_at(t->place, right);
  const struct vec3 move = point_difference(r->to, r->from), start = point_difference(r->from, r->a);
  const struct vec3 at = vec3_add_scaled(start, t->time_from_end ? 1.0 - share : share, move);
  const struct vec3 p = vec3_sub(point_difference(r->pivot, r->a), at), q = point_difference(r->b, r->a);
  const struct vec3 along =
      t->normal_place == AT_TIME
          ? p
          : vec3_sub(point_difference(r->pivot, r->a), vec3_add_scaled(start, share_at(t->normal_place, right), move));
  const double pp = vec3_dot(p, p), pq = vec3_dot(p, q), qq = vec3_dot(q, q), pt = vec3_dot(p, at),
               qt = vec3_dot(q, at);
  const double denominator = difference_of(t->denominator_term, pp * qq, pq * pq);
  double s = 0.5, standing = 0.5;
  if (denominator > 0.0) {
    s = t->s_half ? 0.5 : clamp(t, difference_of(t->s_term, pq * qt, qq * pt) / denominator);
    standing = t->standing_half ? 0.5 : clamp(t, difference_of(t->standing_term, pp * qt, pq * pt) / denominator);
  }
  return (struct contact_hit){t->time_from_end ? 1.0 - right : right, t->s_from_pivot ? 1.0 - s : s,
                              t->standing_from_b ? 1.0 - standing : standing, normal_of(t, along, q, move)};
}

/* --- the exchange ------------------------------------------------------------------------------------------------- */

static double inverse_mass(enum mass_rule rule, const double mass[4], int k)
{
  const double sum = mass[0] + mass[1] + mass[2] + mass[3];
  return rule == MASS_NONE                            ? 1.0
         : rule == MASS_TIMES                         ? mass[k]
         : rule >= MASS_OF_MOVER && rule <= MASS_OF_B ? 1.0 / mass[rule - MASS_OF_MOVER]
         : rule == MASS_OF_BOND                       ? 1.0 / mass[k / 2 * 2]
         : rule == MASS_MEAN                          ? 4.0 / sum
         : rule == MASS_SUM                           ? 1.0 / sum
         : rule == MASS_SQUARED                       ? 1.0 / (mass[k] * mass[k])
         : rule == MASS_ROOT                          ? 1.0 / sqrt(mass[k])
                                                      : 1.0 / mass[k];
}

static void levers_of(const struct contact_twist *t, const struct contact_hit *hit, double lever[4])
{
  const bool moving = t->levers == LEVERS_SWAPPED || t->levers == LEVERS_MOVING_SWAPPED;
  const bool standing = t->levers == LEVERS_SWAPPED || t->levers == LEVERS_STANDING_SWAPPED;
  const bool other_s = t->levers == LEVERS_BY_S_STANDING || t->levers == LEVERS_EXCHANGED;
  const bool other_standing = t->levers == LEVERS_BY_S || t->levers == LEVERS_EXCHANGED;
  const double first = other_s ? hit->s_standing : hit->s, second = other_standing ? hit->s : hit->s_standing;
  const double s = moving ? 1.0 - first : first, u = standing ? 1.0 - second : second;
  lever[0] = 1.0 - s, lever[1] = s, lever[2] = u - 1.0, lever[3] = -u;
  if (t->levers == LEVERS_HALF)
    lever[0] = lever[1] = 0.5, lever[2] = lever[3] = -0.5;
  if (t->levers == LEVERS_OF_VERTEX)
    lever[0] = lever[1] = 1.0, lever[2] = lever[3] = -1.0;
  if (t->levers == LEVERS_ALL_POSITIVE)
    lever[2] = 1.0 - u, lever[3] = u;
}

double contact_exchange(const struct contact_twist *t, const struct contact_hit *hit, const double mass[4],
                        struct vec3 v[4])
{
  double lever[4], approach = 0.0, compliance = 0.0;
  levers_of(t, hit, lever);
  for (int k = 0; k < 4; k++) {
    const double square = t->unsquared ? fabs(lever[k]) : lever[k] * lever[k];
    if (!(t->no_approach & 1U << k))
      approach += lever[k] * vec3_dot(v[k], hit->normal);
    if (!(t->no_compliance & 1U << k))
      compliance += square * inverse_mass(t->mass, mass, k);
  }
  double impulse = (t->factor != 0.0 ? t->factor : 2.0) * approach / compliance;
  impulse = t->clipped         ? fmax(impulse, 0.0)
            : t->clipped_above ? fmin(impulse, 0.0)
            : t->absolute      ? fabs(impulse)
                               : impulse;
  for (int k = 0; k < 4; k++) {
    const double part = t->unlevered ? (double)((lever[k] > 0.0) - (lever[k] < 0.0)) : lever[k];
    if (!(t->no_change & 1U << k))
      v[k] = vec3_add_scaled(v[k], -(1.0 + t->change) * part * impulse * inverse_mass(t->mass_after, mass, k),
                             hit->normal);
  }
  return impulse;
}
