#include <stdlib.h>
#include <string.h>

#include "base/random.h"
#include "fiber/force.h"
#include "oracle/columns.h"
#include "oracle/contact_rows.h"
#include "oracle/stages.h"

#define LONG_SWEEP 32.0 /* dt, or 16, 8, ... if no more fits into the box */

bool oracle_run_order(struct oracle_stage *g)
{
  random_permutation(g->model->seed, RANDOM_VERTEX_ORDER, 0, g->place.step, g->state->vertices, g->work->contact.order);
  oracle_put_counts(g, "out.order", "vertex", g->work->contact.order, g->state->vertices);
  return true;
}

struct events {
  const struct state *state;
  const struct model *model;
  double time; /* of the moves */
  struct logged {
    struct contact_event event;
    double condition;
  } * logged;
  uint32_t count;
  bool failed;
};

/* How much the data of a hit amplify rounding, from the state that its move found (docs/port/tolerances.md,
 * Tolerances). */
static double condition_of(const struct events *e, const struct contact_event *v)
{
  const struct model *m = e->model;
  const struct point *r = e->state->position;
  const bool first = v->moving_bond == v->vertex;
  const struct vec3 move = vec3_scale(e->time, e->state->velocity[v->vertex]);
  const struct vec3 ab = point_difference(r[m->next[v->standing_bond]], r[v->standing_bond]);
  const struct vec3 bond = point_difference(r[first ? (uint32_t)m->next[v->vertex] : v->moving_bond], r[v->vertex]);
  const struct vec3 p = vec3_add_scaled(bond, -v->hit.time, move);
  const double lengths = vec3_norm(ab) * (vec3_norm(bond) + vec3_norm(move));
  const double speed = fabs(vec3_dot(vec3_cross(ab, bond), move));
  const double cross = vec3_norm(vec3_cross(p, ab)), parallel = vec3_norm(p) * vec3_norm(ab) / cross;
  const double reach = vec3_norm(bond) + vec3_norm(ab) + vec3_norm(move);
  return (1.0 + lengths * reach / speed) * parallel * parallel * (1.0 + reach / fmin(vec3_norm(p), vec3_norm(ab)));
}

static void take_event(void *context, const struct contact_event *event)
{
  struct events *e = context;
  struct logged *grown = realloc(e->logged, (e->count + 1) * sizeof *grown);
  e->failed |= !grown;
  if (grown) {
    e->logged = grown;
    e->logged[e->count++] = (struct logged){*event, condition_of(e, event)};
  }
}

/* The log records the executed hit of a move last. Here hits of one move are sorted as `earlier` does, so that every
 * port can write the same order. */
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

static void sort_moves(struct events *e)
{
  for (uint32_t k = 1; k < e->count; k++)
    for (uint32_t j = k; j > 0 && e->logged[j].event.vertex == e->logged[j - 1].event.vertex; j--) {
      if (by_time(&e->logged[j - 1].event, &e->logged[j].event) <= 0)
        break;
      struct logged swap = e->logged[j];
      e->logged[j] = e->logged[j - 1];
      e->logged[j - 1] = swap;
    }
}

static void put_events(struct oracle_stage *g, const struct events *e)
{
  int64_t *who =
      oracle_put_integers(g, "out.event", "vertex moving standing image_x image_y image_z executed", e->count);
  for (uint32_t k = 0; who && k < e->count; k++) {
    const struct contact_event *v = &e->logged[k].event;
    const int64_t row[7] = {v->vertex,   v->moving_bond, v->standing_bond, v->image[0],
                            v->image[1], v->image[2],    v->executed};
    memcpy(&who[7 * (size_t)k], row, sizeof row);
  }
  double *how = oracle_put_reals(g, "out.hit", "time s s_standing normal_x normal_y normal_z momentum", e->count);
  for (uint32_t k = 0; how && k < e->count; k++) {
    const struct contact_event *v = &e->logged[k].event;
    const struct vec3 n = v->hit.normal;
    const double row[7] = {v->hit.time, v->hit.s, v->hit.s_standing, n.x, n.y, n.z, v->impulse};
    memcpy(&how[7 * (size_t)k], row, sizeof row);
  }
  double *condition = oracle_put_reals(g, "bound.hit", "condition", e->count);
  for (uint32_t k = 0; condition && k < e->count; k++)
    condition[k] = e->logged[k].condition;
}

