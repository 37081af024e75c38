/*
 * Two tubes in straight flight: when do they touch?
 *
 * A tube is all within D/2 of a bond, its axis: a cylinder with half a sphere at each end. Two tubes touch when the
 * distance of their axes falls to the reach, the sum of their radii. contact/flight.h explains flights and ticks.
 *
 * The points w + s' q - s p, 0 <= s, s' <= 1, are a parallelogram that moves in time. The axes are as far apart as it
 * is from the origin. At time u of an interval, 0 <= u <= 1, its corners are c(u) = (1 - u) c0 + u c1. Take any two
 * vectors n0, n1 of length 1 or less, and n(u) = (1 - u) n0 + u n1, which is not longer. Then
 *
 *     distance(u) >= least over corners of n(u).c(u),
 *     n(u).c(u) = (1 - u)^2 n0.c0 + 2 u (1 - u) (n0.c1 + n1.c0)/2 + u^2 n1.c1.
 *
 * So if n0.c0, (n0.c1 + n1.c0)/2 and n1.c1 of all four corners exceed the reach, the tubes do not touch in this
 * interval. This is a plane that separates the tubes and turns with them. n0 and n1 are along the shortest lines
 * between the axes at both ends of the interval. Then n0.c0 and n1.c1 are the distances there, at the nearest corner,
 * and the middle one is at most |n1 - n0| |c1 - c0|/2 below their mean. It is of second order in the interval, also
 * where the tubes turn about each other, and where the nearest point passes from the side of a tube to its end. So a
 * few halvings decide. Within a tick it is below 1e-13/D a0 for motions of 1e-7 a0.
 *
 * Rounding errors are bounded on the safe side. A single tick that is in doubt counts as a contact at its first tick.
 * So the answer is never late: the axes are further apart than the reach up to the tick of the answer, and at it. Of
 * two passages the first one is found.
 */
#ifndef UNCROSS_CONTACT_TUBE_H
#define UNCROSS_CONTACT_TUBE_H

#include "contact/flight.h"

/* True if the axes certainly are further apart than `reach` (lattice units) at all times from tick `from` to tick `to`,
 * both included. Where both are the same: at this tick. */
bool tube_excluded(const struct flight_pair *pair, int64_t reach, int32_t from, int32_t to);

/* The first tick, not before `from`, in which the tubes may touch; FLIGHT_TICKS if they do not touch in this drift. At
 * the answer they are apart, if they are at `from`. */
int32_t tube_contact(const struct flight_pair *pair, int64_t reach, int32_t from);

#endif
