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

  /* True if the rule keeps the angular momentum of each cell. It then sums mpc->spin as well, and needs to know where
   * its virtual members are: their number is whole. */
  bool spinning;

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
};

extern const struct collision_rule srd_rule, at_a_rule, at_plus_a_rule;

/* The mean velocity of virtual members, a0/t0; in a plane without what was drawn along z. */
static inline struct vec3 rule_virtual_velocity(const struct model *model, const struct virtual_members *members)
{
  const struct vec3 v = members->velocity;
  return (struct vec3){v.x, v.y, model_is_flat(model) ? 0.0 : v.z};
}

/* The rule of a model. */
const struct collision_rule *collision_rule_of(const struct model *model);

#endif
