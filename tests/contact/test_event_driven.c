/* The rule `event-driven`: the answer to one contact, and whole drifts run backwards. The search for contacts has its
 * own tests (test_flight.c); what every rule keeps is in tests/contract/test_crossings.c. */
#include "exact.h"

#include "contact/flight.h"
#include "contact/impulse.h"
#include "contact/rule.h"
#include "fiber/force.h"

/* --- one contact -------------------------------------------------------------------------------------------------- */

/* Two bonds that touch, the velocities and masses of their ends, and forces on them. */
struct touch {
  struct vec3 place[4], velocity[4], force[4];
  double mass[4];
  struct contact_geometry at;
  double tau;
};

static struct touch random_touch(struct dice *d, double forces)
{
  struct touch t;
  const struct vec3 p = dice_vector(d, 0.5), q = dice_vector(d, 0.5), where = dice_vector(d, 3.0);
  struct vec3 n = vec3_cross(p, q);
  t.at.s = dice_uniform(d), t.at.t = dice_uniform(d);
  t.place[0] = vec3_add_scaled(where, -t.at.s, p), t.place[1] = vec3_add(t.place[0], p);
  t.place[2] = vec3_add_scaled(where, -t.at.t, q), t.place[3] = vec3_add(t.place[2], q);
  for (int k = 0; k < 4; k++) {
    t.velocity[k] = dice_vector(d, 0.5);
    t.force[k] = dice_vector(d, forces);
    t.mass[k] = dice_between(d, 0.5, 8.0);
  }
  t.at.normal = vec3_scale((dice_u64(d) & 1 ? 1.0 : -1.0) / vec3_norm(n), n);
  t.tau = dice_between(d, -0.005, 0.005);
  return t;
}

/* Speed along the normal with which the contact points approach, of v + time F/M. */
static double approach(const struct touch *t, double time)
{
  const double lever[4] = {1.0 - t->at.s, t->at.s, t->at.t - 1.0, -t->at.t};
  double sum = 0.0;
  for (int k = 0; k < 4; k++)
    sum += lever[k] * vec3_dot(vec3_add_scaled(t->velocity[k], time / t->mass[k], t->force[k]), t->at.normal);
  return sum;
}

static enum contact_answer give_answer(struct touch *t)
{
  struct contact_end end[4];
  for (int k = 0; k < 4; k++)
    end[k] = (struct contact_end){&t->velocity[k], 1.0 / t->mass[k], t->force[k]};
  return impulse_at_own_time(end, &t->at, t->tau);
}

struct totals {
  struct vec3 momentum, angular;
  double energy; /* of v + tau F/M */
};

static struct totals totals_of(const struct touch *t)
{
  struct totals sum = {{0, 0, 0}, {0, 0, 0}, 0.0};
  for (int k = 0; k < 4; k++) {
    const struct vec3 u = vec3_add_scaled(t->velocity[k], t->tau / t->mass[k], t->force[k]);
    sum.momentum = vec3_add_scaled(sum.momentum, t->mass[k], t->velocity[k]);
    sum.angular = vec3_add_scaled(sum.angular, t->mass[k], vec3_cross(t->place[k], t->velocity[k]));
    sum.energy += 0.5 * t->mass[k] * vec3_dot(u, u);
  }
  return sum;
}

/* Momentum and angular momentum to rounding; the velocity of the present is reversed along the normal, and so its
 * energy is kept. Where that would be slower than a fifth of the approach, or faster than five times, it is softened.
 */
static void answers_keep_what_they_must(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(1501)};
  int corrected = 0, softened = 0, none = 0;
  for (int k = 0; k < 100000; k++) {
    struct touch t = random_touch(&d, 60.0);
    const struct totals before = totals_of(&t);
    const double a = approach(&t, 0.0), of_now = approach(&t, t.tau), h = of_now - a;
    const enum contact_answer answer = give_answer(&t);
    const struct totals after = totals_of(&t);
    assert_close(vec3_norm(vec3_sub(after.momentum, before.momentum)), 0.0, 1e-13);
    assert_close(vec3_norm(vec3_sub(after.angular, before.angular)), 0.0, 1e-12);
    const double rebound = -approach(&t, 0.0);
    if (answer == CONTACT_NONE) {
      assert_true(a <= 0.0 && rebound == -a && t.at.impulse == 0.0);
      none++;
    } else if (answer == CONTACT_CORRECTED) {
      assert_close(approach(&t, t.tau), -of_now, 1e-12);
      assert_close(after.energy - before.energy, 0.0, 1e-11);
      assert_true(t.at.impulse > 0.0);
      corrected++;
    } else {
      assert_close(1.0 / rebound, 1.0 / a + (h < 0.0 ? 1.6 : -1.6) / fabs(h), 1e-9 / rebound);
      assert_true(a + 2.0 * h < 0.2 * a + 1e-12 || a + 2.0 * h > 5.0 * a - 1e-12);
      softened++;
    }
  }
  print_message("  %d corrected, %d softened, %d apart\n", corrected, softened, none);
  assert_true(corrected > 10000 && softened > 1000 && none > 10000);
}

