/*
 * Baths other than that of collision cells (mpc/), the same one operator (bath.h) with two choices of partner:
 *
 *   private   private.c: each component of a vertex's velocity, about the flow
 *   pairs     near.c finds all pairs of members that are nearer than 1 a0; encounters.c chooses among them; pairs.c
 * acts on one after the other, in a random order, on the component of their relative velocity along the line between
 * them
 *
 * Pairs may also exert forces on each other: repulsion.c.
 *
 * Members are solvent particles and vertices: particle id i has the number i, vertex v the number particles + v. All
 * random numbers of a pair are addressed by its two numbers, so nothing depends on the order in memory, to the bit.
 */
#ifndef UNCROSS_MEDIUM_MEDIUM_H
#define UNCROSS_MEDIUM_MEDIUM_H

#include "medium/bath.h"
#include "system/fault.h"
#include "system/fluid.h"
#include "system/state.h"

struct mover {
  struct vec3 velocity; /* a0/t0 */
  double mass;          /* m */
};

/* A pair on which the bath acts. */
struct encounter {
  struct vec3 along; /* unit vector from b to a, or from a to b: the result is the same to the bit */
  double loss;       /* 1 - c */
  double noise;      /* a0/t0: amplitude times a normal number */
  uint32_t a, b;     /* places of the members */
};

/* Scratch. Members are sorted by cell: the cells of edge 1 a0 of the grid without shift, (z Ly + y) Lx + x. */
struct medium {
  const struct fluid *fluid;
  uint32_t members;
  uint32_t *place;     /* [members] of each in the order of the state: particles as they stand in memory, vertices */
  uint32_t *first;     /* [cells + 1] place of the first member of each cell */
  double *x, *y, *z;   /* [members] a0, in the box, exact */
  uint32_t *number;    /* [members] */
  struct mover *mover; /* [members] */

  struct encounter *encounter; /* [room] */
  uint64_t *key, *spare;       /* [room] order 2^32 + place in encounter */
  uint32_t encounters, room;

  int64_t *push;  /* [3 members] of the member at a place, units of REPULSION_UNIT kT/a0: sums do not depend on order */
  int64_t *crowd; /* [members] density about the member at a place, units of CROWD_UNIT 1/a0^3; with many_body */
  struct vec3 *force; /* [members] kT/a0, of the member with this number */
};

/* Allocates what this model's medium uses; nothing without one. False if memory is short. */
bool medium_alloc(struct medium *medium, const struct model *model, const struct fluid *fluid);
void medium_free(struct medium *medium);

/* Bytes that medium_alloc allocates. */
uint64_t medium_bytes(const struct model *model);

/* Bytes that the list of pairs grows to, and that repulsion_measure takes for a while. */
uint64_t medium_bytes_later(const struct model *model);

/* The bath's action of step number `step`. Particles are streamed before. False, with the fault recorded, if a flight
 * is too far or memory is short. */
bool private_collide(struct state *state, const struct model *model, struct medium *medium, uint64_t step,
                     struct fault *fault);
bool pairs_collide(struct state *state, const struct model *model, struct medium *medium, uint64_t step,
                   struct fault *fault);

/* The same of encounters that are listed already (repulsion_forces_and_encounters), with the velocities of now. */
void pairs_act(struct state *state, struct medium *medium);

/* Gives the members the velocities that the state has now, in the order in memory that it had for members_gather. */
void members_take_velocities(const struct state *state, struct medium *medium);

/* --- parts of pairs_collide, for tests --- */

/* Fills the members' columns, sorted by cell, from the state. Particles must be in the box, and not late. */
void members_gather(const struct state *state, const struct model *model, struct medium *medium);

/* Writes velocities back; particles are then in memory as the members are. */
void members_scatter(struct state *state, const struct medium *medium);

/* How many pairs that list has in the mean, of an ideal gas of members, where the draw chooses at most so many: each
 * has 4 pi/3 others within 1 a0 for each member in a cell. 0 without a bath of pairs. */
double encounters_expected(const struct model *model);

/* Lists all pairs on which the bath acts in this step, in no particular order. False if memory is short. */
bool encounters_find(const struct model *model, struct medium *medium, uint64_t step);

/* Sorts the keys by the random order of pairs; where two are equal, by the numbers of the members. */
void encounters_order(struct medium *medium);

/* The change of the velocities of both members. */
void encounter_act(const struct encounter *encounter, struct mover *mover);

#endif
