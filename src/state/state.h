/*
 * state: exactly what a restart needs. Everything else a run holds is either model (never changes) or work (rebuilt).
 *
 * Between steps the velocities of vertices are those of the half step ahead, v(t + dt/2): the leap-frog of Padding's
 * Eqs. (3), (4), (7), (8). Solvent particles fly freely between collisions, so they are streamed once per collision
 * interval: their positions stand where they last were streamed to, solvent_lag half steps ago.
 */
#ifndef UNCROSS_STATE_H
#define UNCROSS_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/lattice.h"
#include "state/model.h"

/* Structure of arrays, in memory order (re-sorted by cell now and then); id says who is who. */
struct solvent {
  uint32_t n;
  int64_t *x, *y, *z;   /* lattice units, within the box */
  double *vx, *vy, *vz; /* a0/t0 */
  uint32_t *id;         /* 0 .. n-1, each once */
};

/* Of the particle in place i of memory, as of its last streaming. */
static inline struct vec3 solvent_velocity(const struct solvent *s, uint32_t i)
{
  return (struct vec3){s->vx[i], s->vy[i], s->vz[i]};
}

/* Crossings since the start (Padding 2009, Sec. III A). */
struct collision_counts {
  uint64_t moves;    /* trial moves of vertices */
  uint64_t possible; /* hits found */
  uint64_t executed; /* moves rejected, with an exchange of momentum */
  uint64_t negative; /* of these, with dP < 0 (footnote 61) */
};

struct state {
  uint64_t step;        /* steps made; time is step * dt */
  uint32_t solvent_lag; /* half time steps since the solvent was last streamed */
  struct solvent solvent;
  uint32_t vertices;
  struct point *position; /* [vertices] lattice units, unwrapped */
  struct vec3 *velocity;  /* [vertices] a0/t0, of the half step ahead */
  struct collision_counts counts;
};

/* Room for the model's particles and vertices, zeroed; ids in order. False if memory is short. */
bool state_alloc(struct state *state, const struct model *model);
void state_free(struct state *state);

/* The first vertex that is beyond LATTICE_REACH; `vertices` if none is. */
uint32_t state_lost_vertex(const struct state *state);

/* slot[id] = index of solvent particle id in memory. slot: [solvent.n]. */
void state_solvent_slots(const struct state *state, uint32_t *slot);

/* 64-bit hash (XXH64, seed 0) of everything above but counts, in id order: docs/conventions.md lists the bytes. */
uint64_t state_hash(const struct state *state);

/* How far a particle of velocity v gets in a time t under a constant acceleration a, in lattice units: one Cartesian
 * component of Padding 2009, Eq. (3), exact over any number of time steps. Right below LATTICE_MAX_MOVE. */
static inline int64_t state_flight(double v, double a, double t)
{
  return lattice_from_a0(v * t + 0.5 * a * t * t);
}

/* What the body force has given each solvent particle since it was last streamed: so much more is its velocity now. */
struct vec3 state_solvent_gain(const struct state *state, const struct model *model);

/* Where solvent particle number i (in memory order) is now, its lag made up for: lattice units, within the box. And its
 * velocity now. */
struct point state_solvent_position(const struct state *state, const struct model *model, uint32_t i);
struct vec3 state_solvent_velocity(const struct state *state, const struct model *model, uint32_t i);

#endif