/* Backwards, tau has the other sign. Every answer is its own inverse then, softened ones included. */
static void answers_are_reversible(void **unused)
{
  (void)unused;
  struct dice d = {dice_seed(1502)};
  for (int k = 0; k < 100000; k++) {
    struct touch t = random_touch(&d, 60.0);
    const struct touch before = t;
    if (give_answer(&t) == CONTACT_NONE)
      continue;
    for (int e = 0; e < 4; e++)
      t.velocity[e] = vec3_scale(-1.0, t.velocity[e]);
    t.tau = -t.tau;
    assert_true(give_answer(&t) != CONTACT_NONE);
    for (int e = 0; e < 4; e++)
      assert_close(vec3_norm(vec3_add(t.velocity[e], before.velocity[e])), 0.0, 1e-12);
  }
}

/* --- the force on one vertex -------------------------------------------------------------------------------------- */

static struct point place_in_state(const void *context, uint32_t vertex)
{
  return ((const struct state *)context)->position[vertex];
}

static void forces_on_single_vertices(void **unused)
{
  (void)unused;
  struct model m = test_model(9, 9, 9, 0, 0.01, 1);
  test_add_kind(&m, 3, 7);
  struct fiber_kind *k = test_add_kind(&m, 3, 5);
  k->ring = true, k->force = (struct vec3){0.3, -0.2, 0.1};
  k = test_add_kind(&m, 2, 3);
  k->ring = true, k->bending = 9.0;
  k = test_add_kind(&m, 4, 6);
  k->bond_length = 0.0, k->bending = 0.0, k->spring = 3.0;
  test_add_kind(&m, 2, 1)->force = (struct vec3){1, 2, 3};
  k = test_add_kind(&m, 2, 2);
  struct test_run r = test_start(m);
  test_steps(&r, 50);
  assert_true(fiber_forces(&r.state, &r.model, r.work.fiber.force, 0, &r.work.fault));
  for (uint32_t i = 0; i < r.model.vertices; i++) {
    const struct vec3 alone = fiber_force_at(&r.model, i, place_in_state, &r.state), all = r.work.fiber.force[i];
    assert_close(vec3_norm(vec3_sub(alone, all)), 0.0, 1e-11 * (1.0 + vec3_norm(all)));
  }
  test_end(&r);
}

/* --- whole drifts, backwards
 * ------------------------------------------------------------------------------------------ */

static void kick_back(struct test_run *r)
{
  const double dt = r->model.time_step;
  assert_true(fiber_forces(&r->state, &r->model, r->work.fiber.force, 0, &r->work.fault));
  for (uint32_t i = 0; i < r->model.vertices; i++)
    r->state.velocity[i] =
        vec3_scale(-1.0, vec3_add_scaled(r->state.velocity[i], -dt * r->model.inverse_mass[i], r->work.fiber.force[i]));
}

/* A leap-frog in which contacts are answered at their own time returns to where it began. A contact is answered up to a
 * tick early, both ways: the place where paths bend is off by at most a tick's motion, 2^-16 of dt times the relative
 * speed, below 1e-6 a0 for 5 a0/t0. So is each vertex after it. Within 20 steps errors grow less than tenfold (stiff
 * bonds: omega t = 3). With the drift velocities reversed instead (tau = 0) or forces of another time the return misses
 * by 1e-3 (THEORY: rules a, b, c3). */
static void drifts_run_backwards(void **unused)
{
  (void)unused;
  double worst = 0.0;
  uint64_t contacts = 0;
  for (int start = 0; start < 10; start++) {
    struct model m = test_model(5, 5, 5, 0, 0.01, 1);
    m.crossing.rule = CROSSING_EVENT_DRIVEN;
    m.seed = dice_seed(1503) + (uint64_t)start;
    test_add_kind(&m, 60, 16);
    struct test_run r = test_start(m);
    struct point *first = malloc(r.model.vertices * sizeof *first);
    memcpy(first, r.state.position, r.model.vertices * sizeof *first);
    test_steps(&r, 20);
    contacts += r.state.counts.executed;
    kick_back(&r);
    test_steps(&r, 20);
    for (uint32_t i = 0; i < r.model.vertices; i++)
      worst = fmax(worst, vec3_norm(point_difference(r.state.position[i], first[i])));
    free(first);
    test_end(&r);
  }
  print_message("  %lu contacts, back within %.2g a0\n", (unsigned long)contacts, worst);
  assert_true(contacts > 500);
  assert_true(worst < 1e-5);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(answers_keep_what_they_must),
      cmocka_unit_test(answers_are_reversible),
      cmocka_unit_test(forces_on_single_vertices),
      cmocka_unit_test(drifts_run_backwards),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
