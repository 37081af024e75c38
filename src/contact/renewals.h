/*
 * Which vertices need new reference positions, and those that wait for them.
 *
 * A drift reads every vertex, so what is read is kept short: reference positions are read now and then. A vertex that
 * is `hold` inside of its skin cannot leave it before it has gone that far. Each drift takes the vertex's range off
 * `hold`, and its skin is looked at when nothing is left.
 *
 * A search for partners mostly waits for memory. So a vertex does not get its reference position at once: its search
 * cells are prefetched, and it waits until some others wait as well.
 */
#ifndef UNCROSS_CONTACT_RENEWALS_H
#define UNCROSS_CONTACT_RENEWALS_H

#include "contact/neighbors.h"

/* Where a vertex that stands at `from` ends this drift, if it touches nothing. */
typedef struct point end_of_move(const struct drift_frame *frame, struct vec3 velocity, struct point from);

/* New reference positions for all vertices that would leave their skins in this drift. Once in a drift, after
 * contact->range is known. False, with the fault recorded, if memory is short. */
bool renewals_of_late(const struct state *state, const struct model *model, struct contact *contact, end_of_move *end,
                      struct fault *fault);

/* Vertex i does not end this drift where renewals_of_late had it: its skin is looked at in the next one. */
static inline void renewals_look_again(struct neighbors *nb, uint32_t i)
{
  nb->hold[i] = 0;
}

#endif
