/* The search for pairs of members that are near each other: what the bath and the repulsion of pairs share. */
#ifndef UNCROSS_MEDIUM_NEAR_H
#define UNCROSS_MEDIUM_NEAR_H

#include "base/random.h"
#include "medium/medium.h"

enum { NEAR_BLOCK = RANDOM_UNIFORMS };

/* Some pairs, in columns. */
struct near_pairs {
  uint32_t n;
  uint32_t a[NEAR_BLOCK], b[NEAR_BLOCK];                             /* places of the members */
  double x[NEAR_BLOCK], y[NEAR_BLOCK], z[NEAR_BLOCK], r[NEAR_BLOCK]; /* a - b, exact, and its length; a0 */
};

struct near_search {
  const struct model *model;
  struct medium *medium;                                                    /* members_gather has filled it */
  bool (*look)(const struct near_search *search, struct near_pairs *pairs); /* false stops the search */
  void *context;
  bool plain; /* the plain search: the same bits, for tests */
};

/* Shows all pairs with 0 < r < 1 to `look`, each once, in blocks whose order is one for all ways to search: sums of
 * doubles depend on it. False if `look` says so. */
bool near_find(const struct near_search *search);

/* --- encounters in a search ----------------------------------------------------------------------------------------
 */

/* What is the same for all pairs of a step. */
struct encounter_choice {
  const struct bath_draw *draw;
  bath_weight *weigh;
  double x; /* rate dt */
  uint64_t step;
};

/* Begins a step's list of encounters, empty. */
struct encounter_choice encounters_begin(const struct model *model, struct medium *medium, uint64_t step);

/* To be shown all near pairs, with that choice as the context: lists those on which the bath acts, and leaves others in
 * `pairs`. False if memory is short. */
bool encounters_list(const struct near_search *search, struct near_pairs *pairs);

#endif
