/*
 * The stress of the solvent, summed at collisions. Whoever asks for it sets mpc->stress; else nothing of it is
 * computed.
 *
 * At each collision two parts are summed, as in Kikuchi, Pooley, Ryder and Yeomans, J. Chem. Phys. 119, 6388 (2003):
 *
 *   kinetic      m w_a w_b of the flight that ends, w: velocity relative to the applied flow at half the flight
 *   collisional  m b (v_a' - v_a), b: the member's place along b within its cell, v and v': velocities before and after
 *
 * The place at the end of the flight would not do for the kinetic part: it is correlated with v_y, which adds
 * rate dt n kT/2 to the shear stress. The mean of w is subtracted, so that a common motion adds nothing.
 *
 * Between walls only the bulk counts. Cells that a wall cuts do not conserve the momentum of their particles, so their
 * collisional part would depend on the origin.
 */
#ifndef UNCROSS_MPC_STRESS_H
#define UNCROSS_MPC_STRESS_H

#include "mpc/mpc.h"

/* Components: momentum along the first axis, handed on along the second. */
enum { STRESS_XY, STRESS_XX, STRESS_YY, STRESS_ZZ, STRESS_COMPONENTS };

/* Sums over collisions. Doubles alone: it is saved in checkpoints as it is. */
struct mpc_stress {
  double collisions;
  double kinetic[STRESS_COMPONENTS];     /* kT/a0^3: of m w_a w_b over the volume */
  double collisional[STRESS_COMPONENTS]; /* kT t0/a0^3: of m b (v_a' - v_a) over the volume */
};

enum { STRESS_DOUBLES = sizeof(struct mpc_stress) / sizeof(double) };

/* Before velocities are changed, and after: between gathering of members and border->leave. */
void stress_before(const struct state *state, const struct model *model, struct mpc *mpc);
void stress_after(const struct state *state, const struct model *model, struct mpc *mpc);

#endif
