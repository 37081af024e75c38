#include "contact/shape.h"

#include "contact/capsule.h"
#include "contact/determinant.h"
#include "contact/tube.h"

/* --- lines -------------------------------------------------------------------------------------------------------- */

static int32_t line_contact(const struct flight_pair *pair, int64_t reach, int32_t from)
{
  (void)reach;
  return flight_contact(pair, from);
}

static void line_points(struct vec3 p, struct vec3 q, struct vec3 w, double *s, double *t)
{
  capsule_closest(p, q, w, s, t);
}

/* (p x q).w at a tick, with its exact sign. */
static double volume_at(const struct flight_pair *pair, int32_t tick)
{
  const struct point p = flight_place(pair->p, pair->p_rate, tick), q = flight_place(pair->q, pair->q_rate, tick),
                     w = flight_place(pair->w, pair->w_rate, tick);
  return determinant((struct difference){p.x, p.y, p.z}, (struct difference){q.x, q.y, q.z},
                     (struct difference){w.x, w.y, w.z});
}

/* Perpendicular to both bonds. Parallel bonds have no such direction; and where both lie in one plane, an end meets a
 * bond from the side. Then it is the direction of the gap between them; if the gap has none, the direction of their
 * relative velocity perpendicular to q. */
static bool line_normal(const struct flight_pair *pair, int32_t tick, const struct shape_contact *at,
                        struct vec3 *normal)
{
  const struct vec3 p = at->p, q = at->q, velocity = at->velocity;
  const double volume = volume_at(pair, tick);
  struct vec3 n = vec3_cross(p, q);
  const bool parallel = !(vec3_dot(n, n) > 1e-24 * vec3_dot(p, p) * vec3_dot(q, q));
  double approach = vec3_dot(n, velocity);
  if (volume < 0.0 || (volume == 0.0 && approach < 0.0))
    n = vec3_scale(-1.0, n), approach = -approach;
  if (parallel || (volume == 0.0 && !(approach > 0.0))) {
    n = at->gap;
    if (!(vec3_dot(n, n) > 0.0))
      n = vec3_add_scaled(velocity, -vec3_dot(velocity, q) / vec3_dot(q, q), q);
  }
  *normal = vec3_scale(1.0 / vec3_norm(n), n);
  return volume != 0.0 || !(vec3_norm(at->gap) < 0.25 * LATTICE_UNIT);
}

const struct bond_shape line_shape = {"line", line_contact, line_points, line_normal};

/* --- tubes -------------------------------------------------------------------------------------------------------- */

#define PARALLEL 1e-12 /* an angle: that of a lattice unit over a bond */

/* Parallel tubes that lie side by side touch along a line: its middle. */
static void tube_points(struct vec3 p, struct vec3 q, struct vec3 w, double *s, double *t)
{
  const struct vec3 n = vec3_cross(p, q);
  const double pp = vec3_dot(p, p), qq = vec3_dot(q, q), a = vec3_dot(w, p) / pp, b = vec3_dot(vec3_add(w, q), p) / pp,
               from = fmax(0.0, fmin(a, b)), to = fmin(1.0, fmax(a, b));
  capsule_closest(p, q, w, s, t);
  if (!(from < to) || vec3_dot(n, n) > PARALLEL * PARALLEL * pp * qq)
    return;
  *s = 0.5 * (from + to);
  *t = capsule_within_one((*s - a) / (b - a));
}

/* Along the line of nearest points, so that the exchange of momentum keeps the angular momentum. */
static bool tube_normal(const struct flight_pair *pair, int32_t tick, const struct shape_contact *at,
                        struct vec3 *normal)
{
  (void)pair, (void)tick;
  const double size = vec3_norm(at->gap);
  *normal = vec3_scale(size > 0.0 ? 1.0 / size : 0.0, at->gap);
  return size > 0.0;
}

const struct bond_shape tube_shape = {"tube", tube_contact, tube_points, tube_normal};
