/* A drift of the rule `event-driven` by components: docs/port/parallel.md, *Components*.
 * They are worked on in any order between them, with random changes from one to another; each is serial. Then swept
 * boxes and touched vertices tell whether they were independent. If not, those that were not are joined, and all begins
 * anew. */
#ifndef UNCROSS_TESTS_COMPONENTS_H
#define UNCROSS_TESTS_COMPONENTS_H

#include "bead/company.h"
#include "contact/candidates.h"
#include "contact/capsule.h"
#include "contact/neighbors.h"
#include "contact/reference.h"
#include "contact/rule.h"
#include "contact/takeoff.h"

enum { NO_OWNER = -1 };

struct schedule_tally {
  uint64_t drifts, events, components, joins, ahead_drifts, ahead_wrong, bead_answers;
};

/* What a drift changes, apart from its scratch, which is made anew for each. */
struct flown_copy {
  struct state state; /* vertices are its own, the rest is the run's */
  struct work work;
  struct event_drift d;
};

static inline void copy_open(struct flown_copy *c, const struct test_run *r, const struct vec3 *velocity,
                             uint32_t drift)
{
  const size_t n = r->state.vertices;
  c->state = r->state;
  c->state.position = malloc(n * sizeof *c->state.position);
  c->state.velocity = malloc(n * sizeof *c->state.velocity);
  memcpy(c->state.position, r->state.position, n * sizeof *c->state.position);
  memcpy(c->state.velocity, velocity, n * sizeof *c->state.velocity);
  assert_true(work_alloc(&c->work, &r->model));
  struct contact *contact = &c->work.contact;
  contact->frame = drift_frame_now(&c->state, &r->model, 1.0, drift, true);
  for (uint32_t i = 0; i < n && contact->frame.sheared; i++)
    c->state.position[i] = drift_enter(&contact->frame, c->state.position[i]);
  c->d = (struct event_drift){&c->state, &r->model, contact, &contact->frame, NULL, &c->work.fault};
}

static inline void copy_close(struct flown_copy *c)
{
  work_free(&c->work);
  free(c->state.position);
  free(c->state.velocity);
}

static inline bool copies_agree(const struct flown_copy *a, const struct flown_copy *b)
{
  const size_t n = a->state.vertices;
  return memcmp(a->state.position, b->state.position, n * sizeof *a->state.position) == 0 &&
         memcmp(a->state.velocity, b->state.velocity, n * sizeof *a->state.velocity) == 0 &&
         (!a->work.bead ||
          memcmp(&a->work.bead->flight.bead, &b->work.bead->flight.bead, sizeof a->work.bead->flight.bead) == 0);
}

/* --- components --------------------------------------------------------------------------------------------------- */

struct swept {
  int64_t low[3], high[3];
};

/* A vertex, or the bead, as it was last seen to fly. */
struct seen_flight {
  int32_t owner; /* number of the component that answers for it */
  struct point at, rate;
  struct swept box;
};

struct schedule {
  struct flown_copy *c;
  const struct model *model;
  uint32_t n;                /* of vertices; number of the bead */
  uint32_t *group;           /* [n + 1] which vertices are of one component, kept when a drift begins anew */
  struct seen_flight *seen;  /* [n + 1] */
  uint32_t *number;          /* [n + 1] of the component of this root, + 1 */
  uint32_t *root;            /* [components] */
  struct event_queue *queue; /* [components] */
  uint32_t components, joined;
  uint64_t events, bead_answers;
};

static inline uint32_t group_of(uint32_t *group, uint32_t v)
{
  while (group[v] != v)
    v = group[v] = group[group[v]];
  return v;
}

static inline void unite(struct schedule *s, uint32_t a, uint32_t b)
{
  s->group[group_of(s->group, a)] = group_of(s->group, b);
}

/* Vertices up to two further along the fiber, and the vertex itself: they pull at it. Returns how many. */
static inline int pulling(const struct model *m, uint32_t v, uint32_t near[5])
{
  int n = 0;
  near[n++] = v;
  int64_t up = v, down = v;
  for (int k = 0; k < 2; k++) {
    up = up < 0 ? up : m->next[up], down = down < 0 ? down : m->prev[down];
    if (up >= 0)
      near[n++] = (uint32_t)up;
    if (down >= 0)
      near[n++] = (uint32_t)down;
  }
  return n;
}

