/* Progress of a long computation: on a terminal one line that is renewed, elsewhere a line now and then. */
#ifndef UNCROSS_CLI_PROGRESS_H
#define UNCROSS_CLI_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
  bool quiet, terminal;
  uint64_t first, last; /* steps between which this session works */
  double started, told; /* seconds, of clock_seconds */
};

/* Work from step `first` to step `last` begins. Output goes to stderr. */
void progress_begin(struct progress *progress, uint64_t first, uint64_t last, bool quiet);

/* Prints the progress if it is time: every half second on a terminal, every 10 seconds elsewhere. */
void progress_tell(struct progress *progress, uint64_t step);

/* Clears the line on a terminal, so that other text can follow. */
void progress_end(struct progress *progress);

/* Seconds, and steps per second, since the work began. */
double progress_seconds(const struct progress *progress);
double progress_rate(const struct progress *progress, uint64_t step);

/* A duration in words: "45 s", "3 min 05 s", "2 h 10 min", "3 d 4 h". */
void duration_text(double seconds, char *text, unsigned size);

#endif
