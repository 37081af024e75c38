/* Integrators of DPD that err (validation/measure/dpd_integrators.h), against what one pair at a fixed distance does,
 * exactly, and against each other. */
#include "../../validation/measure/dpd_integrators.h"
#include "exact.h"

/* Particles of mass 1 in a cube. */
static struct model fluid(int edge, double density, double dt, double rate, double repulsion)
{
  struct model m = test_model(edge, edge, edge, 0, dt, 0);
  m.medium = (struct medium_model){.kind = MEDIUM_PAIRS,
                                   .rate = rate,
                                   .draw = DRAW_RELAX,
                                   .weight = WEIGHT_QUADRATIC,
                                   .density = density,
                                   .repulsion = repulsion};
  m.medium.many.range = 0.75;
  m.crossing.forbidden = false;
  return m;
}

static const struct dpd_scheme *scheme(const char *name)
{
  for (int k = 0; k < DPD_SCHEMES; k++)
    if (strcmp(dpd_schemes[k].name, name) == 0)
      return &dpd_schemes[k];
  fail_msg("no scheme %s", name);
  return NULL;
}

static double apart(const struct vec3 *v)
{
  return v[0].x - v[1].x;
}

/* The normal number of the pair of particles 0 and 1, by its address. */
static double noise_of(const struct dpd *d)
{
  const uint32_t low = 0, high = 1;
  uint64_t word[4][NEAR_BLOCK];
  double normal;
  random_wide_pair_columns(d->model->seed, RANDOM_BATH_PAIR, d->evaluation, &low, &high, 1, word);
  random_normal_third_column(word[2], word[3], 1, &normal);
  return normal;
}

/* A single noise that then dies out: a linear step adds up such answers, so the temperature is the sum of their squares
 * over that of the noise. */
static void answer(const char *name, double eps, double temperature[2])
{
  const double dt = 0.02, w = 0.5;
  struct test_run r = test_start(fluid(3, 2.0 / 27.0, dt, eps / (w * w * dt), 0.0));
  struct dpd d;
  assert_int_equal(r.state.solvent.n, 2);
  for (uint32_t i = 0; i < 2; i++) {
    r.state.solvent.x[i] = LATTICE_CELL + (r.state.solvent.id[i] == 0 ? LATTICE_CELL / 2 : 0);
    r.state.solvent.y[i] = r.state.solvent.z[i] = LATTICE_CELL;
  }
  assert_true(dpd_begin(&d, &r.model, &r.state, &r.work));
  memset(d.v, 0, 2 * sizeof *d.v);
  d.held = true;
  d.loudness = 0.0;
  assert_true(dpd_find(&d));
  dpd_friction(&d, d.v);
  dpd_keep_force(&d);
  temperature[0] = temperature[1] = 0.0;
  double theta = 0.0;
  for (int step = 0; step < 400; step++) {
    d.loudness = step == 0 ? 1.0 : 0.0;
    assert_true(scheme(name)->step(&d));
    if (step == 0)
      theta = noise_of(&d);
    temperature[0] += 0.5 * apart(d.v) * apart(d.v); /* its variance is 2 kT/m */
    temperature[1] += 0.5 * apart(d.trial) * apart(d.trial);
  }
  for (int k = 0; k < 2; k++)
    temperature[k] /= theta * theta;
  dpd_end(&d);
  test_end(&r);
}

/*
 * Of one pair, eps = 2 gamma w^2 dt/m: the temperature of v and of the velocity that friction is taken with. Recipe:
 * the step is u' = A u + b s with u = (v, force dt), <s^2> = 2 eps; C = A C A' + 2 eps b b' solved as a linear system,
 * to six digits. In closed form 1/(1 - eps/2) for the explicit and the semi-implicit step, and for the second of Groot
 * and Warren's with lambda 1/2; 1/(1 + eps/2) where friction and velocity are made to agree in the second half kick
 * alone.
 */
static void one_pair(void **unused)
{
  (void)unused;
  static const double eps[] = {0.05, 0.1, 0.2, 0.5};
  static const struct {
    const char *name;
    double v[4], trial[4];
  } rows[] = {
      {"groot-warren", {1, 1, 1, 1}, {1.025641, 1.052632, 1.111111, 1.333333}},
      {"groot-warren-65", {0.992556, 0.985222, 0.970874, 0.930233}, {1.035900, 1.074260, 1.159469, 1.512489}},
      {"euler", {1.025641, 1.052632, 1.111111, 1.333333}, {1.025641, 1.052632, 1.111111, 1.333333}},
      {"semi-implicit", {1.025641, 1.052632, 1.111111, 1.333333}, {1.025641, 1.052632, 1.111111, 1.333333}},
      {"dpd-vv", {0.987504, 0.975033, 0.950276, 0.880000}, {1.012496, 1.024967, 1.049724, 1.120000}},
      {"sc-vv", {0.975610, 0.952381, 0.909091, 0.800000}, {1, 1, 1, 1}},
      {"leap-frog", {1, 1, 1, 1}, {0.975610, 0.952381, 0.909091, 0.800000}},
  };
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
    for (int e = 0; e < 4; e++) {
      double found[2];
      answer(rows[k].name, eps[e], found);
      assert_close(found[0], rows[k].v[e], 1e-6);
      assert_close(found[1], rows[k].trial[e], 1e-6);
    }
}

