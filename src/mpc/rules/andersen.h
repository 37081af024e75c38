/* What the rules that draw velocities anew (at_a.c, at_plus_a.c) have in common: the drawn velocities xi. */
#ifndef UNCROSS_MPC_RULES_ANDERSEN_H
#define UNCROSS_MPC_RULES_ANDERSEN_H

#include <string.h>

#include "base/normal.h"
#include "mpc/cell.h"
#include "mpc/members.h"

enum { ANDERSEN_BLOCK = 256 }; /* particles worked on at a time */

/* A velocity from the Maxwell distribution of this mass, a0/t0. */
static inline struct vec3 andersen_draw(const struct model *model, enum random_purpose purpose, uint64_t step,
                                        uint32_t entity, double mass)
{
  double x[3];
  random_normal_three(random_at(model->seed, purpose, 0, step, entity), x);
  return vec3_scale(1.0 / sqrt(mass), (struct vec3){x[0], x[1], model_is_flat(model) ? 0.0 : x[2]});
}

/* Velocities of a block of particles, or v - xi, a column for each component, a0/t0. */
struct andersen_change {
  double x[ANDERSEN_BLOCK], y[ANDERSEN_BLOCK], z[ANDERSEN_BLOCK];
};

/* Draws xi of m particles, from place i of memory on, into mpc->drawn. */
static inline void andersen_draw_particles(const struct solvent *s, const struct model *model, const struct mpc *c,
                                           uint64_t step, uint32_t i, uint32_t m)
{
  random_normal_three_columns(model->seed, RANDOM_ANDERSEN_PARTICLE, 0, step, &s->id[i], m, &c->drawn[0][i],
                              &c->drawn[1][i], &c->drawn[2][i]);
  if (model_is_flat(model))
    memset(&c->drawn[2][i], 0, m * sizeof *c->drawn[2]);
}

/* The same, and sets the columns of `change`. */
static inline void andersen_draw_block(const struct solvent *s, const struct model *model, struct mpc *c, uint64_t step,
                                       uint32_t i, uint32_t m, struct andersen_change *change)
{
  andersen_draw_particles(s, model, c, step, i, m);
  const double *restrict x = &c->drawn[0][i], *restrict y = &c->drawn[1][i], *restrict z = &c->drawn[2][i];
  const double *restrict vx = &s->vx[i], *restrict vy = &s->vy[i], *restrict vz = &s->vz[i];
  for (uint32_t k = 0; k < m; k++) {
    change->x[k] = vx[k] - x[k];
    change->y[k] = vy[k] - y[k];
    change->z[k] = vz[k] - z[k];
  }
}

/* AT-a: new velocities of the particles from place `first` of memory on, and of all vertices, from what they drew and
 * the turns of their cells. */
void andersen_turn_from(struct state *state, const struct mpc *mpc, uint32_t first);

#endif
