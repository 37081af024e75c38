/* Drifts of the rule `event-driven`: contacts of a long drift one by one, and whole drifts. */
#include <stdlib.h>
#include <string.h>

#include "oracle/event_rows.h"
#include "oracle/stages.h"
#include "oracle/tube_rows.h"

#define LONG_DRIFT 32.0 /* dt, or 16, 8, ... if no more fits into the box */

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

/* A drift that has failed leaves its scratch as it was in the middle. */
static bool renew_scratch(struct oracle_stage *g)
{
  contact_force *const force = g->work->contact.force;
  contact_free(&g->work->contact);
  g->work->fault = (struct fault){0};
  return contact_alloc(&g->work->contact, g->model, force, true);
}

/* The time of a long drift: exchanges can make a vertex faster than the box allows. All is put back. */
static bool find_length(struct oracle_stage *g, const struct vertices *saved, double *dt)
{
  bool ok = false, memory = true;
  *dt = LONG_DRIFT * g->model->time_step;
  while (!ok && memory && *dt > g->model->time_step) {
    ok = oracle_drift_at_once(g, *dt, -0.5 * *dt, NULL);
    put_back(g, saved);
    memory = ok || (g->work->fault.code == FAULT_VERTEX_MOVE && renew_scratch(g));
    if (!ok)
      *dt *= 0.5;
  }
  g->pack->failed |= !memory;
  return memory;
}

/* Calls `run` with the time of a long drift, as long as the box allows. Such a drift has many contacts. Then positions
 * and velocities are what they were. */
static bool in_long_drift(struct oracle_stage *g, bool (*run)(struct oracle_stage *, double dt, void *), void *context)
{
  const size_t n = g->state->vertices;
  struct vertices saved = {malloc((n + 1) * sizeof *saved.position), malloc((n + 1) * sizeof *saved.velocity)};
  bool ok = saved.position && saved.velocity;
  g->pack->failed |= !ok;
  if (ok) {
    memcpy(saved.position, g->state->position, n * sizeof *saved.position);
    memcpy(saved.velocity, g->state->velocity, n * sizeof *saved.velocity);
    double dt;
    ok = find_length(g, &saved, &dt) && run(g, dt, context);
    put_back(g, &saved);
  }
  free(saved.position);
  free(saved.velocity);
  return ok;
}

static bool put_long_drift(struct oracle_stage *g, double dt, void *context)
{
  (void)context;
  return oracle_event_drift_for(g, dt, -0.5 * dt);
}

bool oracle_run_long_event_drift(struct oracle_stage *g)
{
  return in_long_drift(g, put_long_drift, NULL);
}

bool oracle_run_event_drift(struct oracle_stage *g)
{
  const bool ok = oracle_event_drift_for(g, g->model->time_step, -0.5 * g->model->time_step);
  g->state->solvent_lag += 2;
  return ok;
}

/* --- contacts of a long drift, one by one ------------------------------------------------------------------------- */

/* What was searched, and what was exchanged, as it comes. */
struct contacts {
  struct oracle_stage *stage;
  double dt;
  struct vec3 *velocity; /* of the vertices, before the contact */
  int32_t *bent;         /* tick at which the flight of each vertex has changed last */
  struct oracle_search *search;
  struct oracle_impulse *impulse;
  struct oracle_tubes *tubes; /* of each impulse; not of two lines */
  uint32_t searches, impulses, touching;
  bool failed;
};

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
static void take_searches(struct contacts *c, const struct contact_event *v, const uint32_t four[4], int32_t tick)
{
  const struct oracle_stage *g = c->stage;
  struct point at[4], rate[4], later[4], new_rate[4];
  int32_t from = 0;
  for (int k = 0; k < 4; k++) {
    at[k] = g->state->position[four[k]], rate[k] = oracle_rate_of(g, four[k]);
    new_rate[k] = flight_rate(vec3_scale(c->dt, g->state->velocity[four[k]]));
    later[k] = flight_place(flight_place(at[k], rate[k], tick), new_rate[k], -(int64_t)tick);
    from = c->bent[four[k]] > from ? c->bent[four[k]] : from;
  }
  const struct flight_pair before = pair_of(g, v, at, rate), after = pair_of(g, v, later, new_rate);
  const int64_t reach = model_reach(g->model, v->moving_bond, v->standing_bond);
  c->search[c->searches++] = (struct oracle_search){before, reach, from};
  if (tick + 1 < FLIGHT_TICKS && reach == 0)
    c->search[c->searches++] = (struct oracle_search){before, reach, tick + 1};
  c->search[c->searches++] = (struct oracle_search){after, reach, tick};
  if (reach > 0)
    c->tubes[c->touching++] =
        (struct oracle_tubes){flight_place(before.p, before.p_rate, tick), flight_place(before.q, before.q_rate, tick),
                              flight_place(before.w, before.w_rate, tick)};
}

