/* What the tests of observables share: summaries kept by name, and rows of time series. */
#ifndef UNCROSS_TESTS_TABLES_H
#define UNCROSS_TESTS_TABLES_H

#include "support.h"

#include "observe/observe.h"

enum { KEPT_TABLES = 8, KEPT_VALUES = 4096 };

struct kept_table {
  char name[128];
  const char *column[OBSERVE_MOST_COLUMNS];
  size_t columns, rows;
  double value[KEPT_VALUES];
};

struct kept {
  struct kept_table table[KEPT_TABLES];
  size_t tables;
};

static inline bool keep_table(void *context, const struct observe_table *table)
{
  struct kept *kept = context;
  assert_true(kept->tables < KEPT_TABLES && table->columns * table->rows <= KEPT_VALUES);
  struct kept_table *t = &kept->table[kept->tables++];
  snprintf(t->name, sizeof t->name, "%s", table->name);
  memcpy(t->column, table->column, table->columns * sizeof *t->column);
  t->columns = table->columns;
  t->rows = table->rows;
  memcpy(t->value, table->value, table->columns * table->rows * sizeof *t->value);
  return true;
}

/* All summaries as they stand now; to be freed. */
static inline struct kept *keep_summaries(const struct observers *observers, const struct model *model)
{
  struct kept *kept = calloc(1, sizeof *kept);
  assert_non_null(kept);
  assert_true(observers_summaries(observers, model, keep_table, kept));
  return kept;
}

/* A value by table, row and column. */
static inline double kept_value(const struct kept *kept, const char *table, size_t row, const char *column)
{
  for (size_t i = 0; i < kept->tables; i++) {
    const struct kept_table *t = &kept->table[i];
    for (size_t c = 0; strcmp(t->name, table) == 0 && c < t->columns; c++)
      if (strcmp(t->column[c], column) == 0 && row < t->rows)
        return t->value[row * t->columns + c];
  }
  fail_msg("no %s in row %zu of table %s", column, row, table);
  return NAN;
}

/* Rows of all series, one after another, each preceded by the observable's number. */
struct kept_rows {
  size_t count, rows;
  double value[1 << 16];
};

static inline bool keep_row(void *context, enum observable which, size_t columns, const double *values)
{
  struct kept_rows *kept = context;
  assert_true(kept->count + columns + 1 <= sizeof kept->value / sizeof *kept->value);
  kept->value[kept->count] = (double)which;
  memcpy(kept->value + kept->count + 1, values, columns * sizeof *values);
  kept->count += columns + 1;
  kept->rows++;
  return true;
}

/* A value by row, from 0 on, and column; of rows of one observable alone. */
static inline double kept_cell(const struct kept_rows *kept, const struct model *model, enum observable which,
                               size_t row, const char *column)
{
  const char *names[OBSERVE_MOST_COLUMNS];
  const size_t columns = observe_series_columns(model, which, names);
  assert_true(row < kept->rows && kept->count == kept->rows * (columns + 1));
  for (size_t k = 0; k < columns; k++)
    if (strcmp(names[k], column) == 0)
      return kept->value[row * (columns + 1) + 1 + k];
  fail_msg("no column %s", column);
  return NAN;
}

/* A state whose positions a test moves by itself: no solvent, no dynamics. */
struct puppet {
  struct model model;
  struct state state;
  struct observers *observers;
};

static inline struct puppet puppet_start(struct model model, enum observable which, uint64_t every, uint64_t longest)
{
  struct puppet p = {.model = model};
  struct observe_plan plan = {.longest_lag = longest};
  plan.every[which] = every;
  test_finish(&p.model);
  assert_true(state_alloc(&p.state, &p.model));
  assert_non_null(p.observers = observers_create(&plan, &p.model));
  return p;
}

static inline void puppet_sample(struct puppet *p)
{
  assert_true(observers_sample(p->observers, &p->model, &p->state, NULL));
}

static inline void puppet_end(struct puppet *p)
{
  observers_free(p->observers);
  state_free(&p->state);
  model_free(&p->model);
}

#endif
