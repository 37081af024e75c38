/*
 * A bead: a sphere of radius R and mass M in the solvent. It translates; it does not turn, and no angular momentum is
 * kept.
 *
 * A particle that hits the surface leaves with its velocity relative to the bead reversed, as two bodies of masses m
 * and M that bounce: momentum and energy are conserved (bead/flight.c). The part of a collision cell that is in the
 * bead holds virtual particles. They are matter of the bead: bead/matter.c.
 *
 * The bead is streamed with the solvent, so a step is a collision interval, and nothing is late between steps.
 */
#ifndef UNCROSS_SYSTEM_BEAD_H
#define UNCROSS_SYSTEM_BEAD_H

#include "system/fault.h"
#include "system/model.h"
#include "system/plan.h"
#include "system/state.h"

#define BEAD_ENERGY_SCALE 0x1p32 /* of the account: units per kT */
#define BEAD_ENERGY_UNIT 0x1p-32

/* a0/t0: of the trap, and of a bead under a constant force (scene/scene.c). That of sound is 1 or 1.29. */
#define BEAD_MOST_SPEED 0.5

/* a0^3; 0 without a bead */
static inline double bead_volume(const struct model *model)
{
  const double r = model->bead.radius;
  return 4.0 / 3.0 * 3.14159265358979323846 * r * r * r;
}

/* R in lattice units, exact. */
static inline int64_t bead_radius(const struct model *model)
{
  return llrint(model->bead.radius * LATTICE_PER_A0);
}

/* Is the place outside the bead, or on its surface? Exact. Both in lattice units, anywhere. */
bool bead_is_outside(const struct model *model, struct point center, struct point place);

/* From a place to the nearest image of another one, lattice units. */
struct point bead_to_image(const struct box *box, struct point from, struct point to);

/* Half of the shortest edge along which the bead has images, a0. */
double bead_half_edge(const struct model *model);

/* Has the box room for the bead? Before anything is derived. */
bool bead_fits(const struct model *model, struct model_error *error);

/* Force of the drive on the bead at a time, kT/a0, where its center is at this place; and the middle of the trap, a0.
 * Both are 0 without it. An acceleration of the solvent pushes the bead as the solvent that it displaces, as a gradient
 * of pressure does: this force is added. half_steps: half time steps since the start. */
struct vec3 bead_force(const struct model *model, struct point place, uint64_t half_steps);
struct vec3 bead_trap(const struct model *model, uint64_t half_steps);

/* The counterforce: acceleration of solvent and vertices, a0/t0^2, from the time to which the solvent was streamed
 * until it is streamed again. It takes up the momentum that the drive gives to the bead at that time. 0 without a
 * drive, and between walls, which take it up. */
struct vec3 bead_counter(const struct state *state, const struct model *model);

/* Appends what the vertices get of it in half a step: before and after their drift. The fluid's particles get it in
 * flight. */
void bead_plan_counter(struct plan *plan, const struct model *model);

/* Adds the drive's force on the bead for a time to its velocity. */
void bead_kick(struct bead *bead, const struct model *model, uint64_t half_steps, double time);

/* Adds the drive's work on the way from a place, at `begin`, to where the bead is now, at `end` (half steps), to its
 * account: the mean of both forces times the way. So a force that is constant or that of a trap at rest does the work
 * of its potential, exactly. */
void bead_work(struct bead *bead, const struct model *model, struct point from, uint64_t begin, uint64_t end);

/* The bead's velocity at the time of the step, a0/t0: with a drive the state has that of the half step ahead. */
struct vec3 bead_velocity_now(const struct state *state, const struct model *model);

/* Derives the mass, and checks what the scene may not combine with a bead. */
bool bead_finish(struct model *model, struct model_error *error);

/* Is the bead between the walls, and the solvent outside of it? Records FAULT_BEAD_WALL or FAULT_IN_BEAD if not. */
bool bead_sound(const struct state *state, const struct model *model, struct fault *fault);

/* Adds to a sum in units of BEAD_ENERGY_UNIT; it may wrap. */
static inline void bead_account(int64_t *sum, double energy)
{
  *sum = (int64_t)((uint64_t)*sum + (uint64_t)llrint(BEAD_ENERGY_SCALE * energy));
}

#endif
