/* Tables: numbers that read back exactly, rows cut at a resume, disks that are full, folders and records of runs. */
#include "files/files.h"

#include <errno.h>
#include <fcntl.h>
#include <unistd.h>

#include "base/clock.h"
#include "cli/progress.h"
#include "files/folder.h"
#include "files/lock.h"
#include "files/table.h"

static const char *const names[] = {"a", "b"};

static void write_rows(const char *folder, uint64_t first, uint64_t last, bool resume)
{
  struct series s;
  struct message m;
  assert_true(series_open(&s, by_name(folder), "t", 2, names, resume ? first : 0, &m));
  for (uint64_t step = first; step <= last; step++)
    assert_true(series_row(&s, step, 2, (double[]){0.1 * (double)step, -1e-300}, &m));
  assert_true(series_sync(&s, &m));
  assert_true(series_close(&s, &m));
}

static void test_numbers_read_back_to_the_last_bit(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct series s;
  struct message m;
  const double written[2] = {1.0 / 3.0, 5e-324};
  double a, b;
  assert_true(series_open(&s, by_name(folder), "t", 2, names, 0, &m));
  assert_true(series_row(&s, 18446744073709551615u, 2, written, &m));
  assert_true(series_close(&s, &m));
  size_t bytes;
  char *text = slurp(in_folder(folder, "t.csv"), &bytes);
  assert_int_equal(sscanf(text, "step,a,b\n18446744073709551615,%lf,%lf\n", &a, &b), 2);
  assert_true(a == written[0] && b == written[1]);
  free(text);
  remove_folder(folder);
}

/* Rows after the checkpoint, and a last row that was cut in the middle, are made again. */
static void test_a_resume_keeps_what_the_checkpoint_knows(void **unused)
{
  (void)unused;
  static const char *const tails[] = {"", "8,0.5", "7,0.7,1\n8,"};
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "t.csv");
  write_rows(folder, 1, 9, false);
  size_t bytes, again;
  char *expected = slurp(path, &bytes);
  for (size_t k = 0; k < sizeof tails / sizeof *tails; k++) {
    remove(path);
    write_rows(folder, 1, 7, false);
    FILE *file = fopen(path, "a");
    fputs(tails[k], file);
    fclose(file);
    write_rows(folder, 6, 9, true);
    char *found = slurp(path, &again);
    assert_int_equal(again, bytes);
    assert_memory_equal(found, expected, bytes);
    free(found);
  }
  free(expected);
  remove_folder(folder);
}

/* Up to what it is whole before a step: rows that a crash of the machine left out, cut or overwrote do not count. */
static void test_where_a_table_ends(void **unused)
{
  (void)unused;
  static const struct {
    const char *text;
    uint64_t found; /* before step 8 */
  } tables[] = {{NULL, 0},
                {"", 0},
                {"st", 0},
                {"step,a,b\n", 0},
                {"step,a,b\n0,1,2\n", 1},
                {"step,a,b\n0,1,2\n5,1,2\n10,1,2\n", 6},
                {"step,a,b\n0,1,2\n7,1,2\n8,1,2\n", 8},
                {"step,a,b\n0,1,2\n5,1,", 1},
                {"step,a,b\n0,1,2\n5,1,2\n5,1,2\n6,1,2\n", 6},
                {"step,a,b\n0,1,2\n?0,1,2\n5,1,2\n", 1}, /* ?: a NUL */
                {"step,a,b\n0,1,2\n3,1,??\n5,1,2\n", 1},
                {"step,a,b\n0,1,2\n3,1?,2\n", 1},
                {"step,a,b\n0,1,2\n3,1\n", 1},
                {"step,a,b\n0,1,2\n3,1,2,3\n", 1},
                {"step,a,b\n0,1,2\n3,1,x\n", 1},
                {"step,a,b\n0,nan,-inf\n3,1e-300,2\n", 4},
                {"step,a,c\n0,1,2\n", 0},
                {"????,a,b\n0,1,2\n", 0},
                {"step,a,b,c\n0,1,2\n", 0},
                {"step,a\n0,1,2\n", 0}};
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "t.csv");
  for (size_t k = 0; k < sizeof tables / sizeof *tables; k++) {
    char bytes[64];
    struct message m;
    uint64_t found = 99;
    if (tables[k].text) {
      const size_t length = strlen(tables[k].text);
      for (size_t i = 0; i < length; i++)
        bytes[i] = tables[k].text[i] == '?' ? '\0' : tables[k].text[i];
      spill(path, bytes, length);
    }
    assert_true(series_find_end(by_name(folder), "t", 2, names, 8, &found, &m));
    if (found != tables[k].found)
      fail_msg("table %zu ends at %u instead of %u", k, (unsigned)found, (unsigned)tables[k].found);
  }
  remove_folder(folder);
}

