/*
 * Inside the oracle: a drift of the rule `event-driven`, made from the inputs of a pack with one thing changed, contact
 * by contact (replay.h). All pairs of bonds are searched, without lists.
 */
#ifndef UNCROSS_ORACLE_FLYER_H
#define UNCROSS_ORACLE_FLYER_H

#include "oracle/event_model.h"
#include "oracle/pair.h"

enum { MOST_EVENTS = 4096, MOST_CONTACTS = 1000 }; /* of a drift; of a vertex */

struct found {
  int32_t tick;
  uint32_t bond, other;
  int64_t image[3];
};

/* A drift at work. At tick T vertex v is at r[v] + T rate[v]. */
struct flyer {
  const struct oracle_pair *pair;
  const struct event_twist *t;
  const struct pack_table *time, *from, *start, *chain, *vertex, *event, *hit, *to, *end;
  struct box box;
  double dt, begin, tolerance;
  uint32_t n;
  struct point *r, *rate, *origin;
  struct vec3 *v;
  uint32_t *contacts, *cluster, clusters;
  struct found *queue;
  uint32_t queued, row;
  bool failed;
};

/* A contact as it is found: four vertices, and what the impulse needs. */
struct touch {
  int64_t four[4];
  struct oracle_impulse e;
  bool touching;
};

/* False if the pack has not what a drift needs. */
bool flyer_take(const struct oracle_pair *pair, struct flyer *f);

/* Makes the vertices fly. False if memory is short, or one is too fast. To be finished in any case. */
bool flyer_begin(struct flyer *f);
void flyer_finish(struct flyer *f);

/* Displacement in a tick, lattice units, at a velocity. */
struct point flyer_rate(struct flyer *f, struct vec3 v);

/* Of vertex k: its neighbors on the chain, -1 if there is none; columns of in.vertex; its place at a tick. */
int64_t flyer_next(const struct flyer *f, int64_t k);
int64_t flyer_prev(const struct flyer *f, int64_t k);
double flyer_constant(const struct flyer *f, int64_t k, uint32_t column);
struct point flyer_place(const struct flyer *f, int64_t k, int32_t tick);
int64_t flyer_axis(struct point p, int axis);
struct flight_pair flyer_pair(const struct flyer *f, const struct found *e);

/* Searches contacts after a tick, and queues them: bonds that are marked against all others (NULL: all; `near`: the
 * tick from which on they may be near); one pair in one image; those of the vertices of a contact anew. */
void flyer_search(struct flyer *f, const bool *marked, int32_t near, int32_t from);
void flyer_search_pair(struct flyer *f, int64_t bond, int64_t other, const int64_t image[3], int32_t from);
void flyer_search_again(struct flyer *f, const bool *vertex, const struct found *e, enum again_rule rule);

/* Takes all contacts of a pair in this image out of the queue. */
void flyer_drop_pair(struct flyer *f, const struct found *e);

/* Levers, normal, velocities, forces and time of a contact. */
void flyer_touch(const struct flyer *f, const struct found *e, struct touch *c);

#endif
