/* Columns by their names: those of another code's pack are put into the order of ours. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/oracle.h"

enum { ABSENT = -1 };

static bool refuse(const struct pack_table *t, struct message *message, const char *what, const char *name,
                   const struct pack_table *mine)
{
  char known[PACK_COLUMNS * PACK_WORD] = "";
  for (uint32_t k = 0; mine && k < mine->columns; k++)
    snprintf(known + strlen(known), sizeof known - strlen(known), " %s", mine->component[k]);
  return message_set(message, "%s step %" PRIu64 " %s: %s %s%s%s", t->place.operator_name, t->place.step, t->name, what,
                     name, mine ? "; its columns are" : "", known);
}

/* Where ours has this column; a single column may be called `value`. */
static int column_of(const struct pack_table *mine, const char *name)
{
  for (uint32_t k = 0; k < mine->columns; k++)
    if (strcmp(mine->component[k], name) == 0)
      return (int)k;
  return mine->columns == 1 && strcmp(name, "value") == 0 ? 0 : ABSENT;
}

/* from[k]: which of their columns is ours k, or ABSENT. */
static bool match(const struct pack_table *mine, const struct pack_table *its, int from[PACK_COLUMNS],
                  struct message *message)
{
  for (uint32_t k = 0; k < PACK_COLUMNS; k++)
    from[k] = ABSENT;
  for (uint32_t k = 0; k < its->columns; k++) {
    const int at = column_of(mine, its->component[k]);
    if (at == ABSENT)
      return refuse(its, message, "unknown column", its->component[k], mine);
    if (from[at] != ABSENT)
      return refuse(its, message, "there are two columns", its->component[k], mine);
    from[at] = (int)k;
  }
  return true;
}

/* Integers and reals take 8 bytes both. */
static bool reorder(const struct pack_table *mine, struct pack_table *its, const int from[PACK_COLUMNS])
{
  int64_t *data = calloc((size_t)its->rows * its->columns + 1, sizeof *data);
  uint32_t at = 0;
  if (!data)
    return false;
  for (uint32_t k = 0; k < mine->columns; k++) {
    if (from[k] == ABSENT)
      continue;
    for (uint32_t row = 0; row < its->rows; row++)
      data[(size_t)row * its->columns + at] = its->value.integer[(size_t)row * its->columns + (uint32_t)from[k]];
    at++;
  }
  free(its->value.data);
  its->value.integer = data;
  at = 0;
  for (uint32_t k = 0; k < mine->columns; k++)
    if (from[k] != ABSENT)
      memcpy(its->component[at++], mine->component[k], PACK_WORD);
  return true;
}

static bool has_place(const struct pack *pack, const struct pack_place *place)
{
  for (size_t k = 0; k < pack->count; k++)
    if (pack->table[k].place.step == place->step &&
        strcmp(pack->table[k].place.operator_name, place->operator_name) == 0)
      return true;
  return false;
}

bool oracle_align(const struct pack *ours, struct pack *theirs, struct message *message)
{
  for (size_t k = 0; k < theirs->count; k++) {
    struct pack_table *its = &theirs->table[k];
    const struct pack_table *mine = pack_find(ours, &its->place, its->name);
    int from[PACK_COLUMNS];
    const bool known = strncmp(its->name, "bound.", 6) == 0 || strcmp(its->name, "in.step") == 0;
    if (!mine && !known && has_place(ours, &its->place))
      return refuse(its, message, "unknown table", its->name, NULL);
    if (!mine || its->unnamed)
      continue;
    if (!match(mine, its, from, message))
      return false;
    if (!reorder(mine, its, from))
      return message_set(message, "memory is short");
  }
  return true;
}
