/* Answers to packs, as any port gives them: of operators whose rows stand for themselves. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/oracle.h"
#include "oracle/schema.h"

/* The operator of this name, if each of its rows stands for itself. */
static const struct oracle_operator *operator_of(const char *name)
{
  for (size_t k = 0; k < oracle_operator_count; k++) {
    const struct oracle_operator *o = &oracle_operators[k];
    if (strcmp(o->name, name) == 0 && o->table[0].source->take)
      return o;
  }
  return NULL;
}

static bool has_columns(const struct pack_table *given, const char *words)
{
  for (uint32_t k = 0; k < given->columns; k++) {
    const size_t length = strcspn(words, " ");
    if (strlen(given->component[k]) != length || strncmp(given->component[k], words, length) != 0)
      return false;
    words += length + (words[length] == ' ');
  }
  return !*words;
}

/* Takes a table into the rows of the stage. */
static bool take(const struct oracle_stage *g, const struct oracle_table *t, const struct pack_table *given,
                 struct message *message)
{
  if (!given || given->rows != g->rows || given->real == (t->source->integers != NULL) ||
      !has_columns(given, t->source->columns))
    return message_set(message, "%s, step %" PRIu64 ": %s: allowed: %s in %" PRIu32 " rows of columns %s",
                       g->place.operator_name, g->place.step, t->name, t->source->integers ? "integers" : "reals",
                       g->rows, t->source->columns);
  for (uint32_t k = 0; k < g->rows; k++)
    t->source->take(g, k, (const char *)given->value.data + 8 * (size_t)given->columns * k);
  return true;
}

static bool take_rows(struct oracle_stage *g, const struct oracle_operator *o, const struct pack *pack,
                      struct message *message)
{
  const struct oracle_entity *of = o->table[0].source->of;
  for (const struct oracle_table *t = o->table; strncmp(t->name, "in.", strlen("in.")) == 0; t++)
    if (!take(g, t, pack_find(pack, &g->place, t->name), message))
      return false;
  for (uint32_t k = 0; of->legal && k < g->rows; k++)
    if (!of->legal((const char *)g->row + of->size * k))
      return message_set(message, "%s, step %" PRIu64 ": %s %" PRIu32 " is beyond what may be asked", o->name,
                         g->place.step, of->word, k);
  return true;
}

bool oracle_answer(const struct pack *pack, struct pack *answers, struct message *message)
{
  struct model model = {.seed = 0};
  const struct pack_table *numbers = pack_find(pack, &(struct pack_place){"model", 0}, "in.numbers");
  memset(answers, 0, sizeof *answers);
  if (!numbers || numbers->real || numbers->columns < 2 || numbers->rows != 1)
    return message_set(message, "the pack has no seed: in.numbers of model");
  model.seed = (uint32_t)numbers->value.integer[0] | (uint64_t)numbers->value.integer[1] << 32;
  bool ok = true;
  for (size_t k = 0; ok && k < pack->count; k++) {
    const struct pack_table *t = &pack->table[k];
    const struct oracle_operator *o = operator_of(t->place.operator_name);
    if (!o || strcmp(t->name, o->table[0].name) != 0)
      continue;
    struct oracle_stage g = {.model = &model, .pack = answers, .place = t->place, .rows = t->rows};
    g.row = calloc((size_t)g.rows + 1, o->table[0].source->of->size);
    ok = g.row ? take_rows(&g, o, pack, message) && (!o->run || o->run(&g)) : message_no_memory(message, "no memory");
    if (ok)
      oracle_put_tables(&g, o, false);
    free(g.row);
  }
  return ok && (!answers->failed || message_no_memory(message, "no memory"));
}
