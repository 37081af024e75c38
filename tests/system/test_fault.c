/* What is said of each fault: where it was, what was found, what is allowed. */
#include "support.h"

static const struct {
  struct fault fault;
  const char *says[4];
} faults[] = {
    {{FAULT_NONE, 0, 0, 0.0, 0.0}, {"nothing wrong"}},
    {{FAULT_SOLVENT_MOVE, 12, 34, 5678.5, 2048.0},
     {"step 12:", "solvent particle 34 ", "5678.5 a0", "2048 is allowed"}},
    {{FAULT_SOLVENT_SPEED, 12, 35, 7e6, 524288.0},
     {"step 12:", "solvent particle 35 ", "7000000 m a0/t0", "524288 is"}},
    {{FAULT_VERTEX_SPEED, 13, 36, 8e6, 524288.0}, {"step 13:", "vertex 36 ", "8000000 m a0/t0", "524288 is"}},
    {{FAULT_SOLVENT_ENERGY, 14, 37, 1e9, 1e8},
     {"step 14:", "solvent particle 37 ", "1e+09 m a0^2/t0^2", "at most 1e+08 is allowed"}},
    {{FAULT_VERTEX_ENERGY, 15, 38, 2e9, 1e8}, {"step 15:", "vertex 38 ", "2e+09 m a0^2/t0^2", "1e+08 is allowed"}},
    {{FAULT_CELL_MASS, 7, 99, 3e6, 1e5}, {"step 7:", "cell 99 ", "3000000 m;", "100000 is allowed"}},
    {{FAULT_VERTEX_MOVE, 5, 6, 8.25, 4.0}, {"step 5:", "vertex 6 ", "8.25 a0", "4 is allowed (a time step"}},
    {{FAULT_VERTEX_PLACE, 1024, 7, 2097153.0, 2097152.0},
     {"step 1024:", "vertex 7 ", "2097153 a0;", "2097152 is allowed"}},
    {{FAULT_BOND_TOO_LONG, UINT64_MAX, 41, 4.5, 4.0}, {"step 18446744073709551615:", "bond 41 ", "4.5 a0", "4 is"}},
    {{FAULT_VERTEX_WALL, 2, 8, -0.001, 8.0}, {"step 2:", "vertex 8 ", "y = -0.001 a0;", "0 to 8 is allowed"}},
    {{FAULT_SOLVENT_PLACE, 2, 9, -0.5, 8.0}, {"solvent particle 9 ", "-0.5 a0;", "0 to 8 is allowed"}},
    {{FAULT_BEAD_WALL, 2, 0, 1.25, 1.5}, {"step 2:", "bead 0 ", "1.25 a0;", "at least 1.5 is allowed"}},
    {{FAULT_IN_BEAD, 2, 10, 1.25, 1.5}, {"solvent particle 10 ", "1.25 a0;", "at least 1.5 is allowed"}},
    {{FAULT_NO_MEMORY, 3, 0, 0.0, 0.0}, {"step 3:", "memory is short"}},
};

static void test_each_fault_is_told_with_its_numbers(void **unused)
{
  (void)unused;
  for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
    char text[512] = "";
    fault_describe(&faults[k].fault, text, sizeof text);
    for (int i = 0; i < 4 && faults[k].says[i]; i++)
      if (!strstr(text, faults[k].says[i]))
        fail_msg("fault %d: '%s' is not in '%s'", faults[k].fault.code, faults[k].says[i], text);
  }
}

static void test_a_small_buffer_is_not_overrun(void **unused)
{
  (void)unused;
  char text[16];
  memset(text, 'x', sizeof text);
  fault_describe(&faults[1].fault, text, 8);
  assert_int_equal(text[7], '\0');
  assert_int_equal(text[8], 'x');
}

static void test_the_first_fault_counts(void **unused)
{
  (void)unused;
  struct work work;
  memset(&work, 0, sizeof work);
  assert_false(fault_record(&work.fault, FAULT_VERTEX_MOVE, 5, 6, 8.25, 4.0));
  assert_false(fault_record(&work.fault, FAULT_NO_MEMORY, 6, 7, 1.0, 2.0));
  assert_int_equal(work.fault.code, FAULT_VERTEX_MOVE);
  assert_int_equal(work.fault.step, 5);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_each_fault_is_told_with_its_numbers),
      cmocka_unit_test(test_a_small_buffer_is_not_overrun),
      cmocka_unit_test(test_the_first_fault_counts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
