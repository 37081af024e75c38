#include "oracle/judge.h"

#include <math.h>
#include <string.h>

#include "base/student.h"

#define NORMAL_90 1.2815515655446004 /* what a normal deviate is below with 90 % probability */

struct judgement judge_one(const struct observable_mean *ours, const struct observable_mean *theirs, double level)
{
  struct judgement j = {
      .ours = ours, .theirs = theirs, .difference = NAN, .error = NAN, .t = NAN, .p = 1.0, .sees = NAN};
  if (!theirs)
    return j;
  j.difference = theirs->value - ours->value;
  j.error = hypot(ours->error, theirs->error);
  j.freedoms = student_welch(ours->error, ours->blocks, theirs->error, theirs->blocks);
  j.t = j.difference / j.error;
  if (fmin(ours->blocks, theirs->blocks) < JUDGE_LEAST_BLOCKS)
    return j;
  j.p = student_tail(fabs(j.t), j.freedoms);
  /* A normal deviate about `away` exceeds `limit` estimated errors, which scatter by 1/sqrt(2 freedoms) about
   * 1 - 1/(4 freedoms): the non-central t to first order, as Johnson and Welch, Biometrika 31, 362 (1940). */
  const double limit = student_quantile(level, j.freedoms);
  const double away = limit * (1.0 - 0.25 / j.freedoms) + NORMAL_90 * sqrt(1.0 + 0.5 * limit * limit / j.freedoms);
  j.sees = away * j.error / fabs(ours->value);
  j.judged = j.sees <= ours->resolve;
  return j;
}

void judge_together(struct judgement *judgement, size_t count, double false_alarm)
{
  for (size_t left = count; left > 0; left--) {
    struct judgement *least = NULL;
    for (size_t k = 0; k < count; k++)
      if (!judgement[k].differs && (!least || judgement[k].p < least->p))
        least = &judgement[k];
    if (least->p > false_alarm / (double)left)
      return;
    least->differs = true;
  }
}

/* --- which -------------------------------------------------------------------------------------------------------- */

/* Judges what is asked for. The number of judgements. */
static size_t judge_all(const struct observable_means *ours, const struct observable_means *theirs, const bool *chosen,
                        double false_alarm, struct judgement *judgement)
{
  size_t count = 0, done = 0;
  for (size_t k = 0; k < ours->count; k++)
    count += chosen[k];
  for (size_t k = 0; k < ours->count; k++)
    if (chosen[k])
      judgement[done++] =
          judge_one(&ours->row[k], observable_means_find(theirs, ours->row[k].name), false_alarm / (double)count);
  judge_together(judgement, count, false_alarm);
  return count;
}

/* Marks the observables named in `only`, with commas between. */
static bool choose(const struct observable_means *ours, const char *only, bool *chosen, struct message *message)
{
  for (size_t k = 0; k < ours->count; k++)
    chosen[k] = !only;
  for (const char *at = only; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
    char name[OBSERVABLES_NAME];
    const size_t length = strcspn(at, ",");
    snprintf(name, sizeof name, "%.*s", (int)length, at);
    const struct observable_mean *row = observable_means_find(ours, name);
    if (!row || strlen(name) != length)
      return message_set(message, "--only: '%.*s' is no observable of the reference table", (int)length, at);
    chosen[row - ours->row] = true;
  }
  return true;
}

/* --- what is told ------------------------------------------------------------------------------------------------- */

static const char *remark(const struct judgement *j)
{
  if (!j->theirs)
    return "missing";
  if (j->differs)
    return "DIFFERS";
  if (isnan(j->sees))
    return "too few blocks";
  return j->judged ? "" : "error too large";
}

static void print_number(FILE *out, int width, const char *format, double x)
{
  char text[32];
  snprintf(text, sizeof text, format, x);
  fprintf(out, "  %*s", width, isnan(x) ? "-" : text);
}

static void print_row(FILE *out, const struct judgement *j)
{
  const struct observable_mean *theirs = j->theirs ? j->theirs : &(struct observable_mean){.value = NAN, .error = NAN};
  const double percent = 100.0 / fabs(j->ours->value);
  fprintf(out, "%-22s", j->ours->name);
  print_number(out, 9, "%.6g", j->ours->theory);
  print_number(out, 9, "%.6g", j->ours->value);
  print_number(out, 7, "%.2g", j->ours->error);
  print_number(out, 9, "%.6g", theirs->value);
  print_number(out, 7, "%.2g", theirs->error);
  print_number(out, 8, "%+.3f", j->difference * percent);
  print_number(out, 8, "%.3f", j->error * percent);
  print_number(out, 7, "%+.2f", j->t);
  print_number(out, 7, j->p < 1e-12 ? "<1e-12" : "%.2g", isnan(j->sees) ? NAN : j->p);
  print_number(out, 6, "%.2f", 100.0 * j->sees);
  print_number(out, 6, "%.2f", 100.0 * j->ours->resolve);
  fprintf(out, "%s%s\n", *remark(j) ? "  " : "", remark(j));
}

static void print_names(FILE *out, const struct judgement *judgement, size_t count, bool differing)
{
  const char *between = ": ";
  for (size_t k = 0; k < count; k++)
    if (differing ? judgement[k].differs : !judgement[k].judged) {
      fprintf(out, "%s%s", between, judgement[k].ours->name);
      between = ", ";
    }
  fputc('\n', out);
}

static enum judge_verdict print_verdict(FILE *out, const struct judgement *judgement, size_t count)
{
  size_t differ = 0, judged = 0;
  for (size_t k = 0; k < count; k++) {
    differ += judgement[k].differs;
    judged += judgement[k].judged;
  }
  if (differ > 0) {
    fprintf(out, "verdict: different, %zu of %zu observables", differ, count);
    print_names(out, judgement, count, true);
    return JUDGE_DIFFERS;
  }
  if (judged < count) {
    fprintf(out, "verdict: cannot tell; nothing differs, but %zu of %zu observables could not be judged",
            count - judged, count);
    print_names(out, judgement, count, false);
    return JUDGE_CANNOT_TELL;
  }
  fprintf(out, "verdict: consistent, %zu observables\n", count);
  return JUDGE_CONSISTENT;
}

bool oracle_judge(const struct observable_means *ours, const struct observable_means *theirs,
                  const struct judge_options *options, FILE *out, enum judge_verdict *verdict, struct message *message)
{
  struct judgement judgement[OBSERVABLES_MOST];
  bool chosen[OBSERVABLES_MOST];
  if (!choose(ours, options->only, chosen, message))
    return false;
  const size_t count = judge_all(ours, theirs, chosen, options->false_alarm, judgement);
  fprintf(out, "%-22s  %9s  %9s  %7s  %9s  %7s  %8s  %8s  %7s  %7s  %6s  %6s\n", "observable", "theory", "ours",
          "error", "theirs", "error", "diff, %", "error, %", "t", "p", "sees,%", "must,%");
  for (size_t k = 0; k < count; k++)
    print_row(out, &judgement[k]);
  fprintf(out,
          "\nfalse alarms: at most %g in all (Holm); the first p counts below %.3g. A difference as large as `sees` "
          "is found with 90 %% probability.\n",
          options->false_alarm, options->false_alarm / (double)count);
  *verdict = print_verdict(out, judgement, count);
  return true;
}
