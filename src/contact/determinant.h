/* Orientation determinants of lattice vectors, with exact signs: in doubles where rounding cannot change the sign, else
 * in 192-bit integers. */
#ifndef UNCROSS_CONTACT_DETERMINANT_H
#define UNCROSS_CONTACT_DETERMINANT_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/lattice.h"

/* Lattice differences: exact as int64, and as doubles below 2^53 units. */
struct difference {
  int64_t x, y, z;
};

static inline struct difference difference(struct point a, struct point b)
{
  return (struct difference){a.x - b.x, a.y - b.y, a.z - b.z};
}

/* --- exact determinant ------------------------------------------------------------------------------------------- */

__extension__ typedef __int128 int128;
__extension__ typedef unsigned __int128 uint128;

/* The integer high * 2^64 + low. low is a sum of a few 64-bit terms; its carry is moved to high at the end. */
struct wide {
  int128 high;
  uint128 low;
};

/* sum += minor * c, |minor| < 2^107, |c| < 2^53. */
static inline void wide_add_product(struct wide *sum, int128 minor, int64_t c)
{
  int128 minor_high = minor >> 64;
  uint64_t minor_low = (uint64_t)minor;
  sum->high += minor_high * c;
  int128 low = (int128)minor_low * c; /* within 2^117 */
  sum->high += low >> 64;
  sum->low += (uint64_t)low;
}

/* sum += (p x q).r of integer vectors with components below 2^53. */
static inline void wide_add_determinant(struct wide *sum, struct difference p, struct difference q, struct difference r)
{
  wide_add_product(sum, (int128)p.y * q.z - (int128)p.z * q.y, r.x);
  wide_add_product(sum, (int128)p.z * q.x - (int128)p.x * q.z, r.y);
  wide_add_product(sum, (int128)p.x * q.y - (int128)p.y * q.x, r.z);
}

/* A double with the sign of the integer, and its value to within rounding. */
static inline double wide_value(struct wide sum)
{
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

/* (p x q).r of integer vectors with components below 2^53: a double with the sign of the exact integer, and its value
 * to within rounding. */
static inline double exact_determinant(struct difference p, struct difference q, struct difference r)
{
  struct wide sum = {0, 0};
  wide_add_determinant(&sum, p, q, r);
  return wide_value(sum);
}

/* --- determinant in doubles, where it can be trusted ------------------------------------------------------------- */

/* (p x q).r in lattice units cubed. Its sign is exact, its value right to rounding. The bound is that of Shewchuk
 * (Discrete Comput. Geom. 18, 305 (1997), orient3d, first stage) for exact differences, with room to spare. */
static inline double determinant(struct difference p, struct difference q, struct difference r)
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

#endif
