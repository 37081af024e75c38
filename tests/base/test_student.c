/* Student's t distribution against the GNU Scientific Library's, which gets it from incomplete beta functions. */
#include <gsl/gsl_cdf.h>

#include "base/student.h"
#include "support.h"

static const double freedoms[] = {1, 2, 3, 4, 5, 9, 10, 31, 44, 100, 357, 1001};
enum { FREEDOMS = sizeof freedoms / sizeof *freedoms };

static void tails_are_those_of_gsl(void **unused)
{
  (void)unused;
  for (int n = 0; n < FREEDOMS; n++)
    for (double t = 0.0; t < 40.0; t += 0.37) {
      const double expected = 2.0 * gsl_cdf_tdist_Q(t, freedoms[n]);
      assert_close(student_tail(t, freedoms[n]), expected, 1e-14 + 1e-12 * expected);
    }
}

static void quantiles_are_those_of_gsl(void **unused)
{
  (void)unused;
  const double p[] = {0.9, 0.2, 0.05, 1e-3, 6.25e-5, 1e-7, 1e-9};
  for (int n = 0; n < FREEDOMS; n++)
    for (size_t k = 0; k < sizeof p / sizeof *p; k++) {
      const double expected = gsl_cdf_tdist_Qinv(p[k] / 2.0, freedoms[n]);
      assert_close(student_quantile(p[k], freedoms[n]), expected, 1e-5 * expected);
    }
}

static void many_freedoms_are_normal(void **unused)
{
  (void)unused;
  assert_close(student_tail(4.0, 1e9), erfc(4.0 / sqrt(2.0)), 0.01 * erfc(4.0 / sqrt(2.0)));
  assert_true(student_tail(40.0, 1e9) >= 0.0);
  assert_true(student_tail(INFINITY, 30.0) < 1e-14);
}

static void fractions_are_rounded_down(void **unused)
{
  (void)unused;
  assert_true(student_tail(3.0, 7.99) == student_tail(3.0, 7.0));
}

/* (a + b)^2/(a^2/(n - 1) + b^2/(m - 1)) of the squared errors a, b. */
static void freedoms_of_a_difference(void **unused)
{
  (void)unused;
  assert_true(student_welch(1.0, 10, 1.0, 10) == 18.0);
  assert_true(student_welch(3.0, 11, 4.0, 21) == 29.0); /* 625/(81/10 + 256/20) = 29.9 */
  assert_true(student_welch(0.001, 320, 1.0, 40) == 39.0);
  assert_true(student_welch(1.0, 2, 1e-300, 2) == 1.0);
  assert_true(student_welch(3e-300, 11, 4e-300, 21) == 29.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tails_are_those_of_gsl),   cmocka_unit_test(quantiles_are_those_of_gsl),
      cmocka_unit_test(many_freedoms_are_normal), cmocka_unit_test(fractions_are_rounded_down),
      cmocka_unit_test(freedoms_of_a_difference),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
