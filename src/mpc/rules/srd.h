/*
 * The SRD collision rule (Malevanets and Kapral 1999; Padding 2009, Sec. III, step 4): velocities relative to the
 * cell's center of mass are turned by a fixed angle about a random axis, one for each cell. rules/srd.c applies this to
 * many particles.
 */
#ifndef UNCROSS_MPC_RULES_SRD_H
#define UNCROSS_MPC_RULES_SRD_H

#include "mpc/cell.h"

/* w turned about n by 90 degrees: R w = n (n.w) + n x w. */
static inline struct vec3 srd_quarter_turn(struct vec3 w, struct vec3 n)
{
  return vec3_add(vec3_scale(vec3_dot(n, w), n), vec3_cross(n, w));
}

/* w turned about n by the angle of this cosine and sine (Rodrigues): R w = cos w + (1-cos) n (n.w) + sin n x w. */
static inline struct vec3 srd_turn(struct vec3 w, struct vec3 n, double cosine, double sine)
{
  struct vec3 along = vec3_scale((1.0 - cosine) * vec3_dot(n, w), n);
  return vec3_add(vec3_add(vec3_scale(cosine, w), along), vec3_scale(sine, vec3_cross(n, w)));
}

/* A member's velocity after the collision: Padding 2009, Eqs. (5) and (6). quarter: the angle is 90 degrees, cosine and
 * sine are not used. scaled: the relative velocity is multiplied by the thermostat's factor. */
static inline struct vec3 srd_apply(const struct cell_turn *turn, struct vec3 v, bool quarter, double cosine,
                                    double sine, bool scaled)
{
  struct vec3 w = vec3_sub(v, turn->center);
  struct vec3 turned = quarter ? srd_quarter_turn(w, turn->axis) : srd_turn(w, turn->axis, cosine, sine);
  return scaled ? vec3_add_scaled(turn->center, turn->factor, turned) : vec3_add(turn->center, turned);
}

/* Changes the velocities of the particles from place `first` of memory on, and those of all vertices, by the turns of
 * their cells. scaled: as in srd_apply. */
void srd_turn_from(struct state *state, const struct model *model, const struct mpc *mpc, uint32_t first, bool scaled);

#endif
