#include "fiber/turns.h"

#include <string.h>

#include "base/memory.h"
#include "fiber/capsule.h"
#include "fiber/neighbors.h"

enum { BLOCK = 64, PAIRS = 256 }; /* vertices, and pairs, worked on at a time */

/* How far turns_trial goes. */
static struct vec3 displacement(const struct state *state, const struct model *model, uint32_t i, double dt)
{
  return vec3_scale(dt, vec3_sub(state->velocity[i], model_frame_velocity(model)));
}

bool turns_trial(const struct state *state, const struct model *model, struct work *work, uint32_t i, double dt,
                 struct point *to)
{
  const struct vec3 d = displacement(state, model, i, dt);
  const double limit = 0.5 * box_shortest_edge(&model->box);
  if (!(fabs(d.x) < limit && fabs(d.y) < limit && fabs(d.z) < limit)) {
    const double far = fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z)));
    return work_fault(work, FAULT_VERTEX_MOVE, state->step + 1, i, far, limit);
  }
  *to = point_move(state->position[i], d);
  return true;
}

/* How far an end of a bond may go in this sweep. */
static double bond_range(const struct model *model, const struct fiber_work *f, uint32_t bond)
{
  return capsule_most(f->range[bond], f->range[model->next[bond]]);
}

/* Places where a bond may be in what is left of this sweep. */
static struct capsule capsule_now(const struct state *state, const struct model *model, const struct fiber_work *f,
                                  uint32_t bond, struct point origin)
{
  const uint32_t end = (uint32_t)model->next[bond];
  return (struct capsule){point_difference(state->position[bond], origin),
                          point_difference(state->position[end], origin), bond_range(model, f, bond)};
}

static bool may_meet(const struct state *state, const struct model *model, const struct fiber_work *f, uint32_t bond,
                     const struct neighbor *n)
{
  const struct point origin = state->position[bond];
  const int32_t back[3] = {-n->image[0], -n->image[1], -n->image[2]};
  const struct capsule mine = capsule_now(state, model, f, bond, origin),
                       its = capsule_now(state, model, f, (uint32_t)n->bond, point_image(origin, back, &model->box));
  return !capsules_apart(&mine, &its);
}

/* Displacements of vertices first .. first + n - 1, as turns_trial has them. */
static bool displacements(const struct state *state, const struct model *model, struct work *work, double dt,
                          uint32_t first, uint32_t n, struct vec3 *restrict d)
{
  const struct vec3 *restrict v = &state->velocity[first], frame = model_frame_velocity(model);
  const double limit = 0.5 * box_shortest_edge(&model->box);
  int64_t beyond = 0;
  for (uint32_t k = 0; k < n; k++) {
    d[k] = vec3_scale(dt, vec3_sub(v[k], frame));
    beyond |= !(fabs(d[k].x) < limit) | !(fabs(d[k].y) < limit) | !(fabs(d[k].z) < limit);
  }
  struct point to;
  for (uint32_t k = 0; beyond && k < n; k++)
    if (!turns_trial(state, model, work, first + k, dt, &to))
      return false;
  return true;
}

bool turns_phantom(struct state *state, const struct model *model, struct work *work, double dt)
{
  struct vec3 d[BLOCK];
  for (uint32_t first = 0; first < state->vertices; first += BLOCK) {
    const uint32_t n = state->vertices - first < BLOCK ? state->vertices - first : BLOCK;
    if (!displacements(state, model, work, dt, first, n, d))
      return false;
    struct point *restrict p = &state->position[first];
    for (uint32_t k = 0; k < n; k++)
      p[k] = point_move(p[k], d[k]);
  }
  return true;
}

/* late[k]: vertex first + k is about to leave its anchor, as neighbors_hold has it. */
static void find_late(const struct state *state, const struct neighbors *nb, uint32_t first, uint32_t n,
                      const struct vec3 *restrict d, int64_t *restrict late)
{
  const struct point *restrict p = &state->position[first], moved = nb->moved;
  const struct anchor *restrict anchor = &nb->anchor[first];
  for (uint32_t k = 0; k < n; k++) {
    const struct point at = anchor[k].at, to = point_move(p[k], d[k]);
    const struct vec3 off = point_difference(to, (struct point){at.x + moved.x, at.y + moved.y, at.z + moved.z});
    late[k] = !(vec3_dot(off, off) <= anchor[k].reach * anchor[k].reach);
  }
}

