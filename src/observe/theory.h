/*
 * Every number that follows from a model without running it: the paper's transport coefficients and dimensionless
 * numbers, exact averages of a phantom chain, frequencies, rates. One function per equation.
 *
 * Units a0 = kT = m = 1. `cosine` is that of the rotation angle alpha; `gamma` the mean number of solvent particles per
 * cell; `interval` is dt_c. Formulas of the solvent assume molecular chaos; at a mean free path of 0.02 a0 they are
 * some per cent off (docs/accuracy.md).
 */
#ifndef UNCROSS_THEORY_H
#define UNCROSS_THEORY_H

#include <stdbool.h>

#include "state/model.h"

/* --- solvent ----------------------------------------------------------------------------------------------------- */

/* gamma - 1 + exp(-gamma): mean of (n - 1) over the cells with n > 0 members, n Poisson of mean gamma. */
double theory_partners(double gamma);

/* Kinetic viscosity, m/(a0 t0): Padding 2009, Eq. (30). */
double theory_viscosity_kinetic(double gamma, double cosine, double interval);

/* Collisional viscosity, m/(a0 t0): Padding 2009, Eq. (31). */
double theory_viscosity_collisional(double gamma, double cosine, double interval);

/* eta: the sum of both. nu = eta / (m gamma) is the kinematic viscosity (Padding 2009, below Eq. 31). */
double theory_viscosity(double gamma, double cosine, double interval);

/* Self-diffusion coefficient of a solvent particle, a0^2/t0: D = kT dt_c/m [1/(1-c) - 1/2], where its velocity keeps
 * the share c = 1 - (2/3)(1 - cos alpha)(gamma - 1 + exp(-gamma))/gamma in a collision. */
double theory_solvent_diffusion(double gamma, double cosine, double interval);

/* Sc = nu / D of the solvent: momentum diffuses so much faster than particles (Padding 2009, Sec. IV A). */
double theory_schmidt(double gamma, double cosine, double interval);

/* c_s, a0/t0: sqrt(5/3) where energy is conserved (Padding 2009, below Eq. 36), 1 where a thermostat holds kT. */
double theory_sound_speed(bool isothermal);

/* Way of a solvent particle between two collisions, dt_c sqrt(kT/m), a0. */
double theory_mean_free_path(double interval);

/* --- a single vertex --------------------------------------------------------------------------------------------- */

/* Share c of its velocity that a vertex of this mass keeps in a collision, alone among n solvent particles, n Poisson:
 * c = 1 - (2/3)(1 - cos alpha) <n m/(M + n m)>. */
double theory_vertex_retention(double mass, double gamma, double cosine);

/* D_0 = kT dt_c/M [1/(1-c) - 1/2], a0^2/t0: diffusion without hydrodynamic correlations. */
double theory_vertex_diffusion(double mass, double gamma, double cosine, double interval);

/* a_h = kT/(6 pi eta D), a0 (Padding 2009, Sec. IV A). */
double theory_hydrodynamic_radius(double viscosity, double diffusion);

/* --- dimensionless numbers --------------------------------------------------------------------------------------- */

/* l_p* = l_p / L: Padding 2009, Eq. (32). */
double theory_relative_persistence(double persistence, double length);

/* p = L / 2 a_h: Padding 2009, Eq. (33). */
double theory_aspect_ratio(double length, double radius);

/* The a_h of the paper's Table II, where 2 a_h = l0 = 0.5 a0 and so p = 64; its text says 0.3 a0. */
#define THEORY_RADIUS 0.25

/* xi = sqrt(3/(c L)), a0; line_density = c L, fiber length per volume: Padding 2009, Eq. (34). */
double theory_mesh_size(double line_density);

/* L_perp, a0: Padding 2009, Eq. (35). The tube of the paper's Fig. 5 stands at 2 L_perp^2. */
double theory_tube_diameter(double length, double persistence, double mesh);

/* L_d, a0: Padding 2009, below Eq. (35). */
double theory_deflection_length(double length, double persistence, double mesh);

/* Ma = v/c_s: Padding 2009, Eq. (36). */
double theory_mach(double speed, double sound);

/* Re = v R/nu: Padding 2009, Eq. (37). */
double theory_reynolds(double speed, double size, double kinematic_viscosity);

/* Pe = v R/D: Padding 2009, Eq. (38). */
double theory_peclet(double speed, double size, double diffusion);

/* --- dilute chains and rods -------------------------------------------------------------------------------------- */

