/* The motion of one fiber between two times. */
#include <math.h>

#include "observe/dynamics.h"

/* Mean square displacements of vertices, centre of mass and middle vertex: Padding 2009, Eqs. (41) and (42). */
static void displacements(const struct fiber_kind *kind, const struct point *origin, const struct point *now,
                          struct vec3 drift, struct fiber_motion *motion)
{
  const uint32_t middle = dynamics_middle(kind);
  struct vec3 sum = {0, 0, 0};
  double squares = 0.0;
  for (uint32_t j = 0; j < kind->vertices; j++) {
    const struct vec3 d = vec3_sub(point_difference(now[j], origin[j]), drift);
    const double squared = vec3_dot(d, d);
    sum = vec3_add(sum, d);
    squares += squared;
    if (j == middle)
      motion->middle = squared;
  }
  const struct vec3 center = vec3_scale(1.0 / kind->vertices, sum);
  motion->vertices = squares / kind->vertices;
  motion->moved = center;
  motion->center = vec3_dot(center, center);
}

/* Squared distance of 0 from the segment (a, b); a and b may coincide. */
static double squared_distance_to_segment(struct vec3 a, struct vec3 b)
{
  const struct vec3 e = vec3_sub(b, a);
  const double along = -vec3_dot(a, e), squared = vec3_dot(e, e);
  if (along <= 0.0)
    return vec3_dot(a, a);
  if (along >= squared)
    return vec3_dot(b, b);
  const struct vec3 nearest = vec3_add_scaled(a, along / squared, e);
  return vec3_dot(nearest, nearest);
}

/* d^2 of Padding 2009, Eq. (43): from the middle vertex, now, to the nearest vertex, then; and to the nearest point of
 * the contour, then, which knows no finite distance between vertices. relative: [vertices] scratch. */
static void tube(const struct fiber_kind *kind, const struct point *origin, struct point middle, struct vec3 drift,
                 struct vec3 *relative, struct fiber_motion *motion)
{
  const uint32_t n = kind->vertices;
  double nearest = INFINITY, contour;
  for (uint32_t j = 0; j < n; j++) {
    relative[j] = vec3_add(point_difference(origin[j], middle), drift);
    nearest = fmin(nearest, vec3_dot(relative[j], relative[j]));
  }
  contour = nearest;
  for (uint32_t j = 0; j + 1 < n; j++)
    contour = fmin(contour, squared_distance_to_segment(relative[j], relative[j + 1]));
  if (kind->ring)
    contour = fmin(contour, squared_distance_to_segment(relative[n - 1], relative[0]));
  motion->tube = nearest;
  motion->tube_contour = contour;
}

static void end_to_end(const struct fiber_kind *kind, const struct point *origin, const struct point *now,
                       struct fiber_motion *motion)
{
  const uint32_t last = kind->vertices - 1;
  const struct vec3 then = point_difference(origin[last], origin[0]), here = point_difference(now[last], now[0]);
  const struct vec3 change = vec3_sub(here, then);
  const double squares = vec3_dot(then, then) * vec3_dot(here, here);
  motion->turned = 0.5 * vec3_dot(change, change);
  motion->square = 0.5 * (vec3_dot(then, then) + vec3_dot(here, here));
  motion->cosine = squares > 0.0 ? vec3_dot(then, here) / sqrt(squares) : 0.0;
}

struct fiber_motion fiber_motion(const struct fiber_kind *kind, const struct point *origin, const struct point *now,
                                 struct vec3 drift, struct vec3 *scratch)
{
  struct fiber_motion motion = {.vertices = 0.0};
  displacements(kind, origin, now, drift, &motion);
  tube(kind, origin, now[dynamics_middle(kind)], drift, scratch, &motion);
  if (!kind->ring)
    end_to_end(kind, origin, now, &motion);
  return motion;
}
