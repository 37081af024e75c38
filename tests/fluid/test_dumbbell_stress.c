/*
 * The stress of dumbbells (Tao, Goetze and Gompper 2008), in every interval: heat of a sheared box, means over a flight
 * against sums over its steps, momentum of walls. Planted bugs:
 * tests/mutants.
 */
#include "../observe/tables.h"
#include "support.h"

#include "fluid/fluid.h"
#include "mpc/stress.h"
#include "statistics.h"
#include "wall/account.h"

/* Columns of stress with dumbbells. */
#define XY "sigma_xy"
#define XY_KINETIC "sigma_xy_kinetic"
#define XY_COLLISIONAL "sigma_xy_collisional"
#define PRESSURE "pressure"
#define LOWER "sigma_lower"
#define UPPER "sigma_upper"
#define XY_SPRING "sigma_xy_spring"
#define N1_SPRING "N1_spring"

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

static double last(const struct watched *w, const char *column)
{
  return kept_cell(w->rows, &w->run.model, OBSERVE_STRESS, w->rows->rows - 1, column);
}

/* --- the sheared box (S5) ---------------------------------------------------------------------------------------- */

static struct model sheared(double spring, double fraction, double rate, double dt)
{
  struct model m = test_model(8, 6, 5, 5, dt, 1);
  m.dumbbells = (struct dumbbell_model){.spring = spring, .fraction = fraction};
  m.shear.rate = rate;
  return m;
}

/* Half the sum of (v - u(y))^2, u the linear flow, and the springs. */
static double heat(const struct test_run *r, double rate)
{
  const struct solvent *s = &r->state.solvent;
  const struct dumbbells *d = &r->state.dumbbells;
  double sum = 0.0;
  for (uint32_t i = 0; i < s->n; i++) {
    const double x = s->vx[i] - rate * ((double)s->y[i] * LATTICE_UNIT - 0.5 * r->model.box.cells[1]);
    sum += 0.5 * (x * x + s->vy[i] * s->vy[i] + s->vz[i] * s->vz[i]);
  }
  for (uint32_t p = 0; p < d->n; p++)
    sum += 0.5 * r->model.dumbbells.spring *
           ((double)d->x[p] * d->x[p] + (double)d->y[p] * d->y[p] + (double)d->z[p] * d->z[p]) * 0x1p-80;
  return sum;
}

/* A rule that keeps energy: the heat of each interval is stress rate volume, to rounding: sums of 2^-28 per term of
 * 1200 particles, positions of 2^-41. Also with so long a time step that springs turn over. */
static void heat_is_stress_times_rate(void **unused)
{
  (void)unused;
  const struct {
    double spring, fraction, rate, dt;
  } cases[] = {{1.0, 1.0, 0.3, 0.05}, {0.2, 0.6, 0.5, 0.1}, {30.0, 1.0, 0.2, 0.2}, {200.0, 0.5, 0.1, 0.15}};
  for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
    struct watched w = watch(sheared(cases[c].spring, cases[c].fraction, cases[c].rate, cases[c].dt), stress_every(1));
    look(&w);
    double gained = 0.0, springs = 0.0, off = 0.0;
    for (int k = 0; k < 60; k++) {
      const double before = heat(&w.run, cases[c].rate), per = cases[c].rate * 240.0 * cases[c].dt;
      go(&w, 1);
      const double error = heat(&w.run, cases[c].rate) - before - last(&w, XY) * per;
      off = fmax(off, fabs(error));
      gained += last(&w, XY) * per, springs += last(&w, XY_SPRING) * per;
      assert_close(last(&w, XY), last(&w, XY_KINETIC) + last(&w, XY_COLLISIONAL) + last(&w, XY_SPRING), 1e-12);
    }
    print_message("  K %g: heat %.1f, of springs %.1f, largest error %.1e\n", cases[c].spring, gained, springs, off);
    assert_true(off < 1e-6 && gained > 20.0);
    end_watch(&w);
  }
}

/* --- means over a flight ----------------------------------------------------------------------------------------- */

/* A collision every 40 steps: the mean of K r_a r_b over the flight is that of its steps, by Simpson's rule, whose
 * error is (w dt)^4/180 of it. In equilibrium, between walls, and sheared. */
static void springs_are_means_over_the_flight(void **unused)
{
  (void)unused;
  enum { STEPS = 40 };
  struct model m = test_model(8, 6, 5, 5, 0.005, STEPS);
  m.dumbbells = (struct dumbbell_model){.spring = 3.0, .fraction = 1.0};
  m.shear.rate = 0.4;
  struct watched w = watch(m, stress_every(STEPS));
  look(&w);
  for (int flight = 0; flight < 5; flight++) {
    double xy = 0.0, difference = 0.0;
    for (int step = 0; step <= STEPS; step++) {
      const double part = step == 0 || step == STEPS ? 1.0 : step % 2 ? 4.0 : 2.0;
      for (uint32_t p = 0; p < w.run.state.dumbbells.n; p++) {
        const struct vec3 r = fluid_dumbbell_now(&w.run.state, &w.run.model, p);
        xy += part * r.x * r.y, difference += part * (r.x * r.x - r.y * r.y);
      }
      if (step < STEPS)
        go(&w, 1);
    }
    const double scale = 3.0 / (3.0 * STEPS * 240.0);
    assert_close(last(&w, XY_SPRING), scale * xy, 1e-7);
    assert_close(last(&w, N1_SPRING), scale * difference, 1e-7);
  }
  end_watch(&w);
}

