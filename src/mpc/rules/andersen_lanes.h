/* What AT-a does for each particle (andersen.h, at_a.c) once more, for LANES particles at once: the same operations in
 * the same order. */
#ifndef UNCROSS_MPC_RULES_ANDERSEN_LANES_H
#define UNCROSS_MPC_RULES_ANDERSEN_LANES_H

#include "base/normal_lanes.h"
#include "mpc/cell_lanes.h"

enum { ANDERSEN_LANES_MOST = 128 }; /* particles at a time: what is drawn stays in the nearest cache */

/* andersen_draw_particles, n a multiple of LANES. Words first, then normals: one loop of both is so long that the
 * processor sees too little of the next pass while it waits for the roots of this one. */
INLINE void andersen_draw_lanes(const struct solvent *s, const struct model *model, const struct mpc *c, uint64_t step,
                                uint32_t first, uint32_t n)
{
  const uint64_t seed = model->seed, z = model_is_flat(model) ? 0 : UINT64_MAX;
  words word[ANDERSEN_LANES_MOST / LANES][4];
  for (uint32_t k = 0; k < n; k += LANES)
    philox_words(seed, RANDOM_ANDERSEN_PARTICLE, 0, step, load_low(&s->id[first + k]), word[k / LANES]);
  for (uint32_t k = 0; k < n; k += LANES) {
    reals x[3];
    normal_three_lanes(word[k / LANES], x);
    store_reals(&c->drawn[0][first + k], x[0]);
    store_reals(&c->drawn[1][first + k], x[1]);
    store_reals(&c->drawn[2][first + k], (reals)((words)x[2] & z));
  }
}

/* New velocities of LANES particles from place i on, by AT-a: the center's and the drawn one. */
INLINE void andersen_turn_lanes(const struct solvent *s, const struct mpc *c, uint32_t i)
{
  double *const v[3] = {s->vx, s->vy, s->vz};
  reals turn[4];
  load_columns((const double *)c->turn, &c->solvent_cell[i], turn, 4);
  for (int k = 0; k < 3; k++)
    store_reals(&v[k][i], choose(turn[3] != 0.0, turn[k] + load_reals(&c->drawn[k][i]), load_reals(&v[k][i])));
}

#endif
