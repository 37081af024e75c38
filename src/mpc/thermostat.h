/* Thermostats scale velocities relative to the center of mass of each collision cell, so they conserve momentum. */
#ifndef UNCROSS_MPC_THERMOSTAT_H
#define UNCROSS_MPC_THERMOSTAT_H

#include "mpc/mpc.h"

struct thermostat {
  const char *name; /* as in scenes */

  bool layered; /* fixes the energy of each row of cells along y; else that of none, or of all together */
  bool common;  /* one factor for all cells: thermostat_set_factor may take the place of `factors` (src/kernel/) */

  /* Sets the factor of every cell that has members to collide, from the relative kinetic energies (mpc->relative). */
  void (*factors)(struct mpc *mpc, const struct model *model, uint64_t step);
};

/* The thermostat of this kind; NULL: none. */
const struct thermostat *thermostat_of(enum thermostat_kind kind);

/* Sets the one factor of all cells, from what they have together: degrees of freedom, and twice their relative kinetic
 * energy. The factor is 1 if there is no energy. */
void thermostat_set_factor(struct mpc *mpc, double freedoms, energy_sum energy);

/* `maxwell-boltzmann`, canonical: each cell's relative kinetic energy is drawn afresh from its Gamma distribution of
 * d (N-1) degrees of freedom, N with virtual particles as one (Huang, Chatterji, Sutmann, Gompper and Winkler, J.
 * Comput. Phys. 229, 168 (2010)). Of the cells from place `begin` on it needs sum, turn and relative, and sets the
 * factors of those that collide. */
void thermostat_canonical(const struct model *model, struct mpc *mpc, uint64_t step, uint32_t begin);

/* Degrees of freedom of the members of a cell relative to its v_cm, with kT/2 each: d (N - M/(M + n)) for N members of
 * mass M, d dimensions, and n virtual particles, which have a share in v_cm. That is d (N - 1) where there are none.
 * For cells that collide (turn.active). */
double cell_freedoms(const struct mpc *mpc, const struct model *model, uint32_t place);

/* A Gamma(shape, 1) deviate for this cell and step, shape >= 1 (Marsaglia and Tsang, ACM TOMS 26, 363 (2000)). */
double thermostat_gamma(uint64_t seed, uint64_t step, uint32_t cell, double shape);

/* thermostat_gamma of n cells, n <= RANDOM_UNIFORMS: gamma[n] of shape[n], to the bit, in loops that vectorise. */
void thermostat_gammas(uint64_t seed, uint64_t step, const uint32_t *cell, const double *shape, uint32_t n,
                       double *gamma);

#endif
