#include "fiber/sweep.h"

#include "base/random.h"
#include "fiber/exchange.h"
#include "fiber/neighbors.h"
#include "fiber/turns.h"

enum { AHEAD = 6 }; /* turns that memory is asked to be ahead */

/* One trial move: vertex i from its place to `to`. */
struct trial {
  uint32_t vertex;
  double dt;
  struct point to;
  uint32_t hits;
  struct sweep_event first;
  const struct sweep_log *log;
};

/* The order in which hits of one move count as earlier; ties are broken by numbers, never by the order of a list. */
static bool earlier(const struct sweep_event *a, const struct sweep_event *b)
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

static void record(const struct sweep_log *log, const struct sweep_event *event)
{
  if (log)
    log->record(log->context, event);
}

static void note_hit(struct trial *t, struct sweep_event event)
{
  bool first = t->hits++ == 0 || earlier(&event, &t->first);
  if (t->hits > 1)
    record(t->log, first ? &t->first : &event);
  if (first)
    t->first = event;
}

/* Padding's literal exclusion: bonds linked to either bond that moves with this vertex. */
static bool linked_to_moving(const struct model *model, uint32_t vertex, const struct neighbor *n)
{
  if (n->image[0] != 0 || n->image[1] != 0 || n->image[2] != 0)
    return false;
  int32_t before = model->prev[vertex], after = model->next[vertex];
  if (before >= 0 && model->prev[before] >= 0 && n->bond == model->prev[before])
    return true;
  return after >= 0 && model->next[after] >= 0 && n->bond == after;
}

/* All hits of one of the two bonds of the moving vertex. */
static void test_bond(const struct state *state, const struct model *model, const struct meeting_list *meetings,
                      uint32_t bond, struct trial *t)
{
  const bool is_first = bond == t->vertex;
  struct crossing_query q = {.from = state->position[t->vertex],
                             .to = t->to,
                             .pivot = state->position[is_first ? (uint32_t)model->next[bond] : bond],
                             .flip = is_first};
  const struct vec3 before = point_difference(q.from, q.pivot), after = point_difference(q.to, q.pivot);
  for (uint32_t m = meetings->first[bond]; m; m = meetings->at[m - 1].next) {
    const struct neighbor *n = &meetings->at[m - 1].with;
    const struct point b = state->position[model->next[n->bond]];
    q.a = point_image(state->position[n->bond], n->image, &model->box);
    if (crossing_far(point_difference(b, state->position[n->bond]), point_difference(q.pivot, q.a), before, after))
      continue;
    q.b = point_image(b, n->image, &model->box);
    if (model->crossing.exclusion == EXCLUSION_PAPER && linked_to_moving(model, t->vertex, n))
      continue;
    struct sweep_event event = {
        t->vertex, bond, (uint32_t)n->bond, {n->image[0], n->image[1], n->image[2]}, {.time = 0.0}, false, 0.0};
    if (crossing_find(&q, &event.hit))
      note_hit(t, event);
  }
}

static struct exchange_end end_of(struct state *state, const struct model *model, uint32_t vertex)
{
  return (struct exchange_end){&state->velocity[vertex], model->inverse_mass[vertex]};
}

/* The first hit takes the place of the move: momentum is exchanged, and the vertex stays. False, with the fault
 * recorded, if memory is short. */
static bool execute(struct state *state, const struct model *model, struct work *work, struct trial *t)
{
  struct sweep_event *e = &t->first;
  uint32_t pivot = e->moving_bond == t->vertex ? (uint32_t)model->next[t->vertex] : e->moving_bond;
  const struct exchange_end moving[2] = {end_of(state, model, t->vertex), end_of(state, model, pivot)};
  const struct exchange_end standing[2] = {end_of(state, model, e->standing_bond),
                                           end_of(state, model, (uint32_t)model->next[e->standing_bond])};
  e->momentum = exchange_momentum(moving, standing, e->hit.s, e->hit.s_standing, e->hit.normal);
  const uint32_t changed[3] = {pivot, e->standing_bond, (uint32_t)model->next[e->standing_bond]};
  for (int k = 0; k < 3; k++)
    if (!turns_reconsider(state, model, work, changed[k], t->dt, work->fiber.rank[t->vertex]))
      return false;
  e->executed = true;
  record(t->log, e);
  state->counts.possible += t->hits;
  state->counts.executed++;
  state->counts.negative += e->momentum < 0.0;
  return true;
}

/* Both bonds against those that they may meet, at the vertex's turn. False, with the fault recorded, if memory is
 * short. */
static bool find_hits(struct state *state, const struct model *model, struct work *work, struct trial *t)
{
  const struct fiber_work *f = &work->fiber;
  const uint32_t i = t->vertex;
  const int32_t before = model->prev[i];
  if (!neighbors_hold(&f->neighbors, i, t->to) && (!neighbors_renew(state, model, work, 1, &i, &t->to) ||
                                                   !turns_look_around(state, model, work, i, t->dt, f->rank[i])))
    return false;
  if (before >= 0)
    test_bond(state, model, &f->meetings, (uint32_t)before, t);
  if (model->next[i] >= 0)
    test_bond(state, model, &f->meetings, i, t);
  return true;
}

/* What is left of the time after the hit, with the velocity after it: one straight move from where the vertex stands to
 * where it would be, made if it crosses nothing. What it might hit is not answered, nor told. */
