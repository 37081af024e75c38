/*
 * Forces and energies of bonds and bends (Padding 2009, Sec. II).
 *
 *   bond   phi_b = (k/2) (R - l0)^2              force on j: +k (R - l0) u_j, on the next vertex the opposite
 *   bend   phi_theta = kappa (1 - u_{i-1}.u_i)   u_j: unit vector from j to the next vertex
 *            dcos/dR_{i-1} = -(u_i - cos u_{i-1}) / R_{i-1,i}
 *            dcos/dR_{i+1} =  (u_{i-1} - cos u_i) / R_{i,i+1}      dcos/dR_i = -(sum of both)
 */
#ifndef UNCROSS_FIBER_FORCE_H
#define UNCROSS_FIBER_FORCE_H

#include "system/fault.h"
#include "system/model.h"
#include "system/state.h"

/* Computes the force on every vertex, force[vertices], in kT/a0: bonds, bends, and the constant force of the kind (the
 * paper's step 5). step: for the fault.
 * False, with the fault recorded, if a bond is longer than half the shortest box edge. */
bool fiber_forces(const struct state *state, const struct model *model, struct vec3 *force, uint64_t step,
                  struct fault *fault);

/* The force on one vertex, kT/a0, of a fiber whose vertices stand at place(context, vertex): as fiber_forces, to
 * rounding. A bond without length exerts none. */
struct vec3 fiber_force_at(const struct model *model, uint32_t vertex,
                           struct point (*place)(const void *context, uint32_t vertex), const void *context);

/* Advances the velocities of all vertices by fraction * dt under these forces (Eq. (8)). */
void fiber_kick(struct state *state, const struct model *model, const struct vec3 *force, double fraction);

/* The room's scratch. */
struct fiber {
  struct vec3 *force; /* [vertices] kT/a0 */
  double *overdamped; /* [overdamped_doubles] */
};

/* False if memory is short. */
bool fiber_alloc(struct fiber *fiber, const struct model *model);
void fiber_free(struct fiber *fiber);
uint64_t fiber_bytes(const struct model *model);

/* Appends the forces, or a kick of fraction * dt, to a plan, if the model has vertices. room: offset of struct fiber in
 * struct work. name: as in struct stage. */
struct plan;
void fiber_plan_forces(struct plan *plan, const struct model *model, size_t room, const char *name);
void fiber_plan_kick(struct plan *plan, const struct model *model, size_t room, double fraction, const char *name);

/* Appends an overdamped move to a plan, in the same way. */
void fiber_plan_move(struct plan *plan, const struct model *model, size_t room, const char *name);

struct fiber_energy {
  double bond, bend; /* kT */
};

/* Potential energy of all fibers. */
struct fiber_energy fiber_energies(const struct state *state, const struct model *model);

/* R_next(j) - R_j, in a0. Vertices are unwrapped, so this is the bond vector; no minimum image is needed. */
static inline struct vec3 fiber_bond(const struct state *state, const struct model *model, uint32_t j)
{
  return point_difference(state->position[model->next[j]], state->position[j]);
}

#endif
