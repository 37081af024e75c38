#include "run.h"

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

#include "io/folder.h"
#include "io/output.h"
#include "io/progress.h"
#include "io/record.h"
#include "io/scene.h"
#include "io/snapshot.h"
#include "step.h"
#include "version.h"

/* Set by SIGINT and SIGTERM; looked at once per step. The only variable of the program that is not passed along. */
static volatile sig_atomic_t interrupted;

static void on_signal(int number)
{
  (void)number;
  interrupted = 1;
}

static void watch_signals(void)
{
  struct sigaction action = {.sa_handler = on_signal};
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

/* Everything that a run holds. */
struct run {
  const struct run_options *options;
  struct scene scene;
  struct state state;
  struct work work;
  struct observers *observers;
  struct output output;
  struct checkpoint_head head;
  double session_started; /* clock_seconds */
  double last_checkpoint; /* clock_seconds */
  double earlier_seconds; /* spent in earlier sessions */
  struct progress progress;
  struct message message;
};

static enum exit_code complain(const struct run *run, enum exit_code code)
{
  fprintf(stderr, "uncross: %s\n", run->message.text);
  return code;
}

/* --- how it starts ----------------------------------------------------------------------------------------------- */

static void checkpoint_path(const struct run *run, char *path, size_t size)
{
  snprintf(path, size, "%s/checkpoint.h5", run->options->folder);
}

/* The folder must be new to a new run, and known to a resumed one: nothing is written over. */
static bool check_folder(const struct run_options *o, struct message *message)
{
  static const char *const ours[] = {"checkpoint.h5", "run.json", "trajectory.h5"};
  if (o->resume)
    return folder_has(o->folder, "checkpoint.h5") ||
           message_set(message, "%s: nothing to resume, there is no checkpoint.h5; leave out --resume to start",
                       o->folder);
  for (size_t k = 0; k < sizeof ours / sizeof *ours; k++)
    if (folder_has(o->folder, ours[k]))
      return message_set(message, "%s: holds a run already (%s); continue it with --resume, or name another folder",
                         o->folder, ours[k]);
  return true;
}

/* What the options say instead of the scene. A resumed run keeps its seed. */
static void apply_options(struct run *run)
{
  if (run->options->has_steps)
    run->scene.steps = run->options->steps;
  if (run->options->has_seed)
    run->scene.model.seed = run->options->seed;
}

static enum exit_code start_anew(struct run *run)
{
  const struct scene *scene = &run->scene;
  if (!scene_start(scene, &run->state, &run->work, &run->message))
    return complain(run, EXIT_BAD_INPUT);
  const struct conserved start = observe_conserved(&scene->model, &run->state);
  run->head = (struct checkpoint_head){.fingerprint = scene->fingerprint,
                                       .seed = scene->model.seed,
                                       .start_energy = start.total,
                                       .start_momentum = start.momentum,
                                       .version = UNCROSS_VERSION};
  return EXIT_DONE;
}

static enum exit_code start_from_checkpoint(struct run *run)
{
  const struct observe_block *blocks;
  size_t count = observers_blocks(run->observers, &blocks);
  char path[4096];
  checkpoint_path(run, path, sizeof path);
  if (!checkpoint_read(path, &run->scene.model, &run->head, &run->state, blocks, count, &run->message))
    return complain(run, EXIT_BAD_INPUT);
  if (run->head.fingerprint != run->scene.fingerprint) {
    message_set(&run->message,
                "%s: is of another scene than %s; resume with the scene of the run (it is kept in run.json)", path,
                run->scene.path);
    return complain(run, EXIT_BAD_INPUT);
  }
  if (run->options->has_seed && run->options->seed != run->head.seed) {
    message_set(&run->message, "%s: was run with seed %" PRIu64 "; a resumed run keeps its seed", path, run->head.seed);
    return complain(run, EXIT_BAD_INPUT);
  }
  if (!output_whole(&run->scene, run->observers, run->options->folder, run->head.frames_end, &run->message))
    return complain(run, EXIT_BAD_INPUT);
  run->scene.model.seed = run->head.seed;
  run->earlier_seconds = run->head.wall_seconds;
  return EXIT_DONE;
}

/* --- how it goes on and ends ------------------------------------------------------------------------------------- */

static double wall_seconds(const struct run *run)
{
  return run->earlier_seconds + clock_seconds() - run->session_started;
}

/* Tables, checkpoint and run.json of this moment. */
static bool save(struct run *run, const char *status)
{
  const struct observe_block *blocks;
  size_t count = observers_blocks(run->observers, &blocks);
  char path[4096];
  checkpoint_path(run, path, sizeof path);
  run->head.wall_seconds = wall_seconds(run);
  run->head.frames_end = trajectory_end(run->output.trajectory);
  run->last_checkpoint = clock_seconds();
  if (!(output_sync(&run->output, &run->message) &&
        checkpoint_write(path, &run->head, &run->scene.model, &run->state, blocks, count, run->scene.text,
                         &run->message) &&
        output_summaries(&run->output, run->observers, &run->scene.model, &run->message)))
    return false;
  const struct record record = {.status = status,
                                .step = run->state.step,
                                .counts = run->state.counts,
                                .wall_seconds = run->head.wall_seconds,
                                .steps_per_second = progress_rate(&run->progress, run->state.step),
                                .start_energy = run->head.start_energy,
                                .start_momentum = run->head.start_momentum,
                                .now = observe_conserved(&run->scene.model, &run->state),
                                .state_hash = run->head.state_hash};
  return record_write(run->options->folder, &run->scene, &record, &run->message);
}

/* What the run's folder gets of this step. */
static bool show(struct run *run)
{
  return output_sample(&run->output, run->observers, &run->scene.model, &run->state, &run->message);
}

static bool checkpoint_due(const struct run *run)
{
  double every = run->scene.checkpoint_seconds;
  return every > 0.0 && clock_seconds() - run->last_checkpoint >= every;
}

static enum exit_code loop(struct run *run)
{
  progress_begin(&run->progress, run->state.step, run->scene.steps, run->options->quiet);
  bool written = run->state.step > 0 || show(run);
  while (written && run->state.step < run->scene.steps && !interrupted) {
    if (!step_advance(&run->state, &run->scene.model, &run->work, NULL)) {
      progress_end(&run->progress);
      message_fault(&run->message, &run->work.fault);
      return complain(run, EXIT_STOPPED);
    }
    written = show(run) && (!checkpoint_due(run) || save(run, "running"));
    progress_tell(&run->progress, run->state.step);
  }
  progress_end(&run->progress);
  bool done = run->state.step >= run->scene.steps;
  if (!written || !save(run, done ? "finished" : "interrupted"))
    return complain(run, EXIT_NOT_WRITTEN);
  return done ? EXIT_DONE : EXIT_INTERRUPTED;
}

static void tell_end(const struct run *run, enum exit_code code)
{
  if (run->options->quiet || (code != EXIT_DONE && code != EXIT_INTERRUPTED))
    return;
  char spent[64];
  duration_text(clock_seconds() - run->session_started, spent, sizeof spent);
  printf("%s at step %" PRIu64 " of %" PRIu64 " after %s (%.1f steps/s)\nstate hash %016" PRIx64 "\nresults in %s\n",
         code == EXIT_DONE ? "finished" : "interrupted", run->state.step, run->scene.steps, spent,
         progress_rate(&run->progress, run->state.step), run->head.state_hash, run->options->folder);
  if (code == EXIT_INTERRUPTED)
    printf("go on with --resume\n");
}

static enum exit_code run_in_folder(struct run *run)
{
  const bool resume = run->options->resume;
  run->session_started = run->last_checkpoint = clock_seconds();
  enum exit_code code = resume ? start_from_checkpoint(run) : start_anew(run);
  if (code != EXIT_DONE)
    return code;
  if (!folder_make(run->options->folder, &run->message))
    return complain(run, EXIT_BAD_INPUT);
  if (!output_open(&run->output, &run->scene, run->observers, run->options->folder, resume, run->state.step,
                   &run->message)) {
    struct message ignored;
    output_close(&run->output, &ignored);
    return complain(run, EXIT_NOT_WRITTEN);
  }
  if (run->message.text[0] != '\0') /* opened all the same, with something to say */
    complain(run, EXIT_DONE);
  watch_signals();
  code = loop(run);
  if (!output_close(&run->output, &run->message) && code == EXIT_DONE)
    code = complain(run, EXIT_NOT_WRITTEN);
  tell_end(run, code);
  return code;
}

enum exit_code run_scene(const struct run_options *options)
{
  struct run *run = calloc(1, sizeof *run);
  if (!run) {
    fprintf(stderr, "uncross: no memory to begin with\n");
    return EXIT_TROUBLE;
  }
  run->options = options;
  enum exit_code code = EXIT_TROUBLE;
  if (!scene_read(options->scene, &run->scene, &run->message) || !check_folder(options, &run->message)) {
    code = complain(run, EXIT_BAD_INPUT);
  } else {
    apply_options(run);
    run->observers = observers_create(&run->scene.observe, &run->scene.model);
    if (run->observers && state_alloc(&run->state, &run->scene.model) && work_alloc(&run->work, &run->scene.model)) {
      code = run_in_folder(run);
    } else {
      message_set(&run->message, "no memory for this scene; `uncross check` says how much it needs");
      complain(run, code);
    }
    work_free(&run->work);
    state_free(&run->state);
    observers_free(run->observers);
  }
  scene_free(&run->scene);
  free(run);
  return code;
}
