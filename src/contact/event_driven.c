/*
 * The rule `event-driven`: all vertices move at once, and bonds that touch exchange momentum at the time of contact.
 *
 *   1  every vertex gets a flight: its displacement per tick (contact/flight.h)
 *   2  pairs of bonds that may touch in this drift are candidates (contact/candidates.h)
 *   3  the first contact of each candidate is searched, and queued
 *   4  the earliest contact is answered: the velocities of the four vertices change, so their flights bend; the
 * contacts of their bonds are searched anew from that tick. Until none is left 5  every vertex lands where its flight
 * ends
 *
 * At every tick up to the one at hand, all bonds are apart: each piece of path that is flown was searched. So no bond
 * passes through another.
 *
 * What a contact reverses is not the relative velocity of the drift but that of the present: a leap-frog's velocity v
 * is that of the middle of the drift, and a time tau later it is u = v + tau F/M, F being the forces at the contact.
 * With u, the exchange conserves the energy of the leap-frog to first order in tau, and is reversible
 * (docs/heat-free.md).
 */
#include "base/memory.h"
#include "contact/candidates.h"
#include "contact/capsule.h"
#include "contact/determinant.h"
#include "contact/drift.h"
#include "contact/flight.h"
#include "contact/impulse.h"
#include "contact/neighbors.h"
#include "contact/rule.h"
#include "contact/takeoff.h"

enum {
  MOST_CONTACTS = 1000 /* of one vertex in one drift; beyond it, its cluster moves rigidly */
};

/* A drift at work. */
struct event_drift {
  struct state *state;
  const struct model *model;
  struct contact *contact;
  double dt, start; /* start: time from the middle of the step to the beginning of this drift */
  const struct contact_log *log;
  struct fault *fault;
};

static bool no_memory(const struct event_drift *d)
{
  return fault_no_memory(d->fault, d->state->step + 1);
}

/* --- flights ------------------------------------------------------------------------------------------------------ */

/* The flight of a vertex that has not bent follows from its velocity. */
static struct point straight_rate(const struct event_drift *d, uint32_t i)
{
  return takeoff_rate(d->state->velocity[i], model_frame_velocity(d->model), d->dt);
}

static struct point rate_of(const struct event_drift *d, uint32_t i)
{
  return takeoff_rate_now(d->state, d->model, &d->contact->flights, i);
}

static struct point place_of(const struct event_drift *d, uint32_t i, int32_t tick)
{
  return flight_place(d->state->position[i], rate_of(d, i), tick);
}

/* The place of a vertex at the start of the drift. */
static struct point start_of(const struct event_drift *d, uint32_t i)
{
  const struct flights *f = &d->contact->flights;
  return f->bend_of[i] ? f->bends.at[f->bend_of[i] - 1].start : d->state->position[i];
}

/* All vertices fly straight to the end; those whose flights have bent are put where such a flight ends where theirs
 * does. */
static void land(const struct event_drift *d)
{
  struct point *restrict p = d->state->position;
  const struct vec3 *restrict v = d->state->velocity, frame = model_frame_velocity(d->model);
  struct flights *f = &d->contact->flights;
  for (uint32_t k = 0; k < f->bends.count; k++) {
    const uint32_t i = f->bends.at[k].vertex;
    p[i] = flight_place(p[i], point_minus(f->bends.at[k].rate, straight_rate(d, i)), FLIGHT_TICKS);
    f->bend_of[i] = 0;
  }
  for (uint32_t i = 0; i < d->state->vertices; i++)
    p[i] = flight_place(p[i], takeoff_rate(v[i], frame, d->dt), FLIGHT_TICKS);
}

/* --- contacts to come --------------------------------------------------------------------------------------------- */

static struct flight_pair pair_of(const struct event_drift *d, uint32_t bond, uint32_t other, const int32_t image[3])
{
  const struct point *at = d->state->position;
  const uint32_t j = (uint32_t)d->model->next[bond], m = (uint32_t)d->model->next[other];
  const struct point bond_rate = rate_of(d, bond), other_rate = rate_of(d, other);
  return (struct flight_pair){
      .p = point_minus(at[j], at[bond]),
      .q = point_minus(at[m], at[other]),
      .w = point_minus(point_image(at[other], image, &d->model->box), at[bond]),
      .p_rate = point_minus(rate_of(d, j), bond_rate),
      .q_rate = point_minus(rate_of(d, m), other_rate),
      .w_rate = point_minus(other_rate, bond_rate),
  };
}

