#include "files/run.h"

#include "files/start.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/clock.h"
#include "files/checkpoint.h"
#include "files/folder.h"
#include "files/same_run.h"
#include "version.h"
#include "wall/motion.h"

/* --- how it starts ----------------------------------------------------------------------------------------------- */

/* Whether a run left something in the folder; the message is then its name. */
static bool find_left(const struct run *run, struct message *name)
{
  static const char *const ours[] = {"run.json", "trajectory.h5"};
  for (size_t k = 0; k < sizeof ours / sizeof *ours; k++) {
    message_set(name, "%s", ours[k]);
    if (folder_has(&run->folder, name->text))
      return true;
  }
  return output_left(run->parts.scene, run->parts.observers, &run->folder, name);
}

/* The folder must be new to a new run, and known to a resumed one: nothing is written over. */
static enum run_code check_folder(const struct run *run, struct message *message)
{
  const char *folder = run->name;
  struct message name;
  if (folder_has(&run->folder, "checkpoint.h5")) {
    if (run->resume)
      return RUN_FINE;
    message_set(message, "%s: holds a run already (checkpoint.h5); continue it with --resume, or name another folder",
                folder);
  } else if (find_left(run, &name)) {
    message_set(message,
                "%s: holds %s but no checkpoint.h5 (it is lost, or a run ended in its first moment, or the file is of "
                "something else); nothing can be resumed here and nothing is written over: name another folder",
                folder, name.text);
  } else if (run->resume) {
    message_set(message, "%s: nothing to resume, there is no checkpoint.h5; leave out --resume to start", folder);
  } else {
    return RUN_FINE;
  }
  return RUN_BAD_INPUT;
}

/* Makes the folder if it is missing, and locks it against other processes. */
static enum run_code take_folder(struct run *run, struct message *message)
{
  const enum folder_trouble trouble = folder_prepare(run->name, &run->made, message);
  if (trouble != FOLDER_FINE)
    return trouble == FOLDER_IS_NONE ? RUN_BAD_INPUT : RUN_NOT_WRITTEN;
  if (!folder_lock(&run->folder, message))
    return RUN_NOT_WRITTEN;
  snprintf(run->unlocked, sizeof run->unlocked, "%s", message->text);
  return check_folder(run, message);
}

bool run_is_ours(const struct run *run)
{
  return run->owner == getpid();
}

/* What could not begin. */
static enum run_code refused(const struct message *message)
{
  return message->kind == MESSAGE_NO_MEMORY ? RUN_NO_MEMORY : RUN_BAD_INPUT;
}

enum run_code run_begin(const struct run_parts *p, struct checkpoint_head *head, struct message *message)
{
  struct stream stream;
  if (!scene_start(p->scene, p->state, p->work, &stream, message))
    return refused(message);
  const struct conserved start = observe_conserved(&p->scene->model, p->state);
  *head = (struct checkpoint_head){.fingerprint = p->scene->fingerprint,
                                   .seed = p->scene->seed,
                                   .stream = stream,
                                   .state_hash = state_hash(p->state),
                                   .state_digest = state_digest(p->state),
                                   .start_energy = start.total,
                                   .start_momentum = start.momentum,
                                   .version = UNCROSS_VERSION};
  if (head->state_hash != 0 && isfinite(start.total))
    return RUN_FINE;
  message_no_memory(message, "no memory to look at the starting state");
  return RUN_NO_MEMORY;
}

enum run_code run_continue(const struct run_parts *p, const char *path, const uint64_t *seed,
                           struct checkpoint_head *head, struct message *message)
{
  const struct observe_block *blocks;
  const size_t count = observers_blocks(p->observers, &blocks);
  struct message why;
  const enum same_run same = same_run_as_begun(p->scene, path, seed, &why);
  const bool read =
      same != OTHER_RUN && checkpoint_read(path, &p->scene->model, head, p->state, blocks, count, message);
  if (same == OTHER_RUN || (read && same == SAME_RUN_UNKNOWN))
    *message = why;
  if (!read || same != SAME_RUN ||
      !same_run(p->scene, head, NULL, seed, path, message)) /* the file may have been another one meanwhile */
    return refused(message);
  p->scene->seed = head->seed;
  p->scene->model.seed = head->stream.key;
  shear_begin(&p->scene->model, head->slide);
  return RUN_FINE;
}

static enum run_code continue_in_folder(struct run *run, const uint64_t *seed, struct message *message)
{
  const struct run_parts *p = &run->parts;
  char path[4096];
  folder_path(&run->folder, "checkpoint.h5", path, sizeof path);
  const enum run_code code = run_continue(p, path, seed, &run->head, message);
  if (code != RUN_FINE)
    return code;
  if (!folder_in_place(&run->folder, message)) /* so what was read may be another run's */
    return RUN_NOT_WRITTEN;
  if (!output_whole(p->scene, p->observers, &run->folder, run->head.frames_end, message))
    return refused(message);
  run->earlier_seconds = run->head.wall_seconds;
  return RUN_FINE;
}

