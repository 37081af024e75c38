/* Every medium with velocities keeps the Maxwell distribution at kT = 1 for all masses, with every draw, and every
 * weight that it takes. (That its bits do not depend on the order in memory is in tests/contract/test_media.c.) */
#include "contract/contract.h"

/* Overdamped motion has no velocities. A weight and a draw are independent factors, so both are varied at once. */
static void equipartition(struct choice c)
{
  if (c.medium != MEDIUM_OVERDAMPED && c.weight == (c.medium == MEDIUM_PAIRS ? c.draw % MEDIUM_WEIGHTS : 0))
    contract_equipartition(c);
}

static void temperature_is_one(void **unused)
{
  (void)unused;
  contract_over_media(equipartition);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(temperature_is_one)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
