/* Tables of simulations in memory: their own copies of what observers give. */
#include <stdlib.h>
#include <string.h>

#include "api/handle.h"

static void table_clear(struct table *t)
{
  for (size_t k = 0; t->column && k < t->face.columns; k++)
    free(t->column[k]);
  free(t->column);
  free(t->name);
  free(t->value);
  *t = (struct table){.name = NULL};
}

static void forget_summaries(struct uncross_sim *sim)
{
  for (size_t k = 0; k < sim->summaries; k++)
    table_clear(&sim->summary[k]);
  free(sim->summary);
  free(sim->listed);
  sim->summary = NULL;
  sim->listed = NULL;
  sim->summaries = 0;
}

void tables_clear(struct uncross_sim *sim)
{
  forget_summaries(sim);
  for (int k = 0; k < OBSERVABLES; k++)
    table_clear(&sim->series[k]);
}

/* A table without rows. leads: a first column of its own, or NULL. */
static bool table_make(struct table *t, const char *name, const char *leads, const char *const *column, size_t columns)
{
  const size_t own = leads ? 1 : 0;
  t->name = strdup(name);
  t->column = calloc(columns + own + 1, sizeof *t->column);
  bool ok = t->name && t->column;
  t->face.columns = columns + own;
  if (ok && leads)
    ok = (t->column[0] = strdup(leads)) != NULL;
  for (size_t k = 0; ok && k < columns; k++)
    ok = (t->column[own + k] = strdup(column[k])) != NULL;
  t->face.name = t->name;
  t->face.column = (const char *const *)t->column;
  return ok;
}

/* Room for one more row at its end; NULL if memory is short. */
static double *table_row(struct table *t)
{
  if (t->face.rows == t->room) {
    const size_t room = t->room ? 2 * t->room : 16;
    double *bigger = realloc(t->value, room * t->face.columns * sizeof *bigger);
    if (!bigger)
      return NULL;
    t->value = bigger;
    t->room = room;
    t->face.value = bigger;
  }
  return &t->value[t->face.rows++ * t->face.columns];
}

static bool take_row(void *context, enum observable which, size_t columns, const double *values)
{
  struct uncross_sim *sim = context;
  double *row = table_row(&sim->series[which]);
  if (!row)
    return false;
  row[0] = (double)sim->state.step;
  memcpy(row + 1, values, columns * sizeof *row);
  return true;
}

bool tables_sample(struct uncross_sim *sim)
{
  const struct observe_sink sink = {take_row, sim};
  return !observers_due(sim->observers, sim->state.step) ||
         observers_sample(sim->observers, &sim->scene.model, &sim->state, &sink);
}

bool tables_begin(struct uncross_sim *sim)
{
  for (int k = 0; k < OBSERVABLES; k++) {
    const char *names[OBSERVE_MOST_COLUMNS];
    const struct scene *scene = &sim->scene;
    const size_t columns =
        scene->observe.every[k] > 0 ? observe_series_columns(&scene->model, (enum observable)k, names) : 0;
    if (columns > 0 && !table_make(&sim->series[k], observable_names[k], "step", names, columns))
      return false;
  }
  return true;
}

static bool take_summary(void *context, const struct observe_table *from)
{
  struct uncross_sim *sim = context;
  struct table *more = realloc(sim->summary, (sim->summaries + 1) * sizeof *more);
  if (!more)
    return false;
  sim->summary = more;
  struct table *t = &more[sim->summaries++];
  *t = (struct table){.name = NULL};
  const size_t values = from->rows * from->columns;
  t->value = malloc((values + 1) * sizeof *t->value);
  if (!t->value || !table_make(t, from->name, NULL, from->column, from->columns))
    return false;
  if (values > 0)
    memcpy(t->value, from->value, values * sizeof *t->value);
  t->face.value = t->value;
  t->face.rows = from->rows;
  return true;
}

static bool list_tables(struct uncross_sim *sim, size_t *count)
{
  forget_summaries(sim);
  if (!observers_summaries(sim->observers, &sim->scene.model, take_summary, sim))
    return false;
  sim->listed =
      calloc(OBSERVABLES + sim->summaries, sizeof *sim->listed); /* NOLINT(bugprone-sizeof-expression): pointers */
  if (!sim->listed)
    return false;
  *count = 0;
  for (int k = 0; k < OBSERVABLES; k++)
    if (sim->series[k].face.columns > 0)
      sim->listed[(*count)++] = &sim->series[k].face;
  for (size_t k = 0; k < sim->summaries; k++)
    sim->listed[(*count)++] = &sim->summary[k].face;
  return true;
}

/* The tables are no part of what the caller may not change: they are made anew from it. */
int uncross_sim_tables(const uncross_sim *of, const uncross_table *const **tables, size_t *count, uncross_error *error)
{
  struct uncross_sim *sim = (struct uncross_sim *)of;
  if (!sim || !tables || !count)
    return fail_null(error, "sim, tables or count");
  struct call call;
  call_begin(&call, false);
  const bool ok = list_tables(sim, count);
  call_end(&call);
  if (!ok)
    return fail(error, UNCROSS_NO_MEMORY, "no memory for tables", NULL);
  *tables = sim->listed;
  return UNCROSS_OK;
}
