/* The observers of flow, profile and stress: against sums by hand, exact balances, and a second implementation of the
 * stress (validation/measure/green_kubo.h). Planted in development, and seen to fail: the place at the end of a flight
 * instead of its middle, no kinetic part, twice the collisional part, slabs shifted by one, temperature with velocities
 * of the laboratory. */
#include "support.h"
#include "tables.h"

#include "../../validation/measure/green_kubo.h"
#include "fluid/fluid.h"
#include "mpc/stress.h"
#include "theory/theory.h"
#include "wall/account.h"

/* Columns of stress. */
#define XY "sigma_xy"
#define XY_KINETIC "sigma_xy_kinetic"
#define XY_COLLISIONAL "sigma_xy_collisional"
#define PRESSURE "pressure"
#define LOWER "sigma_lower"
#define UPPER "sigma_upper"

struct watched {
  struct test_run run;
  struct observers *observers;
  struct kept_rows *rows;
};

static struct watched watch(struct model model, struct observe_plan plan)
{
  struct watched w = {.run = test_start(model), .rows = calloc(1, sizeof *w.rows)};
  assert_non_null(w.rows);
  assert_non_null(w.observers = observers_create(&plan, &w.run.model));
  observers_watch(w.observers, &w.run.work);
  return w;
}

static void look(struct watched *w)
{
  const struct observe_sink sink = {keep_row, w->rows};
  assert_true(observers_sample(w->observers, &w->run.model, &w->run.state, &sink));
}

static void go(struct watched *w, uint64_t steps)
{
  look(w);
  for (uint64_t k = 0; k < steps; k++) {
    test_steps(&w->run, 1);
    look(w);
  }
}

static void end_watch(struct watched *w)
{
  observers_free(w->observers);
  free(w->rows);
  test_end(&w->run);
}

static struct observe_plan stress_every(uint64_t every)
{
  struct observe_plan plan = {.longest_lag = 0};
  plan.every[OBSERVE_STRESS] = every;
  return plan;
}

/* Rows begin with the first that has an average: row 1 is that of the first interval. */
static double stress_of(const struct watched *w, size_t row, const char *column)
{
  return kept_cell(w->rows, &w->run.model, OBSERVE_STRESS, row - 1, column);
}

/* --- stress ------------------------------------------------------------------------------------------------------ */

/* The same run, observed and by the program of validation: xy to rounding (2^-28 per term of 2560). */
static void stress_is_that_of_green_kubo(void **unused)
{
  (void)unused;
  enum { STEPS = 50 };
  const struct model model = test_model(8, 8, 8, 5, 0.1, 1);
  struct watched w = watch(model, stress_every(1));
  struct test_run other = test_start(model);
  go(&w, STEPS);
  assert_int_equal(w.rows->rows, STEPS);
  double largest = 0.0;
  for (uint64_t k = 1; k <= STEPS; k++) {
    double m[GREEN_KUBO_COMPONENTS];
    assert_true(green_kubo_interval(&other.state, &other.model, &other.work.mpc, m, &other.work.fault));
    const double expected = -m[0] / (box_volume(&other.model.box) * 0.1);
    assert_close(stress_of(&w, k, XY), expected, 1e-8);
    largest = fmax(largest, fabs(expected));
  }
  assert_true(largest > 0.05);
  test_end(&other);
  end_watch(&w);
}

/* A flow of everything, and a force on everything, add nothing but rounding to the kinetic part of the first interval.
 * Later the places within cells differ. */
static void common_motion_adds_nothing(void **unused)
{
  (void)unused;
  struct watched still = watch(test_model(8, 8, 8, 5, 0.1, 1), stress_every(1));
  struct model model = test_model(8, 8, 8, 5, 0.1, 1);
  model.flow = (struct vec3){0.5, -0.7, 0.3};
  model.solvent.acceleration = (struct vec3){0.5, 0.4, 0.0};
  struct watched moving = watch(model, stress_every(1));
  go(&still, 1);
  go(&moving, 1);
  assert_close(stress_of(&moving, 1, XY_KINETIC), stress_of(&still, 1, XY_KINETIC), 1e-8);
  end_watch(&still);
  end_watch(&moving);
}

