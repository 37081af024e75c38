/* The collision's part of a plan. */
#include "mpc/plan.h"

#include "mpc/collide.h"
#include "mpc/random_solvent.h"

static bool collide_particles(void *room, const struct moment *now, const struct stage *stage)
{
  (void)stage;
  return mpc_collide(now->state, now->model, room, now->step, now->fault);
}

static bool collide_random_solvent(void *room, const struct moment *now, const struct stage *stage)
{
  (void)stage;
  return random_solvent_collide(now->state, now->model, room, now->step, now->fault);
}

typedef bool act(void *, const struct moment *, const struct stage *);

static act *const collisions[BATHS] = {[BATH_PARTICLES] = collide_particles, [BATH_PHANTOMS] = collide_random_solvent};

void mpc_plan_collision(struct plan *plan, const struct model *m, size_t room, const char *name)
{
  if (model_collides(m))
    plan_append(plan, (struct stage){.name = name, .act = collisions[m->solvent.bath], .room = room});
}
