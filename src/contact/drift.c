#include "contact/drift.h"

#include <math.h>

#include "contact/rule.h"

enum { BLOCK = 64 }; /* vertices worked on at a time */

bool drift_legal(const struct state *state, const struct model *model, uint32_t i, struct vec3 d, struct fault *fault)
{
  const double limit = model_longest_bond(model);
  if (fabs(d.x) < limit && fabs(d.y) < limit && fabs(d.z) < limit)
    return true;
  const double far = fmax(fabs(d.x), fmax(fabs(d.y), fabs(d.z)));
  return fault_record(fault, FAULT_VERTEX_MOVE, state->step + 1, i, far, limit);
}

bool drift_trial(const struct state *state, const struct model *model, uint32_t i, double dt, struct point *to,
                 struct fault *fault)
{
  const struct vec3 d = drift_displacement(state->velocity[i], model_frame_velocity(model), dt);
  if (!drift_legal(state, model, i, d, fault))
    return false;
  *to = point_move(state->position[i], d);
  return true;
}

bool drift_displacements(const struct state *state, const struct model *model, double dt, uint32_t first, uint32_t n,
                         struct vec3 *restrict d, struct fault *fault)
{
  const struct vec3 *restrict v = &state->velocity[first], frame = model_frame_velocity(model);
  const double limit = model_longest_bond(model);
  int64_t beyond = 0;
  for (uint32_t k = 0; k < n; k++) {
    d[k] = drift_displacement(v[k], frame, dt);
    beyond |= !(fabs(d[k].x) < limit) | !(fabs(d[k].y) < limit) | !(fabs(d[k].z) < limit);
  }
  for (uint32_t k = 0; beyond && k < n; k++)
    if (!drift_legal(state, model, first + k, d[k], fault))
      return false;
  return true;
}

/* Moves all vertices to their trial positions. */
static bool drift_free(struct state *state, const struct model *model, struct contact *contact, double dt,
                       uint64_t step, uint32_t drift, const struct contact_log *log, struct fault *fault)
{
  (void)contact, (void)step, (void)drift, (void)log;
  struct vec3 d[BLOCK];
  for (uint32_t first = 0; first < state->vertices; first += BLOCK) {
    const uint32_t n = state->vertices - first < BLOCK ? state->vertices - first : BLOCK;
    if (!drift_displacements(state, model, dt, first, n, d, fault))
      return false;
    struct point *restrict p = &state->position[first];
    for (uint32_t k = 0; k < n; k++)
      p[k] = point_move(p[k], d[k]);
  }
  return true;
}

const struct crossing_rule free_rule = {"free", false, false, drift_free};
