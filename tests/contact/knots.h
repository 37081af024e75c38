/* Knotted rings, and an invariant of knots that is computed exactly: the determinant |Delta(-1)|, Delta being the
 * polynomial of Alexander. 1 of the unknot, 3 of the trefoil, 5 of the figure eight, n of the torus knot (2, n). */
#ifndef UNCROSS_TESTS_KNOTS_H
#define UNCROSS_TESTS_KNOTS_H

#include "contact/rings.h"
#include "topology/alexander.h"

/* --- the determinant of a knot ------------------------------------------------------------------------------------ */

#define KNOT_PRIME (ALEXANDER_ABOVE - 1)

/* Of a closed polygon. */
static inline double knot_determinant(const struct point *vertex, uint32_t vertices)
{
  struct diagram d = {0};
  struct alexander a = {0};
  uint64_t value = 0;
  const struct polygons p = {1, (const uint32_t[]){0, vertices}, vertex};
  assert_int_equal(diagram_make(&d, &p, true, UINT32_MAX), DIAGRAM_FINE);
  assert_true(alexander_value(&a, &d, KNOT_PRIME - 1, KNOT_PRIME, &value));
  diagram_free(&d);
  alexander_free(&a);
  return (double)(value < KNOT_PRIME / 2 ? value : KNOT_PRIME - value);
}

/* --- knots -------------------------------------------------------------------------------------------------------- */

enum knot_kind { UNKNOT, TREFOIL, FIGURE_EIGHT, TORUS_2_5, KNOT_KINDS };

static inline struct vec3 knot_curve(enum knot_kind kind, double t)
{
  const double r = 2.0 + cos(kind == FIGURE_EIGHT ? 2.0 * t : 5.0 * t);
  switch (kind) {
  case TREFOIL:
    return (struct vec3){sin(t) + 2.0 * sin(2.0 * t), cos(t) - 2.0 * cos(2.0 * t), -sin(3.0 * t)};
  case FIGURE_EIGHT:
    return (struct vec3){r * cos(3.0 * t), r * sin(3.0 * t), sin(4.0 * t)};
  case TORUS_2_5: /* twice around */
    return (struct vec3){r * cos(2.0 * t), r * sin(2.0 * t), sin(5.0 * t)};
  default:
    return (struct vec3){cos(t), sin(t), 0.3 * sin(2.0 * t)};
  }
}

static inline double knot_determinant_of_kind(enum knot_kind kind)
{
  return kind == TREFOIL ? 3.0 : kind == UNKNOT ? 1.0 : 5.0;
}

/* n points of the curve, all `bond` apart along it, about a center, turned by an angle about (1, 2, 3). */
static inline void lay_knot(struct point *at, uint32_t n, enum knot_kind kind, double bond, struct vec3 center,
                            double angle)
{
  enum { FINE = 4096 };
  static double length[FINE + 1];
  const double step = 6.283185307179586477 / FINE;
  for (int k = 0; k < FINE; k++)
    length[k + 1] = length[k] + vec3_norm(vec3_sub(knot_curve(kind, (k + 1) * step), knot_curve(kind, k * step)));
  const double size = bond * n / length[FINE];
  const struct vec3 axis = vec3_scale(1.0 / sqrt(14.0), (struct vec3){1, 2, 3});
  for (uint32_t v = 0, k = 0; v < n; v++) {
    while (length[k + 1] < length[FINE] * v / n)
      k++;
    const struct vec3 r = vec3_scale(size, knot_curve(kind, k * step));
    const struct vec3 turned =
        vec3_add(vec3_add(vec3_scale(cos(angle), r), vec3_scale(sin(angle), vec3_cross(axis, r))),
                 vec3_scale((1.0 - cos(angle)) * vec3_dot(axis, r), axis));
    at[v] = point_move((struct point){0, 0, 0}, vec3_add(center, turned));
  }
}

/* Rings in a cubic box, each a knot of this kind, in turn. */
static inline struct test_run start_knots(struct model m, uint32_t rings, uint32_t vertices,
                                          const enum knot_kind *kinds, uint32_t different)
{
  struct fiber_kind *k = test_add_kind(&m, rings, vertices);
  k->ring = true;
  k->bending = 2.0;
  struct test_run r = test_start(m);
  const double edge = box_shortest_edge(&r.model.box);
  for (uint32_t ring = 0; ring < rings; ring++) {
    const struct vec3 center = {edge * ((ring * 5) % 8) / 8.0 + 0.013 * ring, edge * ((ring * 3) % 8) / 8.0,
                                edge * (ring % 8) / 8.0};
    lay_knot(&r.state.position[r.model.fiber_first[ring]], vertices, kinds[ring % different], 0.5, center,
             0.7 + 1.3 * ring);
  }
  r.work.contact.neighbors.built = false; /* they were laid by hand */
  return r;
}

struct knots_followed {
  uint64_t steps, executed;
  uint32_t looked, changed;
};

/* Steps, and looks at all knots every `every` steps. */
static inline struct knots_followed follow_knots(struct test_run *r, uint64_t steps, uint64_t every,
                                                 const enum knot_kind *kinds, uint32_t different)
{
  struct knots_followed f = {0};
  for (; f.steps < steps; f.steps += every) {
    test_steps(r, every);
    for (uint32_t ring = 0; ring < r->model.fibers; ring++) {
      const uint32_t first = r->model.fiber_first[ring], n = r->model.fiber_first[ring + 1] - first;
      const double now = knot_determinant(&r->state.position[first], n);
      f.looked++;
      f.changed += now != knot_determinant_of_kind(kinds[ring % different]);
    }
  }
  f.executed = r->state.counts.executed;
  return f;
}

#endif
