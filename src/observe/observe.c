#include "observe/observe.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fiber/force.h"
#include "mpc/stress.h"
#include "observe/meaning.h"
#include "observe/observer.h"
#include "work.h"

static const struct observer_type *const types[OBSERVABLES] = {
    [OBSERVE_CONSERVED] = &conserved_observer,
    [OBSERVE_TEMPERATURE] = &temperature_observer,
    [OBSERVE_STATICS] = &statics_observer,
    [OBSERVE_DYNAMICS] = &dynamics_observer,
    [OBSERVE_COLLISIONS] = &collisions_observer,
    [OBSERVE_PROFILE] = &profile_observer,
    [OBSERVE_STRESS] = &stress_observer,
    [OBSERVE_DUMBBELLS] = &dumbbells_observer,
    [OBSERVE_ORIENTATION] = &orientation_observer,
    [OBSERVE_BEAD] = &bead_observer,
    [OBSERVE_MEMORY] = &memory_observer,
    [OBSERVE_PRESSURE] = &pressure_observer,
    [OBSERVE_WAKE] = &wake_observer,
    [OBSERVE_TOPOLOGY] = &topology_observer,
};

const char *const observable_names[OBSERVABLES] = {
    [OBSERVE_CONSERVED] = "conserved", [OBSERVE_TEMPERATURE] = "temperature", [OBSERVE_STATICS] = "statics",
    [OBSERVE_DYNAMICS] = "dynamics",   [OBSERVE_COLLISIONS] = "collisions",   [OBSERVE_PROFILE] = "profile",
    [OBSERVE_STRESS] = "stress",       [OBSERVE_DUMBBELLS] = "dumbbells",     [OBSERVE_ORIENTATION] = "orientation",
    [OBSERVE_BEAD] = "bead",           [OBSERVE_MEMORY] = "memory",           [OBSERVE_PRESSURE] = "pressure",
    [OBSERVE_WAKE] = "wake",           [OBSERVE_TOPOLOGY] = "topology",
};

enum { MAX_BLOCKS = 6 * OBSERVABLES };

struct observers {
  struct observer observer[OBSERVABLES]; /* every = 0: not asked for */
  struct fiber scratch;
  struct observe_block block[MAX_BLOCKS];
  char block_name[MAX_BLOCKS][OBSERVER_NAME_SIZE];
  size_t blocks;
  uint64_t from;               /* of the plan */
  struct contact_log contacts; /* without `record` if no observer asks for them */

  /* Of time series: the columns that the model has, and their places in a row. */
  size_t columns[OBSERVABLES], place[OBSERVABLES][OBSERVE_MOST_COLUMNS];
};

static struct observe_block *add_block(struct observers *observers, const char *name, const char *suffix, bool integer,
                                       size_t count, void *data)
{
  if (count == 0)
    return NULL;
  char *label = observers->block_name[observers->blocks];
  snprintf(label, OBSERVER_NAME_SIZE, "%s-%s", name, suffix);
  struct observe_block *block = &observers->block[observers->blocks++];
  *block = (struct observe_block){.name = label, .integer = integer, .count = count, .data = data};
  return block;
}

/* A 64-bit number, under the name of its key in scenes: "dynamics" and ".every", "" and "from". */
static struct observe_block *add_setting(struct observers *observers, const char *name, const char *key, void *value)
{
  char *label = observers->block_name[observers->blocks];
  snprintf(label, OBSERVER_NAME_SIZE, "%s%s", name, key);
  struct observe_block *block = &observers->block[observers->blocks++];
  *block = (struct observe_block){.name = label, .integer = true, .count = 1, .data = value, .setting = true};
  return block;
}

/* calloc that gives something for nothing. */
static void *zeroed(size_t count, size_t size)
{
  return calloc(count ? count : 1, size);
}

/* The places of those columns that this model has; returns their number. */
static size_t find_columns(const struct model *model, enum observable which, const char *const *names, size_t columns,
                           size_t place[OBSERVE_MOST_COLUMNS])
{
  size_t n = 0;
  for (size_t k = 0; k < columns; k++)
    if (meaning_has_column(model, which, names[k]))
      place[n++] = k;
  return n;
}

/* An observer without its memory. */
static struct observer sized(enum observable which, const struct observe_plan *plan, const struct model *model)
{
  struct observer o = {.type = types[which],
                       .every = plan->every[which],
                       .longest_lag = plan->longest_lag,
                       .from = plan->from,
                       .slabs = plan->slabs};
  if (o.every == 0)
    return o;
  o.size = (struct observer_size){.integers = 1};
  if (o.type->size)
    o.type->size(&o, model, &o.size);
  return o;
}

