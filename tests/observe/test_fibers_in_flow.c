/* Stress and orientation of fibers in flow. */
#include "../../validation/measure/nematic.h"
#include "exact.h"
#include "tables.h"

#include "contact/rule.h"
#include "fiber/force.h"

static struct model sheared_crowd(enum crossing_kind rule, double rate, double dt)
{
  struct model m = test_model(4, 4, 3, 0, dt, 2);
  struct fiber_kind *k = test_add_kind(&m, 30, 7);
  k->bending = 8.0;
  k = test_add_kind(&m, 8, 8);
  k->ring = true;
  k->mass = 3.0;
  k->bending = 2.0;
  k->force = (struct vec3){0.3, 0.0, 0.0};
  m.solvent.collision_interval = 0.0;
  m.shear.rate = rate;
  m.crossing.forbidden = rule != CROSSING_FREE;
  m.crossing.rule = rule;
  return m;
}

/* Energy of the motion relative to the flow, and of bonds and bends, at the time of the positions; and the power of the
 * kinds' forces against that motion. */
static double peculiar_energy(struct test_run *r, double *power)
{
  const struct fiber_energy e = fiber_energies(&r->state, &r->model);
  const double half = 0.5 * r->model.time_step, rate = r->model.shear.rate;
  double sum = e.bond + e.bend;
  *power = 0.0;
  for (uint32_t i = 0; i < r->state.vertices; i++) {
    struct vec3 v = vec3_add_scaled(r->state.velocity[i], -half * r->model.inverse_mass[i], r->work.fiber.force[i]);
    v.x -= rate * ((double)r->state.position[i].y * LATTICE_UNIT - 2.0);
    sum += 0.5 * r->model.mass[i] * vec3_dot(v, v);
    *power += vec3_dot(r->model.kind[r->model.fiber_kind_of[r->model.fiber_of[i]]].force, v);
  }
  return sum;
}

struct heard {
  const struct model *model;
  double sigma;
};

static bool hear(void *context, enum observable which, size_t columns, const double *values)
{
  struct heard *h = context;
  const char *names[OBSERVE_MOST_COLUMNS];
  assert_true(which == OBSERVE_STRESS && observe_series_columns(h->model, which, names) == columns);
  assert_string_equal(names[1], "sigma_xy");
  assert_string_equal(names[columns - 2], "sigma_xy_fibers");
  h->sigma = values[1];
  assert_true(values[columns - 2] == values[1]); /* there is no solvent */
  return true;
}

/* THEORY: the energy of the motion relative to a linear flow grows by the stress times the rate of shear times the
 * volume, and by what outer forces do against that motion. Contacts push both bonds at one place, so they add nothing.
 * Tolerance: the trapezoidal sum and the leap-frog's energy are of second order in dt, a part of 1e-3 here; the latter
 * is also at random by less than 0.1 kT. */
static void stress_makes_heat(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < CROSSINGS; rule++) {
    if (crossing_rule_row(rule)->in_turns) /* its exchanges are not at the time of contact, and heat */
      continue;
    struct test_run r = test_start(sheared_crowd(rule, 0.5, 0.005));
    struct observe_plan plan = {0};
    plan.every[OBSERVE_STRESS] = 1;
    struct observers *o = observers_create(&plan, &r.model);
    struct heard h = {.model = &r.model};
    const struct observe_sink sink = {hear, &h};
    double power, work = 0.0;
    const double start = peculiar_energy(&r, &power), volume = 48.0, dt = r.model.time_step;
    for (int step = 0; step <= 1200; step++) {
      assert_true(observers_sample(o, &r.model, &r.state, &sink));
      peculiar_energy(&r, &power);
      work += (step == 0 || step == 1200 ? 0.5 : 1.0) * dt * (h.sigma * 0.5 * volume + power);
      if (step < 1200)
        test_steps(&r, 1);
    }
    const double gained = peculiar_energy(&r, &power) - start;
    print_message("  %s: gained %.4f kT, work %.4f kT, %lu contacts\n", crossing_rule_of(&r.model)->name, gained, work,
                  (unsigned long)r.state.counts.executed);
    assert_true(fabs(work) > 20.0);
    assert_close(gained, work, 0.001 * fabs(work) + 0.1);
    observers_free(o);
    test_end(&r);
  }
}

