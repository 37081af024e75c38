#include "oracle/judge.h"

#include <math.h>
#include <string.h>

#include "base/student.h"

#define NORMAL_90 1.2815515655446004 /* what a normal deviate is below with 90 % probability */
#define MOST_BLOCKS 1e6              /* nobody measures more */

/* The same as student_welch, where both errors may be 0. */
static double freedoms_of(double error_a, double blocks_a, double error_b, double blocks_b)
{
  return error_a > 0.0 || error_b > 0.0 ? student_welch(error_a, blocks_a, error_b, blocks_b) : 1.0;
}

/* A normal deviate about `away` exceeds `limit` estimated errors, which scatter by 1/sqrt(2 freedoms) about
 * 1 - 1/(4 freedoms): the non-central t to first order, as Johnson and Welch, Biometrika 31, 362 (1940). */
double judge_sees(const struct observable_mean *ours, double spread, double blocks, double level)
{
  const double theirs = spread / sqrt(blocks), freedoms = freedoms_of(ours->error, ours->blocks, theirs, blocks);
  const double limit = student_quantile(level, freedoms);
  const double away = limit * (1.0 - 0.25 / freedoms) + NORMAL_90 * sqrt(1.0 + 0.5 * limit * limit / freedoms);
  return away * hypot(ours->error, theirs) / fabs(ours->value);
}

double judge_blocks_needed(const struct observable_mean *ours, double spread, double level)
{
  double low = JUDGE_LEAST_BLOCKS, high = MOST_BLOCKS;
  if (judge_sees(ours, spread, low, level) <= ours->resolve)
    return low;
  if (!(judge_sees(ours, spread, high, level) <= ours->resolve))
    return INFINITY;
  while (high - low > 1.0) { /* low sees too little, high enough */
    const double middle = floor(0.5 * (low + high));
    if (judge_sees(ours, spread, middle, level) <= ours->resolve)
      high = middle;
    else
      low = middle;
  }
  return high;
}

/* P that the ratio of two estimated variances of one distribution is as far from 1 as this, either way: Fisher's F,
 * its cube root taken as normal (Paulson, Ann. Math. Statist. 13, 233 (1942)). */
static double scatter_tail(double ratio, double freedoms, double other_freedoms)
{
  const double a = 2.0 / (9.0 * freedoms), b = 2.0 / (9.0 * other_freedoms), root = cbrt(ratio);
  return erfc(fabs((1.0 - b) * root - (1.0 - a)) / sqrt(2.0 * (b * root * root + a)));
}

static const char *why_undecided(const struct judgement *j)
{
  if (!j->theirs)
    return "missing";
  if (j->conserved)
    return NULL;
  if (fmin(j->ours->blocks, j->theirs->blocks) < JUDGE_LEAST_BLOCKS)
    return "too few blocks";
  if (j->theirs->error == 0.0)
    return "all blocks are equal";
  if (!(j->sees <= j->ours->resolve))
    return "error too large";
  const double square = j->scatter * j->scatter;
  return scatter_tail(square, j->theirs->blocks - 1.0, j->ours->blocks - 1.0) < j->level ? "blocks scatter otherwise"
                                                                                         : NULL;
}

static void compare_means(struct judgement *j)
{
  const struct observable_mean *ours = j->ours, *theirs = j->theirs;
  const double spread = theirs->error * sqrt(theirs->blocks);
  j->difference = theirs->value - ours->value;
  j->error = hypot(ours->error, theirs->error);
  j->freedoms = freedoms_of(ours->error, ours->blocks, theirs->error, theirs->blocks);
  j->t = j->difference / j->error;
  j->scatter = spread / (ours->error * sqrt(ours->blocks));
  if (fmin(ours->blocks, theirs->blocks) < JUDGE_LEAST_BLOCKS)
    return;
  j->p = student_tail(fabs(j->t), j->freedoms);
  j->sees = judge_sees(ours, spread, theirs->blocks, j->level);
}

