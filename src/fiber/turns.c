#include "fiber/turns.h"

#include <string.h>

#include "fiber/capsule.h"
#include "fiber/neighbors.h"

enum { BLOCK = 64, AHEAD = 16 }; /* vertices, or pairs, whose columns are worked on at a time; bonds */

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

/* Places where a bond may be in what is left of this sweep. */
static struct capsule capsule_now(const struct state *state, const struct model *model, const struct fiber_work *f,
                                  uint32_t bond, struct point origin)
{
  const uint32_t end = (uint32_t)model->next[bond];
  return (struct capsule){point_difference(state->position[bond], origin),
                          point_difference(state->position[end], origin), capsule_most(f->range[bond], f->range[end])};
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
      neighbors_fetch(&work->fiber.neighbors, first + k);
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

/* Pairs of bonds. Their columns, in a0: both bond vectors, from the first end of the one to that of the other, and how
 * far both may go. */
struct pairs {
  uint32_t count;
  uint32_t bond[BLOCK];
  const struct neighbor *partner[BLOCK];
  double p[3][BLOCK], q[3][BLOCK], w[3][BLOCK], mine[BLOCK], its[BLOCK];
};

static void fill_column(const struct state *state, const struct model *model, const struct fiber_work *f,
                        struct pairs *s, uint32_t k)
{
  const struct neighbor *n = s->partner[k];
  const uint32_t i = s->bond[k], j = (uint32_t)model->next[i], l = (uint32_t)n->bond, m = (uint32_t)model->next[l];
  const struct point *at = state->position;
  const struct vec3 p = point_difference(at[j], at[i]), q = point_difference(at[m], at[l]),
                    w = point_difference(point_image(at[l], n->image, &model->box), at[i]);
  s->p[0][k] = p.x, s->p[1][k] = p.y, s->p[2][k] = p.z;
  s->q[0][k] = q.x, s->q[1][k] = q.y, s->q[2][k] = q.z;
  s->w[0][k] = w.x, s->w[1][k] = w.y, s->w[2][k] = w.z;
  s->mine[k] = capsule_most(f->range[i], f->range[j]);
  s->its[k] = capsule_most(f->range[l], f->range[m]);
}

/* As may_meet. */
static void test_columns(const struct pairs *restrict s, int64_t *restrict meet)
{
  for (uint32_t k = 0; k < s->count; k++) {
    const struct vec3 p = {s->p[0][k], s->p[1][k], s->p[2][k]}, w = {s->w[0][k], s->w[1][k], s->w[2][k]},
                      q = {s->q[0][k], s->q[1][k], s->q[2][k]};
    const struct capsule mine = {{0, 0, 0}, p, s->mine[k]}, its = {w, vec3_add(w, q), s->its[k]};
    meet[k] = !capsules_apart(&mine, &its);
  }
}

static void settle_pairs(const struct state *state, const struct model *model, struct fiber_work *f, struct pairs *s)
{
  int64_t meet[BLOCK];
  for (uint32_t k = 0; k < s->count; k++)
    fill_column(state, model, f, s, k);
  test_columns(s, meet);
  for (uint32_t k = 0; k < s->count; k++) {
    const uint32_t i = s->bond[k], l = (uint32_t)s->partner[k]->bond;
    if (meet[k])
      f->waits[i] = f->waits[model->next[i]] = f->waits[l] = f->waits[model->next[l]] = 1;
  }
  s->count = 0;
}

/* Bonds that have partners, into `some`; how many. No branch: there is no telling which do. */
static uint32_t list_bonds(const struct neighbors *nb, uint32_t *some)
{
  uint32_t n = 0;
  for (uint32_t j = 0; j < nb->bonds; j++) {
    some[n] = j;
    n += nb->partners[j].count > 0;
  }
  return n;
}

static void find_meetings(const struct state *state, const struct model *model, struct fiber_work *f)
{
  uint32_t *some = f->queue; /* not yet used */
  const uint32_t bonds = list_bonds(&f->neighbors, some);
  struct pairs s = {.count = 0};
  for (uint32_t j = 0; j < bonds; j++) {
    const struct neighbor_row *row = &f->neighbors.partners[some[j]];
    if (j + AHEAD < bonds)
      __builtin_prefetch(f->neighbors.partners[some[j + AHEAD]].at);
    for (uint32_t k = 0; k < row->count; k++) {
      const uint32_t other = (uint32_t)row->at[k].bond;
      __builtin_prefetch(&state->position[other]);
      __builtin_prefetch(&state->position[other + 1].z);
      __builtin_prefetch(&f->range[other]);
      __builtin_prefetch(&model->next[other]);
      s.bond[s.count] = some[j];
      s.partner[s.count] = &row->at[k];
      s.count += other > some[j]; /* else it is in the other's list, too */
      if (s.count == BLOCK)
        settle_pairs(state, model, f, &s);
    }
  }
  settle_pairs(state, model, f, &s);
}

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
  find_meetings(state, model, f);
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

void turns_reconsider(struct state *state, const struct model *model, struct work *work, uint32_t i, double dt,
                      uint32_t now)
{
  struct fiber_work *f = &work->fiber;
  const struct neighbors *nb = &f->neighbors;
  if (f->rank[i] < now)
    return;
  f->range[i] = fmax(f->range[i], vec3_norm(displacement(state, model, i, dt)));
  const int32_t bonds[2] = {model->prev[i], model->next[i] >= 0 ? (int32_t)i : -1};
  for (int b = 0; b < 2; b++)
    for (uint32_t k = 0; bonds[b] >= 0 && k < nb->partners[bonds[b]].count; k++) {
      const struct neighbor *n = &nb->partners[bonds[b]].at[k];
      if (!may_meet(state, model, f, (uint32_t)bonds[b], n))
        continue;
      const int32_t ends[4] = {bonds[b], model->next[bonds[b]], n->bond, model->next[n->bond]};
      for (int e = 0; e < 4; e++)
        call_back(state, model, f, (uint32_t)ends[e], dt, now);
    }
}