/* A folder that is there is taken before its files are read. One that is not there is made only when there is a state
 * to begin with: bad input leaves no folder. */
static enum run_code start_in_folder(struct run *run, const uint64_t *seed, struct message *message)
{
  if (!folder_name_fits(run->name, message))
    return RUN_BAD_INPUT;
  const bool there = folder_has(&run->folder, ".");
  enum run_code code = there ? take_folder(run, message) : check_folder(run, message);
  if (code == RUN_FINE)
    code = run->resume ? continue_in_folder(run, seed, message) : run_begin(&run->parts, &run->head, message);
  if (code == RUN_FINE && !there)
    code = take_folder(run, message);
  return code;
}

/* --- how it goes on and ends ------------------------------------------------------------------------------------- */

static double steps_per_second(const struct run *run)
{
  const double seconds = clock_seconds() - run->loop_started;
  return seconds > 0.0 ? (double)(run->parts.state->step - run->first_step) / seconds : 0.0;
}

static void take_record(struct run *run, const char *status)
{
  const struct run_parts *p = &run->parts;
  run->record = (struct record){.status = status,
                                .stream = run->head.stream,
                                .step = p->state->step,
                                .counts = p->state->counts,
                                .wall_seconds = run->head.wall_seconds,
                                .steps_per_second = steps_per_second(run),
                                .start_energy = run->head.start_energy,
                                .start_momentum = run->head.start_momentum,
                                .now = observe_conserved(&p->scene->model, p->state),
                                .state_hash = run->head.state_hash,
                                .state_digest = run->head.state_digest};
}

static bool write_record(const struct run *run, struct message *message)
{
  return record_write(&run->folder, run->parts.scene, &run->record, message);
}

static bool write_checkpoint(struct run *run, struct message *message)
{
  const struct run_parts *p = &run->parts;
  const struct observe_block *blocks;
  const size_t count = observers_blocks(p->observers, &blocks);
  run->head.wall_seconds = run->earlier_seconds + clock_seconds() - run->session_started;
  if (run->output.trajectory) /* else where it went to stays known */
    run->head.frames_end = trajectory_end(run->output.trajectory);
  run->last_checkpoint = clock_seconds();
  return checkpoint_write_in(&run->folder, "checkpoint.h5", &run->head, &p->scene->model, p->state, blocks, count,
                             p->scene->text, message);
}

static bool save(struct run *run, const char *status, struct message *message)
{
  const struct run_parts *p = &run->parts;
  if (!output_sync(&run->output, message) || !write_checkpoint(run, message))
    return false;
  take_record(run, status);
  return output_summaries(&run->output, p->observers, &p->scene->model, message) && write_record(run, message);
}

/* Says in run.json why the run cannot go on; its numbers stay those of the last checkpoint. */
static enum run_code stop(struct run *run, enum run_code code, const struct message *message)
{
  struct message ignored;
  snprintf(run->reason, sizeof run->reason, "%s", message->text);
  run->record.status = "stopped";
  run->record.reason = run->reason;
  write_record(run, &ignored);
  run->over = true;
  return code;
}

/* What the run's folder gets of this step. */
static bool show(struct run *run, struct message *message)
{
  const struct run_parts *p = &run->parts;
  return output_sample(&run->output, p->observers, &p->scene->model, p->state, message);
}

#define FIRST_INTERVAL 10.0 /* s, or the scene's if that is shorter: a run that is killed soon loses little */

static bool checkpoint_due(struct run *run)
{
  const double every = run->parts.scene->checkpoint_seconds;
  const double interval = run->first_interval ? fmin(every, FIRST_INTERVAL) : every;
  const bool due = every > 0.0 && clock_seconds() - run->last_checkpoint >= interval;
  run->first_interval = run->first_interval && !due;
  return due;
}

/* What a new run made in its folder, which held none of these files before. */
static void remove_all(struct run *run)
{
  struct message ignored;
  output_close(&run->output, &ignored);
  run->writing = false;
  output_remove(run->parts.scene, run->parts.observers, &run->folder);
  folder_remove(&run->folder, "checkpoint.h5");
  folder_remove(&run->folder, "run.json");
}

/* The checkpoint of a new run comes first, before anything is sampled: whenever the run is killed, its folder holds
 * nothing, or can be resumed. A resume at step 0 samples what may be sampled already, which changes nothing then. The
 * message is a note if all went well. */
static bool begin_output(struct run *run, struct message *message)
{
  const struct run_parts *p = &run->parts;
  struct message trouble;
  if (!(run->resume || write_checkpoint(run, message)) ||
      !output_open(&run->output, p->scene, p->observers, &run->folder, run->resume, run->head.frames_end,
                   p->state->step, message))
    return false;
  run->opened = true;
  run->first_step = p->state->step;
  run->first_interval = true;
  run->loop_started = clock_seconds();
  take_record(run, "running");
  if ((p->state->step > 0 || show(run, &trouble)) && write_record(run, &trouble))
    return true;
  *message = trouble;
  return false;
}

