/*
 * Who has to wait for its turn?
 *
 * A sweep moves vertices one at a time, in random order, because a move may end at a bond that has moved before, or has
 * not. But hardly any vertex comes near another bond in one time step. If the two bonds of a pair cannot touch however
 * far their ends go in this sweep, the pair does not care who goes first; a vertex none of whose bonds may touch
 * anything makes the same move at any time. Such vertices move at once, in the order of memory, without a test; the
 * others wait for their turn, and are tested against the bonds that theirs may meet.
 *
 * An exchange of momentum changes what its vertices will do when their turn comes. Who gets faster looks around again,
 * and calls back those that moved before their turn, if that is still to come. Until then, who has moved early counts
 * as standing where it was: called back and hit by another, it may still go anywhere within its range of there.
 */
#ifndef UNCROSS_TURNS_H
#define UNCROSS_TURNS_H

#include "state/model.h"
#include "state/state.h"
#include "state/work.h"

/* May vertex i move by d in one go? False, with the fault recorded, if that is half the shortest edge or more along an
 * axis, or not a number. */
bool turns_legal(const struct state *state, const struct model *model, struct work *work, uint32_t i, struct vec3 d);

/* Padding 2009, Eq. (4): where vertex i wants to go in a time dt, in the frame of the moves. False as turns_legal. */
bool turns_trial(const struct state *state, const struct model *model, struct work *work, uint32_t i, double dt,
                 struct point *to);

/* All vertices to where they want to go, as if nothing were in their way. False as turns_trial. */
bool turns_crossable(struct state *state, const struct model *model, struct work *work, double dt);

/* Before a sweep in the order work->fiber.order: anchors for all that need new ones, work->fiber.meetings: all pairs
 * of bonds that may touch, work->fiber.waits for all vertices (1: waits for its turn), those in work->fiber.queue, and
 * all others moved. False, with the fault recorded, as turns_trial and neighbors_renew. */
bool turns_plan(struct state *state, const struct model *model, struct work *work, double dt);

/* Vertex i has got another velocity during the turn of rank `now`: if it goes further than it would have, new meetings.
 * False, with the fault recorded, if memory is short. */
bool turns_reconsider(struct state *state, const struct model *model, struct work *work, uint32_t i, double dt,
                      uint32_t now);

/* Vertex i, whose turn is now, has a new anchor: among the pairs that the plan looked at there was none beyond the old
 * one, and it may go there although it is no faster. False as turns_reconsider. */
bool turns_look_around(struct state *state, const struct model *model, struct work *work, uint32_t i, double dt,
                       uint32_t now);

#endif
