/* Drift of a kind, what is left about it, cumulative diffusion coefficients, and averages that begin late. */
#include "tables.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include "observe/dynamics.h"

static const char table[] = "dynamics-kind1";

static double at(const struct kept *kept, const char *name, double time, const char *column)
{
  for (size_t row = 0; row < kept->table[0].rows; row++)
    if (fabs(kept_value(kept, name, row, "time") - time) < 1e-9)
      return kept_value(kept, name, row, column);
  fail_msg("no lag of %g t0", time);
  return NAN;
}

/* Points at constant velocities v + w_i, sum w_i = 0, of multiples of 2^-10, so that every move is exact. Then drift =
 * v, and about it sum w_i^2 t^2/(n - 1). g grows as t^2: its rise from t/2 to t is 3/4 of it, over 3t. */
static void drift_of_free_flight(void **unused)
{
  (void)unused;
  enum { POINTS = 5 };
  const double dt = 0.125;
  struct model m = test_model(8, 8, 8, 0, dt, 1);
  test_add_kind(&m, POINTS, 1);
  struct puppet p = puppet_start(m, OBSERVE_DYNAMICS, 1, 24);
  for (p.state.step = 0; p.state.step <= 96; p.state.step++) {
    puppet_sample(&p);
    for (int i = 0; i < POINTS; i++)
      p.state.position[i] =
          point_move(p.state.position[i], (struct vec3){dt * (0x1p-4 + (i - 2) * 0x1p-7), -dt * 0x1p-3, dt * 0x1p-5});
  }
  struct kept *kept = keep_summaries(p.observers, &p.model);
  const double squares = 10 * 0x1p-14, v2 = 0x1p-8 + 0x1p-6 + 0x1p-10; /* sum of w_i^2 = (4+1+0+1+4) 2^-14; v^2 */
  const double mean = squares / 5 + v2;
  for (size_t row = 0; row < kept->table[0].rows; row++) {
    const double t = kept_value(kept, table, row, "time"), lag = t / dt;
    assert_close(kept_value(kept, table, row, "drift_x"), 0x1p-4, 1e-14);
    assert_close(kept_value(kept, table, row, "drift_y"), -0x1p-3, 1e-14);
    assert_close(kept_value(kept, table, row, "drift_z"), 0x1p-5, 1e-14);
    assert_close(kept_value(kept, table, row, "g_cm"), mean * t * t, 1e-13);
    assert_close(kept_value(kept, table, row, "g_cm_about_mean"), squares / 4 * t * t, 1e-13);
    assert_close(kept_value(kept, table, row, "D_about_mean"), squares / 24 * t, 1e-13);
    if (lag == 1 || lag == 3) { /* no lag is half of these */
      assert_true(isnan(kept_value(kept, table, row, "D_cumulative")));
    } else {
      assert_close(kept_value(kept, table, row, "D_cumulative"), mean * t / 4, 1e-13);
      assert_close(kept_value(kept, table, row, "D_cumulative_about_mean"), squares / 4 * t / 4, 1e-13);
    }
  }
  free(kept);
  puppet_end(&p);
}

/* Two kinds of free points without a solvent, pulled by F and -F from rest: the net force is zero, so is the motion of
 * the frame. After a time T they are F T^2/2M away, exactly: the velocities of half a step ahead are F dt/2M at first.
 */
static void pulled_from_rest(void **unused)
{
  (void)unused;
  const double dt = 0x1p-6, force = 0.5, mass = 5, a = force / mass;
  struct model m = test_model(16, 16, 16, 0, dt, 1);
  for (int k = 0; k < 2; k++) {
    struct fiber_kind *kind = test_add_kind(&m, 3, 1);
    kind->force = (struct vec3){k ? -force : force, 0, 0};
  }
  struct test_run run = test_start(m);
  const struct observe_plan plan = {.every = {[OBSERVE_DYNAMICS] = 64}, .longest_lag = 64};
  struct observers *observers = observers_create(&plan, &run.model);
  for (uint32_t i = 0; i < 6; i++)
    run.state.velocity[i] = (struct vec3){(i < 3 ? a : -a) * dt / 2, 0, 0};
  assert_true(observers_sample(observers, &run.model, &run.state, NULL));
  test_steps(&run, 64);
  assert_true(observers_sample(observers, &run.model, &run.state, NULL));
  struct kept *kept = keep_summaries(observers, &run.model);
  for (int k = 0; k < 2; k++) {
    const char *name = k ? "dynamics-kind2" : "dynamics-kind1";
    const double moved = 0.5 * a; /* T = 1 */
    assert_close(at(kept, name, 1, "g_cm"), moved * moved, 1e-9);
    assert_close(at(kept, name, 1, "drift_x"), k ? -moved : moved, 1e-9);
    assert_close(at(kept, name, 1, "drift_y"), 0, 1e-9);
    assert_close(at(kept, name, 1, "g_cm_about_mean"), 0, 1e-12);
  }
  free(kept);
  observers_free(observers);
  test_end(&run);
}

