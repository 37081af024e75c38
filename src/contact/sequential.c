#include "contact/rule.h"

#include "base/random.h"
#include "contact/drift.h"
#include "contact/impulse.h"
#include "contact/neighbors.h"
#include "contact/renewals.h"
#include "contact/schedule.h"
#include "contact/wall.h"

enum { AHEAD = 6 }; /* turns ahead for which candidates are prefetched; vertices, twice as many */

/* One trial move: vertex i from its place to `to`. */
struct trial {
  uint32_t vertex;
  struct point to;
  uint32_t hits;
  struct contact_event first;
  const struct contact_log *log;
};

/* True if hit a of a move comes before hit b: by time; at equal times by numbers, never by the order of a list. */
static bool earlier(const struct contact_event *a, const struct contact_event *b)
{
  if (a->hit.time != b->hit.time)
    return a->hit.time < b->hit.time;
  if (a->moving_bond != b->moving_bond)
    return a->moving_bond < b->moving_bond;
  if (a->standing_bond != b->standing_bond)
    return a->standing_bond < b->standing_bond;
  for (int k = 0; k < 3; k++)
    if (a->image[k] != b->image[k])
      return a->image[k] < b->image[k];
  return false;
}

static void record(const struct contact_log *log, const struct contact_event *event)
{
  if (log)
    log->record(log->context, event);
}

static void note_hit(struct trial *t, struct contact_event event)
{
  bool first = t->hits++ == 0 || earlier(&event, &t->first);
  if (t->hits > 1)
    record(t->log, first ? &t->first : &event);
  if (first)
    t->first = event;
}

/* Exclusion as the paper words it: bonds linked to either of the two bonds that move with this vertex. */
static bool linked_to_moving(const struct model *model, uint32_t vertex, const struct neighbor *n)
{
  if (n->image[0] != 0 || n->image[1] != 0 || n->image[2] != 0)
    return false;
  int32_t before = model->prev[vertex], after = model->next[vertex];
  if (before >= 0 && model->prev[before] >= 0 && n->bond == model->prev[before])
    return true;
  return after >= 0 && model->next[after] >= 0 && n->bond == after;
}

/* Finds all hits of one of the two bonds of the moving vertex. */
static void test_bond(const struct state *state, const struct model *model, const struct candidate_list *candidates,
                      uint32_t bond, struct trial *t)
{
  const bool is_first = bond == t->vertex;
  struct crossing_query q = {.from = state->position[t->vertex],
                             .to = t->to,
                             .pivot = state->position[is_first ? (uint32_t)model->next[bond] : bond],
                             .flip = is_first};
  const struct vec3 before = point_difference(q.from, q.pivot), after = point_difference(q.to, q.pivot);
  for (uint32_t m = candidates->first[bond]; m; m = candidates->at[m - 1].next) {
    const struct neighbor *n = &candidates->at[m - 1].with;
    const struct point b = state->position[model->next[n->bond]];
    q.a = point_image(state->position[n->bond], n->image, &model->box);
    if (crossing_far(point_difference(b, state->position[n->bond]), point_difference(q.pivot, q.a), before, after))
      continue;
    q.b = point_image(b, n->image, &model->box);
    if (model->crossing.exclusion == EXCLUSION_PAPER && linked_to_moving(model, t->vertex, n))
      continue;
    struct contact_event event = {
        t->vertex, bond, (uint32_t)n->bond, {n->image[0], n->image[1], n->image[2]}, {.time = 0.0}, false, 0.0, 0.0};
    if (crossing_find(&q, &event.hit))
      note_hit(t, event);
  }
}

static struct impulse_end end_of(struct state *state, const struct model *model, uint32_t vertex)
{
  return (struct impulse_end){&state->velocity[vertex], model->inverse_mass[vertex]};
}

/* Gives both ends of a bond this velocity along x in addition. */
static void add_along_x(struct state *state, const struct model *model, uint32_t bond, double speed)
{
  state->velocity[bond].x += speed;
  state->velocity[model->next[bond]].x += speed;
}

