/* Contacts at their own time: they do not heat, they balance, they return, they know no frame, and there are as many as
 * kinetic theory says (docs/contacts.md). */
#include "../../validation/measure/contacts.h"
#include "../../validation/measure/needles.h"
#include "../../validation/measure/reversal.h"
#include "support.h"

/* --- heat --------------------------------------------------------------------------------------------------------- */

struct heats {
  struct ratio heat, bilinear, balance;
};

/* 64 fibers x 16 in 8^3, kappa 64, no solvent: runs of 25 t0, each from an equilibrium state of its own. */
static struct heats measure_heats(double dt, int runs)
{
  struct heats h = {.heat = {0}};
  for (int r = 0; r < runs; r++) {
    struct model m = standard_model(8, 8, 8, 0, dt, 1);
    m.crossing.rule = CROSSING_EVENT_DRIVEN;
    add_kind(&m, 64, 16);
    struct run run;
    struct contact_watch w;
    run_start(&run, m, 300 + (uint64_t)r);
    contact_watch_start(&w, &run);
    for (uint64_t k = 0; k < (uint64_t)(25.0 / dt + 0.5); k++)
      contact_step(&run, &w);
    ratio_add(&h.heat, w.sums.heat, w.sums.contacts);
    ratio_add(&h.bilinear, w.sums.bilinear, w.sums.contacts);
    ratio_add(&h.balance, w.sums.balance, w.sums.contacts);
    contact_watch_end(&w);
    run_end(&run);
  }
  print_message("  dt %g: heat %.2e +- %.1e, bilinear %.2e +- %.1e kT, <J exp(-dH)> %.4f +- %.4f\n", dt,
                ratio_value(&h.heat), ratio_error(&h.heat), ratio_value(&h.bilinear), ratio_error(&h.bilinear),
                ratio_value(&h.balance), ratio_error(&h.balance));
  return h;
}

/* A reversal of v instead of u heats by 6.3e-3 kT at dt 0.01 (an independent prototype), 60 times the bound. Errors are
 * from 8 and 10 runs: 6.1 and 5.7 of them are one false alarm in 2000 (Student's t). */
static void a_contact_does_not_heat(void **unused)
{
  (void)unused;
  const struct heats coarse = measure_heats(0.02, 8), fine = measure_heats(0.01, 10);
  assert_true(ratio_error(&coarse.heat) < 5e-4 && ratio_error(&fine.heat) < 1e-4);
  assert_true(fabs(ratio_value(&coarse.heat)) < 2e-3 + 6.1 * ratio_error(&coarse.heat));
  assert_true(fabs(ratio_value(&fine.heat)) < 1e-4 + 5.7 * ratio_error(&fine.heat));
  assert_sigma(ratio_value(&coarse.balance), ratio_error(&coarse.balance), 1.0, 6.1);
  assert_sigma(ratio_value(&fine.balance), ratio_error(&fine.balance), 1.0, 5.7);
  assert_true(ratio_error(&coarse.balance) < 0.01 && ratio_error(&fine.balance) < 0.005);
}

/* --- the way back ------------------------------------------------------------------------------------------------- */

/* Ticks of 1.5e-7 t0: a vertex that flies with another velocity for up to five of them misses its place by 5e-7 a0
 * where |dv| < 0.7; the turned normal adds as much (validation/measure/reversal.h). */
static void a_drift_with_contacts_returns(void **unused)
{
  (void)unused;
  const struct reversal_setup setup = {8, 256, 16, 64, 0.01, 100, 5};
  const struct reversal r = reversal_measure(&setup);
  print_message("  %zu contacts; %d of %d drifts return to the bit, others to %.1e a0; whole run to %.1e a0\n",
                r.contacts, (int)r.same, (int)r.drifts, r.of_others.position, r.whole.position);
  assert_true(r.contacts >= 1000 && r.drifts > 80);
  assert_true(r.same > r.drifts / 3);
  assert_true(r.of_same.position == 0.0);
  assert_true(r.of_same.velocity < 1e-13);
  assert_true(r.of_others.position < 1e-6);
}

/* --- the frame ---------------------------------------------------------------------------------------------------- */

/* Over each step the mean displacement is dt times the mean velocity, which contacts conserve: to the rounding of
 * rates, half a lattice unit per tick for each piece of a path, and that of the landing. */
static void fibers_do_not_lag_behind_a_flow(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 5, 0.02, 1);
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  m.flow = (struct vec3){0.54, 0, 0};
  test_add_kind(&m, 104, 16);
  struct test_run r = test_start(m);
  double worst = 0.0;
  for (int k = 0; k < 200; k++) {
    double from = 0.0, to = 0.0, velocity = 0.0;
    const uint32_t n = r.state.vertices;
    for (uint32_t v = 0; v < n; v++) {
      from += (double)r.state.position[v].x * LATTICE_UNIT / n;
      velocity += r.state.velocity[v].x / n;
    }
    test_steps(&r, 1);
    for (uint32_t v = 0; v < n; v++)
      to += (double)r.state.position[v].x * LATTICE_UNIT / n;
    worst = fmax(worst, fabs(to - from - r.model.time_step * velocity));
  }
  print_message("  %d contacts, largest lag of a step %.1e a0\n", (int)r.state.counts.executed, worst);
  assert_true(r.state.counts.executed > 400);
  assert_true(worst < 0.5 * FLIGHT_TICKS * LATTICE_UNIT);
  test_end(&r);
}

/* --- how many ----------------------------------------------------------------------------------------------------- */

/* 4.5 standard errors of 30 runs: one false alarm in 10 000. */
static void needles_meet_as_often_as_kinetic_theory_says(void **unused)
{
  (void)unused;
  struct model m = test_model(4, 4, 4, 0, 0.01, 1);
  m.crossing.rule = CROSSING_EVENT_DRIVEN;
  struct fiber_kind *k = test_add_kind(&m, 474, 2);
  k->bond_length = 1.0;
  k->bending = 0.0;
  struct test_run r = test_start(m);
  struct rates rates = {.net = {0}};
  assert_true(needle_rates(&r.model, &r.state, &r.work, 1, 30, &rates));
  print_message("  executed/exact %.4f +- %.4f\n", ratio_value(&rates.executed), ratio_error(&rates.executed));
  assert_true(ratio_value(&rates.negative) == 0.0);
  assert_true(ratio_error(&rates.executed) < 0.012);
  assert_sigma(ratio_value(&rates.executed), ratio_error(&rates.executed), 1.0, 4.5);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_contact_does_not_heat),
                                     cmocka_unit_test(a_drift_with_contacts_returns),
                                     cmocka_unit_test(fibers_do_not_lag_behind_a_flow),
                                     cmocka_unit_test(needles_meet_as_often_as_kinetic_theory_says)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