bool oracle_sweep_for(struct oracle_stage *g, double fraction, uint32_t sweep)
{
  struct events events = {g->state, g->model, fraction * g->model->time_step, NULL, 0, false};
  const struct contact_log log = {take_event, &events};
  random_permutation(g->model->seed, RANDOM_VERTEX_ORDER, sweep, g->place.step, g->state->vertices,
                     g->work->contact.order);
  oracle_put_number(g, "in.time", "dt", events.time);
  oracle_put_counts(g, "in.order", "vertex", g->work->contact.order, g->state->vertices);
  oracle_put_points(g, "in.position", g->state->position, g->state->vertices);
  oracle_put_vectors(g, "in.velocity", g->state->velocity, g->state->vertices);
  bool ok = contact_drift(g->state, g->model, &g->work->contact, fraction, g->place.step, sweep, &log, &g->work->fault);
  sort_moves(&events);
  put_events(g, &events);
  oracle_put_points(g, "out.position", g->state->position, g->state->vertices);
  oracle_put_vectors(g, "out.velocity", g->state->velocity, g->state->vertices);
  g->pack->failed |= events.failed;
  free(events.logged);
  return ok;
}

/* Positions and velocities of the vertices, to be put back. */
struct vertices {
  struct point *position;
  struct vec3 *velocity;
};

static void put_back(struct oracle_stage *g, const struct vertices *saved)
{
  const size_t n = g->state->vertices;
  memcpy(g->state->position, saved->position, n * sizeof *saved->position);
  memcpy(g->state->velocity, saved->velocity, n * sizeof *saved->velocity);
  contact_forget_places(&g->work->contact);
}

/* True if no vertex of a sweep moves further than the box allows; exchanges can make one faster. All is put back. */
static bool moves_fit(struct oracle_stage *g, double fraction, const struct vertices *saved)
{
  const bool ok =
      contact_drift(g->state, g->model, &g->work->contact, fraction, g->place.step, 1, NULL, &g->work->fault);
  const bool fits = ok || g->work->fault.code != FAULT_VERTEX_MOVE;
  if (!fits)
    g->work->fault = (struct fault){0};
  put_back(g, saved);
  return fits;
}

/* Calls `run` with the fraction of a step that a long sweep takes: moves many times as long as the scene's, as long as
 * the box allows. They cross often, several bonds at once. Then positions and velocities are what they were. */
static bool in_long_sweep(struct oracle_stage *g, bool (*run)(struct oracle_stage *, double fraction, void *),
                          void *context)
{
  const size_t n = g->state->vertices;
  struct vertices saved = {malloc((n + 1) * sizeof *saved.position), malloc((n + 1) * sizeof *saved.velocity)};
  bool ok = saved.position && saved.velocity;
  g->pack->failed |= !ok;
  if (ok) {
    memcpy(saved.position, g->state->position, n * sizeof *saved.position);
    memcpy(saved.velocity, g->state->velocity, n * sizeof *saved.velocity);
    double fraction = LONG_SWEEP;
    while (fraction > 1.0 && !moves_fit(g, fraction, &saved))
      fraction *= 0.5;
    ok = run(g, fraction, context);
    put_back(g, &saved);
  }
  free(saved.position);
  free(saved.velocity);
  return ok;
}

static bool put_long_sweep(struct oracle_stage *g, double fraction, void *context)
{
  (void)context;
  return oracle_sweep_for(g, fraction, 1);
}

bool oracle_run_long_sweep(struct oracle_stage *g)
{
  return in_long_sweep(g, put_long_sweep, NULL);
}

/* The tests of a long sweep that hit, and its exchanges, as they are found. */
struct contacts {
  const struct oracle_stage *stage;
  double time;           /* of the moves */
  struct vec3 *velocity; /* of the vertices, before the move that hit */
  struct crossing_query *query;
  struct oracle_exchange *exchange;
  uint32_t queries, exchanges;
  bool failed;
};

static void take_exchange(struct contacts *c, const struct contact_event *v, uint32_t pivot)
{
  const struct oracle_stage *g = c->stage;
  const uint32_t four[4] = {v->vertex, pivot, v->standing_bond, (uint32_t)g->model->next[v->standing_bond]};
  struct oracle_exchange *e = &c->exchange[c->exchanges++];
  *e = (struct oracle_exchange){.s = v->hit.s, .s_standing = v->hit.s_standing, .normal = v->hit.normal};
  for (int k = 0; k < 4; k++) {
    e->velocity[k] = c->velocity[four[k]];
    e->mass[k] = g->model->mass[four[k]];
  }
  for (int k = 0; k < 4; k++) /* the log is told after the exchange */
    c->velocity[four[k]] = g->state->velocity[four[k]];
}

