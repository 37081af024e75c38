/* Inside the oracle: patterns of differences that are no table of guesses (relations.h), and what both use. */
#ifndef UNCROSS_ORACLE_PATTERNS_H
#define UNCROSS_ORACLE_PATTERNS_H

#include "base/lattice.h"
#include "oracle/pair.h"

struct oracle_pattern {
  const char *operator_name, *table; /* NULL: any; sweep: long_sweep too */
  const char *meaning;
  bool (*fits)(const struct oracle_pair *);
};

/* Each list ends with one without a meaning; the first pattern that fits is told. */
extern const struct oracle_pattern oracle_patterns_random[], oracle_patterns_sweep[], oracle_patterns_flow[],
    oracle_patterns_any[];

/* True if theirs is this guess, within tolerance. */
bool oracle_guessed(const struct oracle_pair *pair, uint32_t row, uint32_t column, double guess);

/* True if theirs is ours, within tolerance. */
bool oracle_agrees(const struct oracle_pair *pair, uint32_t row, uint32_t column);

#define ORACLE_UNKNOWN "none of those known"
#define ORACLE_AS_SINGLE                                                                                               \
  "right to 5 to 8 digits, with errors of either sign: as of single precision, or of a number that is off by so "      \
  "little"

/* True if the first rows are right to 5 to 8 digits, not better, and the errors scatter about 0. */
bool oracle_is_single(const struct oracle_pair *pair, uint32_t rows);

/* The input in.name of an output out.name, NULL if there is none; and NULL also if it is not of the output's shape, so
 * that the output is its changed form. */
const struct pack_table *oracle_input(const struct oracle_pair *pair);
const struct pack_table *oracle_before(const struct oracle_pair *pair);

/* Tables of the model, and integers in them; 0 for what is not there. */
const struct pack_table *oracle_model(const struct oracle_pair *pair, const char *table);
int64_t oracle_model_integer(const struct oracle_pair *pair, const char *table, uint32_t row, uint32_t column);

/* Key of all random numbers. */
uint64_t oracle_seed(const struct oracle_pair *pair);

/* The model's box. False if it is none. */
bool oracle_box(const struct oracle_pair *pair, struct box *box);

/* A table of x, y, z that reaches to this row: packs may come from anywhere. */
static inline bool oracle_is_vectors(const struct pack_table *t, bool real, uint32_t row)
{
  return t && t->real == real && t->columns == 3 && row < t->rows;
}

static inline struct point oracle_point(const struct pack_table *t, uint32_t row)
{
  const int64_t *r = &t->value.integer[3 * (size_t)row];
  return (struct point){r[0], r[1], r[2]};
}

static inline struct vec3 oracle_vector(const struct pack_table *t, uint32_t row)
{
  const double *v = &t->value.number[3 * (size_t)row];
  return (struct vec3){v[0], v[1], v[2]};
}

static inline double oracle_component(struct vec3 v, uint32_t column)
{
  return column == 0 ? v.x : column == 1 ? v.y : v.z;
}

static inline uint32_t oracle_common_rows(const struct oracle_pair *p)
{
  return p->ours->rows < p->theirs->rows ? p->ours->rows : p->theirs->rows;
}

#endif