uint64_t observers_bytes(const struct observe_plan *plan, const struct model *model, uint64_t *scratch)
{
  uint64_t kept = 0;
  *scratch = 0;
  for (int k = 0; k < OBSERVABLES; k++) {
    const struct observer_size size = sized((enum observable)k, plan, model).size;
    kept += sizeof(double) * (size.reals + size.later) + sizeof(int64_t) * size.integers;
    *scratch += sizeof(double) * size.scratch + size.passing;
  }
  return kept;
}

static void show_contact(void *context, const struct contact_event *event)
{
  struct observers *observers = context;
  for (int k = 0; k < OBSERVABLES; k++)
    if (observers->observer[k].every > 0 && observers->observer[k].type->contact)
      observers->observer[k].type->contact(&observers->observer[k], event);
}

static bool create(struct observers *observers, enum observable which, const struct observe_plan *plan,
                   const struct model *model)
{
  struct observer *o = &observers->observer[which];
  *o = sized(which, plan, model);
  if (o->every == 0)
    return true;
  observers->columns[which] = find_columns(model, which, o->type->column, o->type->columns, observers->place[which]);
  o->constant = o->type->constant ? o->type->constant(model) : 0.0;
  o->real = zeroed(o->size.reals, sizeof *o->real);
  o->later = zeroed(o->size.later, sizeof *o->later);
  o->integer = zeroed(o->size.integers, sizeof *o->integer);
  o->scratch = zeroed(o->size.scratch, sizeof *o->scratch);
  if (o->type->add) /* averages are over samples, lags are counted in them; a row of a series stands alone */
    add_setting(observers, observable_names[which], ".every", &o->every);
  if (which == OBSERVE_DYNAMICS)
    add_setting(observers, observable_names[which], ".longest_lag", &o->longest_lag);
  if (which == OBSERVE_PROFILE)
    add_setting(observers, observable_names[which], ".slabs", &o->slabs);
  if (o->type->contact && meaning_holds(THICK, model)) /* no others hand on something at a contact */
    observers->contacts = (struct contact_log){show_contact, observers};
  add_block(observers, observable_names[which], "reals", false, o->size.reals, o->real);
  add_block(observers, observable_names[which], "integers", true, o->size.integers, o->integer)->wraps =
      which == OBSERVE_STRESS; /* sums that wrap: wall/account.h */
  struct observe_block *later = add_block(observers, observable_names[which], "later", false, o->size.later, o->later);
  if (later)
    later->later = true;
  return o->real && o->later && o->integer && o->scratch && !isnan(o->constant);
}

static bool has_averages(const struct observe_plan *plan)
{
  for (int k = 0; k < OBSERVABLES; k++)
    if (plan->every[k] > 0 && types[k]->add)
      return true;
  return false;
}

struct observers *observers_create(const struct observe_plan *plan, const struct model *model)
{
  struct observers *observers = calloc(1, sizeof *observers);
  if (!observers)
    return NULL;
  bool ok = fiber_alloc(&observers->scratch, model);
  for (int k = 0; ok && k < OBSERVABLES; k++)
    ok = create(observers, (enum observable)k, plan, model);
  observers->from = plan->from;
  if (has_averages(plan))
    add_setting(observers, "", "from", &observers->from)->later = true;
  if (!ok) {
    observers_free(observers);
    return NULL;
  }
  return observers;
}

void observers_free(struct observers *observers)
{
  if (!observers)
    return;
  for (int k = 0; k < OBSERVABLES; k++) {
    free(observers->observer[k].real);
    free(observers->observer[k].later);
    free(observers->observer[k].integer);
    free(observers->observer[k].scratch);
  }
  fiber_free(&observers->scratch);
  free(observers);
}

void observers_watch(struct observers *observers, struct work *work)
{
  const struct observer *o = &observers->observer[OBSERVE_STRESS];
  work->mpc.stress = o->every > 0 ? (struct mpc_stress *)o->real : NULL;
}

const struct contact_log *observers_contacts(const struct observers *observers)
{
  return observers->contacts.record ? &observers->contacts : NULL;
}

static bool due(const struct observer *observer, uint64_t step)
{
  return observer->every > 0 && step % observer->every == 0 && (!observer->type->add || step >= observer->from);
}

