/* Chains without bending stiffness, and springs of no rest length, under the rule `event-driven`: a bond that is caught
 * between two bonds of a folded chain touches them many times in a drift. The queue never ends in a fault, and no step
 * is without end. */
#include "stress.h"

#include "contact/folded.h"

static void folded_chains(void **unused)
{
  (void)unused;
  for (int k = 0; k < FOLDED; k++) {
    const struct folded_tally t = fold(&folded[k], dice_seed(2951), scaled_count(20000));
    tell_folded(folded[k].name, &t);
    fflush(stdout);
    assert_true(t.contacts > 0);
  }
}

int main(int argc, char **argv)
{
  stress_arguments(argc, argv);
  const struct CMUnitTest tests[] = {cmocka_unit_test(folded_chains)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
