/* What run.json tells of a run, held against its checkpoint. */
#ifndef UNCROSS_FILES_TOLD_H
#define UNCROSS_FILES_TOLD_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "files/checkpoint.h"
#include "files/verify.h"

struct told {
  bool there, finished;
  uint64_t step; /* of its numbers */
};

/* What can be known of it; a record that cannot be read tells nothing. */
struct told told_of(const char *folder);

/* Whether it is a record of the run of this checkpoint. It is written after its checkpoint: so it may be older, but not
 * newer, and of one step both have one state. Says on `out` what is wrong. */
enum condition told_check(const char *folder, const struct checkpoint_summary *summary, FILE *out);

#endif
