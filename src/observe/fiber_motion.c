/* The motion of one fiber between two times: the plain way, a point at a time, and the fast one, by columns of doubles.
 * Both make the same bits. */
#include <math.h>

#include "base/registers.h"
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
static inline double squared_distance_to_segment(struct vec3 a, struct vec3 b)
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

/* How far from a place a bond may begin that comes nearer than its nearest vertex. */
static double reach_of(double nearest, double longest)
{
  return sqrt(nearest) + longest;
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
  const double reach = reach_of(nearest, c->longest);
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

static double axis_weight(const struct fiber_kind *kind, uint32_t j)
{
  return j - 0.5 * (kind->vertices - 1);
}

/* The regression axis: sum of (j - (n - 1)/2) r_j, the slope of a line through the vertices but for a factor. */
static struct vec3 regression_axis(const struct fiber_kind *kind, const struct point *position)
{
  struct vec3 axis = {0, 0, 0};
  for (uint32_t j = 1; j < kind->vertices; j++)
    axis = vec3_add_scaled(axis, axis_weight(kind, j), point_difference(position[j], position[0]));
  return axis;
}

static double cosine_between(struct vec3 a, struct vec3 b)
{
  const double squares = vec3_dot(a, a) * vec3_dot(b, b);
  return squares > 0.0 ? vec3_dot(a, b) / sqrt(squares) : 0.0;
}

/* R(0) and R(t). */
static void set_end_to_end(struct vec3 then, struct vec3 here, struct fiber_motion *motion)
{
  const struct vec3 change = vec3_sub(here, then);
  motion->turned = 0.5 * vec3_dot(change, change);
  motion->square = 0.5 * (vec3_dot(then, then) + vec3_dot(here, here));
  motion->cosine = cosine_between(then, here);
}

static void end_to_end(const struct fiber_kind *kind, const struct point *origin, const struct point *now,
                       struct fiber_motion *motion)
{
  const uint32_t last = kind->vertices - 1;
  set_end_to_end(point_difference(origin[last], origin[0]), point_difference(now[last], now[0]), motion);
  motion->axis = cosine_between(regression_axis(kind, origin), regression_axis(kind, now));
}

struct fiber_motion fiber_motion_plain(const struct fiber_kind *kind, const struct point *origin,
                                       const struct point *now, struct vec3 drift, struct vec3 *scratch)
{
  struct fiber_motion motion = {.vertices = 0.0};
  displacements(kind, origin, now, drift, &motion);
  tube(kind, origin, now, drift, scratch, &motion);
  if (!kind->ring)
    end_to_end(kind, origin, now, &motion);
  return motion;
}

/* --- by columns -------------------------------------------------------------------------------------------------- */

/* Places less than LATTICE_NEAR from the fiber's first vertex at the origin are multiples of the lattice unit with at
 * most 52 bits. So their differences are exact, and are those of the points. */
enum { MOST = 256 };
_Static_assert(MOST % LANES == 0, "columns fill registers");

/* a0, from the first vertex at the origin. */
struct columns {
  double x[MOST], y[MOST], z[MOST];
};

static struct vec3 at(const struct columns *c, uint32_t j)
{
  return (struct vec3){c->x[j], c->y[j], c->z[j]};
}

/* False if a place is too far. */
static bool fill(const struct point *from, const struct point *place, uint32_t n, struct columns *c)
{
  const struct point zero = *from;
  uint64_t far = 0;
  for (uint32_t j = 0; j < n; j++) {
    const struct point d = point_minus(place[j], zero);
    far |= lattice_beyond(d.x) | lattice_beyond(d.y) | lattice_beyond(d.z);
    c->x[j] = lattice_near(d.x) * LATTICE_UNIT;
    c->y[j] = lattice_near(d.y) * LATTICE_UNIT;
    c->z[j] = lattice_near(d.z) * LATTICE_UNIT;
  }
  return far == 0;
}

/* What makes n a multiple of LANES is infinitely far, and so never the nearest. */
static uint32_t pad(struct columns *c, uint32_t n)
{
  uint32_t padded = n;
  for (; padded % LANES != 0; padded++) {
    c->x[padded] = INFINITY;
    c->y[padded] = c->z[padded] = 0.0;
  }
  return padded;
}

static void column_displacements(const struct fiber_kind *kind, const struct columns *origin, const struct columns *now,
                                 struct vec3 drift, struct fiber_motion *motion)
{
  const uint32_t n = kind->vertices;
  struct vec3 sum = {0, 0, 0};
  double squares = 0.0;
  for (uint32_t j = 0; j < n; j++) {
    const struct vec3 d = vec3_sub(vec3_sub(at(now, j), at(origin, j)), drift);
    sum = vec3_add(sum, d);
    squares += vec3_dot(d, d);
  }
  const uint32_t middle = dynamics_middle(kind);
  const struct vec3 d = vec3_sub(vec3_sub(at(now, middle), at(origin, middle)), drift);
  motion->middle = vec3_dot(d, d);
  motion->moved = vec3_scale(1.0 / n, sum);
  motion->vertices = squares / n;
  motion->center = vec3_dot(motion->moved, motion->moved);
}

/* The contour at the origin, padded, and the length of its longest bond. */
struct column_contour {
  const struct fiber_kind *kind;
  const struct columns *origin;
  uint32_t padded;
  struct vec3 drift;
  double longest;
};

static struct column_contour column_contour_of(const struct fiber_kind *kind, const struct columns *o, uint32_t padded,
                                               struct vec3 drift)
{
  double square[MOST], longest = 0.0;
  for (uint32_t j = 0; j + 1 < kind->vertices; j++) {
    const double x = o->x[j + 1] - o->x[j], y = o->y[j + 1] - o->y[j], z = o->z[j + 1] - o->z[j];
    square[j] = x * x + y * y + z * z;
  }
  for (uint32_t j = 0; j + 1 < kind->vertices; j++)
    longest = square[j] > longest ? square[j] : longest;
  return (struct column_contour){kind, o, padded, drift, sqrt(longest)};
}

/* Where vertex j was, from a place. */
static struct vec3 column_relative(const struct column_contour *c, struct vec3 place, uint32_t j)
{
  return vec3_add(vec3_sub(at(c->origin, j), place), c->drift);
}

/* fmin of two numbers. */
static double least_of(double a, double b)
{
  return a < b ? a : b;
}

/* Squared distances of a place from all vertices, and the least of them. */
static double column_squares(const struct column_contour *c, struct vec3 place, double *square)
{
  const struct columns *o = c->origin;
  reals least = (reals){0} + INFINITY;
  for (uint32_t j = 0; j < c->padded; j += LANES) {
    const reals x = load_reals(&o->x[j]) - place.x + c->drift.x, y = load_reals(&o->y[j]) - place.y + c->drift.y,
                z = load_reals(&o->z[j]) - place.z + c->drift.z, here = x * x + y * y + z * z;
    store_reals(&square[j], here);
    least = choose(here < least, here, least);
  }
  double nearest = least[0];
  for (int l = 1; l < LANES; l++)
    nearest = least_of(least[l], nearest);
  return nearest;
}

/* distance_from. What fills the columns up is not in reach. */
static double column_distance_from(const struct column_contour *c, struct vec3 place, double *vertex)
{
  const uint32_t last = c->kind->vertices - 1;
  double square[MOST];
  const double nearest = column_squares(c, place, square), reach = reach_of(nearest, c->longest), most = reach * reach;
  double contour = nearest;
  for (uint32_t first = 0; first < last; first += LANES)
    for (uint32_t near = zeros((words)(load_reals(&square[first]) > most)); near != 0; near &= near - 1) {
      const uint32_t j = first + (uint32_t)__builtin_ctz(near);
      if (j < last)
        contour = least_of(contour,
                           squared_distance_to_segment(column_relative(c, place, j), column_relative(c, place, j + 1)));
    }
  if (c->kind->ring)
    contour =
        least_of(contour, squared_distance_to_segment(column_relative(c, place, last), column_relative(c, place, 0)));
  *vertex = nearest;
  return contour;
}

static void column_tube(const struct column_contour *c, const struct columns *now, struct fiber_motion *motion)
{
  const uint32_t vertices = dynamics_third(c->kind), middle = dynamics_middle(c->kind);
  double sum = 0.0, unused;
  motion->tube_contour = column_distance_from(c, at(now, middle), &motion->tube);
  for (uint32_t k = 0; k < vertices; k++) {
    const uint32_t j = dynamics_third_vertex(c->kind, k);
    sum += j == middle ? motion->tube_contour : column_distance_from(c, at(now, j), &unused);
  }
  motion->tube_third = sum / vertices;
}

static void column_end_to_end(const struct fiber_kind *kind, const struct columns *origin, const struct columns *now,
                              struct fiber_motion *motion)
{
  const uint32_t last = kind->vertices - 1;
  const struct vec3 zero = at(now, 0), then = at(origin, last), here = vec3_sub(at(now, last), zero);
  struct vec3 axis = {0, 0, 0}, axis_now = {0, 0, 0};
  for (uint32_t j = 1; j <= last; j++) {
    const double weight = axis_weight(kind, j);
    axis = vec3_add_scaled(axis, weight, at(origin, j));
    axis_now = vec3_add_scaled(axis_now, weight, vec3_sub(at(now, j), zero));
  }
  set_end_to_end(then, here, motion);
  motion->axis = cosine_between(axis, axis_now);
}

struct fiber_motion fiber_motion(const struct fiber_kind *kind, const struct point *origin, const struct point *now,
                                 struct vec3 drift, struct vec3 *scratch)
{
  const uint32_t n = kind->vertices;
  struct fiber_motion motion = {.vertices = 0.0};
  struct columns before, here;
  if (n > MOST || !fill(origin, origin, n, &before) || !fill(origin, now, n, &here))
    return fiber_motion_plain(kind, origin, now, drift, scratch);
  const struct column_contour contour = column_contour_of(kind, &before, pad(&before, n), drift);
  column_displacements(kind, &before, &here, drift, &motion);
  column_tube(&contour, &here, &motion);
  if (!kind->ring)
    column_end_to_end(kind, &before, &here, &motion);
  return motion;
}