static inline void widen(struct swept *b, struct point p)
{
  const int64_t x[3] = {p.x, p.y, p.z};
  for (int k = 0; k < 3; k++) {
    b->low[k] = x[k] < b->low[k] ? x[k] : b->low[k];
    b->high[k] = x[k] > b->high[k] ? x[k] : b->high[k];
  }
}

static inline struct seen_flight flight_now(const struct schedule *s, uint32_t v)
{
  struct seen_flight f = {.owner = NO_OWNER};
  if (v < s->n) {
    f.at = s->c->state.position[v], f.rate = event_rate(&s->c->d, v);
  } else {
    const struct bead_way *w = &s->c->work.bead->flight.way;
    f.rate = w->rate;
    f.at = flight_place(point_plus(s->c->state.bead->position, w->at), w->rate, -w->clock);
  }
  return f;
}

static inline void see_first(struct schedule *s, uint32_t v)
{
  s->seen[v] = flight_now(s, v);
  const struct point p = s->seen[v].at;
  s->seen[v].box = (struct swept){{p.x, p.y, p.z}, {p.x, p.y, p.z}};
}

/* Component c answers for this vertex; if another one does, too, they have to be joined. */
static inline void touch(struct schedule *s, uint32_t c, uint32_t v)
{
  if (s->seen[v].owner != NO_OWNER && s->seen[v].owner != (int32_t)c) {
    unite(s, s->root[c], s->root[s->seen[v].owner]);
    s->joined++;
  }
  s->seen[v].owner = (int32_t)c;
}

static inline void touch_four(struct schedule *s, uint32_t c, const struct event *e)
{
  const uint32_t vertex[4] = {e->bond, (uint32_t)s->model->next[e->bond], e->other, (uint32_t)s->model->next[e->other]};
  for (int end = 0; end < 4; end++)
    touch(s, c, vertex[end]);
}

/* Those that fly elsewhere since tick T. Each piece of a path is taken a tick further than it is flown. */
static inline void see_bends(struct schedule *s, uint32_t c, int32_t tick)
{
  const struct bend_list *bends = &s->c->work.contact.flights.bends;
  const uint32_t bead = s->c->work.bead ? 1 : 0;
  for (uint32_t k = 0; k < bends->count + bead; k++) {
    const uint32_t v = k < bends->count ? bends->at[k].vertex : s->n;
    const struct seen_flight now = flight_now(s, v);
    struct seen_flight *old = &s->seen[v];
    if (memcmp(&now.at, &old->at, sizeof now.at) == 0 && memcmp(&now.rate, &old->rate, sizeof now.rate) == 0)
      continue;
    touch(s, c, v);
    widen(&old->box, flight_place(old->at, old->rate, tick + 1));
    widen(&old->box, flight_place(now.at, now.rate, tick));
    old->at = now.at, old->rate = now.rate;
  }
}

static inline uint32_t component_of(struct schedule *s, uint32_t v)
{
  const uint32_t root = group_of(s->group, v);
  if (!s->number[root]) {
    s->root[s->components] = root;
    s->queue[s->components] = (struct event_queue){0};
    s->number[root] = ++s->components;
  }
  return s->number[root] - 1;
}

/* --- work --------------------------------------------------------------------------------------------------------- */

/* As event_driven.c begins a drift. */
static inline void set_out(struct flown_copy *c)
{
  struct contact *contact = &c->work.contact;
  contact->flights.bends.count = 0;
  assert_true(neighbors_build(&c->state, c->d.model, contact, c->d.fault));
  assert_true(take_off(&c->state, c->d.model, contact, c->d.fault));
  assert_true(candidates_find(&c->state, c->d.model, contact, c->d.fault));
  assert_true(event_search_all(&c->d) && (!c->work.bead || c->work.contact.beside->begin(&c->d)));
}

static inline void come_down(struct flown_copy *c)
{
  if (c->work.bead)
    c->work.contact.beside->end(&c->d);
  event_land(&c->d);
}

