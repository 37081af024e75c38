/* The media's scratch, and their part of a plan. */
#include "medium/medium.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "medium/plan.h"
#include "medium/repulsion.h"

enum { NEEDS = 10 };

static void list_needs(struct medium *medium, const struct model *m, struct memory_need need[NEEDS])
{
  const bool pairs = m->medium.kind == MEDIUM_PAIRS, repels = model_repels(m);
  const size_t members = pairs ? (size_t)m->solvent.particles + m->vertices : 0;
  const struct memory_need all[NEEDS] = {
      {(void **)&medium->place, members, sizeof *medium->place},
      {(void **)&medium->first, pairs ? (size_t)box_cell_count(&m->box) + 1 : 0, sizeof *medium->first},
      {(void **)&medium->x, members, sizeof *medium->x},
      {(void **)&medium->y, members, sizeof *medium->y},
      {(void **)&medium->z, members, sizeof *medium->z},
      {(void **)&medium->number, members, sizeof *medium->number},
      {(void **)&medium->mover, members, sizeof *medium->mover},
      {(void **)&medium->push, repels ? 3 * members : 0, sizeof *medium->push},
      {(void **)&medium->crowd, m->medium.many.repulsion != 0.0 ? members : 0, sizeof *medium->crowd},
      {(void **)&medium->force, repels ? members : 0, sizeof *medium->force},
  };
  memcpy(need, all, sizeof all);
}

bool medium_alloc(struct medium *medium, const struct model *m, const struct fluid *fluid)
{
  struct memory_need need[NEEDS];
  *medium = (struct medium){.fluid = fluid, .members = m->solvent.particles + m->vertices};
  list_needs(medium, m, need);
  return memory_take(need, NEEDS);
}

void medium_free(struct medium *medium)
{
  struct memory_need need[NEEDS];
  const struct model nothing = {0};
  list_needs(medium, &nothing, need);
  memory_release(need, NEEDS);
  free(medium->encounter);
  free(medium->key);
  free(medium->spare);
  memset(medium, 0, sizeof *medium);
}

uint64_t medium_bytes(const struct model *m)
{
  struct medium medium = {0};
  struct memory_need need[NEEDS];
  list_needs(&medium, m, need);
  return memory_bytes(need, NEEDS);
}

/* Observables sum forces of pairs anew: with scratch of their own, and slopes of the densities. */
uint64_t medium_bytes_later(const struct model *m)
{
  struct medium medium;
  const size_t encounter = sizeof *medium.encounter + sizeof *medium.key + sizeof *medium.spare;
  const uint64_t members = m->medium.many.repulsion != 0.0 ? (uint64_t)m->solvent.particles + m->vertices : 0;
  const uint64_t measuring = members * (sizeof(struct vec3) + sizeof(double));
  return (model_repels(m) ? medium_bytes(m) + measuring : 0) + (uint64_t)(encounters_expected(m) * (double)encounter);
}

static bool act_private(void *room, const struct moment *now, const struct stage *stage)
{
  (void)stage;
  return private_collide(now->state, now->model, room, now->step, now->fault);
}

static bool act_pairs(void *room, const struct moment *now, const struct stage *stage)
{
  (void)stage;
  return pairs_collide(now->state, now->model, room, now->step, now->fault);
}

static bool act_listed(void *room, const struct moment *now, const struct stage *stage)
{
  (void)stage;
  pairs_act(now->state, room);
  return true;
}

/* With kick-split, places are the same in the collision as for the forces before it: one search does for both. */
static bool lists_with_forces(const struct model *m)
{
  return model_repels(m) && m->scheme == SCHEME_KICK_SPLIT;
}

typedef bool act(void *, const struct moment *, const struct stage *);

static act *const baths[MEDIA] = {[MEDIUM_PRIVATE] = act_private, [MEDIUM_PAIRS] = act_pairs};

void medium_plan_collision(struct plan *plan, const struct model *m, size_t room, const char *name)
{
  act *const bath = lists_with_forces(m) ? act_listed : baths[m->medium.kind];
  if (bath)
    plan_append(plan, (struct stage){.name = name, .act = bath, .room = room});
}

static bool act_forces(void *room, const struct moment *now, const struct stage *stage)
{
  (void)stage;
  return repulsion_forces(now->state, now->model, room, now->fault);
}

static bool act_forces_and_list(void *room, const struct moment *now, const struct stage *stage)
{
  (void)stage;
  return repulsion_forces_and_encounters(now->state, now->model, room, now->step, now->fault);
}

static bool act_kick(void *room, const struct moment *now, const struct stage *stage)
{
  repulsion_kick(now->state, now->model, room, stage->fraction);
  return true;
}

void medium_plan_forces(struct plan *plan, const struct model *m, size_t room, const char *name)
{
  if (model_repels(m))
    plan_append(plan, (struct stage){
                          .name = name, .act = lists_with_forces(m) ? act_forces_and_list : act_forces, .room = room});
}

void medium_plan_kick(struct plan *plan, const struct model *m, size_t room, double fraction, const char *name)
{
  if (model_repels(m))
    plan_append(plan, (struct stage){.name = name, .act = act_kick, .room = room, .fraction = fraction});
}
