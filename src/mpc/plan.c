/* The parts of collision and solvent in a plan. */
#include "mpc/plan.h"

#include "mpc/collide.h"
#include "mpc/drive.h"
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

/* Streaming by itself: a kick that depends on y needs the solvent where it is now. */
static bool stream(void *room, const struct moment *now, const struct stage *stage)
{
  const struct mpc *mpc = room;
  (void)stage;
  if (!mpc->fluid->stream(now->state, now->model, 0, now->state->solvent.n, now->fault))
    return false;
  state_streamed(now->state);
  return true;
}

static bool kick(void *room, const struct moment *now, const struct stage *stage)
{
  (void)room;
  drive_kick(now->state, now->model, stage->fraction);
  return true;
}

static bool kick_affine(void *room, const struct moment *now, const struct stage *stage)
{
  (void)room, (void)stage;
  drive_affine_kick(now->state, now->model);
  return true;
}

typedef bool act(void *, const struct moment *, const struct stage *);

static act *const collisions[BATHS] = {[BATH_PARTICLES] = collide_particles, [BATH_PHANTOMS] = collide_random_solvent};

void mpc_plan_collision(struct plan *plan, const struct model *m, size_t room, const char *name)
{
  const bool profile = drive_has_profile(m), affine = drive_has_affine_kick(m);
  if (!model_has_cells(m))
    return;
  if (profile)
    plan_append(plan, (struct stage){.act = stream, .room = room});
  if (profile)
    plan_append(plan, (struct stage){.act = kick, .room = room, .fraction = 0.5});
  plan_append(
      plan, (struct stage){.name = profile || affine ? NULL : name, .act = collisions[m->solvent.bath], .room = room});
  if (profile)
    plan_append(plan, (struct stage){.name = name, .act = kick, .room = room, .fraction = 0.5});
  if (affine)
    plan_append(plan, (struct stage){.name = name, .act = kick_affine, .room = room});
}
