/*
 * A fluid of harmonic dumbbells (Tao, Goetze and Gompper, J. Chem. Phys. 128, 144902 (2008)): that of Jeffreys, or
 * Oldroyd's B. The solvent's own viscosity eta_0 and the springs' G(t) = n_d kT exp(-omega_H t) add up. Units a0 = kT =
 * m = 1; n_d: dumbbells per volume. All follows from the diffusion coefficient D of a particle, by molecular chaos: at
 * a mean free path of 0.02 a0 omega_H is some 10 % higher (docs/dumbbells.md).
 */
#ifndef UNCROSS_THEORY_DUMBBELL_H
#define UNCROSS_THEORY_DUMBBELL_H

#include <complex.h>

#include "mpc/rule.h"

/* R_0 = sqrt(d kT/K), a0: root mean square of the vector at rest. */
double theory_dumbbell_size(double spring, uint32_t d);

/* omega_H = 4 K D/kT, 1/t0: a spring forgets its stress in 1/omega_H. */
double theory_dumbbell_rate(double spring, double diffusion);

/* The same, and n_d, of a model with dumbbells. */
double theory_model_dumbbell_rate(const struct model *model);
double theory_model_dumbbells(const struct model *model);

/* eta_0 of a model whose solvent collides, m/(a0 t0); and eta = eta_0 + n_d kT/omega_H. Without dumbbells the two are
 * one. */
double theory_model_viscosity_of_solvent(const struct model *model);
double theory_model_viscosity(const struct model *model);

/* Sc = nu/D of the solvent's particles, without springs. */
double theory_model_schmidt(const struct model *model);

/* G* = G' + i G'' at a frequency: G' = n_d x^2/(1 + x^2), G'' = eta_0 omega + n_d x/(1 + x^2), x = omega/omega_H. */
double complex theory_dumbbell_modulus(double viscosity_of_solvent, double number, double rate, double frequency);

/* Between oscillating walls a distance L apart, stress on a wall over the strain in the middle is not G* but G* times
 * cosh(k L/2), k^2 = -rho omega^2/G*: the inertia of the fluid. */
double complex theory_dumbbell_inertia(double complex modulus, double frequency, double mass_density, double height);

/* First normal stress difference 2 n_d kT Wi^2, kT/a0^3, and <r^2>/R_0^2 = 1 + (2/d) Wi^2; Wi is shear rate/omega_H. */
double theory_dumbbell_normal_stress(double number, double weissenberg);
double theory_dumbbell_stretch(double weissenberg, uint32_t d);

/* Angle of the vector with the flow, radians: tan 2 chi = 1/Wi. */
double theory_dumbbell_angle(double weissenberg);

/* Density of particles at a height y above one wall, over that of the bulk. The center of a dumbbell at Y below its
 * reach c = range sqrt(kT/K) has the energy -depth (1 - Y/c); depth 0: none. */
double theory_dumbbell_density(double spring, double depth, double range, double y);

/* The integral of that density less 1 over y, per wall, a0: -0.398942 sqrt(kT/K) without a potential. */
double theory_dumbbell_excess(double spring, double depth, double range);

/* Particles per volume far from walls, of a model with walls and dumbbells: those that miss near the walls are there.
 */
double theory_dumbbell_bulk_density(const struct model *model);

#endif
