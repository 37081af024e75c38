#include "files/output.h"

#include <inttypes.h>
#include <stdio.h>

#include "files/same_run.h"

/* Columns of the time series that the scene asks for, 0 if it does not or this is none. */
static size_t wanted_columns(const struct scene *scene, int which, const char *names[OBSERVE_MOST_COLUMNS])
{
  const bool wanted = scene->observe.every[which] > 0;
  return wanted ? observe_series_columns(&scene->model, (enum observable)which, names) : 0;
}

/* --- what is there already --------------------------------------------------------------------------------------- */

struct search {
  const struct folder *folder;
  struct message *name;
};

static bool is_absent(const struct search *s, const char *table)
{
  message_set(s->name, "%s.csv", table);
  return !folder_has(s->folder, s->name->text);
}

static bool take_absent(void *context, const struct observe_table *table)
{
  return is_absent(context, table->name);
}

bool output_left(const struct scene *scene, const struct observers *observers, const struct folder *folder,
                 struct message *name)
{
  struct search search = {folder, name};
  const char *names[OBSERVE_MOST_COLUMNS];
  for (int k = 0; k < OBSERVABLES; k++)
    if (wanted_columns(scene, k, names) > 0 && !is_absent(&search, observable_names[k]))
      return true;
  return !observers_summaries(observers, &scene->model, take_absent, &search);
}

struct listing {
  void (*take)(void *context, const char *file);
  void *context;
};

static bool list_table(void *context, const struct observe_table *table)
{
  const struct listing *l = context;
  char file[128];
  snprintf(file, sizeof file, "%s.csv", table->name);
  l->take(l->context, file);
  return true;
}

void output_files(const struct scene *scene, const struct observers *observers,
                  void (*take)(void *context, const char *file), void *context)
{
  struct listing listing = {take, context};
  const char *names[OBSERVE_MOST_COLUMNS];
  for (int k = 0; k < OBSERVABLES; k++)
    if (wanted_columns(scene, k, names) > 0)
      list_table(&listing, &(struct observe_table){.name = observable_names[k]});
  if (observers)
    observers_summaries(observers, &scene->model, list_table, &listing);
  if (scene->trajectory_every > 0)
    take(context, "trajectory.h5");
}

static void remove_file(void *folder, const char *file)
{
  folder_remove(folder, file);
}

void output_remove(const struct scene *scene, const struct observers *observers, const struct folder *folder)
{
  struct folder of_run = *folder;
  output_files(scene, observers, remove_file, &of_run);
}

/* Ends are 1 + a step, 0 before the first. */
static bool same_end(const struct folder *folder, const char *file, uint64_t found, uint64_t end, const char *otherwise,
                     struct message *message)
{
  char where[64] = "is missing, has other columns, or holds nothing of this run";
  if (found > 0)
    snprintf(where, sizeof where, "ends at step %" PRIu64, found - 1);
  return found == end || message_set(message,
                                     "%s/%s: %s, but went to step %" PRIu64
                                     " when the checkpoint was written (changed, or lost with the "
                                     "machine); put the whole file back, or %s",
                                     folder->name, file, where, end - 1, otherwise);
}

static struct trajectory_options options_of(const struct scene *scene, const struct folder *folder)
{
  return (struct trajectory_options){.solvent = scene->trajectory_solvent,
                                     .velocities = scene->trajectory_velocities,
                                     .seed = scene->seed,
                                     .stream = scene->model.seed,
                                     .fingerprint = scene->fingerprint,
                                     .folder = folder};
}

bool output_is_of_run(const struct scene *scene, const struct folder *folder, struct message *message)
{
  char path[4096];
  folder_path(folder, "trajectory.h5", path, sizeof path);
  const struct trajectory_options options = options_of(scene, folder);
  return !folder_has(folder, "trajectory.h5") || same_run_trajectory(path, &scene->model, &options, message);
}

bool output_whole(const struct scene *scene, const struct observers *observers, const struct folder *folder,
                  uint64_t frames_end, struct message *message)
{
  const char *names[OBSERVE_MOST_COLUMNS];
  uint64_t found;
  for (int k = 0; k < OBSERVABLES; k++) {
    const uint64_t end = observers_end(observers, (enum observable)k);
    char file[64];
    snprintf(file, sizeof file, "%s.csv", observable_names[k]);
    const size_t columns = wanted_columns(scene, k, names);
    if (columns > 0 &&
        !(series_find_end(folder, observable_names[k], columns, names, end, &found, message) &&
          same_end(folder, file, found, end, "resume without this table in the scene's `observe`", message)))
      return false;
  }
  char path[4096];
  folder_path(folder, "trajectory.h5", path, sizeof path);
  const struct trajectory_options options = options_of(scene, folder);
  return scene->trajectory_every == 0 ||
         (trajectory_fits(path, &scene->model, &options, message) &&
          (frames_end == 0 || !trajectory_find_end(path, frames_end - 1, &found) ||
           same_end(folder, "trajectory.h5", found, frames_end, "move it away to begin another", message)));
}

/* --- what a run writes ------------------------------------------------------------------------------------------- */