static void take_impulse(struct contacts *c, const struct contact_event *v, const uint32_t four[4], int32_t tick)
{
  const struct oracle_stage *g = c->stage;
  struct oracle_impulse *e = &c->impulse[c->impulses++];
  *e = (struct oracle_impulse){.s = v->hit.s, .t = v->hit.s_standing, .normal = v->hit.normal};
  e->tau = -0.5 * c->dt + c->dt * ((double)tick / FLIGHT_TICKS);
  for (int k = 0; k < 4; k++) {
    e->velocity[k] = c->velocity[four[k]];
    e->mass[k] = g->model->mass[four[k]];
    e->force[k] = oracle_force_at_tick(g, four[k], tick);
    c->velocity[four[k]] = g->state->velocity[four[k]]; /* the log is told after the exchange */
    c->bent[four[k]] = tick;
  }
}

static void take_contact(void *context, const struct contact_event *v)
{
  struct contacts *c = context;
  const int32_t *next = c->stage->model->next;
  const uint32_t four[4] = {v->moving_bond, (uint32_t)next[v->moving_bond], v->standing_bond,
                            (uint32_t)next[v->standing_bond]};
  const int32_t tick = (int32_t)(v->hit.time * FLIGHT_TICKS);
  struct oracle_search *search = realloc(c->search, (c->searches + 3) * sizeof *search);
  c->search = search ? search : c->search;
  struct oracle_impulse *impulse = realloc(c->impulse, (c->impulses + 1) * sizeof *impulse);
  c->impulse = impulse ? impulse : c->impulse;
  struct oracle_tubes *tubes = realloc(c->tubes, (c->touching + 1) * sizeof *tubes);
  c->tubes = tubes ? tubes : c->tubes;
  c->failed |= !search || !impulse || !tubes;
  if (c->failed)
    return;
  take_searches(c, v, four, tick);
  take_impulse(c, v, four, tick);
}

static bool find_contacts(struct oracle_stage *g, double dt, void *context)
{
  struct contacts *c = context;
  const struct contact_log log = {take_contact, c};
  c->dt = dt;
  memcpy(c->velocity, g->state->velocity, g->state->vertices * sizeof *c->velocity);
  return oracle_drift_at_once(g, dt, -0.5 * dt, &log);
}

static bool with_contacts(struct oracle_stage *g, void (*put)(struct oracle_stage *, const struct contacts *))
{
  const size_t n = (size_t)g->state->vertices + 1;
  struct contacts c = {.stage = g, .velocity = malloc(n * sizeof *c.velocity), .bent = calloc(n, sizeof *c.bent)};
  c.failed = !c.velocity || !c.bent;
  const bool ok = c.failed || in_long_drift(g, find_contacts, &c);
  if (ok && !c.failed)
    put(g, &c);
  g->pack->failed |= c.failed;
  free(c.velocity);
  free(c.bent);
  free(c.search);
  free(c.impulse);
  free(c.tubes);
  return ok;
}

/* Those of lines, or those of tubes. */
static void put_searches_of(struct oracle_stage *g, const struct contacts *c, bool tubes,
                            void (*put)(struct oracle_stage *, const struct oracle_search *, uint32_t))
{
  struct oracle_search *s = malloc(((size_t)c->searches + 1) * sizeof *s);
  uint32_t n = 0;
  g->pack->failed |= !s;
  for (uint32_t k = 0; s && k < c->searches; k++)
    if ((c->search[k].reach > 0) == tubes)
      s[n++] = c->search[k];
  if (s)
    put(g, s, n);
  free(s);
}

static void put_searches(struct oracle_stage *g, const struct contacts *c)
{
  put_searches_of(g, c, false, oracle_put_searches);
}

static void put_tube_searches(struct oracle_stage *g, const struct contacts *c)
{
  put_searches_of(g, c, true, oracle_put_tube_searches);
}

static void put_tube_contacts(struct oracle_stage *g, const struct contacts *c)
{
  oracle_put_tube_contacts(g, c->tubes, c->touching);
}

static void put_impulses(struct oracle_stage *g, const struct contacts *c)
{
  oracle_put_impulses(g, c->impulse, c->impulses);
}

bool oracle_run_contact_search(struct oracle_stage *g)
{
  return with_contacts(g, put_searches);
}

bool oracle_run_tube_search(struct oracle_stage *g)
{
  return with_contacts(g, put_tube_searches);
}

bool oracle_run_tube_contact(struct oracle_stage *g)
{
  return with_contacts(g, put_tube_contacts);
}

bool oracle_run_impulse(struct oracle_stage *g)
{
  return with_contacts(g, put_impulses);
}
