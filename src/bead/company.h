/*
 * The bead among bonds, in a drift of the rule `event-driven`: one timeline for its hits of solvent particles
 * (flight.c), for its contacts with bonds, and for the contacts of bonds with each other.
 *
 * A bond touches the bead when its axis is R + D/2 from the center: this is the question of contact/tube.h, with a
 * point for the other axis. So the answer is never late, and no bond ever enters the bead. The exchange of momentum is
 * that of two bonds, where the bead is the other end: contact/impulse.h.
 *
 * Which bonds may touch it is known from paths, as for pairs of bonds (contact/candidates.h): a bond gets a limit when
 * its distance is measured, and is looked at again when its path and that of the bead together exceed the limit.
 */
#ifndef UNCROSS_BEAD_COMPANY_H
#define UNCROSS_BEAD_COMPANY_H

#include "contact/event_drift.h"

#define EVENT_BEAD UINT32_MAX /* the standing bond of a contact with the bead, in struct contact_event */

/* Functions of struct timeline, whose body is struct bead_work. At the same tick hits of the solvent are first, then
 * the contact with the bond of the least number. A bond must not be so long that two images of the bead may touch it.
 */
extern const struct timeline bead_timeline;

/* True if no bond of the fiber is nearer to the bead than it may be; else *bond is one that is, and *distance that of
 * its axis from the center, a0. */
bool bead_company_clear(const struct model *model, struct point bead, const struct point *position, uint32_t fiber,
                        uint32_t *bond, double *distance);

#endif
