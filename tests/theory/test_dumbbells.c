/*
 * A fluid of dumbbells in theory (Tao, Goetze and Gompper 2008). Expected numbers were computed apart from this
 * program; recipes in Python stand beside them.
 */
#include "support.h"

#include "theory/dumbbell.h"
#include "theory/flow.h"
#include "theory/theory.h"

static void close_to(double actual, double expected, double tolerance)
{
  assert_close(actual / expected, 1.0, tolerance);
}

static struct model fluid(double spring, double fraction)
{
  struct model m = test_model(20, 20, 1, 10, 0.02, 1);
  m.dimensions = 2;
  m.solvent.rule = RULE_AT_A;
  m.dumbbells = (struct dumbbell_model){.spring = spring, .fraction = fraction};
  return m;
}

static struct model finished(struct model m)
{
  test_finish(&m);
  return m;
}

/* P = 9 + exp(-10); D = .02*(10/P - .5); w = 4*K*D; eta_p = 5/w; eta_0 = 10*D + P/.24 */
static void viscosity_of_springs(void **unused)
{
  (void)unused;
  static const double table[][3] = {/* K, omega_H, eta */
                                    {0.3, 0.014667, 378.5},
                                    {1.0, 0.048888, 139.90},
                                    {5.0, 0.24444, 58.08}};
  for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
    struct model m = finished(fluid(table[k][0], 1.0));
    close_to(theory_model_dumbbell_rate(&m), table[k][1], 5e-5);
    close_to(theory_model_viscosity(&m), table[k][2], 2e-4);
    close_to(theory_model_viscosity_of_solvent(&m), 37.6224, 1e-5);
    model_free(&m);
  }
  struct model half = finished(fluid(1.0, 0.5)), none = finished(fluid(0.0, 0.0));
  close_to(theory_model_viscosity(&half), 37.62241 + 51.13683, 1e-6);
  close_to(theory_model_viscosity(&none), 37.62241, 1e-6);
  model_free(&half);
  model_free(&none);
}

/* x = w/wH; G = complex(5*x*x/(1+x*x), e0*w + 5*x/(1+x*x)); k = sqrt(1j*w*10/(G/(1j*w))); cosh(k*10) */
static void moduli_and_inertia(void **unused)
{
  (void)unused;
  const double eta = 37.62241026761596, rate = 0.048888440496782745;
  const double complex slow = theory_dumbbell_modulus(eta, 5.0, rate, 0.05);
  const double complex fast = theory_dumbbell_modulus(eta, 5.0, rate, 0.2);
  assert_close(creal(slow), 2.5561956013319156, 1e-12);
  assert_close(cimag(slow), 4.380488844457861, 1e-12);
  assert_close(creal(fast), 4.718085028860572, 1e-12);
  assert_close(cimag(fast), 8.67778114948425, 1e-12);
  const double complex near = theory_dumbbell_inertia(slow, 0.05, 10.0, 20.0);
  const double complex far = theory_dumbbell_inertia(fast, 0.2, 10.0, 20.0);
  assert_close(creal(near), 0.8709667195830388, 1e-12);
  assert_close(cimag(near), 0.2040592443615891, 1e-12);
  assert_close(creal(far), -0.2496102517833436, 1e-12);
  assert_close(cimag(far), 1.2041562951888365, 1e-12);
  assert_true(theory_dumbbell_modulus(eta, 5.0, rate, 0.0) == 0.0);
}

/* At Wi = 1: <r^2> = 2 R_0^2 in a plane, 5/3 R_0^2 in space; tan 2 chi = 1. */
static void stretched(void **unused)
{
  (void)unused;
  close_to(theory_dumbbell_stretch(1.0, 2), 2.0, 1e-15);
  close_to(theory_dumbbell_stretch(1.0, 3), 5.0 / 3.0, 1e-15);
  close_to(theory_dumbbell_angle(1.0), 0.39269908169872414, 1e-15);
  close_to(theory_dumbbell_angle(0.0), 0.78539816339744831, 1e-15);
  close_to(theory_dumbbell_normal_stress(5.0, 2.0), 40.0, 1e-15);
  close_to(theory_dumbbell_size(0.5, 2), 2.0, 1e-15);
}

/* One wall: (1 + erf(y sqrt(K/2)))/2. With the potential A = 0.95, c1 = 1.2 numbers of the closed form, in Python. K =
 * 4 halves all lengths. The integral of the density is a second way: the excess is made from pairs, not from particles.
 */
static void density_at_walls(void **unused)
{
  (void)unused;
  static const double bare[][2] = {{0.0, 0.5},    {0.25, .59871}, {0.5, .69146}, {1.0, .84134},
                                   {1.5, .93319}, {2.0, .97725},  {3.0, .99865}};
  static const double drawn[][2] = {{0.0, .96884}, {0.25, 1.01798}, {0.5, 1.03175}, {0.75, 1.01935}, {1.0, .99592},
                                    {1.2, .97936}, {1.5, .96826},   {2.0, .97960},  {2.4, .99180},   {3.0, .99865}};
  for (size_t k = 0; k < sizeof bare / sizeof *bare; k++)
    assert_close(theory_dumbbell_density(4.0, 0.0, 1.2, 0.5 * bare[k][0]), bare[k][1], 6e-6);
  for (size_t k = 0; k < sizeof drawn / sizeof *drawn; k++)
    assert_close(theory_dumbbell_density(4.0, 0.95, 1.2, 0.5 * drawn[k][0]), drawn[k][1], 6e-6);
  assert_close(theory_dumbbell_excess(1.0, 0.0, 1.2), -0.3989422804014327, 1e-9); /* 1/sqrt(2 pi) */
  assert_close(theory_dumbbell_excess(4.0, 0.95, 1.2), -0.5 * 0.01828, 5e-6);
  /* the excess is the integral of the density */
  for (int kind = 0; kind < 2; kind++) {
    double sum = 0.0;
    for (int k = 0; k < 100000; k++)
      sum += 1e-4 * (theory_dumbbell_density(1.0, kind ? 0.95 : 0.0, 1.2, 1e-4 * (k + 0.5)) - 1.0);
    assert_close(sum, theory_dumbbell_excess(1.0, kind ? 0.95 : 0.0, 1.2), 1e-7);
  }
  struct model m = fluid(1.0, 1.0);
  m.walls.kind = WALL_NO_SLIP;
  m = finished(m);
  close_to(theory_dumbbell_bulk_density(&m), 10.0 / (1.0 - 2.0 * 0.39894228 / 20.0), 1e-8);
  model_free(&m);
}

/* What is slowest when a flow begins: the springs, in a sheared box and in a narrow gap; momentum in a wide one. */
static void transients(void **unused)
{
  (void)unused;
  struct model m = fluid(1.0, 1.0);
  m.shear.rate = 0.05;
  m = finished(m);
  close_to(theory_flow_transient(&m, 14.0), 1.0 / 0.048888, 5e-5);
  model_free(&m);
  struct model still = finished(fluid(1.0, 1.0));
  assert_true(theory_flow_transient(&still, 14.0) == 0.0);
  model_free(&still);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(viscosity_of_springs), cmocka_unit_test(moduli_and_inertia), cmocka_unit_test(stretched),
      cmocka_unit_test(density_at_walls),     cmocka_unit_test(transients),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
