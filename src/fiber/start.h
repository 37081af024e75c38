/* Starting positions and velocities of fibers. */
#ifndef UNCROSS_FIBER_START_H
#define UNCROSS_FIBER_START_H

#include "system/model.h"
#include "system/state.h"

/* Sets positions by each kind's `start`, and velocities from the Maxwell distribution (kT = 1).
 *
 * - equilibrium: the first vertex uniform in the box, then bond by bond: lengths from p(l) ~ l^2 exp(-k (l-l0)^2 / 2),
 *   bends from p(cos) ~ exp(kappa cos), azimuths uniform. This is the exact equilibrium distribution of the open
 *   phantom chain, and of the noncrossing one: thin lines exclude no volume.
 * - straight: vertices spaced by the mean bond length.
 * - circle: the same, on a circle.
 *
 * Straight fibers and circles without a place of their own get a uniform centre and a uniform direction. */
void fiber_start(struct state *state, const struct model *model);

#endif
