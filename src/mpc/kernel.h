/*
 * How a collision is done: the plain way (collide.c) or a faster one (src/kernel/). A faster one goes through several
 * particles or cells at once, and shorter ways where nobody reads the sums of cells. It gives the same bits of
 * positions, velocities, sums, turns and faults as the plain one (tests/contract/test_kernels, tests/kernel/).
 */
#ifndef UNCROSS_MPC_KERNEL_H
#define UNCROSS_MPC_KERNEL_H

#include "system/fault.h"
#include "system/model.h"
#include "system/state.h"

struct mpc;

/* Energies of any number of members, in units of 2^-32 kT. */
__extension__ typedef unsigned __int128 energy_sum;

/* Of all cells together. */
struct solved {
  /* The OR of all loads: in bits 0 to 39, and in bits 40 to 63, at least as large as each load of a cell. */
  uint64_t loads;
  uint64_t others; /* members but the first one, of all cells that have some: degrees of freedom per dimension where
                    * there are no virtual members (else cell_freedoms) */
};

/* The parts of which src/kernel/collide.c makes a collision. Nobody else reads them. */
struct kernel_ways {
  /* n particles, from place `first` of memory on, fly for the time by which the solvent is late, which is not 0. They
   * get their cells (mpc->solvent_cell, on the grid of mpc->shift) and are added to the sums there. The bitwise or of
   * what add_particles of struct collision_rule returns goes into *span. False, with the fault recorded, if one would
   * move too far. */
  bool (*gather)(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, uint32_t first,
                 uint32_t n, uint64_t *span, struct fault *fault);

  /* solve of struct collision_rule. Cells with fewer than two members get any finite center, and any axis. Returns
   * what all cells have together. `last`: nobody reads the sums after this. They may then be cleared, which sets
   * mpc->sum_is_clear. */
  struct solved (*solve)(const struct model *model, struct mpc *mpc, uint64_t step, bool last);

  /* Of n particles from place `first` of memory on, adds twice the kinetic energy relative to v_cm to mpc->relative of
   * their cells, or to *total instead, if it is not NULL. Returns the bitwise or of what was added; out of range it has
   * the sign bit, and *total is then of no use. */
  uint64_t (*energies)(const struct state *state, struct mpc *mpc, uint32_t first, uint32_t n, energy_sum *total);

  /* thermostat_canonical of all cells, where none has virtual members. last: as for solve; the sums may be cleared. */
  void (*canonical)(const struct model *model, struct mpc *mpc, uint64_t step, bool last);

  /* apply of struct collision_rule. */
  void (*turn)(struct state *state, const struct model *model, const struct mpc *mpc, bool scaled);

  /* gather may add to mpc->spin in halves (mpc->spin_in_halves), and solve takes them. */
  bool halves;
};

struct kernel {
  const char *name;

  /* mpc_collide (collide.h). */
  bool (*collide)(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step, struct fault *fault);

  struct kernel_ways ways; /* empty: the plain one */
};

extern const struct kernel kernel_plain;

#endif
