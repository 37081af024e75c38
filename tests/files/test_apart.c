/* Work done by a process of its own: whatever becomes of it, the parent goes on and says so. */
#include "files/files.h"

#include <fcntl.h>

#include "files/apart.h"

static struct message fine = {""};

static void send_numbers(struct apart *link, void *context)
{
  int *number = context;
  number[1]++; /* its own copy */
  apart_put_verdict(link, 0, &fine);
  apart_put(link, number, 2 * sizeof *number);
  apart_put_text(link, "three");
  apart_put_text(link, NULL);
}

static void refuse(struct apart *link, void *context)
{
  struct message message;
  (void)context;
  message_set(&message, "no");
  apart_put_verdict(link, 7, &message);
}

static void die(struct apart *link, void *context)
{
  (void)link;
  raise(*(int *)context);
}

static void leave(struct apart *link, void *context)
{
  (void)link, (void)context;
}

static void spin(struct apart *link, void *context)
{
  volatile unsigned turns = 0;
  (void)context;
  link->seconds = -1.0; /* as if the time for this file were over */
  apart_go_on(link);
  for (;;)
    turns++;
}

static void wait_for_ever(struct apart *link, void *context)
{
  (void)link, (void)context;
  for (;;)
    pause();
}

/* What must not be possible, as bits. */
static void try_all(struct apart *link, void *context)
{
  const char *path = context;
  int possible = 0;
  for (int signal = 1; signal < 16; signal++)
    if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP || signal == SIGUSR1)
      raise(signal); /* the end, were it not ignored */
  void *volatile much = malloc((size_t)1 << 40);
  possible |= much ? 1 : 0;
  free(much);
  possible |= open(path, O_RDONLY) >= 0 ? 0 : 2;
  apart_shut();
  possible |= open(path, O_RDONLY) >= 0 ? 4 : 0;
  apart_put_verdict(link, 0, &fine);
  apart_put(link, &possible, sizeof possible);
}

static struct apart start(const char *path, void (*work)(struct apart *, void *), void *context)
{
  struct apart parent;
  struct message message;
  if (!apart_start(&parent, path, work, context, &message))
    fail_msg("%s", message.text);
  return parent;
}

static void numbers_are_handed_over(void **unused)
{
  (void)unused;
  char folder[64], *text;
  make_folder(folder);
  const char *path = in_folder(folder, "f");
  struct message message;
  int number[2] = {1, 2}, found[2], more;
  spill(path, "data", 4);
  struct apart parent = start(path, send_numbers, number);
  assert_int_equal(apart_get_verdict(&parent, &message), 0);
  assert_true(apart_get(&parent, found, sizeof found) && found[0] == 1 && found[1] == 3 && number[1] == 2);
  assert_true(apart_get_text(&parent, 100, &text));
  assert_string_equal(text, "three");
  free(text);
  assert_true(apart_get_text(&parent, 100, &text));
  assert_null(text);
  assert_false(apart_get(&parent, &more, sizeof more));
  apart_end(&parent);
  parent = start(path, refuse, NULL);
  assert_int_equal(apart_get_verdict(&parent, &message), 7);
  assert_string_equal(message.text, "no");
  apart_end(&parent);
  parent = start(path, send_numbers, number);
  assert_int_equal(apart_get_verdict(&parent, &message), 0);
  assert_true(apart_get(&parent, found, sizeof found));
  assert_false(apart_get_text(&parent, 4, &text)); /* longer than allowed */
  apart_end(&parent);
  remove_folder(folder);
}

static void expect_end(const char *path, void (*work)(struct apart *, void *), int signal, bool died, const char *word)
{
  struct message message = {""};
  struct apart parent = start(path, work, &signal);
  assert_int_equal(apart_get_verdict(&parent, &message), -1);
  if (!strstr(message.text, word) || !strstr(message.text, path))
    fail_msg("'%s' does not say '%s' of %s", message.text, word, path);
  assert_true(parent.died == died);
  apart_end(&parent);
}

static void every_end_is_told(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "f");
  spill(path, "data", 4);
  expect_end(path, die, SIGSEGV, true, "HDF5 dies of it (Segmentation fault)");
  expect_end(path, die, SIGABRT, true, "HDF5 dies of it (Aborted)");
  expect_end(path, die, SIGKILL, false, "was killed");
  expect_end(path, leave, 0, false, "ended early");
  expect_end(path, spin, 0, true, "does not come to an end");
  remove_folder(folder);
}

static void the_parent_may_let_go(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "f");
  spill(path, "data", 4);
  struct apart parent = start(path, wait_for_ever, NULL);
  const pid_t child = parent.child;
  apart_end(&parent);
  assert_int_equal(kill(child, 0), -1);
  apart_end(&parent); /* once more does nothing */
  remove_folder(folder);
}

static void it_reaches_nothing_else(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "f");
  struct message message;
  int possible = -1;
  spill(path, "data", 4);
  struct apart parent = start(path, try_all, (void *)(uintptr_t)path);
  assert_int_equal(apart_get_verdict(&parent, &message), 0);
  assert_true(apart_get(&parent, &possible, sizeof possible));
  assert_int_equal(possible, 0);
  apart_end(&parent);
  const char *const none[] = {folder, "/dev/zero", in_folder(folder, "pipe"), in_folder(folder, "nothing")};
  assert_int_equal(mkfifo(in_folder(folder, "pipe"), 0600), 0);
  for (size_t k = 0; k < 4; k++) {
    assert_false(apart_start(&parent, none[k], leave, NULL, &message));
    assert_non_null(strstr(message.text, none[k]));
  }
  remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_are_handed_over), cmocka_unit_test(every_end_is_told),
                                     cmocka_unit_test(the_parent_may_let_go),
                                     cmocka_unit_test(it_reaches_nothing_else)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
