/*
 * What a collision does at the boundary of the box along y. This is the contract of the rows in border.c. A step of
 * NULL is left out.
 *
 * The order within a collision: enter, bin_particles (both block by block), enter_vertices, bin_vertices, the rule's
 * sums, rebound, fill, the rule's turns, the thermostat, the new velocities, account, leave.
 *
 * A cell that a wall cuts is filled up with virtual particles, whose velocities are of the Maxwell distribution about
 * the velocity of the wall. To SRD and AT-a they are one member: n of them have the mass n, and the mean of their
 * velocities has the variance kT/n per component. To AT+a each of them has a place as well.
 */
#ifndef UNCROSS_MPC_BORDER_H
#define UNCROSS_MPC_BORDER_H

#include "mpc/mpc.h"

/* All virtual particles of a cell, each of mass 1: the phantoms of a random solvent, or those beyond a wall. */
struct virtual_members {
  double n;             /* their number, a multiple of MODEL_MASS_UNIT; 0: none */
  struct vec3 velocity; /* their mean velocity, a0/t0 */
  struct vec3 flow;     /* velocity about which each is drawn, a0/t0 */
  double low, high;     /* they lie where the y coordinate within the cell is between these, a0 */
  uint32_t aside;       /* added to the cell's number where their random numbers are addressed: a wall's have 0 */
};

struct border {
  const char *name;

  /* Fills mpc->solvent_cell of n particles from place `first` on, and mpc->vertex_cell of all vertices, on the grid of
   * mpc->shift. */
  void (*bin_particles)(const struct state *state, const struct model *model, uint32_t first, uint32_t n,
                        struct mpc *mpc);
  void (*bin_vertices)(const struct state *state, const struct model *model, struct mpc *mpc);

  /* Gives members whose cell is beyond the boundary the position and velocity of their image there, until `leave`. Adds
   * particles to those that have entered: mpc->entered is 0 before the first call. */
  void (*enter)(struct state *state, const struct model *model, uint32_t first, uint32_t n, struct mpc *mpc);
  void (*enter_vertices)(struct state *state, const struct model *model, struct mpc *mpc);
  void (*leave)(struct state *state, const struct model *model, struct mpc *mpc);

  /* Adds virtual particles to the sums of cells. False, with the fault recorded, if a cell exceeds its range. */
  bool (*fill)(const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
               struct fault *fault);

  /* Adds the momentum that virtual particles have given to the others to the account of the state. */
  void (*account)(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step);
};

extern const struct border border_periodic, border_walls, border_sheared;

/* What stands in the box, in the way of the solvent. A higher room gives it to struct mpc. Its `fill` and `account`
 * come after those of the border. */
struct obstacle {
  void *room; /* its scratch */

  /* After all particles have been added: gives those their true flights that meet it. span: as add_particles returns
   * it, of all; may grow. False, with the fault recorded, if a flight is out of range. */
  bool (*rebound)(void *room, struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                  uint64_t *span, struct fault *fault);

  /* As of struct border. */
  bool (*fill)(void *room, const struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
               struct fault *fault);
  void (*account)(void *room, struct state *state, const struct model *model, struct mpc *mpc, uint64_t step);
};

/* The virtual particles of the cell at this place in sum; n is 0 in cells that no wall cuts. */
struct virtual_members border_virtual(const struct mpc *mpc, const struct model *model, uint32_t place);

/* The border of a model's box. */
const struct border *border_of(const struct model *model);

#endif