static inline void find_components(struct schedule *s)
{
  struct event_queue *all = &s->c->work.contact.flights.queue;
  for (uint32_t k = 0; k < all->count; k++) {
    const struct event *e = &all->at[k];
    const uint32_t vertex[4] = {e->bond, (uint32_t)s->model->next[e->bond], e->other,
                                (uint32_t)s->model->next[e->other]};
    uint32_t near[5];
    for (int end = 0; end < 4; end++)
      for (int i = pulling(s->model, vertex[end], near); i-- > 0;)
        unite(s, near[i], vertex[0]);
  }
  if (s->c->work.bead)
    component_of(s, s->n);
  struct event e;
  while (event_queue_pop(all, &e)) { /* vertices of first events are its own: others may make an event out of date */
    const uint32_t c = component_of(s, e.bond);
    assert_true(event_queue_push(&s->queue[c], &e));
    touch_four(s, c, &e);
  }
}

static inline bool is_valid(const struct flown_copy *c, const struct event *e)
{
  return e->version == event_version(&c->d, e->bond, e->other);
}

/* The next of a component. False if it has no more to answer. */
static inline bool answer_next(struct schedule *s, uint32_t c)
{
  struct event_queue *mine = &s->queue[c], *all = &s->c->work.contact.flights.queue;
  const bool with_bead = s->c->work.bead && c == component_of(s, s->n);
  struct event e;
  while (mine->count > 0 && !is_valid(s->c, &mine->at[0]))
    event_queue_pop(mine, &e);
  const int32_t bead = with_bead ? s->c->work.contact.beside->next(&s->c->d) : FLIGHT_TICKS;
  int32_t tick = bead;
  if (mine->count > 0 && mine->at[0].tick < bead) {
    event_queue_pop(mine, &e);
    tick = e.tick;
    touch_four(s, c, &e);
    assert_true(event_answer(&s->c->d, &e));
  } else if (bead < FLIGHT_TICKS) {
    assert_true(s->c->work.contact.beside->answer(&s->c->d));
    s->bead_answers++;
  } else {
    return false;
  }
  s->events++;
  see_bends(s, c, tick);
  while (event_queue_pop(all, &e))
    assert_true(event_queue_push(mine, &e));
  return true;
}

static inline void work_in_random_order(struct schedule *s, struct dice *dice)
{
  for (uint32_t left = s->components; left > 0;) {
    const uint32_t k = (uint32_t)dice_integer(dice, 0, left - 1);
    const int64_t most = dice_u64(dice) & 1 ? dice_integer(dice, 1, 3) : 1000000;
    bool more = true;
    for (int64_t i = 0; i < most && more; i++)
      more = answer_next(s, k);
    if (more)
      continue;
    left--; /* the last one takes its number */
    const struct event_queue queue = s->queue[k];
    const uint32_t root = s->root[k];
    s->queue[k] = s->queue[left], s->root[k] = s->root[left];
    s->queue[left] = queue, s->root[left] = root;
    s->number[s->root[k]] = k + 1, s->number[root] = left + 1;
    for (uint32_t v = 0; v <= s->n; v++)
      if (s->seen[v].owner == (int32_t)k || s->seen[v].owner == (int32_t)left)
        s->seen[v].owner = s->seen[v].owner == (int32_t)k ? (int32_t)left : (int32_t)k;
  }
}

/* --- are they independent? ---------------------------------------------------------------------------------------- */

static inline bool boxes_meet(const struct schedule *s, const struct swept *a, const struct swept *b, int64_t gap)
{
  for (int k = 0; k < 3; k++) { /* in any image: a whole number of edges between the two limits */
    const int64_t edge = s->model->box.edge[k], from = a->low[k] - b->high[k] - gap, to = a->high[k] - b->low[k] + gap;
    const int64_t first = from >= 0 ? (from + edge - 1) / edge : -(-from / edge);
    if (first * edge > to)
      return false;
  }
  return true;
}

