/*
 * Virtual particles of mass 1 that stand in a cell for solvent that is not simulated: the phantoms of a random solvent,
 * the solvent beyond a wall, and the matter of a bead (bead/matter.c). Phantoms and walls use the same addresses of
 * random numbers; no scene has both.
 */
#ifndef UNCROSS_MPC_VIRTUAL_H
#define UNCROSS_MPC_VIRTUAL_H

#include "mpc/border.h"

enum { VIRTUAL_CHANCES = 512 }; /* room; the largest mean of a part needs 398 */

/* The law of Poisson numbers of one mean. A large mean is drawn in equal parts. at_most[k]: the chance that a part is k
 * or less, for k < count; from there on it is 1 but for rounding. */
struct virtual_law {
  uint32_t parts, count;
  double at_most[VIRTUAL_CHANCES];
};

/* The law of this mean, at least 0. */
void virtual_law_of(double mean, struct virtual_law *law);

/* A number for this cell. */
uint32_t virtual_number(const struct virtual_law *law, const struct model *model, uint64_t step, uint32_t cell);

/* The same for each of `cells` cells, in a form that vectorises: n[cells]. */
void virtual_numbers(const struct virtual_law *law, const struct model *model, uint64_t step, const uint32_t *cell,
                     uint32_t cells, uint32_t *n);

/* The normal deviates of the mean velocities of `cells` cells. */
void virtual_normals(const struct model *model, uint64_t step, const uint32_t *cell, uint32_t cells,
                     struct vec3 *normal);

/* The mean velocity of n particles of a cell (n > 0, need not be whole) whose velocities are of the Maxwell
 * distribution about `flow`: flow + N(0,1)/sqrt(n) in each component, a0/t0. normal: of this cell. */
static inline struct vec3 virtual_velocity(struct vec3 normal, double n, struct vec3 flow)
{
  return vec3_add_scaled(flow, 1.0 / sqrt(n), normal);
}

/* Half of the range of a cell's sums is reserved for virtual particles, of which there are 1000 at most on average, in
 * flows of at most 100 a0/t0 (system/model_finish.c). True if the other members leave them that room, and the mass
 * stays in its range. If not, the fault is recorded: a momentum with this code, and without its entity. */
bool virtual_room(const struct cell_sum *sum, double n, uint64_t step, uint32_t cell, enum fault_code code,
                  struct fault *fault);

#endif
