/* One sweep: every vertex tries to move, one at a time, in random order (Padding 2009, Sec. III, step 3). */
#ifndef UNCROSS_SWEEP_H
#define UNCROSS_SWEEP_H

#include "fiber/crossing.h"
#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

/* A hit that a trial move found, and what was done about it. */
struct sweep_event {
  uint32_t vertex;      /* that tried to move */
  uint32_t moving_bond; /* its first vertex */
  uint32_t standing_bond;
  int32_t image[3]; /* of the standing bond, in box edges */
  struct crossing_hit hit;
  bool executed;   /* the first of this move's hits; the others were not acted upon */
  double momentum; /* dP of Eq. (28) if executed, else 0 */
};

/* Where hits are told, for oracles and tests; NULL in runs. */
struct sweep_log {
  void (*record)(void *context, const struct sweep_event *event);
  void *context;
};

/* Moves all vertices by fraction * dt, in the order drawn for (step, sweep), sweep = 0 or 1. Without the crossing
 * constraint they simply move. False, with the fault recorded, if a vertex would move further than half the shortest
 * edge, one is beyond LATTICE_REACH (which is looked for now and then only), or memory is short. */
bool fiber_sweep(struct state *state, const struct model *model, struct work *work, double fraction, uint64_t step,
                 uint32_t sweep, const struct sweep_log *log);

#endif
