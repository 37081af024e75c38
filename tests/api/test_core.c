/* The core alone: linked with the C library and xxHash, without HDF5, YAML and jansson. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* after the above */
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "observe/observe.h"
#include "start/start.h"
#include "step.h"

/* A model by hand: 5 fibers of 8 vertices in 6^3 cells with 4 particles each. */
static struct model make_model(void)
{
  struct model m;
  memset(&m, 0, sizeof m);
  m.box = box_of_cells(6, 6, 6);
  m.seed = 4;
  m.time_step = 0.01;
  m.scheme = SCHEME_KICK_SPLIT;
  m.solvent.per_cell = 4;
  m.solvent.collision_interval = 0.02;
  m.solvent.rotation_angle = 90.0;
  m.solvent.hydrodynamics = true;
  m.crossing.forbidden = true;
  m.kind = calloc(1, sizeof *m.kind);
  m.kinds = 1;
  m.kind[0] = (struct fiber_kind){
      .name = "fiber", .count = 5, .vertices = 8, .mass = 5.0, .bond_length = 0.5, .spring = 100.0, .bending = 8.0};
  struct model_error error;
  assert_true(model_finish(&m, &error));
  return m;
}

static bool count_row(void *context, enum observable which, size_t columns, const double *values)
{
  (void)which, (void)columns, (void)values;
  ++*(int *)context;
  return true;
}

static void test_core(void **unused)
{
  (void)unused;
  struct model m = make_model();
  struct state s;
  struct work w;
  int rows = 0;
  const struct observe_plan plan = {.every = {[OBSERVE_CONSERVED] = 5, [OBSERVE_DYNAMICS] = 5}};
  const struct observe_sink sink = {count_row, &rows};
  struct observers *observers = observers_create(&plan, &m);
  assert_true(observers && state_alloc(&s, &m) && work_alloc(&w, &m));
  assert_true(start_state(&s, &m, &w));
  const double energy = observe_conserved(&m, &s).total;
  for (int k = 0; k < 50; k++) {
    assert_true(step_advance(&s, &m, &w, NULL));
    assert_true(observers_sample(observers, &m, &s, &sink));
  }
  assert_int_equal(rows, 10);
  assert_true(fabs(observe_conserved(&m, &s).total / energy - 1.0) < 1e-3);
  assert_int_not_equal(state_hash(&s), 0);
  observers_free(observers);
  work_free(&w);
  state_free(&s);
  model_free(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_core)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