static void test_what_cannot_be_opened_is_not_written_over(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct series s;
  struct message m;
  const char *path = in_folder(folder, "t.csv");
  assert_int_equal(mkdir(path, 0777), 0);
  uint64_t found;
  assert_false(series_open(&s, by_name(folder), "t", 2, names, 4, &m));
  assert_non_null(strstr(m.text, "t.csv: cannot open"));
  assert_false(series_open(&s, by_name(folder), "t", 2, names, 0, &m));
  assert_non_null(strstr(m.text, "t.csv: cannot create"));
  assert_false(series_find_end(by_name(folder), "t", 2, names, 4, &found, &m));
  assert_non_null(strstr(m.text, "t.csv: cannot open: Is a directory"));
  rmdir(path);
  write_rows(folder, 1, 2, false);
  assert_false(series_open(&s, by_name(folder), "t", 2, names, 0, &m)); /* nor begun anew */
  assert_non_null(strstr(m.text, "t.csv: cannot create: File exists"));
  remove_folder(folder);
}

static void test_a_full_disk_is_noticed(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct series s;
  struct message m = {.text = ""};
  const double row[2] = {1.0 / 3.0, 2.0 / 3.0};
  assert_true(series_open(&s, by_name(folder), "t", 2, names, 0, &m));
  limit_files(64);
  assert_true(series_row(&s, 1, 2, row, &m));
  assert_false(series_row(&s, 2, 2, row, &m)); /* nothing waits in a buffer */
  assert_non_null(strstr(m.text, "t.csv: cannot write"));
  assert_false(series_sync(&s, &m));
  assert_non_null(strstr(m.text, "t.csv: cannot write"));
  assert_false(series_row(&s, 3, 2, row, &m));
  series_close(&s, &m);
  double many[80] = {0.1};
  const struct observe_table table = {.name = "sum", .columns = 2, .column = names, .rows = 40, .value = many};
  assert_false(table_write(by_name(folder), &table, &m));
  limit_files(RLIM_INFINITY);
  assert_non_null(strstr(m.text, "sum.csv: cannot write"));
  assert_false(is_there(in_folder(folder, "sum.csv")) || is_there(in_folder(folder, "sum.csv.part")));
  remove_folder(folder);
}

static void test_an_earlier_summary_survives_a_failure(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct message m;
  double value[4] = {1, 2, 3, 4};
  const struct observe_table table = {.name = "sum", .columns = 2, .column = names, .rows = 2, .value = value};
  assert_true(table_write(by_name(folder), &table, &m));
  assert_int_equal(mkdir(in_folder(folder, "sum.csv.part"), 0777), 0);
  assert_false(table_write(by_name(folder), &table, &m));
  assert_non_null(strstr(m.text, "sum.csv: cannot write"));
  size_t bytes;
  char *text = slurp(in_folder(folder, "sum.csv"), &bytes);
  assert_string_equal(text, "a,b\n1,2\n3,4\n");
  free(text);
  rmdir(in_folder(folder, "sum.csv.part"));
  remove_folder(folder);
}

/* --- folders ------------------------------------------------------------------------------------------------------ */

