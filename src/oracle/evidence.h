/*
 * Inside the oracle: one output table of one operator, at all steps of two packs, as a flat list of values. A guess of
 * what theirs are is held against all of it: a bug is named only if its guess is right wherever theirs is wrong, and,
 * if it is to be the whole story, everywhere else too.
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
  uint32_t differences, wrongs;              /* values */
};

/* How a guess does. */
enum evidence_fit {
  FIT_NOT,   /* wrong somewhere where theirs is wrong */
  FIT_WRONG, /* right wherever theirs is wrong, but not everywhere else */
  FIT_WHOLE  /* theirs is this guess, everywhere */
};

/* All of the pair's table. False if memory is short or nothing is wrong; free it in any case. */
bool evidence_take(const struct oracle_pair *pair, struct evidence *e);
void evidence_free(struct evidence *e);

/* From now on, what differs in any bit counts as wrong, too. */
void evidence_count_all(struct evidence *e);

/* Judges e->guess. */
enum evidence_fit evidence_judge(const struct evidence *e);

/* True if this value of theirs is x. */
bool evidence_is(const struct evidence *e, size_t value, double x);

/* The part that a row, counted among all, belongs to; and its number there. */
const struct evidence_part *evidence_part_of(const struct evidence *e, uint32_t row, uint32_t *own);

#endif
