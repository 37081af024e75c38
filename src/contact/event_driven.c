/*
 * The rule `event-driven`: all vertices move at once, and bonds that touch exchange momentum at the time of contact.
 *
 *   1  every vertex gets a flight: its displacement per tick (contact/flight.h)
 *   2  pairs of bonds that may touch in this drift are candidates (contact/candidates.h)
 *   3  the first contact of each candidate is searched, and queued
 *   4  the earliest contact is answered: the velocities of the four vertices change, so their flights bend; the
 *      contacts of their bonds are searched anew from that tick. A vertex that reaches a wall bends, too. Until none
 *      is left
 *   5  every vertex lands where its flight ends
 *
 * Another body among the bonds has its own list of what comes next to it; what is earlier is answered first, from this
 * list or from the queue (struct timeline, contact/contact.h).
 *
 * At every tick up to the one at hand, all bonds are apart: each piece of path that is flown was searched. So no bond
 * passes through another.
 *
 * A contact reverses the relative velocity of the present, not the drift's: a leap-frog's velocity v belongs to the
 * middle of the drift, and a time tau later the velocity is u = v + tau F/M, with the forces F at the contact.
 * With u, the exchange conserves the energy of the leap-frog to first order in tau, and is reversible
 * (docs/contacts.md).
 */
#include "contact/candidates.h"
#include "contact/capsule.h"
#include "contact/event_drift.h"
#include "contact/event_rigid.h"
#include "contact/impulse.h"
#include "contact/neighbors.h"
#include "contact/rule.h"
#include "contact/shape.h"
#include "contact/takeoff.h"

/* --- a contact ---------------------------------------------------------------------------------------------------- */

/* The four vertices of a contact: ends of the first bond, then of the other. touching: the bonds touch already, which
 * cannot happen in a drift that began with all bonds apart. */
struct meeting {
  bool touching;
  struct event event;
  uint32_t vertex[4];
  struct contact_geometry geometry;
  struct vec3 gap; /* from the point of contact of the first bond to that of the other, a0 */
};

/* By how much the other bond's image is faster along x than the bond itself, in a sheared box. */
static double image_speed(const struct event_drift *d, const struct event *e)
{
  return e->image[1] * d->frame->image_speed;
}

/* A vector between two places at a tick, a0. */
static struct vec3 in_space(const struct event_drift *d, struct point r, int32_t tick)
{
  return drift_true(d->frame, point_in_a0(r), (double)tick / FLIGHT_TICKS);
}

static struct meeting meeting_of(const struct event_drift *d, const struct event *e)
{
  const struct flight_pair pair = event_pair(d, e->bond, e->other, e->image);
  struct meeting m = {.event = *e};
  m.vertex[0] = e->bond, m.vertex[1] = (uint32_t)d->model->next[e->bond];
  m.vertex[2] = e->other, m.vertex[3] = (uint32_t)d->model->next[e->other];
  const struct vec3 p = in_space(d, flight_place(pair.p, pair.p_rate, e->tick), e->tick),
                    q = in_space(d, flight_place(pair.q, pair.q_rate, e->tick), e->tick),
                    w = in_space(d, flight_place(pair.w, pair.w_rate, e->tick), e->tick);
  double s, t;
  const struct bond_shape *shape = bond_shape_of(model_reach(d->model, e->bond, e->other));
  shape->points(p, q, w, &s, &t);
  const double lever[4] = {1.0 - s, s, t - 1.0, -t};
  struct vec3 velocity = {0, 0, 0};
  for (int k = 0; k < 4; k++)
    velocity = vec3_add_scaled(velocity, lever[k], d->state->velocity[m.vertex[k]]);
  velocity.x -= image_speed(d, e); /* the levers of the other bond have the sum -1 */
  m.geometry.s = s, m.geometry.t = t;
  const struct shape_contact at = {p, q, capsule_between(p, q, w, s, t), velocity};
  m.gap = at.gap;
  m.touching = !shape->normal(&pair, e->tick, &at, &m.geometry.normal);
  return m;
}

/* --- answers ------------------------------------------------------------------------------------------------------ */

