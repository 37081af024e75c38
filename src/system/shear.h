/*
 * The motion of walls and of sheared images, one collision interval at a time: wall/motion.h has it in time.
 *
 * An oscillation takes a whole number of intervals. Its cosines stand in a table (elementary_circle_turns), so that all
 * machines have the same bits.
 */
#ifndef UNCROSS_SYSTEM_SHEAR_H
#define UNCROSS_SYSTEM_SHEAR_H

#include "system/model.h"

/* The factor of the motion after so many half intervals; 1 where it is constant. */
double shear_wave(const struct model *model, uint64_t half_intervals);

/* Shear rate of a sheared box during an interval, 1/t0; 0 for another box. */
double shear_rate(const struct model *model, uint64_t interval);

/* Lattice units by which the image slides in a half step of this interval, folded into [0, edge). */
uint64_t shear_slide(const struct model *model, uint64_t interval);

/* Fills the table of the motion, once everything else of the model is derived. False if memory is short. */
bool shear_finish(struct model *model);

#endif