static void test_folders_are_made_with_those_above(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct message m;
  size_t made;
  assert_int_equal(folder_prepare(in_folder(folder, "a/b/c"), &made, &m), FOLDER_FINE);
  assert_int_equal(folder_prepare(in_folder(folder, "a/b/c/"), &made, &m), FOLDER_FINE);
  assert_true(folder_has(by_name(in_folder(folder, "a/b")), "c"));
  assert_false(folder_has(by_name(in_folder(folder, "a/b")), "d"));
  spill(in_folder(folder, "file"), "x", 1);
  assert_int_equal(folder_prepare(in_folder(folder, "file"), &made, &m), FOLDER_IS_NONE);
  assert_non_null(strstr(m.text, "is not a folder"));
  assert_int_equal(folder_prepare(in_folder(folder, "file/below"), &made, &m), FOLDER_IS_NONE);
  assert_non_null(strstr(m.text, "file"));
  assert_int_equal(folder_prepare("", &made, &m), FOLDER_IS_NONE);
  assert_non_null(strstr(m.text, "not the name of a folder"));
  /* and unmade: those that were made, unless something is in them */
  const char *deep = in_folder(folder, "a/b/d/e/");
  assert_int_equal(folder_prepare(deep, &made, &m), FOLDER_FINE);
  assert_int_equal(made, strlen(folder) + strlen("/a/b"));
  spill(in_folder(folder, "a/b/d/kept"), "x", 1);
  folder_unmake(deep, made);
  assert_false(is_there(in_folder(folder, "a/b/d/e")));
  remove(in_folder(folder, "a/b/d/kept"));
  folder_unmake(deep, made);
  assert_false(is_there(in_folder(folder, "a/b/d")));
  assert_true(is_there(in_folder(folder, "a/b/c")));
  folder_unmake(in_folder(folder, "a/b/c"), strlen(folder));
  assert_false(is_there(in_folder(folder, "a")));
  remove_folder(folder);
}

/* The open folder is found again wherever it is moved; what is in its place is another. */
static void test_an_open_folder_may_be_moved(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *here = in_folder(folder, "here"), *there = in_folder(folder, "there");
  struct message m;
  assert_int_equal(mkdir(here, 0777), 0);
  struct folder open = {here, FOLDER_BY_NAME};
  assert_true(folder_lock(&open, &m) && folder_in_place(&open, &m));
  assert_int_equal(rename(here, there), 0);
  assert_false(folder_in_place(&open, &m));
  assert_non_null(strstr(m.text, "no longer leads to the folder that was locked"));
  assert_int_equal(mkdir(here, 0777), 0);
  assert_false(folder_in_place(&open, &m));
  assert_true(file_replace(&open, "f", "new", 3, &m));
  assert_true(is_there(in_folder(folder, "there/f")) && !is_there(in_folder(folder, "here/f")));
  assert_true(folder_has(&open, "f"));
  spill(in_folder(folder, "here/f"), "x", 1);
  FILE *other = fopen(in_folder(folder, "here/f"), "r"), *ours = fopen(in_folder(folder, "there/f"), "r");
  assert_true(folder_holds(&open, "f", fileno(ours), &m));
  assert_false(folder_holds(&open, "f", fileno(other), &m));
  assert_non_null(strstr(m.text, "another file was opened"));
  fclose(other);
  fclose(ours);
  const int copy = dup(open.fd); /* as a child has one */
  assert_true(folder_in_use(there));
  folder_close(&open);
  assert_false(folder_in_use(there));
  close(copy);
  remove(in_folder(folder, "here/f"));
  remove(in_folder(folder, "there/f"));
  remove(here);
  remove(there);
  remove_folder(folder);
}

/* No link is followed, and no pipe waited for. */
static void test_links_and_pipes_in_a_folder(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct message m;
  struct folder open = {folder, FOLDER_BY_NAME};
  const char *victim = in_folder(folder, "victim");
  size_t bytes;
  spill(victim, "mine", 4);
  assert_int_equal(symlink("victim", in_folder(folder, "f.part")), 0);
  assert_int_equal(symlink("victim", in_folder(folder, "t.csv")), 0);
  assert_int_equal(mkfifo(in_folder(folder, "p.csv"), 0666), 0);
  assert_true(folder_lock(&open, &m));
  assert_true(file_replace(&open, "f", "new", 3, &m));
  char *text = slurp(victim, &bytes);
  assert_string_equal(text, "mine");
  free(text);
  for (const char *const *odd = (const char *[]){"t.csv", "p.csv", ".", NULL}; *odd; odd++) {
    assert_false(file_replace(&open, *odd, "new", 3, &m));
    assert_non_null(strstr(m.text, "is a link, a folder, a pipe or a device"));
  }
  struct series s;
  uint64_t found;
  assert_false(series_open(&s, &open, "t", 2, names, 4, &m));
  assert_non_null(strstr(m.text, strerror(ELOOP)));
  assert_false(series_find_end(&open, "p", 2, names, 4, &found, &m));
  assert_false(series_open(&s, &open, "p", 2, names, 4, &m));
  FILE *through = fopen(in_folder(folder, "t.csv"), "r");
  assert_false(folder_holds(&open, "t.csv", fileno(through), &m));
  assert_non_null(strstr(m.text, "is a link"));
  fclose(through);
  folder_close(&open);
  remove_folder(folder);
}