/* The bonds exchange momentum. In a sheared box an image has the velocity of the bond plus the image's own. */
static void exchange(struct state *state, const struct model *model, const struct drift_frame *frame,
                     struct contact_event *e)
{
  const uint32_t pivot = e->moving_bond == e->vertex ? (uint32_t)model->next[e->vertex] : e->moving_bond;
  const struct impulse_end moving[2] = {end_of(state, model, e->vertex), end_of(state, model, pivot)};
  const struct impulse_end standing[2] = {end_of(state, model, e->standing_bond),
                                          end_of(state, model, (uint32_t)model->next[e->standing_bond])};
  const double speed = e->image[1] * frame->image_speed;
  e->hit.normal = drift_normal(frame, e->hit.normal);
  if (speed != 0.0)
    add_along_x(state, model, e->standing_bond, speed);
  e->impulse = impulse_exchange(moving, standing, e->hit.s, e->hit.s_standing, e->hit.normal);
  if (speed != 0.0)
    add_along_x(state, model, e->standing_bond, -speed);
}

/* Answers the first hit: the bonds exchange momentum, and the vertex stays where it is. False, with the fault
 * recorded, if memory is short. */
static bool execute(struct state *state, const struct model *model, struct contact *contact, struct trial *t,
                    struct fault *fault)
{
  struct contact_event *e = &t->first;
  const uint32_t pivot = e->moving_bond == t->vertex ? (uint32_t)model->next[t->vertex] : e->moving_bond;
  const uint32_t changed[3] = {pivot, e->standing_bond, (uint32_t)model->next[e->standing_bond]};
  exchange(state, model, &contact->frame, e);
  renewals_look_again(&contact->neighbors, t->vertex);
  for (int k = 0; k < 3; k++)
    if (!schedule_reconsider(state, model, contact, changed[k], contact->rank[t->vertex], fault))
      return false;
  e->executed = true;
  record(t->log, e);
  state->counts.possible += t->hits;
  state->counts.executed++;
  state->counts.negative += e->impulse < 0.0;
  return true;
}

/* Tests both bonds of the vertex against their candidate contacts, at its turn. A vertex that would leave its skin
 * takes a new reference position before. False, with the fault recorded, if memory is short. */
static bool find_hits(struct state *state, const struct model *model, struct contact *contact, struct trial *t,
                      struct fault *fault)
{
  const uint32_t i = t->vertex;
  const int32_t before = model->prev[i];
  if (!neighbors_hold(&contact->neighbors, i, t->to) &&
      (!neighbors_renew(state, model, contact, 1, &i, &state->position[i], &t->to, fault) ||
       !schedule_look_around(state, model, contact, i, contact->rank[i], fault)))
    return false;
  if (before >= 0)
    test_bond(state, model, &contact->candidates, (uint32_t)before, t);
  if (model->next[i] >= 0)
    test_bond(state, model, &contact->candidates, i, t);
  return true;
}

/* The rule `bounce`: the vertex would move to the hit with its old velocity, and for the rest of the time with its new
 * one. It moves from its place straight to the end of this path, if that crosses nothing; else it stays. Hits of this
 * second move are neither answered nor recorded. */
static bool bounce(struct state *state, const struct model *model, struct contact *contact, const struct trial *hit,
                   struct vec3 before, struct fault *fault)
{
  const uint32_t i = hit->vertex;
  const struct drift_frame *frame = &contact->frame;
  const double time = hit->first.hit.time;
  struct trial t = {.vertex = i};
  const struct vec3 first = drift_displacement(frame, before, state->position[i].y),
                    rest = drift_displacement(frame, state->velocity[i], state->position[i].y),
                    d = vec3_add_scaled(vec3_scale(time, first), 1.0 - time, rest);
  t.to = point_move(state->position[i], d);
  if (wall_is_beyond(&model->box, t.to.y))
    return true;
  if (!drift_legal(state, model, i, d, fault) ||
      !schedule_reconsider(state, model, contact, i, contact->rank[i], fault) ||
      !find_hits(state, model, contact, &t, fault))
    return false;
  if (t.hits == 0)
    state->position[i] = t.to;
  return true;
}

static bool try_move(struct state *state, const struct model *model, struct contact *contact, struct trial *t,
                     struct fault *fault)
{
  const struct vec3 before = state->velocity[t->vertex];
  if (!find_hits(state, model, contact, t, fault))
    return false;
  if (t->hits == 0) {
    state->position[t->vertex] = t->to;
    return true;
  }
  return execute(state, model, contact, t, fault) &&
         (model->crossing.rejection == REJECTION_STAY || bounce(state, model, contact, t, before, fault));
}

