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
  uint32_t cells;         /* all cells of the box; in a bath of phantoms, those that hold a vertex */
  struct cell_sum *sum;   /* [cells] */
  struct cell_turn *turn; /* [cells] */
  int64_t *relative;      /* [cells] twice the kinetic energy relative to v_cm, 2^-32 kT; thermostat only, else NULL */
  uint32_t *solvent_cell; /* [particles] in memory order */
  uint32_t *vertex_cell;  /* [vertices] place in sum and turn */
  uint32_t *occupied;     /* [vertices] numbers of the cells that hold a vertex; phantoms only, else NULL */
  uint32_t *table;        /* [2^table_bits] hash table: 1 + place in occupied, or 0; phantoms only, else NULL */
  uint32_t table_bits;
  uint32_t *order;     /* [particles] sorting and velocity swap */
  uint32_t *slot;      /* [particles] velocity swap only, else NULL */
  int64_t *column;     /* [particles] one column while it is permuted */
  uint32_t since_sort; /* collisions since particles were last sorted by cell */
};

/* Number of the cell at this place in sum and turn. */
static inline uint32_t collision_cell(const struct collision_work *c, uint32_t place)
{
  return c->occupied ? c->occupied[place] : place;
}

/* --- fibers ------------------------------------------------------------------------------------------------------ */

/* Another bond that may be touched: bond number, and the image of it, in box edges. */
struct neighbor {
  int32_t bond;
  int32_t image[3];
};

struct neighbor_list {
  uint32_t count, room;
  struct neighbor *at;
};

/* Two bonds that may touch in this sweep, as one of them has it. */
struct meeting {
  uint32_t bond;
  struct neighbor with;
  uint32_t next; /* 1 + the number of the bond's next meeting, or 0 */
};

struct meeting_list {
  uint32_t count, room;
  struct meeting *at;
  uint32_t *first; /* [bonds] as `next` */
};

/* Where a vertex stood when its bonds last looked for partners. */
struct anchor {
  struct point at; /* unwrapped */
  double reach;    /* a0: how far the vertex may be from there */
};

struct image {
  int32_t k[3]; /* in box edges */
};

/* Pairs of bonds that may touch before an end of either takes a new anchor, and for how long they cannot: while their
 * paths together are not longer than `limit`. */
struct pair_list {
  uint32_t count, room;
  uint32_t *bond, *other;
  uint32_t *limit;      /* as path, below, modulo 2^32 */
  uint32_t *generation; /* both bonds', added up, when the pair was found; if it is more now, the pair is out of date */
  struct image *image;  /* of the other one */
};

struct bond_clock {
  uint32_t path;       /* how far the ends have gone at most, in units of 2^-20 a0, modulo 2^32 */
  uint32_t generation; /* how many times it has looked for partners */
};

/* Rows start in the grid itself, and move out when they have grown. */
enum { NEIGHBORS_FIRST_ENTRIES = 15 };

/* A bond that touches a search cell. */
struct grid_entry {
  int32_t bond;
  int8_t image[3];         /* that puts it there, counted from the one in which the anchor of its first end lies */
  uint8_t starts;          /* bit k: the box around it does not reach back beyond the cell along axis k */
  uint8_t low[3], high[3]; /* that box, in 2^cell_shift lattice units from the lower corner of the cell */
};

/* Bonds that touch a search cell; the first few in the row itself, four cache lines in all. */
struct grid_row {
  _Alignas(64) struct grid_entry *at;
  uint32_t count, room;
  struct grid_entry first[NEIGHBORS_FIRST_ENTRIES];
};

struct neighbors {
  bool built;
  struct anchor *anchor;    /* [vertices] */
  struct bond_clock *clock; /* [vertices] of their bonds, used or not */
  struct pair_list pairs;
  int32_t cells[3];     /* of the search grid */
  int64_t cell_edge[3]; /* lattice units */
  int cell_shift[3];    /* 2^cell_shift: about a 256th of that */
  uint32_t cell_count;
  struct grid_row *entries; /* [cell_count] */
  struct point moved;       /* how far everything has moved as one since anchors were first taken */
  uint64_t renewed;         /* anchors taken so far, for benchmarks */
};

struct fiber_work {
  uint32_t *order; /* [vertices] of the sweep */
  uint32_t *rank;  /* [vertices] order[rank[i]] = i; this and all up to meetings.first for noncrossing fibers only */
  double *range; /* [vertices] a0: how far at most a vertex may go in this sweep, from where it was at its beginning */
  uint32_t *queue; /* [vertices] those that wait for their turns, in order: the first `queued` */
  uint32_t queued;
  uint8_t *waits; /* [vertices] 1: moves when its turn comes, 0: at once */
  struct meeting_list meetings;
  struct neighbor_list near; /* scratch */
  struct vec3 *force;        /* [vertices] kT/a0 */
  struct neighbors neighbors;
  uint64_t waited, called_back; /* moves so far that waited for their turn; of these, called back: for benchmarks */
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

/* FAULT_NO_MEMORY, likewise. */
bool work_no_memory(struct work *work, uint64_t step);

#endif
