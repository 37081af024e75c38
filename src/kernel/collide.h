/* The collision in shorter ways. */
#ifndef UNCROSS_KERNEL_COLLIDE_H
#define UNCROSS_KERNEL_COLLIDE_H

#include "mpc/mpc.h"

/* collide_plain (mpc/collide.h) once more, by mpc->kernel.ways. */
bool kernel_collide(struct state *state, const struct model *model, struct mpc *mpc, uint64_t step,
                    struct fault *fault);

/* The collision in shorter ways by those that suit every scene: the functions of its fluid, border and rule, one after
 * the other. For processors without a fast kernel, and for what a fast kernel leaves to others. */
extern const struct kernel kernel_short;

#endif
