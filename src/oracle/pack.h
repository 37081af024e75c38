/*
 * A pack: inputs and outputs of single operators, as named tables of numbers. docs/port/formats.md describes both its
 * forms:
 *
 *   HDF5   group `operator.step`, dataset `in.name` or `out.name` [rows][columns], attribute `components`
 *   text   lines `operator step row in.name.component value`
 */
#ifndef UNCROSS_ORACLE_PACK_H
#define UNCROSS_ORACLE_PACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "base/message.h"
#include "files/apart.h"

#define PACK_FORMAT "uncross pack"
#define PACK_VERSION 2 /* 1 had neither crossing, exchange nor permutation; it is read */
#define PACK_WORD 32
#define PACK_COLUMNS 16

/* Whose numbers: an operator, and the number of the step to which it belongs. */
struct pack_place {
  char operator_name[PACK_WORD];
  uint64_t step;
};

/* rows x columns numbers, all integers or all reals. A row is an entity: a particle id, a vertex, a cell, an event. */
struct pack_table {
  struct pack_place place;
  char name[PACK_WORD]; /* in.position, out.velocity, ... */
  bool real;
  bool unnamed; /* its file does not name the columns: they are those of the contract, in order */
  uint32_t rows, columns;
  char component[PACK_COLUMNS][PACK_WORD];
  union {
    int64_t *integer;
    double *number;
    void *data;
  } value; /* [rows * columns] */
};

struct pack {
  size_t count;
  struct pack_table *table; /* [count] in the order in which they were put */
  bool failed;              /* memory was short once */
};

/* Appends a table, zeroed, its components as words with blanks between. Returns its data, to be filled before the next
 * call; NULL, with failed set, if memory is short. */
int64_t *pack_put_integers(struct pack *pack, const struct pack_place *place, const char *name, const char *components,
                           uint32_t rows);
double *pack_put_reals(struct pack *pack, const struct pack_place *place, const char *name, const char *components,
                       uint32_t rows);

/* Appends a copy of a table. */
void pack_put_copy(struct pack *pack, const struct pack_table *table);

bool pack_same_place(const struct pack_place *a, const struct pack_place *b);

/* The table of this name at this place; NULL if there is none. */
const struct pack_table *pack_find(const struct pack *pack, const struct pack_place *place, const char *name);

/* One value as a real number, whatever the table holds; NaN where it has none. */
double pack_value(const struct pack_table *table, uint32_t row, uint32_t column);

void pack_free(struct pack *pack);

/* Writes a pack as HDF5 to a new file, byte for byte the same for equal packs; `path` serves messages only. */
bool pack_write(const struct pack *pack, FILE *out, const char *path, struct message *message);

/* Reads a pack of either form. False, with a message (for text `file:line:col: ...`), if it is neither, or damaged. */
bool pack_read(const char *path, struct pack *pack, struct message *message);

/* The work of the process that reads HDF5, "pack" (files/apart.h). */
void pack_serve(struct apart *link);

/* Whether a file begins as a pack does, though the rest may be damaged: HDF5, or text with the words that pack_write
 * begins with, or with a first line of values that can be understood. */
bool pack_begins(const char *path);

/* The text form, reals exact: as hexadecimal floating-point constants, or in 17 decimal digits. False if the stream
 * cannot be written. */
bool pack_dump(const struct pack *pack, bool decimal, FILE *out);

#endif
