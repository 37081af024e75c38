/* Events by components, in random orders: a million and more (contact/schedules.h). */
#include "stress.h"

#include "contact/schedules.h"

static void components_in_any_order(void **unused)
{
  (void)unused;
  judge_schedules(dice_seed(2950), scaled_count(160000));
}

int main(int argc, char **argv)
{
  stress_arguments(argc, argv);
  const struct CMUnitTest tests[] = {cmocka_unit_test(components_in_any_order)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
