/*
 * Kinematic viscosity from the decay of a shear wave, for validation/measure/viscosity.c and the test of it.
 *
 * A transverse wave u(y) = A (cos ky, 0, sin ky), k = 2 pi/L_y, is added to an equilibrium solvent. It is two single
 * shear waves v_x(y), v_z(y) a quarter wavelength apart: a parallel flow, so an exact solution of the Navier-Stokes
 * equations at any amplitude, decaying as exp(-nu k^2 t), and it heats evenly in space. Runs with +A and -A start from
 * the same equilibrium state and use the same random numbers; half their difference keeps the wave and loses most of
 * the noise.
 *
 * The rate is estimated from the loss between looks, each weighted by the expected amplitude w; m collisions lie
 * between: lambda = sum_n w_n a_{n+1} / sum_n w_n a_n,    nu(k) = -ln(lambda) / (k^2 m dt_c) The collisional part of
 * the momentum flux acts between cell neighbors, which costs a factor sinc^2(ka/2) averaged over particles' places:
 * nu(k) = nu (1 - k^2 a^2/30) to leading order, for stresses that are mostly collisional.
 */
#ifndef UNCROSS_SHEAR_WAVE_H
#define UNCROSS_SHEAR_WAVE_H

#include "../../tests/statistics.h"
#include "start/start.h"
#include "step.h"
#include "system/model.h"
#include "system/state.h"

struct shear_wave {
  double amplitude;     /* A, in a0/t0 */
  double expected;      /* nu for the weights, a0^2/t0 */
  uint32_t every;       /* collisions between looks at the amplitude */
  uint32_t first, last; /* looks between which the decay is fitted; before `first`, correlations build up */
};

/* Time between looks. */
static inline double shear_wave_interval(const struct model *model, const struct shear_wave *wave)
{
  return wave->every * model_collision_interval(model);
}

static inline double shear_wave_number(const struct model *model)
{
  return 6.283185307179586477 / model->box.cells[1];
}

/* Adds the wave, with this sign, to every solvent particle and loose vertex. */
static inline void shear_wave_add(struct state *state, double k, double amplitude)
{
  struct solvent *s = &state->solvent;
  for (uint32_t i = 0; i < s->n; i++) {
    double phase = k * (double)s->y[i] * LATTICE_UNIT;
    s->vx[i] += amplitude * cos(phase);
    s->vz[i] += amplitude * sin(phase);
  }
  for (uint32_t i = 0; i < state->vertices; i++) {
    double phase = k * (double)state->position[i].y * LATTICE_UNIT;
    state->velocity[i].x += amplitude * cos(phase);
    state->velocity[i].z += amplitude * sin(phase);
  }
}

/* Amplitude of the wave of momentum over mass, right after a collision (the solvent then does not lag). */
static inline double shear_wave_amplitude(const struct model *model, const struct state *state, double k)
{
  const struct solvent *s = &state->solvent;
  double sum = 0.0;
  for (uint32_t i = 0; i < s->n; i++) {
    double phase = k * (double)s->y[i] * LATTICE_UNIT;
    sum += s->vx[i] * cos(phase) + s->vz[i] * sin(phase);
  }
  for (uint32_t i = 0; i < state->vertices; i++) {
    const struct vec3 v = state->velocity[i];
    double phase = k * (double)state->position[i].y * LATTICE_UNIT;
    sum += model->mass[i] * (v.x * cos(phase) + v.z * sin(phase));
  }
  return sum / model->total_mass;
}

/* One run from the equilibrium state of model->seed; adds factor * a_n to amplitude[n], n = 0 .. last. */
static inline bool shear_wave_run(const struct model *model, struct state *state, struct work *work,
                                  const struct shear_wave *wave, double sign, double *amplitude)
{
  const double k = shear_wave_number(model);
  if (!start_state(state, model, work))
    return false;
  shear_wave_add(state, k, sign * wave->amplitude);
  for (uint32_t i = 0; i < state->solvent.n && model_is_flat(model); i++)
    state->solvent.vz[i] = 0.0;
  for (uint32_t n = 0;; n++) {
    amplitude[n] += 0.5 * sign * shear_wave_amplitude(model, state, k);
    if (n == wave->last)
      return true;
    for (uint32_t step = 0; step < wave->every * model->solvent.interval_steps; step++)
      if (!step_advance(state, model, work, NULL))
        return false;
  }
}

/* One pair of runs (+A, -A) with model->seed = seed, its decay added to lambda. amplitude: room for last + 1. */
static inline bool shear_wave_pair(struct model *model, struct state *state, struct work *work,
                                   const struct shear_wave *wave, uint64_t seed, double *amplitude,
                                   struct ratio *lambda)
{
  const double k = shear_wave_number(model), rate = wave->expected * k * k * shear_wave_interval(model, wave);
  model->seed = seed;
  for (uint32_t n = 0; n <= wave->last; n++)
    amplitude[n] = 0.0;
  if (!shear_wave_run(model, state, work, wave, 1.0, amplitude) ||
      !shear_wave_run(model, state, work, wave, -1.0, amplitude))
    return false;
  double after = 0.0, before = 0.0;
  for (uint32_t n = wave->first; n < wave->last; n++) {
    double weight = exp(-rate * n);
    after += weight * amplitude[n + 1];
    before += weight * amplitude[n];
  }
  ratio_add(lambda, after, before);
  return true;
}

/* nu(k) of the box, and its standard error. */
static inline double shear_wave_viscosity(const struct model *model, const struct shear_wave *wave,
                                          const struct ratio *lambda)
{
  const double k = shear_wave_number(model);
  return -log(ratio_value(lambda)) / (k * k * shear_wave_interval(model, wave));
}

static inline double shear_wave_error(const struct model *model, const struct shear_wave *wave,
                                      const struct ratio *lambda)
{
  const double k = shear_wave_number(model);
  return ratio_error(lambda) / (ratio_value(lambda) * k * k * shear_wave_interval(model, wave));
}

#endif
