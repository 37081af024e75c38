/* Every medium keeps what all baths promise: the same bits whatever the order in memory, with every draw, and every
 * weight that it takes. The Maxwell distribution is in tests/physics/test_media.c. */
#include "contract/contract.h"

static void every_row_has_a_word(void **unused)
{
  (void)unused;
  int words;
  for (int medium = MEDIUM_PRIVATE; medium < MEDIA; medium++)
    assert_non_null(contract_word("medium", "kind", medium, &words));
  assert_int_equal(words, MEDIA - MEDIUM_PRIVATE);
  for (int draw = 0; draw < MEDIUM_DRAWS; draw++)
    assert_string_equal(contract_word("medium", "draw", draw, &words), bath_draw_of((enum medium_draw)draw)->name);
  assert_int_equal(words, MEDIUM_DRAWS);
  for (int weight = 0; weight < MEDIUM_WEIGHTS; weight++)
    assert_non_null(contract_word("medium", "weight", weight, &words));
  assert_int_equal(words, MEDIUM_WEIGHTS);
}

static void bits_are_the_same(void **unused)
{
  (void)unused;
  contract_over_media(contract_bits);
}

/* The same with forces of pairs, in every order of a step. */
static void forces_have_the_same_bits(void **unused)
{
  (void)unused;
  for (int scheme = 0; scheme < SCHEMES; scheme++)
    contract_bits((struct choice){.medium = MEDIUM_PAIRS,
                                  .repels = true,
                                  .crossing = scheme == 0 ? CROSSING_SEQUENTIAL : CROSSING_FREE,
                                  .scheme = (enum scheme)scheme});
}

static void scratch_is_what_is_used(void **unused)
{
  (void)unused;
  for (int medium = MEDIUM_PRIVATE; medium < MEDIA; medium++) {
    contract_scratch_of(contract_scene((struct choice){.medium = medium}));
    contract_scratch_of(contract_gas((struct choice){.medium = medium}));
    if (medium == MEDIUM_PAIRS)
      contract_scratch_of(contract_scene((struct choice){.medium = medium, .repels = true}));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_row_has_a_word),
      cmocka_unit_test(bits_are_the_same),
      cmocka_unit_test(forces_have_the_same_bits),
      cmocka_unit_test(scratch_is_what_is_used),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
