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

/* The vertex whose move is the first that differs; -1 if none does. */
double swept_first_mover(const struct swept *w);

/* A hit of that move that only we have (missed), or only they (invented): its row in ours, or in theirs. */
bool swept_missed(const struct swept *w, uint32_t *row);
bool swept_invented(const struct swept *w, uint32_t *row);

/* Moving vertex, pivot, and the ends of the standing bond of an event. False if there are no such vertices. */
bool swept_vertices(const struct swept *w, const struct pack_table *events, uint32_t row, uint32_t four[4]);

/* Their levers in our exchange, or what a port has that swaps the ends. */
void swept_levers(const struct swept *w, uint32_t row, bool swapped, double lever[4]);

struct vec3 swept_normal(const struct swept *w, uint32_t row);
double swept_mass(const struct swept *w, uint32_t vertex);

/* Velocity (a0/t0) after our exchanges in the first `rows` events, those of `mover` left out. */
struct vec3 swept_velocity(const struct swept *w, uint32_t vertex, uint32_t rows, double mover);

#endif
