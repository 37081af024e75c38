/* The search for contacts of tubes at length: 10^7 queries that are made to be hard (contact/tubes.h), each answer
 * against polynomials over the integers (contact/exact_tubes.h). A quarter of an hour; the table is in tests/README.md.
 */
#include "stress.h"

#include "contact/exact_tube_audit.h"

static void no_contact_is_late_and_none_invented(void **unused)
{
  (void)unused;
  const uint64_t seed = dice_seed(2911);
  const struct exact_tally t = audit_tubes_exactly(seed, scaled_count(680000));
  if (t.missed + t.invented + t.open > 0)
    fail_msg("seed %lu: %lu missed, %lu invented, %lu open", (unsigned long)seed, (unsigned long)t.missed,
             (unsigned long)t.invented, (unsigned long)t.open);
  assert_true(t.contacts > t.queries / 4);
}

int main(int argc, char **argv)
{
  stress_arguments(argc, argv);
  const struct CMUnitTest tests[] = {cmocka_unit_test(no_contact_is_late_and_none_invented)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
