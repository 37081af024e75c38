/*
 * What is read off, and where it has a meaning: one table of observables and of what a scene may be. A row says what
 * the columns of an observable mean where a scene is so, that they are left out there, or that the scene is refused.
 * docs/observables.md shows the table (`uncross schema --document`). tests/contract/test_observables.c holds the
 * observers to it.
 */
#ifndef UNCROSS_OBSERVE_MEANING_H
#define UNCROSS_OBSERVE_MEANING_H

#include <stdbool.h>
#include <stdio.h>

#include "observe/observe.h"

/* What a scene may be; the words and the test of each are in meaning.c. */
enum circumstance {
  ANYWHERE,
  NO_FIBERS,
  NO_FIBERS_NO_DUMBBELLS,
  NO_BEAD,
  NO_NETWORK,
  NO_TRAP,
  NO_PAIR_FORCES,
  NO_TUBES,
  NO_DUMBBELLS,
  NO_PARTICLES,
  NO_WALLS,
  NO_BONDS,
  NO_FORCES,
  NOTHING_OF_THE_KIND = NO_FORCES, /* the last of those */
  IN_A_PLANE,
  IN_SHEAR,
  BETWEEN_WALLS,
  IN_A_FLOW, /* that differs from place to place, by a force, sliding walls, a profile, or a bead that is pulled */
  BY_A_FORCE_ON_FIBERS,
  ACCELERATED,
  IN_A_BATH_WITH_FLOW,
  IN_PAIRS,
  PERMUTED,
  OVERDAMPED,
  INEXTENSIBLE,
  DRIFT_SPLIT,
  THICK,
  BESIDE_HELD,
  NOT_CROSSABLE,
  LONG_AND_BENDING, /* fibers that bend so much that they touch themselves, and no chains without bending */
  WITH_DUMBBELLS,
  WITH_A_BEAD,
  CIRCUMSTANCES
};

enum verdict {
  MEANS,    /* exact, with this meaning */
  LEFT_OUT, /* these columns are not in the table */
  REFUSED   /* the scene is refused */
};

struct meaning {
  enum observable of;
  enum circumstance where;
  enum verdict verdict;
  const char *columns; /* separated by blanks, without those of their errors; NULL: all */
  const char *text;
};

/* The table. */
extern const struct meaning meanings[];
extern const size_t meaning_count;

/* How docs/observables.md calls it. */
const char *meaning_words(enum circumstance where);

/* True if a model is so. */
bool meaning_holds(enum circumstance where, const struct model *model);

/* Why this observable cannot be had of this model; NULL if it can. */
const char *meaning_refusal(const struct model *model, enum observable which);

/* False if the column, or the one whose error it is, is left out in this model. */
bool meaning_has_column(const struct model *model, enum observable which, const char *column);

/* Writes the table of docs/observables.md, between the comments that tools/document-keys looks for. */
void meaning_document(FILE *f);

#endif
