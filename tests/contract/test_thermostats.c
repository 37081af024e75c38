/* Every thermostat keeps the contract of mpc/thermostat.h, with every rule that may have one. */
#include "contract/contract.h"

static void over_thermostats(void (*check)(struct choice))
{
  for (int rule = 0; rule < RULES; rule++)
    for (int k = 0; k < THERMOSTATS; k++)
      if (contract_together(rule, k)) {
        print_message("  %s, %s\n", contract_rule(rule)->name, thermostat_of(k) ? thermostat_of(k)->name : "none");
        check((struct choice){.rule = rule, .thermostat = k});
        print_message("  the same in a plane\n");
        check((struct choice){.rule = rule, .thermostat = k, .flat = true});
      }
}

/* The first word means that there is none; all others are the rows' names. */
static void names_are_words(void **unused)
{
  (void)unused;
  int words;
  for (int k = 0; k < THERMOSTATS; k++) {
    const char *word = contract_word("solvent", "thermostat", k, &words);
    assert_int_equal(words, THERMOSTATS);
    assert_true((k == THERMOSTAT_NONE) == (thermostat_of(k) == NULL));
    assert_string_equal(word, thermostat_of(k) ? thermostat_of(k)->name : "none");
  }
}

static void momentum_is_kept(void **unused)
{
  (void)unused;
  over_thermostats(contract_momentum);
}

static void energy_is_kept_where_promised(void **unused)
{
  (void)unused;
  over_thermostats(contract_energy);
}

static void lone_members_are_left_alone(void **unused)
{
  (void)unused;
  over_thermostats(contract_lone);
}

static void flow_does_not_matter(void **unused)
{
  (void)unused;
  over_thermostats(contract_galilean);
}

static void temperature_is_one(void **unused)
{
  (void)unused;
  over_thermostats(contract_equipartition);
}

static void bits_are_the_same(void **unused)
{
  (void)unused;
  over_thermostats(contract_bits);
}

static void scratch_is_what_is_used(void **unused)
{
  (void)unused;
  over_thermostats(contract_scratch);
}

/* Factors are set where there are members to collide, and nowhere else is anything scaled; they are positive. */
static void factors_are_positive(void **unused)
{
  (void)unused;
  for (int k = 0; k < THERMOSTATS; k++)
    for (uint64_t round = 0; thermostat_of(k) && round < CONTRACT_ROUNDS; round++) {
      struct choice c = {.thermostat = k};
      while (c.rule < RULES && !contract_together(c.rule, k))
        c.rule++;
      struct one_collision x = collide_once(c, round, (struct vec3){0, 0, 0});
      for (uint32_t i = 0; i < x.run.work.mpc.cells; i++)
        if (x.old[i].n > 1)
          assert_true(isfinite(factor_of(&x, i)) && factor_of(&x, i) > 0.0);
      end_collision(&x);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(names_are_words),
      cmocka_unit_test(momentum_is_kept),
      cmocka_unit_test(energy_is_kept_where_promised),
      cmocka_unit_test(lone_members_are_left_alone),
      cmocka_unit_test(flow_does_not_matter),
      cmocka_unit_test(temperature_is_one),
      cmocka_unit_test(bits_are_the_same),
      cmocka_unit_test(scratch_is_what_is_used),
      cmocka_unit_test(factors_are_positive),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
