#include "fiber/sweep.h"

#include "base/random.h"
#include "fiber/exchange.h"
#include "fiber/neighbors.h"

/* How many vertices ahead their data are asked for: the order is known, memory is slow. */
#define PREFETCH_FAR 16
#define PREFETCH_NEAR 8

/* One trial move: vertex i from its place to `to`. */
struct trial {
  uint32_t vertex;
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

static bool apart(int64_t a0, int64_t a1, int64_t b0, int64_t b1, int64_t b2)
{
  int64_t low = b0 < b1 ? b0 : b1, high = b0 < b1 ? b1 : b0;
  low = b2 < low ? b2 : low;
  high = b2 > high ? b2 : high;
  return (a0 < low && a1 < low) || (a0 > high && a1 > high);
}

/* The box around the standing bond and the box around the swept triangle do not overlap. */
static bool boxes_apart(const struct crossing_query *q)
{
  return apart(q->a.x, q->b.x, q->pivot.x, q->from.x, q->to.x) ||
         apart(q->a.y, q->b.y, q->pivot.y, q->from.y, q->to.y) || apart(q->a.z, q->b.z, q->pivot.z, q->from.z, q->to.z);
}

/* All hits of one of the two bonds of the moving vertex. */
static void test_bond(const struct state *state, const struct model *model, const struct neighbors *nb, uint32_t bond,
                      struct trial *t)
{
  const struct neighbor *list = &nb->list[(size_t)bond * nb->stride];
  const bool is_first = bond == t->vertex;
  struct crossing_query q = {.from = state->position[t->vertex],
                             .to = t->to,
                             .pivot = state->position[is_first ? (uint32_t)model->next[bond] : bond],
                             .flip = is_first};
  for (uint32_t k = 0; k < nb->count[bond]; k++) {
    const struct neighbor *n = &list[k];
    q.a = point_image(state->position[n->bond], n->image, &model->box);
    q.b = point_image(state->position[model->next[n->bond]], n->image, &model->box);
    if (boxes_apart(&q))
      continue;
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

/* The first hit takes the place of the move: momentum is exchanged, and the vertex stays. */
static void execute(struct state *state, const struct model *model, struct trial *t)
{
  struct sweep_event *e = &t->first;
  uint32_t pivot = e->moving_bond == t->vertex ? (uint32_t)model->next[t->vertex] : e->moving_bond;
  const struct exchange_end moving[2] = {end_of(state, model, t->vertex), end_of(state, model, pivot)};
  const struct exchange_end standing[2] = {end_of(state, model, e->standing_bond),
                                           end_of(state, model, (uint32_t)model->next[e->standing_bond])};
  e->momentum = exchange_momentum(moving, standing, e->hit.s, e->hit.s_standing, e->hit.normal);
  e->executed = true;
  record(t->log, e);
  state->counts.possible += t->hits;
  state->counts.executed++;
  state->counts.negative += e->momentum < 0.0;
}

static bool try_move(struct state *state, const struct model *model, struct work *work, struct trial *t)
{
  const struct neighbors *nb = &work->fiber.neighbors;
  const uint32_t i = t->vertex;
  const int32_t before = model->prev[i];
  const bool has_after = model->next[i] >= 0;
  if (before >= 0) {
    if (!neighbors_cover(state, model, work, (uint32_t)before, t->to))
      return false;
    if (nb->count[before] > 0)
      test_bond(state, model, nb, (uint32_t)before, t);
  }
  if (has_after) {
    if (!neighbors_cover(state, model, work, i, t->to))
      return false;
    if (nb->count[i] > 0)
      test_bond(state, model, nb, i, t);
  }
  if (t->hits == 0)
    state->position[i] = t->to;
  else
    execute(state, model, t);
  return true;
}

/* Padding 2009, Eq. (4): where vertex i wants to go. False if that is too far, or not a number. */
static bool trial_point(const struct state *state, const struct model *model, struct work *work, uint32_t i, double dt,
                        struct point *to)
{
  struct vec3 d = vec3_scale(dt, state->velocity[i]);
  double far = fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z)));
  const double limit = 0.5 * box_shortest_edge(&model->box);
  if (!(fabs(d.x) < limit && fabs(d.y) < limit && fabs(d.z) < limit))
    return work_fault(work, FAULT_VERTEX_MOVE, state->step + 1, i, far, limit);
  *to = point_move(state->position[i], d);
  return true;
}

/* A sweep in random order waits for memory more than it computes. The order is known, so the data of a vertex are asked
 * for in time: first what its own bonds hold, and, when that has arrived, the places of their partners. */
static void prefetch_own(const struct state *state, const struct model *model, const struct neighbors *nb, uint32_t v)
{
  __builtin_prefetch(&state->position[v]);
  __builtin_prefetch(&state->velocity[v]);
  const uint32_t bond[2] = {v, v > 0 ? v - 1 : v};
  for (int k = 0; k < 2; k++) {
    __builtin_prefetch(&nb->box[bond[k]]);
    __builtin_prefetch(&nb->count[bond[k]]);
    __builtin_prefetch(&nb->list[(size_t)bond[k] * nb->stride]);
  }
  __builtin_prefetch(&model->next[v]);
}

static void prefetch_partners(const struct state *state, const struct neighbors *nb, uint32_t v)
{
  for (uint32_t bond = v > 0 ? v - 1 : v; bond <= v; bond++)
    for (uint32_t k = 0; k < nb->count[bond]; k++)
      __builtin_prefetch(&state->position[nb->list[(size_t)bond * nb->stride + k].bond]);
}

static void prefetch_ahead(const struct state *state, const struct model *model, const struct neighbors *nb,
                           const uint32_t *order, uint32_t k, uint32_t n)
{
  if (k + PREFETCH_FAR < n)
    prefetch_own(state, model, nb, order[k + PREFETCH_FAR]);
  if (k + PREFETCH_NEAR < n)
    prefetch_partners(state, nb, order[k + PREFETCH_NEAR]);
}

static bool sweep_noncrossing(struct state *state, const struct model *model, struct work *work, double dt,
                              uint64_t step, uint32_t sweep, const struct sweep_log *log)
{
  if (!work->fiber.neighbors.built && !neighbors_build(state, model, work))
    return false;
  const uint32_t *order = work->fiber.order;
  random_permutation(model->seed, RANDOM_VERTEX_ORDER, sweep, step, state->vertices, work->fiber.order);
  for (uint32_t k = 0; k < state->vertices; k++) {
    prefetch_ahead(state, model, &work->fiber.neighbors, order, k, state->vertices);
    struct trial t = {.vertex = order[k], .log = log};
    if (!trial_point(state, model, work, t.vertex, dt, &t.to) || !try_move(state, model, work, &t))
      return false;
  }
  state->counts.moves += state->vertices;
  return true;
}

static bool sweep_phantom(struct state *state, const struct model *model, struct work *work, double dt)
{
  for (uint32_t i = 0; i < state->vertices; i++)
    if (!trial_point(state, model, work, i, dt, &state->position[i]))
      return false;
  return true;
}

bool fiber_sweep(struct state *state, const struct model *model, struct work *work, double fraction, uint64_t step,
                 uint32_t sweep, const struct sweep_log *log)
{
  const double dt = fraction * model->time_step;
  if (model->crossing.forbidden && model->bonds > 1)
    return sweep_noncrossing(state, model, work, dt, step, sweep, log);
  return sweep_phantom(state, model, work, dt);
}
