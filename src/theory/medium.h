/*
 * What follows from a bath of vertices or of pairs (medium/bath.h), in molecular chaos: partners that have not met
 * before. Exact for the private bath. For pairs it is good where a particle flies 1 a0 and more between two collisions,
 * rate below 1; at rate 10 and density 3 diffusion is faster and viscosity lower by tens of per cent.
 * Units a0 = kT = m = 1.
 */
#ifndef UNCROSS_THEORY_MEDIUM_H
#define UNCROSS_THEORY_MEDIUM_H

#include "system/model.h"

/* The part of its velocity that a member of this mass loses in a time step. Private: <1 - c>. Pairs:
 *   (4 pi/3) rho (mu/M) int_0^1 r^2 <1 - c(r)> dr,   mu = M/(1 + M). */
double theory_medium_loss(const struct model *model, double mass);

/* D = (kT dt/M) [1/loss - 1/2], a0^2/t0. */
double theory_medium_diffusion(const struct model *model, double mass);

/* lambda dt of the fastest mode of an overdamped fiber, without hydrodynamics; unstable from 2 on. 4 k D_0 dt of
 * springs, which filaments have none of, 16 kappa D_0 dt/b^2 of bends. A mode's mean square is 1/(1 - lambda dt/2) of
 * its own. */
double theory_medium_spring_step(const struct model *model, const struct fiber_kind *kind);
double theory_medium_bend_step(const struct model *model, const struct fiber_kind *kind);

/* eta of pairs, m/(a0 t0), 0 of the private bath. Kinetic: rho dt [1/loss - 1/2] of the kinetic stress, of which a
 * step takes the part 4 pi rho int r^2 [<1 - c>/3 - <(1 - c)^2>/15] dr. Collisional: (pi/15) rho^2 int r^4 <1 - c>/dt
 * dr. */
double theory_medium_viscosity_kinetic(const struct model *model);
double theory_medium_viscosity_collisional(const struct model *model);

/* Kirkwood's diffusion coefficient of a Gaussian chain of n vertices, over that of one of them: ratio is the radius
 * over the rms bond. (1/n) [1 + (1/n) sum_{i != j} <tr D_ij>/3 D0]; with `oseen` it is Eq. (39) of Padding 2009 for n
 * -> oo. What the chain really does is lower by 1 to 3 %. */
double theory_kirkwood(enum medium_tensor tensor, uint32_t n, double ratio);

#endif
