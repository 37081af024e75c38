/* Every bath keeps the contract of collision rules (mpc/rule.h), with every rule. */
#include "contract/contract.h"

static void over_baths(void (*check)(struct choice))
{
  for (int rule = 0; rule < RULES; rule++)
    for (int bath = 0; bath < BATHS; bath++) {
      print_message("  %s, bath %d\n", contract_rule(rule)->name, bath);
      check((struct choice){.rule = rule, .bath = bath});
    }
}

static void every_bath_has_a_word(void **unused)
{
  (void)unused;
  int words;
  for (int bath = 0; bath < BATHS; bath++)
    assert_non_null(contract_word("solvent", "bath", bath, &words));
  assert_int_equal(words, BATHS);
}

static void momentum_is_kept(void **unused)
{
  (void)unused;
  over_baths(contract_momentum);
}

static void energy_is_kept_where_promised(void **unused)
{
  (void)unused;
  over_baths(contract_energy);
}

static void lone_members_are_left_alone(void **unused)
{
  (void)unused;
  over_baths(contract_lone);
}

static void flow_does_not_matter(void **unused)
{
  (void)unused;
  over_baths(contract_galilean);
}

static void temperature_is_one(void **unused)
{
  (void)unused;
  over_baths(contract_equipartition);
}

static void bits_are_the_same(void **unused)
{
  (void)unused;
  over_baths(contract_bits);
}

static void scratch_is_what_is_used(void **unused)
{
  (void)unused;
  over_baths(contract_scratch);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_bath_has_a_word),
      cmocka_unit_test(momentum_is_kept),
      cmocka_unit_test(energy_is_kept_where_promised),
      cmocka_unit_test(lone_members_are_left_alone),
      cmocka_unit_test(flow_does_not_matter),
      cmocka_unit_test(temperature_is_one),
      cmocka_unit_test(bits_are_the_same),
      cmocka_unit_test(scratch_is_what_is_used),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
