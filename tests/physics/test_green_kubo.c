/* The viscosity from fluctuations of the stress: its estimator against series whose integral is known, and its stress
 * against the moment that it is the change of. */
#include "../../validation/measure/green_kubo.h"
#include "base/normal.h"
#include "support.h"

enum { LAGS = 12 };

static void add_all(struct green_kubo *g, double value)
{
  double m[GREEN_KUBO_COMPONENTS];
  for (int a = 0; a < GREEN_KUBO_COMPONENTS; a++)
    m[a] = value;
  green_kubo_add(g, m);
}

/* m_n = (-1)^n: C_k = (-1)^k, so the integral is 1/2, -1/2, 1/2, ...; to the bit, and the same in every block. */
static void the_integral_of_an_alternating_series(void **unused)
{
  (void)unused;
  struct green_kubo g;
  assert_true(green_kubo_alloc(&g, LAGS, 50));
  for (uint32_t n = 0; n < LAGS + 4 * 50; n++)
    add_all(&g, n % 2 ? -1.0 : 1.0);
  for (uint32_t k = 0; k <= LAGS; k++) {
    const double sign = k % 2 ? -1.0 : 1.0;
    assert_true(g.c[k].n == 4.0 && g.c[k].mean == sign && g.eta[k].mean == 0.5 * sign);
    assert_true(sample_error(&g.eta[k]) == 0.0);
  }
  green_kubo_free(&g);
}

/* m_n = a m_{n-1} + e_n, e of variance 1 - a^2: C_k = a^k, and the integral to lag K is 1/2 + a (1 - a^K)/(1 - a). Six
 * independent series, some of negative a in the second part, whose errors must be right, too. */
static void the_integral_of_an_autoregressive_series(void **unused)
{
  (void)unused;
  static const double memory[] = {0.7, -0.4};
  for (size_t part = 0; part < 2; part++) {
    const double a = memory[part], width = sqrt(1.0 - a * a);
    double m[GREEN_KUBO_COMPONENTS] = {0}, e[2];
    struct green_kubo g;
    assert_true(green_kubo_alloc(&g, LAGS, 2000));
    for (uint32_t n = 0; n < 100 + LAGS + 64 * 2000; n++) {
      for (uint32_t c = 0; c < GREEN_KUBO_COMPONENTS; c++) {
        random_normal_pair(random_at(17, RANDOM_SOLVENT_VELOCITY, (uint32_t)part, n, c), e);
        m[c] = a * m[c] + width * e[0];
      }
      if (n >= 100)
        green_kubo_add(&g, m);
    }
    assert_true(sample_error(&g.eta[LAGS]) < 0.03);
    for (uint32_t k = 0; k <= LAGS; k += 4) {
      assert_sigma(g.c[k].mean, sample_error(&g.c[k]), pow(a, k), 4.5);
      assert_sigma(g.eta[k].mean, sample_error(&g.eta[k]), 0.5 + a * (1.0 - pow(a, k)) / (1.0 - a), 4.5);
    }
    green_kubo_free(&g);
  }
}

static struct model small_model(enum rule rule)
{
  struct model m = test_model(8, 8, 8, 5, 0.1, 1);
  m.solvent.rule = rule;
  return m;
}

/* An interval put together from parts of a step is the step, to the bit, for every rule. */
static void an_interval_is_a_step(void **unused)
{
  (void)unused;
  for (enum rule rule = 0; rule < RULES; rule++) {
    struct test_run a = test_start(small_model(rule)), b = test_start(small_model(rule));
    double m[GREEN_KUBO_COMPONENTS];
    for (int n = 0; n < 120; n++)
      assert_true(green_kubo_interval(&a.state, &a.model, &a.work.mpc, m, &a.work.fault));
    test_steps(&b, 120);
    assert_true(state_hash(&a.state) == state_hash(&b.state));
    test_end(&a);
    test_end(&b);
  }
}

/* sum_i r_b v_a, about the box's origin. */
static void moment(const struct solvent *s, double m[GREEN_KUBO_COMPONENTS])
{
  for (int a = 0; a < GREEN_KUBO_COMPONENTS; a++)
    m[a] = 0.0;
  for (uint32_t i = 0; i < s->n; i++) {
    const double r[3] = {(double)s->x[i] * LATTICE_UNIT, (double)s->y[i] * LATTICE_UNIT,
                         (double)s->z[i] * LATTICE_UNIT};
    const double v[3] = {s->vx[i], s->vy[i], s->vz[i]};
    for (int a = 0; a < GREEN_KUBO_COMPONENTS; a++)
      m[a] += r[green_kubo_axes[a][1]] * v[green_kubo_axes[a][0]];
  }
}

/* In the middle of the box nothing wraps: the stress is then the change of sum r v itself, cells or not. */
static void the_stress_is_the_change_of_the_moment(void **unused)
{
  (void)unused;
  for (enum rule rule = 0; rule < RULES; rule++) {
    struct test_run r = test_start(small_model(rule));
    struct solvent *s = &r.state.solvent;
    for (uint32_t i = 0; i < s->n; i++) {
      s->x[i] = 2 * LATTICE_CELL + s->x[i] / 2;
      s->y[i] = 2 * LATTICE_CELL + s->y[i] / 2;
      s->z[i] = 2 * LATTICE_CELL + s->z[i] / 2;
    }
    double before[GREEN_KUBO_COMPONENTS], after[GREEN_KUBO_COMPONENTS], m[GREEN_KUBO_COMPONENTS];
    for (int n = 0; n < 3; n++) {
      moment(s, before);
      assert_true(green_kubo_interval(&r.state, &r.model, &r.work.mpc, m, &r.work.fault));
      moment(s, after);
      for (int a = 0; a < GREEN_KUBO_COMPONENTS; a++) {
        assert_true(fabs(m[a]) > 1e-3);
        assert_close(m[a], after[a] - before[a], 1e-8);
      }
    }
    test_end(&r);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_integral_of_an_alternating_series),
                                     cmocka_unit_test(the_integral_of_an_autoregressive_series),
                                     cmocka_unit_test(an_interval_is_a_step),
                                     cmocka_unit_test(the_stress_is_the_change_of_the_moment)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
