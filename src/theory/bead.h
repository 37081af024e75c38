/*
 * A bead in the solvent. Units a0 = kT = m = 1.
 */
#ifndef UNCROSS_THEORY_BEAD_H
#define UNCROSS_THEORY_BEAD_H

#include "system/model.h"

/* 6 pi eta R, kT t0/a0^2: Stokes, no slip, no box. */
double theory_bead_stokes(double viscosity, double radius);

/* The friction of a sphere that turns no flow: (16/3) gamma R^2 sqrt(2 pi mu kT), mu = m M/(m + M). A particle that
 * hits it gets its relative velocity reversed; a sphere that reverses the normal component only has half of it. */
double theory_bead_enskog(double gamma, double radius, double mass);

/* Both at once, 1/(1/xi_S + 1/xi_E): Lee and Kapral, J. Chem. Phys. 121, 11163 (2004); Padding and Louis, Phys. Rev. E
 * 74, 031402 (2006). */
double theory_bead_friction(double stokes, double enskog);

/* Friction in a cubic lattice of beads over that of one alone: 1/(1 - 2.837297 x + (4 pi/3) x^3 - 27.4 x^6), x = R/L
 * (Hasimoto, J. Fluid Mech. 5, 317 (1959)). The velocity is relative to the mean of everything, bead and fluid. For x
 * below 0.25. */
double theory_bead_box(double radius, double edge);

/* The same of a model: Stokes and Enskog, without the box. */
double theory_model_bead_friction(const struct model *model);

#endif
