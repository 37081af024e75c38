#include "io/output.h"

#include <stdio.h>

static bool open_series(struct output *o, const struct observe_plan *plan, bool resume, uint64_t step,
                        struct message *message)
{
  for (int k = 0; k < OBSERVABLES; k++) {
    const char *const *names;
    size_t columns = observe_series_columns((enum observable)k, &names);
    if (plan->every[k] > 0 && columns > 0 &&
        !series_open(&o->series[k], o->folder, observable_names[k], columns, names, resume, step, message))
      return false;
  }
  return true;
}

bool output_open(struct output *o, const struct scene *scene, const char *folder, bool resume, uint64_t step,
                 struct message *message)
{
  *o = (struct output){.folder = folder, .trajectory_every = scene->trajectory_every};
  if (!open_series(o, &scene->observe, resume, step, message))
    return false;
  if (o->trajectory_every == 0)
    return true;
  char path[4096];
  snprintf(path, sizeof path, "%s/trajectory.h5", folder);
  const struct trajectory_options options = {
      .solvent = scene->trajectory_solvent, .velocities = scene->trajectory_velocities, .seed = scene->model.seed};
  o->trajectory = trajectory_open(path, &scene->model, &options, resume, step, scene->text, message);
  return o->trajectory != NULL;
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
    message_set(message, "no memory for the observables of step %llu", (unsigned long long)state->step);
    if (!observers_sample(observers, model, state, &sink))
      return false;
  }
  return !o->trajectory || state->step % o->trajectory_every != 0 ||
         trajectory_append(o->trajectory, model, state, message);
}

bool output_flush(struct output *o, struct message *message)
{
  for (int k = 0; k < OBSERVABLES; k++)
    if (!series_flush(&o->series[k], message))
      return false;
  return true;
}

struct table_context {
  const char *folder;
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
