/*
 * Vertices that are held: those of frozen fibers, and single ones of others. They stand still and take part in the
 * bath.
 *
 * A held vertex has a velocity like any other. Collisions change it, by momentum and mass, so that the fluid is as
 * heavy and as viscous as if the vertex moved. But it moves nothing: in a drift the velocity is set aside, and is 0.
 * Its inverse mass is 0 (system/model.h), so that no force changes it. A bond between two of them is a wall, from which
 * a fiber bounces: the velocity of the contact point of the moving bond reverses along the normal, kinetic energy is
 * conserved, and momentum goes to the obstacle and is lost. That holds under every crossing rule. A rigid cluster with
 * such a vertex stands (contact/event_rigid.h).
 *
 * Every bath that has velocities keeps these at kT = 1: what a bath needs of a mass is `mass`, never the inverse one.
 */
#ifndef UNCROSS_CONTACT_HELD_H
#define UNCROSS_CONTACT_HELD_H

#include "system/model.h"
#include "system/state.h"

/* Keeps the velocities of held vertices in aside[vertices], and sets them to 0. */
void held_set_aside(struct state *state, const struct model *model, struct vec3 *aside);

/* Undoes it. */
void held_give_back(struct state *state, const struct model *model, const struct vec3 *aside);

#endif
