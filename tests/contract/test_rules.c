/* Every collision rule keeps the contract of mpc/rule.h. */
#include "contract/contract.h"
#include "theory/chaos.h"

static void over_rules(void (*check)(struct choice))
{
  for (int rule = 0; rule < RULES; rule++) {
    print_message("  %s\n", contract_rule(rule)->name);
    check((struct choice){.rule = rule});
    print_message("  %s in a plane\n", contract_rule(rule)->name);
    check((struct choice){.rule = rule, .flat = true});
  }
}

/* The key's word is the row's name. With one rule there need be no key. */
static void names_are_words(void **unused)
{
  (void)unused;
  int words;
  for (int rule = 0; rule < RULES; rule++) {
    const char *word = contract_word("solvent", "rule", rule, &words);
    const struct model m = {.solvent.rule = rule};
    assert_non_null(contract_rule(rule));
    assert_true(model_rule_is_thermal(&m) == contract_rule(rule)->thermal);
    assert_true(words == RULES || (words == 0 && RULES == 1));
    if (word)
      assert_string_equal(word, contract_rule(rule)->name);
  }
}

static void momentum_is_kept(void **unused)
{
  (void)unused;
  over_rules(contract_momentum);
}

static void energy_is_kept_where_promised(void **unused)
{
  (void)unused;
  over_rules(contract_energy);
}

static void permuted_velocities_keep_all(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < RULES; rule++) {
    contract_momentum((struct choice){.rule = rule, .permuted = true});
    contract_energy((struct choice){.rule = rule, .permuted = true});
    contract_bits((struct choice){.rule = rule, .permuted = true});
    contract_scratch((struct choice){.rule = rule, .permuted = true});
  }
}

static void lone_members_are_left_alone(void **unused)
{
  (void)unused;
  over_rules(contract_lone);
}

static void flow_does_not_matter(void **unused)
{
  (void)unused;
  over_rules(contract_galilean);
}

static void temperature_is_one(void **unused)
{
  (void)unused;
  over_rules(contract_equipartition);
}

static void bits_are_the_same(void **unused)
{
  (void)unused;
  over_rules(contract_bits);
}

static void scratch_is_what_is_used(void **unused)
{
  (void)unused;
  over_rules(contract_scratch);
}

/* In a plane nothing leaves it. */
static void plane_is_kept(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < RULES; rule++) {
    struct test_run r = test_start(contract_scene((struct choice){.rule = rule, .flat = true}));
    test_steps(&r, 20);
    for (uint32_t i = 0; i < r.state.solvent.n; i++)
      assert_true(r.state.solvent.z[i] == 0 && r.state.solvent.vz[i] == 0.0 && !signbit(r.state.solvent.vz[i]));
    for (uint32_t v = 0; v < r.state.vertices; v++)
      assert_true(r.state.position[v].z == 0 && r.state.velocity[v].z == 0.0);
    test_end(&r);
  }
}

/* A thermal rule is a thermostat. */
static void thermal_rules_have_no_thermostat(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < RULES; rule++)
    for (int k = 0; k < THERMOSTATS; k++)
      assert_true(contract_accepts((struct choice){.rule = rule, .thermostat = k}) == contract_together(rule, k));
}

/* What theory knows of a row: losses are shares of what is there, in both dimensions. */
static void losses_are_shares(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < RULES; rule++)
    for (double cosine = -1.0; cosine <= 0.99; cosine += 0.01)
      for (uint32_t d = 2; d <= 3; d++)
        for (double n = 1.0; n <= 16.0; n *= 2.0) {
          const struct chaos *row = chaos_of(contract_rule(rule));
          assert_true(row->velocity_loss(cosine, d, 2.5, 0) == 0.0);
          assert_true(row->velocity_loss(cosine, d, 1.0, (uint32_t)n) > 0.0);
          assert_true(row->velocity_loss(cosine, d, 1.0, (uint32_t)n) <= 2.0);
          assert_true(row->velocity_loss(cosine, d, 5.0, 3) < row->velocity_loss(cosine, d, 1.0, 3));
          assert_true(row->stress_loss(cosine, d, n) >= -1e-12 && row->stress_loss(cosine, d, n) <= 2.0);
          assert_true(row->handed_on(cosine, d, n) > 0.0 && row->handed_on(cosine, d, n) <= n);
        }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(names_are_words),
      cmocka_unit_test(momentum_is_kept),
      cmocka_unit_test(energy_is_kept_where_promised),
      cmocka_unit_test(permuted_velocities_keep_all),
      cmocka_unit_test(lone_members_are_left_alone),
      cmocka_unit_test(flow_does_not_matter),
      cmocka_unit_test(temperature_is_one),
      cmocka_unit_test(bits_are_the_same),
      cmocka_unit_test(scratch_is_what_is_used),
      cmocka_unit_test(plane_is_kept),
      cmocka_unit_test(thermal_rules_have_no_thermostat),
      cmocka_unit_test(losses_are_shares),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
