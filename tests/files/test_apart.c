/* Work done by a process of its own: whatever becomes of it, the parent goes on and says so. */
#include "files/files.h"

#include <fcntl.h>
#include <limits.h>
#include <sys/wait.h>
#include <time.h>

#include "base/clock.h"
#include "files/reader.h"

static struct message fine = {.text = ""};

static void send_numbers(struct apart *link)
{
  int number[2];
  apart_get(link, number, sizeof number);
  number[1]++;
  apart_put_verdict(link, 0, &fine);
  apart_put(link, number, sizeof number);
  apart_put_text(link, "three");
  apart_put_text(link, NULL);
}

static void refuse(struct apart *link)
{
  struct message message;
  message_set(&message, "no");
  apart_put_verdict(link, 7, &message);
}

static void die(struct apart *link)
{
  int signal = 0;
  apart_get(link, &signal, sizeof signal);
  raise(signal);
}

static void leave(struct apart *link)
{
  (void)link;
}

static void turn(struct apart *link)
{
  volatile unsigned turns = 0;
  (void)link;
  for (;;)
    turns++;
}

static void spin(struct apart *link)
{
  link->seconds = 0.0; /* so that little more than a second is left */
  apart_go_on(link);
  turn(link);
}

static void wait_for_ever(struct apart *link)
{
  (void)link;
  for (;;)
    pause();
}

/* What must not be possible, as bits. */
static void try_all(struct apart *link)
{
  const char *path = link->path;
  int possible = 0;
  for (int signal = 1; signal < 16; signal++)
    if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP || signal == SIGUSR1)
      raise(signal); /* the end, were it not ignored */
  void *volatile much = malloc((size_t)1 << 40);
  possible |= much ? 1 : 0;
  free(much);
  possible |= fcntl(50, F_GETFD) >= 0 ? 8 : 0; /* what its parent had open */
  possible |= open(path, O_RDONLY) >= 0 ? 0 : 2;
  apart_shut();
  possible |= open(path, O_RDONLY) >= 0 ? 4 : 0;
  apart_put_verdict(link, 0, &fine);
  apart_put(link, &possible, sizeof possible);
}

const struct apart_work test_works[];
const struct apart_work test_works[] = {{"numbers", send_numbers}, {"refuse", refuse}, {"die", die},
                                        {"leave", leave},          {"turn", turn},     {"spin", spin},
                                        {"wait", wait_for_ever},   {"try", try_all},   {NULL, NULL}};

static struct apart start(const char *path, const char *work)
{
  struct apart parent;
  struct message message;
  if (!apart_start(&parent, path, work, &message))
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
  struct apart parent = start(path, "numbers");
  apart_put(&parent, number, sizeof number);
  assert_int_equal(apart_get_verdict(&parent, &message), 0);
  assert_true(apart_get(&parent, found, sizeof found) && found[0] == 1 && found[1] == 3);
  assert_true(apart_get_text(&parent, 100, &text));
  assert_string_equal(text, "three");
  free(text);
  assert_true(apart_get_text(&parent, 100, &text));
  assert_null(text);
  assert_false(apart_get(&parent, &more, sizeof more));
  apart_end(&parent);
  parent = start(path, "refuse");
  assert_int_equal(apart_get_verdict(&parent, &message), 7);
  assert_string_equal(message.text, "no");
  apart_end(&parent);
  parent = start(path, "numbers");
  apart_put(&parent, number, sizeof number);
  assert_int_equal(apart_get_verdict(&parent, &message), 0);
  assert_true(apart_get(&parent, found, sizeof found));
  assert_false(apart_get_text(&parent, 4, &text)); /* longer than allowed */
  apart_end(&parent);
  remove_folder(folder);
}

static void expect_end(const char *path, const char *work, int signal, bool died, const char *word)
{
  struct message message = {.text = ""};
  struct apart parent = start(path, work);
  apart_put(&parent, &signal, sizeof signal);
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
  expect_end(path, "die", SIGSEGV, true, "HDF5 dies of it (Segmentation fault)");
  expect_end(path, "die", SIGABRT, true, "HDF5 dies of it (Aborted)");
  expect_end(path, "die", SIGKILL, false, "was killed");
  expect_end(path, "leave", 0, false, "ended early");
  expect_end(path, "spin", 0, true, "does not come to an end");
  remove_folder(folder);
}

