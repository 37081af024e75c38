/* Which kernel the collisions of a scene take, and what the processor can do. */
#ifndef UNCROSS_KERNEL_CHOOSE_H
#define UNCROSS_KERNEL_CHOOSE_H

#include "mpc/mpc.h"

/* The fast kernels (solvent.c), one for each instruction set: the last one that the processor has is the fastest. */
struct kernel_row {
  const struct kernel *kernel;
  bool (*runs)(void); /* the processor has its instructions */
};

extern const struct kernel kernel_sse2, kernel_avx2, kernel_avx512;

/* All of them. Built with PLAIN=1 there is kernel_short only (kernel/collide.h). */
extern const struct kernel_row kernel_rows[];
extern const size_t kernel_row_count;

/* Which ways of a fast kernel a scene can use. The others are those that suit every scene (kernel/collide.h). */
struct kernel_parts {
  bool gather, solve, turn;
};

struct kernel_parts kernel_parts_for(const struct model *model);

/* A fast kernel with the ways that the model can use, and those that suit every scene for the rest. The plain one is
 * returned as it is. */
struct kernel kernel_mix(const struct kernel *fast, const struct model *model);

/* The kernel for this model on this processor. */
struct kernel kernel_choose(const struct model *model);

#endif
