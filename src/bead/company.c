#include "bead/company.h"

#include "base/memory.h"
#include "bead/bead.h"
#include "contact/candidates.h"
#include "contact/capsule.h"
#include "contact/event_rigid.h"
#include "contact/impulse.h"
#include "contact/tube.h"
#include "system/bead.h"

static struct bead_work *work_of(const struct event_drift *d)
{
  return d->contact->beside->body;
}

static struct bead_company *company_of(const struct event_drift *d)
{
  return &work_of(d)->company;
}

static const struct bead_way *way_of(const struct event_drift *d)
{
  return &work_of(d)->flight.way;
}

/* Distance of the axis of a bond from the center of the bead at a contact, lattice units. */
static int64_t reach_of(const struct model *model, uint32_t bond)
{
  return bead_radius(model) + model->kind[model->fiber_kind_of[model->fiber_of[bond]]].radius;
}

static bool is_short(bool ok, const struct event_drift *d)
{
  return ok || event_no_memory(d);
}

/* --- who may touch it --------------------------------------------------------------------------------------------- */

/* A bond and the bead where the drift begins. */
struct stand {
  double apart;       /* a0: what both may go together before they touch */
  double before;      /* a0: the same before the bond touches another image */
  struct point image; /* of the bead that is nearest, from the bead itself */
};

static struct stand stand_of(const struct model *model, struct point bead, struct point a, struct point b,
                             int64_t reach)
{
  const struct point p = point_minus(b, a), half = {p.x / 2, p.y / 2, p.z / 2}, middle = point_plus(a, half);
  const struct point to = point_plus(bead_to_image(&model->box, middle, bead), half); /* from a to the image */
  const struct vec3 bond = point_in_a0(p);
  const double touch = (double)reach * LATTICE_UNIT + CAPSULE_SLACK;
  return (struct stand){
      .apart = capsule_distance(bond, (struct vec3){0, 0, 0}, point_in_a0(to)) - touch,
      .before = 0.5 * box_shortest_edge(&model->box) - 0.5 * vec3_norm(bond) - touch,
      .image = point_minus(point_plus(a, to), bead),
  };
}

static bool carried(const struct event_drift *d, uint32_t i)
{
  const struct flights *f = &d->contact->flights;
  return d->contact->beside->cluster && f->bend_of[i] &&
         f->bends.at[f->bend_of[i] - 1].cluster == d->contact->beside->cluster;
}

/* The next contact, from a tick on. */
static void search(const struct event_drift *d, struct bead_neighbor *n, int32_t from)
{
  const uint32_t i = n->bond, j = (uint32_t)d->model->next[i];
  const struct bead_way *w = way_of(d);
  const struct point at = d->state->position[i], rate = event_rate(d, i), none = {0, 0, 0};
  const struct point center =
      flight_place(point_plus(point_plus(d->state->bead->position, n->image), w->at), w->rate, -w->clock);
  const struct flight_pair pair = {.p = point_minus(d->state->position[j], at),
                                   .q = none,
                                   .w = point_minus(center, at),
                                   .p_rate = point_minus(event_rate(d, j), rate),
                                   .q_rate = none,
                                   .w_rate = point_minus(w->rate, rate)};
  const bool goes_along = carried(d, i) && carried(d, j);
  n->due = from < FLIGHT_TICKS && !goes_along ? tube_contact(&pair, reach_of(d->model, i), from) : FLIGHT_TICKS;
}

static bool add(const struct event_drift *d, uint32_t bond, struct point image)
{
  struct bead_company *c = company_of(d);
  if (c->count == c->room && !memory_double((void **)&c->at, &c->room, 64, sizeof *c->at))
    return event_no_memory(d);
  c->at[c->count] = (struct bead_neighbor){.bond = bond, .image = image};
  c->listed[bond] = ++c->count;
  return true;
}

