/*
 * Inside the oracle: one output table of one operator, at all steps of two packs, as a flat list of values. A guess of
 * what theirs are is held against all of it: a bug is named only if its guess is right wherever theirs is wrong and
 * everywhere else, and if chance would hardly make so many guesses fit (evidence_bits).
 */
#ifndef UNCROSS_ORACLE_EVIDENCE_H
#define UNCROSS_ORACLE_EVIDENCE_H

#include <math.h>

#include "oracle/pair.h"

#define EVIDENCE_PARTS 16
#define EVIDENCE_NAN INFINITY /* the guess of what is not a number */

struct evidence {
  uint32_t parts; /* one for each step that has the table in both packs */
  struct evidence_part {
    struct oracle_pair pair;
    uint32_t rows;  /* that both have */
    uint32_t first; /* number of its first row among all */
  } part[EVIDENCE_PARTS];
  uint32_t rows, columns;                    /* of all parts together */
  double *ours, *theirs, *tolerance, *guess; /* [rows * columns]; guess: scratch */
  bool *different, *wrong;                   /* [rows * columns]; wrong: beyond tolerance, or different if none is */
  uint32_t differences, wrongs, wrong_rows;  /* wrongs: values */
  double *choice;                            /* [columns]: log2 of how many values there are in a column */
  bool *moved;                               /* [rows]: some guess changes few rows, and this one is among them */
  bool decides;                              /* the guess only decides which of two values comes out */
  uint32_t free;                             /* numbers of the guess that were taken from theirs */
};

/* How a guess does. */
enum evidence_fit {
  FIT_NOT,   /* wrong somewhere where theirs is wrong */
  FIT_WRONG, /* right wherever theirs is wrong, but not everywhere else */
  FIT_WHOLE  /* theirs is this guess, everywhere */
};

/* All of the pair's table. False if memory is short; free it in any case. */
bool evidence_load(const struct oracle_pair *pair, struct evidence *e);

/* False also if nothing is wrong. */
bool evidence_take(const struct oracle_pair *pair, struct evidence *e);
void evidence_free(struct evidence *e);

/* From now on, what differs in any bit counts as wrong, too. */
void evidence_count_all(struct evidence *e);

/* Judges e->guess. */
enum evidence_fit evidence_judge(struct evidence *e);

/* log2 of the odds against e->guess being right by chance in the wrong values. Each different pair of our value and
 * theirs counts: a real by how much nearer the guess is than ours, up to 20 bits; an integer by the number of values
 * that its column has, so that one of 0 and 1 counts nothing. */
double evidence_bits(const struct evidence *e);

/* log2 of the number of ways in which so many wrong rows could lie among those that guesses with few wrong rows change:
 * what it is worth that a guess has no other row wrong. */
double evidence_choice(const struct evidence *e);

/* log2 of the number of ways to choose so many of n. */
double evidence_ways(double n, double chosen);

/* A guess is told if chance would make one of all that were tried fit once in 2^10 cases. */
#define EVIDENCE_SURE 10.0

/* True if this value of theirs is x. */
bool evidence_is(const struct evidence *e, size_t value, double x);

/* The part that a row, counted among all, belongs to; and its number there. */
const struct evidence_part *evidence_part_of(const struct evidence *e, uint32_t row, uint32_t *own);

#endif
