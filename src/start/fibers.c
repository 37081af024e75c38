#include "start/fibers.h"

#include <stdlib.h>

#include "base/memory.h"
#include "bead/company.h"
#include "contact/drift.h"
#include "contact/laying.h"
#include "fiber/start.h"
#include "start/start.h"
#include "system/bead.h"

/* Where fibers are laid: among others, and beside a bead. */
struct ground {
  const struct start_watch *watch; /* or NULL */
  const struct state *state;
  const struct model *model;
  struct laying laying; /* nothing if nobody asks which fibers are there */
  bool in_bead;         /* the last fiber that overlaps does so with the bead: */
  uint32_t bond;        /* this bond of it, */
  double distance;      /* whose axis is so far from the center, a0 */
};

static enum fiber_verdict judge_fiber(void *context, const struct point *position, uint32_t fiber)
{
  static const enum fiber_verdict verdicts[] = {
      [LAYING_FITS] = FIBER_STAYS, [LAYING_OVERLAPS] = FIBER_OVERLAPS, [LAYING_NO_MEMORY] = FIBER_NO_MEMORY};
  struct ground *g = context;
  const struct state *s = g->state;
  if (g->watch && g->watch->keep_on && !g->watch->keep_on(g->watch->context))
    return FIBER_GIVEN_UP;
  g->in_bead =
      s->beads > 0 && !bead_company_clear(g->model, s->bead->position, position, fiber, &g->bond, &g->distance);
  if (g->in_bead)
    return FIBER_OVERLAPS;
  return g->laying.model ? verdicts[laying_add(&g->laying, position, fiber)] : FIBER_STAYS;
}

/* Does it matter where fibers are beside each other? Thin ones at random do not touch: at_will says that not all are.
 */
static bool is_crowded(const struct model *model, bool at_will)
{
  return model->thickness > 0 || (at_will && laying_minds_lines(model) && model->bonds > 1);
}

static bool have_places(const struct model *model)
{
  bool have = false;
  for (uint32_t k = 0; k < model->kinds; k++)
    have = have || model->kind[k].placed > 0;
  return have;
}

bool start_is_crowded(const struct model *model)
{
  return is_crowded(model, have_places(model)) || model_has_bead(model);
}

static bool record_overlap(const struct ground *g, struct fault *fault)
{
  const struct model *m = g->model;
  const struct laying *l = &g->laying;
  if (!g->in_bead)
    return fault_record(fault, FAULT_OVERLAP, 0, l->bond, l->distance,
                        (double)model_reach(m, l->bond, l->other) * LATTICE_UNIT);
  const struct fiber_kind *kind = &m->kind[m->fiber_kind_of[m->fiber_of[g->bond]]];
  return fault_record(fault, FAULT_BEAD_OVERLAP, 0, g->bond, g->distance,
                      (double)(bead_radius(m) + kind->radius) * LATTICE_UNIT);
}

static bool record_start(const struct ground *g, enum fiber_start_end end, uint32_t fiber, struct fault *fault)
{
  if (end == FIBERS_OVERLAP)
    return record_overlap(g, fault);
  if (end == FIBERS_NO_ROOM)
    return fault_record(fault, FAULT_NO_ROOM, 0, fiber, FIBER_MOST_ATTEMPTS, FIBER_MOST_ATTEMPTS);
  if (end == FIBERS_GIVEN_UP)
    return fault_record(fault, FAULT_GIVEN_UP, 0, fiber, 0.0, 0.0);
  return end == FIBERS_LAID || fault_no_memory(fault, 0);
}

bool start_fibers(struct state *state, const struct model *model, const struct start_watch *watch, struct fault *fault)
{
  struct ground ground = {.watch = watch, .state = state, .model = model};
  const struct fiber_room room = {judge_fiber, &ground};
  uint32_t fiber = 0;
  enum fiber_start_end end = FIBERS_NO_MEMORY;
  if (!is_crowded(model, have_places(model)) || laying_begin(&ground.laying, model))
    end = fiber_start(state, model, ground.laying.model || model_has_bead(model) ? &room : NULL, &fiber);
  const bool ok = record_start(&ground, end, fiber, fault);
  laying_end(&ground.laying);
  return ok;
}

/* Vertices as the moves see them: in coordinates in which images stand still. To be freed; NULL if memory is short. */
static struct point *places_in_frame(const struct state *state, const struct model *model)
{
  const struct drift_frame frame = drift_frame_now(state, model, 1.0, 0, true);
  struct point *place = memory_alloc((size_t)state->vertices + 1, sizeof *place);
  for (uint32_t i = 0; place && i < state->vertices; i++)
    place[i] = frame.sheared ? drift_enter(&frame, state->position[i]) : state->position[i];
  return place;
}

bool start_sound(const struct state *state, const struct model *model, struct fault *fault)
{
  static const enum fiber_start_end ends[] = {[FIBER_STAYS] = FIBERS_LAID,
                                              [FIBER_OVERLAPS] = FIBERS_OVERLAP,
                                              [FIBER_NO_MEMORY] = FIBERS_NO_MEMORY,
                                              [FIBER_GIVEN_UP] = FIBERS_GIVEN_UP};
  struct ground ground = {.state = state, .model = model};
  enum fiber_start_end end = FIBERS_LAID;
  struct point *place = places_in_frame(state, model);
  if (!place || (is_crowded(model, true) && !laying_begin(&ground.laying, model)))
    end = FIBERS_NO_MEMORY;
  for (uint32_t fiber = 0; end == FIBERS_LAID && fiber < model->fibers; fiber++)
    end = ends[judge_fiber(&ground, place, fiber)];
  const bool ok = record_start(&ground, end, 0, fault);
  laying_end(&ground.laying);
  free(place);
  return ok;
}
