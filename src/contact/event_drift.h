/*
 * A drift of the rule `event-driven` at work (contact/event_driven.c). contact/event_flights.c has the flights and the
 * contacts to come, contact/event_walls.c what happens at walls.
 */
#ifndef UNCROSS_CONTACT_EVENT_DRIFT_H
#define UNCROSS_CONTACT_EVENT_DRIFT_H

#include "contact/contact.h"
#include "contact/drift.h"
#include "contact/flight.h"

enum {
  EVENT_MOST_CONTACTS = 1000 /* of one vertex in one drift; beyond it, its cluster moves rigidly */
};

#define EVENT_WALL UINT32_MAX /* `other` of an event in which the vertex `bond` hits a wall */

struct event_drift {
  struct state *state;
  const struct model *model;
  struct contact *contact;
  const struct drift_frame *frame; /* contact->frame */
  const struct contact_log *log;
  struct fault *fault;
};

/* Records that memory is short. False. */
bool event_no_memory(const struct event_drift *d);

/* --- flights ------------------------------------------------------------------------------------------------------ */

/* The displacement of a vertex in a tick; its place at a tick; the force on it there, kT/a0. */
struct point event_rate(const struct event_drift *d, uint32_t i);
struct point event_place(const struct event_drift *d, uint32_t i, int32_t tick);
struct vec3 event_force(const struct event_drift *d, uint32_t i, int32_t tick);

/* The place of a vertex at the start of the drift. */
struct point event_start(const struct event_drift *d, uint32_t i);

/* Time from the middle of the step to a tick, t0. */
static inline double event_time(const struct event_drift *d, int32_t tick)
{
  return d->frame->start + d->frame->time * ((double)tick / FLIGHT_TICKS);
}

/* The flights of two bonds, the other in this image. */
struct flight_pair event_pair(const struct event_drift *d, uint32_t bond, uint32_t other, const int32_t image[3]);

/* All vertices go to the ends of their flights. */
void event_land(const struct event_drift *d);

/* --- contacts to come --------------------------------------------------------------------------------------------- */

/* Number of changes of the flights of two bonds. A contact that was found before the last one is out of date. */
uint32_t event_version(const struct event_drift *d, uint32_t bond, uint32_t other);

/* Queue the first contact of a pair from a tick on, and of all candidates. False, with the fault recorded, if memory is
 * short. */
bool event_search_pair(const struct event_drift *d, uint32_t bond, const struct neighbor *n, int32_t from);
bool event_search_all(const struct event_drift *d);

/* --- paths bend --------------------------------------------------------------------------------------------------- */

/* The bend of a vertex; a new one if its flight has been straight. Its velocity must not have changed by then. NULL if
 * memory is short. */
struct bend_in_path *event_bend(const struct event_drift *d, uint32_t i);

/* From this tick on, vertex i moves by `rate` in a tick. Its place at the tick stays. The bonds that it may meet now,
 * and could not before, become candidates. False, with the fault recorded, as drift_legal, or if memory is short. */
bool event_steer(const struct event_drift *d, uint32_t i, struct point rate, int32_t tick);

/* The same, with the rate that its velocity gives. */
bool event_steer_freely(const struct event_drift *d, uint32_t i, int32_t tick);

/* The flights of these vertices have bent at this tick: all queued contacts of their bonds are out of date, and are
 * searched anew. */
bool event_search_again(const struct event_drift *d, uint32_t n, const uint32_t *vertex, int32_t tick);

/* Answers what was queued, if it is not out of date. False, with the fault recorded, as event_steer. */
bool event_answer(const struct event_drift *d, const struct event *e);

/* --- walls -------------------------------------------------------------------------------------------------------- */

/* Queue the hit of a wall that a vertex is flying to, if any; and those of all vertices. False as event_search_pair. */
bool event_search_wall(const struct event_drift *d, uint32_t i);
bool event_search_walls(const struct event_drift *d);

/* Answers a hit, if it is not out of date. False, with the fault recorded, as event_steer. */
bool event_answer_wall(const struct event_drift *d, const struct event *e);

#endif
