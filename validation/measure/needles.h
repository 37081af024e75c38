/* Collision rates of needles (fibers of one bond), for validation/measure/crossing_rates.c and the test of them. */
#ifndef UNCROSS_NEEDLES_H
#define UNCROSS_NEEDLES_H

#include <string.h>

#include "../../tests/statistics.h"
#include "energy.h"
#include "start/start.h"
#include "step.h"

/* Collisions of needles per volume and time if all vertices moved at once, exact in equilibrium.
 *
 * Two bonds of lengths l, l' at an angle theta meet at parameters s, s' at the rate l l' sin(theta) ds ds' <|w.n|>/2
 * per pair and volume; w.n is the relative velocity of the contact points along the common normal, a Gaussian of
 * variance (kT/M) [(1-s)^2 + s^2 + (1-s')^2 + s'^2]. With <sin> = pi/4, n bonds, n(n-1)/2 pairs, c_b = n/V:
 *
 *   rate = (pi/8) c_b^2 (1 - 1/n) <l>^2 sqrt(2 kT/(pi M)) I,    I = integral of the root of [...] over the unit square
 *
 * Moving one vertex at a time finds more crossings; those that separate the bonds (dP < 0) must cancel the surplus. */
static inline double needle_root_integral(void)
{
  const int n = 1000; /* midpoint rule: error below 1e-7 */
  double sum = 0.0;
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++) {
      double s = (i + 0.5) / n, t = (j + 0.5) / n;
      sum += sqrt((1 - s) * (1 - s) + s * s + (1 - t) * (1 - t) + t * t);
    }
  return sum / n / n;
}

static inline double needle_exact_rate(const struct model *m)
{
  const struct fiber_kind *k = &m->kind[0];
  const double pi = 3.141592653589793, variance = 1.0 / k->spring, l0 = k->bond_length;
  const double mean = l0 * (l0 * l0 + 3 * variance) / (l0 * l0 + variance); /* of l^2 exp(-k (l-l0)^2/2) */
  const double density = m->bonds / box_volume(&m->box);
  return pi / 8 * density * density * (1 - 1.0 / m->bonds) * mean * mean * sqrt(2 / (pi * k->mass)) *
         needle_root_integral();
}

struct rates {
  struct ratio net, executed; /* against the exact number of collisions */
  struct ratio negative;      /* against executed */
  struct ratio heat;          /* of fiber energy, per executed collision, kT */
};

/* Many runs of 2 t0, each from its own equilibrium state: without a thermostat the exchange heats by some 1e-3 kT per
 * collision (docs/accuracy.md), which over so short a time is below 0.1 % of the rate. */
static inline bool needle_rates(struct model *model, struct state *state, struct work *work, uint64_t seed,
                                uint32_t runs, struct rates *rates)
{
  const double time = 2.0, expected = needle_exact_rate(model) * box_volume(&model->box) * time;
  for (uint32_t run = 0; run < runs; run++) {
    model->seed = seed + run;
    memset(&state->counts, 0, sizeof state->counts);
    work->contact.neighbors.built = false;
    if (!start_state(state, model, work))
      return false;
    const struct energy before = energy_on_step(state, model, work);
    for (uint64_t k = 0; k < (uint64_t)(time / model->time_step + 0.5); k++)
      if (!step_advance(state, model, work, NULL))
        return false;
    const struct energy after = energy_on_step(state, model, work);
    const double executed = (double)state->counts.executed, negative = (double)state->counts.negative;
    ratio_add(&rates->net, executed - 2.0 * negative, expected);
    ratio_add(&rates->executed, executed, expected);
    ratio_add(&rates->negative, negative, executed);
    ratio_add(&rates->heat, energy_total(&after) - energy_total(&before), executed);
  }
  return true;
}

#endif
