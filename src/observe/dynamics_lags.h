/* The memory of the lags of dynamics: what is kept of each, and where it lies in the memory of the observer. */
#ifndef UNCROSS_OBSERVE_DYNAMICS_LAGS_H
#define UNCROSS_OBSERVE_DYNAMICS_LAGS_H

#include "observe/observer.h"
#include "observe/tally.h"

/* Quantities of the tally, each a pair (x, y). */
enum {
  VERTICES_CENTER,
  TUBE_CONTOUR,
  TURNED_SQUARE, /* their ratio makes the end-to-end correlation */
  MIDDLE_COSINE,
  THIRD_AXIS,
  QUANTITIES
};

/* Quantities of the tally of drifts, one sample per interval; and of the tally of rises, one per interval whose middle
 * was sampled too. `about`: about the mean displacement of the kind. */
enum { DRIFT_XY, DRIFT_Z_ABOUT, DRIFT_QUANTITIES };
enum { RISE_AND_ABOUT, RISE_QUANTITIES };

enum { MAX_LAGS = 80 };

/* Memory of a lag: for each kind a tally, and two that are of drift and of rises; and 1 + the origin's step (0: none),
 * then the origin's positions. */
struct lag {
  uint64_t samples;
  double *real, *later;
  int64_t *mark;
  struct point *origin;
};

uint32_t dynamics_count_lags(const struct observer *observer);

/* Lag number 0; and, of lag `number`, the next. */
struct lag dynamics_first_lag(const struct observer *observer);
void dynamics_next_lag(struct lag *lag, const struct model *model, uint32_t number);

/* The three tallies of a kind, in the memory of a lag. */
struct tallies {
  struct tally_shape shape, drift_shape, rise_shape;
  double *memory, *drift, *rise;
};

/* Of the first kind, in the memory of lag `number`; and those of the next kind. */
struct tallies dynamics_first_tallies(const struct lag *lag, const struct fiber_kind *kind, uint32_t number);
void dynamics_next_tallies(struct tallies *tallies, const struct fiber_kind *kind, uint32_t number);

/* Scratch: the sums of a sample, then the contour of a fiber, then displacements of fibers. */
size_t dynamics_scratch_sums(const struct model *model);
uint32_t dynamics_longest_fiber(const struct model *model);
uint32_t dynamics_most_fibers(const struct model *model);

/* What the observer needs in all. */
void dynamics_size(const struct observer *observer, const struct model *model, struct observer_size *size);

#endif
