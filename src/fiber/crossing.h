/*
 * Does a moving bond cross a standing one? (Padding 2009, Sec. III A.)
 *
 * Vertex i moves in a straight line from `from` to `to` while its neighbor, the pivot, stands still: the bond between
 * them sweeps the triangle (pivot, from, to). It crosses the standing bond (a, b) if (a, b) pierces that triangle.
 *
 * Whether it does is decided by signs of orientation determinants of lattice points, and these signs are exact: in
 * doubles where rounding cannot matter, else in 192-bit integers. A determinant that is exactly zero counts as
 * positive, each in a fixed order of its points, so that of two successive moves, or of two bonds that share the vertex
 * which is touched, not both can disown a crossing. When and where along the bonds is then computed in doubles.
 */
#ifndef UNCROSS_CROSSING_H
#define UNCROSS_CROSSING_H

#include <stdbool.h>

#include "base/lattice.h"

/* The points of a test. The volume of two bonds (j, j+1) and (k, k+1) has the same sign whichever bond is named first,
 * but changes it if the ends of one are exchanged: `flip` says that the moving vertex is the first of its bond. */
struct crossing_query {
  struct point from, to, pivot; /* the moving vertex, before and after; the other end of its bond */
  struct point a, b;            /* the standing bond, as (j, j+1) */
  bool flip;
};

struct crossing_hit {
  double time;        /* t_I as a fraction of the move, [0,1]; Eq. (11) */
  double s;           /* along the moving bond, 0 at the moving vertex, 1 at the pivot; Eq. (14) */
  double s_standing;  /* s', 0 at a, 1 at b; Eq. (15) */
  struct vec3 normal; /* n, unit vector along p x q; Eq. (21) */
};

/* True, and *hit filled, if the moving bond crosses the standing one. All points within 4096 a0 of each other. */
bool crossing_find(const struct crossing_query *query, struct crossing_hit *hit);

/* Most partners are far enough away to see at once that the moving vertex stays on one side of both bonds' common
 * plane: true if that is beyond doubt. All vectors in a0: the standing bond, from its first end to the pivot, and the
 * moving bond before and after. What is computed is Eq. (10)'s volume, (q x w).r; the bound, some 50 times its
 * rounding. */
static inline bool crossing_far(struct vec3 standing, struct vec3 to_pivot, struct vec3 before, struct vec3 after)
{
  const struct vec3 n = vec3_cross(standing, to_pivot);
  const double x = vec3_dot(n, before), y = vec3_dot(n, after);
  const double size =
      (fabs(standing.x) + fabs(standing.y) + fabs(standing.z)) *
      (fabs(to_pivot.x) + fabs(to_pivot.y) + fabs(to_pivot.z)) *
      (fabs(before.x) + fabs(before.y) + fabs(before.z) + fabs(after.x) + fabs(after.y) + fabs(after.z));
  const double doubt = 1e-14 * size;
  return (x > doubt && y > doubt) || (x < -doubt && y < -doubt);
}

/* Exact sign (-1, 0, 1) of the determinant of p, q, r = u - origin, v - origin, w - origin: (p x q).r. */
int crossing_orientation(struct point origin, struct point u, struct point v, struct point w);

#endif