struct judgement judge_one(const struct observable_mean *ours, const struct observable_mean *theirs, double level)
{
  struct judgement j = {.ours = ours,
                        .theirs = theirs,
                        .difference = NAN,
                        .error = NAN,
                        .t = NAN,
                        .p = 1.0,
                        .sees = NAN,
                        .scatter = NAN,
                        .level = level,
                        .conserved = !isnan(ours->bound)};
  if (theirs && j.conserved)
    j.differs = !(observable_rms(theirs) <= ours->bound);
  else if (theirs)
    compare_means(&j);
  j.undecided = why_undecided(&j);
  return j;
}

void judge_together(struct judgement *judgement, size_t count, double false_alarm)
{
  size_t left = 0;
  for (size_t k = 0; k < count; k++)
    left += !judgement[k].conserved;
  for (; left > 0; left--) {
    struct judgement *least = NULL;
    for (size_t k = 0; k < count; k++)
      if (!judgement[k].conserved && !judgement[k].differs && (!least || judgement[k].p < least->p))
        least = &judgement[k];
    if (!least || least->p > false_alarm / (double)left)
      return;
    least->differs = true;
  }
}

/* --- which -------------------------------------------------------------------------------------------------------- */

/* The p below which the first difference counts: that of Holm's rule, over what is asked for and has a p. */
static double first_level(const struct observable_means *ours, const bool *chosen, double false_alarm)
{
  size_t count = 0;
  for (size_t k = 0; k < ours->count; k++)
    count += chosen[k] && isnan(ours->row[k].bound);
  return false_alarm / (double)(count ? count : 1);
}

/* Judges what is asked for. The number of judgements. */
static size_t judge_all(const struct observable_means *ours, const struct observable_means *theirs, const bool *chosen,
                        double false_alarm, struct judgement *judgement)
{
  const double level = first_level(ours, chosen, false_alarm);
  size_t done = 0;
  for (size_t k = 0; k < ours->count; k++)
    if (chosen[k])
      judgement[done++] = judge_one(&ours->row[k], observable_means_find(theirs, ours->row[k].name), level);
  judge_together(judgement, done, false_alarm);
  return done;
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
  return j->differs ? "DIFFERS" : j->undecided ? j->undecided : "";
}

static void print_number(FILE *out, int width, const char *format, double x)
{
  char text[32];
  snprintf(text, sizeof text, format, x);
  fprintf(out, "  %*s", width, isnan(x) ? "-" : text);
}

static const struct observable_mean nothing = {.value = NAN, .error = NAN, .blocks = NAN};

