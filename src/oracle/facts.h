/* Inside the oracle: facts about rows, or single values, of a table, as sets: which rows they are true of. */
#ifndef UNCROSS_ORACLE_FACTS_H
#define UNCROSS_ORACLE_FACTS_H

#include "oracle/evidence.h"

#define FACT_TEXT 96

/* What facts are about: rows, or values of the columns that have wrong ones. */
struct units {
  const struct evidence *e;
  bool values;
  uint32_t n, columns, column[PACK_COLUMNS];
  bool *wrong; /* [n] */
};

struct fact {
  char text[FACT_TEXT];
  double cost;    /* bits */
  uint64_t *bits; /* [words] */
};

struct facts {
  uint32_t count, words;
  struct fact *fact;
  bool failed; /* memory was short */
};

static inline uint32_t unit_row(const struct units *u, uint32_t unit)
{
  return u->values ? unit / u->columns : unit;
}

/* All that is known to tell units apart. Free it in any case. */
void facts_collect(const struct units *u, struct facts *f);
void facts_free(struct facts *f);

#endif