/* Two straight fibers and a ring, whose moments are known. */
static void moments_by_hand(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 0.01, 2);
  struct fiber_kind *k = test_add_kind(&m, 2, 3);
  k->start = START_STRAIGHT;
  k->bond_length = 1.0;
  k->spring = 1e4;
  k->placed = 2;
  k->place = calloc(2, sizeof *k->place);
  k->place[0] = (struct fiber_place){{4, 4, 4}, {3, 4, 0}};
  k->place[1] = (struct fiber_place){{2, 2, 2}, {0, 0, 1}};
  k = test_add_kind(&m, 1, 40);
  k->ring = true;
  m.solvent.collision_interval = 0.0;
  m.time_step = 1e-3;
  struct test_run r = test_start(m);
  struct observe_plan plan = {0};
  plan.every[OBSERVE_ORIENTATION] = 1;
  struct observers *o = observers_create(&plan, &r.model);
  assert_true(observers_sample(o, &r.model, &r.state, NULL));
  struct kept *kept = keep_summaries(o, &r.model);
  const double length = 2.0 * vec3_norm(fiber_bond(&r.state, &r.model, 0)), square = length * length;
  assert_int_equal(kept->tables, 2);
  assert_close(kept_value(kept, "orientation-kind1", 0, "RxRx"), 0.18 * square, 1e-9);
  assert_close(kept_value(kept, "orientation-kind1", 0, "RyRy"), 0.32 * square, 1e-9);
  assert_close(kept_value(kept, "orientation-kind1", 0, "RzRz"), 0.5 * square, 1e-9);
  assert_close(kept_value(kept, "orientation-kind1", 0, "RxRy"), 0.24 * square, 1e-9);
  assert_close(kept_value(kept, "orientation-kind1", 0, "uxux"), 0.18, 1e-9);
  assert_close(kept_value(kept, "orientation-kind1", 0, "uyuy"), 0.32, 1e-9);
  assert_close(kept_value(kept, "orientation-kind1", 0, "uzuz"), 0.5, 1e-9);
  assert_close(kept_value(kept, "orientation-kind1", 0, "uxuy"), 0.24, 1e-9);
  assert_close(kept_value(kept, "orientation-kind1", 0, "chi"), 53.13010235415598, 1e-6); /* atan(4/3) */
  assert_close(kept_value(kept, "orientation-kind1", 0, "S"), 0.25, 1e-7); /* two at a right angle: 1/4, 1/4, -1/2 */
  assert_true(isnan(kept_value(kept, "orientation-kind2", 0, "RxRx")));
  const double sum = kept_value(kept, "orientation-kind2", 0, "uxux") +
                     kept_value(kept, "orientation-kind2", 0, "uyuy") +
                     kept_value(kept, "orientation-kind2", 0, "uzuz");
  assert_close(sum, 1.0, 1e-12);
  free(kept);
  observers_free(o);
  test_end(&r);
}

/* Rods drawn about an axis, more and less narrowly, and parallel ones: as measuring programs have it, by GSL. */
static void nematic_order_is_an_eigenvalue(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(1921)};
  for (int round = 0; round < 200; round++) {
    const uint32_t fibers = round % 2 ? 40 : 3;
    const double width = (double[]){0.0, 0.01, 0.3, 3.0}[round % 4];
    struct model m = test_model(8, 8, 8, 0, 0.01, 2);
    test_add_kind(&m, fibers, 2)->bond_length = 1.0;
    struct test_run r = test_start(m);
    struct observe_plan plan = {0};
    plan.every[OBSERVE_ORIENTATION] = 1;
    struct observers *o = observers_create(&plan, &r.model);
    const struct vec3 axis = dice_direction(&d);
    for (uint32_t f = 0; f < fibers; f++)
      r.state.position[2 * f + 1] =
          point_move(r.state.position[2 * f], vec3_add_scaled(axis, 1.0, dice_vector(&d, width)));
    assert_true(observers_sample(o, &r.model, &r.state, NULL));
    struct kept *kept = keep_summaries(o, &r.model);
    const double order = kept_value(kept, "orientation-kind1", 0, "S");
    assert_close(order, nematic_order(&r.state, &r.model), 1e-7);
    if (width == 0.0)
      assert_close(order, 1.0, 1e-9);
    free(kept);
    observers_free(o);
    test_end(&r);
  }
}

/* Two rods that are turned by hand by 0.3 and -0.1 radians from sample to sample. */
static void turning_by_hand(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 0, 0.01, 2);
  struct fiber_kind *k = test_add_kind(&m, 2, 2);
  k->bond_length = 1.0;
  k->spring = 1e4;
  m.solvent.collision_interval = 0.0;
  m.time_step = 1e-3;
  struct test_run r = test_start(m);
  struct observe_plan plan = {0};
  plan.every[OBSERVE_ORIENTATION] = 10;
  struct observers *o = observers_create(&plan, &r.model);
  for (int sample = 0; sample < 40; sample++) {
    const double angle[2] = {0.3 * sample, 2.0 - 0.1 * sample};
    for (int f = 0; f < 2; f++)
      r.state.position[2 * f + 1] =
          point_move(r.state.position[2 * f], (struct vec3){cos(angle[f]), sin(angle[f]), 0.5});
    r.state.step = 10 * (uint64_t)sample;
    assert_true(observers_sample(o, &r.model, &r.state, NULL));
  }
  struct kept *kept = keep_summaries(o, &r.model);
  assert_close(kept_value(kept, "orientation-kind1", 0, "turning"), 0.5 * (0.3 - 0.1) / (10 * 1e-3), 1e-8);
  assert_close(kept_value(kept, "orientation-kind1", 0, "samples"), 40, 0);
  free(kept);
  observers_free(o);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stress_makes_heat),
      cmocka_unit_test(moments_by_hand),
      cmocka_unit_test(nematic_order_is_an_eigenvalue),
      cmocka_unit_test(turning_by_hand),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
