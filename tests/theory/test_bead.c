/* Friction of a bead: numbers worked out by hand, and limits. */
#include "support.h"
#include "theory/bead.h"
#include "theory/flow.h"
#include "theory/theory.h"

static void frictions_by_hand(void **unused)
{
  (void)unused;
  assert_close(theory_bead_stokes(2.5, 3.0), 141.37166941154069, 1e-12);                 /* 45 pi */
  assert_close(theory_bead_enskog(5.0, 3.0, 1e18), 601.59078591144006, 1e-7);            /* 240 sqrt(2 pi) */
  assert_close(theory_bead_enskog(5.0, 3.0, 1.0), 601.59078591144006 / sqrt(2.0), 1e-7); /* as heavy as a particle */
  /* x = 0.1: 1 - 0.2837297 + 0.0041887902 - 0.0000274 = 0.7204316902 */
  assert_close(theory_bead_box(1.5, 15.0), 1.0 / 0.7204316902, 1e-9);
  assert_close(theory_bead_box(1e-9, 1.0), 1.0, 1e-8);
}

/* x = 1/2, in fractions: 1 - 9/32 + 1/64 - 45/4096 - 1/512 = 2955/4096. In the middle 1 - 0.502 + 0.05225 + 0.013125 -
 * 0.00528125 = 0.55809375, at a quarter 1 - 0.3263 + 0.0184375 - 0.0081875 - 0.0020125 = 0.6819375. */
static void walls_by_hand(void **unused)
{
  (void)unused;
  assert_close(theory_bead_wall(1.5, 3.0), 4096.0 / 2955.0, 1e-14);
  assert_close(theory_bead_middle(1.5, 6.0), 1.0 / 0.55809375, 1e-13);
  assert_close(theory_bead_quarter(1.5, 12.0), 1.0 / 0.6819375, 1e-13);
  assert_close(theory_bead_slit(1.5, 3.0, 6.0), 2.0 * 4096.0 / 2955.0 - 1.0, 1e-14);
  assert_close(theory_bead_slit(1.5, 3.0, 1e12), 4096.0 / 2955.0, 1e-9);
}

/* No slip: R. Perfect slip: Stokes's 4 pi eta R, 2/3 of R. A small slip takes b off. */
static void slip_makes_a_bead_smaller(void **unused)
{
  (void)unused;
  assert_close(theory_bead_radius(3.0, 0.0), 3.0, 0.0);
  assert_close(theory_bead_radius(3.0, 1e12), 2.0, 1e-9);
  assert_close(theory_bead_radius(3.0, 1e-6), 3.0 - 1e-6, 1e-11);
}

/* Of a model: the slip of a flat wall in the same solvent, and none where its formula would be negative. */
static void a_model_has_the_slip_of_its_solvent(void **unused)
{
  (void)unused;
  struct model m = test_model(12, 12, 12, 5.0, 0.1, 1);
  m.bead.radius = 2.0;
  test_finish(&m);
  const double slip = theory_slip_length(collision_rule_of(&m), 3, 5.0, m.solvent.cosine, 0.1);
  const double eta = theory_viscosity(collision_rule_of(&m), 3, 5.0, m.solvent.cosine, 0.1);
  assert_true(slip > 0.05 && slip < 0.2);
  assert_close(theory_model_bead_slip(&m), slip, 1e-14);
  assert_close(theory_model_bead_friction(&m),
               6.0 * 3.14159265358979323846 * eta * 2.0 * (2.0 + 2.0 * slip) / (2.0 + 3.0 * slip), 1e-10);
  m.time_step = 1.0, m.solvent.collision_interval = 1.0;
  assert_true(theory_model_bead_slip(&m) == 0.0);
  model_free(&m);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frictions_by_hand),
      cmocka_unit_test(walls_by_hand),
      cmocka_unit_test(slip_makes_a_bead_smaller),
      cmocka_unit_test(a_model_has_the_slip_of_its_solvent),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
