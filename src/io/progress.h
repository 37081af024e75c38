/* How far a long computation is: one line that renews itself on a terminal, a plain line now and then elsewhere. */
#ifndef UNCROSS_PROGRESS_H
#define UNCROSS_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
  bool quiet, terminal;
  uint64_t first, last; /* steps between which this session works */
  double started, told; /* seconds, of clock_seconds */
};

/* Seconds since some fixed moment; never goes back. */
double clock_seconds(void);

/* Work from step `first` to step `last` begins. Output goes to stderr. */
void progress_begin(struct progress *progress, uint64_t first, uint64_t last, bool quiet);

/* Tells, if it is time to: every half second on a terminal, every 10 seconds elsewhere. */
void progress_tell(struct progress *progress, uint64_t step);

/* Clears the line on a terminal, so that other text can follow. */
void progress_end(struct progress *progress);

/* Steps per second so far, in this session. */
double progress_rate(const struct progress *progress, uint64_t step);

/* A duration as people say it: "45 s", "3 min 05 s", "2 h 10 min", "3 d 4 h". */
void duration_text(double seconds, char *text, unsigned size);

#endif