/* Ranges of all vertices, and new anchors for those that are about to leave theirs. */
static bool prepare(const struct state *state, const struct model *model, struct work *work, double dt)
{
  struct vec3 d[BLOCK];
  int64_t late[BLOCK];
  uint32_t vertex[NEIGHBORS_AT_ONCE], count = 0;
  struct point to[NEIGHBORS_AT_ONCE];
  for (uint32_t first = 0; first < state->vertices; first += BLOCK) {
    const uint32_t n = state->vertices - first < BLOCK ? state->vertices - first : BLOCK;
    if (!displacements(state, model, work, dt, first, n, d))
      return false;
    double *restrict range = &work->fiber.range[first];
    for (uint32_t k = 0; k < n; k++)
      range[k] = vec3_norm(d[k]);
    find_late(state, &work->fiber.neighbors, first, n, d, late);
    for (uint32_t k = 0; k < n; k++) {
      if (!late[k])
        continue;
      vertex[count] = first + k;
      to[count++] = point_move(state->position[first + k], d[k]);
      if (count == NEIGHBORS_AT_ONCE) {
        if (!neighbors_renew(state, model, work, count, vertex, to))
          return false;
        count = 0;
      }
    }
  }
  return count == 0 || neighbors_renew(state, model, work, count, vertex, to);
}

/* --- paths: how long a pair need not be looked at ---------------------------------------------------------------- */

/* A way in units of a path, rounded up. What is beyond 64 a0 does not matter: no pair waits for more than 32, and no
 * two paths grow by half of 2^32 units, 4096 a0, before they are looked at. */
static inline uint32_t path_units(double way)
{
  return (uint32_t)(int32_t)(capsule_least(way, 64.0) * 0x1p20) + 1;
}

/* All paths, longer by this sweep. */
static void lengthen_paths(const struct model *model, struct fiber_work *f)
{
  const double *restrict range = f->range;
  const int32_t *restrict next = model->next;
  struct bond_clock *restrict clock = f->neighbors.clock;
  for (uint32_t j = 0; j < f->neighbors.bonds; j++)
    clock[j].path += path_units(capsule_most(range[j], range[next[j] < 0 ? (int32_t)j : next[j]]));
}

/* Pairs first .. first + n - 1 whose paths are longer than their limits; how many. */
static uint32_t list_due(const struct neighbors *nb, uint32_t first, uint32_t n, uint32_t *restrict due)
{
  const uint32_t *restrict bond = &nb->pairs.bond[first], *restrict other = &nb->pairs.other[first],
                           *restrict limit = &nb->pairs.limit[first];
  const struct bond_clock *restrict clock = nb->clock;
  uint32_t left[PAIRS], count = 0;
  for (uint32_t k = 0; k < n; k++)
    left[k] = limit[k] - clock[bond[k]].path - clock[other[k]].path;
  for (uint32_t k = 0; k < n; k++) {
    due[count] = first + k;
    count += left[k] >> 31; /* less than 0 */
  }
  return count;
}

/* Pairs that are due. Their columns, in a0: both bond vectors, from the first end of the one to that of the other; and
 * their paths before this sweep. */
struct columns {
  uint32_t count;
  uint32_t pair[PAIRS];
  uint32_t path[PAIRS];
  double p[3][PAIRS], q[3][PAIRS], w[3][PAIRS];
};

static void fill_column(const struct state *state, const struct model *model, const struct fiber_work *f, uint32_t pair,
                        struct columns *s)
{
  const struct pair_list *list = &f->neighbors.pairs;
  const struct bond_clock *clock = f->neighbors.clock;
  const uint32_t k = s->count++, i = list->bond[pair], j = (uint32_t)model->next[i], l = list->other[pair],
                 m = (uint32_t)model->next[l];
  const struct point *at = state->position;
  const struct vec3 p = point_difference(at[j], at[i]), q = point_difference(at[m], at[l]),
                    w = point_difference(point_image(at[l], list->image[pair].k, &model->box), at[i]);
  s->pair[k] = pair;
  s->path[k] =
      clock[i].path - path_units(bond_range(model, f, i)) + clock[l].path - path_units(bond_range(model, f, l));
  s->p[0][k] = p.x, s->p[1][k] = p.y, s->p[2][k] = p.z;
  s->q[0][k] = q.x, s->q[1][k] = q.y, s->q[2][k] = q.z;
  s->w[0][k] = w.x, s->w[1][k] = w.y, s->w[2][k] = w.z;
}

/* How long the two paths of each pair may get until the bonds touch: their distance longer than before this sweep. */
static void limit_columns(const struct columns *restrict s, uint32_t *restrict limit)
{
  for (uint32_t k = 0; k < s->count; k++) {
    const struct vec3 p = {s->p[0][k], s->p[1][k], s->p[2][k]}, q = {s->q[0][k], s->q[1][k], s->q[2][k]},
                      w = {s->w[0][k], s->w[1][k], s->w[2][k]};
    const double apart = capsule_most(capsule_distance(p, q, w) - CAPSULE_SLACK, 0.0);
    limit[k] = s->path[k] + (uint32_t)(int32_t)(capsule_least(apart, 32.0) * 0x1p20);
  }
}

