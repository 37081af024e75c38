/* Contacts of bonds with a bead, one by one, as the steps of a run have them. */
#include "oracle/company.h"

#include "bead/company.h"
#include "oracle/drift.h"
#include "oracle/stages.h"
#include "system/bead.h"

/* --- as they come ------------------------------------------------------------------------------------------------- */

/* Bodies of a contact at tick 0 of the drift, as if they had always flown as they do now, and their rates: the ends of
 * the bond, then the bead's image that is touched. */
struct bodies {
  struct point at[3], rate[3];
};

static struct bodies before_contact(const struct oracle_stage *g, const uint32_t vertex[2])
{
  const struct bead_company *c = &g->work->bead->company;
  const struct bead_way *w = &g->work->bead->flight.way;
  const struct point image = c->at[c->listed[vertex[0]] - 1].image,
                     now = point_plus(point_plus(g->state->bead->position, image), w->at);
  struct bodies b = {.at[2] = flight_place(now, w->rate, -w->clock), .rate[2] = w->rate};
  for (int e = 0; e < 2; e++)
    b.at[e] = g->state->position[vertex[e]], b.rate[e] = oracle_rate_of(g, vertex[e]);
  return b;
}

/* From the tick of the contact on they have other velocities. */
static struct bodies after_contact(const struct oracle_stage *g, const struct bodies *before, const struct vec3 v[3],
                                   int32_t tick)
{
  struct bodies b;
  for (int e = 0; e < 3; e++) {
    b.rate[e] = flight_rate(vec3_scale(g->work->contact.frame.time, v[e]));
    b.at[e] = flight_place(flight_place(before->at[e], before->rate[e], tick), b.rate[e], -(int64_t)tick);
  }
  return b;
}

static struct flight_pair pair_of(const struct bodies *b)
{
  return (struct flight_pair){.p = point_minus(b->at[1], b->at[0]),
                              .w = point_minus(b->at[2], b->at[0]),
                              .p_rate = point_minus(b->rate[1], b->rate[0]),
                              .w_rate = point_minus(b->rate[2], b->rate[0])};
}

/* The impulse, and the velocities before it: the log is told when the vertices have theirs of after it. */
static struct oracle_impulse impulse_of(const struct oracle_stage *g, const struct contact_event *v,
                                        const uint32_t vertex[2], int32_t tick)
{
  const struct drift_frame *frame = &g->work->contact.frame;
  const struct bead_way *w = &g->work->bead->flight.way;
  const double lever[2] = {1.0 - v->hit.s, v->hit.s};
  struct oracle_impulse e = {.s = v->hit.s, .t = 0.0, .normal = v->hit.normal, .mass[3] = 1.0};
  e.tau = frame->start + frame->time * ((double)tick / FLIGHT_TICKS);
  for (int k = 0; k < 2; k++) {
    e.mass[k] = g->model->mass[vertex[k]];
    e.velocity[k] = vec3_add_scaled(g->state->velocity[vertex[k]], lever[k] * v->impulse / e.mass[k], v->hit.normal);
    e.force[k] = oracle_force_at_tick(g, vertex[k], tick);
  }
  e.mass[2] = g->model->bead.mass;
  e.velocity[2] = w->velocity;
  e.force[2] = bead_force(g->model, flight_place(point_plus(g->state->bead->position, w->at), w->rate, tick - w->clock),
                          g->state->solvent_time + 1);
  return e;
}

void oracle_company_take(void *context, const struct contact_event *event)
{
  struct oracle_company *c = context;
  const struct oracle_stage *g = c->stage;
  if (event->standing_bond != EVENT_BEAD || c->contacts >= ORACLE_COMPANY_MOST)
    return;
  const uint32_t vertex[2] = {event->moving_bond, (uint32_t)g->model->next[event->moving_bond]};
  const int32_t tick = (int32_t)(event->hit.time * FLIGHT_TICKS);
  const int64_t reach =
      bead_radius(g->model) + g->model->kind[g->model->fiber_kind_of[g->model->fiber_of[vertex[0]]]].radius;
  const struct oracle_impulse e = impulse_of(g, event, vertex, tick);
  const struct vec3 after[3] = {g->state->velocity[vertex[0]], g->state->velocity[vertex[1]],
                                vec3_add_scaled(e.velocity[2], event->impulse / e.mass[2], event->hit.normal)};
  const struct bodies old = before_contact(g, vertex), new = after_contact(g, &old, after, tick);
  const struct flight_pair before = pair_of(&old);
  struct oracle_search *s = &c->search[3 * (size_t)c->contacts];
  s[0] = (struct oracle_search){.pair = before, .reach = reach, .from = 0};
  s[1] = (struct oracle_search){.pair = before, .reach = reach, .from = tick / 2};
  s[2] = (struct oracle_search){.pair = pair_of(&new), .reach = reach, .from = tick};
  c->tubes[c->contacts] = (struct oracle_tubes){.p = flight_place(before.p, before.p_rate, tick),
                                                .w = flight_place(before.w, before.w_rate, tick)};
  c->impulse[c->contacts++] = e;
}

/* --- operators ---------------------------------------------------------------------------------------------------- */

bool oracle_begin_bead_searches(struct oracle_stage *g)
{
  const struct oracle_company *c = g->company;
  return oracle_add_rows(g, c->search, 3 * c->contacts, sizeof *c->search);
}

bool oracle_begin_bead_contacts(struct oracle_stage *g)
{
  const struct oracle_company *c = g->company;
  return oracle_add_rows(g, c->tubes, c->contacts, sizeof *c->tubes);
}

bool oracle_begin_bead_impulses(struct oracle_stage *g)
{
  const struct oracle_company *c = g->company;
  return oracle_add_rows(g, c->impulse, c->contacts, sizeof *c->impulse);
}
