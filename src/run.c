#include "run.h"

#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

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
  struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

/* That nobody reads its words any more (SIGPIPE) is no reason for a run to end; a file that may not grow (SIGXFSZ) is
 * told as any other that cannot be written. */
static void ignore_signals(void)
{
  struct sigaction ignore = {.sa_handler = SIG_IGN};
  sigaction(SIGPIPE, &ignore, NULL);
  sigaction(SIGXFSZ, &ignore, NULL);
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
  struct record record;   /* as in run.json, or as it would be there */
  int lock;               /* of the folder */
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

/* Whether a run left something in the folder; the message is then its name. */
static bool find_left(const struct run *run, struct message *name)
{
  static const char *const ours[] = {"run.json", "trajectory.h5"};
  for (size_t k = 0; k < sizeof ours / sizeof *ours; k++) {
    message_set(name, "%s", ours[k]);
    if (folder_has(run->options->folder, name->text))
      return true;
  }
  return output_left(&run->scene, run->observers, run->options->folder, name);
}

/* The folder must be new to a new run, and known to a resumed one: nothing is written over. */
static enum exit_code check_folder(struct run *run)
{
  const char *folder = run->options->folder;
  struct message name;
  if (folder_has(folder, "checkpoint.h5")) {
    if (run->options->resume)
      return EXIT_DONE;
    message_set(&run->message,
                "%s: holds a run already (checkpoint.h5); continue it with --resume, or name another folder", folder);
  } else if (find_left(run, &name)) {
    message_set(&run->message,
                "%s: holds %s but no checkpoint: a run that ended before its first one, or something else that is not "
                "written over; remove the folder, or name another one",
                folder, name.text);
  } else if (run->options->resume) {
    message_set(&run->message, "%s: nothing to resume, there is no checkpoint.h5; leave out --resume to start", folder);
  } else {
    return EXIT_DONE;
  }
  return complain(run, EXIT_BAD_INPUT);
}

/* Makes the folder, if it is not there, and keeps everybody else out of it. */
static enum exit_code take_folder(struct run *run)
{
  const char *folder = run->options->folder;
  const enum folder_trouble trouble = folder_prepare(folder, &run->message);
  if (trouble != FOLDER_FINE)
    return complain(run, trouble == FOLDER_IS_NONE ? EXIT_BAD_INPUT : EXIT_NOT_WRITTEN);
  run->lock = folder_lock(folder, &run->message);
  if (run->lock < 0)
    return complain(run, EXIT_NOT_WRITTEN);
  return check_folder(run);
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
                                       .state_hash = state_hash(&run->state),
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

static void take_record(struct run *run, const char *status)
{
  run->record = (struct record){.status = status,
                                .step = run->state.step,
                                .counts = run->state.counts,
                                .wall_seconds = run->head.wall_seconds,
                                .steps_per_second = progress_rate(&run->progress, run->state.step),
                                .start_energy = run->head.start_energy,
                                .start_momentum = run->head.start_momentum,
                                .now = observe_conserved(&run->scene.model, &run->state),
                                .state_hash = run->head.state_hash};
}

static bool write_record(const struct run *run, struct message *message)
{
  return record_write(run->options->folder, &run->scene, &run->record, message);
}

/* Tables, checkpoint and run.json of this moment. */
static bool save(struct run *run, const char *status)
{
  const struct observe_block *blocks;
  size_t count = observers_blocks(run->observers, &blocks);
  char path[4096];
  checkpoint_path(run, path, sizeof path);
  run->head.wall_seconds = wall_seconds(run);
  if (run->output.trajectory) /* else where it went to stays known */
    run->head.frames_end = trajectory_end(run->output.trajectory);
  run->last_checkpoint = clock_seconds();
  if (!output_sync(&run->output, &run->message) || !checkpoint_write(path, &run->head, &run->scene.model, &run->state,
                                                                     blocks, count, run->scene.text, &run->message))
    return false;
  take_record(run, status);
  return output_summaries(&run->output, run->observers, &run->scene.model, &run->message) &&
         write_record(run, &run->message);
}

/* Says why the run cannot go on, here and in run.json, whose numbers stay those of the last checkpoint. */
static enum exit_code stop(struct run *run, enum exit_code code)
{
  struct message ignored;
  run->record.status = "stopped";
  run->record.reason = run->message.text;
  write_record(run, &ignored);
  return complain(run, code);
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
  take_record(run, "running");
  bool stepped = true, written = run->options->resume ? write_record(run, &run->message) : show(run);
  while (written && run->state.step < run->scene.steps && !interrupted) {
    stepped = step_advance(&run->state, &run->scene.model, &run->work, NULL);
    if (!stepped)
      break;
    written = show(run) && (!checkpoint_due(run) || save(run, "running"));
    progress_tell(&run->progress, run->state.step);
  }
  progress_end(&run->progress);
  if (!stepped) {
    message_fault(&run->message, &run->work.fault);
    return stop(run, EXIT_STOPPED);
  }
  bool done = run->state.step >= run->scene.steps;
  if (!written || !save(run, done ? "finished" : "interrupted"))
    return stop(run, EXIT_NOT_WRITTEN);
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

/* A run that is past the steps asked for stays as it is. */
static enum exit_code leave_alone(const struct run *run)
{
  if (!run->options->quiet)
    printf("at step %" PRIu64 " already, past the %" PRIu64 " asked for: nothing to do\n", run->state.step,
           run->scene.steps);
  return EXIT_DONE;
}

static enum exit_code run_to_end(struct run *run)
{
  const bool resume = run->options->resume;
  if (run->state.step > run->scene.steps)
    return leave_alone(run);
  watch_signals();
  if (!output_open(&run->output, &run->scene, run->observers, run->options->folder, resume, run->head.frames_end,
                   run->state.step, &run->message)) {
    struct message ignored;
    output_close(&run->output, &ignored);
    return complain(run, EXIT_NOT_WRITTEN);
  }
  if (run->message.text[0] != '\0') /* opened all the same, with something to say */
    complain(run, EXIT_DONE);
  enum exit_code code = loop(run);
  if (!output_close(&run->output, &run->message) && (code == EXIT_DONE || code == EXIT_INTERRUPTED))
    code = stop(run, EXIT_NOT_WRITTEN);
  tell_end(run, code);
  return code;
}

/* A folder that is there is taken before anything in it is believed; one that is not, only when there is a state to
 * begin with: bad input leaves no folder. */
static enum exit_code run_in_folder(struct run *run)
{
  const bool there = folder_has(run->options->folder, ".");
  run->session_started = run->last_checkpoint = clock_seconds();
  enum exit_code code = there ? take_folder(run) : check_folder(run);
  if (code == EXIT_DONE)
    code = run->options->resume ? start_from_checkpoint(run) : start_anew(run);
  if (code == EXIT_DONE && !there)
    code = take_folder(run);
  return code == EXIT_DONE ? run_to_end(run) : code;
}

enum exit_code run_scene(const struct run_options *options)
{
  struct run *run = calloc(1, sizeof *run);
  if (!run) {
    fprintf(stderr, "uncross: no memory to begin with\n");
    return EXIT_TROUBLE;
  }
  ignore_signals();
  run->options = options;
  run->lock = -1;
  enum exit_code code = EXIT_TROUBLE;
  if (!scene_read(options->scene, &run->scene, &run->message)) {
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
  if (run->lock >= 0)
    close(run->lock);
  scene_free(&run->scene);
  free(run);
  return code;
}
