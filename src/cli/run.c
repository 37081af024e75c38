/* `uncross run`: the library's run in a folder, with signals, progress and closing words. */
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <time.h>

#include "base/text.h"
#include "cli/command.h"
#include "cli/progress.h"
#include "uncross.h"

/* Set by signals; looked at once per step. The only variables of the program that are not passed along. */
static volatile sig_atomic_t interrupted;
static struct timespec interrupted_at; /* written in the handler only, before `interrupted` */

/* Programs send a signal twice at once (`timeout` does: to the process and to its group), a user waits in between. */
#define SIGNAL_PAUSE 1.0 /* s */

static bool paused(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)(now.tv_sec - interrupted_at.tv_sec) + 1e-9 * (double)(now.tv_nsec - interrupted_at.tv_nsec) >=
         SIGNAL_PAUSE;
}

/* The first signal asks for a checkpoint. A later SIGINT or SIGTERM ends the program as if nobody had caught it; the
 * others are sent again and again by schedulers (SIGXCPU each second). */
static void on_signal(int number)
{
  const bool asks_again = interrupted && (number == SIGINT || number == SIGTERM) && paused();
  if (!interrupted)
    clock_gettime(CLOCK_MONOTONIC, &interrupted_at);
  interrupted = 1;
  if (asks_again) {
    const struct sigaction standard = {.sa_handler = SIG_DFL};
    sigaction(number, &standard, NULL);
    raise(number); /* delivered when this function returns */
  }
}

/* nohup ignores SIGHUP for the program that it starts, which stays so. */
static void watch_signals(void)
{
  static const int watched[] = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGXCPU};
  struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART}, before;
  sigemptyset(&action.sa_mask);
  for (size_t k = 0; k < sizeof watched / sizeof *watched; k++)
    sigaddset(&action.sa_mask, watched[k]);
  for (size_t k = 0; k < sizeof watched / sizeof *watched; k++)
    if (watched[k] != SIGHUP || sigaction(SIGHUP, NULL, &before) != 0 || before.sa_handler != SIG_IGN)
      sigaction(watched[k], &action, NULL);
}

/* A run goes on when the reader of its output closes the pipe (SIGPIPE). A file that may not grow (SIGXFSZ) is reported
 * like any other file that cannot be written. */
static void ignore_signals(void)
{
  struct sigaction ignore = {.sa_handler = SIG_IGN};
  sigaction(SIGPIPE, &ignore, NULL);
  sigaction(SIGXFSZ, &ignore, NULL);
}

static enum exit_code complain(const uncross_error *error)
{
  fprintf(stderr, "uncross: %s\n", error->message);
  return (enum exit_code)error->code;
}

static uncross_scene *read_scene(const struct arguments *a, uncross_error *error)
{
  uncross_scene *scene = uncross_scene_read(a->file[0], a->set, a->sets, error);
  if (scene && a->has_steps)
    uncross_scene_set_steps(scene, a->steps, error);
  if (scene && a->has_seed)
    uncross_scene_set_seed(scene, a->seed, error);
  return scene;
}

static uint64_t step_of(const uncross_run *run)
{
  return uncross_sim_step(uncross_run_sim(run));
}

static int after_step(void *context, const uncross_run *run)
{
  progress_tell(context, step_of(run));
  return !interrupted;
}

static enum exit_code loop(uncross_run *run, struct progress *progress, uncross_error *error)
{
  const uint64_t wanted = uncross_run_wanted(run);
  const bool ok = interrupted || uncross_run_advance(run, wanted, after_step, progress, error) == UNCROSS_OK;
  progress_end(progress);
  const bool done = step_of(run) >= wanted;
  if (!ok || uncross_run_close(run, error) != UNCROSS_OK)
    return complain(error);
  return done ? EXIT_DONE : EXIT_INTERRUPTED;
}

static void print_word(const char *word)
{
  putchar(' ');
  text_print_word(stdout, word);
}

/* A path, which shall not be taken for an option. */
static void print_path(const char *path)
{
  printf(" %s", *path == '-' ? "./" : "");
  text_print_word(stdout, path);
}

/* The command that continues this run. */
static void tell_resume(const struct arguments *a)
{
  printf("go on with: ");
  print_word(a->program);
  printf(" run");
  print_path(a->file[0]);
  printf(" --out");
  print_path(a->out);
  printf(" --resume");
  if (a->has_steps)
    printf(" --steps %" PRIu64, a->steps);
  if (a->has_seed)
    printf(" --seed %" PRIu64, a->seed);
  for (size_t k = 0; k < a->sets; k++) {
    printf(" --set");
    print_word(a->set[k]);
  }
  printf("\n");
}

static void tell_end(const uncross_run *run, const struct progress *progress, const struct arguments *a,
                     enum exit_code code)
{
  uint64_t hash = 0;
  char spent[64];
  duration_text(progress_seconds(progress), spent, sizeof spent);
  uncross_sim_hash(uncross_run_sim(run), &hash, NULL);
  printf("%s at step %" PRIu64 " of %" PRIu64 " after %s (%.1f steps/s)\nstate hash %016" PRIx64 "\nresults in %s\n",
         code == EXIT_DONE ? "finished" : "interrupted", step_of(run), uncross_run_wanted(run), spent,
         progress_rate(progress, step_of(run)), hash, text_shown(a->out));
  if (code == EXIT_INTERRUPTED)
    tell_resume(a);
}

static void tell_note(const uncross_run *run)
{
  if (uncross_run_note(run)[0] != '\0')
    fprintf(stderr, "uncross: %s\n", uncross_run_note(run));
}

static enum exit_code run_to_end(uncross_run *run, const struct arguments *a, uncross_error *error)
{
  struct progress progress;
  const uint64_t wanted = uncross_run_wanted(run);
  if (step_of(run) > wanted) {
    if (!a->quiet)
      printf("at step %" PRIu64 " already, past the %" PRIu64 " asked for: nothing to do\n", step_of(run), wanted);
    return EXIT_DONE;
  }
  tell_note(run);
  progress_begin(&progress, step_of(run), wanted, a->quiet);
  const enum exit_code code = loop(run, &progress, error);
  if (code == EXIT_DONE || code == EXIT_INTERRUPTED)
    tell_note(run);
  if (!a->quiet && (code == EXIT_DONE || code == EXIT_INTERRUPTED))
    tell_end(run, &progress, a, code);
  return code;
}

static void tell_warning(void *file, const char *text)
{
  fprintf(file, "uncross: warning: %s\n", text_shown(text));
}

static int not_interrupted(void *unused)
{
  (void)unused;
  return !interrupted;
}

enum exit_code command_run(const struct arguments *a)
{
  uncross_error error;
  ignore_signals();
  uncross_scene *scene = read_scene(a, &error);
  if (!scene)
    return complain(&error);
  if (!a->quiet && uncross_scene_warnings(scene, tell_warning, stderr, &error) != UNCROSS_OK) {
    uncross_scene_free(scene);
    return complain(&error);
  }
  watch_signals();
  uncross_scene_watch_start(scene, not_interrupted, NULL, &error);
  uncross_run *run = uncross_run_open(scene, a->out, a->resume ? UNCROSS_RESUME : UNCROSS_NEW, &error);
  const enum exit_code code = run                                                 ? run_to_end(run, a, &error)
                              : complain(&error) == EXIT_BAD_INPUT && interrupted ? EXIT_INTERRUPTED
                                                                                  : (enum exit_code)error.code;
  uncross_run_free(run);
  uncross_scene_free(scene);
  return code;
}
