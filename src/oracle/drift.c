#include "oracle/drift.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "contact/rule.h"
#include "contact/takeoff.h"
#include "fiber/force.h"
#include "oracle/rows.h"

#define LONG_DRIFT 32.0 /* dt, or 16, 8, ... if no more fits into the box */

/* --- drifts ------------------------------------------------------------------------------------------------------ */

/* log: told of each contact, or NULL. */
static bool drift(struct oracle_stage *g, const struct contact_log *log)
{
  const struct model *m = g->model;
  struct contact *c = &g->work->contact;
  struct drift_frame frame = {.time = g->drift.time, .start = g->drift.start};
  if (oracle_has_events(m)) {
    c->frame = frame;
    return event_driven_rule.drift(g->state, m, c, g->place.step, 0, log, &g->work->fault);
  }
  frame = drift_frame_now(g->state, m, 1.0, g->drift.number, crossing_rule_of(m)->forbids);
  frame.time = g->drift.time; /* by way of a part of dt it would be rounded */
  return contact_drift_in(&frame, g->state, m, c, g->place.step, g->drift.number, log, &g->work->fault);
}

bool oracle_begin_drift_of(struct oracle_stage *g, double time, uint32_t number)
{
  g->drift = (struct oracle_drift){time, -0.5 * time, number};
  if (!oracle_has_events(g->model))
    random_permutation(g->model->seed, RANDOM_VERTEX_ORDER, number, g->place.step, g->state->vertices,
                       g->work->contact.order);
  return true;
}

bool oracle_begin_drift(struct oracle_stage *g)
{
  g->state->solvent_lag += 2;
  return oracle_begin_drift_of(g, g->model->time_step, 0);
}

/* False if a vertex moves further than the box allows: exchanges can make one faster. A drift that has failed leaves
 * its scratch as it was in the middle. */
static bool fits(struct oracle_stage *g)
{
  const bool ok = drift(g, NULL) || g->work->fault.code != FAULT_VERTEX_MOVE;
  oracle_put_back(g);
  if (!ok) {
    contact_force *const force = g->work->contact.force;
    contact_free(&g->work->contact);
    g->work->fault = (struct fault){0};
    g->pack->failed |= !contact_alloc(&g->work->contact, g->model, force, true);
  }
  return ok || g->pack->failed;
}

bool oracle_begin_long_drift(struct oracle_stage *g)
{
  double length = LONG_DRIFT;
  oracle_begin_drift_of(g, length * g->model->time_step, 1);
  while (length > 1.0 && !fits(g)) {
    length *= 0.5;
    oracle_begin_drift_of(g, length * g->model->time_step, 1);
  }
  return g->work->fault.code == FAULT_NONE && !g->pack->failed;
}

/* --- its contacts ------------------------------------------------------------------------------------------------ */

struct at_tick {
  const struct oracle_stage *stage;
  int32_t tick;
};

struct point oracle_rate_of(const struct oracle_stage *g, uint32_t vertex)
{
  return takeoff_rate_now(g->state, &g->work->contact, vertex);
}

static struct point place_at_tick(const void *context, uint32_t vertex)
{
  const struct at_tick *t = context;
  return flight_place(t->stage->state->position[vertex], oracle_rate_of(t->stage, vertex), t->tick);
}

struct vec3 oracle_force_at_tick(const struct oracle_stage *g, uint32_t vertex, int32_t tick)
{
  const struct at_tick places = {g, tick};
  return fiber_force_at(g->model, vertex, place_at_tick, &places);
}

static int32_t tick_of(const struct contact_event *v)
{
  return (int32_t)(v->hit.time * FLIGHT_TICKS);
}

/* The ends of the bond that moves, the moving vertex first, then those of the other bond. Where all move: of both. */
static void find_ends(const struct oracle_stage *g, const struct contact_event *v, uint32_t four[4])
{
  const int32_t *next = g->model->next;
  const uint32_t end = (uint32_t)next[v->moving_bond];
  const bool events = oracle_has_events(g->model), first = events || v->moving_bond == v->vertex;
  four[0] = events ? v->moving_bond : v->vertex, four[1] = first ? end : v->moving_bond;
  four[2] = v->standing_bond, four[3] = (uint32_t)next[v->standing_bond];
}

