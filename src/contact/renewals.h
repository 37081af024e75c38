/*
 * Vertices that wait for new reference positions. A search for partners mostly waits for memory. So a vertex does not
 * get its reference position at once: its search cells are prefetched, and it waits until some others wait as well.
 */
#ifndef UNCROSS_CONTACT_RENEWALS_H
#define UNCROSS_CONTACT_RENEWALS_H

#include "contact/neighbors.h"

#define RENEWALS_MOST (2 * NEIGHBORS_AT_ONCE)

struct renewals {
  uint32_t count, vertex[RENEWALS_MOST]; /* the one that has waited longest comes first */
  struct point from[RENEWALS_MOST], to[RENEWALS_MOST];
};

/* Vertex i is about to leave its skin by a straight move. If RENEWALS_MOST vertices wait, the first NEIGHBORS_AT_ONCE
 * of them take new reference positions. False, with the fault recorded, if memory is short. */
bool renewals_add(const struct state *state, const struct model *model, struct contact *contact, struct renewals *r,
                  uint32_t i, struct point from, struct point to, struct fault *fault);

/* All vertices that wait take new reference positions. False as renewals_add. */
bool renewals_end(const struct state *state, const struct model *model, struct contact *contact, struct renewals *r,
                  struct fault *fault);

/* Vertex i, which ends its flight at `to` within its skin, cannot leave it before its path has grown by what is left of
 * it. If its flight bends, or its reference position is renewed, `hold` is set anew. */
void renewals_hold_until(struct neighbors *nb, uint32_t i, struct point to);

#endif
