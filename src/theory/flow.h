/*
 * Flow between two walls a distance L apart, and what its slip does to it. Units a0 = kT = m = 1; `gamma`, `cosine` and
 * `interval` as in theory.h, `mass_density` is gamma with m = 1.
 *
 * Walls that reverse velocities and fill cut cells with virtual particles slip nevertheless: near a wall, the mean
 * velocity of a cell is an average over both rows of cells that its members visit, which obeys a Milne equation with a
 * triangular kernel. Extrapolated from the bulk, the flow has the wall's velocity at a distance b behind it.
 */
#ifndef UNCROSS_THEORY_FLOW_H
#define UNCROSS_THEORY_FLOW_H

#include "mpc/rule.h"
#include "system/model.h"

/* b of the Milne problem, a0, planar fill, at a mean free path of 0:
 * b = -1/pi int_0^inf dk k^-2 ln{12 [1 - (sin(k/2)/(k/2))^2]/k^2}. It is the same for all gamma, angles, and
 * dimensions. */
#define THEORY_MILNE_SLIP 0.2273508

/* Time between collisions below which the slip length is that of the Milne problem, t0. */
#define THEORY_MOST_SLIP_INTERVAL 0.3

/* Slip length of no-slip walls with planar fill, a0: b minus what bounce-back stops, sqrt(2/pi) dt_c/(1 - c), where the
 * fraction c of a particle's velocity remains after a collision. The paper's fill (gamma - N) slips 1 % more at gamma
 * 5, and 7 % more at gamma 3. For dt_c below THEORY_MOST_SLIP_INTERVAL. */
double theory_slip_length(const struct collision_rule *rule, uint32_t d, double gamma, double cosine, double interval);

/* Shear rate in the bulk of Couette flow, 1/t0: that of the walls over 1 + 2b/L. */
double theory_couette_rate(double wall_rate, double height, double slip);

/* Largest velocity of Poiseuille flow under a body force per mass, a0/t0: rho g L^2/(8 eta) (1 + 4b/L). */
double theory_poiseuille_speed(double mass_density, double acceleration, double height, double viscosity, double slip);

/* Largest velocity, a0/t0, of the flow that a force with a profile drives in a periodic box: rho g/(eta k^2) with
 * k = 2 pi/L for a sine, rho g L^2/(32 eta) for a force that changes sign at L/2. 0 for a uniform force. */
double theory_profile_speed(enum force_profile profile, double mass_density, double acceleration, double height,
                            double viscosity);

/* v_max/(nu k), k = 2 pi/L. Kolmogorov flow is stable below THEORY_STABLE_REYNOLDS, in boxes that are not longer along
 * the flow than across it (Meshalkin and Sinai, J. Appl. Math. Mech. 25, 1700 (1961)). */
double theory_profile_reynolds(double speed, double height, double kinematic_viscosity);
#define THEORY_STABLE_REYNOLDS 1.4142135623730951

/* L^2/(pi^2 nu), t0: in which a flow between walls becomes steady. */
double theory_flow_relaxation(double height, double kinematic_viscosity);

/* Time in which the slowest part of what the start still differs from a steady flow falls to 1/e, t0. Between walls
 * L^2/(pi^2 nu), a quarter of it where opposite velocities of the walls alone drive the flow: then it is odd about the
 * middle. A force with a profile: 1/(nu k^2), k = 2 pi/L. 0 where nothing flows, and in a sheared box, whose profile is
 * linear from the start. With dumbbells at least 1/omega_H, in a sheared box too. */
double theory_flow_transient(const struct model *model, double kinematic_viscosity);

/* sqrt(2 nu/omega), a0: in which the wave that goes out from an oscillating wall falls to 1/e. */
double theory_penetration_depth(double frequency, double kinematic_viscosity);

/* omega rho L^2/(8 eta): where it is not far below 1, an oscillation of the walls does not reach the middle in phase.
 */
double theory_inertia_number(double frequency, double mass_density, double height, double viscosity);

/* Root mean square of the shear rate of a sheared box over a period, 1/t0. */
double theory_mean_shear_rate(const struct model *model);

/* How the steady flow of the solvent shears what stands in it; no slip. */
struct theory_shear {
  double rate;         /* 1/t0, the largest: of a sheared box and of sliding walls the amplitude; with a force between
                        * walls rho g L/(2 eta) in addition, at the walls; rho g/(eta k) for a sine, rho g L/(4 eta)
                        * for a force that changes sign */
  double bead, radius; /* V of a driven bead, a0/t0, and its R, a0 */
  double sound, kinematic; /* c_s, a0/t0, and nu, a0^2/t0, of the loaded fluid; 0 where nothing shears */
};
struct theory_shear theory_shear_of(const struct model *model);

/* By how much the solvent's velocity may differ over a distance, a0/t0: the rate times the distance, and beside a bead
 * at most its V in addition. */
double theory_shear_speed(const struct theory_shear *shear, double distance);

/* dT/dt of an insulated flow, kT/t0: 2 eta rate^2/(d rho), d the number of dimensions. */
double theory_flow_heating(double viscosity, double rate, double mass_density, uint32_t dimensions);

#endif
