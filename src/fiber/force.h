/*
 * Forces and energies of bonds and bends (Padding 2009, Sec. II).
 *
 *   bond   phi_b = (k/2) (R - l0)^2              force on j: +k (R - l0) u, on its neighbor the opposite
 *   bend   phi_theta = kappa (1 - u_{i-1}.u_i)   with
 *            dcos/dR_{i-1} = -(u_i - cos u_{i-1}) / R_{i-1,i}
 *            dcos/dR_{i+1} =  (u_{i-1} - cos u_i) / R_{i,i+1}      dcos/dR_i = -(sum of both)
 */
#ifndef UNCROSS_FORCE_H
#define UNCROSS_FORCE_H

#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

/* work->fiber.force of every vertex: bonds, bends, and the constant body force, in kT/a0 (the paper's step 5).
 * False, with the fault recorded, if a bond is longer than half the shortest box edge. */
bool fiber_forces(const struct state *state, const struct model *model, struct work *work, uint64_t step);

/* Velocities of all vertices advanced by fraction * dt (Eq. (8)). */
void fiber_kick(struct state *state, const struct model *model, const struct work *work, double fraction);

struct fiber_energy {
  double bond, bend; /* kT */
};

/* Potential energy of all fibers. */
struct fiber_energy fiber_energies(const struct state *state, const struct model *model);

/* R_next(j) - R_j, in a0. Vertices are unwrapped, so this is the bond vector whatever the box. */
static inline struct vec3 fiber_bond(const struct state *state, const struct model *model, uint32_t j)
{
  return point_difference(state->position[model->next[j]], state->position[j]);
}

#endif