static bool is_due(const struct event_drift *d, uint32_t bond)
{
  return (company_of(d)->limit[bond] - d->contact->neighbors.path[bond] - company_of(d)->way) >> 31;
}

/* Measures a bond that is due. If it may touch the bead in this drift, it is listed. */
static bool measure(const struct event_drift *d, uint32_t bond)
{
  struct bead_company *c = company_of(d);
  const struct contact *all = d->contact;
  const uint32_t go = candidates_way(d->model, all, bond), before = all->neighbors.path[bond] - go + c->way_before;
  const struct stand s = stand_of(d->model, d->state->bead->position, event_start(d, bond),
                                  event_start(d, (uint32_t)d->model->next[bond]), reach_of(d->model, bond));
  const double apart = capsule_least(s.apart, s.before),
               both = (double)(go + c->way - c->way_before) / (1 << CANDIDATES_UNITS);
  c->limit[bond] =
      before + (uint32_t)(int32_t)(capsule_least(capsule_most(apart, 0.0), 32.0) * (1 << CANDIDATES_UNITS));
  if (!(s.before > both))
    return fault_record(d->fault, FAULT_BEAD_MOVE, d->state->step + 1, 0, both, s.before);
  return !is_due(d, bond) || add(d, bond, s.image);
}

enum { GROUP = 64 };                       /* vertices looked at together: of most groups none is due */
#define FURTHEST (32u << CANDIDATES_UNITS) /* a0, in units of paths: the largest limit */

static bool any_due(const struct event_drift *d, uint32_t first, uint32_t n)
{
  const uint32_t *limit = &company_of(d)->limit[first], *path = &d->contact->neighbors.path[first],
                 way = company_of(d)->way;
  uint32_t sign = 0;
  for (uint32_t k = 0; k < n; k++)
    sign |= limit[k] - path[k] - way;
  return sign >> 31;
}

/* A vertex that is due: its bond is measured, unless it has none, or is listed. */
static bool look_at(const struct event_drift *d, uint32_t i)
{
  struct bead_company *c = company_of(d);
  if (d->model->next[i] >= 0)
    return c->listed[i] || measure(d, i);
  c->limit[i] = d->contact->neighbors.path[i] + c->way + FURTHEST;
  return true;
}

/* Lists all bonds that may touch the bead and are not listed yet, and searches their contacts from a tick on. */
static bool look_around(const struct event_drift *d, int32_t tick)
{
  struct bead_company *c = company_of(d);
  const uint32_t first = c->count, all = d->model->vertices;
  for (uint32_t group = 0; group < all; group += GROUP) {
    const uint32_t n = all - group < GROUP ? all - group : GROUP;
    if (!any_due(d, group, n))
      continue;
    for (uint32_t i = group; i < group + n; i++)
      if (is_due(d, i) && !look_at(d, i))
        return false;
  }
  for (uint32_t k = first; k < c->count; k++)
    search(d, &c->at[k], tick);
  return true;
}

/* What the bead may go in this drift. */
static void lengthen(const struct event_drift *d)
{
  struct bead_company *c = company_of(d);
  const struct bead_flight *v = &work_of(d)->flight;
  c->slack = v->slack;
  c->way = c->way_before + candidates_units(capsule_least(v->way.time * vec3_norm(v->free) + v->slack, 64.0));
}

static bool company_begin(const struct event_drift *d)
{
  struct bead_company *c = company_of(d);
  if (!bead_flight_begin(d->state, d->model, &work_of(d)->flight, d->fault))
    return false;
  c->count = d->contact->beside->cluster = 0;
  c->stale = true;
  c->way_before = c->way;
  lengthen(d);
  return look_around(d, 0);
}

static bool company_search_again(const struct event_drift *d, uint32_t n, const uint32_t *bond, int32_t tick)
{
  struct bead_company *c = company_of(d);
  for (uint32_t k = 0; k < n; k++) {
    if (!c->listed[bond[k]] && is_due(d, bond[k]) && !measure(d, bond[k]))
      return false;
    if (c->listed[bond[k]])
      search(d, &c->at[c->listed[bond[k]] - 1], tick);
  }
  return true;
}

