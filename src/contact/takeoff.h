/* The start of a drift in which all vertices move at once. */
#ifndef UNCROSS_CONTACT_TAKEOFF_H
#define UNCROSS_CONTACT_TAKEOFF_H

#include "contact/contact.h"
#include "contact/drift.h"
#include "contact/flight.h"

/* The displacement in a tick, lattice units, of a vertex of this velocity that flies straight for a time dt. */
static inline struct point takeoff_rate(struct vec3 velocity, struct vec3 frame, double dt)
{
  return flight_rate(drift_displacement(velocity, frame, dt));
}

/* The displacement of vertex i in a tick, within a drift: that of its last bend, or what its velocity gives. */
static inline struct point takeoff_rate_now(const struct state *state, const struct model *model,
                                            const struct flights *f, uint32_t i)
{
  return f->bend_of[i] ? f->bends.at[f->bend_of[i] - 1].rate
                       : takeoff_rate(state->velocity[i], model_frame_velocity(model), f->time);
}

/* Gives every vertex its range in a flight for a time dt (contact->range), lengthens the paths of bonds, and takes new
 * reference positions for vertices that would leave their skins. False, with the fault recorded, as contact_drift. */
bool take_off(const struct state *state, const struct model *model, struct contact *contact, double dt,
              struct fault *fault);

#endif