static void the_parent_may_let_go(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "f");
  spill(path, "data", 4);
  struct apart parent = start(path, "wait");
  const pid_t child = parent.child;
  apart_end(&parent);
  assert_int_equal(kill(child, 0), -1);
  apart_end(&parent); /* once more does nothing */
  remove_folder(folder);
}

/* One that does not answer: its processor time does not pass, the clock does. */
static void patience_has_an_end(void **unused)
{
  (void)unused;
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "f");
  spill(path, "data", 4);
  const double begun = clock_seconds();
  struct message message = {.text = ""};
  struct apart parent = start(path, "wait");
  assert_true(parent.patience >= 600.0);
  parent.patience = 0.2;
  assert_int_equal(apart_get_verdict(&parent, &message), -1);
  assert_non_null(strstr(message.text, "does not answer"));
  assert_false(parent.died); /* nothing is wrong with the file */
  const pid_t child = parent.child;
  apart_end(&parent);
  assert_int_equal(kill(child, 0), -1);
  assert_true(clock_seconds() - begun < 30.0);
  remove_folder(folder);
}

/* True if a process is there and has not ended. */
static bool is_alive(pid_t process)
{
  char path[64], text[256] = "";
  snprintf(path, sizeof path, "/proc/%d/stat", (int)process);
  FILE *file = fopen(path, "r");
  const bool read = file && fgets(text, sizeof text, file);
  if (file)
    fclose(file);
  const char *state = strrchr(text, ')');
  return read && state && state[2] != 'Z';
}

/* However the parent ends, and whatever the child does: waiting, or turning in circles in HDF5. */
static void it_ends_with_its_parent(void **unused)
{
  (void)unused;
  static const char *const works[] = {"wait", "turn"};
  char folder[64];
  make_folder(folder);
  const char *path = in_folder(folder, "f");
  spill(path, "data", 4);
  for (size_t k = 0; k < 2; k++) {
    int ends[2], status;
    pid_t child = 0;
    assert_int_equal(pipe(ends), 0);
    const pid_t parent = fork();
    if (parent == 0) {
      struct apart link = start(path, works[k]);
      if (write(ends[1], &link.child, sizeof link.child) == sizeof link.child)
        pause();
      _exit(1);
    }
    assert_int_equal(read(ends[0], &child, sizeof child), sizeof child);
    assert_true(is_alive(child));
    kill(parent, SIGKILL);
    assert_int_equal(waitpid(parent, &status, 0), parent);
    const double begun = clock_seconds();
    while (is_alive(child) && clock_seconds() - begun < 20.0)
      nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
    if (is_alive(child))
      fail_msg("%s: outlives its parent", works[k]);
    close(ends[0]);
    close(ends[1]);
  }
  remove_folder(folder);
}

