/* Langevin and Andersen: free diffusion, memory of a velocity, and what tells one from the other, exact at any step. */
#include "exact.h"
#include "medium/medium.h"
#include "statistics.h"
#include "theory/medium.h"

enum { VERTICES = 2000, STEPS = 40, ROUNDS = 60 };

static struct model free_vertices(enum medium_draw draw, double x, double mass)
{
  struct model m = test_model(8, 8, 8, 0, 0.1, 0);
  m.medium = (struct medium_model){.kind = MEDIUM_PRIVATE, .rate = x / m.time_step, .draw = draw};
  m.flow = (struct vec3){0.5, 0.0, -0.25};
  m.crossing.forbidden = false;
  test_add_kind(&m, VERTICES, 1)->mass = mass;
  return m;
}

/*
 * Per step a velocity w about the flow keeps c on average, and c^2 of its square's correlation:
 *
 *   <w(0) w(n)> = c^n/M,   <w^2(0) w^2(n)> M^2 = 1 + 2 <c^2>^n,   <c^2> = c for `replace`, c^2 for the other two;
 *   <x^2> of n steps = (2 dt^2/M) [n/2 + sum_{k<n} (n - k) c^k],  the sum over k = 1 .. n - 1: its slope is 2 D,
 *   D = (dt/M)[1/(1 - c) - 1/2].
 *
 * Independent rounds of many vertices; 4.5 standard errors, 54 numbers: 1 false alarm in 2700 seeds.
 */
static void check(enum medium_draw draw, double x, double mass)
{
  const double c = draw == DRAW_REPLACE ? 1.0 - x : draw == DRAW_RELAX ? exp(-x) : (1.0 - 0.5 * x) / (1.0 + 0.5 * x);
  const double squares = draw == DRAW_REPLACE ? c : c * c;
  struct sample memory[2] = {{0}}, fourth = {0}, spread = {0};
  struct model m = free_vertices(draw, x, mass);
  m.seed = dice_seed(3201) + (uint64_t)draw;
  struct test_run r = test_start(m);
  struct vec3 *old = calloc(VERTICES, sizeof *old);
  struct point *at = calloc(VERTICES, sizeof *at);
  const double dt = r.model.time_step;
  assert_close(theory_medium_diffusion(&r.model, mass), dt / mass * (1.0 / (1.0 - c) - 0.5),
               1e-13 / (mass * (1.0 - c)));
  for (int round = 0; round < ROUNDS; round++) {
    for (uint32_t v = 0; v < VERTICES; v++) {
      old[v] = vec3_sub(r.state.velocity[v], r.model.flow);
      at[v] = r.state.position[v];
    }
    double product[2] = {0.0}, both = 0.0, square = 0.0;
    for (int k = 1; k <= STEPS; k++) {
      test_steps(&r, 1);
      for (uint32_t v = 0; v < VERTICES && k < 3; v++) {
        const struct vec3 w = vec3_sub(r.state.velocity[v], r.model.flow);
        product[k - 1] += vec3_dot(old[v], w) / (3.0 * VERTICES);
        if (k == 2)
          both +=
              (old[v].x * old[v].x * w.x * w.x + old[v].y * old[v].y * w.y * w.y + old[v].z * old[v].z * w.z * w.z) /
              (3.0 * VERTICES);
      }
    }
    for (uint32_t v = 0; v < VERTICES; v++) {
      const struct vec3 moved =
          vec3_add_scaled(point_difference(r.state.position[v], at[v]), -STEPS * dt, r.model.flow);
      square += vec3_dot(moved, moved) / (3.0 * VERTICES);
    }
    for (int k = 0; k < 2; k++)
      sample_add(&memory[k], product[k] * mass);
    sample_add(&fourth, both * mass * mass);
    sample_add(&spread, square);
  }
  double sum = 0.5 * STEPS;
  for (int k = 1; k < STEPS; k++)
    sum += (STEPS - k) * pow(c, k);
  assert_sigma(memory[0].mean, sample_error(&memory[0]), c, 4.5);
  assert_sigma(memory[1].mean, sample_error(&memory[1]), c * c, 4.5);
  assert_sigma(fourth.mean, sample_error(&fourth), 1.0 + 2.0 * squares * squares, 4.5);
  assert_sigma(spread.mean, sample_error(&spread), 2.0 * dt * dt / mass * sum, 4.5);
  free(old);
  free(at);
  test_end(&r);
}

static void free_vertices_are_exact(void **unused)
{
  (void)unused;
  for (int draw = 0; draw < MEDIUM_DRAWS; draw++) {
    check((enum medium_draw)draw, 0.05, 1.0);
    check((enum medium_draw)draw, 0.5, 4.0);
  }
  check(DRAW_REPLACE, 1.0, 1.0); /* no memory at all */
}

/* A harmonic dumbbell: k <r^2> = 3 kT at any time step with the bath between two half drifts; with the bath between two
 * half kicks 3/(1 - omega^2 dt^2/4), omega^2 = 2 k/M. 4.5 standard errors. */
static void bonds_are_exact(void **unused)
{
  (void)unused;
  static const enum scheme schemes[] = {SCHEME_DRIFT_SPLIT, SCHEME_KICK_SPLIT};
  for (int s = 0; s < 2; s++)
    for (int draw = 0; draw < MEDIUM_DRAWS; draw++) {
      struct model m = test_model(40, 40, 40, 0, 0.2, 0);
      m.medium = (struct medium_model){.kind = MEDIUM_PRIVATE, .rate = 2.0, .draw = (enum medium_draw)draw};
      m.scheme = schemes[s];
      m.seed = dice_seed(3202) + (uint64_t)draw;
      m.crossing.forbidden = false;
      struct fiber_kind *k = test_add_kind(&m, 1000, 2);
      k->mass = 1.0;
      k->bond_length = k->bending = 0.0;
      k->spring = 6.0;
      struct test_run r = test_start(m);
      struct sample size = {0};
      test_steps(&r, 50);
      for (int block = 0; block < 60; block++) {
        double square = 0.0;
        test_steps(&r, 40);
        for (uint32_t b = 0; b < r.state.vertices; b += 2) {
          const struct vec3 bond = point_difference(r.state.position[b + 1], r.state.position[b]);
          square += vec3_dot(bond, bond) * 6.0 / 3000.0;
        }
        sample_add(&size, square);
      }
      const double phase = 12.0 * 0.2 * 0.2;
      assert_sigma(size.mean, sample_error(&size), s == 0 ? 1.0 : 1.0 / (1.0 - 0.25 * phase), 4.5);
      test_end(&r);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(free_vertices_are_exact), cmocka_unit_test(bonds_are_exact)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
