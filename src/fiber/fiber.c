/* The fibers' scratch, and their part of a plan. */
#include <string.h>

#include "base/memory.h"
#include "fiber/force.h"
#include "fiber/overdamped.h"
#include "system/plan.h"

enum { NEEDS = 2 };

static void list_needs(struct fiber *f, const struct model *m, struct memory_need need[NEEDS])
{
  need[0] = (struct memory_need){(void **)&f->force, m->vertices, sizeof *f->force};
  need[1] = (struct memory_need){(void **)&f->overdamped, overdamped_doubles(m), sizeof *f->overdamped};
}

bool fiber_alloc(struct fiber *f, const struct model *m)
{
  struct memory_need need[NEEDS];
  list_needs(f, m, need);
  return memory_take(need, NEEDS);
}

void fiber_free(struct fiber *f)
{
  struct memory_need need[NEEDS];
  const struct model nothing = {0};
  list_needs(f, &nothing, need);
  memory_release(need, NEEDS);
}

uint64_t fiber_bytes(const struct model *m)
{
  struct fiber f = {0};
  struct memory_need need[NEEDS];
  list_needs(&f, m, need);
  return memory_bytes(need, NEEDS);
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

static bool act_move(void *room, const struct moment *now, const struct stage *stage)
{
  (void)stage;
  const struct fiber *f = room;
  return overdamped_move(now->state, now->model, f->force, f->overdamped, now->step, now->fault);
}

void fiber_plan_move(struct plan *plan, const struct model *m, size_t room, const char *name)
{
  if (m->vertices > 0)
    plan_append(plan, (struct stage){.name = name, .act = act_move, .room = room});
}
