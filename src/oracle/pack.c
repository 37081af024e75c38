#include "oracle/pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool pack_same_place(const struct pack_place *a, const struct pack_place *b)
{
  return a->step == b->step && strcmp(a->operator_name, b->operator_name) == 0;
}

/* A new table without components and rows; NULL if memory is short. */
static struct pack_table *append(struct pack *pack, const struct pack_place *place, const char *name)
{
  struct pack_table *grown = realloc(pack->table, (pack->count + 1) * sizeof *grown);
  if (!grown) {
    pack->failed = true;
    return NULL;
  }
  pack->table = grown;
  struct pack_table *t = &grown[pack->count++];
  memset(t, 0, sizeof *t);
  t->place = *place;
  snprintf(t->name, sizeof t->name, "%s", name);
  return t;
}

static void set_components(struct pack_table *t, const char *words)
{
  while (*words && t->columns < PACK_COLUMNS) {
    int length = (int)strcspn(words, " ");
    snprintf(t->component[t->columns++], PACK_WORD, "%.*s", length < PACK_WORD ? length : PACK_WORD - 1, words);
    words += length;
    words += strspn(words, " ");
  }
}

/* Integers and reals take 8 bytes both. */
static void *put(struct pack *pack, const struct pack_place *place, const char *name, bool real, const char *components,
                 uint32_t rows)
{
  struct pack_table *t = append(pack, place, name);
  if (!t)
    return NULL;
  set_components(t, components);
  t->real = real;
  t->rows = rows;
  t->value.data = calloc((size_t)rows * t->columns + 1, sizeof(int64_t));
  pack->failed |= !t->value.data;
  return t->value.data;
}

int64_t *pack_put_integers(struct pack *pack, const struct pack_place *place, const char *name, const char *components,
                           uint32_t rows)
{
  return put(pack, place, name, false, components, rows);
}

double *pack_put_reals(struct pack *pack, const struct pack_place *place, const char *name, const char *components,
                       uint32_t rows)
{
  return put(pack, place, name, true, components, rows);
}

void pack_put_copy(struct pack *pack, const struct pack_table *table)
{
  const size_t values = (size_t)table->rows * table->columns;
  struct pack_table *t = append(pack, &table->place, table->name);
  void *data = malloc((values + 1) * sizeof(int64_t));
  pack->failed |= !data;
  if (t)
    *t = *table, t->value.data = data;
  else
    free(data);
  if (t && data)
    memcpy(data, table->value.data, values * sizeof(int64_t));
}

const struct pack_table *pack_find(const struct pack *pack, const struct pack_place *place, const char *name)
{
  for (size_t k = 0; k < pack->count; k++)
    if (pack_same_place(&pack->table[k].place, place) && strcmp(pack->table[k].name, name) == 0)
      return &pack->table[k];
  return NULL;
}

double pack_value(const struct pack_table *t, uint32_t row, uint32_t column)
{
  const size_t k = (size_t)row * t->columns + column;
  if (row >= t->rows || column >= t->columns)
    return NAN;
  return t->real ? t->value.number[k] : (double)t->value.integer[k];
}

void pack_free(struct pack *pack)
{
  for (size_t k = 0; k < pack->count; k++)
    free(pack->table[k].value.data);
  free(pack->table);
  memset(pack, 0, sizeof *pack);
}
