/* Inside the oracle: what guesses of walls (relations_walls.c) and of shear (relations_shear.c) have in common. */
#ifndef UNCROSS_ORACLE_RELATIONS_FLOW_H
#define UNCROSS_ORACLE_RELATIONS_FLOW_H

#include <math.h>
#include <string.h>

#include "oracle/patterns.h"
#include "oracle/relations.h"

#define COUNT_OF(list) (sizeof(list) / sizeof *(list))

/* NaN for what is not there. */
static inline double at(const struct pack_table *t, uint32_t row, uint32_t column)
{
  return t && row < t->rows && column < t->columns ? pack_value(t, row, column) : NAN;
}

static inline double in(const struct evidence_part *part, const char *name, uint32_t row, uint32_t column)
{
  return at(oracle_sibling(&part->pair, name), row, column);
}

static inline double of_model(const struct evidence_part *part, const char *name, uint32_t row, uint32_t column)
{
  return at(oracle_model(&part->pair, name), row, column);
}

static inline bool is_table(const struct evidence_part *part, const char *name)
{
  return strcmp(part->pair.ours->name, name) == 0;
}

static inline bool make(struct evidence *e, relation_value *value, const void *twist, const char *said,
                        char text[RELATION_TEXT])
{
  relation_fill(e, value, twist);
  return relation_say(text, "%s", said);
}

/* Row in `filled` of a cell; -1: no wall cuts it. */
static inline int64_t cut_of(const struct box *box, uint32_t cell)
{
  const uint32_t lx = (uint32_t)box->cells[0], rows = (uint32_t)box->cells[1] + 1;
  const uint32_t row = cell / lx % rows, in_row = cell / (lx * rows) * lx + cell % lx;
  return row == 0 ? (int64_t)in_row : row == rows - 1 ? (int64_t)in_row + (int64_t)lx * box->cells[2] : -1;
}

#endif
