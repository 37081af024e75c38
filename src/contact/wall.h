/*
 * Vertices at walls (Padding 2009, Sec. III, "wall conditions"; walls: mpc/border_walls.c). A vertex that reaches a
 * wall leaves it with the velocity 2 w - v, w being that of the wall; at a slip wall only v_y is reversed. The momentum
 * that the wall gives is entered in its account (wall/account.h), so that the balance of the whole box is exact.
 *
 * As at contacts of bonds (contact/impulse.h), what is reversed at a time tau from the middle of the step is not the
 * leap-frog's v but u = v + tau F/M, the velocity of that time. So a hit conserves the energy of the leap-frog to first
 * order in tau. The rule `sequential` moves vertices one at a time and knows no forces on the way: there tau is 0.
 *
 * All vertices are between the walls, and so are their bonds.
 */
#ifndef UNCROSS_CONTACT_WALL_H
#define UNCROSS_CONTACT_WALL_H

#include "contact/contact.h"

/* Where a straight move from a place between the walls, to one beyond, meets a wall. */
struct wall_meeting {
  enum wall wall;
  double part; /* of the move before it */
  struct point at;
};

struct wall_meeting wall_meet(const struct box *box, struct point from, struct point to);

/* A place set onto the wall if rounding has put it beyond. */
struct point wall_inside(const struct box *box, struct point p);

/* Vertex i hits a wall at a time tau (t0) from the middle of the step, under this force (kT/a0). Its velocity changes,
 * and what the wall gives is entered in the account. */
void wall_hit(struct state *state, const struct model *model, const struct drift_frame *frame, enum wall wall,
              uint32_t i, struct vec3 force, double tau);

/* Two parts of a drift in which all vertices move freely and at once: lists the vertices that hit a wall on their way,
 * while none has moved; after all have moved straight on, puts these to their places, and enters the momentum. False,
 * with the fault recorded, if a vertex would move too far, or if memory is short. */
bool wall_find_hits(struct state *state, const struct model *model, struct contact *contact, struct fault *fault);
void wall_answer_hits(struct state *state, const struct model *model, struct contact *contact);

#endif
