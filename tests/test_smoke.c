/* A small dense suspension steps without fault. */
#include "support.h"

static void suspension_steps(void **unused)
{
  (void)unused;
  struct model m = test_model(8, 8, 8, 5, 0.01, 2);
  test_add_kind(&m, 20, 16);
  struct test_run r = test_start(m);
  test_steps(&r, 50);
  assert_true(r.state.step == 50);
  test_end(&r);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(suspension_steps)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
