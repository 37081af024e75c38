/*
 * Every number that follows from a model without a run: the paper's transport coefficients and dimensionless numbers,
 * exact averages of a phantom chain, frequencies, rates. One function per equation.
 *
 * Units a0 = kT = m = 1. `cosine` is that of the rotation angle alpha; `gamma` the mean number of solvent particles per
 * cell; `interval` is dt_c; d is 2 or 3, the number of dimensions (model->dimensions). Formulas of the solvent assume
 * molecular chaos; at a mean free path of 0.02 a0 they are some per cent off (docs/accuracy.md).
 */
#ifndef UNCROSS_THEORY_THEORY_H
#define UNCROSS_THEORY_THEORY_H

#include <stdbool.h>

#include "mpc/rule.h"
#include "system/model.h"

/* --- solvent ----------------------------------------------------------------------------------------------------- */

/* gamma - 1 + exp(-gamma): mean of (n - 1) over the cells with n > 0 members, n Poisson of mean gamma. */
double theory_partners(double gamma);

/* Kinetic viscosity, m/(a0 t0): gamma dt_c [1/(1 - c) - 1/2], where the fraction c of the kinetic stress remains after
 * a collision (stress_loss of theory/chaos.h). For SRD: Padding 2009, Eq. (30). */
double theory_viscosity_kinetic(const struct collision_rule *rule, uint32_t d, double gamma, double cosine,
                                double interval);

/* Collisional viscosity, m/(a0 t0): the momentum that a collision hands on (handed_on), divided by dt_c.
 * For SRD: Padding 2009, Eq. (31). */
double theory_viscosity_collisional(const struct collision_rule *rule, uint32_t d, double gamma, double cosine,
                                    double interval);

/* eta: the sum of both. nu = eta / (m gamma) is the kinematic viscosity (Padding 2009, below Eq. 31). */
double theory_viscosity(const struct collision_rule *rule, uint32_t d, double gamma, double cosine, double interval);

/* Self-diffusion coefficient of a solvent particle, a0^2/t0: D = kT dt_c/m [1/(1-c) - 1/2], where the fraction c of its
 * velocity remains after a collision: that of a vertex of mass 1. */
double theory_solvent_diffusion(const struct collision_rule *rule, uint32_t d, double gamma, double cosine,
                                double interval);

/* Sc = nu / D of the solvent: the ratio of the diffusion of momentum to that of particles (Padding 2009, Sec. IV A). */
double theory_schmidt(const struct collision_rule *rule, uint32_t d, double gamma, double cosine, double interval);

/* c_s, a0/t0: sqrt((d + 2)/d) where energy is conserved (Padding 2009, below Eq. 36, for d = 3), 1 where a thermostat
 * holds kT. */
double theory_sound_speed(bool isothermal, uint32_t d);

/* Mean free path: distance of a solvent particle between two collisions, dt_c sqrt(kT/m), a0. */
double theory_mean_free_path(double interval);

/* --- a single vertex --------------------------------------------------------------------------------------------- */

/* Fraction c of its velocity that a vertex of this mass keeps in a collision, alone among n solvent particles, n
 * Poisson: c = 1 - <velocity_loss>; for SRD in space 1 - (2/3)(1 - cos alpha) <n m/(M + n m)>. */
double theory_vertex_retention(const struct collision_rule *rule, uint32_t d, double mass, double gamma, double cosine);

/* D_0 = kT dt_c/M [1/(1-c) - 1/2], a0^2/t0: diffusion without hydrodynamic correlations. */
double theory_vertex_diffusion(const struct collision_rule *rule, uint32_t d, double mass, double gamma, double cosine,
                               double interval);

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

/* <l^2> of a bond in equilibrium, a0^2. The mean bond length is fiber_mean_bond (system/fiber_kind.h). */
double theory_bond_square(const struct fiber_kind *kind);

/* Chance that a bond in equilibrium is longer than `limit`. */
double theory_bond_tail(const struct fiber_kind *kind, double limit);

/* <cos theta> between successive bonds in equilibrium: coth kappa - 1/kappa; in a plane, d = 2, I_1(kappa)/I_0(kappa).
 */
double theory_bend_cosine(double bending, uint32_t d);

/* L as the paper counts it: N_v l0; the contour length where l0 = 0. */
double theory_length(const struct fiber_kind *kind);

/* l_p = kappa l0 as the paper sets it, a0; the effective one, -<l>/ln<cos theta>, where l0 = 0. */
double theory_persistence(const struct fiber_kind *kind);

/* The decay length of tangent correlations, -<l>/ln<cos theta>, a0; 0 for a freely jointed chain. */
double theory_effective_persistence(const struct fiber_kind *kind);

/* <R^2> between the ends of an open fiber in equilibrium, exact for the phantom chain, a0^2. */
double theory_end_to_end_square(const struct fiber_kind *kind);

/* A distance that two vertices of a fiber hardly exceed, a0: the length L, or twice R_e where that is shorter (a
 * Gaussian chain has R > 2 R_e in one of 135 shapes); half of this in a ring. */
double theory_reach(const struct fiber_kind *kind);

/* Slowest Rouse mode of an open flexible chain without hydrodynamics, t0: zeta/(4 k sin^2(pi/2N_v)), zeta = kT/D_0. */
double theory_rouse_time(const struct fiber_kind *kind, double friction);

/* --- a suspension ------------------------------------------------------------------------------------------------ */

/* Fiber length per volume, sum of c L over all kinds, with the paper's L, 1/a0^2. */
double theory_line_density(const struct model *model);

/* Collisions of bonds per t0 in the whole box: that of an ideal gas of isotropic line segments of mean length <l> whose
 * ends have independent Maxwell velocities,
 *   (1/2) V sum_AB c_A <l>_A c_B <l>_B (pi/4) sqrt(2/pi) int ds ds' sqrt(w(s)/M_A + w(s')/M_B),  w(s) = (1-s)^2 + s^2.
 * That is of bonds of different fibers, or far apart along a fiber. NAN if memory is short. */
double theory_collision_rate(const struct model *model);

/* Contacts per t0 in the whole box by kinetic theory: those of the ideal gas, and of fibers with themselves. */
double theory_contact_rate(const struct model *model);

/* Contacts that the model's crossing rule is expected to answer. event-driven: theory_contact_rate. A rule that moves
 * one vertex after the other finds some with dP < 0 and as many to undo them: 1.15 times as many in all
 * (docs/accuracy.md). */
double theory_executed_rate(const struct model *model);

/* Collisions per t0 of bonds of the same fiber, for all fibers of a kind without bending stiffness: exact for springs
 * without rest length in equilibrium (phantom chains); with a rest length, for a Gaussian chain of the same <l^2>.
 * Bonds p and q with n bonds between them on one side and n' on the other (in an open fiber 1/n' = 0), b^2 = <l^2>/3,
 * touch at s and s' at the rate (2 pi b^2 n n'/(n + n' + 2))^(-3/2) |A|^(-2) 2 b^2 sqrt(2/pi) sqrt((w(s) + w(s'))/M) ds
 * ds', A = 1 + g g^T/n + h h^T/n',  g = (1-s, s'),  h = (s, 1-s'), the density of the vector between the two points at
 * zero, <|p x q|> there, and the mean relative speed. 0 for stiff fibers, which rarely touch themselves. */
double theory_self_collision_rate(const struct fiber_kind *kind);

/* Total constant force on solvent and vertices, kT/a0; 0 is balanced. */
struct vec3 theory_net_force(const struct model *model);

#endif
