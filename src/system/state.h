/*
 * state: exactly what a restart needs. Everything else in a run is either model (it never changes) or work (it can be
 * rebuilt).
 *
 * Between steps the velocities of vertices belong to the half step ahead, v(t + dt/2): the leap-frog of Padding's
 * Eqs. (3), (4), (7), (8). Solvent particles fly freely between collisions, so they are streamed once per collision
 * interval: the stored positions are solvent_lag half steps old.
 */
#ifndef UNCROSS_SYSTEM_STATE_H
#define UNCROSS_SYSTEM_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/lattice.h"
#include "system/model.h"

/* One array per component, in memory order. Particles are sorted by cell now and then; `id` tells which particle stands
 * at a place. */
struct solvent {
  uint32_t n;
  int64_t *x, *y, *z;   /* lattice units, within the box */
  double *vx, *vy, *vz; /* a0/t0 */
  uint32_t *id;         /* 0 .. n-1, each once */
};

/*
 * Dumbbells: pairs of solvent particles with a spring between them (Tao, Goetze and Gompper 2008). Particles 2k and
 * 2k + 1 are dumbbell k. The dumbbells stand before all other particles in memory: place p of this list has the
 * places 2p and 2p + 1 of the solvent.
 *
 * A spring may be longer than the box, so its vector is part of the state: position of the first particle less that of
 * the second, before both were brought into the box.
 */
struct dumbbells {
  uint32_t n;
  uint32_t *id;       /* 0 .. n-1, each once */
  int64_t *x, *y, *z; /* lattice units */
};

/* Velocity of the particle at place i of memory, at the time to which it was last streamed. */
static inline struct vec3 solvent_velocity(const struct solvent *s, uint32_t i)
{
  return (struct vec3){s->vx[i], s->vy[i], s->vz[i]};
}

/* Counts of crossings since the start (Padding 2009, Sec. III A, where they are called collisions). */
struct collision_counts {
  uint64_t moves;    /* trial moves of vertices */
  uint64_t possible; /* hits found */
  uint64_t executed; /* hits answered: the move is rejected and momentum is exchanged */
  uint64_t negative; /* of the executed ones, those with an impulse dP < 0 (footnote 61) */
  uint64_t softened; /* of the executed ones, those with a softened rebound (contact/impulse.h) */
  uint64_t rigid;    /* contacts that no impulse answers: their bonds moved rigidly for the rest of the drift */
};

/* A sphere in the solvent: system/bead.h. It is always where the solvent was last streamed to. */
struct bead {
  struct point position; /* of its center, lattice units, unwrapped */
  struct vec3 velocity;  /* a0/t0 */
  struct point account;  /* what came in since the start, in units of BEAD_ENERGY_UNIT: x, heat from its own matter in
                          * collisions; y, work of the drive; z, hits: a number. Sums wrap. */
};

/* By what a wall gives momentum to the solvent. */
enum account_share { ACCOUNT_HITS, ACCOUNT_COLLISIONS, ACCOUNT_SHARES };

struct state {
  uint64_t step;         /* steps made; time is step * dt */
  uint32_t solvent_lag;  /* half time steps since the solvent was last streamed */
  uint64_t solvent_time; /* half time steps to which it was streamed; with the lag, the time now */
  struct solvent solvent;
  struct dumbbells dumbbells;
  uint32_t vertices;
  struct point *position; /* [vertices] lattice units, unwrapped */
  struct vec3 *velocity;  /* [vertices] a0/t0, of the half step ahead */
  struct collision_counts counts;
  uint32_t wall_rows;          /* 4 between walls, else 0 */
  struct point *wall_momentum; /* [wall_rows] the account of the walls: wall/account.h */
  uint64_t wall_turns[4];      /* how often the x of each has wrapped */
  uint32_t beads;              /* 0 or 1 */
  struct bead *bead;
};

/* The solvent was streamed to now: there is no lag any more. */
static inline void state_streamed(struct state *state)
{
  state->solvent_time += state->solvent_lag;
  state->solvent_lag = 0;
}

/* Allocates a state for the model's particles and vertices, zeroed, with ids in order. False if memory is short. */
bool state_alloc(struct state *state, const struct model *model);
void state_free(struct state *state);

/* Bytes of a state of this model. */
uint64_t state_bytes(const struct model *model);

/* The same with what its arrays take beyond that (memory_taken). */
uint64_t state_memory(const struct model *model);

/* The first vertex further from the origin than LATTICE_REACH; state->vertices if there is none. */
uint32_t state_lost_vertex(const struct state *state);

/* slot[id] = index of solvent particle id in memory. slot: [solvent.n]. */
void state_solvent_slots(const struct state *state, uint32_t *slot);

/* 64-bit hash (XXH64, seed 0) of everything above but counts, in id order: docs/conventions.md lists the bytes; 0 if
 * memory is short. */
uint64_t state_hash(const struct state *state);

/* The same for codes without an order: the sum, modulo 2^64, of a hash (XXH64, seed 0) of the numbers of the state and
 * of one for each particle, vertex and other row (docs/conventions.md). */
uint64_t state_digest(const struct state *state);

/* --- fields ------------------------------------------------------------------------------------------------------ */

/*
 * What a state consists of, listed once. Checkpoints and state_hash use these lists. A new part of the state is a new
 * row here.
 */

/* A number of the state. */
struct state_number {
  const char *name; /* in checkpoints */
  uint8_t bytes;    /* 4 or 8: an unsigned integer of this size */
  bool hashed;
  bool late;     /* a file without it was written before it came: it is 0 there */
  bool wraps;    /* any value is one; others are counts below 2^62 */
  size_t offset; /* in struct state */
};

extern const struct state_number state_numbers[];
extern const size_t state_number_count;

/* Three 64-bit numbers for each row of a group: row k of memory has them stride * k bytes behind those of row 0. */
struct state_field {
  const char *name; /* in checkpoints */
  bool integer;     /* int64_t, else double */
  void *column[3];
  size_t stride;
};

enum { STATE_FIELDS = 3 }; /* most of a group */

/* Things of one kind (solvent particles, vertices), one row each. */
struct state_group {
  uint32_t rows;
  bool optional; /* without rows it is neither in files nor in hashes */
  uint32_t *id;  /* [rows] number of each row in files and hashes; NULL: its place in memory */
  size_t fields;
  struct state_field field[STATE_FIELDS];
};

enum { STATE_GROUPS = 5 };

/* The groups of this state, in the order in which they are hashed. */
void state_groups(const struct state *state, struct state_group group[STATE_GROUPS]);

/* slot[number] = place in memory of the row with this number: [rows]. Does nothing for a group whose rows stand in the
 * order of their numbers (id is NULL). */
void state_group_slots(const struct state_group *group, uint32_t *slot);

/* Copies a field out of the state into `rows`, or back: [rows][3], in the order of the numbers of rows. slot[number]:
 * place of a row in memory (state_group_slots); NULL: rows stand in the order of their numbers. */
void state_field_get(const struct state_group *group, const struct state_field *field, const uint32_t *slot,
                     void *rows);
void state_field_set(const struct state_group *group, const struct state_field *field, const void *rows);

#endif
