/* What all tests share: CMocka, comparisons that do not pass NaN, and models built by hand. */
#ifndef UNCROSS_TESTS_SUPPORT_H
#define UNCROSS_TESTS_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* after the above */
#include <cmocka.h>

#include <math.h>

#include "start/start.h"
#include "step.h"
#include "system/model.h"
#include "system/state.h"

/* |actual - expected| <= tolerance, and neither is NaN. (CMocka's own assert_float_equal casts to float and passes
 * NaN.) */
#define assert_close(actual, expected, tolerance)                                                                      \
  do {                                                                                                                 \
    double actual_ = (actual), expected_ = (expected), tolerance_ = (tolerance);                                       \
    if (!(fabs(actual_ - expected_) <= tolerance_))                                                                    \
      fail_msg("%s = %.17g, expected %.17g +- %.3g", #actual, actual_, expected_, tolerance_);                         \
  } while (0)

/* A statistical check: |actual - expected| within so many standard errors. */
#define assert_sigma(actual, error, expected, sigmas)                                                                  \
  do {                                                                                                                 \
    double a_ = (actual), s_ = (error), e_ = (expected);                                                               \
    print_message("  %-40s %.6g +- %.2g, expected %.6g (%+.2f sigma)\n", #actual, a_, s_, e_, (a_ - e_) / s_);         \
    if (!(fabs(a_ - e_) <= (sigmas)*s_))                                                                               \
      fail_msg("%s = %.9g +- %.2g, expected %.9g: %.2f sigma", #actual, a_, s_, e_, (a_ - e_) / s_);                   \
  } while (0)

/* Begins a case of long statistics. With NO_STATISTICS set (tools/sanitize: slow programs, of which
 * only faults, or the lines that are reached, are asked) it is skipped: others reach the same code. */
static inline void test_begin_statistics(void)
{
  if (getenv("NO_STATISTICS"))
    skip();
}

/* A model with this box and solvent at the paper's standard point (gamma per cell, dt, dt_c = interval dt, 90 degrees,
 * kick-split, seed 1), without fibers; call model_finish after adding kinds. */
static inline struct model test_model(int lx, int ly, int lz, double per_cell, double dt, uint32_t interval)
{
  struct model m;
  memset(&m, 0, sizeof m);
  m.box = box_of_cells(lx, ly, lz);
  m.seed = 1;
  m.time_step = dt;
  m.scheme = SCHEME_KICK_SPLIT;
  m.solvent.per_cell = per_cell;
  m.solvent.collision_interval = interval * dt;
  m.solvent.rotation_angle = 90.0;
  m.solvent.hydrodynamics = true;
  m.crossing.forbidden = true;
  return m;
}

/* So many solvent particles, whatever the box. */
static inline void test_particles(struct model *m, uint32_t particles)
{
  m->solvent.per_cell = particles / box_volume(&m->box);
}

/* Finishes the model, or ends the test. */
static inline void test_finish(struct model *m)
{
  struct model_error error;
  if (!model_finish(m, &error))
    fail_msg("%s: %s", error.path, error.text);
}

/* Adds a kind of the paper's fibers (M = 5, k = 100, l0 = 0.5, kappa = 64), started by its shape; change it before
 * model_finish. */
static inline struct fiber_kind *test_add_kind(struct model *m, uint32_t count, uint32_t vertices)
{
  m->kind = realloc(m->kind, (m->kinds + 1) * sizeof *m->kind);
  struct fiber_kind *k = &m->kind[m->kinds++];
  memset(k, 0, sizeof *k);
  snprintf(k->name, sizeof k->name, "kind%u", m->kinds);
  k->count = count;
  k->vertices = vertices;
  k->mass = 5.0;
  k->bond_length = 0.5;
  k->spring = 100.0;
  k->bending = 64.0;
  return k;
}

/* Everything a run needs, started. */
struct test_run {
  struct model model;
  struct state state;
  struct work work;
};

static inline struct test_run test_start(struct model model)
{
  struct test_run r = {.model = model};
  test_finish(&r.model);
  assert_true(state_alloc(&r.state, &r.model));
  assert_true(work_alloc(&r.work, &r.model));
  assert_true(start_state(&r.state, &r.model, &r.work));
  return r;
}

static inline void test_steps(struct test_run *r, uint64_t steps)
{
  for (uint64_t k = 0; k < steps; k++)
    if (!step_advance(&r->state, &r->model, &r->work, NULL)) {
      char text[512];
      fault_describe(&r->work.fault, text, sizeof text);
      fail_msg("%s", text);
    }
}

static inline void test_end(struct test_run *r)
{
  work_free(&r->work);
  state_free(&r->state);
  model_free(&r->model);
}

#endif