/* --- meetings: who may touch whom in this sweep ------------------------------------------------------------------- */

static bool add_meeting(const struct state *state, struct work *work, uint32_t bond, struct neighbor n)
{
  struct meeting_list *list = &work->fiber.meetings;
  if (list->count == list->room) {
    const uint32_t room = list->room ? 2 * list->room : 1024;
    if (!memory_grow((void **)&list->at, room, sizeof *list->at))
      return work_fault(work, FAULT_NO_MEMORY, state->step + 1, bond, 0.0, 0.0);
    list->room = room;
  }
  list->at[list->count] = (struct meeting){bond, n, list->first[bond]};
  list->first[bond] = ++list->count;
  return true;
}

/* Bond `bond` and the image of the other one, as both have it. */
static bool add_meetings(const struct state *state, struct work *work, uint32_t bond, const struct neighbor *n)
{
  const struct neighbor back = {(int32_t)bond, {-n->image[0], -n->image[1], -n->image[2]}};
  return add_meeting(state, work, bond, *n) && add_meeting(state, work, (uint32_t)n->bond, back);
}

static bool meets(const struct meeting_list *list, uint32_t bond, const struct neighbor *n)
{
  for (uint32_t m = list->first[bond]; m; m = list->at[m - 1].next)
    if (memcmp(&list->at[m - 1].with, n, sizeof *n) == 0)
      return true;
  return false;
}

static void forget_meetings(struct meeting_list *list)
{
  for (uint32_t m = 0; m < list->count; m++)
    list->first[list->at[m].bond] = 0;
  list->count = 0;
}

/* Pairs that may touch in this sweep meet; the others say when they are next due. */
static bool settle_columns(const struct state *state, const struct model *model, struct work *work,
                           const struct columns *s)
{
  struct fiber_work *f = &work->fiber;
  struct pair_list *list = &f->neighbors.pairs;
  uint32_t limit[PAIRS];
  limit_columns(s, limit);
  for (uint32_t k = 0; k < s->count; k++) {
    const uint32_t pair = s->pair[k], i = list->bond[pair], l = list->other[pair];
    list->limit[pair] = limit[k];
    if ((limit[k] - f->neighbors.clock[i].path - f->neighbors.clock[l].path) >> 31 == 0)
      continue;
    const int32_t *image = list->image[pair].k;
    const struct neighbor n = {(int32_t)l, {image[0], image[1], image[2]}};
    if (!add_meetings(state, work, i, &n))
      return false;
    f->waits[i] = f->waits[model->next[i]] = f->waits[l] = f->waits[model->next[l]] = 1;
  }
  return true;
}

static void fetch_due(const struct state *state, const struct model *model, const struct fiber_work *f, uint32_t pair)
{
  const uint32_t bonds[2] = {f->neighbors.pairs.bond[pair], f->neighbors.pairs.other[pair]};
  for (int b = 0; b < 2; b++) {
    __builtin_prefetch(&state->position[bonds[b]]);
    __builtin_prefetch(&state->position[bonds[b] + 1].z);
    __builtin_prefetch(&f->range[bonds[b]]);
    __builtin_prefetch(&model->next[bonds[b]]);
  }
  __builtin_prefetch(&f->neighbors.pairs.image[pair]);
}

/* One of the pairs that are due, or what has come to its place. */
static void look_at_pair(const struct state *state, const struct model *model, struct fiber_work *f, uint32_t pair,
                         struct columns *s)
{
  struct neighbors *nb = &f->neighbors;
  while (pair < nb->pairs.count && neighbors_out_of_date(nb, pair))
    neighbors_drop_pair(nb, pair);
  if (pair < nb->pairs.count)
    fill_column(state, model, f, pair, s);
}

/* The next pairs that are due, from number `first` on; memory is asked for what they will need. */
static uint32_t next_due(const struct state *state, const struct model *model, const struct fiber_work *f,
                         uint32_t first, uint32_t *due)
{
  const uint32_t end = f->neighbors.pairs.count, left = first < end ? end - first : 0;
  const uint32_t count = list_due(&f->neighbors, first, left < PAIRS ? left : PAIRS, due);
  for (uint32_t k = 0; k < count; k++)
    fetch_due(state, model, f, due[k]);
  return count;
}

static bool find_meetings(const struct state *state, const struct model *model, struct work *work)
{
  struct fiber_work *f = &work->fiber;
  uint32_t due[2][PAIRS] = {{0}}, count[2], now = 0;
  struct columns s;
  forget_meetings(&f->meetings);
  count[0] = next_due(state, model, f, 0, due[0]);
  for (uint32_t first = 0; first < f->neighbors.pairs.count; first += PAIRS, now = !now) {
    count[!now] = next_due(state, model, f, first + PAIRS, due[!now]);
    s.count = 0;
    for (uint32_t k = 0; k < count[now]; k++)
      look_at_pair(state, model, f, due[now][k], &s);
    if (!settle_columns(state, model, work, &s))
      return false;
  }
  return true;
}