static void test_a_wrong_name_is_not_a_closed_folder(void **unused)
{
  (void)unused;
  char folder[64], long_name[301];
  make_folder(folder);
  struct message m;
  size_t made;
  memset(long_name, 'a', 300);
  long_name[300] = '\0';
  char longer[400];
  snprintf(longer, sizeof longer, "%s/%s", folder, long_name);
  spill(in_folder(folder, "file"), "x", 1);
  assert_int_equal(symlink("loop", in_folder(folder, "loop")), 0);
  assert_int_equal(folder_prepare(folder, &made, &m), FOLDER_FINE);
  assert_int_equal(folder_prepare("", &made, &m), FOLDER_IS_NONE);
  assert_int_equal(folder_prepare(in_folder(folder, "file"), &made, &m), FOLDER_IS_NONE);
  assert_int_equal(folder_prepare(longer, &made, &m), FOLDER_REFUSED);
  assert_non_null(strstr(m.text, strerror(ENAMETOOLONG)));
  assert_int_equal(folder_prepare(in_folder(folder, "loop"), &made, &m), FOLDER_REFUSED);
  assert_non_null(strstr(m.text, strerror(ELOOP)));
  assert_int_equal(folder_find(by_name(folder), "file", &m), FOLDER_HAS);
  assert_int_equal(folder_find(by_name(folder), "none", &m), FOLDER_HAS_NOT);
  assert_int_equal(folder_find(by_name(in_folder(folder, "file")), "below", &m), FOLDER_HAS_NOT);
  assert_int_equal(folder_find(by_name(in_folder(folder, "none")), "below", &m), FOLDER_HAS_NOT);
  assert_int_equal(folder_find(by_name(in_folder(folder, "loop")), "below", &m), FOLDER_UNKNOWN);
  assert_non_null(strstr(m.text, "loop/below: cannot find out whether it is there: "));
  assert_true(folder_has(by_name(in_folder(folder, "loop")), "below"));
  if (geteuid() != 0) { /* whom no permission stops */
    assert_int_equal(mkdir(in_folder(folder, "closed"), 0600), 0);
    assert_int_equal(folder_find(by_name(in_folder(folder, "closed")), "below", &m), FOLDER_UNKNOWN);
    assert_int_equal(folder_prepare(in_folder(folder, "closed"), &made, &m), FOLDER_REFUSED);
  }
  remove_folder(folder);
}

/* One lock per folder, whoever asks: another descriptor of the same process stands for another process. */
static void test_a_folder_has_one_writer(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct message m;
  struct folder first = {folder, FOLDER_BY_NAME}, second = first;
  assert_true(folder_lock(&first, &m));
  assert_false(folder_lock(&second, &m));
  assert_non_null(strstr(m.text, folder));
  assert_non_null(strstr(m.text, "in use by another process"));
  folder_close(&first);
  assert_true(folder_lock(&second, &m));
  folder_close(&second);
  assert_false(folder_lock(by_name(in_folder(folder, "none")), &m));
  assert_non_null(strstr(m.text, "none: cannot open"));
  remove_folder(folder);
}

/* What cannot be locked is in nobody's use: the lock that a closed descriptor has not. */
static void test_no_lock_is_not_one_in_use(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  struct folder first = {folder, FOLDER_BY_NAME};
  struct message m;
  assert_true(folder_lock(&first, &m));
  assert_string_equal(m.text, "");
  const int other = open(folder, O_RDONLY | O_DIRECTORY);
  assert_int_equal(lock_take(other, true), LOCK_IN_USE);
  assert_int_equal(lock_take(other, false), LOCK_IN_USE);
  close(other);
  assert_int_equal(lock_take(other, true), LOCK_NONE);
  assert_int_equal(errno, EBADF);
  folder_close(&first);
  remove_folder(folder);
}