/* Pressure of an ideal gas, in each row up to the collisional part's fluctuations, on average n kT, and no shear
 * stress. 300 rows of 2560 particles; the momentum kept takes 1/N away. Stresses of successive collisions are
 * correlated, so errors are those of 30 means of 10 rows (1 t0). False alarm: 1e-3 (4 sigma of 29 degrees of freedom,
 * two numbers). */
static void pressure_of_equilibrium(void **unused)
{
  (void)unused;
  enum { STEPS = 300, BLOCK = 10 };
  struct watched w = watch(test_model(8, 8, 8, 5, 0.1, 1), stress_every(1));
  const double energy = observe_conserved(&w.run.model, &w.run.state).solvent_kinetic;
  go(&w, STEPS);
  struct sample shear = {0}, pressure = {0};
  for (size_t first = 1; first <= STEPS; first += BLOCK) {
    double xy = 0.0, p = 0.0;
    for (size_t k = first; k < first + BLOCK; k++)
      xy += stress_of(&w, k, XY) / BLOCK, p += stress_of(&w, k, PRESSURE) / BLOCK;
    sample_add(&shear, xy);
    sample_add(&pressure, p);
  }
  /* without a thermostat kT is that of the start */
  assert_sigma(pressure.mean, sample_error(&pressure), energy / 1.5 / box_volume(&w.run.model.box), 4);
  assert_sigma(shear.mean, sample_error(&shear), 0, 4);
  assert_true(sample_error(&pressure) < 0.02 && sample_error(&shear) < 0.04);
  end_watch(&w);
}

/* --- the sheared box --------------------------------------------------------------------------------------------- */

static struct model sheared(double rate, double period)
{
  struct model m = test_model(8, 8, 8, 5, 0.1, 1);
  box_bound(&m.box, 1, BOUNDARY_SHEAR);
  m.shear.rate = rate;
  m.shear.period = period;
  return m;
}

/* Half the sum of (v - u(y))^2, with u the linear flow. */
static double heat(const struct watched *w, double rate)
{
  const struct solvent *s = &w->run.state.solvent;
  double sum = 0.0;
  for (uint32_t i = 0; i < s->n; i++) {
    const double x = s->vx[i] - rate * ((double)s->y[i] * LATTICE_UNIT - 0.5 * w->run.model.box.cells[1]);
    sum += 0.5 * (x * x + s->vy[i] * s->vy[i] + s->vz[i] * s->vz[i]);
  }
  return sum;
}

/* A rule that keeps energy: the heat of each interval is stress rate volume, to rounding (the exact check of all parts:
 * a flight turns -rate dt m w_x v_y into heat, w of its middle; a collision rate m y (v_x' - v_x)). */
static void heating_is_stress_times_rate(void **unused)
{
  (void)unused;
  const double rate = 0.3;
  struct watched w = watch(sheared(rate, 0.0), stress_every(1));
  look(&w);
  double gained = 0.0;
  for (uint64_t k = 1; k <= 60; k++) {
    const double before = heat(&w, rate);
    go(&w, 1);
    const double expected = stress_of(&w, k, XY) * rate * box_volume(&w.run.model.box) * 0.1;
    assert_close(heat(&w, rate) - before, expected, 1e-6);
    gained += expected;
  }
  assert_true(gained > 50.0);
  end_watch(&w);
}

/* --- walls ------------------------------------------------------------------------------------------------------- */

/* Couette flow, 150 t0 after a transient of 20 (momentum crosses the gap in about 3): the stress on each wall is that
 * of the bulk, and stress over the slope of the profile is theory's viscosity within 8 % (molecular chaos). Differences
 * come from 30 blocks; false alarm 2 x 6e-5 (4 sigma). */