bool observers_due(const struct observers *observers, uint64_t step)
{
  bool any = false;
  for (int k = 0; k < OBSERVABLES; k++)
    any |= due(&observers->observer[k], step);
  return any;
}

static bool sample(struct observers *observers, enum observable which, struct view *view,
                   const struct observe_sink *sink)
{
  struct observer *o = &observers->observer[which];
  const size_t *place = observers->place[which], columns = observers->columns[which];
  double row[OBSERVE_MOST_COLUMNS];
  const int64_t mark = (int64_t)view->state->step + 1;
  if (o->integer[0] == mark)
    return true;
  if (o->type->add) {
    o->integer[0] = mark;
    o->type->add(o, view);
    return true;
  }
  if (!o->type->row(o, view, row))
    return true;
  o->integer[0] = mark;
  for (size_t k = 0; k < columns; k++) /* places rise, so that nothing is overwritten that is still to come */
    row[k] = row[place[k]];
  return !sink || sink->row(sink->context, which, columns, row);
}

bool observers_sample(struct observers *observers, const struct model *model, const struct state *state,
                      const struct observe_sink *sink)
{
  struct view view = {.model = model, .state = state, .force = observers->scratch.force};
  bool ok = true;
  for (int k = 0; ok && k < OBSERVABLES; k++)
    if (due(&observers->observer[k], state->step))
      ok = sample(observers, (enum observable)k, &view, sink);
  return ok;
}

size_t observe_series_columns(const struct model *model, enum observable which, const char *names[OBSERVE_MOST_COLUMNS])
{
  size_t place[OBSERVE_MOST_COLUMNS];
  const size_t columns = find_columns(model, which, types[which]->column, types[which]->columns, place);
  for (size_t k = 0; k < columns; k++)
    names[k] = types[which]->column[place[k]];
  return columns;
}

/* A summary on its way to whom it is for: without the columns that the model lacks. */
struct narrowing {
  const struct model *model;
  enum observable which;
  bool (*take)(void *context, const struct observe_table *table);
  void *context;
};

static bool narrow(void *context, const struct observe_table *table)
{
  const struct narrowing *n = context;
  const char *names[OBSERVE_MOST_COLUMNS];
  size_t place[OBSERVE_MOST_COLUMNS];
  struct observe_table less = *table;
  less.columns = find_columns(n->model, n->which, table->column, table->columns, place);
  less.column = names;
  less.value = zeroed(table->rows * less.columns, sizeof *less.value);
  for (size_t k = 0; k < less.columns; k++)
    names[k] = table->column[place[k]];
  for (size_t k = 0; less.value && k < table->rows * less.columns; k++)
    less.value[k] = table->value[k / less.columns * table->columns + place[k % less.columns]];
  const bool ok = less.value && n->take(n->context, &less);
  free(less.value);
  return ok;
}

bool observers_summaries(const struct observers *observers, const struct model *model,
                         bool (*take)(void *context, const struct observe_table *table), void *context)
{
  bool ok = true;
  for (int k = 0; ok && k < OBSERVABLES; k++) {
    const struct observer *o = &observers->observer[k];
    struct narrowing narrowing = {model, (enum observable)k, take, context};
    const struct observer_take to = {narrow, &narrowing};
    if (o->every > 0 && o->type->summarise)
      ok = o->type->summarise(o, model, &to);
  }
  return ok;
}

/* name: what follows the observable's. */
static bool is_of_kind(const struct model *model, const char *name)
{
  bool any = !model;
  for (uint32_t k = 0; model && k < model->kinds; k++)
    any |= strcmp(model->kind[k].name, name) == 0;
  return any;
}

bool observe_is_table(const struct model *model, const char *name)
{
  bool any = false;
  for (int k = 0; k < OBSERVABLES; k++) {
    const size_t n = strlen(observable_names[k]);
    const char *rest = name + (strncmp(name, observable_names[k], n) == 0 ? n : strlen(name));
    any |= types[k]->each_kind ? rest[0] == '-' && is_of_kind(model, rest + 1) : strcmp(name, observable_names[k]) == 0;
  }
  return any;
}

size_t observers_blocks(struct observers *observers, const struct observe_block **blocks)
{
  *blocks = observers->block;
  return observers->blocks;
}

uint64_t observers_end(const struct observers *observers, enum observable which)
{
  const struct observer *o = &observers->observer[which];
  return o->every > 0 ? (uint64_t)o->integer[0] : 0;
}
