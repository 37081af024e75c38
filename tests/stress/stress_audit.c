/* The exact audit at length: 4.5 million adversarial moves, two million moves of dense suspensions against all partners
 * and images, a million stacks of a few bonds that hit each other (contact/adversarial.h). Some minutes. */
#include "stress.h"

#include "contact/adversarial.h"

static void adversarial_moves(void **unused)
{
  (void)unused;
  audit_families(dice_seed(2501), scaled_count(500000));
}

static void dense_sweeps(void **unused)
{
  (void)unused;
  audit_sweeps(dice_seed(2502), scaled_count(300));
}

static void brawls(void **unused)
{
  (void)unused;
  audit_brawls(dice_seed(2503), scaled_count(1000000));
}

int main(int argc, char **argv)
{
  stress_arguments(argc, argv);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(adversarial_moves),
      cmocka_unit_test(dense_sweeps),
      cmocka_unit_test(brawls),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
