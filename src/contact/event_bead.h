/*
 * The bead among bonds, in a drift of the rule `event-driven`: one timeline for its hits of solvent particles
 * (system/fluid.h), for its contacts with bonds, and for the contacts of bonds with each other.
 *
 * A bond touches the bead when its axis is R + D/2 from the center: this is the question of contact/tube.h, with a
 * point for the other axis. So the answer is never late, and no bond ever enters the bead. The exchange of momentum is
 * that of two bonds, where the bead is the other end: contact/impulse.h.
 *
 * Which bonds may touch it is known from paths, as for pairs of bonds (contact/candidates.h): a bond gets a limit when
 * its distance is measured, and is looked at again when its path and that of the bead together exceed the limit.
 */
#ifndef UNCROSS_CONTACT_EVENT_BEAD_H
#define UNCROSS_CONTACT_EVENT_BEAD_H

#include "contact/event_drift.h"

#define EVENT_BEAD UINT32_MAX /* the standing bond of a contact with the bead, in struct contact_event */

/* The bead sets out, and the first contacts are searched. False, with the fault recorded, if memory is short, or if a
 * bond is so long that two images of the bead may touch it; so do the others. */
bool event_bead_begin(const struct event_drift *d);

/* The tick of what comes next to the bead, a hit or a contact; FLIGHT_TICKS if nothing does. */
int32_t event_bead_next(const struct event_drift *d);

/* Answers it. At the same tick hits are first, then the contact with the bond of the least number. */
bool event_bead_answer(const struct event_drift *d);

/* The flights of these bonds have bent at a tick. */
bool event_bead_search_again(const struct event_drift *d, uint32_t n, const uint32_t *bond, int32_t tick);

/* The bead stands from this tick on until the drift ends, and its cluster with it; its velocity stays. */
bool event_bead_hold(const struct event_drift *d, int32_t tick);

void event_bead_end(const struct event_drift *d);

/* True if no bond of the fiber is nearer to the bead than it may be; else *bond is one that is, and *distance that of
 * its axis from the center, a0. */
bool event_bead_clear(const struct model *model, struct point bead, const struct point *position, uint32_t fiber,
                      uint32_t *bond, double *distance);

#endif
