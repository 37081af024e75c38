#include "oracle/event_rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/rule.h"
#include "contact/takeoff.h"
#include "fiber/force.h"
#include "oracle/columns.h"

const char *const oracle_ends[4] = {"p0", "p1", "q0", "q1"};

/* --- flights ----------------------------------------------------------------------------------------------------- */

struct at_tick {
  const struct oracle_stage *stage;
  int32_t tick;
};

struct point oracle_rate_of(const struct oracle_stage *g, uint32_t vertex)
{
  return takeoff_rate_now(g->state, &g->work->contact, vertex);
}

static struct point place_of(const struct oracle_stage *g, uint32_t vertex, int32_t tick)
{
  return flight_place(g->state->position[vertex], oracle_rate_of(g, vertex), tick);
}

static struct point place_at_tick(const void *context, uint32_t vertex)
{
  const struct at_tick *t = context;
  return place_of(t->stage, vertex, t->tick);
}

struct vec3 oracle_force_at_tick(const struct oracle_stage *g, uint32_t vertex, int32_t tick)
{
  const struct at_tick places = {g, tick};
  return fiber_force_at(g->model, vertex, place_at_tick, &places);
}

/* --- searches ---------------------------------------------------------------------------------------------------- */

bool oracle_search_is_legal(const struct flight_pair *f, double from)
{
  const int64_t *at = &f->p.x, *rate = &f->p_rate.x, limit = (int64_t)1 << 52, fastest = limit / FLIGHT_TICKS;
  for (int k = 0; k < 9; k++)
    if (!(at[k] < limit && at[k] > -limit && rate[k] < fastest && rate[k] > -fastest))
      return false;
  return from >= 0.0 && from < FLIGHT_TICKS;
}

void oracle_put_flight_pairs(struct oracle_stage *g, const struct oracle_search *s, uint32_t n)
{
  oracle_put_points_of(g, "in.p", s, sizeof *s, offsetof(struct oracle_search, pair.p), n);
  oracle_put_points_of(g, "in.q", s, sizeof *s, offsetof(struct oracle_search, pair.q), n);
  oracle_put_points_of(g, "in.w", s, sizeof *s, offsetof(struct oracle_search, pair.w), n);
  oracle_put_points_of(g, "in.p_rate", s, sizeof *s, offsetof(struct oracle_search, pair.p_rate), n);
  oracle_put_points_of(g, "in.q_rate", s, sizeof *s, offsetof(struct oracle_search, pair.q_rate), n);
  oracle_put_points_of(g, "in.w_rate", s, sizeof *s, offsetof(struct oracle_search, pair.w_rate), n);
  int64_t *from = oracle_put_integers(g, "in.from", "tick", n);
  for (uint32_t k = 0; from && k < n; k++)
    from[k] = s[k].from;
}

void oracle_put_searches(struct oracle_stage *g, const struct oracle_search *s, uint32_t n)
{
  oracle_put_flight_pairs(g, s, n);
  int64_t *tick = oracle_put_integers(g, "out.tick", "tick", n);
  for (uint32_t k = 0; tick && k < n; k++)
    tick[k] = flight_contact(&s[k].pair, s[k].from);
}

/* --- impulses ---------------------------------------------------------------------------------------------------- */

/* A vector of one of the four ends, in each row: it stands at `offset`. */
static void put_vectors(struct oracle_stage *g, const char *kind, const struct oracle_impulse *e, size_t offset,
                        int end, uint32_t n)
{
  char name[PACK_WORD];
  snprintf(name, sizeof name, "%s%s", kind, oracle_ends[end]);
  double *to = oracle_put_reals(g, name, "x y z", n);
  for (uint32_t k = 0; to && k < n; k++) {
    struct vec3 v;
    memcpy(&v, (const char *)&e[k] + offset + (size_t)end * sizeof v, sizeof v);
    to[3 * k] = v.x, to[3 * k + 1] = v.y, to[3 * k + 2] = v.z;
  }
}

