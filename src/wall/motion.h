/*
 * How walls move, and how far sheared images have slid. Both follow from the time alone, which is counted in half time
 * steps, and from where the images of a snapshot were at step 0. So nothing of it is part of the state.
 *
 * The motion is constant during a collision interval: that of the interval's middle. An oscillation takes a whole
 * number of intervals (system/shear.h). Holding the rate for an interval tau changes the amplitude by (omega tau)^2/24
 * of it.
 *
 * Collisions are numbered from 1. With the scheme drift-split they are half a step early, and so the first interval is
 * half a step shorter than the others.
 */
#ifndef UNCROSS_WALL_MOTION_H
#define UNCROSS_WALL_MOTION_H

#include "system/shear.h"

/* Number of the collision interval (0, 1, ...) that begins at this time or holds it. */
uint64_t shear_interval(const struct model *model, uint64_t half_steps);

/* Time of collision number `collision` (1, 2, ...), in half time steps. */
uint64_t shear_collision_time(const struct model *model, uint64_t collision);

/* Velocity of a wall during a collision interval, and at the collision that ends the interval; a0/t0. */
struct vec3 shear_wall_velocity(const struct model *model, enum wall wall, uint64_t interval);
struct vec3 shear_wall_velocity_at_end(const struct model *model, enum wall wall, uint64_t interval);

/* How far the image beyond y = L has slid along x at this time, folded into [0, edge), lattice units. During an
 * interval it slides a whole number of lattice units in each half step, so that it is exact at all times. 0 for a box
 * that is not sheared. */
int64_t shear_offset(const struct model *model, uint64_t half_steps);

/* The images begin where those of a snapshot are: that beyond y = L has slid by so many lattice units at step 0. Taken
 * modulo the edge; nothing happens to a box that is not sheared. */
void shear_begin(struct model *model, uint64_t slid);

#endif
