/* Answers to packs, as any port gives them: of operators all of whose inputs can be taken from a pack. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/head.h"
#include "oracle/oracle.h"
#include "oracle/schema.h"

static bool goes_in(const struct oracle_table *t)
{
  return t->name && strncmp(t->name, "in.", strlen("in.")) == 0;
}

/* Its rows stand for themselves: it needs no state. */
static bool is_alone(const struct oracle_operator *o)
{
  return o->table[0].source->of->size > 0;
}

/* The operator of this name, if it can be answered; plain: there is a model (head.h). */
static const struct oracle_operator *operator_of(const char *name, bool plain)
{
  for (size_t k = 0; k < oracle_operator_count; k++) {
    const struct oracle_operator *o = &oracle_operators[k];
    bool answered = strcmp(o->name, name) == 0 && goes_in(o->table) && (plain || is_alone(o));
    for (const struct oracle_table *t = o->table; goes_in(t); t++)
      answered = answered && t->source->take;
    if (answered)
      return o;
  }
  return NULL;
}

static bool refuse(const struct oracle_stage *g, const char *table, const struct oracle_entity *of, uint32_t row,
                   struct message *message)
{
  return message_set(message, "%s, step %" PRIu64 ": %s: %s %" PRIu32 " is beyond what may be asked",
                     g->place.operator_name, g->place.step, table, of->word, row);
}

/* Takes the tables that go in, into the rows of the stage or into its state. */
static bool take(struct oracle_stage *g, const struct oracle_operator *o, const struct pack *pack,
                 struct message *message)
{
  const struct oracle_entity *first = o->table[0].source->of;
  for (const struct oracle_table *t = o->table; goes_in(t); t++) {
    const struct oracle_entity *of = t->source->of;
    const uint32_t rows = of->count ? of->count(g) : 1;
    const struct pack_table *given = head_table(pack, &g->place, t, rows, message);
    for (uint32_t k = 0; given && k < rows; k++)
      if (!t->source->take(g, k, (const char *)given->value.data + 8 * (size_t)given->columns * k))
        return refuse(g, t->name, of, k, message);
    if (!given)
      return false;
  }
  for (uint32_t k = 0; first->legal && k < g->rows; k++)
    if (!first->legal((const char *)g->row + first->size * k))
      return refuse(g, "all inputs", first, k, message);
  return true;
}

/* Room for the rows that the pack has, or a state in which nothing is known. */
static bool set_up(struct oracle_stage *g, const struct oracle_operator *o, struct model *model, uint32_t rows)
{
  if (is_alone(o)) {
    g->rows = rows;
    g->row = calloc((size_t)rows + 1, o->table[0].source->of->size);
    return g->row;
  }
  model->crossing.rule = o->of == OF_EVENTS ? CROSSING_EVENT_DRIVEN : CROSSING_SEQUENTIAL;
  if (!state_alloc(g->state, model))
    return false;
  g->state->step = g->place.step - 1;
  return work_alloc(g->work, model) && work_add_everything(g->work, model);
}

static bool answer(const struct oracle_operator *o, const struct pack_table *first, const struct pack *pack, bool whole,
                   struct model *model, struct pack *answers, struct message *message)
{
  struct state state = {0};
  struct work work = {0};
  struct oracle_stage g = {.model = model, .state = &state, .work = &work, .pack = answers, .place = first->place};
  bool ok = set_up(&g, o, model, first->rows) || message_no_memory(message, "no memory");
  ok = ok && take(&g, o, pack, message);
  if (ok && whole)
    oracle_put_tables(&g, o, true);
  if (ok && o->run && !o->run(&g))
    ok = work.fault.code == FAULT_NONE ? message_no_memory(message, "no memory") : message_fault(message, &work.fault);
  if (ok)
    oracle_put_tables(&g, o, false);
  free(g.row);
  work_free(&work);
  state_free(&state);
  return ok;
}

/* The order in which the pack of a scene is made. */
static int by_step(const void *left, const void *right)
{
  const struct pack_table *a = left, *b = right;
  return a->place.step != b->place.step ? (a->place.step < b->place.step ? -1 : 1) : oracle_flow(a, b);
}

bool oracle_answer(struct pack *pack, bool whole, struct pack *answers, struct message *message)
{
  struct model model = {.seed = 0};
  const bool plain = head_is_plain(pack);
  memset(answers, 0, sizeof *answers);
  if (pack->count > 0)
    qsort(pack->table, pack->count, sizeof *pack->table, by_step);
  bool ok = plain ? head_model(pack, &model, message) : head_seed(pack, &model.seed, message);
  for (size_t k = 0; ok && k < pack->count; k++) {
    const struct pack_table *t = &pack->table[k];
    const struct oracle_operator *o = operator_of(t->place.operator_name, plain);
    if (!o && whole)
      pack_put_copy(answers, t);
    else if (o && strcmp(t->name, o->table[0].name) == 0)
      ok = answer(o, t, pack, whole, &model, answers, message);
  }
  model_free(&model);
  return ok && (!answers->failed || message_no_memory(message, "no memory"));
}
