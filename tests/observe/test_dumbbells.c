/* The observer of dumbbells, against sums by hand between two collisions, and as a checkpoint continues it. */
#include "support.h"
#include "tables.h"

#include "fluid/fluid.h"

static struct observe_plan plan_every(uint64_t every, uint64_t from)
{
  struct observe_plan plan = {.from = from};
  plan.every[OBSERVE_DUMBBELLS] = every;
  return plan;
}

static struct model sheared(void)
{
  struct model m = test_model(6, 6, 4, 5, 0.025, 4);
  m.dumbbells = (struct dumbbell_model){.spring = 1.5, .fraction = 0.7};
  m.shear.rate = 0.5;
  return m;
}

/* Two samples, within an interval: means are those of the vectors now. */
static void moments_by_hand(void **unused)
{
  (void)unused;
  struct test_run r = test_start(sheared());
  const struct observe_plan plan = plan_every(2, 5);
  struct observers *o = observers_create(&plan, &r.model);
  assert_non_null(o);
  double xx = 0, yy = 0, zz = 0, xy = 0, n = 0;
  for (int step = 0; step <= 9; step++) {
    assert_true(observers_sample(o, &r.model, &r.state, NULL));
    for (uint32_t p = 0; (step == 6 || step == 8) && p < r.state.dumbbells.n; p++, n++) {
      const struct vec3 v = fluid_dumbbell_now(&r.state, &r.model, p);
      xx += v.x * v.x, yy += v.y * v.y, zz += v.z * v.z, xy += v.x * v.y;
    }
    test_steps(&r, 1);
  }
  xx /= n, yy /= n, zz /= n, xy /= n;
  struct kept *kept = keep_summaries(o, &r.model);
  assert_int_equal(kept->tables, 1);
  assert_close(kept_value(kept, "dumbbells", 0, "r2"), xx + yy + zz, 1e-7);
  assert_close(kept_value(kept, "dumbbells", 0, "rxrx"), xx, 1e-7);
  assert_close(kept_value(kept, "dumbbells", 0, "ryry"), yy, 1e-7);
  assert_close(kept_value(kept, "dumbbells", 0, "rzrz"), zz, 1e-7);
  assert_close(kept_value(kept, "dumbbells", 0, "rxry"), xy, 1e-7);
  assert_close(kept_value(kept, "dumbbells", 0, "extension"), sqrt((xx + yy + zz) / (3.0 / 1.5)), 1e-7);
  assert_close(kept_value(kept, "dumbbells", 0, "chi"), 90.0 / acos(-1.0) * atan2(2.0 * xy, xx - yy), 1e-5);
  assert_close(kept_value(kept, "dumbbells", 0, "samples"), 2, 0);
  assert_true(isnan(kept_value(kept, "dumbbells", 0, "r2_error")));
  free(kept);
  observers_free(o);
  test_end(&r);
}

/* At rest <r_a r_a> = kT/K, and chi is undefined: 45 degrees wide at least. Errors are those of blocks; false alarm of
 * five numbers within 4.5 sigma: 1e-4 for Gaussian errors. */
static void errors_cover_equilibrium(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 5, 0.1, 1);
  m.dumbbells = (struct dumbbell_model){.spring = 2.0, .fraction = 1.0};
  m.solvent.rule = RULE_AT_A;
  struct test_run r = test_start(m);
  const struct observe_plan plan = plan_every(2, 0);
  struct observers *o = observers_create(&plan, &r.model);
  assert_non_null(o);
  for (int step = 0; step <= 2000; step++) {
    assert_true(observers_sample(o, &r.model, &r.state, NULL));
    test_steps(&r, 1);
  }
  struct kept *kept = keep_summaries(o, &r.model);
  static const char *const names[][2] = {{"rxrx", "rxrx_error"},
                                         {"ryry", "ryry_error"},
                                         {"rzrz", "rzrz_error"},
                                         {"rxry", "rxry_error"},
                                         {"r2", "r2_error"}};
  static const double expected[] = {0.5, 0.5, 0.5, 0.0, 1.5};
  for (int k = 0; k < 5; k++) {
    const double error = kept_value(kept, "dumbbells", 0, names[k][1]);
    assert_sigma(kept_value(kept, "dumbbells", 0, names[k][0]), error, expected[k], 4.5);
    assert_true(error < 0.02 && error > 0.5 / sqrt(1280.0 * 1000.0));
  }
  assert_close(kept_value(kept, "dumbbells", 0, "extension_error"),
               0.5 * kept_value(kept, "dumbbells", 0, "r2_error") / 1.5,
               0.05 * kept_value(kept, "dumbbells", 0, "extension_error"));
  free(kept);
  observers_free(o);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(moments_by_hand), cmocka_unit_test(errors_cover_equilibrium)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