static void print_mean(FILE *out, const struct judgement *j)
{
  const struct observable_mean *theirs = j->theirs ? j->theirs : &nothing;
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

static void print_conserved(FILE *out, const struct judgement *j)
{
  fprintf(out, "%-22s", j->ours->name);
  print_number(out, 9, "%.2g", observable_rms(j->ours));
  print_number(out, 9, "%.2g", j->theirs ? observable_rms(j->theirs) : NAN);
  print_number(out, 9, "%.2g", j->ours->bound);
  fprintf(out, "%s%s\n", *remark(j) ? "  " : "", remark(j));
}

/* One table of means, one of what is conserved. The number of rows. */
static size_t print_table(FILE *out, const struct judgement *judgement, size_t count, bool conserved)
{
  size_t rows = 0;
  for (size_t k = 0; k < count; k++) {
    if (judgement[k].conserved != conserved)
      continue;
    if (rows++ == 0 && conserved)
      fprintf(out, "\n%-22s  %9s  %9s  %9s\n", "conserved", "our rms", "their rms", "bound");
    else if (rows == 1)
      fprintf(out, "%-22s  %9s  %9s  %7s  %9s  %7s  %8s  %8s  %7s  %7s  %6s  %6s\n", "observable", "theory", "ours",
              "error", "theirs", "error", "diff, %", "error, %", "t", "p", "sees,%", "must,%");
    (conserved ? print_conserved : print_mean)(out, &judgement[k]);
  }
  return rows;
}

static bool is_undecided(const struct judgement *j)
{
  return !j->differs && j->undecided;
}

static void print_names(FILE *out, const struct judgement *judgement, size_t count, bool differing)
{
  const char *between = ": ";
  for (size_t k = 0; k < count; k++)
    if (differing ? judgement[k].differs : is_undecided(&judgement[k])) {
      fprintf(out, "%s%s", between, judgement[k].ours->name);
      between = ", ";
    }
  fputc('\n', out);
}

/* What broke, in words, and where to look. */
static void print_difference(FILE *out, const struct judgement *j)
{
  const struct observable_words *w = observable_words_of(j->ours->name);
  const char *unit = *w->unit ? " " : "";
  const double s = w->scale;
  fprintf(out, "  %s: %s ", j->ours->name, w->what);
  if (j->conserved)
    fprintf(out, "%.3g%s%s (mean %+.3g); it is conserved: at most %.2g%s%s", s * observable_rms(j->theirs), unit,
            w->unit, s * j->theirs->value, s * j->ours->bound, unit, w->unit);
  else
    fprintf(out, "%.6g%s%s, not %.6g%s%s (error of the difference %.2g)", s * j->theirs->value, unit, w->unit,
            s * j->ours->value, unit, w->unit, s * j->error);
  fprintf(out, "%s%s\n", *w->look ? ". Look at: " : "", w->look);
}

static void print_undecided(FILE *out, const struct judgement *j)
{
  const struct observable_mean *ours = j->ours, *theirs = j->theirs;
  fprintf(out, "  %s: %s", ours->name, j->undecided);
  if (theirs && isnan(j->sees))
    fprintf(out, ": %.0f of ours, %.0f of theirs; %d are the fewest", ours->blocks, theirs->blocks, JUDGE_LEAST_BLOCKS);
  else if (theirs && theirs->error == 0.0)
    fputs("; do all have the same seed?", out);
  else if (theirs && j->sees <= ours->resolve)
    fprintf(out,
            ": their standard deviation is %.2f times ours; are they independent, each from a start of its own, and "
            "as long?",
            j->scatter);
  else if (theirs) {
    const double needed = judge_blocks_needed(ours, theirs->error * sqrt(theirs->blocks), j->level);
    fprintf(out, ": it would see %.2g %%, and must see %.2g %%; ", 100.0 * j->sees, 100.0 * ours->resolve);
    if (isinf(needed))
      fputs("no number of such blocks would do", out);
    else
      fprintf(out, "%.0f such blocks would", needed);
  }
  fputc('\n', out);
}

static enum judge_verdict print_verdict(FILE *out, const struct judgement *judgement, size_t count)
{
  size_t differ = 0, undecided = 0;
  for (size_t k = 0; k < count; k++) {
    differ += judgement[k].differs;
    undecided += is_undecided(&judgement[k]);
  }
  if (differ > 0) {
    fprintf(out, "verdict: different, %zu of %zu observables", differ, count);
    print_names(out, judgement, count, true);
  } else if (undecided > 0) {
    fprintf(out, "verdict: cannot tell; nothing differs, but %zu of %zu observables could not be judged", undecided,
            count);
    print_names(out, judgement, count, false);
  } else
    fprintf(out, "verdict: consistent, %zu observables\n", count);
  for (size_t k = 0; k < count; k++) {
    if (judgement[k].differs)
      print_difference(out, &judgement[k]);
    else if (judgement[k].undecided)
      print_undecided(out, &judgement[k]);
  }
  return differ > 0 ? JUDGE_DIFFERS : undecided > 0 ? JUDGE_CANNOT_TELL : JUDGE_CONSISTENT;
}

bool oracle_judge(const struct observable_means *ours, const struct observable_means *theirs,
                  const struct judge_options *options, FILE *out, enum judge_verdict *verdict, struct message *message)
{
  struct judgement judgement[OBSERVABLES_MOST];
  bool chosen[OBSERVABLES_MOST] = {false};
  if (!choose(ours, options->only, chosen, message))
    return false;
  const size_t count = judge_all(ours, theirs, chosen, options->false_alarm, judgement);
  if (print_table(out, judgement, count, false))
    fprintf(out,
            "\nfalse alarms: at most %g in all (Holm); the first p counts below %.3g. A difference as large as `sees` "
            "is found with 90 %% probability.\n",
            options->false_alarm, first_level(ours, chosen, options->false_alarm));
  if (print_table(out, judgement, count, true))
    fputs("\nrms: root mean square over the blocks. The bounds hold for single precision (docs/judging.md).\n", out);
  *verdict = print_verdict(out, judgement, count);
  return true;
}