static uint32_t version_of(const struct event_drift *d, uint32_t bond, uint32_t other)
{
  return d->contact->flights.version[bond] + d->contact->flights.version[other];
}

/* Queues the first contact of a pair from a tick on. Of the two bonds, the lower number comes first. */
static bool search_pair(const struct event_drift *d, uint32_t bond, const struct neighbor *n, int32_t from)
{
  const bool exchange = (uint32_t)n->bond < bond;
  const int32_t sign = exchange ? -1 : 1;
  struct event e = {.bond = exchange ? (uint32_t)n->bond : bond,
                    .other = exchange ? bond : (uint32_t)n->bond,
                    .image = {sign * n->image[0], sign * n->image[1], sign * n->image[2]}};
  const struct flight_pair pair = pair_of(d, e.bond, e.other, e.image);
  e.tick = from < FLIGHT_TICKS ? flight_contact(&pair, from) : FLIGHT_TICKS;
  e.version = version_of(d, e.bond, e.other);
  return e.tick == FLIGHT_TICKS || event_queue_push(&d->contact->flights.queue, &e) || no_memory(d);
}

static bool search_all(const struct event_drift *d)
{
  const struct candidate_list *list = &d->contact->candidates;
  for (uint32_t k = 0; k < list->count; k++) {
    const struct candidate *c = &list->at[k];
    if (c->bond < (uint32_t)c->with.bond && !search_pair(d, c->bond, &c->with, 0))
      return false;
  }
  return true;
}

/* --- paths bend --------------------------------------------------------------------------------------------------- */

/* The bend of a vertex; a new one if its flight has been straight. Its velocity must not have changed by then. NULL if
 * memory is short. */
static struct bend_in_path *bend_of(const struct event_drift *d, uint32_t i)
{
  struct flights *f = &d->contact->flights;
  if (f->bend_of[i])
    return &f->bends.at[f->bend_of[i] - 1];
  struct bend_list *list = &f->bends;
  if (list->count == list->room && !memory_double((void **)&list->at, &list->room, 64, sizeof *list->at))
    return NULL;
  list->at[list->count] = (struct bend_in_path){i, d->state->position[i], straight_rate(d, i), 0, 0};
  f->bend_of[i] = ++list->count;
  return &list->at[list->count - 1];
}

/* Adds the bonds that this one may touch, while the ends of both keep their ranges, to its candidates. */
static bool look_around_bond(const struct event_drift *d, uint32_t bond)
{
  struct neighbor_list *near = &d->contact->near;
  const uint32_t next = (uint32_t)d->model->next[bond];
  const struct point end[2] = {start_of(d, bond), start_of(d, next)};
  const struct capsule mine = {
      {0, 0, 0}, point_difference(end[1], end[0]), candidates_range(d->model, d->contact, bond)};
  if (!neighbors_near(d->state, d->model, d->contact, bond, end, mine.reach, near, d->fault))
    return false;
  for (uint32_t k = 0; k < near->count; k++) {
    const struct neighbor *n = &near->at[k];
    const struct point a = start_of(d, (uint32_t)n->bond), b = start_of(d, (uint32_t)d->model->next[n->bond]);
    const struct capsule its = {point_difference(point_image(a, n->image, &d->model->box), end[0]),
                                point_difference(point_image(b, n->image, &d->model->box), end[0]),
                                candidates_range(d->model, d->contact, (uint32_t)n->bond)};
    if (!capsules_apart(&mine, &its) && !candidates_add(d->state, d->contact, bond, n, d->fault))
      return false;
  }
  return true;
}

static bool look_around(const struct event_drift *d, uint32_t i)
{
  uint32_t bond[2];
  const int bonds = model_bonds_of(d->model, i, bond);
  for (int b = 0; b < bonds; b++)
    if (!look_around_bond(d, bond[b]))
      return false;
  return true;
}

