/* Packs of scenes, and of starts. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/company.h"
#include "oracle/contract.h"
#include "oracle/operators.h"
#include "oracle/oracle.h"
#include "step.h"

/* --- packs ------------------------------------------------------------------------------------------------------- */

static bool advance_to(struct oracle_stage *g, uint64_t step, const struct contact_log *log, struct message *message)
{
  while (g->state->step < step)
    if (!step_advance(g->state, g->model, g->work, log))
      return message_fault(message, &g->work->fault);
  return true;
}

/* A scene's run of its own, for one part of a pack: what it leaves behind is no state of the scene's run. The model
 * comes first in a pack, with the stream of the run. */
typedef bool in_run(struct oracle_stage *stage, const struct scene *scene, uint64_t step, struct message *message);

static bool with_run(struct scene *scene, in_run *put, uint64_t step, struct pack *pack, struct message *message)
{
  const struct model *model = &scene->model;
  struct state state = {0};
  struct work work = {0};
  bool ok = state_alloc(&state, model) && work_alloc(&work, model) && work_add_everything(&work, model);
  message_set(message, "no memory for this scene");
  if (ok) {
    struct oracle_stage g = {.model = model, .state = &state, .work = &work, .pack = pack, .steps = scene->steps};
    ok = contract_start(scene, &state, &work, message);
    if (ok && pack->count == 0)
      oracle_put_model(&g);
    ok = ok && put(&g, scene, step, message);
  }
  work_free(&work);
  state_free(&state);
  return ok && !pack->failed;
}

/* All operators of step number `step`. */
static bool put_step(struct oracle_stage *g, const struct scene *scene, uint64_t step, struct message *message)
{
  (void)scene;
  struct oracle_company company = {.stage = g};
  const struct contact_log log = {oracle_company_take, &company};
  const bool beside = model_has_bead(g->model) && g->model->kinds > 0;
  g->company = &company;
  const bool ok = advance_to(g, step - 1, beside ? &log : NULL, message) &&
                  (oracle_run_operators(g) || g->pack->failed || message_fault(message, &g->work->fault));
  g->company = NULL;
  return ok;
}

bool oracle_emit(struct scene *scene, struct pack *pack, struct message *message)
{
  const struct model *model = &scene->model;
  const uint64_t interval = model_has_solvent(model) ? model->solvent.interval_steps : 1;
  const uint64_t last = scene->steps / interval * interval;
  memset(pack, 0, sizeof *pack);
  if (!contract_covers(scene, true, message))
    return false;
  if (last == 0)
    return message_set(message, "%s: no collision within its %" PRIu64 " steps; a pack needs one", scene->path,
                       scene->steps);
  return with_run(scene, put_step, interval, pack, message) &&
         (last == interval || with_run(scene, put_step, last, pack, message));
}

/* --- what a run starts from -------------------------------------------------------------------------------------- */

static bool put_start(struct oracle_stage *g, const struct scene *scene, uint64_t step, struct message *message)
{
  (void)scene, (void)step, (void)message;
  oracle_put_start(g);
  return true;
}

bool oracle_start(struct scene *scene, struct pack *pack, struct message *message)
{
  memset(pack, 0, sizeof *pack);
  return contract_covers(scene, false, message) && with_run(scene, put_start, 0, pack, message);
}

static int by_place(const void *left, const void *right)
{
  const struct pack_table *a = left, *b = right;
  const int rank_a = oracle_operator_rank(a->place.operator_name),
            rank_b = oracle_operator_rank(b->place.operator_name);
  if (a->place.step != b->place.step)
    return a->place.step < b->place.step ? -1 : 1;
  const int tables = strcmp(a->name, b->name);
  return rank_a != rank_b ? rank_a - rank_b
         : tables != 0    ? tables
                          : strcmp(a->place.operator_name, b->place.operator_name);
}

void oracle_sort(struct pack *pack)
{
  if (pack->count > 0)
    qsort(pack->table, pack->count, sizeof *pack->table, by_place);
}
