/*
 * Forces between members that are nearer than 1 a0, of the energy
 *
 *   U = sum over pairs of (a/2) (1 - r)^2  +  sum over members of (pi d^4/30) B rho_i^2,
 *   rho_i = sum over the others of 15/(2 pi d^3) (1 - r/d)^2, r < d:
 *
 *   F on a = [a (1 - r) + B (rho_a + rho_b) (1 - r/d)] e,   e from b to a.
 *
 * The first is that of DPD: Groot and Warren, J. Chem. Phys. 107, 4423 (1997), Eq. (4); a may be another one between
 * two groups. The second is Warren's of many bodies, Phys. Rev. E 68, 066702 (2003), Eqs. (2), (6).
 */
#ifndef UNCROSS_MEDIUM_REPULSION_H
#define UNCROSS_MEDIUM_REPULSION_H

#include "medium/medium.h"

#define REPULSION_SCALE 0x1p32 /* sums up to 2^31 kT/a0 */
#define REPULSION_UNIT 0x1p-32
#define CROWD_SCALE 0x1p32 /* sums up to 2^31 1/a0^3 */
#define CROWD_UNIT 0x1p-32

/* Fills medium->force: of the state as it is, particles streamed before. False, with the fault recorded, if a flight is
 * too far. */
bool repulsion_forces(struct state *state, const struct model *model, struct medium *medium, struct fault *fault);

/* The same, and the encounters of step number `step` are listed by the same search: pairs_act acts on them while places
 * are what they are. False if memory is short for the list, too. */
bool repulsion_forces_and_encounters(struct state *state, const struct model *model, struct medium *medium,
                                     uint64_t step, struct fault *fault);

/* Advances the velocities of all members by fraction * dt under these forces. */
void repulsion_kick(struct state *state, const struct model *model, const struct medium *medium, double fraction);

/* Sums over the pairs of a state, that do not depend on the order in memory. */
struct repulsion_sums {
  double energy;    /* U, kT */
  double virial[4]; /* kT: r_x F_y, r_x F_x, r_y F_y, r_z F_z (enum of system/fluid.h) */
  double laplacian; /* of U, in all coordinates of members that may move; kT/a0^2 */
};

/* Fills *sums, and force[members], by numbers; force may be NULL. Particles must not be late. All zero without
 * repulsion. False if memory is short. */
bool repulsion_measure(const struct state *state, const struct model *model, struct vec3 *force,
                       struct repulsion_sums *sums);

#endif
