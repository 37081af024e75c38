/*
 * Statistical verdicts on codes whose bits are not ours: tables of observables, each a mean with its standard error
 * from independent blocks. docs/judging.md defines the observables, the files and the rate of false alarms.
 */
#ifndef UNCROSS_ORACLE_JUDGE_H
#define UNCROSS_ORACLE_JUDGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/message.h"

enum {
  OBSERVABLES_MOST = 64,  /* rows of a table */
  OBSERVABLES_NAME = 48,  /* room for a name */
  JUDGE_LEAST_BLOCKS = 10 /* with fewer, means are not normal and their errors not known well enough */
};

/* A row of a table. */
struct observable_mean {
  char name[OBSERVABLES_NAME];
  double value, error, blocks;
  double time;    /* length of a block, t0 */
  double theory;  /* NaN: none is known, or the table has no such column */
  double resolve; /* our table only: relative difference that a verdict must be able to see; NaN if there is a bound */
  double bound;   /* our table only: largest root mean square over the blocks, of what is conserved; else NaN */
};

struct observable_means {
  size_t count;
  struct observable_mean row[OBSERVABLES_MOST];
};

/* Reads a table (CSV, `#` begins a comment line). `reference` is ours, which names all observables there are; NULL:
 * this is ours, and needs `resolve`. False, with a message `file:line:col: ...`, if it is none. */
bool observable_means_read(const char *path, const struct observable_means *reference, struct observable_means *means,
                           struct message *message);

/* Root mean square over the blocks: <x>^2 + (B - 1) e^2 = <x^2>, as e^2 = (<x^2> - <x>^2)/(B - 1). */
double observable_rms(const struct observable_mean *row);

/* The row of this name; NULL if there is none. */
const struct observable_mean *observable_means_find(const struct observable_means *means, const char *name);

/* One observable, ours against theirs. */
struct judgement {
  const struct observable_mean *ours, *theirs; /* theirs NULL: missing */
  double difference, error;                    /* theirs - ours, and the standard error of that */
  double freedoms;                             /* of the error: Welch */
  double t, p;                                 /* difference/error; P(|T| > |t|) if both codes are the same, or 1 */
  double sees;           /* difference over |ours| found with 90 % probability; NaN: too few blocks */
  double scatter;        /* standard deviation of their blocks over that of ours */
  double level;          /* the p below which it counts, were it the only one to differ */
  const char *undecided; /* why it cannot be judged; NULL if it is judged */
  bool conserved;        /* has a bound, and no t, p, sees, scatter */
  bool differs;          /* by Holm's rule, over all observables that have a p; or beyond its bound */
};

/* Judges `ours` against `theirs`, of which NULL is the missing one; `level` is the p below which it would count if it
 * were the only one to differ. `differs` is left false, but for what has a bound and is beyond it. Blocks whose scatter
 * differs from ours at this level are not judged either. */
struct judgement judge_one(const struct observable_mean *ours, const struct observable_mean *theirs, double level);

/* The difference over |ours->value| that is found with 90 % probability in means of so many blocks whose standard
 * deviation is `spread`. */
double judge_sees(const struct observable_mean *ours, double spread, double blocks, double level);

/* The least number of such blocks, JUDGE_LEAST_BLOCKS or more, that sees ours->resolve; infinite if none does. */
double judge_blocks_needed(const struct observable_mean *ours, double spread, double level);

/* Sets `differs` of those that do, so that with equal codes the probability of any is at most `false_alarm`, whatever
 * their correlations: Holm, Scand. J. Statist. 6, 65 (1979). What is conserved is left out: it differs or not, without
 * chance. */
void judge_together(struct judgement *judgement, size_t count, double false_alarm);

/* What an observable is, for a verdict: "WHAT NUMBER UNIT", the number times `scale`; `look`: where a difference comes
 * from, with commas between. */
struct observable_words {
  const char *name, *what, *unit, *look;
  double scale;
};

/* Of a name that has none: words that fit anything. */
const struct observable_words *observable_words_of(const char *name);

enum judge_verdict {
  JUDGE_CONSISTENT,  /* everything was judged, nothing differs */
  JUDGE_CANNOT_TELL, /* nothing differs, but not everything could be judged */
  JUDGE_DIFFERS
};

struct judge_options {
  double false_alarm; /* 1e-9 .. 0.5 */
  const char *only;   /* these observables, with commas between; NULL: all */
};

/* Prints the judgements and the verdict. False, with a message, if `only` names what there is not. */
bool oracle_judge(const struct observable_means *ours, const struct observable_means *theirs,
                  const struct judge_options *options, FILE *out, enum judge_verdict *verdict, struct message *message);

#endif