static bool bounce(struct state *state, const struct model *model, struct work *work, const struct trial *hit,
                   struct vec3 before)
{
  const uint32_t i = hit->vertex;
  const double time = hit->first.hit.time;
  struct trial t = {.vertex = i, .dt = hit->dt};
  const struct vec3 after = vec3_sub(state->velocity[i], model_frame_velocity(model));
  const struct vec3 d = vec3_add_scaled(vec3_scale(time * t.dt, vec3_sub(before, model_frame_velocity(model))),
                                        (1.0 - time) * t.dt, after);
  t.to = point_move(state->position[i], d);
  if (!turns_legal(state, model, work, i, d) || !turns_reconsider(state, model, work, i, t.dt, work->fiber.rank[i]) ||
      !find_hits(state, model, work, &t))
    return false;
  if (t.hits == 0)
    state->position[i] = t.to;
  return true;
}

static bool try_move(struct state *state, const struct model *model, struct work *work, struct trial *t)
{
  const struct vec3 before = state->velocity[t->vertex];
  if (!find_hits(state, model, work, t))
    return false;
  if (t->hits == 0) {
    state->position[t->vertex] = t->to;
    return true;
  }
  return execute(state, model, work, t) &&
         (model->crossing.refusal == REFUSAL_STAY || bounce(state, model, work, t, before));
}

static void draw_order(const struct state *state, const struct model *model, struct fiber_work *f, uint64_t step,
                       uint32_t sweep)
{
  random_permutation(model->seed, RANDOM_VERTEX_ORDER, sweep, step, state->vertices, f->order);
  for (uint32_t k = 0; k < state->vertices; k++)
    f->rank[f->order[k]] = k;
}

/* The frame of the moves has moved, and everything in it: that crosses nothing. */
static void follow_frame(struct state *state, const struct model *model, struct neighbors *nb, double dt)
{
  const struct point origin = {0, 0, 0}, shift = point_move(origin, vec3_scale(dt, model_frame_velocity(model)));
  if (shift.x == 0 && shift.y == 0 && shift.z == 0)
    return;
  for (uint32_t i = 0; i < state->vertices; i++)
    state->position[i] = point_plus(state->position[i], shift);
  nb->moved = point_plus(nb->moved, shift);
}

/* Asks the memory for what a trial move will look at: turns come in random order. */
static void fetch_vertex(const struct state *state, const struct model *model, const struct fiber_work *f, uint32_t i)
{
  __builtin_prefetch(&state->position[i > 0 ? i - 1 : 0], 1);
  __builtin_prefetch(&state->position[i + 1].z, 1);
  __builtin_prefetch(&state->velocity[i]);
  __builtin_prefetch(&f->neighbors.anchor[i]);
  __builtin_prefetch(&model->prev[i]);
  __builtin_prefetch(&model->next[i]);
  __builtin_prefetch(&f->meetings.first[i]);
}

static void fetch_meetings(const struct state *state, const struct model *model, const struct fiber_work *f, uint32_t i)
{
  for (uint32_t bond = i > 0 ? i - 1 : 0; bond <= i; bond++)
    for (uint32_t m = f->meetings.first[bond]; m; m = f->meetings.at[m - 1].next) {
      const int32_t other = f->meetings.at[m - 1].with.bond;
      __builtin_prefetch(&state->position[other]);
      __builtin_prefetch(&state->position[other + 1].z);
      __builtin_prefetch(&model->next[other]);
    }
}

static bool sweep_noncrossing(struct state *state, const struct model *model, struct work *work, double dt,
                              uint64_t step, uint32_t sweep, const struct sweep_log *log)
{
  struct fiber_work *f = &work->fiber;
  if (!f->neighbors.built && !neighbors_build(state, model, work))
    return false;
  draw_order(state, model, f, step, sweep);
  if (!turns_plan(state, model, work, dt))
    return false;
  for (uint32_t k = 0; k < f->queued; k++) {
    if (k + 2 * AHEAD < f->queued)
      fetch_vertex(state, model, f, f->queue[k + 2 * AHEAD]);
    if (k + AHEAD < f->queued)
      fetch_meetings(state, model, f, f->queue[k + AHEAD]);
    struct trial t = {.vertex = f->queue[k], .dt = dt, .log = log};
    if (!turns_trial(state, model, work, t.vertex, dt, &t.to) || !try_move(state, model, work, &t))
      return false;
  }
  f->waited += f->queued;
  state->counts.moves += state->vertices;
  return true;
}

/* In a step vertices come less than 2 (512 + 100) a0 further: two drifts of half an edge, and as far as the frame. So
 * that between two looks they stay below 1.6 LATTICE_REACH. */
#define STEPS_PER_LOOK 1024

/* Nobody may come so far that differences of places overflow. The frame may, but not its part in the anchors. */
static bool look_how_far(const struct state *state, struct work *work, uint64_t step)
{
  struct neighbors *nb = &work->fiber.neighbors;
  const uint32_t lost = state_lost_vertex(state);
  if (!point_within_reach(nb->moved))
    nb->built = false;
  if (lost == state->vertices)
    return true;
  const struct vec3 r = point_in_a0(state->position[lost]);
  return work_fault(work, FAULT_VERTEX_PLACE, step, lost, fmax(fabs(r.x), fmax(fabs(r.y), fabs(r.z))),
                    (double)LATTICE_REACH * LATTICE_UNIT);
}

bool fiber_sweep(struct state *state, const struct model *model, struct work *work, double fraction, uint64_t step,
                 uint32_t sweep, const struct sweep_log *log)
{
  const double dt = fraction * model->time_step;
  const bool noncrossing = model->crossing.forbidden && model->bonds > 1;
  if (step % STEPS_PER_LOOK == 0 && !look_how_far(state, work, step))
    return false;
  if (!(noncrossing ? sweep_noncrossing(state, model, work, dt, step, sweep, log)
                    : turns_crossable(state, model, work, dt)))
    return false;
  follow_frame(state, model, &work->fiber.neighbors, dt);
  return true;
}
