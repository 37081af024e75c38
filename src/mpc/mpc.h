/*
 * Multi-particle collisions (Padding 2009, Sec. III, step 4): the scratch of this room, and the stage that it adds to a
 * step. The algorithm is in collide.c. The collision rule (rule.h) says what happens in one cell.
 */
#ifndef UNCROSS_MPC_MPC_H
#define UNCROSS_MPC_MPC_H

#include "mpc/kernel.h"
#include "system/fluid.h"
#include "system/model.h"
#include "system/state.h"

/* Sums over the members of a collision cell. They are integers, so that they do not depend on the order of the members.
 */
struct cell_sum {
  int64_t px, py, pz; /* momentum, in units of 2^-44 m a0/t0 */
  uint64_t load;      /* members * 2^40 + mass in units of 2^-16 m */
};

/* The change of velocity that a cell gives to each of its members. For SRD: v' = v_cm + factor R (v - v_cm). One cache
 * line; AT-a reads its first half alone. */
struct cell_turn {
  struct vec3 center; /* v_cm */
  double active;      /* 0: fewer than two members, velocities stay as they are */
  struct vec3 axis;   /* unit vector of R */
  double factor;      /* 1, or the thermostat's */
};

struct virtual_members;

struct mpc_stress;

struct mpc {
  const struct collision_rule *rule;
  const struct thermostat *thermostat; /* NULL: none */
  const struct fluid *fluid;
  const struct border *border;
  const struct obstacle *obstacle; /* NULL: none */
  struct kernel kernel;            /* the plain one, unless work_alloc has a faster one for this scene */
  struct point shift;              /* of the grid (grid_shift), lattice units */
  uint32_t cells;                  /* all cells of the box; with a random solvent, those that hold a vertex */
  struct cell_sum *sum;            /* [cells] */
  struct cell_turn *turn;          /* [cells] */
  int64_t *relative;      /* [cells] twice the kinetic energy relative to v_cm, 2^-32 kT; thermostat only, else NULL.
                           * Not filled where one sum of all cells will do (kernel/collide.c) */
  uint32_t *solvent_cell; /* [particles] place of the particle's cell in sum and turn, in memory order */
  uint32_t *vertex_cell;  /* [vertices] the same for vertices */
  uint32_t *occupied;     /* [vertices] numbers of the cells that hold a vertex; random solvent only, else NULL */
  uint32_t *table;        /* [2^table_bits] hash table: 1 + place in occupied, or 0; random solvent only, else NULL */
  uint32_t table_bits;
  struct virtual_members
      *filled;               /* [2 Lx Lz] virtual particles of the cells that walls cut, of this collision: the row
                              * of y = 0, then that of y = L, cell (z, x) of each at z Lx + x; NULL without walls */
  uint32_t *order;           /* [particles] sorting and velocity swap; in a collision, who entered (border.h) */
  uint32_t entered;          /* particles that did */
  uint32_t *slot;            /* [particles] velocity swap only, else NULL */
  uint32_t *slot_ids;        /* [particles] the same: ids in memory order, of when slot was made */
  int64_t *column;           /* [particles] one column while it is permuted */
  double *drawn[3];          /* [particles] velocities that a thermal rule has drawn, else NULL */
  struct vec3 *drawn_vertex; /* [vertices] the same */
  struct mpc_stress *stress; /* where to sum the stress (stress.h); NULL: nobody asks for it */
  struct cell_spin *spin;    /* [cells] sums of a rule with angular momentum (rules/spin.h), else NULL */
  bool spin_in_halves;       /* they are in halves: of src/kernel/, from the first particle until cells are solved */
  bool spin_is_clear;        /* all of `spin` is 0: the rule clears each cell when it has solved it */
  struct point *middle; /* [cells + 1] of the same rule: place in the cell next to its centre of mass, lattice units.
                         * The last one is read, and not used, where four words are read for three */
  bool prefetch;        /* sums and turns of cells are far in memory: they are asked for ahead of their use */
  uint32_t since_sort;  /* collisions since particles were last sorted by cell */
  bool sum_is_clear;    /* of src/kernel/: all of `sum` is 0, cleared when nobody needed it any more */
  bool keeps_sums;      /* of src/kernel/, for tests: it never clears them */
};

/* Allocates the scratch for the collisions of this model. `everything`: also what only other scenes need, for callers
 * of single parts of a collision (oracle, tests). False if memory is short. */
bool mpc_alloc(struct mpc *mpc, const struct model *model, const struct fluid *fluid, bool everything);
void mpc_free(struct mpc *mpc);

/* Bytes that mpc_alloc allocates without `everything`. */
uint64_t mpc_bytes(const struct model *model);

/* Number of the cell at this place in sum and turn. */
static inline uint32_t mpc_cell(const struct mpc *mpc, uint32_t place)
{
  return mpc->occupied ? mpc->occupied[place] : place;
}

#endif