/* Changes the velocities of the four vertices. False if no impulse separates the bonds. */
static bool exchange(const struct event_drift *d, struct meeting *m)
{
  const double speed = image_speed(d, &m->event);
  struct contact_end end[4];
  for (int k = 0; k < 4; k++) {
    struct vec3 *velocity = &d->state->velocity[m->vertex[k]];
    velocity->x += k >= 2 && speed != 0.0 ? speed : 0.0;
    end[k] = (struct contact_end){velocity, d->model->inverse_mass[m->vertex[k]],
                                  event_force(d, m->vertex[k], m->event.tick)};
  }
  const enum contact_answer answer = impulse_at_own_time(end, &m->geometry, event_time(d, m->event.tick));
  for (int k = 2; k < 4 && speed != 0.0; k++)
    d->state->velocity[m->vertex[k]].x -= speed;
  d->state->counts.softened += answer == CONTACT_SOFTENED;
  return answer != CONTACT_NONE;
}

static void note(const struct event_drift *d, const struct meeting *m)
{
  struct collision_counts *counts = &d->state->counts;
  counts->possible++;
  counts->executed++;
  if (!d->log)
    return;
  const struct event *e = &m->event;
  const struct contact_event told = {e->bond,
                                     e->bond,
                                     e->other,
                                     {e->image[0], e->image[1], e->image[2]},
                                     {(double)e->tick / FLIGHT_TICKS, m->geometry.s, m->geometry.t, m->geometry.normal},
                                     true,
                                     m->geometry.impulse,
                                     vec3_norm(m->gap)};
  d->log->record(d->log->context, &told);
}

static bool bend_flights(const struct event_drift *d, const struct meeting *m)
{
  for (int k = 0; k < 4; k++) {
    struct bend_in_path *bend = event_bend(d, m->vertex[k]);
    if (!bend)
      return event_no_memory(d);
    bend->contacts++;
    if (!event_steer_freely(d, m->vertex[k], m->event.tick))
      return false;
  }
  return event_search_again(d, 4, m->vertex, m->event.tick);
}

static bool answer(const struct event_drift *d, const struct event *e)
{
  struct meeting m = meeting_of(d, e);
  if (m.touching) { /* two fibers laid through one point: they part, and meet no more */
    const struct neighbor other = {(int32_t)e->other, {e->image[0], e->image[1], e->image[2]}};
    return event_search_pair(d, e->bond, &other, e->tick + 1);
  }
  for (int k = 0; k < 4; k++) /* before velocities change */
    if (!event_bend(d, m.vertex[k]))
      return event_no_memory(d);
  if (event_is_rigid(d, 4, m.vertex) || !exchange(d, &m))
    return event_make_rigid(d, 4, m.vertex, false, e->tick);
  note(d, &m);
  return bend_flights(d, &m);
}

bool event_answer(const struct event_drift *d, const struct event *e)
{
  if (e->other == EVENT_WALL)
    return event_answer_wall(d, e);
  return e->version != event_version(d, e->bond, e->other) || answer(d, e);
}

/* All that happens in a drift. */
static bool answer_all(const struct event_drift *d)
{
  const struct timeline *beside = d->contact->beside;
  struct event_queue *queue = &d->contact->flights.queue;
  struct event e;
  if (beside && !beside->begin(d))
    return false;
  for (;;) {
    const int32_t its = beside ? beside->next(d) : FLIGHT_TICKS;
    const bool bonds = queue->count > 0 && queue->at[0].tick < its;
    if (!bonds && its == FLIGHT_TICKS)
      break;
    if (!(bonds ? event_queue_pop(queue, &e) && event_answer(d, &e) : beside->answer(d)))
      return false;
  }
  if (beside)
    beside->end(d);
  return true;
}

static bool drift_event_driven(struct state *state, const struct model *model, struct contact *contact, uint64_t step,
                               uint32_t drift, const struct contact_log *log, struct fault *fault)
{
  (void)step, (void)drift;
  const struct event_drift d = {state, model, contact, &contact->frame, log, fault};
  contact->flights.bends.count = 0;
  if ((!contact->neighbors.built && !neighbors_build(state, model, contact, fault)) ||
      !take_off(state, model, contact, fault) || !candidates_find(state, model, contact, fault) ||
      !event_search_all(&d) || (model_has_walls(model) && !event_search_walls(&d)) || !answer_all(&d))
    return false;
  event_land(&d);
  state->counts.moves += state->vertices;
  return true;
}

const struct crossing_rule event_driven_rule = {"event-driven", true, false, drift_event_driven};
