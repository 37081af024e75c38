/*
 * The motion that observables subtract: that of everything together, and the flow that the boundary asks for.
 *
 *   of everything   `flow`, and the acceleration F/M by a net force F, where nothing takes momentum up: in a periodic
 *                   box, and along slip walls. No-slip walls and held vertices take it up; there the background is
 *                   that of the walls, if both have one velocity, else it stands still. A bath has the velocity `flow`.
 *   of the boundary  in a sheared box the rate times the height over the middle.
 */
#ifndef UNCROSS_OBSERVE_BACKGROUND_H
#define UNCROSS_OBSERVE_BACKGROUND_H

#include "system/model.h"
#include "system/state.h"

/* F/M, a0/t0^2; 0 where something takes the momentum up. */
struct vec3 background_acceleration(const struct model *model);

/* Velocity of everything at a time (t0), a0/t0; and displacement between two times, a0. */
struct vec3 background_velocity(const struct model *model, double time);
struct vec3 background_displacement(const struct model *model, double from, double to);

/* The flow at a height y (a0) at the time of a state, a0/t0: of everything, and that of the shear. */
struct vec3 background_flow(const struct model *model, const struct state *state, double y);

/* The same, but between no-slip walls the line between their velocities. */
struct vec3 background_applied(const struct model *model, const struct state *state, double y);

/* True if the flow differs from place to place, other than by the linear profile of a sheared box. */
bool background_differs(const struct model *model);

/* A vertex when collisions act, which is the time at which its velocity is that of kT: at the step; half a step ahead
 * with drift-split. w: its velocity relative to the flow, force: all that acts on it. */
struct vec3 background_peculiar(const struct model *model, const struct state *state, uint32_t vertex,
                                struct vec3 force,
                                struct vec3 (*flow)(const struct model *, const struct state *, double y));

/* Half of the time step by which velocities are ahead of that time, t0. */
double background_ahead(const struct model *model);

#endif
