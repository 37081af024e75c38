/*
 * work: scratch that can be rebuilt from model and state at any time. Nothing in it changes a result: a run whose work
 * is thrown away and rebuilt after every step ends in the same bits.
 */
#ifndef UNCROSS_WORK_H
#define UNCROSS_WORK_H

#include <stdbool.h>
#include <stdint.h>

#include "base/lattice.h"
#include "state/fault.h"
#include "state/model.h"

/* --- solvent ----------------------------------------------------------------------------------------------------- */

/* Sums over the members of a collision cell, in integers: the same whatever the order of the members. */
struct cell_sum {
  int64_t px, py, pz; /* momentum, in units of 2^-44 m a0/t0 */
  uint64_t load;      /* members * 2^40 + mass in units of 2^-16 m */
};

/* What a cell does to each of its members: v' = v_cm + factor R (v - v_cm). One cache line. */
struct cell_turn {
  struct vec3 center; /* v_cm */
  struct vec3 axis;   /* unit vector of R */
  double factor;      /* 1, or the thermostat's */
  double active;      /* 0: fewer than two members, velocities stay as they are */
};

struct collision_work {
  struct cell_sum *sum;   /* [cells] */
  struct cell_turn *turn; /* [cells] */
  int64_t *relative;      /* [cells] twice the kinetic energy relative to v_cm, 2^-32 kT; thermostat only, else NULL */
  uint32_t *solvent_cell; /* [particles] in memory order */
  uint32_t *vertex_cell;  /* [vertices] */
  uint32_t *order;        /* [particles] sorting and velocity swap */
  uint32_t *slot;         /* [particles] velocity swap only, else NULL */
  int64_t *column;        /* [particles] one column while it is permuted */
  uint32_t since_sort;    /* collisions since particles were last sorted by cell */
};

/* --- fibers ------------------------------------------------------------------------------------------------------ */

/* A partner bond that may be touched: bond number, and the image of it, in box edges. */
struct neighbor {
  int32_t bond;
  int32_t image[3];
};

/* A bond stays inside its margin box; two bonds whose margin boxes do not overlap cannot touch. Unwrapped. */
struct margin_box {
  struct point low, high;
};

/* A bond's entry in one cell of the search grid, in a linked list; image is the one that puts the bond there. */
struct grid_entry {
  int32_t bond;
  int32_t next; /* entry, -1 at the end */
  int32_t image[3];
};

struct neighbors {
  bool built;
  int64_t margin;         /* lattice units around a bond when its margin box is drawn */
  struct margin_box *box; /* [vertices] by bond */
  uint32_t *count;        /* [vertices] partners of each bond */
  struct neighbor *list;  /* [vertices * stride] */
  uint32_t stride;
  int32_t cells[3];            /* of the search grid */
  int64_t cell_edge[3];        /* lattice units */
  int32_t *head;               /* [search cells] first entry, -1 if none */
  struct grid_entry *entry;    /* [entries] */
  int32_t entries, free_entry; /* allocated; head of the list of unused ones */
  uint64_t redrawn;            /* margin boxes drawn so far, for benchmarks */
};

struct fiber_work {
  uint32_t *order;        /* [vertices] of the sweep */
  struct vec3 *force;     /* [vertices] kT/a0 */
  struct vec3 *direction; /* [vertices] unit vector of bond j; longest fiber suffices, kept per vertex for simplicity */
  double *inverse_length; /* [vertices] of bond j */
  struct neighbors neighbors;
};

struct work {
  struct collision_work collision;
  struct fiber_work fiber;
  struct fault fault; /* code FAULT_NONE while all is well */
};

/* Room for what this model uses; parts that it does not use stay NULL. False if memory is short. */
bool work_alloc(struct work *work, const struct model *model);
void work_free(struct work *work);

/* Bytes that state and work of this model take, before lists grow. */
uint64_t work_bytes(const struct model *model);

/* Records the first fault of a run; later ones are consequences. Returns false, for `return work_fault(...)`. */
bool work_fault(struct work *work, enum fault_code code, uint64_t step, int64_t entity, double value, double limit);

#endif