/* --- the plan ---------------------------------------------------------------------------------------------------- */

/* The vertices that wait, in the order of their turns. */
static void queue_up(const struct state *state, struct fiber_work *f)
{
  uint32_t n = 0;
  for (uint32_t k = 0; k < state->vertices; k++) {
    const uint32_t i = f->order[k];
    f->queue[n] = i;
    n += f->waits[i];
  }
  f->queued = n;
}

/* Vertex i has its turn later than the one at hand. */
static void join_queue(struct fiber_work *f, uint32_t i)
{
  uint32_t k = f->queued++;
  for (; f->rank[f->queue[k - 1]] > f->rank[i]; k--)
    f->queue[k] = f->queue[k - 1];
  f->queue[k] = i;
}

/* Everybody who need not wait. */
static void move_others(struct state *state, const struct model *model, const struct fiber_work *f, double dt)
{
  const struct vec3 *restrict v = state->velocity, frame = model_frame_velocity(model);
  struct point *restrict p = state->position;
  for (uint32_t i = 0; i < state->vertices; i++) {
    const double time = f->waits[i] ? 0.0 : dt;
    p[i] = point_move(p[i], vec3_scale(time, vec3_sub(v[i], frame)));
  }
}

bool turns_plan(struct state *state, const struct model *model, struct work *work, double dt)
{
  struct fiber_work *f = &work->fiber;
  if (!prepare(state, model, work, dt))
    return false;
  memset(f->waits, 0, state->vertices);
  lengthen_paths(model, f);
  if (!find_meetings(state, model, work))
    return false;
  queue_up(state, f);
  move_others(state, model, f, dt);
  return true;
}

/* A vertex that has moved before its turn goes back and waits for it. */
static void call_back(struct state *state, const struct model *model, struct fiber_work *f, uint32_t i, double dt,
                      uint32_t now)
{
  if (f->waits[i] || f->rank[i] <= now)
    return;
  state->position[i] = point_move(state->position[i], displacement(state, model, i, -dt));
  f->waits[i] = 1;
  join_queue(f, i);
  f->called_back++;
}

/* Who bond `bond` may meet now, and did not: none of the ends may have moved before its turn. */
static bool look_around_bond(struct state *state, const struct model *model, struct work *work, uint32_t bond,
                             double dt, uint32_t now)
{
  struct fiber_work *f = &work->fiber;
  struct neighbor_list *near = &f->near;
  if (!neighbors_near(state, model, work, bond, bond_range(model, f, bond), near))
    return false;
  for (uint32_t k = 0; k < near->count; k++) {
    const struct neighbor *n = &near->at[k];
    if (!may_meet(state, model, f, bond, n))
      continue;
    if (!meets(&f->meetings, bond, n) && !add_meetings(state, work, bond, n))
      return false;
    const int32_t ends[4] = {(int32_t)bond, model->next[bond], n->bond, model->next[n->bond]};
    for (int e = 0; e < 4; e++)
      call_back(state, model, f, (uint32_t)ends[e], dt, now);
  }
  return true;
}

bool turns_look_around(struct state *state, const struct model *model, struct work *work, uint32_t i, double dt,
                       uint32_t now)
{
  const int32_t bonds[2] = {model->prev[i], model->next[i] >= 0 ? (int32_t)i : -1};
  for (int b = 0; b < 2; b++)
    if (bonds[b] >= 0 && !look_around_bond(state, model, work, (uint32_t)bonds[b], dt, now))
      return false;
  return true;
}

/* Vertex i goes further than was planned, and so do its bonds' paths. */
static void widen_range(const struct model *model, struct fiber_work *f, uint32_t i, double range)
{
  const int32_t bonds[2] = {model->prev[i], model->next[i] >= 0 ? (int32_t)i : -1};
  for (int b = 0; b < 2; b++)
    if (bonds[b] >= 0)
      f->neighbors.clock[bonds[b]].path -= path_units(bond_range(model, f, (uint32_t)bonds[b]));
  f->range[i] = range;
  for (int b = 0; b < 2; b++)
    if (bonds[b] >= 0)
      f->neighbors.clock[bonds[b]].path += path_units(bond_range(model, f, (uint32_t)bonds[b]));
}

bool turns_reconsider(struct state *state, const struct model *model, struct work *work, uint32_t i, double dt,
                      uint32_t now)
{
  struct fiber_work *f = &work->fiber;
  const double range = vec3_norm(displacement(state, model, i, dt));
  if (f->rank[i] < now || range <= f->range[i])
    return true;
  widen_range(model, f, i, range);
  return turns_look_around(state, model, work, i, dt, now);
}
