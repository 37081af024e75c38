/*
 * A solvent whose cells hold vertices, too: the vertices go with the flow, make the fluid heavier, and hand on momentum
 * in collisions. Units a0 = kT = m = 1.
 *
 * A collision hands on momentum in proportion to <m_cell - sum m^2/m_cell> of the cell's members, Eq. (31) with their
 * masses; n - 1 + exp(-n) if all masses are 1. Members are independent, so by Campbell and Mecke
 *
 *   <sum m^2/m_cell> = int_0^inf f''(s) exp(f(s) - f(0)) ds,   f(s) = sum over kinds of members n exp(-m s),
 *
 * n: members of a kind per cell. With 2 vertices of mass 5 per cell at gamma = 5 measured shear waves have a kinematic
 * viscosity 1.2 % below this (docs/claims/solvent.md). That is of loose vertices: bonds make the fluid elastic, and
 * more viscous still. In a fluid of pairs a pair hands on momentum as its reduced mass, so that the collisional part
 * has sum n_i n_j 2 mu_ij in place of rho^2. Frozen vertices do not go with the flow, and are no load.
 */
#ifndef UNCROSS_THEORY_LOAD_H
#define UNCROSS_THEORY_LOAD_H

#include "system/model.h"

/* Factor above which a load is worth a warning. */
#define THEORY_HEAVY_LOAD 1.25

/* True if vertices load a solvent that flows: not in a bath of phantoms, nor with hydrodynamics: false, nor if all are
 * frozen. */
bool theory_is_loaded(const struct model *model);

/* Mass of the vertices that move, per cell, m/a0^3. */
double theory_load(const struct model *model);

/* The factor by which vertices raise the viscosity of the solvent: its collisional part, and the kinetic part stays. 1
 * if they do not load it. masses, gamma: what it would be if all masses of vertices were so many times as large, and
 * with gamma solvent particles per cell. */
double theory_load_factor(const struct model *model, double masses, double gamma);

/* eta of the solvent with its vertices, m/(a0 t0), springs of dumbbells included; theory_model_viscosity if they do not
 * load it. */
double theory_loaded_viscosity(const struct model *model);

/* Mass per cell, m/a0^3, and kinematic viscosity, a0^2/t0, of the same fluid. */
double theory_loaded_density(const struct model *model);
double theory_loaded_kinematic(const struct model *model);

#endif