static void company_end(const struct event_drift *d)
{
  struct bead_company *c = company_of(d);
  for (uint32_t k = 0; k < c->count; k++)
    c->listed[c->at[k].bond] = 0;
  bead_flight_end(d->state, d->model, &work_of(d)->flight);
}

/* --- the path of the bead bends ----------------------------------------------------------------------------------- */

/* The bead has another velocity from this tick on. */
static bool bent(const struct event_drift *d, int32_t tick)
{
  struct bead_company *c = company_of(d);
  const uint32_t cluster = d->contact->beside->cluster;
  c->stale = true;
  if (work_of(d)->flight.slack > c->slack) {
    lengthen(d);
    if (!look_around(d, tick))
      return false;
  }
  for (uint32_t k = 0; k < c->count; k++)
    search(d, &c->at[k], tick);
  return !cluster || event_steer_cluster(d, cluster, way_of(d)->rate, tick);
}

static bool company_hold(const struct event_drift *d, int32_t tick)
{
  struct bead_flight *v = &work_of(d)->flight;
  if (v->way.held)
    return true;
  v->way.held = true;
  return bead_flight_turn(d->state, d->model, v, tick, v->way.velocity, d->fault) && bent(d, tick);
}

/* --- a contact ---------------------------------------------------------------------------------------------------- */

/* Where they touch: s along the bond, and the normal from there to the center. */
static struct contact_geometry geometry_of(const struct event_drift *d, const struct bead_neighbor *n)
{
  const struct bead_way *w = way_of(d);
  const struct point a = event_place(d, n->bond, n->due), b = event_place(d, (uint32_t)d->model->next[n->bond], n->due),
                     center = flight_place(point_plus(point_plus(d->state->bead->position, n->image), w->at), w->rate,
                                           n->due - w->clock);
  const struct vec3 p = point_difference(b, a), to = point_difference(center, a), none = {0, 0, 0};
  double s, t;
  capsule_closest(p, none, to, &s, &t);
  const struct vec3 gap = capsule_between(p, none, to, s, 0.0);
  return (struct contact_geometry){.s = s, .t = 0.0, .normal = vec3_scale(1.0 / vec3_norm(gap), gap)};
}

/* The drive's force on the bead, kT/a0. */
static struct vec3 pull(const struct event_drift *d, int32_t tick)
{
  const struct bead_way *w = way_of(d);
  const struct point place = flight_place(point_plus(d->state->bead->position, w->at), w->rate, tick - w->clock);
  return bead_force(d->model, place, d->state->solvent_time + 1);
}

/* Changes the velocities of both ends, and *bead. False if no impulse separates the bond and the bead. */
static bool exchange(const struct event_drift *d, const uint32_t vertex[2], int32_t tick, struct contact_geometry *at,
                     struct vec3 *bead)
{
  struct vec3 nobody = {0, 0, 0};
  struct contact_end end[4] = {[2] = {bead, 1.0 / d->model->bead.mass, pull(d, tick)}, [3] = {&nobody, 0.0, nobody}};
  for (int e = 0; e < 2; e++)
    end[e] = (struct contact_end){&d->state->velocity[vertex[e]], d->model->inverse_mass[vertex[e]],
                                  event_force(d, vertex[e], tick)};
  const enum contact_answer answer = impulse_at_own_time(end, at, event_time(d, tick));
  d->state->counts.softened += answer == CONTACT_SOFTENED;
  return answer != CONTACT_NONE;
}

static void note(const struct event_drift *d, uint32_t bond, int32_t tick, const struct contact_geometry *at)
{
  d->state->counts.possible++;
  d->state->counts.executed++;
  if (!d->log)
    return;
  const struct contact_event told = {.vertex = bond,
                                     .moving_bond = bond,
                                     .standing_bond = EVENT_BEAD,
                                     .hit = {(double)tick / FLIGHT_TICKS, at->s, 0.0, at->normal},
                                     .executed = true,
                                     .impulse = at->impulse};
  d->log->record(d->log->context, &told);
}