/* A move that ends beyond a wall has two parts: to the wall, and with the velocity after the hit from there. Each is
 * tested. Where a bond is in the way, the vertex stays at its old place; it has met the wall if that was first. */
static bool try_move_at_wall(struct state *state, const struct model *model, struct contact *contact, struct trial *t,
                             struct fault *fault)
{
  const uint32_t i = t->vertex;
  const struct point from = state->position[i];
  const struct wall_meeting m = wall_meet(&model->box, from, t->to);
  struct trial rest = {.vertex = i, .log = t->log};
  t->to = m.at;
  if (!try_move(state, model, contact, t, fault))
    return false;
  if (t->hits > 0)
    return true;
  const struct vec3 at_rest = {0, 0, 0};
  wall_hit(state, model, &contact->frame, m.wall, i, at_rest, 0.0);
  const struct vec3 d = drift_displacement(&contact->frame, state->velocity[i], from.y);
  rest.to = wall_inside(&model->box, point_move(m.at, vec3_scale(1.0 - m.part, d)));
  if (!drift_legal(state, model, i, d, fault))
    return false;
  if (!schedule_reconsider(state, model, contact, i, contact->rank[i], fault) ||
      !find_hits(state, model, contact, &rest, fault))
    return false;
  state->position[i] = rest.hits > 0 ? from : rest.to;
  return rest.hits == 0 || execute(state, model, contact, &rest, fault);
}

static void draw_order(const struct state *state, const struct model *model, struct contact *contact, uint64_t step,
                       uint32_t drift)
{
  random_permutation(model->seed, RANDOM_VERTEX_ORDER, drift, step, state->vertices, contact->order);
  for (uint32_t k = 0; k < state->vertices; k++)
    contact->rank[contact->order[k]] = k;
}

/* Prefetches what a trial move reads: turns come in random order, so the data is rarely in the cache. */
static void fetch_vertex(const struct state *state, const struct model *model, const struct contact *contact,
                         uint32_t i)
{
  __builtin_prefetch(&state->position[i > 0 ? i - 1 : 0], 1);
  __builtin_prefetch(&state->position[i + 1].z, 1);
  __builtin_prefetch(&state->velocity[i]);
  __builtin_prefetch(&contact->neighbors.reference[i]);
  __builtin_prefetch(&model->prev[i]);
  __builtin_prefetch(&model->next[i]);
  __builtin_prefetch(&contact->candidates.first[i]);
}

static void fetch_candidates(const struct state *state, const struct model *model, const struct contact *contact,
                             uint32_t i)
{
  for (uint32_t bond = i > 0 ? i - 1 : 0; bond <= i; bond++)
    for (uint32_t m = contact->candidates.first[bond]; m; m = contact->candidates.at[m - 1].next) {
      const int32_t other = contact->candidates.at[m - 1].with.bond;
      __builtin_prefetch(&state->position[other]);
      __builtin_prefetch(&state->position[other + 1].z);
      __builtin_prefetch(&model->next[other]);
    }
}

static bool drift_sequential(struct state *state, const struct model *model, struct contact *contact, uint64_t step,
                             uint32_t drift, const struct contact_log *log, struct fault *fault)
{
  if (!contact->neighbors.built && !neighbors_build(state, model, contact, fault))
    return false;
  draw_order(state, model, contact, step, drift);
  if (!schedule_plan(state, model, contact, fault))
    return false;
  for (uint32_t k = 0; k < contact->queued; k++) {
    if (k + 2 * AHEAD < contact->queued)
      fetch_vertex(state, model, contact, contact->queue[k + 2 * AHEAD]);
    if (k + AHEAD < contact->queued)
      fetch_candidates(state, model, contact, contact->queue[k + AHEAD]);
    struct trial t = {.vertex = contact->queue[k], .log = log};
    if (!drift_trial(state, model, &contact->frame, t.vertex, &t.to, fault))
      return false;
    if (!(wall_is_beyond(&model->box, t.to.y) ? try_move_at_wall : try_move)(state, model, contact, &t, fault))
      return false;
  }
  contact->waited += contact->queued;
  state->counts.moves += state->vertices;
  return true;
}

const struct crossing_rule sequential_rule = {"sequential", true, true, drift_sequential};