static bool check_range(const struct event_drift *d, uint32_t i, struct point start, struct point end)
{
  const double limit = 0.5 * box_shortest_edge(&d->model->box);
  const double far = vec3_norm(point_difference(end, start));
  return far < limit || fault_record(d->fault, FAULT_VERTEX_MOVE, d->state->step + 1, i, far, limit);
}

/* From this tick on, vertex i moves by `rate` in a tick. Its place at the tick stays. The bonds that it may meet now,
 * and could not before, become candidates. False, with the fault recorded, as drift_legal, or if memory is short. */
static bool steer(const struct event_drift *d, uint32_t i, struct point rate, int32_t tick)
{
  struct contact *c = d->contact;
  struct bend_in_path *bend = bend_of(d, i);
  if (!bend)
    return no_memory(d);
  const struct point start = bend->start, here = place_of(d, i, tick);
  bend->rate = rate;
  d->state->position[i] = flight_place(here, rate, -tick);
  const struct point end = place_of(d, i, FLIGHT_TICKS);
  if (!check_range(d, i, start, end))
    return false;
  /* A straight piece stays within its range of the start if both its ends do. */
  const uint32_t range = candidates_units(vec3_norm(point_difference(end, start)) + LATTICE_UNIT);
  const bool wider = range > c->range[i], leaves = !neighbors_hold(&c->neighbors, i, end);
  if (wider)
    candidates_widen(d->model, c, i, range);
  if (leaves && !neighbors_renew(d->state, d->model, c, 1, &i, &here, &end, d->fault))
    return false;
  c->neighbors.hold[i] = c->neighbors.path[i]; /* to be looked at in the next drift */
  return !(wider || leaves) || look_around(d, i);
}

/* The flights of these vertices have bent at this tick: all queued contacts of their bonds are out of date, and are
 * searched anew. */
static bool search_again(const struct event_drift *d, uint32_t n, const uint32_t *vertex, int32_t tick)
{
  uint32_t bond[8] = {0};
  const struct candidate_list *list = &d->contact->candidates;
  const uint32_t bonds = model_bonds_at(d->model, n, vertex, bond);
  for (uint32_t b = 0; b < bonds; b++)
    d->contact->flights.version[bond[b]]++;
  for (uint32_t b = 0; b < bonds; b++)
    for (uint32_t m = list->first[bond[b]]; m; m = list->at[m - 1].next) {
      const struct neighbor with = list->at[m - 1].with;
      bool done = false; /* from the other side */
      for (uint32_t e = 0; e < b; e++)
        done |= bond[e] == (uint32_t)with.bond;
      if (!done && !search_pair(d, bond[b], &with, tick))
        return false;
    }
  return true;
}

/* --- a contact ---------------------------------------------------------------------------------------------------- */

struct places {
  const struct event_drift *drift;
  int32_t tick;
};

static struct point place_at_tick(const void *context, uint32_t vertex)
{
  const struct places *p = context;
  return place_of(p->drift, vertex, p->tick);
}

/* (p x q).w at a tick, with its exact sign. */
static double volume_at(const struct flight_pair *pair, int32_t tick)
{
  const struct point p = flight_place(pair->p, pair->p_rate, tick), q = flight_place(pair->q, pair->q_rate, tick),
                     w = flight_place(pair->w, pair->w_rate, tick);
  return determinant((struct difference){p.x, p.y, p.z}, (struct difference){q.x, q.y, q.z},
                     (struct difference){w.x, w.y, w.z});
}

/* The unit vector along which two touching bonds push each other, from bond p to bond q: perpendicular to both.
 * Parallel bonds have no such direction; and where both lie in one plane, an end meets a bond from the side. Then it is
 * the direction of the gap between them; if that cannot be told, that of their relative velocity perpendicular to q.
 * volume: (p x q).w. velocity: of p's point of contact relative to q's, a0/t0. */
