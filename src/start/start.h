/* The state in which a run begins. */
#ifndef UNCROSS_START_START_H
#define UNCROSS_START_START_H

#include "work.h"

/* The starting state (Padding 2009, Sec. III, step 1): solvent and fibers, with velocities of vertices half a step
 * ahead. The total momentum is that of the flow; in a bath of phantoms it is thermal. False, with the fault recorded,
 * if a bond does not fit the box. The work may have served another state. */
bool start_state(struct state *state, const struct model *model, struct work *work);

/* 1 along the axes along which the total momentum is conserved, else 0. A random solvent and walls take up momentum,
 * slip walls only along y. */
struct vec3 start_conserved_axes(const struct model *model);

/* Gives the velocities of a state without a drive those of a start: total momentum, and half steps ahead of and behind
 * the drive (system/bead.h). Nothing without a driven bead. */
void start_begin_drive(struct state *state, const struct model *model);

/* Takes the half steps back: all velocities of a state between two steps become those of its time. model: with the
 * drive and the time step that it had so far. */
void start_end_drive(struct state *state, const struct model *model);

/* True if no tubes of thick fibers overlap, and none with a bead, and no thin bonds touch by the rule `event-driven`;
 * else the fault says which. For states that come from files. */
bool start_sound(const struct state *state, const struct model *model, struct fault *fault);

#endif
