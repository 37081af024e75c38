/*
 * The table of operators of a time step (schema.c): which scenes have one, the tables that go into it, the function
 * that advances the state by it, the tables that come out, and how much those may differ. Packs, comparison, the tables
 * of docs/port/operators.md and the names of columns of the ports (`uncross oracle schema`) come from it.
 *
 * A table is read from a source (sources.c): names of columns, what a row is, and a function that gives the numbers of
 * a row.
 */
#ifndef UNCROSS_ORACLE_SCHEMA_H
#define UNCROSS_ORACLE_SCHEMA_H

#include "oracle/operators.h"
#include "oracle/tolerance.h"

/* What a row of a table is. */
struct oracle_entity {
  const char *word;
  uint32_t (*count)(const struct oracle_stage *);              /* NULL: one */
  uint32_t (*number)(const struct oracle_stage *, uint32_t k); /* the row of what has place k in memory; NULL: k */
  size_t size;                                                 /* of a row that stands for itself (rows.h); else 0 */
  bool (*legal)(const void *row); /* whether operators may be asked: packs may come from anywhere; NULL: always */
};

struct oracle_source {
  const char *columns; /* names with blanks between */
  const struct oracle_entity *of;
  void (*integers)(const struct oracle_stage *, uint32_t k, int64_t *row); /* of place k; NULL: they are reals */
  void (*reals)(const struct oracle_stage *, uint32_t k, double *row);
  bool (*take)(struct oracle_stage *, uint32_t k, const void *row); /* to place k of the stage, false if it may not be
                                                                       asked; NULL: it cannot */
};

/* Which scenes have an operator, or a table of it. */
enum oracle_scenes {
#define SCENES(name, words, condition) name,
#include "oracle/scenes_list.h"
#undef SCENES
};
bool oracle_scene_is(enum oracle_scenes scenes, const struct model *model);
const char *oracle_scenes_words(enum oracle_scenes scenes);

struct oracle_table {
  const char *name; /* in.time, out.velocity, bound.hit */
  const struct oracle_source *source;
  tolerance_of_all *all;   /* of an out-table: one bound for all its values */
  tolerance_of_each *each; /* or one for each; neither: they are exact */
  enum oracle_scenes of;
  int later; /* so many of the tables below are made before this one */
};

enum { ORACLE_TABLES = 18 };
struct oracle_operator {
  const char *name;
  enum oracle_scenes of;
  bool constructed;                         /* it has constructed rows only */
  bool puts_back;                           /* vertices are where they were after it */
  bool (*begin)(struct oracle_stage *);     /* before tables go in, such as rows that stand for themselves; or NULL */
  bool (*run)(struct oracle_stage *);       /* or NULL */
  struct oracle_table table[ORACLE_TABLES]; /* in the order of packs, those that go in first; names end them */
};

extern const struct oracle_operator oracle_operators[];
extern const size_t oracle_operator_count;

/* A table of an operator; NULL if there is no such. rank: each is made of those with lower ranks; or NULL. */
const struct oracle_table *oracle_table_of(const char *operator_name, const char *name, int *rank);

/* Puts the tables of the operator at hand: those that go in, or the others (operators.c). */
void oracle_put_tables(struct oracle_stage *g, const struct oracle_operator *o, bool in);

/* Writes all of it as JSON. */
void oracle_write_schema(FILE *out);

#endif