static void put_inputs(struct oracle_stage *g, const struct oracle_impulse *e, uint32_t n)
{
  for (int end = 0; end < 4; end++)
    put_vectors(g, "in.", e, offsetof(struct oracle_impulse, velocity), end, n);
  for (int end = 0; end < 4; end++)
    put_vectors(g, "in.force_", e, offsetof(struct oracle_impulse, force), end, n);
  double *mass = oracle_put_reals(g, "in.mass", "p0 p1 q0 q1", n);
  for (uint32_t k = 0; mass && k < n; k++)
    memcpy(&mass[4 * (size_t)k], e[k].mass, sizeof e[k].mass);
  double *contact = oracle_put_reals(g, "in.contact", "s t", n);
  for (uint32_t k = 0; contact && k < n; k++)
    contact[2 * k] = e[k].s, contact[2 * k + 1] = e[k].t;
  double *normal = oracle_put_reals(g, "in.normal", "x y z", n);
  for (uint32_t k = 0; normal && k < n; k++)
    normal[3 * k] = e[k].normal.x, normal[3 * k + 1] = e[k].normal.y, normal[3 * k + 2] = e[k].normal.z;
  double *tau = oracle_put_reals(g, "in.tau", "tau", n);
  for (uint32_t k = 0; tau && k < n; k++)
    tau[k] = e[k].tau;
}

static enum contact_answer exchange(struct oracle_impulse *e, double *momentum)
{
  struct contact_end end[4];
  struct contact_geometry at = {e->s, e->t, e->normal, 0.0};
  for (int k = 0; k < 4; k++)
    end[k] = (struct contact_end){&e->velocity[k], 1.0 / e->mass[k], e->force[k]};
  const enum contact_answer answer = impulse_at_own_time(end, &at, e->tau);
  *momentum = at.impulse;
  return answer;
}

void oracle_put_impulses(struct oracle_stage *g, const struct oracle_impulse *before, uint32_t n)
{
  struct oracle_impulse *e = malloc(((size_t)n + 1) * sizeof *e);
  double *momentum = malloc(((size_t)n + 1) * sizeof *momentum);
  put_inputs(g, before, n);
  int64_t *answer = oracle_put_integers(g, "out.answer", "answer", n);
  g->pack->failed |= !e || !momentum;
  for (uint32_t k = 0; !g->pack->failed && k < n; k++) {
    e[k] = before[k];
    answer[k] = exchange(&e[k], &momentum[k]);
  }
  double *dp = oracle_put_reals(g, "out.momentum", "momentum", n);
  if (!g->pack->failed && momentum) {
    memcpy(dp, momentum, n * sizeof *dp);
    for (int end = 0; end < 4; end++)
      put_vectors(g, "out.", e, offsetof(struct oracle_impulse, velocity), end, n);
  }
  free(e);
  free(momentum);
}

/* --- events ------------------------------------------------------------------------------------------------------ */

void oracle_put_events(struct oracle_stage *g, const struct oracle_events *e)
{
  int64_t *who = oracle_put_integers(g, "out.event", "bond other image_x image_y image_z tick", e->count);
  for (uint32_t k = 0; who && k < e->count; k++) {
    const struct contact_event *v = &e->at[k].event;
    const int64_t row[6] = {v->moving_bond, v->standing_bond, v->image[0], v->image[1], v->image[2], e->at[k].tick};
    memcpy(&who[6 * (size_t)k], row, sizeof row);
  }
  double *how = oracle_put_reals(g, "out.hit", "s t normal_x normal_y normal_z momentum", e->count);
  for (uint32_t k = 0; how && k < e->count; k++) {
    const struct contact_event *v = &e->at[k].event;
    const double row[6] = {v->hit.s, v->hit.s_standing, v->hit.normal.x, v->hit.normal.y, v->hit.normal.z, v->impulse};
    memcpy(&how[6 * (size_t)k], row, sizeof row);
  }
  double *condition = oracle_put_reals(g, "bound.hit", "condition", e->count);
  for (uint32_t k = 0; condition && k < e->count; k++)
    condition[k] = e->at[k].condition;
}

