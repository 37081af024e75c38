/*
 * Baths of vertices and of pairs in molecular chaos. Expected numbers were computed apart from this program: recipes in
 * Python stand beside them; the closed forms of the hat are those of Lowe 1999, those of DPD of Groot and Warren 1997.
 */
#include "support.h"
#include "theory/medium.h"
#include "theory/theory.h"

static struct model pairs(double rate, double dt, enum medium_draw draw, enum medium_weight weight)
{
  struct model m = test_model(5, 5, 5, 0, dt, 0);
  m.medium = (struct medium_model){.kind = MEDIUM_PAIRS, .rate = rate, .draw = draw, .weight = weight, .density = 3.0};
  test_finish(&m);
  return m;
}

/* p = .2; a = 2*pi*p/3; D = .02*(1/a - .5); e = 4*pi*3*(p/9 - p/45); .02*3*(1/e - .5); pi*9*10/75 */
static void lowe_andersen(void **unused)
{
  (void)unused;
  struct model m = pairs(10.0, 0.02, DRAW_REPLACE, WEIGHT_HAT);
  assert_close(theory_medium_loss(&m, 1.0), 0.41887902047863906, 1e-13);
  assert_close(theory_medium_loss(&m, 4.0), 0.41887902047863906 * 0.4, 1e-13);
  assert_close(theory_medium_diffusion(&m, 1.0), 0.037746482927568603, 1e-14);
  assert_close(theory_medium_viscosity_kinetic(&m), 0.059524655489191135, 1e-13);
  assert_close(theory_medium_viscosity_collisional(&m), 3.7699111843077517, 1e-8); /* of r^4, Simpson leaves 4e-10 */
  model_free(&m);
}

/* At a small step, gamma = 4.5: D = 45/(2 pi gamma rho), eta_kin = rho D/2, eta_col = 2 pi gamma rho^2/1575. */
static void dissipative_particles(void **unused)
{
  (void)unused;
  for (int draw = DRAW_RELAX; draw <= DRAW_CAYLEY; draw++) {
    struct model m = pairs(9.0, 1e-6, (enum medium_draw)draw, WEIGHT_QUADRATIC);
    assert_close(theory_medium_diffusion(&m, 1.0), 0.53051647697298445, 3e-6);
    assert_close(theory_medium_viscosity_kinetic(&m), 3.0 * 0.26525823848649222, 1e-5);
    assert_close(theory_medium_viscosity_collisional(&m), 9.0 * 0.017951958020513104, 1e-5);
    model_free(&m);
  }
}

/* D is the same at the same rate. Per collision the kinetic stress loses (1 - c)/3 - (1 - c)^2/15: 4/15 for c = 0, and
 * 1/3 of the loss for weak relaxation. So `replace` has 5/4 of the kinetic viscosity. */
static void what_tells_replacing_from_relaxing(void **unused)
{
  (void)unused;
  struct model replace = pairs(1.0, 1e-6, DRAW_REPLACE, WEIGHT_HAT), relax = pairs(1.0, 1e-6, DRAW_RELAX, WEIGHT_HAT);
  const double same = theory_medium_diffusion(&replace, 1.0) / theory_medium_diffusion(&relax, 1.0);
  const double other = theory_medium_viscosity_kinetic(&replace) / theory_medium_viscosity_kinetic(&relax);
  assert_close(same, 1.0, 2e-6);
  assert_close(other, 1.25, 2e-6);
  model_free(&replace);
  model_free(&relax);
}

/* Sums of sqrt(6/(pi |i - j|)) a/b, with overlaps integrated numerically: digits of the ratio D_K/D0 at a/b = 1/4. */
static void kirkwood(void **unused)
{
  (void)unused;
  static const struct {
    uint32_t n;
    double oseen, rpy;
  } rows[] = {{2, 0.67275, 0.66271},  {4, 0.46557, 0.45569},  {5, 0.41493, 0.40587},  {8, 0.32653, 0.31948},
              {10, 0.29169, 0.28559}, {16, 0.23027, 0.22590}, {20, 0.20589, 0.20221}, {128, 0.08137, 0.08064}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    assert_close(theory_kirkwood(TENSOR_OSEEN, rows[k].n, 0.25), rows[k].oseen, 6e-6);
    assert_close(theory_kirkwood(TENSOR_RPY, rows[k].n, 0.25), rows[k].rpy, 6e-6);
    assert_close(theory_kirkwood(TENSOR_NONE, rows[k].n, 0.25), 1.0 / rows[k].n, 1e-15);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(lowe_andersen), cmocka_unit_test(dissipative_particles),
                                     cmocka_unit_test(what_tells_replacing_from_relaxing), cmocka_unit_test(kirkwood)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
