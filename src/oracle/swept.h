/*
 * Inside the oracle: a sweep, replayed. Of what came before an event, our tables tell everything: a vertex whose turn
 * is over stands where it ended, the others where they began, and the exchanges so far have made the velocities.
 */
#ifndef UNCROSS_ORACLE_SWEPT_H
#define UNCROSS_ORACLE_SWEPT_H

#include "oracle/patterns.h"

enum event_column { VERTEX, MOVING, STANDING, IMAGE_X, IMAGE_Y, IMAGE_Z, EXECUTED, EVENT_COLUMNS };
enum hit_column { TIME, S, S_STANDING, NORMAL_X, NORMAL_Y, NORMAL_Z, MOMENTUM, HIT_COLUMNS };

/* All tables of a sweep that patterns look at. */
struct swept {
  const struct oracle_pair *pair;
  struct oracle_pair event, hit; /* ours and theirs */
  const struct pack_table *order, *from, *start, *to, *chain;
};

/* The tables of the pair's sweep. False if one is missing, or is not of its shape. */
bool oracle_swept_take(const struct oracle_pair *pair, struct swept *w);

/* True if rows of two event tables are of the same vertex, bonds and image. */
bool swept_same_event(const struct pack_table *a, uint32_t row, const struct pack_table *b, uint32_t other);

/* The first row whose event is not the same, or not executed in both; the rows that both have if there is none. */
uint32_t swept_first_other(const struct swept *w);

#endif
