/*
 * The schedule of a sequential drift: which vertices must wait for their turns, and which may move at once.
 *
 * The rule moves vertices one at a time, in random order, because the result of a move may depend on whether another
 * bond has moved before it. But few vertices come near another bond in one time step. Two bonds that cannot touch in
 * this drift do not affect each other: it does not matter which one moves first. So a vertex whose bonds have no
 * candidate contact (contact/candidates.h) makes the same move at any time. Such vertices move at once, in the order of
 * memory, without a test. The others wait for their turns, and are tested against their candidates.
 *
 * An exchange of momentum changes the later moves of its four vertices. If one of them becomes faster, its bonds search
 * for candidates again. A vertex of a new candidate may have moved early although its turn is still to come. It is
 * called back: it returns to its former place and waits for its turn. So until its turn, such a vertex may be called
 * back, be hit, and then move in any direction within its range. Therefore a search looks for it at its former place
 * until then.
 */
#ifndef UNCROSS_CONTACT_SCHEDULE_H
#define UNCROSS_CONTACT_SCHEDULE_H

#include "contact/contact.h"

/* Prepares a drift in which vertices move in the order contact->order. It takes new reference positions where needed,
 * and fills contact->candidates (all pairs of bonds that may touch), contact->waits (1: the vertex waits for its turn)
 * and contact->queue (the vertices that wait). All other vertices are moved. False, with the fault recorded, as
 * drift_trial and neighbors_renew. */
bool schedule_plan(struct state *state, const struct model *model, struct contact *contact, struct fault *fault);

/* Vertex i has a new velocity since the turn of rank `now`. If it may now move further than before, its bonds search
 * for new candidates. False, with the fault recorded, if memory is short. */
bool schedule_reconsider(struct state *state, const struct model *model, struct contact *contact, uint32_t i,
                         uint32_t now, struct fault *fault);

/* Vertex i, whose turn has the rank `now`, has a new reference position, and so may leave the skin of the old one. The
 * pair list was complete only within the old skin, so its bonds search for candidates again. False as
 * schedule_reconsider. */
bool schedule_look_around(struct state *state, const struct model *model, struct contact *contact, uint32_t i,
                          uint32_t now, struct fault *fault);

#endif
