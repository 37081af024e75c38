/* Tables of the operators `contact_search`, `impulse` and `event_drift`: the rule `event-driven`, part by part. */
#ifndef UNCROSS_ORACLE_EVENT_ROWS_H
#define UNCROSS_ORACLE_EVENT_ROWS_H

#include "contact/flight.h"
#include "contact/impulse.h"
#include "oracle/operators.h"

/* A search for the first contact of two bonds, from a tick on. */
struct oracle_search {
  struct flight_pair pair;
  int64_t reach; /* distance of the axes at a contact, lattice units; 0: of thin lines */
  int32_t from;
};

/* What the impulse of a contact is computed from: the ends of the first bond, then of the other. */
struct oracle_impulse {
  struct vec3 velocity[4], force[4]; /* a0/t0, kT/a0 */
  double mass[4];
  double s, t;
  struct vec3 normal;
  double tau; /* from the middle between two kicks, t0 */
};

/* Contacts of a drift, as they were answered. */
struct oracle_events {
  const struct oracle_stage *stage;
  struct oracle_event {
    struct contact_event event;
    int32_t tick;
    double condition; /* how much its data amplify rounding (docs/port/tolerances.md, Tolerances) */
  } * at;
  uint32_t count;
  bool failed; /* memory was short */
};

/* How far a vertex flies in a tick, as it does now within a drift; and the force on it where it is at a tick, kT/a0. */
struct point oracle_rate_of(const struct oracle_stage *g, uint32_t vertex);
struct vec3 oracle_force_at_tick(const struct oracle_stage *g, uint32_t vertex, int32_t tick);

/* Names of the four ends in tables. */
extern const char *const oracle_ends[4];

/* True if a search is made for it: packs may come from anywhere. */
bool oracle_search_is_legal(const struct flight_pair *pair, double from);

/* Puts the inputs of n searches that those of lines and of tubes have in common. */
void oracle_put_flight_pairs(struct oracle_stage *g, const struct oracle_search *search, uint32_t n);

/* Puts n searches with their ticks; n impulses with the velocities after them; the events of a drift. */
void oracle_put_searches(struct oracle_stage *g, const struct oracle_search *search, uint32_t n);
void oracle_put_impulses(struct oracle_stage *g, const struct oracle_impulse *before, uint32_t n);
void oracle_put_events(struct oracle_stage *g, const struct oracle_events *events);

/* The drift, in one piece of `dt` t0, that begins `start` t0 after the middle between two kicks; the state is advanced.
 * False, with work->fault or pack->failed saying why. */
bool oracle_event_drift_for(struct oracle_stage *stage, double dt, double start);

/* The same without tables. log: told of each contact, or NULL. */
bool oracle_drift_at_once(struct oracle_stage *stage, double dt, double start, const struct contact_log *log);

#endif
