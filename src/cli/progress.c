#include "cli/progress.h"

#include <inttypes.h>
#include <stdio.h>
#include <unistd.h>

#include "base/clock.h"

void progress_begin(struct progress *p, uint64_t first, uint64_t last, bool quiet)
{
  double now = clock_seconds();
  *p = (struct progress){quiet, isatty(STDERR_FILENO) == 1, first, last, now, now};
}

double progress_seconds(const struct progress *p)
{
  return clock_seconds() - p->started;
}

double progress_rate(const struct progress *p, uint64_t step)
{
  double seconds = progress_seconds(p);
  return seconds > 0.0 ? (double)(step - p->first) / seconds : 0.0;
}

void duration_text(double seconds, char *text, unsigned size)
{
  uint64_t s = (uint64_t)(seconds + 0.5);
  if (s < 60)
    snprintf(text, size, "%" PRIu64 " s", s);
  else if (s < 3600)
    snprintf(text, size, "%" PRIu64 " min %02" PRIu64 " s", s / 60, s % 60);
  else if (s < 86400)
    snprintf(text, size, "%" PRIu64 " h %02" PRIu64 " min", s / 3600, s % 3600 / 60);
  else
    snprintf(text, size, "%" PRIu64 " d %" PRIu64 " h", s / 86400, s % 86400 / 3600);
}

void progress_tell(struct progress *p, uint64_t step)
{
  if (p->quiet)
    return;
  double now = clock_seconds();
  if (now - p->told < (p->terminal ? 0.5 : 10.0))
    return;
  p->told = now;
  double rate = progress_rate(p, step);
  char left[64] = "?";
  if (rate > 0.0)
    duration_text((double)(p->last - step) / rate, left, sizeof left);
  fprintf(stderr, "%sstep %" PRIu64 " of %" PRIu64 " (%.1f %%), %.1f steps/s, %s left%s", p->terminal ? "\r\033[K" : "",
          step, p->last, 100.0 * (double)step / (double)p->last, rate, left, p->terminal ? "" : "\n");
  fflush(stderr);
}

void progress_end(struct progress *p)
{
  if (!p->quiet && p->terminal)
    fputs("\r\033[K", stderr);
}
