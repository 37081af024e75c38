#include "fiber/turns.h"

#include <string.h>

#include "fiber/capsule.h"
#include "fiber/meetings.h"
#include "fiber/neighbors.h"

enum { BLOCK = 64 }; /* vertices worked on at a time */

/* How far a vertex goes in a time dt, in the frame of the moves. */
static inline struct vec3 displacement(struct vec3 velocity, struct vec3 frame, double dt)
{
  return vec3_scale(dt, vec3_sub(velocity, frame));
}

bool turns_legal(const struct state *state, const struct model *model, struct work *work, uint32_t i, struct vec3 d)
{
  const double limit = 0.5 * box_shortest_edge(&model->box);
  if (fabs(d.x) < limit && fabs(d.y) < limit && fabs(d.z) < limit)
    return true;
  const double far = fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z)));
  return work_fault(work, FAULT_VERTEX_MOVE, state->step + 1, i, far, limit);
}

bool turns_trial(const struct state *state, const struct model *model, struct work *work, uint32_t i, double dt,
                 struct point *to)
{
  const struct vec3 d = displacement(state->velocity[i], model_frame_velocity(model), dt);
  if (!turns_legal(state, model, work, i, d))
    return false;
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
    d[k] = displacement(v[k], frame, dt);
    beyond |= !(fabs(d[k].x) < limit) | !(fabs(d[k].y) < limit) | !(fabs(d[k].z) < limit);
  }
  for (uint32_t k = 0; beyond && k < n; k++)
    if (!turns_legal(state, model, work, first + k, d[k]))
      return false;
  return true;
}

bool turns_crossable(struct state *state, const struct model *model, struct work *work, double dt)
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
    const struct vec3 off = point_difference(point_move(p[k], d[k]), point_plus(anchor[k].at, moved));
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
    p[i] = point_move(p[i], displacement(v[i], frame, time));
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

/* Has the vertex moved before its turn, which is yet to come after that of rank `now`? */
static bool moved_early(const struct fiber_work *f, uint32_t i, uint32_t now)
{
  return !f->waits[i] && f->rank[i] > now;
}

/* Where the vertex was before it moved early, or is, if it has not. Its velocity is still that of its move: nobody hits
 * a bond that is in no meeting, and the ends of those that are in one wait, or have been called back. */
static struct point standing_place(const struct state *state, const struct model *model, const struct fiber_work *f,
                                   uint32_t i, double dt, uint32_t now)
{
  const struct vec3 back = displacement(state->velocity[i], model_frame_velocity(model), -dt);
  return moved_early(f, i, now) ? point_move(state->position[i], back) : state->position[i];
}

/* A vertex that has moved before its turn goes back and waits for it. */
static void call_back(struct state *state, const struct model *model, struct fiber_work *f, uint32_t i, double dt,
                      uint32_t now)
{
  if (!moved_early(f, i, now))
    return;
  state->position[i] = standing_place(state, model, f, i, dt, now);
  f->waits[i] = 1;
  join_queue(f, i);
  f->called_back++;
}

/* Where a bond stands for what is left of this sweep; its ends may go as far as meetings_range from there. */
struct standing_bond {
  struct point end[2];
  double range;
};

static struct standing_bond standing_bond(const struct state *state, const struct model *model,
                                          const struct fiber_work *f, uint32_t bond, double dt, uint32_t now)
{
  const uint32_t end = (uint32_t)model->next[bond];
  return (struct standing_bond){
      {standing_place(state, model, f, bond, dt, now), standing_place(state, model, f, end, dt, now)},
      meetings_range(model, f, bond)};
}

static bool may_meet(const struct standing_bond *mine, const struct standing_bond *its, const int32_t image[3],
                     const struct box *box)
{
  const struct point origin = mine->end[0];
  const struct capsule c = {{0, 0, 0}, point_difference(mine->end[1], origin), mine->range};
  const struct capsule d = {point_difference(point_image(its->end[0], image, box), origin),
                            point_difference(point_image(its->end[1], image, box), origin), its->range};
  return !capsules_apart(&c, &d);
}

/* Who bond `bond` may meet now, and did not: none of the ends may have moved before its turn. */
static bool look_around_bond(struct state *state, const struct model *model, struct work *work, uint32_t bond,
                             double dt, uint32_t now)
{
  struct fiber_work *f = &work->fiber;
  struct neighbor_list *near = &f->near;
  const struct standing_bond mine = standing_bond(state, model, f, bond, dt, now);
  if (!neighbors_near(state, model, work, bond, mine.end, mine.range, near))
    return false;
  for (uint32_t k = 0; k < near->count; k++) {
    const struct neighbor *n = &near->at[k];
    const struct standing_bond its = standing_bond(state, model, f, (uint32_t)n->bond, dt, now);
    if (!may_meet(&mine, &its, n->image, &model->box))
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
  const double furthest = box_shortest_edge(&model->box); /* no legal move is longer: who tries ends the run */
  const double range = fmin(vec3_norm(displacement(state->velocity[i], model_frame_velocity(model), dt)), furthest);
  if (f->rank[i] < now || range <= f->range[i])
    return true;
  meetings_widen(model, f, i, range);
  return turns_look_around(state, model, work, i, dt, now);
}
