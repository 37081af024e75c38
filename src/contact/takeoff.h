/* The start of a drift in which all vertices move at once. */
#ifndef UNCROSS_CONTACT_TAKEOFF_H
#define UNCROSS_CONTACT_TAKEOFF_H

#include "contact/contact.h"

/* Gives every vertex its flight for a time dt (contact->flights.rate) and its range, lengthens the paths of bonds, and
 * takes new reference positions for vertices that would leave their skins. False, with the fault recorded, as
 * contact_drift. */
bool take_off(const struct state *state, const struct model *model, struct contact *contact, double dt,
              struct fault *fault);

#endif
