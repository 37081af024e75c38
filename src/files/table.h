/* Tables of numbers as CSV: a header line of column names, then rows of the shortest decimals that read back. */
#ifndef UNCROSS_FILES_TABLE_H
#define UNCROSS_FILES_TABLE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/message.h"
#include "files/folder.h"
#include "observe/observe.h"

/* A time series that grows: one file, one row per sample, its first column the step. */
struct series {
  FILE *file;      /* NULL: not open */
  char path[4096]; /* for messages */
};

/* Creates folder/name.csv with its header line, where there must be none (end = 0); or opens the one that is there and
 * keeps its rows up to that of step end - 1 (a run that was interrupted may have written more after its last
 * checkpoint). */
bool series_open(struct series *series, const struct folder *folder, const char *name, size_t columns,
                 const char *const *names, uint64_t end, struct message *message);
/* The end of folder/name.csv: 1 + the step of the last row before `end`, of those that are whole and come after whole
 * ones; 0 if there is none, or the file is missing or has another header. */
bool series_find_end(const struct folder *folder, const char *name, size_t columns, const char *const *names,
                     uint64_t end, uint64_t *found, struct message *message);
bool series_row(struct series *series, uint64_t step, size_t columns, const double *values, struct message *message);
/* Waits until all rows are on the disk. */
bool series_sync(struct series *series, struct message *message);
bool series_close(struct series *series, struct message *message);

/* Writes a summary as folder/name.csv, in place of an earlier one. */
bool table_write(const struct folder *folder, const struct observe_table *table, struct message *message);

/* Whether folder/name.csv has the columns of this summary, and as many rows; false, with a message, if not. Numbers are
 * not compared. */
bool table_fits(const struct folder *folder, const struct observe_table *table, struct message *message);

/* Number of columns that a first line names. */
size_t table_columns(const char *line);

#endif
