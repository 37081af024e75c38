/* The interval search of contact/flight.h, against exact arithmetic that shares no code with it. `make stress` runs the
 * same for longer. */
#include "contact/flights.h"

static void contacts_by_construction(void **unused)
{
  (void)unused;
  audit_contacts(dice_seed(1601), 1500);
}

static void near_contacts(void **unused)
{
  (void)unused;
  audit_near_contacts(dice_seed(1602), 1000);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(contacts_by_construction),
      cmocka_unit_test(near_contacts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
