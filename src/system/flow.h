/* The part of a model that makes the solvent flow: walls, shear, the profile of its body force. */
#ifndef UNCROSS_SYSTEM_FLOW_H
#define UNCROSS_SYSTEM_FLOW_H

#include "system/model.h"

/* Checks what a scene says of dimensions, walls, shear and force, once its solvent is finished. Derives the boundary of
 * the box, the velocities of the walls, and the length of their period. False with the reason in *error. */
bool flow_finish(struct model *model, struct model_error *error);

#endif
