/* What must be on the disk is waited for: each call that could fail is made, and its failure is told. */
#include "files/files.h"

#include "faults/inject.h"
#include "files/folder.h"
#include "files/table.h"

/* What is synced or put in place. */
struct bench {
  struct series series;
  struct trajectory *trajectory;
  const char *path;
};

/* Each fails at call n to the system. */
static bool try_series(struct bench *b, uint64_t n)
{
  struct message m;
  inject_arm(INJECT_FILE, n, false);
  return series_row(&b->series, n, 1, (double[]){0.5}, &m) && series_sync(&b->series, &m);
}

static bool try_trajectory(struct bench *b, uint64_t n)
{
  struct message m;
  inject_arm(INJECT_FILE, n, false);
  return trajectory_sync(b->trajectory, &m);
}

/* The old file or the new one, and no part beside it. */
static bool try_replace(struct bench *b, uint64_t n)
{
  struct message m = {.text = ""};
  spill(b->path, "old", 3);
  inject_arm(INJECT_FILE, n, false);
  const bool ok = file_replace(by_name(""), b->path, "new!", 4, &m);
  inject_disarm();
  size_t bytes;
  char *found = slurp(b->path, &bytes), part[160];
  assert_string_equal(found, ok ? "new!" : "old");
  assert_true(ok || strstr(m.text, b->path));
  snprintf(part, sizeof part, "%s.part", b->path);
  assert_false(is_there(part));
  free(found);
  return ok;
}

static const struct {
  const char *name;
  bool (*act)(struct bench *b, uint64_t n);
  unsigned failures; /* of how many calls are told, at least */
} tries[] = {
    {"series_row, series_sync: flush, flush, sync", try_series, 3},
    {"trajectory_sync: sync", try_trajectory, 1},
    {"file_replace: open, write, sync, close, rename", try_replace, 5},
};

static void test_failures_are_told(void **unused)
{
  (void)unused;
  static const char *const names[] = {"a"};
  const struct trajectory_options options = {.solvent = true, .velocities = true, .seed = 1};
  char folder[64];
  struct message m;
  make_folder(folder);
  struct test_run run = small_run(1);
  struct bench b = {.path = in_folder(folder, "f")};
  assert_true(series_open(&b.series, by_name(folder), "t", 1, names, 0, &m));
  b.trajectory = trajectory_open(in_folder(folder, "t.h5"), &run.model, &options, false, 0, "", &m);
  assert_non_null(b.trajectory);
  for (size_t k = 0; k < sizeof tries / sizeof *tries; k++) {
    unsigned failures = 0;
    for (uint64_t n = 1; n < 20; n++) {
      failures += !tries[k].act(&b, n);
      inject_disarm();
    }
    if (failures < tries[k].failures)
      fail_msg("%s: only %u failures were told", tries[k].name, failures);
  }
  assert_true(series_close(&b.series, &m) && trajectory_close(b.trajectory, &m));
  test_end(&run);
  remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_failures_are_told)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
