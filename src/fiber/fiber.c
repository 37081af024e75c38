/* The fibers' scratch, and their part of a plan. */
#include <string.h>

#include "base/memory.h"
#include "fiber/force.h"
#include "system/plan.h"

bool fiber_alloc(struct fiber *f, const struct model *m)
{
  const struct memory_need need = {(void **)&f->force, m->vertices, sizeof *f->force};
  return memory_take(&need, 1);
}

void fiber_free(struct fiber *f)
{
  const struct memory_need need = {(void **)&f->force, 0, sizeof *f->force};
  memory_release(&need, 1);
}

uint64_t fiber_bytes(const struct model *m)
{
  return (uint64_t)m->vertices * sizeof(struct vec3);
}

static bool act_forces(void *room, const struct moment *now, const struct stage *stage)
{
  (void)stage;
  const struct fiber *f = room;
  return fiber_forces(now->state, now->model, f->force, now->step, now->fault);
}

static bool act_kick(void *room, const struct moment *now, const struct stage *stage)
{
  const struct fiber *f = room;
  fiber_kick(now->state, now->model, f->force, stage->fraction);
  return true;
}

void fiber_plan_forces(struct plan *plan, const struct model *m, size_t room, const char *name)
{
  if (m->vertices > 0)
    plan_append(plan, (struct stage){.name = name, .act = act_forces, .room = room});
}

void fiber_plan_kick(struct plan *plan, const struct model *m, size_t room, double fraction, const char *name)
{
  if (m->vertices > 0)
    plan_append(plan, (struct stage){.name = name, .act = act_kick, .room = room, .fraction = fraction});
}