/* D = 0.196 kT/(eta R_e), a0^2/t0, of a flexible chain: Padding 2009, Eq. (39). */
double theory_chain_diffusion(double viscosity, double end_to_end);

/* D = kT/(3 pi eta L) [ln(L/b) + 0.312], a0^2/t0, of a rod of diameter b: Padding 2009, Eq. (40). */
double theory_rod_diffusion(double viscosity, double length, double diameter);

/* tau_r = 1/(2 D_r), t0, of a rod of aspect ratio p, with D_r = 3kT/(pi eta L^3) (ln p - 0.662 + 0.917/p - 0.050/p^2)
 * (Tirado and Garcia de la Torre, J. Chem. Phys. 73, 1986 (1980)); made for 2 < p < 30, often used beyond. */
double theory_rod_relaxation(double viscosity, double length, double aspect_ratio);

/* --- a kind of fiber --------------------------------------------------------------------------------------------- */

/* Bonds of one fiber: N_v - 1, or N_v in a ring. */
double theory_bonds(const struct fiber_kind *kind);

/* <l^2> of a bond in equilibrium, a0^2. The mean bond length is fiber_mean_bond (fiber/start.h). */
double theory_bond_square(const struct fiber_kind *kind);

/* Chance that a bond in equilibrium is longer than `limit`. */
double theory_bond_tail(const struct fiber_kind *kind, double limit);

/* <cos theta> = coth kappa - 1/kappa between successive bonds in equilibrium. */
double theory_bend_cosine(double bending);

/* Contour length: bonds times mean bond length, a0. The paper's L is theory_length. */
double theory_contour(const struct fiber_kind *kind);

/* L as the paper counts it: N_v l0; the contour length where l0 = 0. */
double theory_length(const struct fiber_kind *kind);

/* l_p = kappa l0 as the paper sets it, a0; the effective one, -<l>/ln<cos theta>, where l0 = 0. */
double theory_persistence(const struct fiber_kind *kind);

/* The decay length of tangent correlations, -<l>/ln<cos theta>, a0; 0 for a freely jointed chain. */
double theory_effective_persistence(const struct fiber_kind *kind);

/* <R^2> between the ends of an open fiber in equilibrium, exact for the phantom chain, a0^2. */
double theory_end_to_end_square(const struct fiber_kind *kind);

/* Highest frequency of stretching in a straight chain, 1/t0: 2 sqrt(k/M) cos(pi/2N_v), 2 sqrt(k/M) in a ring. */
double theory_stretch_frequency(const struct fiber_kind *kind);

/* Highest frequency of bending of a straight chain at its mean bond length b, 1/t0: sqrt(kappa lambda/(M b^2)), lambda
 * the largest eigenvalue of the fourth-difference matrix of a free chain (16 for N_v -> infinity and for rings). */
double theory_bend_frequency(const struct fiber_kind *kind);

/* Highest frequency of a straight chain at its mean bond length, 1/t0: the larger of stretching along the chain and of
 * motion across it, where bends and the tension of the bonds, k(1 - l0/b) per length, act together (the sum of their
 * two maxima, a close upper bound). A leap-frog of step dt is unstable above 2/dt. */
double theory_highest_frequency(const struct fiber_kind *kind);

/* Slowest Rouse mode of an open flexible chain without hydrodynamics, t0: zeta/(4 k sin^2(pi/2N_v)), zeta = kT/D_0. */
double theory_rouse_time(const struct fiber_kind *kind, double friction);

/* --- a suspension ------------------------------------------------------------------------------------------------ */

/* Fiber length per volume, sum of c L over all kinds, with the paper's L, 1/a0^2. */
double theory_line_density(const struct model *model);

/* Collisions of bonds per t0 in the whole box: that of an ideal gas of isotropic line segments of mean length <l> whose
 * ends have independent Maxwell velocities,
 *   (1/2) V sum_AB c_A <l>_A c_B <l>_B (pi/4) sqrt(2/pi) int ds ds' sqrt(w(s)/M_A + w(s')/M_B),  w(s) = (1-s)^2 + s^2.
 * Moving one vertex after the other adds some with dP < 0 and as many to undo them, so the algorithm executes
 * about 1.15 times as many. */
double theory_collision_rate(const struct model *model);

/* Total constant force on solvent and vertices, kT/a0; 0 is balanced. */
struct vec3 theory_net_force(const struct model *model);

#endif
