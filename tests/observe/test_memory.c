/* Memory of velocities and of the stress of fibers, where both are known at any step. */
#include "exact.h"
#include "observe/observe.h"
#include "statistics.h"

static const double pi = 3.14159265358979323846;

enum { TIME, VERTICES, VERTICES_ERROR, CENTER, CENTER_ERROR, STRESS, STRESS_ERROR, INTERVALS, COLUMNS };

struct kept {
  double row[40][COLUMNS];
  size_t rows;
};

static bool keep(void *context, const struct observe_table *table)
{
  struct kept *k = context;
  const bool still = table->columns == COLUMNS - 4; /* without velocities: their columns are left out */
  assert_true(table->rows <= 40 && (still || table->columns == COLUMNS));
  assert_string_equal(table->column[still ? 1 : STRESS], "stress_memory");
  for (size_t n = 0; n < table->rows; n++)
    for (size_t c = 0; c < table->columns; c++)
      k->row[n][still && c > 0 ? c + 4 : c] = table->value[n * table->columns + c];
  k->rows = table->rows;
  return true;
}

static struct kept watch(struct model m, int steps)
{
  struct test_run r = test_start(m);
  const struct observe_plan plan = {.every[OBSERVE_MEMORY] = 1};
  struct observers *o = observers_create(&plan, &r.model);
  struct kept kept = {.rows = 0};
  test_steps(&r, 200);
  for (int k = 0; k < steps; k++) {
    test_steps(&r, 1);
    assert_true(observers_sample(o, &r.model, &r.state, NULL));
  }
  assert_true(observers_summaries(o, &r.model, keep, &kept));
  assert_close(kept.row[0][TIME], 0.0, 0.0);
  assert_close(kept.row[0][INTERVALS], steps, 0.0);
  assert_close(kept.row[1][INTERVALS], steps - 1, 0.0);
  assert_close(kept.row[4][TIME], 4.0 * r.model.time_step, 1e-12);
  observers_free(o);
  test_end(&r);
  return kept;
}

/* A Langevin bath leaves exp(-rate t) of a velocity and, of a chain of N, kT/(N M) of its centre's: bonds take nothing.
 * In a flow. Lags up to 2 t0; 4 standard errors each of 22 numbers, 1 false alarm in 700 seeds. */
static void velocities(void **unused)
{
  (void)unused;
  struct model m = test_model(30, 30, 30, 0, 0.1, 0);
  m.medium = (struct medium_model){.kind = MEDIUM_PRIVATE, .rate = 1.5, .draw = DRAW_RELAX};
  m.scheme = SCHEME_DRIFT_SPLIT;
  m.flow = (struct vec3){1, 0, -2};
  m.crossing.forbidden = false;
  m.seed = dice_seed(3501);
  test_add_kind(&m, 200, 1)->mass = 2.0;
  const struct kept free = watch(m, 4000);
  m = test_model(30, 30, 30, 0, 0.1, 0);
  m.medium = (struct medium_model){.kind = MEDIUM_PRIVATE, .rate = 1.5, .draw = DRAW_RELAX};
  m.scheme = SCHEME_DRIFT_SPLIT;
  m.crossing.forbidden = false;
  m.seed = dice_seed(3502);
  struct fiber_kind *k = test_add_kind(&m, 100, 4);
  k->mass = 2.0;
  k->bond_length = k->bending = 0.0;
  k->spring = 3.0;
  const struct kept chain = watch(m, 4000);
  for (size_t n = 0; n < free.rows && free.row[n][TIME] < 2.0; n++) {
    const double left = exp(-1.5 * free.row[n][TIME]);
    assert_sigma(free.row[n][VERTICES], free.row[n][VERTICES_ERROR], 0.5 * left, 4.0);
    assert_close(free.row[n][CENTER], free.row[n][VERTICES], 1e-12);
    assert_sigma(chain.row[n][CENTER], chain.row[n][CENTER_ERROR], 0.125 * left, 4.0);
  }
}

/* Rouse, in steps: mode p of an overdamped chain keeps 1 - l dt of itself, l = 12 sin^2(p pi/2N) at k = 3, and has
 * 1/(1 - l dt/2) of its mean square. So <s(0) s(n)> = sum_p [(1 - l dt)^n/(1 - l dt/2)]^2, exactly; 9 bonds. */
static void stress_of_chains(void **unused)
{
  (void)unused;
  enum { N = 10 };
  struct model m = test_model(40, 40, 40, 0, 0.04, 0);
  m.medium = (struct medium_model){.kind = MEDIUM_OVERDAMPED, .rate = 1.0};
  m.crossing.forbidden = false;
  m.seed = dice_seed(3503);
  struct fiber_kind *k = test_add_kind(&m, 200, N);
  k->mass = 1.0;
  k->bond_length = k->bending = 0.0;
  k->spring = 3.0;
  k->force = (struct vec3){1, 2, 3}; /* no such scene can be asked for it; a uniform force leaves the shape alone */
  const struct kept kept = watch(m, 5000);
  for (size_t n = 0; n < kept.rows && kept.row[n][TIME] < 3.0; n++) {
    double expected = 0.0;
    for (int p = 1; p < N; p++) {
      const double rate = 12.0 * pow(sin(p * pi / (2 * N)), 2) * 0.04;
      expected += pow(pow(1.0 - rate, nearbyint(kept.row[n][TIME] / 0.04)) / (1.0 - 0.5 * rate), 2);
    }
    assert_sigma(kept.row[n][STRESS], kept.row[n][STRESS_ERROR], expected, 4.0);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(velocities), cmocka_unit_test(stress_of_chains)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
