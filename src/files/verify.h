/* Whether files are what was written: `uncross verify`, and the last line of `uncross info`. */
#ifndef UNCROSS_FILES_VERIFY_H
#define UNCROSS_FILES_VERIFY_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "base/message.h"
#include "files/frames.h"

/* The worst that was found. */
enum condition {
  CONDITION_WHOLE,
  CONDITION_UNKNOWN, /* not there, not readable, in use, or no file that this program knows */
  CONDITION_DAMAGED
};

/* Each prints a line `FILE: whole: why this is known`, `FILE: readable: what was not checked`, or one line for each
 * damage found, and returns the worst. */

/* Reads all frames of an open file. */
enum condition verify_frames(struct frames *frames, FILE *out);

/* A checkpoint, trajectory, table or run.json. A file that may be a pack is left to others: `other` is set to true, and
 * nothing is printed. */
enum condition verify_file(const char *path, bool *other, FILE *out);

/* All files of a run, and whether they fit each other. */
enum condition verify_folder(const char *folder, FILE *out);

#endif
