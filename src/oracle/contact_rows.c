#include "oracle/contact_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/impulse.h"
#include "oracle/columns.h"

/* How much the data of a hit at this time amplify rounding (docs/port/tolerances.md, Tolerances). */
static double condition_of(const struct crossing_query *k, double time)
{
  const struct vec3 move = point_difference(k->to, k->from), ab = point_difference(k->b, k->a);
  const struct vec3 bond = point_difference(k->pivot, k->from);
  const struct vec3 p = vec3_add_scaled(bond, -time, move);
  const double lengths = vec3_norm(ab) * (vec3_norm(bond) + vec3_norm(move));
  const double speed = fabs(vec3_dot(vec3_cross(ab, bond), move));
  const double cross = vec3_norm(vec3_cross(p, ab)), parallel = vec3_norm(p) * vec3_norm(ab) / cross;
  const double reach = vec3_norm(bond) + vec3_norm(ab) + vec3_norm(move);
  return (1.0 + lengths * reach / speed) * parallel * parallel * (1.0 + reach / fmin(vec3_norm(p), vec3_norm(ab)));
}

void oracle_put_crossings(struct oracle_stage *g, const struct crossing_query *q, uint32_t n)
{
  oracle_put_points_of(g, "in.from", q, sizeof *q, offsetof(struct crossing_query, from), n);
  oracle_put_points_of(g, "in.to", q, sizeof *q, offsetof(struct crossing_query, to), n);
  oracle_put_points_of(g, "in.pivot", q, sizeof *q, offsetof(struct crossing_query, pivot), n);
  oracle_put_points_of(g, "in.a", q, sizeof *q, offsetof(struct crossing_query, a), n);
  oracle_put_points_of(g, "in.b", q, sizeof *q, offsetof(struct crossing_query, b), n);
  int64_t *flip = oracle_put_integers(g, "in.flip", "flip", n);
  for (uint32_t k = 0; flip && k < n; k++)
    flip[k] = q[k].flip;
  int64_t *crosses = oracle_put_integers(g, "out.crosses", "crosses", n);
  for (uint32_t k = 0; crosses && k < n; k++) {
    struct crossing_hit hit;
    crosses[k] = crossing_find(&q[k], &hit);
  }
  double *how = oracle_put_reals(g, "out.hit", "time s s_standing normal_x normal_y normal_z", n);
  for (uint32_t k = 0; how && k < n; k++) {
    struct crossing_hit h;
    if (!crossing_find(&q[k], &h))
      continue;
    const double row[6] = {h.time, h.s, h.s_standing, h.normal.x, h.normal.y, h.normal.z};
    memcpy(&how[6 * (size_t)k], row, sizeof row);
  }
  double *condition = oracle_put_reals(g, "bound.hit", "condition", n);
  for (uint32_t k = 0; condition && k < n; k++) {
    struct crossing_hit h;
    condition[k] = crossing_find(&q[k], &h) ? condition_of(&q[k], h.time) : 0.0;
  }
}

/* --- exchanges --------------------------------------------------------------------------------------------------- */

static const char *const ends[4] = {"moving", "pivot", "a", "b"};

/* The velocity of one of the four vertices, in each row. */
static void put_velocities(struct oracle_stage *g, const char *kind, const struct oracle_exchange *e, int end,
                           uint32_t n)
{
  char name[PACK_WORD];
  snprintf(name, sizeof name, "%s.%s", kind, ends[end]);
  double *to = oracle_put_reals(g, name, "x y z", n);
  for (uint32_t k = 0; to && k < n; k++) {
    const struct vec3 v = e[k].velocity[end];
    to[3 * k] = v.x, to[3 * k + 1] = v.y, to[3 * k + 2] = v.z;
  }
}

static double exchange(struct oracle_exchange *e)
{
  const struct impulse_end moving[2] = {{&e->velocity[0], 1.0 / e->mass[0]}, {&e->velocity[1], 1.0 / e->mass[1]}};
  const struct impulse_end standing[2] = {{&e->velocity[2], 1.0 / e->mass[2]}, {&e->velocity[3], 1.0 / e->mass[3]}};
  return impulse_exchange(moving, standing, e->s, e->s_standing, e->normal);
}

static void put_inputs(struct oracle_stage *g, const struct oracle_exchange *e, uint32_t n)
{
  for (int end = 0; end < 4; end++)
    put_velocities(g, "in", e, end, n);
  double *mass = oracle_put_reals(g, "in.mass", "moving pivot a b", n);
  for (uint32_t k = 0; mass && k < n; k++)
    memcpy(&mass[4 * (size_t)k], e[k].mass, sizeof e[k].mass);
  double *contact = oracle_put_reals(g, "in.contact", "s s_standing", n);
  for (uint32_t k = 0; contact && k < n; k++)
    contact[2 * k] = e[k].s, contact[2 * k + 1] = e[k].s_standing;
  double *normal = oracle_put_reals(g, "in.normal", "x y z", n);
  for (uint32_t k = 0; normal && k < n; k++)
    normal[3 * k] = e[k].normal.x, normal[3 * k + 1] = e[k].normal.y, normal[3 * k + 2] = e[k].normal.z;
}

void oracle_put_exchanges(struct oracle_stage *g, const struct oracle_exchange *before, uint32_t n)
{
  struct oracle_exchange *e = malloc(((size_t)n + 1) * sizeof *e);
  put_inputs(g, before, n);
  double *momentum = oracle_put_reals(g, "out.momentum", "momentum", n);
  g->pack->failed |= !e;
  if (g->pack->failed) {
    free(e);
    return;
  }
  for (uint32_t k = 0; k < n; k++) {
    e[k] = before[k];
    momentum[k] = exchange(&e[k]);
  }
  for (int end = 0; end < 4; end++)
    put_velocities(g, "out", e, end, n);
  free(e);
}
