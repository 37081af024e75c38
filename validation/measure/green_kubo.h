/*
 * Viscosity from the equilibrium fluctuations of the stress, for validation/measure/green_kubo.c and the test of it.
 *
 * M_ab is what one collision interval adds to the Helfand moment sum_i r_b,i m v_a,i of the unwrapped particles: the
 * flight's share and the collision's, for which only the place within the cell counts, because a cell keeps momentum
 * (Ihle, Tuzel and Kroll, Phys. Rev. E 72, 046707 (2005)):
 *
 *   M_ab = dt_c sum_i m v_a v_b + sum_i m (r_b - r_b,cell) (v_a' - v_a)
 *   eta(K) = [C_0/2 + sum_{k=1..K} C_k]/(kT V dt_c),    C_k = <M_ab(n) M_ab(n + k)>
 *
 * eta(K) for large K is the viscosity of a shear flow v_a(r_b). It follows from the decay of transverse momentum for
 * long waves, <|j(t) - j(0)|^2> = k^2 <(sum M)^2>, and asks nothing of the collision rule but stationarity. All six
 * off-diagonal components are averaged; ab and ba differ where a collision does not keep angular momentum.
 */
#ifndef UNCROSS_GREEN_KUBO_H
#define UNCROSS_GREEN_KUBO_H

#include <stdlib.h>
#include <string.h>

#include "../../tests/statistics.h"
#include "fluid/fluid.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "step.h"

enum { GREEN_KUBO_COMPONENTS = 6 }; /* xy, xz, yx, yz, zx, zy: first the velocity's axis, then the place's */

/* --- the series and its integral -------------------------------------------------------------------------------- */

/* Running integrals of the autocorrelation of several series of zero mean, averaged over them. Errors are those of
 * blocks. */
struct green_kubo {
  uint32_t lags;      /* the longest lag */
  uint32_t length;    /* of a block, in entries; much more than lags */
  uint64_t entries;   /* so far */
  double *past;       /* [lags + 1][components] ring of the last entries */
  double *sum;        /* [lags + 1] products in this block */
  uint32_t filled;    /* products of the longest lag in this block */
  struct sample *c;   /* [lags + 1] C_k, one entry per block */
  struct sample *eta; /* [lags + 1] C_0/2 + C_1 + ... + C_k, one entry per block */
};

static inline void green_kubo_free(struct green_kubo *g)
{
  free(g->past);
  free(g->sum);
  free(g->c);
  free(g->eta);
}

/* False if memory is short. */
static inline bool green_kubo_alloc(struct green_kubo *g, uint32_t lags, uint32_t length)
{
  const size_t n = (size_t)lags + 1;
  *g = (struct green_kubo){.lags = lags,
                           .length = length,
                           .past = calloc(n * GREEN_KUBO_COMPONENTS, sizeof(double)),
                           .sum = calloc(n, sizeof(double)),
                           .c = calloc(n, sizeof(struct sample)),
                           .eta = calloc(n, sizeof(struct sample))};
  if (g->past && g->sum && g->c && g->eta)
    return true;
  green_kubo_free(g);
  return false;
}

/* The next entry of all series. Products begin when all lags have a past. */
static inline void green_kubo_add(struct green_kubo *g, const double m[GREEN_KUBO_COMPONENTS])
{
  const uint64_t n = (uint64_t)g->lags + 1;
  memcpy(&g->past[g->entries % n * GREEN_KUBO_COMPONENTS], m, GREEN_KUBO_COMPONENTS * sizeof *m);
  if (g->entries++ < g->lags)
    return;
  for (uint64_t k = 0; k < n; k++) {
    const double *before = &g->past[(g->entries - 1 - k) % n * GREEN_KUBO_COMPONENTS];
    for (int a = 0; a < GREEN_KUBO_COMPONENTS; a++)
      g->sum[k] += m[a] * before[a];
  }
  if (++g->filled < g->length)
    return;
  double integral = 0.0;
  for (uint64_t k = 0; k < n; k++) {
    const double c = g->sum[k] / g->length / GREEN_KUBO_COMPONENTS;
    integral += k == 0 ? 0.5 * c : c;
    sample_add(&g->c[k], c);
    sample_add(&g->eta[k], integral);
    g->sum[k] = 0.0;
  }
  g->filled = 0;
}

