/* Where fibers are at the start, and how fast. */
#ifndef UNCROSS_FIBER_START_H
#define UNCROSS_FIBER_START_H

#include "state/model.h"
#include "state/state.h"

/* Positions by each kind's `start`, velocities from the Maxwell distribution (kT = 1).
 *
 * - equilibrium: the first vertex uniform in the box, then bond by bond: lengths from p(l) ~ l^2 exp(-k (l-l0)^2 / 2),
 *   bends from p(cos) ~ exp(kappa cos), azimuths uniform. This is the exact equilibrium distribution of the open
 *   phantom chain, and of the noncrossing one: thin lines exclude no volume.
 * - straight: vertices spaced by the mean bond length.
 * - circle: the same, on a circle.
 *
 * Straight fibers and circles without a place of their own get a uniform centre and a uniform direction. */
void fiber_start(struct state *state, const struct model *model);

/* Mean bond length of a bond of this kind in equilibrium, in a0. */
double fiber_mean_bond(const struct fiber_kind *kind);

#endif
