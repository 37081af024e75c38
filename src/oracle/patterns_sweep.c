/* What went wrong in a sweep that no replay makes. */
#include <math.h>
#include <string.h>

#include "oracle/patterns.h"
#include "oracle/swept.h"

/* Hits are found, but at the end all velocities are what they were. */
static bool no_exchange(const struct oracle_pair *p)
{
  struct swept w;
  const struct pack_table *out = oracle_sibling_of_theirs(p, "out.velocity");
  if (!oracle_swept_take(p, &w) || swept_first_other(&w) == 0 || !out || out->rows != w.start->rows)
    return false;
  for (uint32_t row = 0; row < out->rows; row++)
    for (uint32_t k = 0; k < 3; k++)
      if (pack_value(w.start, row, k) != pack_value(out, row, k))
        return false;
  return true;
}

/* Before the first event that differs; what follows may be anything. */
static bool hits_single(const struct oracle_pair *p)
{
  struct swept w;
  return oracle_swept_take(p, &w) && oracle_is_single(&w.hit, swept_first_other(&w));
}

const struct oracle_pattern oracle_patterns_sweep[] = {
    {"sweep", NULL, "no velocity changes, though hits are found: no exchange of momentum", .fits = no_exchange},
    {"sweep", "out.hit", ORACLE_AS_SINGLE, .fits = hits_single},
    {.meaning = NULL},
};
