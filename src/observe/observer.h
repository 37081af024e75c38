/*
 * The contract of an observer. The table of types is in observe.c; each type has a file of its own. Only files of this
 * room include this header.
 */
#ifndef UNCROSS_OBSERVE_OBSERVER_H
#define UNCROSS_OBSERVE_OBSERVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "observe/conserved.h"
#include "observe/observe.h"

/* Doubles and 64-bit integers that an observer remembers, and doubles that it needs while it samples. later: doubles
 * that earlier programs did not remember (struct observe_block). passing: bytes that a sample takes and gives back. */
struct observer_size {
  size_t reals, later, integers, scratch, passing;
};

struct observer {
  const struct observer_type *type;
  uint64_t every, longest_lag, from; /* of the plan, in steps */
  uint64_t slabs;                    /* of the plan */
  struct observer_size size;
  double constant;  /* of the model: what type->constant gave */
  double *real;     /* [size.reals] zero at first */
  double *later;    /* [size.later] zero at first */
  int64_t *integer; /* [size.integers] zero at first; [0] is 1 + the last step sampled, 0 if none */
  double *scratch;  /* [size.scratch] undefined between samples */
};

/* The state that the observers sample, and quantities that several of them need. */
struct view {
  const struct model *model;
  const struct state *state;
  struct vec3 *force; /* [vertices] scratch */
  struct motion motion;
  bool motion_known;
};

/* The motion of the state. It is measured at the first call. */
const struct motion *view_motion(struct view *view);

struct observer_take {
  bool (*take)(void *context, const struct observe_table *table);
  void *context;
};

struct observer_type {
  /* Adds the memory that the type needs beyond integer[0]; NULL if none. */
  void (*size)(const struct observer *observer, const struct model *model, struct observer_size *size);

  /* A number that the type needs at each sample, and that the model alone decides; NAN if memory is short. NULL if
   * none. */
  double (*constant)(const struct model *model);

  /* A time series: its columns, and the function that fills a row. */
  const char *const *column;
  size_t columns;
  bool (*row)(struct observer *observer, struct view *view, double *row); /* false: there is none yet */

  /* A time series: adds a contact of thick fibers (observe/handed_on.h). NULL if it needs none. */
  void (*contact)(struct observer *observer, const struct contact_event *event);

  /* A summary: the function that adds a sample, and the one that makes its tables. NULL for time series. */
  void (*add)(struct observer *observer, struct view *view);
  bool (*summarise)(const struct observer *observer, const struct model *model, const struct observer_take *to);
  bool each_kind; /* a table for each kind of fiber: NAME-KIND, else one: NAME */
};

enum { OBSERVER_NAME_SIZE = MODEL_NAME_SIZE + 32 };

extern const struct observer_type conserved_observer, temperature_observer, statics_observer, dynamics_observer,
    collisions_observer, profile_observer, stress_observer, dumbbells_observer, orientation_observer, bead_observer,
    memory_observer, pressure_observer, wake_observer, topology_observer;

/* Time of a state, in t0. */
static inline double view_time(const struct view *view)
{
  return (double)view->state->step * view->model->time_step;
}

#endif
