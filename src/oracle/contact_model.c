#include "oracle/contact_model.h"

#include <math.h>
#include <stddef.h>

#include "contact/line.h"

/* --- the three conditions ----------------------------------------------------------------------------------------- */

static double volume(struct vec3 p, struct vec3 q, struct vec3 r)
{
  return vec3_dot(vec3_cross(p, q), r);
}

static int sign_of(const struct contact_twist *t, struct point origin, struct point u, struct point v, struct point w)
{
  if (!t->doubles)
    return crossing_orientation(origin, u, v, w);
  const double det = volume(point_difference(u, origin), point_difference(v, origin), point_difference(w, origin));
  return (det > 0.0) - (det < 0.0);
}

static bool positive(int sign, bool zero_negative)
{
  return zero_negative ? sign > 0 : sign >= 0;
}

bool contact_crosses(const struct contact_twist *t, const struct contact_points *r)
{
  const int before = sign_of(t, r->a, r->b, r->pivot, r->from), after = sign_of(t, r->a, r->b, r->pivot, r->to);
  const int path = sign_of(t, r->a, r->b, r->from, r->to);
  const int a = sign_of(t, r->from, r->to, r->pivot, r->a), b = sign_of(t, r->from, r->to, r->pivot, r->b);
  const bool first = t->zero == ZERO_NEGATIVE || (t->zero == ZERO_FLIPS_OTHERWISE && !r->flip) ||
                     ((t->zero == ZERO_FLIPS || t->zero == ZERO_FLIPS_EVERYWHERE) && r->flip);
  const bool others = t->zero == ZERO_NEGATIVE || (t->zero == ZERO_FLIPS_EVERYWHERE && r->flip);
  const bool side = positive(before, first);
  if (t->zero == ZERO_MISSES && (!before || !after || !path || !a || !b))
    return false;
  return (t->no_change || positive(after, first) != side) &&
         (t->no_path || (positive(path, others) == side) != t->path_turned) &&
         (t->no_sides || positive(a, others) != (t->one_side ? side : positive(b, others)));
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

struct contact_hit contact_describe(const struct contact_twist *t, const struct contact_points *r)
{
  const double before = rounded_volume(r, r->from), after = rounded_volume(r, r->to);
  const double right = clamp(t, before / (before - after));
  const double share = t->place == AT_END ? 1.0 : t->place == AT_START ? 0.0 : t->place == AT_MIDDLE ? 0.5 : right;
  const struct vec3 move = point_difference(r->to, r->from);
  const struct vec3 at = vec3_add_scaled(point_difference(r->from, r->a), t->time_from_end ? 1.0 - share : share, move);
  const struct vec3 p = vec3_sub(point_difference(r->pivot, r->a), at), q = point_difference(r->b, r->a);
  const double pp = vec3_dot(p, p), pq = vec3_dot(p, q), qq = vec3_dot(q, q), pt = vec3_dot(p, at),
               qt = vec3_dot(q, at);
  const double denominator = pp * qq - pq * pq;
  double s = 0.5, standing = 0.5;
  if (denominator > 0.0) {
    s = t->s_half ? 0.5 : clamp(t, (pq * qt - qq * pt) / denominator);
    standing = t->standing_half ? 0.5 : clamp(t, (pp * qt - pq * pt) / denominator);
  }
  return (struct contact_hit){t->time_from_end ? 1.0 - right : right, t->s_from_pivot ? 1.0 - s : s,
                              t->standing_from_b ? 1.0 - standing : standing, normal_of(t, p, q, move)};
}

/* --- the exchange ------------------------------------------------------------------------------------------------- */

static double inverse_mass(enum mass_rule rule, const double mass[4], int k)
{
  return rule == MASS_NONE       ? 1.0
         : rule == MASS_TIMES    ? mass[k]
         : rule == MASS_OF_MOVER ? 1.0 / mass[0]
         : rule == MASS_SQUARED  ? 1.0 / (mass[k] * mass[k])
                                 : 1.0 / mass[k];
}

static void levers_of(const struct contact_twist *t, const struct contact_hit *hit, double lever[4])
{
  const bool moving = t->levers == LEVERS_SWAPPED || t->levers == LEVERS_MOVING_SWAPPED;
  const bool standing = t->levers == LEVERS_SWAPPED || t->levers == LEVERS_STANDING_SWAPPED;
  const double s = moving ? 1.0 - hit->s : hit->s, u = standing ? 1.0 - hit->s_standing : hit->s_standing;
  lever[0] = 1.0 - s, lever[1] = s, lever[2] = u - 1.0, lever[3] = -u;
  if (t->levers == LEVERS_HALF)
    lever[0] = lever[1] = 0.5, lever[2] = lever[3] = -0.5;
  if (t->levers == LEVERS_OF_VERTEX)
    lever[0] = lever[1] = 1.0, lever[2] = lever[3] = -1.0;
}

double contact_exchange(const struct contact_twist *t, const struct contact_hit *hit, const double mass[4],
                        struct vec3 v[4])
{
  double lever[4], approach = 0.0, compliance = 0.0;
  levers_of(t, hit, lever);
  for (int k = 0; k < 4; k++) {
    const double square = t->unsquared ? fabs(lever[k]) : lever[k] * lever[k];
    if (k < 2 || !t->approach_of_moving)
      approach += lever[k] * vec3_dot(v[k], hit->normal);
    if (k < 2 || !t->compliance_of_moving)
      compliance += square * inverse_mass(t->mass, mass, k);
  }
  double impulse = (t->factor != 0.0 ? t->factor : 2.0) * approach / compliance;
  impulse = t->clipped ? fmax(impulse, 0.0) : t->absolute ? fabs(impulse) : impulse;
  for (int k = 0; k < 4; k++)
    if (!(t->moving_only && k >= 2) && !(t->standing_only && k < 2))
      v[k] = vec3_add_scaled(v[k], -(1.0 + t->change) * lever[k] * impulse * inverse_mass(t->mass_after, mass, k),
                             hit->normal);
  return impulse;
}

/* --- guesses ------------------------------------------------------------------------------------------------------ */

const struct contact_twist contact_test_twists[] = {
    {.zero = ZERO_POSITIVE, .text = "a determinant that is exactly zero: it counts as positive, but for `flip`"},
    {.zero = ZERO_NEGATIVE,
     .text = "a determinant that is exactly zero counts as negative: it counts as positive, but for `flip`"},
    {.zero = ZERO_FLIPS_OTHERWISE, .text = "a determinant that is exactly zero: `flip` is turned round"},
    {.zero = ZERO_FLIPS_EVERYWHERE, .text = "a determinant that is exactly zero: `flip` is for condition 1 only"},
    {.zero = ZERO_MISSES,
     .text = "a determinant that is exactly zero counts as no crossing: it counts as positive, but for `flip`"},
    {.doubles = true, .text = "determinants in doubles alone: their signs are exact"},
    {.no_change = true, .text = "the first volume's sign need not change (condition 1)"},
    {.no_path = true, .text = "a line that passes beyond the swept triangle counts as a hit (condition 2)"},
    {.path_turned = true, .text = "the sign of the second volume is turned round (condition 2)"},
    {.no_sides = true, .text = "a bond that ends beyond the triangle's plane counts as a hit (condition 3)"},
    {.one_side = true,
     .text = "one end of the standing bond is tested against the first volume, not the other end (condition 3)"},
    {.no_path = true, .no_sides = true, .text = "only condition 1 is tested, not 2 and 3"},
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
    {.mass = MASS_NONE, .mass_after = MASS_NONE, .text = "exchange without masses"},
    {.mass = MASS_NONE, .text = "dP without mass"},
    {.mass_after = MASS_NONE, .text = "changes of velocity without the mass: dP for dP/M"},
    {.mass = MASS_TIMES, .mass_after = MASS_TIMES, .text = "exchange times the mass, not over it"},
    {.mass = MASS_TIMES, .text = "dP with masses multiplied, not divided"},
    {.mass_after = MASS_TIMES, .text = "changes of velocity times the mass: dP M for dP/M"},
    {.mass = MASS_OF_MOVER, .mass_after = MASS_OF_MOVER, .text = "dP with the mass of one vertex for all four"},
    {.mass = MASS_OF_MOVER, .text = "dP with the mass of one vertex for all four, velocities with their own"},
    {.mass_after = MASS_OF_MOVER, .text = "changes of velocity with the mass of one vertex for all four"},
    {.mass = MASS_SQUARED, .mass_after = MASS_SQUARED, .text = "exchange over the mass squared"},
    {.mass_after = MASS_SQUARED, .text = "changes of velocity over the mass squared"},
    {.compliance_of_moving = true, .text = "levers of the moving bond only in the denominator of dP"},
    {.approach_of_moving = true, .text = "velocities of the moving bond only in dP"},
    {.approach_of_moving = true, .compliance_of_moving = true, .text = "levers of the moving bond only in dP"},
    {.approach_of_moving = true,
     .compliance_of_moving = true,
     .moving_only = true,
     .text = "levers of the moving bond only, in dP and in the changes of velocity"},
    {.moving_only = true, .text = "the moving bond only changes its velocities"},
    {.standing_only = true, .text = "the standing bond only changes its velocities"},
    {.unsquared = true, .text = "levers are not squared in dP"},
    {.change = -2.0, .text = "sign: changes of velocity are the negative of what is wanted"},
    {.change = -0.5, .text = "half of dP enters the velocities"},
    {.change = 1.0, .text = "twice dP enters the velocities"},
    {.change = -1.0, .text = "no exchange of momentum"},
    {.text = NULL},
};
