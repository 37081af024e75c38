/*
 * Collisions around a bead: what they keep, virtual particles, the bead's temperature, bits.
 */
#include "exact.h"
#include "mpc/cell.h"
#include "mpc/collide.h"
#include "mpc/grid.h"
#include "statistics.h"
#include "system/bead.h"

static struct model bead_model_at(double per_cell, enum rule rule, double radius, double mass_over_displaced)
{
  struct model m = test_model(12, 13, 14, per_cell, 0.1, 1);
  m.solvent.rule = rule;
  m.bead.radius = radius;
  m.bead.center = (struct vec3){0.3, 12.9, 6.4}; /* across two faces */
  m.bead.mass = mass_over_displaced * per_cell * 4.18879020478639098 * radius * radius * radius * (1.0 + 1e-12);
  return m;
}

static struct model bead_model(enum rule rule, double radius, double mass_over_displaced)
{
  return bead_model_at(4.0, rule, radius, mass_over_displaced);
}

struct total {
  long double momentum[3], energy; /* with the heat that has come in taken off */
};

static struct total total_of(const struct test_run *r)
{
  const struct solvent *s = &r->state.solvent;
  const struct vec3 w = r->state.bead->velocity;
  const long double mass = r->model.bead.mass;
  struct total t = {{mass * w.x, mass * w.y, mass * w.z},
                    mass * vec3_dot(w, w) / 2 - (double)r->state.bead->account.x * BEAD_ENERGY_UNIT};
  for (uint32_t i = 0; i < s->n; i++) {
    const long double v[3] = {s->vx[i], s->vy[i], s->vz[i]};
    for (int k = 0; k < 3; k++)
      t.momentum[k] += v[k], t.energy += v[k] * v[k] / 2;
  }
  return t;
}

/* Of solvent and bead, over whole steps. SRD keeps the energy as well, but for the heat of the bead's own matter. Each
 * member's momentum is rounded to 2^-44; 9000 members and 200 steps leave 1e-10. Heat is rounded to 2^-32 kT per cell
 * and step: 100 cells, 200 steps, 5e-6 at most. Nobody is ever inside. */
static void steps_keep_momentum_energy_and_the_outside(void **unused)
{
  (void)unused;
  const enum rule rules[] = {RULE_SRD, RULE_AT_A};
  for (int k = 0; k < 6; k++) {
    const enum rule rule = rules[k % 2];
    struct test_run r = test_start(bead_model(rule, 1.5 + 0.25 * (k / 2), k < 4 ? 1.0 : 5.0));
    const struct total before = total_of(&r);
    double heat = 0.0;
    for (int step = 0; step < 200; step++) {
      test_steps(&r, 1);
      struct fault fault = {.code = FAULT_NONE};
      assert_true(bead_sound(&r.state, &r.model, &fault));
      heat = fmax(heat, fabs((double)r.state.bead->account.x * BEAD_ENERGY_UNIT));
    }
    const struct total after = total_of(&r);
    for (int c = 0; c < 3; c++) {
      assert_close((double)before.momentum[c], 0.0, 1e-9);
      assert_close((double)after.momentum[c], 0.0, 1e-9);
    }
    if (rule == RULE_SRD)
      assert_close((double)(after.energy - before.energy), 0.0, 2e-5);
    assert_true(heat > 1.0); /* there was some */
    assert_true(r.state.bead->account.z > 500);
    test_end(&r);
  }
}

/* The same future for any order in memory, sorted or not, and if the scratch is made anew after each step. */
static void memory_does_not_matter(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(4202)};
  for (int k = 0; k < 4; k++) {
    struct model m = bead_model(k % 2 ? RULE_AT_A : RULE_SRD, 2.0, 1.0);
    m.bead.drive.spring = k < 2 ? 0.0 : 20.0;
    m.bead.drive.velocity.y = k < 2 ? 0.0 : 0.1;
    struct test_run a = test_start(m), b = test_start(m);
    for (int step = 0; step < 20; step++) {
      shuffle_memory(&b.state, &d);
      work_free(&b.work);
      assert_true(work_alloc(&b.work, &b.model));
      b.work.mpc.since_sort = step % 3 ? 1 : 0;
      test_steps(&a, 1);
      test_steps(&b, 1);
      assert_true(state_hash(&a.state) == state_hash(&b.state));
    }
    const uint64_t hash = state_hash(&a.state);
    a.state.bead->position.y ^= 1;
    assert_true(state_hash(&a.state) != hash);
    test_end(&a);
    test_end(&b);
  }
}

/* All start outside, as many as the room beside the bead holds, uniformly: the second moment of x - R of those within
 * 3 a0 of the surface has that of a uniform density. */
static void the_solvent_starts_outside(void **unused)
{
  (void)unused;
  struct sample shell = {0};
  for (uint64_t seed = 1; seed <= 40; seed++) {
    struct model m = bead_model(RULE_SRD, 2.0, 1.0);
    m.seed = seed;
    struct test_run r = test_start(m);
    struct fault fault = {.code = FAULT_NONE};
    assert_true(bead_sound(&r.state, &r.model, &fault));
    assert_int_equal(r.state.solvent.n, (uint32_t)nearbyint(4.0 * (12 * 13 * 14 - 33.510321638291127)));
    double n = 0.0;
    for (uint32_t i = 0; i < r.state.solvent.n; i++) {
      const struct solvent *s = &r.state.solvent;
      const struct point x = {s->x[i], s->y[i], s->z[i]};
      n += vec3_norm(point_in_a0(bead_to_image(&m.box, r.state.bead->position, x))) < 4.0;
    }
    sample_add(&shell, n);
    test_end(&r);
  }
  /* gamma 4/3 pi (4^3 - 2^3) */
  assert_sigma(shell.mean, sample_error(&shell), 4.0 * 4.1887902047863909846 * 56.0, 4.0);
}

/* The velocity of the bead in equilibrium: kT/M per component, and Gaussian (fourth moment 3), with the total momentum
 * 0: M <V^2> = kT (1 - M/(M + N)). Two rules, light and heavy beads. Independent velocities of the virtual particles
 * would heat the lightest by a fifth; the error is 2 %. */
static void the_bead_is_thermal(void **unused)
{
  (void)unused;
  test_begin_statistics();
  const struct {
    enum rule rule;
    double radius, heavier;
  } rows[] = {{RULE_SRD, 1.5, 1.0}, {RULE_AT_A, 1.5, 1.0}, {RULE_SRD, 2.0, 1.0}, {RULE_AT_A, 2.0, 4.0}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    struct model m = bead_model_at(2.0, rows[k].rule, rows[k].radius, rows[k].heavier);
    struct test_run r = test_start(m);
    const double mass = r.model.bead.mass, share = 1.0 - mass / (mass + r.state.solvent.n);
    struct blocks square = {.length = 500};
    for (int step = 0; step < 16000; step++) {
      test_steps(&r, 1);
      const struct vec3 v = r.state.bead->velocity;
      blocks_add(&square, mass * vec3_dot(v, v) / 3.0 / share);
    }
    print_message("  rule %d, R %.1f, M %.0f\n", (int)rows[k].rule, rows[k].radius, mass);
    assert_sigma(square.of_blocks.mean, sample_error(&square.of_blocks), 1.0, 4.0);
    test_end(&r);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(steps_keep_momentum_energy_and_the_outside),
      cmocka_unit_test(memory_does_not_matter),
      cmocka_unit_test(the_solvent_starts_outside),
      cmocka_unit_test(the_bead_is_thermal),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