/* --- progress ----------------------------------------------------------------------------------------------------- */

static void test_durations_as_people_say_them(void **unused)
{
  (void)unused;
  static const struct {
    double seconds;
    const char *text;
  } said[] = {{0.0, "0 s"},           {59.4, "59 s"},         {59.6, "1 min 00 s"},     {185.0, "3 min 05 s"},
              {3600.0, "1 h 00 min"}, {7800.0, "2 h 10 min"}, {86399.0, "23 h 59 min"}, {273600.0, "3 d 4 h"}};
  for (size_t k = 0; k < sizeof said / sizeof *said; k++) {
    char text[64];
    duration_text(said[k].seconds, text, sizeof text);
    assert_string_equal(text, said[k].text);
  }
}

/* What is told on stderr at this step, 20 s and 50 steps after the beginning; to be freed. */
static char *told(struct progress p, uint64_t step, bool and_end)
{
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "err");
  fflush(stderr);
  int saved = dup(STDERR_FILENO);
  assert_non_null(freopen(path, "w", stderr));
  progress_tell(&p, step);
  progress_tell(&p, step); /* at once again: nothing more is said */
  if (and_end)
    progress_end(&p);
  fflush(stderr);
  dup2(saved, STDERR_FILENO);
  close(saved);
  size_t bytes;
  char *text = slurp(path, &bytes);
  remove_folder(folder);
  return text;
}

static void test_progress_is_told_now_and_then(void **unused)
{
  (void)unused;
  const double then = clock_seconds() - 20.0;
  const struct progress plain = {.first = 100, .last = 200, .started = then, .told = then};
  struct progress quiet = plain, terminal = plain, early = plain, idle = plain;
  quiet.quiet = terminal.terminal = true;
  early.told = clock_seconds() - 5.0;
  idle.first = 150;
  const struct {
    struct progress progress;
    const char *begins, *holds;
  } cases[] = {{plain, "step 150 of 200 (75.0 %), 2.5 steps/s, 20 s left\n", ""},
               {terminal, "\r\033[Kstep 150 of 200", "20 s left\r\033[K"},
               {idle, "step 150 of 200", "0.0 steps/s, ? left\n"},
               {quiet, "", NULL},
               {early, "", NULL}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    char *text = told(cases[k].progress, 150, true);
    if (strncmp(text, cases[k].begins, strlen(cases[k].begins)) != 0)
      fail_msg("case %zu: '%s'", k, text);
    if (cases[k].holds ? !strstr(text, cases[k].holds) : text[0] != '\0')
      fail_msg("case %zu: '%s'", k, text);
    free(text);
  }
}

static void test_the_rate_counts_this_session(void **unused)
{
  (void)unused;
  struct progress p;
  progress_begin(&p, 1000, 2000, true);
  assert_true(p.quiet);
  p.started -= 10.0;
  assert_close(progress_rate(&p, 1500), 50.0, 0.5);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_numbers_read_back_to_the_last_bit),
      cmocka_unit_test(test_a_resume_keeps_what_the_checkpoint_knows),
      cmocka_unit_test(test_where_a_table_ends),
      cmocka_unit_test(test_what_cannot_be_opened_is_not_written_over),
      cmocka_unit_test(test_a_full_disk_is_noticed),
      cmocka_unit_test(test_an_earlier_summary_survives_a_failure),
      cmocka_unit_test(test_folders_are_made_with_those_above),
      cmocka_unit_test(test_a_wrong_name_is_not_a_closed_folder),
      cmocka_unit_test(test_a_folder_has_one_writer),
      cmocka_unit_test(test_no_lock_is_not_one_in_use),
      cmocka_unit_test(test_an_open_folder_may_be_moved),
      cmocka_unit_test(test_links_and_pipes_in_a_folder),
      cmocka_unit_test(test_durations_as_people_say_them),
      cmocka_unit_test(test_progress_is_told_now_and_then),
      cmocka_unit_test(test_the_rate_counts_this_session),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
