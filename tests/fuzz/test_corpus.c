/* What the fuzzer has kept, read once more, without a fuzzer: with what fuzz_readers.c asserts. Runs in the root of the
 * tree. */
#include "files/files.h"

#include "fuzz/fuzz_readers.c"

static void test_all_kept_inputs_are_borne(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  setenv("TMPDIR", folder, 1);
  assert_int_equal(LLVMFuzzerInitialize(NULL, NULL), 0);
  DIR *corpus = opendir("tests/fuzz/corpus");
  assert_non_null(corpus);
  unsigned readers[256] = {0};
  for (struct dirent *entry = readdir(corpus); entry; entry = readdir(corpus)) {
    char path[400];
    size_t bytes;
    snprintf(path, sizeof path, "tests/fuzz/corpus/%s", entry->d_name);
    if (entry->d_name[0] == '.')
      continue;
    char *data = slurp(path, &bytes);
    assert_int_equal(LLVMFuzzerTestOneInput((uint8_t *)data, bytes), 0);
    readers[(uint8_t)data[0]]++;
    free(data);
  }
  closedir(corpus);
  for (const char *c = "sokjctefpCEPKhHqrR"; *c; c++)
    print_message("  %u of reader %c\n", readers[(uint8_t)*c], *c);
  assert_true(readers['s'] > 100 && readers['c'] > 10 && readers['t'] > 10);
  for (const char *c = "okjefpCEPKhHqrR"; *c; c++)
    if (readers[(uint8_t)*c] < 3)
      fail_msg("reader %c has only %u inputs", *c, readers[(uint8_t)*c]);
  end();
  remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_all_kept_inputs_are_borne)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
