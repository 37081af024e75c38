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
  const double size = fabs(r.x) * (fabs(p.y * q.z) + fabs(p.z * q.y)) + fabs(r.y) * (fabs(p.z * q.x) + fabs(p.x * q.z)) +
                      fabs(r.z) * (fabs(p.x * q.y) + fabs(p.y * q.x));
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
  const int after = turn * sign_of(t, r->a, r->b, r->pivot, r->to), path = turn * sign_of(t, r->a, r->b, r->from, r->to);
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
  return rule == MASS_NONE                                          ? 1.0
         : rule == MASS_TIMES                                       ? mass[k]
         : rule >= MASS_OF_MOVER && rule <= MASS_OF_B               ? 1.0 / mass[rule - MASS_OF_MOVER]
         : rule == MASS_OF_BOND                                     ? 1.0 / mass[k / 2 * 2]
         : rule == MASS_MEAN                                        ? 4.0 / sum
         : rule == MASS_SUM                                         ? 1.0 / sum
         : rule == MASS_SQUARED                                     ? 1.0 / (mass[k] * mass[k])
         : rule == MASS_ROOT                                        ? 1.0 / sqrt(mass[k])
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

/* --- guesses ------------------------------------------------------------------------------------------------------ */

const struct contact_twist contact_test_twists[] = {
    {.zero = {ZERO_POSITIVE, ZERO_RIGHT, ZERO_RIGHT}, .text = "a determinant that is exactly zero counts as positive in condition 1 whatever `flip` says: there `flip` turns it"},
    {.zero = {ZERO_NEGATIVE, ZERO_NEGATIVE, ZERO_NEGATIVE}, .text = "a determinant that is exactly zero counts as negative: it counts as positive, but for `flip` in condition 1"},
    {.zero = {ZERO_NEGATIVE, ZERO_RIGHT, ZERO_RIGHT}, .text = "a determinant that is exactly zero counts as negative in condition 1: it counts as positive, but for `flip`"},
    {.zero = {ZERO_FLIPS_OTHERWISE, ZERO_RIGHT, ZERO_RIGHT}, .text = "a determinant that is exactly zero: `flip` is turned round in condition 1"},
    {.zero = {ZERO_RIGHT, ZERO_FLIPS, ZERO_FLIPS}, .text = "a determinant that is exactly zero: `flip` is for condition 1 only, not 2 and 3"},
    {.zero = {ZERO_RIGHT, ZERO_FLIPS, ZERO_RIGHT}, .text = "a determinant that is exactly zero: `flip` is for condition 1 only, not 2"},
    {.zero = {ZERO_RIGHT, ZERO_RIGHT, ZERO_FLIPS}, .text = "a determinant that is exactly zero: `flip` is for condition 1 only, not 3"},
    {.zero = {ZERO_FLIPS_OTHERWISE, ZERO_FLIPS_OTHERWISE, ZERO_FLIPS_OTHERWISE}, .text = "a determinant that is exactly zero: `flip` is turned round, and is for condition 1 only"},
    {.zero = {ZERO_MISSES, ZERO_MISSES, ZERO_MISSES}, .text = "a determinant that is exactly zero counts as no crossing: it counts as positive, but for `flip` in condition 1"},
    {.zero = {ZERO_MISSES, ZERO_RIGHT, ZERO_RIGHT}, .text = "a determinant that is exactly zero counts as no crossing in condition 1: it counts as positive, but for `flip`"},
    {.zero = {ZERO_RIGHT, ZERO_NEGATIVE, ZERO_RIGHT}, .text = "a determinant that is exactly zero counts as negative in condition 2: it counts as positive"},
    {.zero = {ZERO_RIGHT, ZERO_MISSES, ZERO_RIGHT}, .text = "a determinant that is exactly zero counts as no crossing in condition 2: it counts as positive"},
    {.zero = {ZERO_RIGHT, ZERO_RIGHT, ZERO_NEGATIVE}, .text = "a determinant that is exactly zero counts as negative in condition 3: it counts as positive"},
    {.zero = {ZERO_RIGHT, ZERO_RIGHT, ZERO_MISSES}, .text = "a determinant that is exactly zero counts as no crossing in condition 3: it counts as positive"},
    {.zero = {ZERO_RIGHT, ZERO_NEGATIVE, ZERO_NEGATIVE}, .text = "a determinant that is exactly zero counts as negative in conditions 2 and 3: it counts as positive"},
    {.zero = {ZERO_RIGHT, ZERO_MISSES, ZERO_MISSES}, .text = "a determinant that is exactly zero counts as no crossing in conditions 2 and 3: it counts as positive"},
    {.zero = {ZERO_MISSES, ZERO_RIGHT, ZERO_MISSES}, .text = "a determinant that is exactly zero counts as no crossing in conditions 1 and 3: it counts as positive, but for `flip`"},
    {.exact = IN_DOUBLES, .text = "determinants in doubles alone: their signs are exact"},
    {.exact = IN_SINGLES, .text = "determinants in single precision: their signs are exact"},
    {.exact = DOUBT_IS_ZERO, .text = "determinants that doubles cannot tell count as zero: their signs are exact"},
    {.exact = MINORS_OF_64, .text = "minors of determinants in integers of 64 bits: they need up to 128, all of it 192"},
    {.exact = MINORS_OF_64,
     .unfiltered = true,
     .text = "minors of determinants in integers of 64 bits: they need up to 128, all of it 192"},
    {.exact = ALL_OF_64, .text = "determinants in integers of 64 bits: they need up to 192"},
    {.exact = ALL_OF_64, .unfiltered = true, .text = "determinants in integers of 64 bits: they need up to 192"},
    {.exact = ALL_OF_128, .text = "determinants in integers of 128 bits: they need up to 192"},
    {.exact = ALL_OF_128, .unfiltered = true, .text = "determinants in integers of 128 bits: they need up to 192"},
    {.exact = WITHOUT_CARRY, .text = "determinants in several words without the carry from the low one to the high one"},
    {.exact = WITHOUT_CARRY,
     .unfiltered = true,
     .text = "determinants in several words without the carry from the low one to the high one"},
    {.bond_turned = true, .text = "the standing bond taken the other way round in the volumes: zero counts as negative there"},
    {.change_of_sign = CHANGE_ANY, .text = "the first volume's sign need not change (condition 1)"},
    {.change_of_sign = CHANGE_NONE, .text = "the first volume's sign must stay, it should change (condition 1)"},
    {.change_of_sign = CHANGE_UP, .text = "crossings are found from the negative to the positive side only (condition 1)"},
    {.change_of_sign = CHANGE_DOWN, .text = "crossings are found from the positive to the negative side only (condition 1)"},
    {.path = PATH_ANY, .text = "a line that passes beyond the swept triangle counts as a hit (condition 2)"},
    {.path = PATH_TURNED, .text = "the sign of the second volume is turned round, or compared to that at the end (condition 2)"},
    {.path = PATH_POSITIVE, .text = "the second volume must be positive, not of the first's sign (condition 2)"},
    {.path = PATH_NEGATIVE, .text = "the second volume must be negative, not of the first's sign (condition 2)"},
    {.side = SIDES_ANY, .text = "a bond that ends beyond the triangle's plane counts as a hit (condition 3)"},
    {.side = SIDES_ALIKE, .text = "both ends of the standing bond must be on one side: they should not (condition 3)"},
    {.side = SIDE_A_OTHER,
     .text = "one end of the standing bond, a, is tested against the first volume, not the other end (condition 3)"},
    {.side = SIDE_A_SAME,
     .text = "one end of the standing bond, a, is tested against the first volume, turned round (condition 3)"},
    {.side = SIDE_B_OTHER,
     .text = "one end of the standing bond, b, is tested against the first volume, not the other end (condition 3)"},
    {.side = SIDE_B_SAME,
     .text = "one end of the standing bond, b, is tested against the first volume, turned round (condition 3)"},
    {.side = SIDE_A_POSITIVE, .text = "one end of the standing bond is tested alone: a on the positive side (condition 3)"},
    {.side = SIDE_A_NEGATIVE, .text = "one end of the standing bond is tested alone: a on the negative side (condition 3)"},
    {.side = SIDE_B_POSITIVE, .text = "one end of the standing bond is tested alone: b on the positive side (condition 3)"},
    {.side = SIDE_B_NEGATIVE, .text = "one end of the standing bond is tested alone: b on the negative side (condition 3)"},
    {.path = PATH_ANY, .side = SIDES_ANY, .text = "only condition 1 is tested, not 2 and 3"},
    {.change_of_sign = CHANGE_ANY, .side = SIDES_ANY, .text = "only condition 2 is tested, not 1 and 3"},
    {.change_of_sign = CHANGE_ANY, .path = PATH_ANY, .text = "only condition 3 is tested, not 1 and 2"},
    {.time_of_sum = true, .text = "t_I with the sum of both volumes for their difference"},
    {.time_from_end = true, .text = "the time from the end of the move: 1 - t for t"},
    {.place = AT_END, .text = "the contact is taken at the end of the move, not at t_I"},
    {.place = AT_START, .text = "the contact is taken at the start of the move, not at t_I"},
    {.place = AT_MIDDLE, .text = "the contact is taken at the middle of the move, not at t_I"},
    {.s_from_pivot = true, .text = "lever rule: s counts from the moving vertex, not from the pivot"},
    {.standing_from_b = true, .text = "lever rule: s' counts from the standing bond's first end, not from its second"},
    {.s_from_pivot = true,
     .standing_from_b = true,
     .text = "lever rule: s counts from the moving vertex, s' from the bond's first end"},
    {.s_half = true, .text = "s is 0.5 always"},
    {.standing_half = true, .text = "s' is 0.5 always"},
    {.s_half = true, .standing_half = true, .text = "s and s' are 0.5 always"},
    {.s_term = 1, .text = "sign of the first term of s"},
    {.s_term = 2, .text = "sign of the second term of s"},
    {.s_term = 3, .text = "first term of s left out"},
    {.s_term = 4, .text = "second term of s left out"},
    {.standing_term = 1, .text = "sign of the first term of s'"},
    {.standing_term = 2, .text = "sign of the second term of s'"},
    {.standing_term = 3, .text = "first term of s' left out"},
    {.standing_term = 4, .text = "second term of s' left out"},
    {.denominator_term = 2, .text = "sign of the second term of the denominator of s and s'"},
    {.denominator_term = 4, .text = "second term of the denominator of s and s' left out"},
    {.normal_place = AT_START, .text = "the normal of the bond at the start of the move, not at t_I"},
    {.normal_place = AT_END, .text = "the normal of the bond at the end of the move, not at t_I"},
    {.unclamped = true, .text = "s and s' are not clamped to [0, 1]"},
    {.normal = NORMAL_TURNED, .text = "normal turned round: it points the way the vertex moves"},
    {.normal = NORMAL_PLAIN, .text = "the normal's sign as it comes from p x q: it points the way the vertex moves"},
    {.normal = NORMAL_PLAIN_TURNED,
     .text = "the normal's sign as it comes from q x p: it points the way the vertex moves"},
    {.normal = NORMAL_UNSCALED, .text = "the normal is not of length 1: p x q itself"},
    {.normal = NORMAL_SQUARED, .text = "the normal is not of length 1: divided by (p x q)^2, the root is missing"},
    {.text = NULL},
};

