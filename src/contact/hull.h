/* Is the origin in the hull of eight points? The last step of the search for contacts (contact/flight.h), exact. */
#ifndef UNCROSS_CONTACT_HULL_H
#define UNCROSS_CONTACT_HULL_H

#include "contact/determinant.h"

#define HULL_POINTS 8

/* True if a plane through the origin has all points strictly on one side; false if the origin is in their convex hull,
 * its surface included. No rounding: points of lattice units, components below 2^54. */
bool hull_misses_origin(const struct difference point[HULL_POINTS]);

#endif