static enum run_code open_files(struct run *run, struct message *message)
{
  run->writing = true;
  if (begin_output(run, message))
    return RUN_FINE;
  if (!run->resume)
    remove_all(run);
  return run->opened && run->resume ? stop(run, RUN_NOT_WRITTEN, message) : RUN_NOT_WRITTEN;
}

/* Whatever is open, without saving; the folder is anybody's then. */
static void close_all(struct run *run)
{
  struct message ignored;
  if (run->writing)
    output_close(&run->output, &ignored);
  folder_close(&run->folder);
  run->writing = false;
  run->over = true;
}

/* Adds a sentence to a note. */
static void add_note(void *note, const char *text)
{
  struct message *message = note;
  message_set(message, "%s%s%s", message->text, message->text[0] != '\0' ? "; " : "", text);
}

static void add_warning(void *note, const char *text)
{
  struct message warning;
  message_set(&warning, "warning: %s", text);
  add_note(note, warning.text);
}

enum run_code run_open(struct run *run, const struct run_parts *parts, const char *folder, bool resume,
                       const uint64_t *seed, struct message *message)
{
  *run = (struct run){.parts = *parts, .owner = getpid(), .resume = resume, .made = SIZE_MAX};
  run->name = strdup(folder);
  run->folder = (struct folder){run->name, FOLDER_BY_NAME};
  message_no_memory(message, "no memory for the name of the folder");
  if (!run->name)
    return RUN_NO_MEMORY;
  run->session_started = run->last_checkpoint = run->loop_started = clock_seconds();
  enum run_code code = start_in_folder(run, seed, message);
  if (code == RUN_FINE) {
    message_set(message, "%s", "");
    if (parts->state->step <= parts->scene->steps)
      code = open_files(run, message);
    if (code == RUN_FINE && run->unlocked[0] != '\0')
      add_note(message, run->unlocked);
    if (code == RUN_FINE)
      start_warnings(parts->scene, &run->head.stream, add_warning, message);
  }
  if (code != RUN_FINE) {
    close_all(run);
    folder_unmake(run->name, run->made);
    run_release(run);
  }
  return code;
}

enum run_code run_advance(struct run *run, uint64_t steps, bool (*keep_on)(void *context), void *context,
                          struct message *message)
{
  const struct run_parts *p = &run->parts;
  if (run->over) {
    message_set(message, "%s: this run is over%s%s", run->name, run->reason[0] ? ": " : "", run->reason);
    return RUN_BAD_INPUT;
  }
  for (uint64_t k = 0; k < steps && p->state->step < p->scene->steps; k++) {
    if (!step_advance(p->state, &p->scene->model, p->work, observers_contacts(p->observers))) {
      message_fault(message, &p->work->fault);
      return stop(run, RUN_STOPPED, message);
    }
    if (!show(run, message) || (checkpoint_due(run) && !save(run, "running", message)))
      return stop(run, RUN_NOT_WRITTEN, message);
    if (keep_on && !keep_on(context))
      break;
    if (run->over) { /* keep_on closed it, or could not save it */
      message_set(message, "%s: this run is over: %s", run->name, run->reason);
      return run->reason[0] ? RUN_NOT_WRITTEN : RUN_FINE;
    }
  }
  return RUN_FINE;
}

enum run_code run_save(struct run *run, struct message *message)
{
  if (run->over || !run->writing) {
    message_set(message, "%s: this run is over, nothing more is saved", run->name);
    return RUN_BAD_INPUT;
  }
  return save(run, "running", message) ? RUN_FINE : stop(run, RUN_NOT_WRITTEN, message);
}

/* What a user has to know who looks for the files. */
static void note_place(const struct run *run, struct message *note)
{
  struct message moved;
  const bool here = folder_in_place(&run->folder, &moved);
  message_set(note, "%s%s", here ? "" : moved.text, here ? "" : "; all files of this run are in that one");
}

enum run_code run_close(struct run *run, struct message *message)
{
  enum run_code code = RUN_FINE;
  if (run->writing && !run->over) {
    const bool done = run->parts.state->step >= run->parts.scene->steps;
    if (!save(run, done ? "finished" : "interrupted", message))
      code = stop(run, RUN_NOT_WRITTEN, message);
    struct message trouble;
    if (!output_close(&run->output, &trouble) && code == RUN_FINE) {
      *message = trouble;
      code = stop(run, RUN_NOT_WRITTEN, message);
    }
    run->writing = false;
  }
  if (code == RUN_FINE)
    note_place(run, message);
  close_all(run);
  return code;
}

void run_release(struct run *run)
{
  close_all(run);
  free(run->name);
  run->name = NULL;
}
