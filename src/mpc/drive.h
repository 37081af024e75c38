/*
 * What drives the solvent at collisions, as a kick of velocities that depends on y. Both keep the total momentum.
 *
 * - A body force with a profile (Kolmogorov flow, reverse Poiseuille flow). Half of its kick comes before the
 *   collision, half after it, so that the error of an interval tau is of second order, and velocities seen between
 *   steps are those of the middle of a kick.
 * - Oscillating shear: a linear profile is a solution of the equations of motion only under the affine force
 *   m y d(rate)/dt. It changes the rate from that of the interval that ended to that of the one that begins.
 */
#ifndef UNCROSS_MPC_DRIVE_H
#define UNCROSS_MPC_DRIVE_H

#include "mpc/mpc.h"

/* Acceleration at y over the scene's `acceleration`: 1, sin(2 pi y/L), or 1 below L/2 and -1 above. y in lattice units,
 * in [0, edge]. */
double drive_profile(const struct model *model, int64_t y);

/* True if the force of this model depends on y. */
bool drive_has_profile(const struct model *model);

/* Kicks the solvent by its body force for this part of a collision interval. The solvent must have been streamed. The
 * mean kick is taken out, so that the solvent's momentum stays as it is, to rounding. */
void drive_kick(struct state *state, const struct model *model, double part);

/* True if the shear rate of this model changes in time. */
bool drive_has_affine_kick(const struct model *model);

/* Gives the solvent the shear rate of the collision interval that begins now. */
void drive_affine_kick(struct state *state, const struct model *model);

#endif
