/* Arrays begin with a cache line and are zero, whatever stood there before; what cannot be had is not half given. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "support.h"

static void zero_and_aligned(void **unused)
{
  (void)unused;
  const size_t sizes[] = {0,
                          1,
                          63,
                          64,
                          65,
                          4096,
                          100000,
                          (size_t)1 << 20,
                          (size_t)3 << 20,
                          (size_t)16 << 20,
                          ((size_t)16 << 20) + 1,
                          (size_t)40 << 20};
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
    for (int again = 0; again < 2; again++) { /* the second time in what the first left behind */
      unsigned char *p = memory_alloc(sizes[k], 1);
      assert_non_null(p);
      assert_true((uintptr_t)p % 64 == 0);
      for (size_t i = 0; i < sizes[k]; i++)
        assert_true(p[i] == 0);
      memset(p, 0xff, sizes[k]);
      free(p);
    }
}

/* Arrays of half a large page and more begin with one: else none of them is ever in a large page. */
static void large_ones_begin_with_a_large_page(void **unused)
{
  (void)unused;
  const size_t page = (size_t)2 << 20, sizes[] = {page / 2, page - 1, page, page + page / 2, 9 * page + 1};
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
    void *p = memory_alloc(sizes[k], 1);
    assert_non_null(p);
    assert_true((uintptr_t)p % page == 0);
    free(p);
  }
}

static void too_much_is_nothing(void **unused)
{
  (void)unused;
  assert_null(memory_alloc(SIZE_MAX / 2, 3));    /* the product wraps to something small */
  assert_null(memory_alloc(SIZE_MAX - 63, 1));   /* rounded up, it would wrap */
  assert_null(memory_alloc((size_t)1 << 60, 8)); /* fits a number, but no machine */
}

static void lists_double_and_keep(void **unused)
{
  (void)unused;
  void *list = NULL;
  uint32_t room = 0;
  assert_true(memory_double(&list, &room, 3, sizeof(uint32_t)));
  assert_int_equal(room, 3);
  uint32_t *at = list;
  for (uint32_t k = 0; k < 3; k++)
    at[k] = 70 + k;
  assert_true(memory_double(&list, &room, 3, sizeof(uint32_t)));
  assert_int_equal(room, 6);
  at = list;
  for (uint32_t k = 0; k < 3; k++)
    assert_int_equal(at[k], 70 + k);
  uint32_t full = UINT32_C(1) << 31; /* twice that is no number of 32 bits */
  assert_false(memory_double(&list, &full, 3, 1));
  assert_ptr_equal(list, at);
  assert_int_equal(full, UINT32_C(1) << 31);
  assert_false(memory_double(&list, &room, 3, SIZE_MAX / 4)); /* the product wraps */
  assert_ptr_equal(list, at);
  assert_int_equal(room, 6);
  free(list);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(zero_and_aligned),
      cmocka_unit_test(large_ones_begin_with_a_large_page),
      cmocka_unit_test(too_much_is_nothing),
      cmocka_unit_test(lists_double_and_keep),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