static bool touch(const struct event_drift *d, struct bead_neighbor n)
{
  struct bead_flight *v = &work_of(d)->flight;
  const uint32_t vertex[2] = {n.bond, (uint32_t)d->model->next[n.bond]};
  for (int e = 0; e < 2; e++) /* before velocities change */
    if (!is_short(event_bend(d, vertex[e]), d))
      return false;
  struct contact_geometry at = geometry_of(d, &n);
  struct vec3 bead = v->way.velocity;
  if (event_is_rigid(d, 2, vertex) || !exchange(d, vertex, n.due, &at, &bead))
    return event_make_rigid(d, 2, vertex, true, n.due);
  note(d, n.bond, n.due, &at);
  if (!bead_flight_turn(d->state, d->model, v, n.due, bead, d->fault))
    return false;
  for (int e = 0; e < 2; e++) {
    event_bend(d, vertex[e])->contacts++;
    if (!event_steer_freely(d, vertex[e], n.due))
      return false;
  }
  return event_search_again(d, 2, vertex, n.due) && bent(d, n.due);
}

/* --- what comes next ---------------------------------------------------------------------------------------------- */

static const struct bead_neighbor *first_of(const struct bead_company *c)
{
  const struct bead_neighbor *first = c->at;
  for (uint32_t k = 0; k < c->count; k++) {
    const struct bead_neighbor *n = &c->at[k];
    if (n->due < first->due || (n->due == first->due && n->bond < first->bond))
      first = n;
  }
  return first;
}

/* The tick of the next hit of a solvent particle. */
static int32_t next_hit(const struct event_drift *d)
{
  struct bead_company *c = company_of(d);
  if (c->stale)
    c->hit = (int32_t)bead_flight_next(d->state, &work_of(d)->flight);
  c->stale = false;
  return c->hit;
}

static int32_t company_next(const struct event_drift *d)
{
  const struct bead_company *c = company_of(d);
  const int32_t hit = next_hit(d), due = c->count > 0 ? first_of(c)->due : FLIGHT_TICKS;
  return hit < due ? hit : due;
}

static bool company_answer(const struct event_drift *d)
{
  struct bead_company *c = company_of(d);
  const int32_t hit = next_hit(d);
  if (c->count > 0 && first_of(c)->due < hit)
    return touch(d, *first_of(c));
  return bead_flight_answer(d->state, d->model, &work_of(d)->flight, d->fault) && bent(d, hit);
}

static struct point company_rate(const struct event_drift *d)
{
  return way_of(d)->rate;
}

const struct timeline bead_timeline = {.begin = company_begin,
                                       .next = company_next,
                                       .answer = company_answer,
                                       .search_again = company_search_again,
                                       .end = company_end,
                                       .rate = company_rate,
                                       .hold = company_hold};

/* --- starts ------------------------------------------------------------------------------------------------------- */

bool bead_company_clear(const struct model *model, struct point bead, const struct point *position, uint32_t fiber,
                        uint32_t *bond, double *distance)
{
  for (uint32_t j = model->fiber_first[fiber]; j < model->fiber_first[fiber + 1]; j++) {
    if (model->next[j] < 0)
      continue;
    const int64_t reach = reach_of(model, j);
    const struct stand s = stand_of(model, bead, position[j], position[model->next[j]], reach);
    const struct flight_pair pair = {.p = point_minus(position[model->next[j]], position[j]),
                                     .w = point_minus(point_plus(bead, s.image), position[j])};
    if (tube_excluded(&pair, reach, 0, 0))
      continue;
    *bond = j;
    *distance = s.apart + (double)reach * LATTICE_UNIT + CAPSULE_SLACK;
    return false;
  }
  return true;
}
