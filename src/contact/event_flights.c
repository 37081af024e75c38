#include "contact/event_drift.h"

#include "base/memory.h"
#include "contact/candidates.h"
#include "contact/capsule.h"
#include "contact/neighbors.h"
#include "contact/renewals.h"
#include "contact/shape.h"
#include "contact/takeoff.h"

bool event_no_memory(const struct event_drift *d)
{
  return fault_no_memory(d->fault, d->state->step + 1);
}

/* --- flights ------------------------------------------------------------------------------------------------------ */

struct point event_rate(const struct event_drift *d, uint32_t i)
{
  return takeoff_rate_now(d->state, d->contact, i);
}

struct point event_place(const struct event_drift *d, uint32_t i, int32_t tick)
{
  return flight_place(d->state->position[i], event_rate(d, i), tick);
}

struct point event_start(const struct event_drift *d, uint32_t i)
{
  const struct flights *f = &d->contact->flights;
  return f->bend_of[i] ? f->bends.at[f->bend_of[i] - 1].start : d->state->position[i];
}

struct places {
  const struct event_drift *drift;
  int32_t tick;
};

static struct point place_in_space(const void *context, uint32_t vertex)
{
  const struct places *p = context;
  return drift_place(p->drift->frame, event_place(p->drift, vertex, p->tick), (double)p->tick / FLIGHT_TICKS);
}

struct vec3 event_force(const struct event_drift *d, uint32_t i, int32_t tick)
{
  const struct places places = {d, tick};
  return d->contact->force(d->model, i, place_in_space, &places);
}

/* All vertices fly straight to the end; those whose flights have bent are then put where theirs end. */
void event_land(const struct event_drift *d)
{
  struct point *restrict p = d->state->position;
  const struct vec3 *restrict v = d->state->velocity;
  struct flights *f = &d->contact->flights;
  for (uint32_t k = 0; k < f->bends.count; k++)
    f->bends.at[k].end = event_place(d, f->bends.at[k].vertex, FLIGHT_TICKS);
  for (uint32_t i = 0; i < d->state->vertices; i++)
    p[i] = flight_place(p[i], takeoff_rate(d->frame, v[i], p[i].y), FLIGHT_TICKS);
  for (uint32_t k = 0; k < f->bends.count; k++) {
    p[f->bends.at[k].vertex] = f->bends.at[k].end;
    f->bend_of[f->bends.at[k].vertex] = 0;
  }
}

/* --- contacts to come --------------------------------------------------------------------------------------------- */

struct flight_pair event_pair(const struct event_drift *d, uint32_t bond, uint32_t other, const int32_t image[3])
{
  const struct point *at = d->state->position;
  const uint32_t j = (uint32_t)d->model->next[bond], m = (uint32_t)d->model->next[other];
  const struct point bond_rate = event_rate(d, bond), other_rate = event_rate(d, other);
  return (struct flight_pair){
      .p = point_minus(at[j], at[bond]),
      .q = point_minus(at[m], at[other]),
      .w = point_minus(point_image(at[other], image, &d->model->box), at[bond]),
      .p_rate = point_minus(event_rate(d, j), bond_rate),
      .q_rate = point_minus(event_rate(d, m), other_rate),
      .w_rate = point_minus(other_rate, bond_rate),
  };
}

uint32_t event_version(const struct event_drift *d, uint32_t bond, uint32_t other)
{
  return d->contact->flights.version[bond] + d->contact->flights.version[other];
}

/* Queues the first contact of a pair from a tick on. Of the two bonds, the lower number comes first. */
bool event_search_pair(const struct event_drift *d, uint32_t bond, const struct neighbor *n, int32_t from)
{
  const bool exchange = (uint32_t)n->bond < bond;
  const int32_t sign = exchange ? -1 : 1;
  struct event e = {.bond = exchange ? (uint32_t)n->bond : bond,
                    .other = exchange ? bond : (uint32_t)n->bond,
                    .image = {sign * n->image[0], sign * n->image[1], sign * n->image[2]}};
  const struct flight_pair pair = event_pair(d, e.bond, e.other, e.image);
  const int64_t reach = model_reach(d->model, e.bond, e.other);
  e.tick = from < FLIGHT_TICKS ? bond_shape_of(reach)->contact(&pair, reach, from) : FLIGHT_TICKS;
  e.version = event_version(d, e.bond, e.other);
  return e.tick == FLIGHT_TICKS || event_queue_push(&d->contact->flights.queue, &e) || event_no_memory(d);
}

