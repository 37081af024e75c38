/* Whole drifts of the rule `event-driven`, audited by brute force (flight_replay.h). `make stress` runs the same for
 * longer. */
#include "contact/flight_replay.h"

static void dense_suspensions(void **unused)
{
  (void)unused;
  for (int k = 0; k < REPLAYED; k++)
    replay_suspensions(dice_seed(1801), &replayed[k], 6);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(dense_suspensions),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
