#include "oracle/rows.h"

#include <math.h>
#include <string.h>

#include "contact/capsule.h"
#include "contact/impulse.h"
#include "contact/shape.h"
#include "topology/pair.h"

double oracle_condition(struct vec3 way, struct vec3 bond, struct vec3 standing, double time)
{
  const struct vec3 p = vec3_add_scaled(bond, -time, way);
  const double lengths = vec3_norm(standing) * (vec3_norm(bond) + vec3_norm(way));
  const double speed = fabs(vec3_dot(vec3_cross(standing, bond), way));
  const double cross = vec3_norm(vec3_cross(p, standing)), parallel = vec3_norm(p) * vec3_norm(standing) / cross;
  const double reach = vec3_norm(bond) + vec3_norm(standing) + vec3_norm(way);
  return (1.0 + lengths * reach / speed) * parallel * parallel *
         (1.0 + reach / fmin(vec3_norm(p), vec3_norm(standing)));
}

bool oracle_run_permutations(struct oracle_stage *g)
{
  struct oracle_permutation *p = g->row;
  for (uint32_t k = 0; k < g->rows; k++) {
    const struct oracle_address *a = &p[k].address;
    random_permutation(g->model->seed, a->purpose, a->draw, a->step, a->entity, p[k].order);
  }
  return true;
}

bool oracle_run_tests(struct oracle_stage *g)
{
  struct oracle_test *t = g->row;
  for (uint32_t k = 0; k < g->rows; k++) {
    const struct crossing_query *q = &t[k].query;
    struct crossing_hit hit;
    t[k].crosses = crossing_find(q, &hit);
    if (!t[k].crosses)
      continue;
    t[k].hit = hit;
    t[k].condition = oracle_condition(point_difference(q->to, q->from), point_difference(q->pivot, q->from),
                                      point_difference(q->b, q->a), hit.time);
  }
  return true;
}

static struct vec3 vector_of(struct point x)
{
  return (struct vec3){(double)x.x, (double)x.y, (double)x.z};
}

bool oracle_run_meetings(struct oracle_stage *g)
{
  struct oracle_meeting *m = g->row;
  for (uint32_t k = 0; k < g->rows; k++) {
    struct pair pair;
    struct crossing crossing[3];
    int crossings;
    for (int t = 0; t < 2; t++) {
      pair.p[t] = vector_of(m[k].p[t]);
      pair.q[t] = vector_of(m[k].q[t]);
      pair.w[t] = vector_of(m[k].w[t]);
    }
    const enum pair_verdict verdict = pair_decide(&pair, crossing, &crossings);
    m[k].class = verdict == PAIR_APART ? 0 : verdict == PAIR_CROSSED ? 1 : 2;
    for (int i = 0; i < 3; i++)
      m[k].sign[i] = verdict == PAIR_CROSSED && i < crossings ? crossing[i].sign : 0;
  }
  return true;
}

bool oracle_run_exchanges(struct oracle_stage *g)
{
  struct oracle_exchange *e = g->row;
  for (uint32_t k = 0; k < g->rows; k++) {
    struct impulse_end end[4];
    memcpy(e[k].after, e[k].velocity, sizeof e[k].after);
    for (int i = 0; i < 4; i++)
      end[i] = (struct impulse_end){&e[k].after[i], 1.0 / e[k].mass[i]};
    e[k].momentum = impulse_exchange(end, end + 2, e[k].s, e[k].s_standing, e[k].normal);
  }
  return true;
}

bool oracle_search_is_legal(const struct flight_pair *f, double from)
{
  const int64_t *at = &f->p.x, *rate = &f->p_rate.x, limit = (int64_t)1 << 52, fastest = limit / FLIGHT_TICKS;
  for (int k = 0; k < 9; k++)
    if (!(at[k] < limit && at[k] > -limit && rate[k] < fastest && rate[k] > -fastest))
      return false;
  return from >= 0.0 && from < FLIGHT_TICKS;
}

bool oracle_run_searches(struct oracle_stage *g)
{
  struct oracle_search *s = g->row;
  for (uint32_t k = 0; k < g->rows; k++)
    s[k].tick = bond_shape_of(s[k].reach)->contact(&s[k].pair, s[k].reach, s[k].from);
  return true;
}

bool oracle_run_tubes(struct oracle_stage *g)
{
  struct oracle_tubes *c = g->row;
  for (uint32_t k = 0; k < g->rows; k++) {
    const struct flight_pair still = {.p = c[k].p, .q = c[k].q, .w = c[k].w};
    const struct vec3 p = point_in_a0(c[k].p), q = point_in_a0(c[k].q), w = point_in_a0(c[k].w);
    tube_shape.points(p, q, w, &c[k].s, &c[k].t);
    const struct shape_contact at = {p, q, capsule_between(p, q, w, c[k].s, c[k].t), {0, 0, 0}};
    tube_shape.normal(&still, 0, &at, &c[k].normal);
  }
  return true;
}

bool oracle_run_impulses(struct oracle_stage *g)
{
  struct oracle_impulse *e = g->row;
  for (uint32_t k = 0; k < g->rows; k++) {
    struct contact_end end[4];
    struct contact_geometry at = {e[k].s, e[k].t, e[k].normal, 0.0};
    memcpy(e[k].after, e[k].velocity, sizeof e[k].after);
    for (int i = 0; i < 4; i++)
      end[i] = (struct contact_end){&e[k].after[i], 1.0 / e[k].mass[i], e[k].force[i]};
    e[k].answer = impulse_at_own_time(end, &at, e[k].tau);
    e[k].momentum = at.impulse;
  }
  return true;
}
