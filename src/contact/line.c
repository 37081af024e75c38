#include "contact/line.h"

#include "contact/determinant.h"

/* --- the test ---------------------------------------------------------------------------------------------------- */

/* True for a positive determinant. Zero counts as positive; with flip it counts as negative, because the points then
 * stand in the mirrored order. */
static bool positive(double det, bool flip)
{
  return flip ? det > 0.0 : det >= 0.0;
}

/* Padding 2009, Eqs. (12)-(20): the points along both bonds, at time t_I, that are closest to each other. */
static void closest_points(struct vec3 p, struct vec3 q, struct vec3 r, struct crossing_hit *hit)
{
  const double a = vec3_dot(p, p), b = vec3_dot(p, q), c = vec3_dot(q, q), d = vec3_dot(p, r), e = vec3_dot(q, r);
  const double denominator = a * c - b * b;
  double s = 0.5, s_standing = 0.5;
  if (denominator > 0.0) {
    s = (b * e - c * d) / denominator;
    s_standing = (a * e - b * d) / denominator;
  }
  hit->s = fmin(fmax(s, 0.0), 1.0);
  hit->s_standing = fmin(fmax(s_standing, 0.0), 1.0);
}

/* Padding 2009, Eq. (21), with the sign for which it points in the direction of the move. The exchange does not depend
 * on this sign; but with it, dP > 0 where the bonds approach each other (footnote 61). If the bonds are parallel to
 * rounding when they meet, n is along the part of the displacement that is perpendicular to the standing bond, because
 * the crossing is real and must be answered. */
static struct vec3 common_normal(struct vec3 p, struct vec3 q, struct vec3 displacement)
{
  struct vec3 n = vec3_cross(p, q);
  if (!(vec3_norm(n) > 0.0))
    n = vec3_add_scaled(displacement, -vec3_dot(displacement, q) / vec3_dot(q, q), q);
  return vec3_scale((vec3_dot(n, displacement) < 0.0 ? -1.0 : 1.0) / vec3_norm(n), n);
}

bool crossing_find(const struct crossing_query *k, struct crossing_hit *hit)
{
  /* Padding 2009, Eq. (10): a, b, pivot and vertex lie in one plane at some time of the move if the volume that they
   * span changes sign. */
  const struct difference ab = difference(k->b, k->a), pivot = difference(k->pivot, k->a);
  const struct difference from = difference(k->from, k->a), to = difference(k->to, k->a);
  const double before = determinant(ab, pivot, from), after = determinant(ab, pivot, to);
  const bool side = positive(before, k->flip);
  if (side == positive(after, k->flip))
    return false;

  /* The line through a and b passes on the pivot's side of the moving vertex's path. */
  if (positive(determinant(ab, from, to), false) != side)
    return false;

  /* a and b lie on opposite sides of the triangle's plane. (docs/conventions.md has the same volumes about `from`.) */
  const struct difference u = difference(k->from, k->pivot), v = difference(k->to, k->pivot);
  if (positive(determinant(u, v, difference(k->a, k->pivot)), false) ==
      positive(determinant(u, v, difference(k->b, k->pivot)), false))
    return false;

  /* Padding 2009, Eqs. (9) and (11), with the two volumes in place of the velocity. */
  hit->time = before / (before - after);
  struct vec3 at = vec3_add_scaled(point_difference(k->from, k->a), hit->time, point_difference(k->to, k->from));
  struct vec3 p = vec3_sub(point_difference(k->pivot, k->a), at), q = point_difference(k->b, k->a);
  closest_points(p, q, at, hit);
  hit->normal = common_normal(p, q, point_difference(k->to, k->from));
  return true;
}
