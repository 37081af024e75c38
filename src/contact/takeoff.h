/* The start of a drift in which all vertices move at once. */
#ifndef UNCROSS_CONTACT_TAKEOFF_H
#define UNCROSS_CONTACT_TAKEOFF_H

#include "contact/contact.h"
#include "contact/drift.h"
#include "contact/flight.h"

/* The displacement in a tick, lattice units, of a vertex of this velocity that flies straight. y: its height at the
 * start of the drift. */
static inline struct point takeoff_rate(const struct drift_frame *frame, struct vec3 velocity, int64_t y)
{
  return flight_rate(drift_displacement(frame, velocity, y));
}

/* The displacement of vertex i in a tick, within a drift: that of its last bend, or what its velocity gives. */
static inline struct point takeoff_rate_now(const struct state *state, const struct contact *contact, uint32_t i)
{
  const struct flights *f = &contact->flights;
  return f->bend_of[i] ? f->bends.at[f->bend_of[i] - 1].rate
                       : takeoff_rate(&contact->frame, state->velocity[i], state->position[i].y);
}

/* Gives every vertex its range in this drift (contact->range), lengthens the paths of bonds, and takes new
 * reference positions for vertices that would leave their skins. False, with the fault recorded, as contact_drift. */
bool take_off(const struct state *state, const struct model *model, struct contact *contact, struct fault *fault);

#endif
