#include "oracle/operators.h"

#include <stdlib.h>
#include <string.h>

#include "oracle/drift.h"
#include "oracle/schema.h"

bool oracle_add_rows(struct oracle_stage *g, const void *rows, uint32_t n, size_t size)
{
  char *grown = realloc(g->row, ((size_t)g->rows + n + 1) * size);
  g->pack->failed |= !grown;
  if (!grown)
    return false;
  memcpy(grown + g->rows * size, rows, n * size);
  g->row = grown;
  g->rows += n;
  return true;
}

/* --- one operator ------------------------------------------------------------------------------------------------ */

static void put_table(struct oracle_stage *g, const struct oracle_table *t)
{
  const struct oracle_source *s = t->source;
  const struct oracle_entity *of = s->of;
  const uint32_t rows = of->count ? of->count(g) : 1;
  int64_t *integers = s->integers ? pack_put_integers(g->pack, &g->place, t->name, s->columns, rows) : NULL;
  double *reals = s->reals ? pack_put_reals(g->pack, &g->place, t->name, s->columns, rows) : NULL;
  if (!integers && !reals)
    return;
  const size_t columns = g->pack->table[g->pack->count - 1].columns;
  for (uint32_t k = 0; k < rows; k++) {
    const size_t at = columns * (of->number ? of->number(g, k) : k);
    if (integers)
      s->integers(g, k, &integers[at]);
    else
      s->reals(g, k, &reals[at]);
  }
}

void oracle_put_tables(struct oracle_stage *g, const struct oracle_operator *o, bool in)
{
  for (const struct oracle_table *t = o->table; t < &o->table[ORACLE_TABLES] && t->name; t++)
    if ((strncmp(t->name, "in.", strlen("in.")) == 0) == in && oracle_scene_is(t->of, g->model))
      put_table(g, t);
}

void oracle_put_back(struct oracle_stage *g)
{
  const size_t n = g->state->vertices;
  memcpy(g->state->position, g->position, n * sizeof *g->position);
  memcpy(g->state->velocity, g->velocity, n * sizeof *g->velocity);
  contact_forget_places(&g->work->contact);
}

/* What is asked of the state as it was before the operator. */
static bool keep(struct oracle_stage *g, bool vertices)
{
  const size_t n = g->state->vertices;
  if (g->state->wall_rows > 0)
    memcpy(g->account, g->state->wall_momentum, g->state->wall_rows * sizeof *g->account);
  if (!vertices)
    return true;
  g->position = malloc((n + 1) * sizeof *g->position);
  g->velocity = malloc((n + 1) * sizeof *g->velocity);
  g->pack->failed |= !g->position || !g->velocity;
  if (g->pack->failed)
    return false;
  memcpy(g->position, g->state->position, n * sizeof *g->position);
  memcpy(g->velocity, g->state->velocity, n * sizeof *g->velocity);
  return true;
}

static void forget(struct oracle_stage *g)
{
  free(g->position);
  free(g->velocity);
  free(g->row);
  state_free(&g->fresh);
  g->position = NULL, g->velocity = NULL, g->row = NULL, g->rows = 0, g->fresh = (struct state){0};
}

static bool run_operator(struct oracle_stage *g, const struct oracle_operator *o)
{
  snprintf(g->place.operator_name, sizeof g->place.operator_name, "%s", o->name);
  bool ok = keep(g, o->puts_back) && (!o->begin || o->begin(g));
  if (ok)
    oracle_put_tables(g, o, true);
  ok = ok && (!o->run || o->run(g));
  if (ok)
    oracle_put_tables(g, o, false);
  if (ok && o->puts_back)
    oracle_put_back(g);
  forget(g);
  return ok;
}

/* --- all of them ------------------------------------------------------------------------------------------------- */

bool oracle_run_operators(struct oracle_stage *g)
{
  bool ok = true;
  g->place.step = g->state->step + 1;
  for (size_t k = 0; ok && k < oracle_operator_count; k++) {
    const struct oracle_operator *o = &oracle_operators[k];
    if (!o->constructed && oracle_scene_is(o->of, g->model))
      ok = run_operator(g, o);
  }
  return ok && !g->pack->failed;
}

static void put_alone(struct oracle_stage *g, const struct oracle_operator *o)
{
  g->place = (struct pack_place){.step = 0};
  snprintf(g->place.operator_name, sizeof g->place.operator_name, "%s", o->name);
  oracle_put_tables(g, o, true);
}

void oracle_put_model(struct oracle_stage *g)
{
  put_alone(g, &oracle_operators[0]);
}

void oracle_put_start(struct oracle_stage *g)
{
  put_alone(g, &oracle_operators[1]);
}

int oracle_operator_rank(const char *name)
{
  for (size_t k = 0; k < oracle_operator_count; k++)
    if (strcmp(oracle_operators[k].name, name) == 0)
      return oracle_operators[k].of == OF_NO_STEP ? 0 : (int)k;
  return 0;
}

bool oracle_is_drift(const char *name)
{
  bool found = false;
  for (size_t k = 0; !found && k < oracle_operator_count; k++)
    found = oracle_operators[k].run == oracle_run_drift && strcmp(oracle_operators[k].name, name) == 0;
  return found;
}

/* What is unknown comes last. */
static int table_rank(const struct pack_table *t)
{
  int rank = 2 * ORACLE_TABLES;
  oracle_table_of(t->place.operator_name, t->name, &rank);
  return rank;
}

int oracle_flow(const struct pack_table *a, const struct pack_table *b)
{
  const int operators = oracle_operator_rank(a->place.operator_name) - oracle_operator_rank(b->place.operator_name);
  const int tables = table_rank(a) - table_rank(b), names = strcmp(a->place.operator_name, b->place.operator_name);
  if (operators != 0 || tables != 0)
    return operators != 0 ? operators : tables;
  if (a->place.step != b->place.step)
    return a->place.step < b->place.step ? -1 : 1;
  return names != 0 ? names : strcmp(a->name, b->name);
}
