/*
 * One observer: what observe.c needs to know of each observable. The table of types is in observe.c; each type lives in
 * a file of its own. Only files of this folder include this header.
 */
#ifndef UNCROSS_OBSERVER_H
#define UNCROSS_OBSERVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "observe/conserved.h"
#include "observe/observe.h"

/* Doubles and 64-bit integers that an observer remembers, and doubles that it needs while it samples. */
struct observer_size {
  size_t reals, integers, scratch;
};

struct observer {
  const struct observer_type *type;
  uint64_t every, longest_lag; /* of the plan, in steps */
  struct observer_size size;
  double *real;     /* [size.reals] zero at first */
  int64_t *integer; /* [size.integers] zero at first; [0] is 1 + the last step sampled, 0 if none */
  double *scratch;  /* [size.scratch] means nothing between samples */
};

/* The state that is shown to the observers that are due, and what more than one of them wants to know of it. */
struct view {
  const struct model *model;
  const struct state *state;
  struct work *work; /* scratch for forces */
  struct motion motion;
  bool motion_known;
};

/* The motion of the state on view: measured when first asked for. */
const struct motion *view_motion(struct view *view);

struct observer_take {
  bool (*take)(void *context, const struct observe_table *table);
  void *context;
};

struct observer_type {
  /* Adds what it needs beyond integer[0]; NULL if nothing. */
  void (*size)(const struct observer *observer, const struct model *model, struct observer_size *size);

  /* A time series: its columns, and what fills a row. */
  const char *const *column;
  size_t columns;
  void (*row)(struct observer *observer, struct view *view, double *row);

  /* A summary: what adds a sample, and what gives a table for each kind of fiber. NULL for time series. */
  void (*add)(struct observer *observer, struct view *view);
  bool (*summarise)(const struct observer *observer, const struct model *model, const struct observer_take *to);
};

enum { OBSERVER_MAX_COLUMNS = 32, OBSERVER_NAME_SIZE = MODEL_NAME_SIZE + 32 };

extern const struct observer_type conserved_observer, temperature_observer, statics_observer, dynamics_observer,
    collisions_observer;

/* Time of a state, in t0. */
static inline double view_time(const struct view *view)
{
  return (double)view->state->step * view->model->time_step;
}

#endif