static inline struct swept box_of(const struct schedule *s, uint32_t bond)
{
  struct swept b = s->seen[bond].box;
  if (bond == s->n)
    return b;
  const struct swept *end = &s->seen[s->model->next[bond]].box;
  widen(&b, (struct point){end->low[0], end->low[1], end->low[2]});
  widen(&b, (struct point){end->high[0], end->high[1], end->high[2]});
  return b;
}

static inline int32_t owner_of_bond(const struct schedule *s, uint32_t bond)
{
  const int32_t one = s->seen[bond].owner;
  return one != NO_OWNER || bond == s->n ? one : s->seen[s->model->next[bond]].owner;
}

static inline int64_t reach_between(const struct schedule *s, uint32_t bond, uint32_t other)
{
  const int64_t slack = lattice_from_a0(CAPSULE_SLACK);
  if (other < s->n)
    return model_reach(s->model, bond, other) + (s->model->thickness ? slack : 0);
  return lattice_from_a0(s->model->bead.radius) + s->model->thickness + slack;
}

/* Joins those that are not. */
static inline void judge(struct schedule *s)
{
  uint32_t *bond = malloc((s->n + 1) * sizeof *bond), bonds = 0, near[5];
  for (uint32_t v = 0; v <= s->n; v++) {
    if (v < s->n || s->c->work.bead)
      widen(&s->seen[v].box, flight_place(s->seen[v].at, s->seen[v].rate, FLIGHT_TICKS));
    if (s->c->work.bead && v == s->n)
      touch(s, component_of(s, v), v);
    if (v < s->n && s->seen[v].owner != NO_OWNER)
      for (int i = pulling(s->model, v, near); i-- > 0;)
        if (s->seen[near[i]].owner != NO_OWNER && s->seen[near[i]].owner != s->seen[v].owner)
          unite(s, s->root[s->seen[near[i]].owner], s->root[s->seen[v].owner]), s->joined++;
  }
  for (uint32_t v = 0; v <= s->n; v++)
    if ((v == s->n ? s->c->work.bead != NULL : s->model->next[v] >= 0) && owner_of_bond(s, v) != NO_OWNER)
      bond[bonds++] = v;
  for (uint32_t a = 0; a < bonds; a++)
    for (uint32_t b = a + 1; b < bonds; b++) {
      const int32_t one = owner_of_bond(s, bond[a]), other = owner_of_bond(s, bond[b]);
      const struct swept its = box_of(s, bond[a]), that = box_of(s, bond[b]);
      if (one != other && boxes_meet(s, &its, &that, reach_between(s, bond[a], bond[b])))
        unite(s, s->root[one], s->root[other]), s->joined++;
    }
  free(bond);
}

/* One drift by components. Returns how often they had to be joined and all done again. */
static inline uint64_t drift_by_components(struct test_run *r, const struct vec3 *velocity, uint32_t drift,
                                           struct dice *dice, struct flown_copy *c, struct schedule_tally *tally)
{
  const uint32_t n = r->state.vertices;
  struct schedule s = {.c = c, .model = &r->model, .n = n};
  s.group = malloc((n + 1) * sizeof *s.group), s.seen = calloc(n + 1, sizeof *s.seen);
  s.number = malloc((n + 1) * sizeof *s.number), s.root = malloc((n + 1) * sizeof *s.root);
  s.queue = malloc((n + 1) * sizeof *s.queue);
  for (uint32_t v = 0; v <= n; v++)
    s.group[v] = v;
  uint64_t again = 0;
  for (;; again++) {
    copy_open(c, r, velocity, drift);
    set_out(c);
    memset(s.number, 0, (n + 1) * sizeof *s.number);
    s.components = s.joined = 0, s.events = s.bead_answers = 0;
    for (uint32_t v = 0; v < n + (c->work.bead ? 1 : 0); v++)
      see_first(&s, v);
    find_components(&s);
    work_in_random_order(&s, dice);
    judge(&s);
    come_down(c);
    for (uint32_t k = 0; k < s.components; k++)
      free(s.queue[k].at);
    if (s.joined == 0)
      break;
    copy_close(c);
  }
  tally->events += s.events, tally->components += s.components, tally->joins += again;
  tally->bead_answers += s.bead_answers;
  free(s.group), free(s.seen), free(s.number), free(s.root), free(s.queue);
  return again;
}

#endif
