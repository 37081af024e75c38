/* Displacements of vertices in a drift (Padding 2009, Eq. (4)), before any test for crossings. */
#ifndef UNCROSS_CONTACT_DRIFT_H
#define UNCROSS_CONTACT_DRIFT_H

#include "system/fault.h"
#include "system/model.h"
#include "system/state.h"

/* Displacement (a0) of a vertex of this velocity in a time dt, in a frame that moves with velocity `frame`. */
static inline struct vec3 drift_displacement(struct vec3 velocity, struct vec3 frame, double dt)
{
  return vec3_scale(dt, vec3_sub(velocity, frame));
}

/* True if vertex i may move by d in one drift. False, with the fault recorded, if a component of d is half the shortest
 * edge or more, or not a number. */
bool drift_legal(const struct state *state, const struct model *model, uint32_t i, struct vec3 d, struct fault *fault);

/* The trial position of vertex i after a time dt, in the frame of the moves. False as drift_legal. */
bool drift_trial(const struct state *state, const struct model *model, uint32_t i, double dt, struct point *to,
                 struct fault *fault);

/* Displacements of vertices first .. first + n - 1 in a time dt: d[n], a0. False as drift_legal. */
bool drift_displacements(const struct state *state, const struct model *model, double dt, uint32_t first, uint32_t n,
                         struct vec3 *restrict d, struct fault *fault);

#endif
