/* Every decision of adversarial single moves, and of whole sweeps of dense suspensions, judged by exact integers
 * (adversarial.h). `make stress` runs the same for longer. */
#include "contact/adversarial.h"

static void adversarial_moves(void **unused)
{
  (void)unused;
  audit_families(dice_seed(1501), 30000);
}

static void dense_sweeps(void **unused)
{
  (void)unused;
  audit_sweeps(dice_seed(1502), 12);
}

static void brawls(void **unused)
{
  (void)unused;
  audit_brawls(dice_seed(1503), 10000);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(adversarial_moves),
      cmocka_unit_test(dense_sweeps),
      cmocka_unit_test(brawls),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
