/*
 * Which bonds may touch in this sweep?
 *
 * Of all pairs of bonds that are near each other (fiber/neighbors.h) hardly any can touch in one time step. Each bond
 * counts how far its ends may have gone, its path; a pair that has been looked at says how long the two paths may get,
 * together, until the bonds touch, and is passed over while they are shorter. Pairs whose paths are long enough, and
 * whose distance is within what both may go in this sweep, are its meetings; a sweep tests no
 * others but those that look-arounds add (fiber/turns.h).
 */
#ifndef UNCROSS_MEETINGS_H
#define UNCROSS_MEETINGS_H

#include "fiber/capsule.h"
#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

/* All paths become longer by work->fiber.range of their bonds' ends, a0, and work->fiber.meetings are all pairs that
 * may touch within that; their vertices wait for their turns (work->fiber.waits). False, with the fault recorded, if
 * memory is short. */
bool meetings_find(const struct state *state, const struct model *model, struct work *work);

/* Bond `bond` and the image of another one meet from now on, if they did not: both have it. False as meetings_find. */
bool meetings_add(const struct state *state, struct work *work, uint32_t bond, const struct neighbor *n);

/* Vertex i may go as far as `range`, a0, further than was known, and so may its bonds. */
void meetings_widen(const struct model *model, struct fiber_work *f, uint32_t i, double range);

/* How far an end of a bond may go in this sweep, a0. */
static inline double meetings_range(const struct model *model, const struct fiber_work *f, uint32_t bond)
{
  return capsule_most(f->range[bond], f->range[model->next[bond]]);
}

#endif
