/* Events by components, in random orders (contact/schedules.h). `make stress` does the same for a million events. */
#include "contact/schedules.h"

static void components_in_any_order(void **unused)
{
  (void)unused;
  judge_schedules(dice_seed(1803), 1500);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(components_in_any_order)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