/* Walkers of variance `step` per component and sample, that drift by `v` along x per sample. */
static struct kept *walk(uint32_t walkers, double step, double v, uint64_t samples, unsigned long seed)
{
  struct model m = test_model(8, 8, 8, 0, 1, 1);
  test_add_kind(&m, walkers, 1);
  struct puppet p = puppet_start(m, OBSERVE_DYNAMICS, 1, samples / 4);
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_rng_set(rng, seed);
  for (p.state.step = 0; p.state.step <= samples; p.state.step++) {
    puppet_sample(&p);
    for (uint32_t i = 0; i < walkers; i++) {
      const double x = gsl_ran_gaussian(rng, sqrt(step)), y = gsl_ran_gaussian(rng, sqrt(step));
      p.state.position[i] = point_move(p.state.position[i], (struct vec3){v + x, y, gsl_ran_gaussian(rng, sqrt(step))});
    }
  }
  gsl_rng_free(rng);
  struct kept *kept = keep_summaries(p.observers, &p.model);
  puppet_end(&p);
  return kept;
}

struct sum {
  double n, x, xx;
};

static void sum_add(struct sum *s, double x)
{
  s->n += 1, s->x += x, s->xx += x * x;
}

static double sum_mean(const struct sum *s)
{
  return s->x / s->n;
}

static double sum_variance(const struct sum *s)
{
  return (s->xx - s->x * s->x / s->n) / (s->n - 1);
}

enum { WALKS = 400, SAMPLES = 256 };

/* Three walkers that drift: D = step/2 about the mean without bias (n instead of n - 1 would miss a third of it, at 40
 * standard errors), and D + v^2 t/6 with the drift in it. */
static void diffusion_about_the_drift_is_unbiased(void **unused)
{
  (void)unused;
  const double step = 0.25, v = 0.5;
  struct sum raw = {0}, about = {0}, rise = {0}, drift = {0}, inside = {0};
  for (unsigned long seed = 1; seed <= WALKS; seed++) {
    struct kept *kept = walk(3, step, v, SAMPLES, seed);
    sum_add(&raw, at(kept, table, 4, "D"));
    sum_add(&about, at(kept, table, 4, "D_about_mean"));
    sum_add(&rise, at(kept, table, 4, "D_cumulative_about_mean"));
    sum_add(&drift, at(kept, table, 4, "drift_x"));
    sum_add(&inside, fabs(at(kept, table, 4, "drift_x") - v) < 2 * at(kept, table, 4, "drift_x_error"));
    free(kept);
  }
  assert_sigma(sum_mean(&raw), sqrt(sum_variance(&raw) / WALKS), step / 2 + v * v * 4 / 6, 4);
  assert_sigma(sum_mean(&about), sqrt(sum_variance(&about) / WALKS), step / 2, 4);
  assert_sigma(sum_mean(&rise), sqrt(sum_variance(&rise) / WALKS), step / 2, 4);
  assert_sigma(sum_mean(&drift), sqrt(sum_variance(&drift) / WALKS), v, 4);
  assert_true(sum_mean(&inside) > 0.92 && sum_mean(&inside) < 0.998);
}

/*
 * The rise g(t) - g(t/2) of a walk: with d = d_1 + d_2 of independent halves, |d|^2 varies by 4V and the mean of
 * |d_1|^2 and |d_2|^2 by V/2, V = 6 s^4 the variance of |d_1|^2 (s^2 = step t/2 per component), and their covariance is
 * V. So the rise varies by (4 + 1/2 - 2) V = 5V/2 per interval and walker. Errors of both ends, added as if they were
 * independent, would give 9V/2. Walks scatter as that says; and the error that a walk tells is theirs, a few per cent
 * larger.
 */
