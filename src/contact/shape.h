/* What bonds are to each other: thin lines (contact/flight.h) or tubes (contact/tube.h). This is the contract of the
 * rows in shape.c, for the rule `event-driven`. */
#ifndef UNCROSS_CONTACT_SHAPE_H
#define UNCROSS_CONTACT_SHAPE_H

#include "contact/flight.h"

/* Two bonds when they touch, in space, a0: their vectors, from the first one's nearest point to the other's, and the
 * velocity of the first point relative to the other, a0/t0. */
struct shape_contact {
  struct vec3 p, q, gap, velocity;
};

struct bond_shape {
  const char *name;

  /* The first tick, not before `from`, in which the bonds may touch; FLIGHT_TICKS if they do not. reach: distance of
   * their axes at a contact, lattice units; 0 for lines. Never late. */
  int32_t (*contact)(const struct flight_pair *pair, int64_t reach, int32_t from);

  /* The points where two bonds p and q touch, w from the first end of p to that of q: s along p, t along q, from 0
   * to 1. */
  void (*points)(struct vec3 p, struct vec3 q, struct vec3 w, double *s, double *t);

  /* The unit vector along which they push each other, from the first to the other. False if they touch already, which
   * cannot happen in a drift that began with all bonds apart. */
  bool (*normal)(const struct flight_pair *pair, int32_t tick, const struct shape_contact *at, struct vec3 *n);
};

extern const struct bond_shape line_shape, tube_shape;

/* The shape of two bonds whose axes touch at this distance. */
static inline const struct bond_shape *bond_shape_of(int64_t reach)
{
  return reach == 0 ? &line_shape : &tube_shape;
}

#endif