bool event_search_all(const struct event_drift *d)
{
  const struct candidate_list *list = &d->contact->candidates;
  for (uint32_t k = 0; k < list->count; k++) {
    const struct candidate *c = &list->at[k];
    if (c->bond < (uint32_t)c->with.bond && !event_search_pair(d, c->bond, &c->with, 0))
      return false;
  }
  return true;
}

/* --- paths bend --------------------------------------------------------------------------------------------------- */

struct bend_in_path *event_bend(const struct event_drift *d, uint32_t i)
{
  struct flights *f = &d->contact->flights;
  if (f->bend_of[i])
    return &f->bends.at[f->bend_of[i] - 1];
  struct bend_list *list = &f->bends;
  if (list->count == list->room && !memory_double((void **)&list->at, &list->room, 64, sizeof *list->at))
    return NULL;
  list->at[list->count] = (struct bend_in_path){.vertex = i, .start = d->state->position[i], .rate = event_rate(d, i)};
  f->bend_of[i] = ++list->count;
  return &list->at[list->count - 1];
}

/* Adds the bonds that this one may touch, while the ends of both keep their ranges, to its candidates. */
static bool look_around_bond(const struct event_drift *d, uint32_t bond)
{
  struct neighbor_list *near = &d->contact->near;
  const uint32_t next = (uint32_t)d->model->next[bond];
  const double radius = 0.5 * model_thickness(d->model);
  const struct point end[2] = {event_start(d, bond), event_start(d, next)};
  const struct capsule mine = {
      {0, 0, 0}, point_difference(end[1], end[0]), radius + candidates_range(d->model, d->contact, bond)};
  if (!neighbors_near(d->state, d->model, d->contact, bond, end, mine.reach, near, d->fault))
    return false;
  for (uint32_t k = 0; k < near->count; k++) {
    const struct neighbor *n = &near->at[k];
    const struct point a = event_start(d, (uint32_t)n->bond), b = event_start(d, (uint32_t)d->model->next[n->bond]);
    const struct capsule its = {point_difference(point_image(a, n->image, &d->model->box), end[0]),
                                point_difference(point_image(b, n->image, &d->model->box), end[0]),
                                radius + candidates_range(d->model, d->contact, (uint32_t)n->bond)};
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

bool event_steer(const struct event_drift *d, uint32_t i, struct point rate, int32_t tick)
{
  struct contact *c = d->contact;
  struct bend_in_path *bend = event_bend(d, i);
  if (!bend)
    return event_no_memory(d);
  const struct point start = bend->start, here = event_place(d, i, tick);
  bend->rate = rate;
  d->state->position[i] = flight_place(here, rate, -tick);
  const struct point end = event_place(d, i, FLIGHT_TICKS);
  if (!check_range(d, i, start, end))
    return false;
  /* A straight piece stays within its range of the start if both its ends do. */
  const uint32_t range = candidates_units(vec3_norm(point_difference(end, start)) + LATTICE_UNIT);
  const bool wider = range > c->range[i], leaves = !neighbors_hold(&c->neighbors, i, end);
  if (wider)
    candidates_widen(d->model, c, i, range);
  if (leaves && !neighbors_renew(d->state, d->model, c, 1, &i, &here, &end, d->fault))
    return false;
  renewals_look_again(&c->neighbors, i);
  return (!model_has_walls(d->model) || event_search_wall(d, i)) && (!(wider || leaves) || look_around(d, i));
}

bool event_steer_freely(const struct event_drift *d, uint32_t i, int32_t tick)
{
  const struct bend_in_path *bend = event_bend(d, i);
  if (!bend)
    return event_no_memory(d);
  const struct vec3 displacement = drift_displacement(d->frame, d->state->velocity[i], bend->start.y);
  return drift_legal(d->state, d->model, i, displacement, d->fault) &&
         event_steer(d, i, flight_rate(displacement), tick);
}

bool event_search_again(const struct event_drift *d, uint32_t n, const uint32_t *vertex, int32_t tick)
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
      if (!done && !event_search_pair(d, bond[b], &with, tick))
        return false;
    }
  const struct timeline *beside = d->contact->beside;
  return !beside || beside->search_again(d, bonds, bond, tick);
}