/* --- the stress -------------------------------------------------------------------------------------------------- */

/* Velocity's axis and place's axis of each component. */
static const int green_kubo_axes[GREEN_KUBO_COMPONENTS][2] = {{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}};

/* Adds dt sum_i v_a v_b. */
static inline void green_kubo_flight(const struct solvent *s, double dt, double m[GREEN_KUBO_COMPONENTS])
{
  double xy = 0.0, xz = 0.0, yz = 0.0;
  for (uint32_t i = 0; i < s->n; i++) {
    xy += s->vx[i] * s->vy[i];
    xz += s->vx[i] * s->vz[i];
    yz += s->vy[i] * s->vz[i];
  }
  const double sum[GREEN_KUBO_COMPONENTS] = {xy, xz, xy, yz, xz, yz};
  for (int a = 0; a < GREEN_KUBO_COMPONENTS; a++)
    m[a] += dt * sum[a];
}

/* A coordinate relative to the centre of its cell on the shifted grid, a0. */
static inline double green_kubo_place(int64_t x, int64_t shift)
{
  return (double)((x + shift) & (LATTICE_CELL - 1)) * LATTICE_UNIT - 0.5;
}

/* Adds sign * sum_i (r_b - r_b,cell) v_a. */
static inline void green_kubo_places(const struct solvent *s, struct point shift, double sign,
                                     double m[GREEN_KUBO_COMPONENTS])
{
  double xy = 0.0, xz = 0.0, yx = 0.0, yz = 0.0, zx = 0.0, zy = 0.0;
  for (uint32_t i = 0; i < s->n; i++) {
    const double x = green_kubo_place(s->x[i], shift.x), y = green_kubo_place(s->y[i], shift.y),
                 z = green_kubo_place(s->z[i], shift.z);
    xy += s->vx[i] * y;
    xz += s->vx[i] * z;
    yx += s->vy[i] * x;
    yz += s->vy[i] * z;
    zx += s->vz[i] * x;
    zy += s->vz[i] * y;
  }
  const double sum[GREEN_KUBO_COMPONENTS] = {xy, xz, yx, yz, zx, zy};
  for (int a = 0; a < GREEN_KUBO_COMPONENTS; a++)
    m[a] += sign * sum[a];
}

/* One collision interval of a solvent without vertices: flight, then collision, as step_advance makes them (but
 * particles keep their places in memory). m: the Helfand moment's increment. False, with the fault recorded, as
 * mpc_collide. */
static inline bool green_kubo_interval(struct state *state, const struct model *model, struct mpc *mpc,
                                       double m[GREEN_KUBO_COMPONENTS], struct fault *fault)
{
  const uint64_t step = state->step + model->solvent.interval_steps;
  for (int a = 0; a < GREEN_KUBO_COMPONENTS; a++)
    m[a] = 0.0;
  green_kubo_flight(&state->solvent, model_collision_interval(model), m);
  state->solvent_lag = 2 * model->solvent.interval_steps;
  if (!fluid_stream(state, model, fault))
    return false;
  const struct point shift = grid_shift(model, step);
  grid_bin(state, model, shift, mpc);
  green_kubo_places(&state->solvent, shift, -1.0, m);
  if (!collide_sum(state, model, mpc, step, fault))
    return false;
  collide_solve(model, mpc, step);
  collide_turn(state, model, mpc, false);
  green_kubo_places(&state->solvent, shift, 1.0, m);
  state->step = step;
  return true;
}

#endif
