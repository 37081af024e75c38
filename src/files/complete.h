/* Whether a run's folder has all that its checkpoint speaks of. */
#ifndef UNCROSS_FILES_COMPLETE_H
#define UNCROSS_FILES_COMPLETE_H

#include <stdbool.h>
#include <stdio.h>

#include "files/verify.h"

/* Says on `out` that the file is missing, and why it is looked for. */
enum condition complete_has(const char *folder, const char *file, const char *why, FILE *out);

struct complete_wish {
  bool averages; /* not only what grows */
  bool finished; /* the run is: its averages are those of the checkpoint */
  bool whole;    /* all files that are there can be read, and are whole by themselves */
};

/* All files that the scene in the checkpoint asks for. If those that are there are whole, time series and frames must
 * go as far as the checkpoint; of a run that is finished, averages must have the columns and rows that the checkpoint's
 * memory of observables makes. Numbers in them are not compared. Says what is wrong on `out`. */
enum condition complete_check(const char *folder, const char *checkpoint, const struct complete_wish *wish, FILE *out);

#endif