/* resume: a table of which the checkpoint has no row begins anew. */
static bool open_series(struct output *o, const struct scene *scene, const struct observers *observers, bool resume,
                        struct message *message)
{
  for (int k = 0; k < OBSERVABLES; k++) {
    const char *names[OBSERVE_MOST_COLUMNS];
    size_t columns = wanted_columns(scene, k, names);
    const uint64_t end = observers_end(observers, (enum observable)k);
    char file[64];
    snprintf(file, sizeof file, "%s.csv", observable_names[k]);
    if (columns > 0 && resume && end == 0)
      folder_remove(o->folder, file);
    if (columns > 0 && !series_open(&o->series[k], o->folder, observable_names[k], columns, names, end, message))
      return false;
  }
  return true;
}

/* What a resumed run has to say of frames that are missing before step `step`; frames_end as in checkpoint_head. */
static void tell_gap(const struct output *o, const char *path, bool there, uint64_t frames_end, uint64_t step,
                     struct message *message)
{
  if (!there && frames_end == 0)
    message_set(message, "%s: there was none; its frames begin after step %" PRIu64, path, step);
  else if (!there)
    message_set(message, "%s: is gone, it went to step %" PRIu64 "; the frames of a new one begin after step %" PRIu64,
                path, frames_end - 1, step);
  else if (frames_end > 0 && step - (frames_end - 1) > o->trajectory_every)
    message_set(message, "%s: without frames from step %" PRIu64 " to %" PRIu64, path, frames_end - 1, step);
}

static bool open_trajectory(struct output *o, const struct scene *scene, bool resume, uint64_t frames_end,
                            uint64_t step, struct message *message)
{
  char path[4096];
  folder_path(o->folder, "trajectory.h5", path, sizeof path);
  const bool there = folder_has(o->folder, "trajectory.h5");
  const struct trajectory_options options = options_of(scene, o->folder);
  o->trajectory = trajectory_open(path, &scene->model, &options, resume, step, scene->text, message);
  if (o->trajectory && resume && step > 0 && message->text[0] == '\0')
    tell_gap(o, path, there, frames_end, step, message);
  return o->trajectory != NULL;
}

/* The trajectory comes first: if another program has it open, no table is touched. */
bool output_open(struct output *o, const struct scene *scene, const struct observers *observers,
                 const struct folder *folder, bool resume, uint64_t frames_end, uint64_t step, struct message *message)
{
  *o = (struct output){.folder = folder, .trajectory_every = scene->trajectory_every};
  message_set(message, "%s", "");
  return (o->trajectory_every == 0 || open_trajectory(o, scene, resume, frames_end, step, message)) &&
         open_series(o, scene, observers, resume, message);
}

struct row_context {
  struct output *output;
  uint64_t step;
  struct message *message;
};

static bool take_row(void *context, enum observable which, size_t columns, const double *values)
{
  struct row_context *c = context;
  return series_row(&c->output->series[which], c->step, columns, values, c->message);
}

bool output_sample(struct output *o, struct observers *observers, const struct model *model, const struct state *state,
                   struct message *message)
{
  struct row_context context = {o, state->step, message};
  const struct observe_sink sink = {take_row, &context};
  if (observers_due(observers, state->step)) {
    message_no_memory(message, "no memory for the observables of step %llu", (unsigned long long)state->step);
    if (!observers_sample(observers, model, state, &sink))
      return false;
  }
  return !o->trajectory || state->step % o->trajectory_every != 0 ||
         trajectory_append(o->trajectory, model, state, message);
}

/* A file whose name is gone would end with the run, and nobody would know. */
static bool still_named(const struct output *o, const char *file, int fd, struct message *message)
{
  struct message why;
  return folder_holds(o->folder, file, fd, &why) ||
         message_set(message, "%s/%s: was deleted or replaced while the run wrote it", o->folder->name, file);
}

bool output_sync(struct output *o, struct message *message)
{
  for (int k = 0; k < OBSERVABLES; k++) {
    char file[64];
    snprintf(file, sizeof file, "%s.csv", observable_names[k]);
    if (!series_sync(&o->series[k], message) ||
        (o->series[k].file && !still_named(o, file, fileno(o->series[k].file), message)))
      return false;
  }
  return !o->trajectory || (trajectory_sync(o->trajectory, message) &&
                            still_named(o, "trajectory.h5", trajectory_descriptor(o->trajectory), message));
}

struct table_context {
  const struct folder *folder;
  struct message *message;
};

static bool take_table(void *context, const struct observe_table *table)
{
  struct table_context *c = context;
  return table_write(c->folder, table, c->message);
}

bool output_summaries(struct output *o, const struct observers *observers, const struct model *model,
                      struct message *message)
{
  struct table_context context = {o->folder, message};
  message_no_memory(message, "%s: no memory for the tables", o->folder->name); /* unless a table says what failed */
  return observers_summaries(observers, model, take_table, &context);
}

bool output_close(struct output *o, struct message *message)
{
  bool ok = true;
  for (int k = 0; k < OBSERVABLES; k++)
    ok = series_close(&o->series[k], message) && ok;
  if (o->trajectory)
    ok = trajectory_close(o->trajectory, message) && ok;
  o->trajectory = NULL;
  return ok;
}
