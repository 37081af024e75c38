/*
 * Overdamped motion: Ermak and McCammon, J. Chem. Phys. 69, 1352 (1978), Eq. (15), with tensors without divergence:
 *
 *   r_i += u dt + (dt/kT) sum_j D_ij.F_j + X_i,   <X X> = 2 D dt,   D_ii = D0 = kT/(M rate).
 *
 * Inextensible fibers have no noise, and tensions (tension.h) beside their forces.
 *
 * Each fiber is alone in an unbounded fluid: tensors (mobility.h) join vertices of one fiber. Velocities of the state
 * stay 0, and have no meaning.
 */
#ifndef UNCROSS_FIBER_OVERDAMPED_H
#define UNCROSS_FIBER_OVERDAMPED_H

#include "fiber/force.h"

/* Doubles of scratch for this model. */
size_t overdamped_doubles(const struct model *model);

/* Moves all vertices under the forces force[vertices]. False, with the fault recorded, if a move is too far or the
 * tensor of a fiber is not positive, or tensions cannot be found. */
bool overdamped_move(struct state *state, const struct model *model, const struct vec3 *force, double *scratch,
                     uint64_t step, struct fault *fault);

#endif
