/* The solvent between collisions (Padding 2009, Sec. III, step 2). */
#ifndef UNCROSS_FLUID_FLUID_H
#define UNCROSS_FLUID_FLUID_H

#include "system/fluid.h"

/* Independent particles. */
extern const struct fluid fluid_points;

/* Pairs of particles with a spring, and independent ones. */
extern const struct fluid fluid_dumbbells;

enum fluid_kind { FLUID_POINTS, FLUID_DUMBBELLS, FLUIDS };

/* The fluid of this kind. */
const struct fluid *fluid_row(enum fluid_kind kind);

/* The fluid of a model. */
const struct fluid *fluid_of(const struct model *model);

/* Where a particle begins: uniform in the box, in each attempt another place. */
struct point fluid_start_place(const struct model *model, uint32_t id, uint32_t attempt);

/* Streams all particles, and sets the lag to 0. False as `stream` of struct fluid. */
bool fluid_stream(struct state *state, const struct model *model, struct fault *fault);

/* Position and velocity now of the particle at place i of memory, as `now` of struct fluid. */
struct point fluid_position_now(const struct state *state, const struct model *model, uint32_t i);
struct vec3 fluid_velocity_now(const struct state *state, const struct model *model, uint32_t i);

/* The vector of the dumbbell at place p of the list, now; a0. */
struct vec3 fluid_dumbbell_now(const struct state *state, const struct model *model, uint32_t p);

/* The energy of all springs now, and that of dumbbells in the potential of walls; kT. */
double fluid_dumbbell_energy(const struct state *state, const struct model *model);

/* The velocity that the body force has added to each particle since it was last streamed. */
struct vec3 fluid_gain(const struct state *state, const struct model *model);

#endif