static void walls_feel_the_stress_of_the_bulk(void **unused)
{
  (void)unused;
  enum { L = 10, EVERY = 250, BLOCKS = 30 };
  struct model m = test_model(8, L, 8, 10, 0.02, 1);
  box_bound(&m.box, 1, BOUNDARY_WALL);
  m.solvent.rule = RULE_AT_A;
  m.walls.kind = WALL_NO_SLIP;
  m.walls.shear_rate = 0.15;
  struct observe_plan plan = stress_every(EVERY);
  plan.every[OBSERVE_PROFILE] = 5;
  plan.slabs = L;
  plan.from = 1000;
  struct watched w = watch(m, plan);
  go(&w, 1000 + EVERY * BLOCKS);
  struct sample lower = {0}, upper = {0}, bulk = {0};
  for (size_t k = 5; k <= 4 + BLOCKS; k++) {
    const double xy = stress_of(&w, k, XY);
    sample_add(&bulk, xy);
    sample_add(&lower, stress_of(&w, k, LOWER) - xy);
    sample_add(&upper, stress_of(&w, k, UPPER) - xy);
  }
  assert_sigma(lower.mean, sample_error(&lower), 0, 4);
  assert_sigma(upper.mean, sample_error(&upper), 0, 4);
  assert_true(sample_error(&lower) < 0.02 * bulk.mean && sample_error(&upper) < 0.02 * bulk.mean);
  struct kept *kept = keep_summaries(w.observers, &w.run.model);
  const double rise = kept_value(kept, "profile", 7, "vx") - kept_value(kept, "profile", 2, "vx");
  const double theory = theory_viscosity(&at_a_rule, 3, 10, w.run.model.solvent.cosine, 0.02);
  assert_close(bulk.mean / (rise / 5.0), theory, 0.08 * theory);
  free(kept);
  end_watch(&w);
}

/* Rows do not depend on what the account was before, though its sums wrap between two rows, upward and downward. And a
 * difference may be beyond the range of a sum. */
static void sums_may_wrap(void **unused)
{
  (void)unused;
  enum { STEPS = 40, EVERY = 20 };
  struct watched w[3];
  for (int k = 0; k < 3; k++) {
    struct model m = test_model(8, 4, 8, 5, 0.1, 1);
    m.walls.kind = WALL_NO_SLIP;
    m.walls.shear_rate = 0.4;
    w[k] = watch(m, stress_every(EVERY));
    for (uint32_t row = 0; row < 4; row++)
      w[k].run.state.wall_momentum[row].x = k == 0 ? 0 : k == 1 ? INT64_MAX : INT64_MIN;
    go(&w[k], STEPS);
  }
  for (size_t row = 1; row <= STEPS / EVERY; row++)
    for (int k = 1; k < 3; k++) {
      assert_true(fabs(stress_of(&w[0], row, LOWER)) > 0.1);
      assert_true(stress_of(&w[k], row, LOWER) == stress_of(&w[0], row, LOWER));
      assert_true(stress_of(&w[k], row, UPPER) == stress_of(&w[0], row, UPPER));
    }
  for (int k = 0; k < 3; k++)
    end_watch(&w[k]);

  struct point sum = {-7, 0, 0};
  uint64_t turns = 0;
  for (int k = 0; k < 1000; k++)
    account_add(&sum, &turns, (struct vec3){0x1p18, 0, 0});
  assert_true(account_along(-7, 0, sum.x, turns) == 1000 * 0x1p18);
  for (int k = 0; k < 3000; k++)
    account_add(&sum, &turns, (struct vec3){-0x1p18, 0, 0});
  assert_true(account_along(-7, 0, sum.x, turns) == -2000 * 0x1p18);
}

/* --- profile ----------------------------------------------------------------------------------------------------- */

/* Against sums by hand, at a time between collisions. A sheared flow, so that slabs differ. */
static void profile_by_hand(void **unused)
{
  (void)unused;
  enum { SLABS = 3 };
  struct model m = sheared(0.4, 0.0);
  m.time_step = 0.025;
  struct observe_plan plan = {.slabs = SLABS, .from = 6};
  plan.every[OBSERVE_PROFILE] = 1;
  struct watched w = watch(m, plan);
  go(&w, 6);
  struct kept *kept = keep_summaries(w.observers, &w.run.model);
  assert_true(w.run.state.solvent_lag > 0);
  for (int k = 0; k < SLABS; k++) {
    double n = 0.0, p[3] = {0}, squares = 0.0;
    for (uint32_t i = 0; i < w.run.state.solvent.n; i++) {
      const double y = (double)fluid_position_now(&w.run.state, &w.run.model, i).y * LATTICE_UNIT;
      const struct vec3 v = fluid_velocity_now(&w.run.state, &w.run.model, i);
      if (y < 8.0 * k / SLABS || y >= 8.0 * (k + 1) / SLABS)
        continue;
      n++, p[0] += v.x, p[1] += v.y, p[2] += v.z, squares += vec3_dot(v, v);
    }
    const double about = squares - (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) / n;
    assert_close(kept_value(kept, "profile", (size_t)k, "y"), 8.0 * (k + 0.5) / SLABS, 1e-12);
    assert_close(kept_value(kept, "profile", (size_t)k, "density"), n * SLABS / 512.0, 1e-12);
    assert_close(kept_value(kept, "profile", (size_t)k, "vx"), p[0] / n, 1e-9);
    assert_close(kept_value(kept, "profile", (size_t)k, "vy"), p[1] / n, 1e-9);
    assert_close(kept_value(kept, "profile", (size_t)k, "vz"), p[2] / n, 1e-9);
    assert_close(kept_value(kept, "profile", (size_t)k, "temperature"), about / (3.0 * (n - 1.0)), 1e-8);
    assert_close(kept_value(kept, "profile", (size_t)k, "samples"), 1, 0);
  }
  free(kept);
  end_watch(&w);
}