/* An ideal gas of dumbbells, and of particles among them: the pressure is their number per volume. Springs are counted
 * from exact starts, so that their mean is exact at all times. Errors of 60 means over 0.5 t0. */
static void pressure_is_that_of_dumbbells(void **unused)
{
  (void)unused;
  enum { MEANS = 60, EACH = 5 };
  struct model m = test_model(8, 6, 5, 10, 0.1, 1);
  m.dumbbells = (struct dumbbell_model){.spring = 2.0, .fraction = 0.75};
  m.solvent.rule = RULE_AT_A;
  struct watched w = watch(m, stress_every(EACH));
  struct sample pressure = {0}, shear = {0};
  look(&w);
  for (int k = 0; k < MEANS; k++) {
    go(&w, EACH);
    sample_add(&pressure, last(&w, PRESSURE));
    sample_add(&shear, last(&w, XY_SPRING));
  }
  assert_sigma(pressure.mean, sample_error(&pressure), 10.0 * (0.25 + 0.375), 4.5);
  assert_true(sample_error(&pressure) < 0.1);
  end_watch(&w);
}

/* --- walls (E4, S7) ---------------------------------------------------------------------------------------------- */

static struct vec3 momentum(const struct state *state)
{
  struct vec3 sum = {0, 0, 0};
  for (uint32_t i = 0; i < state->solvent.n; i++)
    sum = vec3_add(sum, solvent_velocity(&state->solvent, i));
  return sum;
}

/* What walls have given, in hits and by virtual particles, is the change of the momentum, in each step; along y the
 * pull of the walls' potential counts as a hit does. Every rule and fill. */
static void walls_give_what_dumbbells_get(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < RULES; rule++)
    for (int fill = 0; fill < 2; fill++) {
      struct model m = test_model(6, 5, 4, 6, 0.05, 1);
      m.dumbbells = (struct dumbbell_model){.spring = 1.5, .fraction = 0.8, .depth = fill ? 0.95 : 0.0};
      m.solvent.rule = (enum rule)rule;
      m.walls = (struct wall_model){.kind = WALL_NO_SLIP, .shear_rate = 0.2};
      m.walls.fill = fill ? FILL_PAPER : FILL_PLANAR;
      struct test_run r = test_start(m);
      struct vec3 before = momentum(&r.state), largest = {0, 0, 0};
      for (int step = 0; step < 60; step++) {
        struct point old[WALLS * ACCOUNT_SHARES];
        memcpy(old, r.state.wall_momentum, sizeof old);
        test_steps(&r, 1);
        struct vec3 given = {0, 0, 0};
        for (int row = 0; row < WALLS * ACCOUNT_SHARES; row++)
          given = vec3_add(given, account_between(old[row], r.state.wall_momentum[row]));
        const struct vec3 after = momentum(&r.state), off = vec3_sub(vec3_sub(after, before), given);
        largest =
            (struct vec3){fmax(largest.x, fabs(off.x)), fmax(largest.y, fabs(off.y)), fmax(largest.z, fabs(off.z))};
        before = after;
      }
      assert_true(largest.x < 1e-9 && largest.y < 1e-9 && largest.z < 1e-9);
      test_end(&r);
    }
}

/* Couette flow of dumbbells, 1200 t0 after 60 (five relaxation times of a spring, and momentum crosses the gap in
 * less): each wall feels the stress of the bulk, though the viscosity differs between the wall and the middle.
 * Differences from 24 blocks; false alarm 2 x 2e-4 (4 sigma of 23 degrees of freedom is 6e-4 each). */
static void walls_feel_the_stress_of_the_bulk(void **unused)
{
  (void)unused;
  enum { L = 10, EVERY = 2500, BLOCKS = 24 };
  struct model m = test_model(16, L, 1, 10, 0.02, 1);
  m.dimensions = 2;
  m.dumbbells = (struct dumbbell_model){.spring = 1.0, .fraction = 1.0};
  m.solvent.rule = RULE_AT_A;
  m.walls = (struct wall_model){.kind = WALL_NO_SLIP, .shear_rate = 0.1};
  struct watched w = watch(m, stress_every(EVERY));
  struct sample lower = {0}, upper = {0}, bulk = {0}, springs = {0};
  look(&w);
  for (int k = 0; k < BLOCKS + 2; k++) {
    go(&w, EVERY);
    if (k < 2)
      continue;
    const double xy = last(&w, XY);
    sample_add(&bulk, xy);
    sample_add(&springs, last(&w, XY_SPRING));
    sample_add(&lower, last(&w, LOWER) - xy);
    sample_add(&upper, last(&w, UPPER) - xy);
  }
  print_message("  bulk %.3f(%.3f), of springs %.3f, walls less bulk %.3f(%.3f), %.3f(%.3f)\n", bulk.mean,
                sample_error(&bulk), springs.mean, lower.mean, sample_error(&lower), upper.mean, sample_error(&upper));
  assert_sigma(lower.mean, sample_error(&lower), 0, 4);
  assert_sigma(upper.mean, sample_error(&upper), 0, 4);
  assert_true(sample_error(&lower) < 0.02 * bulk.mean && sample_error(&upper) < 0.02 * bulk.mean);
  end_watch(&w);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(heat_is_stress_times_rate),         cmocka_unit_test(springs_are_means_over_the_flight),
      cmocka_unit_test(pressure_is_that_of_dumbbells),     cmocka_unit_test(walls_give_what_dumbbells_get),
      cmocka_unit_test(walls_feel_the_stress_of_the_bulk),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
