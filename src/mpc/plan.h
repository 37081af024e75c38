/* The parts of collision and solvent in a plan. */
#ifndef UNCROSS_MPC_PLAN_H
#define UNCROSS_MPC_PLAN_H

#include "system/plan.h"

/* Appends the collision of this model to a plan, if the model has collisions. room: offset of struct mpc in struct
 * work. name: as in struct stage. */
void mpc_plan_collision(struct plan *plan, const struct model *model, size_t room, const char *name);

#endif
