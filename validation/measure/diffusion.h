/* Diffusion of loose vertices, for validation/measure/vertex_diffusion.c and the test of it. */
#ifndef UNCROSS_DIFFUSION_H
#define UNCROSS_DIFFUSION_H

#include <stdlib.h>
#include <string.h>

#include "../../tests/statistics.h"
#include "step.h"

/* Velocity kept by a vertex of mass M per collision, where the other members of its cell are n solvent particles and l
 * other vertices, both Poisson, l of mean `loading`, and the rotation is about a uniform axis:
 *   c = 1 - (2/3)(1 - cos alpha) <m_o/(M + m_o)>,   m_o = n + l M */
static inline double diffusion_retention(double per_cell, double loading, double mass, double cosine)
{
  double average = 0.0, pl = exp(-loading);
  for (int l = 0; l < 20; pl *= loading / ++l) {
    double pn = exp(-per_cell);
    for (int n = 0; n < 200; pn *= per_cell / ++n) {
      double other = n + l * mass;
      average += pl * pn * other / (mass + other);
    }
  }
  return 1.0 - 2.0 / 3.0 * (1.0 - cosine) * average;
}

/* Fraction of its excess kinetic energy that such a vertex gives to its cell's other members. It keeps of its velocity
 * (M + m_o R)/M_t, M_t = M + m_o, so of its energy <(M^2 + m_o^2 + 2 M m_o c_1)/M_t^2>, c_1 = (1 + 2 cos alpha)/3. */
static inline double diffusion_energy_given(double per_cell, double loading, double mass, double cosine)
{
  double average = 0.0, pl = exp(-loading);
  for (int l = 0; l < 20; pl *= loading / ++l) {
    double pn = exp(-per_cell);
    for (int n = 0; n < 200; pn *= per_cell / ++n) {
      double other = n + l * mass;
      average += pl * pn * mass * other / ((mass + other) * (mass + other));
    }
  }
  return 4.0 / 3.0 * (1.0 - cosine) * average;
}

/* kT of a closed box at rest. It is set by the starting state, and scatters by sqrt(2/3N) from seed to seed. A bath of
 * phantoms has 1. */
static inline double diffusion_temperature(const struct state *state, const struct model *model)
{
  if (model_has_phantoms(model))
    return 1.0;
  const struct solvent *s = &state->solvent;
  double twice = 0.0;
  for (uint32_t i = 0; i < s->n; i++)
    twice += s->vx[i] * s->vx[i] + s->vy[i] * s->vy[i] + s->vz[i] * s->vz[i];
  for (uint32_t v = 0; v < state->vertices; v++)
    twice += model->mass[v] * vec3_dot(state->velocity[v], state->velocity[v]);
  return twice / 3.0 / (s->n + state->vertices - 1.0);
}

/* Molecular chaos: the Green-Kubo sum of a velocity that keeps c per collision, D_0 = (kT dt_c/M) [1/(1-c) - 1/2], at
 * kT = 1. The last factor: in a closed box at rest, which a bath of phantoms is not, a velocity is measured against the
 * rest of the box, <v^2> = (kT/M)(1 - M/M_total). */
static inline double diffusion_chaos(const struct model *model)
{
  const double mass = model->mass[0], loading = model->vertices / box_volume(&model->box);
  const double c = diffusion_retention(model->solvent.per_cell, loading, mass, model->solvent.cosine);
  const double closed = model_has_phantoms(model) ? 1.0 : 1.0 - mass / model->total_mass;
  return model_collision_interval(model) / mass * (1.0 / (1.0 - c) - 0.5) * closed;
}

/* D/kT from the growth of the mean square displacement between two lags, counted in looks that are `every` steps apart:
 * D/kT = [msd(t_2) - msd(t_1)]/(6 kT (t_2 - t_1)); t_1 is beyond the memory of the velocity. One entry of `d` per block
 * of 50 looks. False if a step fails or memory is short. */
static inline bool diffusion_run(const struct model *model, struct state *state, struct work *work, uint32_t every,
                                 uint32_t looks, const uint32_t lag[2], struct sample *d)
{
  const size_t n = model->vertices, depth = lag[1] + 1;
  const double time = every * model->time_step * (lag[1] - lag[0]);
  const double kt = diffusion_temperature(state, model);
  struct point *past = calloc(n * depth, sizeof *past);
  struct blocks blocks = {.length = 50};
  bool ok = past != NULL;
  for (uint32_t look = 0; ok && look < looks; look++) {
    for (uint32_t k = 0; ok && k < every; k++)
      ok = step_advance(state, model, work, NULL);
    memcpy(&past[look % depth * n], state->position, n * sizeof *past);
    if (look < lag[1])
      continue;
    double growth = 0.0;
    for (size_t v = 0; v < n; v++) {
      struct vec3 near = point_difference(state->position[v], past[(look - lag[0]) % depth * n + v]);
      struct vec3 far = point_difference(state->position[v], past[(look - lag[1]) % depth * n + v]);
      growth += vec3_dot(far, far) - vec3_dot(near, near);
    }
    blocks_add(&blocks, growth / (double)n / 6.0 / time / kt);
  }
  free(past);
  *d = blocks.of_blocks;
  return ok;
}

#endif