static struct vec3 contact_normal(double volume, struct vec3 p, struct vec3 q, struct vec3 gap, struct vec3 velocity)
{
  struct vec3 n = vec3_cross(p, q);
  const bool parallel = !(vec3_dot(n, n) > 1e-24 * vec3_dot(p, p) * vec3_dot(q, q));
  double approach = vec3_dot(n, velocity);
  if (volume < 0.0 || (volume == 0.0 && approach < 0.0))
    n = vec3_scale(-1.0, n), approach = -approach;
  if (parallel || (volume == 0.0 && !(approach > 0.0))) {
    n = gap;
    if (!(vec3_dot(n, n) > 0.0))
      n = vec3_add_scaled(velocity, -vec3_dot(velocity, q) / vec3_dot(q, q), q);
  }
  return vec3_scale(1.0 / vec3_norm(n), n);
}

/* The four vertices of a contact: ends of the first bond, then of the other. touching: the bonds have no gap at all, as
 * at no tick of a drift that began with bonds apart. */
struct meeting {
  bool touching;
  struct event event;
  uint32_t vertex[4];
  struct contact_geometry geometry;
};

static struct meeting meeting_of(const struct event_drift *d, const struct event *e)
{
  const struct flight_pair pair = pair_of(d, e->bond, e->other, e->image);
  struct meeting m = {.event = *e};
  m.vertex[0] = e->bond, m.vertex[1] = (uint32_t)d->model->next[e->bond];
  m.vertex[2] = e->other, m.vertex[3] = (uint32_t)d->model->next[e->other];
  const struct point origin = {0, 0, 0};
  const struct vec3 p = point_difference(flight_place(pair.p, pair.p_rate, e->tick), origin),
                    q = point_difference(flight_place(pair.q, pair.q_rate, e->tick), origin),
                    w = point_difference(flight_place(pair.w, pair.w_rate, e->tick), origin);
  double s, t;
  capsule_closest(p, q, w, &s, &t);
  const double lever[4] = {1.0 - s, s, t - 1.0, -t};
  struct vec3 velocity = {0, 0, 0};
  for (int k = 0; k < 4; k++)
    velocity = vec3_add_scaled(velocity, lever[k], d->state->velocity[m.vertex[k]]);
  m.geometry.s = s, m.geometry.t = t;
  const double volume = volume_at(&pair, e->tick);
  const struct vec3 gap = capsule_between(p, q, w, s, t);
  m.touching = volume == 0.0 && vec3_norm(gap) < 0.25 * LATTICE_UNIT;
  m.geometry.normal = contact_normal(volume, p, q, gap, velocity);
  return m;
}

/* --- rigid clusters ----------------------------------------------------------------------------------------------- */

/* All members of the cluster of `from` join that of `to`, and fly as it does. */
static bool join_cluster(const struct event_drift *d, uint32_t from, uint32_t to, struct point rate, int32_t tick)
{
  struct bend_list *list = &d->contact->flights.bends;
  for (uint32_t k = 0; k < list->count; k++) {
    if (list->at[k].cluster != from)
      continue;
    const uint32_t i = list->at[k].vertex;
    list->at[k].cluster = to;
    if (!steer(d, i, rate, tick) || !search_again(d, 1, &i, tick))
      return false;
  }
  return true;
}

/* The four vertices of a contact move rigidly for the rest of the drift, with the clusters that they belong to: a
 * common displacement crosses nothing. Velocities stay. This ends the work on a contact that no impulse separates. */
static bool make_rigid(const struct event_drift *d, const struct meeting *m)
{
  const int32_t tick = m->event.tick;
  struct point sum = {0, 0, 0};
  uint32_t cluster = 0;
  for (int k = 0; k < 4; k++) {
    const struct bend_in_path *bend = bend_of(d, m->vertex[k]);
    if (!bend)
      return no_memory(d);
    if (bend->cluster && !cluster) {
      cluster = bend->cluster;
      sum = flight_place((struct point){0, 0, 0}, bend->rate, 4);
    }
  }
  for (int k = 0; k < 4 && !cluster; k++)
    sum = point_plus(sum, rate_of(d, m->vertex[k]));
  const struct point rate = {sum.x / 4, sum.y / 4, sum.z / 4};
  cluster = cluster ? cluster : d->contact->flights.bend_of[m->vertex[0]];
  for (int k = 0; k < 4; k++) {
    struct bend_in_path *bend = bend_of(d, m->vertex[k]);
    const uint32_t old = bend->cluster;
    if (old == cluster)
      continue;
    bend->cluster = cluster;
    if ((old && !join_cluster(d, old, cluster, rate, tick)) || !steer(d, m->vertex[k], rate, tick))
      return false;
  }
  d->state->counts.rigid++;
  return search_again(d, 4, m->vertex, tick);
}

