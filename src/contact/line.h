/*
 * Does a moving bond cross a standing one? (Padding 2009, Sec. III A.)
 *
 * Vertex i moves in a straight line from `from` to `to` while its neighbor, the pivot, stands still: the bond between
 * them sweeps the triangle (pivot, from, to). It crosses the standing bond (a, b) if (a, b) pierces that triangle.
 *
 * Signs of orientation determinants of lattice points decide this. The signs are exact: they are computed in doubles
 * where rounding cannot change them, else in 192-bit integers. A determinant that is exactly zero counts as positive,
 * with its points in a fixed order. So a crossing that happens exactly between two successive moves, or exactly at a
 * vertex that two bonds share, is not lost (docs/conventions.md). The time of a crossing and its place along the bonds
 * are then computed in doubles.
 */
#ifndef UNCROSS_CONTACT_LINE_H
#define UNCROSS_CONTACT_LINE_H

#include <stdbool.h>

#include "base/lattice.h"

/* The points of a test. flip: the moving vertex is the first one of its bond. The volume of two bonds changes its sign
 * if the ends of one bond are exchanged, but not if the bonds are. */
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

/* A quick test before crossing_find: true if the moving vertex certainly stays on one side of the plane through the
 * standing bond and the pivot. Then there is no crossing. All vectors in a0. standing: the standing bond; to_pivot:
 * from its first end to the pivot; before, after: from the pivot to the moving vertex. The test computes the volume of
 * Eq. (10), (q x w).r; its margin is some 50 times the rounding error. */
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

#endif