/* Places by number, lattice units. */
static void places(const struct state *state, int64_t (*at)[3])
{
  const struct solvent *s = &state->solvent;
  for (uint32_t i = 0; i < s->n; i++) {
    at[s->id[i]][0] = s->x[i];
    at[s->id[i]][1] = s->y[i];
    at[s->id[i]][2] = s->z[i];
  }
}

/* With lambda 1/2 and w = v + F dt/2, Groot and Warren's step is w += F(r, w) dt, r += w dt, identically. Over 100
 * steps of 0.02 what rounding of places leaves, 2^-40, grows by collisions; a step that differs in anything is off by
 * 1e-4 at least. */
static void groot_warren_is_semi_implicit(void **unused)
{
  (void)unused;
  const double dt = 0.02;
  struct model m = fluid(4, 3.0, dt, 9.0, 25.0);
  m.seed = dice_seed(4101);
  struct test_run a = test_start(m), b = test_start(m);
  struct dpd one, two;
  assert_true(dpd_begin(&one, &a.model, &a.state, &a.work));
  assert_true(dpd_begin(&two, &b.model, &b.state, &b.work));
  dpd_add_force(&two, 0.5 * dt, two.v, two.v);
  assert_true(dpd_move(&two, two.v));
  const uint32_t n = a.state.solvent.n;
  int64_t(*here)[3] = calloc(n, sizeof *here), (*there)[3] = calloc(n, sizeof *there);
  double off = 0.0, fast = 0.0;
  for (int step = 0; step < 100; step++) {
    assert_true(dpd_groot_warren_half(&one));
    places(&a.state, here);
    places(&b.state, there);
    for (uint32_t i = 0; i < n; i++) {
      for (int k = 0; k < 3; k++)
        off = fmax(off, fabs(remainder((double)(here[i][k] - there[i][k]) * LATTICE_UNIT, 4.0)));
      fast = fmax(fast, vec3_norm(vec3_sub(one.trial[i], two.v[i])));
    }
    assert_true(dpd_semi_implicit(&two));
  }
  print_message("  places differ by %.2g a0, velocities by %.2g a0/t0\n", off, fast);
  assert_close(off, 0.0, 1e-8);
  assert_close(fast, 0.0, 1e-7);
  free(here);
  free(there);
  dpd_end(&one);
  dpd_end(&two);
  test_end(&a);
  test_end(&b);
}

/* All of them keep momentum. After 20 steps of 1e-4 from one state the places differ by noise alone, 1e-4 a0: so the
 * squares of the repulsions agree to 1 %. */
static void one_fluid(void **unused)
{
  (void)unused;
  const double dt = 1e-4;
  double first[DPD_SCHEMES] = {0.0};
  for (int k = 0; k < DPD_SCHEMES; k++) {
    struct model m = fluid(4, 3.0, dt, 9.0, 25.0);
    m.seed = dice_seed(4102);
    m.medium.draw = dpd_schemes[k].draw;
    m.medium.weight = dpd_schemes[k].weight;
    struct test_run r = test_start(m);
    struct dpd d;
    assert_true(dpd_begin(&d, &r.model, &r.state, &r.work));
    for (int step = 0; step < 20; step++)
      assert_true(dpd_schemes[k].step(&d));
    struct vec3 p = {0, 0, 0};
    for (uint32_t i = 0; i < r.state.solvent.n; i++)
      p = vec3_add(p, dpd_schemes[k].own ? solvent_velocity(&r.state.solvent, i) : d.v[i]);
    assert_close(vec3_norm(p), 0.0, 1e-9);
    assert_true(dpd_find(&d));
    for (uint32_t i = 0; i < r.state.solvent.n; i++)
      first[k] += vec3_dot(d.push[i], d.push[i]);
    dpd_end(&d);
    test_end(&r);
  }
  for (int k = 1; k < DPD_SCHEMES; k++)
    assert_close(first[k] / first[0], 1.0, 0.01);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_pair),
      cmocka_unit_test(groot_warren_is_semi_implicit),
      cmocka_unit_test(one_fluid),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