/* From the state that the move of a sweep found. */
static double condition_in_turn(const struct oracle_stage *g, const struct contact_event *v, const uint32_t four[4])
{
  const struct point *r = g->state->position;
  return oracle_condition(vec3_scale(g->drift.time, g->state->velocity[v->vertex]),
                          point_difference(r[four[1]], r[four[0]]), point_difference(r[four[3]], r[four[2]]),
                          v->hit.time);
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
static double condition_at_once(const struct oracle_stage *g, const struct contact_event *v, const uint32_t four[4])
{
  const struct at_tick places = {g, tick_of(v)};
  struct point at[4];
  for (int k = 0; k < 4; k++)
    at[k] = place_at_tick(&places, four[k]);
  const struct vec3 p = point_difference(at[1], at[0]), q = point_difference(at[3], at[2]),
                    w = point_difference(point_image(at[2], v->image, &g->model->box), at[0]);
  const double reach = (double)model_reach(g->model, v->moving_bond, v->standing_bond) * LATTICE_UNIT,
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
  struct oracle_stage *g = context;
  uint32_t four[4];
  find_ends(g, v, four);
  const struct oracle_event e = {
      *v, tick_of(v), oracle_has_events(g->model) ? condition_at_once(g, v, four) : condition_in_turn(g, v, four)};
  oracle_add_rows(g, &e, 1, sizeof e);
}

/* The log of a sweep records the executed hit of a move last. Here hits of one move are sorted as `earlier` does, so
 * that every port can write the same order. */
static int by_time(const struct contact_event *a, const struct contact_event *b)
{
  if (a->hit.time != b->hit.time)
    return a->hit.time < b->hit.time ? -1 : 1;
  const int64_t mine[5] = {a->moving_bond, a->standing_bond, a->image[0], a->image[1], a->image[2]};
  const int64_t its[5] = {b->moving_bond, b->standing_bond, b->image[0], b->image[1], b->image[2]};
  for (int k = 0; k < 5; k++)
    if (mine[k] != its[k])
      return mine[k] < its[k] ? -1 : 1;
  return 0;
}

static void sort_moves(struct oracle_event *e, uint32_t n)
{
  for (uint32_t k = 1; k < n; k++)
    for (uint32_t j = k; j > 0 && e[j].event.vertex == e[j - 1].event.vertex; j--) {
      if (by_time(&e[j - 1].event, &e[j].event) <= 0)
        break;
      const struct oracle_event swap = e[j];
      e[j] = e[j - 1];
      e[j - 1] = swap;
    }
}

bool oracle_run_drift(struct oracle_stage *g)
{
  const struct contact_log log = {take_event, g};
  const bool ok = drift(g, &log);
  if (!oracle_has_events(g->model))
    sort_moves(g->row, g->rows);
  return ok;
}

/* --- rows of a long drift ---------------------------------------------------------------------------------------- */

/* Makes rows of contacts as they come. */
struct witness {
  struct oracle_stage *stage;
  struct vec3 *velocity; /* of the vertices, before the contact: the log is told after the exchange */
  int32_t *bent;         /* tick at which the flight of each vertex has changed last */
  void (*take)(const struct witness *, const struct contact_event *, const uint32_t four[4]);
};

static void take_contact(void *context, const struct contact_event *v)
{
  struct witness *w = context;
  uint32_t four[4];
  find_ends(w->stage, v, four);
  w->take(w, v, four);
  for (int k = 0; v->executed && k < 4; k++) {
    w->velocity[four[k]] = w->stage->state->velocity[four[k]];
    w->bent[four[k]] = tick_of(v);
  }
}

static bool watch(struct oracle_stage *g,
                  void (*take)(const struct witness *, const struct contact_event *, const uint32_t[4]))
{
  const size_t n = (size_t)g->state->vertices + 1;
  struct witness w = {g, malloc(n * sizeof *w.velocity), calloc(n, sizeof *w.bent), take};
  const struct contact_log log = {take_contact, &w};
  g->pack->failed |= !w.velocity || !w.bent;
  bool ok = !g->pack->failed && oracle_begin_long_drift(g);
  if (ok) {
    memcpy(w.velocity, g->state->velocity, g->state->vertices * sizeof *w.velocity);
    ok = drift(g, &log);
  }
  free(w.velocity);
  free(w.bent);
  return ok;
}

/* The test that hit, and that of a move of half the time, which crosses nothing. */
static void take_tests(const struct witness *w, const struct contact_event *v, const uint32_t four[4])
{
  const struct oracle_stage *g = w->stage;
  const struct point *r = g->state->position;
  const struct vec3 way = vec3_scale(g->drift.time, w->velocity[v->vertex]);
  const struct crossing_query q = {.from = r[four[0]],
                                   .to = point_move(r[four[0]], way),
                                   .pivot = r[four[1]],
                                   .a = point_image(r[four[2]], v->image, &g->model->box),
                                   .b = point_image(r[four[3]], v->image, &g->model->box),
                                   .flip = v->moving_bond == v->vertex};
  struct oracle_test both[2] = {{.query = q}, {.query = q}};
  both[1].query.to = point_move(q.from, vec3_scale(0.5 * v->hit.time, way));
  oracle_add_rows(w->stage, both, 2, sizeof *both);
}

bool oracle_begin_tests(struct oracle_stage *g)
{
  return watch(g, take_tests);
}

static void take_exchange(const struct witness *w, const struct contact_event *v, const uint32_t four[4])
{
  struct oracle_exchange e = {.s = v->hit.s, .s_standing = v->hit.s_standing, .normal = v->hit.normal};
  for (int k = 0; k < 4; k++)
    e.velocity[k] = w->velocity[four[k]], e.mass[k] = w->stage->model->mass[four[k]];
  if (v->executed)
    oracle_add_rows(w->stage, &e, 1, sizeof e);
}

bool oracle_begin_exchanges(struct oracle_stage *g)
{
  return watch(g, take_exchange);
}

static struct flight_pair pair_of(const struct oracle_stage *g, const struct contact_event *v, const struct point at[4],
                                  const struct point rate[4])
{
  return (struct flight_pair){.p = point_minus(at[1], at[0]),
                              .q = point_minus(at[3], at[2]),
                              .w = point_minus(point_image(at[2], v->image, &g->model->box), at[0]),
                              .p_rate = point_minus(rate[1], rate[0]),
                              .q_rate = point_minus(rate[3], rate[2]),
                              .w_rate = point_minus(rate[2], rate[0])};
}

/* Three searches of each contact: the one that found it; of lines, one that begins a tick later, when the bonds have
 * passed each other; and the one after the exchange. */
static void take_searches(const struct witness *w, const struct contact_event *v, const uint32_t four[4])
{
  const struct oracle_stage *g = w->stage;
  const int32_t tick = tick_of(v);
  struct point at[4], rate[4], later[4], new_rate[4];
  int32_t from = 0;
  for (int k = 0; k < 4; k++) {
    at[k] = g->state->position[four[k]], rate[k] = oracle_rate_of(g, four[k]);
    new_rate[k] = flight_rate(vec3_scale(g->drift.time, g->state->velocity[four[k]]));
    later[k] = flight_place(flight_place(at[k], rate[k], tick), new_rate[k], -(int64_t)tick);
    from = w->bent[four[k]] > from ? w->bent[four[k]] : from;
  }
  const int64_t reach = model_reach(g->model, v->moving_bond, v->standing_bond);
  const struct oracle_search before = {.pair = pair_of(g, v, at, rate), .reach = reach, .from = from},
                             passed = {.pair = before.pair, .reach = reach, .from = tick + 1},
                             after = {.pair = pair_of(g, v, later, new_rate), .reach = reach, .from = tick};
  oracle_add_rows(w->stage, &before, 1, sizeof before);
  if (tick + 1 < FLIGHT_TICKS && reach == 0)
    oracle_add_rows(w->stage, &passed, 1, sizeof passed);
  oracle_add_rows(w->stage, &after, 1, sizeof after);
}

static void take_lines(const struct witness *w, const struct contact_event *v, const uint32_t four[4])
{
  if (model_reach(w->stage->model, v->moving_bond, v->standing_bond) == 0)
    take_searches(w, v, four);
}

static void take_tubes(const struct witness *w, const struct contact_event *v, const uint32_t four[4])
{
  if (model_reach(w->stage->model, v->moving_bond, v->standing_bond) > 0)
    take_searches(w, v, four);
}

bool oracle_begin_line_searches(struct oracle_stage *g)
{
  return watch(g, take_lines);
}

bool oracle_begin_tube_searches(struct oracle_stage *g)
{
  return watch(g, take_tubes);
}

static void take_tube_contact(const struct witness *w, const struct contact_event *v, const uint32_t four[4])
{
  const struct oracle_stage *g = w->stage;
  const struct at_tick places = {g, tick_of(v)};
  struct point at[4];
  for (int k = 0; k < 4; k++)
    at[k] = place_at_tick(&places, four[k]);
  const struct oracle_tubes c = {.p = point_minus(at[1], at[0]),
                                 .q = point_minus(at[3], at[2]),
                                 .w = point_minus(point_image(at[2], v->image, &g->model->box), at[0])};
  if (model_reach(g->model, v->moving_bond, v->standing_bond) > 0)
    oracle_add_rows(w->stage, &c, 1, sizeof c);
}

bool oracle_begin_tube_contacts(struct oracle_stage *g)
{
  return watch(g, take_tube_contact);
}

static void take_impulse(const struct witness *w, const struct contact_event *v, const uint32_t four[4])
{
  const struct oracle_stage *g = w->stage;
  struct oracle_impulse e = {.s = v->hit.s, .t = v->hit.s_standing, .normal = v->hit.normal};
  e.tau = g->drift.start + g->drift.time * ((double)tick_of(v) / FLIGHT_TICKS);
  for (int k = 0; k < 4; k++) {
    e.velocity[k] = w->velocity[four[k]], e.mass[k] = g->model->mass[four[k]];
    e.force[k] = oracle_force_at_tick(g, four[k], tick_of(v));
  }
  oracle_add_rows(w->stage, &e, 1, sizeof e);
}

bool oracle_begin_impulses(struct oracle_stage *g)
{
  return watch(g, take_impulse);
}
