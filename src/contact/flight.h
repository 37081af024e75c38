/*
 * Two bonds in straight flight: when do they touch?
 *
 * A drift has FLIGHT_TICKS ticks. In one tick a vertex moves by a whole number of lattice units, so it stands on a
 * lattice point at every tick, and nothing is rounded where a path bends. Between two bends both bonds' ends move on
 * straight lines. Let p and q be the bond vectors, w the vector from the first end of the one to that of the other. All
 * three are linear in time, and the bonds touch when w = s p - s' q with 0 <= s, s' <= 1.
 *
 * The search excludes contacts from intervals of ticks, both ends included. It never excludes a contact wrongly:
 *
 *  (i)  At a contact the volume f = (p x q).w is zero. f is a cubic polynomial of time. If its four Bernstein
 *       coefficients over the interval have one strict sign, f has no zero there. The coefficients are sums of
 *       determinants of p, q and w at both ends of the interval.
 *  (ii) The points w + s' q - s p of all s, s' at both ends of the interval span a convex body, which contains all of
 *       them at all times between, since they are linear in time. It is the hull of 8 corners. If a plane separates the
 *       corners from the origin, the bonds do not touch. Any direction of the plane may be tried.
 *
 * Rounding errors are bounded on the safe side. An interval that is not excluded is halved. A single tick that is in
 * doubt is decided in exact integers: by (i), and by (ii) with any plane (contact/hull.h). If it is still not excluded,
 * it counts as a contact at its first tick. So no contact is missed. And at the tick of the answer the bonds are no
 * further apart than any two of their points move towards each other within one tick (1e-7 a0): else the plane
 * perpendicular to the shortest line would separate them. So a contact may be answered up to a tick early, and one may
 * be answered that would just have been missed by as little.
 *
 * The answer is a matter of integers alone. If (i) or (ii) excludes an interval, the same excludes each tick of it: the
 * coefficients over a part are means of those over the whole, and so are the corners. So the answer is the first tick
 * that exact arithmetic does not exclude, whatever is tried before, and wherever intervals are halved.
 */
#ifndef UNCROSS_CONTACT_FLIGHT_H
#define UNCROSS_CONTACT_FLIGHT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/lattice.h"

#define FLIGHT_TICK_BITS 16
#define FLIGHT_TICKS (1 << FLIGHT_TICK_BITS) /* of a drift */

/* Two bonds. At tick T the bond vectors are p + T p_rate and q + T q_rate, and the vector from the first end of p to
 * that of q is w + T w_rate. Lattice units, each below 4096 a0 throughout the drift. */
struct flight_pair {
  struct point p, q, w;
  struct point p_rate, q_rate, w_rate;
};

/* True if the bonds certainly do not touch at any time from tick `from` to tick `to`, both included. */
bool flight_excluded(const struct flight_pair *pair, int32_t from, int32_t to);

/* The first tick, not before `from`, in which the bonds may touch; FLIGHT_TICKS if they do not touch in this drift. At
 * tick `from` they must be apart. */
int32_t flight_contact(const struct flight_pair *pair, int32_t from);

/* Place at tick T of a point that is at `at` at tick 0. */
static inline struct point flight_place(struct point at, struct point rate, int64_t tick)
{
  return (struct point){at.x + rate.x * tick, at.y + rate.y * tick, at.z + rate.z * tick};
}

/* Displacement in a tick, lattice units, for a displacement d (a0) in the whole drift: the nearest integers. */
static inline struct point flight_rate(struct vec3 d)
{
  const double ticks = LATTICE_PER_A0 / FLIGHT_TICKS;
  return (struct point){lattice_round(d.x * ticks), lattice_round(d.y * ticks), lattice_round(d.z * ticks)};
}

#endif