/* Oscillating shear: v_x = rate cos(2 pi (t + tau/2)/period) (y - L/2), because the rate of an interval is that of its
 * middle. Forty periods of 20 intervals; eight numbers within 4 sigma, false alarm 5e-4. The transient of `from` begins
 * within a period, which must be left out. */
static void profile_in_phase(void **unused)
{
  (void)unused;
  enum { SLABS = 4, INTERVALS = 20 };
  const double rate = 0.5, turn = acos(-1.0) / INTERVALS;
  struct observe_plan plan = {.slabs = SLABS, .from = 7};
  plan.every[OBSERVE_PROFILE] = 1;
  struct model m = sheared(rate, INTERVALS * 0.1);
  m.solvent.thermostat = THERMOSTAT_RESCALE;
  struct watched w = watch(m, plan);
  go(&w, 41 * INTERVALS);
  struct kept *kept = keep_summaries(w.observers, &w.run.model);
  for (size_t k = 0; k < SLABS; k++) {
    const double v = rate * (2.0 * (double)k + 1.0 - 4.0);
    assert_sigma(kept_value(kept, "profile", k, "vx_in_phase"), kept_value(kept, "profile", k, "vx_in_phase_error"),
                 v * cos(turn), 4);
    assert_sigma(kept_value(kept, "profile", k, "vx_out_of_phase"),
                 kept_value(kept, "profile", k, "vx_out_of_phase_error"), -v * sin(turn), 4);
  }
  free(kept);
  end_watch(&w);
}

/* A transient that ends within a period does not count for the harmonics: they are those of the next whole period on,
 * to the bit. Here its rest is three quarters of a period. */
static void harmonics_are_of_whole_periods(void **unused)
{
  (void)unused;
  enum { SLABS = 2, INTERVALS = 20, PERIODS = 4 };
  const uint64_t from[2] = {5, INTERVALS};
  struct kept *kept[2];
  for (int k = 0; k < 2; k++) {
    struct observe_plan plan = {.slabs = SLABS, .from = from[k]};
    plan.every[OBSERVE_PROFILE] = 1;
    struct watched w = watch(sheared(0.5, INTERVALS * 0.1), plan);
    go(&w, PERIODS * INTERVALS);
    kept[k] = keep_summaries(w.observers, &w.run.model);
    end_watch(&w);
  }
  for (size_t slab = 0; slab < SLABS; slab++) {
    static const char *const of_periods[] = {"vx_in_phase", "vx_out_of_phase"};
    for (size_t k = 0; k < sizeof of_periods / sizeof *of_periods; k++) {
      const double late = kept_value(kept[1], "profile", slab, of_periods[k]);
      assert_true(fabs(late) > 1e-6 && kept_value(kept[0], "profile", slab, of_periods[k]) == late);
    }
    assert_true(kept_value(kept[0], "profile", slab, "samples") ==
                kept_value(kept[1], "profile", slab, "samples") + INTERVALS - 5);
  }
  free(kept[0]);
  free(kept[1]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stress_is_that_of_green_kubo),
      cmocka_unit_test(common_motion_adds_nothing),
      cmocka_unit_test(pressure_of_equilibrium),
      cmocka_unit_test(heating_is_stress_times_rate),
      cmocka_unit_test(walls_feel_the_stress_of_the_bulk),
      cmocka_unit_test(sums_may_wrap),
      cmocka_unit_test(profile_by_hand),
      cmocka_unit_test(profile_in_phase),
      cmocka_unit_test(harmonics_are_of_whole_periods),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