static void take_contact(void *context, const struct contact_event *v)
{
  struct contacts *c = context;
  const struct model *m = c->stage->model;
  const struct point *r = c->stage->state->position;
  const bool flip = v->moving_bond == v->vertex;
  const uint32_t pivot = flip ? (uint32_t)m->next[v->vertex] : v->moving_bond;
  struct crossing_query *query = realloc(c->query, (c->queries + 2) * sizeof *query);
  c->query = query ? query : c->query;
  struct oracle_exchange *exchange = realloc(c->exchange, (c->exchanges + 1) * sizeof *exchange);
  c->exchange = exchange ? exchange : c->exchange;
  c->failed |= !query || !exchange;
  if (c->failed)
    return;
  const struct vec3 move = vec3_scale(c->time, c->velocity[v->vertex]);
  struct crossing_query q = {.from = r[v->vertex],
                             .to = point_move(r[v->vertex], move),
                             .pivot = r[pivot],
                             .a = point_image(r[v->standing_bond], v->image, &m->box),
                             .b = point_image(r[m->next[v->standing_bond]], v->image, &m->box),
                             .flip = flip};
  c->query[c->queries++] = q;
  q.to = point_move(q.from, vec3_scale(0.5 * v->hit.time, move)); /* this half of the way crosses nothing */
  c->query[c->queries++] = q;
  if (v->executed)
    take_exchange(c, v, pivot);
}

static bool find_contacts(struct oracle_stage *g, double fraction, void *context)
{
  struct contacts *c = context;
  const struct contact_log log = {take_contact, c};
  c->time = fraction * g->model->time_step;
  memcpy(c->velocity, g->state->velocity, g->state->vertices * sizeof *c->velocity);
  return contact_drift(g->state, g->model, &g->work->contact, fraction, g->place.step, 1, &log, &g->work->fault);
}

static bool with_contacts(struct oracle_stage *g, void (*put)(struct oracle_stage *, const struct contacts *))
{
  struct contacts c = {.stage = g, .velocity = malloc(((size_t)g->state->vertices + 1) * sizeof *c.velocity)};
  c.failed = !c.velocity;
  const bool ok = c.failed || in_long_sweep(g, find_contacts, &c);
  if (ok && !c.failed)
    put(g, &c);
  g->pack->failed |= c.failed;
  free(c.velocity);
  free(c.query);
  free(c.exchange);
  return ok;
}

static void put_crossings(struct oracle_stage *g, const struct contacts *c)
{
  oracle_put_crossings(g, c->query, c->queries);
}

static void put_exchanges(struct oracle_stage *g, const struct contacts *c)
{
  oracle_put_exchanges(g, c->exchange, c->exchanges);
}

bool oracle_run_crossing(struct oracle_stage *g)
{
  return with_contacts(g, put_crossings);
}

bool oracle_run_exchange(struct oracle_stage *g)
{
  return with_contacts(g, put_exchanges);
}

bool oracle_run_sweep(struct oracle_stage *g)
{
  bool ok = oracle_sweep_for(g, 1.0, 0);
  g->state->solvent_lag += 2;
  return ok;
}

/* Forces of a model whose kinds keep only some of their constants. */
static bool put_forces(struct oracle_stage *g, bool springs, bool bends, bool body)
{
  struct model part = *g->model;
  part.kind = malloc((part.kinds + 1) * sizeof *part.kind);
  if (!part.kind)
    return false;
  for (uint32_t k = 0; k < part.kinds; k++) {
    part.kind[k] = g->model->kind[k];
    part.kind[k].spring *= springs;
    part.kind[k].bending *= bends;
    part.kind[k].force = vec3_scale(body, part.kind[k].force);
  }
  oracle_put_points(g, "in.position", g->state->position, g->state->vertices);
  bool ok = fiber_forces(g->state, &part, g->work->fiber.force, g->place.step, &g->work->fault);
  oracle_put_vectors(g, "out.force", g->work->fiber.force, g->state->vertices);
  free(part.kind);
  return ok;
}

bool oracle_run_bond_force(struct oracle_stage *g)
{
  return put_forces(g, true, false, false);
}

bool oracle_run_bend_force(struct oracle_stage *g)
{
  return put_forces(g, false, true, false);
}

bool oracle_run_force(struct oracle_stage *g)
{
  return put_forces(g, true, true, true);
}

bool oracle_run_kick(struct oracle_stage *g)
{
  oracle_put_number(g, "in.time", "dt", 0.5 * g->model->time_step);
  oracle_put_vectors(g, "in.velocity", g->state->velocity, g->state->vertices);
  oracle_put_vectors(g, "in.force", g->work->fiber.force, g->state->vertices);
  fiber_kick(g->state, g->model, g->work->fiber.force, 0.5);
  oracle_put_vectors(g, "out.velocity", g->state->velocity, g->state->vertices);
  return true;
}
