/* Answers to packs, as any port gives them: of operators all of whose inputs can be taken from a pack. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "fiber/force.h"
#include "mpc/border.h"
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

/* An operator of states that takes particles and cells. */
static bool has_particles(const struct oracle_operator *o)
{
  return o->of == OF_CELLS;
}

/* The operator of this name, if it can be answered; plain: there may be a model (head.h). */
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

/* --- one operator ------------------------------------------------------------------------------------------------ */

/* The tables of a pack that go into an operator. */
struct inputs {
  int count;
  const struct pack_table *of[ORACLE_TABLES];
};

static bool refuse(const struct oracle_stage *g, const char *table, const struct oracle_entity *of, uint32_t row,
                   struct message *message)
{
  return message_set(message, "%s, step %" PRIu64 ": %s: %s %" PRIu32 " is beyond what may be asked",
                     g->place.operator_name, g->place.step, table, of->word, row);
}

/* Before memory is asked for: a head may claim anything. */
static bool find(const struct oracle_stage *g, const struct oracle_operator *o, const struct pack *pack,
                 struct inputs *in, struct message *message)
{
  if (!is_alone(o) && !oracle_scene_is(o->of, g->model))
    return message_set(message, "%s, step %" PRIu64 ": the model of the pack has no such operator; allowed: %s",
                       o->name, g->place.step, oracle_scenes_words(o->of));
  for (const struct oracle_table *t = o->table; goes_in(t); t++) {
    const uint32_t rows = t->source->of->count ? t->source->of->count(g) : 1;
    const struct pack_table *given = head_table(pack, &g->place, t, rows, message);
    if (!given)
      return false;
    in->of[in->count++] = given;
  }
  return true;
}

/* Room for the rows that the pack has, or a state in which nothing is known. */
static bool set_up(struct oracle_stage *g, const struct oracle_operator *o)
{
  const struct model *m = g->model;
  struct mpc *mpc = &g->work->mpc;
  if (is_alone(o)) {
    g->row = calloc((size_t)g->rows + 1, o->table[0].source->of->size);
    return g->row;
  }
  if (!state_alloc(g->state, m))
    return false;
  g->state->step = g->place.step - 1;
  if (!has_particles(o))
    return contact_alloc(&g->work->contact, m, fiber_force_at, true) && fiber_alloc(&g->work->fiber, m);
  mpc->border = border_of(m); /* the cells themselves, of which there may be any number, are not asked for */
  mpc->solvent_cell = memory_alloc((size_t)m->solvent.particles + 1, sizeof *mpc->solvent_cell);
  mpc->vertex_cell = memory_alloc((size_t)m->vertices + 1, sizeof *mpc->vertex_cell);
  return mpc->solvent_cell && mpc->vertex_cell;
}

/* Takes the inputs into the rows of the stage or into its state. */
static bool take(struct oracle_stage *g, const struct oracle_operator *o, const struct inputs *in,
                 struct message *message)
{
  const struct oracle_entity *first = o->table[0].source->of;
  for (int j = 0; j < in->count; j++) {
    const struct pack_table *given = in->of[j];
    const struct oracle_source *s = o->table[j].source;
    for (uint32_t k = 0; k < given->rows; k++)
      if (!s->take(g, k, (const char *)given->value.data + 8 * (size_t)given->columns * k))
        return refuse(g, o->table[j].name, s->of, k, message);
  }
  for (uint32_t k = 0; first->legal && k < g->rows; k++)
    if (!first->legal((const char *)g->row + first->size * k))
      return refuse(g, "all inputs", first, k, message);
  return true;
}

static bool answer(const struct oracle_operator *o, const struct pack_place *place, const struct pack *pack, bool whole,
                   const struct model *model, struct pack *answers, struct message *message)
{
  const struct pack_table *first = pack_find(pack, place, o->table[0].name);
  struct model own = *model;
  own.crossing.rule = o->of == OF_EVENTS ? CROSSING_EVENT_DRIVEN : CROSSING_SEQUENTIAL;
  own.solvent.particles = has_particles(o) ? model->solvent.particles : 0;
  struct state state = {.solvent.n = own.solvent.particles};
  struct work work = {0};
  struct oracle_stage g = {.model = &own, .state = &state, .work = &work, .pack = answers, .place = *place};
  struct inputs in = {.count = 0};
  if (is_alone(o))
    g.rows = first ? first->rows : 1;
  bool ok = find(&g, o, pack, &in, message) && (set_up(&g, o) || message_no_memory(message, "no memory"));
  ok = ok && take(&g, o, &in, message);
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

/* --- a pack ------------------------------------------------------------------------------------------------------ */

/* The order in which the pack of a scene is made. */
static int by_step(const void *left, const void *right)
{
  const struct pack_table *a = left, *b = right;
  return a->place.step != b->place.step ? (a->place.step < b->place.step ? -1 : 1) : oracle_flow(a, b);
}

/* Whether a state is asked of: then all of the model must be there. */
static bool has_states(const struct pack *pack, bool plain)
{
  bool found = false;
  for (size_t k = 0; !found && k < pack->count; k++) {
    const struct oracle_operator *o = operator_of(pack->table[k].place.operator_name, plain);
    found = o && !is_alone(o);
  }
  return found;
}

bool oracle_answer(struct pack *pack, bool whole, struct pack *answers, struct message *message)
{
  struct model model = {.seed = 0};
  const bool plain = head_is_plain(pack);
  memset(answers, 0, sizeof *answers);
  if (pack->count > 0)
    qsort(pack->table, pack->count, sizeof *pack->table, by_step);
  bool ok = has_states(pack, plain) ? head_model(pack, &model, message) : head_seed(pack, &model.seed, message);
  for (size_t k = 0; ok && k < pack->count; k++) {
    const struct pack_table *t = &pack->table[k];
    const struct oracle_operator *o = operator_of(t->place.operator_name, plain);
    if (!o && whole)
      pack_put_copy(answers, t);
    else if (o && (k == 0 || !pack_same_place(&t->place, &t[-1].place)))
      ok = answer(o, &t->place, pack, whole, &model, answers, message);
  }
  model_free(&model);
  return ok && (!answers->failed || message_no_memory(message, "no memory"));
}
