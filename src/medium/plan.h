/* The part of a medium in a plan. */
#ifndef UNCROSS_MEDIUM_PLAN_H
#define UNCROSS_MEDIUM_PLAN_H

#include "system/plan.h"

/* Appends the bath of this model to a plan, if it is not that of cells. room: offset of struct medium in struct work.
 * name: as in struct stage. */
void medium_plan_collision(struct plan *plan, const struct model *model, size_t room, const char *name);

/* The same of the forces of pairs, and of a kick by fraction * dt, if there are any. */
void medium_plan_forces(struct plan *plan, const struct model *model, size_t room, const char *name);
void medium_plan_kick(struct plan *plan, const struct model *model, size_t room, double fraction, const char *name);

#endif
