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

/* A fiber's contour at the origin, and the length of its longest bond. */
struct contour {
  const struct fiber_kind *kind;
  const struct point *origin;
  struct vec3 drift;
  double longest;
};

static struct contour contour_of(const struct fiber_kind *kind, const struct point *origin, struct vec3 drift)
{
  struct contour c = {kind, origin, drift, 0.0};
  for (uint32_t j = 0; j + 1 < kind->vertices; j++) {
    const struct vec3 bond = point_difference(origin[j + 1], origin[j]);
    c.longest = fmax(c.longest, vec3_dot(bond, bond));
  }
  c.longest = sqrt(c.longest);
  return c;
}

/* d^2 of Padding 2009, Eq. (43): from a vertex, now, to the nearest vertex, then (*vertex); and to the nearest point of
 * the contour, then (returned), which knows no finite distance between vertices. A bond whose vertex is farther than
 * the nearest one by more than a bond's length cannot come nearer. relative: [vertices] scratch. */
static double distance_from(const struct contour *c, struct point place, struct vec3 *relative, double *vertex)
{
  const uint32_t n = c->kind->vertices;
  double nearest = INFINITY;
  for (uint32_t j = 0; j < n; j++) {
    relative[j] = vec3_add(point_difference(c->origin[j], place), c->drift);
    nearest = fmin(nearest, vec3_dot(relative[j], relative[j]));
  }
  *vertex = nearest;
  const double reach = sqrt(nearest) + c->longest;
  double contour = nearest;
  for (uint32_t j = 0; j + 1 < n; j++)
    if (vec3_dot(relative[j], relative[j]) <= reach * reach)
      contour = fmin(contour, squared_distance_to_segment(relative[j], relative[j + 1]));
  if (c->kind->ring)
    contour = fmin(contour, squared_distance_to_segment(relative[n - 1], relative[0]));
  return contour;
}

static void tube(const struct fiber_kind *kind, const struct point *origin, const struct point *now, struct vec3 drift,
                 struct vec3 *relative, struct fiber_motion *motion)
{
  const struct contour c = contour_of(kind, origin, drift);
  const uint32_t vertices = dynamics_third(kind);
  double sum = 0.0, unused;
  motion->tube_contour = distance_from(&c, now[dynamics_middle(kind)], relative, &motion->tube);
  for (uint32_t k = 0; k < vertices; k++)
    sum += distance_from(&c, now[dynamics_third_vertex(kind, k)], relative, &unused);
  motion->tube_third = sum / vertices;
}

/* The regression axis: sum of (j - (n - 1)/2) r_j, the slope of a line through the vertices but for a factor. */
static struct vec3 regression_axis(const struct fiber_kind *kind, const struct point *position)
{
  struct vec3 axis = {0, 0, 0};
  for (uint32_t j = 1; j < kind->vertices; j++)
    axis = vec3_add_scaled(axis, j - 0.5 * (kind->vertices - 1), point_difference(position[j], position[0]));
  return axis;
}

static double cosine_between(struct vec3 a, struct vec3 b)
{
  const double squares = vec3_dot(a, a) * vec3_dot(b, b);
  return squares > 0.0 ? vec3_dot(a, b) / sqrt(squares) : 0.0;
}

static void end_to_end(const struct fiber_kind *kind, const struct point *origin, const struct point *now,
                       struct fiber_motion *motion)
{
  const uint32_t last = kind->vertices - 1;
  const struct vec3 then = point_difference(origin[last], origin[0]), here = point_difference(now[last], now[0]);
  const struct vec3 change = vec3_sub(here, then);
  motion->turned = 0.5 * vec3_dot(change, change);
  motion->square = 0.5 * (vec3_dot(then, then) + vec3_dot(here, here));
  motion->cosine = cosine_between(then, here);
  motion->axis = cosine_between(regression_axis(kind, origin), regression_axis(kind, now));
}

struct fiber_motion fiber_motion(const struct fiber_kind *kind, const struct point *origin, const struct point *now,
                                 struct vec3 drift, struct vec3 *scratch)
{
  struct fiber_motion motion = {.vertices = 0.0};
  displacements(kind, origin, now, drift, &motion);
  tube(kind, origin, now, drift, scratch, &motion);
  if (!kind->ring)
    end_to_end(kind, origin, now, &motion);
  return motion;
}
