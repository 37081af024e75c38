/*
 * Averages of single fibers in equilibrium, per kind: one table "statics-<kind>" of one row. Names and meanings of its
 * columns are in docs/observables.md. A quantity that a kind does not have (the end-to-end distance of a ring, the bend
 * of a dumbbell) is NaN. Errors: tally.h.
 */
#ifndef UNCROSS_OBSERVE_STATICS_H
#define UNCROSS_OBSERVE_STATICS_H

#include "system/model.h"

/* Means over one fiber. */
struct fiber_shape {
  double length, length_squared; /* of its bonds: <l> in a0, <l^2> in a0^2; 0 without bonds */
  double cosine;                 /* of its bends; 0 without bends */
  double end_to_end;             /* R_ee^2 in a0^2; 0 for rings */
  double gyration;               /* R_g^2 in a0^2 */
};

/* Measures a fiber of this kind whose vertices are at position[0 .. vertices-1]. */
struct fiber_shape fiber_shape(const struct fiber_kind *kind, const struct point *position);

#endif
