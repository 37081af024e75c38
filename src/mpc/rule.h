/*
 * A collision rule: what happens to the members of one cell. This is the contract of the rows in rule.c.
 *
 * Solvent particles, vertices and the particles of a random solvent are all members: a member is a mass and a velocity.
 * A collision finds the cells of all members (mpc->solvent_cell, .vertex_cell) and sets the sums to zero. Then it calls
 * add_particles (block by block), add_vertices, solve, and apply. Every rule conserves or guarantees:
 *
 * - the momentum of each cell, to the rounding of its sum (2^-44 m a0/t0 per member);
 * - the velocity of a member that is alone in its cell;
 * - the Maxwell distribution at kT = 1 about any common velocity;
 * - the same bits for any order of particles in memory: sums are integers (cell.h), and random numbers are addressed by
 *   cell, by particle id, or by vertex.
 *
 * tests/contract/ tests every row.
 */
#ifndef UNCROSS_MPC_RULE_H
#define UNCROSS_MPC_RULE_H

#include "mpc/border.h"

struct collision_rule {
  const char *name; /* as in scenes */

  /* True if the rule draws its members' velocities anew. Such a rule keeps kT = 1 by itself and does not conserve
   * energy. It stores the drawn velocities in mpc->drawn and .drawn_vertex, between add and apply. */
  bool thermal;

  /* Adds n particles, from place `first` of memory on, to the sums of their cells. Returns a number that is at least
   * the size of each momentum component that was added, in momentum units (cell_add). */
  uint64_t (*add_particles)(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                            uint32_t first, uint32_t n);

  /* Adds all vertices to the sums of their cells. Returns the same. */
  uint64_t (*add_vertices)(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step);

  /* Adds virtual particles to the cell at this place in sum. */
  void (*add_virtual)(const struct model *model, struct mpc *mpc, uint64_t step, uint32_t place,
                      const struct virtual_members *members);

  /* The momentum that they gain in the collision, m a0/t0, once `turn` is set; `scaled` as in apply. The other members
   * of the cell lose as much. */
  struct vec3 (*virtual_gain)(const struct model *model, const struct mpc *mpc, uint64_t step, uint32_t place,
                              const struct virtual_members *members, bool scaled);

  /* Sets `turn` of every cell from its sum, with factor 1. */
  void (*solve)(const struct model *model, struct mpc *mpc, uint64_t step);

  /* Changes the velocities of all members by the turns of their cells. `scaled`: relative velocities are multiplied by
   * the thermostat's factor. */
  void (*apply)(struct state *state, const struct model *model, const struct mpc *mpc, bool scaled);

  /* Molecular chaos: averages over cells of Poisson occupation with a mean of n particles, P_n = n - 1 + exp(-n).
   * velocity_loss and stress_loss: the fraction of a particle's velocity, and of the kinetic stress, that a collision
   * removes, as multiples of P_n/n. handed_on: the momentum that passes through a cell, as a multiple of P_n (m a0^2).
   * cosine: of the rotation angle. */
  double (*velocity_loss)(double cosine);
  double (*stress_loss)(double cosine);
  double (*handed_on)(double cosine);
};

extern const struct collision_rule srd_rule, at_a_rule;

/* The rule of a model. */
const struct collision_rule *collision_rule_of(const struct model *model);

#endif
