/*
 * A bead in the solvent. Units a0 = kT = m = 1.
 */
#ifndef UNCROSS_THEORY_BEAD_H
#define UNCROSS_THEORY_BEAD_H

#include "system/model.h"

/* 6 pi eta R, kT t0/a0^2: Stokes, no slip, no box. */
double theory_bead_stokes(double viscosity, double radius);

/* Hydrodynamic radius, a0, of a sphere on which the flow slips by a length b: R (1 + 2b/R)/(1 + 3b/R) (Basset 1888). */
double theory_bead_radius(double radius, double slip);

/* The friction of single hits, kT t0/a0^2, without any flow: (16/3) gamma R^2 sqrt(2 pi mu kT), mu = m M/(m + M). A
 * particle that hits the bead gets its relative velocity reversed; where the normal component alone is reversed, it is
 * half of this. Where hits are all the coupling, frictions add up as 1/xi_S + 1/xi_E (Lee and Kapral, J. Chem. Phys.
 * 121, 11163 (2004); Padding and Louis, Phys. Rev. E 74, 031402 (2006)). Here collisions with virtual particles couple
 * more: as at a wall, the flow slips by the length of theory_slip_length. docs/bead.md has the measurement. */
double theory_bead_enskog(double gamma, double radius, double mass);

/* Friction in a cubic lattice of beads over that of one alone: 1/(1 - 2.837297 x + (4 pi/3) x^3 - 27.4 x^6), x = R/L
 * (Hasimoto, J. Fluid Mech. 5, 317 (1959)). The velocity is relative to the mean of everything. For x below 0.25. */
double theory_bead_box(double radius, double edge);

/* Friction along a wall at this distance of the center, over that without a wall, to the fifth order in x = R/h:
 * 1/(1 - (9/16) x + (1/8) x^3 - (45/256) x^4 - (1/16) x^5) (Faxen; Happel and Brenner, Low Reynolds number
 * hydrodynamics, 7-4). For x below 0.7: nearer, lubrication makes it larger. */
double theory_bead_wall(double radius, double height);

/* The same between two walls at this distance, in their middle and at a quarter of it from one of them (Faxen; Happel
 * and Brenner, 7-4): in x = R/h, h the distance from the nearer wall. */
double theory_bead_middle(double radius, double distance);
double theory_bead_quarter(double radius, double distance);

/* Between two walls at any height, as if what the walls add did not depend on each other. */
double theory_bead_slit(double radius, double height, double distance);

/* Of a model: slip length, a0; friction 6 pi eta R_h, without the box. */
double theory_model_bead_slip(const struct model *model);
double theory_model_bead_friction(const struct model *model);

#endif
