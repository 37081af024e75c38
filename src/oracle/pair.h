/* Inside the oracle: what two packs have at one place, and how much it may differ. */
#ifndef UNCROSS_ORACLE_PAIR_H
#define UNCROSS_ORACLE_PAIR_H

#include "oracle/pack.h"

/* One output table of one operator, ours and theirs, same shape. */
struct oracle_pair {
  const struct pack *pack;        /* ours: inputs, model */
  const struct pack *pack_theirs; /* their outputs */
  const struct pack_table *ours, *theirs;
  double rounding;               /* u: 2^-53 or 2^-24 */
  struct tolerance_known *known; /* of this table; NULL: computed for each value anew */
};

/* Bound on |ours - theirs| in this column, if both made the operator's roundings and no mistake:
 * docs/port/tolerances.md. */
double oracle_tolerance(const struct oracle_pair *pair, uint32_t row, uint32_t column);

/* A table of the same operator and step, of our pack; NULL if there is none. */
static inline const struct pack_table *oracle_sibling(const struct oracle_pair *pair, const char *name)
{
  return pack_find(pair->pack, &pair->ours->place, name);
}

/* Theirs of the same operator and step. */
static inline const struct pack_table *oracle_sibling_of_theirs(const struct oracle_pair *pair, const char *name)
{
  return pack_find(pair->pack_theirs, &pair->ours->place, name);
}

#endif
