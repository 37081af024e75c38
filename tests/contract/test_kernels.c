/* Every kernel keeps the contract of mpc/kernel.h: with each choice of rows that a model may have, a run by it ends in
 * the state of the run by the plain kernel. tests/kernel/ compares each part, and what is rare. */
#include "contract/contract.h"
#include "kernel/choose.h"

/* Enough for both halves of a step without a collision and of one with it, many times. */
enum { STEPS = 20 };

static struct test_run run_by(struct model model, const struct kernel *kernel)
{
  struct test_run r = test_start(model);
  r.work.mpc.kernel = kernel_mix(kernel, &r.model);
  test_steps(&r, STEPS);
  return r;
}

static uint32_t compared;

static void compare(struct model (*make)(struct choice), struct choice c)
{
  struct test_run plain = run_by(make(c), &kernel_plain);
  for (size_t k = 0; k < kernel_row_count; k++)
    if (kernel_rows[k].runs()) {
      struct test_run fast = run_by(make(c), kernel_rows[k].kernel);
      assert_same_state(&plain, &fast, kernel_rows[k].kernel->name);
      test_end(&fast);
      compared++;
    }
  test_end(&plain);
}

static void compare_if_accepted(struct choice c)
{
  struct model m = contract_scene(c);
  struct model_error error;
  const bool accepted = model_finish(&m, &error);
  model_free(&m);
  if (accepted) {
    compare(contract_scene, c);
    compare(contract_gas, c);
  }
}

/* Bits of an index: what else a choice may be. */
static struct choice with(struct choice c, uint32_t bits)
{
  c.flat = bits & 1;
  c.permuted = bits & 2;
  c.fluid = bits & 4 ? FLUID_DUMBBELLS : c.fluid;
  return c;
}

static void every_choice_ends_in_the_same_state(void **unused)
{
  (void)unused;
  for (int rule = 0; rule < RULES; rule++)
    for (int thermostat = 0; thermostat < THERMOSTATS; thermostat++)
      for (int bath = 0; bath < BATHS; bath++)
        for (uint32_t bits = 0; bits < 8; bits++)
          compare_if_accepted(with((struct choice){.rule = rule, .thermostat = thermostat, .bath = bath}, bits));
  print_message("  %u runs compared with those of the plain kernel\n", compared);
  assert_true(compared > 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(every_choice_ends_in_the_same_state)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
