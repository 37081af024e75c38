/*
 * The stress of the solvent, summed at collisions. Whoever asks for it sets mpc->stress; else nothing of it is
 * computed.
 *
 * At each collision these parts are summed, the first two as in Kikuchi, Pooley, Ryder and Yeomans, J. Chem. Phys. 119,
 * 6388 (2003):
 *
 *   kinetic      m w_a w_b of the flight that ends, w: velocity relative to the applied flow at half the flight
 *   collisional  m b (v_a' - v_a), b: the member's place along b within its cell, v and v': velocities before and after
 *   spring       K r_a r_b of dumbbells, mean over the flight that ends (Tao et al. 2008); it counts with the sign of a
 *                tension, the other two with that of a pressure
 *
 * The place at the end of the flight would not do for the kinetic part: it is correlated with v_y, which adds
 * rate dt n kT/2 to the shear stress. The mean of w is subtracted, so that a common motion adds nothing.
 *
 * Between walls only the bulk counts: momentum that passes through planes with 1 < y < L - 1, which no cut cell holds.
 * Cells that a wall cuts do not conserve the momentum of their particles, so their collisional part would depend on the
 * origin. The collisional part of xx and zz is that of all cells that no wall cuts.
 */
#ifndef UNCROSS_MPC_STRESS_H
#define UNCROSS_MPC_STRESS_H

#include "mpc/mpc.h"

/* Sums over collisions. Doubles alone: it is saved in checkpoints as it is. */
struct mpc_stress {
  double collisions;
  double kinetic[STRESS_COMPONENTS];     /* kT/a0^3: of m w_a w_b over the volume */
  double collisional[STRESS_COMPONENTS]; /* kT t0/a0^3: of m b (v_a' - v_a) over the volume */
  double spring[STRESS_COMPONENTS];      /* kT/a0^3: of K r_a r_b over the volume; there with dumbbells only */
};

/* Doubles of it that a model uses: the springs are its end. */
static inline size_t stress_doubles(const struct model *model)
{
  const size_t all = sizeof(struct mpc_stress) / sizeof(double);
  return model_has_dumbbells(model) ? all : all - STRESS_COMPONENTS;
}

/* Before velocities are changed, and after: between gathering of members and border->leave. */
void stress_before(const struct state *state, const struct model *model, struct mpc *mpc);
void stress_after(const struct state *state, const struct model *model, struct mpc *mpc);

#endif