/* Its path comes from the user's surroundings, or stands beside the code; it is of this build, or not taken. */
static void a_reader_is_found_or_missed(void **unused)
{
  (void)unused;
  char folder[64], ours[PATH_MAX], found[PATH_MAX];
  make_folder(folder);
  const char *path = in_folder(folder, "f"), *other = in_folder(folder, "uncross");
  struct apart parent;
  struct message message = {.text = ""};
  spill(path, "data", 4);
  snprintf(ours, sizeof ours, "%s", getenv("UNCROSS_READER"));
  /* it says of which build it is as long as ours does, and then reads what it is asked for */
  static const char talks[] = "#!/bin/sh\nprintf %0128d 0 >&3\nexec cat <&3\n";
  assert_int_equal(APART_BUILD, 128);
  spill(other, talks, sizeof talks - 1);
  assert_int_equal(chmod(other, 0755), 0);
  setenv("UNCROSS_READER", other, 1);
  assert_true(reader_find(found, sizeof found, &message));
  assert_string_equal(found, other);
  assert_false(apart_start(&parent, path, "leave", &message));
  assert_non_null(strstr(message.text, "is not of this build"));
  assert_non_null(strstr(message.text, other));
  static const char dies[] = "#!/bin/sh\nkill -KILL $$\n"; /* of what, nobody knows: it has read nothing yet */
  spill(other, dies, sizeof dies - 1);
  assert_int_equal(chmod(other, 0755), 0);
  assert_false(apart_start(&parent, path, "leave", &message));
  assert_null(strstr(message.text, "build"));
  assert_null(strstr(message.text, "damaged"));
  assert_non_null(strstr(message.text, "ended before it began: Killed"));
  if (geteuid() == 0) { /* it belongs to somebody else */
    assert_int_equal(chown(other, 12345, 12345), 0);
    assert_false(reader_find(found, sizeof found, &message));
    assert_non_null(strstr(message.text, other));
  }
  /* Relative to where? Not there; no program. Who names one does not want another. */
  const char *const wrong[] = {"uncross", "/nowhere/uncross", path};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    setenv("UNCROSS_READER", wrong[k], 1);
    message.text[0] = '\0';
    assert_false(reader_find(found, sizeof found, &message));
    assert_non_null(strstr(message.text, "UNCROSS_READER"));
    assert_non_null(strstr(message.text, wrong[k]));
  }
  setenv("UNCROSS_READER", ours, 1);
  remove_folder(folder);
}

/* Nothing that the host has open, and did not keep from its children, is there when the reader begins: a lock of
 * another thread would stay until the reader has closed it. The reader is a script here, which lists what it has. */
static void it_begins_with_nothing_of_its_host(void **unused)
{
  (void)unused;
  char folder[64], ours[PATH_MAX], text[2 * PATH_MAX], seen[4096] = "";
  make_folder(folder);
  const char *path = in_folder(folder, "f"), *lister = in_folder(folder, "uncross"), *list = in_folder(folder, "list");
  struct apart parent;
  struct message message = {.text = ""};
  spill(path, "data", 4);
  snprintf(ours, sizeof ours, "%s", getenv("UNCROSS_READER"));
  const int length =
      snprintf(text, sizeof text, "#!/bin/sh\nfor fd in /proc/$$/fd/*; do readlink $fd; done >%s\n", list);
  spill(lister, text, (size_t)length);
  assert_int_equal(chmod(lister, 0755), 0);
  setenv("UNCROSS_READER", lister, 1);
  assert_int_equal(dup2(open(path, O_RDONLY), 50), 50); /* not closed by exec */
  assert_false(apart_start(&parent, path, "leave", &message));
  setenv("UNCROSS_READER", ours, 1);
  FILE *file = fopen(list, "r");
  assert_non_null(file);
  assert_true(fread(seen, 1, sizeof seen - 1, file) > 0);
  fclose(file);
  close(50);
  assert_non_null(strstr(seen, "socket"));
  if (strstr(seen, path))
    fail_msg("a reader has its host's file: %s", seen);
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
  assert_int_equal(dup2(open(path, O_RDONLY), 50), 50); /* not closed by exec */
  struct apart parent = start(path, "try");
  assert_int_equal(apart_get_verdict(&parent, &message), 0);
  assert_true(apart_get(&parent, &possible, sizeof possible));
  assert_int_equal(possible, 0);
  apart_end(&parent);
  const char *const none[] = {folder, "/dev/zero", in_folder(folder, "pipe"), in_folder(folder, "nothing")};
  assert_int_equal(mkfifo(in_folder(folder, "pipe"), 0600), 0);
  for (size_t k = 0; k < 4; k++) {
    assert_false(apart_start(&parent, none[k], "leave", &message));
    assert_non_null(strstr(message.text, none[k]));
  }
  remove_folder(folder);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_are_handed_over),
                                     cmocka_unit_test(every_end_is_told),
                                     cmocka_unit_test(the_parent_may_let_go),
                                     cmocka_unit_test(patience_has_an_end),
                                     cmocka_unit_test(it_ends_with_its_parent),
                                     cmocka_unit_test(a_reader_is_found_or_missed),
                                     cmocka_unit_test(it_begins_with_nothing_of_its_host),
                                     cmocka_unit_test(it_reaches_nothing_else)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
