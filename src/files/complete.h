/* Whether a run's folder has all that its checkpoint speaks of. */
#ifndef UNCROSS_FILES_COMPLETE_H
#define UNCROSS_FILES_COMPLETE_H

#include <stdbool.h>
#include <stdio.h>

#include "files/verify.h"

/* Says on `out` that the file is missing, and why it is looked for. */
enum condition complete_has(const char *folder, const char *file, const char *why, FILE *out);

/* All files that the scene in the checkpoint asks for; averages, or only those that grow. Time series and frames must
 * go as far as the checkpoint; of a run that is finished, averages must have the columns and rows that the checkpoint's
 * memory of observables makes. Numbers in them are not compared. Says what is wrong on `out`. */
enum condition complete_check(const char *folder, const char *checkpoint, bool averages, bool finished, FILE *out);

#endif
