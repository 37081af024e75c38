#include "fiber/turns.h"

#include <string.h>

#include "fiber/meetings.h"
#include "fiber/neighbors.h"

enum { BLOCK = 64 }; /* vertices worked on at a time */

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
  if (!meetings_find(state, model, work))
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
  if (!neighbors_near(state, model, work, bond, meetings_range(model, f, bond), near))
    return false;
  for (uint32_t k = 0; k < near->count; k++) {
    const struct neighbor *n = &near->at[k];
    if (!meetings_possible(state, model, f, bond, n))
      continue;
    if (!meetings_add(state, work, bond, n))
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
  uint32_t bond[2];
  const int bonds = model_bonds_of(model, i, bond);
  for (int b = 0; b < bonds; b++)
    if (!look_around_bond(state, model, work, bond[b], dt, now))
      return false;
  return true;
}

bool turns_reconsider(struct state *state, const struct model *model, struct work *work, uint32_t i, double dt,
                      uint32_t now)
{
  struct fiber_work *f = &work->fiber;
  const double range = vec3_norm(displacement(state, model, i, dt));
  if (f->rank[i] < now || range <= f->range[i])
    return true;
  meetings_widen(model, f, i, range);
  return turns_look_around(state, model, work, i, dt, now);
}
