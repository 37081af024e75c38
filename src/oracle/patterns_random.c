/* What went wrong with random numbers, where no relation tells it. */
#include <stdlib.h>

#include "oracle/patterns.h"

/* --- words ------------------------------------------------------------------------------------------------------- */

/* All but a few addresses, which may look the same either way. */
static bool words_unlike(const struct oracle_pair *p)
{
  const struct pack_table *ours = oracle_sibling(p, "out.word"), *theirs = oracle_sibling_of_theirs(p, "out.word");
  uint32_t values = 0, right = 0;
  for (uint32_t row = 0; ours && theirs && row < ours->rows; row++)
    for (uint32_t k = 0; k < ours->columns; k++) {
      values++;
      right += pack_value(ours, row, k) == pack_value(theirs, row, k);
    }
  return right < values && 8 * (uint64_t)right <= values;
}

/* --- permutations ------------------------------------------------------------------------------------------------ */

static bool is_permutation(const struct oracle_pair *p)
{
  const uint32_t n = p->ours->rows;
  bool *seen = calloc((size_t)n + 1, sizeof *seen), all = seen && p->theirs->rows == n;
  for (uint32_t k = 0; all && k < n; k++) {
    const double at = pack_value(p->theirs, k, 0);
    all = at >= 0.0 && at < n && !seen[(uint32_t)at];
    if (all)
      seen[(uint32_t)at] = true;
  }
  free(seen);
  return all;
}

static bool is_no_permutation(const struct oracle_pair *p)
{
  return !is_permutation(p);
}

const struct oracle_pattern oracle_patterns_random[] = {
    {"random", "out.word",
     "none of those known; hardly a word is right, so the counter, the key or the rounds of Philox differ",
     words_unlike},
    {NULL, "out.order", "none of those known; no permutation: a number is missing", is_no_permutation},
    {NULL, "out.order", "none of those known; a permutation, but of other random numbers or exchanges", is_permutation},
    {.meaning = NULL},
};
