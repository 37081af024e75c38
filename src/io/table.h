/* Tables of numbers as CSV: a header line of column names, then rows with 17 significant digits. */
#ifndef UNCROSS_TABLE_H
#define UNCROSS_TABLE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "io/message.h"
#include "observe/observe.h"

/* A time series that grows: one file, one row per sample, its first column the step. */
struct series {
  FILE *file; /* NULL: not open */
  char path[4096];
};

/* Creates the file with its header line. If `resume`, keeps what is there up to and including row `keep_to_step` (a run
 * that was interrupted may have written rows after its last checkpoint). */
bool series_open(struct series *series, const char *folder, const char *name, size_t columns, const char *const *names,
                 bool resume, uint64_t keep_to_step, struct message *message);
bool series_row(struct series *series, uint64_t step, size_t columns, const double *values, struct message *message);
bool series_flush(struct series *series, struct message *message);
bool series_close(struct series *series, struct message *message);

/* Writes a summary as folder/name.csv, in place of an earlier one. */
bool table_write(const char *folder, const struct observe_table *table, struct message *message);

#endif