/* Whether doubles make a product, and so any other arithmetic of 53 bits, fused or not. */
static bool is_exact(double a, double b)
{
  return fma(a, b, -(a * b)) == 0.0;
}

/* Bonds so parallel that nothing is rounded on the way to their s and t. */
static bool exactly_parallel(struct vec3 p, struct vec3 q, struct vec3 w)
{
  const double *of[3] = {&p.x, &q.x, &w.x};
  bool exact = vec3_norm(vec3_cross(p, q)) == 0.0;
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      for (int k = 0; k < 9; k++)
        exact = exact && is_exact(of[a][k / 3], of[b][k % 3]);
  return exact && is_exact(vec3_dot(p, w), vec3_dot(q, q)) && is_exact(vec3_dot(p, q), vec3_dot(q, w));
}

/* Of nearly parallel bonds, s and t are inexact. The normal of tubes, and of parallel bonds, is the direction of a
 * short vector. */
static double condition_of(const struct oracle_stage *g, const struct contact_event *v, int32_t tick)
{
  const struct model *m = g->model;
  const uint32_t four[4] = {v->moving_bond, (uint32_t)m->next[v->moving_bond], v->standing_bond,
                            (uint32_t)m->next[v->standing_bond]};
  struct point at[4];
  for (int k = 0; k < 4; k++)
    at[k] = place_of(g, four[k], tick);
  const struct vec3 p = point_difference(at[1], at[0]), q = point_difference(at[3], at[2]),
                    w = point_difference(point_image(at[2], v->image, &m->box), at[0]);
  const double reach = (double)model_reach(m, v->moving_bond, v->standing_bond) * LATTICE_UNIT,
               both = vec3_norm(p) + vec3_norm(q), lengths = 1.0 + both / fmin(vec3_norm(p), vec3_norm(q));
  if (reach == 0.0 && exactly_parallel(p, q, w)) {
    const struct vec3 gap = vec3_add_scaled(vec3_add_scaled(w, v->hit.s_standing, q), -v->hit.s, p);
    return lengths * (1.0 + (vec3_norm(gap) > 0.0 ? both / vec3_norm(gap) : 0.0));
  }
  const double parallel = vec3_norm(p) * vec3_norm(q) / vec3_norm(vec3_cross(p, q));
  return parallel * parallel * lengths * (reach > 0.0 ? 1.0 + both / reach : 1.0);
}

static void take_event(void *context, const struct contact_event *v)
{
  struct oracle_events *e = context;
  struct oracle_event *grown = realloc(e->at, (e->count + 1) * sizeof *grown);
  e->failed |= !grown;
  if (!grown)
    return;
  e->at = grown;
  const int32_t tick = (int32_t)(v->hit.time * FLIGHT_TICKS);
  e->at[e->count++] = (struct oracle_event){*v, tick, condition_of(e->stage, v, tick)};
}

bool oracle_drift_at_once(struct oracle_stage *g, double dt, double start, const struct contact_log *log)
{
  g->work->contact.frame = (struct drift_frame){.time = dt, .start = start};
  return event_driven_rule.drift(g->state, g->model, &g->work->contact, g->place.step, 0, log, &g->work->fault);
}

bool oracle_event_drift_for(struct oracle_stage *g, double dt, double start)
{
  struct oracle_events events = {.stage = g};
  const struct contact_log log = {take_event, &events};
  double *time = oracle_put_reals(g, "in.time", "dt start", 1);
  if (time)
    time[0] = dt, time[1] = start;
  oracle_put_points(g, "in.position", g->state->position, g->state->vertices);
  oracle_put_vectors(g, "in.velocity", g->state->velocity, g->state->vertices);
  const bool ok = oracle_drift_at_once(g, dt, start, &log);
  oracle_put_events(g, &events);
  oracle_put_points(g, "out.position", g->state->position, g->state->vertices);
  oracle_put_vectors(g, "out.velocity", g->state->velocity, g->state->vertices);
  g->pack->failed |= events.failed;
  free(events.at);
  return ok;
}
