/* A bath other than that of collision cells: what a model may ask of it. */
#ifndef UNCROSS_SYSTEM_MEDIUM_H
#define UNCROSS_SYSTEM_MEDIUM_H

#include "system/model.h"

/* Most members of pairs, particles and vertices together: their numbers are draws of random numbers (base/random.h). */
#define MEDIUM_MOST_MEMBERS 16777216.0

/* Checks the medium of a model whose box is known, and derives its particles and its interval, which is a time step.
 * False, with the reason in *error. */
bool medium_finish(struct model *model, struct model_error *error);

#endif
