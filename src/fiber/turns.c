#include "fiber/turns.h"

#include <string.h>

#include "fiber/capsule.h"
#include "fiber/neighbors.h"

#define AHEAD 16 /* bonds */

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

static void find_meetings(const struct state *state, const struct model *model, struct fiber_work *f)
{
  const struct neighbor_row *partners = f->neighbors.partners;
  for (uint32_t j = 0; j < state->vertices; j++) {
    if (j + AHEAD < state->vertices)
      __builtin_prefetch(partners[j + AHEAD].at); /* rows lie all over memory */
    for (uint32_t k = 0; k < partners[j].count; k++) {
      const struct neighbor *n = &partners[j].at[k];
      if (n->bond > (int32_t)j && may_meet(state, model, f, j, n))
        f->waits[j] = f->waits[model->next[j]] = f->waits[n->bond] = f->waits[model->next[n->bond]] = 1;
    }
  }
}

bool turns_plan(struct state *state, const struct model *model, struct work *work, double dt)
{
  struct fiber_work *f = &work->fiber;
  for (uint32_t i = 0; i < state->vertices; i++) {
    struct point to = state->position[i];
    if (!turns_trial(state, model, work, i, dt, &to))
      return false;
    f->range[i] = vec3_norm(displacement(state, model, i, dt));
    if (!neighbors_hold(&f->neighbors, i, to) && !neighbors_renew(state, model, work, i, to))
      return false;
  }
  memset(f->waits, 0, state->vertices);
  find_meetings(state, model, f);
  for (uint32_t i = 0; i < state->vertices; i++)
    if (!f->waits[i])
      state->position[i] = point_move(state->position[i], displacement(state, model, i, dt));
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
