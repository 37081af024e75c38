/*
 * Inside the oracle: how facts are made of a number for each unit. Facts of rows in general, of cells and of fibers are
 * in files of their own.
 */
#ifndef UNCROSS_ORACLE_FACTS_MAKE_H
#define UNCROSS_ORACLE_FACTS_MAKE_H

#include "oracle/facts.h"

/* What a number is: how facts are made of it. */
enum sort {
  FLAG = 1, /* text: yes|no */
  SIGN = 2,
  EQUAL = 4,
  RANGE = 8,
  PARITY = 16,
  NUMBER = SIGN | RANGE,
  COUNT = EQUAL | RANGE,
};

struct maker {
  const struct units *u;
  struct facts *f;
  double *value; /* [n]; NaN: not known */
  bool *true_of; /* [n] */
};

/* Facts of m->value. */
void facts_make(struct maker *m, enum sort sort, const char *name);

/* Facts of what a function gives for each unit; column: 0 if units are rows. */
typedef double number_of(const struct evidence_part *part, uint32_t row, uint32_t column);
void facts_make_of(struct maker *m, enum sort sort, const char *name, number_of *f);

/* Facts of a column; of the unit's own one if column is PACK_COLUMNS; at row, or at the row that the table `cells` has
 * there. */
void facts_make_of_column(struct maker *m, const struct pack_table *t, uint32_t column, const char *cells);

/* A table of the part's operator and step. */
const struct pack_table *facts_sibling(const struct evidence_part *part, const char *name);

void facts_of_places(struct maker *m);
void facts_of_cells(struct maker *m);
void facts_of_fibers(struct maker *m);
void facts_of_contacts(struct maker *m);
void facts_of_tables(struct maker *m);

#endif
