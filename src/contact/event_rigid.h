/*
 * Rigid clusters: vertices that move rigidly for the rest of a drift. A common displacement crosses nothing, so this
 * ends the work on a contact that no impulse separates. Velocities stay.
 *
 * All members have one rate. What is held stands: if a member is held the rate is 0, and a body beside the
 * bonds (struct timeline) that belongs to the cluster stands with it until the drift ends.
 */
#ifndef UNCROSS_CONTACT_EVENT_RIGID_H
#define UNCROSS_CONTACT_EVENT_RIGID_H

#include "contact/event_drift.h"

/* True if one of these vertices belongs to a cluster, or has had too many contacts: no exchange answers its next one.
 */
bool event_is_rigid(const struct event_drift *d, uint32_t n, const uint32_t *vertex);

/* These vertices, and the clusters that they belong to, are one cluster from a tick on; with_body: together with the
 * body beside the bonds. Its rate is the body's, if the body belongs to it; else the rate of the first vertex in this
 * order that belonged to a cluster; else the mean of all their rates, cut toward zero. False, with the fault recorded,
 * as event_steer. */
bool event_make_rigid(const struct event_drift *d, uint32_t n, const uint32_t *vertex, bool with_body, int32_t tick);

/* All members of a cluster have this rate from a tick on. False as event_make_rigid. */
bool event_steer_cluster(const struct event_drift *d, uint32_t cluster, struct point rate, int32_t tick);

#endif
