#include "fiber/crossing.h"

/* Lattice differences: exact as int64, and as doubles below 2^53 units. */
struct difference {
  int64_t x, y, z;
};

static struct difference difference(struct point a, struct point b)
{
  return (struct difference){a.x - b.x, a.y - b.y, a.z - b.z};
}

/* --- exact determinant ------------------------------------------------------------------------------------------- */

__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;

/* high * 2^64 + low; low collects a few 64-bit terms, whose carries are moved up at the end */
struct wide {
  int128 high;
  uint128 low;
};

/* sum += minor * c, |minor| < 2^107, |c| < 2^53. */
static void wide_add_product(struct wide *sum, int128 minor, int64_t c)
{
  int128 minor_high = minor >> 64;
  uint64_t minor_low = (uint64_t)minor;
  sum->high += minor_high * c;
  int128 low = (int128)minor_low * c; /* within 2^117 */
  sum->high += low >> 64;
  sum->low += (uint64_t)low;
}

/* (p x q).r of integer vectors with components below 2^53, as the exact integer's sign and its nearest double or so. */
static double exact_determinant(struct difference p, struct difference q, struct difference r)
{
  struct wide sum = {0, 0};
  wide_add_product(&sum, (int128)p.y * q.z - (int128)p.z * q.y, r.x);
  wide_add_product(&sum, (int128)p.z * q.x - (int128)p.x * q.z, r.y);
  wide_add_product(&sum, (int128)p.x * q.y - (int128)p.y * q.x, r.z);
  sum.high += (int128)(sum.low >> 64);
  uint64_t low = (uint64_t)sum.low;
  bool negative = sum.high < 0;
  if (negative) { /* two's complement, so that no part cancels another in the sum of doubles */
    low = -low;
    sum.high = ~sum.high + (low == 0);
  }
  double size = (double)sum.high * 0x1p64 + (double)low;
  return negative ? -size : size;
}

/* --- determinant in doubles, where it can be trusted ------------------------------------------------------------- */

/* (p x q).r in lattice units cubed. Its sign is exact, and so, nearly, is its value. The bound is that of Shewchuk
 * (Discrete Comput. Geom. 18, 305 (1997), orient3d, first stage) for exact differences, with room to spare. */
static double determinant(struct difference p, struct difference q, struct difference r)
{
  const double px = (double)p.x, py = (double)p.y, pz = (double)p.z;
  const double qx = (double)q.x, qy = (double)q.y, qz = (double)q.z;
  const double rx = (double)r.x, ry = (double)r.y, rz = (double)r.z;
  const double yz = py * qz, zy = pz * qy, zx = pz * qx, xz = px * qz, xy = px * qy, yx = py * qx;
  const double det = rx * (yz - zy) + ry * (zx - xz) + rz * (xy - yx);
  const double size =
      fabs(rx) * (fabs(yz) + fabs(zy)) + fabs(ry) * (fabs(zx) + fabs(xz)) + fabs(rz) * (fabs(xy) + fabs(yx));
  if (fabs(det) > 16.0 * 0x1p-53 * size)
    return det;
  return exact_determinant(p, q, r);
}

int crossing_orientation(struct point origin, struct point u, struct point v, struct point w)
{
  double d = determinant(difference(u, origin), difference(v, origin), difference(w, origin));
  return (d > 0.0) - (d < 0.0);
}

/* --- the test ---------------------------------------------------------------------------------------------------- */

/* Side of a determinant, zero counted as positive; flip: zero counted as negative, for determinants that are taken in
 * the mirrored order of their points. */
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

/* Padding 2009, Eq. (21), turned so that it points the way the vertex moves: the exchange does not depend on that, but
 * the sign of dP then says whether the bonds approach each other (footnote 61). Where the bonds are parallel to
 * rounding when they meet, the part of the displacement across the standing bond takes its place: the crossing is real,
 * and must be answered. */
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

  /* The line through a and b passes the swept triangle between the moving vertex's path and the pivot. */
  if (positive(determinant(ab, from, to), false) != side)
    return false;

  /* a and b lie on either side of the triangle's plane. */
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
