/*
 * What drives the solvent at collisions, as a kick of velocities that depends on y.
 *
 * - A body force with a profile: the scene's `acceleration` times sin(2 pi y/L) (Kolmogorov flow), or times 1 below L/2
 *   and -1 above (reverse Poiseuille flow). Half of its kick comes before the collision, half after it, so that the
 *   error of an interval tau is of second order. The mean kick is taken out, so that the momentum stays as it is.
 * - Oscillating shear: a linear profile is a solution of the equations of motion only under the affine force
 *   m (y - L/2) d(rate)/dt. It changes the rate from that of the interval that ended to that of the one that begins.
 *   The momentum relative to the profile stays as it is. The mean kick must not be taken out: it jumps when a particle
 *   crosses the boundary, and images would no longer be alike.
 */
#ifndef UNCROSS_MPC_DRIVE_H
#define UNCROSS_MPC_DRIVE_H

#include "mpc/mpc.h"

/* True if the force of this model depends on y. */
bool drive_has_profile(const struct model *model);

/* Kicks the solvent by its body force for this part of a collision interval. The solvent must have been streamed. */
void drive_kick(struct state *state, const struct model *model, double part);

/* True if the shear rate of this model changes in time. */
bool drive_has_affine_kick(const struct model *model);

/* Gives the solvent the shear rate of the collision interval that begins now. */
void drive_affine_kick(struct state *state, const struct model *model);

#endif