const struct contact_twist contact_exchange_twists[] = {
    {.clipped = true, .text = "dP clipped at 0: it is used with its sign (footnote 61)"},
    {.clipped_above = true, .text = "dP cut to negative values: it is used with its sign (footnote 61)"},
    {.absolute = true, .text = "dP without its sign: |dP|"},
    {.factor = 1.0, .text = "dP without its factor 2"},
    {.factor = 4.0, .text = "dP with a factor 4 for 2"},
    {.factor = -2.0, .text = "sign of dP"},
    {.levers = LEVERS_SWAPPED, .text = "lever rule swapped: 1 - s goes to the moving vertex, 1 - s' to bond's first"},
    {.levers = LEVERS_MOVING_SWAPPED, .text = "lever rule swapped in the moving bond: 1 - s goes to the moving vertex"},
    {.levers = LEVERS_STANDING_SWAPPED,
     .text = "lever rule swapped in the standing bond: 1 - s' goes to its first end"},
    {.levers = LEVERS_HALF, .text = "lever rule: levers are 0.5 always"},
    {.levers = LEVERS_OF_VERTEX, .text = "lever rule: levers are 1 always"},
    {.levers = LEVERS_BY_S, .text = "lever rule: s for both bonds"},
    {.levers = LEVERS_BY_S_STANDING, .text = "lever rule: s' for both bonds"},
    {.levers = LEVERS_EXCHANGED, .text = "lever rule: s and s' exchanged"},
    {.levers = LEVERS_ALL_POSITIVE, .text = "lever rule: the standing bond's levers have the other sign"},
    {.unlevered = true, .text = "changes of velocity without the levers"},
    {.mass = MASS_NONE, .mass_after = MASS_NONE, .text = "exchange without masses"},
    {.mass = MASS_NONE, .text = "dP without mass"},
    {.mass_after = MASS_NONE, .text = "changes of velocity without the mass: dP for dP/M"},
    {.mass = MASS_TIMES, .mass_after = MASS_TIMES, .text = "exchange times the mass, not over it"},
    {.mass = MASS_TIMES, .text = "dP with masses multiplied, not divided"},
    {.mass_after = MASS_TIMES, .text = "changes of velocity times the mass: dP M for dP/M"},
    {.mass = MASS_OF_MOVER, .mass_after = MASS_OF_MOVER, .text = "exchange with the mass of one vertex, the moving one, for all four"},
    {.mass = MASS_OF_MOVER, .text = "dP with the mass of one vertex, the moving one, for all four, velocities with their own"},
    {.mass_after = MASS_OF_MOVER, .text = "changes of velocity with the mass of one vertex, the moving one, for all four"},
    {.mass = MASS_OF_PIVOT, .mass_after = MASS_OF_PIVOT, .text = "exchange with the mass of one vertex, the pivot, for all four"},
    {.mass = MASS_OF_PIVOT, .text = "dP with the mass of one vertex, the pivot, for all four, velocities with their own"},
    {.mass_after = MASS_OF_PIVOT, .text = "changes of velocity with the mass of one vertex, the pivot, for all four"},
    {.mass = MASS_OF_A, .mass_after = MASS_OF_A, .text = "exchange with the mass of one vertex, a, for all four"},
    {.mass = MASS_OF_A, .text = "dP with the mass of one vertex, a, for all four, velocities with their own"},
    {.mass_after = MASS_OF_A, .text = "changes of velocity with the mass of one vertex, a, for all four"},
    {.mass = MASS_OF_B, .mass_after = MASS_OF_B, .text = "exchange with the mass of one vertex, b, for all four"},
    {.mass = MASS_OF_B, .text = "dP with the mass of one vertex, b, for all four, velocities with their own"},
    {.mass_after = MASS_OF_B, .text = "changes of velocity with the mass of one vertex, b, for all four"},
    {.mass = MASS_OF_BOND, .mass_after = MASS_OF_BOND, .text = "exchange with the mass of each bond's first vertex for all four"},
    {.mass = MASS_OF_BOND, .text = "dP with the mass of each bond's first vertex for all four, velocities with their own"},
    {.mass_after = MASS_OF_BOND, .text = "changes of velocity with the mass of each bond's first vertex for all four"},
    {.mass = MASS_MEAN, .mass_after = MASS_MEAN, .text = "exchange with the mean mass for all four"},
    {.mass = MASS_MEAN, .text = "dP with the mean mass for all four, velocities with their own"},
    {.mass_after = MASS_MEAN, .text = "changes of velocity with the mean mass for all four"},
    {.mass = MASS_SUM, .mass_after = MASS_SUM, .text = "exchange with the sum of masses for all four"},
    {.mass = MASS_SUM, .text = "dP with the sum of masses for all four, velocities with their own"},
    {.mass_after = MASS_SUM, .text = "changes of velocity with the sum of masses for all four"},
    {.mass = MASS_SQUARED, .mass_after = MASS_SQUARED, .text = "exchange over the mass squared"},
    {.mass = MASS_SQUARED, .text = "dP over the mass squared"},
    {.mass_after = MASS_SQUARED, .text = "changes of velocity over the mass squared"},
    {.mass = MASS_ROOT, .mass_after = MASS_ROOT, .text = "exchange over the root of the mass"},
    {.mass = MASS_ROOT, .text = "dP over the root of the mass"},
    {.mass_after = MASS_ROOT, .text = "changes of velocity over the root of the mass"},
    {.no_change = END_MOVING, .text = "exchange: the moving vertex keeps its velocity"},
    {.no_approach = END_MOVING, .text = "velocities in dP: the moving vertex is left out"},
    {.no_compliance = END_MOVING, .text = "denominator of dP: the moving vertex is left out"},
    {.no_approach = END_MOVING, .no_compliance = END_MOVING, .text = "dP: the moving vertex is left out of velocities and denominator"},
    {.no_approach = END_MOVING,
     .no_compliance = END_MOVING,
     .no_change = END_MOVING,
     .text = "exchange: the moving vertex is left out of all"},
    {.no_change = END_PIVOT, .text = "exchange: the pivot keeps its velocity"},
    {.no_approach = END_PIVOT, .text = "velocities in dP: the pivot is left out"},
    {.no_compliance = END_PIVOT, .text = "denominator of dP: the pivot is left out"},
    {.no_approach = END_PIVOT, .no_compliance = END_PIVOT, .text = "dP: the pivot is left out of velocities and denominator"},
    {.no_approach = END_PIVOT,
     .no_compliance = END_PIVOT,
     .no_change = END_PIVOT,
     .text = "exchange: the pivot is left out of all"},
    {.no_change = END_A, .text = "exchange: the standing bond's first vertex, a, keeps its velocity"},
    {.no_approach = END_A, .text = "velocities in dP: the standing bond's first vertex, a, is left out"},
    {.no_compliance = END_A, .text = "denominator of dP: the standing bond's first vertex, a, is left out"},
    {.no_approach = END_A, .no_compliance = END_A, .text = "dP: the standing bond's first vertex, a, is left out of velocities and denominator"},
    {.no_approach = END_A,
     .no_compliance = END_A,
     .no_change = END_A,
     .text = "exchange: the standing bond's first vertex, a, is left out of all"},
    {.no_change = END_B, .text = "exchange: the standing bond's second vertex, b, keeps its velocity"},
    {.no_approach = END_B, .text = "velocities in dP: the standing bond's second vertex, b, is left out"},
    {.no_compliance = END_B, .text = "denominator of dP: the standing bond's second vertex, b, is left out"},
    {.no_approach = END_B, .no_compliance = END_B, .text = "dP: the standing bond's second vertex, b, is left out of velocities and denominator"},
    {.no_approach = END_B,
     .no_compliance = END_B,
     .no_change = END_B,
     .text = "exchange: the standing bond's second vertex, b, is left out of all"},
    {.no_change = END_A | END_B, .text = "exchange: the standing bond keeps its velocity"},
    {.no_approach = END_A | END_B, .text = "velocities in dP: the standing bond is left out"},
    {.no_compliance = END_A | END_B, .text = "denominator of dP: the standing bond is left out"},
    {.no_approach = END_A | END_B, .no_compliance = END_A | END_B, .text = "dP: the standing bond is left out of velocities and denominator"},
    {.no_approach = END_A | END_B,
     .no_compliance = END_A | END_B,
     .no_change = END_A | END_B,
     .text = "exchange: the standing bond is left out of all"},
    {.no_change = END_MOVING | END_PIVOT, .text = "exchange: the moving bond keeps its velocity"},
    {.no_approach = END_MOVING | END_PIVOT, .text = "velocities in dP: the moving bond is left out"},
    {.no_compliance = END_MOVING | END_PIVOT, .text = "denominator of dP: the moving bond is left out"},
    {.no_approach = END_MOVING | END_PIVOT, .no_compliance = END_MOVING | END_PIVOT, .text = "dP: the moving bond is left out of velocities and denominator"},
    {.no_approach = END_MOVING | END_PIVOT,
     .no_compliance = END_MOVING | END_PIVOT,
     .no_change = END_MOVING | END_PIVOT,
     .text = "exchange: the moving bond is left out of all"},
    {.unsquared = true, .text = "levers are not squared in dP"},
    {.change = -2.0, .text = "sign: changes of velocity are the negative of what is wanted"},
    {.change = -0.5, .text = "half of dP enters the velocities"},
    {.change = 1.0, .text = "twice dP enters the velocities"},
    {.change = -1.0, .text = "no exchange of momentum"},
    {.text = NULL},
};