static void error_of_a_rise_knows_that_lags_share_their_blocks(void **unused)
{
  (void)unused;
  enum { WALKERS = 4, LAG = 4 };
  const double step = 0.25, s2 = step * LAG / 2, v = 6 * s2 * s2, intervals = SAMPLES / (double)LAG;
  const double expected = 2.5 * v / (intervals * WALKERS) / (9.0 * LAG * LAG);
  struct sum rise = {0}, told = {0}, inside = {0};
  for (unsigned long seed = 1; seed <= WALKS; seed++) {
    struct kept *kept = walk(WALKERS, step, 0, SAMPLES, 1000 + seed);
    const double d = at(kept, table, LAG, "D_cumulative"), error = at(kept, table, LAG, "D_cumulative_error");
    sum_add(&rise, d);
    sum_add(&told, error * error);
    sum_add(&inside, fabs(d - step / 2) < 2 * error);
    free(kept);
  }
  assert_sigma(sum_mean(&rise), sqrt(sum_variance(&rise) / WALKS), step / 2, 4);
  assert_sigma(sum_variance(&rise) / expected, sqrt(2.0 / WALKS) * 1.2, 1,
               4); /* a variance of nearly Gaussian numbers */
  print_message("  told/expected variance %.3f, within two errors %.3f\n", sum_mean(&told) / expected,
                sum_mean(&inside));
  assert_true(sum_mean(&told) > 0.95 * expected && sum_mean(&told) < 1.5 * expected); /* 1.8: as if independent */
  assert_true(sum_mean(&inside) > 0.92 && sum_mean(&inside) < 0.995);
}

/* One fiber has no mean but its own motion. */
static void one_fiber_has_nothing_about_its_mean(void **unused)
{
  (void)unused;
  struct kept *kept = walk(1, 0.25, 0, 64, 1);
  assert_true(isnan(at(kept, table, 4, "D_about_mean")) && isnan(at(kept, table, 4, "D_about_mean_error")));
  assert_true(isnan(at(kept, table, 4, "D_cumulative_about_mean")));
  assert_true(at(kept, table, 4, "D_cumulative") > 0 && at(kept, table, 4, "D") > 0);
  free(kept);
}

/* A lag whose middle was not sampled has no rise, and does not spoil others. Motion at 1 a0 per step; step 3 is
 * missing: of lag 2 the interval 2-4 has no middle, 0-2 and 4-6 have. */
static void a_missed_middle_makes_no_rise(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 1, 1);
  test_add_kind(&m, 2, 1);
  struct puppet p = puppet_start(m, OBSERVE_DYNAMICS, 1, 2);
  for (p.state.step = 0; p.state.step <= 6; p.state.step++) {
    p.state.position[0].x = (int64_t)p.state.step * LATTICE_CELL;
    if (p.state.step != 3)
      puppet_sample(&p);
  }
  struct kept *kept = keep_summaries(p.observers, &p.model);
  assert_close(at(kept, table, 2, "intervals"), 3, 0);
  assert_close(at(kept, table, 2, "D_cumulative"), (4 - 1) * 0.5 / 6, 1e-15); /* one of two points moves */
  free(kept);
  puppet_end(&p);
}

/* Averages that begin at step 10 are those of observers that were shown nothing before; time series begin at 0. */
static void averages_begin_late(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 0.5, 1);
  test_add_kind(&m, 4, 2)->spring = 10.0;
  test_finish(&m);
  struct state state;
  assert_true(state_alloc(&state, &m));
  const struct observe_plan late = {.every = {1, 1, 3, 3, 1}, .longest_lag = 6, .from = 10};
  const struct observe_plan whole = {.every = {1, 1, 3, 3, 1}, .longest_lag = 6};
  struct observers *a = observers_create(&late, &m), *b = observers_create(&whole, &m);
  struct kept_rows *rows = calloc(1, sizeof *rows);
  const struct observe_sink sink = {keep_row, rows};
  for (state.step = 0; state.step <= 40; state.step++) {
    for (uint32_t i = 0; i < m.vertices; i++)
      state.position[i].x = (int64_t)((double)LATTICE_CELL * sin(0.1 * i * (double)state.step));
    assert_true(observers_sample(a, &m, &state, &sink));
    if (state.step >= 10)
      assert_true(observers_sample(b, &m, &state, NULL));
  }
  struct kept *from = keep_summaries(a, &m), *since = keep_summaries(b, &m);
  assert_int_equal(rows->rows, 3 * 41 - 1); /* collisions have no rate at the first step */
  assert_int_equal(from->tables, 2);
  for (size_t k = 0; k < from->tables; k++) {
    assert_int_equal(from->table[k].rows, since->table[k].rows);
    assert_memory_equal(from->table[k].value, since->table[k].value,
                        from->table[k].rows * from->table[k].columns * sizeof(double));
  }
  assert_close(kept_value(from, "statics-kind1", 0, "samples"), 10, 0); /* 12, 15, ..., 39 */
  free(rows);
  free(from);
  free(since);
  observers_free(a);
  observers_free(b);
  state_free(&state);
  model_free(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(drift_of_free_flight),
      cmocka_unit_test(pulled_from_rest),
      cmocka_unit_test(diffusion_about_the_drift_is_unbiased),
      cmocka_unit_test(error_of_a_rise_knows_that_lags_share_their_blocks),
      cmocka_unit_test(one_fiber_has_nothing_about_its_mean),
      cmocka_unit_test(a_missed_middle_makes_no_rise),
      cmocka_unit_test(averages_begin_late),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