/* --- answers ------------------------------------------------------------------------------------------------------ */

/* True if an exchange may answer the contact: none of its vertices is rigid, or has had too many. */
static bool may_exchange(const struct event_drift *d, const struct meeting *m)
{
  const struct flights *f = &d->contact->flights;
  for (int k = 0; k < 4; k++) {
    const uint32_t number = f->bend_of[m->vertex[k]];
    if (number && (f->bends.at[number - 1].cluster || f->bends.at[number - 1].contacts >= MOST_CONTACTS))
      return false;
  }
  return true;
}

/* Changes the velocities of the four vertices. False if no impulse separates the bonds. */
static bool exchange(const struct event_drift *d, struct meeting *m)
{
  const double tau = d->start + d->dt * ((double)m->event.tick / FLIGHT_TICKS);
  const struct places places = {d, m->event.tick};
  struct contact_end end[4];
  for (int k = 0; k < 4; k++)
    end[k] = (struct contact_end){&d->state->velocity[m->vertex[k]], d->model->inverse_mass[m->vertex[k]],
                                  d->contact->force(d->model, m->vertex[k], place_at_tick, &places)};
  const enum contact_answer answer = impulse_at_own_time(end, &m->geometry, tau);
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
                                     m->geometry.impulse};
  d->log->record(d->log->context, &told);
}

static bool bend_flights(const struct event_drift *d, const struct meeting *m)
{
  for (int k = 0; k < 4; k++) {
    const uint32_t i = m->vertex[k];
    struct bend_in_path *bend = bend_of(d, i);
    if (!bend)
      return no_memory(d);
    bend->contacts++;
    const struct vec3 displacement = vec3_scale(d->dt, d->state->velocity[i]);
    if (!drift_legal(d->state, d->model, i, displacement, d->fault) ||
        !steer(d, i, flight_rate(displacement), m->event.tick))
      return false;
  }
  return search_again(d, 4, m->vertex, m->event.tick);
}

static bool answer(const struct event_drift *d, const struct event *e)
{
  struct meeting m = meeting_of(d, e);
  if (m.touching) { /* two fibers laid through one point: they part, and meet no more */
    const struct neighbor other = {(int32_t)e->other, {e->image[0], e->image[1], e->image[2]}};
    return search_pair(d, e->bond, &other, e->tick + 1);
  }
  for (int k = 0; k < 4; k++) /* before velocities change */
    if (!bend_of(d, m.vertex[k]))
      return no_memory(d);
  if (!may_exchange(d, &m) || !exchange(d, &m))
    return make_rigid(d, &m);
  note(d, &m);
  return bend_flights(d, &m);
}

static bool drift_event_driven(struct state *state, const struct model *model, struct contact *contact, double dt,
                               uint64_t step, uint32_t drift, const struct contact_log *log, struct fault *fault)
{
  (void)step;
  const struct event_drift d = {state, model, contact, dt, (double)drift * dt - 0.5 * model->time_step, log, fault};
  contact->flights.time = dt;
  contact->flights.bends.count = 0;
  if ((!contact->neighbors.built && !neighbors_build(state, model, contact, fault)) ||
      !take_off(state, model, contact, dt, fault) || !candidates_find(state, model, contact, fault) || !search_all(&d))
    return false;
  struct event e;
  while (event_queue_pop(&contact->flights.queue, &e))
    if (e.version == version_of(&d, e.bond, e.other) && !answer(&d, &e))
      return false;
  land(&d);
  state->counts.moves += state->vertices;
  return true;
}

const struct crossing_rule event_driven_rule = {"event-driven", true, false, drift_event_driven};
