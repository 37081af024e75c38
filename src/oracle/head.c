#include "oracle/head.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct pack_place head = {"model", 0};

/* The tables of a plain head, in the order of the operator `model`. */
enum { BOX, NUMBERS, REALS, CHAIN, VERTEX, TABLES };

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

const struct pack_table *head_table(const struct pack *pack, const struct pack_place *place,
                                    const struct oracle_table *wanted, uint32_t rows, struct message *message)
{
  static const struct pack_table empty = {.rows = 0};
  const struct oracle_source *s = wanted->source;
  const struct pack_table *given = pack_find(pack, place, wanted->name);
  if (!given && rows == 0)
    return &empty;
  if (given && given->rows == rows && given->real == !s->integers && has_columns(given, s->columns))
    return given;
  message_set(message, "%s, step %" PRIu64 ": %s%s: allowed: %s in %" PRIu32 " rows of columns %s",
              place->operator_name, place->step, wanted->name, given ? "" : " is missing",
              s->integers ? "integers" : "reals", rows, s->columns);
  return NULL;
}

bool head_is_plain(const struct pack *pack)
{
  bool plain = true;
  for (size_t k = 0; k < pack->count; k++) {
    const struct pack_table *t = &pack->table[k];
    bool known = strcmp(t->place.operator_name, head.operator_name) != 0;
    for (int j = 0; j < TABLES; j++)
      known = known || strcmp(t->name, oracle_operators[0].table[j].name) == 0;
    plain = plain && known;
  }
  return plain;
}

bool head_seed(const struct pack *pack, uint64_t *seed, struct message *message)
{
  const struct pack_table *t = pack_find(pack, &head, "in.numbers");
  if (!t || t->real || t->columns < 2 || t->rows != 1)
    return message_set(message, "the pack has no seed: in.numbers of model");
  *seed = (uint32_t)t->value.integer[0] | (uint64_t)t->value.integer[1] << 32;
  return true;
}

/* What is no number of cells becomes 0, which model_finish refuses. */
static int cells_of(int64_t n)
{
  return n > 0 && n < INT32_MAX ? (int)n : 0;
}

static void take_numbers(struct model *m, const int64_t *box, const int64_t *numbers, const double *reals)
{
  for (int axis = 0; axis < 3; axis++)
    m->box.cells[axis] = cells_of(box[axis]);
  m->time_step = reals[0];
  m->solvent.per_cell = (double)numbers[2] / ((double)box[0] * (double)box[1] * (double)box[2]);
  m->solvent.collision_interval = (double)numbers[3] * m->time_step;
  m->solvent.rotation_angle = 90.0; /* of which cosine and sine are put back after all is checked */
  m->solvent.hydrodynamics = true;
  m->solvent.acceleration = (struct vec3){reals[3], reals[4], reals[5]};
  m->crossing.forbidden = numbers[4] != 0;
  m->crossing.exclusion = numbers[5] ? EXCLUSION_PAPER : EXCLUSION_SHARED_VERTEX;
}

/* Rows of the tables of vertices. */
struct link {
  int64_t next, prev, fiber;
};
struct constants {
  double mass, bond_length, spring, bending;
  struct vec3 force;
};

/* Fibers are those vertices that follow each other and are of one fiber. */
static bool take_fibers(struct model *m, uint32_t vertices, const struct link *chain, const struct constants *vertex)
{
  m->kind = calloc((size_t)vertices + 1, sizeof *m->kind);
  for (uint32_t v = 0; m->kind && v < vertices; v++) {
    if (v == 0 || chain[v].fiber != chain[v - 1].fiber) {
      const struct constants *c = &vertex[v];
      struct fiber_kind *k = &m->kind[m->kinds++];
      *k = (struct fiber_kind){.count = 1, .mass = c->mass, .bond_length = c->bond_length, .spring = c->spring};
      k->bending = c->bending, k->force = c->force;
      snprintf(k->name, sizeof k->name, "%" PRIu32, m->kinds - 1);
    }
    m->kind[m->kinds - 1].vertices++;
    m->kind[m->kinds - 1].ring = chain[v].next >= 0; /* of its last vertex */
  }
  return m->kind;
}

bool head_model(const struct pack *pack, struct model *m, struct message *message)
{
  const struct pack_table *chain = pack_find(pack, &head, "in.chain"), *t[TABLES];
  const uint32_t vertices = chain ? chain->rows : 0;
  struct model_error error;
  bool ok = true;
  for (int k = 0; ok && k < TABLES; k++) {
    t[k] = head_table(pack, &head, &oracle_operators[0].table[k], k < CHAIN ? 1 : vertices, message);
    ok = t[k] != NULL;
  }
  if (!ok || !head_seed(pack, &m->seed, message))
    return false;
  const struct link *link = t[CHAIN]->value.data;
  take_numbers(m, t[BOX]->value.integer, t[NUMBERS]->value.integer, t[REALS]->value.number);
  if (!take_fibers(m, vertices, link, t[VERTEX]->value.data))
    return message_no_memory(message, "no memory");
  if (!model_finish(m, &error))
    return message_set(message, "model of the pack: %s: %s", error.path, error.text);
  m->solvent.cosine = t[REALS]->value.number[1], m->solvent.sine = t[REALS]->value.number[2];
  for (uint32_t v = 0; v < m->vertices; v++)
    if (link[v].next != m->next[v] || link[v].prev != m->prev[v] || link[v].fiber != m->fiber_of[v])
      return message_set(message, "model of the pack: in.chain: row %" PRIu32 " is none of fibers one after the other",
                         v);
  return true;
}
